// SPDX-License-Identifier: BSD-3-Clause
/// @file CompletedModel.h
/// @brief A model in which every face has loops and every trim curve an edge with vertices.
#pragma once

#include "Model.h"

#include <deque>

namespace nurbs
{

/// A model completed: faces without loops have their natural boundary, and every
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

/// One place where a loop of a face runs along an edge.
struct EdgeUse
{
  std::int64_t Face = -1;
  std::int64_t Curve = -1; ///< Index into Model::TrimCurves.
};

/// The parameter of a trim curve that belongs to an edge's parameter (affine if domains differ).
double TrimParameter(const TrimCurve& curve, const Interval& edge, double t);

/// The parameter interval of an edge: its 3D curve's domain, or its first trim curve's.
Interval EdgeDomain(const Model& model, std::int64_t edge, const std::vector<EdgeUse>& uses);

/// Completes a model. Opposite sides of a closed surface share an edge; sides that are a point get
/// a degenerate edge.
/// @param sideTolerance sides of faces without loops that are nowhere farther apart than this, at
/// parameters that run evenly along both, become one edge, too. Negative: none do.
CompletedModel CompleteModel(
  const Model& model, const std::vector<std::string>& faceErrors, double sideTolerance = -1.0);

/// Makes one vertex of the ends of edges that are too short to matter, and the edge a degenerate
/// one. Neighbouring short edges become points only as far as they are so short together; a loop
/// keeps two longer ones.
/// @param shortest one length an edge; longer edges stay.
void CollapseShortEdges(CompletedModel& model, const std::vector<double>& shortest);

} // namespace nurbs
