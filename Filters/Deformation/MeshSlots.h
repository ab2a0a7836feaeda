// SPDX-License-Identifier: BSD-3-Clause
/// @file MeshSlots.h
/// @brief The arrays of a mesh that is edited in place.
///
/// Points and triangles keep their places from frame to frame. Those that are added take the places of
/// removed ones, then places at the end. Triangles have no gaps: the last ones move into the places
/// that stay free. A point's place that stays free has the position of a point in use, until there
/// are so many that the points are numbered anew.
#pragma once

#include "Types.h"

#include <functional>

namespace nurbs
{

/// The arrays that a deforming mesh is written to; who derives from it owns them.
class MeshArrays
{
public:
  virtual ~MeshArrays() = default;
  /// Changes the numbers of points and triangles and sets the pointers; what fits is kept.
  virtual void Resize(std::int64_t points, std::int64_t triangles) = 0;

  std::int64_t PointCount = 0;
  std::int64_t TriangleCount = 0;
  double* Points = nullptr;        ///< xyz triples.
  float* Normals = nullptr;        ///< Likewise; unit, outwards.
  double* UV = nullptr;            ///< Pairs, in the domain of the point's face.
  std::int64_t* Corners = nullptr; ///< Three points a triangle, counter-clockwise from outside.
  std::int64_t* Faces = nullptr;   ///< One a triangle: index of its face.
};

/// MeshArrays in vectors.
class MeshVectors : public MeshArrays
{
public:
  void Resize(std::int64_t points, std::int64_t triangles) override;

private:
  std::vector<double> Xyz, Parameters;
  std::vector<float> Directions;
  std::vector<std::int64_t> Indices, Owners;
};

/// What a point is in its face.
struct PointUse
{
  std::int32_t Face = -1;  ///< -1: the place is free.
  std::int32_t Patch = -1; ///< A vertex of the grid: its patch; -1: a vertex of a loop.
  std::int32_t Index = -1; ///< In the patch, or among the face's loop vertices.
  std::int32_t Uses = 0;   ///< How many cells have it as a corner.
};

/// What a triangle belongs to: a cell of a face, or (-1) the zone along its loops.
struct TriangleOwner
{
  std::int32_t Face = -1;
  std::int32_t Cell = -1;
};

/// Places of points and triangles. Not for several threads.
class MeshSlots
{
public:
  /// @param heads where an owner keeps its first triangle (-1: none): lists go on from there.
  MeshSlots(MeshArrays& arrays, std::function<std::int32_t&(const TriangleOwner&)> heads);

  /// Returns its place; Points and Normals of it are the caller's to fill.
  std::int32_t AddPoint(const PointUse& use, const Vec2& uv);
  /// Its place is free.
  void RemovePoint(std::int32_t point);
  /// Three points, counter-clockwise from outside.
  void AddTriangle(const TriangleOwner& owner, std::int32_t a, std::int32_t b, std::int32_t c);
  /// Removes all triangles of an owner.
  void RemoveTriangles(const TriangleOwner& owner);

  /// To be called once a frame, when all is added and removed: no triangle's place stays free.
  void FillGaps();
  /// Places of points that nothing uses take the position of one in use.
  void HideGaps();
  /// True if so many places of points are free that they should be numbered anew.
  bool IsSparse() const;
  /// Numbers the points anew, without gaps. Returns the new number of each; -1: it was not in use.
  std::vector<std::int32_t> Compact();

  /// What a point is.
  PointUse& Use(std::int32_t point) { return this->Uses[point]; }
  /// Likewise.
  const PointUse& Use(std::int32_t point) const { return this->Uses[point]; }
  /// Number of triangles.
  std::int64_t Triangles() const
  {
    return this->TriangleEnd - std::int64_t(this->FreeTriangles.size());
  }
  /// The arrays given.
  MeshArrays& Arrays() { return this->Data; }
  /// Likewise.
  const MeshArrays& Arrays() const { return this->Data; }
  /// A point's position.
  Eigen::Map<Vec3> Point(std::int32_t point)
  {
    return Eigen::Map<Vec3>(this->Data.Points + 3 * std::int64_t(point));
  }
  /// A point's parameters.
  Vec2 UV(std::int32_t point) const
  {
    return Eigen::Map<const Vec2>(this->Data.UV + 2 * std::int64_t(point));
  }

  /// What changed since the last call of ClearChanges.
  struct Changes
  {
    bool Topology = false;                  ///< Triangles, or the number of points.
    std::int64_t FirstTriangle = -1;        ///< Of those that changed; -1: none.
    std::int64_t LastTriangle = -1;         ///< Inclusive.
    std::int64_t Inserted = 0, Deleted = 0; ///< Points.
    bool Renumbered = false;                ///< All points have other numbers.
    std::vector<std::int32_t> Added;        ///< Points, some of which may be gone again.
  };
  /// What changed.
  const Changes& GetChanges() const { return this->Changed; }
  /// Forgets what changed.
  void ClearChanges() { this->Changed = Changes(); }

private:
  void Touch(std::int64_t triangle);
  void Link(std::int32_t triangle, const TriangleOwner& owner);
  void Unlink(std::int32_t triangle);
  void Reserve(std::int64_t points, std::int64_t triangles);
  void Fit(std::int64_t points);

  static constexpr std::int64_t SmallestStep = 512;

  MeshArrays& Data;
  std::function<std::int32_t&(const TriangleOwner&)> Head;
  std::vector<PointUse> Uses;
  std::vector<std::int32_t> FreePoints;
  std::vector<TriangleOwner> Owners;
  std::vector<std::int32_t> Next, Previous; ///< Triangle of the same owner; -1: none.
  std::vector<std::int32_t> FreeTriangles;
  std::int64_t Step = SmallestStep;
  std::int64_t TriangleEnd = 0; ///< Of places that were ever taken and not given back.
  Changes Changed;
};

} // namespace nurbs
