// SPDX-License-Identifier: BSD-3-Clause
/// @file Basis.h
/// @brief B-spline basis functions and their derivatives by the Cox-de Boor recursion.
#pragma once

#include "KnotVector.h"

namespace nurbs
{

/// The degree + 1 basis functions N[0..degree] that do not vanish on `span` (see FindSpan), at t.
void EvaluateBasis(KnotView knots, int degree, int span, double t, double* N);

/// Basis functions and derivatives to `order`: `ders[k * (degree + 1) + j]` is the k-th derivative
/// of the j-th function that does not vanish on `span`. Derivatives over the degree are zero.
void EvaluateBasisDerivatives(
  KnotView knots, int degree, int span, double t, int order, double* ders);

} // namespace nurbs
