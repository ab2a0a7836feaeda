// SPDX-License-Identifier: BSD-3-Clause
/// @file NetRefinement.h
/// @brief Many knots at once by the Oslo algorithm, for the methods that DeformationRivals.h compares.
#pragma once

#include "Surface.h"

namespace nurbs
{

/// The matrix of one direction's refinement: rows of `degree` + 1 discrete B-splines.
struct Refinement
{
  std::vector<double> Knots;        ///< The finer knot vector.
  std::vector<int> First;           ///< Finer point j is the sum over coarse points First[j], ...
  std::vector<double> Coefficients; ///< of these, degree + 1 for each j.
  int Count() const { return static_cast<int>(this->First.size()); }
};

/// Discrete B-splines of `coarse` over `coarse` and `add` by their recursion in the order (Cohen,
/// Lyche, Riesenfeld 1980, Oslo algorithm 1). `add` need not be sorted, and lies inside the domain.
/// @param coarse clamped, interior multiplicity <= degree.
Refinement Refine(KnotView coarse, int degree, const std::vector<double>& add);

/// What raises each of `values` (sorted) to `multiplicity` in `knots`.
std::vector<double> MissingKnots(
  KnotView knots, const std::vector<double>& values, int multiplicity);

/// A control net: Cartesian (3 numbers a point) or homogeneous (4), u fastest.
struct ControlNet
{
  int Dimension = 3;
  int Count[2] = { 0, 0 };
  std::vector<double> Values;
};

/// Homogeneous if the surface has weights.
ControlNet NetOf(const Surface& surface);

/// The net over the finer knots: rows in u first, then whole rows are combined. `rows` is scratch
/// space, which like `fine` keeps its memory from call to call.
void RefineNet(
  const ControlNet& net, const Refinement (&refinements)[2], ControlNet& rows, ControlNet& fine);

} // namespace nurbs
