// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDrawModel.h"

#include "Arguments.h"
#include "Failure.h"
#include "Report.h"
#include "vtkConvertModel.h"
#include "vtkMessages.h"
#include "vtkWriteMesh.h"

#include "vtkBoundingBox.h"
#include "vtkNURBSDrawingWriter.h"
#include "vtkNURBSVisibleRegions.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"
#include "vtkXMLPolyDataWriter.h"

#include <algorithm>
#include <chrono>
#include <filesystem>

namespace nurbs
{
namespace
{

double Diagonal(vtkDataObject* model)
{
  const auto samples = SamplesOf(model);
  vtkBoundingBox box;
  for (vtkIdType k = 0; k < samples->GetNumberOfPoints(); ++k)
  {
    box.AddPoint(samples->GetPoint(k));
  }
  return box.GetDiagonalLength();
}

bool IsVectorFormat(const std::string& path)
{
  const std::string ending = Ending(path);
  return ending == ".svg" || ending == ".pdf";
}

// A file of curves takes half of the error for fitting them.
double LinePrecision(const Arguments& arguments, const Report& report)
{
  return (arguments.What == Command::Drawing && IsVectorFormat(arguments.Output) ? 0.5 : 1.0) *
    report.Precision;
}

void Configure(vtkNURBSVisibleRegions* regions, const Arguments& arguments, double precision)
{
  const auto& [x, y, z] = arguments.View;
  const auto& [ex, ey, ez] = arguments.Eye;
  const auto& [ux, uy, uz] = arguments.Up;
  regions->SetDirection(x, y, z);
  regions->SetEyePoint(ex, ey, ez);
  regions->SetProjection(
    arguments.Perspective ? vtkNURBSVisibleRegions::PERSPECTIVE : vtkNURBSVisibleRegions::PARALLEL);
  regions->SetViewUp(ux, uy, uz);
  regions->SetPrecisionModeToAbsolute();
  regions->SetPrecision(precision);
  regions->SetSmoothEdges(arguments.SmoothEdges);
  regions->SetHiddenLines(arguments.HiddenLines);
  regions->SetBothSides(arguments.BothSides);
  regions->SetProjectLines(true);
  regions->SetComputeRegions(arguments.What != Command::Drawing);
  regions->SetRegion(arguments.HiddenRegions ? vtkNURBSVisibleRegions::HIDDEN_REGION
                                             : vtkNURBSVisibleRegions::VISIBLE_REGION);
}

void Fill(vtkNURBSVisibleRegions* regions, Report& report)
{
  report.Viewed = true;
  report.HasRegions = regions->GetComputeRegions();
  report.VisibleFaces = regions->GetNumberOfVisibleFaces();
  report.PartialFaces = regions->GetNumberOfPartialFaces();
  report.HiddenFaces = regions->GetNumberOfHiddenFaces();
  report.UnusedFaces = regions->GetNumberOfFailedFaces();
  report.PiercingPairs = regions->GetNumberOfPiercingPairs();
  report.VisibleArea = regions->GetVisibleArea();
  report.Lines = regions->GetNumberOfLines();
  report.VisibleLines = regions->GetNumberOfVisibleLines();
}

// Data in line: the VTK of Debian's ParaView 5.11 reads no appended data since an update of expat.
void WriteLines(vtkPolyData* lines, const std::string& path)
{
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputDataObject(lines);
  writer->SetDataModeToBinary();
  writer->SetFileName(path.c_str());
  if (!writer->Write() || writer->GetErrorCode() != 0)
  {
    throw Failure("cannot write " + path);
  }
}

void WriteCurves(vtkDataObject* lines, const Arguments& arguments, Report& report)
{
  vtkNew<vtkNURBSDrawingWriter> writer;
  writer->SetInputDataObject(lines);
  writer->SetFileName(arguments.Output.c_str());
  writer->SetToleranceModeToAbsolute();
  writer->SetTolerance(report.Precision - LinePrecision(arguments, report));
  writer->SetScale(arguments.Scale * 1000.0 * MetresOf(report.Unit.empty() ? "mm" : report.Unit));
  writer->SetPageSize(static_cast<int>(arguments.Sheet));
  writer->SetOrientation(static_cast<int>(arguments.Orientation));
  writer->SetHiddenLines(arguments.HiddenLines);
  writer->SetSource(std::filesystem::path(arguments.Model).filename().c_str());
  if (!arguments.Perspective)
  {
    writer->SetView(arguments.ViewName.c_str());
  }
  if (!writer->Write())
  {
    throw Failure(vtkMessages::SafeDownCast(vtkOutputWindow::GetInstance())->GetFirstError());
  }
  report.Drawn = true;
  report.Paths = writer->GetNumberOfVisiblePaths() + writer->GetNumberOfHiddenPaths();
  report.Curves = writer->GetNumberOfCurves();
  report.StraightLines = writer->GetNumberOfStraightLines();
  report.Scale = writer->GetScaleUsed();
}

} // namespace

//--------------------------------------------------------------------------------------------------
void CheckViewPath(const Arguments& arguments)
{
  const std::string ending = Ending(arguments.Output);
  const bool drawing = arguments.What == Command::Drawing;
  if (drawing ? !IsVectorFormat(arguments.Output) && ending != ".vtp"
              : ending != ".vtu" && !IsCADPath(arguments.Output))
  {
    throw Failure("cannot write " + arguments.Output + ": " +
      (drawing ? "drawings are .svg, .pdf or .vtp" : "models are .vtu, .step, .iges or .brep"));
  }
  CheckWritable(arguments.Output);
}

//--------------------------------------------------------------------------------------------------
vtkSmartPointer<vtkDataObject> LookAt(vtkDataObject* model, const Arguments& arguments,
  const ProgressFunction& progress, Report& report)
{
  const auto started = std::chrono::steady_clock::now();
  const bool drawing = arguments.What == Command::Drawing;
  const std::vector<vtkUnstructuredGrid*> parts = PartsOf(model);
  if (!drawing && parts.size() > 1)
  {
    throw Failure("cannot use " + arguments.Model + ": it has several parts, save one as .vtu");
  }
  report.Precision = arguments.Precision * Diagonal(model);
  vtkNew<vtkNURBSVisibleRegions> regions;
  Configure(regions, arguments, LinePrecision(arguments, report));
  regions->SetInputDataObject(0, parts.size() == 1 ? parts.front() : model);
  Run(regions, progress);
  Fill(regions, report);
  report.VisibilitySeconds =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  vtkSmartPointer<vtkDataObject> result = regions->GetOutputDataObject(drawing ? 1 : 0);
  if (drawing ? report.Lines == 0 : result->GetNumberOfElements(vtkDataObject::CELL) == 0)
  {
    throw Failure(std::string(drawing ? "there are no lines" : "there is nothing") +
      " to be seen of " + arguments.Model);
  }
  return result;
}

//--------------------------------------------------------------------------------------------------
void WriteView(
  vtkDataObject* data, const Arguments& arguments, const ProgressFunction& progress, Report& report)
{
  const auto started = std::chrono::steady_clock::now();
  if (IsVectorFormat(arguments.Output))
  {
    WriteCurves(data, arguments, report);
  }
  else if (Ending(arguments.Output) == ".vtp")
  {
    WriteLines(Joined(data), arguments.Output);
  }
  else
  {
    WriteModel(data, arguments, progress, report);
  }
  report.WriteSeconds =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
}

} // namespace nurbs
