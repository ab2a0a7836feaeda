// SPDX-License-Identifier: BSD-3-Clause
/// @file ClosestTriangle.h
/// @brief Nearest triangle or segment to a point: a tree of boxes over triangles.
#pragma once

#include "FaceMesh.h"

#include <limits>

namespace verify
{

/// A tree of axis-aligned boxes. Degenerate triangles are fine: a segment is the triangle (a, b, a).
class ClosestTriangle
{
public:
  struct Hit
  {
    double Distance = std::numeric_limits<double>::infinity();
    int Triangle = -1;
    Vec3 Weights = Vec3::Zero(); ///< Barycentric coordinates of the nearest point.
  };

  /// Keeps references to nothing: the corners are copied.
  void Build(const std::vector<Vec3>& points, const std::vector<std::array<int, 3>>& triangles);
  bool Empty() const { return this->Corners.empty(); }

  /// The nearest point nearer than @a bound; Triangle is -1 if there is none.
  Hit Find(const Vec3& p, double bound = std::numeric_limits<double>::infinity()) const;

private:
  struct Node
  {
    Vec3 Low, High;
    int First = 0, Count = 0; ///< Count 0: inner node, whose children are First and First + 1.
  };
  void Split(int node, int first, int count, std::vector<Vec3>& centres);

  std::vector<std::array<Vec3, 3>> Corners;
  std::vector<int> Order;
  std::vector<Node> Nodes;
};

/// Nearest point of a triangle to @a p, as barycentric coordinates.
Vec3 NearestWeights(const Vec3& p, const std::array<Vec3, 3>& corners);

} // namespace verify
