// SPDX-License-Identifier: BSD-3-Clause
// Lines that nobody has told the cells of a face: they must find them.
#include "FaceCells.h"

#include "ModelBuilder.h"
#include "PatchStitcher.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using nurbs::Vec2;

// A unit square in the plane of the image.
struct Square
{
  nurbs::ModelBuilder Builder;
  nurbs::AssembledModel Made;

  Square()
  {
    nurbs::Surface s;
    s.Degree[0] = s.Degree[1] = 1;
    s.Count[0] = s.Count[1] = 2;
    s.Knots[0] = s.Knots[1] = { 0, 0, 1, 1 };
    s.Points = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 } };
    nurbs::PatchStitcher(this->Builder, 1e-12).AddFace(s, nurbs::FaceAttributes());
    this->Made = nurbs::AssembleModel(this->Builder.Arrays());
  }

  nurbs::FaceCells Cells(double precision) const
  {
    nurbs::FaceCells out(this->Made.Model, 0, precision);
    out.AddTrims({});
    return out;
  }

  // Corners of all loops.
  std::vector<std::vector<Vec2>> Loops(const nurbs::FaceCells& cells, nurbs::Sight sight) const
  {
    std::vector<std::vector<Vec2>> out;
    for (const nurbs::RegionLoop& loop : cells.Loops(sight))
    {
      out.emplace_back();
      for (const nurbs::RegionPiece& piece : loop)
      {
        if (piece.Curve >= 0)
        {
          out.back().push_back(nurbs::EndOfPiece(this->Made.Model, piece, false));
        }
        out.back().insert(out.back().end(), piece.Polyline.begin(), piece.Polyline.end());
      }
    }
    return out;
  }
};

double Area(const std::vector<std::vector<Vec2>>& loops)
{
  double sum = 0.0;
  for (const std::vector<Vec2>& loop : loops)
  {
    for (std::size_t k = 0; k < loop.size(); ++k)
    {
      const Vec2& a = loop[k];
      const Vec2& b = loop[(k + 1) % loop.size()];
      sum += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
  }
  return sum;
}

nurbs::FaceView Look(const std::function<bool(const Vec2&)>& isSeen)
{
  return { isSeen, [](const Vec2& uv) { return uv; } };
}

} // namespace

TEST(FaceCells, FindsALineAcross)
{
  const Square square;
  for (const double precision : { 1e-2, 1e-3, 1e-4 })
  {
    nurbs::FaceCells cells = square.Cells(precision);
    const Vec2 center(0.3, 0.2);
    EXPECT_EQ(
      cells.Look(Look([&](const Vec2& uv) { return (uv - center).norm() < 0.6; }), true), 0);
    const auto loops = square.Loops(cells, nurbs::Sight::Visible);
    ASSERT_EQ(loops.size(), 1u);
    for (const Vec2& p : loops[0])
    {
      const bool isOnSide = p.minCoeff() < 1e-9 || p.maxCoeff() > 1.0 - 1e-9;
      EXPECT_TRUE(isOnSide || std::abs((p - center).norm() - 0.6) <= precision) << p.transpose();
    }
    // The disc without what lies beyond the sides u = 0 and v = 0.
    double exact = 0.0;
    constexpr int Steps = 200000;
    for (int k = 0; k < Steps; ++k)
    {
      const double u = 0.9 * (k + 0.5) / Steps;
      const double half = std::sqrt(0.36 - (u - 0.3) * (u - 0.3));
      exact += 0.9 / Steps * (0.2 + half - std::max(0.0, 0.2 - half));
    }
    EXPECT_NEAR(Area(loops), exact, 2.0 * precision);
    EXPECT_NEAR(Area(square.Loops(cells, nurbs::Sight::Hidden)), 1.0 - exact, 2.0 * precision);
  }
}

TEST(FaceCells, MovesALineThatIsWrong)
{
  const Square square;
  const nurbs::FaceView view = Look([](const Vec2& uv) { return uv[0] + 0.1 * uv[1] < 0.5; });
  nurbs::FaceCells cells = square.Cells(1e-3);
  // The line that is given leaves the true one for a while, into what is hidden, and comes back.
  cells.AddPolyline(
    { { 0.5, 0.0 }, { 0.48, 0.2 }, { 0.9, 0.3 }, { 0.47, 0.3 }, { 0.4, 1.0 } }, true);
  EXPECT_EQ(cells.Look(view, true), 0);
  EXPECT_NEAR(Area(square.Loops(cells, nurbs::Sight::Visible)), 0.45, 1e-3);
}

TEST(FaceCells, LeavesALineThatIsRight)
{
  const Square square;
  nurbs::FaceCells cells = square.Cells(1e-3);
  cells.AddPolyline({ { 0.5, 0.0 }, { 0.4, 1.0 } }, true);
  int looks = 0;
  cells.Look(Look([&](const Vec2& uv) {
    ++looks;
    return uv[0] + 0.1 * uv[1] < 0.5;
  }),
    true);
  EXPECT_LE(looks, 12);
  const auto loops = square.Loops(cells, nurbs::Sight::Visible);
  ASSERT_EQ(loops.size(), 1u);
  EXPECT_NEAR(Area(loops), 0.45, 1e-8);
}

// Where faces coincide there is no line to find: the search ends, and says that it has found none.
TEST(FaceCells, EndsInNoise)
{
  const Square square;
  nurbs::FaceCells cells = square.Cells(1e-4);
  const auto noise = [](const Vec2& uv) {
    const double x = 1e4 * std::sin(1e4 * uv[0] + 3e4 * uv[1] * uv[1]);
    return x - std::floor(x) < 0.5;
  };
  EXPECT_GT(cells.Look(Look(noise), true), 0);
  EXPECT_NEAR(Area(square.Loops(cells, nurbs::Sight::Visible)) +
      Area(square.Loops(cells, nurbs::Sight::Hidden)),
    1.0, 1e-8);
}
