// SPDX-License-Identifier: BSD-3-Clause
/// @file FaceMesh.h
/// @brief The triangles of one face, as the checks take them, whoever made them.
#pragma once

#include <Eigen/Core>

#include <array>
#include <vector>

namespace verify
{

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;

/// A face's own triangles. Points are in the model's space and length unit.
struct FaceMesh
{
  std::vector<Vec3> Points;
  std::vector<std::array<int, 3>> Triangles; ///< Indices into Points, seen from outside CCW.
  double Certified = -1.0; ///< The bound that the mesher states for this face; < 0: none.
};

} // namespace verify
