// SPDX-License-Identifier: BSD-3-Clause
// Times reading and tessellating of one model through the suite's filters and prints JSON; see --help.
#include "Measuring.h"
#include "TrimCurveMethods.h"
#include "vtkNURBSCADReader.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNURBSTessellator.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkErrorCode.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iostream>

using measuring::MedianTime;
using measuring::PeakMemory;

namespace
{

struct Arguments
{
  std::string File, Shape, Output, Subdivision = "default", Measure = "default";
  std::vector<double> Absolute, Relative;
  std::vector<std::string> Methods{ "kd-tree" }, Errors{ "guaranteed" };
  std::vector<int> Threads{ 1 };
  int Repeat = 3;
  bool NoSimplify = false, NoBalance = false, CurveTable = false;
};

void Declare(CLI::App& app, Arguments& a)
{
  auto* file = app.add_option("file", a.File, "STEP, IGES or BREP file")->check(CLI::ExistingFile);
  app
    .add_option("--shape", a.Shape,
      "car:N (a car body of N faces), sheet:N (N x N control points), "
      "or teapot, instead of a file")
    ->excludes(file);
  app.add_option("--absolute", a.Absolute, "Tolerances in the model's unit");
  app.add_option("--relative", a.Relative, "Tolerances over the diagonal")->excludes("--absolute");
  app.add_option("--method", a.Methods, "kd-tree, quadtree, binary")
    ->check(CLI::IsMember({ "kd-tree", "quadtree", "binary" }));
  app.add_option("--error", a.Errors, "guaranteed, estimated")
    ->check(CLI::IsMember({ "guaranteed", "estimated" }));
  app.add_option("--curve-subdivision", a.Subdivision, "midpoint or arbitrary")
    ->check(CLI::IsMember({ "midpoint", "arbitrary" }));
  app.add_option("--curve-measure", a.Measure, "point or line")
    ->check(CLI::IsMember({ "point", "line" }));
  app.add_flag("--no-simplify", a.NoSimplify, "Keep every vertex of the trimming polylines");
  app.add_flag("--no-balance", a.NoBalance, "Subdivide trim curves as in the paper");
  app.add_flag("--curves", a.CurveTable,
    "Also measure every way to turn trim curves into polylines, at the last tolerance");
  app.add_option("--threads", a.Threads, "Numbers of threads")->capture_default_str();
  app.add_option("--repeat", a.Repeat, "Runs of which the median counts")->capture_default_str();
  app.add_option("--output", a.Output, "Write the last mesh to this .vtp file");
}

vtkSmartPointer<vtkAlgorithm> MakeSource(const Arguments& a)
{
  if (!a.File.empty())
  {
    vtkNew<vtkNURBSCADReader> reader;
    reader->SetFileName(a.File.c_str());
    reader->SingleModelOn();
    return reader.Get();
  }
  vtkNew<vtkNURBSShapeSource> source;
  const std::string kind = a.Shape.substr(0, a.Shape.find(':'));
  const int size = kind.size() < a.Shape.size() ? std::stoi(a.Shape.substr(kind.size() + 1)) : 0;
  if (kind == "car")
  {
    source->SetShapeToCarBody();
    source->SetNumberOfPatches(size);
  }
  else if (kind == "sheet")
  {
    source->SetShapeToSheet();
    source->SetSheetPoints(size, size);
    source->SetSheetWaves(std::max(1, size / 12));
  }
  else if (kind == "teapot")
  {
    source->SetShapeToTeapot();
  }
  else
  {
    throw std::runtime_error("'" + a.Shape + "' is not one of car:N, sheet:N, teapot");
  }
  return source.Get();
}

void SetCurveOptions(vtkNURBSTessellator* tessellator, const Arguments& a)
{
  if (a.Subdivision != "default")
  {
    a.Subdivision == "midpoint" ? tessellator->SetCurveSubdivisionToMidpoint()
                                : tessellator->SetCurveSubdivisionToArbitrary();
  }
  if (a.Measure != "default")
  {
    a.Measure == "point" ? tessellator->SetCurveMeasureToPoint()
                         : tessellator->SetCurveMeasureToLine();
  }
  tessellator->SetCurveSimplification(!a.NoSimplify);
  tessellator->SetCurveBalancing(!a.NoBalance);
}

void SetMethod(
  vtkNURBSTessellator* tessellator, const std::string& method, const std::string& error)
{
  if (method == "quadtree")
  {
    tessellator->SetMethodToQuadTree();
  }
  else if (method == "binary")
  {
    tessellator->SetMethodToBinary();
  }
  else
  {
    tessellator->SetMethodToKdTree();
  }
  error == "guaranteed" ? tessellator->SetErrorModeToGuaranteed()
                        : tessellator->SetErrorModeToEstimated();
}

/// FNV-1a of the coordinates and triangles: equal meshes have equal digests.
std::string Digest(vtkPolyData* mesh)
{
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  auto mix = [&](std::uint64_t bits) { hash = (hash ^ bits) * 0x100000001b3ULL; };
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    double p[3];
    mesh->GetPoint(i, p);
    for (double x : p)
    {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &x, sizeof bits);
      mix(bits);
    }
  }
  for (vtkIdType c = 0; c < mesh->GetNumberOfPolys(); ++c)
  {
    vtkIdType count = 0;
    const vtkIdType* points = nullptr;
    mesh->GetPolys()->GetCellAtId(c, count, points);
    for (vtkIdType k = 0; k < count; ++k)
    {
      mix(std::uint64_t(points[k]));
    }
  }
  return std::to_string(hash);
}

long Segments(vtkPolyData* polylines)
{
  return polylines->GetLines()->GetNumberOfConnectivityIds() - polylines->GetNumberOfLines();
}

/// The source's model, whether it comes alone or as the only one of a collection.
vtkUnstructuredGrid* ModelOf(vtkAlgorithm* source)
{
  vtkDataObject* output = source->GetOutputDataObject(0);
  if (auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(output))
  {
    output =
      collection->GetNumberOfPartitionedDataSets() > 0 ? collection->GetPartition(0, 0) : nullptr;
  }
  return vtkUnstructuredGrid::SafeDownCast(output);
}

nlohmann::json Measure(vtkNURBSTessellator* tessellator, int threads, int repeat)
{
  vtkSMPTools::Initialize(threads);
  const measuring::Duration taken = MedianTime(repeat, [&] {
    tessellator->Modified();
    tessellator->Update();
  });
  if (tessellator->GetErrorCode() != vtkErrorCode::NoError)
  {
    throw std::runtime_error("the tessellator reports an error");
  }
  auto* mesh = vtkPolyData::SafeDownCast(tessellator->GetOutputDataObject(0));
  auto* lines = vtkPolyData::SafeDownCast(tessellator->GetOutputDataObject(1));
  return { { "threads", threads }, { "seconds", taken.Elapsed },
    { "processor_seconds", taken.Processor }, { "triangles", mesh->GetNumberOfPolys() },
    { "points", mesh->GetNumberOfPoints() }, { "edges", Segments(lines) },
    { "tolerance", tessellator->GetToleranceUsed() },
    { "certified", tessellator->GetCertifiedError() },
    { "repaired", tessellator->GetNumberOfRepairedFaces() },
    { "capped", tessellator->GetNumberOfCappedFaces() },
    { "failed", tessellator->GetNumberOfFailedFaces() },
    { "kernel_seconds", tessellator->GetTessellateSeconds() }, { "digest", Digest(mesh) } };
}

/// Table 2 of the paper, see TrimCurveMethods.h.
nlohmann::json MeasureCurves(vtkUnstructuredGrid* model, double tolerance)
{
  const auto view = vtkNURBSModel::View(model);
  std::vector<std::string> errors;
  for (vtkIdType face = 0; face < model->GetNumberOfCells(); ++face)
  {
    errors.push_back(view->GetFaceError(face));
  }
  const nurbs::CurveMethodTable table =
    nurbs::CompareCurveMethods(view->GetModel(), errors, tolerance);
  nlohmann::json result = { { "curves", table.Curves }, { "failed", table.Failed } };
  for (const nurbs::CurveMethodFigures& m : table.Methods)
  {
    result["methods"][m.Method] = { { "conversion", m.Conversion },
      { "approximation", m.Approximation }, { "edges", m.Edges } };
  }
  return result;
}

nlohmann::json Run(const Arguments& a)
{
  nlohmann::json result;
  result["memory_start"] = PeakMemory();
  const vtkSmartPointer<vtkAlgorithm> source = MakeSource(a);
  vtkSMPTools::Initialize(1);
  result["read"] = MedianTime(a.Repeat, [&] {
    source->Modified();
    source->Update();
  }).Elapsed;
  vtkUnstructuredGrid* model = ModelOf(source);
  if (!model || model->GetNumberOfCells() == 0)
  {
    throw std::runtime_error("no faces were read");
  }
  result["faces"] = model->GetNumberOfCells();
  result["control_points"] = model->GetNumberOfPoints();
  result["memory_read"] = PeakMemory();
  vtkNew<vtkNURBSTessellator> tessellator;
  tessellator->SetInputData(model);
  SetCurveOptions(tessellator, a);
  const bool absolute = !a.Absolute.empty();
  std::vector<double> tolerances = absolute ? a.Absolute : a.Relative;
  if (tolerances.empty())
  {
    tolerances.push_back(1e-3);
  }
  result["meshes"] = nlohmann::json::array();
  for (double tolerance : tolerances)
  {
    absolute ? tessellator->SetToleranceModeToAbsolute()
             : tessellator->SetToleranceModeToRelative();
    absolute ? tessellator->SetAbsoluteTolerance(tolerance) : tessellator->SetTolerance(tolerance);
    for (const std::string& method : a.Methods)
    {
      for (const std::string& error : a.Errors)
      {
        SetMethod(tessellator, method, error);
        for (int threads : a.Threads)
        {
          nlohmann::json row = Measure(tessellator, threads, a.Repeat);
          row[absolute ? "absolute" : "relative"] = tolerance;
          row["method"] = method;
          row["error_mode"] = error;
          result["meshes"].push_back(row);
        }
      }
    }
  }
  result["memory"] = PeakMemory();
  if (a.CurveTable)
  {
    result["curves"] = MeasureCurves(model, tessellator->GetToleranceUsed());
  }
  if (!a.Output.empty())
  {
    vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetFileName(a.Output.c_str());
    writer->SetInputData(tessellator->GetOutputDataObject(0));
    writer->SetDataModeToBinary();
    writer->SetCompressorTypeToNone();
    writer->Write();
  }
  return result;
}

} // namespace

int main(int argc, char** argv)
{
  Arguments arguments;
  CLI::App app{
    "Times reading and tessellating of one model and prints JSON. Peak memory is that of\n"
    "the process: at its start, after reading, at its end."
  };
  Declare(app, arguments);
  CLI11_PARSE(app, argc, argv);
  try
  {
    std::cout << Run(arguments).dump() << '\n';
    return 0;
  }
  catch (const std::exception& e)
  {
    std::cerr << (arguments.File.empty() ? arguments.Shape : arguments.File) << ": " << e.what()
              << '\n';
  }
  return 2;
}
