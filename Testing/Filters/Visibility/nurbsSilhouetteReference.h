// SPDX-License-Identifier: BSD-3-Clause
// What is asked of silhouettes, by nurbs::Normal and dense grids, and shapes to ask it of.
#ifndef nurbsSilhouetteReference_h
#define nurbsSilhouetteReference_h

#include "ModelBuilder.h"
#include "Silhouette.h"

#include <cmath>
#include <random>

namespace reference
{

using nurbs::FaceSilhouette;
using nurbs::LineKind;
using nurbs::Model;
using nurbs::SilhouetteLine;
using nurbs::Silhouettes;
using nurbs::SurfaceView;
using nurbs::Vec2;
using nurbs::Vec3;
using nurbs::Viewer;

inline Viewer Direction(double x, double y, double z)
{
  return { false, Vec3(x, y, z).normalized() };
}

inline Viewer Eye(double x, double y, double z)
{
  return { true, Vec3(x, y, z) };
}

/// Unit normal times the unit vector to the viewer, of the surface's own S_u x S_v.
inline double Cosine(const SurfaceView& surface, const Viewer& viewer, const Vec2& uv)
{
  const Vec3 point = nurbs::Evaluate(surface, uv[0], uv[1]);
  return nurbs::Normal(surface, uv[0], uv[1]).dot(viewer.Toward(point).normalized());
}

/// The same; at a knot, where the normal may jump, that of the side where it is nearest to 0.
inline double SidedCosine(const SurfaceView& surface, const Viewer& viewer, const Vec2& uv)
{
  double least = 2.0;
  for (int k = 0; k < 4; ++k)
  {
    Vec2 p = uv;
    p[0] = k & 1 ? std::nextafter(p[0], -1e300) : p[0];
    p[1] = k & 2 ? std::nextafter(p[1], -1e300) : p[1];
    const double cosine = std::abs(Cosine(surface, viewer, p));
    least = std::min(least, cosine);
  }
  return least;
}

inline double Length(const SilhouetteLine& line)
{
  double length = 0.0;
  for (std::size_t k = 1; k < line.Points.size(); ++k)
  {
    length += (line.Points[k].Point - line.Points[k - 1].Point).norm();
  }
  return line.Closed ? length + (line.Points.front().Point - line.Points.back().Point).norm()
                     : length;
}

/// Points of the lines of one kind, and what they are like.
struct Measure
{
  std::size_t Points = 0;
  double Length = 0.0;
  double Cosine = 0.0; ///< Largest |normal . view| that is no crease's.
  int Over = 0;        ///< Points where it is over 1e-9.
  double Offset = 0.0; ///< Largest distance from the surface at UV.
  double Chord = 0.0;  ///< Largest distance of the exact contour, between points, from the chord.
  int WrongSide = 0;   ///< Chords whose front is not on the left.
};

/// The point of the contour across the middle of a chord: by bisection along the normal of the chord
/// in the domain. False: normal . view does not change its sign there.
inline bool ExactMiddle(const SurfaceView& surface, const Viewer& viewer, const Vec2& a,
  const Vec2& b, Vec3& point, bool& frontOnLeft)
{
  const Vec2 middle = 0.5 * (a + b);
  const Vec2 size(surface.Domain(0).Length(), surface.Domain(1).Length());
  const Vec2 chord = (b - a).cwiseQuotient(size);
  const double reach = std::min(0.25, 0.01 / chord.norm());
  const Vec2 aside = reach * Vec2(-chord[1], chord[0]).cwiseProduct(size);
  const auto at = [&](double t) {
    const Vec2 p = middle + t * aside;
    return Vec2(surface.Domain(0).Clamp(p[0]), surface.Domain(1).Clamp(p[1]));
  };
  double low = -1.0, high = 1.0;
  const double fLow = Cosine(surface, viewer, at(low));
  const double fHigh = Cosine(surface, viewer, at(high));
  frontOnLeft = fHigh > fLow;
  if (fLow * fHigh >= 0.0 || std::min(std::abs(fLow), std::abs(fHigh)) < 1e-9)
  {
    return false;
  }
  for (int k = 0; k < 60; ++k)
  {
    const double t = 0.5 * (low + high);
    (Cosine(surface, viewer, at(t)) * fLow > 0.0 ? low : high) = t;
  }
  point = nurbs::Evaluate(surface, at(low)[0], at(low)[1]);
  return true;
}

inline Measure MeasureLines(const Model& model, const Silhouettes& result, const Viewer& viewer)
{
  Measure out;
  for (const SilhouetteLine& line : result.Lines)
  {
    if (line.Kind != LineKind::Silhouette)
    {
      continue;
    }
    const SurfaceView& surface = model.Faces[line.Face].Geometry;
    out.Points += line.Points.size();
    out.Length += Length(line);
    for (std::size_t k = 0; k < line.Points.size(); ++k)
    {
      const nurbs::ContourPoint& p = line.Points[k];
      out.Offset =
        std::max(out.Offset, (nurbs::Evaluate(surface, p.UV[0], p.UV[1]) - p.Point).norm());
      if (line.Crease)
      {
        continue;
      }
      const double cosine = SidedCosine(surface, viewer, p.UV);
      out.Cosine = std::max(out.Cosine, cosine);
      out.Over += cosine > 1e-9;
      if (k + 1 == line.Points.size() && !line.Closed)
      {
        continue;
      }
      const nurbs::ContourPoint& q = line.Points[(k + 1) % line.Points.size()];
      Vec3 exact;
      bool front = true;
      // Chords so short that the sign is not known on both sides of them are left out.
      if ((p.Point - q.Point).norm() > 1e-6 &&
        ExactMiddle(surface, viewer, p.UV, q.UV, exact, front))
      {
        out.Chord = std::max(out.Chord, nurbs::DistanceToSegment(exact, p.Point, q.Point));
        out.WrongSide += !front;
      }
    }
  }
  return out;
}

/// Distance of a point from the silhouettes of a face.
inline double DistanceToLines(const Silhouettes& result, std::int64_t face, const Vec3& point)
{
  double nearest = 1e300;
  for (const SilhouetteLine& line : result.Lines)
  {
    for (std::size_t k = 0; line.Kind == LineKind::Silhouette && line.Face == face &&
         k + (line.Closed ? 0 : 1) < line.Points.size();
         ++k)
    {
      nearest = std::min(nearest,
        nurbs::DistanceToSegment(
          point, line.Points[k].Point, line.Points[(k + 1) % line.Points.size()].Point));
    }
  }
  return nearest;
}

/// The grid edges of n x n over a face's domain where normal . view changes its sign (beyond 1e-9),
/// and how many have no silhouette of the face within a cell (of the domain; in space: within
/// `precision` more than their length).
struct GridCheck
{
  int Changes = 0;
  int Missed = 0;
  int Regions = 0; ///< Connected sets of samples of one sign.
};

template <typename Inside>
GridCheck CheckGrid(const Model& model, std::int64_t face, const Silhouettes& result,
  const Viewer& viewer, double precision, int n, const Inside& inside)
{
#ifdef NURBS_SANITIZE
  n /= 2; // Sanitizers are slow, and look for other things.
#endif
  const SurfaceView& surface = model.Faces[face].Geometry;
  const nurbs::Interval u = surface.Domain(0);
  const nurbs::Interval v = surface.Domain(1);
  const auto at = [&](int i, int j) {
    return Vec2(u.Min + (i + 0.5) / n * u.Length(), v.Min + (j + 0.5) / n * v.Length());
  };
  std::vector<int> sign(n * n);
  for (int k = 0; k < n * n; ++k)
  {
    const Vec2 uv = at(k % n, k / n);
    const double c = inside(uv) ? Cosine(surface, viewer, uv) : 0.0;
    sign[k] = c > 1e-9 ? 1 : (c < -1e-9 ? -1 : 0);
  }
  // Cells around what the lines pass.
  std::vector<char> near(n * n, 0);
  const auto mark = [&](const Vec2& uv) {
    const int i = int((uv[0] - u.Min) / u.Length() * n);
    const int j = int((uv[1] - v.Min) / v.Length() * n);
    for (int y = std::max(0, j - 1); y <= std::min(n - 1, j + 1); ++y)
    {
      for (int x = std::max(0, i - 1); x <= std::min(n - 1, i + 1); ++x)
      {
        near[x + y * n] = 1;
      }
    }
  };
  for (const SilhouetteLine& line : result.Lines)
  {
    for (std::size_t k = 0; line.Kind == LineKind::Silhouette && line.Face == face &&
         k + (line.Closed ? 0 : 1) < line.Points.size();
         ++k)
    {
      const Vec2 a = line.Points[k].UV;
      const Vec2 b = line.Points[(k + 1) % line.Points.size()].UV;
      const int steps = 1 +
        int(
          4 * n * std::max(std::abs(b[0] - a[0]) / u.Length(), std::abs(b[1] - a[1]) / v.Length()));
      for (int s = 0; s <= steps; ++s)
      {
        mark(a + double(s) / steps * (b - a));
      }
    }
  }
  GridCheck out;
  std::vector<int> parent(n * n);
  for (int k = 0; k < n * n; ++k)
  {
    parent[k] = k;
  }
  const auto find = [&](int k) {
    while (parent[k] != k)
    {
      k = parent[k] = parent[parent[k]];
    }
    return k;
  };
  for (int k = 0; k < n * n; ++k)
  {
    for (const int step : { 1, n })
    {
      if ((step == 1 && k % n == n - 1) || k + step >= n * n || sign[k] == 0)
      {
        continue;
      }
      if (sign[k] == sign[k + step])
      {
        parent[std::max(find(k), find(k + step))] = std::min(find(k), find(k + step));
      }
      else if (sign[k] * sign[k + step] < 0)
      {
        ++out.Changes;
        if (!near[k] && !near[k + step])
        {
          const Vec2 a = at(k % n, k / n);
          const Vec2 b = at((k + step) % n, (k + step) / n);
          const Vec3 pa = nurbs::Evaluate(surface, a[0], a[1]);
          const Vec3 pb = nurbs::Evaluate(surface, b[0], b[1]);
          out.Missed +=
            DistanceToLines(result, face, 0.5 * (pa + pb)) > precision + (pa - pb).norm();
        }
      }
    }
  }
  for (int k = 0; k < n * n; ++k)
  {
    out.Regions += sign[k] != 0 && find(k) == k;
  }
  return out;
}

inline GridCheck CheckGrid(const Model& model, std::int64_t face, const Silhouettes& result,
  const Viewer& viewer, double precision, int n = 400)
{
  return CheckGrid(model, face, result, viewer, precision, n, [](const Vec2&) { return true; });
}

/// Ends of silhouettes that go on nowhere, and are farther than `reach` from borders and sharp edges.
inline int LooseEnds(const Silhouettes& result, double reach)
{
  int loose = 0;
  for (const SilhouetteLine& line : result.Lines)
  {
    for (int end = 0; line.Kind == LineKind::Silhouette && !line.Closed && end < 2; ++end)
    {
      const Vec3& point = (end == 0 ? line.Points.front() : line.Points.back()).Point;
      double nearest = line.Next[end] >= 0 ? 0.0 : 1e300;
      for (const SilhouetteLine& edge : result.Lines)
      {
        for (std::size_t k = 1;
             nearest > reach && edge.Kind != LineKind::Silhouette && k < edge.Points.size(); ++k)
        {
          nearest = std::min(nearest,
            nurbs::DistanceToSegment(point, edge.Points[k - 1].Point, edge.Points[k].Point));
        }
      }
      loose += nearest > reach;
    }
  }
  return loose;
}

/// A Bezier patch with control points z(i, j) over the unit square.
template <typename Point>
nurbs::Surface BezierSurface(int p, int q, const Point& point)
{
  nurbs::Surface s;
  s.Degree[0] = p;
  s.Degree[1] = q;
  for (int d = 0; d < 2; ++d)
  {
    s.Count[d] = s.Degree[d] + 1;
    s.Knots[d] = nurbs::UniformKnots(s.Degree[d], s.Count[d]);
  }
  for (int j = 0; j <= q; ++j)
  {
    for (int i = 0; i <= p; ++i)
    {
      s.Points.push_back(point(double(i) / p, double(j) / q));
    }
  }
  return s;
}

/// A model of one surface, which must live as long.
inline nurbs::Model OneFace(const nurbs::Surface& surface)
{
  nurbs::Model model;
  nurbs::Face face;
  face.Geometry = surface.View();
  face.FaceId = 0;
  model.Faces.push_back(face);
  return model;
}

inline Silhouettes Make(const Model& model, const Viewer& viewer, double precision)
{
  nurbs::SilhouetteOptions options;
  options.View = viewer;
  options.Precision = precision;
  return nurbs::MakeSilhouettes(model, std::vector<std::string>(model.Faces.size()), options);
}

} // namespace reference

#endif
