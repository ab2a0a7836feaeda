// SPDX-License-Identifier: BSD-3-Clause
// vtkNURBSVisibleRegions against rays: VisibilityTruth FILE | --shape NAME [--view x,y,z]...
// One line a view: hits that agree; that disagree within the precision of a border of their face's
// regions (in the image, as seen there); of a border of any face's ("narrow": what is narrower than
// the precision may be left out); "coincident" where another face lies at the same place, within the
// file's tolerance; "near", within ten times the precision; and "wrong", all others;
// "missed" are those on faces without a region, "worst" is the largest distance in precisions. Exit
// status 3 if there is a near or wrong one, or an output face with an error. With --area T the visible
// area of closed solids by rays (AreaByLines.h, to T of it) beside the sum of VisibleArea. See --help.
#include "AreaByLines.h"
#include "Measuring.h"
#include "ModelExtent.h"
#include "vtkNURBSCADReader.h"
#include "vtkNURBSModelPool.h"
#include "vtkNURBSParallel.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNURBSVisibleRegions.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkSMPTools.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <numeric>

namespace
{

using nurbs::Vec3;

const std::map<std::string, int> ShapeNames = { { "sphere", vtkNURBSShapeSource::SPHERE },
  { "torus", vtkNURBSShapeSource::TORUS }, { "cylinder", vtkNURBSShapeSource::CYLINDER },
  { "cone", vtkNURBSShapeSource::CONE }, { "plate", vtkNURBSShapeSource::PLATE },
  { "teapot", vtkNURBSShapeSource::TEAPOT }, { "sheet", vtkNURBSShapeSource::SHEET },
  { "car", vtkNURBSShapeSource::CAR_BODY }, { "vase", vtkNURBSShapeSource::VASE },
  { "missile", vtkNURBSShapeSource::MISSILE }, { "spring", vtkNURBSShapeSource::SPRING } };

/// The cell data by which faces of the output are found again in the input.
const char* const SourceFace = "SourceFace";

struct Options
{
  std::string File, Shape;
  int Patches = 1000;
  std::vector<std::string> Views;
  std::string Eye;
  double Precision = 1e-4;
  double Rays = 1e6;
  bool Hidden = false;
  bool Clustering = false;
  int List = 0;
  double Area = 0.0;
  int Scan = 100;
  bool Json = false;
  int Threads = 0;
};

Vec3 ParseVector(const std::string& text)
{
  Vec3 v;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf", &v[0], &v[1], &v[2]) != 3)
  {
    throw std::runtime_error("'" + text + "' is not x,y,z");
  }
  return v;
}

vtkSmartPointer<vtkDataObject> Load(const Options& options)
{
  if (options.Shape.empty())
  {
    vtkNew<vtkNURBSCADReader> reader;
    reader->SetFileName(options.File.c_str());
    reader->Update();
    return reader->GetOutputDataObject(0);
  }
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(ShapeNames.at(options.Shape));
  source->SetNumberOfPatches(options.Patches);
  source->Update();
  return source->GetOutputDataObject(0);
}

void NumberFaces(const vtkNURBSModelPool& pool)
{
  for (const vtkNURBSModelPool::Leaf& leaf : pool.Leaves)
  {
    vtkNew<vtkIdTypeArray> numbers;
    numbers->SetName(SourceFace);
    for (std::size_t f = leaf.FirstFace; f < leaf.LastFace; ++f)
    {
      numbers->InsertNextValue(static_cast<vtkIdType>(f));
    }
    leaf.Grid->GetCellData()->AddArray(numbers);
  }
}

/// A cell array of all leaves of the pool, one value a face.
std::vector<double> Gather(const vtkNURBSModelPool& pool, const char* name)
{
  std::vector<double> values;
  for (const vtkNURBSModelPool::Leaf& leaf : pool.Leaves)
  {
    vtkDataArray* array = leaf.Grid->GetCellData()->GetArray(name);
    if (!array)
    {
      throw std::runtime_error(std::string("the regions have no cell data ") + name);
    }
    for (vtkIdType c = 0; c < leaf.Grid->GetNumberOfCells(); ++c)
    {
      values.push_back(array->GetTuple1(c));
    }
  }
  return values;
}

class Program
{
public:
  explicit Program(const Options& options)
    : Given(options)
    , Data(Load(options))
  {
    const std::string problem = this->Source.Collect(this->Data);
    if (!problem.empty() || this->Source.Model.Faces.empty())
    {
      throw std::runtime_error("no faces " + problem);
    }
    NumberFaces(this->Source);
    this->Caster = std::make_unique<nurbs::RayCaster>(this->Source.Model, vtkNURBSParallelFor);
    this->Precision = options.Precision *
      nurbs::Diagonal(
        nurbs::FaceBoxes(this->Source.Model, this->Source.FaceErrors, vtkNURBSParallelFor));
  }

  /// True if nothing is wrong.
  bool Run(const std::string& name, bool isEye)
  {
    const Vec3 place = ParseVector(name);
    nlohmann::json result{ { isEye ? "eye" : "view", name },
      { "faces", this->Source.Model.Faces.size() } };
    vtkNew<vtkNURBSVisibleRegions> filter;
    filter->SetInputDataObject(this->Data);
    isEye ? filter->SetProjectionToPerspective() : filter->SetProjectionToParallel();
    filter->SetDirection(place[0], place[1], place[2]);
    filter->SetEyePoint(place[0], place[1], place[2]);
    filter->SetPrecision(this->Given.Precision);
    filter->SetClustering(this->Given.Clustering);
    filter->SetRegion(this->Given.Hidden ? vtkNURBSVisibleRegions::HIDDEN_REGION
                                         : vtkNURBSVisibleRegions::VISIBLE_REGION);
    const measuring::Stopwatch watch;
    filter->Update();
    result["seconds"] = watch.Read().Elapsed;
    result["piercing"] = filter->GetNumberOfPiercingPairs();
    result["inexact"] = filter->GetNumberOfInexactFaces();
    vtkNURBSModelPool regions;
    const std::string problem = regions.Collect(filter->GetOutputDataObject(0));
    if (!problem.empty())
    {
      throw std::runtime_error("the regions: " + problem);
    }
    const truth::ImageView view = isEye ? truth::ImageView::FromEye(this->Caster->Bounds(), place)
                                        : truth::ImageView::Parallel(this->Caster->Bounds(), place);
    const bool right = this->CompareRays(regions, view, result);
    if (this->Given.Area > 0.0)
    {
      this->CompareArea(regions, view, result);
    }
    this->Given.Json ? void(std::cout << result.dump() << std::endl) : this->Print(result);
    return right;
  }

private:
  bool CompareRays(
    const vtkNURBSModelPool& regions, const truth::ImageView& view, nlohmann::json& result) const
  {
    for (const std::string& error : regions.FaceErrors)
    {
      if (!error.empty())
      {
        result["bad_regions"].push_back(error);
      }
    }
    std::vector<std::int64_t> sources;
    for (const double number : Gather(regions, SourceFace))
    {
      sources.push_back(static_cast<std::int64_t>(number));
    }
    const measuring::Stopwatch watch;
    const truth::RegionTruth truth(*this->Caster, regions.Model, sources, view, this->Precision,
      this->Given.Hidden, vtkNURBSParallelFor);
    const truth::RegionCheck check = truth.Check(
      static_cast<std::int64_t>(this->Given.Rays), static_cast<std::size_t>(this->Given.List));
    result.update({ { "regions", sources.size() }, { "rays", check.Rays }, { "hits", check.Hits },
      { "agree", check.Agree }, { "within", check.Within }, { "narrow", check.Narrow },
      { "coincident", check.Coincident }, { "bridged", check.Bridged }, { "near", check.Near },
      { "wrong", check.Wrong }, { "missed", check.MissedFaces }, { "worst", check.Worst },
      { "checking", watch.Read().Elapsed } });
    for (const truth::Disagreement& one : check.List)
    {
      char text[200];
      std::snprintf(text, sizeof text,
        "face %lld (FaceId %lld) uv %.9g %.9g point %.9g %.9g %.9g is %s, %.3g precisions from its "
        "border",
        static_cast<long long>(one.Face),
        static_cast<long long>(this->Source.Model.Faces[one.Face].FaceId), one.UV[0], one.UV[1],
        one.Point[0], one.Point[1], one.Point[2], one.IsFront ? "visible" : "hidden",
        one.Distance / this->Precision);
      result["list"].push_back(text);
    }
    return check.Near + check.Wrong == 0 && !result.contains("bad_regions");
  }

  void CompareArea(
    const vtkNURBSModelPool& regions, const truth::ImageView& view, nlohmann::json& result) const
  {
    const std::vector<double> areas = Gather(regions, "VisibleArea");
    const double ours = std::accumulate(areas.begin(), areas.end(), 0.0);
    const double tolerance = this->Given.Area * ours / double(this->Source.Model.Faces.size());
    double coarse = 0.0, fine = 0.0;
    for (std::size_t f = 0; f < this->Source.Model.Faces.size(); ++f)
    {
      const auto face = static_cast<std::int64_t>(f);
      coarse += truth::AreaByLines(
        *this->Caster, face, view, 10.0 * tolerance, this->Given.Scan / 2 + 1, vtkNURBSParallelFor);
      fine += truth::AreaByLines(
        *this->Caster, face, view, tolerance, this->Given.Scan, vtkNURBSParallelFor);
    }
    result.update({ { "area", ours }, { "area_by_rays", fine },
      { "area_coarse", (coarse - fine) / fine }, { "area_off", (ours - fine) / fine } });
  }

  void Print(const nlohmann::json& result) const
  {
    const std::string model = this->Given.Shape.empty()
      ? std::filesystem::path(this->Given.File).filename().string()
      : this->Given.Shape;
    std::printf("%-24s", model.c_str());
    for (const char* key : { "eye", "view", "faces", "regions", "seconds", "piercing", "inexact",
           "rays", "hits", "agree", "within", "narrow", "coincident", "bridged", "near", "wrong",
           "missed", "worst", "checking", "area", "area_by_rays", "area_coarse", "area_off" })
    {
      if (result.contains(key))
      {
        std::printf(" %s %s", key, result[key].dump().substr(0, 16).c_str());
      }
    }
    std::printf("\n");
    for (const char* key : { "bad_regions", "list" })
    {
      for (const std::string& line : result.value(key, std::vector<std::string>()))
      {
        std::printf("  %s\n", line.c_str());
      }
    }
    std::fflush(stdout);
  }

  const Options& Given;
  vtkSmartPointer<vtkDataObject> Data;
  vtkNURBSModelPool Source;
  std::unique_ptr<nurbs::RayCaster> Caster;
  double Precision = 0.0;
};

} // namespace

int main(int argc, char** argv)
{
  Options options;
  CLI::App app("Visible regions against rays");
  app.add_option("file", options.File, "CAD file")->check(CLI::ExistingFile);
  app.add_option("--shape", options.Shape, "of vtkNURBSShapeSource")
    ->check(CLI::IsMember(ShapeNames));
  app.add_option("--patches", options.Patches, "of the shape car")->capture_default_str();
  app.add_option("--view", options.Views, "x,y,z: to the viewer; default three directions");
  app.add_option("--eye", options.Eye, "x,y,z: a perspective view instead");
  app.add_option("--precision", options.Precision, "of the diagonal")->capture_default_str();
  app.add_option("--rays", options.Rays)->capture_default_str();
  app.add_flag("--hidden", options.Hidden, "the hidden regions instead of the visible ones");
  app.add_flag("--clustering", options.Clustering, "as vtkNURBSVisibleRegions::Clustering");
  app.add_option("--list", options.List, "disagreements to list");
  app.add_option("--area", options.Area, "compare the area of a closed solid, to this part of it");
  app.add_option("--scan", options.Scan, "points a knot span that the area is scanned at")
    ->capture_default_str();
  app.add_flag("--json", options.Json, "print lines of JSON");
  app.add_option("--threads", options.Threads, "0: as many as there are");
  CLI11_PARSE(app, argc, argv);
  if (options.Threads > 0)
  {
    vtkSMPTools::Initialize(options.Threads);
  }
  const vtkNURBSParallelScope parallel;
  try
  {
    Program program(options);
    bool right = true;
    if (!options.Eye.empty())
    {
      right = program.Run(options.Eye, true);
    }
    else
    {
      const std::vector<std::string> standard{ "1,1,1", "0,0,1", "0.3,-0.9,0.2" };
      for (const std::string& view : options.Views.empty() ? standard : options.Views)
      {
        right = program.Run(view, false) && right;
      }
    }
    return right ? 0 : 3;
  }
  catch (const std::exception& e)
  {
    std::fprintf(stderr, "%s\n", e.what());
    return 2;
  }
}
