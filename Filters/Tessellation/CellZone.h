// SPDX-License-Identifier: BSD-3-Clause
/// @file CellZone.h
/// @brief The cells of a surface tree against a trimmed region: whole, cut or outside.
#pragma once

#include "FacetBound.h"
#include "TrimRegion.h"

#include <array>
#include <functional>
#include <unordered_map>

namespace nurbs
{

/// What is known of a whole leaf's triangles, for as long as its outline stays the same.
struct LeafState
{
  std::uint64_t Outline = 0; ///< Hash of the outline's vertices; 0: nothing is known.
  bool Fan = false;          ///< Triangulated around its middle.
  double Error = -1.0;       ///< Of its triangles; negative: not computed yet.
};

/// Sorts a tree's leaves, triangulates the whole ones and tells what the border zone needs.
class CellZone
{
public:
  /// A triangle of a whole cell; corners index Points(), counter-clockwise in (u, v).
  struct Triangle
  {
    int Corner[3];
    int Leaf;
    bool Whole; ///< One of the leaf's own two triangles (no T-vertex on its sides).
  };
  /// The error of a triangle, NotGood if it must not be. Called from several threads, each with a
  /// FacetBound of its own.
  using ErrorOf = std::function<double(FacetBound&, const Triangle&)>;
  static constexpr double NotGood = 1e300;

  /// @param margin leaves nearer to a trim line than this share of their size count as cut.
  CellZone(const SurfaceTree& tree, const TrimRegion& region, double margin);

  /// Leaves that no trim line comes near and that are inside.
  const std::vector<int>& WholeLeaves() const { return this->Whole; }
  /// Parameters of all vertices: corners of whole cells, and corners of cut cells well inside.
  const std::vector<Vec2>& Points() const { return this->Vertices; }
  /// Triangulates the whole cells, with the T-vertices on their sides. A cell with T-vertices one of
  /// whose triangles is not good becomes a fan around its middle, a new point of Points().
  /// @param states one a leaf; what it knows of unchanged cells is not tried again.
  void TriangulateWhole(const ErrorOf& errorOf, const FacetBound& bound,
    std::vector<LeafState>& states, const ParallelFor& parallel);
  const std::vector<Triangle>& Triangles() const { return this->Result; }
  /// Sides of whole cells that face the border zone, directed with the zone on their left.
  const std::vector<std::pair<int, int>>& OpenSides() const { return this->Sides; }
  /// Vertices inside the border zone.
  const std::vector<int>& FreePoints() const { return this->Free; }

private:
  struct Key
  {
    LineCode U, V;
    bool operator==(const Key& o) const { return this->U == o.U && this->V == o.V; }
  };
  struct Hash
  {
    std::size_t operator()(const Key& k) const
    {
      return std::size_t(k.U) * 0x9E3779B97F4A7C15ull ^
        (std::size_t(k.V) + 0x7F4A7C15ull) * 0xC2B2AE3D27D4EB4Full;
    }
  };
  using Corners = std::array<int, 4>; ///< Vertices at (U0, V0), (U1, V0), (U0, V1), (U1, V1).
  int Vertex(LineCode u, LineCode v);
  void KeepCutCorners(const TrimRegion& region, const std::vector<std::pair<int, int>>& cut);
  void LinkVertices();
  void FindOpenSides(const std::vector<std::pair<int, int>>& directed);
  void Polygon(const Corners& corners, std::vector<int>& polygon, std::vector<int>& lower,
    std::vector<int>& upper) const;
  void Monotone(int leaf, const std::vector<int>& lower, const std::vector<int>& upper,
    std::vector<Triangle>& out) const;
  struct Part;
  void TriangulatePart(std::size_t begin, std::size_t end, const ErrorOf& errorOf, FacetBound bound,
    std::vector<LeafState>& states, Part& out) const;
  std::uint64_t Outline(const std::vector<int>& polygon) const;

  const SurfaceTree& Tree;
  std::vector<int> Whole;         ///< Leaves,
  std::vector<Corners> CornersOf; ///< and theirs.
  std::unordered_map<Key, int, Hash> Index;
  std::vector<Key> Keys;
  std::vector<Vec2> Vertices;
  std::vector<int> Free;
  std::vector<Triangle> Result;
  std::vector<std::pair<int, int>> Sides;
  std::vector<int> NextU,
    NextV; ///< Each vertex's neighbour on its line in direction u, v; -1: none.
};

} // namespace nurbs
