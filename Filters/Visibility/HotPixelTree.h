// SPDX-License-Identifier: BSD-3-Clause
/// @file HotPixelTree.h
/// @brief A tree of boxes over pixels that tells which of them a segment passes.
#pragma once

#include "SegmentCrossings.h"

namespace nurbs
{

/// If a line passes the pixel of a grid point. Exact.
bool PassesPixel(const GridLine& line, const GridPoint& pixel);

class HotPixelTree
{
public:
  /// `pixels` must be different.
  explicit HotPixelTree(const std::vector<GridPoint>& pixels);

  /// Appends the pixels that the line passes, by index, from its start to its end.
  void Find(const GridLine& line, std::vector<std::int32_t>& passed) const;

private:
  // The tree halves ranges of the pixels until they have LeafSize or less. Children of the node n
  // are 2 n + 1 and 2 n + 2.
  static constexpr std::int64_t LeafSize = 8;
  struct Pixel
  {
    std::int32_t X, Y, Index;
  };
  struct Box
  {
    std::int32_t X0, Y0, X1, Y1; // centres of the outermost pixels
  };

  void Build(std::size_t node, std::int64_t begin, std::int64_t end);
  static bool IsMet(const GridLine& line, const Box& box);

  std::vector<Pixel> Pixels;
  std::vector<Box> Boxes;
};

} // namespace nurbs
