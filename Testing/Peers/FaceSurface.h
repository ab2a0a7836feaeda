// SPDX-License-Identifier: BSD-3-Clause
/// @file FaceSurface.h
/// @brief Nearest points on the untrimmed surface of an OpenCASCADE face.
#pragma once

#include "ClosestTriangle.h"

#include <BRepAdaptor_Surface.hxx>
#include <TopoDS_Face.hxx>

namespace verify
{

/// Where on the surface a point's (locally) nearest point lies.
struct Foot
{
  Vec2 UV = Vec2::Zero();
  double Distance = std::numeric_limits<double>::infinity();
};

/// The face's surface in the model's space. One object a thread: its evaluator keeps caches.
class FaceSurface
{
public:
  /// @a accuracy is the length that does not matter; distances below it need not be exact.
  FaceSurface(const TopoDS_Face& face, double accuracy);

  Vec3 Point(const Vec2& uv) const;
  /// @a uv moved into the surface's domain where it is not periodic: pcurves of dirty models leave
  /// it, and a polynomial continued beyond its domain means nothing.
  Vec2 Clamped(Vec2 uv) const;
  /// Unit Su x Sv, turned outwards if the face is reversed; zero where it vanishes.
  Vec3 OuterNormal(const Vec2& uv) const;
  void Derivatives(const Vec2& uv, Vec3& p, Vec3& su, Vec3& sv) const;
  /// |k1| + |k2| times the area element, for the allowance of areas.
  double BendingDensity(const Vec2& uv) const;

  bool IsElementary() const { return this->Elementary; }
  /// 0 where the surface is not periodic in that direction.
  double Period(int direction) const { return this->Periods[direction]; }

  /// The part of the domain that the seeds of ProjectGlobally cover: the box of the trim.
  void SetRegion(const Vec2& low, const Vec2& high);

  /// Newton from @a seed, a closed form on elementary surfaces. Its distance is attained, hence never
  /// below the true one.
  Foot Project(const Vec3& p, const Vec2& seed) const;
  /// Newton from the nearest point of a grid over the region.
  Foot ProjectGlobally(const Vec3& p) const;
  /// As before from every promising grid point, then a pattern search that needs no derivative.
  Foot ProjectExhaustively(const Vec3& p, const Foot& best) const;

private:
  Foot ClosedForm(const Vec3& p) const;
  Foot Newton(const Vec3& p, Vec2 uv) const;
  Vec2 Limited(Vec2& step) const;
  Foot PatternSearch(const Vec3& p, Foot foot) const;
  void BuildGrid() const;

  BRepAdaptor_Surface Surface;
  double Accuracy;
  bool Elementary = false, Reversed = false;
  double Periods[2] = { 0.0, 0.0 };
  bool Closed[2] = { false, false };
  Vec2 Low, High;             ///< Of the surface's own domain; may be infinite.
  Vec2 RegionLow, RegionHigh; ///< Of the trim.
  mutable std::vector<Vec3> GridPoints;
  mutable std::vector<Vec2> GridUV;
  mutable std::vector<std::array<int, 3>> GridTriangles;
  mutable ClosestTriangle Grid;
};

} // namespace verify
