// SPDX-License-Identifier: BSD-3-Clause
#include "nurbsDeformingShapes.h"

#include <gtest/gtest.h>

#include <random>
#include <thread>

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
  bool Closed;
  std::vector<double> Areas; ///< Of the faces, in their parameters; the last stands for all others.
};

constexpr double Disc = 2.25 * 3.14159265358979323846;
constexpr double Pentagon = 2.377641290737884;

const Case Cases[] = {
  { "sheet", [](nurbs::ModelBuilder& b) { shapes::AddSheet(b, 6, 0.8); }, false, { 1.0 } },
  { "torus", [](nurbs::ModelBuilder& b) { shapes::AddTorus(b, 3.0, 1.0); }, true, { 16.0 } },
  { "ball", [](nurbs::ModelBuilder& b) { shapes::AddBall(b, true); }, true, { 1.0 } },
  { "balls", [](nurbs::ModelBuilder& b) { shapes::AddBall(b, false); }, true, { 6.0 } },
  { "prism", shapes::AddPrism, true, { 5.0, -Pentagon, Pentagon } },
  { "holes", shapes::AddHoles, false, { 100.0 - 2.0 * Disc, Disc } },
};

/// No crack, no overlap, nothing missing.
void ExpectWhole(const nurbs::MeshArrays& mesh, const MovableModel& model, const Case& c)
{
  const shapes::MeshCounts counts = shapes::Count(mesh, model.Model);
  EXPECT_EQ(counts.Beyond, 0);
  EXPECT_EQ(counts.Turned, 0);
  EXPECT_EQ(counts.Inside, 0);
  EXPECT_EQ(counts.Open == 0, c.Closed);
  for (std::size_t f = 0; f < model.Model.Faces.size(); ++f)
  {
    const double area = c.Areas[std::min(f, c.Areas.size() - 1)];
    EXPECT_NEAR(shapes::ParameterArea(mesh, f), area, 0.01 * std::abs(area)); // Chords of circles.
  }
}

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
    ExpectOnSurfaces(mesh, model.Model, 1e-9);
    ExpectWhole(mesh, model, c);
    EXPECT_LE(report.ErrorBound, 0.01 + report.ModelGap + Rounding);
    EXPECT_LE(shapes::LargestDistance(mesh, model.Model), report.ErrorBound + Rounding);
  }
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
    std::int64_t inserted = 0, deleted = 0, capped = 0;
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
      if (frame % 6 == 0)
      {
        SCOPED_TRACE(frame);
        ExpectOnSurfaces(mesh, model.Model, 1e-9 + report.ModelGap);
        ExpectWhole(mesh, model, c);
        EXPECT_LE(report.ErrorBound, 0.0100001 + report.ModelGap);
        EXPECT_LE(shapes::LargestDistance(mesh, model.Model), report.ErrorBound + Rounding);
      }
    }
    EXPECT_EQ(capped, 0);
    if (mesh.TriangleCount > 100) // The prism is made of planes, and stays so.
    {
      EXPECT_GT(inserted, 0);
      EXPECT_LT(inserted + deleted, 5 * mesh.PointCount);
    }
  }
}

// Bumps of all sizes, weights, a viewer that comes and goes, and budgets.
TEST(DeformingModel, TakesAnyEdits)
{
  for (const Case& c : Cases)
  {
    SCOPED_TRACE(c.Name);
    MovableModel model;
    c.Add(model.Builder);
    model.Make();
    const std::vector<double> rest = model.Points;
    const std::vector<double> restWeights = model.Weights;
    nurbs::MeshVectors mesh;
    nurbs::DeformingModel deforming(model.Model, model.Errors(), Options(0.02), mesh);
    std::mt19937 random(7);
    const auto uniform = [&]() {
      return std::uniform_real_distribution<double>(-1.0, 1.0)(random);
    };
    for (int frame = 1; frame <= 300; ++frame)
    {
      SCOPED_TRACE(frame);
      const Vec3 center(5.0 * uniform(), 5.0 * uniform(), uniform());
      const double width = std::exp(1.5 * uniform());
      const Vec3 height = 0.3 * Vec3(uniform(), uniform(), uniform());
      for (std::int64_t k = 0; k < model.Count(); ++k)
      {
        const Eigen::Map<const Vec3> p(rest.data() + 3 * k);
        const double bump = std::exp(-(p - center).squaredNorm() / (width * width));
        if (bump > 1e-3)
        {
          model.Point(k) += bump * height + 0.1 * (p - model.Point(k));
          if (!restWeights.empty() && frame % 3 == 0)
          {
            // The same for all at one place, lest the model be torn.
            model.Weights[k] = restWeights[k] * (1.0 + 0.5 * bump * height[0]);
          }
        }
      }
      nurbs::MeshViewer viewer;
      viewer.Eye = Vec3(5.0, 5.0, 12.0);
      viewer.FullDetail = 8.0;
      const bool watched = frame % 40 >= 20;
      const nurbs::FrameReport report = deforming.Update(model.Model, watched ? &viewer : nullptr);
      ASSERT_TRUE(report.Accepted) << report.Problem;
      if (frame % 25 == 0)
      {
        ExpectOnSurfaces(mesh, model.Model, 1e-9 + report.ModelGap);
        ExpectWhole(mesh, model, c);
        EXPECT_LE(report.ErrorBound, (watched ? 0.2 : 0.0200001) + report.ModelGap);
        EXPECT_LE(shapes::LargestDistance(mesh, model.Model), report.ErrorBound + Rounding);
        EXPECT_EQ(report.CappedCells, 0);
      }
    }
  }
}

// Sums of increments do not drift: the error after many frames is that of rounding.
TEST(DeformingModel, DoesNotDrift)
{
  MovableModel model;
  shapes::AddSheet(model.Builder, 6, 0.8);
  model.Make();
  const std::vector<double> rest = model.Points;
  nurbs::DeformingOptions options = Options(1.0);
  options.FixedDepth = 2;
  nurbs::MeshVectors mesh;
  nurbs::DeformingModel deforming(model.Model, model.Errors(), options, mesh);
  const std::int64_t k = 40;
  for (int frame = 1; frame <= 100000; ++frame)
  {
    model.Point(k) = Eigen::Map<const Vec3>(rest.data() + 3 * k) +
      Vec3(std::sin(0.7 * frame), std::cos(1.1 * frame), std::sin(1.3 * frame));
    const nurbs::FrameReport report = deforming.Update(model.Model);
    ASSERT_TRUE(report.Accepted);
    if (frame == 1 || frame == 2 || frame == 999 || frame % 20000 == 0)
    {
      ExpectOnSurfaces(mesh, model.Model, 1e-11); // 1e-12 of the size.
    }
  }
  EXPECT_GT(deforming.BytesOfSums(), 0);
}

// A bad frame is refused as a whole, and names the control point; the next good one is followed.
TEST(DeformingModel, RefusesBadFrames)
{
  MovableModel model;
  shapes::AddTorus(model.Builder, 3.0, 1.0);
  model.Make();
  nurbs::MeshVectors mesh;
  nurbs::DeformingModel deforming(model.Model, model.Errors(), Options(0.02), mesh);
  const std::vector<double> points(mesh.Points, mesh.Points + 3 * mesh.PointCount);
  const std::vector<double> rest = model.Points;
  const std::vector<double> restWeights = model.Weights;
  const double inf = std::numeric_limits<double>::infinity();
  const std::pair<double, const char*> places[] = { { std::nan(""), "is not finite" },
    { -inf, "is not finite" }, { 1e30, "moved by" } };
  const auto expectRefused = [&](const std::string& name, const std::string& reason) {
    const nurbs::FrameReport report = deforming.Update(model.Model);
    EXPECT_FALSE(report.Accepted);
    EXPECT_NE(report.Problem.find(name), std::string::npos) << report.Problem;
    EXPECT_NE(report.Problem.find(reason), std::string::npos) << report.Problem;
    EXPECT_TRUE(std::equal(points.begin(), points.end(), mesh.Points));
    model.Points = rest;
    model.Weights = restWeights;
    for (nurbs::Face& face : model.Model.Faces)
    {
      face.Geometry.Points = model.Points.data();
      face.Geometry.Weights = model.Weights.data();
    }
  };
  for (const auto& place : places)
  {
    model.Point(20)[1] = place.first;
    expectRefused("control point (2, 2), point 20", place.second);
  }
  for (const double weight : { 0.0, -1.0 })
  {
    model.Weights[13] = weight;
    expectRefused("control point (4, 1), point 13", "which must be positive");
  }
  model.Weights[13] = std::nan("");
  expectRefused("control point (4, 1), point 13", "is not finite");
  for (std::int64_t k = 0; k < model.Count(); ++k)
  {
    model.Point(k) = Vec3(1.0, 2.0, 3.0);
  }
  expectRefused("face 0", "in one place");
  model.Point(20) += Vec3(0.1, 0.2, -0.1);
  const nurbs::FrameReport report = deforming.Update(model.Model);
  EXPECT_TRUE(report.Accepted) << report.Problem;
  EXPECT_EQ(report.MovedControlPoints, 1);
  ExpectOnSurfaces(mesh, model.Model, 1e-9);
}

// The leaves of all faces: how many, and the largest share of the tolerance that one errs by.
struct Decisions
{
  std::int64_t Leaves = 0;
  double Largest = 0.0;          ///< Error of a leaf.
  double SmallestMerged = 1e300; ///< Error that a cell would have whose halves are leaves.
};

Decisions Decide(const nurbs::DeformingModel& deforming, const nurbs::Model& model)
{
  Decisions out;
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    const nurbs::DeformingFace& face = *deforming.GetFace(f);
    const nurbs::CellForest& cells = face.Cells();
    // Bounds by Core, of the surface as it is now.
    nurbs::SurfaceBound bound(model.Faces[f].Geometry, face.Used());
    const auto error = [&](std::int32_t cell) {
      const nurbs::ParameterBox box = cells.Box(cell);
      bound.MakeGrid({ box.U0, box.U1 }, { box.V0, box.V1 }, nurbs::SerialFor);
      return bound.Over(box).Bow(box.A(), box.B());
    };
    for (std::int32_t cell = 0; cell < cells.Size(); ++cell)
    {
      const nurbs::Cell& c = cells[cell];
      if (c.Patch < 0)
      {
        continue;
      }
      if (c.Child < 0)
      {
        ++out.Leaves;
        out.Largest = std::max(out.Largest, error(cell));
      }
      else if (cells.IsLeaf(c.Child) && cells.IsLeaf(c.Child + 1))
      {
        out.SmallestMerged = std::min(out.SmallestMerged, error(cell));
      }
    }
  }
  return out;
}

// After any frames, cells are halved as in a mesh made anew, but for those that err by between half the
// tolerance and all of it.
TEST(DeformingModel, DecidesAsAFreshMesh)
{
  MovableModel model;
  shapes::AddSheet(model.Builder, 3, 0.8);
  model.Make();
  const std::vector<double> rest = model.Points;
  const double tolerance = 0.02;
  nurbs::MeshVectors mesh;
  nurbs::DeformingModel deforming(model.Model, model.Errors(), Options(tolerance), mesh);
  for (int frame = 1; frame <= 80; ++frame)
  {
    for (std::int64_t k = 0; k < model.Count(); ++k)
    {
      const Eigen::Map<const Vec3> p(rest.data() + 3 * k);
      model.Point(k) =
        p + Vec3(0.0, 0.0, 2.0 * std::sin(0.17 * frame) * std::sin(p[0] - 0.1 * frame));
    }
    deforming.Update(model.Model);
    if (frame % 8 != 0)
    {
      continue;
    }
    SCOPED_TRACE(frame);
    const Decisions ours = Decide(deforming, model.Model);
    // Core's bounds are intervals in floats, ours norms: they differ by little.
    EXPECT_LE(ours.Largest, 1.3 * tolerance);
    EXPECT_GE(ours.SmallestMerged, 0.5 * tolerance);
    std::int64_t fresh[2];
    for (int k = 0; k < 2; ++k)
    {
      nurbs::MeshVectors other;
      nurbs::DeformingModel made(
        model.Model, model.Errors(), Options(k == 0 ? tolerance : 0.5 * tolerance), other);
      fresh[k] = Decide(made, model.Model).Leaves;
    }
    EXPECT_GE(ours.Leaves, fresh[0]);
    EXPECT_LE(ours.Leaves, fresh[1]);
  }
}

TEST(DeformingModel, KeepsItsBudget)
{
  MovableModel model;
  shapes::AddBall(model.Builder, true);
  model.Make();
  const std::vector<double> rest = model.Points;
  nurbs::DeformingOptions options = Options(0.001);
  options.TriangleBudget = 3000;
  nurbs::MeshVectors mesh;
  nurbs::DeformingModel deforming(model.Model, model.Errors(), options, mesh);
  double largest = 0.0;
  double smallest = 1e300;
  for (int frame = 0; frame <= 120; ++frame)
  {
    const double height = 0.5 * std::max(0.0, std::sin(0.1 * frame));
    for (std::int64_t k = 0; k < model.Count(); ++k)
    {
      const Eigen::Map<const Vec3> p(rest.data() + 3 * k);
      model.Point(k) = p + height * Vec3(0.0, 0.0, std::sin(6.0 * p[0]) * std::cos(5.0 * p[1]));
    }
    const nurbs::FrameReport report =
      frame == 0 ? deforming.FirstFrame() : deforming.Update(model.Model);
    EXPECT_LE(mesh.TriangleCount, 3000) << frame;
    EXPECT_GT(mesh.TriangleCount, 1000) << frame;
    EXPECT_LE(report.ErrorBound, 1.0001 * report.ToleranceUsed + report.ModelGap) << frame;
    largest = std::max(largest, report.ToleranceUsed);
    smallest = std::min(smallest, report.ToleranceUsed);
    if (frame % 10 == 0)
    {
      ExpectWhole(mesh, model, Cases[2]);
    }
  }
  EXPECT_GT(largest, 1.5 * smallest); // It gave way and came back.
}

// Patches near the eye and the line of sight are finer.
TEST(DeformingModel, LooksWhereTheViewerDoes)
{
  MovableModel model;
  shapes::AddSheet(model.Builder, 8, 0.8);
  model.Make();
  nurbs::MeshVectors mesh;
  nurbs::DeformingModel deforming(model.Model, model.Errors(), Options(0.002), mesh);
  nurbs::MeshViewer viewer;
  viewer.Eye = Vec3(-2.0, 2.0, 2.0);
  viewer.Direction = Vec3(1.0, 0.0, -0.4).normalized();
  viewer.FullDetail = 3.0;
  const std::int64_t before = mesh.TriangleCount;
  const nurbs::FrameReport report = deforming.Update(model.Model, &viewer);
  EXPECT_EQ(report.MovedControlPoints, 0);
  EXPECT_LT(mesh.TriangleCount, 0.6 * before);
  std::int64_t near = 0, far = 0;
  for (std::int64_t t = 0; t < mesh.TriangleCount; ++t)
  {
    const double x = mesh.Points[3 * mesh.Corners[3 * t]];
    const double y = mesh.Points[3 * mesh.Corners[3 * t] + 1];
    near += x < 2.5 && y < 2.5;
    far += x > 7.5 && y > 7.5;
  }
  EXPECT_GT(near, 3 * far);
  for (int k = 0; k < 2; ++k) // Once more to merge what was halved on the way.
  {
    deforming.Update(model.Model);
  }
  EXPECT_GE(mesh.TriangleCount, before);
  EXPECT_LE(shapes::LargestDistance(mesh, model.Model), 0.002);
}

// A pole that opens, and one that closes.
TEST(DeformingModel, TellsOfPolesThatOpen)
{
  MovableModel model;
  shapes::AddSheet(model.Builder, 4, 0.5);
  model.Make();
  const std::vector<double> rest = model.Points;
  for (int k = 0; k < 7; ++k)
  {
    model.Point(k) = Vec3(5.0, 0.0, 0.0);
  }
  nurbs::MeshVectors mesh;
  nurbs::DeformingModel deforming(model.Model, model.Errors(), Options(0.01), mesh);
  ExpectOnSurfaces(mesh, model.Model, 1e-9);
  for (int k = 0; k < 7; ++k)
  {
    model.Point(k) += Vec3(0.0, 0.1, 0.2);
  }
  EXPECT_TRUE(deforming.Update(model.Model).Accepted);
  model.Points = rest;
  model.Model.Faces[0].Geometry.Points = model.Points.data();
  const nurbs::FrameReport report = deforming.Update(model.Model);
  EXPECT_FALSE(report.Accepted);
  EXPECT_TRUE(report.NeedsReplacement);
}

// One face gets other knots; the others keep their triangles.
TEST(DeformingModel, ReplacesFaces)
{
  MovableModel model;
  shapes::AddBall(model.Builder, true);
  model.Make();
  nurbs::MeshVectors mesh;
  nurbs::DeformingModel deforming(model.Model, model.Errors(), Options(0.01), mesh);
  const std::int64_t triangles = mesh.TriangleCount;
  const nurbs::Surface finer = nurbs::RefineKnots(model.Model.Faces[2].Geometry, 0, { 0.25, 0.7 });
  model.Model.Faces[2].Geometry = finer.View();
  std::vector<char> changed(6, 0);
  changed[2] = 1;
  ASSERT_TRUE(deforming.Replace(model.Model, model.Errors(), changed));
  ExpectOnSurfaces(mesh, model.Model, 1e-9);
  ExpectWhole(mesh, model, Cases[2]);
  EXPECT_NE(mesh.TriangleCount, triangles);
  EXPECT_LE(shapes::LargestDistance(mesh, model.Model), 0.01);
  std::vector<double> points;
  for (const Vec3& p : finer.Points)
  {
    points.insert(points.end(), p.data(), p.data() + 3);
  }
  model.Model.Faces[2].Geometry.Points = points.data();
  for (int frame = 0; frame < 30; ++frame)
  {
    points[3 * 17 + 2] += 0.01; // Inside the face.
    ASSERT_TRUE(deforming.Update(model.Model).Accepted);
  }
  ExpectOnSurfaces(mesh, model.Model, 1e-9);
  ExpectWhole(mesh, model, Cases[2]);
  model.Model.Faces.pop_back();
  EXPECT_FALSE(
    deforming.Replace(model.Model, std::vector<std::string>(5), std::vector<char>(5, 1)));
}

// Points that moved are told, and no others.
TEST(DeformingModel, TellsWhatChanged)
{
  MovableModel model;
  shapes::AddSheet(model.Builder, 12, 0.8);
  model.Make();
  nurbs::MeshVectors mesh;
  nurbs::DeformingModel deforming(model.Model, model.Errors(), Options(0.01), mesh);
  for (int frame = 0; frame < 20; ++frame)
  {
    const std::vector<double> before(mesh.Points, mesh.Points + 3 * mesh.PointCount);
    model.Point(15 * 7 + 7) += Vec3(0.0, 0.0, 0.05);
    const nurbs::FrameReport report = deforming.Update(model.Model);
    const std::vector<unsigned char>& changed = deforming.ChangedPoints();
    ASSERT_EQ(std::int64_t(changed.size()), mesh.PointCount);
    std::int64_t count = 0;
    for (std::int64_t k = 0; k < mesh.PointCount; ++k)
    {
      count += changed[k];
      const bool same = 3 * k + 2 < std::int64_t(before.size()) &&
        std::equal(mesh.Points + 3 * k, mesh.Points + 3 * k + 3, before.data() + 3 * k);
      EXPECT_TRUE(same || changed[k]);
    }
    EXPECT_LE(count, report.UpdatedVertices + report.InsertedVertices + 1);
    EXPECT_LT(count, 0.5 * mesh.PointCount);
    EXPECT_EQ(report.MovedControlPoints, 1);
  }
}

// The result does not depend on how faces are shared out to threads.
TEST(DeformingModel, IsTheSameForAllThreads)
{
  std::vector<std::vector<double>> points(2);
  std::vector<std::vector<std::int64_t>> corners(2);
  for (int threads = 1; threads <= 2; ++threads)
  {
    MovableModel model;
    shapes::AddBall(model.Builder, true);
    shapes::AddHoles(model.Builder);
    model.Make();
    nurbs::DeformingOptions options = Options(0.01);
    if (threads == 2)
    {
      options.Parallel = [](std::int64_t first, std::int64_t last,
                           const std::function<void(std::int64_t, std::int64_t)>& body) {
        std::vector<std::thread> pool;
        for (std::int64_t k = first; k < last; ++k)
        {
          pool.emplace_back([&body, k]() { body(k, k + 1); });
        }
        for (std::thread& thread : pool)
        {
          thread.join();
        }
      };
    }
    nurbs::MeshVectors mesh;
    nurbs::DeformingModel deforming(model.Model, model.Errors(), options, mesh);
    for (int frame = 0; frame < 20; ++frame)
    {
      for (std::int64_t k = 0; k < model.Count(); ++k)
      {
        model.Point(k)[2] += 0.02 * std::sin(3.0 * model.Point(k)[0] + 0.3 * frame);
      }
      deforming.Update(model.Model);
    }
    points[threads - 1].assign(mesh.Points, mesh.Points + 3 * mesh.PointCount);
    corners[threads - 1].assign(mesh.Corners, mesh.Corners + 3 * mesh.TriangleCount);
  }
  EXPECT_EQ(points[0], points[1]);
  EXPECT_EQ(corners[0], corners[1]);
}

// What the paper's correction of cracks (section 4.3) would do to the same cells: a vertex of a finer
// neighbour on a cell's side moves onto the side, off the surface. Ours stays, and the cell has a triangle
// more for it.
TEST(DeformingModel, CracksNeedNoCorrection)
{
  for (const double height : { 0.8, 3.0 })
  {
    MovableModel model;
    shapes::AddSheet(model.Builder, 5, height);
    model.Make();
    const double tolerance = 0.01;
    nurbs::MeshVectors mesh;
    nurbs::DeformingModel deforming(model.Model, model.Errors(), Options(tolerance), mesh);
    const nurbs::DeformingFace& face = *deforming.GetFace(0);
    std::map<std::pair<long long, long long>, std::int64_t> points;
    const auto key = [](double u, double v) {
      return std::make_pair(std::llround(1e10 * u), std::llround(1e10 * v));
    };
    for (std::int64_t k = 0; k < mesh.PointCount; ++k)
    {
      points[key(mesh.UV[2 * k], mesh.UV[2 * k + 1])] = k;
    }
    const auto at = [&](const Vec2& uv) { return points.find(key(uv[0], uv[1])); };
    std::int64_t cells = 0, hanging = 0;
    double largest = 0.0, sum = 0.0;
    for (std::int32_t c = 0; c < face.Cells().Size(); ++c)
    {
      if (face.Cells()[c].Patch < 0 || !face.Cells().IsLeaf(c))
      {
        continue;
      }
      ++cells;
      const nurbs::ParameterBox box = face.Cells().Box(c);
      const Vec2 corners[4] = { { box.U0, box.V0 }, { box.U1, box.V0 }, { box.U1, box.V1 },
        { box.U0, box.V1 } };
      for (int side = 0; side < 4; ++side)
      {
        const Vec2& a = corners[side];
        const Vec2& b = corners[(side + 1) % 4];
        const Eigen::Map<const Vec3> pa(mesh.Points + 3 * at(a)->second);
        const Eigen::Map<const Vec3> pb(mesh.Points + 3 * at(b)->second);
        for (int k = 1; k < 16; ++k)
        {
          const auto found = at(Vec2(a + (b - a) * (k / 16.0)));
          if (found != points.end())
          {
            const Eigen::Map<const Vec3> p(mesh.Points + 3 * found->second);
            const double t = (p - pa).dot(pb - pa) / (pb - pa).squaredNorm();
            const double off = (p - pa - t * (pb - pa)).norm();
            ++hanging;
            largest = std::max(largest, off);
            sum += off;
          }
        }
      }
    }
    EXPECT_EQ(mesh.TriangleCount, 2 * cells + hanging);
    EXPECT_LE(shapes::LargestDistance(mesh, model.Model), tolerance);
    EXPECT_GT(largest, 0.2 * tolerance); // The correction would show.
    const std::string name = height < 1.0 ? "flat" : "steep";
    RecordProperty(name + "_cells", std::to_string(cells));
    RecordProperty(name + "_triangles", std::to_string(mesh.TriangleCount));
    RecordProperty(name + "_hanging", std::to_string(hanging));
    RecordProperty(name + "_largest_correction", std::to_string(largest / tolerance));
    RecordProperty(name + "_mean_correction", std::to_string(sum / double(hanging) / tolerance));
  }
}

} // namespace
