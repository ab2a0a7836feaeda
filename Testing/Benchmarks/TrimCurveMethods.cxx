// SPDX-License-Identifier: BSD-3-Clause
#include "TrimCurveMethods.h"

#include "CompletedModel.h"
#include "EdgeDiscretizer.h"
#include "Measuring.h"
#include "TrimCurves.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

using measuring::Stopwatch;

namespace
{

constexpr int MaxHalvings = 20;
constexpr int Samples = 5;        // a direction, of a surface's derivatives
constexpr double Inside = 1e-6;   // how far the outermost stay off the box's sides
constexpr double SameKnot = 1e-9; // of the domain

struct LiftedCurve
{
  SurfaceView Surface;
  CurveView<2> Curve;
  std::vector<BezierCurve<3>> Pieces;
};

/// Greatest lengths of a surface's derivatives.
struct Stretch
{
  double U = 0.0, V = 0.0, UU = 0.0, UV = 0.0, VV = 0.0;
};

Stretch SampleStretch(const SurfaceView& surface, const BezierCurve<2>& piece)
{
  Eigen::AlignedBox2d box;
  for (const Vec3& h : piece.Points)
  {
    box.extend(Vec2(h.head<2>() / h[2]));
  }
  Stretch most;
  for (int k = 0; k < Samples * Samples; ++k)
  {
    const Vec2 grid = Vec2(k % Samples, k / Samples) / (Samples - 1);
    const Vec2 at = Vec2::Constant(Inside) + (1.0 - 2.0 * Inside) * grid;
    const Vec2 uv = box.min() + box.sizes().cwiseProduct(at);
    const SurfaceDerivatives d = EvaluateDerivatives(surface, uv[0], uv[1], 2);
    most.U = std::max(most.U, d.Su.norm());
    most.V = std::max(most.V, d.Sv.norm());
    most.UU = std::max(most.UU, d.Suu.norm());
    most.UV = std::max(most.UV, d.Suv.norm());
    most.VV = std::max(most.VV, d.Svv.norm());
  }
  return most;
}

/// The sum of the partial errors of a 2D piece and its chord.
double DomainError(const std::vector<Vec3>& points, const Stretch& most)
{
  const Vec2 scale(most.U, most.V);
  const Vec2 first = points.front().head<2>() / points.front()[2];
  const Vec2 chord = points.back().head<2>() / points.back()[2] - first;
  const Vec2 stretched = chord.cwiseProduct(scale);
  double curve = 0.0;
  for (const Vec3& h : points)
  {
    const Vec2 p = (h.head<2>() / h[2] - first).cwiseProduct(scale);
    const double square = stretched.squaredNorm();
    const double along = square > 0.0 ? std::clamp(p.dot(stretched) / square, 0.0, 1.0) : 0.0;
    curve = std::max(curve, (p - along * stretched).lpNorm<1>());
  }
  const Vec2 d = chord.cwiseAbs();
  const double surface =
    0.125 * (d[0] * d[0] * most.UU + 2.0 * d[0] * d[1] * most.UV + d[1] * d[1] * most.VV);
  return curve + surface;
}

std::int64_t HalveInDomain(
  const std::vector<Vec3>& points, const Stretch& most, double tolerance, int depth)
{
  if (depth >= MaxHalvings || DomainError(points, most) <= tolerance)
  {
    return 1;
  }
  std::vector<Vec3> halves[2] = { points, points };
  SplitBezier<3>(points.data(), int(points.size()) - 1, 0.5, halves[0].data(), halves[1].data());
  return HalveInDomain(halves[0], most, tolerance, depth + 1) +
    HalveInDomain(halves[1], most, tolerance, depth + 1);
}

/// The 2D curve in Bezier form, cut where the lifted one is.
std::vector<BezierCurve<2>> CutLikeLifted(const LiftedCurve& lifted)
{
  const double same = SameKnot * lifted.Curve.Domain().Length();
  std::vector<double> cuts;
  for (std::size_t k = 1; k < lifted.Pieces.size(); ++k)
  {
    const double t = lifted.Pieces[k].T0;
    const KnotView knots = lifted.Curve.Knots;
    if (std::none_of(
          knots.begin(), knots.end(), [&](double knot) { return std::abs(knot - t) <= same; }))
    {
      cuts.push_back(t);
    }
  }
  Curve<2> cut = RefineKnots(lifted.Curve, cuts);
  cut.Pack();
  return ToBezier(cut.View());
}

CurveMethodFigures MeasureInDomain(const std::vector<LiftedCurve>& curves, double tolerance)
{
  CurveMethodFigures figures;
  figures.Method = "2D";
  for (const LiftedCurve& lifted : curves)
  {
    const Stopwatch conversion;
    const std::vector<BezierCurve<2>> pieces = CutLikeLifted(lifted);
    figures.Conversion += conversion.Read().Processor;
    const Stopwatch approximation;
    for (const BezierCurve<2>& piece : pieces)
    {
      const Stretch most = SampleStretch(lifted.Surface, piece);
      figures.Edges += HalveInDomain(piece.Points, most, tolerance, 0);
    }
    figures.Approximation += approximation.Read().Processor;
  }
  return figures;
}

CurveMethodFigures MeasureLifted(const std::string& method, const std::vector<LiftedCurve>& curves,
  double conversion, double tolerance, const CurveOptions& options)
{
  CurveMethodFigures figures;
  figures.Method = method;
  figures.Conversion = conversion;
  const Stopwatch approximation;
  for (const LiftedCurve& lifted : curves)
  {
    double certified = 0.0;
    figures.Edges +=
      std::int64_t(ApproximateCurve(lifted.Pieces, tolerance, options, certified).size()) - 1;
  }
  figures.Approximation = approximation.Read().Processor;
  return figures;
}

std::vector<LiftedCurve> LiftAll(const CompletedModel& model, CurveMethodTable& table)
{
  std::vector<LiftedCurve> curves;
  const Model& data = model.Data;
  for (const Face& face : data.Faces)
  {
    for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
    {
      const TrimLoop& loop = data.Loops[l];
      for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
      {
        const TrimCurve& curve = data.TrimCurves[c];
        if (data.Edges[curve.Edge].Geometry.Count == 1) // a pole
        {
          continue;
        }
        ++table.Curves;
        try
        {
          std::vector<BezierCurve<3>> pieces = LiftTrimCurve(face.Geometry, curve.Geometry);
          curves.push_back({ face.Geometry, curve.Geometry, std::move(pieces) });
        }
        catch (const Error&)
        {
          ++table.Failed;
        }
      }
    }
  }
  return curves;
}

} // namespace

CurveMethodTable CompareCurveMethods(
  const Model& model, const std::vector<std::string>& faceErrors, double tolerance)
{
  CurveMethodTable table;
  const CompletedModel completed = CompleteModel(model, faceErrors);
  const Stopwatch lifting;
  const std::vector<LiftedCurve> curves = LiftAll(completed, table);
  const double conversion = lifting.Read().Processor;
  table.Methods.push_back(MeasureInDomain(curves, tolerance));
  const auto lifted = [&](const std::string& method, const CurveOptions& options) {
    table.Methods.push_back(MeasureLifted(method, curves, conversion, tolerance, options));
  };
  for (const CurveSubdivision subdivision :
    { CurveSubdivision::Midpoint, CurveSubdivision::Arbitrary })
  {
    const std::string name = subdivision == CurveSubdivision::Midpoint ? "midpoint" : "arbitrary";
    CurveOptions options;
    options.Balanced = false;
    options.Subdivision = subdivision;
    options.Measure = CurveMeasure::Point;
    options.Simplify = false;
    lifted(name + " point", options);
    options.Measure = CurveMeasure::Line;
    lifted(name + " line", options);
    options.Simplify = true;
    lifted(name + " line simplified", options);
  }
  lifted("balanced", CurveOptions());
  return table;
}

} // namespace nurbs
