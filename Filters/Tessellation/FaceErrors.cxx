// SPDX-License-Identifier: BSD-3-Clause
#include "FaceErrors.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{
// In tolerances: gaps from here on leave no room,
constexpr double LargestGap = 0.85;
// and this is what a triangle may add to one.
constexpr double RoomBesideGap = 0.3;
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
  const double gap = this->GapOf(t);
  return gap <= LargestGap * this->Job.Tolerance ? this->Job.Tolerance
                                                 : gap + RoomBesideGap * this->Job.Tolerance;
}

// The direction (0: u, 1: v) in which a pole's parameters run along the boundary; -1: no pole.
int FaceErrors::PoleDirection(int vertex) const
{
  if (vertex >= this->BoundaryCount)
  {
    return -1;
  }
  const auto direction = [&](int a, int b) {
    const Vec2 d = (this->Mesh.UV[b] - this->Mesh.UV[a]).cwiseAbs();
    return this->Mesh.Points[a] != this->Mesh.Points[b] ? -1
      : d[1] == 0.0                                     ? 0
      : d[0] == 0.0                                     ? 1
                                                        : -1;
  };
  const int after = direction(vertex, this->Next[vertex]);
  return after < 0 ? direction(this->Previous[vertex], vertex) : after;
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
  for (int i = 0; i < 3 && triangle.Pole < 0; ++i)
  {
    triangle.PoleDirection = this->PoleDirection(t[i]);
    triangle.Pole = triangle.PoleDirection < 0 ? -1 : i;
  }
  return bound.Error(triangle, this->Limit(t));
}

} // namespace nurbs
