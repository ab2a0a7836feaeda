// SPDX-License-Identifier: BSD-3-Clause
// What TrimIndex calls inside is what the tessellator triangulates: loops of all kinds that do not
// cross, and how the two differ, as told in TrimIndex.h, where loops do.
#include "Tessellator.h"
#include "TrimIndex.h"

#include "nurbsReference.h"
#include "nurbsTrimReference.h"

#include <gtest/gtest.h>

namespace
{

using nurbs::Vec2;
using reference::LoopCurve;
using reference::Loops;
using reference::Polygon;

std::vector<LoopCurve> Circle(const Vec2& centre, double radius, bool clockwise)
{
  nurbs::Curve<2> circle = reference::Circle(radius);
  for (Vec2& p : circle.Points)
  {
    p += centre;
  }
  circle.Pack();
  return { { circle, clockwise } };
}

std::vector<LoopCurve> Square(double from, double to, bool clockwise)
{
  return Polygon({ Vec2(from, from), clockwise ? Vec2(from, to) : Vec2(to, from), Vec2(to, to),
    clockwise ? Vec2(to, from) : Vec2(from, to) });
}

/// Parts of the domain: what the triangles cover, and what the index has inside.
struct Areas
{
  double Triangles = 0.0;
  double Inside = 0.0;
};

Areas Measure(const Loops& loops)
{
  const reference::TrimmedSheet sheet(loops, false);
  nurbs::TessellatorOptions options;
  options.Tolerance = 1e-5;
  const nurbs::TessellationResult result =
    nurbs::Tessellate(sheet.Model(), { std::string() }, options);
  const nurbs::FaceMesh& mesh = result.Meshes.at(0);
  Areas areas;
  for (std::size_t t = 0; t < mesh.Triangles.size(); t += 3)
  {
    const Vec2& a = mesh.UV[mesh.Triangles[t]];
    const Vec2 b = mesh.UV[mesh.Triangles[t + 1]] - a;
    const Vec2 c = mesh.UV[mesh.Triangles[t + 2]] - a;
    areas.Triangles += 0.5 * std::abs(b[0] * c[1] - b[1] * c[0]);
  }
  const nurbs::TrimIndex index(sheet.Model());
  constexpr int Side = 500;
  for (int k = 0; k < Side * Side; ++k)
  {
    areas.Inside += index.Inside(0, (k % Side + 0.5) / Side, (k / Side + 0.5) / Side);
  }
  areas.Inside /= double(Side) * Side;
  return areas;
}

TEST(TrimRule, LoopsThatDoNotCross)
{
  for (int turned = 0; turned < 8; ++turned)
  {
    const auto way = [turned](int k) { return (turned >> k) % 2 == 1; };
    const std::vector<Loops> kinds{
      { Circle(Vec2(0.4, 0.5), 0.3, way(0)) },                           // one
      { Square(0.1, 0.9, way(0)), Circle(Vec2(0.5, 0.5), 0.3, way(1)),   // nested
        Square(0.4, 0.6, way(2)) },                                      //
      { Square(0.1, 0.4, way(0)), Circle(Vec2(0.7, 0.7), 0.2, way(1)),   // side by side
        Circle(Vec2(0.3, 0.3), 0.05, way(2)) },                          //
      { Square(0.0, 1.0, way(0)), Circle(Vec2(0.5, 0.5), 0.2, way(1)) }, // the domain itself
      { Polygon({ Vec2(0.1, 0.1), Vec2(0.9, 0.1), Vec2(0.9, 0.9), Vec2(0.5, 0.9), Vec2(0.5, 0.4),
        Vec2(0.5, 0.9), Vec2(0.1, 0.9) }) }, // a slit
      { Polygon({ Vec2(-0.01, 0.2), Vec2(1.01, 0.2), Vec2(1.01, 0.8), Vec2(-0.01, 0.8) }) },
    };
    for (std::size_t k = 0; k < kinds.size(); ++k)
    {
      const Areas areas = Measure(kinds[k]);
      EXPECT_GT(areas.Triangles, 0.1);
      EXPECT_NEAR(areas.Inside, areas.Triangles, 2e-3) << "kind " << k << ", turned " << turned;
    }
  }
}

TEST(TrimRule, GapsAreClosedByBoth)
{
  Loops loops{ Square(0.2, 0.8, false) };
  loops[0][1] = reference::Line(Vec2(0.8, 0.204), Vec2(0.8, 0.8));
  const Areas areas = Measure(loops);
  EXPECT_NEAR(areas.Triangles, 0.36, 2e-3);
  EXPECT_NEAR(areas.Inside, areas.Triangles, 2e-3);
}

TEST(TrimRule, LoopsThatCrossDifferAsTold)
{
  // Lobes of a figure of eight: both rules keep both.
  Areas areas =
    Measure({ Polygon({ Vec2(0.1, 0.1), Vec2(0.9, 0.7), Vec2(0.9, 0.1), Vec2(0.1, 0.5) }) });
  EXPECT_GT(areas.Triangles, 0.1);
  EXPECT_NEAR(areas.Inside, areas.Triangles, 2e-3);
  // Loops that overlap: united, or without what both have.
  areas = Measure({ Square(0.1, 0.5, false), Square(0.3, 0.7, false) });
  EXPECT_NEAR(areas.Triangles, 0.28, 2e-3);
  EXPECT_NEAR(areas.Inside, 0.24, 2e-3);
}

} // namespace
