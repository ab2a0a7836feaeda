// SPDX-License-Identifier: BSD-3-Clause
/// @file Curve.h
/// @brief Rational B-spline curves in 2D (trim curves) and 3D (edges).
///
/// Control points are stored as D Cartesian coordinates followed by the weight.
#pragma once

#include "Bezier.h"
#include "KnotVector.h"

namespace nurbs
{

/// A rational B-spline curve that somebody else owns. Copies nothing.
template <int D>
struct CurveView
{
  int Degree = 0;                 ///< 0 (one point: a degenerate curve) to MaxDegree.
  KnotView Knots;                 ///< Count + Degree + 1 values.
  const double* Points = nullptr; ///< Count x (D + 1): Cartesian coordinates, then the weight.
  int Count = 0;

  Interval Domain() const { return nurbs::Domain(this->Knots, this->Degree); }
  Vec<D> Point(int i) const { return Eigen::Map<const Vec<D>>(this->Points + i * (D + 1)); }
  double Weight(int i) const { return this->Points[i * (D + 1) + D]; }
  Vec<D + 1> Homogeneous(int i) const
  {
    Vec<D + 1> h;
    h << this->Point(i) * this->Weight(i), this->Weight(i);
    return h;
  }
};

/// A rational B-spline curve that owns its data.
template <int D>
struct Curve
{
  int Degree = 1;
  std::vector<double> Knots;
  std::vector<Vec<D>> Points;
  std::vector<double> Weights; ///< One a point.

  std::vector<double> Packed; ///< What View points into; see Pack.
  void Pack();                ///< Fills Packed; call after changing points or weights.
  CurveView<D> View() const;  ///< Throws Error if Pack was not called.
};

/// Cartesian point at t.
template <int D>
Vec<D> Evaluate(const CurveView<D>& curve, double t);

/// Cartesian point and derivatives: out[k] is the k-th derivative, k <= order <= 2.
template <int D>
void EvaluateDerivatives(const CurveView<D>& curve, double t, int order, Vec<D>* out);

/// The curve as Bezier pieces, one a non-empty knot span, in order (knot insertion, exact).
template <int D>
std::vector<BezierCurve<D>> ToBezier(const CurveView<D>& curve);

/// The curve with the knots `add` (in the domain, sorted, repeated for multiplicity) inserted.
template <int D>
Curve<D> RefineKnots(const CurveView<D>& curve, const std::vector<double>& add);

/// The same curve with its degree raised by `times`, exactly.
template <int D>
Curve<D> ElevateDegree(const CurveView<D>& curve, int times);

/// The curve cut at t into two clamped curves.
template <int D>
std::pair<Curve<D>, Curve<D>> Split(const CurveView<D>& curve, double t);

/// The curve over [t0, t1] of its domain, clamped.
template <int D>
Curve<D> Restrict(const CurveView<D>& curve, double t0, double t1);

} // namespace nurbs
