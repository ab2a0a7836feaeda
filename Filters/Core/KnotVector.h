// SPDX-License-Identifier: BSD-3-Clause
/// @file KnotVector.h
/// @brief Knot vectors: spans, multiplicities, continuity, and what is wrong with a bad one.
///
/// A knot vector of degree p over n control points has n + p + 1 non-decreasing values. Its domain is
/// [knots[p], knots[n]]; unclamped (periodic) vectors are allowed everywhere.
#pragma once

#include "Types.h"

namespace nurbs
{

/// A distinct knot value and how often it occurs in the whole vector.
struct Knot
{
  double Value;
  int Multiplicity;
};

/// The reason why `knots` is not a valid knot vector of `degree` over `count` points, or "" if it
/// is: wrong size, NaN or infinite, decreasing, a step under 1e-100 that is not 0, empty domain,
/// interior multiplicity over degree + 1.
std::string CheckKnots(KnotView knots, int degree, std::int64_t count);

/// The parameter domain [knots[degree], knots[size - degree - 1]].
Interval Domain(KnotView knots, int degree);

/// The span k, degree <= k < count, with knots[k] <= t < knots[k+1] (at the domain's end: the last
/// span that is not empty). Parameters outside the domain are clamped to its first or last span.
int FindSpan(KnotView knots, int degree, double t);

/// FindSpan that tries span `hint` and its successor first (coherent evaluation, Balazs section 8).
int FindSpan(KnotView knots, int degree, double t, int hint);

/// The distinct knots inside the closed domain, in order, with their multiplicity.
std::vector<Knot> DistinctKnots(KnotView knots, int degree);

/// The interior knots where the curve may be only C0 or broken (multiplicity >= degree).
std::vector<double> CreaseKnots(KnotView knots, int degree);

/// The Greville abscissae, one a control point: the mean of `degree` consecutive knots.
std::vector<double> GrevilleAbscissae(KnotView knots, int degree);

/// True if the knot vector is clamped (degree + 1 equal knots) at both ends.
bool IsClamped(KnotView knots, int degree);

/// A clamped knot vector over [0, 1] with uniform interior knots for `count` points.
std::vector<double> UniformKnots(int degree, int count);

} // namespace nurbs
