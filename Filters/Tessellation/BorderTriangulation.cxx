// SPDX-License-Identifier: BSD-3-Clause
#include "BorderTriangulation.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <set>

namespace nurbs
{

namespace
{
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
using FaceBase = CGAL::Constrained_triangulation_face_base_2<Kernel,
  CGAL::Triangulation_face_base_with_info_2<int, Kernel>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure,
  CGAL::No_constraint_intersection_requiring_constructions_tag>;
} // namespace

struct BorderTriangulation::Internals
{
  Triangulation Mesh;
  std::vector<Triangulation::Vertex_handle> Vertices;
  std::vector<std::pair<int, int>> Segments;
  bool HasCreases = false;
  mutable std::set<std::pair<int, int>> Walls; ///< Edges of segments, if there are creases, too.
  Triangulation::Vertex_handle Last = nullptr; ///< Where the next point is looked for first.

  // Where a segment runs through other points it consists of several edges: visits each of them.
  template <typename F>
  void Walk(int a, int b, F&& visit) const
  {
    Triangulation::Vertex_handle va = this->Vertices[a];
    const Triangulation::Vertex_handle vb = this->Vertices[b];
    for (std::size_t step = 0; va != vb && step < this->Vertices.size(); ++step)
    {
      Triangulation::Face_handle face;
      int index = 0;
      Triangulation::Vertex_handle next = vb;
      if (!this->Mesh.is_edge(va, vb, face, index) && !this->NextOnLine(va, vb, next))
      {
        return;
      }
      if (!this->Mesh.is_edge(va, next, face, index))
      {
        return;
      }
      visit(va, next, face, index);
      va = next;
    }
  }

  bool NextOnLine(Triangulation::Vertex_handle va, Triangulation::Vertex_handle vb,
    Triangulation::Vertex_handle& next) const
  {
    auto at = this->Mesh.incident_vertices(va);
    const auto end = at;
    do
    {
      if (!this->Mesh.is_infinite(at) &&
        CGAL::orientation(va->point(), at->point(), vb->point()) == CGAL::COLLINEAR &&
        CGAL::collinear_are_strictly_ordered_along_line(va->point(), at->point(), vb->point()))
      {
        next = at;
        return true;
      }
    } while (++at != end);
    return false;
  }

  bool Constrain(int a, int b)
  {
    try
    {
      this->Mesh.insert_constraint(this->Vertices[a], this->Vertices[b]);
      return true;
    }
    catch (const Triangulation::Intersection_of_constraints_exception&)
    {
      return false;
    }
  }
};

BorderTriangulation::BorderTriangulation()
  : Data(new Internals)
{}

BorderTriangulation::~BorderTriangulation() = default;

int BorderTriangulation::AddPoint(const Vec2& p)
{
  Internals& d = *this->Data;
  const int id = int(d.Vertices.size());
  const Triangulation::Vertex_handle v =
    d.Mesh.insert(Kernel::Point_2(p[0], p[1]), d.Last == nullptr ? nullptr : d.Last->face());
  d.Last = v;
  if (d.Mesh.number_of_vertices() == std::size_t(id) + 1)
  {
    v->info() = id;
    d.Vertices.push_back(v);
    return id;
  }
  return v->info();
}

bool BorderTriangulation::AddSegment(int a, int b)
{
  if (a == b)
  {
    return true;
  }
  this->Data->Segments.emplace_back(a, b);
  return this->Data->Constrain(a, b);
}

bool BorderTriangulation::AddCrease(int a, int b)
{
  if (a == b || this->IsConstrained(a, b))
  {
    return true;
  }
  if (!this->Data->Constrain(a, b))
  {
    return false;
  }
  this->Data->HasCreases = true;
  return true;
}

void BorderTriangulation::Triangles(std::vector<std::array<int, 3>>& triangles) const
{
  const Internals& d = *this->Data;
  triangles.clear();
  if (d.Mesh.dimension() < 2)
  {
    return;
  }
  for (auto f = d.Mesh.all_faces_begin(); f != d.Mesh.all_faces_end(); ++f)
  {
    f->info() = 0;
  }
  // Step 1: the faces to the left of the segments.
  std::vector<Triangulation::Face_handle> stack;
  const auto enter = [&](Triangulation::Face_handle f) {
    if (f->info() == 0 && !d.Mesh.is_infinite(f))
    {
      f->info() = 1;
      stack.push_back(f);
    }
  };
  d.Walls.clear();
  for (const auto& segment : d.Segments)
  {
    d.Walk(segment.first, segment.second, [&](auto va, auto vb, auto face, int index) {
      const bool left = face->vertex(Triangulation::ccw(index)) == va;
      enter(left ? face : face->neighbor(index));
      if (d.HasCreases)
      {
        d.Walls.insert(std::minmax(va->info(), vb->info()));
      }
    });
  }
  // Step 2: what can be reached without crossing a segment.
  while (!stack.empty())
  {
    const Triangulation::Face_handle f = stack.back();
    stack.pop_back();
    triangles.push_back({ f->vertex(0)->info(), f->vertex(1)->info(), f->vertex(2)->info() });
    for (int i = 0; i < 3; ++i)
    {
      const bool wall = f->is_constrained(i) &&
        (!d.HasCreases ||
          d.Walls.count(std::minmax(f->vertex(Triangulation::ccw(i))->info(),
            f->vertex(Triangulation::cw(i))->info())) > 0);
      if (!wall)
      {
        enter(f->neighbor(i));
      }
    }
  }
}

bool BorderTriangulation::IsConstrained(int a, int b) const
{
  Triangulation::Face_handle face;
  int index = 0;
  return this->Data->Mesh.is_edge(this->Data->Vertices[a], this->Data->Vertices[b], face, index) &&
    face->is_constrained(index);
}

bool BorderTriangulation::IsWall(int a, int b) const
{
  return this->IsConstrained(a, b) &&
    (!this->Data->HasCreases || this->Data->Walls.count(std::minmax(a, b)) > 0);
}

std::size_t BorderTriangulation::Size() const
{
  return this->Data->Vertices.size();
}

} // namespace nurbs
