// SPDX-License-Identifier: BSD-3-Clause
/// @file CellBorders.h
/// @brief The half-edges of each cell of a planar map.
#pragma once

#include "HalfEdges.h"
#include "PlanarMap.h"
#include "Types.h"

#include <numeric>

namespace nurbs
{

/// By cell, those that have it on their left.
class CellBorders
{
public:
  explicit CellBorders(const PlanarMap& plane)
    : First(plane.CellCount + 1, 0)
    , Halves(2 * plane.Sides.size())
  {
    for (const std::array<std::int32_t, 2>& sides : plane.Sides)
    {
      ++this->First[sides[0] + 1];
      ++this->First[sides[1] + 1];
    }
    std::partial_sum(this->First.begin(), this->First.end(), this->First.begin());
    std::vector<std::int64_t> next(this->First.begin(), this->First.end() - 1);
    for (HalfEdge half = 0; half < HalfEdge(this->Halves.size()); ++half)
    {
      this->Halves[next[plane.Sides[half / 2][half % 2]]++] = half;
    }
  }

  /// In increasing order.
  ArrayView<HalfEdge> Of(std::int32_t cell) const
  {
    return { this->Halves.data() + this->First[cell],
      std::size_t(this->First[cell + 1] - this->First[cell]) };
  }

private:
  std::vector<std::int64_t> First; // One a cell, into Halves; and the end.
  std::vector<HalfEdge> Halves;
};

} // namespace nurbs
