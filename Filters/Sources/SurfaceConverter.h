// SPDX-License-Identifier: BSD-3-Clause
/// @file SurfaceConverter.h
/// @brief OpenCASCADE's surfaces as rational B-splines, exactly.
///
/// Planes become bilinear patches; cylinders, cones, spheres, tori and surfaces of revolution are
/// revolved profiles with spans of a quarter turn; extrusions are ruled; Bezier and B-spline
/// surfaces keep their control points (periodic ones are unrolled over the range). Offset and
/// unknown surfaces are fitted, and the deviation is told.
///
/// The parameters of a converted surface are x = MapU(u), y = MapV(v), see ParameterMap: the maps
/// depend on the kind of surface alone, not on the range, so trim curves can be converted first.
#pragma once

#include "ParameterMap.h"
#include "Surface.h"

#include <Geom_Surface.hxx>

namespace nurbs
{

/// What is known of a surface before its range is.
class SurfaceConverter
{
public:
  /// `tolerance`: what a fit may deviate, length.
  SurfaceConverter(const Handle(Geom_Surface) & surface, double tolerance);

  /// The surface itself, without rectangular trimming; an offset of an elementary surface is that
  /// elementary surface.
  const Handle(Geom_Surface) & GetSurface() const { return this->Base; }
  bool IsPlane() const;

  /// Maps of u (0) and v (1) to the converted surface's parameters.
  const ParameterMap& Map(int dir) const { return this->Maps[dir]; }

  /// The period in u (0) or v (1), 0 if it is not periodic.
  double Period(int dir) const;

  /// The natural range of u (0) or v (1) in original parameters; may be infinite.
  Interval NaturalRange(int dir) const;

  /// The converted surface over at least the range (original parameters): B-splines keep their
  /// whole domain unless they are periodic and the range leaves it, others cover just the range.
  /// `error` receives the largest deviation of a fit, 0 for exact surfaces. Throws Error when the
  /// range is empty or infinite.
  Surface Convert(Interval u, Interval v, double& error) const;

private:
  Surface Plane(Interval u, Interval v) const;
  Surface Elementary(Interval u, Interval v) const;
  Surface Extrusion(Interval u, Interval v, double& error) const;
  Surface Revolution(Interval u, Interval v, double& error) const;
  Surface BSpline(Interval u, Interval v) const;
  Surface Bezier() const;
  Surface Fit(Interval u, Interval v, double& error) const;

  Handle(Geom_Surface) Base;
  ParameterMap Maps[2];
  double Tolerance;
};

} // namespace nurbs
