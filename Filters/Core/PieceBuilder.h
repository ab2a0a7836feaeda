// SPDX-License-Identifier: BSD-3-Clause
/// @file PieceBuilder.h
/// @brief Takes faces out of models, with all they need and no more, and puts them together again.
///
/// A piece of a model has some of its faces, the edges and vertices that these use, and the numbers
/// that edges and vertices have in the whole model (their global ids), so that pieces fit together:
/// where two faces of different pieces use an edge, it has the same global id in both.
#pragma once

#include "ModelBuilder.h"

#include <unordered_map>

namespace nurbs
{

/// Where the pieces of a model begin: faces [first[p], first[p + 1]) are those of piece p. Faces stay
/// in order, as neighbours have near numbers in most models; a piece gets the faces whose middle, on
/// the sum of all costs, lies in its share.
/// @param costs one a face, over 0. @param pieces at least 1.
std::vector<std::int64_t> DealFaces(const std::vector<double>& costs, int pieces);

/// What working on a face is estimated to cost, in no unit: the control points of its net and trims
/// and a part that all faces have.
double FaceCost(const ModelArrays& arrays, std::int64_t face);

/// The faces of all models dealt together: of each model, the first face of a piece and the one past
/// its last.
std::vector<std::pair<std::int64_t, std::int64_t>> DealModels(
  const std::vector<const ModelBuilder*>& models, int piece, int pieces);

/// Collects faces of several sources. A face comes as it is, with what is wrong with it.
class PieceBuilder
{
public:
  /// Global ids of edges or vertices.
  using Integers = ArrayView<std::int64_t>;

  /// Starts with another source; all sources must stay until Finish. Edges and vertices of sources
  /// with the same global id are one. Without ids (empty) they are those of no other source.
  void Begin(const ModelArrays& source, Integers edgeIds, Integers vertexIds);

  /// Adds a face of the current source.
  void AddFace(std::int64_t face);

  /// Adds the edges and vertices, sorted by their global ids.
  void Finish();

  ModelBuilder Model;                  ///< The faces; complete after Finish.
  std::vector<std::int64_t> EdgeIds;   ///< Global ids of its edges; made by Finish.
  std::vector<std::int64_t> VertexIds; ///< The same for its vertices.

private:
  struct Source
  {
    ModelArrays Arrays;
    Integers EdgeIds, VertexIds;
    std::int64_t FirstEdgeId = 0, FirstVertexId = 0; ///< Of a source without ids.
  };
  struct Item
  {
    std::int64_t Id;    ///< Global.
    int Source;         ///< Where it comes from.
    std::int64_t Index; ///< And which it is there.
  };
  void AddNet(std::int64_t face);
  void AddKnots(std::int64_t face);
  void AddLoops(std::int64_t face);
  void AddTrimCurve(std::int64_t curve);
  std::int64_t EdgeOf(std::int64_t index);
  std::int64_t VertexOf(int source, std::int64_t index);
  void AddEdge(const Item& edge);

  std::vector<Source> Sources;
  std::int64_t NextEdgeId = 0, NextVertexId = 0; ///< For sources without ids.
  std::vector<Item> Edges, Vertices;             ///< In the order of their first use.
  std::unordered_map<std::int64_t, std::int64_t> EdgeWith, VertexWith; ///< By global id.
  std::unordered_map<std::int64_t, std::int64_t> PointWith; ///< By a face's point, for one face.
};

/// Faces [first, last) of a model that was built, with their looks. Edges and vertices have the
/// indices of the model as global ids.
PieceBuilder TakeFaces(const ModelBuilder& model, std::int64_t first, std::int64_t last);

} // namespace nurbs
