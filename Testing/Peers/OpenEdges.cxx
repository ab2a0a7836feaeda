// SPDX-License-Identifier: BSD-3-Clause
#include "OpenEdges.h"

#include "ClosestTriangle.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRep_Tool.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_DataMapOfShapeInteger.hxx>
#include <TopoDS.hxx>

#include <algorithm>
#include <cstring>
#include <set>
#include <unordered_map>

namespace verify
{

namespace
{

struct PointHash
{
  std::size_t operator()(const std::array<double, 3>& p) const
  {
    std::size_t h = 0;
    for (double x : p)
    {
      h = (h ^ std::hash<double>()(x)) * 0x9e3779b97f4a7c15ULL;
      h ^= h >> 31;
    }
    return h;
  }
};

/// Uses of a mesh edge: forward (from the smaller to the larger index), backward, and by which face.
struct EdgeUse
{
  int Forward = 0, Backward = 0, Face = -1;
  Vec3 A, B;
};

using EdgeUses = std::unordered_map<std::uint64_t, EdgeUse>;

EdgeUses CollectEdges(const Body& body, const std::vector<FaceMesh>& meshes)
{
  std::unordered_map<std::array<double, 3>, std::uint32_t, PointHash> ids;
  EdgeUses uses;
  for (int f : body.Faces)
  {
    const FaceMesh& mesh = meshes[std::size_t(f)];
    std::vector<std::uint32_t> id;
    for (const Vec3& p : mesh.Points)
    {
      const std::array<double, 3> key{ p[0] + 0.0, p[1] + 0.0, p[2] + 0.0 };
      id.push_back(ids.emplace(key, std::uint32_t(ids.size())).first->second);
    }
    for (const auto& t : mesh.Triangles)
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        const auto from = std::size_t(t[k]), to = std::size_t(t[(k + 1) % 3]);
        const std::uint32_t a = id[from], b = id[to];
        if (a == b)
        {
          continue;
        }
        EdgeUse& use = uses[(std::uint64_t(std::min(a, b)) << 32) | std::max(a, b)];
        ++(a < b ? use.Forward : use.Backward);
        use.Face = f;
        use.A = mesh.Points[from];
        use.B = mesh.Points[to];
      }
    }
  }
  return uses;
}

/// Polylines of the edges that only one face uses.
ClosestTriangle FreeEdges(const ReferenceShape& shape, const Body& body)
{
  TopTools_DataMapOfShapeInteger uses;
  std::vector<TopoDS_Edge> edges;
  for (int f : body.Faces)
  {
    for (TopExp_Explorer e(shape.Faces[std::size_t(f)], TopAbs_EDGE); e.More(); e.Next())
    {
      const TopoDS_Edge edge = TopoDS::Edge(e.Current());
      if (!BRep_Tool::Degenerated(edge))
      {
        Standard_Integer* count = uses.ChangeSeek(edge);
        count ? void(++*count) : void((uses.Bind(edge, 1), edges.push_back(edge)));
      }
    }
  }
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> lines;
  for (const TopoDS_Edge& edge : edges)
  {
    if (uses.Find(edge) % 2 == 0)
    {
      continue;
    }
    const BRepAdaptor_Curve curve(edge);
    const int steps = 200 + 8 * curve.NbIntervals(GeomAbs_CN);
    for (int i = 0; i <= steps; ++i)
    {
      const double first = curve.FirstParameter(), last = curve.LastParameter();
      const gp_Pnt p = curve.Value(first + (last - first) * i / steps);
      points.emplace_back(p.X(), p.Y(), p.Z());
      const int at = int(points.size()) - 1;
      if (i > 0)
      {
        lines.push_back({ at - 1, at, at - 1 });
      }
    }
  }
  ClosestTriangle tree;
  tree.Build(points, lines);
  return tree;
}

} // namespace

OpenEdgeReport FindOpenEdges(
  const ReferenceShape& shape, const std::vector<FaceMesh>& meshes, double reach)
{
  OpenEdgeReport report;
  std::set<int> faces;
  for (const Body& body : shape.Bodies)
  {
    ++(body.Closed ? report.ClosedBodies : report.OpenBodies);
    const EdgeUses uses = CollectEdges(body, meshes);
    const ClosestTriangle free = body.Closed ? ClosestTriangle() : FreeEdges(shape, body);
    for (const auto& [key, use] : uses)
    {
      const bool odd = (use.Forward + use.Backward) % 2 != 0;
      if (!odd)
      {
        report.Misdirected += use.Forward != use.Backward;
        continue;
      }
      const bool crack =
        !body.Closed && std::max(free.Find(use.A).Distance, free.Find(use.B).Distance) > reach;
      report.OpenEdges += body.Closed;
      report.Cracks += crack;
      if (body.Closed || crack)
      {
        faces.insert(use.Face);
        if (report.Examples.size() < 8)
        {
          report.Examples.push_back({ use.Face, { use.A, use.B } });
        }
      }
    }
  }
  report.Faces.assign(faces.begin(), faces.end());
  return report;
}

} // namespace verify
