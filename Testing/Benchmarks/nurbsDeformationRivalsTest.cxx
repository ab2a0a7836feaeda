// SPDX-License-Identifier: BSD-3-Clause
// What the methods of the benchmark leave behind is the moved surface, by direct evaluation.
#include "../Filters/Core/nurbsReference.h"
#include "DeformationRivals.h"
#include "NetRefinement.h"

#include <gtest/gtest.h>

using namespace nurbs;

namespace
{

std::vector<std::unique_ptr<DeformationRival>> Rivals()
{
  std::vector<std::unique_ptr<DeformationRival>> rivals;
  for (int multiplicity : { 1, 2, 3, 5 })
  {
    rivals.push_back(MakeOsloRival(multiplicity));
  }
  rivals.push_back(MakeBezierRival(false));
  rivals.push_back(MakeBezierRival(true));
  rivals.push_back(MakeGridRival());
  rivals.push_back(MakeLocalGridRival());
  return rivals;
}

/// Uneven knots of any multiplicity; the net is flat enough that no normal is ill-conditioned.
Surface MakeSurface(int p, int q, bool rational, unsigned seed)
{
  reference::Random random(seed);
  Surface s = random.Surface(p, q, true, rational, false, 9);
  for (Vec3& point : s.Points)
  {
    point[2] *= 0.5;
  }
  for (double& weight : s.Weights)
  {
    weight = 0.75 + 0.25 * weight;
  }
  return s;
}

void ExpectSurface(const DeformationRival& rival, const SampleGrid& grid)
{
  const SurfaceView view = rival.GetSurface().View();
  const DeformationMesh& mesh = rival.GetMesh();
  const std::size_t width = grid.Parameters[0].size();
  ASSERT_EQ(mesh.Points.size(), std::size_t(3 * grid.Count()));
  ASSERT_EQ(mesh.Normals.size(), mesh.Points.size());
  double size = 0.0, distance = 0.0, angle = 0.0;
  for (const Vec3& p : rival.GetSurface().Points)
  {
    size = std::max(size, (p - rival.GetSurface().Points[0]).norm());
  }
  for (std::int64_t k = 0; k < grid.Count(); ++k)
  {
    const double u = grid.Parameters[0][k % width], v = grid.Parameters[1][k / width];
    const SurfaceDerivatives d = EvaluateDerivatives(view, u, v, 1);
    const Eigen::Map<const Vec3> point(mesh.Points.data() + 3 * k);
    const Eigen::Map<const Vec3> normal(mesh.Normals.data() + 3 * k);
    distance = std::max(distance, (point - d.S).norm());
    angle = std::max(angle, (normal - d.Su.cross(d.Sv).normalized()).norm());
    EXPECT_NEAR(normal.norm(), 1.0, 1e-14);
  }
  EXPECT_LT(distance, 1e-12 * size);
  EXPECT_LT(angle, 1e-10);
}

} // namespace

TEST(DeformationRivals, LeaveTheMovedSurfaceBehind)
{
  const int degrees[][2] = { { 3, 3 }, { 3, 3 }, { 2, 4 }, { 5, 1 }, { 3, 2 } };
  unsigned seed = 20;
  for (const auto& degree : degrees)
  {
    for (bool rational : { false, true })
    {
      const Surface start = MakeSurface(degree[0], degree[1], rational, ++seed);
      for (int cells : { 1, 2, 5 })
      {
        const SampleGrid grid(start, cells);
        for (const std::unique_ptr<DeformationRival>& rival : Rivals())
        {
          SCOPED_TRACE(std::string(rival->GetName()) + ", seed " + std::to_string(seed) + ", " +
            std::to_string(cells) + " cells");
          rival->Prepare(start, grid);
          ExpectSurface(*rival, grid);
          // Corners, sides and the inside, one after the other.
          for (std::size_t index = 0; index < start.Points.size(); index += 3)
          {
            rival->Move(std::int64_t(index), start.Points[index] + Vec3(0.1, -0.2, 0.4));
          }
          ExpectSurface(*rival, grid);
        }
      }
    }
  }
}

TEST(DeformationRivals, GridKnowsTheSupport)
{
  Surface s;
  for (int dir = 0; dir < 2; ++dir)
  {
    s.Degree[dir] = 3;
    s.Count[dir] = 8;
    s.Knots[dir] = UniformKnots(3, 8);
  }
  s.Points.resize(64, Vec3::Zero());
  const SampleGrid grid(s, 4); // five spans
  ASSERT_EQ(grid.Parameters[0].size(), 21u);
  EXPECT_EQ(grid.Breaks[1].size(), 6u);
  EXPECT_EQ(grid.Parameters[1][4], s.Knots[1][4]);
  EXPECT_EQ(grid.Parameters[1].back(), 1.0);
  EXPECT_EQ(grid.Support(s, 0, 0), (std::array<int, 2>{ 0, 4 }));
  EXPECT_EQ(grid.Support(s, 0, 3), (std::array<int, 2>{ 0, 16 }));
  EXPECT_EQ(grid.Support(s, 1, 4), (std::array<int, 2>{ 4, 21 }));
  EXPECT_EQ(grid.Support(s, 1, 7), (std::array<int, 2>{ 16, 21 }));
}

TEST(DeformationRivals, TrianglesCoverTheGrid)
{
  const Surface s = MakeSurface(3, 2, false, 5);
  const SampleGrid grid(s, 3);
  const std::unique_ptr<DeformationRival> rival = MakeGridRival();
  rival->Prepare(s, grid);
  const std::vector<int>& triangles = rival->GetMesh().Triangles;
  const int width = int(grid.Parameters[0].size()), height = int(grid.Parameters[1].size());
  ASSERT_EQ(triangles.size(), std::size_t(6 * (width - 1) * (height - 1)));
  double area = 0.0; // in index space, positive if u to v
  for (std::size_t k = 0; k < triangles.size(); k += 3)
  {
    const auto at = [&](std::size_t c) {
      return Vec2(triangles[k + c] % width, triangles[k + c] / width);
    };
    const Vec2 a = at(1) - at(0), b = at(2) - at(0);
    const double twice = a[0] * b[1] - a[1] * b[0];
    EXPECT_EQ(twice, 1.0);
    area += 0.5 * twice;
  }
  EXPECT_EQ(area, double((width - 1) * (height - 1)));
}

TEST(NetRefinement, DiscreteBsplinesAreTextbookKnotInsertion)
{
  // Chaikin's corner cutting: halving the knots of uniform quadratic splines weighs 1/4 and 3/4.
  const std::vector<double> coarse{ 0, 0, 0, 1, 2, 3, 4, 5, 5, 5 };
  const Refinement r = Refine(coarse, 2, { 0.5, 1.5, 2.5, 3.5, 4.5 });
  ASSERT_EQ(r.Count(), 12);
  for (int j = 4; j < 8; ++j)
  {
    double sum = 0.0;
    std::vector<double> row;
    for (int i = 0; i < 3; ++i)
    {
      const double a = r.Coefficients[3 * j + i];
      sum += a;
      if (a != 0.0)
      {
        row.push_back(a);
      }
    }
    std::sort(row.begin(), row.end());
    EXPECT_EQ(row, (std::vector<double>{ 0.25, 0.75 })) << "point " << j;
    EXPECT_EQ(sum, 1.0);
  }
}
