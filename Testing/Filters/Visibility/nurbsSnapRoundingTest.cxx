// SPDX-License-Identifier: BSD-3-Clause
// Snap rounding against its definition, pair by pair and pixel by pixel in exact arithmetic.
#include "SegmentCrossings.h"
#include "SnapRounding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <thread>

namespace
{

__extension__ using Wide = __int128;
using nurbs::GridLimit;
using nurbs::GridPoint;
using nurbs::GridSegment;
using nurbs::SnappedSegments;

struct Drawing
{
  std::vector<GridPoint> Points;
  std::vector<GridSegment> Segments;

  void Add(const GridPoint& a, const GridPoint& b)
  {
    const auto n = std::int32_t(this->Points.size());
    this->Points.push_back(a);
    this->Points.push_back(b);
    this->Segments.push_back({ n, n + 1 });
  }
};

// A number Top / Bottom with Bottom > 0.
struct Fraction
{
  Wide Top, Bottom;
  bool operator<(const Fraction& f) const { return this->Top * f.Bottom < f.Top * this->Bottom; }
  double Value() const { return double(this->Top) / double(this->Bottom); }
};

Fraction Divide(Wide top, Wide bottom)
{
  return bottom < 0 ? Fraction{ -top, -bottom } : Fraction{ top, bottom };
}

std::int64_t Floor(Wide top, Wide bottom)
{
  const Fraction f = Divide(top, bottom);
  const Wide q = f.Top / f.Bottom;
  return std::int64_t(f.Top % f.Bottom < 0 ? q - 1 : q);
}

Wide Cross(const GridPoint& a, const GridPoint& b, const GridPoint& c)
{
  return Wide(b.X - a.X) * (c.Y - a.Y) - Wide(b.Y - a.Y) * (c.X - a.X);
}

int Sign(Wide w)
{
  return w > 0 ? 1 : (w < 0 ? -1 : 0);
}

// The part of [0, 1] in which a point from a to b is in a pixel: all t for which
// slope t + constant >= 0 or > 0, for the four sides.
struct Passage
{
  Fraction Low{ 0, 1 };
  Fraction High{ 1, 1 };
  bool LowIn = true;
  bool HighIn = true;
  bool Never = false;

  Passage(const GridPoint& a, const GridPoint& b, const GridPoint& p)
  {
    this->Demand(2 * (b.X - a.X), 2 * (a.X - p.X) + 1, true);
    this->Demand(-2 * (b.X - a.X), -2 * (a.X - p.X) + 1, false);
    this->Demand(2 * (b.Y - a.Y), 2 * (a.Y - p.Y) + 1, true);
    this->Demand(-2 * (b.Y - a.Y), -2 * (a.Y - p.Y) + 1, false);
  }
  bool IsEmpty() const
  {
    return this->Never || this->High < this->Low ||
      (!(this->Low < this->High) && !(this->LowIn && this->HighIn));
  }
  double Middle() const { return 0.5 * (this->Low.Value() + this->High.Value()); }

private:
  void Demand(std::int64_t slope, std::int64_t constant, bool closed)
  {
    if (slope == 0)
    {
      this->Never = this->Never || constant < 0 || (constant == 0 && !closed);
      return;
    }
    const Fraction t = Divide(-constant, slope);
    Fraction& bound = slope > 0 ? this->Low : this->High;
    bool& in = slope > 0 ? this->LowIn : this->HighIn;
    if (slope > 0 ? bound < t : t < bound)
    {
      bound = t;
      in = closed;
    }
    else if (!(bound < t) && !(t < bound))
    {
      in = in && closed;
    }
  }
};

// Pixels of ends and of all points that two segments have in common, if it is one point.
std::set<GridPoint> ReferencePixels(const Drawing& d)
{
  std::set<GridPoint> hot;
  for (std::size_t s = 0; s < d.Segments.size(); ++s)
  {
    const GridPoint& a = d.Points[d.Segments[s].Start];
    const GridPoint& b = d.Points[d.Segments[s].End];
    hot.insert(a);
    hot.insert(b);
    for (std::size_t t = 0; t < s; ++t)
    {
      const GridPoint& p = d.Points[d.Segments[t].Start];
      const GridPoint& q = d.Points[d.Segments[t].End];
      const Wide parallel = Cross(a, b, q) - Cross(a, b, p);
      if (parallel == 0 || Sign(Cross(a, b, p)) * Sign(Cross(a, b, q)) > 0 ||
        Sign(Cross(p, q, a)) * Sign(Cross(p, q, b)) > 0)
      {
        continue;
      }
      const Wide part = Cross(p, q, a);
      const Wide whole = part - Cross(p, q, b);
      hot.insert({ Floor((2 * a.X + 1) * whole + 2 * (b.X - a.X) * part, 2 * whole),
        Floor((2 * a.Y + 1) * whole + 2 * (b.Y - a.Y) * part, 2 * whole) });
    }
  }
  return hot;
}

std::vector<GridPoint> ReferencePath(
  const GridPoint& a, const GridPoint& b, const std::set<GridPoint>& hot)
{
  std::map<double, GridPoint> way;
  for (const GridPoint& p : hot)
  {
    const Passage passage(a, b, p);
    if (!passage.IsEmpty())
    {
      const bool fresh = way.emplace(passage.Middle(), p).second;
      EXPECT_TRUE(fresh);
    }
  }
  std::vector<GridPoint> path;
  for (const auto& step : way)
  {
    path.push_back(step.second);
  }
  return path;
}

std::vector<GridPoint> PathOf(const SnappedSegments& snapped, const Drawing& d, std::size_t s)
{
  std::vector<GridPoint> path(1, d.Points[d.Segments[s].Start]);
  for (std::int64_t k = snapped.PathStart[s]; k < snapped.PathStart[s + 1]; ++k)
  {
    const bool back = snapped.Path[k] < 0;
    const auto& edge = snapped.Edges.at(back ? ~snapped.Path[k] : snapped.Path[k]);
    EXPECT_EQ(path.back(), snapped.Vertices[edge[back ? 1 : 0]]);
    path.push_back(snapped.Vertices[edge[back ? 0 : 1]]);
  }
  EXPECT_EQ(path.back(), d.Points[d.Segments[s].End]);
  return path;
}

// Pairs of edges that have a point in common that is not an end of both.
int CountContacts(const SnappedSegments& snapped)
{
  int contacts = 0;
  for (std::size_t e = 0; e < snapped.Edges.size(); ++e)
  {
    const GridPoint& a = snapped.Vertices[snapped.Edges[e][0]];
    const GridPoint& b = snapped.Vertices[snapped.Edges[e][1]];
    for (std::size_t f = 0; f < e; ++f)
    {
      const GridPoint& p = snapped.Vertices[snapped.Edges[f][0]];
      const GridPoint& q = snapped.Vertices[snapped.Edges[f][1]];
      contacts += Sign(Cross(a, b, p)) * Sign(Cross(a, b, q)) < 0 &&
        Sign(Cross(p, q, a)) * Sign(Cross(p, q, b)) < 0;
    }
    for (const GridPoint& v : snapped.Vertices)
    {
      contacts += v != a && v != b && Cross(a, b, v) == 0 &&
        Wide(v.X - a.X) * (v.X - b.X) + Wide(v.Y - a.Y) * (v.Y - b.Y) < 0;
    }
  }
  return contacts;
}

double Distance(const nurbs::Vec2& p, const GridPoint& a, const GridPoint& b)
{
  const nurbs::Vec2 from(a.X, a.Y);
  const nurbs::Vec2 along = nurbs::Vec2(b.X, b.Y) - from;
  const double length = along.squaredNorm();
  const double t = length > 0.0 ? std::clamp((p - from).dot(along) / length, 0.0, 1.0) : 0.0;
  return (p - from - t * along).norm();
}

// The largest distance between a segment, at 65 places, and its path.
double Drift(const GridPoint& a, const GridPoint& b, const std::vector<GridPoint>& path)
{
  double drift = 0.0;
  for (int k = 0; k <= 64; ++k)
  {
    const nurbs::Vec2 p =
      nurbs::Vec2(a.X, a.Y) + k / 64.0 * (nurbs::Vec2(b.X, b.Y) - nurbs::Vec2(a.X, a.Y));
    double nearest = Distance(p, path[0], path[0]);
    for (std::size_t i = 1; i < path.size(); ++i)
    {
      nearest = std::min(nearest, Distance(p, path[i - 1], path[i]));
    }
    drift = std::max(drift, nearest);
  }
  for (const GridPoint& p : path)
  {
    drift = std::max(drift, Distance(nurbs::Vec2(p.X, p.Y), a, b));
  }
  return drift;
}

void ExpectLikeDefinition(const Drawing& d)
{
  const SnappedSegments snapped = nurbs::SnapRound(d.Points, d.Segments);
  const std::set<GridPoint> hot = ReferencePixels(d);
  EXPECT_EQ(snapped.Vertices, std::vector<GridPoint>(hot.begin(), hot.end()));
  ASSERT_EQ(snapped.PathStart.size(), d.Segments.size() + 1);
  ASSERT_EQ(snapped.PathStart.back(), std::int64_t(snapped.Path.size()));
  std::set<std::array<std::int32_t, 2>> used;
  for (std::size_t s = 0; s < d.Segments.size(); ++s)
  {
    const GridPoint& a = d.Points[d.Segments[s].Start];
    const GridPoint& b = d.Points[d.Segments[s].End];
    const std::vector<GridPoint> path = PathOf(snapped, d, s);
    EXPECT_EQ(path, ReferencePath(a, b, hot));
    EXPECT_LE(Drift(a, b, path), std::sqrt(0.5) + 1e-6);
    for (std::int64_t k = snapped.PathStart[s]; k < snapped.PathStart[s + 1]; ++k)
    {
      used.insert(snapped.Edges[std::max(snapped.Path[k], ~snapped.Path[k])]);
    }
  }
  // Each edge once, sorted, and none but those on paths.
  const std::vector<std::array<std::int32_t, 2>> edges(used.begin(), used.end());
  EXPECT_EQ(snapped.Edges, edges);
  for (const auto& e : edges)
  {
    EXPECT_LT(e[0], e[1]);
  }
  EXPECT_EQ(CountContacts(snapped), 0);
}

std::int64_t Random(std::mt19937& random, std::int64_t low, std::int64_t high)
{
  return std::uniform_int_distribution<std::int64_t>(low, high)(random);
}

Drawing RandomDrawing(std::mt19937& random, int segments, std::int64_t width, std::int64_t height)
{
  Drawing d;
  for (int s = 0; s < segments; ++s)
  {
    d.Add({ Random(random, 0, width), Random(random, 0, height) },
      { Random(random, 0, width), Random(random, 0, height) });
  }
  return d;
}

// Ranges of one item each, from the last to the first, on three threads.
void BackwardsFor(std::int64_t first, std::int64_t last,
  const std::function<void(std::int64_t, std::int64_t)>& body)
{
  std::atomic<std::int64_t> next{ last };
  std::vector<std::thread> threads;
  for (int t = 0; t < 3; ++t)
  {
    threads.emplace_back([&] {
      for (std::int64_t i = --next; i >= first; i = --next)
      {
        body(i, i + 1);
      }
    });
  }
  for (std::thread& t : threads)
  {
    t.join();
  }
}

TEST(SnapRounding, SmallGridsLikeTheDefinition)
{
  std::mt19937 random(1);
  for (const std::int64_t size : { 2, 3, 5, 8, 13, 40, 200 })
  {
    for (int trial = 0; trial < 60; ++trial)
    {
      SCOPED_TRACE(testing::Message() << size << " / " << trial);
      const int segments = int(Random(random, 1, size < 10 ? 25 : 40));
      ExpectLikeDefinition(RandomDrawing(random, segments, size, size));
      ASSERT_FALSE(HasFailure());
    }
  }
}

TEST(SnapRounding, FlatAndHighGrids)
{
  std::mt19937 random(2);
  for (int trial = 0; trial < 60; ++trial)
  {
    SCOPED_TRACE(trial);
    ExpectLikeDefinition(RandomDrawing(random, 30, 300, 3));
    ExpectLikeDefinition(RandomDrawing(random, 30, 3, 300));
    ExpectLikeDefinition(RandomDrawing(random, 10, 0, 20));
    ExpectLikeDefinition(RandomDrawing(random, 10, 20, 0));
    ASSERT_FALSE(HasFailure());
  }
}

// Nearly parallel lines across the whole grid, where no rounded arithmetic can tell their order.
TEST(SnapRounding, NeedlesAtTheLimit)
{
  std::mt19937 random(3);
  for (int trial = 0; trial < 40; ++trial)
  {
    SCOPED_TRACE(trial);
    Drawing d;
    const bool upright = trial % 4 == 1;
    const bool across = trial % 4 > 1;
    const std::int64_t wide = trial % 4 == 3 ? 1000 : 4;
    for (int s = 0; s < 16; ++s)
    {
      GridPoint a{ -GridLimit + Random(random, 0, wide), Random(random, -wide, wide) };
      GridPoint b{ GridLimit - Random(random, 0, wide), Random(random, -wide, wide) };
      if (across)
      {
        a.Y = -GridLimit + Random(random, 0, wide);
        b.Y = GridLimit - Random(random, 0, wide);
      }
      if (upright)
      {
        std::swap(a.X, a.Y);
        std::swap(b.X, b.Y);
      }
      s % 2 ? d.Add(a, b) : d.Add(b, a);
    }
    ExpectLikeDefinition(d);
    ASSERT_FALSE(HasFailure());
  }
}

TEST(SnapRounding, CornersBelongToOnePixel)
{
  // Diagonals through corners of the pixel (1, 1) and its neighbours, which other segments make
  // hot.
  Drawing d;
  d.Add({ 0, 1 }, { 1, 0 });
  d.Add({ 1, 2 }, { 2, 1 });
  d.Add({ 0, 1 }, { 1, 2 });
  d.Add({ 1, 0 }, { 2, 1 });
  d.Add({ 1, 1 }, { 1, 1 });
  ExpectLikeDefinition(d);
  const SnappedSegments snapped = nurbs::SnapRound(d.Points, d.Segments);
  const std::vector<GridPoint> bent{ { 0, 1 }, { 1, 1 }, { 1, 0 } };
  EXPECT_EQ(PathOf(snapped, d, 0), bent);
  for (std::size_t s = 1; s < 4; ++s)
  {
    EXPECT_EQ(PathOf(snapped, d, s).size(), 2u);
  }
  EXPECT_EQ(PathOf(snapped, d, 4).size(), 1u);
}

TEST(SnapRounding, OverlapsShareEdges)
{
  Drawing d;
  d.Add({ 0, 0 }, { 30, 10 });
  d.Add({ 21, 7 }, { 3, 1 });
  d.Add({ 30, 10 }, { 0, 0 });
  d.Add({ 9, 3 }, { 9, 3 });
  const SnappedSegments snapped = nurbs::SnapRound(d.Points, d.Segments);
  EXPECT_EQ(snapped.Vertices.size(), 5u);
  EXPECT_EQ(snapped.Edges.size(), 4u);
  const std::vector<std::int64_t> starts{ 0, 4, 6, 10, 10 };
  EXPECT_EQ(snapped.PathStart, starts);
  const std::vector<std::int32_t> path{ 0, 1, 2, 3, ~2, ~1, ~3, ~2, ~1, ~0 };
  EXPECT_EQ(snapped.Path, path);
}

TEST(SnapRounding, SameInAnyOrderAndOnThreads)
{
  std::mt19937 random(4);
  Drawing d = RandomDrawing(random, 1500, 2000, 2000);
  const SnappedSegments one = nurbs::SnapRound(d.Points, d.Segments);
  const SnappedSegments many = nurbs::SnapRound(d.Points, d.Segments, BackwardsFor);
  EXPECT_EQ(many.Vertices, one.Vertices);
  EXPECT_EQ(many.Edges, one.Edges);
  EXPECT_EQ(many.PathStart, one.PathStart);
  EXPECT_EQ(many.Path, one.Path);
  std::shuffle(d.Segments.begin(), d.Segments.end(), random);
  for (GridSegment& s : d.Segments)
  {
    if (random() % 2)
    {
      std::swap(s.Start, s.End);
    }
  }
  const SnappedSegments other = nurbs::SnapRound(d.Points, d.Segments);
  EXPECT_EQ(other.Vertices, one.Vertices);
  EXPECT_EQ(other.Edges, one.Edges);
}

TEST(SnapRounding, Hatchings)
{
  // Both families have their ends outside the square in which each line crosses each other one.
  constexpr int count = 30;
  Drawing d;
  for (int i = 0; i < count; ++i)
  {
    d.Add({ -100, 100 * i }, { 100 * count, 100 * i + 7 });
    d.Add({ 100 * i, -100 }, { 100 * i, 100 * count });
  }
  ExpectLikeDefinition(d);
  const SnappedSegments snapped = nurbs::SnapRound(d.Points, d.Segments);
  EXPECT_EQ(snapped.Vertices.size(), std::size_t(count * count + 4 * count));
  EXPECT_EQ(snapped.Edges.size(), std::size_t(2 * count * (count + 1)));
}

// No line's box is apart from another one's, but no two lines cross.
TEST(SnapRounding, ManyLongParallels)
{
  constexpr int count = 100000;
  Drawing d;
  for (int i = 0; i < count; ++i)
  {
    d.Add({ -GridLimit + 4000 * i, -GridLimit }, { 4000 * i, GridLimit });
  }
  const SnappedSegments snapped = nurbs::SnapRound(d.Points, d.Segments, BackwardsFor);
  EXPECT_EQ(snapped.Vertices.size(), std::size_t(2 * count));
  EXPECT_EQ(snapped.Edges.size(), std::size_t(count));
  EXPECT_EQ(snapped.Path.size(), std::size_t(count));
}

TEST(SnapRounding, ManyShortSegments)
{
  constexpr std::int64_t size = 1000000;
  std::mt19937 random(5);
  Drawing d;
  for (int i = 0; i < 100000; ++i)
  {
    const GridPoint a{ Random(random, 0, size), Random(random, 0, size) };
    d.Add(a, { a.X + Random(random, -5000, 5000), a.Y + Random(random, -5000, 5000) });
  }
  const SnappedSegments snapped = nurbs::SnapRound(d.Points, d.Segments, BackwardsFor);
  for (std::size_t s = 0; s < d.Segments.size(); ++s)
  {
    PathOf(snapped, d, s);
  }
  ASSERT_FALSE(HasFailure());
  EXPECT_GT(snapped.Vertices.size(), 2 * d.Segments.size());
  // Small drawings tell that the search misses nothing.
  std::vector<nurbs::GridLine> lines;
  for (const auto& e : snapped.Edges)
  {
    lines.push_back({ snapped.Vertices[e[0]], snapped.Vertices[e[1]] });
  }
  EXPECT_TRUE(nurbs::CrossingPixels(lines, nurbs::SerialFor, [](double) { return true; }).empty());
}

TEST(SnapRounding, EmptyInput)
{
  const SnappedSegments none = nurbs::SnapRound({}, {});
  EXPECT_TRUE(none.Vertices.empty() && none.Edges.empty() && none.Path.empty());
  EXPECT_EQ(none.PathStart, std::vector<std::int64_t>(1, 0));
  // A point alone isn't used; a segment of no length is.
  const SnappedSegments dot = nurbs::SnapRound({ { 1, 2 }, { 3, 4 } }, { { 1, 1 } });
  EXPECT_EQ(dot.Vertices, std::vector<GridPoint>(1, GridPoint{ 3, 4 }));
  EXPECT_TRUE(dot.Edges.empty());
  EXPECT_EQ(dot.PathStart, std::vector<std::int64_t>(2, 0));
}

TEST(SnapRounding, BadInput)
{
  EXPECT_THROW(nurbs::SnapRound({ { GridLimit + 1, 0 } }, {}), nurbs::Error);
  EXPECT_THROW(nurbs::SnapRound({ { 0, -GridLimit - 1 } }, {}), nurbs::Error);
  EXPECT_THROW(nurbs::SnapRound({ { 0, 0 } }, { { 0, 1 } }), nurbs::Error);
  EXPECT_THROW(nurbs::SnapRound({ { 0, 0 } }, { { -1, 0 } }), nurbs::Error);
}

TEST(SnapRounding, ProgressAndAbort)
{
  std::mt19937 random(6);
  const Drawing d = RandomDrawing(random, 600, 5000, 5000);
  double last = 0.0;
  const auto follow = [&](double share) {
    EXPECT_GE(share, last);
    last = share;
    return true;
  };
  EXPECT_FALSE(nurbs::SnapRound(d.Points, d.Segments, nurbs::SerialFor, follow).Aborted);
  EXPECT_EQ(last, 1.0);
  for (const double limit : { 0.0, 0.2, 0.5, 0.7, 0.95, 1.0 })
  {
    const SnappedSegments stopped = nurbs::SnapRound(
      d.Points, d.Segments, BackwardsFor, [limit](double share) { return share < limit; });
    EXPECT_TRUE(stopped.Aborted);
    EXPECT_TRUE(stopped.Vertices.empty() && stopped.Edges.empty() && stopped.Path.empty());
  }
}

} // namespace
