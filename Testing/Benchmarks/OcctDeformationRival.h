// SPDX-License-Identifier: BSD-3-Clause
/// @file OcctDeformationRival.h
/// @brief OpenCASCADE as a rival: surface, face and mesh made anew for every frame.
#pragma once

#include "DeformationRivals.h"

namespace nurbs
{

/// Geom_BSplineSurface, BRepBuilderAPI_MakeFace, BRepMesh_IncrementalMesh (one thread, its angle
/// criterion off), normals from the surface at the nodes. OpenCASCADE chooses the vertices: Prepare
/// looks for the deflection that gives about as many as the grid has, and Mesh.Parameters says where
/// they are. Prepare and Move throw Error where OpenCASCADE fails.
class OcctDeformationRival : public DeformationRival
{
public:
  const char* GetName() const override { return "OpenCASCADE"; }

  /// What Prepare found, in model units.
  double GetDeflection() const { return this->Deflection; }

private:
  void Polygonise() override;
  void MakeMesh();

  double Deflection = 0.0; ///< 0: not yet found.
};

} // namespace nurbs
