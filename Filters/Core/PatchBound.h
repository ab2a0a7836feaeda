// SPDX-License-Identifier: BSD-3-Clause
/// @file PatchBound.h
/// @brief Intervals of the second derivatives of a row of Bezier patches.
///
/// Derivation: Documentation/Papers/balazs-2004-bound.md.
#pragma once

#include "Types.h"

namespace nurbs
{

/// Patches side by side in u, between two values of v.
struct PatchRow
{
  int P, Q;               ///< Degrees in u and v.
  bool Rational;          ///< Else all weights are 1.
  int Count;              ///< Patches.
  const double* Breaks;   ///< Count + 1 values of u.
  const int* First;       ///< First column of Rows, one a patch: it takes P + 1 of them.
  const double* Blossoms; ///< Matrices that take them to Bezier points, (P + 1)^2 numbers a patch.
  double Height;          ///< Of the patches, in v.
  int Columns;
  const Vec4* Rows; ///< Q + 1 rows of homogeneous points: B-spline in u, Bezier in v.
};

/// What holds S_uu, S_uv, S_vv (index 0, 1, 2) of a patch.
struct DerivativeIntervals
{
  Vec3 Low[3];
  Vec3 High[3];
};

/// Bounds every patch of a row, by the control points of its derivatives and, if it is rational,
/// the quotient rule in intervals. Vectorised; gives the same bits on every machine.
void BoundPatches(const PatchRow& row, DerivativeIntervals* bounds);

} // namespace nurbs
