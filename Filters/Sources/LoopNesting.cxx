// SPDX-License-Identifier: BSD-3-Clause
#include "LoopNesting.h"

#include <cmath>

namespace nurbs
{

namespace
{

using Polygon = std::vector<Vec2>;

void AppendPoints(const TrimCurve& trim, Polygon& polygon)
{
  constexpr int InSpan = 16;
  const CurveView<2>& curve = trim.Geometry;
  const std::vector<Knot> knots = DistinctKnots(curve.Knots, curve.Degree);
  const int steps = curve.Degree == 1 ? 1 : InSpan;
  Polygon points;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i)
  {
    const double length = knots[i + 1].Value - knots[i].Value;
    for (int k = 0; k < steps; ++k)
    {
      points.push_back(Evaluate(curve, knots[i].Value + length * k / steps));
    }
  }
  points.push_back(Evaluate(curve, knots.back().Value));
  if (trim.Reversed)
  {
    polygon.insert(polygon.end(), points.rbegin(), points.rend());
  }
  else
  {
    polygon.insert(polygon.end(), points.begin(), points.end());
  }
}

Polygon PolygonOf(const Model& model, const TrimLoop& loop)
{
  Polygon polygon;
  for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
  {
    AppendPoints(model.TrimCurves[c], polygon);
  }
  return polygon;
}

double SignedArea(const Polygon& polygon)
{
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    // From the first point, so that areas far from the origin keep their digits.
    const Vec2 a = polygon[i] - polygon[0];
    const Vec2 b = polygon[(i + 1) % polygon.size()] - polygon[0];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return 0.5 * twice;
}

bool Contains(const Polygon& polygon, const Vec2& p)
{
  bool inside = false;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Vec2& a = polygon[i];
    const Vec2& b = polygon[(i + 1) % polygon.size()];
    if ((a[1] > p[1]) != (b[1] > p[1]) &&
      p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
    {
      inside = !inside;
    }
  }
  return inside;
}

/// Of several points the most decide: loops may touch.
bool Contains(const Polygon& outer, const Polygon& inner)
{
  constexpr std::size_t Samples = 7;
  std::size_t inside = 0;
  for (std::size_t k = 0; k < Samples; ++k)
  {
    const std::size_t i = k * inner.size() / Samples;
    const Vec2 middle = 0.5 * (inner[i] + inner[(i + 1) % inner.size()]);
    inside += Contains(outer, middle) ? 1 : 0;
  }
  return 2 * inside > Samples;
}

} // namespace

std::vector<std::vector<std::int64_t>> GroupLoops(const Model& model, const Face& face)
{
  std::vector<std::vector<std::int64_t>> groups(1);
  if (face.LoopCount < 2)
  {
    for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
    {
      groups[0].push_back(l);
    }
    return groups;
  }
  groups.clear();
  std::vector<Polygon> polygons;
  std::vector<double> areas;
  std::vector<std::size_t> outer; // The outer loop of each group.
  for (std::int64_t k = 0; k < face.LoopCount; ++k)
  {
    polygons.push_back(PolygonOf(model, model.Loops[face.FirstLoop + k]));
    areas.push_back(polygons.back().empty() ? 0.0 : SignedArea(polygons.back()));
    if (areas.back() > 0.0)
    {
      outer.push_back(static_cast<std::size_t>(k));
      groups.push_back({ face.FirstLoop + k });
    }
  }
  if (groups.empty())
  {
    groups.resize(1);
  }
  for (std::size_t k = 0; k < polygons.size(); ++k)
  {
    if (areas[k] > 0.0 || polygons[k].empty())
    {
      continue;
    }
    std::size_t best = outer.size();
    for (std::size_t g = 0; g < outer.size(); ++g)
    {
      if ((best == outer.size() || areas[outer[g]] < areas[outer[best]]) &&
        Contains(polygons[outer[g]], polygons[k]))
      {
        best = g;
      }
    }
    groups[best == outer.size() ? 0 : best].push_back(
      face.FirstLoop + static_cast<std::int64_t>(k));
  }
  return groups;
}

} // namespace nurbs
