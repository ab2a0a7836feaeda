// SPDX-License-Identifier: BSD-3-Clause
/// @file DenseNet.h
/// @brief Makes control nets denser without changing the surface, so that it can be bent.
///
/// Who moves the control points P_i of a surface S = sum R_i P_i by a map D gets sum R_i D(P_i),
/// not D(S). The R_i are convex weights with sum R_i (P_i - S) = 0, so Taylor's theorem leaves
///
///     |sum R_i D(P_i) - D(S)| <= M / 2 sum R_i |P_i - S|^2,
///
/// where M bounds D's second derivative in every direction; maps that are affine are followed
/// exactly. It is the error of Schoenberg's variation diminishing operator ("On spline functions",
/// 1967). For even knots of degree p whose neighbouring control points have the distance h, the sum
/// is (p + 1) / 12 h^2 a direction: bicubic faces are within M h^2 / 3 of D(S), and two that share
/// an edge part by less than 2 / 3 M h^2. In general, edges up to h of the net leave no more than
/// 3 / 16 M ((p + q) h)^2, as points within a diameter d of each other vary by 3 / 8 d^2 at most
/// (Jung's theorem). Knot insertion (Boehm 1980) is what makes h small. The degree is raised first:
/// an inserted knot is a crease of what gets bent unless the degree is over 1.
#pragma once

#include "Model.h"

namespace nurbs
{

/// How dense a control net shall be.
struct NetDensity
{
  int MinimumDegree = 3; ///< Of both directions, 1 to MaxDegree.
  double Spacing = 1.0;  ///< Longest distance of neighbouring control points; > 0.
  /// Most control points of a face. A net that has more already stays as it is, as does one that
  /// would by its degree alone. Else knots are as dense as this allows.
  std::int64_t MaximumPoints = 10000;
  /// Cut the surface to the part of the domain that the loops reach, if that leaves the loops valid
  /// (CheckLoops finds no more in them). Parameters stay the same numbers.
  bool ClampToTrims = true;
};

/// A face's surface with a dense control net.
struct DenseNet
{
  Surface Geometry;     ///< The same surface, or the part of it that trims reach. Clamped.
  bool Changed = false; ///< Geometry differs from the face's own; empty if not.
  bool Capped = false;  ///< MaximumPoints was reached before the wish was met.
};

/// Raises the degree and inserts knots, evenly in every span. Edges across a break (degree + 1
/// equal knots) can't be shortened, nor do intervals of rounding size get knots. `face` must be
/// sound and belong to `model`. Throws Error for a degree out of range, or a spacing that is not
/// positive.
DenseNet MakeDense(const Model& model, const Face& face, const NetDensity& wanted);

/// The longest distance of neighbouring control points in direction `dir`, breaks left out.
double LongestNetEdge(const SurfaceView& surface, int dir);

} // namespace nurbs
