// SPDX-License-Identifier: BSD-3-Clause
/// @file LineChains.h
/// @brief Chains the lines of a model across knot lines, seams, poles and edges.
#pragma once

#include "Silhouette.h"

namespace nurbs
{

/// An end of a line that may go on in another one.
struct LineEnd
{
  std::int64_t Line = -1;
  int End = 0; ///< 0: first point, 1: last.
  Vec3 Point = Vec3::Zero();
  double Reach = 0.0;     ///< How far away the other end may be.
  std::int64_t Group = 0; ///< Only ends of the same group are joined.
};

/// Joins last points with first points, or (`anyEnd`) any two ends, the nearest pairs first; writes
/// SilhouetteLine::Next. An end has one other at most.
void JoinEnds(const std::vector<LineEnd>& ends, bool anyEnd, std::vector<SilhouetteLine>& lines);

/// Numbers the connected lines of each kind in order of their first line; returns their counts.
void NumberChains(std::vector<SilhouetteLine>& lines, std::int64_t (&counts)[LineKindCount]);

} // namespace nurbs
