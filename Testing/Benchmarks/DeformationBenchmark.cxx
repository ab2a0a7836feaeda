// SPDX-License-Identifier: BSD-3-Clause
/// @file DeformationBenchmark.cxx
/// @brief Milliseconds a frame of a surface of which one control point moves, by every method of
/// DeformationRivals.h. Prints JSON; see --help. One thread.
#include "DeformationRivals.h"
#include "IncrementalRival.h"
#include "Measuring.h"
#include "MemoryBandwidth.h"
#include "OcctDeformationRival.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

using namespace nurbs;

namespace
{

constexpr double FastShare = 0.02;            // Of the polygons, as in the paper's section 6.
constexpr std::int64_t MostRefined = 1000000; // Vertices: a face has no more cells.
constexpr double FarthestReach = 100.0;       // Steps of the control points.

struct Arguments
{
  int Degree = 3;
  int Spans = 39;
  int Cells = 8;
  bool Polynomial = false;
  bool WithoutOcct = false;
  int Rounds = 5;
  double Seconds = 0.2;
};

/// A smooth sheet with small random bumps, about 1 wide and clamped.
Surface Sheet(const Arguments& a)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> bump(-0.1, 0.1);
  Surface s;
  const int count = a.Degree + a.Spans;
  for (int dir = 0; dir < 2; ++dir)
  {
    s.Degree[dir] = a.Degree;
    s.Count[dir] = count;
    s.Knots[dir] = UniformKnots(a.Degree, count);
  }
  for (int j = 0; j < count; ++j)
  {
    for (int i = 0; i < count; ++i)
    {
      const double height = std::sin(0.5 * i) * std::cos(0.3 * j) + bump(random);
      s.Points.push_back(Vec3(i, j, height) / count);
      if (!a.Polynomial)
      {
        s.Weights.push_back(1.0 + bump(random));
      }
    }
  }
  return s;
}

/// A method and what it was measured at.
struct Contestant
{
  std::string Key;
  std::unique_ptr<DeformationRival> Rival;
  double Prepared = 0.0;  ///< Seconds.
  double Best = 1e300;    ///< Seconds a frame.
  std::int64_t Frame = 0; ///< Frames so far.
  double Reach = 1.0;     ///< Of the control point's way.
};

/// The middle control point goes round in circles, and up and down.
Vec3 Position(const Surface& start, std::int64_t index, double reach, std::int64_t frame)
{
  const double angle = 0.1 * double(frame);
  const double step = reach / start.Count[0];
  return start.Points[std::size_t(index)] +
    step * Vec3(0.3 * std::sin(angle), 0.3 * std::cos(angle), std::sin(0.7 * angle));
}

std::int64_t MovedPoint(const Surface& s)
{
  return s.Count[0] / 2 + std::int64_t(s.Count[1] / 2) * s.Count[0];
}

/// As many frames as last `seconds`, at least one; the mean of batches that the clock can tell
/// apart, of which the shortest counts.
void RunFrames(Contestant& c, const Surface& start, double seconds)
{
  const std::int64_t index = MovedPoint(start);
  std::int64_t batch = c.Best < 1e300 ? 1 + std::int64_t(1e-3 / c.Best) : 1;
  for (double total = 0.0; total < seconds;)
  {
    const measuring::Stopwatch stopwatch;
    for (std::int64_t i = 0; i < batch; ++i)
    {
      c.Rival->Move(index, Position(start, index, c.Reach, ++c.Frame));
    }
    const double taken = stopwatch.Read().Processor;
    total += taken;
    c.Best = std::min(c.Best, taken / double(batch));
    batch = 1 + std::int64_t(1e-3 / c.Best);
  }
}

/// The share of the polygons that changes in a frame: two with every vertex that comes or goes.
double ChangedPolygons(Contestant& c, const Surface& start)
{
  auto& rival = dynamic_cast<IncrementalRival&>(*c.Rival);
  constexpr int frames = 40;
  std::int64_t changed = 0;
  for (int k = 0; k < frames; ++k)
  {
    const std::int64_t index = MovedPoint(start);
    rival.Move(index, Position(start, index, c.Reach, ++c.Frame));
    changed += 2 * (rival.GetReport().InsertedVertices + rival.GetReport().DeletedVertices);
  }
  return double(changed) / frames / double(rival.Triangles());
}

/// A way as long as changes that share of the polygons a frame, if the mesh does not become another one
/// before.
void Lengthen(Contestant& c, const Surface& start, double share)
{
  const auto& rival = dynamic_cast<IncrementalRival&>(*c.Rival);
  const double most = 1.25 * double(rival.Triangles());
  while (c.Reach < FarthestReach && ChangedPolygons(c, start) < share &&
    double(rival.Triangles()) < most)
  {
    c.Reach *= 1.25;
  }
}

/// The largest distance and angle of some of the mesh's vertices to direct evaluation.
void Deviations(const DeformationRival& rival, const SampleGrid& grid, nlohmann::json& result)
{
  const DeformationMesh& mesh = rival.GetMesh();
  const SurfaceView view = rival.GetSurface().View();
  const std::size_t count = mesh.Points.size() / 3;
  const std::size_t width = grid.Parameters[0].size();
  double distance = 0.0, angle = 0.0;
  for (std::size_t k = 0; k < count; k += 1 + count / 20000)
  {
    const double u =
      mesh.Parameters.empty() ? grid.Parameters[0][k % width] : mesh.Parameters[2 * k];
    const double v =
      mesh.Parameters.empty() ? grid.Parameters[1][k / width] : mesh.Parameters[2 * k + 1];
    const Eigen::Map<const Vec3> point(mesh.Points.data() + 3 * k);
    const Eigen::Map<const Vec3> normal(mesh.Normals.data() + 3 * k);
    distance = std::max(distance, (point - Evaluate(view, u, v)).norm());
    angle = std::max(angle, (normal - Normal(view, u, v)).norm());
  }
  result["point_error"] = distance;
  result["normal_error"] = angle;
}

nlohmann::json BandwidthToJson(std::size_t bytes)
{
  const measuring::Bandwidth b = measuring::MeasureBandwidth(bytes);
  return { { "bytes", bytes }, { "copy", b.Copy }, { "modify", b.Modify } };
}

std::vector<Contestant> Contestants(const Arguments& a, const SampleGrid& grid)
{
  std::vector<Contestant> all;
  const auto add = [&](const char* key, std::unique_ptr<DeformationRival> rival) {
    all.push_back({});
    all.back().Key = key;
    all.back().Rival = std::move(rival);
  };
  add("oslo", MakeOsloRival(a.Degree));
  add("oslo_simple", MakeOsloRival(1));
  add("bezier", MakeBezierRival(false));
  add("bezier_rows", MakeBezierRival(true));
  if (!a.WithoutOcct)
  {
    add("occt", std::make_unique<OcctDeformationRival>());
  }
  if (grid.Count() < MostRefined)
  {
    add("refined", std::make_unique<IncrementalRival>(true));
    add("refined_far", std::make_unique<IncrementalRival>(true));
  }
  add("increments", std::make_unique<IncrementalRival>(false));
  add("full", MakeGridRival());
  add("local", MakeLocalGridRival());
  return all;
}

nlohmann::json Run(const Arguments& a)
{
  const Surface sheet = Sheet(a);
  const SampleGrid grid(sheet, a.Cells);
  const std::int64_t index = MovedPoint(sheet);
  std::int64_t touched = 1;
  for (int dir = 0; dir < 2; ++dir)
  {
    const int s = int(dir == 0 ? index % sheet.Count[0] : index / sheet.Count[0]);
    const std::array<int, 2> range = grid.Support(sheet, dir, s);
    touched *= range[1] - range[0];
  }
  std::vector<Contestant> all = Contestants(a, grid);
  for (Contestant& c : all)
  {
    const measuring::Stopwatch stopwatch;
    c.Rival->Prepare(sheet, grid);
    c.Prepared = stopwatch.Read().Processor;
    if (c.Key == "refined_far")
    {
      Lengthen(c, sheet, FastShare);
    }
  }
  // In turns, so that what else the machine does hits all of them.
  for (int round = 0; round < a.Rounds; ++round)
  {
    for (Contestant& c : all)
    {
      if (round == 0 || c.Best < 10.0)
      {
        RunFrames(c, sheet, a.Seconds);
      }
    }
  }
  nlohmann::json result = { { "spans", a.Spans }, { "rational", !a.Polynomial },
    { "vertices", grid.Count() }, { "touched", touched } };
  for (Contestant& c : all)
  {
    const DeformationMesh& mesh = c.Rival->GetMesh();
    nlohmann::json row = { { "name", c.Rival->GetName() }, { "prepare", c.Prepared },
      { "frame", c.Best }, { "vertices", mesh.Points.size() / 3 },
      { "triangles", mesh.Triangles.size() / 3 } };
    Deviations(*c.Rival, grid, row);
    if (const auto* occt = dynamic_cast<const OcctDeformationRival*>(c.Rival.get()))
    {
      row["deflection"] = occt->GetDeflection();
    }
    if (const auto* ours = dynamic_cast<const IncrementalRival*>(c.Rival.get()))
    {
      row["changed"] = ChangedPolygons(c, sheet);
      row["moved"] = ours->GetReport().UpdatedVertices;
      row["reach"] = c.Reach;
    }
    result["rivals"][c.Key] = row;
  }
  result["memory"] = BandwidthToJson(std::size_t(256) << 20);
  result["cache"] = BandwidthToJson(std::size_t(touched) * 6 * sizeof(double));
  return result;
}

} // namespace

int main(int argc, char** argv)
{
  Arguments a;
  CLI::App app{
    "Times methods that bring a sheet's mesh up to date after a control point has moved,\n"
    "and prints JSON: processor seconds a frame (the best of several rounds in turns),\n"
    "deviations from direct evaluation, and bytes a second of one thread in memory and\n"
    "in arrays as large as the points and normals that a move touches."
  };
  app.add_option("--degree", a.Degree, "In both directions")
    ->capture_default_str()
    ->check(CLI::Range(1, 25));
  app.add_option("--spans", a.Spans, "Knot spans a direction")
    ->capture_default_str()
    ->check(CLI::Range(1, 5000));
  app.add_option("--cells", a.Cells, "Cells of the mesh a span and direction: a power of two")
    ->capture_default_str()
    ->check(CLI::IsMember({ 1, 2, 4, 8, 16, 32, 64 }));
  app.add_flag("--polynomial", a.Polynomial, "No weights");
  app.add_flag("--without-occt", a.WithoutOcct, "Leave OpenCASCADE out");
  app.add_option("--rounds", a.Rounds, "Rounds; what takes over 10 s a frame has one")
    ->capture_default_str();
  app.add_option("--seconds", a.Seconds, "Seconds a round and method")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try
  {
    std::cout << Run(a).dump() << '\n';
    return 0;
  }
  catch (const std::exception& e)
  {
    std::cerr << e.what() << '\n';
  }
  return 2;
}
