// SPDX-License-Identifier: BSD-3-Clause
#include "ZoneTriangulation.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <map>

namespace nurbs
{

namespace
{

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
constexpr int Unnumbered = -1;

// Vertices that CGAL makes where constraints cross have no number yet.
struct Number
{
  int Value = Unnumbered;
};

using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<Number, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel,
  CGAL::Triangulation_face_base_with_info_2<int, Kernel>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation =
  CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::Exact_predicates_tag>;
using Vertex = Triangulation::Vertex_handle;

// The next vertex on the way from a to b, which may lead through other vertices.
Vertex NextOnLine(const Triangulation& mesh, Vertex a, Vertex b)
{
  if (mesh.is_edge(a, b))
  {
    return b;
  }
  auto at = mesh.incident_vertices(a);
  const auto end = at;
  do
  {
    const Vertex v = at;
    if (!mesh.is_infinite(v) &&
      CGAL::orientation(a->point(), v->point(), b->point()) == CGAL::COLLINEAR &&
      CGAL::collinear_are_strictly_ordered_along_line(a->point(), v->point(), b->point()))
    {
      return v;
    }
  } while (++at != end);
  return nullptr;
}

// Adds `walls` to the edges on the way from a to b, in both directions.
void Count(const Triangulation& mesh, Vertex a, Vertex b, int walls,
  std::map<std::pair<Vertex, Vertex>, int>& along)
{
  for (std::size_t step = 0; a != b && step < mesh.number_of_vertices(); ++step)
  {
    const Vertex next = NextOnLine(mesh, a, b);
    if (next == nullptr)
    {
      return;
    }
    along[{ a, next }] += walls;
    along[{ next, a }] += walls;
    a = next;
  }
}

} // namespace

ZoneTriangles TriangulateZone(const Zone& zone)
{
  ZoneTriangles out;
  Triangulation mesh;
  std::vector<Vertex> vertices;
  Triangulation::Face_handle near;
  for (std::size_t i = 0; i < zone.Points.size(); ++i)
  {
    const Vertex v = mesh.insert(Kernel::Point_2(zone.Points[i][0], zone.Points[i][1]), near);
    near = v->face();
    if (v->info().Value == Unnumbered)
    {
      v->info().Value = int(i);
    }
    vertices.push_back(v);
  }
  // A wall that is there twice, as the two sides of a slit, has the same on both sides.
  std::map<std::pair<int, int>, int> times;
  for (const std::array<int, 2>& wall : zone.Walls)
  {
    const int a = vertices[wall[0]]->info().Value;
    const int b = vertices[wall[1]]->info().Value;
    if (a != b)
    {
      ++times[std::minmax(a, b)];
    }
  }
  for (const auto& wall : times)
  {
    if (wall.second % 2 == 1)
    {
      mesh.insert_constraint(vertices[wall.first.first], vertices[wall.first.second]);
    }
  }
  for (const std::array<int, 2>& line : zone.Lines)
  {
    if (vertices[line[0]] != vertices[line[1]])
    {
      mesh.insert_constraint(vertices[line[0]], vertices[line[1]]);
    }
  }
  // How many walls go along an edge; 0: lines only. Edges of walls that cross others are not found.
  std::map<std::pair<Vertex, Vertex>, int> along;
  for (const auto& wall : times)
  {
    if (wall.second % 2 == 1)
    {
      Count(mesh, vertices[wall.first.first], vertices[wall.first.second], 1, along);
    }
  }
  for (const std::array<int, 2>& line : zone.Lines)
  {
    Count(mesh, vertices[line[0]], vertices[line[1]], 0, along);
  }
  if (mesh.dimension() < 2)
  {
    return out;
  }
  for (const Vertex v : mesh.finite_vertex_handles())
  {
    if (v->info().Value == Unnumbered)
    {
      v->info().Value = int(zone.Points.size() + out.Added.size());
      out.Added.emplace_back(v->point().x(), v->point().y());
    }
  }
  // From outside inwards; each wall changes between out (1) and in (2). 0: not visited.
  for (auto f = mesh.all_faces_begin(); f != mesh.all_faces_end(); ++f)
  {
    f->info() = 0;
  }
  std::vector<Triangulation::Face_handle> stack(1, mesh.infinite_face());
  mesh.infinite_face()->info() = 1;
  while (!stack.empty())
  {
    const Triangulation::Face_handle f = stack.back();
    stack.pop_back();
    if (f->info() == 2 && !mesh.is_infinite(f)) // Walls that are not closed let it be in.
    {
      out.Triangles.push_back(
        { f->vertex(0)->info().Value, f->vertex(1)->info().Value, f->vertex(2)->info().Value });
    }
    for (int i = 0; i < 3; ++i)
    {
      const Triangulation::Face_handle next = f->neighbor(i);
      if (next->info() != 0)
      {
        continue;
      }
      const auto known =
        along.find({ f->vertex(Triangulation::ccw(i)), f->vertex(Triangulation::cw(i)) });
      const bool wall = f->is_constrained(i) && (known == along.end() || known->second % 2 == 1);
      next->info() = wall ? 3 - f->info() : f->info();
      stack.push_back(next);
    }
  }
  return out;
}

} // namespace nurbs
