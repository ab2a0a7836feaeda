// SPDX-License-Identifier: BSD-3-Clause
// Whole faces with loops that cross, run the wrong way or enclose nothing: their area, and what is
// said about it.
#include "ModelBuilder.h"
#include "Tessellator.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

namespace
{

using nurbs::FaceMesh;
using nurbs::FaceStatus;
using nurbs::Vec2;
using nurbs::Vec3;

/// The plane z = 0 over [0, 10] x [0, 10] in both spaces; bent into a parabola z = (x / 10)^2 if
/// asked for.
nurbs::Surface Sheet(bool bent)
{
  nurbs::Surface sheet;
  sheet.Degree[0] = 2;
  sheet.Degree[1] = 1;
  sheet.Count[0] = 3;
  sheet.Count[1] = 2;
  sheet.Knots[0] = { 0, 0, 0, 10, 10, 10 };
  sheet.Knots[1] = { 0, 0, 10, 10 };
  for (int j = 0; j < 2; ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      sheet.Points.push_back(Vec3(5.0 * i, 10.0 * j, bent && i == 2 ? 1.0 : 0.0));
    }
  }
  return sheet;
}

using Side = std::pair<Vec2, Vec2>;

/// Loops of straight sides, each from its first point to its second one.
FaceMesh Tessellate(const nurbs::Surface& sheet, const std::vector<std::vector<Side>>& loops)
{
  nurbs::ModelBuilder builder;
  builder.BeginFace(sheet.View(), nurbs::FaceAttributes());
  for (const std::vector<Side>& loop : loops)
  {
    builder.BeginLoop();
    for (const Side& side : loop)
    {
      nurbs::Curve<2> line;
      line.Knots = { 0, 0, 1, 1 };
      line.Points = { side.first, side.second };
      line.Weights = { 1, 1 };
      line.Pack();
      builder.AddTrimCurve(line.View(), -1, false);
    }
  }
  const nurbs::AssembledModel assembled = nurbs::AssembleModel(builder.Arrays());
  nurbs::TessellatorOptions options;
  options.Tolerance = 0.01;
  const nurbs::TessellationResult result =
    nurbs::Tessellate(assembled.Model, assembled.FaceErrors, options);
  return result.Meshes.at(0);
}

std::vector<Side> Polygon(const std::vector<Vec2>& corners)
{
  std::vector<Side> sides;
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    sides.emplace_back(corners[i], corners[(i + 1) % corners.size()]);
  }
  return sides;
}

FaceMesh Tessellate(const std::vector<std::vector<Vec2>>& loops, bool bent)
{
  std::vector<std::vector<Side>> sides;
  for (const std::vector<Vec2>& loop : loops)
  {
    sides.push_back(Polygon(loop));
  }
  return Tessellate(Sheet(bent), sides);
}

/// A sheet bent along v with a crease at u = crease.
nurbs::Surface Roof(double crease)
{
  nurbs::Surface roof;
  roof.Degree[0] = 1;
  roof.Degree[1] = 2;
  roof.Count[0] = 3;
  roof.Count[1] = 3;
  roof.Knots[0] = { 0, 0, crease, 10, 10 };
  roof.Knots[1] = { 0, 0, 0, 10, 10, 10 };
  for (int j = 0; j < 3; ++j)
  {
    for (const double u : { 0.0, crease, 10.0 })
    {
      roof.Points.push_back(Vec3(u, 5.0 * j, (u == crease ? 0.1 * crease : 0.0) + (j == 1)));
    }
  }
  return roof;
}

/// The area of the triangles in (u, v); all must be turned the same way.
double ParameterArea(const FaceMesh& mesh)
{
  double area = 0.0;
  for (std::size_t t = 0; t < mesh.Triangles.size(); t += 3)
  {
    const Vec2& a = mesh.UV[mesh.Triangles[t]];
    const Vec2 b = mesh.UV[mesh.Triangles[t + 1]] - a;
    const Vec2 c = mesh.UV[mesh.Triangles[t + 2]] - a;
    const double one = 0.5 * (b[0] * c[1] - b[1] * c[0]);
    EXPECT_GE(one, -1e-12);
    area += one;
  }
  return area;
}

std::vector<Vec2> Square(double x, double y, double size, bool clockwise = false)
{
  std::vector<Vec2> square = { Vec2(x, y), Vec2(x + size, y), Vec2(x + size, y + size),
    Vec2(x, y + size) };
  if (clockwise)
  {
    std::reverse(square.begin(), square.end());
  }
  return square;
}

class BadLoops : public testing::TestWithParam<bool>
{};

TEST_P(BadLoops, LeavesGoodOnesAlone)
{
  const FaceMesh mesh =
    Tessellate({ Square(1, 1, 8), Square(2, 2, 4, true), Square(3, 3, 1) }, GetParam());
  EXPECT_EQ(mesh.Status, FaceStatus::Ok) << mesh.Message;
  EXPECT_NEAR(ParameterArea(mesh), 64.0 - 16.0 + 1.0, 1e-9);
}

TEST_P(BadLoops, TurnsThoseThatRunTheWrongWay)
{
  FaceMesh mesh = Tessellate({ Square(1, 1, 8, true) }, GetParam());
  EXPECT_EQ(mesh.Status, FaceStatus::Repaired);
  EXPECT_NE(mesh.Message.find("wrong way"), std::string::npos) << mesh.Message;
  EXPECT_NEAR(ParameterArea(mesh), 64.0, 1e-9);
  mesh = Tessellate({ Square(1, 1, 8), Square(2, 2, 4) }, GetParam());
  EXPECT_EQ(mesh.Status, FaceStatus::Repaired);
  EXPECT_NEAR(ParameterArea(mesh), 48.0, 1e-9);
}

TEST_P(BadLoops, ResolvesCrossings)
{
  // A hole that leaves the outer loop.
  FaceMesh mesh = Tessellate({ Square(1, 1, 5), Square(4, 4, 5, true) }, GetParam());
  EXPECT_EQ(mesh.Status, FaceStatus::Repaired);
  EXPECT_NE(mesh.Message.find("cross"), std::string::npos) << mesh.Message;
  EXPECT_NEAR(ParameterArea(mesh), 25.0 - 4.0, 1e-6);
  EXPECT_LE(mesh.CertifiedError, 0.01);
  // A loop with a small knot at one corner.
  mesh = Tessellate({ { Vec2(1, 1), Vec2(9, 1), Vec2(9, 9), Vec2(1, 9), Vec2(1, 0.5), Vec2(2, 0.5),
                      Vec2(0.5, 1.5) } },
    GetParam());
  EXPECT_EQ(mesh.Status, FaceStatus::Repaired);
  EXPECT_NEAR(ParameterArea(mesh), 64.0, 2.0);
}

TEST_P(BadLoops, SaysThatNothingIsEnclosed)
{
  const FaceMesh mesh = Tessellate({ { Vec2(1, 1), Vec2(5, 1), Vec2(9, 1) } }, GetParam());
  EXPECT_TRUE(mesh.Triangles.empty());
  EXPECT_FALSE(mesh.Message.empty());
}

/// Curves of dirty models do not end quite where the next one of the loop starts. The two ends are
/// one vertex of the model and must be one corner of the mesh: if the curves cross just before, a
/// repair would leave the vertex out, and a crack to the neighbours.
TEST_P(BadLoops, JoinsCurvesThatMissEachOther)
{
  std::vector<Side> sides = Polygon(Square(1, 1, 8));
  sides[1].second = Vec2(8.998, 9.01); // Overshoots the third side, which starts at (9, 9).
  const FaceMesh mesh = Tessellate(Sheet(GetParam()), { sides });
  EXPECT_NE(mesh.Message.find("gap"), std::string::npos) << mesh.Message;
  EXPECT_EQ(mesh.Message.find("cross"), std::string::npos) << mesh.Message;
  EXPECT_NEAR(ParameterArea(mesh), 64.0, 0.1);
  int corners = 0;
  for (const Vec2& p : mesh.UV)
  {
    corners += (p - Vec2(9, 9)).norm() < 0.02;
  }
  EXPECT_EQ(corners, 1);
}

/// Two faces over the same edges, one of which sees its loop cross itself beside a corner (a tiny
/// edge that leads beyond another one). What the repair takes off must not open a crack.
TEST_P(BadLoops, StayClosedAlthoughOneFaceIsRepaired)
{
  const nurbs::Surface sheet = Sheet(GetParam());
  const std::vector<Vec2> crossing = { Vec2(1, 1), Vec2(9, 1), Vec2(9, 9), Vec2(9.002, 8.999),
    Vec2(6, 8.998), Vec2(1, 9) };
  std::vector<Vec2> sound = crossing;
  sound[3] = Vec2(8.999, 9);
  nurbs::ModelBuilder builder;
  for (const Vec2& p : sound)
  {
    builder.AddVertex(nurbs::Evaluate(sheet.View(), p[0], p[1]));
  }
  const int n = int(sound.size());
  for (int i = 0; i < n; ++i)
  {
    builder.AddUnknownEdge(0.0, i, (i + 1) % n);
  }
  for (const bool reversed : { false, true })
  {
    nurbs::FaceAttributes attributes;
    attributes.Reversed = reversed;
    builder.BeginFace(sheet.View(), attributes);
    builder.BeginLoop();
    const std::vector<Vec2>& corners = reversed ? sound : crossing;
    for (int i = 0; i < n; ++i)
    {
      nurbs::Curve<2> line;
      line.Knots = { 0, 0, 1, 1 };
      line.Points = { corners[i], corners[(i + 1) % n] };
      line.Weights = { 1, 1 };
      line.Pack();
      builder.AddTrimCurve(line.View(), i, false);
    }
  }
  const nurbs::AssembledModel assembled = nurbs::AssembleModel(builder.Arrays());
  nurbs::TessellatorOptions options;
  options.Tolerance = 0.01;
  const nurbs::TessellationResult result =
    nurbs::Tessellate(assembled.Model, assembled.FaceErrors, options);
  EXPECT_NE(result.Meshes[0].Message.find("cross"), std::string::npos);
  EXPECT_GE(result.Meshes[0].Triangles.size(), 9u);
  using Spot = std::array<double, 3>;
  std::map<std::pair<Spot, Spot>, int> sides; // Forward less backward uses.
  for (const FaceMesh& mesh : result.Meshes)
  {
    for (std::size_t k = 0; k < mesh.Triangles.size(); ++k)
    {
      const Vec3& x = mesh.Points[mesh.Triangles[k]];
      const Vec3& y = mesh.Points[mesh.Triangles[k % 3 == 2 ? k - 2 : k + 1]];
      const Spot a{ x[0], x[1], x[2] };
      const Spot b{ y[0], y[1], y[2] };
      sides[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  for (const auto& side : sides)
  {
    EXPECT_EQ(side.second, 0) << side.first.first[0] << ' ' << side.first.first[1];
  }
}

/// An edge much shorter than the tolerance, whose ends are in the other order on one of its faces: it
/// becomes a point, the same for both faces, instead of a sliver that looks backwards.
TEST_P(BadLoops, MakePointsOfShortEdges)
{
  const nurbs::Surface sheet = Sheet(GetParam());
  const std::vector<Vec2> corners = { Vec2(1, 1), Vec2(9, 1), Vec2(9, 9), Vec2(8.99996, 9),
    Vec2(1, 9) };
  const int n = int(corners.size());
  nurbs::ModelBuilder builder;
  for (const Vec2& p : corners)
  {
    builder.AddVertex(nurbs::Evaluate(sheet.View(), p[0], p[1]));
  }
  for (int i = 0; i < n; ++i)
  {
    const Vec2 from = corners[i];
    const Vec2 to = corners[(i + 1) % n];
    const auto at = [&](double t) {
      const Vec2 p = from + t * (to - from);
      return nurbs::Evaluate(sheet.View(), p[0], p[1]);
    };
    nurbs::Curve<3> edge; // Over a straight line the sheet is a parabola.
    edge.Degree = 2;
    edge.Knots = { 0, 0, 0, 1, 1, 1 };
    edge.Points = { at(0), Vec3(2.0 * at(0.5) - 0.5 * at(0) - 0.5 * at(1)), at(1) };
    edge.Weights = { 1, 1, 1 };
    edge.Pack();
    builder.AddEdge(edge.View(), 0.0, i, (i + 1) % n);
  }
  for (const bool reversed : { false, true })
  {
    std::vector<Vec2> seen = corners;
    if (reversed)
    {
      seen[3] = Vec2(9.00004, 9); // Beyond the corner.
    }
    nurbs::FaceAttributes attributes;
    attributes.Reversed = reversed;
    builder.BeginFace(sheet.View(), attributes);
    builder.BeginLoop();
    for (int i = 0; i < n; ++i)
    {
      nurbs::Curve<2> line;
      line.Knots = { 0, 0, 1, 1 };
      line.Points = { seen[i], seen[(i + 1) % n] };
      line.Weights = { 1, 1 };
      line.Pack();
      builder.AddTrimCurve(line.View(), i, false);
    }
  }
  const nurbs::AssembledModel assembled = nurbs::AssembleModel(builder.Arrays());
  nurbs::TessellatorOptions options;
  options.Tolerance = 0.01;
  const nurbs::TessellationResult result =
    nurbs::Tessellate(assembled.Model, assembled.FaceErrors, options);
  ASSERT_EQ(result.Meshes.size(), 2u);
  for (const FaceMesh& mesh : result.Meshes)
  {
    EXPECT_EQ(mesh.Status, FaceStatus::Ok) << mesh.Message;
    EXPECT_LE(mesh.CertifiedError, 0.01);
    int corner = 0;
    for (const Vec3& x : mesh.Points)
    {
      corner += (x.head<2>() - Vec2(9, 9)).norm() < 1e-3;
    }
    EXPECT_EQ(corner, 1);
    for (std::size_t t = 0; t < mesh.Triangles.size(); t += 3)
    {
      const int* c = &mesh.Triangles[t];
      const Vec3 normal =
        (mesh.Points[c[1]] - mesh.Points[c[0]]).cross(mesh.Points[c[2]] - mesh.Points[c[0]]);
      EXPECT_GT(normal.dot(mesh.Normals[c[0]]), 0.0);
    }
  }
}

/// The corners of a mesh are the model's vertices; how far these are from the ends of the curves is
/// part of the error, in a plane, too.
TEST(BadLoopsInAPlane, CountHowFarVerticesAreFromTheirCurves)
{
  const nurbs::Surface sheet = Sheet(false);
  const std::vector<Vec2> square = Square(1, 1, 8);
  nurbs::ModelBuilder builder;
  std::vector<std::int64_t> vertices;
  for (int i = 0; i < 4; ++i)
  {
    vertices.push_back(
      builder.AddVertex(Vec3(square[i][0], square[i][1] + (i == 1 ? 0.004 : 0.0), 0.0)));
  }
  builder.BeginFace(sheet.View(), nurbs::FaceAttributes());
  builder.BeginLoop();
  for (int i = 0; i < 4; ++i)
  {
    const Vec2& from = square[i];
    const Vec2& to = square[(i + 1) % 4];
    nurbs::Curve<2> line;
    line.Knots = { 0, 0, 1, 1 };
    line.Points = { from, to };
    line.Weights = { 1, 1 };
    line.Pack();
    nurbs::Curve<3> edge;
    edge.Knots = line.Knots;
    edge.Points = { Vec3(from[0], from[1], 0.0), Vec3(to[0], to[1], 0.0) };
    edge.Weights = line.Weights;
    edge.Pack();
    const std::int64_t id = builder.AddEdge(edge.View(), 0.0, vertices[i], vertices[(i + 1) % 4]);
    builder.AddTrimCurve(line.View(), id, false);
  }
  const nurbs::AssembledModel assembled = nurbs::AssembleModel(builder.Arrays());
  nurbs::TessellatorOptions options;
  options.Tolerance = 0.01;
  const FaceMesh mesh =
    nurbs::Tessellate(assembled.Model, assembled.FaceErrors, options).Meshes.at(0);
  EXPECT_GE(mesh.CertifiedError, 0.00399);
  EXPECT_LE(mesh.CertifiedError, 0.01);
}

/// Trim curves that miss their edges by tolerances: the mesh's boundary is the edges, and vertices
/// inside the face must not lie beyond it.
TEST(BadLoopsWithGaps, DoNotFold)
{
  const nurbs::Surface sheet = Sheet(true);
  nurbs::ModelBuilder builder;
  builder.BeginFace(sheet.View(), nurbs::FaceAttributes());
  builder.BeginLoop();
  const std::vector<Vec2> square = Square(1, 1, 8);
  for (int i = 0; i < 4; ++i)
  {
    // The curve bulges by 0.2 = 20 tolerances over the edge, which is straight in (u, v).
    const Vec2& from = square[i];
    const Vec2& to = square[(i + 1) % 4];
    const Vec2 along = to - from;
    nurbs::Curve<2> curve;
    curve.Degree = 2;
    curve.Knots = { 0, 0, 0, 1, 1, 1 };
    curve.Points = { from, 0.5 * (from + to) + 0.05 * Vec2(along[1], -along[0]), to };
    curve.Weights = { 1, 1, 1 };
    curve.Pack();
    nurbs::Curve<3> edge; // Over a straight line the sheet is a parabola.
    edge.Degree = 2;
    edge.Knots = curve.Knots;
    const auto at = [&](double t) {
      const Vec2 p = from + t * along;
      return nurbs::Evaluate(sheet.View(), p[0], p[1]);
    };
    edge.Points = { at(0), Vec3(2.0 * at(0.5) - 0.5 * at(0) - 0.5 * at(1)), at(1) };
    edge.Weights = curve.Weights;
    edge.Pack();
    const std::int64_t id = builder.AddEdge(edge.View(), 0.25, -1, -1);
    builder.AddTrimCurve(curve.View(), id, false);
  }
  // A neighbour, without which the trim curves alone would count.
  builder.BeginFace(sheet.View(), nurbs::FaceAttributes());
  builder.BeginLoop();
  for (int i = 0; i < 4; ++i)
  {
    nurbs::Curve<2> line;
    line.Knots = { 0, 0, 1, 1 };
    line.Points = { square[i], square[(i + 1) % 4] };
    line.Weights = { 1, 1 };
    line.Pack();
    builder.AddTrimCurve(line.View(), i, false);
  }
  const nurbs::AssembledModel assembled = nurbs::AssembleModel(builder.Arrays());
  nurbs::TessellatorOptions options;
  options.Tolerance = 0.01;
  const FaceMesh mesh =
    nurbs::Tessellate(assembled.Model, assembled.FaceErrors, options).Meshes.at(0);
  EXPECT_GE(mesh.CertifiedError, 0.19);
  EXPECT_LE(mesh.ModelGap, 0.01);
  EXPECT_NEAR(ParameterArea(mesh), 64.0, 0.01);
}

/// A side that runs beside a crease, nearer than a triangle's width, is put on it together with the
/// ends of the sides that it meets.
TEST(BadLoopsOnACrease, SidesBesideItStayJoined)
{
  for (const double beyond : { 1.0, -1.0 })
  {
    const Vec2 low(5 + beyond * 1.8e-4, 1);
    const Vec2 high(5 + beyond * 1.5e-4, 9);
    const FaceMesh mesh = Tessellate(Roof(5), { Polygon({ Vec2(1, 1), low, high, Vec2(1, 9) }) });
    EXPECT_EQ(mesh.Status, FaceStatus::Ok) << mesh.Message;
    EXPECT_LE(mesh.CertifiedError, 0.01);
    EXPECT_NEAR(ParameterArea(mesh), 32.0, 0.01);
  }
}

/// A strip between a trim line and a crease that is narrower than chords bow: triangles between
/// vertices that are not opposite to each other would overlap.
TEST(BadLoopsOnACrease, StripsBesideItDoNotFold)
{
  for (const double width : { 0.0005, 0.002, 0.005, 0.02, 0.1 })
  {
    for (const bool beyond : { false, true })
    {
      const std::vector<Vec2> corners = beyond
        ? std::vector<Vec2>{ Vec2(1, 1), Vec2(5 + width, 1), Vec2(5 + width, 9), Vec2(1, 9) }
        : std::vector<Vec2>{ Vec2(0, 0), Vec2(10, 0), Vec2(10, 10), Vec2(0, 10) };
      const FaceMesh mesh = Tessellate(Roof(beyond ? 5 : width), { Polygon(corners) });
      EXPECT_EQ(mesh.Status, FaceStatus::Ok) << mesh.Message;
      EXPECT_LE(mesh.CertifiedError, 0.01);
      EXPECT_LT(mesh.Triangles.size() / 3, 150u) << width;
      for (std::size_t t = 0; t < mesh.Triangles.size(); t += 3)
      {
        const int* c = &mesh.Triangles[t];
        const Vec3 n =
          (mesh.Points[c[1]] - mesh.Points[c[0]]).cross(mesh.Points[c[2]] - mesh.Points[c[0]]);
        EXPECT_GE(n.dot(mesh.Normals[c[0]] + mesh.Normals[c[1]] + mesh.Normals[c[2]]), 0.0)
          << width;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(PlaneAndParabola, BadLoops, testing::Bool(),
  [](const testing::TestParamInfo<bool>& info) { return info.param ? "Parabola" : "Plane"; });

} // namespace
