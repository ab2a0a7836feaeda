// SPDX-License-Identifier: BSD-3-Clause
// Judges line drawings of a CAD file by rays against our exact surfaces (LineTruth.h): a .vtp of
// polylines with cell data Visibility, whoever made it, or the lines that vtkNURBSVisibleRegions
// makes. Prints JSON: lengths in the image over the diagonal, a tolerance each. See --help.
#include "LineTruth.h"
#include "Measuring.h"
#include "ModelExtent.h"
#include "vtkNURBSCADReader.h"
#include "vtkNURBSModelPool.h"
#include "vtkNURBSParallel.h"
#include "vtkNURBSVisibleRegions.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataReader.h>

#include <iostream>

namespace
{

struct Line
{
  std::vector<nurbs::Vec3> Points;
  bool Visible;
};

void TakeLines(vtkPolyData* data, std::vector<Line>& lines)
{
  vtkDataArray* visibility = data->GetCellData()->GetArray("Visibility");
  if (data->GetNumberOfLines() > 0 && !visibility)
  {
    throw std::runtime_error("the lines have no cell data Visibility");
  }
  const vtkIdType before = data->GetNumberOfVerts();
  for (vtkIdType c = 0; c < data->GetNumberOfLines(); ++c)
  {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    data->GetLines()->GetCellAtId(c, count, ids);
    Line line{ {}, visibility->GetTuple1(before + c) != 0.0 };
    for (vtkIdType k = 0; k < count; ++k)
    {
      nurbs::Vec3 p;
      data->GetPoint(ids[k], p.data());
      line.Points.push_back(p);
    }
    lines.push_back(std::move(line));
  }
}

void TakeAllLines(vtkDataObject* data, std::vector<Line>& lines)
{
  if (auto* leaf = vtkPolyData::SafeDownCast(data))
  {
    TakeLines(leaf, lines);
  }
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    vtkSmartPointer<vtkCompositeDataIterator> at;
    at.TakeReference(composite->NewIterator());
    for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
    {
      TakeAllLines(at->GetCurrentDataObject(), lines);
    }
  }
}

struct Options
{
  std::string File, Lines;
  std::vector<double> View{ 1.0, 1.0, 1.0 };
  std::vector<double> Tolerances{ 1e-4, 1e-3 };
  double Precision = 1e-4;
  double Step = 1e-3;
  int List = 0;
};

/// Our own lines; the seconds count the filter alone, on one thread.
void MakeOwn(
  vtkDataObject* model, const Options& options, std::vector<Line>& lines, nlohmann::json& result)
{
  vtkNew<vtkNURBSVisibleRegions> filter;
  filter->SetInputDataObject(model);
  filter->SetDirection(options.View.data());
  filter->SetPrecision(options.Precision);
  filter->ComputeRegionsOff(); // Lines are what is compared.
  const measuring::Stopwatch watch;
  filter->Update();
  result["seconds"] = watch.Read().Processor;
  TakeAllLines(filter->GetOutputDataObject(1), lines);
}

nlohmann::json Judge(const std::vector<Line>& lines, const nurbs::RayCaster& caster,
  const Options& options, double tolerance, double diagonal)
{
  const nurbs::Vec3 view(options.View[0], options.View[1], options.View[2]);
  const verify::LineTruth truth(caster, view, tolerance * diagonal);
  std::vector<verify::LineLengths> each(lines.size());
  vtkNURBSParallelFor(0, std::int64_t(lines.size()), [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i)
    {
      truth.Judge(lines[i].Points, lines[i].Visible, options.Step * diagonal, each[i]);
    }
  });
  verify::LineLengths sum;
  int listed = 0;
  for (const verify::LineLengths& one : each)
  {
    sum.Visible += one.Visible / diagonal;
    sum.Hidden += one.Hidden / diagonal;
    sum.WrongVisible += one.WrongVisible / diagonal;
    sum.WrongHidden += one.WrongHidden / diagonal;
    sum.Undecided += one.Undecided / diagonal;
    for (std::size_t k = 0; k < one.WrongPoints.size() && listed < options.List; ++k, ++listed)
    {
      std::cerr << "wrong at " << tolerance << ": line " << (&one - each.data())
                << (one.WrongVisible > 0.0 ? " drawn visible, " : " drawn hidden, ")
                << one.WrongPoints[k].transpose() << "\n";
    }
  }
  return { { "tolerance", tolerance }, { "visible", sum.Visible }, { "hidden", sum.Hidden },
    { "wrong_visible", sum.WrongVisible }, { "wrong_hidden", sum.WrongHidden },
    { "undecided", sum.Undecided } };
}

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app{ "Judges a line drawing of a CAD file by rays against the exact surfaces." };
  app.add_option("file", options.File)->required()->check(CLI::ExistingFile);
  app.add_option("lines", options.Lines, ".vtp; without it, ours are made and judged");
  app.add_option("--view", options.View, "x,y,z: to the viewer")->delimiter(',')->expected(3);
  app.add_option("--tolerance", options.Tolerances, "how far lines may be off, of the diagonal");
  app.add_option("--precision", options.Precision, "of our lines, of the diagonal");
  app.add_option("--step", options.Step, "between points that are judged, of the diagonal");
  app.add_option("--list", options.List, "points that are wrong to list, a tolerance");
  CLI11_PARSE(app, argc, argv);
  try
  {
    nlohmann::json result;
    vtkNew<vtkNURBSCADReader> reader;
    reader->SetFileName(options.File.c_str());
    const measuring::Stopwatch reading;
    reader->Update();
    result["read"] = reading.Read().Elapsed;
    vtkNURBSModelPool pool;
    const std::string problem = pool.Collect(reader->GetOutputDataObject(0));
    if (!problem.empty() || pool.Model.Faces.empty())
    {
      throw std::runtime_error(options.File + ": no faces " + problem);
    }
    result["faces"] = pool.Model.Faces.size();
    std::vector<Line> lines;
    if (options.Lines.empty())
    {
      vtkSMPTools::Initialize(1);
      MakeOwn(reader->GetOutputDataObject(0), options, lines, result);
    }
    else
    {
      vtkNew<vtkXMLPolyDataReader> input;
      input->SetFileName(options.Lines.c_str());
      input->Update();
      TakeLines(input->GetOutput(), lines);
    }
    result["lines"] = lines.size();
    vtkSMPTools::Initialize();
    const vtkNURBSParallelScope parallel;
    const nurbs::RayCaster caster(pool.Model, vtkNURBSParallelFor);
    const double diagonal =
      nurbs::Diagonal(nurbs::FaceBoxes(pool.Model, pool.FaceErrors, vtkNURBSParallelFor));
    for (const double tolerance : options.Tolerances)
    {
      result["judged"].push_back(Judge(lines, caster, options, tolerance, diagonal));
    }
    std::cout << result.dump() << '\n';
    return 0;
  }
  catch (const std::exception& e)
  {
    std::cerr << e.what() << '\n';
    return 2;
  }
}
