// SPDX-License-Identifier: BSD-3-Clause
// Times vtkNURBSVisibleRegions on one model from some directions, and prints JSON: a run a direction,
// precision and choice of clustering. See --help.
#include "Measuring.h"
#include "vtkNURBSCADReader.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNURBSVisibleRegions.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <iostream>
#include <map>

namespace
{

const std::map<std::string, int> Shapes = { { "vase", vtkNURBSShapeSource::VASE },
  { "missile", vtkNURBSShapeSource::MISSILE }, { "spring", vtkNURBSShapeSource::SPRING },
  { "teapot", vtkNURBSShapeSource::TEAPOT }, { "car", vtkNURBSShapeSource::CAR_BODY } };

struct Options
{
  std::string File, Shape;
  int Patches = 1000;
  std::vector<std::string> Views{ "1,1,1", "0,0,1", "0.3,-0.9,0.2" };
  std::vector<double> Precisions{ 1e-4 };
  std::vector<std::string> Clustering{ "off" };
  bool DrawingOnly = false;
  bool Keep = false;
  int Threads = 1;
  int Repeat = 1;
};

vtkSmartPointer<vtkDataObject> Load(const Options& options)
{
  if (options.Shape.empty())
  {
    vtkNew<vtkNURBSCADReader> reader;
    reader->SetFileName(options.File.c_str());
    reader->Update();
    return reader->GetOutputDataObject(0);
  }
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(Shapes.at(options.Shape));
  source->SetNumberOfPatches(options.Patches);
  source->Update();
  return source->GetOutputDataObject(0);
}

vtkIdType CountPoints(vtkDataObject* data)
{
  if (auto* lines = vtkPolyData::SafeDownCast(data))
  {
    return lines->GetNumberOfPoints();
  }
  vtkIdType count = 0;
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    vtkSmartPointer<vtkCompositeDataIterator> at;
    at.TakeReference(composite->NewIterator());
    for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
    {
      count += CountPoints(at->GetCurrentDataObject());
    }
  }
  return count;
}

/// `filter`: of the run before; another one is made if it must not be kept.
nlohmann::json Run(vtkDataObject* model, const std::string& view, double precision,
  const std::string& clustering, const Options& options,
  vtkSmartPointer<vtkNURBSVisibleRegions>& filter)
{
  double direction[3];
  if (std::sscanf(view.c_str(), "%lf,%lf,%lf", direction, direction + 1, direction + 2) != 3)
  {
    throw std::runtime_error("'" + view + "' is not x,y,z");
  }
  const measuring::Duration taken = measuring::MedianTime(options.Repeat, [&] {
    if (!filter || !options.Keep)
    {
      filter = vtkSmartPointer<vtkNURBSVisibleRegions>::New();
    }
    filter->SetInputDataObject(model);
    filter->SetDirection(direction);
    filter->SetPrecision(precision);
    filter->SetClustering(clustering == "on");
    filter->SetComputeRegions(!options.DrawingOnly);
    filter->Modified();
    filter->Update();
  });
  return { { "view", view }, { "precision", precision }, { "clustering", clustering },
    { "seconds", taken.Elapsed }, { "processor_seconds", taken.Processor },
    { "faces", filter->GetNumberOfFaces() }, { "visible_area", filter->GetVisibleArea() },
    { "lines", filter->GetNumberOfLines() }, { "cells", filter->GetNumberOfCells() },
    { "piercing", filter->GetNumberOfPiercingPairs() },
    { "failed", filter->GetNumberOfFailedFaces() },
    { "points", CountPoints(filter->GetOutputDataObject(1)) } };
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app("Times visible regions");
  app.add_option("file", options.File, "CAD file")->check(CLI::ExistingFile);
  app.add_option("--shape", options.Shape)->check(CLI::IsMember(Shapes));
  app.add_option("--patches", options.Patches, "of the shape car")->capture_default_str();
  app.add_option("--view", options.Views, "x,y,z: to the viewer")->capture_default_str();
  app.add_option("--precision", options.Precisions, "of the diagonal")->capture_default_str();
  app.add_option("--clustering", options.Clustering)->check(CLI::IsMember({ "on", "off" }));
  app.add_flag("--drawing-only", options.DrawingOnly, "without regions and areas");
  app.add_flag(
    "--keep", options.Keep, "one filter for all runs: what no view changes is made once");
  app.add_option("--threads", options.Threads)->capture_default_str();
  app.add_option("--repeat", options.Repeat, "runs of which the median counts")
    ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  vtkSMPTools::Initialize(options.Threads);
  try
  {
    nlohmann::json result;
    const measuring::Stopwatch reading;
    const auto model = Load(options);
    vtkSmartPointer<vtkNURBSVisibleRegions> filter;
    result["read"] = reading.Read().Elapsed;
    for (const std::string& view : options.Views)
    {
      for (const double precision : options.Precisions)
      {
        for (const std::string& clustering : options.Clustering)
        {
          result["runs"].push_back(Run(model, view, precision, clustering, options, filter));
        }
      }
    }
    result["memory"] = measuring::PeakMemory();
    std::cout << result.dump() << '\n';
    return 0;
  }
  catch (const std::exception& e)
  {
    std::cerr << e.what() << '\n';
    return 2;
  }
}
