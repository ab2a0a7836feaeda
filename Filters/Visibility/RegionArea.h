// SPDX-License-Identifier: BSD-3-Clause
/// @file RegionArea.h
/// @brief The area of a region of a surface, from its border.
#pragma once

#include "RegionLoops.h"

namespace nurbs
{

/// Area of what loops in (u, v) enclose (the ones on the left of which it lies count positive), by
/// Green's theorem: the integral of P dv along them, P_u = |S_u x S_v|. P comes from Legendre series of
/// |S_u x S_v| on every knot span, whose degree grows until the last coefficients are below 1e-11 of
/// the largest (or 24 is reached).
double RegionArea(const Model& model, std::int64_t face, const std::vector<RegionLoop>& loops);

/// The loops of a face as it is.
std::vector<RegionLoop> WholeRegion(const Model& model, std::int64_t face);

} // namespace nurbs
