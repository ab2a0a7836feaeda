// SPDX-License-Identifier: BSD-3-Clause
/// @file BoundaryRepair.h
/// @brief LoopRepair applied to a face's boundary, whose vertices know their edges.
///
/// Source: Balazs, Guthe, Klein 2004, end of section 5.1 (loops that intersect).
#pragma once

#include "TrimRegion.h"

namespace nurbs
{

/// Turns loops that run the wrong way and, if `crossings` is set, builds loops that do not cross from
/// those that do (see RepairLoops). New vertices lie on the straight side they were made on; sides
/// keep the edge and the parameters that they are part of.
///
/// `crossings` is meant for the last pass: before, finer polylines may be all that is needed.
///
/// Returns what was done in words, "" if nothing was. Throws Error as RepairLoops does.
std::string RepairBoundary(std::vector<std::vector<BoundaryVertex>>& loops, bool crossings);

} // namespace nurbs
