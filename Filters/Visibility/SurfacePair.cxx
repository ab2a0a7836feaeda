// SPDX-License-Identifier: BSD-3-Clause
#include "SurfacePair.h"

#include <cmath>

namespace nurbs
{

namespace
{

// Of the size: gaps and steps that small are rounding.
constexpr double ZeroGap = 1e-12;
constexpr double ZeroStep = 1e-11;

// The parameters' part of a vector in the tangent plane.
Vec2 ParametersOf(const SurfaceDerivatives& d, const Vec3& way)
{
  const double uu = d.Su.squaredNorm();
  const double uv = d.Su.dot(d.Sv);
  const double vv = d.Sv.squaredNorm();
  const double u = d.Su.dot(way);
  const double v = d.Sv.dot(way);
  const double det = uu * vv - uv * uv;
  return Vec2(vv * u - uv * v, uu * v - uv * u) / det;
}

} // namespace

SurfacePair::SurfacePair(const SurfaceEvaluator& a, const Box2& boxA, const SurfaceEvaluator& b,
  const Box2& boxB, double size)
  : Surfaces{ a, b }
  , Boxes{ boxA, boxB }
  , Length(size)
{}

bool SurfacePair::Converged(double gap, double move) const
{
  return gap <= ZeroGap * this->Length && move <= ZeroStep * this->Length;
}

bool SurfacePair::IsInBox(int side, const Vec2& uv, double share) const
{
  const Box2& box = this->Boxes[side];
  const Vec2 margin = share * box.sizes();
  return (uv - (box.min() - margin)).minCoeff() >= 0.0 &&
    ((box.max() + margin) - uv).minCoeff() >= 0.0;
}

bool SurfacePair::MoveToPlane(const Vec3& place, const Vec3& normal, IntersectionPoint& point)
{
  for (int k = 0; k < MaxPairSteps; ++k)
  {
    const SurfaceDerivatives a = this->Surfaces[0].Derivatives(point.UV[0][0], point.UV[0][1], 1);
    const SurfaceDerivatives b = this->Surfaces[1].Derivatives(point.UV[1][0], point.UV[1][1], 1);
    point.Point = 0.5 * (a.S + b.S);
    // Within each tangent plane: the nearest to the plane and the other one, by normals, which
    // keeps a system of three unknowns.
    const Vec3 na = a.Su.cross(a.Sv);
    const Vec3 nb = b.Su.cross(b.Sv);
    Eigen::Matrix3d m;
    m.row(0) = na.normalized();
    m.row(1) = nb.normalized();
    m.row(2) = normal;
    const Vec3 right(m.row(0).dot(a.S), m.row(1).dot(b.S), normal.dot(place));
    const Vec3 next = m.inverse() * right;
    if (!next.allFinite())
    {
      return false;
    }
    const Vec2 stepA = ParametersOf(a, next - a.S);
    const Vec2 stepB = ParametersOf(b, next - b.S);
    if (!stepA.allFinite() || !stepB.allFinite())
    {
      return false;
    }
    if (this->Converged((a.S - b.S).norm(), (next - a.S).norm() + (next - b.S).norm()))
    {
      return true;
    }
    point.UV[0] += stepA;
    point.UV[1] += stepB;
    if (!this->IsNear(0, point.UV[0]) || !this->IsNear(1, point.UV[1]))
    {
      return false;
    }
  }
  return false;
}

CrossingFrame SurfacePair::Frame(const IntersectionPoint& point)
{
  CrossingFrame out;
  SurfaceDerivatives d[2];
  Vec3 normals[2];
  for (int side = 0; side < 2; ++side)
  {
    d[side] = this->Surfaces[side].Derivatives(point.UV[side][0], point.UV[side][1], 1);
    normals[side] = d[side].Su.cross(d[side].Sv);
    const double length = normals[side].norm();
    if (!(length > 1e-12 * d[side].Su.norm() * d[side].Sv.norm()))
    {
      return out;
    }
    normals[side] /= length;
  }
  const Vec3 cross = normals[0].cross(normals[1]);
  out.Sine = cross.norm();
  if (!(out.Sine > 0.0))
  {
    return out;
  }
  out.Tangent = cross / out.Sine;
  for (int side = 0; side < 2; ++side)
  {
    out.Across[side] = normals[side].cross(out.Tangent);
    out.AlongUV[side] = ParametersOf(d[side], out.Tangent);
    out.AcrossUV[side] = ParametersOf(d[side], out.Across[side]);
  }
  return out;
}

std::optional<bool> SurfacePair::LiesOnOther(
  int side, const Vec3& point, Vec2 uvOther, double tolerance)
{
  const int other = 1 - side;
  for (int k = 0; k < MaxPairSteps; ++k)
  {
    const SurfaceDerivatives d = this->Surfaces[other].Derivatives(uvOther[0], uvOther[1], 1);
    const Vec2 step = ParametersOf(d, point - d.S);
    if (!step.allFinite())
    {
      return std::nullopt;
    }
    const double move = (d.Su * step[0] + d.Sv * step[1]).norm();
    if (move <= 0.1 * tolerance)
    {
      return this->IsInBox(other, uvOther, 1e-6)
        ? std::optional<bool>((d.S - point).norm() <= tolerance)
        : std::nullopt;
    }
    uvOther += step;
    if (!this->IsInBox(other, uvOther, 0.5))
    {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

} // namespace nurbs
