// SPDX-License-Identifier: BSD-3-Clause
// Silhouettes of CAD files: SilhouetteBenchmark [--precision P] [--threads N] [--grid N]
// [--patches N] FILE...
// One line a file and direction: seconds of nurbs::MakeSilhouettes (the reading of the file is not
// counted), lines, connected silhouettes, points. With --grid, silhouettes are compared with the
// signs of nurbs::Normal . view on N x N samples a face, within its trims: how many neighbours of
// different signs have no silhouette within a cell, the largest |normal . view| of the points and
// the largest distance between chords and contour, of the precision; chords whose front is not on
// the left; ends of silhouettes that go on nowhere and are no border's or sharp edge's.
#include "Measuring.h"
#include "ModelExtent.h"
#include "nurbsSilhouetteReference.h"
#include "vtkNURBSCADReader.h"
#include "vtkNURBSModelPool.h"
#include "vtkNURBSParallel.h"
#include "vtkNURBSShapeSource.h"

#include <CLI/CLI.hpp>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkSMPTools.h>
#include <vtkUnstructuredGrid.h>

#include <cstdio>
#include <filesystem>

namespace
{

const nurbs::Vec3 Directions[3] = { { 1.0, 1.0, 1.0 }, { 0.0, 0.0, 1.0 }, { 0.3, -0.9, 0.2 } };

struct Options
{
  double Precision = 1e-4;
  int Grid = 0;
};

void Check(const nurbs::Model& model, const std::vector<std::string>& errors,
  const nurbs::Silhouettes& result, const nurbs::SilhouetteOptions& options, int n)
{
  const reference::Measure measure = reference::MeasureLines(model, result, options.View);
  std::vector<reference::GridCheck> checks(model.Faces.size());
  vtkNURBSParallelFor(0, std::int64_t(checks.size()), [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f)
    {
      if (errors[f].empty())
      {
        const nurbs::FaceTrim trim(model, f);
        checks[f] = reference::CheckGrid(model, f, result, options.View, options.Precision, n,
          [&](const nurbs::Vec2& uv) { return trim.Inside(uv[0], uv[1]); });
      }
    }
  });
  int changes = 0, missed = 0;
  for (std::size_t f = 0; f < checks.size(); ++f)
  {
    changes += checks[f].Changes;
    missed += checks[f].Missed;
    if (checks[f].Missed > 0)
    {
      std::printf(" (face %zu: %d)", f, checks[f].Missed);
    }
  }
  std::printf("  missed %d of %d, over 1e-9 %d (%.1e), chord %.2f, wrong side %d, loose %d", missed,
    changes, measure.Over, measure.Cosine, measure.Chord / options.Precision, measure.WrongSide,
    reference::LooseEnds(result, 20.0 * options.Precision));
}

vtkSmartPointer<vtkDataObject> Read(const std::string& file)
{
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  return reader->GetOutputDataObject(0);
}

vtkSmartPointer<vtkDataObject> MakeCar(int patches)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToCarBody();
  source->SetNumberOfPatches(patches);
  source->Update();
  return source->GetOutputDataObject(0);
}

void Run(const std::string& file, vtkDataObject* model, const Options& given)
{
  vtkNURBSModelPool pool;
  const std::string problem = pool.Collect(model);
  if (!problem.empty() || pool.Model.Faces.empty())
  {
    std::printf(
      "%-28s no faces %s\n", std::filesystem::path(file).filename().c_str(), problem.c_str());
    return;
  }
  for (const nurbs::Vec3& direction : Directions)
  {
    nurbs::SilhouetteOptions options;
    options.View.Place = direction.normalized();
    options.Parallel = vtkNURBSParallelFor;
    options.Precision = given.Precision *
      nurbs::Diagonal(nurbs::FaceBoxes(pool.Model, pool.FaceErrors, vtkNURBSParallelFor));
    nurbs::Silhouettes result;
    const measuring::Stopwatch watch;
    result = nurbs::MakeSilhouettes(pool.Model, pool.FaceErrors, options);
    const measuring::Duration time = watch.Read();
    std::size_t points = 0;
    int counts[4] = { 0, 0, 0, 0 };
    for (const nurbs::SilhouetteLine& line : result.Lines)
    {
      points += line.Points.size();
    }
    for (const nurbs::FaceSilhouette& face : result.Faces)
    {
      ++counts[static_cast<int>(face.Status)];
    }
    std::printf("%-28s %6zu faces  %8.4f s (cpu %8.4f)  %6zu lines %5lld chains %7zu points  "
                "singular %d capped %d failed %d inexact %lld",
      std::filesystem::path(file).filename().c_str(), pool.Model.Faces.size(), time.Elapsed,
      time.Processor, result.Lines.size(), static_cast<long long>(result.Chains[0]), points,
      counts[1], counts[2], counts[3], static_cast<long long>(result.InexactPoints));
    if (given.Grid > 0)
    {
      Check(pool.Model, pool.FaceErrors, result, options, given.Grid);
    }
    std::printf("\n");
    std::fflush(stdout);
  }
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  int threads = 0;
  int patches = 0;
  std::vector<std::string> files;
  CLI::App app("Silhouettes of CAD files in three directions");
  app.add_option("--precision", options.Precision, "of the diagonal");
  app.add_option("--threads", threads, "0: as many as there are");
  app.add_option("--grid", options.Grid, "samples a side for the comparison; 0: none");
  app.add_option("--patches", patches, "of the car body; 0: none");
  app.add_option("files", files);
  CLI11_PARSE(app, argc, argv);
  if (threads > 0)
  {
    vtkSMPTools::Initialize(threads);
  }
  const vtkNURBSParallelScope parallel;
  if (patches > 0)
  {
    Run("car", MakeCar(patches), options);
  }
  for (const std::string& file : files)
  {
    Run(file, Read(file), options);
  }
  return 0;
}
