// SPDX-License-Identifier: BSD-3-Clause
// OpenCASCADE's mesh is that of the moved surface: nodes on it, triangles within the deflection.
#include "OcctDeformationRival.h"
#include "../Filters/Core/nurbsReference.h"

#include <gtest/gtest.h>

using namespace nurbs;

namespace
{

struct Distances
{
  double Node = 0.0;     ///< Nodes to the surface at their parameters, over all.
  double Normal = 0.0;   ///< Angles there.
  double Domain = 0.0;   ///< Area of the triangles in the domain.
  double Triangle = 0.0; ///< The surface at the triangles' centres to their planes.
};

Distances Measure(const DeformationRival& rival)
{
  const SurfaceView view = rival.GetSurface().View();
  const DeformationMesh& mesh = rival.GetMesh();
  const auto uv = [&](int k) { return Vec2(mesh.Parameters[2 * k], mesh.Parameters[2 * k + 1]); };
  const auto point = [&](int k) { return Vec3(Eigen::Map<const Vec3>(&mesh.Points[3 * k])); };
  Distances d;
  for (int k = 0; k < int(mesh.Points.size() / 3); ++k)
  {
    const Eigen::Map<const Vec3> normal(&mesh.Normals[3 * k]);
    d.Node = std::max(d.Node, (point(k) - Evaluate(view, uv(k)[0], uv(k)[1])).norm());
    d.Normal = std::max(d.Normal, (normal - Normal(view, uv(k)[0], uv(k)[1])).norm());
  }
  for (std::size_t t = 0; t < mesh.Triangles.size(); t += 3)
  {
    const int a = mesh.Triangles[t], b = mesh.Triangles[t + 1], c = mesh.Triangles[t + 2];
    const Vec2 side = uv(b) - uv(a), other = uv(c) - uv(a);
    d.Domain += 0.5 * (side[0] * other[1] - side[1] * other[0]);
    const Vec2 centre = (uv(a) + uv(b) + uv(c)) / 3.0;
    const Vec3 normal = (point(b) - point(a)).cross(point(c) - point(a)).normalized();
    const Vec3 on = Evaluate(view, centre[0], centre[1]);
    d.Triangle = std::max(d.Triangle, std::abs(normal.dot(on - point(a))));
  }
  return d;
}

} // namespace

TEST(OcctDeformationRival, MeshIsTheMovedSurface)
{
  for (bool rational : { false, true })
  {
    reference::Random random(rational ? 3 : 4);
    Surface s;
    for (int dir = 0; dir < 2; ++dir)
    {
      s.Degree[dir] = 3;
      s.Count[dir] = 13;
      s.Knots[dir] = UniformKnots(3, 13);
    }
    for (int k = 0; k < 169; ++k)
    {
      s.Points.push_back(Vec3(k % 13, k / 13, random.Uniform(-0.5, 0.5)));
      if (rational)
      {
        s.Weights.push_back(random.Uniform(0.8, 1.2));
      }
    }
    const SampleGrid grid(s, 8);
    OcctDeformationRival rival;
    rival.Prepare(s, grid);
    const double count = double(grid.Count());
    EXPECT_NEAR(double(rival.GetMesh().Points.size() / 3), count, 0.2 * count);
    rival.Move(84, s.Points[84] + Vec3(0.3, -0.2, 1.0));
    const Distances d = Measure(rival);
    const double size = 17.0;
    EXPECT_LT(d.Node, 1e-12 * size);
    EXPECT_LT(d.Normal, 1e-10);
    EXPECT_NEAR(d.Domain, 1.0, 1e-9);
    EXPECT_LT(d.Triangle, rival.GetDeflection());
  }
}
