// SPDX-License-Identifier: BSD-3-Clause
// Reads CAD files with vtkNURBSCADReader and prints one line each: what came in, how exact, how fast.
// Exit status 1 if a face was not converted, a model is invalid, or a file with faces was not read.
#include "vtkNURBSCADReader.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"

#include <CLI/CLI.hpp>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkUnstructuredGrid.h>

#include <cstdio>
#include <filesystem>

namespace
{

struct Row
{
  long Faces = 0, Edges = 0, Unconverted = 0, Invalid = 0;
  double ConversionError = 0.0, EdgeTolerance = 0.0, Diagonal = 0.0;
};

void Add(vtkUnstructuredGrid* grid, nurbs::Box3& box, Row& row)
{
  const auto view = vtkNURBSModel::View(grid);
  row.Faces += grid->GetNumberOfCells();
  row.Edges += static_cast<long>(view->GetModel().Edges.size());
  row.Unconverted += static_cast<long>(vtkNURBSModel::GetUnconvertedFaces(grid).size());
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    row.Invalid += view->GetFaceError(cell).empty() ? 0 : 1;
  }
  for (const nurbs::Edge& edge : view->GetModel().Edges)
  {
    row.EdgeTolerance = std::max(row.EdgeTolerance, edge.Tolerance);
  }
  for (const nurbs::Vec3& vertex : view->GetModel().Vertices)
  {
    box.extend(vertex);
  }
  if (auto* errors = vtkDoubleArray::SafeDownCast(grid->GetCellData()->GetArray("ConversionError")))
  {
    row.ConversionError = std::max(row.ConversionError, errors->GetRange()[1]);
  }
}

bool Report(const std::string& file)
{
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  Row row;
  nurbs::Box3 box;
  vtkPartitionedDataSetCollection* output = reader->GetOutput();
  for (unsigned int i = 0; i < output->GetNumberOfPartitionedDataSets(); ++i)
  {
    Add(vtkUnstructuredGrid::SafeDownCast(output->GetPartitionAsDataObject(i, 0)), box, row);
  }
  row.Diagonal = box.isEmpty() ? 1.0 : box.diagonal().norm();
  std::printf("%-34s %5u %6ld %6ld %5ld %5ld %9.1e %9.1e %8.3f %8.3f\n",
    std::filesystem::path(file).filename().c_str(), output->GetNumberOfPartitionedDataSets(),
    row.Faces, row.Edges, row.Unconverted, row.Invalid, row.ConversionError / row.Diagonal,
    row.EdgeTolerance / row.Diagonal, reader->GetParseSeconds(), reader->GetConvertSeconds());
  std::fflush(stdout);
  return reader->GetErrorCode() == 0 && row.Unconverted == 0 && row.Invalid == 0;
}

} // namespace

int main(int argc, char** argv)
{
  CLI::App app("Reads CAD files as exact models and tells how exact and how fast.");
  std::vector<std::string> files;
  app.add_option("files", files, "STEP, IGES and BREP files")->required();
  CLI11_PARSE(app, argc, argv);
  std::printf("%-34s %5s %6s %6s %5s %5s %9s %9s %8s %8s\n", "file (lengths over the diagonal)",
    "model", "faces", "edges", "lost", "bad", "surface", "edge tol", "OCCT s", "ours s");
  bool good = true;
  for (const std::string& file : files)
  {
    good = Report(file) && good;
  }
  return good ? 0 : 1;
}
