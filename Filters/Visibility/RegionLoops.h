// SPDX-License-Identifier: BSD-3-Clause
/// @file RegionLoops.h
/// @brief The borders of visible regions in the (u, v) domains of their faces.
///
/// A region is the union of the cells of a FrontMap where its face is in front. Its border is traced
/// in the image, where it is closed by construction, and taken back to the surface piece by piece:
/// parts of the face's own trim curves and silhouettes as they are, shadows of what is in front by
/// line-surface intersection (Ruan, Zhang, Yong 2006, section 4), with points added until chords are
/// within the precision.
#pragma once

#include "FrontMap.h"

namespace nurbs
{

/// A directed part of a region's border.
struct RegionPiece
{
  std::int64_t Curve = -1;     ///< Trim curve of the completed model; -1: a polyline.
  double From = 0.0, To = 1.0; ///< Shares of the curve's domain; From > To: against it.
  std::vector<Vec2> Polyline;  ///< (u, v).
};

/// Closed: a piece starts where the one before ends. The region lies on the left in the (u, v) plane.
using RegionLoop = std::vector<RegionPiece>;

/// (u, v) at a piece's start or end.
Vec2 EndOfPiece(const Model& model, const RegionPiece& piece, bool last);

/// The region of a face as it is taken back from the image: loops may cross near silhouettes.
struct TracedRegion
{
  std::vector<RegionLoop> Loops;
  /// Points and chords of shadows that are not found on the surface where they are in the image, to the
  /// precision, and gaps that are closed: what is beside shadows must be looked at.
  std::int64_t Doubtful = 0;
};

/// The regions of all faces. `precision`: twice the largest distance of chords of shadows from the
/// exact curve on the surface. `bothSides`: what is seen from behind is visible, too.
std::vector<TracedRegion> TraceRegions(const ViewLines& lines, const ImagePlane& image,
  const RayCaster& caster, const FrontMap& map, double precision, bool bothSides,
  const ParallelFor& parallel);

/// Drops loops of a face that enclose no area in (u, v): a model's loops must enclose some.
void DropFlatLoops(const Model& model, std::int64_t face, std::vector<RegionLoop>& loops);

/// Moves ends of polylines to where the pieces beside them end.
void JoinPolylines(const Model& model, RegionLoop& loop);

/// Cuts pieces of trim curves wherever a piece of another use of the same edge ends, so that faces
/// share whole edges. Ends that parameters do not tell apart become one, and pieces between them go.
void CutAtSharedEnds(const ViewLines& lines, std::vector<std::vector<RegionLoop>>& regions);

} // namespace nurbs
