// SPDX-License-Identifier: BSD-3-Clause
#include "CoincidentLines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace nurbs
{

namespace
{

// In tolerances: lines that only cross or touch, or a remainder between two copies, may be as long.
constexpr double Shortest = 4.0;
// Cells of the grid that segments are found by, across the box around the lines, at most.
constexpr double MostCells = 1024.0;

// A part of a segment of a line.
struct Step
{
  std::size_t Segment; // Of the line: from point Segment to the next one.
  double From, To;     // Shares of the segment.
  double Length;
  bool IsCopy;
};

class CopyFinder
{
public:
  CopyFinder(
    const std::vector<PlaneLine>& lines, const std::vector<char>& isVisible, double tolerance);

  /// What is left of a line.
  std::vector<PlaneLine> Rest(std::size_t line) const;

private:
  struct Segment
  {
    std::size_t Line;
    Vec2 From, To;
  };
  using Cell = std::array<std::int64_t, 2>;

  template <typename Visit>
  void ForCells(const Vec2& from, const Vec2& to, const Visit& visit) const;
  std::vector<Interval> Covered(std::size_t line, const Vec2& from, const Vec2& to) const;
  std::vector<Step> Steps(std::size_t line) const;

  const std::vector<PlaneLine>& Lines;
  const std::vector<char>& IsVisible;
  double Tolerance;
  double Size = 1.0; // Of a cell.
  std::vector<Segment> Segments;
  std::map<Cell, std::vector<std::size_t>> Cells;
};

// All cells that a segment comes within the tolerance of.
template <typename Visit>
void CopyFinder::ForCells(const Vec2& from, const Vec2& to, const Visit& visit) const
{
  const auto parts = std::max<std::int64_t>(1, std::llround((to - from).norm() / this->Size));
  for (std::int64_t k = 0; k < parts; ++k)
  {
    Box2 box(from + double(k) / double(parts) * (to - from));
    box.extend(from + double(k + 1) / double(parts) * (to - from));
    const Vec2 low = (box.min().array() - this->Tolerance) / this->Size;
    const Vec2 high = (box.max().array() + this->Tolerance) / this->Size;
    for (auto i = std::int64_t(std::floor(low[0])); double(i) <= high[0]; ++i)
    {
      for (auto j = std::int64_t(std::floor(low[1])); double(j) <= high[1]; ++j)
      {
        visit(Cell{ i, j });
      }
    }
  }
}

CopyFinder::CopyFinder(
  const std::vector<PlaneLine>& lines, const std::vector<char>& isVisible, double tolerance)
  : Lines(lines)
  , IsVisible(isVisible)
  , Tolerance(tolerance)
{
  Box2 box;
  for (std::size_t l = 0; l < lines.size(); ++l)
  {
    for (std::size_t k = 0; k < lines[l].Points.size(); ++k)
    {
      box.extend(lines[l].Points[k]);
      if (k > 0 && lines[l].Points[k] != lines[l].Points[k - 1])
      {
        this->Segments.push_back({ l, lines[l].Points[k - 1], lines[l].Points[k] });
      }
    }
  }
  if (this->Segments.empty())
  {
    return;
  }
  const double across = std::min(MostCells, std::sqrt(double(this->Segments.size())) + 1.0);
  this->Size = std::max(4.0 * tolerance, box.sizes().maxCoeff() / across);
  for (std::size_t s = 0; s < this->Segments.size(); ++s)
  {
    this->ForCells(this->Segments[s].From, this->Segments[s].To, [&](const Cell& cell) {
      std::vector<std::size_t>& found = this->Cells[cell];
      if (found.empty() || found.back() != s)
      {
        found.push_back(s);
      }
    });
  }
}

// Shares of a hidden line's segment that other lines draw, in order and apart.
std::vector<Interval> CopyFinder::Covered(std::size_t line, const Vec2& from, const Vec2& to) const
{
  const double length = (to - from).norm();
  const Vec2 along = (to - from) / length;
  const Vec2 across(-along[1], along[0]);
  std::vector<std::size_t> near;
  this->ForCells(from, to, [&](const Cell& cell) {
    const auto found = this->Cells.find(cell);
    if (found != this->Cells.end())
    {
      near.insert(near.end(), found->second.begin(), found->second.end());
    }
  });
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  std::vector<Interval> all;
  for (const std::size_t s : near)
  {
    const Segment& other = this->Segments[s];
    if (other.Line == line || (!this->IsVisible[other.Line] && other.Line > line))
    {
      continue;
    }
    // The other segment in this one's frame, over what both have.
    Vec2 a(along.dot(other.From - from), across.dot(other.From - from));
    Vec2 b(along.dot(other.To - from), across.dot(other.To - from));
    if (a[0] > b[0])
    {
      std::swap(a, b);
    }
    const Interval common{ std::max(0.0, a[0]), std::min(length, b[0]) };
    const auto height = [&](double x) { return a[1] + (x - a[0]) / (b[0] - a[0]) * (b[1] - a[1]); };
    if (common.Min < common.Max && std::abs(height(common.Min)) <= this->Tolerance &&
      std::abs(height(common.Max)) <= this->Tolerance)
    {
      all.push_back({ common.Min / length, common.Max / length });
    }
  }
  std::sort(
    all.begin(), all.end(), [](const Interval& p, const Interval& q) { return p.Min < q.Min; });
  std::vector<Interval> out;
  for (const Interval& one : all)
  {
    if (!out.empty() && one.Min <= out.back().Max)
    {
      out.back().Max = std::max(out.back().Max, one.Max);
    }
    else
    {
      out.push_back(one);
    }
  }
  return out;
}

std::vector<Step> CopyFinder::Steps(std::size_t index) const
{
  const PlaneLine& line = this->Lines[index];
  std::vector<Step> out;
  for (std::size_t k = 0; k + 1 < line.Points.size(); ++k)
  {
    const double length = (line.Points[k + 1] - line.Points[k]).norm();
    double reached = 0.0;
    const auto add = [&](double to, bool isCopy) {
      if (to > reached)
      {
        out.push_back({ k, reached, to, (to - reached) * length, isCopy });
        reached = to;
      }
    };
    if (length > 0.0)
    {
      for (const Interval& one : this->Covered(index, line.Points[k], line.Points[k + 1]))
      {
        add(one.Min, false);
        add(one.Max, true);
      }
    }
    add(1.0, length == 0.0 && !out.empty() && out.back().IsCopy);
  }
  return out;
}

std::vector<PlaneLine> CopyFinder::Rest(std::size_t index) const
{
  std::vector<Step> steps = this->Steps(index);
  // Copies that are too short are none, and then remainders between copies go, too.
  for (const bool isCopy : { true, false })
  {
    for (std::size_t first = 0, last = 0; first < steps.size(); first = last)
    {
      double length = 0.0;
      for (last = first; last < steps.size() && steps[last].IsCopy == steps[first].IsCopy; ++last)
      {
        length += steps[last].Length;
      }
      if (steps[first].IsCopy == isCopy && length < Shortest * this->Tolerance &&
        last - first < steps.size())
      {
        std::for_each(steps.begin() + std::ptrdiff_t(first), steps.begin() + std::ptrdiff_t(last),
          [&](Step& step) { step.IsCopy = !isCopy; });
      }
    }
  }
  const PlaneLine& line = this->Lines[index];
  const auto at = [&](std::size_t segment, double share) {
    return share == 0.0 ? line.Points[segment]
      : share == 1.0
      ? line.Points[segment + 1]
      : Vec2((1.0 - share) * line.Points[segment] + share * line.Points[segment + 1]);
  };
  std::vector<PlaneLine> out;
  for (std::size_t k = 0; k < steps.size(); ++k)
  {
    const Step& step = steps[k];
    if (step.IsCopy)
    {
      continue;
    }
    if (k == 0 || steps[k - 1].IsCopy)
    {
      out.push_back({ { at(step.Segment, step.From) }, line.Group, line.Source });
    }
    const bool goesOn = k + 1 < steps.size() && !steps[k + 1].IsCopy;
    if (step.To == 1.0 || !goesOn)
    {
      out.back().Points.push_back(at(step.Segment, step.To));
    }
  }
  return out;
}

} // namespace

std::vector<std::size_t> DropHiddenCopies(
  std::vector<PlaneLine>& lines, const std::vector<char>& isVisible, double tolerance)
{
  const CopyFinder finder(lines, isVisible, tolerance);
  std::vector<PlaneLine> kept;
  std::vector<std::size_t> out;
  for (std::size_t l = 0; l < lines.size(); ++l)
  {
    const std::vector<PlaneLine> rest =
      isVisible[l] ? std::vector<PlaneLine>{ lines[l] } : finder.Rest(l);
    kept.insert(kept.end(), rest.begin(), rest.end());
    out.insert(out.end(), rest.size(), l);
  }
  lines = std::move(kept);
  return out;
}

} // namespace nurbs
