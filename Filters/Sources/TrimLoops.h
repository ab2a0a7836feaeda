// SPDX-License-Identifier: BSD-3-Clause
/// @file TrimLoops.h
/// @brief Brings the curves of a face's wires into the order of closed loops in (u, v).
#pragma once

#include "Curve.h"

namespace nurbs
{

/// Where a loop enters and leaves a curve: parameters, and vertex numbers (-1: unknown).
struct TrimEnds
{
  Vec2 Start, End;
  std::int64_t StartVertex, EndVertex;
};

/// A closed sequence of curves, each with the whole periods that carry it to the one before it.
struct OrderedLoop
{
  struct Item
  {
    std::size_t Index;
    Vec2 Shift;
  };
  std::vector<Item> Items;
};

/// Box of the ends of a loop's curves.
using LoopBox = Box2;

/// Splits the curves of a wire into loops: each curve is followed by one that starts at the vertex
/// where it ends, by the nearest in (u, v) if there are several (seams), and by the nearest of all
/// if there is none. `period` is 0 in a direction that is not periodic.
std::vector<OrderedLoop> OrderLoops(const std::vector<TrimEnds>& ends, const Vec2& period);

/// Whole periods that bring every loop of a face into the box of its largest one.
std::vector<Vec2> GatherLoops(const std::vector<LoopBox>& boxes, const Vec2& period);

/// Appends the parameters between neighbouring `breaks` where the function crosses
/// offset + k span for an integer k. Throws Error if that is absurdly often.
void AppendCrossings(const std::function<double(double)>& function,
  const std::vector<double>& breaks, double offset, double span, std::vector<double>& crossings);

/// Parameters at which a trim curve is compared with its edge: several in every span of either.
std::vector<double> SampleParameters(const CurveView<2>& trim, const CurveView<3>& edge);

/// The largest value of a function over the range of the sorted samples: the samples' own, and the
/// tops between neighbours of the highest local maxima unless all is at most `negligible`.
double LargestValue(const std::function<double(double)>& function,
  const std::vector<double>& samples, double negligible);

} // namespace nurbs
