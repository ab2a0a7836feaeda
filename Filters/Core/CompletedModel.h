// SPDX-License-Identifier: BSD-3-Clause
/// @file CompletedModel.h
/// @brief A model in which every face has loops and every trim curve an edge with vertices.
#pragma once

#include "Model.h"

#include <deque>
#include <functional>

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

/// Makes one vertex of the ends of edges that are too short to matter, and the edge a degenerate
/// one. Neighbouring short edges become points only as far as they are so short together; a loop
/// keeps two longer ones.
/// @param shortest one length an edge; longer edges stay.
/// @param piece if the model is a piece of one, its place there; null: it is the whole.
void CollapseShortEdges(
  CompletedModel& model, const std::vector<double>& shortest, const PieceLoops* piece = nullptr);

} // namespace nurbs
