// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceTree.h"

#include "CellError.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{
constexpr int FractionBits = 20;
constexpr double EvenShare = 0.75;  // Mean demand over greatest demand from which on lines fit all.
constexpr double BoundSlack = 1.02; // By how much bounds exceed the sampled error, typically.
constexpr std::size_t FewSpans = 16; // Fewer are sampled too thinly to tell.
constexpr LineCode One = LineCode(1) << FractionBits;

// Segments that a parameter interval wants: the square root of deviation over tolerance for one
// chord, sampled inside the knot spans of both directions.
struct DemandSamples
{
  std::vector<double> At;     // Sample boundaries, ascending: cell k is [At[k], At[k+1]].
  std::vector<double> Wanted; // Segments wanted in cell k, where it wants most.
  std::vector<double> Mean;   // On average across the other direction.
};

int SamplesOfSpan(int degree, std::size_t spans)
{
  const int wish = degree == 1 ? 1 : (degree <= 3 ? 3 : degree);
  return spans > 24 ? std::min(wish, 2) : wish;
}

std::vector<double> SpanBreaks(KnotView knots, int degree, double low, double high)
{
  std::vector<double> breaks{ low };
  // Spans of no width to speak of at the ends are noise of CAD kernels; they would make slivers.
  const double eps = NegligibleSpan * (high - low);
  for (const Knot& knot : DistinctKnots(knots, degree))
  {
    if (knot.Value > low + eps && knot.Value < high - eps)
    {
      breaks.push_back(knot.Value);
    }
  }
  breaks.push_back(high);
  return breaks;
}

DemandSamples MakeCells(const std::vector<double>& breaks, int degree)
{
  DemandSamples s;
  const int n = SamplesOfSpan(degree, breaks.size() - 1);
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k)
  {
    for (int i = 0; i < n; ++i)
    {
      s.At.push_back(breaks[k] + (breaks[k + 1] - breaks[k]) * i / n);
    }
  }
  s.At.push_back(breaks.back());
  s.Wanted.assign(s.At.size() - 1, 0.0);
  s.Mean = s.Wanted;
  return s;
}

// Sample positions in a direction for the *other* direction's demand: cell middles, and both ends
// where the surface is linear there (a cone is widest at one end).
std::vector<double> Positions(const DemandSamples& s, int degree)
{
  std::vector<double> at;
  if (degree == 1 && s.At.size() == 2)
  {
    const double a = s.At.front();
    const double b = s.At.back();
    return { a + 0.02 * (b - a), b - 0.02 * (b - a) };
  }
  for (std::size_t k = 0; k + 1 < s.At.size(); ++k)
  {
    at.push_back(0.5 * (s.At[k] + s.At[k + 1]));
  }
  return at;
}

void SampleDemand(const SurfaceBound& bound, double tolerance, DemandSamples& u, DemandSamples& v,
  const ParallelFor& parallel)
{
  const SurfaceView& surface = bound.View();
  const std::vector<double> us = Positions(u, surface.Degree[0]);
  const std::vector<double> vs = Positions(v, surface.Degree[1]);
  const auto cell = [](const DemandSamples& s, std::size_t sample, std::size_t samples) {
    return samples == s.Wanted.size() ? sample : std::size_t(0);
  };
  std::vector<double> wantU(us.size() * vs.size());
  std::vector<double> wantV(us.size() * vs.size());
  parallel(0, std::int64_t(vs.size()), [&](std::int64_t begin, std::int64_t end) {
    SurfaceEvaluator evaluator(bound.Evaluator());
    for (std::int64_t j = begin; j < end; ++j)
    {
      for (std::size_t i = 0; i < us.size(); ++i)
      {
        const SurfaceDerivatives d = evaluator.Derivatives(us[i], vs[j], 2);
        Vec3 n = d.Su.cross(d.Sv);
        const double length = n.norm();
        if (length > 1e-12 * d.Su.norm() * d.Sv.norm() && length > 0.0)
        {
          n /= length;
          wantU[i + j * us.size()] = std::sqrt(std::abs(n.dot(d.Suu)) / (8.0 * tolerance));
          wantV[i + j * us.size()] = std::sqrt(std::abs(n.dot(d.Svv)) / (8.0 * tolerance));
        }
      }
    }
  });
  for (std::size_t j = 0; j < vs.size(); ++j)
  {
    for (std::size_t i = 0; i < us.size(); ++i)
    {
      double& wu = u.Wanted[cell(u, i, us.size())];
      double& wv = v.Wanted[cell(v, j, vs.size())];
      wu = std::max(wu, wantU[i + j * us.size()]);
      wv = std::max(wv, wantV[i + j * us.size()]);
      u.Mean[cell(u, i, us.size())] += wantU[i + j * us.size()] / double(vs.size());
      v.Mean[cell(v, j, vs.size())] += wantV[i + j * us.size()] / double(us.size());
    }
  }
}

double Total(const DemandSamples& s)
{
  double total = 0.0;
  for (std::size_t k = 0; k < s.Wanted.size(); ++k)
  {
    total += s.Wanted[k] * (s.At[k + 1] - s.At[k]);
  }
  return total;
}

// True if the demand is much the same across the surface, so that lines all over it suit it; where
// it is not, halving spans where needed makes fewer cells.
bool IsEven(const DemandSamples& s)
{
  double most = 0.0;
  double mean = 0.0;
  for (std::size_t k = 0; k < s.Wanted.size(); ++k)
  {
    most += s.Wanted[k] * (s.At[k + 1] - s.At[k]);
    mean += s.Mean[k] * (s.At[k + 1] - s.At[k]);
  }
  return mean >= EvenShare * most;
}

// The deviations of both directions add up in a cell: they share the tolerance, half each (which
// minimises the number of cells) unless one direction needs less with a single segment.
void ShareTolerance(DemandSamples& u, DemandSamples& v)
{
  const double u2 = std::min(0.5, std::pow(Total(u), 2));
  const double v2 = std::min(0.5, std::pow(Total(v), 2));
  const double shareU = v2 < 0.5 ? 1.0 - v2 : (u2 < 0.5 ? u2 : 0.5);
  for (double& w : u.Wanted)
  {
    w /= std::sqrt(std::max(1e-12, shareU));
  }
  for (double& w : v.Wanted)
  {
    w /= std::sqrt(std::max(1e-12, 1.0 - shareU));
  }
}

// Lines of one direction: every stop, and between two of them the quantiles of the demand.
void PlaceLines(const std::vector<double>& stops, const DemandSamples& s, double margin, bool even,
  std::vector<double>& lines, std::vector<double>& demand)
{
  lines.assign(1, stops.front());
  demand.assign(1, 0.0);
  std::size_t cell = 0;
  for (std::size_t k = 0; k + 1 < stops.size(); ++k)
  {
    double total = 0.0;
    std::size_t end = cell;
    for (; end < s.Wanted.size() && s.At[end] < stops[k + 1]; ++end)
    {
      total += s.Wanted[end] * (s.At[end + 1] - s.At[end]);
    }
    const double start = demand.back();
    const int n = even ? std::min(20000, std::max(1, int(std::ceil(margin * total - 0.02)))) : 1;
    double done = 0.0;
    for (int m = 1; m < n; ++m)
    {
      const double target = total * m / n;
      while (cell + 1 < end && done + s.Wanted[cell] * (s.At[cell + 1] - s.At[cell]) < target)
      {
        done += s.Wanted[cell] * (s.At[cell + 1] - s.At[cell]);
        ++cell;
      }
      const double t = std::min(s.At[cell + 1], s.At[cell] + (target - done) / s.Wanted[cell]);
      if (t > lines.back())
      {
        lines.push_back(t);
        demand.push_back(start + target);
      }
    }
    lines.push_back(stops[k + 1]);
    demand.push_back(start + total);
    cell = end;
  }
}
} // namespace

void SurfaceTree::MakeLines(
  const SurfaceBound& bound, const ParameterBox& domain, const TreeGoal& goal)
{
  const SurfaceView& surface = bound.View();
  const double low[2] = { domain.U0, domain.V0 };
  const double high[2] = { domain.U1, domain.V1 };
  std::vector<double> breaks[2];
  std::vector<double> stops[2];
  for (int d = 0; d < 2; ++d)
  {
    breaks[d] = SpanBreaks(surface.Knots[d], surface.Degree[d], low[d], high[d]);
    this->Crease[d] = bound.Creases(d);
    stops[d] = this->Crease[d];
    stops[d].insert(stops[d].begin(), low[d]);
    stops[d].push_back(high[d]);
  }
  if (goal.Method == SubdivisionMethod::KdTree)
  {
    DemandSamples u = MakeCells(breaks[0], surface.Degree[0]);
    DemandSamples v = MakeCells(breaks[1], surface.Degree[1]);
    SampleDemand(bound, goal.Tolerance, u, v, this->Parallel);
    ShareTolerance(u, v);
    const bool evenU = breaks[0].size() <= FewSpans || IsEven(u);
    const bool evenV = breaks[1].size() <= FewSpans || IsEven(v);
    const auto place = [&](double margin) {
      PlaceLines(evenU ? stops[0] : breaks[0], u, margin, evenU, this->Line[0], this->Demand[0]);
      PlaceLines(evenV ? stops[1] : breaks[1], v, margin, evenV, this->Line[1], this->Demand[1]);
    };
    place(1.0);
    if (evenU || evenV)
    {
      place(this->BestMargin(bound, goal, evenU && evenV));
    }
  }
  else
  {
    for (int d = 0; d < 2; ++d)
    {
      this->Line[d] = stops[d];
      this->Demand[d].resize(this->Line[d].size());
      for (std::size_t k = 0; k < this->Line[d].size(); ++k)
      {
        this->Demand[d][k] = double(k);
      }
    }
  }
  for (int d = 0; d < 2; ++d)
  {
    this->IsCrease[d].assign(this->Line[d].size(), 0);
    for (double t : bound.Creases(d))
    {
      const auto at = std::lower_bound(this->Line[d].begin(), this->Line[d].end(), t);
      this->IsCrease[d][at - this->Line[d].begin()] = 1;
    }
  }
}

// The factor on the number of lines that makes the fewest cells: cells that miss the tolerance are
// halved, so that it pays to satisfy all but a few of them at once. Typical cells tell.
double SurfaceTree::BestMargin(
  const SurfaceBound& bound, const TreeGoal& goal, bool bothDirections) const
{
  constexpr int Samples = 16;
  CellError cell(bound, goal);
  double error[Samples];
  const std::size_t nu = this->Line[0].size() - 1;
  const std::size_t nv = this->Line[1].size() - 1;
  for (int k = 0; k < Samples; ++k)
  {
    const std::size_t i = std::size_t((k + 0.5) / Samples * nu);
    const std::size_t j = std::size_t((0.5 + (k * 5) % Samples) / Samples * nv);
    error[k] = cell.Sampled(
      { this->Line[0][i], this->Line[0][i + 1], this->Line[1][j], this->Line[1][j + 1] });
  }
  std::sort(error, error + Samples);
  double best = 1.0;
  double least = 1e300;
  for (int k = 0; k < Samples; ++k)
  {
    const double margin =
      std::min(2.0, std::max(0.8, std::sqrt(BoundSlack * error[k] / goal.Tolerance)));
    int failing = 0;
    for (double e : error)
    {
      failing += BoundSlack * e > goal.Tolerance * margin * margin * (1.0 + 1e-9);
    }
    const double cells =
      (bothDirections ? margin * margin : margin) * (1.0 + double(failing) / Samples);
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
  const std::vector<double>& lines = this->Line[dir];
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
    const std::vector<double>& demand = this->Demand[dir];
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
      const double t = 0.5 * (this->Line[dir][first] + this->Line[dir][last]);
      const auto& lines = this->Line[dir];
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

void SurfaceTree::Build(const SurfaceBound& bound, const ParameterBox& domain, const TreeGoal& goal,
  const ParallelFor& parallel)
{
  this->Parallel = parallel;
  this->MakeLines(bound, domain, goal);
  this->Nodes.assign(1, Node());
  this->Cells.clear();
  this->Capped = false;
  const Range root{ 0, LineCode(this->Line[0].size() - 1) << FractionBits, 0,
    LineCode(this->Line[1].size() - 1) << FractionBits };

  // Step 1: the upper levels in breadth-first order, until there are enough parts to share out.
  const bool large = (this->Line[0].size() - 1) * (this->Line[1].size() - 1) > 4000;
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
