// SPDX-License-Identifier: BSD-3-Clause
#include "FaceTrim.h"

#include <BRepTools_WireExplorer.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Tool.hxx>
#include <Geom2dAdaptor_Curve.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Wire.hxx>

#include <algorithm>
#include <cmath>

namespace verify
{

namespace
{

std::vector<TopoDS_Edge> EdgesOf(const TopoDS_Wire& wire, const TopoDS_Face& face)
{
  std::vector<TopoDS_Edge> edges, unordered;
  for (BRepTools_WireExplorer e(wire, face); e.More(); e.Next())
  {
    edges.push_back(e.Current());
  }
  for (TopExp_Explorer e(wire, TopAbs_EDGE); e.More(); e.Next())
  {
    if (e.Current().Orientation() == TopAbs_FORWARD || e.Current().Orientation() == TopAbs_REVERSED)
    {
      unordered.push_back(TopoDS::Edge(e.Current()));
    }
  }
  return edges.size() == unordered.size() ? edges : unordered;
}

// The knots of the pcurve, so that no span is stepped over.
std::vector<double> Breaks(const Handle(Geom2d_Curve) & pcurve, double first, double last)
{
  const Geom2dAdaptor_Curve adaptor(pcurve, first, last);
  const int spans = adaptor.NbIntervals(GeomAbs_CN);
  std::vector<double> breaks{ first };
  if (spans > 1 && spans < 20000)
  {
    TColStd_Array1OfReal knots(1, spans + 1);
    adaptor.Intervals(knots, GeomAbs_CN);
    for (int i = 2; i <= spans; ++i)
    {
      breaks.push_back(knots(i));
    }
  }
  breaks.push_back(last);
  return breaks;
}

} // namespace

FaceTrim::FaceTrim(const TopoDS_Face& oriented, const FaceSurface& surface, double accuracy)
  : Surface(surface)
  , Accuracy(accuracy)
{
  const TopoDS_Face face = TopoDS::Face(oriented.Oriented(TopAbs_FORWARD));
  this->BoxLow.setConstant(std::numeric_limits<double>::infinity());
  this->BoxHigh = -this->BoxLow;
  bool broken = false;
  for (TopExp_Explorer w(face, TopAbs_WIRE); w.More(); w.Next())
  {
    std::vector<Curve> wire;
    for (const TopoDS_Edge& edge : EdgesOf(TopoDS::Wire(w.Current()), face))
    {
      Curve curve;
      curve.PCurve = BRep_Tool::CurveOnSurface(edge, face, curve.First, curve.Last);
      curve.Reversed = edge.Orientation() == TopAbs_REVERSED;
      if (curve.PCurve.IsNull() || !(curve.Last > curve.First))
      {
        broken = true;
        continue;
      }
      wire.push_back(curve);
    }
    this->AddWire(wire);
  }
  // Ends that should meet but whose chord leaves them in space (pcurves a period apart): then the
  // polygon means nothing. A missing pole edge is fine, its chord stays in the pole.
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec3& p : this->LinePoints)
  {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const std::size_t joints = this->Segments.size() - this->Lines.size();
  for (std::size_t i = 0; i < joints && !broken; ++i)
  {
    const auto& [a, b] = this->Segments[i];
    const Vec3 start = this->Surface.Point(a);
    broken = std::max((this->Surface.Point(0.5 * (a + b)) - start).norm(),
               (this->Surface.Point(b) - start).norm()) > 0.02 * (high - low).norm();
  }
  if (broken)
  {
    this->Classifier = std::make_unique<BRepTopAdaptor_FClass2d>(face, 1e-9);
  }
  this->Boundary.Build(this->LinePoints, this->Lines);
  this->Slabs.resize(std::clamp<std::size_t>(this->Segments.size() / 2, 1, 4096));
  const double height = std::max(this->BoxHigh[1] - this->BoxLow[1], 1e-300);
  for (std::size_t i = 0; i < this->Segments.size(); ++i)
  {
    auto slab = [&](double v) {
      const double s = (v - this->BoxLow[1]) / height * double(this->Slabs.size());
      return std::size_t(std::clamp(s, 0.0, double(this->Slabs.size() - 1)));
    };
    const auto [low, high] = std::minmax(this->Segments[i].first[1], this->Segments[i].second[1]);
    for (std::size_t k = slab(low); k <= slab(high); ++k)
    {
      this->Slabs[k].push_back(int(i));
    }
  }
}

FaceTrim::~FaceTrim() = default;

FaceTrim::Sample FaceTrim::At(const Curve& curve, double t) const
{
  const gp_Pnt2d uv = curve.PCurve->Value(t);
  const Vec2 at = this->Surface.Clamped({ uv.X(), uv.Y() });
  return { t, at, this->Surface.Point(at) };
}

void FaceTrim::Refine(
  const Curve& curve, const Sample& a, const Sample& b, int depth, std::vector<Sample>& out) const
{
  const Sample middle = this->At(curve, 0.5 * (a.T + b.T));
  const Vec3 chord = 0.5 * (a.Point + b.Point);
  bool flat = depth <= 0;
  if (!flat)
  {
    flat = (middle.Point - chord).norm() < this->Accuracy &&
      (middle.Point - this->Surface.Point(0.5 * (a.UV + b.UV))).norm() < this->Accuracy;
    for (double s : { 0.25, 0.75 })
    {
      const Sample q = flat ? this->At(curve, a.T + s * (b.T - a.T)) : a;
      flat = flat && (q.Point - (a.Point + s * (b.Point - a.Point))).norm() < 2.0 * this->Accuracy;
    }
  }
  if (flat)
  {
    out.push_back(b);
    return;
  }
  this->Refine(curve, a, middle, depth - 1, out);
  this->Refine(curve, middle, b, depth - 1, out);
}

void FaceTrim::AddWire(const std::vector<Curve>& curves)
{
  std::vector<std::pair<Vec2, Vec2>> ends;
  for (const Curve& curve : curves)
  {
    const auto breaks = Breaks(curve.PCurve, curve.First, curve.Last);
    std::vector<Sample> samples{ this->At(curve, curve.First) };
    const int pieces = std::max(1, 4 / int(breaks.size() - 1));
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
    {
      for (int k = 1; k <= pieces; ++k)
      {
        const double t = breaks[i] + (breaks[i + 1] - breaks[i]) * k / pieces;
        const Sample start = samples.back();
        this->Refine(curve, start, this->At(curve, t), 11, samples);
      }
    }
    for (std::size_t i = 0; i + 1 < samples.size(); ++i)
    {
      this->LineOrigins.emplace_back(int(this->Curves.size()), samples[i].T);
      const int at = int(this->LinePoints.size());
      this->LinePoints.push_back(samples[i].Point);
      this->LinePoints.push_back(samples[i + 1].Point);
      this->Lines.push_back({ at, at + 1, at });
      this->TotalLength += (samples[i + 1].Point - samples[i].Point).norm();
      this->AddSegment(samples[i].UV, samples[i + 1].UV);
    }
    this->Curves.push_back(curve);
    ends.emplace_back(samples.front().UV, samples.back().UV);
    if (curve.Reversed)
    {
      std::swap(ends.back().first, ends.back().second);
    }
  }
  // The joints go to the front, where the constructor finds them.
  std::vector<std::pair<Vec2, Vec2>> joints;
  for (std::size_t i = 0; i < ends.size(); ++i)
  {
    joints.emplace_back(ends[i].second, ends[(i + 1) % ends.size()].first);
  }
  this->Segments.insert(this->Segments.begin(), joints.begin(), joints.end());
}

void FaceTrim::AddSegment(const Vec2& a, const Vec2& b)
{
  this->Segments.emplace_back(a, b);
  this->BoxLow = this->BoxLow.cwiseMin(a).cwiseMin(b);
  this->BoxHigh = this->BoxHigh.cwiseMax(a).cwiseMax(b);
}

bool FaceTrim::CoversExactly(const Vec2& uv) const
{
  if (this->Classifier)
  {
    return this->Classifier->Perform(gp_Pnt2d(uv[0], uv[1]), Standard_False) != TopAbs_OUT;
  }
  if (!((uv - this->BoxLow).minCoeff() >= 0.0 && (this->BoxHigh - uv).minCoeff() >= 0.0))
  {
    return false;
  }
  const double s = (uv[1] - this->BoxLow[1]) / std::max(this->BoxHigh[1] - this->BoxLow[1], 1e-300);
  const auto slab = std::min(std::size_t(s * double(this->Slabs.size())), this->Slabs.size() - 1);
  bool inside = false;
  for (int i : this->Slabs[slab])
  {
    const auto& [a, b] = this->Segments[std::size_t(i)];
    if ((a[1] > uv[1]) != (b[1] > uv[1]) &&
      uv[0] < a[0] + (uv[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
    {
      inside = !inside;
    }
  }
  return inside;
}

bool FaceTrim::Covers(Vec2& uv) const
{
  std::array<std::vector<double>, 2> candidates;
  for (int k = 0; k < 2; ++k)
  {
    const double period = this->Surface.Period(k);
    candidates[std::size_t(k)] = { uv[k] };
    if (period > 0.0)
    {
      const double slack = 1e-9 * period;
      const double first = uv[k] + std::ceil((this->BoxLow[k] - slack - uv[k]) / period) * period;
      candidates[std::size_t(k)].clear();
      for (double x = first; x <= this->BoxHigh[k] + slack; x += period)
      {
        candidates[std::size_t(k)].push_back(x);
      }
    }
  }
  for (double u : candidates[0])
  {
    for (double v : candidates[1])
    {
      if (this->CoversExactly({ u, v }))
      {
        uv = { u, v };
        return true;
      }
    }
  }
  return false;
}

double FaceTrim::RefineOnCurve(const Curve& curve, const Vec3& p, double t) const
{
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 6; ++i)
  {
    gp_Pnt2d uv;
    gp_Vec2d d;
    curve.PCurve->D1(t, uv, d);
    Vec3 s, su, sv;
    this->Surface.Derivatives(this->Surface.Clamped({ uv.X(), uv.Y() }), s, su, sv);
    const double distance = (s - p).norm();
    const bool better = distance < best;
    best = std::min(best, distance);
    const Vec3 tangent = su * d.X() + sv * d.Y();
    const double length2 = tangent.squaredNorm();
    if (!better || !(length2 > 0.0))
    {
      break;
    }
    t = std::clamp(t + (p - s).dot(tangent) / length2, curve.First, curve.Last);
  }
  return best;
}

double FaceTrim::BoundaryDistance(const Vec3& p, double bound) const
{
  const ClosestTriangle::Hit hit = this->Boundary.Find(p, bound);
  if (hit.Triangle < 0)
  {
    return std::numeric_limits<double>::infinity();
  }
  return this->RefineFrom(std::size_t(hit.Triangle), hit.Weights[1], p);
}

double FaceTrim::BoundaryDistanceExactly(const Vec3& p) const
{
  double best = this->BoundaryDistance(p, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < this->Lines.size(); ++i)
  {
    const std::array<Vec3, 3> corners{ this->LinePoints[2 * i], this->LinePoints[2 * i + 1],
      this->LinePoints[2 * i] };
    const double along = NearestWeights(p, corners)[1];
    const Vec3 nearest = corners[0] + along * (corners[1] - corners[0]);
    if ((nearest - p).norm() < best + 2.0 * this->Accuracy)
    {
      best = std::min(best, this->RefineFrom(i, along, p));
    }
  }
  return best;
}

double FaceTrim::RefineFrom(std::size_t line, double along, const Vec3& p) const
{
  const auto& [index, start] = this->LineOrigins[line];
  const Curve& curve = this->Curves[std::size_t(index)];
  const bool sameCurve =
    line + 1 < this->Lines.size() && this->LineOrigins[line + 1].first == index;
  const double end = sameCurve ? this->LineOrigins[line + 1].second : curve.Last;
  return this->RefineOnCurve(curve, p, start + along * (end - start));
}

std::vector<Vec3> FaceTrim::BoundarySamples(double step) const
{
  std::vector<Vec3> samples;
  for (std::size_t i = 0; i < this->Lines.size(); ++i)
  {
    const auto& [index, start] = this->LineOrigins[i];
    const Curve& curve = this->Curves[std::size_t(index)];
    const bool sameCurve = i + 1 < this->Lines.size() && this->LineOrigins[i + 1].first == index;
    const double end = sameCurve ? this->LineOrigins[i + 1].second : curve.Last;
    const double length = (this->LinePoints[2 * i + 1] - this->LinePoints[2 * i]).norm();
    const int pieces = int(std::clamp(std::ceil(length / std::max(step, 1e-300)), 1.0, 1000.0));
    for (int k = 0; k < pieces; ++k)
    {
      samples.push_back(this->At(curve, start + (end - start) * (k + 0.5) / pieces).Point);
    }
  }
  return samples;
}

} // namespace verify
