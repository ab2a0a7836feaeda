// SPDX-License-Identifier: BSD-3-Clause
// Compares the model that vtkNURBSCADReader makes of a file with the original shape, face by face:
// surfaces, trimming loops, edges, orientation; see --help.
#include "ModelFaceCheck.h"
#include "ReferenceShape.h"

#include "vtkNURBSCADReader.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"

#include <CLI/CLI.hpp>
#include <Standard_Failure.hxx>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

namespace
{

using namespace verify;

int Run(const std::string& file, double limit, int listed)
{
  const ReferenceShape shape = Describe(ReadShape(file));
  const std::vector<FaceGap> gaps = MeasureGaps(shape);
  std::vector<ModelFaceReport> reports(shape.Faces.size());
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(file.c_str());
  reader->SingleModelOn();
  reader->Update();
  auto* grid = vtkUnstructuredGrid::SafeDownCast(reader->GetOutput()->GetPartition(0, 0));
  const auto view = vtkNURBSModel::View(grid);
  int bad = 0;
  for (vtkIdType cell = 0; grid && cell < grid->GetNumberOfCells(); ++cell)
  {
    const vtkIdType id = vtkNURBSModel::GetFaceId(grid, cell);
    if (id < 0 || id >= vtkIdType(reports.size()) || !view->GetFaceError(cell).empty())
    {
      std::printf("  cell %lld: FaceId %lld of %zu faces %s\n", static_cast<long long>(cell),
        static_cast<long long>(id), reports.size(), view->GetFaceError(cell).c_str());
      ++bad;
      continue;
    }
    reports[std::size_t(id)] = CheckModelFace(
      shape.Faces[std::size_t(id)], view->GetModel(), std::size_t(cell), shape.Diagonal);
  }
  ModelFaceReport worst;
  for (std::size_t f = 0; f < reports.size(); ++f)
  {
    const ModelFaceReport& r = reports[f];
    const double scale = shape.Diagonal, allowed = limit * scale + 1.05 * gaps[f].Own;
    worst.Surface = std::max(worst.Surface, r.Surface);
    worst.Loops = std::max(worst.Loops, r.Loops);
    worst.Boundary = std::max(worst.Boundary, r.Boundary);
    worst.Edges = std::max(worst.Edges, r.Edges);
    worst.Excess = std::max(worst.Excess, r.Excess);
    worst.LoopGap = std::max(worst.LoopGap, r.LoopGap);
    const bool fails = !r.Seen || r.Inverted || r.Surface > allowed || r.Loops > allowed ||
      r.Edges > allowed || r.LoopGap > allowed || (r.Area <= 0.0 && r.Loops > 0.0);
    if (fails && bad++ < listed)
    {
      std::printf(
        "  face %zu (%s):%s%s surface %.2e, loops %.2e, boundary %.2e, edges %.2e (beyond "
        "tolerance %.2e), loop gaps %.2e, (u,v) area %.2e; original's own gap %.2e\n",
        f, SurfaceKind(shape.Faces[f]).c_str(), r.Seen ? "" : " NOT THERE,",
        r.Inverted ? " INVERTED," : "", r.Surface / scale, r.Loops / scale, r.Boundary / scale,
        r.Edges / scale, r.Excess / scale, r.LoopGap / scale, r.Area, gaps[f].Own / scale);
    }
  }
  std::printf("%s %s: %zu faces, %d bad; over the diagonal: surface %.2e, loops %.2e, boundary "
              "%.2e, edges %.2e (beyond tolerance %.2e), loop gaps %.2e\n",
    bad == 0 ? "ok  " : "FAIL", file.substr(file.rfind('/') + 1).c_str(), reports.size(), bad,
    worst.Surface / shape.Diagonal, worst.Loops / shape.Diagonal, worst.Boundary / shape.Diagonal,
    worst.Edges / shape.Diagonal, worst.Excess / shape.Diagonal, worst.LoopGap / shape.Diagonal);
  return bad == 0 ? 0 : 1;
}

} // namespace

int main(int argc, char** argv)
{
  std::string file;
  double limit = 1e-6;
  int listed = 20;
  CLI::App app{ "Compares the exact model read from a CAD file with the original shape.\n"
                "Exit status: 0 all agree, 1 not, 2 an error." };
  app.add_option("file", file, "STEP, IGES or BREP file")->required()->check(CLI::ExistingFile);
  app
    .add_option("--limit", limit,
      "Deviation allowed beyond the original's own gaps, over the "
      "diagonal")
    ->capture_default_str();
  app.add_option("--list", listed, "At most so many failing faces listed")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try
  {
    return Run(file, limit, listed);
  }
  catch (const Standard_Failure& failure)
  {
    std::cerr << file << ": " << failure.GetMessageString() << '\n';
  }
  catch (const std::exception& e)
  {
    std::cerr << e.what() << '\n';
  }
  return 2;
}
