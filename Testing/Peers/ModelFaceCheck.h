// SPDX-License-Identifier: BSD-3-Clause
/// @file ModelFaceCheck.h
/// @brief A face of our model against a face of OpenCASCADE: surface, loops, edges, orientation.
#pragma once

#include "Model.h"

#include <TopoDS_Face.hxx>

namespace verify
{

/// How our face differs from an OpenCASCADE face. Lengths.
struct ModelFaceReport
{
  bool Seen = false, Inverted = false;
  double Surface = 0.0;  ///< Points of our trimmed surface from the trimmed face.
  double Loops = 0.0;    ///< Points of our lifted trim curves from its boundary.
  double Boundary = 0.0; ///< Points of its boundary from our lifted trim curves.
  double Edges = 0.0;    ///< Our lifted trim curves from our edges, at equal parameters.
  double Excess = 0.0;   ///< By how much that exceeds the edges' stated tolerances.
  double LoopGap = 0.0;  ///< Between the ends of consecutive lifted trim curves.
  double Area = 0.0;     ///< Signed area of the loops in (u, v): must be positive.
};

/// @param scale the diagonal of the shape, in the unit of both.
ModelFaceReport CheckModelFace(
  const TopoDS_Face& face, const nurbs::Model& model, std::size_t index, double scale);

} // namespace verify
