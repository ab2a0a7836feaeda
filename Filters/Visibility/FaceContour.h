// SPDX-License-Identifier: BSD-3-Clause
/// @file FaceContour.h
/// @brief The contour of one surface: all patches, knot lines and borders, as directed polylines.
#pragma once

#include "PatchContour.h"

namespace nurbs
{

/// Self-visible types of Bezier patches (Ruan, Zhang, Yong 2006, section 2), certified by the bounds
/// of the contour function where the paper looks at normals of the control net.
enum class PatchVisibility
{
  Visible = 0, ///< Faces the viewer everywhere.
  Invisible,   ///< Faces away everywhere.
  Partial,     ///< Both.
  EdgeOn       ///< normal . view vanishes.
};
/// Number of kinds.
inline constexpr int PatchVisibilityCount = 4;

/// A connected part of the contour in the domain of one surface.
struct SurfaceContour
{
  ContourArcKind Kind = ContourArcKind::Inner;
  std::vector<ContourPoint> Points; ///< In order; a closed one does not repeat its first point.
  bool Closed = false;
};

/// What TraceSurface found.
struct SurfaceContours
{
  std::vector<SurfaceContour> Contours;
  std::int64_t Patches[PatchVisibilityCount] = { 0, 0, 0, 0 };
  std::int64_t SingularCells = 0;
  std::int64_t UnresolvedCells = 0;
  std::vector<ContourPoint> Singular; ///< Where; the first of each patch.
};

/// The contour within the box `region` of a surface's domain: all patches that it meets are looked at
/// whole. The front (where the outside faces the viewer) lies on the left of every contour, seen from
/// outside. `reversed`: the outside is against S_u x S_v; it exchanges visible and invisible patches.
SurfaceContours TraceSurface(const SurfaceView& surface, bool reversed, const Box2& region,
  const Viewer& viewer, const ContourLimits& limits);

} // namespace nurbs
