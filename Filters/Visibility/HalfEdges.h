// SPDX-License-Identifier: BSD-3-Clause
/// @file HalfEdges.h
/// @brief Borders of unions of cells of a planar map.
#pragma once

#include "SnapRounding.h"

namespace nurbs
{

/// A half-edge 2 e + side runs along edge e with that side's cell (PlanarMap::Sides) on its left.
using HalfEdge = std::int32_t;

/// The half-edges of a planar map, in their order around each vertex. Constant once built; the segments
/// must outlive it.
class HalfEdges
{
public:
  explicit HalfEdges(const SnappedSegments& segments);

  std::int32_t Start(HalfEdge half) const { return this->Map.Edges[half / 2][half % 2]; }
  std::int32_t End(HalfEdge half) const { return this->Map.Edges[half / 2][1 - half % 2]; }
  /// Loops of the half-edges of a border, one flag a half-edge, that have the region on their left. They
  /// close, do not cross, and part where the region touches itself in a vertex. The first of each loop has
  /// the lowest number.
  std::vector<std::vector<HalfEdge>> Loops(const std::vector<char>& border) const;

private:
  HalfEdge Next(HalfEdge half, const std::vector<char>& border) const;

  const SnappedSegments& Map;
  std::vector<std::int64_t> First;   // One a vertex, into Around; and the end.
  std::vector<HalfEdge> Around;      // That start at the vertex, counter-clockwise.
  std::vector<std::int32_t> PlaceOf; // Of a half-edge in Around.
};

} // namespace nurbs
