// SPDX-License-Identifier: BSD-3-Clause
#include "PlanarMap.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/spatial_sort.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace nurbs
{

namespace
{

__extension__ using Wide = __int128;
using Plane = CGAL::Simple_cartesian<double>;

// Points of the grid are doubles without a fraction. Differences are at most 2^30, so an orientation
// is at most 2^61, and the determinant of a circle at most 3 * 2^122: exact in 64 and 128 bits. Grids
// have many points on one circle, where CGAL's own filters would fail and its slow arithmetic run.
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
using Structure =
  CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_2<GridTraits>, FaceBase>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<GridTraits, Structure,
  CGAL::No_constraint_intersection_tag>;
using Vertex = Triangulation::Vertex_handle;
using Face = Triangulation::Face_handle;
constexpr std::int32_t NoCell = -1;

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
  for (const std::array<std::int32_t, 2>& e : segments.Edges)
  {
    const auto low = std::min(e[0], e[1]);
    const auto high = std::max(e[0], e[1]);
    if (low < 0 || std::size_t(high) >= segments.Vertices.size() || low == high)
    {
      throw Error("MakePlanarMap: an edge needs two vertices that are there");
    }
  }
}

struct Stopped
{};

class MapMaker
{
public:
  MapMaker(const SnappedSegments& segments, const std::function<bool(double)>& progress)
    : Segments(segments)
    , Progress(progress)
  {}

  PlanarMap Make(int samplesPerCell)
  {
    this->InsertVertices();
    this->InsertEdges();
    this->MarkCells();
    this->SampleSides();
    this->SampleCells(std::size_t(samplesPerCell));
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
    Face near;
    for (std::size_t i = 0; i < order.size(); ++i)
    {
      this->ReportItem(i, order.size(), 0.0, VerticesShare);
      this->Vertices[order[i]] = this->Mesh.insert(points[order[i]], near);
      near = this->Vertices[order[i]]->face();
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
    for (std::size_t e = 0; e < count && this->IsFlat(); ++e)
    {
      this->CheckFlatEdge(e);
    }
    for (std::size_t e = 0; e < count && !this->IsFlat(); ++e)
    {
      this->ReportItem(e, count, VerticesShare, EdgesShare);
      const Vertex a = this->Vertices[this->Segments.Edges[e][0]];
      const Vertex b = this->Vertices[this->Segments.Edges[e][1]];
      Face face;
      int index = 0;
      if (this->Mesh.is_edge(a, b, face, index))
      {
        face->set_constraint(index, true);
        face->neighbor(index)->set_constraint(this->Mesh.mirror_index(face, index), true);
        continue;
      }
      try
      {
        this->Mesh.insert_constraint(a, b);
      }
      catch (const Triangulation::Intersection_of_constraints_exception&)
      {
        throw Error("MakePlanarMap: edges cross");
      }
    }
  }

  // All vertices are on one line, so there are no triangles.
  bool IsFlat() const { return this->Mesh.dimension() < 2; }

  void CheckFlatEdge(std::size_t edge) const
  {
    if (!this->Mesh.is_edge(this->Vertices[this->Segments.Edges[edge][0]],
          this->Vertices[this->Segments.Edges[edge][1]]))
    {
      throw Error("MakePlanarMap: an edge passes through a vertex");
    }
  }

  // The triangles to the left and right of an edge.
  std::array<Face, 2> FacesBeside(std::size_t edge) const
  {
    const Vertex a = this->Vertices[this->Segments.Edges[edge][0]];
    const Vertex b = this->Vertices[this->Segments.Edges[edge][1]];
    Face face;
    int index = 0;
    if (!this->Mesh.is_edge(a, b, face, index))
    {
      throw Error("MakePlanarMap: an edge passes through a vertex");
    }
    const Face other = face->neighbor(index);
    return face->vertex(Triangulation::ccw(index)) == a ? std::array<Face, 2>{ face, other }
                                                        : std::array<Face, 2>{ other, face };
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
      const std::array<Face, 2> faces = this->FacesBeside(e);
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

  // Touches the middle of an edge; side 0: from the left.
  PlanarSample UnitCircle(std::size_t edge, int side) const
  {
    const GridPoint& p = this->Segments.Vertices[this->Segments.Edges[edge][0]];
    const GridPoint& q = this->Segments.Vertices[this->Segments.Edges[edge][1]];
    const Vec2 start(p.X, p.Y);
    const Vec2 along = Vec2(q.X, q.Y) - start;
    const Vec2 left = Vec2(-along[1], along[0]).normalized();
    return { start + 0.5 * along + (side == 0 ? left : Vec2(-left)), 1.0 };
  }

  void SampleSides()
  {
    this->Map.SideSamples.resize(this->Segments.Edges.size());
    for (std::size_t e = 0; e < this->Segments.Edges.size(); ++e)
    {
      std::array<Face, 2> faces;
      if (!this->IsFlat())
      {
        faces = this->FacesBeside(e);
      }
      for (int side = 0; side < 2; ++side)
      {
        const bool bounded = !this->IsFlat() && !this->Mesh.is_infinite(faces[side]);
        this->Map.SideSamples[e][side] =
          bounded ? Incircle(faces[side]) : this->UnitCircle(e, side);
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
  Triangulation Mesh;
  std::vector<Vertex> Vertices;
  PlanarMap Map;
};

} // namespace

PlanarMap MakePlanarMap(
  const SnappedSegments& segments, int samplesPerCell, const std::function<bool(double)>& progress)
{
  CheckInput(segments, samplesPerCell);
  try
  {
    return MapMaker(segments, progress).Make(samplesPerCell);
  }
  catch (const Stopped&)
  {
    PlanarMap aborted;
    aborted.Aborted = true;
    return aborted;
  }
}

} // namespace nurbs
