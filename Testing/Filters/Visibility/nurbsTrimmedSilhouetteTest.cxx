// SPDX-License-Identifier: BSD-3-Clause
// Silhouettes cut by trimming loops: ends on both exact curves, lengths against those of what dense
// samples say is inside; silhouettes that run along edges; edges by kind.
#include "Shapes.h"
#include "nurbsSilhouetteReference.h"

#include <gtest/gtest.h>

using namespace reference;

namespace
{

// Of a grid of 200 x 200; CheckGrid halves it under sanitizers.
#ifdef NURBS_SANITIZE
constexpr int LeastChanges = 50;
#else
constexpr int LeastChanges = 100;
#endif

const double Pi = std::acos(-1.0);

// A circle in the domain, in one rational piece a quarter.
nurbs::Curve<2> Circle(const Vec2& middle, double radius)
{
  static const int sign[9][2] = { { 1, 0 }, { 1, 1 }, { 0, 1 }, { -1, 1 }, { -1, 0 }, { -1, -1 },
    { 0, -1 }, { 1, -1 }, { 1, 0 } };
  nurbs::Curve<2> curve;
  curve.Degree = 2;
  curve.Knots = { 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4 };
  for (int k = 0; k < 9; ++k)
  {
    curve.Points.push_back(middle + radius * Vec2(sign[k][0], sign[k][1]));
    curve.Weights.push_back(k % 2 ? std::sqrt(0.5) : 1.0);
  }
  curve.Pack();
  return curve;
}

nurbs::Curve<2> Segment(const Vec2& a, const Vec2& b)
{
  nurbs::Curve<2> line;
  line.Degree = 1;
  line.Knots = { 0, 0, 1, 1 };
  line.Points = { a, b };
  line.Weights = { 1, 1 };
  line.Pack();
  return line;
}

// A surface within one circle and without another one.
struct Trimmed
{
  nurbs::ModelBuilder Builder;
  nurbs::AssembledModel Assembled;

  Trimmed(const nurbs::Surface& surface, const std::vector<nurbs::Curve<2>>& circles)
  {
    this->Builder.BeginFace(surface.View(), nurbs::FaceAttributes());
    for (std::size_t k = 0; k < circles.size(); ++k)
    {
      this->Builder.BeginLoop();
      this->Builder.AddTrimCurve(circles[k].View(), -1, k > 0);
    }
    this->Assembled = nurbs::AssembleModel(this->Builder.Arrays());
    EXPECT_EQ(this->Assembled.FaceErrors[0], "");
  }
  const Model& Get() const { return this->Assembled.Model; }
};

nurbs::Surface Waves()
{
  return BezierSurface(7, 6, [](double u, double v) {
    return Vec3(u, v, 0.9 * std::sin(9.0 * u + 2.0 * v) + 0.4 * std::cos(7.0 * v));
  });
}

TEST(TrimmedSilhouette, EndsLieOnBothCurves)
{
  const Vec2 middle(0.52, 0.47);
  const Vec2 hole(0.6, 0.5);
  const Trimmed trimmed(Waves(), { Circle(middle, 0.36), Circle(hole, 0.13) });
  const Model& model = trimmed.Get();
  const nurbs::Surface surface = Waves();
  const Model whole = OneFace(surface);
  int ends = 0;
  for (const Viewer& viewer :
    { Direction(1, 0.2, 0.4), Direction(0.2, 1, 0.3), Eye(2, 3, 1), Direction(1, 1, 0.2) })
  {
    for (const double precision : { 1e-2, 1e-3, 1e-5 })
    {
      const Silhouettes result = Make(model, viewer, precision);
      const Measure measure = MeasureLines(model, result, viewer);
      EXPECT_LE(measure.Cosine, 1e-9);
      EXPECT_LE(measure.Chord, precision);
      EXPECT_EQ(measure.WrongSide, 0);
      // Of the whole silhouette, finely sampled, what is inside by the distance from the middles.
      const Silhouettes all = Make(whole, viewer, 1e-7);
      double inside = 0.0;
      for (const SilhouetteLine& line : all.Lines)
      {
        for (std::size_t k = 1; line.Kind == LineKind::Silhouette && k < line.Points.size(); ++k)
        {
          const Vec2 uv = 0.5 * (line.Points[k].UV + line.Points[k - 1].UV);
          const bool kept = (uv - middle).norm() < 0.36 && (uv - hole).norm() > 0.13;
          inside += kept ? (line.Points[k].Point - line.Points[k - 1].Point).norm() : 0.0;
        }
      }
      EXPECT_GT(inside, 0.3);
      EXPECT_NEAR(measure.Length, inside, 0.002 + 10.0 * precision);
      for (const SilhouetteLine& line : result.Lines)
      {
        for (int end = 0; line.Kind == LineKind::Silhouette && !line.Closed && end < 2; ++end)
        {
          const nurbs::ContourPoint& point = end == 0 ? line.Points.front() : line.Points.back();
          const double outer = std::abs((point.UV - middle).norm() - 0.36);
          const double inner = std::abs((point.UV - hole).norm() - 0.13);
          EXPECT_LT(std::min(outer, inner), 1e-12);
          EXPECT_LT(std::abs(Cosine(surface.View(), viewer, point.UV)), 1e-10);
          ASSERT_GE(line.Ends[end].Curve, 0);
          const nurbs::TrimCurve& curve = model.TrimCurves[line.Ends[end].Curve];
          const Vec2 there = nurbs::Evaluate(curve.Geometry, line.Ends[end].Parameter);
          EXPECT_LT((there - point.UV).norm(), 1e-12);
          ++ends;
        }
      }
      const GridCheck grid = CheckGrid(model, 0, result, viewer, precision, 200,
        [&](const Vec2& uv) { return (uv - middle).norm() < 0.36 && (uv - hole).norm() > 0.13; });
      EXPECT_GT(grid.Changes, LeastChanges);
      EXPECT_EQ(grid.Missed, 0);
    }
  }
  EXPECT_GT(ends, 40);
}

// A closed loop that a rectangle leaves whole, removes, cuts once or twice.
TEST(TrimmedSilhouette, ClosedLoops)
{
  const nurbs::Surface bump = BezierSurface(9, 9,
    [](double u, double v) { return Vec3(u, v, std::hypot(u - 0.5, v - 0.5) < 0.3 ? 2.0 : 0.0); });
  const Viewer viewer = Direction(1, 0, 3.8);
  const Silhouettes all = Make(OneFace(bump), viewer, 1e-5);
  ASSERT_EQ(all.Chains[0], 1);
  ASSERT_TRUE(all.Lines.front().Closed);
  nurbs::Box2 box;
  for (const nurbs::ContourPoint& point : all.Lines.front().Points)
  {
    box.extend(point.UV);
  }
  struct Case
  {
    Vec2 Low, High; // Of the rectangle, shares of the loop's box.
    int Lines;
    bool Closed;
    double Share; // Of the loop's length; it is symmetric in v.
  };
  for (const Case& c : { Case{ { -0.1, -0.1 }, { 1.1, 1.1 }, 1, true, 1.0 },
         Case{ { 0.45, 0.45 }, { 0.55, 0.55 }, 0, true, 0.0 },
         Case{ { -0.1, -0.1 }, { 1.1, 0.5 }, 1, false, 0.5 },
         Case{ { -0.1, 0.3 }, { 1.1, 0.7 }, 2, false, -1.0 } })
  {
    const Vec2 low = box.min() + c.Low.cwiseProduct(box.sizes());
    const Vec2 high = box.min() + c.High.cwiseProduct(box.sizes());
    nurbs::Curve<2> rectangle;
    rectangle.Degree = 1;
    rectangle.Knots = { 0, 0, 1, 2, 3, 4, 4 };
    rectangle.Points = { low, Vec2(high[0], low[1]), high, Vec2(low[0], high[1]), low };
    rectangle.Weights.assign(5, 1.0);
    rectangle.Pack();
    const Trimmed trimmed(bump, { rectangle });
    const Silhouettes result = Make(trimmed.Get(), viewer, 1e-5);
    int lines = 0;
    double length = 0.0;
    for (const SilhouetteLine& line : result.Lines)
    {
      if (line.Kind == LineKind::Silhouette)
      {
        ++lines;
        length += Length(line);
        EXPECT_EQ(line.Closed, c.Closed);
      }
    }
    EXPECT_EQ(lines, c.Lines);
    if (c.Share >= 0.0)
    {
      EXPECT_NEAR(length, c.Share * Length(all.Lines.front()), 1e-3);
    }
  }
}

// Half a cylinder whose straight edges are where its normal turns away: the silhouette is the edges.
TEST(TrimmedSilhouette, RunsAlongEdges)
{
  nurbs::ModelBuilder full;
  nurbs::AddCylinder(full, 1.0, 2.0, false);
  const nurbs::AssembledModel cylinder = nurbs::AssembleModel(full.Arrays());
  const nurbs::SurfaceView side = cylinder.Model.Faces[0].Geometry;
  const nurbs::Interval u = side.Domain(0);
  const nurbs::Interval v = side.Domain(1);
  // From a quarter to three quarters of the way around, the lines x = 0.
  const double low = u.Min + 0.25 * u.Length();
  const double high = u.Min + 0.75 * u.Length();
  const Vec2 corners[4] = { Vec2(low, v.Min), Vec2(high, v.Min), Vec2(high, v.Max),
    Vec2(low, v.Max) };
  nurbs::ModelBuilder builder;
  builder.BeginFace(side, nurbs::FaceAttributes());
  builder.BeginLoop();
  for (int k = 0; k < 4; ++k)
  {
    const nurbs::Curve<2> curve = Segment(corners[k], corners[(k + 1) % 4]);
    builder.AddTrimCurve(curve.View(), builder.AddUnknownEdge(1e-7, -1, -1), false);
  }
  const nurbs::AssembledModel half = nurbs::AssembleModel(builder.Arrays());
  const Viewer viewer = Direction(1, 0, 0);
  const Silhouettes result = Make(half.Model, viewer, 1e-4);
  int lines = 0;
  for (const SilhouetteLine& line : result.Lines)
  {
    if (line.Kind == LineKind::Silhouette)
    {
      ++lines;
      EXPECT_TRUE(line.Edge == 1 || line.Edge == 3) << line.Edge;
      EXPECT_NEAR(Length(line), 2.0, 1e-12);
      EXPECT_NEAR(std::abs(line.Points[0].Point[1]), 1.0, 1e-12);
    }
  }
  EXPECT_EQ(lines, 2);
  EXPECT_LE(MeasureLines(half.Model, result, viewer).Cosine, 1e-9);
}

// Two planes that meet at an angle: sharp from there on, smooth below; the other sides are borders.
TEST(FeatureEdges, KindsByAngle)
{
  for (const double degrees : { 10.0, 29.0, 31.0, 120.0 })
  {
    const double a = degrees * Pi / 180.0;
    const nurbs::Surface flat =
      BezierSurface(1, 1, [](double u, double v) { return Vec3(u - 1.0, v, 0.0); });
    const nurbs::Surface slope = BezierSurface(
      1, 1, [a](double u, double v) { return Vec3(u * std::cos(a), v, u * std::sin(a)); });
    for (const bool flipped : { false, true })
    {
      Model model = OneFace(flat);
      nurbs::Face face;
      face.Geometry = slope.View();
      face.Reversed = flipped; // Neighbours that do not agree on the outside.
      model.Faces.push_back(face);
      nurbs::SilhouetteOptions options;
      std::fill(options.Kinds, options.Kinds + nurbs::LineKindCount, true);
      const Silhouettes result = nurbs::MakeSilhouettes(model, { "", "" }, options);
      int counts[nurbs::LineKindCount] = { 0, 0, 0, 0 };
      for (const SilhouetteLine& line : result.Lines)
      {
        ++counts[int(line.Kind)];
        EXPECT_EQ(line.Points.size(), 2u);
        EXPECT_NEAR(Length(line), 1.0, 1e-15);
      }
      EXPECT_EQ(counts[int(LineKind::Boundary)], 6);
      EXPECT_EQ(counts[int(LineKind::Sharp)], degrees > 30.0 ? 1 : 0);
      EXPECT_EQ(counts[int(LineKind::Smooth)], degrees > 30.0 ? 0 : 1);
      EXPECT_EQ(result.Chains[int(LineKind::Boundary)], 1);
    }
  }
}

// Planes that meet at 10 degrees, one of which faces the viewer: their edge is the silhouette.
TEST(FeatureEdges, SmoothEdgesThatTurnAway)
{
  const double a = 10.0 * Pi / 180.0;
  const nurbs::Surface flat =
    BezierSurface(1, 1, [](double u, double v) { return Vec3(u - 1.0, v, 0.0); });
  const nurbs::Surface slope = BezierSurface(
    1, 1, [a](double u, double v) { return Vec3(u * std::cos(a), v, u * std::sin(a)); });
  for (const bool reversed : { false, true })
  {
    Model model = OneFace(flat);
    nurbs::Face face;
    face.Geometry = slope.View();
    model.Faces.push_back(face);
    model.Faces[0].Reversed = model.Faces[1].Reversed = reversed;
    const Silhouettes over = Make(model, Direction(0, 0, 1), 1e-4);
    EXPECT_EQ(over.Chains[0], 0);
    const Silhouettes result = Make(model, Direction(1, 0, 0.1), 1e-4);
    ASSERT_EQ(result.Chains[0], 1);
    for (const SilhouetteLine& line : result.Lines)
    {
      if (line.Kind == LineKind::Silhouette)
      {
        EXPECT_TRUE(line.Crease);
        EXPECT_NEAR(Length(line), 1.0, 1e-12);
        // The front is the flat one, or of outsides below the slope; on the left from outside.
        EXPECT_EQ(line.Face, reversed ? 1 : 0);
        EXPECT_NEAR(line.Points[0].Point[1], 0.0, 1e-15);
      }
    }
  }
}

// Round edges within the precision, against a circle.
TEST(FeatureEdges, LieOnTheCurve)
{
  nurbs::ModelBuilder builder;
  nurbs::AddCylinder(builder, 1.0, 2.0, true);
  const nurbs::AssembledModel cylinder = nurbs::AssembleModel(builder.Arrays());
  for (const double precision : { 1e-2, 1e-4, 1e-6 })
  {
    const Silhouettes result = Make(cylinder.Model, Direction(0, 0, 1), precision);
    int rims = 0;
    for (const SilhouetteLine& line : result.Lines)
    {
      ASSERT_EQ(line.Kind, LineKind::Sharp);
      ++rims;
      for (std::size_t k = 0; k < line.Points.size(); ++k)
      {
        const Vec3& p = line.Points[k].Point;
        EXPECT_NEAR(std::hypot(p[0], p[1]), 1.0, 1e-12);
        if (k > 0)
        {
          const Vec3 middle = 0.5 * (p + line.Points[k - 1].Point);
          EXPECT_LE(1.0 - std::hypot(middle[0], middle[1]), precision);
        }
      }
      EXPECT_EQ(line.Next[0], line.Next[1]); // Closed by itself.
      EXPECT_GE(line.Next[0], 0);
    }
    EXPECT_EQ(rims, 2);
  }
}

} // namespace
