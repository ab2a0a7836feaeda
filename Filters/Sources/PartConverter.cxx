// SPDX-License-Identifier: BSD-3-Clause
#include "PartConverter.h"

#include "CurveConverter.h"
#include "FaceConverter.h"
#include "ModelBuilder.h"
#include "SurfaceConverter.h"

#include <BRepBndLib.hxx>
#include <BRepLib.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Geom2d_Line.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <ShapeFix_Edge.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Vertex.hxx>
#include <gp_Trsf.hxx>

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

class Converter
{
public:
  Converter(const TopoDS_Shape& shape, const ParallelFor& parallel, const std::atomic<bool>& abort)
    : Parallel(parallel)
    , Abort(abort)
  {
    for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next())
    {
      this->Faces.push_back(TopoDS::Face(it.Current()));
      TopExp::MapShapes(it.Current(), TopAbs_EDGE, this->Table.Index);
      TopExp::MapShapes(it.Current(), TopAbs_VERTEX, this->VertexIndex);
    }
  }

  Part Run()
  {
    this->ReadEdges();
    this->ReadVertices();
    for (const TopoDS_Face& face : this->Faces)
    {
      this->PrepareFace(face);
    }
    this->ForEach(this->Result.Edges.size(), [this](std::size_t i) { this->ConvertEdge(i); });
    this->MeasureSize();
    std::vector<FaceResult> faces(this->Faces.size());
    this->ForEach(
      faces.size(), [&](std::size_t i) { faces[i] = ConvertFace(this->Faces[i], this->Table); });
    this->Gather(faces);
    return std::move(this->Result);
  }

private:
  void ReadEdges();
  void ReadVertices();
  void PrepareFace(const TopoDS_Face& face);
  void AlignCircle(std::size_t edge, const TopoDS_Edge& use, const TopoDS_Face& face,
    const SurfaceConverter& surface);
  void ConvertEdge(std::size_t i);
  void MeasureSize();
  void Gather(std::vector<FaceResult>& faces);

  void ForEach(std::size_t count, const std::function<void(std::size_t)>& body) const
  {
    this->Parallel(0, static_cast<std::int64_t>(count), [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t i = begin; i < end && !this->Abort; ++i)
      {
        body(static_cast<std::size_t>(i));
      }
    });
  }

  const ParallelFor& Parallel;
  const std::atomic<bool>& Abort;
  std::vector<TopoDS_Face> Faces;
  TopTools_IndexedMapOfShape VertexIndex;
  std::vector<double> Offsets; ///< Where the spans of each edge begin, if it is a circle.
  EdgeTable Table;
  Part Result;
};

void Converter::ReadEdges()
{
  const int count = this->Table.Index.Extent();
  this->Table.Sources.resize(static_cast<std::size_t>(count));
  this->Table.Edges = &this->Result.Edges;
  this->Result.Edges.resize(static_cast<std::size_t>(count));
  this->Offsets.assign(static_cast<std::size_t>(count), std::nan(""));
  for (int i = 0; i < count; ++i)
  {
    const TopoDS_Edge edge = TopoDS::Edge(this->Table.Index(i + 1).Oriented(TopAbs_FORWARD));
    EdgeSource& source = this->Table.Sources[static_cast<std::size_t>(i)];
    Part::Edge& target = this->Result.Edges[static_cast<std::size_t>(i)];
    source.Shape = edge;
    source.Tolerance = BRep_Tool::Tolerance(edge);
    const TopoDS_Vertex ends[2] = { TopExp::FirstVertex(edge), TopExp::LastVertex(edge) };
    for (int k = 0; k < 2; ++k)
    {
      target.Vertex[k] = ends[k].IsNull() ? -1 : this->VertexIndex.FindIndex(ends[k]) - 1;
    }
    if (BRep_Tool::Degenerated(edge))
    {
      target.Kind = Part::EdgeKind::Pole;
      BRep_Tool::Range(edge, target.Range.Min, target.Range.Max);
      continue;
    }
    double first, last;
    if (BRep_Tool::Curve(edge, first, last).IsNull())
    {
      BRepLib::BuildCurve3d(edge);
    }
    if (!BRep_Tool::SameRange(edge) || !BRep_Tool::SameParameter(edge))
    {
      BRepLib::SameParameter(edge, std::max(source.Tolerance, 1e-7));
    }
  }
}

void Converter::ReadVertices()
{
  for (int i = 1; i <= this->VertexIndex.Extent(); ++i)
  {
    const gp_Pnt p = BRep_Tool::Pnt(TopoDS::Vertex(this->VertexIndex(i)));
    this->Result.Vertices.emplace_back(p.X(), p.Y(), p.Z());
  }
}

/// Adds curves that are missing on the surface, and finds out how circles lie on it.
void Converter::PrepareFace(const TopoDS_Face& oriented)
{
  const TopoDS_Face face = TopoDS::Face(oriented.Oriented(TopAbs_FORWARD));
  TopLoc_Location location;
  const Handle(Geom_Surface)& geometry = BRep_Tool::Surface(face, location);
  if (geometry.IsNull())
  {
    return;
  }
  const SurfaceConverter surface(geometry, 0.0);
  if (surface.IsPlane())
  {
    return;
  }
  TopTools_IndexedMapOfShape seen;
  for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next())
  {
    const TopoDS_Edge edge = TopoDS::Edge(it.Current());
    double first, last;
    const bool again = seen.Contains(edge);
    seen.Add(edge);
    if (BRep_Tool::CurveOnSurface(edge, face, first, last).IsNull())
    {
      int uses = 0;
      for (TopExp_Explorer other(face, TopAbs_EDGE); other.More(); other.Next())
      {
        uses += other.Current().IsSame(edge) ? 1 : 0;
      }
      ShapeFix_Edge().FixAddPCurve(edge, face, uses > 1);
    }
    if (!again)
    {
      const int index = this->Table.Index.FindIndex(edge) - 1;
      this->AlignCircle(static_cast<std::size_t>(index), edge, face, surface);
    }
  }
}

/// A circle that runs along u (or v) of a surface turned by the angle p, t -> p +- t, gets its spans
/// where the surface has them: its trim curve is then a straight line, exactly.
void Converter::AlignCircle(std::size_t edge, const TopoDS_Edge& use, const TopoDS_Face& face,
  const SurfaceConverter& surface)
{
  if (!std::isnan(this->Offsets[edge]))
  {
    return;
  }
  double first, last;
  Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(use, face, first, last);
  if (Handle(Geom2d_TrimmedCurve) trimmed = Handle(Geom2d_TrimmedCurve)::DownCast(curve);
      !trimmed.IsNull())
  {
    curve = trimmed->BasisCurve();
  }
  const Handle(Geom2d_Line) line = Handle(Geom2d_Line)::DownCast(curve);
  if (line.IsNull())
  {
    return;
  }
  const gp_Dir2d& direction = line->Direction();
  for (int dir = 0; dir < 2; ++dir)
  {
    const double along = dir == 0 ? direction.X() : direction.Y();
    const ParameterMap& map = surface.Map(dir);
    if (map.GetKind() == ParameterMap::Kind::Circular && 1.0 - std::abs(along) < 1e-12)
    {
      const double start = dir == 0 ? line->Location().X() : line->Location().Y();
      const double sign = along > 0.0 ? 1.0 : -1.0;
      const double offset = std::remainder(-sign * start, map.Span());
      this->Offsets[edge] = std::abs(offset) < 1e-12 ? 0.0 : offset;
    }
  }
}

void Converter::ConvertEdge(std::size_t i)
{
  Part::Edge& edge = this->Result.Edges[i];
  EdgeSource& source = this->Table.Sources[i];
  if (edge.Kind == Part::EdgeKind::Pole)
  {
    return;
  }
  try
  {
    TopLoc_Location location;
    double first, last;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(source.Shape, location, first, last);
    if (curve.IsNull())
    {
      return;
    }
    const Placement place = ToPlacement(location.Transformation());
    const double offset = std::isnan(this->Offsets[i]) ? 0.0 : this->Offsets[i];
    ConvertedCurve<3> converted =
      ConvertCurve(curve, first, last, offset, std::max(0.01 * source.Tolerance, 1e-12));
    for (Vec3& p : converted.Geometry.Points)
    {
      p = place.Linear * p + place.Shift;
    }
    converted.Geometry.Pack();
    const Interval domain = converted.Geometry.View().Domain();
    source.Map = converted.Map;
    source.Range[0] = converted.Map.Inverse(domain.Min);
    source.Range[1] = converted.Map.Inverse(domain.Max);
    if (converted.Map.IsIdentity() == false)
    {
      source.Range[0] = first;
      source.Range[1] = last;
    }
    edge.Geometry = std::move(converted.Geometry);
    edge.Kind = Part::EdgeKind::Curve;
  }
  catch (const Standard_Failure&)
  {
    edge.Kind = Part::EdgeKind::Unknown;
  }
  catch (const std::exception&)
  {
    edge.Kind = Part::EdgeKind::Unknown;
  }
}

void Converter::MeasureSize()
{
  Box3 box;
  for (const Part::Edge& edge : this->Result.Edges)
  {
    for (const Vec3& p : edge.Geometry.Points)
    {
      box.extend(p);
    }
  }
  if (box.isEmpty())
  {
    Bnd_Box bounds;
    for (const TopoDS_Face& face : this->Faces)
    {
      BRepBndLib::Add(face, bounds, Standard_False);
    }
    this->Table.Size =
      bounds.IsVoid() || bounds.IsOpen() ? 1.0 : bounds.CornerMin().Distance(bounds.CornerMax());
    return;
  }
  this->Table.Size = box.diagonal().norm();
}

/// Where a vertex is that faces and edges see at `ends`: where more than half of them agree if they do,
/// by a tenth of what all differ, so that one edge that misses its vertex doesn't spoil the other edges'
/// faces; else in the middle, which is the nearest to all.
Vec3 VertexPlace(const std::vector<Vec3>& ends)
{
  Box3 box;
  for (const Vec3& p : ends)
  {
    box.extend(p);
  }
  const double near = 0.05 * box.diagonal().norm();
  std::size_t most = 0;
  Box3 agreed;
  for (const Vec3& p : ends)
  {
    std::size_t count = 0;
    Box3 around;
    for (const Vec3& q : ends)
    {
      if ((q - p).norm() <= near)
      {
        ++count;
        around.extend(q);
      }
    }
    if (count > most)
    {
      most = count;
      agreed = around;
    }
  }
  return 2 * most > ends.size() ? Vec3(agreed.center()) : Vec3(box.center());
}

/// Edge tolerances, and vertices where their faces and edges see them.
void Converter::Gather(std::vector<FaceResult>& faces)
{
  std::vector<std::vector<Vec3>> seen(this->Result.Vertices.size());
  auto extend = [&](std::int64_t vertex, const Vec3& p) {
    if (vertex >= 0)
    {
      seen[static_cast<std::size_t>(vertex)].push_back(p);
    }
  };
  for (FaceResult& face : faces)
  {
    for (const FaceResult::Deviation& d : face.Deviations)
    {
      double& tolerance = this->Result.Edges[static_cast<std::size_t>(d.Edge)].Tolerance;
      // The search for the largest distance may miss it by a little.
      tolerance = std::max(tolerance, 1.05 * d.Distance + 1e-14 * this->Table.Size);
    }
    for (const FaceResult::Pole& pole : face.Poles)
    {
      const Part::Edge& edge = this->Result.Edges[static_cast<std::size_t>(pole.Edge)];
      extend(edge.Vertex[0], pole.Box.min());
      extend(edge.Vertex[0], pole.Box.max());
    }
    for (const FaceResult::End& end : face.Ends)
    {
      extend(end.Vertex, end.Point);
    }
    this->Result.Faces.push_back(std::move(face.Face));
  }
  for (const Part::Edge& edge : this->Result.Edges)
  {
    if (edge.Kind == Part::EdgeKind::Curve)
    {
      extend(edge.Vertex[0], edge.Geometry.Points.front());
      extend(edge.Vertex[1], edge.Geometry.Points.back());
    }
  }
  for (std::size_t i = 0; i < seen.size(); ++i)
  {
    if (!seen[i].empty())
    {
      this->Result.Vertices[i] = VertexPlace(seen[i]);
    }
  }
  for (const FaceResult& face : faces)
  {
    for (const FaceResult::Pole& pole : face.Poles)
    {
      Part::Edge& edge = this->Result.Edges[static_cast<std::size_t>(pole.Edge)];
      if (edge.Vertex[0] >= 0)
      {
        const Vec3& vertex = this->Result.Vertices[static_cast<std::size_t>(edge.Vertex[0])];
        const Vec3 far =
          (pole.Box.max() - vertex).cwiseAbs().cwiseMax((vertex - pole.Box.min()).cwiseAbs());
        edge.Tolerance = std::max(edge.Tolerance, far.norm());
      }
    }
  }
}

/// A copy of a surface or curve, placed.
Surface Place(Surface surface, const Placement& placement)
{
  for (Vec3& p : surface.Points)
  {
    p = placement.Linear * p + placement.Shift;
  }
  return surface;
}

} // namespace

Part ConvertPart(
  const TopoDS_Shape& shape, const ParallelFor& parallel, const std::atomic<bool>& abort)
{
  return Converter(shape, parallel, abort).Run();
}

void AppendPart(const Part& part, const Placement& placement,
  std::vector<FaceAttributes>& attributes, ModelBuilder& builder, std::vector<double>& errors)
{
  const double scale = std::cbrt(std::abs(placement.Linear.determinant()));
  const bool mirrored = placement.Linear.determinant() < 0.0;
  std::int64_t firstVertex = 0;
  std::vector<Vec3> vertices;
  for (std::size_t i = 0; i < part.Vertices.size(); ++i)
  {
    vertices.emplace_back(placement.Linear * part.Vertices[i] + placement.Shift);
    const std::int64_t index = builder.AddVertex(vertices.back());
    firstVertex = i == 0 ? index : firstVertex;
  }
  const std::int64_t firstEdge = builder.EdgeCount();
  for (const Part::Edge& edge : part.Edges)
  {
    std::int64_t ends[2];
    for (int k = 0; k < 2; ++k)
    {
      ends[k] = edge.Vertex[k] < 0 ? -1 : edge.Vertex[k] + firstVertex;
    }
    const double tolerance = edge.Tolerance * scale;
    if (edge.Kind == Part::EdgeKind::Curve)
    {
      Curve<3> curve = edge.Geometry;
      for (Vec3& p : curve.Points)
      {
        p = placement.Linear * p + placement.Shift;
      }
      curve.Pack();
      builder.AddEdge(curve.View(), tolerance, ends[0], ends[1]);
    }
    else if (edge.Kind == Part::EdgeKind::Pole && edge.Vertex[0] >= 0)
    {
      builder.AddPole(
        vertices[static_cast<std::size_t>(edge.Vertex[0])], edge.Range, tolerance, ends[0]);
    }
    else
    {
      builder.AddUnknownEdge(tolerance, ends[0], ends[1]);
    }
  }
  for (std::size_t i = 0; i < part.Faces.size(); ++i)
  {
    const Part::Face& face = part.Faces[i];
    if (!face.Failure.empty())
    {
      continue;
    }
    attributes[i].Reversed = face.Reversed != mirrored;
    const Surface surface = Place(face.Geometry, placement);
    builder.BeginFace(surface.View(), attributes[i]);
    errors.push_back(face.Error * scale);
    for (const Part::Loop& loop : face.Loops)
    {
      builder.BeginLoop();
      for (const Part::TrimCurve& trim : loop)
      {
        builder.AddTrimCurve(
          trim.Geometry.View(), trim.Edge < 0 ? -1 : trim.Edge + firstEdge, trim.Reversed);
      }
    }
  }
}

} // namespace nurbs
