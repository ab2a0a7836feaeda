// SPDX-License-Identifier: BSD-3-Clause
/// @file Bezier.h
/// @brief Bezier curves and patches in homogeneous coordinates: the form every bound works on.
///
/// All functions are linear in the control points, so `Vec<D>` may be Cartesian (polynomial) or
/// homogeneous (rational); degree = number of points - 1, parameter in [0, 1]. The curve lies in the
/// convex hull of its points (rational: of its projected points, if all weights are positive), and
/// splitting, elevation and restriction keep that hull: what the error bounds rely on. Any degree
/// >= 0 works, also over MaxDegree (products and lifted curves). D is 1, 2, 3 or 4.
#pragma once

#include "Types.h"

namespace nurbs
{

/// Value by de Casteljau's algorithm, numerically stable for every degree: convex combinations only
/// for t in [0, 1]. Other t extrapolate.
template <int D>
Vec<D> DeCasteljau(const Vec<D>* points, int degree, double t);

/// Splits at t: `left` and `right` receive degree + 1 points each (they may not alias `points`). The
/// last of `left` and the first of `right` are the same bits.
template <int D>
void SplitBezier(const Vec<D>* points, int degree, double t, Vec<D>* left, Vec<D>* right);

/// Raises the degree by one, exactly (Farin, Curves and Surfaces for CAGD, section 5.1).
template <int D>
std::vector<Vec<D>> ElevateBezier(const std::vector<Vec<D>>& points);

/// Lowers the degree by one by Farin's forward and backward reduction (Balazs, Guthe, Klein 2004,
/// section 4): forward for the first half of the points, backward for the second, and the mean of the
/// two in the middle, since each recursion is stable on its own half only. `error` receives the
/// largest distance between the points and the elevation of the result, which bounds the distance of
/// the two curves (in the points' own D coordinates). Throws Error for a single point.
template <int D>
std::vector<Vec<D>> ReduceBezierOnce(const std::vector<Vec<D>>& points, double& error);

/// Lowers the degree while the total error stays at or under `tolerance` (lossless for a tiny one, in
/// the unit of the points), down to degree 0 at most.
template <int D>
std::vector<Vec<D>> ReduceBezier(std::vector<Vec<D>> points, double tolerance);

/// One Bezier piece of a curve in D dimensions, in homogeneous coordinates, over [T0, T1].
template <int D>
struct BezierCurve
{
  double T0 = 0.0; ///< Parameter of the first point on the curve that the piece was cut from.
  double T1 = 1.0; ///< Parameter of the last one.
  std::vector<Vec<D + 1>> Points; ///< (w x, ..., w).
  /// One less than the number of points.
  int Degree() const { return static_cast<int>(this->Points.size()) - 1; }
  /// Cartesian point at the piece's own parameter s in [0, 1].
  Vec<D> Evaluate(double s) const
  {
    const Vec<D + 1> h = DeCasteljau<D + 1>(this->Points.data(), this->Degree(), s);
    return h.template head<D>() / h[D];
  }
};

/// One tensor-product Bezier patch in homogeneous coordinates over [U.Min, U.Max] x [V.Min, V.Max].
struct BezierPatch
{
  int Degree[2] = { 0, 0 };
  Interval U; ///< The patch's part of the surface's domain.
  Interval V;
  std::vector<Vec4> Points; ///< (Degree[0]+1) x (Degree[1]+1), u fastest.
};

/// Splits a patch at the relative parameter t in [0, 1] in direction `dir` (0: u, 1: v) by de
/// Casteljau's algorithm; U and V follow. Both halves hold the same bits along the cut.
void SplitBezierPatch(
  const BezierPatch& patch, int dir, double t, BezierPatch& low, BezierPatch& high);

} // namespace nurbs
