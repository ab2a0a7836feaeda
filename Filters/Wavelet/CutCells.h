// SPDX-License-Identifier: BSD-3-Clause
/// @file CutCells.h
/// @brief First step of a face's mesh: which cells of its grid its loops leave whole.
#pragma once

#include "FaceMesher.h"

#include <map>

namespace nurbs
{

/// What the steps of a face's mesh share.
class CutCells
{
protected:
  enum LeafState : char
  {
    Kept, ///< Inside, whole, and its sides on the box fit the loops' vertices.
    Cut,  ///< Part of the zone that is triangulated with the loops.
    Outside
  };

  /// A segment of a loop.
  struct Segment
  {
    int A, B; ///< Vertices of the mesh.
    const LevelLoopVertex* Source;
    int Side;      ///< Of the box, that it lies on; -1: none.
    bool Consumed; ///< It is a kept leaf's side.
  };

  explicit CutCells(const FaceMeshJob& job)
    : Job(job)
    , Cells{ int(job.Lines[0].size()) - 1, int(job.Lines[1].size()) - 1 }
  {}

  int AddVertex(const Vec2& uv, const Vec3& x, const Eigen::Vector3f& normal, double offset);
  int GridVertex(int i, int j);
  /// Vertices at any parameters: the surface is asked for normals and for the distance from it.
  std::vector<int> AddEvaluated(const std::vector<Vec2>& uv, const std::vector<Vec3>* places);
  void AddLoops();
  int SideOf(const Vec2& a, const Vec2& b) const;
  void MarkGrid();
  int OwnerOf(int i, int j) const { return this->Owner[i + std::size_t(j) * this->Cells[0]]; }
  /// The leaves that loops cut, but for loops along sides of the box.
  void CutLeaves();
  void Walk(int s);
  /// Where a line v = const crosses loops, ascending.
  std::vector<std::vector<double>> Crossings(const std::vector<double>& vs) const;
  static bool IsInside(const std::vector<double>& crossings, double u);
  /// Of the others, those inside are kept, if the edges along their sides fit.
  void KeepLeaves();
  /// Corners of a leaf, counter-clockwise from (I0, J0).
  static void Corner(const GridLeaf& leaf, int k, int& i, int& j);
  bool IsOnSide(const GridLeaf& leaf, int side) const;
  bool TakeSides(const GridLeaf& leaf);
  /// The end of a segment on a side that comes first or last on the way around the box.
  int EndOf(const Segment& segment, int side, bool last) const;
  /// The segments along a leaf's side on the box, counter-clockwise; false: they do not fit it.
  bool FindChain(const GridLeaf& leaf, int side, std::vector<int>& chain) const;
  ParameterBox BoxOf(const GridLeaf& leaf) const;
  int CellOf(int dir, double t) const;

  const FaceMeshJob& Job;
  const int Cells[2];
  WaveletMesh Mesh;
  /// Bound of each vertex's distance from the surface at its parameters.
  std::vector<double> Offsets;
  std::vector<Segment> Segments;       ///< Segment k starts at vertex k.
  std::multimap<double, int> Sides[4]; ///< Segments along the box's sides, by their lower end.
  std::vector<int> Owner;              ///< Leaf of each cell.
  std::vector<char> Marks;             ///< Grid vertices that are corners of leaves.
  std::vector<int> GridIds;            ///< Their vertices in the mesh; -1: none yet.
  std::vector<LeafState> States;
  std::vector<std::vector<int>> CutBy; ///< Segments that come near a leaf.
};

} // namespace nurbs
