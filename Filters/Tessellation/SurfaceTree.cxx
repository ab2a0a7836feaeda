// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTree.h"

#include "CellError.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace nurbs
{

namespace
{
constexpr int FractionBits = 20;
constexpr double FailureCost = 3.0; // Cells that a failing one becomes or adds T-vertices to.
constexpr double BoundSlack = 1.06; // By how much bounds exceed the sampled error, typically.
constexpr LineCode One = LineCode(1) << FractionBits;

} // namespace

void SurfaceTree::MakeLines(
  const SurfaceBound& bound, const ParameterBox& domain, const TreeGoal& goal)
{
  if (goal.Method == SubdivisionMethod::KdTree)
  {
    const LinePlacement placement(bound, domain, goal.Tolerance, this->Parallel);
    placement.Place(1.0, this->Line[0], this->Line[1]);
    const bool both = placement.FollowsDemand(0) && placement.FollowsDemand(1);
    const bool several = this->Line[0].At.size() > 2 || this->Line[1].At.size() > 2;
    if (several && (placement.FollowsDemand(0) || placement.FollowsDemand(1)))
    {
      placement.Place(this->BestMargin(bound, goal, both), this->Line[0], this->Line[1]);
    }
  }
  else
  {
    const double low[2] = { domain.U0, domain.V0 };
    const double high[2] = { domain.U1, domain.V1 };
    for (int d = 0; d < 2; ++d)
    {
      std::vector<double>& at = this->Line[d].At;
      at = bound.Creases(d);
      at.insert(at.begin(), low[d]);
      at.push_back(high[d]);
      this->Line[d].Demand.resize(at.size());
      std::iota(this->Line[d].Demand.begin(), this->Line[d].Demand.end(), 0.0);
    }
  }
  for (int d = 0; d < 2; ++d)
  {
    this->Crease[d] = bound.Creases(d);
    const std::vector<double>& lines = this->Line[d].At;
    this->IsCrease[d].assign(lines.size(), 0);
    for (double t : this->Crease[d])
    {
      this->IsCrease[d][std::lower_bound(lines.begin(), lines.end(), t) - lines.begin()] = 1;
    }
  }
}

// The factor on the number of lines that makes the fewest cells: cells that miss the tolerance are
// halved, so that it pays to satisfy all but a few of them at once. Typical cells tell.
double SurfaceTree::BestMargin(
  const SurfaceBound& bound, const TreeGoal& goal, bool bothDirections) const
{
  constexpr std::size_t Most = 16;
  CellError cell(bound, goal);
  double error[Most];
  const std::size_t nu = this->Line[0].At.size() - 1;
  const std::size_t nv = this->Line[1].At.size() - 1;
  const int samples = int(std::min(Most, nu * nv));
  for (int k = 0; k < samples; ++k)
  {
    const std::size_t i = std::size_t((k + 0.5) / samples * nu);
    const std::size_t j = std::size_t((0.5 + (k * 5) % samples) / samples * nv);
    error[k] = cell.Sampled({ this->Line[0].At[i], this->Line[0].At[i + 1], this->Line[1].At[j],
      this->Line[1].At[j + 1] });
  }
  std::sort(error, error + samples);
  double best = 1.0;
  double least = 1e300;
  for (int k = 0; k < samples; ++k)
  {
    const double margin =
      std::min(2.0, std::max(0.8, std::sqrt(BoundSlack * error[k] / goal.Tolerance)));
    int failing = 0;
    for (int i = 0; i < samples; ++i)
    {
      failing += BoundSlack * error[i] > goal.Tolerance * margin * margin * (1.0 + 1e-9);
    }
    const double cells =
      (bothDirections ? margin * margin : margin) * (1.0 + FailureCost * failing / samples);
    if (cells < least)
    {
      least = cells;
      best = margin;
    }
  }
  return best;
}

double SurfaceTree::Parameter(int dir, LineCode code) const
{
  const std::vector<double>& lines = this->Line[dir].At;
  const std::size_t k = std::size_t(code >> FractionBits);
  const LineCode fraction = code & (One - 1);
  return fraction == 0 ? lines[k]
                       : lines[k] + (lines[k + 1] - lines[k]) * (double(fraction) / double(One));
}

ParameterBox SurfaceTree::BoxOf(const Range& r) const
{
  return { this->Parameter(0, r.U0), this->Parameter(0, r.U1), this->Parameter(1, r.V0),
    this->Parameter(1, r.V1) };
}

LineCode SurfaceTree::SplitCode(int dir, LineCode low, LineCode high, bool halves) const
{
  const LineCode first = (low + One - 1) >> FractionBits;
  const LineCode last = high >> FractionBits;
  if (last - first >= 2)
  {
    // Crease lines first, then the line that halves the demand.
    const std::vector<double>& demand = this->Line[dir].Demand;
    const double middle = 0.5 * (demand[first] + demand[last]);
    auto at = std::lower_bound(demand.begin() + first, demand.begin() + last, middle);
    LineCode best = at - demand.begin();
    if (best - 1 > first && middle - demand[best - 1] < demand[best] - middle)
    {
      --best;
    }
    if (demand[last] - demand[first] <= 0.0)
    {
      best = (first + last) / 2;
    }
    if (halves)
    {
      const std::vector<double>& lines = this->Line[dir].At;
      const double t = 0.5 * (lines[first] + lines[last]);
      best = std::lower_bound(lines.begin(), lines.end(), t) - lines.begin();
    }
    best = std::min(last - 1, std::max(first + 1, best));
    LineCode crease = -1;
    for (LineCode k = first + 1; k < last; ++k)
    {
      if (this->IsCrease[dir][k] && (crease < 0 || std::abs(k - best) < std::abs(crease - best)))
      {
        crease = k;
      }
    }
    return (crease >= 0 ? crease : best) << FractionBits;
  }
  return high - low >= 2 ? low + (high - low) / 2 : low;
}

// A part of the tree under construction; parts are built independently and joined in order.
struct SurfaceTree::Subtree
{
  std::vector<Node> Nodes;
  std::vector<TreeLeaf> Leaves;
  bool Capped = false;
};

struct SurfaceTree::Work
{
  const SurfaceTree& Tree;
  const SurfaceBound& Bound;
  const TreeGoal& Goal;
  std::int64_t MaximumLeaves;
  Subtree& Out;
  CellError Cell;

  Work(const SurfaceTree& tree, const SurfaceBound& bound, const TreeGoal& goal,
    std::int64_t maximumLeaves, Subtree& out)
    : Tree(tree)
    , Bound(bound)
    , Goal(goal)
    , MaximumLeaves(maximumLeaves)
    , Out(out)
    , Cell(bound, goal)
  {}

  bool CreaseInside(int dir, LineCode low, LineCode high) const
  {
    const LineCode first = (low >> FractionBits) + 1;
    const LineCode last = (high + One - 1) >> FractionBits;
    const auto& crease = this->Tree.IsCrease[dir];
    return first < last &&
      std::find(crease.begin() + first, crease.begin() + last, 1) != crease.begin() + last;
  }

  // A range as a leaf, good enough or not.
  TreeLeaf Measure(const Range& r)
  {
    TreeLeaf leaf;
    leaf.U0 = r.U0;
    leaf.U1 = r.U1;
    leaf.V0 = r.V0;
    leaf.V1 = r.V1;
    leaf.Box = this->Tree.BoxOf(r);
    this->Cell.Examine(leaf);
    return leaf;
  }

  // Children of a range; empty: the range is a leaf, whose data `leaf` receives.
  std::vector<Range> Divide(const Range& r, TreeLeaf& leaf)
  {
    const bool creaseU = this->CreaseInside(0, r.U0, r.U1);
    const bool creaseV = this->CreaseInside(1, r.V0, r.V1);
    int axis = creaseU ? 0 : 1;
    if (!creaseU && !creaseV)
    {
      leaf.U0 = r.U0;
      leaf.U1 = r.U1;
      leaf.V0 = r.V0;
      leaf.V1 = r.V1;
      leaf.Box = this->Tree.BoxOf(r);
      axis = this->Cell.Examine(leaf);
      if (axis >= 0 && std::int64_t(this->Out.Leaves.size()) >= this->MaximumLeaves)
      {
        this->Out.Capped = true;
        axis = -1;
      }
      if (axis < 0)
      {
        return {};
      }
    }
    const bool halves = this->Goal.Method != SubdivisionMethod::KdTree;
    LineCode u = this->Tree.SplitCode(0, r.U0, r.U1, halves);
    LineCode v = this->Tree.SplitCode(1, r.V0, r.V1, halves);
    if (this->Goal.Method == SubdivisionMethod::QuadTree && u != r.U0 && v != r.V0 && !creaseU &&
      !creaseV)
    {
      return { { r.U0, u, r.V0, v }, { u, r.U1, r.V0, v }, { r.U0, u, v, r.V1 },
        { u, r.U1, v, r.V1 } };
    }
    if ((axis == 0 ? u == r.U0 : v == r.V0) && !creaseU && !creaseV)
    {
      axis = 1 - axis;
    }
    if (axis == 0 && u != r.U0)
    {
      return { { r.U0, u, r.V0, r.V1 }, { u, r.U1, r.V0, r.V1 } };
    }
    if (axis == 1 && v != r.V0)
    {
      return { { r.U0, r.U1, r.V0, v }, { r.U0, r.U1, v, r.V1 } };
    }
    return {};
  }

  void Build(int node, const Range& r)
  {
    const ParameterBox box = this->Tree.BoxOf(r);
    TreeLeaf leaf;
    const std::vector<Range> children = this->Divide(r, leaf);
    this->Out.Nodes[node].Box = box;
    if (children.empty())
    {
      this->Out.Nodes[node].First = -1;
      this->Out.Nodes[node].Count = int(this->Out.Leaves.size());
      this->Out.Leaves.push_back(leaf);
      return;
    }
    const int first = int(this->Out.Nodes.size());
    this->Out.Nodes[node].First = first;
    this->Out.Nodes[node].Count = int(children.size());
    this->Out.Nodes.resize(first + children.size());
    for (std::size_t c = 0; c < children.size(); ++c)
    {
      this->Build(first + int(c), children[c]);
    }
  }
};

void SurfaceTree::Build(SurfaceBound& bound, const ParameterBox& domain, const TreeGoal& goal,
  const ParallelFor& parallel)
{
  this->Parallel = parallel;
  this->MakeLines(bound, domain, goal);
  bound.MakeGrid(this->Line[0].At, this->Line[1].At, parallel);
  this->Nodes.assign(1, Node());
  this->Cells.clear();
  this->Capped = false;
  const Range root{ 0, LineCode(this->Line[0].At.size() - 1) << FractionBits, 0,
    LineCode(this->Line[1].At.size() - 1) << FractionBits };

  // Step 1: the upper levels in breadth-first order, until there are enough parts to share out.
  const bool large = (this->Line[0].At.size() - 1) * (this->Line[1].At.size() - 1) > 4000;
  struct Part
  {
    int Node;
    Range Where;
  };
  std::vector<Part> parts{ { 0, root } };
  Subtree unused;
  Work top(*this, bound, goal, goal.MaximumLeaves, unused);
  while (large && !parts.empty() && parts.size() < 128)
  {
    std::vector<Part> next;
    for (const Part& part : parts)
    {
      const ParameterBox box = this->BoxOf(part.Where);
      this->Nodes[part.Node].Box = box;
      TreeLeaf leaf;
      const std::vector<Range> children = top.Divide(part.Where, leaf);
      if (children.empty())
      {
        next.push_back(part);
        continue;
      }
      const int first = int(this->Nodes.size());
      this->Nodes[part.Node].First = first;
      this->Nodes[part.Node].Count = int(children.size());
      this->Nodes.resize(first + children.size());
      for (std::size_t c = 0; c < children.size(); ++c)
      {
        next.push_back({ first + int(c), children[c] });
      }
    }
    const bool grew = next.size() > parts.size();
    parts.swap(next);
    if (!grew)
    {
      break;
    }
  }

  // Step 2: every part for itself.
  std::vector<Subtree> trees(parts.size());
  const std::int64_t limit =
    std::max<std::int64_t>(1, goal.MaximumLeaves / std::int64_t(parts.size()));
  parallel(0, std::int64_t(parts.size()), [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k)
    {
      trees[k].Nodes.resize(1);
      Work work(*this, bound, goal, limit, trees[k]);
      work.Build(0, parts[k].Where);
    }
  });

  // Step 3: join them in order.
  for (std::size_t k = 0; k < parts.size(); ++k)
  {
    const int shift = int(this->Nodes.size()) - 1;
    const int leafShift = int(this->Cells.size());
    for (std::size_t i = 0; i < trees[k].Nodes.size(); ++i)
    {
      Node node = trees[k].Nodes[i];
      if (node.First < 0)
      {
        node.Count += leafShift;
      }
      else
      {
        node.First += shift;
      }
      if (i == 0)
      {
        this->Nodes[parts[k].Node] = node;
      }
      else
      {
        this->Nodes.push_back(node);
      }
    }
    this->Cells.insert(this->Cells.end(), trees[k].Leaves.begin(), trees[k].Leaves.end());
    this->Capped = this->Capped || trees[k].Capped;
    trees[k] = Subtree();
  }
}

void SurfaceTree::Refine(const SurfaceBound& bound, const TreeGoal& goal, std::vector<int> leaves)
{
  std::sort(leaves.begin(), leaves.end());
  leaves.erase(std::unique(leaves.begin(), leaves.end()), leaves.end());
  std::vector<int> nodeOf(this->Cells.size(), -1);
  for (std::size_t n = 0; n < this->Nodes.size(); ++n)
  {
    if (this->Nodes[n].First < 0)
    {
      nodeOf[this->Nodes[n].Count] = int(n);
    }
  }
  Subtree unused;
  Work work(*this, bound, goal, goal.MaximumLeaves, unused);
  for (int k : leaves)
  {
    const TreeLeaf old = this->Cells[k];
    const Range r{ old.U0, old.U1, old.V0, old.V1 };
    const LineCode u = this->SplitCode(0, r.U0, r.U1, false);
    const LineCode v = this->SplitCode(1, r.V0, r.V1, false);
    const bool alongU = u != r.U0 && (old.Axis == 0 || v == r.V0);
    if (!alongU && v == r.V0)
    {
      continue;
    }
    const Range halves[2] = { { r.U0, alongU ? u : r.U1, r.V0, alongU ? r.V1 : v },
      { alongU ? u : r.U0, r.U1, alongU ? r.V0 : v, r.V1 } };
    const int first = int(this->Nodes.size());
    this->Nodes[nodeOf[k]].First = first;
    this->Nodes[nodeOf[k]].Count = 2;
    for (int half = 0; half < 2; ++half)
    {
      Node node;
      node.Box = this->BoxOf(halves[half]);
      node.Count = half == 0 ? k : int(this->Cells.size());
      this->Nodes.push_back(node);
      const TreeLeaf leaf = work.Measure(halves[half]);
      if (half == 0)
      {
        this->Cells[k] = leaf;
      }
      else
      {
        this->Cells.push_back(leaf);
      }
    }
  }
}

bool SegmentTouchesBox(const Vec2& a, const Vec2& b, const ParameterBox& box)
{
  if (std::max(a[0], b[0]) < box.U0 || std::min(a[0], b[0]) > box.U1 ||
    std::max(a[1], b[1]) < box.V0 || std::min(a[1], b[1]) > box.V1)
  {
    return false;
  }
  // Separating axis: the segment's own normal.
  const Vec2 d = b - a;
  const Vec2 middle(0.5 * (box.U0 + box.U1), 0.5 * (box.V0 + box.V1));
  const double distance = std::abs(d[0] * (middle[1] - a[1]) - d[1] * (middle[0] - a[0]));
  return distance <= 0.5 * (std::abs(d[0]) * box.B() + std::abs(d[1]) * box.A());
}

} // namespace nurbs
