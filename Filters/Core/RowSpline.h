// SPDX-License-Identifier: BSD-3-Clause
/// @file RowSpline.h
/// @brief Knot insertion, clamping, degree elevation and reduction for curves and surfaces alike.
///
/// These operations act on one parameter direction and are linear in the control points. A curve in
/// d dimensions and a surface seen along one direction are therefore the same thing: a B-spline whose
/// coefficients are rows of numbers (one homogeneous point, or a whole line of the control net).
/// Every step forms convex combinations of rows only, so it is stable at every degree. The one
/// exception is ReduceRowDegree, a well-conditioned least-squares problem.
#pragma once

#include "KnotVector.h"

namespace nurbs
{

/// A B-spline with rows of `Width` numbers as coefficients.
struct RowSpline
{
  int Degree = 1;            ///< 0 to MaxDegree.
  int Width = 1;             ///< Numbers a row.
  std::vector<double> Knots; ///< Count() + Degree + 1 values.
  std::vector<double> Rows;  ///< Count() x Width.

  /// Number of rows.
  std::int64_t Count() const
  {
    return static_cast<std::int64_t>(this->Knots.size()) - this->Degree - 1;
  }
  /// The Width numbers of a row.
  double* Row(std::int64_t i) { return this->Rows.data() + i * this->Width; }
  /// Likewise.
  const double* Row(std::int64_t i) const { return this->Rows.data() + i * this->Width; }
};

/// Inserts the sorted knots `add` (Boehm, "Inserting new knots into B-spline curves", 1980). Throws
/// Error if one lies outside the domain, the list is not sorted, or a multiplicity would exceed
/// degree + 1.
void InsertKnots(RowSpline& spline, ArrayView<double> add);

/// The part over [t0, t1] of the domain, clamped at both ends. An end within round-off of a knot
/// means that knot. Throws Error if the interval is empty or leaves the domain.
RowSpline ClampRows(const RowSpline& spline, double t0, double t1);

/// Raises the degree by one: the mean of degree + 1 refinements (Prautzsch, "Degree elevation of
/// B-spline curves", 1984). A spline that is not clamped is clamped first. Throws Error over
/// MaxDegree.
void ElevateRows(RowSpline& spline);

/// Lowers the degree by one in the least-squares sense; every knot loses one multiplicity, so a
/// spline that has been elevated comes back. Receives the result and returns false if the degree is
/// already 1 or 0. The caller decides by `residual` (elevation of the result minus the spline, one
/// row a control point of the clamped spline) whether the result is good enough.
bool ReduceRowDegree(const RowSpline& spline, RowSpline& reduced, std::vector<double>& residual);

/// A spline refined until every span of the domain that is not empty has its Bezier coefficients as
/// degree + 1 consecutive rows.
struct BezierForm
{
  RowSpline Refined;
  std::vector<double> Breaks;      ///< The distinct knots of the domain, one more than spans.
  std::vector<std::int64_t> First; ///< The span's first row; neighbours may share a row.
};

/// The Bezier form of all spans, by knot insertion.
BezierForm ToBezierForm(const RowSpline& spline);

} // namespace nurbs
