// SPDX-License-Identifier: BSD-3-Clause
/// @file HandleSearch.h
/// @brief Points on the screen: which are near the cursor, and where the cursor is in space.
///
/// Display coordinates are pixels from the window's lower left corner, as VTK's.
#pragma once

#include "Types.h"

namespace nurbs
{

/// A camera's projection onto a viewport.
struct ScreenView
{
  Eigen::Matrix4d WorldToClip = Eigen::Matrix4d::Identity(); ///< Visible: -w <= x, y, z <= w.
  Vec2 Origin = Vec2::Zero();                                ///< Lower left corner, pixels.
  Vec2 Size = Vec2::Ones();                                  ///< Pixels.

  /// Display coordinates and depth, -1 (near) to 1 (far). False if the point is behind the camera,
  /// before the near plane or beyond the far one.
  bool Project(const Vec3& point, Vec3& display) const;
  /// The point with these display coordinates and depth.
  Vec3 Unproject(const Vec3& display) const;
  /// Direction of the line of sight through a pixel, away from the viewer, length 1.
  Vec3 Sight(const Vec2& display) const;
  /// Depth of a point that is moved towards the viewer by as much as `pixels` are wide there.
  double DepthInFront(const Vec3& display, double pixels) const;
};

/// A point near the cursor.
struct HandleHit
{
  std::int64_t Point = -1;
  double Distance = 0.0; ///< Pixels.
  Vec3 Display;          ///< See ScreenView::Project.
};

/// Points (Cartesian triples at `xyz`) listed in `points` within `radius` pixels of the cursor, the
/// nearest first, then in ascending order. The result does not depend on the number of threads.
std::vector<HandleHit> FindHandles(const ScreenView& view, const double* xyz,
  const std::vector<std::int64_t>& points, const Vec2& cursor, double radius,
  const ParallelFor& parallel);

/// The points inside a rectangle of the screen, in the order of `points`.
std::vector<std::int64_t> FindHandlesInBox(const ScreenView& view, const double* xyz,
  const std::vector<std::int64_t>& points, const Box2& box);

/// Which of the hits is meant: among those that are not hidden (all, if all are) and at most
/// `slack` pixels farther from the cursor than the nearest, the one next to the viewer. `hidden`
/// has one entry a hit, or is empty.
HandleHit ChooseHandle(
  const std::vector<HandleHit>& hits, const std::vector<bool>& hidden, double slack);

/// The parameter t of the point start + t * direction (length 1) that is nearest to the line of
/// sight through `display`; 0 if the two are parallel within 1e-3.
double NearestOnLine(
  const ScreenView& view, const Vec2& display, const Vec3& start, const Vec3& direction);

} // namespace nurbs
