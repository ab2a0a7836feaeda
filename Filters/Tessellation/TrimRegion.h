// SPDX-License-Identifier: BSD-3-Clause
/// @file TrimRegion.h
/// @brief A face's trimmed domain as directed polygons in (u, v): what is inside, what is cut.
#pragma once

#include "SurfaceTree.h"

namespace nurbs
{

/// A vertex of a face's boundary.
struct BoundaryVertex
{
  Vec2 UV;
  Vec2 Other; ///< Another place for it, should UV make sides cross; equal to UV: none.
  Vec3 X;
  std::int64_t Edge = -1;    ///< The edge of the segment that starts here.
  double T0 = 0.0, T1 = 0.0; ///< That segment on the edge (T0 > T1 if reversed).
};

/// The directed polygons of one face, material on the left.
class TrimRegion
{
public:
  /// @param loops of at least three vertices each.
  /// @param near distances in u and v as long as the chords of trim lines may bow.
  explicit TrimRegion(
    const std::vector<std::vector<BoundaryVertex>>& loops, const Vec2& near = Vec2(0.0, 0.0));

  /// True if p lies inside (even-odd); p must not be on a segment.
  bool Inside(const Vec2& p) const;

  /// True if a segment crosses, from one side to the other, the line (u or v, by `dir`) = `value`
  /// strictly between `from` and `to`.
  bool Crosses(int dir, double value, double from, double to) const;

  /// True if p is on a segment that runs along u or v (`dir`: the direction that is constant).
  bool IsOnLine(int dir, const Vec2& p) const;

  /// Segments as pairs of indices into Points().
  const std::vector<std::pair<int, int>>& Segments() const { return this->Sides; }
  const std::vector<Vec2>& Points() const { return this->Corners; }
  /// Which segments come near which leaf: (leaf, segment) pairs, sorted. "Near" means within
  /// `margin` times the leaf's own size, or about as near as chords may bow: beside those, triangles
  /// with a whole cell's side would overlap.
  std::vector<std::pair<int, int>> CutLeaves(const SurfaceTree& tree, double margin) const;
  /// Factors, powers of two, that make the typical cell along the trim lines a square: what does not
  /// cross in (u, v) does not cross when scaled.
  Vec2 CellScale(const SurfaceTree& tree) const;

private:
  std::vector<Vec2> Corners;
  std::vector<std::pair<int, int>> Sides;
  Vec2 Near;
  double Low = 0.0, Step = 1.0;
  std::vector<int> BucketStart; ///< Segments by rows of v.
  std::vector<int> BucketItems;
};

} // namespace nurbs
