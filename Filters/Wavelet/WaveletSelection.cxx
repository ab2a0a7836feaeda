// SPDX-License-Identifier: BSD-3-Clause
#include "WaveletSelection.h"

#include <algorithm>
#include <memory>
#include <set>

namespace nurbs
{

namespace
{

template <typename F>
void VisitLeaves(const WaveletFace& face, const WaveletCell& cell, const SplitCell& split, F& leaf)
{
  if (cell.Level == 0 || !split(cell))
  {
    leaf(cell);
    return;
  }
  WaveletCell children[4];
  const int count = face.Children(cell, children);
  for (int c = 0; c < count; ++c)
  {
    VisitLeaves(face, children[c], split, leaf);
  }
}

template <typename F>
void VisitLeaves(const WaveletFace& face, const SplitCell& split, F leaf)
{
  const int level = face.Levels() - 1;
  for (int j = 0; j < face.Axis(1).BaseIntervals(); ++j)
  {
    for (int i = 0; i < face.Axis(0).BaseIntervals(); ++i)
    {
      VisitLeaves(face, { level, i, j }, split, leaf);
    }
  }
}

} // namespace

SplitCell CellErrorOver(const WaveletFace& face, double tolerance)
{
  const auto samples = std::make_shared<std::vector<Vec3>>(face.Pyramid().Level(0));
  const std::size_t width = face.Axis(0).Intervals() + 1;
  return [&face, tolerance, samples, width](const WaveletCell& cell) {
    int at[4];
    face.Extent(cell, at);
    const auto x = [&](int i, int j) -> const Vec3& { return (*samples)[i + j * width]; };
    const double twist =
      (x(at[0], at[2]) - x(at[1], at[2]) - x(at[0], at[3]) + x(at[1], at[3])).norm();
    // Neighbours may be finer and put vertices on its sides; else that would be one after the
    // other.
    const double through = 2.0 * face.FineError() +
      std::min(face.Spread(cell), 2.0 * face.Deviation(cell)) + 0.25 * twist;
    if (through <= tolerance)
    {
      return false;
    }
    const ParameterBox box{ face.Axis(0).Line(at[0]), face.Axis(0).Line(at[1]),
      face.Axis(1).Line(at[2]), face.Axis(1).Line(at[3]) };
    return face.Bound().Over(box).Bow(box.A(), box.B()) > tolerance;
  };
}

int LevelWithin(const WaveletFace& face, double threshold)
{
  int level = face.Levels() - 1;
  while (level > 0 && face.LargestDropped(level) > threshold)
  {
    --level;
  }
  return level;
}

std::int64_t CountCells(const WaveletFace& face, double threshold)
{
  std::int64_t count = 0;
  VisitLeaves(
    face, [&](const WaveletCell& cell) { return face.LargestCoefficient(cell) > threshold; },
    [&](const WaveletCell&) { ++count; });
  return count;
}

WaveletSelection::WaveletSelection(Wavelet kind, std::size_t faces, std::size_t edges)
  : Haar(kind == Wavelet::Haar)
  , Cells(faces)
  , Level(faces, 0)
  , Lines(edges)
  , EdgeLevel(edges, 0)
  , ChangedEdges(edges, 0)
{}

void WaveletSelection::SetLevel(std::size_t face, const WaveletFace& source, int level)
{
  this->Level[face] = std::clamp(level, 0, source.Levels() - 1);
}

void WaveletSelection::SetEdgeLevel(std::size_t edge, const WaveletEdge& source, int level)
{
  this->EdgeLevel[edge] = std::clamp(level, 0, source.Axis().Depth);
  this->Lines[edge].clear();
  for (int i = 0; !this->Haar && i <= source.Axis().Intervals(this->EdgeLevel[edge]); ++i)
  {
    this->Lines[edge].push_back(i << this->EdgeLevel[edge]);
  }
}

void WaveletSelection::RefineCells(
  std::size_t face, const WaveletFace& source, const SplitCell& split)
{
  std::vector<WaveletCell>& cells = this->Cells[face];
  cells.clear();
  int& level = this->Level[face];
  level = source.Levels() - 1;
  VisitLeaves(source, split, [&](const WaveletCell& cell) {
    cells.push_back(cell);
    level = std::min(level, cell.Level);
  });
}

void WaveletSelection::RefineEdge(std::size_t edge, const std::function<bool(int, int)>& split)
{
  std::vector<int>& lines = this->Lines[edge];
  std::vector<int> out(1, lines.front());
  std::vector<int> ends(lines.rbegin(), lines.rend() - 1);
  while (!ends.empty())
  {
    const int first = out.back();
    const int last = ends.back();
    if (last - first > 1 && split(first, last))
    {
      ends.push_back((first + last) / 2);
      continue;
    }
    out.push_back(last);
    ends.pop_back();
  }
  lines.swap(out);
}

void WaveletSelection::AddLine(std::size_t edge, int line)
{
  std::vector<int>& lines = this->Lines[edge];
  for (;;)
  {
    const auto next = std::lower_bound(lines.begin(), lines.end(), line);
    if (*next == line)
    {
      return;
    }
    lines.insert(next, (*(next - 1) + *next) / 2);
    this->ChangedEdges[edge] = 1;
  }
}

void WaveletSelection::SplitSegment(std::size_t edge, int first, int last)
{
  if (this->Lines[edge].empty() || last <= first + 1)
  {
    return;
  }
  this->AddLine(edge, (first + last) / 2);
}

bool WaveletSelection::Apply(const std::vector<FaceMeshRequests>& requests,
  const std::vector<std::unique_ptr<WaveletFace>>& faces, std::vector<char>& dirty)
{
  bool any = false;
  std::set<std::int64_t> edges; // Haar: each by one level.
  for (std::size_t f = 0; f < requests.size(); ++f)
  {
    std::vector<WaveletCell>& cells = this->Cells[f];
    const std::set<int> leaves(requests[f].Leaves.begin(), requests[f].Leaves.end());
    if (!leaves.empty() && cells.empty() && this->Level[f] > 0)
    {
      --this->Level[f];
      dirty[f] = 1;
    }
    else if (!leaves.empty() && !cells.empty())
    {
      std::vector<WaveletCell> out;
      for (int l = 0; l < int(cells.size()); ++l)
      {
        WaveletCell children[4];
        const bool split = leaves.count(l) > 0 && cells[l].Level > 0;
        const int count = split ? faces[f]->Children(cells[l], children) : 0;
        out.insert(out.end(), children, children + count);
        if (!split)
        {
          out.push_back(cells[l]);
        }
        else
        {
          this->Level[f] = std::min(this->Level[f], cells[l].Level - 1);
          dirty[f] = 1;
        }
      }
      cells.swap(out);
    }
    any = any || dirty[f] != 0;
    for (const auto& segment : requests[f].Segments)
    {
      if (this->Lines[segment.first].empty())
      {
        edges.insert(segment.first);
      }
      this->SplitSegment(segment.first, segment.second.first, segment.second.second);
    }
  }
  for (const std::int64_t e : edges)
  {
    if (this->EdgeLevel[e] > 0)
    {
      --this->EdgeLevel[e];
      this->ChangedEdges[e] = 1;
    }
  }
  for (const char changed : this->ChangedEdges)
  {
    any = any || changed != 0;
  }
  return any;
}

void WaveletSelection::MarkChangedEdges(
  const std::vector<std::unique_ptr<WaveletEdge>>& edges, std::vector<char>& dirty)
{
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    if (this->ChangedEdges[e])
    {
      for (const WaveletEdgeUse& use : edges[e]->Uses())
      {
        dirty[use.Where.Face] = 1;
      }
      this->ChangedEdges[e] = 0;
    }
  }
}

} // namespace nurbs
