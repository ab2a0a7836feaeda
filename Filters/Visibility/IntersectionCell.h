// SPDX-License-Identifier: BSD-3-Clause
/// @file IntersectionCell.h
/// @brief Parts of Bezier patches and curves with what refutes that two of them meet.
///
/// Hulls of control points separated by a plane do not meet. Two patches none of whose normals are
/// parallel meet in no closed curve (Sinha, Klassen, Wang, "Exploiting topological and geometric
/// properties for selective subdivision", 1985), which cones of normals tell (Sederberg, Meyers,
/// "Loop detection in surface patch intersections", 1988).
#pragma once

#include "Surface.h"

#include <array>
#include <memory>
#include <optional>

namespace nurbs
{

/// Directions within Angle of a unit vector; Angle >= 4: not known.
struct DirectionCone
{
  Vec3 Axis = Vec3::Zero();
  double Angle = 4.0;
  bool IsKnown() const { return this->Angle < 1.5; }
};

/// A part of a curve.
struct IntersectionArc
{
  std::vector<Vec4> Points; ///< Homogeneous Bezier points.
  Interval Range;           ///< Of the parameter that it has on its patch.
  std::vector<Vec3> Hull;   ///< Cartesian.
  Box3 Box;
  DirectionCone Tangents;
  double Size = 0.0; ///< Length of the control polygon.

  IntersectionArc() = default;
  IntersectionArc(std::vector<Vec4> points, const Interval& range);
  Vec3 At(double t) const; ///< 0 <= t <= 1.
  std::array<IntersectionArc, 2> Halves() const;
};

/// A part of a patch.
struct IntersectionCell
{
  BezierPatch Patch; ///< U and V: the part of the face's domain.
  std::vector<Vec3> Hull;
  Box3 Box;
  double Size[2] = { 0.0, 0.0 }; ///< Length of the longest row of control points in u and v.
  /// Unit vectors along which the cell is likely to be separated from a neighbour: first the
  /// normal, then those of planes through its sides.
  std::array<Vec3, 5> Axes;
  std::array<Interval, 5> Extents; ///< Of the hull along them.
  /// What is left by trimming: -1: not looked at, else 1 if there may be something.
  int Cover = -1;
  /// Sides (direction, end) beyond which the face does not go on.
  bool IsOuter[2][2] = { { false, false }, { false, false } };
  std::unique_ptr<std::array<IntersectionCell, 2>> Halves;

  IntersectionCell() = default;
  explicit IntersectionCell(BezierPatch patch);
  double LargestSize() const { return std::max(this->Size[0], this->Size[1]); }
  /// What holds the normals; made at the first call.
  const DirectionCone& GetNormals();
  /// Halves along the longer direction, made at the first call.
  std::array<IntersectionCell, 2>& Split();
  /// The side in direction dir (0: where u, 1: where v is constant), at end 0 or 1.
  IntersectionArc Side(int dir, int end) const;

private:
  std::optional<DirectionCone> Normals;
};

/// How two cells lie to each other.
enum class CellMeeting
{
  /// A plane separates them, but for `tolerance`, and if they touch, one of them ends there.
  Apart,
  /// The same, but where they touch, one has a side that it goes on beyond in another cell.
  Touching,
  Unknown
};
CellMeeting Meet(const IntersectionCell& a, const IntersectionCell& b, double tolerance);

/// True if the arc and the cell have no common point, for sure.
bool AreApart(const IntersectionArc& arc, const IntersectionCell& cell);

/// True if no normal of one is parallel to one of the other.
bool AreTransversal(IntersectionCell& a, IntersectionCell& b);

/// True if the arc crosses the cell once at most, at angles that Newton's method is safe with.
bool IsTransversal(const IntersectionArc& arc, IntersectionCell& cell);

} // namespace nurbs
