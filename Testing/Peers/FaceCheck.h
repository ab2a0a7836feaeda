// SPDX-License-Identifier: BSD-3-Clause
/// @file FaceCheck.h
/// @brief Measures the mesh of one face against the face itself, by dense sampling.
#pragma once

#include "FaceMesh.h"

#include <TopoDS_Face.hxx>

namespace verify
{

struct CheckOptions
{
  double Tolerance = 0.0; ///< Absolute; errors below it need no second look.
  double Density = 1.0;   ///< Factor on the number of samples.
};

/// Lengths and areas in the model's unit. Distances are attained by actual pairs of points, hence
/// upper bounds of the true ones at the samples; the largest ones are confirmed by a global search.
struct FaceReport
{
  long Triangles = 0;
  bool Missing = false;     ///< The face has an area, its mesh has no triangle.
  bool BrokenWires = false; ///< Pcurves do not join; OpenCASCADE's classifier was used.
  double MeshToFace = 0.0;  ///< Largest distance of a mesh point from the trimmed face.
  double FaceToMesh = 0.0;  ///< Largest distance of a point of the trimmed face from its mesh.
  Vec3 WorstOnMesh = Vec3::Zero(), WorstOnFace = Vec3::Zero();
  double MeshArea = 0.0, ExactArea = 0.0;
  /// Length of the boundary plus the integral of the principal curvatures' magnitudes: times the
  /// tolerance it is what an inscribed mesh may lose or gain in area.
  double AreaSpread = 0.0;
  long Folded = 0;     ///< Triangles that look against the face's outer normal.
  long Degenerate = 0; ///< Triangles without an area to speak of.
  long Samples = 0;

  double Error() const { return std::max(this->MeshToFace, this->FaceToMesh); }
  /// Whether the areas differ no more than a mesh within @a distance of the face may.
  bool AreaAgrees(double distance) const
  {
    return std::abs(this->MeshArea - this->ExactArea) <=
      1e-4 * this->ExactArea + distance * this->AreaSpread;
  }
};

FaceReport CheckFace(const TopoDS_Face& face, const FaceMesh& mesh, const CheckOptions& options);

} // namespace verify
