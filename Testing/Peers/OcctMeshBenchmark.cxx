// SPDX-License-Identifier: BSD-3-Clause
// Times OpenCASCADE's reader and BRepMesh on one file and prints JSON; see --help.
#include "OcctMesh.h"
#include "ReferenceShape.h"

#include <BRepTools.hxx>
#include <CLI/CLI.hpp>
#include <OSD_ThreadPool.hxx>
#include <Standard_Failure.hxx>
#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <iostream>

namespace
{

double Now()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double Median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double PeakMemory()
{
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * double(usage.ru_maxrss);
}

/// Medians over at most @a repeat runs; what takes longer than 5 s is run once.
template <class Work>
double Time(int repeat, Work&& work)
{
  std::vector<double> seconds;
  for (int i = 0; i < repeat && (seconds.empty() || seconds[0] < 5.0); ++i)
  {
    const double start = Now();
    work();
    seconds.push_back(Now() - start);
  }
  return Median(seconds);
}

} // namespace

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
    result["read"] = Time(repeat, [&] { root = verify::ReadShape(file); });
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
        const double seconds = Time(repeat, [&] { verify::MeshByOcct(root, tolerance, n > 1); });
        long triangles = 0;
        for (const verify::FaceMesh& mesh : verify::TakeOcctMesh(shape))
        {
          triangles += long(mesh.Triangles.size());
        }
        result["meshes"].push_back({ { "relative", relative }, { "absolute", tolerance },
          { "threads", n }, { "seconds", seconds }, { "triangles", triangles } });
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
