// SPDX-License-Identifier: BSD-3-Clause
// The operations of Surface.h that rebuild the control net: see RowSpline.h for the algorithms.
#include "RowSpline.h"
#include "Surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nurbs
{

namespace
{

/// The surface seen along `dir`: row i holds the i-th line of the net across it, 4 homogeneous
/// numbers a point, or 3 Cartesian ones if there are no weights.
RowSpline ToRows(const SurfaceView& surface, int dir)
{
  const int size = surface.Weights ? 4 : 3;
  const int lines = surface.Count[dir];
  const int across = surface.Count[1 - dir];
  RowSpline spline;
  spline.Degree = surface.Degree[dir];
  spline.Width = size * across;
  spline.Knots.assign(surface.Knots[dir].begin(), surface.Knots[dir].end());
  spline.Rows.resize(std::size_t(lines) * spline.Width);
  const std::int64_t step = dir == 0 ? 1 : surface.Count[0];
  const std::int64_t stepAcross = dir == 0 ? surface.Count[0] : 1;
  double* to = spline.Rows.data();
  for (int i = 0; i < lines; ++i)
  {
    for (int j = 0; j < across; ++j, to += size)
    {
      const Vec4 h = surface.Homogeneous(i * step + j * stepAcross);
      std::copy(h.data(), h.data() + size, to);
    }
  }
  return spline;
}

/// The surface whose direction `dir` is `spline`; the other direction is that of `like`.
Surface FromRows(const SurfaceView& like, int dir, RowSpline spline)
{
  const int size = like.Weights ? 4 : 3;
  Surface surface;
  surface.Degree[dir] = spline.Degree;
  surface.Degree[1 - dir] = like.Degree[1 - dir];
  surface.Count[dir] = static_cast<int>(spline.Count());
  surface.Count[1 - dir] = like.Count[1 - dir];
  surface.Knots[1 - dir].assign(like.Knots[1 - dir].begin(), like.Knots[1 - dir].end());
  const std::int64_t total = std::int64_t(surface.Count[0]) * surface.Count[1];
  surface.Points.resize(total);
  surface.Weights.resize(like.Weights ? total : 0);
  const std::int64_t step = dir == 0 ? 1 : surface.Count[0];
  const std::int64_t stepAcross = dir == 0 ? surface.Count[0] : 1;
  const double* from = spline.Rows.data();
  for (int i = 0; i < surface.Count[dir]; ++i)
  {
    for (int j = 0; j < surface.Count[1 - dir]; ++j, from += size)
    {
      const std::int64_t k = i * step + j * stepAcross;
      surface.Points[k] = Eigen::Map<const Vec3>(from);
      if (like.Weights)
      {
        surface.Points[k] /= from[3];
        surface.Weights[k] = from[3];
      }
    }
  }
  surface.Knots[dir] = std::move(spline.Knots);
  return surface;
}

/// How far the surface can have moved: a bound in model units from the change of the homogeneous
/// control points. With C = A / w and C' = A' / w', C - C' = ((A - A') - C (w - w')) / w', and
/// coordinates relative to the net's centre keep |C| small.
double MovementBound(
  const SurfaceView& surface, const RowSpline& reduced, const std::vector<double>& residual)
{
  const int size = surface.Weights ? 4 : 3;
  Box3 box;
  for (std::int64_t k = 0; k < surface.Size(); ++k)
  {
    box.extend(surface.Point(k));
  }
  const Vec3 centre = box.center();
  const double radius = 0.5 * box.diagonal().norm();
  double minWeight = 1.0;
  if (size == 4)
  {
    minWeight = std::numeric_limits<double>::infinity();
    for (std::size_t k = 3; k < reduced.Rows.size(); k += 4)
    {
      minWeight = std::min(minWeight, reduced.Rows[k]);
    }
  }
  if (!(minWeight > 0.0))
  {
    return std::numeric_limits<double>::infinity();
  }
  double largest = 0.0;
  for (std::size_t k = 0; k < residual.size(); k += size)
  {
    const double dw = size == 4 ? residual[k + 3] : 0.0;
    const Vec3 da = Eigen::Map<const Vec3>(residual.data() + k) - centre * dw;
    largest = std::max(largest, (da.norm() + radius * std::abs(dw)) / minWeight);
  }
  return largest;
}

} // namespace

Surface RefineKnots(const SurfaceView& surface, int dir, const std::vector<double>& add)
{
  RowSpline spline = ToRows(surface, dir);
  InsertKnots(spline, add);
  return FromRows(surface, dir, std::move(spline));
}

Surface ElevateDegree(const SurfaceView& surface, int dir, int times)
{
  RowSpline spline = ToRows(surface, dir);
  for (int i = 0; i < times; ++i)
  {
    ElevateRows(spline);
  }
  return FromRows(surface, dir, std::move(spline));
}

Surface ReduceDegree(const SurfaceView& surface, int dir, double tolerance)
{
  RowSpline best = ToRows(surface, dir);
  bool changed = false;
  double total = 0.0;
  RowSpline reduced;
  std::vector<double> residual;
  while (ReduceRowDegree(best, reduced, residual))
  {
    total += MovementBound(surface, reduced, residual);
    if (!(total <= tolerance))
    {
      break;
    }
    best = reduced;
    changed = true;
  }
  return changed ? FromRows(surface, dir, std::move(best)) : Copy(surface);
}

std::pair<Surface, Surface> Split(const SurfaceView& surface, int dir, double t)
{
  const RowSpline spline = ToRows(surface, dir);
  const Interval domain = surface.Domain(dir);
  return { FromRows(surface, dir, ClampRows(spline, domain.Min, t)),
    FromRows(surface, dir, ClampRows(spline, t, domain.Max)) };
}

Surface Restrict(const SurfaceView& surface, Interval u, Interval v)
{
  const Surface part = FromRows(surface, 0, ClampRows(ToRows(surface, 0), u.Min, u.Max));
  const SurfaceView view = part.View();
  return FromRows(view, 1, ClampRows(ToRows(view, 1), v.Min, v.Max));
}

namespace
{

/// The surface along v, its lines across already in the Bezier form of u: all spans' coefficients
/// one after the other.
RowSpline AcrossBezierForm(const SurfaceView& surface, const BezierForm& u)
{
  const int p = surface.Degree[0];
  const int size = surface.Weights ? 4 : 3;
  RowSpline spline;
  spline.Degree = surface.Degree[1];
  spline.Width = static_cast<int>(u.First.size()) * (p + 1) * size;
  spline.Knots.assign(surface.Knots[1].begin(), surface.Knots[1].end());
  spline.Rows.resize(std::size_t(surface.Count[1]) * spline.Width);
  double* to = spline.Rows.data();
  for (int j = 0; j < surface.Count[1]; ++j)
  {
    for (std::int64_t first : u.First)
    {
      for (int i = 0; i <= p; ++i, to += size)
      {
        const double* from = u.Refined.Row(first + i) + j * size;
        std::copy(from, from + size, to);
      }
    }
  }
  return spline;
}

} // namespace

std::vector<BezierPatch> ToBezier(const SurfaceView& surface)
{
  const int p = surface.Degree[0];
  const int q = surface.Degree[1];
  const int size = surface.Weights ? 4 : 3;
  const BezierForm u = ToBezierForm(ToRows(surface, 0));
  const BezierForm v = ToBezierForm(AcrossBezierForm(surface, u));
  std::vector<BezierPatch> patches(u.First.size() * v.First.size());
  for (std::size_t b = 0; b < v.First.size(); ++b)
  {
    for (std::size_t a = 0; a < u.First.size(); ++a)
    {
      BezierPatch& patch = patches[a + b * u.First.size()];
      patch.Degree[0] = p;
      patch.Degree[1] = q;
      patch.U = { u.Breaks[a], u.Breaks[a + 1] };
      patch.V = { v.Breaks[b], v.Breaks[b + 1] };
      patch.Points.resize((p + 1) * (q + 1), Vec4(0.0, 0.0, 0.0, 1.0));
      for (int j = 0; j <= q; ++j)
      {
        const double* from = v.Refined.Row(v.First[b] + j) + a * (p + 1) * size;
        for (int i = 0; i <= p; ++i, from += size)
        {
          std::copy(from, from + size, patch.Points[i + j * (p + 1)].data());
        }
      }
    }
  }
  return patches;
}

} // namespace nurbs
