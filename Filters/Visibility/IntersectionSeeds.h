// SPDX-License-Identifier: BSD-3-Clause
/// @file IntersectionSeeds.h
/// @brief At least one point of every intersection curve of two faces.
///
/// Patches are halved until two parts are apart, or no normals of them are parallel. Then they have
/// no closed curve in common, so all curves cross the sides of the parts, and the points where
/// sides cross the other part are the seeds, found by the same subdivision (Krishnan, Manocha, "An
/// efficient surface intersection algorithm based on lower-dimensional formulation", 1997).
#pragma once

#include "IntersectionCell.h"
#include "PatchCutter.h"
#include "SurfacePair.h"

namespace nurbs
{

struct SeedLimits
{
  double Tolerance = 0.0; ///< Surfaces that pass each other by less only touch.
  double Smallest = 0.0;  ///< Size of parts that are not halved any more.
  std::int64_t Tests = 0; ///< Of pairs of parts, at most.
  /// Halvings after which parts count as tangent: of faces that share an edge, which most of what
  /// is not told apart lies along.
  int Depth = 60;
};

/// The search for one pair of faces.
class SeedSearch
{
public:
  SeedSearch(
    SurfacePair& pair, const CoverTest& coverA, const CoverTest& coverB, const SeedLimits& limits);

  /// Adds seeds of two patches.
  void Search(IntersectionCell& a, IntersectionCell& b) { this->Search(a, b, 0); }

  std::vector<IntersectionPoint> Seeds;
  bool Exhausted = false; ///< The limit of tests was reached: seeds may be missing.

private:
  struct ArcSource
  {
    int Side;     ///< Surface of the arc.
    int Dir;      ///< Its constant parameter,
    double Value; ///< and what it is.
  };

  void Search(IntersectionCell& a, IntersectionCell& b, int depth);
  void SearchSides(const IntersectionCell& cell, int side, IntersectionCell& other);
  void SearchArc(
    const ArcSource& source, const IntersectionArc& arc, IntersectionCell& cell, int depth);
  bool AddSeed(const ArcSource& source, const IntersectionArc& arc, const IntersectionCell& cell);
  bool IsLeft(int side, IntersectionCell& cell) const;
  bool Coincide(const IntersectionCell& a, int side, const IntersectionCell& b);
  bool LiesOn(const ArcSource& source, const IntersectionArc& arc, const IntersectionCell& cell);
  bool CountTest() { return !(this->Exhausted = this->Exhausted || --this->Limits.Tests < 0); }

  SurfacePair& Pair;
  const CoverTest* Covers[2];
  SeedLimits Limits;
};

} // namespace nurbs
