// SPDX-License-Identifier: BSD-3-Clause
#include "SnapRounding.h"

#include "HotPixelTree.h"
#include "SegmentCrossings.h"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <limits>
#include <numeric>

namespace nurbs
{

namespace
{

// About how the time divides.
constexpr double CrossingsShare = 0.5;
constexpr double PathsShare = 0.9;

void CheckInput(const std::vector<GridPoint>& points, const std::vector<GridSegment>& segments)
{
  for (const GridPoint& p : points)
  {
    if (p.X < -GridLimit || p.X > GridLimit || p.Y < -GridLimit || p.Y > GridLimit)
    {
      throw Error("SnapRound: a coordinate exceeds 2^29 pixels");
    }
  }
  if (segments.size() > std::size_t(std::numeric_limits<std::int32_t>::max()))
  {
    throw Error("SnapRound: more than 2^31 - 1 segments");
  }
  for (const GridSegment& s : segments)
  {
    if (s.Start < 0 || s.End < 0 || std::size_t(s.Start) >= points.size() ||
      std::size_t(s.End) >= points.size())
    {
      throw Error("SnapRound: a segment names a point that is not there");
    }
  }
}

// The segments as lines, each once.
struct DistinctLines
{
  std::vector<GridLine> Lines;
  std::vector<std::int32_t> LineOf; // of a segment; -1: its length is zero

  DistinctLines(const std::vector<GridPoint>& points, const std::vector<GridSegment>& segments);
};

DistinctLines::DistinctLines(
  const std::vector<GridPoint>& points, const std::vector<GridSegment>& segments)
  : LineOf(segments.size(), -1)
{
  struct Entry
  {
    GridLine Line;
    std::int32_t Segment;
  };
  std::vector<Entry> entries;
  entries.reserve(segments.size());
  for (std::size_t s = 0; s < segments.size(); ++s)
  {
    const GridPoint& a = points[segments[s].Start];
    const GridPoint& b = points[segments[s].End];
    if (a != b)
    {
      entries.push_back({ { std::min(a, b), std::max(a, b) }, std::int32_t(s) });
    }
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.Line.Start != b.Line.Start ? a.Line.Start < b.Line.Start : a.Line.End < b.Line.End;
  });
  for (const Entry& e : entries)
  {
    if (this->Lines.empty() || this->Lines.back().Start != e.Line.Start ||
      this->Lines.back().End != e.Line.End)
    {
      this->Lines.push_back(e.Line);
    }
    this->LineOf[e.Segment] = std::int32_t(this->Lines.size()) - 1;
  }
}

std::vector<GridPoint> HotPixels(const std::vector<GridPoint>& points,
  const std::vector<GridSegment>& segments, const std::vector<GridPoint>& crossings)
{
  std::vector<GridPoint> ends;
  ends.reserve(2 * segments.size());
  for (const GridSegment& s : segments)
  {
    ends.push_back(points[s.Start]);
    ends.push_back(points[s.End]);
  }
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  std::vector<GridPoint> hot;
  hot.reserve(ends.size() + crossings.size());
  std::set_union(
    ends.begin(), ends.end(), crossings.begin(), crossings.end(), std::back_inserter(hot));
  if (hot.size() > std::size_t(std::numeric_limits<std::int32_t>::max()))
  {
    throw Error("SnapRound: more than 2^31 - 1 vertices");
  }
  return hot;
}

// Values in rows of different lengths.
struct Rows
{
  std::vector<std::int64_t> Start{ 0 };
  std::vector<std::int32_t> Values;
};

// The hot pixels on each line, by index.
Rows PixelsOnLines(const std::vector<GridLine>& lines, const HotPixelTree& tree,
  const ParallelFor& parallel, const std::function<bool(double)>& goOn)
{
  constexpr std::int64_t ChunkSize = 2048;
  const std::int64_t count = std::int64_t(lines.size());
  const std::int64_t chunks = (count + ChunkSize - 1) / ChunkSize;
  std::vector<Rows> parts(chunks);
  std::atomic<std::int64_t> done{ 0 };
  parallel(0, chunks, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t c = begin; c < end; ++c)
    {
      if (!goOn(double(done) / double(chunks)))
      {
        return;
      }
      for (std::int64_t l = c * ChunkSize; l < std::min(count, (c + 1) * ChunkSize); ++l)
      {
        tree.Find(lines[l], parts[c].Values);
        parts[c].Start.push_back(std::int64_t(parts[c].Values.size()));
      }
      ++done;
    }
  });
  Rows all;
  all.Start.reserve(lines.size() + 1);
  for (const Rows& part : parts)
  {
    const std::int64_t offset = std::int64_t(all.Values.size());
    for (std::size_t l = 1; l < part.Start.size(); ++l)
    {
      all.Start.push_back(offset + part.Start[l]);
    }
    all.Values.insert(all.Values.end(), part.Values.begin(), part.Values.end());
  }
  return all;
}

// All pairs of vertices that follow each other, for each vertex those that come after it.
Rows Successors(const Rows& pixels, std::size_t vertices)
{
  const auto forEachPair = [&pixels](auto&& body) {
    for (std::size_t l = 0; l + 1 < pixels.Start.size(); ++l)
    {
      for (std::int64_t i = pixels.Start[l]; i + 1 < pixels.Start[l + 1]; ++i)
      {
        body(std::minmax(pixels.Values[i], pixels.Values[i + 1]));
      }
    }
  };
  Rows out;
  out.Start.assign(vertices + 1, 0);
  forEachPair([&](const auto& pair) { ++out.Start[pair.first + 1]; });
  std::partial_sum(out.Start.begin(), out.Start.end(), out.Start.begin());
  out.Values.resize(out.Start.back());
  std::vector<std::int64_t> next(out.Start.begin(), out.Start.end() - 1);
  forEachPair([&](const auto& pair) { out.Values[next[pair.first]++] = pair.second; });
  std::int64_t kept = 0;
  for (std::size_t v = 0; v < vertices; ++v)
  {
    const auto begin = out.Values.begin() + out.Start[v];
    const auto end = out.Values.begin() + out.Start[v + 1];
    std::sort(begin, end);
    const auto last = std::unique(begin, end);
    out.Start[v] = kept;
    kept = std::copy(begin, last, out.Values.begin() + kept) - out.Values.begin();
  }
  out.Start[vertices] = kept;
  out.Values.resize(kept);
  if (kept > std::numeric_limits<std::int32_t>::max())
  {
    throw Error("SnapRound: more than 2^31 - 1 edges");
  }
  return out;
}

// The edge, from its other end if need be, that leads from one vertex to the next.
std::int32_t EdgeBetween(const Rows& successors, std::int32_t from, std::int32_t to)
{
  const auto [low, high] = std::minmax(from, to);
  const auto begin = successors.Values.begin();
  const auto at =
    std::lower_bound(begin + successors.Start[low], begin + successors.Start[low + 1], high);
  const std::int32_t edge = std::int32_t(at - begin);
  return from < to ? edge : ~edge;
}

void FillEdgesAndPaths(const std::vector<GridPoint>& points,
  const std::vector<GridSegment>& segments, const DistinctLines& distinct, const Rows& pixels,
  SnappedSegments& out)
{
  const Rows successors = Successors(pixels, out.Vertices.size());
  out.Edges.reserve(successors.Values.size());
  for (std::size_t v = 0; v < out.Vertices.size(); ++v)
  {
    for (std::int64_t i = successors.Start[v]; i < successors.Start[v + 1]; ++i)
    {
      out.Edges.push_back({ std::int32_t(v), successors.Values[i] });
    }
  }
  out.PathStart.assign(1, 0);
  out.PathStart.reserve(segments.size() + 1);
  for (std::size_t s = 0; s < segments.size(); ++s)
  {
    const std::int32_t line = distinct.LineOf[s];
    if (line >= 0)
    {
      const std::int32_t* way = pixels.Values.data() + pixels.Start[line];
      const std::int64_t steps = pixels.Start[line + 1] - pixels.Start[line] - 1;
      const bool forward = points[segments[s].Start] < points[segments[s].End];
      for (std::int64_t k = 0; k < steps; ++k)
      {
        out.Path.push_back(forward ? EdgeBetween(successors, way[k], way[k + 1])
                                   : EdgeBetween(successors, way[steps - k], way[steps - k - 1]));
      }
    }
    out.PathStart.push_back(std::int64_t(out.Path.size()));
  }
}

} // namespace

SnappedSegments SnapRound(const std::vector<GridPoint>& points,
  const std::vector<GridSegment>& segments, const ParallelFor& parallel,
  const std::function<bool(double)>& progress)
{
  CheckInput(points, segments);
  std::atomic<bool> aborted{ false };
  const auto goOn = [&](double share) {
    if (progress && !aborted && !progress(share))
    {
      aborted = true;
    }
    return !aborted;
  };
  SnappedSegments out;
  const DistinctLines distinct(points, segments);
  const std::vector<GridPoint> crossings = CrossingPixels(
    distinct.Lines, parallel, [&](double share) { return goOn(share * CrossingsShare); });
  if (goOn(CrossingsShare))
  {
    out.Vertices = HotPixels(points, segments, crossings);
    const HotPixelTree tree(out.Vertices);
    const Rows pixels = PixelsOnLines(distinct.Lines, tree, parallel,
      [&](double share) { return goOn(CrossingsShare + share * (PathsShare - CrossingsShare)); });
    if (goOn(PathsShare))
    {
      FillEdgesAndPaths(points, segments, distinct, pixels, out);
      goOn(1.0);
    }
  }
  if (aborted)
  {
    out = SnappedSegments();
    out.Aborted = true;
  }
  return out;
}

} // namespace nurbs
