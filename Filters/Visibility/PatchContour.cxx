// SPDX-License-Identifier: BSD-3-Clause
#include "PatchContour.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace nurbs
{

namespace
{

// Cells are split beside their middle: shapes are often symmetric, and contours then run through or
// along the middle.
constexpr double SplitPlaces[2] = { 0.4861, 0.5317 };
constexpr int MaxChordDepth = 30;
constexpr std::size_t MaxSingularPoints = 16;
constexpr double SmallestStep = 1e-12; // Of a patch's parameter.
constexpr double StraightWay = 1e-9;   // Of the one parameter against the other.

struct Cell
{
  double Range[2][2] = { { 0.0, 1.0 }, { 0.0, 1.0 } }; ///< Direction; low, high.
  BernsteinForm G;
  int Depth = 0;

  double Width(int dir) const { return this->Range[dir][1] - this->Range[dir][0]; }
};

ContourPoint MakePoint(const BezierPatch& patch, const Vec2& st, const ContourValue& value)
{
  return { Vec2(patch.U.Min + st[0] * patch.U.Length(), patch.V.Min + st[1] * patch.V.Length()),
    value.Point, value.Cosine };
}

// -1, 0 (both), 1: the sign of all coefficients.
int SignOf(const BernsteinForm& g)
{
  bool negative = false;
  bool positive = false;
  for (const double c : g.Coefficients)
  {
    (c < 0.0 ? negative : positive) = true;
    if (negative && positive)
    {
      return 0;
    }
  }
  return positive ? 1 : -1;
}

// What the differences in direction `dir`, that is the derivative, have in common.
struct Slope
{
  int Sign = 0;       ///< 0: not the same, or one of them could be rounding.
  double Least = 0.0; ///< Smallest magnitude.
};

Slope SlopeOf(const BernsteinForm& g, int dir, double rounding)
{
  const int width = g.Degree[0] + 1;
  const int step = dir == 0 ? 1 : width;
  Slope out;
  for (int j = 0; j <= g.Degree[1] - (dir == 1); ++j)
  {
    for (int i = 0; i <= g.Degree[0] - (dir == 0); ++i)
    {
      const int k = i + j * width;
      const double d = g.Coefficients[k + step] - g.Coefficients[k];
      const int sign = d > rounding ? 1 : (d < -rounding ? -1 : 0);
      if (sign == 0 || (out.Sign != 0 && sign != out.Sign))
      {
        return Slope();
      }
      out.Least = out.Sign == 0 ? std::abs(d) : std::min(out.Least, std::abs(d));
      out.Sign = sign;
    }
  }
  return out;
}

// Largest second difference: what keeps the slope from having one sign.
double Bend(const BernsteinForm& g, int dir)
{
  const int width = g.Degree[0] + 1;
  const int step = dir == 0 ? 1 : width;
  double largest = 0.0;
  for (int j = 0; j <= g.Degree[1] - 2 * (dir == 1); ++j)
  {
    for (int i = 0; i <= g.Degree[0] - 2 * (dir == 0); ++i)
    {
      const double* c = g.Coefficients.data() + i + j * width;
      largest = std::max(largest, std::abs(c[0] - 2.0 * c[step] + c[2 * step]));
    }
  }
  return largest;
}

} // namespace

double DistanceToSegment(const Vec3& p, const Vec3& a, const Vec3& b)
{
  const Vec3 ab = b - a;
  const double length = ab.squaredNorm();
  const double t = length > 0.0 ? std::min(1.0, std::max(0.0, (p - a).dot(ab) / length)) : 0.0;
  return (p - a - t * ab).norm();
}

ContourLine& SideLine(PatchContour& patch, int dir, int end)
{
  std::shared_ptr<ContourLine>& line = patch.Sides[dir][end];
  if (!line)
  {
    line = std::make_shared<ContourLine>();
    std::vector<double> c = patch.G.OnLine(dir, end);
    for (double& x : c)
    {
      x += patch.Rounding;
    }
    line->At = SignChanges(c);
    line->Node.assign(line->At.size(), -1);
  }
  return *line;
}

int LineNode(const PatchContour& patch, const Viewer& viewer, ContourLine& line, int dir, double at,
  std::size_t k, std::vector<ContourPoint>& nodes)
{
  if (line.Node[k] >= 0)
  {
    return line.Node[k];
  }
  // Newton's method along the line, on the surface itself; not far from where the polynomial's root
  // is, and not where the side itself belongs to the contour.
  constexpr double Reach = 1e-4;
  const double start = line.At[k];
  const int along = 1 - dir;
  const auto evaluate = [&](double t) {
    return EvaluateContour(*patch.Patch, viewer, dir == 0 ? at : t, dir == 0 ? t : at);
  };
  double best = start;
  const int end = at == 1.0 ? 1 : 0;
  const bool side = at == 0.0 || at == 1.0;
  ContourValue value = evaluate(start);
  if (!side || !(patch.IsPole[dir][end] || patch.IsZero[dir][end]))
  {
    double t = start;
    ContourValue next = value;
    for (int i = 0; i < 12 && std::abs(value.Cosine) > 1e-15 && next.Gradient[along] != 0.0; ++i)
    {
      t -= next.Cosine / next.Gradient[along];
      if (!(std::abs(t - start) <= Reach && t >= 0.0 && t <= 1.0))
      {
        break;
      }
      next = evaluate(t);
      if (!(std::abs(next.Cosine) < std::abs(value.Cosine)))
      {
        break;
      }
      value = next;
      best = t;
    }
  }
  value.Cosine = side && patch.IsPole[dir][end] ? 0.0 : value.Cosine;
  line.At[k] = best;
  line.Node[k] = static_cast<int>(nodes.size());
  nodes.push_back(MakePoint(*patch.Patch, dir == 0 ? Vec2(at, best) : Vec2(best, at), value));
  return line.Node[k];
}

namespace
{

// A node on a cell's side.
struct SideNode
{
  int Node;
  Vec2 ST; ///< In the patch's parameters.
};

class Tracer
{
public:
  Tracer(PatchContour& patch, const Viewer& viewer, const ContourLimits& limits,
    std::vector<ContourPoint>& nodes, std::vector<ContourArc>& arcs)
    : Source(patch)
    , View(viewer)
    , Limits(limits)
    , Nodes(nodes)
    , Arcs(arcs)
  {}

  void Run();

private:
  bool Finish(const Cell& cell);
  bool IsSmall(const Cell& cell) const;
  void Divide(const Cell& cell);
  void FinishMonotone(const Cell& cell, const Slope (&slopes)[2]);
  void FinishSingular(const Cell& cell);
  bool IsTouching(const ContourArc& arc) const;
  void AddArc(const Cell& cell, ContourArc arc);
  void NoteSingular(const Cell& cell);
  std::vector<SideNode> NodesOf(const Cell& cell);
  void AddSide(const Cell& cell, int dir, int end, bool backwards, std::vector<SideNode>& out);
  ContourLine& LineAt(int dir, double at);
  ContourPoint Solve(
    const Cell& cell, int slopeDir, int slope, double x, double guess, double* found);
  void Trace(const Cell& cell, const Slope (&slopes)[2], const SideNode& a, const SideNode& b,
    std::vector<ContourPoint>& out);

  PatchContour& Source;
  const Viewer& View;
  const ContourLimits& Limits;
  std::vector<ContourPoint>& Nodes;
  std::vector<ContourArc>& Arcs;
  BernsteinForm Whole; ///< G + Rounding.
  std::map<std::pair<int, double>, ContourLine> Lines;
  std::deque<Cell> Queue;
};

void Tracer::Run()
{
  Cell first;
  first.G = this->Source.G;
  for (double& c : first.G.Coefficients)
  {
    c += this->Source.Rounding;
  }
  this->Whole = first.G;
  this->Queue.push_back(std::move(first));
  int cells = 0;
  while (!this->Queue.empty())
  {
    const Cell cell = std::move(this->Queue.front());
    this->Queue.pop_front();
    if (this->Finish(cell))
    {
      continue;
    }
    const bool capped = ++cells > this->Limits.MaximumCells;
    if (capped || this->IsSmall(cell))
    {
      ++(capped ? this->Source.UnresolvedCells : this->Source.SingularCells);
      this->FinishSingular(cell);
    }
    else
    {
      this->Divide(cell);
    }
  }
}

// True if the cell needs no division.
bool Tracer::Finish(const Cell& cell)
{
  const int sign = SignOf(cell.G);
  if (sign != 0)
  {
    (sign > 0 ? this->Source.HasFront : this->Source.HasBack) = true;
    return true;
  }
  const Slope slopes[2] = { SlopeOf(cell.G, 0, this->Source.Rounding),
    SlopeOf(cell.G, 1, this->Source.Rounding) };
  if (slopes[0].Sign == 0 && slopes[1].Sign == 0)
  {
    return false;
  }
  this->Source.HasFront = this->Source.HasBack = true;
  this->FinishMonotone(cell, slopes);
  return true;
}

bool Tracer::IsSmall(const Cell& cell) const
{
  if (cell.Width(0) < SmallestStep || cell.Width(1) < SmallestStep)
  {
    return true;
  }
  if (cell.Depth < 6)
  {
    return false;
  }
  if (cell.G.Magnitude() <= ContourZero * this->Source.Scale)
  {
    return true; // Edge-on.
  }
  const auto corner = [&](int i, int j) {
    return EvaluatePatch(*this->Source.Patch, cell.Range[0][i], cell.Range[1][j]);
  };
  const Vec3 c[4] = { corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1) };
  double size = std::max((c[2] - c[0]).norm(), (c[3] - c[1]).norm());
  for (int k = 0; k < 4 && size <= this->Limits.Smallest; ++k)
  {
    size = std::max(size, (c[k] - c[(k + 1) % 4]).norm());
  }
  return size <= this->Limits.Smallest;
}

void Tracer::Divide(const Cell& cell)
{
  const double bends[2] = { Bend(cell.G, 0), Bend(cell.G, 1) };
  int dir = bends[0] > bends[1] || (bends[0] == bends[1] && cell.Width(0) >= cell.Width(1)) ? 0 : 1;
  constexpr double MostUneven = 8.0;
  if (cell.Width(1 - dir) > MostUneven * cell.Width(dir))
  {
    dir = 1 - dir;
  }
  const double share = SplitPlaces[cell.Depth % 2];
  Cell low, high;
  low.Depth = high.Depth = cell.Depth + 1;
  std::copy(&cell.Range[0][0], &cell.Range[0][0] + 4, &low.Range[0][0]);
  std::copy(&cell.Range[0][0], &cell.Range[0][0] + 4, &high.Range[0][0]);
  const double middle = cell.Range[dir][0] + share * cell.Width(dir);
  low.Range[dir][1] = high.Range[dir][0] = middle;
  Split(cell.G, dir, share, low.G, high.G);
  this->Queue.push_back(std::move(low));
  this->Queue.push_back(std::move(high));
}

ContourLine& Tracer::LineAt(int dir, double at)
{
  if (at == 0.0 || at == 1.0)
  {
    return SideLine(this->Source, dir, at == 1.0 ? 1 : 0);
  }
  const auto found = this->Lines.find({ dir, at });
  if (found != this->Lines.end())
  {
    return found->second;
  }
  ContourLine& line = this->Lines[{ dir, at }];
  line.At = SignChanges(this->Whole.OnLine(dir, at));
  line.Node.assign(line.At.size(), -1);
  return line;
}

void Tracer::AddSide(const Cell& cell, int dir, int end, bool backwards, std::vector<SideNode>& out)
{
  const double at = cell.Range[dir][end];
  const double* range = cell.Range[1 - dir];
  ContourLine& line = this->LineAt(dir, at);
  const std::size_t first = out.size();
  for (std::size_t k = 0; k < line.At.size(); ++k)
  {
    if (line.At[k] >= range[0] && (line.At[k] < range[1] || (range[1] == 1.0 && line.At[k] == 1.0)))
    {
      const int node = LineNode(this->Source, this->View, line, dir, at, k, this->Nodes);
      const double t = line.At[k];
      out.push_back({ node, dir == 0 ? Vec2(at, t) : Vec2(t, at) });
    }
  }
  if (backwards)
  {
    std::reverse(out.begin() + first, out.end());
  }
}

// The nodes on the sides, counter-clockwise from the low corner.
std::vector<SideNode> Tracer::NodesOf(const Cell& cell)
{
  std::vector<SideNode> out;
  this->AddSide(cell, 1, 0, false, out);
  this->AddSide(cell, 0, 1, false, out);
  this->AddSide(cell, 1, 1, true, out);
  this->AddSide(cell, 0, 0, true, out);
  return out;
}

// The point of the contour where the other parameter is x: by Newton's method within the cell.
ContourPoint Tracer::Solve(
  const Cell& cell, int slopeDir, int slope, double x, double guess, double* found)
{
  double low = cell.Range[slopeDir][0];
  double high = cell.Range[slopeDir][1];
  double t = std::min(high, std::max(low, guess));
  double best = t;
  ContourValue bestValue;
  bestValue.Cosine = 2.0;
  for (int k = 0; k < 80; ++k)
  {
    const ContourValue value = EvaluateContour(
      *this->Source.Patch, this->View, slopeDir == 0 ? t : x, slopeDir == 0 ? x : t);
    if (std::abs(value.Cosine) < std::abs(bestValue.Cosine))
    {
      bestValue = value;
      best = t;
    }
    if (std::abs(value.Cosine) < 1e-15)
    {
      break;
    }
    (value.Cosine * slope < 0.0 ? low : high) = t;
    const double steep = value.Gradient[slopeDir];
    double next = steep * slope > 0.0 ? t - value.Cosine / steep : 0.5 * (low + high);
    const bool inside = next > low && next < high;
    if (inside && std::abs(next - t) <= 2e-16)
    {
      break;
    }
    next = inside ? next : 0.5 * (low + high);
    if (next == t || !(high - low > 1e-16))
    {
      break;
    }
    t = next;
  }
  *found = best;
  return MakePoint(*this->Source.Patch, slopeDir == 0 ? Vec2(best, x) : Vec2(x, best), bestValue);
}

// The points between two nodes that one branch joins.
void Tracer::Trace(const Cell& cell, const Slope (&slopes)[2], const SideNode& a, const SideNode& b,
  std::vector<ContourPoint>& out)
{
  // Of two parameters that both can lead, the one that changes more: the contour is less steep.
  const bool both = slopes[0].Sign != 0 && slopes[1].Sign != 0;
  const Vec2 way = (b.ST - a.ST).cwiseAbs();
  const int slopeDir = both ? (way[1] > way[0] ? 0 : 1) : (slopes[1].Sign != 0 ? 1 : 0);
  const int slope = slopes[slopeDir].Sign;
  const int lead = 1 - slopeDir;
  const double length = (this->Nodes[a.Node].Point - this->Nodes[b.Node].Point).norm();
  if (way[lead] <= StraightWay || length <= this->Limits.Smallest)
  {
    // One value of what should lead, to rounding, along a ruling of a cone for example, where the other
    // parameter would be found anywhere.
    const auto straight = [&](double t) {
      const Vec2 st = a.ST + t * (b.ST - a.ST);
      return MakePoint(
        *this->Source.Patch, st, EvaluateContour(*this->Source.Patch, this->View, st[0], st[1]));
    };
    RefineChord(straight, this->Limits.Precision, 0.0, this->Nodes[a.Node], 1.0,
      this->Nodes[b.Node], MaxChordDepth, out);
    return;
  }
  // Known points of the branch, for guesses.
  std::map<double, double> known{ { 0.0, a.ST[slopeDir] }, { 1.0, b.ST[slopeDir] } };
  const auto at = [&](double t) {
    const auto above = known.lower_bound(t);
    const auto below = std::prev(above);
    const double part = (t - below->first) / (above->first - below->first);
    const double guess = below->second + part * (above->second - below->second);
    double found = guess;
    const ContourPoint point =
      this->Solve(cell, slopeDir, slope, a.ST[lead] + t * (b.ST[lead] - a.ST[lead]), guess, &found);
    known.emplace(t, found);
    return point;
  };
  RefineChord(at, this->Limits.Precision, 0.0, this->Nodes[a.Node], 1.0, this->Nodes[b.Node],
    MaxChordDepth, out);
}

void Tracer::FinishMonotone(const Cell& cell, const Slope (&slopes)[2])
{
  std::vector<SideNode> ends = this->NodesOf(cell);
  const int slopeDir = slopes[1].Least >= slopes[0].Least ? 1 : 0;
  const int slope = slopes[slopeDir].Sign;
  const int lead = 1 - slopeDir;
  std::stable_sort(ends.begin(), ends.end(),
    [lead](const SideNode& a, const SideNode& b) { return a.ST[lead] < b.ST[lead]; });
  const bool forward = (slope > 0) == (lead == 0);
  for (std::size_t k = 0; k + 1 < ends.size(); k += 2)
  {
    if (ends[k].Node == ends[k + 1].Node)
    {
      continue;
    }
    ContourArc arc;
    this->Trace(cell, slopes, ends[k], ends[k + 1], arc.Inner);
    arc.Start = ends[k].Node;
    arc.End = ends[k + 1].Node;
    if (!forward)
    {
      std::swap(arc.Start, arc.End);
      std::reverse(arc.Inner.begin(), arc.Inner.end());
    }
    this->AddArc(cell, std::move(arc));
  }
}

// True if normal . view has the same sign on both sides of an arc, as far as it can be told from 0: a
// surface that is seen edge-on along a curve, but does not turn away there.
bool Tracer::IsTouching(const ContourArc& arc) const
{
  const BezierPatch& patch = *this->Source.Patch;
  const Vec2 uv = arc.Inner.empty()
    ? Vec2(0.5 * (this->Nodes[arc.Start].UV + this->Nodes[arc.End].UV))
    : arc.Inner[arc.Inner.size() / 2].UV;
  Vec2 st((uv[0] - patch.U.Min) / patch.U.Length(), (uv[1] - patch.V.Min) / patch.V.Length());
  const auto evaluate = [&](const Vec2& p) {
    return EvaluateContour(
      patch, this->View, std::min(1.0, std::max(0.0, p[0])), std::min(1.0, std::max(0.0, p[1])));
  };
  // The middle of a chord is not on the contour itself.
  constexpr double Steep = 1e-5;
  ContourValue value = evaluate(st);
  for (int k = 0; k < 40 && std::abs(value.Cosine) > 1e-16; ++k)
  {
    const double steep = value.Gradient.norm();
    if (steep > Steep || !(steep > 0.0))
    {
      return false;
    }
    const double step = std::min(0.05, std::abs(value.Cosine) / steep);
    st -= std::copysign(step, value.Cosine) / steep * value.Gradient;
    value = evaluate(st);
  }
  if (value.Gradient.norm() > Steep)
  {
    return false;
  }
  const Vec2 way = (this->Nodes[arc.End].UV - this->Nodes[arc.Start].UV)
                     .cwiseQuotient(Vec2(patch.U.Length(), patch.V.Length()));
  const Vec2 aside = value.Gradient.norm() > 1e-9 ? Vec2(value.Gradient.normalized())
                                                  : Vec2(-way[1], way[0]).normalized();
  for (double h = 1e-6; h < 0.1; h *= 4.0)
  {
    const double low = evaluate(st - h * aside).Cosine;
    const double high = evaluate(st + h * aside).Cosine;
    if (std::min(std::abs(low), std::abs(high)) > ContourCosine)
    {
      return low * high > 0.0;
    }
  }
  return true;
}

// Adds an arc if some point of it belongs to the contour.
void Tracer::AddArc(const Cell& cell, ContourArc arc)
{
  const auto isExact = [](const ContourPoint& p) { return std::abs(p.Cosine) <= ContourCosine; };
  const bool exact = isExact(this->Nodes[arc.Start]) || isExact(this->Nodes[arc.End]) ||
    std::any_of(arc.Inner.begin(), arc.Inner.end(), isExact);
  if (exact && !this->IsTouching(arc))
  {
    this->Arcs.push_back(std::move(arc));
    return;
  }
  if (!exact &&
    (this->Nodes[arc.Start].Point - this->Nodes[arc.End].Point).norm() > this->Limits.Smallest)
  {
    ++this->Source.SingularCells;
    this->NoteSingular(cell);
  }
}

void Tracer::NoteSingular(const Cell& cell)
{
  if (this->Source.Singular.size() < MaxSingularPoints)
  {
    const Vec2 st(
      0.5 * (cell.Range[0][0] + cell.Range[0][1]), 0.5 * (cell.Range[1][0] + cell.Range[1][1]));
    this->Source.Singular.push_back(MakePoint(
      *this->Source.Patch, st, EvaluateContour(*this->Source.Patch, this->View, st[0], st[1])));
  }
}

// Joins the nodes on the sides of a cell that is not divided further: where g becomes negative on the way around, a
// branch enters; it leaves where g becomes positive again.
void Tracer::FinishSingular(const Cell& cell)
{
  this->NoteSingular(cell);
  const std::vector<SideNode> ends = this->NodesOf(cell);
  const std::size_t first = cell.G.Coefficients[0] < 0.0 ? 1 : 0;
  for (std::size_t k = first; k < ends.size() && ends.size() > 1; k += 2)
  {
    const SideNode& leaving = ends[(k + 1) % ends.size()];
    if (ends[k].Node != leaving.Node)
    {
      ContourArc arc;
      arc.Start = ends[k].Node;
      arc.End = leaving.Node;
      this->AddArc(cell, std::move(arc));
    }
  }
}

} // namespace

void TracePatch(PatchContour& patch, const Viewer& viewer, const ContourLimits& limits,
  std::vector<ContourPoint>& nodes, std::vector<ContourArc>& arcs)
{
  Tracer(patch, viewer, limits, nodes, arcs).Run();
}

} // namespace nurbs
