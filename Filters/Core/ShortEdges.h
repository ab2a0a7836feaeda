// SPDX-License-Identifier: BSD-3-Clause
/// @file ShortEdges.h
/// @brief CollapseShortEdges where several processes have pieces of a model.
#pragma once

#include "CompletedModel.h"

#include <functional>

namespace nurbs
{

/// An edge in a loop that has edges too short to matter.
struct LoopEdge
{
  std::int64_t Edge = -1;
  double Length = -1.0;  ///< Bound of its length; -1: it is long enough.
  double Shortest = 0.0; ///< A length under which it is too short.
  bool IsPoint = false;  ///< A pole.
  std::int64_t Vertex[2] = { -1, -1 };
  Vec3 Places[2] = { Vec3::Zero(), Vec3::Zero() }; ///< Of the vertices.
};
using ShortLoops = std::vector<std::vector<LoopEdge>>;

/// How a piece of a model, which other processes have the rest of, is part of the whole.
struct PieceLoops
{
  std::function<bool(std::int64_t face)> IsOwn; ///< Whether the face is this process's.
  /// Replaces the loops of own faces by those of all processes, in order. Edges and vertices have the
  /// numbers of the whole model.
  std::function<void(ShortLoops& loops)> Share;
  std::function<std::int64_t(std::int64_t edge)> EdgeNumber; ///< In the whole model; -1: none.
  std::function<std::int64_t(std::int64_t vertex)> VertexNumber;
};

/// As the function of that name for whole models, with the same result.
void CollapseShortEdges(
  CompletedModel& model, const std::vector<double>& shortest, const PieceLoops& piece);

} // namespace nurbs
