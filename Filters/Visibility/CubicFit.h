// SPDX-License-Identifier: BSD-3-Clause
/// @file CubicFit.h
/// @brief One cubic Bezier curve for a part of a polyline, with a bound on the distance.
#pragma once

#include "Types.h"

#include <array>
#include <optional>

namespace nurbs
{

using Cubic = std::array<Vec2, 4>;

/// Unit tangents that a cubic shall have at its ends, both in its direction.
struct CubicEnds
{
  bool Free[2] = { true, true }; ///< Whether there is none.
  Vec2 Tangent[2] = { Vec2::Zero(), Vec2::Zero() };

  void Set(int end, const Vec2& tangent)
  {
    this->Free[end] = false;
    this->Tangent[end] = tangent;
  }
};

/// The distance of a point from a segment.
double SegmentDistance(const Vec2& point, const Vec2& a, const Vec2& b);

/// A cubic from the first to the last of `count` points (two at least, neighbours different) whose
/// distance from the polyline through them is `tolerance` at most, both ways; nothing if none is
/// found.
std::optional<Cubic> FitCubic(
  const Vec2* points, std::size_t count, const CubicEnds& ends, double tolerance);

} // namespace nurbs
