// SPDX-License-Identifier: BSD-3-Clause
/// @file SplineData.h
/// @brief Knots and poles of OpenCASCADE's splines as our flat, non-periodic knot vectors.
#pragma once

#include "Types.h"

#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>

#include <algorithm>
#include <cmath>
#include <vector>

namespace nurbs
{

/// A flat knot vector and, for each control point of the result, the pole (0-based) it is.
struct FlatKnots
{
  std::vector<double> Knots;
  std::vector<int> Poles;
};

/// Flat knots of a non-periodic spline.
inline FlatKnots Flatten(
  const TColStd_Array1OfReal& knots, const TColStd_Array1OfInteger& multiplicities, int poles)
{
  FlatKnots flat;
  for (int i = knots.Lower(); i <= knots.Upper(); ++i)
  {
    flat.Knots.insert(flat.Knots.end(), multiplicities(i), knots(i));
  }
  for (int i = 0; i < poles; ++i)
  {
    flat.Poles.push_back(i);
  }
  return flat;
}

/// Flat, unclamped knots of a periodic spline unrolled so that its domain covers [t0, t1], which may
/// lie anywhere and be longer than a period. OpenCASCADE's first pole belongs to the basis function
/// whose knots begin degree + 1 - m places before those of the domain's start, of multiplicity m.
inline FlatKnots Unroll(const TColStd_Array1OfReal& knots,
  const TColStd_Array1OfInteger& multiplicities, int degree, double t0, double t1)
{
  std::vector<double> period; // one period of flat knots, the end excluded
  for (int i = knots.Lower(); i < knots.Upper(); ++i)
  {
    period.insert(period.end(), multiplicities(i), knots(i));
  }
  const double length = knots(knots.Upper()) - knots(knots.Lower());
  const std::int64_t n = static_cast<std::int64_t>(period.size());
  const int first = multiplicities(multiplicities.Lower());
  auto wrap = [n](std::int64_t i) { return ((i % n) + n) % n; };
  auto knot = [&](std::int64_t i) {
    return period[static_cast<std::size_t>(wrap(i))] + double((i - wrap(i)) / n) * length;
  };

  std::int64_t low = static_cast<std::int64_t>(std::floor((t0 - period[0]) / length)) * n;
  while (knot(low + 1) <= t0)
  {
    ++low;
  }
  std::int64_t high = low + 1;
  while (knot(high) < t1)
  {
    ++high;
  }
  FlatKnots flat;
  for (std::int64_t i = low - degree; i <= high + degree; ++i)
  {
    flat.Knots.push_back(knot(i));
  }
  for (std::int64_t i = low - degree; i < high; ++i)
  {
    flat.Poles.push_back(static_cast<int>(wrap(i + degree + 1 - first)));
  }
  return flat;
}

} // namespace nurbs
