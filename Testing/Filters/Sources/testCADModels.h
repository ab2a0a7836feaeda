// SPDX-License-Identifier: BSD-3-Clause
/// @file testCADModels.h
/// @brief Reads files with vtkNURBSCADReader and compares the models with OpenCASCADE's shapes.
#pragma once

#include "vtkNURBSCADReader.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"

#include "vtkNew.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <TopoDS_Shape.hxx>

#include <string>
#include <vector>

using Grids = std::vector<vtkSmartPointer<vtkUnstructuredGrid>>;

/// NURBS_TEST_OUTPUT/name.
std::string OutputPath(const std::string& name);

/// Writes a shape as BREP text and returns the path.
std::string WriteBrep(const TopoDS_Shape& shape, const std::string& name);

/// Updates the reader; all models of its output.
Grids Models(vtkNURBSCADReader* reader);

/// Reads a file of one model. Fails the test if there is none.
vtkSmartPointer<vtkUnstructuredGrid> ReadOne(const std::string& path);

/// Writes and reads a shape.
vtkSmartPointer<vtkUnstructuredGrid> Convert(const TopoDS_Shape& shape, const std::string& name);

/// Expects one valid cell for each face of the shape, in order; points of the converted surfaces
/// on the shape's within `tolerance`, and lifted trim curves within the edges' stated tolerances.
void ExpectSameFaces(
  vtkUnstructuredGrid* grid, const TopoDS_Shape& shape, double tolerance, double edgeTolerance);

/// Expects every edge but poles to be used once in each direction, seen from outside.
void ExpectClosed(vtkUnstructuredGrid* grid);

/// Largest distance of lifted trim curves from their edges at equal parameters, and by how much it
/// is over the stated tolerance.
struct EdgeFit
{
  double Distance = 0.0;
  double Excess = 0.0;
};
EdgeFit MeasureEdges(const nurbs::Model& model);

/// The outward unit normal of a face at a relative parameter of its domain.
nurbs::Vec3 Outside(const nurbs::Face& face, double u, double v);
