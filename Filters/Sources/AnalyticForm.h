// SPDX-License-Identifier: BSD-3-Clause
/// @file AnalyticForm.h
/// @brief Planes, cylinders, cones, spheres and tori among NURBS surfaces; lines and circles among curves.
///
/// A surface or curve is taken for one if it is one but for round-off: 1e-12 of its largest coordinate.
/// Planes are told by the control points, in whose convex hull the surface is; a patch that may fold
/// in its plane, as far as the Bernstein coefficients of its Jacobian tell, is none. The others are
/// told by samples: a surface of degrees p, q put into the equation of a quadric has a numerator of degrees 2p,
/// 2q in every patch (4p, 4q for a torus), so it is on it everywhere if it is at 2p + 1 by 2q + 1 (4p + 1
/// by 4q + 1) places. Besides, its lines in one direction must be circles about the axis: then the
/// angle is a function of one parameter and the other parameter of the analytic surface of the other,
/// and trim curves along u or v stay straight. Meridians of spheres end at a pole at the latest, and
/// a torus has a major radius of 0.001 of its minor one at least: what is nearer to a sphere is a
/// piece of one, so narrow that its axis is not certain, and stays what it is.
#pragma once

#include "Curve.h"
#include "Surface.h"

#include <Geom_Curve.hxx>
#include <Geom_ElementarySurface.hxx>

#include <algorithm>
#include <optional>

namespace nurbs
{

/// An angle as a function of a parameter, without jumps.
class AngleTable
{
public:
  AngleTable() = default;
  /// `angle` is known but for full turns, and turns by less than half a turn from one of the sorted
  /// `parameters` to the next.
  AngleTable(std::vector<double> parameters, const std::function<double(double)>& angle);

  /// The one of the angles `raw` + 2 pi k that belongs to the parameter.
  double Unwrap(double parameter, double raw) const;
  /// At the last parameter less at the first.
  double Total() const { return this->Angles.back() - this->Angles.front(); }
  bool IsMonotone() const;
  double Least() const { return std::min(this->Angles.front(), this->Angles.back()); }
  void Shift(double by);

private:
  std::vector<double> Parameters, Angles;
};

/// A surface of OpenCASCADE that a NURBS surface is a part of.
class AnalyticSurface
{
public:
  /// Nothing if the surface is none of the kinds. Its points are multiplied by `scale` first. The view
  /// must stay valid.
  static std::optional<AnalyticSurface> Recognise(const SurfaceView& surface, double scale);

  const Handle(Geom_ElementarySurface) & GetGeometry() const { return this->Geometry; }
  bool IsPlane() const { return this->Kind == Shape::Plane; }
  /// True if its normals are opposite to those of the NURBS surface.
  bool IsMirrored() const { return this->Mirrored; }
  /// The parameters of the point at (u, v); not for planes.
  Vec2 Parameters(const Vec2& uv) const;
  /// Lengths of a unit of the two parameters, at most.
  Vec2 UnitLengths() const;

private:
  enum class Shape
  {
    Plane,
    Cylinder,
    Cone,
    Sphere,
    Torus
  };

  AnalyticSurface(const SurfaceView& surface, double scale);
  bool FindPlane();
  bool FindTurned(int dir);
  bool FindAxis();
  bool FindProfile();
  bool MakeTables();
  void MakeGeometry();
  bool HoldsEverywhere();
  Vec3 Point(double along, double across) const;
  double Angle(double along) const;
  double Across(double across) const;
  Vec2 Profile(double across) const;
  Vec3 Expected(double angle, double across) const;

  SurfaceView View;
  double Scale = 1.0;
  double Near = 0.0; ///< What round-off may do, length.
  Shape Kind = Shape::Plane;
  bool Mirrored = false;
  int Dir = 0;            ///< The direction of circles.
  Interval Domain[2];     ///< Along the circles, and across.
  double Reference = 0.0; ///< Across: where a circle is not small.
  Vec3 Origin = Vec3::Zero(), X = Vec3::UnitX(), Y = Vec3::UnitY(), Z = Vec3::UnitZ();
  double Radius = 0.0;    ///< Of a torus: the major one. Of a cone: at the origin.
  double Minor = 0.0;     ///< Of a torus.
  double HalfAngle = 0.0; ///< Of a cone.
  double Side = 1.0;      ///< -1: of a torus whose tube is on the other side of the axis.
  AngleTable Turn;        ///< About the axis.
  AngleTable Tube;        ///< Of a torus.
  Handle(Geom_ElementarySurface) Geometry;
};

/// A line or circle that a NURBS curve is a part of, over a range.
struct AnalyticCurve
{
  Handle(Geom_Curve) Geometry;
  Interval Range;
  bool Affine = false; ///< The parameter is an affine function of the NURBS curve's.
};

/// Nothing if the curve is neither. Its points are multiplied by `scale` first.
std::optional<AnalyticCurve> RecogniseCurve(const CurveView<3>& curve, double scale);

} // namespace nurbs
