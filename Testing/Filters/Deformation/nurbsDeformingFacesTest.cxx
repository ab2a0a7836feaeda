// SPDX-License-Identifier: BSD-3-Clause
// Deforming models with trims, options and faces that ask for care.
#include "nurbsDeformingShapes.h"

#include <gtest/gtest.h>

namespace
{

using nurbs::Vec2;
using nurbs::Vec3;
using shapes::MovableModel;

constexpr double Rounding = 1e-12;

nurbs::DeformingOptions Options(double tolerance)
{
  nurbs::DeformingOptions options;
  options.Tolerance = tolerance;
  options.SideTolerance = 1e-9;
  return options;
}

/// A sheet of many patches in a circle, whose first polygon leaves many of them outside.
void AddDisc(nurbs::ModelBuilder& builder, int spans, double height)
{
  MovableModel sheet;
  shapes::AddSheet(sheet.Builder, spans, height);
  sheet.Make();
  const nurbs::SurfaceView& surface = sheet.Model.Faces[0].Geometry;
  const nurbs::Curve<2> circle = nurbs::TrimCircle({ 0.5, 0.5 }, 0.45);
  const std::int64_t vertex = builder.AddVertex(nurbs::Evaluate(surface, 0.95, 0.5));
  const std::int64_t edge = builder.AddUnknownEdge(1e-12, vertex, vertex);
  builder.BeginFace(surface, nurbs::FaceAttributes());
  builder.BeginLoop();
  builder.AddTrimCurve(circle.View(), edge, false);
}

constexpr double DiscArea = 0.45 * 0.45 * 3.14159265358979323846;

void ExpectBounded(const nurbs::MeshArrays& mesh, const nurbs::Model& model,
  const nurbs::FrameReport& report, double tolerance)
{
  EXPECT_LE(report.ErrorBound, 1.0001 * tolerance + report.ModelGap);
  EXPECT_LE(shapes::LargestDistance(mesh, model), report.ErrorBound + Rounding);
}

// Patches between the loop and its first, coarse polygon are refined like all others.
TEST(DeformingFaces, RefinesPatchesThatLoopsTakeInLate)
{
  MovableModel model;
  AddDisc(model.Builder, 30, 0.8);
  model.Make();
  nurbs::MeshVectors mesh;
  nurbs::DeformingModel deforming(model.Model, model.Errors(), Options(0.002), mesh);
  ExpectBounded(mesh, model.Model, deforming.FirstFrame(), 0.002);
  EXPECT_NEAR(shapes::ParameterArea(mesh, 0), DiscArea, 1e-3);
  EXPECT_EQ(deforming.FirstFrame().CappedCells, 0);
}

// From a plane, whose loop is a coarse polygon and stays one where few points move.
TEST(DeformingFaces, RefinesPatchesThatLoopsTakeInLater)
{
  MovableModel model;
  AddDisc(model.Builder, 30, 0.0);
  model.Make();
  nurbs::MeshVectors mesh;
  nurbs::DeformingModel deforming(model.Model, model.Errors(), Options(0.002), mesh);
  for (int frame = 1; frame <= 20; ++frame)
  {
    for (std::int64_t k = 0; k < model.Count(); ++k)
    {
      model.Point(k)[2] = 0.05 * frame * std::sin(model.Point(k)[0]);
    }
    const nurbs::FrameReport report = deforming.Update(model.Model);
    SCOPED_TRACE(frame);
    ASSERT_TRUE(report.Accepted) << report.Problem;
    ExpectBounded(mesh, model.Model, report, 0.002);
  }
}

// Cells that stay as they are made have loops within the tolerance, and a bound.
TEST(DeformingFaces, BoundsWhatIsMadeOnce)
{
  for (const int depth : { -1, 0, 2 })
  {
    SCOPED_TRACE(depth);
    MovableModel model;
    AddDisc(model.Builder, 6, 0.8);
    model.Make();
    nurbs::DeformingOptions options = Options(0.002);
    options.Refine = false;
    options.FixedDepth = depth;
    nurbs::MeshVectors mesh;
    nurbs::DeformingModel deforming(model.Model, model.Errors(), options, mesh);
    ExpectBounded(mesh, model.Model, deforming.FirstFrame(), depth < 0 ? 0.002 : 1.0);
    EXPECT_NEAR(shapes::ParameterArea(mesh, 0), DiscArea, 1e-3);
    const std::int64_t triangles = mesh.TriangleCount;
    for (std::int64_t k = 0; k < model.Count(); ++k)
    {
      model.Point(k)[2] *= 1.5;
    }
    EXPECT_TRUE(deforming.Update(model.Model).Accepted);
    EXPECT_EQ(mesh.TriangleCount, triangles);
  }
}

// The same weights once more after all kinds of weights: what was known of errors then is forgotten.
TEST(DeformingFaces, ForgetsErrorsWithWeights)
{
  MovableModel model;
  shapes::AddTorus(model.Builder, 3.0, 1.0);
  model.Make();
  const std::vector<double> rest = model.Weights;
  nurbs::MeshVectors mesh;
  nurbs::DeformingModel deforming(model.Model, model.Errors(), Options(0.01), mesh);
  for (int frame = 1; frame <= 12; ++frame)
  {
    for (std::size_t k = 0; k < rest.size(); ++k)
    {
      model.Weights[k] = rest[k] * (frame % 4 == 0 ? 1.0 : 1.0 + 0.9 * std::sin(1.7 * k + frame));
    }
    const nurbs::FrameReport report = deforming.Update(model.Model);
    ASSERT_TRUE(report.Accepted) << report.Problem;
    ExpectBounded(mesh, model.Model, report, 0.01);
  }
  nurbs::MeshVectors other; // Cells are merged that err by less than half the tolerance.
  nurbs::DeformingModel fresh(model.Model, model.Errors(), Options(0.005), other);
  EXPECT_LT(mesh.TriangleCount, 1.3 * other.TriangleCount);
}

TEST(DeformingFaces, TellsOfBadOptions)
{
  MovableModel model;
  shapes::AddSheet(model.Builder, 2, 0.5);
  model.Make();
  const auto expectError = [&](void (*change)(nurbs::DeformingOptions&), const char* reason) {
    nurbs::DeformingOptions options = Options(0.01);
    change(options);
    nurbs::MeshVectors mesh;
    try
    {
      nurbs::DeformingModel deforming(model.Model, model.Errors(), options, mesh);
      ADD_FAILURE() << reason;
    }
    catch (const nurbs::Error& error)
    {
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  };
  using O = nurbs::DeformingOptions;
  expectError([](O& o) { o.Tolerance = 0.0; }, "tolerance");
  expectError([](O& o) { o.Tolerance = std::nan(""); }, "tolerance");
  expectError([](O& o) { o.Hysteresis = 1.5; }, "hysteresis");
  expectError([](O& o) { o.Hysteresis = 0.0; }, "hysteresis");
  expectError([](O& o) { o.FixedDepth = 13; }, "fixed depth");
  expectError([](O& o) { o.MemoryLimit = -1; }, "memory limit");
  expectError([](O& o) { o.TriangleBudget = -5; }, "triangle budget");
  expectError([](O& o) { o.LargestMove = std::nan(""); }, "largest move");
}

// A budget that no mesh of the model can keep costs nothing for ever, and is forgotten by none.
TEST(DeformingFaces, LivesWithABudgetThatIsTooSmall)
{
  MovableModel model;
  shapes::AddHoles(model.Builder);
  model.Make();
  nurbs::DeformingOptions options = Options(0.01);
  options.TriangleBudget = 10;
  nurbs::MeshVectors mesh;
  nurbs::DeformingModel deforming(model.Model, model.Errors(), options, mesh);
  double used = deforming.FirstFrame().ToleranceUsed;
  EXPECT_LT(used, 40.0); // Twice the size of the model.
  for (int frame = 0; frame < 5; ++frame)
  {
    model.Point(30)[2] += 0.01;
    EXPECT_EQ(deforming.Update(model.Model).ToleranceUsed, used);
  }
}

TEST(DeformingFaces, KeepsTheLargestNumberOfCells)
{
  MovableModel model;
  shapes::AddSheet(model.Builder, 2, 0.8);
  model.Make();
  nurbs::MeshVectors mesh;
  std::unique_ptr<nurbs::DeformingFace> face;
  nurbs::MeshSlots slots(mesh, [&](const nurbs::TriangleOwner& owner) -> std::int32_t& {
    return face->FirstTriangle(owner.Cell);
  });
  nurbs::FaceOptions options;
  options.Tolerance = 1e-6;
  options.MaximumLeaves = 100;
  face = std::make_unique<nurbs::DeformingFace>(model.Model.Faces[0].Geometry, false,
    nurbs::ParameterBox{ 0.0, 1.0, 0.0, 1.0 }, 0, slots, options);
  face->Adapt([](const Vec3&) { return 1.0; }, true, 0.5);
  EXPECT_EQ(face->Cells().Size(), 4 + 2 * 96); // 100 leaves: four patches, 96 of which were halved.
  EXPECT_GT(face->CappedCells(), 0);
  EXPECT_GT(face->ErrorBound(), 1e-6);
}

// A face that can't be used any more goes, its neighbours stay; and it comes back.
TEST(DeformingFaces, TakesFacesAwayAndBack)
{
  MovableModel model;
  shapes::AddBall(model.Builder, true);
  model.Make();
  nurbs::MeshVectors mesh;
  nurbs::DeformingModel deforming(model.Model, model.Errors(), Options(0.01), mesh);
  const nurbs::FrameReport first = deforming.FirstFrame();
  std::vector<std::string> errors(6);
  errors[2] = "bad knots";
  std::vector<char> changed(6, 0);
  changed[2] = 1;
  for (int turn = 0; turn < 3; ++turn)
  {
    SCOPED_TRACE(turn);
    ASSERT_TRUE(deforming.Replace(model.Model, errors, changed));
    EXPECT_LE(deforming.FirstFrame().ErrorBound, 1.0001 * 0.01 + first.ModelGap);
    EXPECT_EQ(shapes::ParameterArea(mesh, 2), 0.0);
    EXPECT_GT(shapes::Count(mesh, model.Model).Open, 0);
    EXPECT_EQ(shapes::Count(mesh, model.Model).Inside, 0);
    for (int frame = 0; frame < 5; ++frame)
    {
      for (std::int64_t k = 0; k < model.Count(); ++k)
      {
        model.Point(k) *= 1.1;
      }
      ASSERT_TRUE(deforming.Update(model.Model).Accepted);
    }
    for (std::int64_t k = 0; k < model.Count(); ++k)
    {
      model.Point(k) /= std::pow(1.1, 5);
    }
    ASSERT_TRUE(deforming.Update(model.Model).Accepted);
    ASSERT_TRUE(deforming.Replace(model.Model, model.Errors(), changed));
    EXPECT_LE(deforming.FirstFrame().ErrorBound, 1.0001 * 0.01 + first.ModelGap);
    EXPECT_EQ(shapes::Count(mesh, model.Model).Open, 0);
    for (std::size_t f = 0; f < 6; ++f)
    {
      EXPECT_NEAR(shapes::ParameterArea(mesh, f), 1.0, 1e-9);
    }
    EXPECT_LE(shapes::LargestDistance(mesh, model.Model), 0.01);
  }
  EXPECT_LT(mesh.PointCount, 1.2 * mesh.TriangleCount); // No points are left behind.
}

// The former model may go with its arrays when faces are replaced, after a refused frame, too.
TEST(DeformingFaces, LetsFormerModelsGo)
{
  auto former = std::make_unique<MovableModel>();
  shapes::AddBall(former->Builder, true);
  former->Make();
  MovableModel model;
  shapes::AddBall(model.Builder, true);
  model.Make();
  nurbs::MeshVectors mesh;
  nurbs::DeformingModel deforming(former->Model, former->Errors(), Options(0.01), mesh);
  former->Point(3)[0] = std::nan("");
  EXPECT_FALSE(deforming.Update(former->Model).Accepted);
  std::vector<char> changed(6, 0);
  changed[1] = 1;
  ASSERT_TRUE(deforming.Replace(model.Model, model.Errors(), changed));
  former.reset();
  for (int frame = 0; frame < 10; ++frame)
  {
    for (std::int64_t k = 0; k < model.Count(); ++k)
    {
      model.Point(k) *= 1.2;
    }
    const nurbs::FrameReport report = deforming.Update(model.Model);
    ASSERT_TRUE(report.Accepted) << report.Problem;
    ExpectBounded(mesh, model.Model, report, 0.01);
  }
}

// Points of faces that stay where they are follow their neighbours' along edges, and that is told.
TEST(DeformingFaces, TellsOfPointsThatNeighboursMove)
{
  for (int moved = 0; moved < 6; ++moved)
  {
    MovableModel model;
    shapes::AddBall(model.Builder, true);
    model.Make();
    nurbs::DeformingOptions options = Options(0.01);
    options.FixedDepth = 2;
    nurbs::MeshVectors mesh;
    nurbs::DeformingModel deforming(model.Model, model.Errors(), options, mesh);
    const std::vector<double> before(mesh.Points, mesh.Points + 3 * mesh.PointCount);
    const std::int64_t share = model.Count() / 6;
    for (std::int64_t k = moved * share; k < (moved + 1) * share; ++k)
    {
      model.Point(k) *= 1.001;
    }
    EXPECT_EQ(deforming.Update(model.Model).MovedControlPoints, share);
    const std::vector<unsigned char> changed = deforming.ChangedPoints();
    ASSERT_EQ(changed.size() * 3, before.size());
    for (std::size_t k = 0; k < changed.size(); ++k)
    {
      const bool same = std::equal(mesh.Points + 3 * k, mesh.Points + 3 * k + 3, &before[3 * k]);
      EXPECT_TRUE(same || changed[k]) << moved << " " << k;
    }
  }
}

// A model of which no face can be used is empty, and stays so.
TEST(DeformingFaces, TakesModelsWithoutUsableFaces)
{
  MovableModel model;
  shapes::AddHoles(model.Builder);
  model.Make();
  const std::vector<std::string> errors(model.Model.Faces.size(), "bad");
  nurbs::MeshVectors mesh;
  nurbs::DeformingModel deforming(model.Model, errors, Options(0.01), mesh);
  model.Point(5)[1] += 0.1;
  EXPECT_TRUE(deforming.Update(model.Model).Accepted);
  EXPECT_EQ(mesh.TriangleCount, 0);
  EXPECT_EQ(mesh.PointCount, 0);
}

// A face that nothing can be made of is told; the others come out.
TEST(DeformingFaces, TellsOfFacesWithoutArea)
{
  MovableModel model;
  shapes::AddBall(model.Builder, true);
  shapes::AddHoles(model.Builder);
  model.Make();
  nurbs::Model flat = model.Model;
  // The loop of the first patch is on a line of its domain.
  const double points[6] = { 0.0, 0.5, 1.0, 1.0, 0.5, 1.0 };
  const nurbs::Face& face = flat.Faces[0];
  const nurbs::TrimLoop& loop = flat.Loops[face.FirstLoop];
  for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
  {
    flat.TrimCurves[c].Geometry.Points = points;
    flat.TrimCurves[c].Geometry.Count = 2;
    flat.TrimCurves[c].Geometry.Degree = 1;
  }
  nurbs::DeformingOptions options;
  options.Tolerance = 0.02;
  nurbs::MeshVectors mesh;
  nurbs::DeformingModel deforming(flat, model.Errors(), options, mesh);
  EXPECT_NE(deforming.FaceProblems()[0].find("no area"), std::string::npos);
  EXPECT_EQ(shapes::ParameterArea(mesh, 0), 0.0);
  for (std::size_t f = 1; f < flat.Faces.size(); ++f)
  {
    EXPECT_EQ(deforming.FaceProblems()[f], "");
    EXPECT_GT(shapes::ParameterArea(mesh, f), 0.0);
  }
}

// Two circles that cross in the parameters: the frame says so.
TEST(DeformingFaces, TellsOfLoopsThatCross)
{
  MovableModel model;
  shapes::AddSheet(model.Builder, 3, 0.5);
  const nurbs::Curve<2> outer = nurbs::TrimCircle(Vec2(0.4, 0.5), 0.2);
  const nurbs::Curve<2> other = nurbs::TrimCircle(Vec2(0.6, 0.5), 0.2);
  for (const nurbs::Curve<2>* circle : { &outer, &other })
  {
    model.Builder.BeginLoop();
    model.Builder.AddTrimCurve(circle->View(), -1, false);
  }
  model.Make();
  nurbs::DeformingOptions options;
  options.Tolerance = 0.02;
  nurbs::MeshVectors mesh;
  const nurbs::DeformingModel deforming(model.Model, model.Errors(), options, mesh);
  EXPECT_EQ(deforming.FirstFrame().CrossingFaces, 1);
}

} // namespace
