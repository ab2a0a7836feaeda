// SPDX-License-Identifier: BSD-3-Clause
// Times OpenCASCADE's reader and BRepMesh on one file and prints JSON; see --help.
#include "Measuring.h"
#include "OcctMesh.h"
#include "ReferenceShape.h"

#include <BRepTools.hxx>
#include <CLI/CLI.hpp>
#include <OSD_ThreadPool.hxx>
#include <Standard_Failure.hxx>
#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <iostream>

using measuring::MedianTime;
using measuring::PeakMemory;

int main(int argc, char** argv)
{
  std::string file;
  std::vector<double> tolerances{ 1e-3, 1e-4 };
  std::vector<int> threads{ 1, 2 };
  int repeat = 3;
  CLI::App app{ "Times OpenCASCADE's reader and BRepMesh (native shapes, angle criterion off)." };
  app.add_option("file", file, "STEP, IGES or BREP file")->required()->check(CLI::ExistingFile);
  app.add_option("--tolerance", tolerances, "Tolerances over the diagonal")->capture_default_str();
  app.add_option("--threads", threads, "Numbers of threads")->capture_default_str();
  app.add_option("--repeat", repeat, "Runs of which the median counts")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try
  {
    TopoDS_Shape root;
    nlohmann::json result;
    result["read"] = MedianTime(repeat, [&] { root = verify::ReadShape(file); }).Elapsed;
    const verify::ReferenceShape shape = verify::Describe(root);
    result["faces"] = shape.Faces.size();
    result["diagonal"] = shape.Diagonal;
    result["memory_read"] = PeakMemory();
    for (double relative : tolerances)
    {
      for (int n : threads)
      {
        tbb::global_control limit(
          tbb::global_control::max_allowed_parallelism, std::size_t(std::max(1, n)));
        OSD_ThreadPool::DefaultPool()->SetNbDefaultThreadsToLaunch(n);
        const double tolerance = relative * shape.Diagonal;
        const measuring::Duration taken =
          MedianTime(repeat, [&] { verify::MeshByOcct(root, tolerance, n > 1); });
        long triangles = 0;
        for (const verify::FaceMesh& mesh : verify::TakeOcctMesh(shape))
        {
          triangles += long(mesh.Triangles.size());
        }
        result["meshes"].push_back({ { "relative", relative }, { "absolute", tolerance },
          { "threads", n }, { "seconds", taken.Elapsed }, { "processor_seconds", taken.Processor },
          { "triangles", triangles } });
      }
    }
    result["memory"] = PeakMemory();
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
