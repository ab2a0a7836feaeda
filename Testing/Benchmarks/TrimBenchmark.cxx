// SPDX-License-Identifier: BSD-3-Clause
// Points in trimmed faces: size and speed of nurbs::TrimIndex on CAD files, a line a file, and whether
// it agrees with the tessellator on what is inside.
#include "Measuring.h"
#include "Tessellator.h"
#include "TrimIndex.h"
#include "vtkNURBSCADReader.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"

#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

namespace
{

using nurbs::Vec2;

struct Figures
{
  std::int64_t Trimmed = 0, Pieces = 0, Bytes = 0, Queries = 0, Inside = 0, Visits = 0;
  int Most = 0;
  double BuildSeconds = 0.0, QuerySeconds = 0.0;
  int Disagree = 0; ///< Faces without defects whose area differs by over 0.005 of the domain.
  int DisagreeRepaired = 0; ///< Faces that the tessellator repaired.
};

constexpr int Side = 64; // samples a face: Side x Side

/// A sample of the face's domain, one a cell of a grid.
std::vector<Vec2> Samples(const nurbs::SurfaceView& surface)
{
  std::mt19937 random(1);
  std::uniform_real_distribution<double> in(0.0, 1.0);
  std::vector<Vec2> samples;
  for (int k = 0; k < Side * Side; ++k)
  {
    const Vec2 p((k % Side + in(random)) / Side, (k / Side + in(random)) / Side);
    samples.emplace_back(surface.Domain(0).Min + p[0] * surface.Domain(0).Length(),
      surface.Domain(1).Min + p[1] * surface.Domain(1).Length());
  }
  return samples;
}

/// The part of the domain that the triangles cover.
double CoveredPart(const nurbs::FaceMesh& mesh, const nurbs::SurfaceView& surface)
{
  double area = 0.0;
  for (std::size_t t = 0; t < mesh.Triangles.size(); t += 3)
  {
    const auto corner = [&](std::size_t k) -> const Vec2& {
      return mesh.UV[static_cast<std::size_t>(mesh.Triangles[t + k])];
    };
    const Vec2 b = corner(1) - corner(0);
    const Vec2 c = corner(2) - corner(0);
    area += 0.5 * std::abs(b[0] * c[1] - b[1] * c[0]);
  }
  return area / (surface.Domain(0).Length() * surface.Domain(1).Length());
}

Figures Measure(const nurbs::Model& model, const nurbs::TessellationResult& meshes)
{
  Figures out;
  nurbs::TrimIndex index;
  out.BuildSeconds = measuring::MedianTime(5, [&] { index = nurbs::TrimIndex(model); }).Processor;
  for (std::int64_t f = 0; f < index.FaceCount(); ++f)
  {
    const nurbs::FaceTrim& face = index.Face(f);
    const nurbs::SurfaceView& surface = model.Faces[static_cast<std::size_t>(f)].Geometry;
    if (face.IsWhole() || surface.Size() == 0)
    {
      continue;
    }
    ++out.Trimmed;
    out.Pieces += face.PieceCount();
    out.Bytes += 16 * (face.PointTexelCount() + face.RecordTexelCount());
    const std::vector<Vec2> samples = Samples(surface);
    int inside = 0;
    const measuring::Stopwatch watch;
    for (const Vec2& p : samples)
    {
      inside += face.Inside(p[0], p[1]);
    }
    out.QuerySeconds += watch.Read().Processor;
    out.Inside += inside;
    out.Queries += std::int64_t(samples.size());
    for (const Vec2& p : samples)
    {
      int visited = 0;
      face.Inside(p[0], p[1], visited);
      out.Visits += visited;
      out.Most = std::max(out.Most, visited);
    }
    const nurbs::FaceMesh& mesh = meshes.Meshes[static_cast<std::size_t>(f)];
    if (std::abs(double(inside) / (Side * Side) - CoveredPart(mesh, surface)) > 0.005)
    {
      const bool sound = mesh.Status == nurbs::FaceStatus::Ok;
      ++(sound ? out.Disagree : out.DisagreeRepaired);
      std::fprintf(stderr, "face %lld: inside %.4f, triangles %.4f %s\n", static_cast<long long>(f),
        double(inside) / (Side * Side), CoveredPart(mesh, surface), mesh.Message.c_str());
    }
  }
  return out;
}

bool Report(const char* file)
{
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(file);
  reader->SingleModelOn();
  reader->Update();
  auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(reader->GetOutputDataObject(0));
  auto* grid = vtkUnstructuredGrid::SafeDownCast(
    collection && collection->GetNumberOfPartitionedDataSets() > 0 ? collection->GetPartition(0, 0)
                                                                   : nullptr);
  if (!grid || grid->GetNumberOfCells() == 0)
  {
    std::fprintf(stderr, "%s: no faces were read\n", file);
    return false;
  }
  const auto view = vtkNURBSModel::View(grid);
  std::vector<std::string> errors;
  for (vtkIdType face = 0; face < grid->GetNumberOfCells(); ++face)
  {
    errors.push_back(view->GetFaceError(face));
  }
  nurbs::TessellatorOptions options;
  options.Tolerance = 1e-6 * grid->GetLength();
  const nurbs::Model& model = view->GetModel();
  const Figures f = Measure(model, nurbs::Tessellate(model, errors, options));
  const std::string path(file);
  const double queries = double(std::max<std::int64_t>(1, f.Queries));
  std::printf("| %s | %zu | %lld | %lld | %.0f | %.1f | %.0f | %.2f | %d | %d | %d |\n",
    path.substr(path.rfind('/') + 1).c_str(), model.Faces.size(), static_cast<long long>(f.Trimmed),
    static_cast<long long>(f.Pieces), double(f.Bytes) / double(std::max<std::int64_t>(1, f.Pieces)),
    1e6 * f.BuildSeconds / double(std::max<std::int64_t>(1, f.Pieces)),
    1e9 * f.QuerySeconds / queries, double(f.Visits) / queries, f.Most, f.Disagree,
    f.DisagreeRepaired);
  return true;
}

} // namespace

int main(int argc, char** argv)
{
  if (argc < 2)
  {
    std::fprintf(stderr, "usage: TrimBenchmark FILE... (STEP, IGES or BREP)\n");
    return 2;
  }
  std::printf("| file | faces | trimmed | pieces | bytes/piece | build, us/piece | query, ns "
              "| visited, mean | most | differ | differ, repaired |\n"
              "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  bool good = true;
  for (int k = 1; k < argc; ++k)
  {
    good = Report(argv[k]) && good;
  }
  return good ? 0 : 1;
}
