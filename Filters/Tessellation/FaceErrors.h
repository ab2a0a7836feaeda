// SPDX-License-Identifier: BSD-3-Clause
/// @file FaceErrors.h
/// @brief Bounds of the distance between a face's surface and its triangles.
///
/// From the cheapest bound to the dearest: what the tree's leaves know, transversal bows of the edges,
/// the triangle as a segment, and coefficients over the triangle's own parameter box.
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

  /// Largest error of a single triangle that lets the face meet its tolerance.
  double Limit() const;
  /// True if two corners are one point (at a pole): no triangle comes out.
  bool IsCollapsed(const int* t) const;
  /// Slope of the mesh around a triangle against its plane with normal n; 1 or more: too steep.
  double Slope(const int* t, const Vec3& n) const;
  /// The bounds of a triangle; `leaf`: see Leaf.
  FacetBound Facet(const int* t, int leaf) const;
  double FacetError(const int* t, int leaf, FacetBound& facet) const;
  /// Bound (or estimate) of the surface's distance from a triangle; `leaf`: see Leaf.
  double TriangleError(const int* t, int leaf) const;
  /// True if the boundary runs from vertex a straight to vertex b.
  bool IsSegment(int a, int b) const { return a < this->BoundaryCount && this->Next[a] == b; }

  /// The parameter box of a triangle.
  ParameterBox BoxOf(const int* t) const;

  static constexpr int NoLeaf = -2147483647 - 1;

  /// Calls use(range, box) for the leaves that a triangle touches.
  template <typename F>
  void ForLeaves(const int* t, int leaf, F&& use) const
  {
    const std::vector<TreeLeaf>& leaves = this->Job.Tree->Leaves();
    if (leaf != NoLeaf)
    {
      use(leaves[-1 - leaf].Range, leaves[-1 - leaf].Box);
      return;
    }
    const ParameterBox box = this->BoxOf(t);
    const double a = 1e-7 * box.A();
    const double b = 1e-7 * box.B();
    this->Job.Tree->Query({ box.U0 + a, box.U1 - a, box.V0 + b, box.V1 - b },
      [&](int k) { use(leaves[k].Range, leaves[k].Box); });
  }

  std::vector<const BoundaryVertex*> Segments; ///< The segment that starts at each boundary vertex.
  std::vector<int> Next;                       ///< The boundary vertex after each.
  int BoundaryCount = 0;
  /// Per triangle: the leaf whose own two triangles it is one of; -1 - leaf: another triangle inside
  /// that leaf; NoLeaf: anywhere.
  std::vector<int> Leaf;
  double Gap = 0.0; ///< Largest distance of boundary vertices from the surface.

private:
  bool IsPole(int vertex) const;
  double CloseError(const int* t) const;
  double SampledError(const int* t) const;
  bool CrossesCrease(const ParameterBox& box) const;
  double EdgeSliverError(const int* t, const FacetBound& facet) const;
};

} // namespace nurbs
