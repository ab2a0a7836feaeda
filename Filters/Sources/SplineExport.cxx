// SPDX-License-Identifier: BSD-3-Clause
#include "SplineExport.h"

#include "CADSession.h"
#include "CurveCopy.h"

#include <Standard_Failure.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_Array1OfPnt2d.hxx>
#include <TColgp_Array2OfPnt.hxx>

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr double SamePoint = 1e-12; // of the net's size, of control points on both sides of a break

/// Distinct knots with multiplicities, and the control points that stay.
struct Knots
{
  std::vector<double> Values;
  std::vector<int> Multiplicities;
  std::vector<int> Points;

  TColStd_Array1OfReal ValueArray() const
  {
    return TColStd_Array1OfReal(
      this->Values.front(), 1, static_cast<Standard_Integer>(this->Values.size()));
  }
  TColStd_Array1OfInteger MultiplicityArray() const
  {
    return TColStd_Array1OfInteger(
      this->Multiplicities.front(), 1, static_cast<Standard_Integer>(this->Multiplicities.size()));
  }
};

/// At a break, a knot of multiplicity degree + 1, the spline ends at one control point and goes on at
/// the next. Where both are the same one of them can go, with one of the knots.
template <typename Same>
Knots Collect(const std::vector<double>& flat, int degree, const Same& same)
{
  Knots knots;
  int removed = 0;
  const int count = static_cast<int>(flat.size()) - degree - 1;
  for (int i = 0; i < count; ++i)
  {
    knots.Points.push_back(i);
  }
  for (std::size_t i = 0; i < flat.size();)
  {
    std::size_t end = i;
    while (end < flat.size() && flat[end] == flat[i])
    {
      ++end;
    }
    int multiplicity = static_cast<int>(end - i);
    const bool inside = i > 0 && end < flat.size();
    if (inside && multiplicity == degree + 1)
    {
      const int before = static_cast<int>(i) - 1;
      if (!same(before, before + 1))
      {
        throw Error("it is broken at the knot " + std::to_string(flat[i]));
      }
      knots.Points.erase(knots.Points.begin() + before - removed);
      ++removed;
      --multiplicity;
    }
    knots.Values.push_back(flat[i]);
    knots.Multiplicities.push_back(multiplicity);
    i = end;
  }
  return knots;
}

template <int D>
Curve<D> Clamped(const CurveView<D>& view)
{
  const Interval domain = view.Domain();
  if (!IsClamped(view.Knots, view.Degree))
  {
    return Restrict(view, domain.Min, domain.Max);
  }
  return Copy(view);
}

template <int D>
Knots KnotsOf(const Curve<D>& curve)
{
  Eigen::AlignedBox<double, D> box;
  for (const Vec<D>& p : curve.Points)
  {
    box.extend(p);
  }
  const double near = SamePoint * box.diagonal().norm();
  return Collect(curve.Knots, curve.Degree, [&](int a, int b) {
    return (curve.Points[a] - curve.Points[b]).norm() <= near &&
      std::abs(curve.Weights[a] - curve.Weights[b]) <= SamePoint * curve.Weights[a];
  });
}

Knots KnotsOf(const Surface& surface, int dir)
{
  Box3 box;
  for (const Vec3& p : surface.Points)
  {
    box.extend(p);
  }
  const double near = SamePoint * box.diagonal().norm();
  const auto index = [&](int along, int across) {
    const int i = dir == 0 ? along : across;
    const int j = dir == 0 ? across : along;
    return i + static_cast<std::size_t>(j) * surface.Count[0];
  };
  return Collect(surface.Knots[dir], surface.Degree[dir], [&](int a, int b) {
    for (int k = 0; k < surface.Count[1 - dir]; ++k)
    {
      const std::size_t p = index(a, k), q = index(b, k);
      if ((surface.Points[p] - surface.Points[q]).norm() > near ||
        (!surface.Weights.empty() &&
          std::abs(surface.Weights[p] - surface.Weights[q]) > SamePoint * surface.Weights[p]))
      {
        return false;
      }
    }
    return true;
  });
}

[[noreturn]] void Rethrow(const Standard_Failure& failure)
{
  throw Error("OpenCASCADE has no such spline: " + ReasonOf(failure));
}

} // namespace

Handle(Geom_BSplineSurface) ExportSurface(const SurfaceView& view, double scale)
{
  const bool clamped =
    IsClamped(view.Knots[0], view.Degree[0]) && IsClamped(view.Knots[1], view.Degree[1]);
  const Surface surface = clamped ? Copy(view) : Restrict(view, view.Domain(0), view.Domain(1));
  const Knots u = KnotsOf(surface, 0), v = KnotsOf(surface, 1);
  const int rows = static_cast<int>(u.Points.size()), columns = static_cast<int>(v.Points.size());
  TColgp_Array2OfPnt points(1, rows, 1, columns);
  TColStd_Array2OfReal weights(1, rows, 1, columns);
  for (int j = 0; j < columns; ++j)
  {
    for (int i = 0; i < rows; ++i)
    {
      const std::size_t id = u.Points[i] + static_cast<std::size_t>(v.Points[j]) * surface.Count[0];
      const Vec3 p = scale * surface.Points[id];
      points(i + 1, j + 1).SetCoord(p[0], p[1], p[2]);
      weights(i + 1, j + 1) = surface.Weights.empty() ? 1.0 : surface.Weights[id];
    }
  }
  try
  {
    return new Geom_BSplineSurface(points, weights, u.ValueArray(), v.ValueArray(),
      u.MultiplicityArray(), v.MultiplicityArray(), surface.Degree[0], surface.Degree[1]);
  }
  catch (const Standard_Failure& failure)
  {
    Rethrow(failure);
  }
}

Handle(Geom_BSplineCurve) ExportCurve(const CurveView<3>& view, double scale)
{
  const Curve<3> curve = Clamped(view);
  const Knots knots = KnotsOf(curve);
  const int count = static_cast<int>(knots.Points.size());
  TColgp_Array1OfPnt points(1, count);
  TColStd_Array1OfReal weights(1, count);
  for (int i = 0; i < count; ++i)
  {
    const Vec3 p = scale * curve.Points[knots.Points[i]];
    points(i + 1).SetCoord(p[0], p[1], p[2]);
    weights(i + 1) = curve.Weights[knots.Points[i]];
  }
  try
  {
    return new Geom_BSplineCurve(
      points, weights, knots.ValueArray(), knots.MultiplicityArray(), curve.Degree);
  }
  catch (const Standard_Failure& failure)
  {
    Rethrow(failure);
  }
}

Handle(Geom2d_BSplineCurve) ExportCurve(const CurveView<2>& view, const Interval& range)
{
  const Curve<2> curve = Clamped(view);
  Knots knots = KnotsOf(curve);
  const double first = knots.Values.front(), last = knots.Values.back();
  if (first != range.Min || last != range.Max)
  {
    for (double& knot : knots.Values)
    {
      knot = range.Min + (knot - first) / (last - first) * range.Length();
    }
    knots.Values.back() = range.Max;
  }
  const int count = static_cast<int>(knots.Points.size());
  TColgp_Array1OfPnt2d points(1, count);
  TColStd_Array1OfReal weights(1, count);
  for (int i = 0; i < count; ++i)
  {
    const Vec2& p = curve.Points[knots.Points[i]];
    points(i + 1).SetCoord(p[0], p[1]);
    weights(i + 1) = curve.Weights[knots.Points[i]];
  }
  try
  {
    return new Geom2d_BSplineCurve(
      points, weights, knots.ValueArray(), knots.MultiplicityArray(), curve.Degree);
  }
  catch (const Standard_Failure& failure)
  {
    Rethrow(failure);
  }
}

} // namespace nurbs
