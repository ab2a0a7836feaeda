// SPDX-License-Identifier: BSD-3-Clause
// OpenCASCADE's line drawing of a file, as a .vtp with cell data Visibility and Kind and as a line of
// JSON: seconds to read, to mesh (polygonal only) and to hide, lines and points. See --help.
#include "Measuring.h"
#include "OcctHiddenLines.h"
#include "OcctMesh.h"
#include "ReferenceShape.h"

#include <CLI/CLI.hpp>
#include <Standard_Failure.hxx>
#include <nlohmann/json.hpp>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLPolyDataWriter.h>

#include <iostream>

namespace
{

void Write(const std::vector<verify::HiddenLine>& lines, const std::string& file)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> cells;
  vtkNew<vtkUnsignedCharArray> visibility, kind;
  visibility->SetName("Visibility");
  kind->SetName("Kind");
  for (const verify::HiddenLine& line : lines)
  {
    cells->InsertNextCell(int(line.Points.size()));
    for (const Eigen::Vector3d& p : line.Points)
    {
      cells->InsertCellPoint(points->InsertNextPoint(p.data()));
    }
    visibility->InsertNextValue(line.Visible ? 1 : 0);
    kind->InsertNextValue(static_cast<unsigned char>(line.Kind));
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(cells);
  data->GetCellData()->AddArray(visibility);
  data->GetCellData()->AddArray(kind);
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(data);
  writer->SetFileName(file.c_str());
  writer->SetDataModeToBinary();
  if (!writer->Write())
  {
    throw std::runtime_error(file + ": not writable");
  }
}

} // namespace

int main(int argc, char** argv)
{
  std::string file, output, algorithm = "exact";
  std::vector<double> view{ 1.0, 1.0, 1.0 };
  double relative = 1e-4;
  CLI::App app{ "OpenCASCADE's hidden lines: HLRBRep_Algo (exact) or HLRBRep_PolyAlgo (polygonal), "
                "outlines and sharp edges, on one thread." };
  app.add_option("file", file, "STEP, IGES or BREP file")->required()->check(CLI::ExistingFile);
  app.add_option("--view", view, "x,y,z: from the model to the viewer")
    ->delimiter(',')
    ->expected(3);
  app.add_option("--algorithm", algorithm)->check(CLI::IsMember({ "exact", "polygonal" }));
  app
    .add_option("--deflection", relative,
      "of the diagonal: of the mesh (polygonal), or between curves and the lines written (exact)")
    ->capture_default_str();
  app.add_option("--out", output, ".vtp");
  CLI11_PARSE(app, argc, argv);
  try
  {
    nlohmann::json result;
    const measuring::Stopwatch reading;
    const TopoDS_Shape root = verify::ReadShape(file);
    result["read"] = reading.Read().Elapsed;
    const double deflection = relative * verify::Describe(root).Diagonal;
    const Eigen::Vector3d direction(view[0], view[1], view[2]);
    const measuring::Stopwatch hiding;
    std::vector<verify::HiddenLine> lines;
    if (algorithm == "polygonal")
    {
      verify::MeshByOcct(root, deflection, false);
      result["mesh"] = hiding.Read().Processor;
      lines = verify::HideByPolygons(root, direction);
    }
    else
    {
      lines = verify::HideExactly(root, direction, deflection);
    }
    result["seconds"] = hiding.Read().Processor; // Meshing included.
    std::size_t points = 0;
    for (const verify::HiddenLine& line : lines)
    {
      points += line.Points.size();
    }
    result["lines"] = lines.size();
    result["points"] = points;
    if (!output.empty())
    {
      Write(lines, output);
    }
    std::cout << result.dump() << '\n';
    return 0;
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
