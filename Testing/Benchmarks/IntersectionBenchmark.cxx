// SPDX-License-Identifier: BSD-3-Clause
// Intersection curves of faces of CAD files: IntersectionBenchmark [--precision P] [--threads N] FILE...
// One line a file: processor seconds of nurbs::FindIntersections as visible regions call it, and of
// nurbs::MakeVisibleRegions from (1, 1, 1), which contain them (the reading of the file is not counted);
// pairs of faces that were looked at, curves, their length, pairs that were given up.
#include "Measuring.h"
#include "ModelExtent.h"
#include "VisibleRegions.h"
#include "vtkNURBSCADReader.h"
#include "vtkNURBSModelPool.h"
#include "vtkNURBSParallel.h"

#include <CLI/CLI.hpp>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkSMPTools.h>

#include <cstdio>
#include <filesystem>

namespace
{

// The share of the regions' precision that their lines have.
constexpr double LineShare = 0.25;

double LengthOf(const nurbs::FaceIntersections& result)
{
  double sum = 0.0;
  for (const nurbs::FaceIntersection& curve : result.Curves)
  {
    for (std::size_t k = 1; k < curve.Points.size(); ++k)
    {
      sum += (curve.Points[k].Point - curve.Points[k - 1].Point).norm();
    }
  }
  return sum;
}

void Run(const std::string& file, double precision)
{
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkNURBSModelPool pool;
  const std::string problem = pool.Collect(reader->GetOutputDataObject(0));
  if (!problem.empty())
  {
    std::printf("%s: %s\n", file.c_str(), problem.c_str());
    return;
  }
  const double size =
    nurbs::Diagonal(nurbs::FaceBoxes(pool.Model, pool.FaceErrors, vtkNURBSParallelFor));
  const nurbs::CompletedModel whole =
    nurbs::CompleteModel(pool.Model, pool.FaceErrors, 1e-7 * size);
  const nurbs::TrimIndex trims(pool.Model, vtkNURBSParallelFor);
  nurbs::FaceIntersectionOptions options;
  options.Precision = LineShare * precision * size;
  options.Parallel = vtkNURBSParallelFor;
  const measuring::Stopwatch watch;
  const nurbs::FaceIntersections result =
    nurbs::FindIntersections(whole.Data, trims, pool.FaceErrors, options);
  const double seconds = watch.Read().Processor;
  nurbs::VisibleRegionOptions view;
  view.View.Place = nurbs::Vec3(1.0, 1.0, 1.0);
  view.Precision = precision * size;
  view.Parallel = vtkNURBSParallelFor;
  const measuring::Stopwatch regions;
  nurbs::MakeVisibleRegions(pool.Model, pool.FaceErrors, view);
  std::printf("%-28s %6zu faces  %8.4f s of %8.4f s  %6lld pairs %6zu curves %9.4f diagonals long "
              "%zu given up\n",
    std::filesystem::path(file).filename().c_str(), pool.Model.Faces.size(), seconds,
    regions.Read().Processor, static_cast<long long>(result.Pairs), result.Curves.size(),
    LengthOf(result) / size, result.Unresolved.size());
  std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv)
{
  double precision = 1e-4;
  int threads = 1;
  std::vector<std::string> files;
  CLI::App app("Intersection curves of faces of CAD files");
  app.add_option("--precision", precision, "of visible regions, of the diagonal")
    ->capture_default_str();
  app.add_option("--threads", threads, "0: as many as there are")->capture_default_str();
  app.add_option("files", files)->required();
  CLI11_PARSE(app, argc, argv);
  if (threads > 0)
  {
    vtkSMPTools::Initialize(threads);
  }
  const vtkNURBSParallelScope parallel;
  for (const std::string& file : files)
  {
    Run(file, precision);
  }
  return 0;
}
