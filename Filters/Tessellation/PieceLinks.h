// SPDX-License-Identifier: BSD-3-Clause
/// @file PieceLinks.h
/// @brief What the processes that tessellate the pieces of a model tell each other.
///
/// A piece has ghosts: faces of other processes that have an edge or vertex in common with its own. An
/// edge's polyline depends on both faces beside it, on their trees of cells, and on the points that
/// either face asked for when it could not certify its triangles. So every process makes bounds and
/// trees of its ghosts as well, and after each pass all tell what their faces asked for and which
/// cells they refined. All then have the same polyline for every shared edge, bit for bit, and it is
/// the one that a single process would make.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace nurbs
{

/// Identity across processes.
struct PieceLinks
{
  std::vector<char> IsGhost; ///< One a face of the model: it is another process's.
  std::vector<std::array<std::int64_t, 2>> Faces; ///< One a face: the owner, and its number there.
  std::vector<std::int64_t> Edges;                ///< One an edge: its number in the whole model.
  std::vector<std::int64_t> Vertices;             ///< The same for vertices.
  /// Gives every process the messages of all, by rank. All must call it at the same time.
  std::function<std::vector<std::vector<char>>(const std::vector<char>&)> Exchange;
};

} // namespace nurbs
