// SPDX-License-Identifier: BSD-3-Clause
/// @file VertexSets.h
/// @brief Sets of vertices that become one, and edges that become points. Private to this folder.
#pragma once

#include "Model.h"

#include <numeric>

namespace nurbs
{

/// Sets of numbers from 0 on; each is known by its least.
struct UnionFind
{
  std::vector<std::int64_t> Parent;
  explicit UnionFind(std::size_t n)
    : Parent(n)
  {
    std::iota(this->Parent.begin(), this->Parent.end(), 0);
  }
  std::int64_t Find(std::int64_t x)
  {
    while (this->Parent[x] != x)
    {
      x = this->Parent[x] = this->Parent[this->Parent[x]];
    }
    return x;
  }
  void Join(std::int64_t a, std::int64_t b)
  {
    a = this->Find(a);
    b = this->Find(b);
    this->Parent[std::max(a, b)] = std::min(a, b);
  }
};

/// Makes a pole of an edge.
inline void MakeDegenerate(Edge& edge)
{
  static const double pole[4] = { 0.0, 0.0, 0.0, 1.0 };
  static const double knots[2] = { 0.0, 1.0 };
  edge.Geometry.Degree = 0;
  edge.Geometry.Count = 1;
  edge.Geometry.Points = pole;
  edge.Geometry.Knots = KnotView(knots, 2);
}

} // namespace nurbs
