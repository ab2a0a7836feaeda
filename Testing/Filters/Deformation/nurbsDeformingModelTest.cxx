// SPDX-License-Identifier: BSD-3-Clause
#include "nurbsDeformingShapes.h"

#include <gtest/gtest.h>

#include <random>

namespace
{

using nurbs::Vec2;
using nurbs::Vec3;
using shapes::MovableModel;

nurbs::DeformingOptions Options(double tolerance)
{
  nurbs::DeformingOptions options;
  options.Tolerance = tolerance;
  options.SideTolerance = 1e-9;
  return options;
}

/// Points and normals against direct evaluation.
void ExpectOnSurfaces(const nurbs::MeshArrays& mesh, const nurbs::Model& model, double tolerance)
{
  std::vector<std::int64_t> face(mesh.PointCount, -1);
  for (std::int64_t t = 0; t < mesh.TriangleCount; ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      face[mesh.Corners[3 * t + k]] = mesh.Faces[t];
    }
  }
  double distance = 0.0;
  double angle = 0.0;
  for (std::int64_t k = 0; k < mesh.PointCount; ++k)
  {
    if (face[k] < 0)
    {
      continue;
    }
    const nurbs::Face& f = model.Faces[face[k]];
    const double* uv = mesh.UV + 2 * k;
    distance = std::max(distance,
      (Eigen::Map<const Vec3>(mesh.Points + 3 * k) - nurbs::Evaluate(f.Geometry, uv[0], uv[1]))
        .norm());
    const Vec3 normal = (f.Reversed ? -1.0 : 1.0) * nurbs::Normal(f.Geometry, uv[0], uv[1]);
    const Vec3 ours = Eigen::Map<const Eigen::Vector3f>(mesh.Normals + 3 * k).cast<double>();
    angle = std::max(angle, (normal - ours).norm());
  }
  EXPECT_LE(distance, tolerance);
  EXPECT_LE(angle, 1e-6);
}

constexpr double Rounding = 1e-13; // Of models of size 10.

struct Case
{
  const char* Name;
  void (*Add)(nurbs::ModelBuilder&);
  std::int64_t Open; ///< Sides of its border; -1: as many as there are.
};

const Case Cases[] = {
  { "sheet", [](nurbs::ModelBuilder& b) { shapes::AddSheet(b, 6, 0.8); }, -1 },
  { "torus", [](nurbs::ModelBuilder& b) { shapes::AddTorus(b, 3.0, 1.0); }, 0 },
  { "ball", [](nurbs::ModelBuilder& b) { shapes::AddBall(b, true); }, 0 },
  { "balls", [](nurbs::ModelBuilder& b) { shapes::AddBall(b, false); }, 0 },
  { "prism", shapes::AddPrism, 0 },
  { "holes", shapes::AddHoles, -1 },
};

TEST(DeformingModel, FirstFrame)
{
  for (const Case& c : Cases)
  {
    SCOPED_TRACE(c.Name);
    MovableModel model;
    c.Add(model.Builder);
    model.Make();
    nurbs::MeshVectors mesh;
    nurbs::DeformingModel deforming(model.Model, model.Errors(), Options(0.01), mesh);
    const nurbs::FrameReport& report = deforming.FirstFrame();
    const shapes::MeshCounts counts = shapes::Count(mesh);
    std::printf("%s: %lld points, %lld triangles, open %lld, bound %g, measured %g, gap %g\n",
      c.Name, (long long)mesh.PointCount, (long long)mesh.TriangleCount, (long long)counts.Open,
      report.ErrorBound, shapes::LargestDistance(mesh, model.Model), report.ModelGap);
    for (std::size_t f = 0; f < model.Model.Faces.size(); ++f)
    {
      std::printf("   area %g\n", shapes::ParameterArea(mesh, f));
    }
    ExpectOnSurfaces(mesh, model.Model, 1e-9);
    EXPECT_EQ(counts.Beyond, 0);
    EXPECT_EQ(counts.Turned, 0);
    EXPECT_LE(report.ErrorBound, 0.01 + report.ModelGap + 1e-12);
    EXPECT_LE(shapes::LargestDistance(mesh, model.Model), report.ErrorBound + Rounding);
  }
}

void ExpectWhole(const nurbs::MeshArrays& mesh, const MovableModel& model, std::int64_t open)
{
  const shapes::MeshCounts counts = shapes::Count(mesh);
  EXPECT_EQ(counts.Beyond, 0);
  EXPECT_EQ(counts.Turned, 0);
  if (open >= 0)
  {
    EXPECT_EQ(counts.Open, open);
  }
  (void)model;
}

// Everything moves by a wave whose height comes and goes.
TEST(DeformingModel, FollowsAWave)
{
  for (const Case& c : Cases)
  {
    SCOPED_TRACE(c.Name);
    MovableModel model;
    c.Add(model.Builder);
    model.Make();
    const std::vector<double> rest = model.Points;
    nurbs::MeshVectors mesh;
    nurbs::DeformingModel deforming(model.Model, model.Errors(), Options(0.01), mesh);
    std::vector<double> area;
    for (std::size_t f = 0; f < model.Model.Faces.size(); ++f)
    {
      area.push_back(shapes::ParameterArea(mesh, f));
    }
    std::int64_t inserted = 0, deleted = 0, capped = 0;
    double seconds[4] = {};
    for (int frame = 1; frame <= 60; ++frame)
    {
      const double height = 0.3 * std::sin(0.1 * frame);
      for (std::int64_t k = 0; k < model.Count(); ++k)
      {
        const Eigen::Map<const Vec3> p(rest.data() + 3 * k);
        model.Point(k) =
          p + height * Vec3(std::sin(2.0 * p[1]), std::cos(3.0 * p[2]), std::sin(p[0]));
      }
      const nurbs::FrameReport report = deforming.Update(model.Model);
      ASSERT_TRUE(report.Accepted) << report.Problem;
      inserted += report.InsertedVertices;
      deleted += report.DeletedVertices;
      capped += report.CappedCells;
      seconds[0] += report.CompareSeconds;
      seconds[1] += report.MoveSeconds;
      seconds[2] += report.AdaptSeconds;
      seconds[3] += report.RebuildSeconds;
      if (frame % 6 == 0)
      {
        SCOPED_TRACE(frame);
        ExpectOnSurfaces(mesh, model.Model, 1e-9 + report.ModelGap);
        ExpectWhole(mesh, model, c.Open);
        EXPECT_LE(report.ErrorBound, 0.0100001 + report.ModelGap);
        EXPECT_LE(shapes::LargestDistance(mesh, model.Model), report.ErrorBound + Rounding);
        for (std::size_t f = 0; f < area.size(); ++f)
        {
          EXPECT_NEAR(shapes::ParameterArea(mesh, f), area[f], 0.01 * std::abs(area[f]));
        }
      }
    }
    std::printf("%s: %lld triangles; inserted %lld, deleted %lld, capped %lld; ms %g %g %g %g\n",
      c.Name, (long long)mesh.TriangleCount, (long long)inserted, (long long)deleted,
      (long long)capped, 1e3 * seconds[0] / 60, 1e3 * seconds[1] / 60, 1e3 * seconds[2] / 60,
      1e3 * seconds[3] / 60);
  }
}

} // namespace
