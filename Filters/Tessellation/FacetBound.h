// SPDX-License-Identifier: BSD-3-Clause
/// @file FacetBound.h
/// @brief Bound of the distance between a surface and one triangle inscribed in it.
///
/// The surface lies at most h above the triangle's plane (SurfaceBound.h). Sliding of parameters
/// along an edge or inside the triangle is no error; only what leaves the triangle through an edge
/// counts: with m the edge's outward normal in the plane, m . (S - x) vanishes at both ends of the
/// edge, so the foot of a surface point leaves by at most the transversal bow r of the edge. There
/// the neighbour goes on with a slope against this facet: distance <= h + r * slope.
#pragma once

#include "SurfaceBound.h"

namespace nurbs
{

/// Height h over a facet and sliding d out of it as one distance: sqrt(h^2 + d^2), or h + d slope if
/// the mesh goes on around the facet with a slope of at most `slope` (< 1/2) against it.
double SurfaceDistance(double height, double sliding, double slope);

/// Collects the bounds of all boxes that a triangle touches.
class FacetBound
{
public:
  /// @param x corners on the surface; @param uv their parameters.
  FacetBound(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec2& uv0, const Vec2& uv1,
    const Vec2& uv2);

  /// Says that corner k is a pole: all parameters of its side are that point, so the triangle stands
  /// for the whole parameter box between the other two corners and the side.
  void SetPole(int k);

  /// Says that the triangle is one of the two halves of a parameter box whose fourth corner is x:
  /// the exact twist replaces the bound of the mixed derivative (Balazs section 5.2, scalar form).
  void SetFourthCorner(const Vec3& x, double weight);

  /// False if the triangle has no plane (an edge or altitude vanishes).
  bool HasPlane() const { return this->Plane; }
  const Vec3& Normal() const { return this->N; }
  int LongestEdge() const;
  double AltitudeOver(int i) const { return this->Altitude[i]; }

  /// Adds a box's bounds; the triangle must lie inside the union of all boxes added.
  ///
  /// A box of width w much narrower than the triangle's extent b (a sliver of a knot span, say) holds
  /// at most 2 w / |dv| of the weight of a mean Hessian along a segment, so its b^2 / 8 becomes
  /// b w / 2, added to what the other boxes give.
  void Add(const CurvatureRange& range, const ParameterBox& box);

  /// Adds a box's bounds of the edges' bows; needed before Sliding, SegmentDeviation, EdgeHeight.
  void AddEdges(const CurvatureRange& range, const ParameterBox& box);

  double Height() const { return (this->HeightOver + this->Twist) / this->Weight; }
  /// Bound of |S - L|: sliding in any direction.
  double Deviation() const { return this->Full; }
  /// How far surface points' feet get out of the triangle.
  double Sliding() const;
  /// Bound of the distance from the longest edge's line for a triangle that is nearly that line:
  /// sliding along it is free, any other counts, and so does the triangle's own width.
  double SegmentDeviation() const;
  /// Height over the plane along edge i (from corner i to i + 1): which edge to split.
  double EdgeHeight(int i) const { return this->Along[i] / this->Weight; }

private:
  Vec3 X[3];
  Vec3 N;
  Vec3 Out[3];         ///< In-plane outward normal of edge i.
  double Du[3], Dv[3]; ///< Parameter extent of edge i.
  double Altitude[3];  ///< Over edge i.
  double A = 0.0, B = 0.0;
  bool Plane = false;
  bool Mixed = true;
  double Twist = 0.0;
  double HeightOver = 0.0;
  double Full = 0.0;
  double Bow[3] = { 0, 0, 0 };
  double Pull[3] = { 0, 0, 0 };
  double Along[3] = { 0, 0, 0 };
  double Across[3] = { 0, 0, 0 }; ///< In-plane deviation across edge i, whole triangle.
  double Weight = 1e300;
};

} // namespace nurbs
