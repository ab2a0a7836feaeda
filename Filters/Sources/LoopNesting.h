// SPDX-License-Identifier: BSD-3-Clause
/// @file LoopNesting.h
/// @brief Which loops of a face bound one connected piece of it.
#pragma once

#include "Model.h"

namespace nurbs
{

/// The loops of a face, as indices into Model::Loops, in groups: an outer loop, which runs
/// counter-clockwise, and the holes right inside it. A face of our models may have several pieces
/// (visible regions, islands in holes), one of a boundary representation must not. Holes in no outer
/// loop join the first group. Loops are compared as polygons through points of their curves.
std::vector<std::vector<std::int64_t>> GroupLoops(const Model& model, const Face& face);

} // namespace nurbs
