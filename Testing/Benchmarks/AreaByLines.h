// SPDX-License-Identifier: BSD-3-Clause
/// @file AreaByLines.h
/// @brief The visible area of closed solids by rays, to six digits and more.
#pragma once

#include "RegionTruth.h"

namespace truth
{

/// The area of a face that is visible in a closed solid, that is: turned to the viewer, inside the
/// trims, and nothing in front of it.
///
/// Lines of constant v are scanned for changes of visibility, which rays then bisect to 1e-12 of the
/// domain; between changes the area's element is integrated by Gauss' rule, and over v by Simpson's,
/// with lines added where it has not converged.
/// @param tolerance that is to be reached over v, an area; no bound.
/// @param scan points a knot span and line; what is narrower may be missed.
double AreaByLines(const nurbs::RayCaster& caster, std::int64_t face, const ImageView& view,
  double tolerance, int scan, const nurbs::ParallelFor& parallel);

} // namespace truth
