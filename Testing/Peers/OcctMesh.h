// SPDX-License-Identifier: BSD-3-Clause
/// @file OcctMesh.h
/// @brief OpenCASCADE's own mesh of a shape, for comparison and to try the verifier on.
#pragma once

#include "FaceMesh.h"
#include "ReferenceShape.h"

namespace verify
{

/// Runs BRepMesh on @a root, its angle criterion off. Any earlier mesh is dropped.
/// @param deflection absolute, in the model's unit.
void MeshByOcct(const TopoDS_Shape& root, double deflection, bool parallel);

/// The triangles that BRepMesh left on every face, turned outwards.
std::vector<FaceMesh> TakeOcctMesh(const ReferenceShape& shape);

} // namespace verify
