// SPDX-License-Identifier: BSD-3-Clause
/// @file OcctHiddenLines.h
/// @brief OpenCASCADE's two removers of hidden lines, for comparison.
#pragma once

#include <Eigen/Core>
#include <TopoDS_Shape.hxx>

#include <vector>

namespace verify
{

/// A piece of an edge or outline, in the model's coordinates.
struct HiddenLine
{
  std::vector<Eigen::Vector3d> Points;
  bool Visible = true;
  int Kind = 0; ///< As vtkNURBSVisibleRegions: 0 outline, 2 sharp edge (those of one face, too).
};

/// HLRBRep_Algo, exact, parallel projection. Outlines and sharp edges, without smooth and seam ones.
/// @param view from the model to the viewer.
/// @param chord largest distance of the polylines from the curves.
std::vector<HiddenLine> HideExactly(
  const TopoDS_Shape& root, const Eigen::Vector3d& view, double chord);

/// HLRBRep_PolyAlgo on the triangles that `root` has; lines as above.
std::vector<HiddenLine> HideByPolygons(const TopoDS_Shape& root, const Eigen::Vector3d& view);

} // namespace verify
