// SPDX-License-Identifier: BSD-3-Clause
/// @file CurveConverter.h
/// @brief OpenCASCADE's curves as rational B-splines, exactly.
///
/// Lines, circles, ellipses, parabolas, hyperbolas, Bezier and B-spline curves (periodic ones too)
/// and trimmed ones of these keep their shape to rounding. Conics change their parameter as
/// ParameterMap says, all others keep it. Offset and unknown curves are fitted; the deviation is told.
#pragma once

#include "Curve.h"
#include "ParameterMap.h"

#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>

namespace nurbs
{

/// A curve over the part that was asked for, in the parameter Map.Forward(t).
template <int D>
struct ConvertedCurve
{
  Curve<D> Geometry;  ///< Packed and clamped.
  ParameterMap Map;   ///< Original parameter t -> parameter of Geometry.
  double Error = 0.0; ///< Largest deviation from the original; 0: exact to rounding.
};

/// The map of a curve's parameter that ConvertCurve will use. `offset`: where the spans of circles
/// and ellipses begin (radians).
ParameterMap MapOf(const Handle(Geom_Curve) & curve, double offset = 0.0);

/// The curve over [t0, t1], cut to the domain of a non-periodic spline.
/// Throws Error: t0 >= t1, infinite, not a number, or all outside the domain.
/// `tolerance`: what a fit may deviate, length.
ConvertedCurve<3> ConvertCurve(
  const Handle(Geom_Curve) & curve, double t0, double t1, double offset, double tolerance);

/// A B-spline or Bezier curve (trimmed or not) of the (u, v) plane over [t0, t1]. False if it is of
/// another kind; then `result` is untouched.
bool ConvertSpline(const Handle(Geom2d_Curve) & curve, double t0, double t1, Curve<2>& result);

/// The distinct parameters inside (t0, t1) where the curve changes its formula, in order.
std::vector<double> BreaksOf(const Handle(Geom_Curve) & curve, double t0, double t1);
std::vector<double> BreaksOf(const Handle(Geom2d_Curve) & curve, double t0, double t1);

} // namespace nurbs
