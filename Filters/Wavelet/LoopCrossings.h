// SPDX-License-Identifier: BSD-3-Clause
/// @file LoopCrossings.h
/// @brief Loops of a face whose polylines cross or enclose nothing.
#pragma once

#include "FaceMesher.h"

namespace nurbs
{

/// The vertices whose segments cross others, or belong to loops that collapsed, and can be finer.
std::vector<LevelLoopVertex> CrossingSegments(
  const std::vector<std::vector<LevelLoopVertex>>& loops);

} // namespace nurbs
