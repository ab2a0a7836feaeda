// SPDX-License-Identifier: BSD-3-Clause
#include "FeatureEdges.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr int AngleSamples = 9;
constexpr int StraightSamples = 15;
constexpr int FirstParts = 4; // Of a Bezier piece of a trim curve that is not straight.
constexpr int MaxChordDepth = 30;
// Surfaces are planar whose control points are as near to a plane, as a share of their size.
constexpr double FlatShare = 1e-10;
// Of control points of a bilinear patch, that make it a parallelogram.
constexpr double AffineShare = 1e-13;

// True if the surface is an affine image of its domain: lines stay straight.
bool IsAffine(const SurfaceView& surface)
{
  if (surface.Size() != 4 || surface.Degree[0] != 1 || surface.Degree[1] != 1)
  {
    return false;
  }
  for (int k = 1; k < 4; ++k)
  {
    if (surface.Weight(k) != surface.Weight(0))
    {
      return false;
    }
  }
  const Vec3 diagonal = surface.Point(3) - surface.Point(0);
  const Vec3 skew = surface.Point(1) + surface.Point(2) - surface.Point(0) - surface.Point(3);
  return skew.norm() <= AffineShare * diagonal.norm();
}

// A point of an edge, and where it is in a Bezier piece of the trim curve.
struct EdgePoint : ContourPoint
{
  double Share = 0.0;
};

ContourPoint Lift(const SurfaceView& surface, const Vec2& uv)
{
  ContourPoint out;
  out.UV = Vec2(surface.Domain(0).Clamp(uv[0]), surface.Domain(1).Clamp(uv[1]));
  out.Point = Evaluate(surface, out.UV[0], out.UV[1]);
  return out;
}

// Outer normal of a use's face where the edge's parameter is t.
Vec3 NormalAt(const Model& model, const EdgeUse& use, const Interval& domain, double t)
{
  const Face& face = model.Faces[use.Face];
  const TrimCurve& curve = model.TrimCurves[use.Curve];
  const Vec2 uv = Evaluate(curve.Geometry, TrimParameter(curve, domain, t));
  const Vec3 n = Normal(
    face.Geometry, face.Geometry.Domain(0).Clamp(uv[0]), face.Geometry.Domain(1).Clamp(uv[1]));
  return face.Reversed ? Vec3(-n) : n;
}

} // namespace

bool IsPlanar(const SurfaceView& surface)
{
  const std::int64_t count = surface.Size();
  if (count == 0)
  {
    return false;
  }
  const Vec3 origin = surface.Point(0);
  Vec3 along = Vec3::Zero();
  for (std::int64_t k = 1; k < count; ++k)
  {
    const Vec3 way = surface.Point(k) - origin;
    along = way.squaredNorm() > along.squaredNorm() ? way : along;
  }
  Vec3 normal = Vec3::Zero();
  for (std::int64_t k = 1; k < count; ++k)
  {
    const Vec3 cross = along.cross(surface.Point(k) - origin);
    normal = cross.squaredNorm() > normal.squaredNorm() ? cross : normal;
  }
  const double most = FlatShare * along.norm() * normal.norm();
  for (std::int64_t k = 1; k < count && most > 0.0; ++k)
  {
    if (std::abs(normal.dot(surface.Point(k) - origin)) > most)
    {
      return false;
    }
  }
  return most > 0.0;
}

std::vector<std::vector<EdgeUse>> UsesOfEdges(
  const Model& model, const std::vector<std::string>& faceErrors)
{
  std::vector<std::vector<EdgeUse>> uses(model.Edges.size());
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    const Face& face = model.Faces[f];
    for (std::int64_t l = 0; l < face.LoopCount && faceErrors[f].empty(); ++l)
    {
      const TrimLoop& loop = model.Loops[face.FirstLoop + l];
      for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
      {
        uses[model.TrimCurves[c].Edge].push_back({ std::int64_t(f), c });
      }
    }
  }
  return uses;
}

LineKind KindOfEdge(
  const Model& model, std::int64_t edge, const std::vector<EdgeUse>& uses, double featureAngle)
{
  if (uses.size() != 2)
  {
    return uses.size() < 2 ? LineKind::Boundary : LineKind::Sharp;
  }
  // Faces that agree on the outside run through their edge in opposite directions.
  bool forward[2];
  for (int k = 0; k < 2; ++k)
  {
    forward[k] = model.TrimCurves[uses[k].Curve].Reversed == model.Faces[uses[k].Face].Reversed;
  }
  const double flip = forward[0] == forward[1] ? -1.0 : 1.0;
  const Interval domain = EdgeDomain(model, edge, uses);
  const bool isConstant = std::all_of(uses.begin(), uses.end(),
    [&](const EdgeUse& use) { return IsAffine(model.Faces[use.Face].Geometry); });
  const int samples = isConstant ? 1 : AngleSamples;
  for (int k = 0; k < samples; ++k)
  {
    const double t = domain.Min + (k + 0.5) / samples * domain.Length();
    const Vec3 a = NormalAt(model, uses[0], domain, t);
    const Vec3 b = flip * NormalAt(model, uses[1], domain, t);
    if (std::atan2(a.cross(b).norm(), a.dot(b)) > featureAngle)
    {
      return LineKind::Sharp;
    }
  }
  return LineKind::Smooth;
}

std::vector<ContourPoint> LiftEdge(const Model& model, const EdgeUse& use, const Interval& range,
  double precision, std::vector<double>* parameters)
{
  const SurfaceView& surface = model.Faces[use.Face].Geometry;
  const bool isAffine = IsAffine(surface);
  std::vector<ContourPoint> out;
  std::vector<double> at;
  for (const BezierCurve<2>& piece : ToBezier(model.TrimCurves[use.Curve].Geometry))
  {
    const double low = (range.Clamp(piece.T0) - piece.T0) / (piece.T1 - piece.T0);
    const double high = (range.Clamp(piece.T1) - piece.T0) / (piece.T1 - piece.T0);
    if (!(low < high))
    {
      continue;
    }
    const auto point = [&](double t) {
      EdgePoint p;
      p.Share = t < 1.0 ? low + t * (high - low) : high;
      static_cast<ContourPoint&>(p) = Lift(surface, piece.Evaluate(p.Share));
      return p;
    };
    const auto add = [&](const EdgePoint& p) {
      out.push_back(p);
      at.push_back(piece.T0 + p.Share * (piece.T1 - piece.T0));
    };
    EdgePoint a = point(0.0);
    const EdgePoint end = point(1.0);
    if (out.empty())
    {
      add(a);
    }
    const bool isLine = isAffine && piece.Degree() == 1;
    bool straight = true;
    for (int k = 1; k <= StraightSamples && straight && !isLine; ++k)
    {
      straight = DistanceToSegment(point(double(k) / (StraightSamples + 1)).Point, a.Point,
                   end.Point) <= 0.9 * precision;
    }
    const int parts = straight ? 1 : FirstParts;
    std::vector<EdgePoint> inner;
    for (int k = 1; k <= parts; ++k)
    {
      const EdgePoint b = k == parts ? end : point(double(k) / parts);
      inner.clear();
      if (!straight)
      {
        RefineChord(
          point, precision, double(k - 1) / parts, a, double(k) / parts, b, MaxChordDepth, inner);
      }
      std::for_each(inner.begin(), inner.end(), add);
      add(b);
      a = b;
    }
  }
  if (parameters)
  {
    *parameters = std::move(at);
  }
  return out;
}

} // namespace nurbs
