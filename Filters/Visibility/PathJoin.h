// SPDX-License-Identifier: BSD-3-Clause
/// @file PathJoin.h
/// @brief Joins plane polylines that go on in each other.
#pragma once

#include "Types.h"

#include <vector>

namespace nurbs
{

/// A polyline to be joined with others of its group.
struct PlaneLine
{
  std::vector<Vec2> Points;
  std::int64_t Group = 0;  ///< Lines of different groups are not joined.
  std::int64_t Source = 0; ///< Lines of one source are joined even where they form a corner.
};

/// Lines that have become one.
struct JoinedLine
{
  std::vector<Vec2> Points;         ///< The last is the first, exactly, if the line is closed.
  std::vector<std::size_t> Members; ///< The lines, in order.
};

/// Joins ends that are within `reach` of each other where the line goes on without a corner
/// (IsCorner with `tolerance`) or both lines are of one source; of several such ends, those that
/// turn least. Lines without two different points are left out. The result is in the order of first
/// members; joined lines keep all of their points but one at each joint.
std::vector<JoinedLine> JoinLines(
  const std::vector<PlaneLine>& lines, double reach, double tolerance);

} // namespace nurbs
