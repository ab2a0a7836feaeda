// SPDX-License-Identifier: BSD-3-Clause
/// @file WaveletSelection.h
/// @brief Which cells of the faces' pyramids and which segments of the edges' are meshed.
#pragma once

#include "FaceMesher.h"
#include "WaveletEdge.h"

namespace nurbs
{

/// Whether a cell is split.
using SplitCell = std::function<bool(const WaveletCell&)>;

/// True for cells whose error, as far as the face alone tells it, is over a tolerance.
SplitCell CellErrorOver(const WaveletFace& face, double tolerance);

/// The coarsest level that lacks no coefficient over a threshold.
int LevelWithin(const WaveletFace& face, double threshold);

/// The number of cells that are left when cells with a coefficient over a threshold are split.
std::int64_t CountCells(const WaveletFace& face, double threshold);

/// Cells by face and segments by edge.
struct WaveletSelection
{
  bool Haar;                                   ///< Edges have one level.
  std::vector<std::vector<WaveletCell>> Cells; ///< Empty: all of the face's Level.
  std::vector<int> Level;                      ///< The level of the face's grid.
  std::vector<std::vector<int>> Lines;         ///< An edge's vertices, ascending; none for Haar.
  std::vector<int> EdgeLevel;                  ///< Haar.
  std::vector<char> ChangedEdges;

  WaveletSelection(Wavelet kind, std::size_t faces, std::size_t edges);

  void SetLevel(std::size_t face, const WaveletFace& source, int level);
  void SetEdgeLevel(std::size_t edge, const WaveletEdge& source, int level);
  /// Chooses the coarsest cells that are not to be split.
  void RefineCells(std::size_t face, const WaveletFace& source, const SplitCell& split);
  /// Halves an edge's segments while `split(first line, last line)` says so.
  void RefineEdge(std::size_t edge, const std::function<bool(int, int)>& split);
  /// Makes a line a vertex of the edge; segments stay dyadic. Needs not be new.
  void AddLine(std::size_t edge, int line);
  /// Makes a segment of the edge finer, if it can be.
  void SplitSegment(std::size_t edge, int first, int last);
  /// Does what meshes ask for. Marks faces; returns whether there was anything to do.
  bool Apply(const std::vector<FaceMeshRequests>& requests,
    const std::vector<std::unique_ptr<WaveletFace>>& faces, std::vector<char>& dirty);
  /// Marks the faces of edges that were changed since the last call.
  void MarkChangedEdges(
    const std::vector<std::unique_ptr<WaveletEdge>>& edges, std::vector<char>& dirty);
};

} // namespace nurbs
