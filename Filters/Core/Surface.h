// SPDX-License-Identifier: BSD-3-Clause
/// @file Surface.h
/// @brief Tensor-product rational B-spline surfaces: views, knot insertion, Bezier form, splitting.
///
/// Control points are Cartesian, u fastest: point (i, j) has index i + j * Count[0]. Directions are
/// 0 (u) and 1 (v). The functions take any valid knot vectors (CheckKnots), clamped or not, and
/// positive weights, and do not check it. Sources: The NURBS Book, chapters 4 and 5; RowSpline.h has
/// those of the refinements. Surfaces that come back from a refinement have weights if the given one
/// had.
#pragma once

#include "Bezier.h"
#include "KnotVector.h"

namespace nurbs
{

/// A surface that somebody else owns (a cell of the VTK model). Copies nothing.
struct SurfaceView
{
  int Degree[2] = { 1, 1 };          ///< 1 to MaxDegree, u then v.
  int Count[2] = { 0, 0 };           ///< Size of the control net.
  KnotView Knots[2];                 ///< Count + Degree + 1 values each.
  const double* Points = nullptr;    ///< Cartesian xyz triples, indexed through Ids if it is set.
  const double* Weights = nullptr;   ///< One a point, same indexing; null: all 1 (polynomial).
  const std::int64_t* Ids = nullptr; ///< Count[0] * Count[1] point indices; null: 0, 1, 2, ...

  /// Number of control points.
  std::int64_t Size() const { return std::int64_t(this->Count[0]) * this->Count[1]; }
  /// Index of control point k in Points and Weights.
  std::int64_t Id(std::int64_t k) const { return this->Ids ? this->Ids[k] : k; }
  /// Control point k, Cartesian.
  Vec3 Point(std::int64_t k) const
  {
    return Eigen::Map<const Vec3>(this->Points + 3 * this->Id(k));
  }
  /// Its weight.
  double Weight(std::int64_t k) const { return this->Weights ? this->Weights[this->Id(k)] : 1.0; }
  /// Both: (w x, w y, w z, w).
  Vec4 Homogeneous(std::int64_t k) const
  {
    const double w = this->Weight(k);
    const double* p = this->Points + 3 * this->Id(k);
    return Vec4(p[0] * w, p[1] * w, p[2] * w, w);
  }
  /// Where the surface is defined in a direction.
  Interval Domain(int dir) const { return nurbs::Domain(this->Knots[dir], this->Degree[dir]); }
  /// True if some weight differs from the others.
  bool IsRational() const;
};

/// A surface that owns its data.
struct Surface
{
  int Degree[2] = { 1, 1 };
  int Count[2] = { 0, 0 };
  std::vector<double> Knots[2];
  std::vector<Vec3> Points;    ///< Cartesian, u fastest.
  std::vector<double> Weights; ///< Empty: polynomial.

  /// Valid until the surface changes.
  SurfaceView View() const;
};

/// An owning copy.
Surface Copy(const SurfaceView& surface);

/// Point and partial derivatives at one parameter.
struct SurfaceDerivatives
{
  Vec3 S, Su, Sv;     ///< Point and first derivatives.
  Vec3 Suu, Suv, Svv; ///< Second derivatives (zero when not asked for).
};

/// The derivatives of the projected surface from those of the homogeneous one by the quotient rule:
/// h[a][b] = d^(a+b) H / du^a dv^b, read for a + b <= order (1 or 2).
SurfaceDerivatives ProjectDerivatives(const Vec4 (&h)[3][3], int order);

/// Cartesian point at (u, v); the obvious reference, see SurfaceEvaluator for the fast way.
/// Parameters outside the domain extrapolate the first or last span.
Vec3 Evaluate(const SurfaceView& surface, double u, double v);

/// Point, first and (order 2) second derivatives of the rational surface at (u, v); at a knot those
/// after it (at the domain's end: before it). Throws Error unless order is 1 or 2.
SurfaceDerivatives EvaluateDerivatives(const SurfaceView& surface, double u, double v, int order);

/// The unit normal Su x Sv / |Su x Sv|. Where the cross product vanishes (pole of a sphere, apex of
/// a cone, collapsed edge) the limit along the way into the domain: by the second derivative, then
/// by approaching the pole. Zero only if the surface is a line or point there. "Vanishes" is relative
/// to the control net around (u, v), so units, place and parametrisation do not matter; the change
/// from one rule to the other is an angle of about 1e-7.
Vec3 Normal(const SurfaceView& surface, double u, double v);

/// The surface with the knots `add` (sorted, inside the domain) inserted in direction `dir`. Throws
/// Error as RefineKnots of Curve.h does.
Surface RefineKnots(const SurfaceView& surface, int dir, const std::vector<double>& add);

/// Degree raised by `times` in direction `dir`, exactly; that direction comes back clamped. Throws
/// Error over MaxDegree.
Surface ElevateDegree(const SurfaceView& surface, int dir, int times);

/// Degree lowered in direction `dir` as far as a bound on the movement of the surface, in model
/// units, stays at or under `tolerance` (lossless reduction for a tiny one); weights stay positive.
/// Returns the surface unchanged if it cannot be lowered, or is linear.
Surface ReduceDegree(const SurfaceView& surface, int dir, double tolerance);

/// The surface cut at parameter t of direction `dir` into two surfaces, clamped in that direction.
/// Throws Error if t is not inside the domain.
std::pair<Surface, Surface> Split(const SurfaceView& surface, int dir, double t);

/// The surface over the box [u.Min, u.Max] x [v.Min, v.Max] of its domain, clamped. Throws Error if
/// the box is empty or leaves the domain.
Surface Restrict(const SurfaceView& surface, Interval u, Interval v);

/// All Bezier patches of the surface, one a pair of non-empty knot spans, u fastest. Exact; without
/// weights w is 1 everywhere. Neighbours share the same bits along their side, unless the surface is
/// broken there.
std::vector<BezierPatch> ToBezier(const SurfaceView& surface);

/// True if the first and last rows of the surface (its iso-curves, not only the control points) in
/// direction `dir` agree within `tolerance`.
bool IsClosed(const SurfaceView& surface, int dir, double tolerance);

/// True if the side (dir, end: 0 at the domain's start, 1 at its end) is a single point within
/// `tolerance`: a pole of a sphere or the apex of a cone.
bool IsDegenerateSide(const SurfaceView& surface, int dir, int end, double tolerance);

} // namespace nurbs
