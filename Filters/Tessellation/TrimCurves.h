// SPDX-License-Identifier: BSD-3-Clause
/// @file TrimCurves.h
/// @brief Trim curves in 3D Bezier form and their polylines (Balazs sections 4 and 5.1).
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
  Line   ///< Control points against the chord's line (section 5.1).
};

/// How curves become polylines.
struct CurveOptions
{
  CurveSubdivision Subdivision = CurveSubdivision::Arbitrary;
  CurveMeasure Measure = CurveMeasure::Line;
  bool Simplify = true; ///< Merge neighbouring segments that one chord can replace.
  double Gamma = 0.75;  ///< Share of the tolerance for subdivision before simplification, (0, 1].
  bool Balanced = true; ///< Then spread the vertices evenly (ours); false: as the paper has it.
};

/// An upper bound of the distance of any point of the curve from its chord *segment* (and of any
/// chord point from the curve), over the Bezier pieces' own span.
double ChordDeviation(const BezierCurve<3>& piece, CurveMeasure measure);

/// Parameters t_0 < ... < t_n (in the pieces' own T0..T1 parameter) such that the chords between
/// them stay within `tolerance` of the curve. `certified` receives the bound that was reached.
/// A piece that is a point gives no inner parameter. `closed`: at least three segments.
std::vector<double> ApproximateCurve(const std::vector<BezierCurve<3>>& pieces, double tolerance,
  const CurveOptions& options, double& certified);

/// Lifts a trim curve to 3D rational Bezier curves, exactly: the curve is cut where it crosses the
/// surface's knot lines and at its own knots, losslessly degree-reduced, and each piece S(c(t)) of
/// degree d_2D (d_u + d_v) is found by collocation at that degree + 1 points. The collocation
/// matrix depends on the degree only and is factored once a degree (section 4).
std::vector<BezierCurve<3>> LiftTrimCurve(const SurfaceView& surface, const CurveView<2>& curve);

} // namespace nurbs
