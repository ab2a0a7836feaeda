// SPDX-License-Identifier: BSD-3-Clause
/// @file FaceErrors.h
/// @brief Errors of a face's triangles, by FacetBound.h.
#pragma once

#include "FaceLoops.h"
#include "FacetBound.h"

namespace nurbs
{

/// The vertices and triangles of a face with their error bounds.
class FaceErrors : public FaceLoops
{
protected:
  using FaceLoops::FaceLoops;

  /// Largest error that lets a triangle pass. Where the model's own gap leaves little of the
  /// tolerance smaller triangles can't make up for it.
  double Limit(const int* t) const;
  /// True if two corners are one point (at a pole): no triangle comes out.
  bool IsCollapsed(const int* t) const;
  /// Bound (or estimate) of the surface's distance from a triangle; exact only up to its Limit.
  double TriangleError(FacetBound& bound, const int* t) const;
  /// How far side i of a triangle (from corner i to i + 1) is over MaximumEdgeLength, or the angle of
  /// the normals at its ends over MaximumAngle: the larger quotient, at most 1 if all is well. Normals
  /// at creases are those of the triangle's side; small triangles' count as equal.
  double SideExcess(const int* t, int i) const;
  bool HasLimits() const;
  /// True if a side is over the limits and the triangle comes out.
  bool ExceedsLimits(const int* t) const;
  /// Too small to gain from a split: the tolerance, or the gap of its boundary vertices, is as large.
  bool IsTiny(const int* t) const;
  /// True if a corner is as far from the surface as the triangle is high: it can look anywhere.
  bool IsGap(const int* t) const;
  /// True if a triangle larger than the tolerance looks against the surface at all its corners.
  bool LooksBack(const int* t) const;
  /// True if the surface's normals at all corners are against n.
  bool IsFolded(const int* t, const Vec3& n) const;
  ParameterBox BoxOf(const int* t) const;
  /// The longest side.
  double Longest(const int* t) const;
  /// True if the boundary runs from vertex a straight to vertex b.
  bool IsSegment(int a, int b) const { return a < this->BoundaryCount && this->Next[a] == b; }

  std::vector<const BoundaryVertex*> Segments; ///< The segment that starts at each boundary vertex.
  std::vector<int> Next;                       ///< The boundary vertex after each,
  std::vector<int> Previous;                   ///< and before.
  int BoundaryCount = 0;
  std::vector<double> Gaps; ///< Distance of each boundary vertex from the surface at its (u, v).

private:
  double GapOf(const int* t) const;
  Vec3 NormalInside(const int* t, int i) const;
  int PoleDirection(int vertex) const;
};

} // namespace nurbs
