// SPDX-License-Identifier: BSD-3-Clause
/// @file vtkMeshOpenEdges.h
/// @brief Whether the triangles of a mesh meet, exact coordinates compared.
#pragma once

#include "vtkType.h"

class vtkPolyData;

/// Edges used an odd number of times when points whose coordinates are the same bit for bit (0 and -0
/// are one) are one point. A vertex in the middle of a neighbour's edge thus opens three edges.
/// @param ignoreBorder leave out edges along a side of the domain, by the point data UV: for one face
///   that is not closed.
vtkIdType CountOpenEdges(vtkPolyData* mesh, bool ignoreBorder);
