// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeContour.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr int SignSamples = 17;
constexpr int MaxBisections = 50;
constexpr int FacingSamples = 5;
constexpr double FacingCosine = 1e-6; // Less faces neither way.

// Adds where a function of t changes its sign.
template <typename Function>
void AddSignChanges(const Function& f, const Interval& domain, std::vector<double>& out)
{
  double before = domain.Min;
  double valueBefore = f(before);
  for (int k = 1; k < SignSamples; ++k)
  {
    const double t = domain.Min + domain.Length() * k / (SignSamples - 1);
    const double value = f(t);
    if ((value < 0.0) != (valueBefore < 0.0))
    {
      double low = before;
      double high = t;
      for (int i = 0; i < MaxBisections; ++i)
      {
        const double middle = 0.5 * (low + high);
        ((f(middle) < 0.0) == (valueBefore < 0.0) ? low : high) = middle;
      }
      out.push_back(0.5 * (low + high));
    }
    before = t;
    valueBefore = value;
  }
}

} // namespace

double CosineOfUse(
  const Model& model, const EdgeUse& use, const Interval& domain, const Viewer& viewer, double t)
{
  const Face& face = model.Faces[use.Face];
  const TrimCurve& curve = model.TrimCurves[use.Curve];
  const Vec2 on = Evaluate(curve.Geometry, TrimParameter(curve, domain, t));
  const Vec2 uv(face.Geometry.Domain(0).Clamp(on[0]), face.Geometry.Domain(1).Clamp(on[1]));
  const Vec3 view = viewer.Perspective ? viewer.Toward(Evaluate(face.Geometry, uv[0], uv[1]))
                                       : viewer.Place; // Of any point.
  const double length = view.norm();
  const double cosine = length > 0.0 ? Normal(face.Geometry, uv[0], uv[1]).dot(view) / length : 0.0;
  return face.Reversed ? -cosine : cosine;
}

std::vector<EdgeContour> ContoursOfEdge(const Model& model, std::int64_t edge,
  const std::vector<EdgeUse>& uses, const Viewer& viewer, double precision)
{
  const Interval domain = EdgeDomain(model, edge, uses);
  std::vector<double> breaks{ domain.Min, domain.Max };
  for (const EdgeUse& use : uses)
  {
    AddSignChanges(
      [&](double t) { return CosineOfUse(model, use, domain, viewer, t); }, domain, breaks);
  }
  std::sort(breaks.begin(), breaks.end());
  std::vector<EdgeContour> out;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k)
  {
    const double t = 0.5 * (breaks[k] + breaks[k + 1]);
    const double first = CosineOfUse(model, uses[0], domain, viewer, t);
    const double second = CosineOfUse(model, uses[1], domain, viewer, t);
    if (std::min(first, second) > -ContourCosine || std::max(first, second) < ContourCosine)
    {
      continue;
    }
    EdgeContour contour;
    contour.Use = first > 0.0 ? uses[0] : uses[1];
    const TrimCurve& curve = model.TrimCurves[contour.Use.Curve];
    contour.Ends[0] = TrimParameter(curve, domain, breaks[k]);
    contour.Ends[1] = TrimParameter(curve, domain, breaks[k + 1]);
    contour.Points = LiftEdge(model, contour.Use, { contour.Ends[0], contour.Ends[1] }, precision);
    // A loop has its face on the left of Su x Sv.
    if (curve.Reversed != model.Faces[contour.Use.Face].Reversed)
    {
      std::reverse(contour.Points.begin(), contour.Points.end());
      std::swap(contour.Ends[0], contour.Ends[1]);
    }
    if (contour.Points.size() > 1)
    {
      out.push_back(std::move(contour));
    }
  }
  return out;
}

bool FaceTheSameWay(
  const Model& model, std::int64_t edge, const std::vector<EdgeUse>& uses, const Viewer& viewer)
{
  if (uses.size() != 2)
  {
    return false;
  }
  bool forward[2];
  for (int k = 0; k < 2; ++k)
  {
    forward[k] = model.TrimCurves[uses[k].Curve].Reversed == model.Faces[uses[k].Face].Reversed;
  }
  if (forward[0] == forward[1])
  {
    return false;
  }
  const Interval domain = EdgeDomain(model, edge, uses);
  double sign = 0.0;
  for (int k = 0; k < 2 * FacingSamples; ++k)
  {
    const double t = domain.Min + (k / 2 + 0.5) / FacingSamples * domain.Length();
    const double cosine = CosineOfUse(model, uses[k % 2], domain, viewer, t);
    if (std::abs(cosine) < FacingCosine || cosine * sign < 0.0)
    {
      return false;
    }
    sign = cosine;
  }
  return true;
}

} // namespace nurbs
