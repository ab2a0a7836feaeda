// SPDX-License-Identifier: BSD-3-Clause
/// @file SurfacePair.h
/// @brief Points that two surfaces have in common, by Newton's method.
#pragma once

#include "SurfaceEvaluator.h"

#include <optional>

namespace nurbs
{

/// A common point of two surfaces.
struct IntersectionPoint
{
  Vec3 Point = Vec3::Zero();
  Vec2 UV[2] = { Vec2::Zero(), Vec2::Zero() };
};

/// How two surfaces cross in a common point.
struct CrossingFrame
{
  Vec3 Tangent = Vec3::Zero(); ///< Of the curve: n0 x n1, of unit length.
  double Sine = 0.0;           ///< Of the angle between the surfaces; 0 where a normal vanishes.
  Vec3 Across[2];              ///< n x Tangent, in each surface.
  Vec2 AlongUV[2];             ///< What Tangent and
  Vec2 AcrossUV[2];            ///< Across are in (u, v).
};

/// Newton's method for a point of two surfaces in the plane through `place` orthogonal to `normal`.
/// `evaluate(side, uv)` gives first derivatives; `isDone(gap, move)` looks at the distance of the
/// two surfaces' points and the next step; `isValid(point)` at parameters. False: it fails.
template <typename Evaluate, typename IsDone, typename IsValid>
bool FindCommonPoint(const Evaluate& evaluate, const Vec3& place, const Vec3& normal,
  const IsDone& isDone, const IsValid& isValid, IntersectionPoint& point);

/// The same for two surfaces by name, to rounding. Within their domains.
bool FindCommonPoint(const SurfaceView& a, const SurfaceView& b, const Vec3& place,
  const Vec3& normal, IntersectionPoint& point);

/// Two surfaces, each within a box of its domain. Not for more than one thread.
class SurfacePair
{
public:
  SurfacePair(const SurfaceEvaluator& a, const Box2& boxA, const SurfaceEvaluator& b,
    const Box2& boxB, double size);

  /// Moves a guess to the common point in the plane through `place` orthogonal to `normal`.
  /// Parameters may leave the boxes. False: it does not converge.
  bool MoveToPlane(const Vec3& place, const Vec3& normal, IntersectionPoint& point);

  /// Moves a guess to where curve(t) in the domain of surface `side` meets the other one. `curve`
  /// gives (u, v) and its derivative. False: it does not converge.
  template <typename Curve>
  bool MoveAlongCurve(int side, const Curve& curve, double& t, IntersectionPoint& point);

  CrossingFrame Frame(const IntersectionPoint& point);

  /// True if the point of one surface at uv lies within `tolerance` of the other one, inside its
  /// box. `uvOther`: a guess. No value: the foot is beyond the box.
  std::optional<bool> LiesOnOther(int side, const Vec3& point, Vec2 uvOther, double tolerance);

  const Box2& Box(int side) const { return this->Boxes[side]; }
  SurfaceEvaluator& Evaluator(int side) { return this->Surfaces[side]; }
  double Size() const { return this->Length; }
  /// True if uv is within a side's box, or beyond it by that share of its size.
  bool IsInBox(int side, const Vec2& uv, double share) const;

private:
  bool IsNear(int side, const Vec2& uv) const { return this->IsInBox(side, uv, 1.0); }
  bool Converged(double gap, double move) const;

  SurfaceEvaluator Surfaces[2];
  Box2 Boxes[2];
  double Length;
};

/// Steps of Newton's method, at most.
inline constexpr int MaxPairSteps = 20;

/// The coordinates in (u, v) of a vector in the tangent plane; of another one: of its projection.
Vec2 ParametersOf(const SurfaceDerivatives& d, const Vec3& way);

template <typename Evaluate, typename IsDone, typename IsValid>
bool FindCommonPoint(const Evaluate& evaluate, const Vec3& place, const Vec3& normal,
  const IsDone& isDone, const IsValid& isValid, IntersectionPoint& point)
{
  for (int k = 0; k < MaxPairSteps; ++k)
  {
    const SurfaceDerivatives d[2] = { evaluate(0, point.UV[0]), evaluate(1, point.UV[1]) };
    point.Point = 0.5 * (d[0].S + d[1].S);
    // Where both tangent planes and the plane meet.
    Eigen::Matrix3d m;
    m.row(0) = d[0].Su.cross(d[0].Sv).normalized();
    m.row(1) = d[1].Su.cross(d[1].Sv).normalized();
    m.row(2) = normal;
    const Vec3 right(m.row(0).dot(d[0].S), m.row(1).dot(d[1].S), normal.dot(place));
    const Vec3 next = m.inverse() * right;
    if (!next.allFinite())
    {
      return false;
    }
    if (isDone((d[0].S - d[1].S).norm(), (next - d[0].S).norm() + (next - d[1].S).norm()))
    {
      return true;
    }
    for (int side = 0; side < 2; ++side)
    {
      point.UV[side] += ParametersOf(d[side], next - d[side].S);
    }
    if (!point.UV[0].allFinite() || !point.UV[1].allFinite() || !isValid(point))
    {
      return false;
    }
  }
  return false;
}

template <typename Curve>
bool SurfacePair::MoveAlongCurve(int side, const Curve& curve, double& t, IntersectionPoint& point)
{
  Vec2& own = point.UV[side];
  Vec2& other = point.UV[1 - side];
  for (int k = 0; k < MaxPairSteps; ++k)
  {
    Vec2 along;
    curve(t, own, along);
    const SurfaceDerivatives a = this->Surfaces[side].Derivatives(own[0], own[1], 1);
    const SurfaceDerivatives b = this->Surfaces[1 - side].Derivatives(other[0], other[1], 1);
    const Vec3 gap = b.S - a.S;
    Eigen::Matrix3d m;
    m << a.Su * along[0] + a.Sv * along[1], -b.Su, -b.Sv;
    const Vec3 step = m.inverse() * gap;
    if (!step.allFinite())
    {
      return false;
    }
    point.Point = 0.5 * (a.S + b.S);
    const double move =
      m.col(0).norm() * std::abs(step[0]) + (b.Su * step[1]).norm() + (b.Sv * step[2]).norm();
    if (this->Converged(gap.norm(), move))
    {
      return true;
    }
    t += step[0];
    other += step.tail<2>();
    if (std::abs(t) > 1e6 || !this->IsNear(1 - side, other))
    {
      return false;
    }
  }
  return false;
}

} // namespace nurbs
