// SPDX-License-Identifier: BSD-3-Clause
/// @file ChainStitch.h
/// @brief Triangles between a face's boundary as its neighbours have it and as a repair left it.
///
/// Not in the paper, which does not ask for watertight models. Repairs of loops leave out vertices
/// and put new ones where sides cross. The difference of the two boundaries consists of closed
/// chains; triangles that fill these make the boundary the neighbours' again, bit for bit.
#pragma once

#include "Types.h"

#include <array>

namespace nurbs
{

/// Closed directed chains of vertex numbers.
using Chains = std::vector<std::vector<int>>;

/// What StitchChains made.
struct Stitches
{
  std::vector<std::array<int, 3>> Triangles; ///< Of the vertices' numbers.
  double Error = 0.0; ///< Bound of the distance of the triangles' points from the chains' sides.
  int Open = 0;       ///< Chains left open because they enclose too much.
};

/// Fills what is between chains: the boundary of the triangles is `given` less `made`.
///
/// @param points position of each vertex number.
/// @param limit a chain whose triangles would be farther from its sides is left open.
Stitches StitchChains(
  const Chains& given, const Chains& made, const std::vector<Vec3>& points, double limit);

} // namespace nurbs
