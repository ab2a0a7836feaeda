// SPDX-License-Identifier: BSD-3-Clause
/// @file Basis.h
/// @brief B-spline basis functions and their derivatives by the Cox-de Boor recursion.
///
/// Source: Piegl, Tiller, The NURBS Book (1997), section 2.5. Values are sums of non-negative terms
/// and therefore good to round-off at every degree up to MaxDegree. `span` must not be empty, see
/// FindSpan; t outside of it evaluates the polynomial piece of the span there. Nothing is checked.
#pragma once

#include "KnotVector.h"

namespace nurbs
{

/// The degree + 1 basis functions N[0..degree] that do not vanish on `span` (see FindSpan), at t:
/// N[j] belongs to control point span - degree + j.
void EvaluateBasis(KnotView knots, int degree, int span, double t, double* N);

/// Basis functions and derivatives to `order` >= 0: `ders[k * (degree + 1) + j]` is the k-th
/// derivative of the j-th function that does not vanish on `span`, (order + 1) x (degree + 1) values
/// in all. Derivatives over the degree are zero. At a knot: those of the span, i.e. from its side.
void EvaluateBasisDerivatives(
  KnotView knots, int degree, int span, double t, int order, double* ders);

/// The matrix that takes the degree + 1 control points of `span` to the Bezier points over [a, b]:
/// row i has the coefficients of the blossom at a (degree - i times) and b (i times), so that
/// m[i * (degree + 1) + x] is also the Bezier coefficient i of basis function x.
void BlossomMatrix(KnotView knots, int degree, int span, double a, double b, double* m);

} // namespace nurbs
