// SPDX-License-Identifier: BSD-3-Clause
/// @file testCADWriting.h
/// @brief Writes models with vtkNURBSCADWriter and measures what OpenCASCADE reads.
#pragma once

#include "../../testMessageKeeper.h"
#include "testCADModels.h"

#include "ModelBuilder.h"
#include "vtkNURBSCADWriter.h"
#include "vtkNURBSShapeSource.h"

const char* const Greek = "\xCE\x93\xCF\x81\xCE\xB1\xCE\xBD\xCE\xAC\xCE\xB6\xCE\xB9"; // UTF-8
const char* const Endings[] = { "step", "iges", "brep" };

/// The shape of a file, by OpenCASCADE alone.
TopoDS_Shape ReadShape(const std::string& path);

/// How many different faces, solids, ... there are.
int CountOf(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind);

/// Edges of two faces.
int SharedEdges(const TopoDS_Shape& shape);

double AreaOf(const TopoDS_Shape& shape);
double VolumeOf(const TopoDS_Shape& shape);

/// Writes the model to NURBS_TEST_OUTPUT/name; the path. Fails the test if that fails.
std::string Write(vtkNURBSCADWriter* writer, vtkDataObject* model, const std::string& name);
std::string Write(vtkDataObject* model, const std::string& name);

/// A shape of vtkNURBSShapeSource; the car body has some 60 patches.
vtkSmartPointer<vtkUnstructuredGrid> Shape(int shape);

/// Names the faces: `start` and the cell's index.
void SetNames(vtkUnstructuredGrid* model, const std::string& start);

/// Which face of the file each cell is: names of faces tell.
std::vector<int> OrderOf(vtkUnstructuredGrid* written, vtkUnstructuredGrid* read);

/// Expects points of the model's faces, and of their loops, on OpenCASCADE's faces: of some three of
/// the faces.
void ExpectModelFaces(vtkUnstructuredGrid* model, const TopoDS_Shape& shape,
  const std::vector<int>& order, double tolerance);

/// The largest distance between surfaces of two models at equal parameters, faces in order.
double SurfaceDistance(vtkUnstructuredGrid* a, vtkUnstructuredGrid* b);

vtkSmartPointer<vtkUnstructuredGrid> Store(nurbs::ModelBuilder& builder);

/// A flat patch from (x, 0) to (x + 1, 1) of degree 1.
nurbs::Surface Patch(double x, double z = 0.0);

/// A part of the ball about the origin: longitudes u and latitudes v, in spans of degree 2;
/// latitudes beyond a pole are on the other side of it.
nurbs::Surface BallPatch(double radius, nurbs::Interval u, nurbs::Interval v, int spans = 1);

/// The next side of the loop: a Bezier curve.
void AddSide(
  nurbs::ModelBuilder& builder, const std::vector<nurbs::Vec2>& points, std::int64_t edge = -1);

/// A face in the loop through these (u, v).
void AddFace(nurbs::ModelBuilder& builder, const nurbs::Surface& surface,
  const std::vector<nurbs::Vec2>& corners);

/// Two patches side by side that share the edge x = 1, the second one lifted by `gap`.
vtkSmartPointer<vtkUnstructuredGrid> TwoPatches(double gap);

/// Blocks of one name, in the order given.
vtkSmartPointer<vtkPartitionedDataSetCollection> Blocks(const Grids& models);

/// A writer whose messages are kept.
class Listened
{
public:
  Listened()
  {
    this->Writer->AddObserver(vtkCommand::ErrorEvent, this->Errors);
    this->Writer->AddObserver(vtkCommand::WarningEvent, this->Warnings);
  }
  vtkNew<vtkNURBSCADWriter> Writer;
  vtkNew<MessageKeeper> Errors, Warnings;
};
