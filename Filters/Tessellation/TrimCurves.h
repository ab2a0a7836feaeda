// SPDX-License-Identifier: BSD-3-Clause
/// @file TrimCurves.h
/// @brief Trim curves in 3D Bezier form and their polylines.
///
/// Source: Balazs, Guthe, Klein 2004, sections 4 and 5.1. Three things are ours, with the reasons in
/// Documentation/Papers/balazs-2004.md: bounds that are sound for rational curves and for chords
/// that span several pieces, the balanced distribution of vertices, and the lifting by products of
/// Bernstein polynomials instead of collocation (which stays in use where degrees grow too high).
#pragma once

#include "Curve.h"
#include "Surface.h"

namespace nurbs
{

/// Where a Bezier curve is split when it deviates too much.
enum class CurveSubdivision
{
  Midpoint, ///< At the middle of its parameter range.
  Arbitrary ///< Beneath the control point that deviates most ("arbitrary" in the paper).
};

/// What the deviation of a Bezier curve is measured against.
enum class CurveMeasure
{
  Point, ///< Control points against the points of the chord at i/n: counts sliding as error.
  Line   ///< Control points against the chord itself (section 5.1).
};

/// How curves become polylines.
struct CurveOptions
{
  CurveSubdivision Subdivision = CurveSubdivision::Midpoint; ///< The paper's best.
  CurveMeasure Measure = CurveMeasure::Line;
  bool Simplify = true; ///< Merge neighbouring segments that one chord can replace.
  double Gamma = 0.75;  ///< Share of the tolerance for subdivision before simplification, (0, 1].
  /// Ours: as few vertices as will do, spread so that all chords err alike. An arc gets the minimum
  /// number of equal segments instead of a power of two. Chords are bounded against the curve
  /// itself with the whole tolerance, so that Simplify and Gamma have nothing left to do. False: as
  /// the paper has it.
  bool Balanced = true;
};

/// The highest degree of a Bezier piece that the functions below take; LiftTrimCurve stays under it.
inline constexpr int MaxPieceDegree = 63;

/// The change of direction, in radians, from which on a joint of two pieces is a corner, whose
/// vertex is kept whatever the tolerance.
inline constexpr double CornerAngle = 0.1;

/// An upper bound of the distance of any point of the curve from its chord *segment*, and of any
/// point of the chord from the curve. Weights must be positive.
///
/// The piece is split in the middle and the control points of both halves are measured: all of the
/// curve is a convex combination of them, and distance from a segment is a convex function. For a
/// circular arc and for a parabola the bound is attained; the factor 1 - 2^(1-n) of section 5.1
/// (printed there as 1 - 1/2^(n-2), which is 0 for a parabola) is never smaller for Line.
double ChordDeviation(const BezierCurve<3>& piece, CurveMeasure measure);

/// Parameters t_0 < ... < t_n (in the pieces' own T0..T1 parameter) such that the chords between
/// them stay within `tolerance` of the curve, and the curve of them.
///
/// Pieces follow each other in space and in parameter; weights are positive. Corners of the curve
/// are vertices. A straight stretch is one segment, a curve that is a point has no inner parameter,
/// a closed curve (its ends coincide to 1e-9 of its size) has at least three segments. Reversing
/// the curve mirrors the parameters up to round-off.
///
/// @param tolerance model units, > 0. A curve that would need more than 200,000 segments, or chords
///   beneath round-off, is left with a larger error.
/// @param certified receives the bound that was reached, over the tolerance only in that case.
/// Throws Error if there is no piece or a degree exceeds MaxPieceDegree.
std::vector<double> ApproximateCurve(const std::vector<BezierCurve<3>>& pieces, double tolerance,
  const CurveOptions& options, double& certified);

/// Lifts a trim curve to 3D rational Bezier curves S(c(t)), in order, over the curve's parameter.
///
/// The curve is losslessly degree-reduced and cut at its own knots and where it crosses the
/// surface's knot lines (a curve along a knot line is not cut). Within one span of the surface the
/// steps of de Boor's algorithm are carried out on polynomials of t instead of numbers, which gives
/// the piece's d_2D (d_u + d_v) + 1 control points (fewer where u or v is constant), relative error
/// about 1e-14; then these are losslessly degree-reduced. Pieces with weights that are not positive
/// are halved until they are.
///
/// Where the degree would exceed 48 a piece is instead interpolated at degree 15 (collocation
/// matrix factored once) and halved until it agrees with the surface to 1e-11 of the model's size.
///
/// Parameters outside the surface's domain extrapolate its first and last spans.
std::vector<BezierCurve<3>> LiftTrimCurve(const SurfaceView& surface, const CurveView<2>& curve);

} // namespace nurbs
