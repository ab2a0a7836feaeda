// SPDX-License-Identifier: BSD-3-Clause
/// @file PieceExchange.h
/// @brief The exchange of processes while they tessellate the pieces of a model; see PieceLinks.h.
#pragma once

#include "CompletedModel.h"
#include "FaceTessellator.h"
#include "PieceLinks.h"
#include "ShortEdges.h"

#include <unordered_map>

namespace nurbs
{

/// What became of the faces of a pass: points that they ask for, and the cells of their trees that are
/// too weak. One a face.
struct PassNews
{
  std::vector<std::vector<SplitRequest>> Requests;
  std::vector<std::vector<int>> Weak;
  bool IsAborted = false;
  bool IsUnfinished = false; ///< Some process's face asks for something.
};

/// The exchange after each pass. Does nothing without links.
class PieceExchange
{
public:
  /// @param uses one list an edge of the completed model.
  PieceExchange(const PieceLinks* links, const CompletedModel& model,
    const std::vector<std::vector<EdgeUse>>& uses);

  bool IsGhost(std::int64_t face) const { return this->Links && this->Links->IsGhost[face] != 0; }
  /// True if an own face uses the edge.
  bool IsOwnEdge(const std::vector<EdgeUse>& uses) const;
  /// True if there are other processes.
  bool IsParallel() const { return this->Links != nullptr; }

  /// Tells what others must know of the own faces `done`, and adds what they tell of ghosts: to `news`,
  /// and the ghosts to `done`.
  void Share(PassNews& news, std::vector<std::int64_t>& done) const;

  /// For CollapseShortEdges; only if there are other processes.
  PieceLoops GetLoops() const;

private:
  std::vector<char> Pack(const PassNews& news, const std::vector<std::int64_t>& done) const;

  const PieceLinks* Links;
  std::int64_t KnownEdges;
  std::vector<char> IsBorder; ///< One a face: it has an edge in common with a ghost.
  std::unordered_map<std::int64_t, std::int64_t> EdgeWith; ///< By number in the whole model.
  std::unordered_map<std::int64_t, std::vector<std::int64_t>> GhostsWith; ///< By number there.
};

} // namespace nurbs
