// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceConverter.h"

#include "CurveConverter.h"
#include "CurveFit.h"
#include "SplineData.h"

#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Precision.hxx>

namespace nurbs
{

namespace
{

Vec3 ToVec(const gp_XYZ& p)
{
  return Vec3(p.X(), p.Y(), p.Z());
}

/// Homogeneous control points of a profile with how each turns about the axis: the point is
/// Center + x Radial + y Tangent for (x, y) on the unit circle.
struct TurningPoint
{
  Vec3 Center, Radial, Tangent;
  double Weight;
};

/// The profile (knots and degree of `v`) revolved over the range of u.
Surface Revolve(const ParameterMap& map, Interval u, int degree, const std::vector<double>& knots,
  const std::vector<TurningPoint>& profile)
{
  const UnitArc arc = MakeUnitArc(map, u.Min, u.Max);
  Surface surface;
  surface.Degree[0] = 2;
  surface.Degree[1] = degree;
  surface.Knots[0] = arc.Knots;
  surface.Knots[1] = knots;
  surface.Count[0] = static_cast<int>(arc.Points.size());
  surface.Count[1] = static_cast<int>(profile.size());
  for (const TurningPoint& p : profile)
  {
    for (const Vec3& h : arc.Points)
    {
      surface.Points.push_back(p.Center + (h[0] / h[2]) * p.Radial + (h[1] / h[2]) * p.Tangent);
      surface.Weights.push_back(h[2] * p.Weight);
    }
  }
  return surface;
}

std::vector<double> LineKnots(Interval range)
{
  return { range.Min, range.Min, range.Max, range.Max };
}

void Require(Interval range, const char* name)
{
  if (!(range.Min < range.Max) || Precision::IsInfinite(range.Min) ||
    Precision::IsInfinite(range.Max))
  {
    throw Error(std::string("the face has no extent, or an infinite one, in ") + name);
  }
}

} // namespace

SurfaceConverter::SurfaceConverter(const Handle(Geom_Surface) & surface, double tolerance)
  : Base(surface)
  , Tolerance(tolerance)
{
  for (;;)
  {
    if (Handle(Geom_RectangularTrimmedSurface) trimmed =
          Handle(Geom_RectangularTrimmedSurface)::DownCast(this->Base);
        !trimmed.IsNull())
    {
      this->Base = trimmed->BasisSurface();
      continue;
    }
    const Handle(Geom_OffsetSurface) offset = Handle(Geom_OffsetSurface)::DownCast(this->Base);
    const Handle(Geom_Surface) same = offset.IsNull() ? nullptr : offset->Surface();
    if (same.IsNull())
    {
      break;
    }
    this->Base = same;
  }
  if (this->Base->IsKind(STANDARD_TYPE(Geom_ElementarySurface)) && !this->IsPlane())
  {
    this->Maps[0] = ParameterMap::Circular();
    if (this->Base->IsKind(STANDARD_TYPE(Geom_SphericalSurface)) ||
      this->Base->IsKind(STANDARD_TYPE(Geom_ToroidalSurface)))
    {
      this->Maps[1] = ParameterMap::Circular();
    }
  }
  else if (Handle(Geom_SurfaceOfRevolution) turned =
             Handle(Geom_SurfaceOfRevolution)::DownCast(this->Base);
           !turned.IsNull())
  {
    this->Maps[0] = ParameterMap::Circular();
    this->Maps[1] = MapOf(turned->BasisCurve());
  }
  else if (Handle(Geom_SurfaceOfLinearExtrusion) drawn =
             Handle(Geom_SurfaceOfLinearExtrusion)::DownCast(this->Base);
           !drawn.IsNull())
  {
    this->Maps[0] = MapOf(drawn->BasisCurve());
  }
}

bool SurfaceConverter::IsPlane() const
{
  return this->Base->IsKind(STANDARD_TYPE(Geom_Plane));
}

double SurfaceConverter::Period(int dir) const
{
  if (dir == 0)
  {
    return this->Base->IsUPeriodic() ? this->Base->UPeriod() : 0.0;
  }
  return this->Base->IsVPeriodic() ? this->Base->VPeriod() : 0.0;
}

Interval SurfaceConverter::NaturalRange(int dir) const
{
  double u0, u1, v0, v1;
  this->Base->Bounds(u0, u1, v0, v1);
  return dir == 0 ? Interval{ u0, u1 } : Interval{ v0, v1 };
}

Surface SurfaceConverter::Convert(Interval u, Interval v, double& error) const
{
  error = 0.0;
  if (this->Base->IsKind(STANDARD_TYPE(Geom_BezierSurface)))
  {
    return this->Bezier();
  }
  Require(u, "u");
  Require(v, "v");
  if (this->Base->IsKind(STANDARD_TYPE(Geom_BSplineSurface)))
  {
    return this->BSpline(u, v);
  }
  if (this->IsPlane())
  {
    return this->Plane(u, v);
  }
  u = this->Maps[0].Widen(u);
  v = this->Maps[1].Widen(v);
  if (this->Base->IsKind(STANDARD_TYPE(Geom_ElementarySurface)))
  {
    return this->Elementary(u, v);
  }
  if (this->Base->IsKind(STANDARD_TYPE(Geom_SurfaceOfLinearExtrusion)))
  {
    return this->Extrusion(u, v, error);
  }
  if (this->Base->IsKind(STANDARD_TYPE(Geom_SurfaceOfRevolution)))
  {
    return this->Revolution(u, v, error);
  }
  return this->Fit(u, v, error);
}

Surface SurfaceConverter::Plane(Interval u, Interval v) const
{
  const gp_Ax3& frame = Handle(Geom_Plane)::DownCast(this->Base)->Position();
  const Vec3 o = ToVec(frame.Location().XYZ());
  const Vec3 x = ToVec(frame.XDirection().XYZ());
  const Vec3 y = ToVec(frame.YDirection().XYZ());
  Surface surface;
  surface.Count[0] = surface.Count[1] = 2;
  surface.Knots[0] = LineKnots(u);
  surface.Knots[1] = LineKnots(v);
  for (const double b : { v.Min, v.Max })
  {
    for (const double a : { u.Min, u.Max })
    {
      surface.Points.push_back(o + a * x + b * y);
    }
  }
  return surface;
}

Surface SurfaceConverter::Elementary(Interval u, Interval v) const
{
  const gp_Ax3& frame = Handle(Geom_ElementarySurface)::DownCast(this->Base)->Position();
  const Vec3 o = ToVec(frame.Location().XYZ());
  const Vec3 x = ToVec(frame.XDirection().XYZ());
  const Vec3 y = ToVec(frame.YDirection().XYZ());
  const Vec3 z = ToVec(frame.Direction().XYZ());
  std::vector<TurningPoint> profile;
  // A point of the profile at the distance r from the axis and the height h.
  auto add = [&](double r, double h, double weight) {
    profile.push_back({ o + h * z, r * x, r * y, weight });
  };

  double middle = 0.0;
  double radius = 0.0;
  if (Handle(Geom_CylindricalSurface) cylinder =
        Handle(Geom_CylindricalSurface)::DownCast(this->Base);
      !cylinder.IsNull())
  {
    add(cylinder->Radius(), v.Min, 1.0);
    add(cylinder->Radius(), v.Max, 1.0);
    return Revolve(this->Maps[0], u, 1, LineKnots(v), profile);
  }
  if (Handle(Geom_ConicalSurface) cone = Handle(Geom_ConicalSurface)::DownCast(this->Base);
      !cone.IsNull())
  {
    const double s = std::sin(cone->SemiAngle());
    const double c = std::cos(cone->SemiAngle());
    add(cone->RefRadius() + v.Min * s, v.Min * c, 1.0);
    add(cone->RefRadius() + v.Max * s, v.Max * c, 1.0);
    return Revolve(this->Maps[0], u, 1, LineKnots(v), profile);
  }
  if (Handle(Geom_SphericalSurface) sphere = Handle(Geom_SphericalSurface)::DownCast(this->Base);
      !sphere.IsNull())
  {
    radius = sphere->Radius();
  }
  else
  {
    const Handle(Geom_ToroidalSurface) torus = Handle(Geom_ToroidalSurface)::DownCast(this->Base);
    if (torus.IsNull())
    {
      throw Error("an elementary surface of an unknown kind");
    }
    middle = torus->MajorRadius();
    radius = torus->MinorRadius();
  }
  const UnitArc arc = MakeUnitArc(this->Maps[1], v.Min, v.Max);
  for (const Vec3& h : arc.Points)
  {
    add(middle + radius * h[0] / h[2], radius * h[1] / h[2], h[2]);
  }
  return Revolve(this->Maps[0], u, 2, arc.Knots, profile);
}

Surface SurfaceConverter::Extrusion(Interval u, Interval v, double& error) const
{
  const Handle(Geom_SurfaceOfLinearExtrusion) drawn =
    Handle(Geom_SurfaceOfLinearExtrusion)::DownCast(this->Base);
  const ConvertedCurve<3> basis =
    ConvertCurve(drawn->BasisCurve(), u.Min, u.Max, 0.0, this->Tolerance);
  error = basis.Error;
  const Vec3 direction = ToVec(drawn->Direction().XYZ());
  Surface surface;
  surface.Degree[0] = basis.Geometry.Degree;
  surface.Count[0] = static_cast<int>(basis.Geometry.Points.size());
  surface.Count[1] = 2;
  surface.Knots[0] = basis.Geometry.Knots;
  surface.Knots[1] = LineKnots(v);
  for (const double height : { v.Min, v.Max })
  {
    for (std::size_t i = 0; i < basis.Geometry.Points.size(); ++i)
    {
      surface.Points.push_back(basis.Geometry.Points[i] + height * direction);
      surface.Weights.push_back(basis.Geometry.Weights[i]);
    }
  }
  return surface;
}

Surface SurfaceConverter::Revolution(Interval u, Interval v, double& error) const
{
  const Handle(Geom_SurfaceOfRevolution) turned =
    Handle(Geom_SurfaceOfRevolution)::DownCast(this->Base);
  const ConvertedCurve<3> basis =
    ConvertCurve(turned->BasisCurve(), v.Min, v.Max, 0.0, this->Tolerance);
  error = basis.Error;
  const Vec3 o = ToVec(turned->Axis().Location().XYZ());
  const Vec3 z = ToVec(turned->Axis().Direction().XYZ());
  std::vector<TurningPoint> profile;
  for (std::size_t i = 0; i < basis.Geometry.Points.size(); ++i)
  {
    const Vec3& p = basis.Geometry.Points[i];
    const Vec3 center = o + (p - o).dot(z) * z;
    const Vec3 radial = p - center;
    profile.push_back({ center, radial, z.cross(radial), basis.Geometry.Weights[i] });
  }
  return Revolve(this->Maps[0], u, basis.Geometry.Degree, basis.Geometry.Knots, profile);
}

Surface SurfaceConverter::Bezier() const
{
  const Handle(Geom_BezierSurface) bezier = Handle(Geom_BezierSurface)::DownCast(this->Base);
  Surface surface;
  surface.Degree[0] = bezier->UDegree();
  surface.Degree[1] = bezier->VDegree();
  for (int dir = 0; dir < 2; ++dir)
  {
    surface.Count[dir] = surface.Degree[dir] + 1;
    surface.Knots[dir].assign(surface.Degree[dir] + 1, 0.0);
    surface.Knots[dir].insert(surface.Knots[dir].end(), surface.Degree[dir] + 1, 1.0);
  }
  const bool rational = bezier->IsURational() || bezier->IsVRational();
  for (int j = 1; j <= surface.Count[1]; ++j)
  {
    for (int i = 1; i <= surface.Count[0]; ++i)
    {
      surface.Points.push_back(ToVec(bezier->Pole(i, j).XYZ()));
      if (rational)
      {
        surface.Weights.push_back(bezier->Weight(i, j));
      }
    }
  }
  return surface;
}

Surface SurfaceConverter::BSpline(Interval u, Interval v) const
{
  const Handle(Geom_BSplineSurface) spline = Handle(Geom_BSplineSurface)::DownCast(this->Base);
  Interval range[2] = { u, v };
  bool unrolled[2] = { spline->IsUPeriodic() == Standard_True,
    spline->IsVPeriodic() == Standard_True };
  const int degree[2] = { spline->UDegree(), spline->VDegree() };
  FlatKnots flat[2];
  for (int dir = 0; dir < 2; ++dir)
  {
    const TColStd_Array1OfReal& knots = dir == 0 ? spline->UKnots() : spline->VKnots();
    const TColStd_Array1OfInteger& multiplicities =
      dir == 0 ? spline->UMultiplicities() : spline->VMultiplicities();
    if (unrolled[dir])
    {
      // Whole spans of the spline; the domain's ends stay where the original has knots.
      const Interval natural = this->NaturalRange(dir);
      const double slack = 1e-9 * natural.Length();
      if (range[dir].Min >= natural.Min - slack && range[dir].Max <= natural.Max + slack)
      {
        range[dir] = natural;
      }
      flat[dir] = Unroll(knots, multiplicities, degree[dir], range[dir].Min, range[dir].Max);
    }
    else
    {
      flat[dir] =
        Flatten(knots, multiplicities, dir == 0 ? spline->NbUPoles() : spline->NbVPoles());
    }
  }
  Surface surface;
  const bool rational = spline->IsURational() || spline->IsVRational();
  for (int dir = 0; dir < 2; ++dir)
  {
    surface.Degree[dir] = degree[dir];
    surface.Count[dir] = static_cast<int>(flat[dir].Poles.size());
    surface.Knots[dir] = flat[dir].Knots;
  }
  surface.Points.reserve(flat[0].Poles.size() * flat[1].Poles.size());
  for (const int j : flat[1].Poles)
  {
    for (const int i : flat[0].Poles)
    {
      surface.Points.push_back(ToVec(spline->Pole(i + 1, j + 1).XYZ()));
      if (rational)
      {
        surface.Weights.push_back(spline->Weight(i + 1, j + 1));
      }
    }
  }
  bool clamped = true;
  for (int dir = 0; dir < 2; ++dir)
  {
    clamped = clamped && IsClamped(surface.Knots[dir], surface.Degree[dir]);
    if (!unrolled[dir])
    {
      range[dir] = surface.View().Domain(dir);
    }
  }
  return clamped ? surface : Restrict(surface.View(), range[0], range[1]);
}

Surface SurfaceConverter::Fit(Interval u, Interval v, double& error) const
{
  std::vector<double> breaks[2] = { { u.Min }, { v.Min } };
  Handle(Geom_Surface) basis = this->Base;
  if (Handle(Geom_OffsetSurface) offset = Handle(Geom_OffsetSurface)::DownCast(basis);
      !offset.IsNull())
  {
    basis = offset->BasisSurface();
  }
  if (Handle(Geom_BSplineSurface) spline = Handle(Geom_BSplineSurface)::DownCast(basis);
      !spline.IsNull())
  {
    const Handle(Geom_Curve) iso[2] = { spline->VIso(v.Min), spline->UIso(u.Min) };
    const std::vector<double> inner[2] = { BreaksOf(iso[0], u.Min, u.Max),
      BreaksOf(iso[1], v.Min, v.Max) };
    for (int dir = 0; dir < 2; ++dir)
    {
      breaks[dir].insert(breaks[dir].end(), inner[dir].begin(), inner[dir].end());
    }
  }
  breaks[0].push_back(u.Max);
  breaks[1].push_back(v.Max);
  const auto value = [this](double a, double b) { return ToVec(this->Base->Value(a, b).XYZ()); };
  return FitSurface(value, breaks[0], breaks[1], this->Tolerance, error);
}

} // namespace nurbs
