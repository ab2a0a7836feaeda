// SPDX-License-Identifier: BSD-3-Clause
/// @file FreeFormLattice.h
/// @brief Free-form deformation: a lattice of control points bends the space in a box.
///
/// Source: T. W. Sederberg, S. R. Parry, "Free-form deformation of solid geometric models",
/// SIGGRAPH 1986. A point X of the box has local coordinates (s, t, u), 0 to 1 along the box's
/// axes. It moves to sum_ijk N_i(s) N_j(t) N_k(u) P_ijk, the trivariate tensor product of the
/// lattice's control points. What differs from the paper:
///
/// - The functions are B-splines over uniform clamped knots. They are the paper's Bernstein
///   polynomials where the degree is the number of control points less one; a lower degree makes a
///   control point move only what is near it.
/// - At rest, control points are at the Greville abscissae (for Bernstein polynomials: uniform, as
///   in the paper), so that the lattice at rest moves nothing. What is summed are displacements d
///   from rest: X + sum_ijk N_i(s) N_j(t) N_k(u) d_ijk. A lattice at rest leaves every bit of a
///   point as it is, and an affine map of the lattice maps points by the same affine map, to
///   round-off.
///
/// Points outside the box stay. At a side of the box only its outermost layer of control points
/// counts. If n layers next to a side rest, the deformation is C^(n-1) across it, for n up to the
/// degree p, and C^(p-1) for more. If the outermost layer moves, points in the box part from those
/// outside.
#pragma once

#include "Types.h"

#include <array>

namespace nurbs
{

/// The largest number of lattice points in one direction.
inline constexpr int MaxLatticeCount = 32;

/// The box that a lattice fills: a parallelepiped, X = Origin + Axes * (s, t, u).
struct LatticeBox
{
  Vec3 Origin = Vec3::Zero();
  Eigen::Matrix3d Axes = Eigen::Matrix3d::Identity(); ///< Columns: the edges S, T, U.

  /// The box of `bounds`, along x, y and z.
  static LatticeBox Of(const Box3& bounds);
};

/// What a batch did.
struct LatticeMoves
{
  std::int64_t Moved = 0; ///< Points that are not where they were.
  bool Changed = false;   ///< True if the batch changed any value of its target.
};

/// A lattice of L x M x N control points; index i + L (j + M k) is that of point (i, j, k).
class FreeFormLattice
{
public:
  /// A lattice at rest. `counts`: 2 to MaxLatticeCount. `degrees`: 1 to count - 1, at most
  /// MaxDegree, lowered to that; 0: min(3, count - 1). Throws Error for other numbers and for a box
  /// that is flat or not finite.
  FreeFormLattice(const LatticeBox& box, const std::array<int, 3>& counts,
    const std::array<int, 3>& degrees = { { 0, 0, 0 } });

  /// Control points along an axis.
  int Count(int axis) const { return this->Axes[axis].Count; }
  /// Degree along an axis.
  int Degree(int axis) const { return this->Axes[axis].Degree; }
  /// Number of control points.
  std::int64_t Size() const { return std::int64_t(this->Displacements.size()) / 4; }

  /// Where a control point is at rest, and its displacement from there.
  Vec3 RestPoint(std::int64_t index) const;
  /// Likewise.
  Vec3 Displacement(std::int64_t index) const;

  /// Moves all control points: Size() xyz triples. Points of the `frozen` outermost layers of every
  /// side stay at rest, whatever is given for them. Throws Error naming the first lattice point
  /// that is not finite (of all, frozen or not) and changes nothing then.
  void SetDisplacements(ArrayView<double> xyz, int frozen = 0);

  /// The local coordinates (s, t, u) of a point.
  Vec3 LocalCoordinates(const Vec3& point) const;

  /// Whether a point is in the closed box, give or take 1e-12 of its size. NaN is not.
  bool Contains(const Vec3& point) const;

  /// The place of one point.
  Vec3 Map(const Vec3& point) const;

  /// The places of `count` points (xyz triples), written to `target`, which may be `points`. Points
  /// outside the box, and those that are not finite, are copied. The result does not depend on
  /// `parallel`.
  LatticeMoves Map(const double* points, std::int64_t count, double* target,
    const ParallelFor& parallel = SerialFor) const;

private:
  friend struct LatticeKernel;

  struct Axis
  {
    int Count = 0;
    int Degree = 0;
    int Spans = 0;
    int FirstMoving = 0; ///< Spans that a moved control point reaches.
    int LastMoving = -1;
    std::vector<double> Knots;
    std::vector<double> Rest;
    std::vector<double> Inverse; ///< Degree * (Degree + 1) / 2 reciprocals of knot steps a span.
  };
  static Axis MakeAxis(int count, int degree);
  std::array<int, 3> Position(std::int64_t index) const;

  LatticeBox Box;
  Eigen::Matrix3d ToLocal;
  std::array<Axis, 3> Axes;
  std::vector<double> Displacements; ///< x, y, z, 0 a control point.
};

/// The box around those of `count` points (xyz triples) that are finite; empty if none is.
Box3 BoxOfFinitePoints(const double* points, std::int64_t count);

} // namespace nurbs
