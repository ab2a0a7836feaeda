// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Opening a model, and walking over its parts.
#ifndef vtkReadModel_h
#define vtkReadModel_h

#include "vtkSmartPointer.h"

#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataObject;
class vtkPoints;
class vtkPolyData;
class vtkUnstructuredGrid;

namespace nurbs
{

struct Arguments;

/// Called with 0 to 1 while something works.
using ProgressFunction = std::function<void(double)>;

/// Runs an algorithm with its progress told. Throws Failure with VTK's first error if there is one.
void Run(vtkAlgorithm* algorithm, const ProgressFunction& progress);

/// Reads arguments.Model: a CAD file, in arguments.Unit and as one model if `single`, or a saved
/// model (.vtu, .vtpc), as it is. The result is a vtkUnstructuredGrid or a
/// vtkPartitionedDataSetCollection with at least one face. Throws Failure if the file is missing, of
/// another kind, broken or empty.
vtkSmartPointer<vtkDataObject> ReadModel(
  const Arguments& arguments, bool single, const ProgressFunction& progress);

/// The models of an assembly in its order, or the model itself.
std::vector<vtkUnstructuredGrid*> PartsOf(vtkDataObject* model);

/// A few points on each face, within the box of its loops: about as far as the model reaches, which
/// its control points may pass by far.
vtkSmartPointer<vtkPoints> SamplesOf(vtkDataObject* model);

/// All of a tessellator's output as one mesh: itself if it is one already.
vtkSmartPointer<vtkPolyData> Joined(vtkDataObject* output);

} // namespace nurbs

#endif
