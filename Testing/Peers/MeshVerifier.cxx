// SPDX-License-Identifier: BSD-3-Clause
// Measures a mesh of a CAD file against the original shape, face by face; see --help.
#include "FaceCheck.h"
#include "OcctMesh.h"
#include "OpenEdges.h"
#include "ReferenceShape.h"
#include "vtkMeshInput.h"

#include <CLI/CLI.hpp>
#include <Standard_Failure.hxx>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <numeric>
#include <thread>

namespace
{

using namespace verify;

struct Arguments
{
  std::string File, Mesh, Report;
  double Relative = 1e-3, Absolute = 0.0, Density = 1.0;
  int Threads = 2, Listed = 20;
  bool Estimates = false;
  bool Diagonal = false;
};

Arguments Parse(int argc, char** argv, int* exitCode)
{
  Arguments a;
  CLI::App app{
    "Measures a mesh of a CAD file against the original shape that OpenCASCADE reads:\n"
    "distances both ways, areas, folded triangles, open edges. Without MESH it measures\n"
    "OpenCASCADE's own mesh. Exit status: 0 all within the tolerance, 1 not, 2 an error."
  };
  app.add_option("file", a.File, "STEP, IGES or BREP file")->required()->check(CLI::ExistingFile);
  app.add_option("mesh", a.Mesh, "Its mesh: .vtp with cell data FaceId")->check(CLI::ExistingFile);
  app.add_option("--tolerance", a.Relative, "Tolerance over the diagonal")->capture_default_str();
  app.add_option("--absolute", a.Absolute, "Tolerance in the model's unit instead");
  app.add_option("--density", a.Density, "Factor on the number of samples")->capture_default_str();
  app.add_option("--threads", a.Threads, "Faces measured at a time")->capture_default_str();
  app.add_option("--list", a.Listed, "At most so many failing faces listed")->capture_default_str();
  app.add_option("--json", a.Report, "Write every face's figures to this file");
  app.add_flag("--estimates", a.Estimates, "The mesh's own errors are estimates, no bounds");
  app.add_flag("--diagonal", a.Diagonal, "Only print faces and diagonal, measure nothing");
  try
  {
    app.parse(argc, argv);
  }
  catch (const CLI::ParseError& e)
  {
    *exitCode = app.exit(e) == 0 ? 0 : 2;
  }
  return a;
}

std::vector<FaceReport> CheckFaces(const ReferenceShape& shape, const std::vector<FaceMesh>& meshes,
  const CheckOptions& options, int threads)
{
  std::vector<FaceReport> reports(shape.Faces.size());
  std::vector<std::size_t> order(shape.Faces.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return meshes[a].Triangles.size() > meshes[b].Triangles.size();
  });
  std::atomic<std::size_t> next{ 0 };
  auto work = [&] {
    for (std::size_t i = next++; i < order.size(); i = next++)
    {
      const std::size_t f = order[i];
      try
      {
        reports[f] = CheckFace(shape.Faces[f], meshes[f], options);
      }
      catch (const Standard_Failure& failure)
      {
        std::cerr << "face " << f << ": " << failure.GetMessageString() << '\n';
        reports[f].MeshToFace = std::numeric_limits<double>::infinity();
      }
    }
  };
  std::vector<std::thread> pool;
  for (int t = 1; t < threads; ++t)
  {
    pool.emplace_back(work);
  }
  work();
  for (std::thread& t : pool)
  {
    t.join();
  }
  return reports;
}

struct Totals
{
  long Triangles = 0, Folded = 0, Degenerate = 0, Samples = 0;
  int Missing = 0, Over = 0, OverGap = 0, BadArea = 0, Uncertified = 0;
  double Error = 0.0, ErrorMinusGap = 0.0, AreaError = 0.0;
  std::vector<double> Ratios; ///< Certified over measured, where something was measured.
  double MedianRatio() const
  {
    std::vector<double> r = this->Ratios;
    std::sort(r.begin(), r.end());
    return r.empty() ? 0.0 : r[r.size() / 2];
  }
};

bool Undercuts(const FaceMesh& mesh, const FaceReport& r, double tolerance)
{
  return mesh.Certified >= 0.0 && r.Error() > mesh.Certified * (1.0 + 1e-9) + 1e-6 * tolerance;
}

Totals Sum(const std::vector<FaceMesh>& meshes, const std::vector<FaceReport>& reports,
  const std::vector<FaceGap>& gaps, double tolerance)
{
  Totals t;
  for (std::size_t f = 0; f < reports.size(); ++f)
  {
    const FaceReport& r = reports[f];
    t.Triangles += r.Triangles;
    t.Folded += r.Folded;
    t.Degenerate += r.Degenerate;
    t.Samples += r.Samples;
    t.Missing += r.Missing;
    if (r.Missing)
    {
      continue;
    }
    t.Over += r.Error() > tolerance * (1.0 + 1e-6);
    t.OverGap += r.Error() > (tolerance + gaps[f].Neighbours) * (1.0 + 1e-6);
    t.BadArea += !r.AreaAgrees(tolerance + gaps[f].Neighbours);
    t.Error = std::max(t.Error, r.Error());
    t.ErrorMinusGap = std::max(t.ErrorMinusGap, r.Error() - gaps[f].Neighbours);
    t.AreaError =
      std::max(t.AreaError, std::abs(r.MeshArea - r.ExactArea) / std::max(r.ExactArea, 1e-300));
    t.Uncertified += Undercuts(meshes[f], r, tolerance);
    if (meshes[f].Certified > 0.0 && r.Error() > 1e-6 * tolerance)
    {
      t.Ratios.push_back(meshes[f].Certified / r.Error());
    }
  }
  return t;
}

nlohmann::json FaceJson(std::size_t f, const TopoDS_Face& face, const FaceMesh& mesh,
  const FaceReport& r, const FaceGap& gap, double tolerance)
{
  nlohmann::json j{ { "face", f }, { "kind", SurfaceKind(face) }, { "triangles", r.Triangles },
    { "missing", r.Missing }, { "area", r.ExactArea }, { "own_gap", gap.Own / tolerance },
    { "gap", gap.Neighbours / tolerance }, { "folded", r.Folded }, { "degenerate", r.Degenerate } };
  if (!r.Missing)
  {
    j.update({ { "mesh_to_face", r.MeshToFace / tolerance },
      { "face_to_mesh", r.FaceToMesh / tolerance }, { "certified", mesh.Certified / tolerance },
      { "mesh_area", r.MeshArea }, { "area_spread", r.AreaSpread },
      { "area_agrees", r.AreaAgrees(tolerance + gap.Neighbours) },
      { "broken_wires", r.BrokenWires },
      { "worst_on_mesh", { r.WorstOnMesh[0], r.WorstOnMesh[1], r.WorstOnMesh[2] } },
      { "worst_on_face", { r.WorstOnFace[0], r.WorstOnFace[1], r.WorstOnFace[2] } } });
  }
  return j;
}

std::string Bound(const FaceMesh& mesh, double tolerance)
{
  return mesh.Certified < 0.0 ? "nothing" : std::to_string(mesh.Certified / tolerance) + " tol";
}

/// One line a face that fails in any respect, worst first.
void ListFailures(const Arguments& a, const ReferenceShape& shape,
  const std::vector<FaceMesh>& meshes, const std::vector<FaceReport>& reports,
  const std::vector<FaceGap>& gaps, double tolerance)
{
  std::vector<std::pair<double, std::size_t>> failing;
  for (std::size_t f = 0; f < reports.size(); ++f)
  {
    const FaceReport& r = reports[f];
    const bool over = r.Error() > tolerance * (1.0 + 1e-6);
    if (r.Missing || over || !r.AreaAgrees(tolerance + gaps[f].Neighbours) || r.Folded ||
      (!a.Estimates && Undercuts(meshes[f], r, tolerance)))
    {
      failing.emplace_back(-r.Error(), f);
    }
  }
  std::sort(failing.begin(), failing.end());
  for (std::size_t i = 0; i < failing.size() && i < std::size_t(std::max(0, a.Listed)); ++i)
  {
    const std::size_t f = failing[i].second;
    const FaceReport& r = reports[f];
    std::printf("  face %zu (%s): %s mesh->face %.4g tol, face->mesh %.4g tol, gap %.3g tol, "
                "certified %s, area %.6g of %.6g%s, %ld triangles, %ld folded%s\n",
      f, SurfaceKind(shape.Faces[f]).c_str(), r.Missing ? "MISSING," : "", r.MeshToFace / tolerance,
      r.FaceToMesh / tolerance, gaps[f].Neighbours / tolerance, Bound(meshes[f], tolerance).c_str(),
      r.MeshArea, r.ExactArea,
      r.Missing || r.AreaAgrees(tolerance + gaps[f].Neighbours) ? "" : " DIFFERS", r.Triangles,
      r.Folded, r.BrokenWires ? ", pcurves do not join" : "");
  }
  if (failing.size() > std::size_t(std::max(0, a.Listed)))
  {
    std::printf("  ... %zu failing faces in all\n", failing.size());
  }
}

void ListOpenEdges(const Arguments& a, const OpenEdgeReport& open)
{
  const std::size_t most = std::min(open.Faces.size(), std::size_t(std::max(0, a.Listed)));
  for (std::size_t i = 0; i < most; ++i)
  {
    std::printf("%s%d%s", i == 0 ? "  open edges or cracks on faces " : " ", open.Faces[i],
      i + 1 == most ? "\n" : "");
  }
  for (std::size_t i = 0; i < std::min(most, open.Examples.size()); ++i)
  {
    const auto& [face, ends] = open.Examples[i];
    std::printf("    face %d: %.17g %.17g %.17g to %.17g %.17g %.17g\n", face, ends[0][0],
      ends[0][1], ends[0][2], ends[1][0], ends[1][1], ends[1][2]);
  }
}

int Run(const Arguments& a)
{
  const auto start = std::chrono::steady_clock::now();
  const ReferenceShape shape = Describe(ReadShape(a.File));
  if (a.Diagonal)
  {
    std::printf("{\"faces\":%zu,\"diagonal\":%.17g}\n", shape.Faces.size(), shape.Diagonal);
    return 0;
  }
  const double tolerance = a.Absolute > 0.0 ? a.Absolute : a.Relative * shape.Diagonal;
  std::vector<FaceMesh> meshes;
  if (a.Mesh.empty())
  {
    MeshByOcct(shape.Root, tolerance, a.Threads > 1);
    meshes = TakeOcctMesh(shape);
  }
  else
  {
    meshes = ReadMesh(a.Mesh, int(shape.Faces.size()));
  }
  const std::vector<FaceGap> gaps = MeasureGaps(shape);
  CheckOptions options;
  options.Tolerance = tolerance;
  options.Density = a.Density;
  const auto reports = CheckFaces(shape, meshes, options, a.Threads);
  const Totals t = Sum(meshes, reports, gaps, tolerance);
  double largestGap = 0.0;
  for (const FaceGap& gap : gaps)
  {
    largestGap = std::max(largestGap, gap.Own);
  }
  const OpenEdgeReport open = FindOpenEdges(shape, meshes, 2.0 * (tolerance + largestGap));
  const double seconds =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const std::string name = a.File.substr(a.File.rfind('/') + 1);
  const bool good = t.OverGap == 0 && t.Missing == 0 && t.BadArea == 0 && t.Folded == 0 &&
    (a.Estimates || t.Uncertified == 0) && open.OpenEdges == 0 && open.Cracks == 0;
  std::printf(
    "%s %s: faces %zu, triangles %ld, error/tol %.4g (less gaps %.4g), faces over %d "
    "(%d despite gaps), missing %d, area error %.3g (%d beyond allowance), folded %ld, "
    "open edges %ld in %d closed bodies, cracks %ld in %d open ones, misdirected %ld, "
    "certified/measured %.3g (undercut on %d), largest gap/tol %.3g, %.3g M samples, %.1f s\n",
    good ? "ok  " : "FAIL", name.c_str(), reports.size(), t.Triangles, t.Error / tolerance,
    t.ErrorMinusGap / tolerance, t.Over, t.OverGap, t.Missing, t.AreaError, t.BadArea, t.Folded,
    open.OpenEdges, open.ClosedBodies, open.Cracks, open.OpenBodies, open.Misdirected,
    t.MedianRatio(), t.Uncertified, largestGap / tolerance, double(t.Samples) * 1e-6, seconds);
  if (!good)
  {
    ListFailures(a, shape, meshes, reports, gaps, tolerance);
    ListOpenEdges(a, open);
  }
  if (!a.Report.empty())
  {
    nlohmann::json faces = nlohmann::json::array();
    for (std::size_t f = 0; f < reports.size(); ++f)
    {
      faces.push_back(FaceJson(f, shape.Faces[f], meshes[f], reports[f], gaps[f], tolerance));
    }
    std::ofstream(a.Report) << nlohmann::json{ { "file", name }, { "ok", good },
      { "diagonal", shape.Diagonal }, { "tolerance", tolerance }, { "faces", reports.size() },
      { "triangles", t.Triangles }, { "error", t.Error / tolerance },
      { "error_less_gap", t.ErrorMinusGap / tolerance }, { "faces_over", t.Over },
      { "faces_over_gap", t.OverGap }, { "missing", t.Missing }, { "area_error", t.AreaError },
      { "area_bad", t.BadArea }, { "folded", t.Folded }, { "degenerate", t.Degenerate },
      { "closed_bodies", open.ClosedBodies }, { "open_edges", open.OpenEdges },
      { "open_bodies", open.OpenBodies }, { "cracks", open.Cracks },
      { "misdirected", open.Misdirected }, { "certified_ratio", t.MedianRatio() },
      { "undercut", t.Uncertified }, { "gap", largestGap / tolerance }, { "samples", t.Samples },
      { "seconds", seconds }, { "face", faces } };
  }
  return good ? 0 : 1;
}

} // namespace

int main(int argc, char** argv)
{
  int exitCode = -1;
  const Arguments arguments = Parse(argc, argv, &exitCode);
  if (exitCode >= 0)
  {
    return exitCode;
  }
  try
  {
    return Run(arguments);
  }
  catch (const Standard_Failure& failure)
  {
    std::cerr << arguments.File << ": " << failure.GetMessageString() << '\n';
  }
  catch (const std::exception& e)
  {
    std::cerr << arguments.File << ": " << e.what() << '\n';
  }
  return 2;
}
