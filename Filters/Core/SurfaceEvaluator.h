// SPDX-License-Identifier: BSD-3-Clause
/// @file SurfaceEvaluator.h
/// @brief Fast repeated evaluation of one surface: coherent (Balazs section 8) and in batches.
#pragma once

#include "Surface.h"

#include <memory>

namespace nurbs
{

/// Evaluates one surface many times.
///
/// Keeps the homogeneous control net contiguous and the reciprocals of its knot differences, and
/// remembers what the last point needed (Balazs, Guthe, Klein 2004, section 8): with v and the span
/// of u unchanged, the inner sums of their equation (1) are reused and a point costs one curve
/// evaluation; with u unchanged, its basis functions are. Point, PointAndNormal, Batch and Grid give
/// the same bits for the same parameters, on every machine and in every order of calls; they agree
/// with nurbs::Evaluate to round-off.
///
/// One object per thread; copies are cheap and share the net. The surface's knots, points and
/// weights must outlive the evaluator. Parameters outside the domain extrapolate.
class SurfaceEvaluator
{
public:
  /// Copies the net: Count[0] x Count[1] homogeneous points.
  explicit SurfaceEvaluator(const SurfaceView& surface);

  /// Cartesian point.
  Vec3 Point(double u, double v);

  /// Point and derivatives to `order`. Throws Error unless it is 1 or 2.
  SurfaceDerivatives Derivatives(double u, double v, int order);

  /// Point and unit normal, exact at poles (see nurbs::Normal).
  void PointAndNormal(double u, double v, Vec3& point, Vec3& normal);

  /// Points and, if `normals` is not null, unit normals of `count` parameters in any order;
  /// `points` and `normals` are xyz triples. Vectorised over the net, no allocation per point.
  /// Sorted by v, then u, the parameters profit from coherence.
  void Batch(const Vec2* uv, std::int64_t count, double* points, double* normals);

  /// The grid of us.size() x vs.size() points, u fastest: one basis evaluation per row and column.
  void Grid(ArrayView<double> us, ArrayView<double> vs, double* points, double* normals);

  /// Points and derivatives to order 2 on such a grid, the same as those of Derivatives.
  void DerivativesGrid(ArrayView<double> us, ArrayView<double> vs, SurfaceDerivatives* derivatives);

  /// The surface given.
  const SurfaceView& GetSurface() const { return this->View; }

private:
  struct Tables;

  /// What the columns of a grid need of u, and the row of inner sums that all of them share. Kept
  /// for its memory only.
  struct GridPlan
  {
    int Width = 0;                ///< Numbers a column in Bases: values, then derivatives.
    int First = 0;                ///< The column of the net that is column 0 of what follows.
    std::vector<int> Starts;      ///< First column, one a u.
    std::vector<double> Bases;    ///< One u after the other.
    std::vector<char> Needed;     ///< Which columns some u needs,
    std::vector<int> Columns;     ///< and these.
    std::vector<double> Sums;     ///< 8 numbers a column: value, v derivative.
    std::vector<double> Bends;    ///< Second derivatives of the basis functions, as Bases,
    std::vector<double> BendSums; ///< and 4 numbers a column: second v derivative.
  };

  SurfaceView View;
  std::shared_ptr<const Tables> Shared;

  // What the last point left behind. NaN: nothing yet.
  double Last[2];
  int Span[2];
  double Basis[2][2][MaxDegree + 1];           ///< Direction; value or derivative; function.
  alignas(32) double Row[8 * (MaxDegree + 1)]; ///< Inner sums over v: value, v derivative a column.
  int RowStart = -1;                           ///< First column of Row; -1: none.
  GridPlan Plan;

  template <typename Quad>
  friend struct EvaluatorKernel;
};

} // namespace nurbs
