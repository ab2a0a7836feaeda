// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeBuilder.h"

#include "AnalyticForm.h"
#include "CADSession.h"
#include "CurveFit.h"
#include "CurveLift.h"
#include "EdgeExport.h"
#include "LoopNesting.h"
#include "ShapeBodies.h"
#include "SplineExport.h"

#include <BRepCheck.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepCheck_ListIteratorOfListOfStatus.hxx>
#include <BRepCheck_Result.hxx>
#include <BRep_Builder.hxx>
#include <Geom2d_Line.hxx>
#include <Precision.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>

#include <algorithm>
#include <set>
#include <sstream>

namespace nurbs
{

namespace
{

constexpr double SameLength = 1e-10; // relative: of parameters that are the same
constexpr double FitShare = 0.01;    // of the tolerance of curves: what trim curves may add to it
constexpr double FitSlack = 1.5;     // The deviation of a fit is measured at some places only.

class ShapeMaker
{
public:
  ShapeMaker(const Model& model, const std::vector<std::string>& faceErrors,
    const ShapeOptions& options, const ParallelFor& parallel, const std::atomic<bool>& abort)
    : Options(options)
    , Parallel(parallel)
    , Abort(abort)
  {
    this->Result.FaceErrors = faceErrors;
    this->ExportSurfaces(model);
    this->Size = this->MeasureSize(model);
    this->Whole =
      CompleteModel(model, this->Result.FaceErrors, options.CurveTolerance * this->Size);
  }

  BuiltShape Run()
  {
    EdgeExportOptions lengths;
    lengths.CurveTolerance = this->Options.CurveTolerance * this->Size;
    lengths.Gap = this->Options.Gap * this->Size;
    lengths.Negligible = 0.5 * Precision::Confusion() / this->Options.Scale;
    this->Edges =
      PrepareEdges(this->Whole, this->Result.FaceErrors, lengths, this->Parallel, this->Abort);
    if (this->Abort)
    {
      return std::move(this->Result);
    }
    this->FindForms();
    this->MakeVertices();
    this->Shapes.resize(this->Edges.Edges.size());
    this->FaceOfLoop.assign(this->Whole.Data.Loops.size(), -1);
    for (std::size_t f = 0; f < this->Whole.Data.Faces.size(); ++f)
    {
      this->TryFace(f);
    }
    this->Count();
    this->GatherBodies();
    return std::move(this->Result);
  }

private:
  /// A trim curve where its edge is on a face.
  struct Pcurve
  {
    std::int64_t Edge;
    bool Reversed;
    Handle(Geom2d_Curve) Curve; ///< Null on a plane, where the edge's curve tells all.
  };
  using Wire = std::vector<Pcurve>;

  void ExportSurfaces(const Model& model);
  double MeasureSize(const Model& model) const;
  void FindForms();
  void KeepPatchesWithSeams();
  bool Follows(const AnalyticCurve& form, const EdgeUse& use) const;
  Handle(Geom2d_Line) StraightPcurve(const EdgeUse& use, double first, double& length) const;
  Handle(Geom2d_Curve) PcurveOf(const EdgeUse& use, std::int64_t edge);
  void MakeVertices();
  void TryFace(std::size_t f);
  std::vector<Wire> ExportWires(std::int64_t face, const std::vector<std::int64_t>& loops);
  TopoDS_Edge& EdgeShape(std::int64_t edge);
  void AttachPcurves(const std::vector<Wire>& wires, const Handle(Geom_Surface) & surface);
  TopoDS_Face MakeFace(const std::vector<Wire>& wires, const Handle(Geom_Surface) & surface);
  void Count();
  void GatherBodies();

  double Length(double length) const
  {
    return std::max(this->Options.Scale * length, Precision::Confusion());
  }

  const ShapeOptions& Options;
  const ParallelFor& Parallel;
  const std::atomic<bool>& Abort;
  double Size = 0.0; ///< Diagonal of the model, in its unit.
  CompletedModel Whole;
  ExportEdges Edges;
  std::vector<Handle(Geom_Surface)> Surfaces;
  std::vector<std::optional<AnalyticSurface>> Forms; ///< One a face.
  std::vector<std::optional<AnalyticCurve>> Curves;  ///< One an edge.
  std::vector<Interval> Ranges;                      ///< Of the edges.
  std::vector<TopoDS_Vertex> Vertices;
  std::vector<TopoDS_Edge> Shapes;
  std::vector<std::int64_t> FaceOfLoop; ///< Index into the result's faces, or -1.
  BuiltShape Result;
};

void ShapeMaker::ExportSurfaces(const Model& model)
{
  this->Surfaces.resize(model.Faces.size());
  for (std::size_t f = 0; f < model.Faces.size() && !this->Abort; ++f)
  {
    try
    {
      if (this->Result.FaceErrors[f].empty())
      {
        this->Surfaces[f] = ExportSurface(model.Faces[f].Geometry, this->Options.Scale);
      }
    }
    catch (const Error& error)
    {
      this->Result.FaceErrors[f] = std::string("its surface can't be written: ") + error.what();
    }
  }
}

double ShapeMaker::MeasureSize(const Model& model) const
{
  Box3 box;
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    const SurfaceView& surface = model.Faces[f].Geometry;
    for (std::int64_t k = 0; this->Result.FaceErrors[f].empty() && k < surface.Size(); ++k)
    {
      box.extend(surface.Point(k));
    }
  }
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

/// Planes, cylinders and their kin, and lines and circles where all faces of an edge go along.
void ShapeMaker::FindForms()
{
  const std::vector<Face>& faces = this->Whole.Data.Faces;
  const std::vector<ExportEdge>& edges = this->Edges.Edges;
  this->Forms.resize(faces.size());
  this->Curves.resize(edges.size());
  for (const ExportEdge& edge : edges)
  {
    this->Ranges.push_back(edge.Range);
  }
  if (!this->Options.Analytic)
  {
    return;
  }
  this->Parallel(0, static_cast<std::int64_t>(faces.size()), [&](std::int64_t i, std::int64_t end) {
    for (; i < end && !this->Abort; ++i)
    {
      if (this->Result.FaceErrors[i].empty())
      {
        this->Forms[i] = AnalyticSurface::Recognise(faces[i].Geometry, this->Options.Scale);
      }
    }
  });
  this->KeepPatchesWithSeams();
  for (std::size_t f = 0; f < faces.size(); ++f)
  {
    if (this->Forms[f])
    {
      this->Surfaces[f] = this->Forms[f]->GetGeometry();
    }
  }
  for (std::size_t e = 0; e < edges.size(); ++e)
  {
    if (edges[e].Pole)
    {
      double length = 0.0;
      if (!this->StraightPcurve(edges[e].Uses.front(), 0.0, length).IsNull())
      {
        this->Ranges[e] = { 0.0, length };
      }
      continue;
    }
    const auto form = RecogniseCurve(edges[e].Geometry.View(), this->Options.Scale);
    if (form && std::all_of(edges[e].Uses.begin(), edges[e].Uses.end(), [&](const EdgeUse& use) {
          return this->Follows(*form, use);
        }))
    {
      this->Curves[e] = form;
      this->Ranges[e] = form->Range;
    }
  }
}

/// A disc that is a patch turned about its middle has a pole and a seam. A plane has neither.
void ShapeMaker::KeepPatchesWithSeams()
{
  for (const ExportEdge& edge : this->Edges.Edges)
  {
    for (const EdgeUse& use : edge.Uses)
    {
      const auto uses = std::count_if(edge.Uses.begin(), edge.Uses.end(),
        [&](const EdgeUse& other) { return other.Face == use.Face; });
      std::optional<AnalyticSurface>& form = this->Forms[use.Face];
      if (form && form->IsPlane() && (edge.Pole || uses > 1))
      {
        form.reset();
      }
    }
  }
}

/// Whether the trim curve can be told, exactly, in the parameter of the line or circle.
bool ShapeMaker::Follows(const AnalyticCurve& form, const EdgeUse& use) const
{
  const std::optional<AnalyticSurface>& surface = this->Forms[use.Face];
  if (!surface || surface->IsPlane())
  {
    return surface || form.Affine;
  }
  double length = 0.0;
  return !this->StraightPcurve(use, 0.0, length).IsNull() &&
    std::abs(length - form.Range.Length()) <= SameLength * length;
}

/// A trim curve along u or v of the patch as a line on the analytic surface, from the parameter
/// `first` on; null if it is none. `length`: of its parameter.
Handle(Geom2d_Line) ShapeMaker::StraightPcurve(
  const EdgeUse& use, double first, double& length) const
{
  const CurveView<2>& trim = this->Whole.Data.TrimCurves[use.Curve].Geometry;
  const std::optional<AnalyticSurface>& surface = this->Forms[use.Face];
  if (!surface || surface->IsPlane())
  {
    return nullptr;
  }
  const SurfaceView& patch = this->Whole.Data.Faces[use.Face].Geometry;
  for (int dir = 0; dir < 2; ++dir)
  {
    bool constant = true;
    for (int i = 1; i < trim.Count; ++i)
    {
      constant = constant &&
        std::abs(trim.Point(i)[dir] - trim.Point(0)[dir]) <=
          SameLength * patch.Domain(dir).Length();
    }
    if (constant)
    {
      const Interval domain = trim.Domain();
      const Vec2 a = surface->Parameters(Evaluate(trim, domain.Min));
      const Vec2 b = surface->Parameters(Evaluate(trim, domain.Max));
      const int along = std::abs(b[0] - a[0]) > std::abs(b[1] - a[1]) ? 0 : 1;
      const double step = b[along] > a[along] ? 1.0 : -1.0;
      length = std::abs(b[along] - a[along]);
      return new Geom2d_Line(gp_Pnt2d(a[0] - (along == 0 ? step * first : 0.0),
                               a[1] - (along == 1 ? step * first : 0.0)),
        gp_Dir2d(along == 0 ? step : 0.0, along == 1 ? step : 0.0));
    }
  }
  return nullptr;
}

/// The trim curve in the parameters of the surface that is written, in that of the edge.
Handle(Geom2d_Curve) ShapeMaker::PcurveOf(const EdgeUse& use, std::int64_t edge)
{
  const CurveView<2>& trim = this->Whole.Data.TrimCurves[use.Curve].Geometry;
  const std::optional<AnalyticSurface>& surface = this->Forms[use.Face];
  const Interval range = this->Ranges[edge];
  if (!surface)
  {
    return ExportCurve(trim, range);
  }
  if (surface->IsPlane())
  {
    return nullptr;
  }
  double length = 0.0;
  const Handle(Geom2d_Line) line = this->StraightPcurve(use, range.Min, length);
  if (!line.IsNull() && (this->Curves[edge] || this->Edges.Edges[edge].Pole))
  {
    return Handle(Geom2d_Curve)(line);
  }
  const Interval domain = trim.Domain();
  double error = 0.0;
  const Curve<2> fitted =
    FitCurve<2>([&](double t) { return surface->Parameters(Evaluate(trim, domain.Clamp(t))); },
      LiftBreaks(this->Whole.Data.Faces[use.Face].Geometry, trim), surface->UnitLengths(),
      FitShare * this->Options.CurveTolerance * this->Size * this->Options.Scale, error);
  this->Edges.Edges[edge].Tolerance += FitSlack * error / this->Options.Scale;
  return ExportCurve(fitted.View(), range);
}

void ShapeMaker::MakeVertices()
{
  BRep_Builder builder;
  for (const ExportVertex& vertex : this->Edges.Vertices)
  {
    const Vec3 p = this->Options.Scale * vertex.Place;
    this->Vertices.emplace_back();
    builder.MakeVertex(
      this->Vertices.back(), gp_Pnt(p[0], p[1], p[2]), this->Length(vertex.Tolerance));
  }
}

/// The edge, made when it is first asked for.
TopoDS_Edge& ShapeMaker::EdgeShape(std::int64_t index)
{
  TopoDS_Edge& shape = this->Shapes[index];
  if (!shape.IsNull())
  {
    return shape;
  }
  const ExportEdge& edge = this->Edges.Edges[index];
  BRep_Builder builder;
  if (edge.Pole)
  {
    builder.MakeEdge(shape);
    builder.Degenerated(shape, Standard_True);
    builder.UpdateEdge(shape, this->Length(edge.Tolerance));
  }
  else
  {
    const std::optional<AnalyticCurve>& form = this->Curves[index];
    const Handle(Geom_Curve) curve = form
      ? form->Geometry
      : Handle(Geom_Curve)(ExportCurve(edge.Geometry.View(), this->Options.Scale));
    builder.MakeEdge(shape, curve, this->Length(edge.Tolerance));
  }
  builder.Add(shape, this->Vertices[edge.Vertex[0]].Oriented(TopAbs_FORWARD));
  builder.Add(shape, this->Vertices[edge.Vertex[1]].Oriented(TopAbs_REVERSED));
  return shape;
}

/// On a surface whose normals are opposite to the patch's everything runs the other way.
std::vector<ShapeMaker::Wire> ShapeMaker::ExportWires(
  std::int64_t face, const std::vector<std::int64_t>& loops)
{
  const bool mirrored = this->Forms[face] && this->Forms[face]->IsMirrored();
  std::vector<Wire> wires;
  for (const std::int64_t l : loops)
  {
    const TrimLoop& loop = this->Whole.Data.Loops[l];
    Wire wire;
    for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
    {
      const std::int64_t edge = this->Edges.EdgeOf[c];
      const TrimCurve& trim = this->Whole.Data.TrimCurves[c];
      wire.push_back({ edge, trim.Reversed != mirrored, this->PcurveOf({ face, c }, edge) });
    }
    if (mirrored)
    {
      std::reverse(wire.begin(), wire.end());
    }
    if (!wire.empty())
    {
      wires.push_back(std::move(wire));
    }
  }
  return wires;
}

/// A seam has two trim curves, and they are told together: first the one that runs with the edge.
void ShapeMaker::AttachPcurves(const std::vector<Wire>& wires, const Handle(Geom_Surface) & surface)
{
  std::vector<const Pcurve*> all;
  for (const Wire& wire : wires)
  {
    for (const Pcurve& use : wire)
    {
      all.push_back(&use);
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Pcurve* a, const Pcurve* b) {
    return a->Edge != b->Edge ? a->Edge < b->Edge : a->Reversed < b->Reversed;
  });
  BRep_Builder builder;
  const TopLoc_Location here;
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    const std::int64_t index = all[i]->Edge;
    TopoDS_Edge& shape = this->EdgeShape(index);
    const ExportEdge& edge = this->Edges.Edges[index];
    const double tolerance = this->Length(edge.Tolerance);
    if (all[i]->Curve.IsNull())
    {
      builder.UpdateEdge(shape, tolerance);
    }
    else if (i + 1 < all.size() && all[i + 1]->Edge == index)
    {
      builder.UpdateEdge(shape, all[i]->Curve, all[i + 1]->Curve, surface, here, tolerance);
      ++i;
    }
    else
    {
      builder.UpdateEdge(shape, all[i]->Curve, surface, here, tolerance);
    }
    builder.Range(shape, this->Ranges[index].Min, this->Ranges[index].Max);
    for (const std::int64_t vertex : edge.Vertex)
    {
      builder.UpdateVertex(this->Vertices[vertex], tolerance);
    }
  }
}

TopoDS_Face ShapeMaker::MakeFace(
  const std::vector<Wire>& wires, const Handle(Geom_Surface) & surface)
{
  BRep_Builder builder;
  TopoDS_Face face;
  builder.MakeFace(face, surface, Precision::Confusion());
  for (const Wire& wire : wires)
  {
    TopoDS_Wire shape;
    builder.MakeWire(shape);
    for (const Pcurve& use : wire)
    {
      builder.Add(
        shape, this->EdgeShape(use.Edge).Oriented(use.Reversed ? TopAbs_REVERSED : TopAbs_FORWARD));
    }
    shape.Closed(Standard_True);
    builder.Add(face, shape);
  }
  return face;
}

void ShapeMaker::TryFace(std::size_t f)
{
  if (!this->Result.FaceErrors[f].empty())
  {
    return;
  }
  const Face& face = this->Whole.Data.Faces[f];
  const bool mirrored = this->Forms[f] && this->Forms[f]->IsMirrored();
  try
  {
    const std::vector<std::vector<std::int64_t>> groups = GroupLoops(this->Whole.Data, face);
    std::vector<std::vector<Wire>> pieces;
    std::vector<Wire> all;
    for (const std::vector<std::int64_t>& loops : groups)
    {
      pieces.push_back(this->ExportWires(static_cast<std::int64_t>(f), loops));
      all.insert(all.end(), pieces.back().begin(), pieces.back().end());
    }
    this->AttachPcurves(all, this->Surfaces[f]);
    for (std::size_t k = 0; k < pieces.size(); ++k)
    {
      for (const std::int64_t l : groups[k])
      {
        this->FaceOfLoop[l] = static_cast<std::int64_t>(this->Result.Faces.size());
      }
      this->Result.Faces.push_back(this->MakeFace(pieces[k], this->Surfaces[f]));
      this->Result.Faces.back().Orientation(
        face.Reversed != mirrored ? TopAbs_REVERSED : TopAbs_FORWARD);
      this->Result.FaceOf.push_back(static_cast<std::int64_t>(f));
    }
    this->Result.SplitFaces += pieces.size() > 1;
    this->Result.AnalyticFaces += this->Forms[f].has_value();
  }
  catch (const Error& error)
  {
    this->Result.FaceErrors[f] = std::string("a curve of it can't be written: ") + error.what();
  }
  catch (const Standard_Failure& failure)
  {
    this->Result.FaceErrors[f] = "OpenCASCADE refuses it: " + ReasonOf(failure);
  }
}

void ShapeMaker::Count()
{
  std::set<std::int64_t> torn;
  for (const ExportEdge& edge : this->Edges.Edges)
  {
    if (edge.Torn)
    {
      torn.insert(edge.Source);
    }
    if (!edge.Pole)
    {
      ++this->Result.Edges;
      this->Result.SharedEdges += edge.Uses.size() > 1;
      this->Result.ComputedEdges += edge.Computed;
      this->Result.EdgeTolerance =
        std::max(this->Result.EdgeTolerance, this->Length(edge.Tolerance));
    }
  }
  this->Result.TornEdges = static_cast<std::int64_t>(torn.size());
}

void ShapeMaker::GatherBodies()
{
  std::vector<std::int64_t> faceOf(this->Whole.Data.TrimCurves.size(), -1);
  for (std::size_t l = 0; l < this->FaceOfLoop.size(); ++l)
  {
    const TrimLoop& loop = this->Whole.Data.Loops[l];
    std::fill_n(faceOf.begin() + loop.FirstCurve, loop.CurveCount, this->FaceOfLoop[l]);
  }
  std::vector<BodyLink> links;
  for (const ExportEdge& edge : this->Edges.Edges)
  {
    if (edge.Pole)
    {
      continue;
    }
    BodyLink link;
    for (const EdgeUse& use : edge.Uses)
    {
      const bool reversed = this->Whole.Data.TrimCurves[use.Curve].Reversed;
      if (faceOf[use.Curve] >= 0)
      {
        link.push_back(
          { faceOf[use.Curve], reversed != this->Whole.Data.Faces[use.Face].Reversed });
      }
    }
    links.push_back(std::move(link));
  }
  const Bodies bodies = MakeBodies(this->Result.Faces, links);
  this->Result.Shape = bodies.Shape;
  this->Result.Solids = bodies.Solids;
  this->Result.Shells = bodies.Shells;
}

/// The statuses of a shape, and of those of its own parts in its context.
void AppendReasons(
  const BRepCheck_Analyzer& analyzer, const TopoDS_Shape& shape, std::set<std::string>& reasons)
{
  const Handle(BRepCheck_Result)& result = analyzer.Result(shape);
  const auto append = [&](const BRepCheck_ListOfStatus& list) {
    for (BRepCheck_ListIteratorOfListOfStatus it(list); it.More(); it.Next())
    {
      if (it.Value() != BRepCheck_NoError)
      {
        std::ostringstream text;
        BRepCheck::Print(it.Value(), text);
        std::string word = text.str();
        word.erase(word.find_last_not_of(" \n") + 1);
        reasons.insert(word);
      }
    }
  };
  if (result.IsNull())
  {
    return;
  }
  append(result->Status());
  for (result->InitContextIterator(); result->MoreShapeInContext(); result->NextShapeInContext())
  {
    append(result->StatusOnShape());
  }
}

std::string Joined(const std::set<std::string>& words)
{
  std::string text;
  for (const std::string& word : words)
  {
    text += (text.empty() ? "" : ", ") + word;
  }
  return text;
}

std::vector<ShapeFault> FindFaults(const BuiltShape& built)
{
  std::vector<ShapeFault> faults;
  if (built.Shape.IsNull())
  {
    return faults;
  }
  const BRepCheck_Analyzer analyzer(built.Shape);
  if (analyzer.IsValid())
  {
    return faults;
  }
  for (std::size_t f = 0; f < built.Faces.size(); ++f)
  {
    if (analyzer.IsValid(built.Faces[f]))
    {
      continue;
    }
    std::set<std::string> reasons;
    for (const TopAbs_ShapeEnum kind : { TopAbs_FACE, TopAbs_WIRE, TopAbs_EDGE, TopAbs_VERTEX })
    {
      for (TopExp_Explorer it(built.Faces[f], kind); it.More(); it.Next())
      {
        AppendReasons(analyzer, it.Current(), reasons);
      }
    }
    faults.push_back({ built.FaceOf[f], Joined(reasons) });
  }
  for (TopExp_Explorer it(built.Shape, TopAbs_SHELL); it.More(); it.Next())
  {
    std::set<std::string> reasons;
    AppendReasons(analyzer, it.Current(), reasons);
    if (!reasons.empty())
    {
      faults.push_back({ -1, "a shell: " + Joined(reasons) });
    }
  }
  for (TopExp_Explorer it(built.Shape, TopAbs_SOLID); it.More(); it.Next())
  {
    std::set<std::string> reasons;
    AppendReasons(analyzer, it.Current(), reasons);
    if (!reasons.empty())
    {
      faults.push_back({ -1, "a solid: " + Joined(reasons) });
    }
  }
  return faults;
}

} // namespace

BuiltShape BuildShape(const Model& model, const std::vector<std::string>& faceErrors,
  const ShapeOptions& options, const ParallelFor& parallel, const std::atomic<bool>& abort)
{
  return WithoutFailures("to build the shape",
    [&] { return ShapeMaker(model, faceErrors, options, parallel, abort).Run(); });
}

std::vector<ShapeFault> CheckShape(const BuiltShape& built)
{
  return WithoutFailures("to check the shape", [&] { return FindFaults(built); });
}

} // namespace nurbs
