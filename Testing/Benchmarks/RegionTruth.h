// SPDX-License-Identifier: BSD-3-Clause
/// @file RegionTruth.h
/// @brief Are the visible regions of a model what rays see? Compares point by point.
///
/// A ray's first hit with the exact model is visible, its others are hidden; each hit is inside or
/// outside of its face's visible regions as their trims tell. Where the two disagree, the distance to
/// the nearest border of that face's regions in the image tells whether precision excuses it. What is
/// narrower than the precision may have no border of its own, but then lies beside another face's.
#pragma once

#include "RayCaster.h"

#include <cmath>
#include <memory>
#include <mutex>
#include <unordered_map>

namespace truth
{

/// How points are projected, for parallel views and for an eye.
struct ImageView
{
  bool Perspective = false;
  nurbs::Vec3 Toward =
    nurbs::Vec3::UnitZ(); ///< Unit; to the viewer (of an eye: from Center to it).
  nurbs::Vec3 Eye = nurbs::Vec3::Zero();
  nurbs::Vec3 Right = nurbs::Vec3::UnitX(), Up = nurbs::Vec3::UnitY();
  nurbs::Vec3 Center = nurbs::Vec3::Zero(); ///< The image plane runs through it.

  /// A parallel view of what is in the box; `direction` of any length over 0.
  static ImageView Parallel(const nurbs::Box3& box, const nurbs::Vec3& direction);
  /// The view of an eye outside of the box.
  static ImageView FromEye(const nurbs::Box3& box, const nurbs::Vec3& eye);

  /// Coordinates in the image plane, in the model's unit.
  nurbs::Vec2 Project(const nurbs::Vec3& point) const;
  /// The ray of an image point, from in front of everything away from the viewer; `size`: the
  /// model's diagonal.
  nurbs::Ray RayOf(const nurbs::Vec2& image, double size) const;
  /// By how much what is at `point` is magnified in the image: 1 in the image plane.
  double Scale(const nurbs::Vec3& point) const;
};

/// A point where rays and regions disagree beyond the precision.
struct Disagreement
{
  std::int64_t Face = -1; ///< Of the source model.
  nurbs::Vec2 UV = nurbs::Vec2::Zero();
  nurbs::Vec3 Point = nurbs::Vec3::Zero();
  bool IsFront = false;  ///< The ray sees it.
  double Distance = 0.0; ///< From the nearest border of the face's regions; infinite: it has none.
};

struct RegionCheck
{
  std::int64_t Rays = 0, Hits = 0;
  std::int64_t Agree = 0;  ///< Hits.
  std::int64_t Within = 0; ///< Hits that disagree within the precision of a border.
  std::int64_t Narrow = 0; ///< Those within the precision of a border of another face only.
  std::int64_t Near = 0;   ///< Those within ten times the precision of a border of their face.
  std::int64_t Wrong = 0;  ///< All others.
  /// Neither near nor wrong: beyond the precision, but another face lies at the same place, to a
  /// millionth of the size or twice the tolerance of the edges of either. Which one is in front is
  /// not told by such a file. Or the ray meets the face beyond its own border, in a gap to another one
  /// that the edges' tolerance bridges (RayCaster.h), where no region can reach; or is as near to a border
  /// as twice the tolerance of the edges of its face, or of the face in front, and the precision.
  std::int64_t Coincident = 0;
  std::int64_t Bridged = 0;     ///< The part of Coincident that only edges' tolerances explain.
  std::int64_t MissedFaces = 0; ///< Wrong hits on faces that have no region at all.
  double Worst = 0.0; ///< The largest finite distance of a disagreement, over the precision.
  std::vector<Disagreement> List; ///< Of Near and Wrong, some.
};

/// The regions of one view of one model.
class RegionTruth
{
public:
  /// @param caster of the source model.
  /// @param regions faces whose trims are the regions.
  /// @param sources one a face of `regions`: the source model's face, over the same domain.
  /// @param areHidden the regions are what is hidden.
  RegionTruth(const nurbs::RayCaster& caster, const nurbs::Model& regions,
    const std::vector<std::int64_t>& sources, const ImageView& view, double precision,
    bool areHidden, const nurbs::ParallelFor& parallel);

  /// Casts about `rays` rays, one at random in every cell of a grid over the model's image; lists up
  /// to `list` disagreements.
  RegionCheck Check(std::int64_t rays, std::size_t list) const;

private:
  struct Segment
  {
    nurbs::Vec2 From, To;
    double Scale;
  };
  void AddBorder(const nurbs::Face& face, std::vector<Segment>& border) const;
  /// `front` is the ray's first hit, `hit` itself if that is it.
  void Judge(const nurbs::RayHit& hit, const nurbs::RayHit& front, RegionCheck& check,
    std::size_t list) const;
  bool IsBridged(const nurbs::RayHit& hit, const nurbs::RayHit& front) const;
  bool IsCoincident(const nurbs::RayHit& hit) const;
  double DistanceToBorder(std::int64_t face, const nurbs::Vec3& point) const;
  bool IsBesideAnyBorder(const nurbs::Vec3& point) const;
  void SortSegments();

  const nurbs::RayCaster& Caster;
  const nurbs::Model& Regions;
  nurbs::TrimIndex Trims;
  ImageView View;
  double Precision;
  bool AreHidden;
  nurbs::ParallelFor Parallel;
  std::vector<std::vector<std::int64_t>> RegionsOf; ///< One a face of the source model.
  std::vector<std::vector<Segment>> Borders;        ///< One a face of the source model.
  /// All segments by the cells of a grid over the image that they may be within the precision of.
  double Cell = 1.0;
  std::unordered_map<std::int64_t, std::vector<const Segment*>> Cells;
  std::vector<double> Tolerances; ///< The largest of a face's edges, one a face.
  /// The model without one of its faces, by that face.
  struct Others
  {
    nurbs::Model Model;
    std::unique_ptr<nurbs::RayCaster> Caster;
  };
  mutable std::mutex OthersMutex;
  mutable std::unordered_map<std::int64_t, std::unique_ptr<Others>> OthersOf;
};

} // namespace truth
