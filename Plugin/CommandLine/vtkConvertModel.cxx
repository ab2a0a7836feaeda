// SPDX-License-Identifier: BSD-3-Clause
#include "vtkConvertModel.h"

#include "Arguments.h"
#include "Failure.h"
#include "Report.h"
#include "vtkMessages.h"
#include "vtkWriteMesh.h"

#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkNURBSCADWriter.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkUnstructuredGrid.h"
#include "vtkXMLPartitionedDataSetCollectionWriter.h"
#include "vtkXMLUnstructuredGridWriter.h"

#include <algorithm>
#include <chrono>

namespace nurbs
{
namespace
{

const std::vector<std::string> CADEndings = { ".step", ".stp", ".iges", ".igs", ".brep", ".brp" };

void WriteCAD(vtkDataObject* model, const Arguments& arguments, const ProgressFunction& progress,
  Report& report)
{
  vtkNew<vtkNURBSCADWriter> writer;
  vtkNew<vtkCallbackCommand> command;
  command->SetClientData(const_cast<ProgressFunction*>(&progress));
  command->SetCallback([](vtkObject*, unsigned long, void* client, void* amount) {
    (*static_cast<const ProgressFunction*>(client))(*static_cast<const double*>(amount));
  });
  writer->AddObserver(vtkCommand::ProgressEvent, command);
  writer->SetInputDataObject(model);
  writer->SetFileName(arguments.Output.c_str());
  writer->SetGap(arguments.Gap);
  if (!writer->Write())
  {
    throw Failure(vtkMessages::SafeDownCast(vtkOutputWindow::GetInstance())->GetFirstError());
  }
  report.Converted = true;
  report.WrittenFaces = writer->GetNumberOfFaces();
  report.LostFaces = writer->GetNumberOfFailedFaces();
  report.InvalidFaces = writer->GetNumberOfInvalidFaces();
  report.AnalyticFaces = writer->GetNumberOfAnalyticFaces();
  report.Instances = writer->GetNumberOfInstances();
  report.Solids = writer->GetNumberOfSolids();
  report.Shells = writer->GetNumberOfShells();
  report.SharedEdges = writer->GetNumberOfSharedEdges();
  report.ComputedEdges = writer->GetNumberOfComputedEdges();
  report.TornEdges = writer->GetNumberOfTornEdges();
  report.EdgeTolerance = writer->GetEdgeTolerance();
}

// Data in line: the VTK of Debian's ParaView 5.11 reads no appended data since an update of expat.
template <typename Writer>
void WriteVTK(vtkDataObject* data, const std::string& path)
{
  vtkNew<Writer> writer;
  writer->SetInputDataObject(data);
  writer->SetDataModeToBinary();
  writer->SetFileName(path.c_str());
  if (!writer->Write() || writer->GetErrorCode() != 0)
  {
    throw Failure("cannot write " + path);
  }
}

/// The assembly, or one of the only part.
vtkSmartPointer<vtkDataObject> Collected(vtkDataObject* model)
{
  if (!vtkUnstructuredGrid::SafeDownCast(model))
  {
    return model;
  }
  auto collection = vtkSmartPointer<vtkPartitionedDataSetCollection>::New();
  collection->SetNumberOfPartitionedDataSets(1);
  collection->SetPartition(0, 0, model);
  return collection;
}

} // namespace

//--------------------------------------------------------------------------------------------------
bool IsCADPath(const std::string& path)
{
  return std::find(CADEndings.begin(), CADEndings.end(), Ending(path)) != CADEndings.end();
}

//--------------------------------------------------------------------------------------------------
void CheckModelPath(const std::string& path)
{
  const std::string ending = Ending(path);
  if (!IsCADPath(path) && ending != ".vtu" && ending != ".vtpc")
  {
    throw Failure("cannot write " + path + ": models are .step, .iges, .brep, .vtu or .vtpc");
  }
  CheckWritable(path);
}

//--------------------------------------------------------------------------------------------------
void WriteModel(vtkDataObject* model, const Arguments& arguments, const ProgressFunction& progress,
  Report& report)
{
  const auto started = std::chrono::steady_clock::now();
  const std::string& path = arguments.Output;
  if (IsCADPath(path))
  {
    WriteCAD(model, arguments, progress, report);
  }
  else if (Ending(path) == ".vtpc")
  {
    WriteVTK<vtkXMLPartitionedDataSetCollectionWriter>(Collected(model), path);
  }
  else
  {
    const std::vector<vtkUnstructuredGrid*> parts = PartsOf(model);
    if (parts.size() != 1)
    {
      throw Failure("cannot write " + path + ": the model has several parts, which .vtpc can hold");
    }
    WriteVTK<vtkXMLUnstructuredGridWriter>(parts.front(), path);
  }
  report.WriteSeconds =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
}

} // namespace nurbs
