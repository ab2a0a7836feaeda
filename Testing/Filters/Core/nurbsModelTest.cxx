// SPDX-License-Identifier: BSD-3-Clause
// Builder and checks of the model's arrays: every kind of bad input is told from a good one, by
// name and number, and spoils no other face.
#include "ModelBuilder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{

using nurbs::AssembledModel;
using nurbs::ModelBuilder;
using nurbs::ModelProblem;
using nurbs::Vec2;
using nurbs::Vec3;

nurbs::Curve<2> Line(const Vec2& a, const Vec2& b)
{
  nurbs::Curve<2> line;
  line.Knots = { 0, 0, 1, 1 };
  line.Points = { a, b };
  line.Weights = { 1, 1 };
  line.Pack();
  return line;
}

nurbs::Curve<3> Line(const Vec3& a, const Vec3& b)
{
  nurbs::Curve<3> line;
  line.Knots = { 0, 0, 1, 1 };
  line.Points = { a, b };
  line.Weights = { 1, 1 };
  line.Pack();
  return line;
}

/// The square [x, x + 1] x [0, 1] of degree 2 x 1 with weights 1.
nurbs::Surface Square(double x)
{
  nurbs::Surface square;
  square.Degree[0] = 2;
  square.Count[0] = 3;
  square.Count[1] = 2;
  square.Knots[0] = { 0, 0, 0, 1, 1, 1 };
  square.Knots[1] = { 0, 0, 1, 1 };
  for (int k = 0; k < 6; ++k)
  {
    square.Points.emplace_back(x + 0.5 * (k % 3), k / 3, 0.0);
    square.Weights.push_back(1.0);
  }
  return square;
}

/// A loop through the points, without edges.
void AddLoop(ModelBuilder& builder, const std::vector<Vec2>& points)
{
  builder.BeginLoop();
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    builder.AddTrimCurve(Line(points[i], points[(i + 1) % points.size()]).View(), -1, false);
  }
}

const std::vector<Vec2> Hole{ { 0.2, 0.2 }, { 0.2, 0.7 }, { 0.6, 0.5 } };

/// Face 0 (FaceId 70), with the natural boundary and a hole, and face 1 (FaceId 71) beside it;
/// they share edge 1, each from the other side.
ModelBuilder TwoSquares()
{
  ModelBuilder builder;
  for (int i = 0; i < 6; ++i)
  {
    builder.AddVertex(Vec3(i / 2, i % 2, 0));
  }
  const auto edge = [&builder](int a, int b) {
    const Vec3 start(a / 2, a % 2, 0), end(b / 2, b % 2, 0);
    builder.AddEdge(Line(start, end).View(), 1e-12, a, b);
  };
  edge(0, 2);
  edge(2, 3);
  edge(3, 1);
  edge(1, 0);
  edge(2, 4);
  edge(4, 5);
  edge(5, 3);
  for (int face = 0; face < 2; ++face)
  {
    nurbs::FaceAttributes attributes;
    attributes.FaceId = 70 + face;
    builder.BeginFace(Square(face).View(), attributes);
    builder.BeginLoop();
    const Vec2 corners[4] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
    for (int side = 0; side < 4; ++side)
    {
      const int own[2][4] = { { 0, 1, 2, 3 }, { 4, 5, 6, 1 } };
      const bool backwards = face == 1 && side == 3;
      const Vec2 a = corners[side], b = corners[(side + 1) % 4];
      builder.AddTrimCurve(
        (backwards ? Line(b, a) : Line(a, b)).View(), own[face][side], backwards);
    }
    if (face == 0)
    {
      AddLoop(builder, Hole);
    }
  }
  return builder;
}

/// Expects that face 0 has an error with all `parts` and face 1 none.
void ExpectFirstFaceBad(const ModelBuilder& builder, const std::vector<std::string>& parts)
{
  const AssembledModel model = nurbs::AssembleModel(builder.Arrays());
  ASSERT_EQ(model.FaceErrors.size(), 2u);
  for (const std::string& part : parts)
  {
    EXPECT_NE(model.FaceErrors[0].find(part), std::string::npos)
      << "'" << part << "' in '" << model.FaceErrors[0] << "'";
  }
  EXPECT_EQ(model.Model.Faces[0].Geometry.Size(), 0);
  EXPECT_EQ(model.Model.Faces[0].LoopCount, 0);
  EXPECT_EQ(model.FaceErrors[1], "");
  EXPECT_EQ(model.Model.Faces[1].Geometry.Size(), 6);
  EXPECT_EQ(model.Model.Faces[1].LoopCount, 1);
}

/// The model's only problem: a warning with this text.
void ExpectOneWarning(const ModelBuilder& builder, std::int64_t face, const std::string& part)
{
  const AssembledModel model = nurbs::AssembleModel(builder.Arrays());
  ASSERT_EQ(model.Problems.size(), 1u);
  EXPECT_EQ(model.Problems[0].Severity, ModelProblem::Level::Warning);
  EXPECT_EQ(model.Problems[0].Face, face);
  EXPECT_NE(model.Problems[0].Reason.find(part), std::string::npos) << model.Problems[0].Reason;
  EXPECT_EQ(model.FaceErrors[0] + model.FaceErrors[1], "");
}

constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr std::int64_t Huge = std::numeric_limits<std::int64_t>::max();

TEST(Model, BuilderAndAssemblyKeepEverything)
{
  const ModelBuilder builder = TwoSquares();
  const AssembledModel assembled = nurbs::AssembleModel(builder.Arrays());
  EXPECT_TRUE(assembled.Problems.empty());
  const nurbs::Model& model = assembled.Model;
  ASSERT_EQ(model.Faces.size(), 2u);
  EXPECT_EQ(model.Faces[1].FaceId, 71);
  EXPECT_EQ(model.Faces[0].LoopCount, 2);
  EXPECT_EQ(model.Loops.size(), 3u);
  EXPECT_EQ(model.TrimCurves.size(), 11u);
  EXPECT_TRUE(model.TrimCurves[10].Reversed);
  EXPECT_EQ(model.TrimCurves[10].Edge, 1);
  EXPECT_EQ(model.Edges[1].Vertex[1], 3);
  EXPECT_EQ(model.Vertices[5], Vec3(2, 1, 0));
  EXPECT_EQ(nurbs::Evaluate(model.Faces[1].Geometry, 0.5, 1.0), Vec3(1.5, 1, 0));
  // Views, not copies.
  EXPECT_EQ(model.Faces[0].Geometry.Points, builder.Data.Points.data());
  EXPECT_EQ(model.TrimCurves[0].Geometry.Points, builder.Data.TrimPoints.data());
}

TEST(Model, DroppedFaceLeavesNoTrace)
{
  ModelBuilder builder = TwoSquares();
  const ModelBuilder::Storage before = builder.Data;
  builder.BeginFace(Square(7).View(), nurbs::FaceAttributes());
  AddLoop(builder, Hole);
  AddLoop(builder, Hole);
  builder.DropFace();
  EXPECT_EQ(builder.Data.Points, before.Points);
  EXPECT_EQ(builder.Data.Weights, before.Weights);
  EXPECT_EQ(builder.Data.Knots, before.Knots);
  EXPECT_EQ(builder.Data.Offsets, before.Offsets);
  EXPECT_EQ(builder.Data.TrimPoints, before.TrimPoints);
  EXPECT_EQ(builder.Data.TrimCurveEdgeId, before.TrimCurveEdgeId);
  EXPECT_EQ(builder.Data.LoopCurveCount, before.LoopCurveCount);
  EXPECT_EQ(builder.Data.Color, before.Color);
  builder.BeginFace(Square(7).View(), nurbs::FaceAttributes());
  builder.DropFace();
  EXPECT_EQ(builder.Data.TrimPoints, before.TrimPoints);
  EXPECT_EQ(builder.Data.LoopStart, before.LoopStart);
  EXPECT_TRUE(nurbs::AssembleModel(builder.Arrays()).Problems.empty());
}

TEST(Model, PolynomialFacesBeforeRationalOnesGetWeights)
{
  ModelBuilder builder;
  nurbs::Surface polynomial = Square(0);
  polynomial.Weights.clear();
  builder.BeginFace(polynomial.View(), nurbs::FaceAttributes());
  EXPECT_TRUE(builder.Data.Weights.empty());
  builder.BeginFace(Square(1).View(), nurbs::FaceAttributes());
  builder.BeginFace(polynomial.View(), nurbs::FaceAttributes());
  EXPECT_EQ(builder.Data.Weights, std::vector<double>(18, 1.0));
}

TEST(Model, BadControlPoints)
{
  for (const double bad : { NaN, Infinity, -Infinity })
  {
    ModelBuilder builder = TwoSquares();
    builder.Data.Points[3 * 4 + 1] = bad;
    ExpectFirstFaceBad(builder, { "control point 4", "not finite" });
  }
  ModelBuilder far = TwoSquares();
  far.Data.Points[3 * 4 + 1] = -2e50;
  ExpectFirstFaceBad(far, { "control point 4", "-2e+50", "limit" });
  for (const std::int64_t id : { std::int64_t(-1), std::int64_t(12), Huge })
  {
    ModelBuilder builder = TwoSquares();
    builder.Data.Connectivity[2] = id;
    ExpectFirstFaceBad(builder, { "control point 2", "point " + std::to_string(id) + " of 12" });
  }
}

TEST(Model, BadWeights)
{
  for (const double bad : { 1e-21, 1e21 })
  {
    ModelBuilder builder = TwoSquares();
    builder.Data.Weights[5] = bad;
    ExpectFirstFaceBad(builder, { "control point 5", "weight", "limits" });
  }
  for (const double bad : { 0.0, -1.0, NaN, Infinity })
  {
    ModelBuilder builder = TwoSquares();
    builder.Data.Weights[5] = bad;
    ExpectFirstFaceBad(builder, { "control point 5", "weight", "must be positive" });
    builder = TwoSquares();
    builder.Data.TrimPoints[3 * 8 + 2] = bad; // The hole's first curve.
    ExpectFirstFaceBad(builder, { "loop 1", "trim curve 0", "control point 0" });
  }
}

TEST(Model, BadKnots)
{
  ModelBuilder builder = TwoSquares();
  builder.Data.Knots[3] = -1.0;
  ExpectFirstFaceBad(builder, { "in u" });
  builder = TwoSquares();
  builder.Data.Knots[7] = NaN;
  ExpectFirstFaceBad(builder, { "in v" });
  builder = TwoSquares();
  std::fill_n(builder.Data.Knots.begin(), 6, 0.5); // Empty domain.
  ExpectFirstFaceBad(builder, { "in u" });
  builder = TwoSquares();
  builder.Data.TrimKnots[2] = -3.0;
  ExpectFirstFaceBad(builder, { "loop 0", "trim curve 0" });
  for (const std::int64_t start : { std::int64_t(-1), std::int64_t(19), Huge })
  {
    builder = TwoSquares();
    builder.Data.KnotStart[1] = start;
    ExpectFirstFaceBad(builder, { "Knots has 20 entries", "in v" });
    builder = TwoSquares();
    builder.Data.TrimCurveKnotStart[0] = start == 19 ? 43 : start;
    ExpectFirstFaceBad(builder, { "TrimKnots has 44 entries" });
  }
}

TEST(Model, BadDegreesAndCounts)
{
  for (const std::int64_t degree : { std::int64_t(0), std::int64_t(-1), std::int64_t(26), Huge })
  {
    ModelBuilder builder = TwoSquares();
    builder.Data.Degree[0] = degree;
    ExpectFirstFaceBad(builder, { "degree " + std::to_string(degree), "1 and 25" });
    builder = TwoSquares();
    builder.Data.TrimCurveDegree[0] = degree;
    ExpectFirstFaceBad(builder, { "loop 0", "trim curve 0", "degree" });
  }
  for (const std::int64_t count : { std::int64_t(-3), std::int64_t(0), std::int64_t(2), Huge })
  {
    ModelBuilder builder = TwoSquares();
    builder.Data.NetSize[0] = count;
    ExpectFirstFaceBad(builder, { "control points in u" });
  }
  ModelBuilder builder = TwoSquares();
  builder.Data.NetSize[0] = 4;
  builder.Data.KnotStart[0] = 20;
  for (const double knot : { 0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0 })
  {
    builder.Data.Knots.push_back(knot);
  }
  ExpectFirstFaceBad(builder, { "4 x 2", "6 points" });
  for (const std::int64_t count : { std::int64_t(-3), std::int64_t(1), std::int64_t(50), Huge })
  {
    builder = TwoSquares();
    builder.Data.TrimCurvePointCount[0] = count;
    ExpectFirstFaceBad(builder, { "loop 0: trim curve 0" });
  }
}

TEST(Model, BadRanges)
{
  const std::int64_t bad[] = { -1, 3, Huge };
  for (const std::int64_t value : bad)
  {
    ModelBuilder builder = TwoSquares();
    builder.Data.LoopStart[0] = value;
    ExpectFirstFaceBad(builder, { "LoopCurveStart has 3 entries" });
    builder = TwoSquares();
    builder.Data.LoopCurveStart[0] = value == 3 ? 8 : value;
    ExpectFirstFaceBad(builder, { "loop 0", "TrimCurveDegree has 11 entries" });
    builder = TwoSquares();
    builder.Data.TrimCurvePointStart[0] = value == 3 ? 21 : value;
    ExpectFirstFaceBad(builder, { "TrimPoints has 22 entries" });
    builder = TwoSquares();
    builder.Data.TrimCurveEdgeId[0] = value == 3 ? 7 : (value == -1 ? -2 : value);
    ExpectFirstFaceBad(builder, { "edge", "does not exist" });
  }
  ModelBuilder builder = TwoSquares();
  builder.Data.LoopCount[0] = Huge;
  ExpectFirstFaceBad(builder, { "LoopCurveStart" });
  builder = TwoSquares();
  builder.Data.LoopCurveCount[1] = 0;
  ExpectFirstFaceBad(builder, { "loop 1", "no trim curve" });
  builder = TwoSquares();
  builder.Data.LoopCurveStart[1] = 0;
  builder.Data.LoopCurveCount[1] = 11;
  ExpectFirstFaceBad(builder, { "loop 1", "more trim curves than there are" });
}

TEST(Model, ArraysWhoseSizesDisagree)
{
  ModelBuilder builder = TwoSquares();
  builder.Data.Degree.pop_back();
  AssembledModel model = nurbs::AssembleModel(builder.Arrays());
  EXPECT_NE(model.FaceErrors[0].find("Degree has 3 values instead of 4"), std::string::npos);
  EXPECT_EQ(model.FaceErrors[1], model.FaceErrors[0]);

  builder = TwoSquares();
  builder.Data.TrimCurvePointCount.pop_back();
  model = nurbs::AssembleModel(builder.Arrays());
  EXPECT_NE(model.FaceErrors[1].find("TrimCurvePointCount has 10"), std::string::npos);

  builder = TwoSquares();
  builder.Data.Weights.pop_back();
  model = nurbs::AssembleModel(builder.Arrays());
  EXPECT_NE(model.FaceErrors[0].find("RationalWeights has 11"), std::string::npos);
}

TEST(Model, OpenLoopIsAnErrorWithItsGap)
{
  ModelBuilder builder = TwoSquares();
  builder.Data.TrimPoints[3 * 8] += 0.25; // The hole's start moves, its end stays.
  ExpectFirstFaceBad(builder, { "loop 1", "open", "trim curves 2 and 0", "0.25" });
  builder = TwoSquares();
  builder.Data.TrimPoints[3 * 8] += 1e-3;
  ExpectOneWarning(builder, 0, "loop 1: it has a gap of 0.001 of the domain");
  builder = TwoSquares();
  builder.Data.TrimPoints[3 * 8] += 1e-5;
  EXPECT_TRUE(nurbs::AssembleModel(builder.Arrays()).Problems.empty());
}

TEST(Model, GapWithinItsEdgesToleranceIsAWarning)
{
  ModelBuilder builder = TwoSquares();
  builder.Data.TrimPoints[0] += 0.03; // The first curve starts late: edges 3 and 0 should meet.
  builder.Data.EdgeVertices[0] = -1;
  ExpectFirstFaceBad(builder, { "loop 0", "open", "trim curves 3 and 0", "0.03" });
  builder.Data.EdgeTolerance[0] = builder.Data.EdgeTolerance[3] = 0.02;
  ExpectOneWarning(builder, 0, "loop 0: it has a gap of 0.03 of the domain");
}

TEST(Model, GapWhereEdgesMeetInAVertexIsAWarning)
{
  ModelBuilder builder = TwoSquares();
  builder.Data.TrimPoints[0] += 0.03;
  builder.Data.EdgeTolerance[0] = 0.01; // So that the edge is not taken for one left behind.
  ExpectOneWarning(builder, 0, "loop 0: it has a gap of 0.03 of the domain");
  builder.Data.TrimPoints[0] += 0.1; // Too far for any vertex.
  ExpectFirstFaceBad(builder, { "loop 0", "open" });
}

TEST(Model, LoopOutsideTheDomain)
{
  ModelBuilder builder = TwoSquares();
  for (int i = 8; i < 14; ++i)
  {
    builder.Data.TrimPoints[3 * i] += 10.0;
  }
  ExpectFirstFaceBad(builder, { "loop 1", "leaves the surface's domain by 9.6" });
  builder = TwoSquares();
  for (int i = 8; i < 14; ++i)
  {
    builder.Data.TrimPoints[3 * i] -= 0.201;
  }
  ExpectOneWarning(builder, 0, "leaves the surface's domain by 0.001");
}

TEST(Model, LoopWithoutAreaIsAWarning)
{
  ModelBuilder builder = TwoSquares();
  builder.BeginFace(Square(2).View(), nurbs::FaceAttributes());
  AddLoop(builder, { { 0.25, 0.25 }, { 0.75, 0.75 } });
  const AssembledModel model = nurbs::AssembleModel(builder.Arrays());
  ASSERT_EQ(model.Problems.size(), 1u);
  EXPECT_EQ(model.Problems[0].Reason, "loop 0: it encloses no area");
  EXPECT_EQ(model.FaceErrors[2], "");
}

TEST(Model, GapAtAPoleIsClosedByThePole)
{
  ModelBuilder builder;
  nurbs::Surface triangle = Square(0);
  for (int k = 3; k < 6; ++k)
  {
    triangle.Points[k] = Vec3(0.5, 1.0, 0.0); // The side v = 1 is a point.
  }
  builder.BeginFace(triangle.View(), nurbs::FaceAttributes());
  builder.BeginLoop();
  builder.AddTrimCurve(Line(Vec2(0, 0), Vec2(1, 0)).View(), -1, false);
  builder.AddTrimCurve(Line(Vec2(1, 0), Vec2(1, 1)).View(), -1, false);
  builder.AddTrimCurve(Line(Vec2(0, 1), Vec2(0, 0)).View(), -1, false);
  const AssembledModel model = nurbs::AssembleModel(builder.Arrays());
  EXPECT_EQ(model.FaceErrors[0], "");
  ASSERT_EQ(model.Problems.size(), 1u);
  EXPECT_NE(model.Problems[0].Reason.find("gap of 1"), std::string::npos);
}

TEST(Model, CollapsedSurfacesAreValid)
{
  for (int dimensions = 0; dimensions < 2; ++dimensions)
  {
    ModelBuilder builder;
    nurbs::Surface surface = Square(0);
    for (Vec3& point : surface.Points)
    {
      point = Vec3(dimensions * point[0], 0, 0);
    }
    builder.BeginFace(surface.View(), nurbs::FaceAttributes());
    EXPECT_TRUE(nurbs::AssembleModel(builder.Arrays()).Problems.empty());
  }
}

TEST(Model, BadEdgesLoseTheirCurvesAndSpoilNoFace)
{
  ModelBuilder builder = TwoSquares();
  builder.Data.EdgePoints[5] = NaN;
  ExpectOneWarning(builder, -1, "edge 0: control point 1 is not finite");
  EXPECT_EQ(nurbs::AssembleModel(builder.Arrays()).Model.Edges[0].Geometry.Count, 0);
  builder = TwoSquares();
  builder.Data.EdgeDegree[2] = 26;
  ExpectOneWarning(builder, -1, "edge 2: degree 26");
  builder = TwoSquares();
  builder.Data.EdgeTolerance[2] = -1.0;
  ExpectOneWarning(builder, -1, "edge 2: its tolerance");
  builder = TwoSquares();
  builder.Data.EdgeVertices[5] = 6;
  ExpectOneWarning(builder, -1, "edge 2: vertex 6 does not exist");
  builder = TwoSquares();
  builder.Data.VertexPoints[0] = Infinity;
  const AssembledModel model = nurbs::AssembleModel(builder.Arrays());
  EXPECT_EQ(model.Problems.size(), 2u); // Two edges meet there.
  EXPECT_EQ(model.Model.Edges[0].Vertex[0], -1);
}

TEST(Model, EdgesLeftBehindByMovedPointsAreReleased)
{
  ModelBuilder builder = TwoSquares();
  for (double& coordinate : builder.Data.Points)
  {
    coordinate = 3.0 * coordinate + 1.0;
  }
  ExpectOneWarning(builder, -1, "7 of 7 edges do not fit their faces (the first is edge 0)");
  const AssembledModel moved = nurbs::AssembleModel(builder.Arrays());
  for (const nurbs::Edge& edge : moved.Model.Edges)
  {
    EXPECT_EQ(edge.Geometry.Count, 0);
    EXPECT_GE(edge.Vertex[0], 0);
  }
  EXPECT_EQ(moved.Model.Vertices[5], Vec3(7, 4, 1));

  nurbs::AssembleOptions options;
  options.CheckEdges = false;
  EXPECT_TRUE(nurbs::AssembleModel(builder.Arrays(), options).Problems.empty());
}

// An odd wave, 3 t (1 - t) (1 - 2 t), leaves both ends and the middle of the edge where they were.
TEST(Model, EdgesMovedByAWaveAreReleased)
{
  for (const double height : { 0.0, 1e-3 })
  {
    nurbs::Surface sheet = nurbs::ElevateDegree(Square(0).View(), 0, 1);
    ASSERT_EQ(sheet.Count[0], 4);
    sheet.Points[1][2] = height;
    sheet.Points[2][2] = -height;
    ASSERT_LE(nurbs::Evaluate(sheet.View(), 0.5, 0.0)[2], 1e-18);
    ModelBuilder builder;
    const auto edge = builder.AddEdge(Line(Vec3(0, 0, 0), Vec3(1, 0, 0)).View(), 1e-7, -1, -1);
    builder.BeginFace(sheet.View(), nurbs::FaceAttributes());
    builder.BeginLoop();
    builder.AddTrimCurve(Line(Vec2(0, 0), Vec2(1, 0)).View(), edge, false);
    builder.AddTrimCurve(Line(Vec2(1, 0), Vec2(1, 1)).View(), -1, false);
    builder.AddTrimCurve(Line(Vec2(1, 1), Vec2(0, 1)).View(), -1, false);
    builder.AddTrimCurve(Line(Vec2(0, 1), Vec2(0, 0)).View(), -1, false);
    const AssembledModel model = nurbs::AssembleModel(builder.Arrays());
    EXPECT_EQ(model.Problems.size(), height > 0.0 ? 1u : 0u);
    EXPECT_EQ(model.Model.Edges[edge].Geometry.Count, height > 0.0 ? 0 : 2);
  }
}

TEST(Model, PolesMoveWithTheirFace)
{
  ModelBuilder builder;
  const auto vertex = builder.AddVertex(Vec3(0.5, 1, 0));
  const auto pole = builder.AddPole(Vec3(0.5, 1, 0), { 0, 1 }, 0.0, vertex);
  nurbs::Surface triangle = Square(0);
  for (int k = 3; k < 6; ++k)
  {
    triangle.Points[k] = Vec3(0.5, 1.0, 0.0);
  }
  builder.BeginFace(triangle.View(), nurbs::FaceAttributes());
  builder.BeginLoop();
  builder.AddTrimCurve(Line(Vec2(0, 0), Vec2(1, 0)).View(), -1, false);
  builder.AddTrimCurve(Line(Vec2(1, 0), Vec2(1, 1)).View(), -1, false);
  builder.AddTrimCurve(Line(Vec2(1, 1), Vec2(0, 1)).View(), pole, false);
  builder.AddTrimCurve(Line(Vec2(0, 1), Vec2(0, 0)).View(), -1, false);
  EXPECT_TRUE(nurbs::AssembleModel(builder.Arrays()).Problems.empty());
  for (std::size_t i = 2; i < builder.Data.Points.size(); i += 3)
  {
    builder.Data.Points[i] = 8.0;
  }
  const AssembledModel moved = nurbs::AssembleModel(builder.Arrays());
  ASSERT_EQ(moved.Problems.size(), 1u);
  EXPECT_EQ(moved.Model.Edges[pole].Geometry.Degree, 0);
  EXPECT_EQ(moved.Model.Edges[pole].Geometry.Point(0), Vec3(0.5, 1, 8));
  EXPECT_EQ(moved.Model.Vertices[vertex], Vec3(0.5, 1, 8));
}

} // namespace
