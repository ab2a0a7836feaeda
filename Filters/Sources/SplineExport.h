// SPDX-License-Identifier: BSD-3-Clause
/// @file SplineExport.h
/// @brief Our surfaces and curves as OpenCASCADE's B-splines, exactly.
///
/// Degree, knots, control points and weights are kept. Knot vectors that are not clamped (those of
/// periodic splines) are clamped by knot insertion, which changes nothing but round-off. All throw
/// Error with the reason where OpenCASCADE has no such spline: one that is broken at a knot of
/// multiplicity degree + 1, or whose knots are closer than its numbers can tell.
#pragma once

#include "Curve.h"
#include "Surface.h"

#include <Geom2d_BSplineCurve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>

namespace nurbs
{

/// The surface, its points multiplied by `scale`.
Handle(Geom_BSplineSurface) ExportSurface(const SurfaceView& surface, double scale);

/// The curve, its points multiplied by `scale`.
Handle(Geom_BSplineCurve) ExportCurve(const CurveView<3>& curve, double scale);

/// The curve of the (u, v) plane, its parameter mapped affinely to `range`.
Handle(Geom2d_BSplineCurve) ExportCurve(const CurveView<2>& curve, const Interval& range);

} // namespace nurbs
