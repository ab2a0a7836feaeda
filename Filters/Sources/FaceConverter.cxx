// SPDX-License-Identifier: BSD-3-Clause
#include "FaceConverter.h"

#include "SurfaceEvaluator.h"

#include "CurveConverter.h"
#include "CurveFit.h"
#include "SurfaceConverter.h"
#include "TrimLoops.h"

#include <BRep_Tool.hxx>
#include <Geom2dAdaptor_Curve.hxx>
#include <Geom_Plane.hxx>
#include <Standard_Failure.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <gp_Trsf.hxx>

#include <algorithm>
#include <cmath>
#include <optional>

namespace nurbs
{

namespace
{

/// The face's surface in its own coordinates and where it is in the part.
struct FaceSurface
{
  FaceSurface(
    const Handle(Geom_Surface) & surface, const TopLoc_Location& location, double tolerance)
    : Converter(surface, tolerance)
    , Location(ToPlacement(location.Transformation()))
    , Moved(!location.IsIdentity())
  {
    if (this->Converter.IsPlane())
    {
      const gp_Ax3& frame = Handle(Geom_Plane)::DownCast(this->Converter.GetSurface())->Position();
      auto vec = [](const gp_XYZ& p) { return Vec3(p.X(), p.Y(), p.Z()); };
      this->Origin = this->Location.Linear * vec(frame.Location().XYZ()) + this->Location.Shift;
      Eigen::Matrix<double, 3, 2> axes;
      axes << this->Location.Linear * vec(frame.XDirection().XYZ()),
        this->Location.Linear * vec(frame.YDirection().XYZ());
      this->ToPlane = (axes.transpose() * axes).inverse() * axes.transpose();
    }
  }

  Vec3 Place(const gp_Pnt& p) const
  {
    return this->Location.Linear * Vec3(p.X(), p.Y(), p.Z()) + this->Location.Shift;
  }

  /// (u, v) of a point's projection on a plane.
  Vec2 Project(const Vec3& p) const { return this->ToPlane * (p - this->Origin); }

  SurfaceConverter Converter;
  Placement Location;
  bool Moved;
  Vec3 Origin = Vec3::Zero();
  Eigen::Matrix<double, 2, 3> ToPlane = Eigen::Matrix<double, 2, 3>::Zero();
};

/// A trim curve on its way.
struct Use
{
  std::int64_t Edge = -1;
  bool Reversed = false;
  Handle(Geom2d_Curve) Curve2d; ///< Null: the edge is projected on the plane.
  double First = 0.0;           ///< Its range belongs to the edge's range.
  double Last = 0.0;
  Vec2 Shift = Vec2::Zero(); ///< Whole periods.
};

class Converter
{
public:
  Converter(const TopoDS_Face& face, const EdgeTable& table, FaceResult& result)
    : Shape(TopoDS::Face(face.Oriented(TopAbs_FORWARD)))
    , Table(table)
    , Result(result)
    , Support(this->SurfaceOf(face), this->Where, std::max(1e-9 * table.Size, 1e-12))
  {
    result.Face.Reversed = face.Orientation() == TopAbs_REVERSED;
  }

  void Run()
  {
    this->CollectLoops();
    this->ConvertTrims();
    this->ConvertSurface();
    for (Part::Loop& loop : this->Result.Face.Loops)
    {
      for (Part::TrimCurve& trim : loop)
      {
        this->ClampTrim(trim);
      }
    }
    this->MeasureSurface();
    this->MeasureEdges();
  }

private:
  Handle(Geom_Surface) SurfaceOf(const TopoDS_Face& face)
  {
    const Handle(Geom_Surface)& surface = BRep_Tool::Surface(face, this->Where);
    if (surface.IsNull())
    {
      throw Error("the face has no surface");
    }
    return surface;
  }

  const Part::Edge& EdgeOf(const Use& use) const
  {
    return (*this->Table.Edges)[static_cast<std::size_t>(use.Edge)];
  }

  void CollectLoops();
  Use MakeUse(const TopoDS_Edge& edge) const;
  TrimEnds EndsOf(const Use& use) const;
  void ConvertTrims();
  Curve<2> ConvertTrim(const Use& use) const;
  Curve<2> ProjectEdge(const Use& use) const;
  Curve<2> ComposeTrim(const Use& use) const;
  Curve<2> StraightPole(const Use& use) const;
  Vec2 ScaleOf(const Use& use) const;
  double ToCurve2d(const Use& use, double t) const;
  std::vector<double> BreaksOfTrim(const Use& use, const ParameterMap& map, Interval range) const;
  Interval RangeOf(int dir) const;
  void ConvertSurface();
  void ClampTrim(Part::TrimCurve& trim);
  void MeasureSurface();
  Vec3 Lift(const CurveView<2>& trim, double t);
  double Deviation(const Part::TrimCurve& trim);
  double DistanceFromPlane(const CurveView<3>& curve) const;
  void MeasureEdges();

  TopoDS_Face Shape;
  const EdgeTable& Table;
  FaceResult& Result;
  TopLoc_Location Where;
  FaceSurface Support;
  std::vector<std::vector<Use>> Loops;
  std::optional<SurfaceEvaluator> Evaluator; ///< Of the converted surface.
};

Use Converter::MakeUse(const TopoDS_Edge& edge) const
{
  Use use;
  use.Edge = this->Table.Index.FindIndex(edge) - 1;
  use.Reversed = edge.Orientation() == TopAbs_REVERSED;
  const Part::Edge& converted = this->EdgeOf(use);
  if (this->Support.Converter.IsPlane() && converted.Kind == Part::EdgeKind::Curve)
  {
    return use;
  }
  use.Curve2d = BRep_Tool::CurveOnSurface(edge, this->Shape, use.First, use.Last);
  if (use.Curve2d.IsNull())
  {
    throw Error("an edge has no curve on the surface, and none could be computed");
  }
  if (!(use.First < use.Last))
  {
    throw Error("an edge has an empty or reversed parameter range");
  }
  return use;
}

/// Where the loop enters and leaves the curve, in the surface's original parameters.
TrimEnds Converter::EndsOf(const Use& use) const
{
  Vec2 ends[2];
  for (int i = 0; i < 2; ++i)
  {
    if (use.Curve2d.IsNull())
    {
      const std::vector<Vec3>& points = this->EdgeOf(use).Geometry.Points;
      ends[i] = this->Support.Project(i == 0 ? points.front() : points.back());
    }
    else
    {
      const gp_Pnt2d p = use.Curve2d->Value(i == 0 ? use.First : use.Last);
      ends[i] = Vec2(p.X(), p.Y());
    }
  }
  const std::int64_t* vertex = this->EdgeOf(use).Vertex;
  const int start = use.Reversed ? 1 : 0;
  return { ends[start], ends[1 - start], vertex[start], vertex[1 - start] };
}

void Converter::CollectLoops()
{
  const Vec2 period(this->Support.Converter.Period(0), this->Support.Converter.Period(1));
  std::vector<LoopBox> boxes;
  for (TopoDS_Iterator wires(this->Shape); wires.More(); wires.Next())
  {
    if (wires.Value().ShapeType() != TopAbs_WIRE)
    {
      continue;
    }
    std::vector<Use> uses;
    std::vector<TrimEnds> ends;
    for (TopoDS_Iterator it(wires.Value()); it.More(); it.Next())
    {
      const TopAbs_Orientation side = it.Value().Orientation();
      if (it.Value().ShapeType() == TopAbs_EDGE &&
        (side == TopAbs_FORWARD || side == TopAbs_REVERSED))
      {
        uses.push_back(this->MakeUse(TopoDS::Edge(it.Value())));
        ends.push_back(this->EndsOf(uses.back()));
      }
    }
    for (const OrderedLoop& order : OrderLoops(ends, period))
    {
      std::vector<Use> loop;
      LoopBox box;
      for (const OrderedLoop::Item& item : order.Items)
      {
        loop.push_back(uses[item.Index]);
        loop.back().Shift = item.Shift;
        box.extend(ends[item.Index].Start + item.Shift);
        box.extend(ends[item.Index].End + item.Shift);
      }
      this->Loops.push_back(std::move(loop));
      boxes.push_back(box);
    }
  }
  const std::vector<Vec2> shifts = GatherLoops(boxes, period);
  for (std::size_t i = 0; i < this->Loops.size(); ++i)
  {
    for (Use& use : this->Loops[i])
    {
      use.Shift += shifts[i];
    }
  }
}

void Converter::ConvertTrims()
{
  for (const std::vector<Use>& uses : this->Loops)
  {
    Part::Loop loop;
    for (const Use& use : uses)
    {
      loop.push_back({ this->ConvertTrim(use), use.Edge, use.Reversed });
    }
    this->Result.Face.Loops.push_back(std::move(loop));
  }
}

Curve<2> Converter::ConvertTrim(const Use& use) const
{
  if (use.Curve2d.IsNull())
  {
    return this->ProjectEdge(use);
  }
  const EdgeSource& source = this->Table.Sources[static_cast<std::size_t>(use.Edge)];
  const SurfaceConverter& surface = this->Support.Converter;
  if (this->EdgeOf(use).Kind == Part::EdgeKind::Pole)
  {
    return this->StraightPole(use);
  }
  Curve<2> trim;
  if (source.Map.IsIdentity() && surface.Map(0).IsIdentity() && surface.Map(1).IsIdentity() &&
    ConvertSpline(use.Curve2d, this->ToCurve2d(use, source.Range[0]),
      this->ToCurve2d(use, source.Range[1]), trim))
  {
    const Interval domain = trim.View().Domain();
    const double ratio = (source.Range[1] - source.Range[0]) / domain.Length();
    const bool same = domain.Min == source.Range[0] && domain.Max == source.Range[1];
    for (double& knot : trim.Knots)
    {
      knot = same
        ? knot
        : (knot >= domain.Max ? source.Range[1] : source.Range[0] + (knot - domain.Min) * ratio);
    }
    for (Vec2& p : trim.Points)
    {
      p += use.Shift;
    }
    trim.Pack();
    return trim;
  }
  return this->ComposeTrim(use);
}

/// On a plane a trim curve is the edge's own control net in the plane's coordinates.
Curve<2> Converter::ProjectEdge(const Use& use) const
{
  const Curve<3>& edge = this->EdgeOf(use).Geometry;
  Curve<2> trim;
  trim.Degree = edge.Degree;
  trim.Knots = edge.Knots;
  trim.Weights = edge.Weights;
  for (const Vec3& p : edge.Points)
  {
    trim.Points.push_back(this->Support.Project(p));
  }
  trim.Pack();
  return trim;
}

/// The parameter of the (u, v) curve that belongs to the edge's parameter t.
double Converter::ToCurve2d(const Use& use, double t) const
{
  const EdgeSource& source = this->Table.Sources[static_cast<std::size_t>(use.Edge)];
  double first, last;
  BRep_Tool::Range(source.Shape, first, last);
  if (this->EdgeOf(use).Kind != Part::EdgeKind::Curve || (first == use.First && last == use.Last))
  {
    return t;
  }
  return use.First + (t - first) * (use.Last - use.First) / (last - first);
}

/// Along a pole the parameter means nothing, so its trim curve is straight in the converted one.
Curve<2> Converter::StraightPole(const Use& use) const
{
  Curve<2> trim;
  trim.Knots = { use.First, use.First, use.Last, use.Last };
  for (const double t : { use.First, use.Last })
  {
    const gp_Pnt2d p = use.Curve2d->Value(t);
    trim.Points.emplace_back(this->Support.Converter.Map(0).Forward(p.X() + use.Shift[0]),
      this->Support.Converter.Map(1).Forward(p.Y() + use.Shift[1]));
  }
  trim.Weights.assign(2, 1.0);
  trim.Pack();
  return trim;
}

/// Lengths of the surface's derivatives along the curve: what (u, v) deviations mean in space.
Vec2 Converter::ScaleOf(const Use& use) const
{
  Vec2 scale = Vec2::Zero();
  for (const double r : { 0.02, 0.5, 0.98 })
  {
    const gp_Pnt2d p = use.Curve2d->Value(use.First + r * (use.Last - use.First));
    gp_Pnt s;
    gp_Vec du, dv;
    this->Support.Converter.GetSurface()->D1(p.X(), p.Y(), s, du, dv);
    scale = scale.cwiseMax(Vec2(du.Magnitude(), dv.Magnitude()));
  }
  scale *= this->Support.Location.Linear.col(0).norm();
  const double least = std::max(1e-3 * scale.maxCoeff(), 1e-6 * this->Table.Size);
  return scale.cwiseMax(Vec2(least, least));
}

/// Where the converted trim curve is not smooth, in its own parameter: where the edge's spans meet,
/// where the (u, v) curve has knots, and where it crosses the surface's spans.
std::vector<double> Converter::BreaksOfTrim(
  const Use& use, const ParameterMap& map, Interval range) const
{
  const double t0 = map.Inverse(range.Min);
  const double t1 = map.Inverse(range.Max);
  std::vector<double> breaks{ range.Min };
  map.AppendBreaks(range.Min, range.Max, breaks);
  const double p0 = this->ToCurve2d(use, t0);
  const double p1 = this->ToCurve2d(use, t1);
  for (const double p : BreaksOf(use.Curve2d, p0, p1))
  {
    breaks.push_back(map.Forward(t0 + (p - p0) * (t1 - t0) / (p1 - p0)));
  }
  breaks.push_back(range.Max);
  std::sort(breaks.begin(), breaks.end());

  std::vector<double> crossings;
  const Geom2dAdaptor_Curve curve(use.Curve2d); // Faster than the curve itself.
  for (int dir = 0; dir < 2; ++dir)
  {
    const ParameterMap& surface = this->Support.Converter.Map(dir);
    if (surface.IsIdentity())
    {
      continue;
    }
    auto coordinate = [&](double x) {
      const gp_Pnt2d p = curve.Value(this->ToCurve2d(use, map.Inverse(x)));
      return (dir == 0 ? p.X() : p.Y()) + use.Shift[dir];
    };
    AppendCrossings(coordinate, breaks, surface.Offset(), surface.Span(), crossings);
  }
  breaks.insert(breaks.end(), crossings.begin(), crossings.end());
  return DistinctBreaks(std::move(breaks), range);
}

/// The (u, v) curve in the parameters of edge and surface after conversion.
Curve<2> Converter::ComposeTrim(const Use& use) const
{
  const EdgeSource& source = this->Table.Sources[static_cast<std::size_t>(use.Edge)];
  const ParameterMap& map = source.Map;
  Interval range{ use.First, use.Last };
  if (this->EdgeOf(use).Kind == Part::EdgeKind::Curve)
  {
    range = this->EdgeOf(use).Geometry.View().Domain();
  }
  const SurfaceConverter& surface = this->Support.Converter;
  const Geom2dAdaptor_Curve curve(use.Curve2d);
  const auto value = [&](double x) {
    const gp_Pnt2d p = curve.Value(this->ToCurve2d(use, map.Inverse(x)));
    return Vec2(
      surface.Map(0).Forward(p.X() + use.Shift[0]), surface.Map(1).Forward(p.Y() + use.Shift[1]));
  };
  double error = 0.0;
  return FitCurve<2>(value, this->BreaksOfTrim(use, map, range), this->ScaleOf(use),
    this->Table.FitTolerance(use.Edge), error);
}

/// The range of the original parameter that the trim curves need.
Interval Converter::RangeOf(int dir) const
{
  const SurfaceConverter& surface = this->Support.Converter;
  const Interval natural = surface.NaturalRange(dir);
  if (this->Loops.empty())
  {
    return natural;
  }
  Interval range{ std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest() };
  for (const Part::Loop& loop : this->Result.Face.Loops)
  {
    for (const Part::TrimCurve& trim : loop)
    {
      for (const Vec2& p : trim.Geometry.Points)
      {
        range.Min = std::min(range.Min, p[dir]);
        range.Max = std::max(range.Max, p[dir]);
      }
    }
  }
  range.Min = surface.Map(dir).Inverse(range.Min);
  range.Max = surface.Map(dir).Inverse(range.Max);
  if (surface.Period(dir) == 0.0)
  {
    range.Min = std::max(range.Min, natural.Min);
    range.Max = std::min(range.Max, natural.Max);
  }
  return range;
}

void Converter::ConvertSurface()
{
  Part::Face& face = this->Result.Face;
  face.Geometry = this->Support.Converter.Convert(this->RangeOf(0), this->RangeOf(1), face.Error);
  if (this->Support.Moved)
  {
    for (Vec3& p : face.Geometry.Points)
    {
      p = this->Support.Location.Linear * p + this->Support.Location.Shift;
    }
  }
  for (const Vec3& p : face.Geometry.Points)
  {
    if (!p.allFinite())
    {
      throw Error("the surface has a control point that is not a number");
    }
  }
  const auto& weights = face.Geometry.Weights;
  if (std::any_of(weights.begin(), weights.end(), [](double w) { return !(w > 0.0); }))
  {
    throw Error("the surface has a weight that is not positive");
  }
}

/// Rounding, fits and sloppy files leave control points of trim curves a little outside the domain,
/// where splines may run wild. They are moved inside; by more than rounding only if the curve comes
/// not much farther from its edge than it is or the tolerance allows.
void Converter::ClampTrim(Part::TrimCurve& trim)
{
  constexpr double Rounding = 1e-9;
  constexpr double Sloppy = 1e-3;
  const SurfaceView surface = this->Result.Face.Geometry.View();
  Part::TrimCurve inside = trim;
  double moved = 0.0;
  for (Vec2& p : inside.Geometry.Points)
  {
    for (int dir = 0; dir < 2; ++dir)
    {
      const Interval domain = surface.Domain(dir);
      const double clamped = domain.Clamp(p[dir]);
      moved = std::max(moved, std::abs(clamped - p[dir]) / domain.Length());
      p[dir] = clamped;
    }
  }
  if (moved == 0.0 || moved > Sloppy)
  {
    return;
  }
  inside.Geometry.Pack();
  if (moved > Rounding)
  {
    const std::size_t edge = static_cast<std::size_t>(trim.Edge);
    const double enough = std::max(this->Table.Sources[edge].Tolerance, 1e-9 * this->Table.Size);
    if ((*this->Table.Edges)[edge].Kind == Part::EdgeKind::Curve &&
      this->Deviation(inside) > std::max(2.0 * this->Deviation(trim), enough))
    {
      return;
    }
  }
  trim = std::move(inside);
}

/// Compares with the original surface at a grid of parameters.
void Converter::MeasureSurface()
{
  Part::Face& face = this->Result.Face;
  const SurfaceView surface = face.Geometry.View();
  const SurfaceConverter& converter = this->Support.Converter;
  constexpr int Samples = 7;
  for (int i = 0; i < Samples * Samples; ++i)
  {
    double x[2];
    double u[2];
    for (int dir = 0; dir < 2; ++dir)
    {
      const Interval domain = surface.Domain(dir);
      const double r = ((dir == 0 ? i % Samples : i / Samples) + 0.37) / Samples;
      x[dir] = domain.Min + r * domain.Length();
      u[dir] = converter.Map(dir).Inverse(x[dir]);
    }
    const Vec3 original = this->Support.Place(converter.GetSurface()->Value(u[0], u[1]));
    face.Error = std::max(face.Error, (Evaluate(surface, x[0], x[1]) - original).norm());
  }
}

/// The surface over a point of a trim curve; the domain's border stands for what is outside.
Vec3 Converter::Lift(const CurveView<2>& trim, double t)
{
  if (!this->Evaluator)
  {
    this->Evaluator.emplace(this->Result.Face.Geometry.View());
  }
  const SurfaceView& surface = this->Evaluator->GetSurface();
  const Vec2 p = Evaluate(trim, t);
  return this->Evaluator->Point(surface.Domain(0).Clamp(p[0]), surface.Domain(1).Clamp(p[1]));
}

/// Largest distance of the lifted trim curve from its edge.
double Converter::Deviation(const Part::TrimCurve& trim)
{
  const Part::Edge& edge = (*this->Table.Edges)[static_cast<std::size_t>(trim.Edge)];
  const CurveView<3> curve = edge.Geometry.View();
  if (this->Support.Converter.IsPlane())
  {
    // The trim curve is the edge's projection: no point is farther than a control point.
    const double most = this->DistanceFromPlane(curve);
    if (most <= 1e-9 * this->Table.Size)
    {
      return most;
    }
  }
  return LargestValue(
    [&](double t) { return (this->Lift(trim.Geometry.View(), t) - Evaluate(curve, t)).norm(); },
    SampleParameters(trim.Geometry.View(), curve), 1e-11 * this->Table.Size);
}

/// Largest distance of a curve's control points from the face's plane.
double Converter::DistanceFromPlane(const CurveView<3>& curve) const
{
  const SurfaceView plane = this->Result.Face.Geometry.View();
  const Vec3 origin = plane.Point(0);
  const Vec3 normal =
    (plane.Point(1) - origin).cross(plane.Point(plane.Count[0]) - origin).normalized();
  double most = 0.0;
  for (int i = 0; i < curve.Count; ++i)
  {
    most = std::max(most, std::abs(normal.dot(curve.Point(i) - origin)));
  }
  return most;
}

/// Tells how far the edges are and where the face sees the vertices.
void Converter::MeasureEdges()
{
  for (const Part::Loop& loop : this->Result.Face.Loops)
  {
    for (const Part::TrimCurve& trim : loop)
    {
      const Part::Edge& edge = (*this->Table.Edges)[static_cast<std::size_t>(trim.Edge)];
      const Interval domain = trim.Geometry.View().Domain();
      for (int k = 0; k < 2; ++k)
      {
        const double t = k == 0 ? domain.Min : domain.Max;
        this->Result.Ends.push_back({ edge.Vertex[k], this->Lift(trim.Geometry.View(), t) });
      }
      if (edge.Kind == Part::EdgeKind::Curve)
      {
        this->Result.Deviations.push_back({ trim.Edge, this->Deviation(trim) });
      }
      else if (edge.Kind == Part::EdgeKind::Pole)
      {
        Box3 box;
        for (int k = 0; k <= 8; ++k)
        {
          box.extend(this->Lift(trim.Geometry.View(), domain.Min + k * domain.Length() / 8.0));
        }
        this->Result.Poles.push_back({ trim.Edge, box });
      }
    }
  }
}

} // namespace

double EdgeTable::FitTolerance(std::int64_t edge) const
{
  const double tolerance = this->Sources[static_cast<std::size_t>(edge)].Tolerance;
  return std::min(std::max(0.01 * tolerance, 1e-10 * this->Size), 1e-8 * this->Size);
}

Placement ToPlacement(const gp_Trsf& transformation)
{
  Placement placement;
  for (int i = 0; i < 3; ++i)
  {
    for (int j = 0; j < 3; ++j)
    {
      placement.Linear(i, j) = transformation.Value(i + 1, j + 1);
    }
    placement.Shift[i] = transformation.Value(i + 1, 4);
  }
  return placement;
}

FaceResult ConvertFace(const TopoDS_Face& face, const EdgeTable& edges)
{
  FaceResult result;
  std::string reason;
  try
  {
    Converter(face, edges, result).Run();
    return result;
  }
  catch (const Standard_Failure& failure)
  {
    const char* text = failure.GetMessageString();
    reason =
      std::string(failure.DynamicType()->Name()) + (text && *text ? ": " : "") + (text ? text : "");
  }
  catch (const std::exception& failure)
  {
    reason = failure.what();
  }
  result = FaceResult();
  result.Face.Failure = reason.empty() ? "unknown reason" : reason;
  return result;
}

} // namespace nurbs
