// SPDX-License-Identifier: BSD-3-Clause
/// @file TrimCurveMethods.h
/// @brief Table 2 of Balazs, Guthe, Klein 2004: what turns trim curves into polylines, and its cost.
#pragma once

#include "Model.h"

namespace nurbs
{

/// One method, over all trim curves of a model.
struct CurveMethodFigures
{
  std::string Method;         ///< "2D", "midpoint point", ..., "balanced".
  double Conversion = 0.0;    ///< Processor seconds to Bezier form.
  double Approximation = 0.0; ///< Processor seconds to polylines.
  std::int64_t Edges = 0;     ///< Segments of the polylines.
};

struct CurveMethodTable
{
  std::vector<CurveMethodFigures> Methods;
  std::int64_t Curves = 0; ///< Trim curves; poles are left out.
  std::int64_t Failed = 0; ///< Those that cannot be lifted, and do not count.
};

/// Measures every method on each face's own trim curves (natural boundaries included), one by one, in
/// one thread. As in the paper, nothing is shared between faces here.
///
/// "2D" stands for the method of Kahlesz, Balazs, Klein 2002 that the paper compares with: Bezier
/// pieces are halved in the parameter domain until partial errors sum up to the tolerance, that of
/// the piece against its chord, which the surface's first derivatives stretch, and that of the
/// surface along the chord, by its second derivatives. Their greatest lengths are sampled in the
/// piece's box.
/// @param tolerance model units, > 0.
CurveMethodTable CompareCurveMethods(
  const Model& model, const std::vector<std::string>& faceErrors, double tolerance);

} // namespace nurbs
