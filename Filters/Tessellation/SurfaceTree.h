// SPDX-License-Identifier: BSD-3-Clause
/// @file SurfaceTree.h
/// @brief Subdivision of a surface's parameter domain into cells that two triangles can replace.
///
/// Source: Balazs, Guthe, Klein 2004, section 5.2 (kd-tree, quadtree, binary tree). Two changes make
/// the kd-tree coarser: cells end at lines that the whole face shares, so that neighbours align and
/// hardly any T-vertices arise, and between two knots there may be any number of such lines, chosen
/// from the curvature, rather than a power of two.
#pragma once

#include "LinePlacement.h"
#include "Tessellator.h"

namespace nurbs
{

/// A position on the shared lines of one direction: line index * 2^20 + dyadic fraction. Equal
/// codes are equal parameters; order is the parameters' order.
using LineCode = std::int64_t;

/// A cell that needs no further split.
struct TreeLeaf
{
  LineCode U0 = 0, U1 = 0, V0 = 0, V1 = 0;
  ParameterBox Box;
  double Error = 0.0; ///< Bound (or estimate) of the two triangles' distance from the surface.
  int Axis = 0;       ///< Direction (0: u, 1: v) that deviates most.
  int Diagonal = 0;   ///< 0: from (U0, V0) to (U1, V1); 1: from (U1, V0) to (U0, V1).
};

/// What a tree must reach.
struct TreeGoal
{
  double Tolerance = 0.0; ///< Model units.
  SubdivisionMethod Method = SubdivisionMethod::KdTree;
  ErrorMode Error = ErrorMode::Guaranteed;
  double MaximumEdgeLength = 0.0; ///< 0: none.
  double MaximumAngle = 0.0;      ///< Radians; 0: none.
  std::int64_t MaximumLeaves = 2000000;
};

/// True if the segment a-b touches the closed box.
bool SegmentTouchesBox(const Vec2& a, const Vec2& b, const ParameterBox& box);

/// The tree over one surface.
class SurfaceTree
{
public:
  /// Subdivides `domain` (inside the surface's domain). Large surfaces are built in parallel.
  /// Makes the grid of `bound`, too.
  void Build(SurfaceBound& bound, const ParameterBox& domain, const TreeGoal& goal,
    const ParallelFor& parallel);

  /// Splits leaves once more; the other leaves keep their index.
  void Refine(const SurfaceBound& bound, const TreeGoal& goal, std::vector<int> leaves);

  const std::vector<TreeLeaf>& Leaves() const { return this->Cells; }
  /// True if MaximumLeaves stopped the subdivision.
  bool IsCapped() const { return this->Capped; }
  /// The parameter of a code in direction 0 (u) or 1 (v).
  double Parameter(int dir, LineCode code) const;
  /// The shared lines of a direction, ascending.
  const std::vector<double>& Lines(int dir) const { return this->Line[dir].At; }
  /// Crease knots strictly inside the domain: triangles may not cross them.
  const std::vector<double>& Creases(int dir) const { return this->Crease[dir]; }

  /// Calls use(leaf index) for every leaf that touches the closed box.
  template <typename F>
  void Query(const ParameterBox& box, F&& use) const
  {
    if (!this->Nodes.empty())
    {
      this->QueryNode(0, box, use);
    }
  }

  /// Calls use(leaf index) for every leaf that the segment a-b comes near: nearer than `margin`
  /// times the leaf's own size.
  template <typename F>
  void QuerySegment(const Vec2& a, const Vec2& b, double margin, F&& use) const
  {
    if (!this->Nodes.empty())
    {
      this->QuerySegmentNode(0, a, b, margin, use);
    }
  }

private:
  struct Node
  {
    ParameterBox Box;
    int First = -1; ///< First child; children follow each other. Leaf: -1.
    int Count = 0;  ///< Children, or the leaf's index if First < 0.
  };
  struct Range
  {
    LineCode U0, U1, V0, V1;
  };
  struct Subtree;
  struct Work;

  template <typename F>
  void QueryNode(int index, const ParameterBox& box, F& use) const
  {
    const Node& node = this->Nodes[index];
    if (box.U0 > node.Box.U1 || box.U1 < node.Box.U0 || box.V0 > node.Box.V1 ||
      box.V1 < node.Box.V0)
    {
      return;
    }
    if (node.First < 0)
    {
      use(node.Count);
      return;
    }
    for (int c = 0; c < node.Count; ++c)
    {
      this->QueryNode(node.First + c, box, use);
    }
  }

  template <typename F>
  void QuerySegmentNode(int index, const Vec2& a, const Vec2& b, double margin, F& use) const
  {
    const Node& node = this->Nodes[index];
    const double mu = margin * node.Box.A();
    const double mv = margin * node.Box.B();
    if (!SegmentTouchesBox(
          a, b, { node.Box.U0 - mu, node.Box.U1 + mu, node.Box.V0 - mv, node.Box.V1 + mv }))
    {
      return;
    }
    if (node.First < 0)
    {
      use(node.Count);
      return;
    }
    for (int c = 0; c < node.Count; ++c)
    {
      this->QuerySegmentNode(node.First + c, a, b, margin, use);
    }
  }

  void MakeLines(const SurfaceBound& bound, const ParameterBox& domain, const TreeGoal& goal);
  double BestMargin(const SurfaceBound& bound, const TreeGoal& goal, bool bothDirections) const;
  ParameterBox BoxOf(const Range& range) const;
  /// The code where [low, high] of a direction is split; `low` if it cannot be.
  LineCode SplitCode(int dir, LineCode low, LineCode high, bool halves) const;

  ParallelFor Parallel = SerialFor;
  ParameterLines Line[2];
  std::vector<double> Crease[2];
  std::vector<char> IsCrease[2]; ///< Per line.
  std::vector<Node> Nodes;
  std::vector<TreeLeaf> Cells;
  bool Capped = false;
};

} // namespace nurbs
