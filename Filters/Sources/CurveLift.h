// SPDX-License-Identifier: BSD-3-Clause
/// @file CurveLift.h
/// @brief Trim curves as curves in space.
#pragma once

#include "Curve.h"
#include "SurfaceEvaluator.h"

namespace nurbs
{

/// The curve of the surface at constant u (`dir` 0) or v (1), over all of the other domain, exactly.
Curve<3> IsoCurve(const SurfaceView& surface, int dir, double value);

/// Where the lifted trim curve may not be smooth: the ends of its domain and between them its knots and
/// those places where it crosses the surface's.
std::vector<double> LiftBreaks(const SurfaceView& surface, const CurveView<2>& trim);

/// The trim curve `trim` on the surface that `evaluator` has, in the trim curve's parameter: exactly
/// if the surface is a parallelogram or the trim curve a straight line along u or v, else fitted.
/// `error` receives the largest deviation found; over `tolerance` if the fit did not succeed.
Curve<3> LiftCurve(
  SurfaceEvaluator& evaluator, const CurveView<2>& trim, double tolerance, double& error);

} // namespace nurbs
