// SPDX-License-Identifier: BSD-3-Clause
/// @file CurveCopy.h
/// @brief Curves that are owned, of views of them.
#pragma once

#include "Curve.h"

namespace nurbs
{

/// A packed copy.
template <int D>
Curve<D> Copy(const CurveView<D>& view)
{
  Curve<D> curve;
  curve.Degree = view.Degree;
  curve.Knots.assign(view.Knots.begin(), view.Knots.end());
  for (int i = 0; i < view.Count; ++i)
  {
    curve.Points.push_back(view.Point(i));
    curve.Weights.push_back(view.Weight(i));
  }
  curve.Pack();
  return curve;
}

} // namespace nurbs
