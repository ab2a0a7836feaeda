// SPDX-License-Identifier: BSD-3-Clause
/// @file RegionCells.h
/// @brief Regions of a face as unions of cells of its (u, v) domain.
///
/// A border that is taken back from the image is right to the precision there. On a surface that turns
/// away that may be as much as the precision's square root, so that borders cross each other or the
/// face's own ones; and what is narrower than the precision has no cell in the image at all. So the
/// domain is divided once more: by those borders, the face's trim curves, silhouettes and intersection
/// curves, snapped to a grid of 2^-28 of the domain (SnapRounding.h). A line of sight through a point of
/// each cell tells whether it is seen. Regions are unions of cells: their borders close, do not cross,
/// lie within the face, and no part of the face's own border is lost, however narrow it is.
#pragma once

#include "RegionLoops.h"

namespace nurbs
{

/// What is seen of a face, and, on demand, the rest of it: loops, each closed, with the region on the left.
struct SettledRegions
{
  std::vector<RegionLoop> Visible, Hidden;
  /// Places where what is seen and what is not are not told apart to the precision (FaceCells::Look).
  std::int64_t Unsettled = 0;
};

/// Settles regions face by face. Constant once built, and safe to use from many threads.
class RegionCells
{
public:
  /// All must outlive it. `precision`: a length in the image. `bothSides`: what is seen from behind is
  /// visible, too.
  RegionCells(const ViewLines& lines, const ImagePlane& image, const RayCaster& caster,
    double precision, bool bothSides);

  /// @param traced the borders that were taken back from the image; they need not be simple. Where they
  /// are doubtful, what is beside shadows is looked at.
  /// @param hidden make SettledRegions::Hidden, too.
  SettledRegions Settle(std::int64_t face, const TracedRegion& traced, bool hidden) const;

  /// True if the face shows a point, given by its (u, v), to the viewer.
  bool IsSeen(std::int64_t face, const Vec2& uv) const;

private:
  const ViewLines& Lines;
  const ImagePlane& Image;
  const RayCaster& Caster;
  double Precision;
  bool BothSides;
  std::vector<std::vector<std::int32_t>> OwnLines; // Silhouettes and intersections, by face.
};

} // namespace nurbs
