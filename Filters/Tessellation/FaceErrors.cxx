// SPDX-License-Identifier: BSD-3-Clause
#include "FaceErrors.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{
constexpr double RoomBesideGap = 0.3; // Of the tolerance: what a triangle may add to a gap.
} // namespace

double FaceErrors::GapOf(const int* t) const
{
  double gap = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    gap = t[i] < this->BoundaryCount ? std::max(gap, this->Gaps[t[i]]) : gap;
  }
  return gap;
}

double FaceErrors::Limit(const int* t) const
{
  return std::max(this->Job.Tolerance, this->GapOf(t) + RoomBesideGap * this->Job.Tolerance);
}

bool FaceErrors::IsPole(int vertex) const
{
  if (vertex >= this->BoundaryCount)
  {
    return false;
  }
  const std::int64_t edge = this->Segments[vertex]->Edge;
  return (edge >= 0 && (*this->Job.Edges)[edge].Degenerate) ||
    this->Mesh.Points[vertex] == this->Mesh.Points[this->Next[vertex]];
}

// The corner that stands for a side of poles; -1: none, or the base has no direction of its own.
int FaceErrors::PoleOf(const int* t) const
{
  for (int i = 0; i < 3; ++i)
  {
    if (this->IsPole(t[i]))
    {
      return i;
    }
  }
  return -1;
}

bool FaceErrors::IsCollapsed(const int* t) const
{
  const Vec3* x = this->Mesh.Points.data();
  return x[t[0]] == x[t[1]] || x[t[1]] == x[t[2]] || x[t[2]] == x[t[0]];
}

double FaceErrors::TriangleError(FacetBound& bound, const int* t) const
{
  if (this->IsCollapsed(t))
  {
    return 0.0;
  }
  const Vec3* x = this->Mesh.Points.data();
  const Vec2* uv = this->Mesh.UV.data();
  FacetBound::Triangle triangle;
  for (int i = 0; i < 3; ++i)
  {
    triangle.X[i] = x[t[i]];
    triangle.UV[i] = uv[t[i]];
    triangle.Normal[i] = this->Mesh.Normals[t[i]];
    triangle.Boundary[i] = this->IsSegment(t[i], t[(i + 1) % 3]);
  }
  triangle.Gap = this->GapOf(t);
  triangle.Pole = this->PoleOf(t);
  return bound.Error(triangle, this->Limit(t));
}

} // namespace nurbs
