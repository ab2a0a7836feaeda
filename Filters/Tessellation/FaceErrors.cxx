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
constexpr double Rounding = 1e-9; // Of a limit.
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

double FaceErrors::Longest(const int* t) const
{
  const Vec3* x = this->Mesh.Points.data();
  return std::max(
    { (x[t[1]] - x[t[0]]).norm(), (x[t[2]] - x[t[1]]).norm(), (x[t[0]] - x[t[2]]).norm() });
}

double FaceErrors::SideExcess(const int* t, int i) const
{
  const double length = this->Job.Options->MaximumEdgeLength;
  const double angle = this->Job.Options->MaximumAngle;
  const int j = (i + 1) % 3;
  double excess = 0.0;
  if (length > 0.0)
  {
    excess = (this->Mesh.Points[t[j]] - this->Mesh.Points[t[i]]).norm() / length;
  }
  if (angle > 0.0 && this->Longest(t) >= SmallForAngles * this->Job.Tolerance)
  {
    excess = std::max(excess, Angle(this->NormalInside(t, i), this->NormalInside(t, j)) / angle);
  }
  return excess * (1.0 - Rounding);
}

Vec3 FaceErrors::NormalInside(const int* t, int i) const
{
  const Vec2& uv = this->Mesh.UV[t[i]];
  bool on = false;
  for (int d = 0; d < 2; ++d)
  {
    const std::vector<double>& creases = this->Job.Bound->Creases(d);
    on = on || std::binary_search(creases.begin(), creases.end(), uv[d]);
  }
  if (!on)
  {
    return this->Mesh.Normals[t[i]];
  }
  const Vec2 middle = (this->Mesh.UV[t[0]] + this->Mesh.UV[t[1]] + this->Mesh.UV[t[2]]) / 3.0;
  const Vec2 p = uv + BesideCrease * (middle - uv);
  return Normal(this->Job.Bound->View(), p[0], p[1]);
}

bool FaceErrors::HasLimits() const
{
  return this->Job.Options->MaximumEdgeLength > 0.0 || this->Job.Options->MaximumAngle > 0.0;
}

bool FaceErrors::ExceedsLimits(const int* t) const
{
  return this->HasLimits() && !this->IsCollapsed(t) &&
    (this->SideExcess(t, 0) > 1.0 || this->SideExcess(t, 1) > 1.0 || this->SideExcess(t, 2) > 1.0);
}

bool FaceErrors::IsTiny(const int* t) const
{
  return this->Longest(t) < 0.5 * this->Job.Tolerance;
}

bool FaceErrors::IsGap(const int* t) const
{
  const Vec3* x = this->Mesh.Points.data();
  return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).norm() <= this->GapOf(t) * this->Longest(t);
}

bool FaceErrors::LooksBack(const int* t) const
{
  const Facet facet(this->Mesh.Points[t[0]], this->Mesh.Points[t[1]], this->Mesh.Points[t[2]]);
  return facet.HasPlane() && this->IsFolded(t, facet.Normal()) && !this->IsTiny(t);
}

bool FaceErrors::IsFolded(const int* t, const Vec3& n) const
{
  return n.dot(this->Mesh.Normals[t[0]]) < 0.0 && n.dot(this->Mesh.Normals[t[1]]) < 0.0 &&
    n.dot(this->Mesh.Normals[t[2]]) < 0.0;
}

ParameterBox FaceErrors::BoxOf(const int* t) const
{
  const Vec2& a = this->Mesh.UV[t[0]];
  const Vec2& b = this->Mesh.UV[t[1]];
  const Vec2& c = this->Mesh.UV[t[2]];
  return { std::min({ a[0], b[0], c[0] }), std::max({ a[0], b[0], c[0] }),
    std::min({ a[1], b[1], c[1] }), std::max({ a[1], b[1], c[1] }) };
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
