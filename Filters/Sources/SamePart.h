// SPDX-License-Identifier: BSD-3-Clause
/// @file SamePart.h
/// @brief Models that are one part in different places.
#pragma once

#include "CADExport.h"
#include "Model.h"
#include "PartConverter.h"

#include <optional>

namespace nurbs
{

/// The root mean square of the distances of all control points from their centre: motions do not
/// change it but for round-off, so models of different ones need not be compared. NaN or infinite if
/// a point is; 0 without points.
double MeanRadius(const Model& model);

/// The motion, a turn and a shift, that takes the first model to the second: faces and loops that are
/// the same to the bit, and control points that it moves onto each other but for round-off, 1e-12 of the
/// largest coordinate. Curves of edges do not count, as those of models that were moved have stayed
/// behind; where both have them, their tolerances are the same but for that. Nothing if there is
/// none: mirror images are not the same.
std::optional<Placement> MotionBetween(const Model& from, const Model& to);

/// A motion, as OpenCASCADE moves shapes.
TopLoc_Location ToLocation(const Placement& motion);

/// Moves the part's geometry; what other parts share with it stays where it is. Throws Error where
/// OpenCASCADE fails.
void MovePart(const Placement& motion, CADPart& part);

} // namespace nurbs
