// SPDX-License-Identifier: BSD-3-Clause
/// @file LineTruth.h
/// @brief Is a point of a line on the exact surfaces visible? Asked of rays, whoever drew the line.
///
/// Parallel projection. Beside the point, at both sides of the line's image, rays look for the
/// foremost surface, at two distances. A surface in front that comes near the point as the rays do is
/// the point's own (the near side of a silhouette, the walls of a valley). One that stays in front is
/// in the way. In the way on both sides: the point is hidden. On neither: it is visible. On one: the
/// point lies at the border of what may hide it, and is not judged; nor is it if a ray through the
/// point itself is blocked and those beside it are not. Where two surfaces are near the point (an edge
/// of a thin plate, an edge of a block at its outline) nothing tells which is its own: it is on the
/// foremost one, or right behind it.
#pragma once

#include "RayCaster.h"

namespace verify
{

enum class Truth
{
  Visible,
  Foremost, ///< Visible, or hidden by what is no further away than ten times the tolerance.
  Hidden,
  Undecided
};

/// Lengths in the image.
struct LineLengths
{
  double Visible = 0.0;                 ///< Of lines said to be visible.
  double Hidden = 0.0;                  ///< Of those said to be hidden.
  double WrongVisible = 0.0;            ///< Said to be visible, but hidden.
  double WrongHidden = 0.0;             ///< Said to be hidden, but visible.
  double Undecided = 0.0;               ///< Not judged.
  std::vector<nurbs::Vec3> WrongPoints; ///< In the middle of each wrong piece.
};

/// Judges lines of one model seen from one direction. The caster must outlive it.
class LineTruth
{
public:
  /// @param view from the model to the viewer, of any length over 0.
  /// @param tolerance how far lines may be from where they belong, a length. Rays run at 4 and 16
  /// times that from them; surfaces up to 10 times that in front of a point hide nothing.
  LineTruth(const nurbs::RayCaster& caster, const nurbs::Vec3& view, double tolerance);

  /// A point with the direction of its line (of any length over 0).
  Truth At(const nurbs::Vec3& point, const nurbs::Vec3& tangent) const
  {
    return this->At(point, tangent, this->Tolerance);
  }

  /// Adds a polyline, judged at every `step` of its image. A point that is said to be hidden is wrong
  /// if it is visible by a quarter of the tolerance and by four times it, too.
  void Judge(
    const std::vector<nurbs::Vec3>& line, bool isVisible, double step, LineLengths& lengths) const;

private:
  /// The foremost surface in the image at `place`.
  struct Foremost
  {
    double Gap;   ///< How far it is in front of the depth asked for; -infinity: there is none.
    bool IsAlone; ///< No other surface is within the limit of that depth.
  };
  Foremost Look(const nurbs::Vec3& place, double depth, double limit) const;
  Truth At(const nurbs::Vec3& point, const nurbs::Vec3& tangent, double tolerance) const;

  const nurbs::RayCaster& Caster;
  nurbs::Vec3 View;
  double Tolerance;
  double Far; ///< Depth, along View, in front of the whole model.
};

} // namespace verify
