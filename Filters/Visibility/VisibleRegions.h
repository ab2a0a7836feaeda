// SPDX-License-Identifier: BSD-3-Clause
/// @file VisibleRegions.h
/// @brief What is seen of a model from somewhere: regions of its faces, and lines without what is hidden.
///
/// Source: X. Ruan, H. Zhang, J. Yong, "Visible region extraction from a sequence of rational Bezier
/// surfaces", 2006, section 4. See Documentation/Papers/ruan-2006.md for what is done differently.
#pragma once

#include "RegionLoops.h"

#include <memory>
#include <optional>

namespace nurbs
{

class ModelBuilder;

/// Where from, how exact, what is wanted.
struct VisibleRegionOptions
{
  Viewer View;
  Vec3 Up = Vec3::UnitZ(); ///< See ImagePlane.
  /// In the image, a length over 0: how far borders of regions and ends of visible lines may be off,
  /// and how narrow a region may be to be left out.
  double Precision = 1e-4;
  double FeatureAngle = 0.5235987755982988; ///< Of sharp edges, radians; 30 degrees.
  bool Regions = true;                      ///< Off: lines only, regions stay empty.
  bool SmoothLines = true;                  ///< Off, without regions: smooth edges may be left out.
  bool HiddenRegions = false;               ///< Regions are what is not visible.
  bool BothSides = true;                    ///< Faces are visible from behind, too.
  /// Lines within clusters of faces that face the viewer are cut by clusters' borders only.
  bool Clustering = false;
  std::int64_t MaximumCells = 20000; ///< As SilhouetteOptions.
  std::vector<int> Parts;            ///< As SilhouetteOptions.
  ParallelFor Parallel = SerialFor;
  WorkShare Share; ///< Processes that all make the regions of the same model.
  /// Called from any thread with the share done; false: stop.
  std::function<bool(double)> Progress;
};

/// What is visible of a face.
struct FaceRegion
{
  std::vector<RegionLoop> Loops; ///< Empty: no part of the face.
  bool IsWhole = false;          ///< The loops are those of the face.
  /// A part of the border was not found to the precision, and runs about where it must be: see
  /// SettledRegions::Unsettled.
  bool IsInexact = false;
  double Area = 0.0; ///< Of the face; 0 if nothing of it is visible.
  double VisibleArea = 0.0;
};

/// A part of a line that is visible or hidden as a whole.
struct DrawnLine
{
  LineKind Kind = LineKind::Silhouette;
  bool Visible = false;
  std::int64_t Face = -1; ///< Whose (u, v) the points have.
  std::int64_t Edge = -1; ///< Of the given model; -1: none.
  std::vector<ContourPoint> Points;
};

/// Regions of all faces and the lines of the drawing.
struct VisibleRegions
{
  std::optional<ImagePlane> Image; ///< What was projected to.
  ViewLines Lines;                 ///< With the model completed, which regions refer to.
  std::vector<FaceRegion> Faces;   ///< One a face; without regions: none.
  /// Silhouettes by face, then intersections by pair of faces, then edges by their index.
  std::vector<DrawnLine> Drawn;
  /// Faces of which now one and now the other is in front within one cell of the image: they pierce
  /// or touch each other there, and the border between their regions is not exact. -1: nothing. And
  /// pairs whose intersection curves may be missing (FaceIntersections::Unresolved). Sorted.
  std::vector<std::array<std::int64_t, 2>> Piercing;
  std::int64_t Cells = 0; ///< Of the planar map.
  bool Aborted = false;
};

/// What is the same whatever the view. The first call that is given it fills it in; the next ones, with
/// the same model and face errors, which must not have changed, are the quicker for it.
struct VisibilityCache
{
  std::shared_ptr<const RayCaster> Caster;
  std::shared_ptr<const FaceIntersections> Intersections;
  double Precision = 0.0; ///< VisibleRegionOptions::Precision that they are for.
};

/// Makes regions and lines. `faceErrors`: one a face, why it can't be used, or "". The result does not
/// depend on `Parallel`. Throws Error if the precision or feature angle is not positive, the view not
/// valid (see ImagePlane), or the precision below 2e-9 of the image of the model's box or 4e-15 of the
/// largest coordinate, the eye's included.
VisibleRegions MakeVisibleRegions(const Model& model, const std::vector<std::string>& faceErrors,
  const VisibleRegionOptions& options, VisibilityCache* cache = nullptr);

/// Adds the regions of faces [first, last) to a builder, in order, as faces with their own trims: parts
/// of trim curves keep sharing edges. Returns the faces that were added. Aborted or empty: none.
std::vector<std::int64_t> BuildRegions(
  const VisibleRegions& regions, std::int64_t first, std::int64_t last, ModelBuilder& builder);

} // namespace nurbs
