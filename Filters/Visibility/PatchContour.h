// SPDX-License-Identifier: BSD-3-Clause
/// @file PatchContour.h
/// @brief Every component of the contour of one Bezier patch, by subdivision and tracing.
///
/// The paper finds where a contour meets the patch's four sides, sorts the ways it can run into 16
/// cases and leaves closed contours out (Ruan, Zhang, Yong 2006, figure 3 and table 1). Here the
/// patch is divided until the coefficients of each cell's polynomial g have one sign (no contour), or
/// those of g_u or g_v have: then no contour is closed in the cell, each value of the other parameter
/// has one point of it at most, and the roots of g on the cell's sides tell all its branches. g is
/// looked at where it passes through minus its rounding error, which makes every position general;
/// the points are then moved to g = 0.
#pragma once

#include "ContourForm.h"

#include <algorithm>
#include <map>
#include <memory>

namespace nurbs
{

/// A point of a contour.
struct ContourPoint
{
  Vec2 UV = Vec2::Zero(); ///< In the face's parameters.
  Vec3 Point = Vec3::Zero();
  double Cosine = 0.0; ///< normal . view there, of unit vectors; 0 at a pole.
};

/// |normal . view| up to which a point belongs to the contour.
inline constexpr double ContourCosine = 1e-9;

/// Where the contour crosses a line of constant u or v of one patch.
struct ContourLine
{
  std::vector<double> At; ///< The patch's own parameter along the line, increasing.
  std::vector<int> Node;  ///< Index into ContourNodes, -1: not used so far.
};

/// What runs where: along a side of patches, or across them.
enum class ContourArcKind
{
  Inner = 0, ///< normal . view = 0 within a patch.
  Crease,    ///< Along a knot line: its two sides face different ways.
  Border     ///< Along the border of the surface's domain, where normal . view = 0.
};

/// A directed part of a contour between two nodes; the front (S_u x S_v faces the viewer) lies on its
/// left in the (u, v) plane.
struct ContourArc
{
  ContourArcKind Kind = ContourArcKind::Inner;
  int Start = -1, End = -1; ///< Nodes.
  std::vector<ContourPoint> Inner;
};

/// How closely a contour is followed.
struct ContourLimits
{
  double Precision = 1e-4;  ///< Largest distance of chord and contour, a length.
  double Smallest = 1e-6;   ///< Size of the cells where a contour may be singular, a length.
  int MaximumCells = 20000; ///< A patch's.
};

/// One patch on its way: what FaceContour hands to TracePatch.
struct PatchContour
{
  const BezierPatch* Patch = nullptr;
  BernsteinForm G;    ///< Without the factors of the sides.
  double Scale = 0.0; ///< Of G; see ContourForm.
  double Rounding = 0.0;
  bool EdgeOn = false; ///< G vanishes.
  /// Sides (direction, end) on which g vanishes: a pole, or the contour runs along it.
  bool IsPole[2][2] = { { false, false }, { false, false } };
  bool IsZero[2][2] = { { false, false }, { false, false } };
  std::shared_ptr<ContourLine> Sides[2][2]; ///< Null: not sought so far.

  bool HasFront = false, HasBack = false; ///< What was found.
  /// Of the smallest size: a node, a cusp of the surface, a tiny loop; and arcs given up, as
  /// normal . view comes near 0 there only.
  int SingularCells = 0;
  int UnresolvedCells = 0;            ///< Left when MaximumCells was reached.
  std::vector<ContourPoint> Singular; ///< The middles of the first of either.
};

/// Share of g's scale up to which a patch counts as edge-on, and g as 0 along a side.
inline constexpr double ContourZero = 1e-11;

/// Finds the contour of a patch; appends to `nodes` and `arcs`. Lines that the patch has been given
/// are shared with its neighbours, so that arcs meet in the same nodes.
void TracePatch(PatchContour& patch, const Viewer& viewer, const ContourLimits& limits,
  std::vector<ContourPoint>& nodes, std::vector<ContourArc>& arcs);

/// The sign changes of the patch's G on a side, sought at the first call.
ContourLine& SideLine(PatchContour& patch, int dir, int end);
/// Node of the k-th crossing of a line, made at the first call.
int LineNode(const PatchContour& patch, const Viewer& viewer, ContourLine& line, int dir, double at,
  std::size_t k, std::vector<ContourPoint>& nodes);

/// Adds points between `a` and `b`, till chords are within `precision`. `at(t)` is the point at
/// 0 < t < 1 on the way from a to b, a ContourPoint or
/// derived from it.
template <typename At, typename P>
void RefineChord(const At& at, double precision, double ta, const P& a, double tb, const P& b,
  int depth, std::vector<P>& out);

/// Distance of p from the segment from a to b.
double DistanceToSegment(const Vec3& p, const Vec3& a, const Vec3& b);

template <typename At, typename P>
void RefineChord(const At& at, double precision, double ta, const P& a, double tb, const P& b,
  int depth, std::vector<P>& out)
{
  if (depth == 0)
  {
    return;
  }
  // Chords are kept to less than the precision, so that what lies between the samples is within it;
  // a curve that turns between two of them shows by their distance.
  constexpr double Share = 0.9;
  constexpr double LargestGap = 0.6;
  const double tm = 0.5 * (ta + tb);
  const P middle = at(tm);
  if (DistanceToSegment(middle.Point, a.Point, b.Point) <= Share * precision)
  {
    const Vec3 first = at(0.5 * (ta + tm)).Point;
    const Vec3 last = at(0.5 * (tm + tb)).Point;
    const double gaps[4] = { (first - a.Point).norm(), (middle.Point - first).norm(),
      (last - middle.Point).norm(), (b.Point - last).norm() };
    const double sum = gaps[0] + gaps[1] + gaps[2] + gaps[3];
    const double gap = std::max(std::max(gaps[0], gaps[1]), std::max(gaps[2], gaps[3]));
    if (DistanceToSegment(first, a.Point, b.Point) <= Share * precision &&
      DistanceToSegment(last, a.Point, b.Point) <= Share * precision &&
      (gap <= LargestGap * sum || sum <= precision))
    {
      return;
    }
  }
  RefineChord(at, precision, ta, a, tm, middle, depth - 1, out);
  out.push_back(middle);
  RefineChord(at, precision, tm, middle, tb, b, depth - 1, out);
}

} // namespace nurbs
