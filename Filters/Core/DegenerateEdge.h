// SPDX-License-Identifier: BSD-3-Clause
/// @file DegenerateEdge.h
/// @brief Edges that become points. Private to this folder.
#pragma once

#include "Model.h"

namespace nurbs
{

/// Makes a pole of an edge.
inline void MakeDegenerate(Edge& edge)
{
  static const double pole[4] = { 0.0, 0.0, 0.0, 1.0 };
  static const double knots[2] = { 0.0, 1.0 };
  edge.Geometry.Degree = 0;
  edge.Geometry.Count = 1;
  edge.Geometry.Points = pole;
  edge.Geometry.Knots = KnotView(knots, 2);
}

} // namespace nurbs
