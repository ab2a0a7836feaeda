// SPDX-License-Identifier: BSD-3-Clause
/// @file LoopRepair.h
/// @brief Trimming loops that cross themselves or each other, or run the wrong way: found, repaired.
///
/// Source: Balazs, Guthe, Klein 2004, section 5.1: "in theory trimming curves should never
/// intersect, in practice [...] they often do": intersections become vertices and intersection-free
/// loops are built. All decisions are exact (CGAL); what differs from the paper is told in
/// Documentation/Papers/balazs-2004.md.
///
/// Loops are closed polygons in (u, v), material on the left. Vertices are numbered through all
/// loops in order; side k starts at vertex k and ends at the next one of its loop.
#pragma once

#include "Types.h"

namespace nurbs
{

/// Closed polygons in (u, v); the first point is not repeated.
using Loops2 = std::vector<std::vector<Vec2>>;

/// Finds the pairs of sides that have more in common than an end. Keeps its memory from call to
/// call; one object a thread.
class CrossingFinder
{
public:
  /// The pairs (a < b), sorted: sides that cross, a vertex inside another side, sides that overlap,
  /// and neighbours that fold back onto each other. No pair: vertices in the same spot, sides that
  /// run along each other from end to end in opposite directions (a slit), sides of length zero.
  ///
  /// Exact. O(n log n) for n sides unless very many boxes around sides overlap, well under a
  /// microsecond a side for the loops of a usual face.
  const std::vector<std::pair<int, int>>& Find(const Loops2& loops);

private:
  struct Side
  {
    double Low[2];
    double High[2];
    Vec2 A, B;
    int Index;
  };
  void Test(const Side& a, const Side& b);

  std::vector<Side> Sides;
  std::vector<int> Active;
  std::vector<std::pair<int, int>> Pairs;
};

/// A vertex of a repaired loop and the side that starts there.
struct RepairedVertex
{
  Vec2 P;
  int Source = -1; ///< Input vertex; -1: where sides cross.
  int Side = -1;   ///< Input side that this side is a part of.
  double S0 = 0.0; ///< Where this side starts on that one, 0 (its start) to 1 (its end).
  double S1 = 1.0; ///< Where it ends; S0 > S1 if it runs the other way.
};

/// What RepairLoops made.
struct RepairedLoops
{
  std::vector<std::vector<RepairedVertex>> Loops; ///< Outer loops CCW, holes CW; none cross.
  bool Changed = false; ///< False: the input was sound; Loops has it, vertex by vertex.
  std::string Message;  ///< What was done, in words; "" if nothing was.
};

/// Repairs loops.
///
/// - Vertices in the same spot as the one before them are dropped, and loops without area (all
///   vertices on a line).
/// - If no sides cross, a loop inside an even number of others must be counter-clockwise and one
///   inside an odd number clockwise: those that are not are turned round.
/// - If sides cross, what a loop winds around at all is its own (lobes that run the other way
///   included, so that a narrow face whose sides swap keeps its area and its edges), and clockwise
///   loops take away from counter-clockwise ones. If nothing remains, or less than half of what is
///   inside by the even-odd rule, the latter is kept. The boundary is returned as loops that may
///   touch in vertices but not cross. Sides where the region lies on both sides vanish.
///
/// Vertices keep their position bit for bit; crossings are rounded to double, after which the result
/// is checked and, if rounding made sides cross again, repaired again.
///
/// Throws Error if a coordinate is not finite, or if three rounds are not enough.
RepairedLoops RepairLoops(const Loops2& loops);

/// True if loops inside an even number of others are counter-clockwise and the rest clockwise. Only
/// sensible for loops that do not cross; quick for few loops.
bool LoopsRunRight(const Loops2& loops);

/// Twice the signed area of a polygon, positive if counter-clockwise.
double SignedArea2(const std::vector<Vec2>& polygon);

} // namespace nurbs
