// SPDX-License-Identifier: BSD-3-Clause
#include "PlanarMap.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/spatial_sort.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace nurbs
{

namespace
{

__extension__ using Wide = __int128;
using Plane = CGAL::Simple_cartesian<double>;

// Points of the grid are doubles without a fraction. Differences are at most 2^30, so an
// orientation is at most 2^61, and the determinant of a circle at most 3 * 2^122: exact in 64 and
// 128 bits. Grids have many points on one circle, where CGAL's own filters would fail and its slow
// arithmetic run.
struct GridDifference
{
  GridDifference(const Plane::Point_2& p, const Plane::Point_2& from)
    : X(std::int64_t(p.x()) - std::int64_t(from.x()))
    , Y(std::int64_t(p.y()) - std::int64_t(from.y()))
  {}
  std::int64_t Cross(const GridDifference& d) const { return this->X * d.Y - this->Y * d.X; }
  std::int64_t Square() const { return this->X * this->X + this->Y * this->Y; }
  std::int64_t X, Y;
};

struct GridOrientation
{
  using result_type = CGAL::Orientation;
  result_type operator()(
    const Plane::Point_2& a, const Plane::Point_2& b, const Plane::Point_2& c) const
  {
    const std::int64_t turn = GridDifference(b, a).Cross(GridDifference(c, a));
    return turn > 0 ? CGAL::LEFT_TURN : (turn < 0 ? CGAL::RIGHT_TURN : CGAL::COLLINEAR);
  }
};

struct GridCircleSide
{
  using result_type = CGAL::Oriented_side;
  result_type operator()(const Plane::Point_2& a, const Plane::Point_2& b, const Plane::Point_2& c,
    const Plane::Point_2& d) const
  {
    const GridDifference p(a, d);
    const GridDifference q(b, d);
    const GridDifference r(c, d);
    const Wide inside =
      Wide(p.Square()) * q.Cross(r) + Wide(q.Square()) * r.Cross(p) + Wide(r.Square()) * p.Cross(q);
    return inside > 0 ? CGAL::ON_POSITIVE_SIDE
                      : (inside < 0 ? CGAL::ON_NEGATIVE_SIDE : CGAL::ON_ORIENTED_BOUNDARY);
  }
};

struct GridTraits : Plane
{
  using Orientation_2 = GridOrientation;
  using Side_of_oriented_circle_2 = GridCircleSide;
  Orientation_2 orientation_2_object() const { return {}; }
  Side_of_oriented_circle_2 side_of_oriented_circle_2_object() const { return {}; }
};

using FaceBase = CGAL::Constrained_triangulation_face_base_2<GridTraits,
  CGAL::Triangulation_face_base_with_info_2<std::int32_t, GridTraits>>;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::int32_t, GridTraits>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<GridTraits, Structure,
  CGAL::No_constraint_intersection_tag>;
using Vertex = Triangulation::Vertex_handle;
using Face = Triangulation::Face_handle;
constexpr std::int32_t NoCell = -1;
// Triangles on the way from an edge to the next: beyond, it is not looked for.
constexpr int LongestWalk = 64;

// About how the time divides.
constexpr double VerticesShare = 0.55;
constexpr double EdgesShare = 0.75;
constexpr std::size_t ItemsPerReport = 16384;

void CheckInput(const SnappedSegments& segments, int samplesPerCell)
{
  if (samplesPerCell < 1)
  {
    throw Error("MakePlanarMap: fewer than one sample per cell");
  }
  for (const GridPoint& p : segments.Vertices)
  {
    if (p.X < -GridLimit || p.X > GridLimit || p.Y < -GridLimit || p.Y > GridLimit)
    {
      throw Error("MakePlanarMap: a coordinate exceeds 2^29 pixels");
    }
  }
  for (std::size_t i = 0; i < segments.Edges.size(); ++i)
  {
    const std::array<std::int32_t, 2>& e = segments.Edges[i];
    if (e[0] < 0 || e[0] >= e[1] || std::size_t(e[1]) >= segments.Vertices.size() ||
      (i > 0 && !(segments.Edges[i - 1] < e)))
    {
      throw Error("MakePlanarMap: edges must be sorted pairs of vertices that are there");
    }
  }
}

struct Stopped
{};

class MapMaker
{
public:
  MapMaker(
    const SnappedSegments& segments, const std::function<bool(double)>& progress, double sideReach)
    : Segments(segments)
    , Progress(progress)
    , Reach(sideReach)
  {}

  PlanarMap Make(int samplesPerCell, bool diagonals)
  {
    this->InsertVertices();
    this->InsertEdges();
    this->FindFaces();
    this->MarkCells();
    this->SampleSides();
    this->SampleCells(std::size_t(samplesPerCell));
    if (diagonals && !this->IsFlat())
    {
      this->CollectDiagonals();
    }
    this->Report(1.0);
    return std::move(this->Map);
  }

private:
  void InsertVertices()
  {
    std::vector<Plane::Point_2> points;
    points.reserve(this->Segments.Vertices.size());
    for (const GridPoint& p : this->Segments.Vertices)
    {
      points.emplace_back(double(p.X), double(p.Y));
    }
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    using PointMap = CGAL::Pointer_property_map<Plane::Point_2>::type;
    CGAL::spatial_sort(order.begin(), order.end(),
      CGAL::Spatial_sort_traits_adapter_2<GridTraits, PointMap>(CGAL::make_property_map(points)));
    this->Vertices.resize(points.size());
    this->Rank.resize(points.size());
    Face near;
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      this->ReportItem(i, order.size(), 0.0, VerticesShare);
      const Vertex v = this->Mesh.insert(points[order[i]], near);
      v->info() = std::int32_t(order[i]);
      this->Vertices[order[i]] = v;
      this->Rank[order[i]] = std::int32_t(i);
      near = v->face();
    }
    if (this->Mesh.number_of_vertices() != points.size())
    {
      throw Error("MakePlanarMap: vertices are equal");
    }
  }

  // Most edges are in the triangulation already.
  void InsertEdges()
  {
    const std::size_t count = this->Segments.Edges.size();
    if (this->IsFlat())
    {
      return;
    }
    this->CountEdges();
    std::vector<char> there(count, 0);
    this->ForEachEdge([&](std::size_t e, Face face, int index) {
      const int mirror = this->Mesh.mirror_index(face, index);
      face->set_constraint(index, true);
      face->neighbor(index)->set_constraint(mirror, true);
      there[e] = 1;
    });
    std::vector<std::size_t> missing;
    for (std::size_t e = 0; e < count; ++e)
    {
      if (!there[e])
      {
        missing.push_back(e);
      }
    }
    this->SortForInsertion(missing);
    for (std::size_t i = 0; i < missing.size(); ++i)
    {
      this->ReportItem(i, missing.size(), VerticesShare, EdgesShare);
      this->InsertEdge(missing[i]);
    }
  }

  void CountEdges()
  {
    this->FirstEdge.assign(this->Vertices.size() + 1, 0);
    this->EdgesAt.assign(this->Vertices.size(), 0);
    for (const std::array<std::int32_t, 2>& e : this->Segments.Edges)
    {
      ++this->FirstEdge[e[0] + 1];
      ++this->EdgesAt[e[0]];
      ++this->EdgesAt[e[1]];
    }
    std::partial_sum(this->FirstEdge.begin(), this->FirstEdge.end(), this->FirstEdge.begin());
  }

  // Edges in the order of their places can each cut through nearly all triangles; in a random one,
  // few do (J. R. Shewchuk, B. C. Brown, "Fast segment insertion and incremental construction of
  // constrained Delaunay triangulations", 2015). Random rounds, each twice as large as the one
  // before and in the order of places, are as good and keep memory near (N. Amenta, S. Choi, G.
  // Rote, "Incremental constructions con BRIO", 2003).
  void SortForInsertion(std::vector<std::size_t>& edges) const
  {
    constexpr std::size_t Smallest = 64;
    std::shuffle(edges.begin(), edges.end(), std::mt19937(1));
    for (std::size_t end = edges.size(); end > 0;)
    {
      const std::size_t begin = end > Smallest ? end / 2 : 0;
      std::sort(edges.begin() + begin, edges.begin() + end, [this](std::size_t a, std::size_t b) {
        const std::int32_t rankA = this->Rank[this->Segments.Edges[a][0]];
        const std::int32_t rankB = this->Rank[this->Segments.Edges[b][0]];
        return rankA != rankB ? rankA < rankB : a < b;
      });
      end = begin;
    }
  }

  // CGAL turns around the first vertex to find its way, which is better not the one with many
  // edges.
  void InsertEdge(std::size_t edge)
  {
    std::array<std::int32_t, 2> ends = this->Segments.Edges[edge];
    if (this->EdgesAt[ends[0]] > this->EdgesAt[ends[1]])
    {
      std::swap(ends[0], ends[1]);
    }
    try
    {
      this->Mesh.insert_constraint(this->Vertices[ends[0]], this->Vertices[ends[1]]);
    }
    catch (const Triangulation::Intersection_of_constraints_exception&)
    {
      throw Error("MakePlanarMap: edges cross");
    }
  }

  // All vertices are on one line, so there are no triangles.
  bool IsFlat() const { return this->Mesh.dimension() < 2; }

  // The edges that are in the triangulation; `body` gets the triangle on the left of each, and the
  // number of the edge there.
  template <typename F>
  void ForEachEdge(F&& body) const
  {
    for (const Triangulation::Edge& side : this->Mesh.finite_edges())
    {
      Face face = side.first;
      int index = side.second;
      std::int32_t start = face->vertex(Triangulation::ccw(index))->info();
      std::int32_t end = face->vertex(Triangulation::cw(index))->info();
      if (start > end)
      {
        std::swap(start, end);
        const int mirror = this->Mesh.mirror_index(face, index);
        face = face->neighbor(index);
        index = mirror;
      }
      const auto& edges = this->Segments.Edges;
      const auto last = edges.begin() + this->FirstEdge[start + 1];
      const std::array<std::int32_t, 2> wanted{ start, end };
      const auto at = std::lower_bound(edges.begin() + this->FirstEdge[start], last, wanted);
      if (at != last && *at == wanted)
      {
        body(std::size_t(at - edges.begin()), face, index);
      }
    }
  }

  // The triangles to the left and right of each edge.
  void FindFaces()
  {
    this->Beside.resize(this->Segments.Edges.size());
    std::size_t found = 0;
    if (this->IsFlat())
    {
      for (const std::array<std::int32_t, 2>& e : this->Segments.Edges)
      {
        found += this->Mesh.is_edge(this->Vertices[e[0]], this->Vertices[e[1]]);
      }
    }
    else
    {
      this->ForEachEdge([&](std::size_t e, Face face, int index) {
        this->Beside[e] = { face, face->neighbor(index) };
        ++found;
      });
    }
    if (found < this->Segments.Edges.size())
    {
      throw Error("MakePlanarMap: an edge passes through a vertex");
    }
  }

  void MarkCells()
  {
    this->Map.Sides.assign(this->Segments.Edges.size(), { 0, 0 });
    this->Map.CellCount = 1;
    if (this->IsFlat())
    {
      return;
    }
    for (const Face face : this->Mesh.all_face_handles())
    {
      face->info() = NoCell;
    }
    this->Fill(this->Mesh.infinite_face(), 0);
    for (std::size_t e = 0; e < this->Segments.Edges.size(); ++e)
    {
      const std::array<Face, 2>& faces = this->Beside[e];
      for (int side = 0; side < 2; ++side)
      {
        if (faces[side]->info() == NoCell)
        {
          this->Fill(faces[side], this->Map.CellCount++);
        }
        this->Map.Sides[e][side] = faces[side]->info();
      }
    }
  }

  void Fill(Face start, std::int32_t cell)
  {
    std::vector<Face> stack(1, start);
    start->info() = cell;
    while (!stack.empty())
    {
      const Face face = stack.back();
      stack.pop_back();
      for (int i = 0; i < 3; ++i)
      {
        const Face next = face->neighbor(i);
        if (!face->is_constrained(i) && next->info() == NoCell)
        {
          next->info() = cell;
          stack.push_back(next);
        }
      }
    }
  }

  static Vec2 Place(Vertex v) { return Vec2(v->point().x(), v->point().y()); }

  static std::int64_t DoubleArea(Face face)
  {
    return GridDifference(face->vertex(1)->point(), face->vertex(0)->point())
      .Cross(GridDifference(face->vertex(2)->point(), face->vertex(0)->point()));
  }

  static PlanarSample Incircle(Face face)
  {
    const Vec2 a = Place(face->vertex(0));
    const Vec2 ab = Place(face->vertex(1)) - a;
    const Vec2 ac = Place(face->vertex(2)) - a;
    const double lengthA = (ac - ab).norm();
    const double lengthB = ac.norm();
    const double lengthC = ab.norm();
    const double around = lengthA + lengthB + lengthC;
    return { a + (lengthB * ab + lengthC * ac) / around, double(DoubleArea(face)) / around };
  }

  // From the middle of an edge into the cell, straight away from it. Walks
  // through triangles till an edge bars the way.
  PlanarSample LookAside(std::size_t edge, int side) const
  {
    const Vec2 p = Position(this->Segments.Vertices[this->Segments.Edges[edge][0]]);
    const Vec2 q = Position(this->Segments.Vertices[this->Segments.Edges[edge][1]]);
    const Vec2 middle = 0.5 * (p + q);
    const Vec2 along = (side == 0 ? 1.0 : -1.0) * (q - p).normalized();
    const Vec2 way(-along[1], along[0]);
    double free = 2.0 * this->Reach;
    if (!this->IsFlat())
    {
      Face face = this->Beside[edge][side];
      int index = 0; // Of the edge that the way has come through.
      while (face->vertex(index) == this->Vertices[this->Segments.Edges[edge][0]] ||
        face->vertex(index) == this->Vertices[this->Segments.Edges[edge][1]])
      {
        ++index;
      }
      int passed = 0;
      for (double reached = 0.0; reached < free && !this->Mesh.is_infinite(face); ++passed)
      {
        if (passed == LongestWalk)
        {
          free = reached;
          break;
        }
        const Vec2 apex = Place(face->vertex(index)) - middle;
        if (std::abs(Cross(way, apex)) <= 1e-9 * (1.0 + apex.norm()))
        {
          free = std::min(free, way.dot(apex)); // Edges that end there may bar it.
          break;
        }
        // Left of the apex through the edge that is not the right end's, which follows the apex last.
        const bool leavesLeft = Cross(way, apex) < 0.0;
        const int out = leavesLeft ? Triangulation::cw(index) : Triangulation::ccw(index);
        const Vec2 a = Place(face->vertex(Triangulation::ccw(out))) - middle;
        const Vec2 b = Place(face->vertex(Triangulation::cw(out))) - middle;
        const double slope = Cross(way, b - a);
        reached = slope != 0.0 ? std::max(reached, Cross(a, b - a) / slope) : reached;
        if (face->is_constrained(out))
        {
          free = std::min(free, reached);
          break;
        }
        index = this->Mesh.mirror_index(face, out);
        face = face->neighbor(out);
      }
    }
    return { middle + 0.5 * free * way, 0.5 * free };
  }

  static Vec2 Position(const GridPoint& p) { return Vec2(double(p.X), double(p.Y)); }
  static double Cross(const Vec2& a, const Vec2& b) { return a[0] * b[1] - a[1] * b[0]; }

  void SampleSides()
  {
    this->Map.SideSamples.resize(this->Segments.Edges.size());
    for (std::size_t e = 0; e < this->Segments.Edges.size(); ++e)
    {
      for (int side = 0; side < 2; ++side)
      {
        this->Map.SideSamples[e][side] = this->LookAside(e, side);
      }
    }
  }

  void CollectDiagonals()
  {
    for (const Triangulation::Edge& side : this->Mesh.finite_edges())
    {
      const std::int32_t cell = side.first->info();
      if (cell != 0 && !side.first->is_constrained(side.second))
      {
        const std::int32_t a = side.first->vertex(Triangulation::ccw(side.second))->info();
        const std::int32_t b = side.first->vertex(Triangulation::cw(side.second))->info();
        this->Map.Diagonals.push_back({ std::min(a, b), std::max(a, b), cell });
      }
    }
  }

  // Areas, and the largest incircles of each cell.
  void SampleCells(std::size_t most)
  {
    const std::size_t cells = std::size_t(this->Map.CellCount);
    std::vector<std::int64_t> doubleAreas(cells, 0);
    std::vector<std::size_t> start(cells + 1, 0);
    this->ForEachTriangle([&](Face face) {
      doubleAreas[face->info()] += DoubleArea(face);
      ++start[face->info() + 1];
    });
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<PlanarSample> all(start.back());
    std::vector<std::size_t> next(start.begin(), start.end() - 1);
    this->ForEachTriangle([&](Face face) { all[next[face->info()]++] = Incircle(face); });
    this->Map.Areas.assign(1, std::numeric_limits<double>::infinity());
    this->Map.Samples.assign(1, this->SampleOutside());
    this->Map.SampleStart = { 0, 1 };
    for (std::size_t c = 1; c < cells; ++c)
    {
      const auto begin = all.begin() + start[c];
      const auto end = all.begin() + start[c + 1];
      const auto middle = begin + std::min(most, start[c + 1] - start[c]);
      std::partial_sort(begin, middle, end,
        [](const PlanarSample& a, const PlanarSample& b) { return a.Radius > b.Radius; });
      this->Map.Samples.insert(this->Map.Samples.end(), begin, middle);
      this->Map.SampleStart.push_back(std::int64_t(this->Map.Samples.size()));
      this->Map.Areas.push_back(0.5 * double(doubleAreas[c]));
    }
  }

  // The triangles of bounded cells.
  template <typename F>
  void ForEachTriangle(F&& body) const
  {
    if (this->IsFlat())
    {
      return;
    }
    for (const Face face : this->Mesh.finite_face_handles())
    {
      if (face->info() != 0)
      {
        body(face);
      }
    }
  }

  PlanarSample SampleOutside() const
  {
    Box2 box;
    for (const GridPoint& p : this->Segments.Vertices)
    {
      box.extend(Vec2(p.X, p.Y));
    }
    return { box.isEmpty() ? Vec2(Vec2::Zero()) : Vec2(box.min() - Vec2(1.0, 1.0)), 1.0 };
  }

  void ReportItem(std::size_t i, std::size_t count, double from, double to)
  {
    if (i % ItemsPerReport == 0)
    {
      this->Report(from + (to - from) * double(i) / double(count));
    }
  }

  void Report(double share)
  {
    if (this->Progress && !this->Progress(share))
    {
      throw Stopped();
    }
  }

  const SnappedSegments& Segments;
  const std::function<bool(double)>& Progress;
  double Reach; // Of samples beside edges.
  Triangulation Mesh;
  std::vector<Vertex> Vertices;
  std::vector<std::int32_t> Rank;          // of vertices, in the order of places
  std::vector<std::int32_t> FirstEdge;     // of the edges that start at a vertex; vertices + 1
  std::vector<std::int32_t> EdgesAt;       // how many a vertex has
  std::vector<std::array<Face, 2>> Beside; // an edge; void if there are no triangles
  PlanarMap Map;
};

} // namespace

PlanarMap MakePlanarMap(const SnappedSegments& segments, int samplesPerCell,
  const std::function<bool(double)>& progress, bool diagonals, double sideReach)
{
  CheckInput(segments, samplesPerCell);
  try
  {
    return MapMaker(segments, progress, sideReach).Make(samplesPerCell, diagonals);
  }
  catch (const Stopped&)
  {
    PlanarMap aborted;
    aborted.Aborted = true;
    return aborted;
  }
}

} // namespace nurbs
