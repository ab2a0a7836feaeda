// SPDX-License-Identifier: BSD-3-Clause
/// @file VisibleParts.h
/// @brief Clusters of faces, and what of lines can be visible: what the planar map is spared.
///
/// The paper puts neighbours that are visible as a whole into one cluster, and tests clusters against
/// each other only (Ruan, Zhang, Yong 2006, section 4, "Cluster surfaces"). Here the edges tell: where
/// both faces of an edge face the viewer, no silhouette meets it and the two lie on either side of it
/// in the image, nothing is hidden by it. Such edges are inner lines of a cluster. A map of all other
/// lines is made first; inner lines are cut by it alone, not by each other, and only the parts of lines
/// that are not surely hidden come into the map that regions are made of.
#pragma once

#include "FrontMap.h"

namespace nurbs
{

struct FaceClusters
{
  std::vector<char> IsInner;         ///< One a line: it is an inner line of a cluster.
  std::vector<std::int64_t> Cluster; ///< One a face: the lowest face of its cluster.
};

FaceClusters FindClusters(const ViewLines& lines, const Viewer& viewer);

/// The parts of lines that are not surely hidden, by line and in order, for MakeFrontMap. Empty if
/// `progress` says no.
std::vector<LinePart> FindVisibleParts(const ViewLines& lines, const FaceClusters& clusters,
  const ImagePlane& image, const RayCaster& caster, double pixel, const ParallelFor& parallel,
  const std::function<bool(double)>& progress);

} // namespace nurbs
