// SPDX-License-Identifier: BSD-3-Clause
/// @file Curve.h
/// @brief Rational B-spline curves in 2D (trim curves) and 3D (edges).
///
/// Control points are stored as D Cartesian coordinates followed by the weight. D is 2 or 3. The
/// functions take any valid knot vector (CheckKnots), clamped or not, with breaks (knots of
/// multiplicity degree + 1) or without, and positive weights; they do not check it. Sources: The NURBS
/// Book, chapters 3 to 5; RowSpline.h has those of the refinements.
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

  /// Where the curve is defined.
  Interval Domain() const { return nurbs::Domain(this->Knots, this->Degree); }
  /// A control point, Cartesian.
  Vec<D> Point(int i) const { return Eigen::Map<const Vec<D>>(this->Points + i * (D + 1)); }
  /// Its weight.
  double Weight(int i) const { return this->Points[i * (D + 1) + D]; }
  /// Both: (w x, ..., w).
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
  int Degree = 1;              ///< 0 to MaxDegree.
  std::vector<double> Knots;   ///< Points.size() + Degree + 1 values.
  std::vector<Vec<D>> Points;  ///< Cartesian.
  std::vector<double> Weights; ///< One a point, positive.

  std::vector<double> Packed; ///< What View points into; see Pack.
  void Pack();                ///< Fills Packed; call after changing points or weights.
  CurveView<D> View() const;  ///< Throws Error if Pack was not called.
};

/// Cartesian point at t, at a break the one after it. Parameters outside the domain extrapolate the
/// first or last piece.
template <int D>
Vec<D> Evaluate(const CurveView<D>& curve, double t);

/// Cartesian point and derivatives with respect to t: out[k] is the k-th derivative, k <= order.
/// Throws Error unless 0 <= order <= 2. At a knot: the derivatives after it (domain's end: before).
template <int D>
void EvaluateDerivatives(const CurveView<D>& curve, double t, int order, Vec<D>* out);

/// The curve as Bezier pieces, one a non-empty knot span, in order (knot insertion, exact).
template <int D>
std::vector<BezierCurve<D>> ToBezier(const CurveView<D>& curve);

/// The curve with the knots `add` (in the domain, sorted, repeated for multiplicity) inserted. Throws
/// Error for knots that are outside or not sorted, or a multiplicity over degree + 1.
template <int D>
Curve<D> RefineKnots(const CurveView<D>& curve, const std::vector<double>& add);

/// The same curve with its degree raised by `times` >= 0, exactly; every knot gains that multiplicity.
/// An unclamped curve comes back clamped to its domain. Throws Error over MaxDegree.
template <int D>
Curve<D> ElevateDegree(const CurveView<D>& curve, int times);

/// The curve cut at t inside its domain into two clamped curves. Throws Error at the domain's ends.
template <int D>
std::pair<Curve<D>, Curve<D>> Split(const CurveView<D>& curve, double t);

/// The curve over [t0, t1] of its domain, clamped. Throws Error if the interval is empty or leaves the
/// domain. Ends within 1e-14 (relative) of a knot mean the knot, so no sliver spans arise.
template <int D>
Curve<D> Restrict(const CurveView<D>& curve, double t0, double t1);

} // namespace nurbs
