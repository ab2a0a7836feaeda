// SPDX-License-Identifier: BSD-3-Clause
// Cells of the plane against loops traced around them in exact arithmetic, against a search of the
// edge below a point, and against pictures.
#include "PlanarMap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

namespace
{

using nurbs::GridPoint;
using nurbs::PlanarMap;
using nurbs::PlanarSample;
using nurbs::SnappedSegments;
using nurbs::Vec2;

std::int64_t Cross(const GridPoint& a, const GridPoint& b, const GridPoint& c)
{
  return (b.X - a.X) * (c.Y - a.Y) - (b.Y - a.Y) * (c.X - a.X);
}

// Segments from pairs of points, snapped.
SnappedSegments Snap(const std::vector<std::array<GridPoint, 2>>& pairs)
{
  std::vector<GridPoint> points;
  std::vector<nurbs::GridSegment> segments;
  for (const auto& pair : pairs)
  {
    const auto n = std::int32_t(points.size());
    points.insert(points.end(), pair.begin(), pair.end());
    segments.push_back({ n, n + 1 });
  }
  return nurbs::SnapRound(points, segments);
}

std::vector<std::array<GridPoint, 2>> Square(std::int64_t x, std::int64_t y, std::int64_t size)
{
  const GridPoint a{ x, y }, b{ x + size, y }, c{ x + size, y + size }, d{ x, y + size };
  return { { a, b }, { b, c }, { c, d }, { d, a } };
}

void Append(
  std::vector<std::array<GridPoint, 2>>& pairs, const std::vector<std::array<GridPoint, 2>>& more)
{
  pairs.insert(pairs.end(), more.begin(), more.end());
}

// Cells by their loops. The half-edge 2 e runs along the edge e, 2 e + 1 back; a cell is on its
// left.
class LoopReference
{
public:
  explicit LoopReference(const SnappedSegments& segments)
    : Segments(segments)
    , Component(segments.Vertices.size())
    , CellOf(2 * segments.Edges.size(), -1)
  {
    this->FindComponents();
    this->TraceLoops();
    this->AssignLoops();
  }

  int CellCount() const { return int(this->DoubleAreas.size()); }
  int ComponentCount() const
  {
    return int(std::set<int>(this->Component.begin(), this->Component.end()).size());
  }

  const SnappedSegments& Segments;
  std::vector<int> Component;
  std::vector<int> CellOf;               // of a half-edge
  std::vector<std::int64_t> DoubleAreas; // cell 0 is the outer one

private:
  struct Loop
  {
    std::vector<int> HalfEdges;
    std::int64_t DoubleArea = 0;
  };

  int Tail(int h) const { return this->Segments.Edges[h / 2][h % 2]; }
  int Head(int h) const { return this->Segments.Edges[h / 2][1 - h % 2]; }
  const GridPoint& At(int v) const { return this->Segments.Vertices[v]; }

  void FindComponents()
  {
    for (std::size_t v = 0; v < this->Component.size(); ++v)
    {
      this->Component[v] = int(v);
    }
    for (bool changed = true; changed;)
    {
      changed = false;
      for (const auto& e : this->Segments.Edges)
      {
        const int least = std::min(this->Component[e[0]], this->Component[e[1]]);
        changed = changed || this->Component[e[0]] != this->Component[e[1]];
        this->Component[e[0]] = this->Component[e[1]] = least;
      }
    }
  }

  // Around a vertex, anticlockwise from the positive x axis.
  bool IsEarlier(int g, int h) const
  {
    const GridPoint& o = this->At(this->Tail(g));
    const GridPoint& a = this->At(this->Head(g));
    const GridPoint& b = this->At(this->Head(h));
    const auto lower = [&o](const GridPoint& p) { return p.Y < o.Y || (p.Y == o.Y && p.X < o.X); };
    return lower(a) != lower(b) ? lower(b) : Cross(o, a, b) > 0;
  }

  void TraceLoops()
  {
    std::vector<std::vector<int>> leaving(this->Segments.Vertices.size());
    for (int h = 0; h < int(this->CellOf.size()); ++h)
    {
      leaving[this->Tail(h)].push_back(h);
    }
    for (auto& around : leaving)
    {
      std::sort(around.begin(), around.end(), [this](int g, int h) { return IsEarlier(g, h); });
    }
    std::vector<char> done(this->CellOf.size(), 0);
    for (int first = 0; first < int(done.size()); ++first)
    {
      Loop loop;
      for (int h = first; !done[h];)
      {
        done[h] = 1;
        loop.HalfEdges.push_back(h);
        loop.DoubleArea += Cross({ 0, 0 }, this->At(this->Tail(h)), this->At(this->Head(h)));
        const std::vector<int>& around = leaving[this->Head(h)];
        const auto back = std::find(around.begin(), around.end(), h ^ 1) - around.begin();
        h = around[(back + around.size() - 1) % around.size()];
      }
      if (!loop.HalfEdges.empty())
      {
        this->Loops.push_back(loop);
      }
    }
  }

  // Loops that run clockwise, or around nothing, are in the smallest loop around their component.
  void AssignLoops()
  {
    std::vector<int> cellOfLoop(this->Loops.size(), 0);
    this->DoubleAreas.assign(1, 0);
    for (std::size_t l = 0; l < this->Loops.size(); ++l)
    {
      if (this->Loops[l].DoubleArea > 0)
      {
        cellOfLoop[l] = int(this->DoubleAreas.size());
        this->DoubleAreas.push_back(this->Loops[l].DoubleArea);
      }
    }
    for (std::size_t l = 0; l < this->Loops.size(); ++l)
    {
      if (this->Loops[l].DoubleArea > 0)
      {
        continue;
      }
      const int vertex = this->Tail(this->Loops[l].HalfEdges[0]);
      std::int64_t smallest = std::numeric_limits<std::int64_t>::max();
      for (std::size_t k = 0; k < this->Loops.size(); ++k)
      {
        const Loop& around = this->Loops[k];
        if (around.DoubleArea > 0 && around.DoubleArea < smallest &&
          this->Component[vertex] != this->Component[this->Tail(around.HalfEdges[0])] &&
          this->IsInside(this->At(vertex), around))
        {
          smallest = around.DoubleArea;
          cellOfLoop[l] = cellOfLoop[k];
        }
      }
      this->DoubleAreas[cellOfLoop[l]] += this->Loops[l].DoubleArea;
    }
    for (std::size_t l = 0; l < this->Loops.size(); ++l)
    {
      for (const int h : this->Loops[l].HalfEdges)
      {
        this->CellOf[h] = cellOfLoop[l];
      }
    }
  }

  bool IsInside(const GridPoint& p, const Loop& loop) const
  {
    bool inside = false;
    for (const int h : loop.HalfEdges)
    {
      const GridPoint& a = this->At(this->Tail(h));
      const GridPoint& b = this->At(this->Head(h));
      if ((a.X <= p.X) != (b.X <= p.X) && (Cross(a, b, p) > 0) == (a.X < b.X))
      {
        inside = !inside;
      }
    }
    return inside;
  }

  std::vector<Loop> Loops;
};

// The cell of a point that is not straight above a vertex: that above the highest edge below it.
int CellAt(const SnappedSegments& segments, const PlanarMap& map, const Vec2& p)
{
  double highest = -std::numeric_limits<double>::infinity();
  int cell = 0;
  for (std::size_t e = 0; e < segments.Edges.size(); ++e)
  {
    const GridPoint& a = segments.Vertices[segments.Edges[e][0]];
    const GridPoint& b = segments.Vertices[segments.Edges[e][1]];
    if (double(a.X) <= p[0] && p[0] < double(b.X))
    {
      const double y = a.Y + double(b.Y - a.Y) * (p[0] - a.X) / double(b.X - a.X);
      if (y < p[1] && y > highest)
      {
        highest = y;
        cell = map.Sides[e][0];
      }
    }
  }
  return cell;
}

double Distance(const Vec2& p, const GridPoint& a, const GridPoint& b)
{
  const Vec2 from(a.X, a.Y);
  const Vec2 along = Vec2(b.X, b.Y) - from;
  const double t = std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - from - t * along).norm();
}

/// True if no edge but `own` crosses the way from a to b.
bool IsClear(const SnappedSegments& segments, std::size_t own, const Vec2& a, const Vec2& b)
{
  const auto turn = [](const Vec2& p, const Vec2& q, const Vec2& r) {
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
  };
  for (std::size_t e = 0; e < segments.Edges.size(); ++e)
  {
    const GridPoint& start = segments.Vertices[segments.Edges[e][0]];
    const GridPoint& end = segments.Vertices[segments.Edges[e][1]];
    const Vec2 p(double(start.X), double(start.Y));
    const Vec2 q(double(end.X), double(end.Y));
    if (e != own && turn(a, b, p) * turn(a, b, q) < 0.0 && turn(p, q, a) * turn(p, q, b) < 0.0)
    {
      return false;
    }
  }
  return true;
}

void ExpectFree(
  const SnappedSegments& segments, const PlanarMap& map, const PlanarSample& sample, int cell)
{
  EXPECT_GT(sample.Radius, 0.0);
  // Aside, as vertices may be straight below.
  const Vec2 aside = sample.Point + Vec2(0.0123 * sample.Radius, 0.0);
  EXPECT_EQ(CellAt(segments, map, aside), cell) << sample.Point.transpose();
  for (const auto& e : segments.Edges)
  {
    EXPECT_GE(Distance(sample.Point, segments.Vertices[e[0]], segments.Vertices[e[1]]),
      sample.Radius * (1.0 - 1e-9));
  }
}

void ExpectSamples(const SnappedSegments& segments, const PlanarMap& map, int most)
{
  ASSERT_EQ(map.SampleStart.size(), std::size_t(map.CellCount) + 1);
  ASSERT_EQ(map.SampleStart.back(), std::int64_t(map.Samples.size()));
  for (int c = 0; c < map.CellCount; ++c)
  {
    const std::int64_t begin = map.SampleStart[c];
    const std::int64_t end = map.SampleStart[c + 1];
    EXPECT_GE(end - begin, 1);
    EXPECT_LE(end - begin, c == 0 ? 1 : most);
    for (std::int64_t i = begin; i < end; ++i)
    {
      ExpectFree(segments, map, map.Samples[i], c);
      EXPECT_TRUE(i == begin || map.Samples[i].Radius <= map.Samples[i - 1].Radius);
    }
  }
  ASSERT_EQ(map.SideSamples.size(), segments.Edges.size());
  for (std::size_t e = 0; e < segments.Edges.size(); ++e)
  {
    for (int side = 0; side < 2; ++side)
    {
      const PlanarSample& sample = map.SideSamples[e][side];
      EXPECT_GT(sample.Radius, 0.0);
      EXPECT_LE(sample.Radius, nurbs::SideReach);
      // It is on that side, and seen from the edge.
      const GridPoint& a = segments.Vertices[segments.Edges[e][0]];
      const GridPoint& b = segments.Vertices[segments.Edges[e][1]];
      const double turn =
        double(b.X - a.X) * (sample.Point[1] - a.Y) - double(b.Y - a.Y) * (sample.Point[0] - a.X);
      EXPECT_EQ(turn > 0.0, side == 0);
      EXPECT_NEAR(std::abs(turn) / std::hypot(b.X - a.X, b.Y - a.Y), sample.Radius, 1e-9);
      // No edge crosses the way twice as far.
      const Vec2 middle(0.5 * double(a.X + b.X), 0.5 * double(a.Y + b.Y));
      EXPECT_NEAR((sample.Point - middle).norm(), sample.Radius, 1e-9);
      EXPECT_TRUE(
        IsClear(segments, e, middle, middle + 2.0 * (1.0 - 1e-9) * (sample.Point - middle)));
    }
  }
}

void ExpectLikeLoops(const SnappedSegments& segments)
{
  const PlanarMap map = nurbs::MakePlanarMap(segments, 4);
  const LoopReference reference(segments);
  ASSERT_EQ(map.CellCount, reference.CellCount());
  // Euler's formula.
  EXPECT_EQ(map.CellCount,
    int(segments.Edges.size()) - int(segments.Vertices.size()) + 1 + reference.ComponentCount());
  ASSERT_EQ(map.Sides.size(), segments.Edges.size());
  std::map<int, int> same{ { 0, 0 } };
  int fresh = 1;
  for (std::size_t e = 0; e < segments.Edges.size(); ++e)
  {
    for (int side = 0; side < 2; ++side)
    {
      const auto [at, isNew] = same.emplace(reference.CellOf[2 * e + side], map.Sides[e][side]);
      EXPECT_EQ(at->second, map.Sides[e][side]);
      // Numbered as they come.
      EXPECT_TRUE(!isNew || map.Sides[e][side] == fresh);
      fresh += isNew;
    }
  }
  EXPECT_EQ(fresh, map.CellCount);
  ASSERT_EQ(map.Areas.size(), std::size_t(map.CellCount));
  EXPECT_TRUE(std::isinf(map.Areas[0]));
  for (const auto& pair : same)
  {
    if (pair.second > 0)
    {
      EXPECT_EQ(map.Areas[pair.second], 0.5 * double(reference.DoubleAreas[pair.first]));
    }
  }
  ExpectSamples(segments, map, 4);
}

SnappedSegments RandomSegments(std::mt19937& random, int count, int size, int length)
{
  const auto number = [&random](int low, int high) {
    return std::int64_t(std::uniform_int_distribution<int>(low, high)(random));
  };
  std::vector<std::array<GridPoint, 2>> pairs;
  for (int i = 0; i < count; ++i)
  {
    const GridPoint a{ number(0, size), number(0, size) };
    pairs.push_back({ a, { a.X + number(-length, length), a.Y + number(-length, length) } });
  }
  return Snap(pairs);
}

TEST(PlanarMap, RandomSegmentsLikeLoops)
{
  std::mt19937 random(1);
  for (const int size : { 3, 6, 12, 40, 300 })
  {
    for (int trial = 0; trial < 25; ++trial)
    {
      SCOPED_TRACE(testing::Message() << size << " / " << trial);
      ExpectLikeLoops(RandomSegments(random, 1 + trial, size, size));
      ExpectLikeLoops(RandomSegments(random, 2 * trial, size, 1 + size / 4));
      ASSERT_FALSE(HasFailure());
    }
  }
}

TEST(PlanarMap, IslandsInLakesLikeLoops)
{
  std::mt19937 random(2);
  for (int trial = 0; trial < 20; ++trial)
  {
    SCOPED_TRACE(trial);
    std::vector<std::array<GridPoint, 2>> pairs;
    for (int i = 0; i < 25; ++i)
    {
      Append(pairs, Square(random() % 200, random() % 200, 1 + random() % (trial % 2 ? 12 : 120)));
    }
    ExpectLikeLoops(Snap(pairs));
    ASSERT_FALSE(HasFailure());
  }
}

// A picture of 16 x 16 points a pixel: what no edge divides is one cell, and areas are counts.
TEST(PlanarMap, RandomSegmentsLikePictures)
{
  constexpr int size = 10;
  constexpr int fine = 16;
  constexpr int width = (size + 2) * fine;
  std::mt19937 random(3);
  for (int trial = 0; trial < 5; ++trial)
  {
    SCOPED_TRACE(trial);
    const SnappedSegments segments = RandomSegments(random, 9, size, size / 2);
    const PlanarMap map = nurbs::MakePlanarMap(segments);
    // Odd fractions: no point is on an edge.
    const auto place = [](int i, int j) {
      return Vec2(-1.0 + (i + 0.5237) / fine, -1.0 + (j + 0.4891) / fine);
    };
    const auto divided = [&segments](const Vec2& p, const Vec2& q) {
      const auto turn = [](const Vec2& a, const Vec2& b, const Vec2& c) {
        return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0.0;
      };
      for (const auto& e : segments.Edges)
      {
        const GridPoint& s = segments.Vertices[e[0]];
        const GridPoint& t = segments.Vertices[e[1]];
        const Vec2 a(s.X, s.Y);
        const Vec2 b(t.X, t.Y);
        if (turn(a, b, p) != turn(a, b, q) && turn(p, q, a) != turn(p, q, b))
        {
          return true;
        }
      }
      return false;
    };
    // Flood fill from each point that has no number yet.
    std::vector<int> cell(width * width, -1);
    std::vector<double> areas(map.CellCount, 0.0);
    std::vector<std::set<std::array<int, 2>>> regions(map.CellCount);
    for (int first = 0; first < width * width; ++first)
    {
      if (cell[first] >= 0)
      {
        continue;
      }
      const int number = CellAt(segments, map, place(first % width, first / width));
      std::vector<int> stack(1, first);
      cell[first] = number;
      while (!stack.empty())
      {
        const int at = stack.back();
        stack.pop_back();
        areas[number] += 1.0 / (fine * fine);
        const int i = at % width;
        const int j = at / width;
        EXPECT_EQ(CellAt(segments, map, place(i, j)), number);
        for (const auto& step :
          { std::array<int, 2>{ i + 1, j }, { i - 1, j }, { i, j + 1 }, { i, j - 1 } })
        {
          const bool in = step[0] >= 0 && step[0] < width && step[1] >= 0 && step[1] < width;
          const int next = step[1] * width + step[0];
          if (in && cell[next] < 0 && !divided(place(i, j), place(step[0], step[1])))
          {
            cell[next] = number;
            stack.push_back(next);
          }
        }
      }
    }
    for (int c = 1; c < map.CellCount; ++c)
    {
      double around = 0.0;
      for (std::size_t e = 0; e < segments.Edges.size(); ++e)
      {
        const GridPoint& a = segments.Vertices[segments.Edges[e][0]];
        const GridPoint& b = segments.Vertices[segments.Edges[e][1]];
        around += (map.Sides[e][0] == c || map.Sides[e][1] == c) * std::hypot(b.X - a.X, b.Y - a.Y);
      }
      EXPECT_NEAR(areas[c], map.Areas[c], 0.5 * around / fine);
    }
  }
}

TEST(PlanarMap, NestedSquares)
{
  std::vector<std::array<GridPoint, 2>> pairs = Square(0, 0, 100);
  Append(pairs, Square(10, 10, 80));
  Append(pairs, Square(20, 20, 60));
  Append(pairs, Square(200, 0, 5));
  pairs.push_back({ GridPoint{ 50, 50 }, GridPoint{ 55, 55 } });  // floats in the innermost one
  pairs.push_back({ GridPoint{ 100, 50 }, GridPoint{ 95, 50 } }); // ends in the outermost one
  const SnappedSegments segments = Snap(pairs);
  const PlanarMap map = nurbs::MakePlanarMap(segments);
  ASSERT_EQ(map.CellCount, 5);
  std::vector<double> areas(map.Areas.begin() + 1, map.Areas.end());
  std::sort(areas.begin(), areas.end());
  EXPECT_EQ(areas, (std::vector<double>{ 25.0, 2800.0, 3600.0, 3600.0 }));
  ExpectLikeLoops(segments);
}

TEST(PlanarMap, WithoutTriangles)
{
  const PlanarMap none = nurbs::MakePlanarMap(SnappedSegments());
  EXPECT_EQ(none.CellCount, 1);
  EXPECT_TRUE(none.Sides.empty());
  EXPECT_EQ(none.Samples.size(), 1u);
  EXPECT_TRUE(std::isinf(none.Areas.at(0)));
  // One point; one edge; edges and a point on a line, not next to each other.
  ExpectLikeLoops(Snap({ { GridPoint{ 5, 5 }, GridPoint{ 5, 5 } } }));
  ExpectLikeLoops(Snap({ { GridPoint{ 5, 5 }, GridPoint{ 7, 9 } } }));
  ExpectLikeLoops(Snap({ { GridPoint{ 0, 0 }, GridPoint{ 1, 2 } },
    { GridPoint{ 3, 6 }, GridPoint{ 4, 8 } }, { GridPoint{ 9, 18 }, GridPoint{ 9, 18 } } }));
  // Points alone, and an edge with a point beside it.
  ExpectLikeLoops(Snap({ { GridPoint{ 0, 0 }, GridPoint{ 0, 0 } },
    { GridPoint{ 9, 1 }, GridPoint{ 9, 1 } }, { GridPoint{ 3, 3 }, GridPoint{ 3, 3 } } }));
  ExpectLikeLoops(
    Snap({ { GridPoint{ 0, 0 }, GridPoint{ 8, 0 } }, { GridPoint{ 3, 3 }, GridPoint{ 3, 3 } } }));
}

// Many points on one circle, and many edges at one vertex.
TEST(PlanarMap, LatticeAndStar)
{
  constexpr int count = 60;
  std::vector<std::array<GridPoint, 2>> pairs;
  for (int i = 0; i <= count; ++i)
  {
    pairs.push_back({ GridPoint{ 0, 10 * i }, GridPoint{ 10 * count, 10 * i } });
    pairs.push_back({ GridPoint{ 10 * i, 0 }, GridPoint{ 10 * i, 10 * count } });
  }
  const PlanarMap lattice = nurbs::MakePlanarMap(Snap(pairs));
  ASSERT_EQ(lattice.CellCount, count * count + 1);
  EXPECT_TRUE(std::all_of(
    lattice.Areas.begin() + 1, lattice.Areas.end(), [](double area) { return area == 100.0; }));
  pairs.clear();
  for (int i = 0; i < 20000; ++i)
  {
    const double angle = i * 2.0 * EIGEN_PI / 20000;
    const GridPoint tip{ std::llround(5e8 * std::cos(angle)), std::llround(5e8 * std::sin(angle)) };
    pairs.push_back({ GridPoint{ 0, 0 }, tip });
  }
  const SnappedSegments star = Snap(pairs);
  EXPECT_EQ(star.Edges.size(), 20000u);
  EXPECT_EQ(nurbs::MakePlanarMap(star).CellCount, 1);
}

// Edges that the Delaunay triangulation of their ends has not: each cuts through all of it.
TEST(PlanarMap, ManyLongParallels)
{
  std::vector<std::array<GridPoint, 2>> pairs;
  constexpr std::int64_t size = 400000000;
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i)
  {
    const std::int64_t x = size / count * i;
    pairs.push_back({ GridPoint{ x - size, 0 }, GridPoint{ x, size } });
  }
  pairs.push_back({ GridPoint{ -size, -1 }, GridPoint{ size, -1 } });
  pairs.push_back({ GridPoint{ -size, 0 }, GridPoint{ -size, -1 } });
  const PlanarMap map = nurbs::MakePlanarMap(Snap(pairs));
  EXPECT_EQ(map.CellCount, 1);
}

TEST(PlanarMap, LargestCoordinates)
{
  constexpr std::int64_t far = nurbs::GridLimit;
  std::vector<std::array<GridPoint, 2>> pairs = Square(-far, -far, 2 * far);
  Append(pairs, Square(-far, -far, 1));
  Append(pairs, Square(far - 1, far - 1, 1));
  pairs.push_back({ GridPoint{ -far, far }, GridPoint{ far, -far } });
  const PlanarMap map = nurbs::MakePlanarMap(Snap(pairs));
  ASSERT_EQ(map.CellCount, 5);
  std::vector<double> areas(map.Areas.begin() + 1, map.Areas.end());
  std::sort(areas.begin(), areas.end());
  const double half = 2.0 * far * far;
  EXPECT_EQ(areas, (std::vector<double>{ 1.0, 1.0, half - 1.0, half - 1.0 }));
}

TEST(PlanarMap, BadInput)
{
  SnappedSegments segments;
  segments.Vertices = { { 0, 0 }, { 10, 10 }, { 0, 10 }, { 10, 0 }, { 5, 5 } };
  segments.Edges = { { 0, 2 }, { 2, 4 } };
  EXPECT_NO_THROW(nurbs::MakePlanarMap(segments));
  EXPECT_THROW(nurbs::MakePlanarMap(segments, 0), nurbs::Error);
  const auto fails = [&segments](const std::vector<std::array<std::int32_t, 2>>& edges) {
    SnappedSegments bad = segments;
    bad.Edges = edges;
    EXPECT_THROW(nurbs::MakePlanarMap(bad), nurbs::Error);
  };
  fails({ { 0, 5 } });
  fails({ { -1, 2 } });
  fails({ { 2, 2 } });
  fails({ { 2, 0 } });
  fails({ { 2, 3 }, { 0, 2 } });
  fails({ { 0, 2 }, { 0, 2 } });
  fails({ { 0, 1 } }); // through a vertex
  segments.Vertices[4] = { 5, 4 };
  fails({ { 0, 1 }, { 2, 3 } }); // across
  segments.Vertices[4] = { 0, 0 };
  fails({ { 0, 2 } });
  segments.Vertices[4] = { nurbs::GridLimit + 1, 0 };
  fails({ { 0, 2 } });
  segments.Vertices = { { 0, 0 }, { 1, 1 }, { 2, 2 } };
  fails({ { 0, 2 } }); // through a vertex, and all on a line
}

TEST(PlanarMap, ProgressAndAbort)
{
  std::mt19937 random(4);
  const SnappedSegments segments = RandomSegments(random, 500, 5000, 2000);
  double last = 0.0;
  const auto follow = [&last](double share) {
    EXPECT_GE(share, last);
    last = share;
    return true;
  };
  EXPECT_FALSE(nurbs::MakePlanarMap(segments, 1, follow).Aborted);
  EXPECT_EQ(last, 1.0);
  for (const double limit : { 0.0, 0.5, 1.0 })
  {
    const PlanarMap stopped =
      nurbs::MakePlanarMap(segments, 1, [limit](double share) { return share < limit; });
    EXPECT_TRUE(stopped.Aborted);
    EXPECT_TRUE(stopped.Sides.empty() && stopped.Areas.empty() && stopped.Samples.empty());
  }
}

} // namespace
