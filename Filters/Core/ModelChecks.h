// SPDX-License-Identifier: BSD-3-Clause
/// @file ModelChecks.h
/// @brief Geometric checks of a model whose arrays are sound: loops that close, edges that fit.
#pragma once

#include "ModelArrays.h"

namespace nurbs
{

/// Checks the loops of a face of `model`.
///
/// Returns the reason why the face can't be trimmed, or "": a loop is open (its gap is over
/// `gapLimit` of the domain's size, the edges there do not meet in one vertex, and on the surface
/// it is over twice their tolerance and no point, as it is at a pole) or leaves the domain by more than a fiftieth of it. `warnings`
/// receives smaller gaps and excesses (over 1e-4 of the domain) and loops without area.
std::string CheckLoops(
  const Model& model, const Face& face, double gapLimit, std::vector<std::string>& warnings);

/// True if the face has no loop, or one that runs along the boundary of its domain: trimming takes
/// nothing away.
bool IsNaturallyBounded(const Model& model, const Face& face);

/// Compares every edge with the first trim curve that names it, at both ends and between. An
/// edge that is farther away than four times its tolerance (and 1e-6 of the model's size) was left
/// behind when points were moved: AssembleOptions::CheckEdges says what happens then. `around`: as
/// AssembleOptions::Around.
void ReleaseMovedEdges(AssembledModel& model, const Box3& around, const ParallelFor& parallel);

/// Box of the control points of all faces.
Box3 BoxOfNets(const Model& model);

} // namespace nurbs
