// SPDX-License-Identifier: BSD-3-Clause
/// @file ModelExtent.h
/// @brief Where the surfaces of a model are, by samples: what relative tolerances are relative to.
#pragma once

#include "Model.h"

namespace nurbs
{

/// A box around 5 x 5 points of each face within the box of its loops (two along a direction that is
/// straight). Empty for a face with an error.
/// @param faceErrors one string a face: "" if it is usable.
std::vector<Box3> FaceBoxes(const Model& model, const std::vector<std::string>& faceErrors,
  const ParallelFor& parallel = SerialFor);

/// Length of the diagonal of the box around all boxes; 0 if there is none.
double Diagonal(const std::vector<Box3>& boxes);

} // namespace nurbs
