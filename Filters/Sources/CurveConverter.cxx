// SPDX-License-Identifier: BSD-3-Clause
#include "CurveConverter.h"

#include "CurveFit.h"
#include "SplineData.h"

#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_BezierCurve.hxx>
#include <Geom2d_OffsetCurve.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_Circle.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Hyperbola.hxx>
#include <Geom_Line.hxx>
#include <Geom_OffsetCurve.hxx>
#include <Geom_Parabola.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Precision.hxx>

namespace nurbs
{

namespace
{

Vec3 ToVec(const gp_Pnt& p)
{
  return Vec3(p.X(), p.Y(), p.Z());
}

Vec3 ToVec(const gp_Dir& d)
{
  return Vec3(d.X(), d.Y(), d.Z());
}

Vec2 ToVec(const gp_Pnt2d& p)
{
  return Vec2(p.X(), p.Y());
}

/// The curve over [t0, t1].
template <int D>
Curve<D> Part(Curve<D> curve, double t0, double t1)
{
  curve.Pack();
  const Interval domain = curve.View().Domain();
  const double slack = 1e-12 * std::max(std::abs(domain.Min), std::abs(domain.Max));
  if (std::abs(t0 - domain.Min) <= slack && std::abs(t1 - domain.Max) <= slack &&
    IsClamped(curve.Knots, curve.Degree))
  {
    return curve;
  }
  if (t0 < domain.Min || t1 > domain.Max)
  {
    t0 = std::max(t0, domain.Min);
    t1 = std::min(t1, domain.Max);
    if (!(t0 < t1))
    {
      throw Error("the parameter range is outside the spline's domain");
    }
  }
  Curve<D> part = Restrict(curve.View(), t0, t1);
  part.Pack();
  return part;
}

/// A spline of either dimension. The classes of both have the same methods.
template <int D, typename Spline>
Curve<D> FromSpline(const Handle(Spline) & spline, double t0, double t1)
{
  const int degree = spline->Degree();
  const FlatKnots flat = spline->IsPeriodic()
    ? Unroll(spline->Knots(), spline->Multiplicities(), degree, t0, t1)
    : Flatten(spline->Knots(), spline->Multiplicities(), spline->NbPoles());
  Curve<D> curve;
  curve.Degree = degree;
  curve.Knots = flat.Knots;
  for (const int pole : flat.Poles)
  {
    curve.Points.push_back(ToVec(spline->Pole(pole + 1)));
    curve.Weights.push_back(spline->Weight(pole + 1));
  }
  return Part(std::move(curve), t0, t1);
}

template <int D, typename Bezier>
Curve<D> FromBezier(const Handle(Bezier) & bezier, double t0, double t1)
{
  Curve<D> curve;
  curve.Degree = bezier->Degree();
  curve.Knots.assign(curve.Degree + 1, 0.0);
  curve.Knots.insert(curve.Knots.end(), curve.Degree + 1, 1.0);
  for (int i = 1; i <= bezier->NbPoles(); ++i)
  {
    curve.Points.push_back(ToVec(bezier->Pole(i)));
    curve.Weights.push_back(bezier->Weight(i));
  }
  return Part(std::move(curve), t0, t1);
}

/// Conic with a centre: o + x X + y Y for the unit arc's (x, y).
Curve<3> FromArc(
  const Vec3& o, const Vec3& x, const Vec3& y, const ParameterMap& map, double t0, double t1)
{
  const UnitArc arc = MakeUnitArc(map, t0, t1);
  Curve<3> curve;
  curve.Degree = 2;
  curve.Knots = arc.Knots;
  for (const Vec3& h : arc.Points)
  {
    curve.Points.push_back(o + (h[0] / h[2]) * x + (h[1] / h[2]) * y);
    curve.Weights.push_back(h[2]);
  }
  curve.Pack();
  return curve;
}

/// Polynomial Bezier points of degree 1 or 2 over [t0, t1], by evaluation.
Curve<3> FromPolynomial(const Handle(Geom_Curve) & curve, int degree, double t0, double t1)
{
  Curve<3> result;
  result.Degree = degree;
  result.Knots.assign(degree + 1, t0);
  result.Knots.insert(result.Knots.end(), degree + 1, t1);
  const Vec3 a = ToVec(curve->Value(t0));
  const Vec3 b = ToVec(curve->Value(t1));
  result.Points = { a, b };
  if (degree == 2)
  {
    const Vec3 m = ToVec(curve->Value(0.5 * (t0 + t1)));
    result.Points = { a, Vec3(2.0 * m - 0.5 * (a + b)), b };
  }
  result.Weights.assign(degree + 1, 1.0);
  result.Pack();
  return result;
}

template <typename Base, typename Trimmed>
Handle(Base) Untrim(Handle(Base) curve)
{
  for (Handle(Trimmed) trimmed = Handle(Trimmed)::DownCast(curve); !trimmed.IsNull();
       trimmed = Handle(Trimmed)::DownCast(curve))
  {
    curve = trimmed->BasisCurve();
  }
  return curve;
}

template <typename Spline, typename Offset, typename Base>
std::vector<double> Breaks(Handle(Base) curve, double t0, double t1)
{
  std::vector<double> breaks;
  if (Handle(Offset) offset = Handle(Offset)::DownCast(curve); !offset.IsNull())
  {
    return BreaksOf(offset->BasisCurve(), t0, t1);
  }
  Handle(Spline) spline = Handle(Spline)::DownCast(curve);
  if (spline.IsNull())
  {
    return breaks;
  }
  const TColStd_Array1OfReal& knots = spline->Knots();
  const double period = spline->IsPeriodic() ? knots(knots.Upper()) - knots(knots.Lower()) : 0.0;
  const double first =
    spline->IsPeriodic() ? std::floor((t0 - knots(knots.Lower())) / period) * period : 0.0;
  for (double shift = first;; shift += period)
  {
    for (int i = knots.Lower(); i <= knots.Upper(); ++i)
    {
      const double t = knots(i) + shift;
      if (t > t0 && t < t1 && (breaks.empty() || t > breaks.back()))
      {
        breaks.push_back(t);
      }
    }
    if (period == 0.0 || knots(knots.Upper()) + shift >= t1)
    {
      return breaks;
    }
  }
}

} // namespace

ParameterMap MapOf(const Handle(Geom_Curve) & original, double offset)
{
  const Handle(Geom_Curve) curve = Untrim<Geom_Curve, Geom_TrimmedCurve>(original);
  if (curve->IsKind(STANDARD_TYPE(Geom_Circle)) || curve->IsKind(STANDARD_TYPE(Geom_Ellipse)))
  {
    return ParameterMap::Circular(offset);
  }
  return curve->IsKind(STANDARD_TYPE(Geom_Hyperbola)) ? ParameterMap::Hyperbolic() : ParameterMap();
}

ConvertedCurve<3> ConvertCurve(
  const Handle(Geom_Curve) & original, double t0, double t1, double offset, double tolerance)
{
  if (!(t0 < t1) || Precision::IsInfinite(t0) || Precision::IsInfinite(t1))
  {
    throw Error("the curve's parameter range is empty or infinite");
  }
  const Handle(Geom_Curve) curve = Untrim<Geom_Curve, Geom_TrimmedCurve>(original);
  ConvertedCurve<3> result;
  result.Map = MapOf(curve, offset);
  if (curve->IsKind(STANDARD_TYPE(Geom_Line)))
  {
    result.Geometry = FromPolynomial(curve, 1, t0, t1);
  }
  else if (curve->IsKind(STANDARD_TYPE(Geom_Parabola)))
  {
    result.Geometry = FromPolynomial(curve, 2, t0, t1);
  }
  else if (!result.Map.IsIdentity())
  {
    const gp_Ax2& frame = Handle(Geom_Conic)::DownCast(curve)->Position();
    double a = 0.0;
    double b = 0.0;
    if (Handle(Geom_Circle) circle = Handle(Geom_Circle)::DownCast(curve); !circle.IsNull())
    {
      a = b = circle->Radius();
    }
    else if (Handle(Geom_Ellipse) ellipse = Handle(Geom_Ellipse)::DownCast(curve);
             !ellipse.IsNull())
    {
      a = ellipse->MajorRadius();
      b = ellipse->MinorRadius();
    }
    else
    {
      const Handle(Geom_Hyperbola) hyperbola = Handle(Geom_Hyperbola)::DownCast(curve);
      a = hyperbola->MajorRadius();
      b = hyperbola->MinorRadius();
    }
    result.Geometry = FromArc(ToVec(frame.Location()), a * ToVec(frame.XDirection()),
      b * ToVec(frame.YDirection()), result.Map, t0, t1);
  }
  else if (Handle(Geom_BSplineCurve) spline = Handle(Geom_BSplineCurve)::DownCast(curve);
           !spline.IsNull())
  {
    result.Geometry = FromSpline<3>(spline, t0, t1);
  }
  else if (Handle(Geom_BezierCurve) bezier = Handle(Geom_BezierCurve)::DownCast(curve);
           !bezier.IsNull())
  {
    result.Geometry = FromBezier<3>(bezier, t0, t1);
  }
  else
  {
    std::vector<double> breaks = BreaksOf(curve, t0, t1);
    breaks.insert(breaks.begin(), t0);
    breaks.push_back(t1);
    result.Geometry = FitCurve<3>([&](double t) { return ToVec(curve->Value(t)); }, breaks,
      Vec3::Ones(), tolerance, result.Error);
  }
  return result;
}

bool ConvertSpline(const Handle(Geom2d_Curve) & original, double t0, double t1, Curve<2>& result)
{
  const Handle(Geom2d_Curve) curve = Untrim<Geom2d_Curve, Geom2d_TrimmedCurve>(original);
  if (Handle(Geom2d_BSplineCurve) spline = Handle(Geom2d_BSplineCurve)::DownCast(curve);
      !spline.IsNull())
  {
    result = FromSpline<2>(spline, t0, t1);
    return true;
  }
  if (Handle(Geom2d_BezierCurve) bezier = Handle(Geom2d_BezierCurve)::DownCast(curve);
      !bezier.IsNull())
  {
    result = FromBezier<2>(bezier, t0, t1);
    return true;
  }
  return false;
}

std::vector<double> BreaksOf(const Handle(Geom_Curve) & curve, double t0, double t1)
{
  return Breaks<Geom_BSplineCurve, Geom_OffsetCurve>(
    Untrim<Geom_Curve, Geom_TrimmedCurve>(curve), t0, t1);
}

std::vector<double> BreaksOf(const Handle(Geom2d_Curve) & curve, double t0, double t1)
{
  return Breaks<Geom2d_BSplineCurve, Geom2d_OffsetCurve>(
    Untrim<Geom2d_Curve, Geom2d_TrimmedCurve>(curve), t0, t1);
}

} // namespace nurbs
