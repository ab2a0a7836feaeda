// SPDX-License-Identifier: BSD-3-Clause
/// @file vtkMeshInput.h
/// @brief Our meshes as the tessellator writes them, split into faces.
#ifndef vtkMeshInput_h
#define vtkMeshInput_h

#include "FaceMesh.h"

#include <string>

class vtkPolyData;

namespace verify
{

/// Splits triangles by their cell datum `FaceId`; faces without any stay empty.
/// @throws std::runtime_error for a mesh without FaceId, with a face beyond @a faceCount, or with
/// points that are not double (then exact comparison means nothing).
std::vector<FaceMesh> SplitIntoFaces(vtkPolyData* mesh, int faceCount);

/// Reads a .vtp file and splits it.
std::vector<FaceMesh> ReadMesh(const std::string& file, int faceCount);

} // namespace verify
#endif
