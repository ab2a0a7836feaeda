// SPDX-License-Identifier: BSD-3-Clause
// Reads CAD files as models, writes these with vtkNURBSCADWriter, and compares what OpenCASCADE and
// vtkNURBSCADReader read of that with the models; one line a file and format, see --help.
#include "ModelFaceCheck.h"
#include "ReferenceShape.h"

#include "vtkNURBSCADReader.h"
#include "vtkNURBSCADWriter.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <CLI/CLI.hpp>
#include <GProp_GProps.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>

namespace
{

using namespace verify;

/// What there is in a shape.
struct Counts
{
  int Faces = 0, Solids = 0, SharedEdges = 0, Invalid = 0;
  int Elementary = 0; // Faces on planes, cylinders, cones, spheres and tori.
  double Area = 0.0;
};

double AreaOf(const TopoDS_Shape& shape)
{
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(shape, properties, 1e-6);
  return properties.Mass();
}

Counts CountShape(const ReferenceShape& shape)
{
  Counts counts;
  counts.Faces = static_cast<int>(shape.Faces.size());
  for (TopExp_Explorer it(shape.Root, TopAbs_SOLID); it.More(); it.Next())
  {
    ++counts.Solids;
  }
  TopTools_IndexedDataMapOfShapeListOfShape uses;
  TopExp::MapShapesAndAncestors(shape.Root, TopAbs_EDGE, TopAbs_FACE, uses);
  for (int i = 1; i <= uses.Extent(); ++i)
  {
    counts.SharedEdges += uses(i).Extent() > 1 ? 1 : 0;
  }
  const BRepCheck_Analyzer analyzer(shape.Root);
  for (const TopoDS_Face& face : shape.Faces)
  {
    counts.Invalid += analyzer.IsValid(face) ? 0 : 1;
    counts.Area += AreaOf(face);
    counts.Elementary += BRepAdaptor_Surface(face).GetType() <= GeomAbs_Torus ? 1 : 0;
  }
  return counts;
}

vtkSmartPointer<vtkUnstructuredGrid> ReadModel(const std::string& file)
{
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(file.c_str());
  reader->SingleModelOn();
  reader->Update();
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  if (auto* read = reader->GetOutput()->GetNumberOfPartitionedDataSets() > 0
      ? vtkUnstructuredGrid::SafeDownCast(reader->GetOutput()->GetPartition(0, 0))
      : nullptr)
  {
    grid->ShallowCopy(read);
  }
  return grid;
}

struct Deviations
{
  double Surface = 0.0, Loops = 0.0, Area = 0.0;
  int Inverted = 0, Lost = 0;
};

/// Where a face is and how it spreads: its middle, and square roots of its area and of its second
/// moments about the axes, all lengths.
using Traits = Eigen::Matrix<double, 10, 1>;

Traits TraitsOf(const TopoDS_Face& face)
{
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties);
  const gp_Pnt middle = properties.CentreOfMass();
  const gp_Mat inertia = properties.MatrixOfInertia();
  const double area = std::max(properties.Mass(), 1e-300);
  const auto length = [&](double moment) {
    return std::copysign(std::sqrt(std::abs(moment) / area), moment);
  };
  Traits traits;
  traits << middle.X(), middle.Y(), middle.Z(), std::sqrt(area), length(inertia(1, 1)),
    length(inertia(2, 2)), length(inertia(3, 3)), length(inertia(1, 2)), length(inertia(1, 3)),
    length(inertia(2, 3));
  return traits;
}

/// The face of the shape that each original face was written as. Writers put faces of one body
/// together, so it is searched: the one that is most alike.
std::vector<int> MatchFaces(const ReferenceShape& original, const ReferenceShape& written)
{
  std::vector<Traits> traits;
  std::vector<bool> taken(written.Faces.size(), false);
  for (const TopoDS_Face& face : written.Faces)
  {
    traits.push_back(TraitsOf(face));
  }
  std::vector<int> matches;
  for (const TopoDS_Face& face : original.Faces)
  {
    const Traits own = TraitsOf(face);
    int best = -1;
    for (std::size_t i = 0; i < traits.size(); ++i)
    {
      if (!taken[i] &&
        (best < 0 || (traits[i] - own).norm() < (traits[std::size_t(best)] - own).norm()))
      {
        best = static_cast<int>(i);
      }
    }
    if (best >= 0)
    {
      taken[std::size_t(best)] = true;
    }
    matches.push_back(best);
  }
  return matches;
}

Deviations Compare(vtkUnstructuredGrid* grid, const ReferenceShape& original,
  const ReferenceShape& written, bool listed)
{
  Deviations worst;
  const auto view = vtkNURBSModel::View(grid);
  const std::vector<int> matches = MatchFaces(original, written);
  double total = 0.0;
  for (const TopoDS_Face& face : original.Faces)
  {
    total += AreaOf(face);
  }
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    const std::size_t id = std::size_t(vtkNURBSModel::GetFaceId(grid, cell));
    if (matches[id] < 0)
    {
      ++worst.Lost;
      continue;
    }
    const TopoDS_Face& face = written.Faces[std::size_t(matches[id])];
    const ModelFaceReport r =
      CheckModelFace(face, view->GetModel(), std::size_t(cell), original.Diagonal);
    const double area = std::abs(AreaOf(face) - AreaOf(original.Faces[id])) / total;
    if (listed && (std::max(r.Surface, r.Loops) > 1e-6 * original.Diagonal || area > 1e-6))
    {
      std::printf("  face %zu (%s): surface %.1e, loops %.1e, area %.1e%s\n", id,
        SurfaceKind(original.Faces[id]).c_str(), r.Surface / original.Diagonal,
        r.Loops / original.Diagonal, area, r.Inverted ? ", INVERTED" : "");
    }
    worst.Surface = std::max(worst.Surface, r.Surface);
    worst.Loops = std::max(worst.Loops, r.Loops);
    worst.Area += area;
    worst.Inverted += r.Inverted ? 1 : 0;
  }
  return worst;
}

/// Over all files, by format.
struct Total
{
  int Files = 0, Agreeing = 0;
  long long Cells = 0, Faces = 0, Invalid = 0, Shared = 0, Elementary = 0;
  Counts Before, After;
  std::vector<double> Surface; // Over the diagonal.
};
std::map<std::string, Total> Totals;

/// False if a face is lost, turned or off by more than `limit` of the diagonal.
bool Report(const std::string& file, const std::string& ending, double limit, bool listed)
{
  const std::filesystem::path out = std::filesystem::temp_directory_path() /
    ("roundtrip-" + std::to_string(getpid()) + "." + ending);
  const ReferenceShape original = Describe(ReadShape(file));
  const auto grid = ReadModel(file);
  vtkNew<vtkNURBSCADWriter> writer;
  writer->SetInputData(grid);
  writer->SetFileName(out.c_str());
  if (!writer->Write())
  {
    std::printf(
      "%-22s %-5s FAILED\n", std::filesystem::path(file).filename().c_str(), ending.c_str());
    return false;
  }
  const ReferenceShape written = Describe(ReadShape(out.string()));
  const Counts before = CountShape(original), after = CountShape(written);
  const Deviations off = Compare(grid, original, written, listed);
  const auto again = ReadModel(out.string());
  std::printf(
    "%-22s %-5s %5lld/%-5lld %5d %5lld %6d %6lld %3d %3d %4lld %4d %4d %8.1e %8.1e %8.1e %8.1e%s\n",
    std::filesystem::path(file).filename().c_str(), ending.c_str(),
    static_cast<long long>(writer->GetNumberOfFaces()),
    static_cast<long long>(grid->GetNumberOfCells()), after.Faces,
    static_cast<long long>(again->GetNumberOfCells()), before.SharedEdges,
    static_cast<long long>(writer->GetNumberOfSharedEdges()), before.Solids, after.Solids,
    static_cast<long long>(writer->GetNumberOfInvalidFaces()), before.Invalid, after.Invalid,
    off.Surface / original.Diagonal, off.Loops / original.Diagonal, off.Area,
    writer->GetEdgeTolerance() / original.Diagonal, off.Inverted > 0 ? " TURNED" : "");
  std::fflush(stdout);
  std::filesystem::remove(out);
  const bool agrees = off.Inverted == 0 && off.Lost == 0 &&
    std::max(off.Surface, off.Loops) <= limit * original.Diagonal &&
    again->GetNumberOfCells() >= writer->GetNumberOfFaces();
  Total& total = Totals[ending];
  ++total.Files;
  total.Agreeing += agrees ? 1 : 0;
  total.Cells += grid->GetNumberOfCells();
  total.Faces += writer->GetNumberOfFaces();
  total.Invalid += writer->GetNumberOfInvalidFaces();
  total.Shared += writer->GetNumberOfSharedEdges();
  total.Elementary += writer->GetNumberOfAnalyticFaces();
  for (const auto& [sum, one] :
    { std::pair(&total.Before, &before), std::pair(&total.After, &after) })
  {
    sum->Solids += one->Solids;
    sum->SharedEdges += one->SharedEdges;
    sum->Invalid += one->Invalid;
    sum->Elementary += one->Elementary;
  }
  total.Surface.push_back(off.Surface / original.Diagonal);
  return agrees;
}

void PrintTotal(const std::string& format, Total& total, double limit)
{
  std::sort(total.Surface.begin(), total.Surface.end());
  std::printf(
    "%s: %d of %d files agree within %g of the diagonal, and their surfaces within %.0e, as "
    "the median has it;\n"
    "  faces written %lld of %lld; shared edges %lld of %d; solids read %d of %d;\n"
    "  elementary surfaces written %lld, read %d, in the originals %d;\n"
    "  faces not valid: as written %lld, as read %d, in the originals %d\n",
    format.c_str(), total.Agreeing, total.Files, limit, total.Surface[total.Surface.size() / 2],
    total.Faces, total.Cells, total.Shared, total.Before.SharedEdges, total.After.Solids,
    total.Before.Solids, total.Elementary, total.After.Elementary, total.Before.Elementary,
    total.Invalid, total.After.Invalid, total.Before.Invalid);
}

} // namespace

int main(int argc, char** argv)
{
  std::vector<std::string> files, formats{ "step", "iges", "brep" };
  double limit = 1e-4;
  bool listed = false;
  CLI::App app{
    "Reads files as models, writes these again and compares: OpenCASCADE's faces of the written\n"
    "file against the models' faces, densely.\n"
    "Columns: faces written and of the model; faces that OpenCASCADE and we read again; shared "
    "edges\n"
    "of the original and as written; solids of the original and of the written file; faces that\n"
    "BRepCheck_Analyzer finds fault with: as written, of the original file, of the written file; "
    "then,\n"
    "over the diagonal: points of the model's surfaces from the written faces, of their "
    "boundaries\n"
    "both ways; the differences of areas, of the whole; the largest edge tolerance written.\n"
    "Exit status: 0 all agree, 1 not, 2 an error."
  };
  app.add_option("files", files, "STEP, IGES and BREP files")->required();
  app.add_option("--format", formats, "Endings of what is written")->capture_default_str();
  app.add_option("--limit", limit, "Deviation allowed, over the diagonal")->capture_default_str();
  app.add_flag("--list", listed, "List faces that are off by more than 1e-6");
  CLI11_PARSE(app, argc, argv);
  std::printf("%-22s %-5s %11s %5s %5s %6s %6s %3s %3s %4s %4s %4s %8s %8s %8s %8s\n", "file", "as",
    "faces", "OCCT", "ours", "shared", "written", "sol", "sol", "bad", "orig", "read", "surface",
    "loops", "area", "tol");
  int status = 0;
  for (const std::string& file : files)
  {
    for (const std::string& format : formats)
    {
      try
      {
        status = Report(file, format, limit, listed) ? status : std::max(status, 1);
      }
      catch (const Standard_Failure& failure)
      {
        std::cerr << file << ": " << failure.GetMessageString() << '\n';
        status = 2;
      }
      catch (const std::exception& error)
      {
        std::cerr << file << ": " << error.what() << '\n';
        status = 2;
      }
    }
  }
  for (auto& [format, total] : Totals)
  {
    PrintTotal(format, total, limit);
  }
  return status;
}
