// SPDX-License-Identifier: BSD-3-Clause
/// @file CurveFit.h
/// @brief Polynomial splines through smooth functions, with the deviation measured.
///
/// For what has no exact form: trim curves in a parameter that changed with the surface's, offset
/// curves and surfaces. Pieces interpolate at Chebyshev-Lobatto points, so they converge
/// geometrically where the function is analytic, and meet exactly at their ends.
#pragma once

#include "Curve.h"
#include "Surface.h"

namespace nurbs
{

/// A curve through `function`, piece by piece between the sorted `breaks` (at least 2; put every
/// parameter there where the function is not smooth). A piece takes the lowest of the degrees 1, 2,
/// 3, 5, 7 that keeps the deviation under `tolerance`, and is halved if none does (at most 10
/// times). Coordinates are multiplied by `scale` before they are compared. `error` receives the
/// largest deviation found, scaled; it is over the tolerance if the halving ended first.
template <int D>
Curve<D> FitCurve(const std::function<Vec<D>(double)>& function, const std::vector<double>& breaks,
  const Vec<D>& scale, double tolerance, double& error);

/// The ends of the range and those of `breaks` between them, sorted; of those closer together than 1e-9
/// of the range only the first.
std::vector<double> DistinctBreaks(std::vector<double> breaks, const Interval& range);

/// A surface of degree 7 x 7 through `function` over the grid of breaks, whose spans are halved in
/// the direction that deviates more until the deviation is under `tolerance` or a direction has over
/// 256 spans. `error` receives the largest deviation found.
Surface FitSurface(const std::function<Vec3(double, double)>& function, std::vector<double> uBreaks,
  std::vector<double> vBreaks, double tolerance, double& error);

} // namespace nurbs
