// SPDX-License-Identifier: BSD-3-Clause
/// @file CoincidentLines.h
/// @brief Leaves out hidden lines where another line is drawn already.
#pragma once

#include "PathJoin.h"

namespace nurbs
{

/// Takes away from each hidden line where it runs along a visible line, or a hidden one before it, within a
/// tolerance: dashes over dashes whose gaps differ make a full line. Parts shorter than four tolerances,
/// where lines cross or touch, stay.
/// @param isVisible one flag a line.
/// @param tolerance a length over 0.
/// @returns the line that each of the new `lines` is, or is a part of; in order, with its Group and Source.
std::vector<std::size_t> DropHiddenCopies(
  std::vector<PlaneLine>& lines, const std::vector<char>& isVisible, double tolerance);

} // namespace nurbs
