// SPDX-License-Identifier: BSD-3-Clause
/// @file IntersectionTracer.h
/// @brief Follows the intersection curve of two surfaces from a point of it.
#pragma once

#include "SurfacePair.h"

namespace nurbs
{

/// A curve within the boxes of both domains.
struct TracedIntersection
{
  std::vector<IntersectionPoint> Points; ///< A closed one repeats its first point.
  bool Closed = false;
  /// The first and last point lie beyond a box, a bit: what precedes it is on the box's border.
  bool Beyond[2] = { false, false };
};

/// Follows curves where the sine of the angle between the surfaces is at least LeastSine.
class IntersectionTracer
{
public:
  static constexpr double LeastSine = 0.01;

  explicit IntersectionTracer(SurfacePair& pair);

  /// The whole curve through `seed`, by steps that turn by a fifth of a radian at most. Empty if it
  /// is too flat there.
  TracedIntersection Trace(const IntersectionPoint& seed);

  /// Adds points till chords are within `precision` of the curve.
  void Refine(TracedIntersection& curve, double precision);

  /// The point of the curve at a share of a chord.
  IntersectionPoint Between(const IntersectionPoint& a, const IntersectionPoint& b, double share);

  /// True if a point of the two surfaces is one of a traced curve, refined or not.
  bool Passes(const TracedIntersection& curve, const IntersectionPoint& point);

private:
  /// Follows one direction; appends points. Returns true if the curve closes.
  bool Follow(
    const IntersectionPoint& seed, double sign, std::vector<IntersectionPoint>& out, bool& beyond);
  bool IsOnWay(const IntersectionPoint& a, const IntersectionPoint& b, const IntersectionPoint& q);
  bool Step(const IntersectionPoint& from, const CrossingFrame& frame, double sign, double length,
    IntersectionPoint& to, CrossingFrame& toFrame);
  bool Leave(const IntersectionPoint& from, const CrossingFrame& frame, double sign, double length,
    std::vector<IntersectionPoint>& out);

  SurfacePair& Pair;
  double LongestStep;
  double ShortestStep;
};

} // namespace nurbs
