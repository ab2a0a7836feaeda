// SPDX-License-Identifier: BSD-3-Clause
#include "FrontMap.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace nurbs
{

namespace
{

// Cells whose largest circle is smaller than this, in pixels, are no cells.
constexpr double SliverRadius = 0.75;
// Lines of sight a cell, that show surfaces that pierce each other.
constexpr int SamplesPerCell = 4;

// The segments of all parts.
void AddSegments(const ViewLines& lines, const std::vector<LinePart>& parts, FrontMap& map,
  std::vector<GridPoint>& points, std::vector<GridSegment>& segments)
{
  map.FirstSegment.assign(lines.Lines.size() + 1, 0);
  for (const LinePart& part : parts)
  {
    const ViewLine& line = lines.Lines[part.Line];
    const auto addPoint = [&](LinePosition at) {
      const Vec2 grid = (ImageAt(line, at) - map.Center) / map.Pixel;
      points.push_back({ std::llround(grid[0]), std::llround(grid[1]) });
    };
    if (part.IsSnapped)
    {
      const auto first = std::int32_t(points.size());
      points.insert(points.end(), part.Ends, part.Ends + 2);
      segments.push_back({ first, first + 1 });
      map.Segments.push_back(part);
      ++map.FirstSegment[part.Line + 1];
      continue;
    }
    addPoint(part.From);
    for (LinePosition at = part.From; at < part.To;)
    {
      const LinePosition next = std::min(part.To, std::floor(at) + 1.0);
      addPoint(next);
      const auto last = std::int32_t(points.size() - 1);
      segments.push_back({ last - 1, last });
      map.Segments.emplace_back();
      map.Segments.back().Line = part.Line;
      map.Segments.back().From = at;
      map.Segments.back().To = next;
      ++map.FirstSegment[part.Line + 1];
      at = next;
    }
  }
  std::partial_sum(map.FirstSegment.begin(), map.FirstSegment.end(), map.FirstSegment.begin());
}

// Which lines run along which edge.
void CollectSources(FrontMap& map)
{
  const SnappedSegments& snapped = map.Snapped;
  map.SourceStart.assign(snapped.Edges.size() + 1, 0);
  for (const std::int32_t entry : snapped.Path)
  {
    ++map.SourceStart[FrontMap::EdgeOf(entry) + 1];
  }
  std::partial_sum(map.SourceStart.begin(), map.SourceStart.end(), map.SourceStart.begin());
  map.Sources.resize(snapped.Path.size());
  std::vector<std::int64_t> next(map.SourceStart.begin(), map.SourceStart.end() - 1);
  for (std::size_t s = 0; s < map.Segments.size(); ++s)
  {
    for (std::int64_t p = snapped.PathStart[s]; p < snapped.PathStart[s + 1]; ++p)
    {
      LineSource& source = map.Sources[next[FrontMap::EdgeOf(snapped.Path[p])]++];
      source.Line = map.Segments[s].Line;
      source.Segment = std::int32_t(s);
      source.Backward = snapped.Path[p] < 0;
    }
  }
}

// Looks at each cell; the outer one is empty.
void LookAtCells(const ViewLines& lines, const ImagePlane& image, const RayCaster& caster,
  const ParallelFor& parallel, const std::function<bool(double)>& progress, FrontMap& map)
{
  const PlanarMap& plane = map.Plane;
  map.Cells.resize(plane.CellCount);
  std::vector<std::vector<std::int64_t>> others(plane.CellCount);
  constexpr std::int32_t Batch = 4096;
  for (std::int32_t first = 1; first < plane.CellCount; first += Batch)
  {
    const std::int32_t last = std::min(plane.CellCount, first + Batch);
    parallel(first, last, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t c = begin; c < end; ++c)
      {
        const std::int64_t first = plane.SampleStart[c];
        map.Cells[c] = LookAt(caster, image, map.ToImage(plane.Samples[first].Point));
        for (std::int64_t k = first + 1;
             k < plane.SampleStart[c + 1] && plane.Samples[k].Radius > SliverRadius; ++k)
        {
          const FrontHit other = LookAt(caster, image, map.ToImage(plane.Samples[k].Point));
          if (!lines.AreJoined(other.Face, map.Cells[c].Face))
          {
            others[c].push_back(other.Face);
          }
        }
      }
    });
    if (progress && !progress(double(last) / double(plane.CellCount)))
    {
      map.Cells.clear();
      return;
    }
  }
  std::set<std::array<std::int64_t, 2>> pairs;
  for (std::int32_t c = 1; c < plane.CellCount; ++c)
  {
    for (const std::int64_t face : others[c])
    {
      const std::int64_t front = map.Cells[c].Face;
      pairs.insert({ std::min(front, face), std::max(front, face) });
    }
  }
  map.Piercing.assign(pairs.begin(), pairs.end());
}

} // namespace

bool FrontMap::IsSliver(std::int32_t cell) const
{
  return cell != 0 && this->Plane.Samples[this->Plane.SampleStart[cell]].Radius < SliverRadius;
}

LinePosition FrontMap::At(
  const std::vector<ViewLine>& lines, const LineSource& source, std::int32_t vertex) const
{
  const LinePart& segment = this->Segments[source.Segment];
  for (int end = 0; end < 2 && segment.IsSnapped; ++end)
  {
    if (this->Snapped.Vertices[vertex] == segment.Ends[end] || segment.From == segment.To)
    {
      return end == 0 ? segment.From : segment.To;
    }
  }
  const Vec2 a = ImageAt(lines[source.Line], segment.From);
  const Vec2 along = ImageAt(lines[source.Line], segment.To) - a;
  const double share = along.dot(this->VertexImage(vertex) - a) / along.squaredNorm();
  // Within a pixel's reach of an end of the segment it is the end.
  const double reach = std::min(0.5, this->Pixel / along.norm());
  return share < reach     ? segment.From
    : share >= 1.0 - reach ? segment.To
                           : segment.From + share * (segment.To - segment.From);
}

std::vector<LinePart> LinesInView(const ViewLines& lines)
{
  std::vector<LinePart> out;
  for (std::size_t l = 0; l < lines.Lines.size(); ++l)
  {
    if (!lines.Lines[l].IsBehind)
    {
      out.emplace_back();
      out.back().Line = std::int32_t(l);
      out.back().To = double(lines.Lines[l].Points.size() - 1);
    }
  }
  return out;
}

FrontHit LookAt(const RayCaster& caster, const ImagePlane& image, const Vec2& at)
{
  FrontHit out;
  RayHit hit;
  const Ray ray = image.Sight(at);
  if (caster.Nearest(ray, hit))
  {
    out.Face = hit.Face;
    out.UV = Vec2(hit.U, hit.V);
    out.Point = hit.Point;
    out.FromBehind = hit.Normal.dot(ray.Direction) > 0.0;
  }
  return out;
}

FrontMap MakeLineMap(const ViewLines& lines, const std::vector<LinePart>& parts, double pixel,
  const ParallelFor& parallel)
{
  FrontMap map;
  map.Pixel = pixel;
  const Box2 box = lines.Box();
  map.Center = box.isEmpty() ? Vec2(Vec2::Zero()) : Vec2(box.center());
  std::vector<GridPoint> points;
  std::vector<GridSegment> segments;
  AddSegments(lines, parts, map, points, segments);
  map.Snapped = SnapRound(points, segments, parallel);
  map.Plane = MakePlanarMap(map.Snapped, SamplesPerCell);
  CollectSources(map);
  return map;
}

FrontMap MakeFrontMap(const ViewLines& lines, const std::vector<LinePart>& parts,
  const ImagePlane& image, const RayCaster& caster, double pixel, const ParallelFor& parallel,
  const std::function<bool(double)>& progress)
{
  FrontMap map = MakeLineMap(lines, parts, pixel, parallel);
  LookAtCells(lines, image, caster, parallel, progress, map);
  return map;
}

LineWalk::LineWalk(const std::vector<ViewLine>& lines, const FrontMap& map)
  : Lines(lines)
  , Map(map)
  , Degree(map.Snapped.Vertices.size(), 0)
{
  for (const auto& ends : map.Snapped.Edges)
  {
    ++this->Degree[ends[0]];
    ++this->Degree[ends[1]];
  }
}

std::vector<LineStep> LineWalk::Steps(std::int64_t line) const
{
  std::vector<LineStep> out;
  const SnappedSegments& snapped = this->Map.Snapped;
  for (std::int64_t s = this->Map.FirstSegment[line]; s < this->Map.FirstSegment[line + 1]; ++s)
  {
    for (std::int64_t p = snapped.PathStart[s]; p < snapped.PathStart[s + 1]; ++p)
    {
      const std::int32_t edge = FrontMap::EdgeOf(snapped.Path[p]);
      out.push_back({ edge, &this->Map.SourceOf(edge, s) - this->Map.Sources.data() });
    }
  }
  return out;
}

LinePosition LineWalk::Start(const LineStep& step) const
{
  const LineSource& source = this->Map.Sources[step.Source];
  return this->Map.At(
    this->Lines, source, this->Map.Snapped.Edges[step.Edge][source.Backward ? 1 : 0]);
}

LinePosition LineWalk::End(const LineStep& step) const
{
  const LineSource& source = this->Map.Sources[step.Source];
  return this->Map.At(
    this->Lines, source, this->Map.Snapped.Edges[step.Edge][source.Backward ? 0 : 1]);
}

// True if a silhouette ends on the line after the middle of the one step and before that of the next.
bool LineWalk::TurnsBetween(const LineStep& before, const LineStep& step) const
{
  const std::vector<LinePosition>& turns = this->Lines[this->Map.Sources[step.Source].Line].Turns;
  if (turns.empty())
  {
    return false;
  }
  const auto middle = [&](
                        const LineStep& one) { return 0.5 * (this->Start(one) + this->End(one)); };
  const auto next = std::lower_bound(turns.begin(), turns.end(), middle(before));
  return next != turns.end() && *next < middle(step);
}

std::size_t LineWalk::GroupEnd(const std::vector<LineStep>& steps, std::size_t first) const
{
  std::size_t last = first + 1;
  while (last < steps.size())
  {
    const LineStep& step = steps[last];
    const int start = this->Map.Sources[step.Source].Backward ? 1 : 0;
    if (this->Degree[this->Map.Snapped.Edges[step.Edge][start]] != 2 ||
      this->TurnsBetween(steps[last - 1], step) ||
      this->Cell(step, 0) != this->Cell(steps[first], 0) ||
      this->Cell(step, 1) != this->Cell(steps[first], 1))
    {
      break;
    }
    ++last;
  }
  return last;
}

const LineStep& LineWalk::Widest(
  const std::vector<LineStep>& steps, std::size_t first, std::size_t last, int lineSide) const
{
  const auto room = [&](std::size_t k) {
    return this->Map.Plane.SideSamples[steps[k].Edge][this->Side(steps[k], lineSide)].Radius;
  };
  std::size_t best = first + (last - first) / 2;
  for (std::size_t k = first; k < last; ++k)
  {
    best = room(k) > room(best) ? k : best;
  }
  return steps[best];
}

namespace
{

// Chooses for each sliver the neighbour that it goes to.
class SliverJoiner
{
public:
  SliverJoiner(const ViewLines& lines, FrontMap& map)
    : Lines(lines)
    , Map(map)
    , EdgesOf(map.Plane.CellCount)
  {
    for (std::size_t e = 0; e < map.Plane.Sides.size(); ++e)
    {
      for (int side = 0; side < 2; ++side)
      {
        const std::int32_t cell = map.Plane.Sides[e][side];
        if (this->Map.IsSliver(cell) && map.Plane.Sides[e][1 - side] != cell)
        {
          this->EdgesOf[cell].push_back(2 * std::int32_t(e) + side);
        }
      }
    }
  }

  void Run();

private:
  double Length(std::int32_t edge) const
  {
    const auto& ends = this->Map.Snapped.Edges[edge];
    return (this->Map.VertexImage(ends[1]) - this->Map.VertexImage(ends[0])).norm();
  }
  bool IsBorderOf(std::int32_t edge, const std::set<std::int64_t>& faces) const;
  std::int32_t Choose(std::int32_t cell, const std::vector<char>& known) const;

  const ViewLines& Lines;
  FrontMap& Map;
  std::vector<std::vector<std::int32_t>> EdgesOf; // 2 * edge + side, of slivers.
};

bool SliverJoiner::IsBorderOf(std::int32_t edge, const std::set<std::int64_t>& faces) const
{
  for (const LineSource& source : this->Map.SourcesOf(edge))
  {
    const ViewLine& line = this->Lines.Lines[source.Line];
    for (const std::int64_t face : faces)
    {
      if (face >= 0 && IsOfFace(this->Lines, line, face))
      {
        return true;
      }
    }
  }
  return false;
}

// The neighbour to join, -1: none is known yet. By each neighbour: the length of the common edges that
// no surface seen beside ends at, less that of the others.
std::int32_t SliverJoiner::Choose(std::int32_t cell, const std::vector<char>& known) const
{
  std::set<std::int64_t> faces;
  for (const std::int32_t half : this->EdgesOf[cell])
  {
    const std::int32_t other = this->Map.Plane.Sides[half / 2][1 - half % 2];
    if (known[other])
    {
      faces.insert(this->Map.Cells[other].Face);
    }
  }
  std::map<std::int32_t, double> gain;
  for (const std::int32_t half : this->EdgesOf[cell])
  {
    const std::int32_t other = this->Map.Plane.Sides[half / 2][1 - half % 2];
    if (known[other])
    {
      const double length = this->Length(half / 2);
      gain[other] += this->IsBorderOf(half / 2, faces) ? -length : length;
    }
  }
  const auto best = std::max_element(
    gain.begin(), gain.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return best == gain.end() ? -1 : best->first;
}

void SliverJoiner::Run()
{
  std::vector<char> known(this->Map.Plane.CellCount);
  std::vector<std::int32_t> waiting;
  for (std::int32_t c = 0; c < this->Map.Plane.CellCount; ++c)
  {
    known[c] = !this->Map.IsSliver(c);
    if (!known[c])
    {
      waiting.push_back(c);
    }
  }
  // From outside in: slivers beside cells first.
  while (!waiting.empty())
  {
    std::vector<std::pair<std::int32_t, std::int32_t>> joined;
    std::vector<std::int32_t> left;
    for (const std::int32_t cell : waiting)
    {
      const std::int32_t other = this->Choose(cell, known);
      if (other >= 0)
      {
        joined.emplace_back(cell, other);
      }
      else
      {
        left.push_back(cell);
      }
    }
    for (const auto& [cell, other] : joined)
    {
      this->Map.Cells[cell] = this->Map.Cells[other];
      known[cell] = 1;
    }
    if (joined.empty())
    {
      return;
    }
    waiting = std::move(left);
  }
}

} // namespace

void AbsorbSlivers(const ViewLines& lines, FrontMap& map)
{
  SliverJoiner(lines, map).Run();
}

} // namespace nurbs
