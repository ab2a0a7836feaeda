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

} // namespace

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
  return FindCommonPoint(
    [&](int side, const Vec2& uv) { return this->Surfaces[side].Derivatives(uv[0], uv[1], 1); },
    place, normal, [&](double gap, double move) { return this->Converged(gap, move); },
    [&](
      const IntersectionPoint& p) { return this->IsNear(0, p.UV[0]) && this->IsNear(1, p.UV[1]); },
    point);
}

bool FindCommonPoint(const SurfaceView& a, const SurfaceView& b, const Vec3& place,
  const Vec3& normal, IntersectionPoint& point)
{
  const SurfaceView* surfaces[2] = { &a, &b };
  const double size = place.cwiseAbs().maxCoeff() + (point.Point - place).norm();
  const auto isInside = [&](const IntersectionPoint& p) {
    bool out = true;
    for (int k = 0; k < 4; ++k)
    {
      const Interval domain = surfaces[k / 2]->Domain(k % 2);
      const double t = p.UV[k / 2][k % 2];
      const double margin = 1e-3 * domain.Length();
      out = out && t >= domain.Min - margin && t <= domain.Max + margin;
    }
    return out;
  };
  return FindCommonPoint(
    [&](int side, const Vec2& uv) { return EvaluateDerivatives(*surfaces[side], uv[0], uv[1], 1); },
    place, normal,
    [&](double gap, double move) { return gap <= ZeroGap * size && move <= ZeroStep * size; },
    isInside, point);
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
