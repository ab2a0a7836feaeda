// SPDX-License-Identifier: BSD-3-Clause
/// @file ImagePlane.h
/// @brief The plane that a model is projected to, and the way back to its surfaces.
#pragma once

#include "ContourForm.h"
#include "RayCaster.h"

namespace nurbs
{

/// Two planes through a line of sight: |Normal[k] . p - Offset[k]| vanishes on it, and is elsewhere the
/// distance in the image, in units of length there (perspective: scaled by the depth of p).
struct SightPlanes
{
  Vec3 Normal[2];
  double Offset[2];
};

/// Projects to coordinates x (right) and y (up), lengths in the model's unit: in parallel light true to
/// size; in perspective at the depth of the model's farthest point, so that nothing appears larger in
/// the model than in the image.
class ImagePlane
{
public:
  /// @param bounds a box around the model, not empty.
  /// @param up what points upwards in the image. Parallel to the view or zero: z, or y if the view
  /// is along z.
  /// Throws Error if a direction has no length, a number is not finite, or no plane through the eye
  /// has all of the box on one side.
  ImagePlane(const Viewer& viewer, const Vec3& up, const Box3& bounds);

  /// The viewer given.
  const Viewer& GetViewer() const { return this->View; }
  /// Of a point in front of the eye.
  Vec2 Project(const Vec3& point) const;
  /// Grows away from the viewer; in perspective the distance along the axis.
  double Depth(const Vec3& point) const { return this->Axes[2].dot(point - this->Origin); }
  /// The line of sight of an image point, away from the viewer; t is a length.
  Ray Sight(const Vec2& image) const;
  /// Two planes that meet in the line of sight.
  SightPlanes Planes(const Vec2& image) const;

  /// Moves (u, v) on the surface (not its trimmed part alone) to where an image point is seen, by
  /// Newton's method from the uv given, on its sheet: where S_u x S_v faces the viewer (`sheet` 1) or
  /// away (-1), or wherever (0). False if it does not come within `tolerance` in the image, a length; uv
  /// is the nearest place met, then: for an image point beyond the silhouette about a point of that.
  bool Lift(
    const SurfaceView& surface, const Vec2& image, double tolerance, int sheet, Vec2& uv) const;

private:
  Viewer View;
  Vec3 Axes[3];       ///< Right, up, and away from the viewer.
  Vec3 Origin;        ///< The eye, or (parallel) a point before the model.
  double Focus = 1.0; ///< Depth of the image plane in perspective.
};

} // namespace nurbs
