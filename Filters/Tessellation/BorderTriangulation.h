// SPDX-License-Identifier: BSD-3-Clause
/// @file BorderTriangulation.h
/// @brief Constrained Delaunay triangulation of the zone between trim polylines and whole cells.
///
/// Plays the part of section 6 of Balazs et al. (trimming by directed half-edges): directed segments
/// have the zone on their left; triangles are found from them and by crossing free edges. No vertex
/// is ever added to a segment, so what two faces share stays shared.
#pragma once

#include "Types.h"

#include <array>
#include <memory>

namespace nurbs
{

/// A triangulation in a scaled (u, v) plane; predicates are exact.
class BorderTriangulation
{
public:
  BorderTriangulation();
  ~BorderTriangulation();

  /// Adds a point; returns its id, or the id of the point that is there already.
  int AddPoint(const Vec2& p);
  /// Adds the directed segment a -> b with the zone on its left. False: it crosses another one.
  bool AddSegment(int a, int b);
  /// Adds a line that triangles may not cross, with the zone on both sides. False: it crosses.
  bool AddCrease(int a, int b);
  /// The triangles of the zone, counter-clockwise.
  void Triangles(std::vector<std::array<int, 3>>& triangles) const;
  /// True if the edge (a, b) exists and is a segment or crease.
  bool IsConstrained(int a, int b) const;
  /// True if the edge (a, b) belongs to a segment; creases may be split by points on them. Valid
  /// after Triangles.
  bool IsWall(int a, int b) const;
  std::size_t Size() const;

private:
  struct Internals;
  std::unique_ptr<Internals> Data;
};

} // namespace nurbs
