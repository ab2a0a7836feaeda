// SPDX-License-Identifier: BSD-3-Clause
// Rays a second through exact models, in one thread: RayBenchmark [--rays N] [--patches N]
// [FILE...]. Without a file: analytic shapes. One line a model (of a file: its largest one) and
// kind of rays: lines through random points of its box in random directions, and the parallel rays
// of a picture along x, which meet many planes and cylinders at a grazing angle. "uneven" counts
// lines along which hits do not enter and leave by turns: none for a sound solid, save at vertices
// that they meet.
#include "Measuring.h"
#include "RayCaster.h"
#include "vtkNURBSCADReader.h"
#include "vtkNURBSCellLocator.h"
#include "vtkNURBSShapeSource.h"

#include <CLI/CLI.hpp>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkUnstructuredGrid.h>

#include <cstdio>
#include <filesystem>
#include <random>

namespace
{

using Grid = vtkSmartPointer<vtkUnstructuredGrid>;

Grid ReadLargest(const std::string& file)
{
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  Grid largest;
  vtkPartitionedDataSetCollection* output = reader->GetOutput();
  for (unsigned int i = 0; i < output->GetNumberOfPartitionedDataSets(); ++i)
  {
    for (unsigned int j = 0; j < output->GetNumberOfPartitions(i); ++j)
    {
      auto* grid = vtkUnstructuredGrid::SafeDownCast(output->GetPartitionAsDataObject(i, j));
      if (grid && (!largest || grid->GetNumberOfCells() > largest->GetNumberOfCells()))
      {
        largest = grid;
      }
    }
  }
  return largest;
}

Grid MakeShape(int shape, int patches)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(shape);
  source->SetNumberOfPatches(patches);
  source->SetPlateHoles(20, 20);
  source->Update();
  return vtkUnstructuredGrid::SafeDownCast(source->GetOutputDataObject(0));
}

std::vector<nurbs::Ray> RandomLines(const nurbs::Box3& box, int count)
{
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::normal_distribution<double> normal;
  std::vector<nurbs::Ray> rays(count);
  for (nurbs::Ray& ray : rays)
  {
    const nurbs::Vec3 at(part(engine), part(engine), part(engine));
    ray.Direction = nurbs::Vec3(normal(engine), normal(engine), normal(engine)).normalized();
    ray.Origin =
      box.min() + at.cwiseProduct(box.sizes()) - 2.0 * box.diagonal().norm() * ray.Direction;
  }
  return rays;
}

std::vector<nurbs::Ray> PictureRays(const nurbs::Box3& box, int count)
{
  const int side = std::max(1, static_cast<int>(std::sqrt(count)));
  std::vector<nurbs::Ray> rays;
  for (int k = 0; k < side * side; ++k)
  {
    const nurbs::Vec3 at(-1.0, (k % side + 0.5) / side, (k / side + 0.5) / side);
    rays.emplace_back();
    rays.back().Direction = nurbs::Vec3::UnitX();
    rays.back().Origin = box.min() + at.cwiseProduct(box.sizes());
  }
  return rays;
}

void Measure(const std::string& name, const nurbs::RayCaster& caster, double build,
  const char* kind, const std::vector<nurbs::Ray>& rays)
{
  std::int64_t hit = 0, hits = 0, uneven = 0;
  double slowest = 0.0;
  nurbs::RayHit first;
  const measuring::Stopwatch nearest;
  for (const nurbs::Ray& ray : rays)
  {
    hit += caster.Nearest(ray, first) ? 1 : 0;
  }
  const double nearestTime = nearest.Read().Processor;
  std::vector<nurbs::RayHit> found;
  const measuring::Stopwatch all;
  double before = 0.0;
  for (const nurbs::Ray& ray : rays)
  {
    caster.All(ray, found);
    int depth = 0;
    bool turns = true;
    for (const nurbs::RayHit& one : found)
    {
      depth += one.Crossing;
      turns = turns && (depth == 0 || depth == 1);
    }
    hits += static_cast<std::int64_t>(found.size());
    uneven += turns && depth == 0 ? 0 : 1;
    const double now = all.Read().Processor;
    slowest = std::max(slowest, now - before);
    before = now;
  }
  const double count = static_cast<double>(rays.size());
  std::printf("%-22s %6lld %8lld %7.2f %8.1f  %-7s %9.0f %9.0f %6.1f%% %6.2f %8.0f %8lld\n",
    name.c_str(), static_cast<long long>(caster.GetModel().Faces.size()),
    static_cast<long long>(caster.PartCount()), build, 1e-6 * caster.MemoryUse(), kind,
    count / nearestTime, count / all.Read().Processor, 100.0 * hit / count, hits / count,
    1e6 * slowest, static_cast<long long>(uneven));
}

void Report(const std::string& name, vtkUnstructuredGrid* grid, int count)
{
  if (!grid)
  {
    std::printf("%-22s no faces\n", name.c_str());
    return;
  }
  vtkNew<vtkNURBSCellLocator> locator;
  locator->SetDataSet(grid);
  const measuring::Stopwatch building;
  const auto caster = locator->GetRayCaster();
  const double build = building.Read().Processor;
  if (caster)
  {
    Measure(name, *caster, build, "random", RandomLines(caster->Bounds(), count));
    Measure(name, *caster, build, "picture", PictureRays(caster->Bounds(), count));
  }
}

} // namespace

int main(int argc, char** argv)
{
  CLI::App app("Rays a second through exact models");
  int rays = 200000;
  int patches = 31040;
  std::vector<std::string> files;
  app.add_option("--rays", rays, "Rays of each kind");
  app.add_option("--patches", patches, "Patches of the car body");
  app.add_option("files", files, "STEP, IGES or BREP files");
  CLI11_PARSE(app, argc, argv);
  std::printf("%-22s %6s %8s %7s %8s  %-7s %9s %9s %7s %6s %8s %8s\n", "model", "faces", "parts",
    "build_s", "MB", "rays", "nearest/s", "all/s", "hit", "hits", "worst_us", "uneven");
  for (const std::string& file : files)
  {
    Report(std::filesystem::path(file).filename().string(), ReadLargest(file), rays);
  }
  if (files.empty())
  {
    Report("sphere", MakeShape(vtkNURBSShapeSource::SPHERE, patches), rays);
    Report("torus", MakeShape(vtkNURBSShapeSource::TORUS, patches), rays);
    Report("cylinder", MakeShape(vtkNURBSShapeSource::CYLINDER, patches), rays);
    Report("plate, 400 holes", MakeShape(vtkNURBSShapeSource::PLATE, patches), rays);
    Report("teapot", MakeShape(vtkNURBSShapeSource::TEAPOT, patches), rays);
    Report("car body", MakeShape(vtkNURBSShapeSource::CAR_BODY, patches), rays);
  }
  return 0;
}
