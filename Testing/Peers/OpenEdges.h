// SPDX-License-Identifier: BSD-3-Clause
/// @file OpenEdges.h
/// @brief Whether the meshes of neighbouring faces meet, exact coordinates compared.
#pragma once

#include "FaceMesh.h"
#include "ReferenceShape.h"

namespace verify
{

struct OpenEdgeReport
{
  int ClosedBodies = 0, OpenBodies = 0;
  long OpenEdges = 0;     ///< Mesh edges used an odd number of times, in the closed bodies.
  long Misdirected = 0;   ///< Of the others, those not used equally often in both directions.
  long Cracks = 0;        ///< In open bodies: mesh edges used once, far from every free edge.
  std::vector<int> Faces; ///< Where the open edges are.
  /// Ends of the first few of them, and the face that has them.
  std::vector<std::pair<int, std::array<Vec3, 2>>> Examples;
};

/// Points are the same if all bits of their coordinates are (0 and -0 are one). A vertex in the middle
/// of a neighbour's edge thus opens three edges.
/// @param reach distance from the free edges within which a mesh edge of an open body may be free.
OpenEdgeReport FindOpenEdges(
  const ReferenceShape& shape, const std::vector<FaceMesh>& meshes, double reach);

} // namespace verify
