// SPDX-License-Identifier: BSD-3-Clause
/// @file CompletedModel.h
/// @brief A model in which every face has loops and every trim curve an edge with vertices.
#pragma once

#include "Model.h"

#include <deque>

namespace nurbs
{

/// A model completed for tessellation: faces without loops have their natural boundary, and every
/// trim curve has an edge of its own or a shared one.
struct CompletedModel
{
  Model Data;
  std::deque<Curve<2>> OwnCurves; ///< Storage of natural boundaries.
  std::int64_t KnownEdges = 0;    ///< Edges of the given model; later ones are ours.
};

/// True for an edge that is one point: a pole.
inline bool IsDegenerate(const Edge& edge)
{
  return edge.Geometry.Count == 1;
}

/// Completes a model. Opposite sides of a closed surface share an edge; sides that are a point get
/// a degenerate edge.
CompletedModel CompleteModel(const Model& model, const std::vector<std::string>& faceErrors);

/// Makes one vertex of the ends of edges that are too short to matter, and the edge a degenerate one.
/// Neighbouring short edges become points only as far as they are so short together; a loop keeps two
/// longer ones.
/// @param shortest one length an edge; longer edges stay.
void CollapseShortEdges(CompletedModel& model, const std::vector<double>& shortest);

} // namespace nurbs
