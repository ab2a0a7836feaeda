// SPDX-License-Identifier: BSD-3-Clause
// The cells of whole surfaces: they tile the domain, and their triangles are as near to the surface
// as they say.
#include "SurfaceTree.h"
#include "nurbsBoundReference.h"

#include <gtest/gtest.h>

namespace
{

using namespace reference;
using nurbs::ErrorMode;
using nurbs::SubdivisionMethod;
using nurbs::SurfaceBound;
using nurbs::SurfaceTree;
using nurbs::TreeGoal;
using nurbs::TreeLeaf;

struct Triangle
{
  Vec3 X[3];
  Vec2 UV[3];
};

/// The two triangles of a leaf but for those that a pole makes empty.
std::vector<Triangle> TrianglesOf(const nurbs::SurfaceView& s, const TreeLeaf& leaf)
{
  const ParameterBox& b = leaf.Box;
  const Vec2 uv[4] = { Vec2(b.U0, b.V0), Vec2(b.U1, b.V0), Vec2(b.U0, b.V1), Vec2(b.U1, b.V1) };
  const int corners[2][2][3] = { { { 0, 1, 3 }, { 0, 3, 2 } }, { { 0, 1, 2 }, { 1, 3, 2 } } };
  std::vector<Triangle> out;
  for (const int(&f)[3] : corners[leaf.Diagonal])
  {
    Triangle t;
    for (int i = 0; i < 3; ++i)
    {
      t.UV[i] = uv[f[i]];
      t.X[i] = nurbs::Evaluate(s, t.UV[i][0], t.UV[i][1]);
    }
    const double shortest =
      std::min({ (t.X[1] - t.X[0]).norm(), (t.X[2] - t.X[1]).norm(), (t.X[0] - t.X[2]).norm() });
    if (shortest > 1e-9 * (t.X[1] - t.X[0] + t.X[2] - t.X[0]).norm())
    {
      out.push_back(t);
    }
  }
  return out;
}

/// The facets with a side on the domain's boundary, continued beyond it: there the mesh has
/// vertices of the boundary's own, or (`closed`) cells from the other end.
void AddAprons(const ParameterBox& domain, const bool* closed, std::vector<Triangle>& triangles)
{
  const double low[2] = { domain.U0, domain.V0 };
  const double high[2] = { domain.U1, domain.V1 };
  const std::size_t count = triangles.size();
  for (std::size_t k = 0; k < count; ++k)
  {
    for (int i = 0; i < 3; ++i)
    {
      const Triangle t = triangles[k];
      const int j = (i + 1) % 3;
      for (int d = 0; d < 2; ++d)
      {
        const double at = t.UV[i][d];
        if (closed[d] || t.UV[j][d] != at || (at != low[d] && at != high[d]))
        {
          continue;
        }
        const Vec3 edge = t.X[j] - t.X[i];
        const Vec3 n = (t.X[1] - t.X[0]).cross(t.X[2] - t.X[0]);
        const Vec3 out = edge.cross(n).normalized() * edge.norm();
        triangles.push_back({ { t.X[i], t.X[j], t.X[i] + out }, { t.UV[i], t.UV[j], t.UV[i] } });
        triangles.push_back(
          { { t.X[j], t.X[j] + out, t.X[i] + out }, { t.UV[j], t.UV[j], t.UV[i] } });
      }
    }
  }
}

/// What lies between a side and the finer sides of its neighbours: a fan over their corners, as a
/// mesh without T-junctions has it in one way or another.
void AddFans(const nurbs::SurfaceView& s, const SurfaceTree& tree, const TreeLeaf& leaf,
  std::vector<Triangle>& triangles)
{
  const ParameterBox& b = leaf.Box;
  for (int side = 0; side < 4; ++side)
  {
    const int d = side / 2; // Of the side's normal.
    const double at = side == 0 ? b.U0 : side == 1 ? b.U1 : side == 2 ? b.V0 : b.V1;
    const double low = d == 0 ? b.V0 : b.U0;
    const double high = d == 0 ? b.V1 : b.U1;
    std::vector<double> on{ low, high };
    const ParameterBox line =
      d == 0 ? ParameterBox{ at, at, low, high } : ParameterBox{ low, high, at, at };
    tree.Query(line, [&](int k) {
      const ParameterBox& o = tree.Leaves()[k].Box;
      for (double t : { d == 0 ? o.V0 : o.U0, d == 0 ? o.V1 : o.U1 })
      {
        if (t > low && t < high)
        {
          on.push_back(t);
        }
      }
    });
    std::sort(on.begin(), on.end());
    on.erase(std::unique(on.begin(), on.end()), on.end());
    const auto corner = [&](double t) { return d == 0 ? Vec2(at, t) : Vec2(t, at); };
    for (std::size_t k = 1; k + 1 < on.size(); ++k)
    {
      Triangle t{ {}, { corner(on[0]), corner(on[k]), corner(on[k + 1]) } };
      for (int i = 0; i < 3; ++i)
      {
        t.X[i] = nurbs::Evaluate(s, t.UV[i][0], t.UV[i][1]);
      }
      triangles.push_back(t);
    }
  }
}

/// Leaves cover the domain once, in exact arithmetic of their codes, and know their boxes.
void ExpectTiling(const SurfaceTree& tree, const ParameterBox& domain)
{
  __int128 area = 0;
  const nurbs::LineCode one = nurbs::LineCode(1) << 20;
  const nurbs::LineCode nu = nurbs::LineCode(tree.Lines(0).size() - 1) * one;
  const nurbs::LineCode nv = nurbs::LineCode(tree.Lines(1).size() - 1) * one;
  EXPECT_EQ(tree.Parameter(0, 0), domain.U0);
  EXPECT_EQ(tree.Parameter(0, nu), domain.U1);
  EXPECT_EQ(tree.Parameter(1, 0), domain.V0);
  EXPECT_EQ(tree.Parameter(1, nv), domain.V1);
  int wrong = 0;
  for (std::size_t k = 0; k < tree.Leaves().size(); ++k)
  {
    const TreeLeaf& l = tree.Leaves()[k];
    wrong += l.U0 < 0 || l.U1 > nu || l.V0 < 0 || l.V1 > nv || l.U0 >= l.U1 || l.V0 >= l.V1;
    area += __int128(l.U1 - l.U0) * (l.V1 - l.V0);
    wrong += l.Box.U0 != tree.Parameter(0, l.U0) || l.Box.U1 != tree.Parameter(0, l.U1) ||
      l.Box.V0 != tree.Parameter(1, l.V0) || l.Box.V1 != tree.Parameter(1, l.V1);
    // Nothing else touches what is inside it.
    const double a = 1e-6 * l.Box.A();
    const double b = 1e-6 * l.Box.B();
    int touched = 0;
    tree.Query({ l.Box.U0 + a, l.Box.U1 - a, l.Box.V0 + b, l.Box.V1 - b }, [&](int other) {
      ++touched;
      wrong += other != int(k);
    });
    wrong += touched != 1;
    for (int d = 0; d < 2; ++d)
    {
      for (double crease : tree.Creases(d))
      {
        wrong += (d == 0 ? l.Box.U0 : l.Box.V0) < crease && crease < (d == 0 ? l.Box.U1 : l.Box.V1);
      }
    }
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_TRUE(area == __int128(nu) * nv);
}

struct Result
{
  std::size_t Cells = 0;
  double Bound = 0.0;   ///< Greatest error of a leaf,
  double Mesh = 0.0;    ///< greatest distance from the surface to the triangles of all leaves,
  double Surface = 0.0; ///< and from those to the surface; all over the tolerance.
  double Ideal = 0.0;   ///< Integral of sqrt(|K|) over the area, over four tolerances.
};

/// Samples at most `most` leaves; half of those at open ends only if the ends lie `inPlanes`, as
/// curves that bow inwards leave facets without surface, which a mesh's boundary takes care of.
Result Measure(const nurbs::Surface& surface, const ParameterBox& domain, const TreeGoal& goal,
  const char* name, std::size_t most = 120, bool inPlanes = true)
{
  const nurbs::SurfaceView view = surface.View();
  SurfaceBound bound(view, domain);
  SurfaceTree tree;
  tree.Build(bound, domain, goal, nurbs::SerialFor);
  EXPECT_FALSE(tree.IsCapped());
  ExpectTiling(tree, domain);
  Result out;
  const std::vector<TreeLeaf>& leaves = tree.Leaves();
  out.Cells = leaves.size();
  std::vector<std::vector<Triangle>> triangles(leaves.size());
  const ParameterBox all = DomainOf(view);
  const double period[2] = { domain.A(), domain.B() };
  const bool closed[2] = { nurbs::IsClosed(view, 0, 1e-9) && domain.A() == all.A(),
    nurbs::IsClosed(view, 1, 1e-9) && domain.B() == all.B() };
  for (std::size_t k = 0; k < leaves.size(); ++k)
  {
    triangles[k] = TrianglesOf(view, leaves[k]);
    AddAprons(domain, closed, triangles[k]);
    AddFans(view, tree, leaves[k], triangles[k]);
    out.Bound = std::max(out.Bound, leaves[k].Error / goal.Tolerance);
  }
  const std::size_t step = 1 + leaves.size() / std::size_t(Rounds(int(most)));
  for (std::size_t k = 0; k < leaves.size(); k += step)
  {
    const ParameterBox& b = leaves[k].Box;
    const auto nearest = [&](const Vec3& x, const std::vector<Triangle>& all, double least) {
      for (const Triangle& t : all)
      {
        least = std::min(least, TriangleDistance(x, t.X));
      }
      return least;
    };
    constexpr int N = 7;
    for (int i = 0; i <= N * N + 2 * N; ++i)
    {
      const Vec2 uv(b.U0 + b.A() * (i % (N + 1)) / N, b.V0 + b.B() * (i / (N + 1)) / N);
      const Vec3 x = nurbs::Evaluate(view, uv[0], uv[1]);
      double least = nearest(x, triangles[k], 1e300);
      for (double margin = 0.01; least > 0.95 * goal.Tolerance && margin < 3.0; margin *= 4.0)
      {
        const double a = margin * b.A();
        const double c = margin * b.B();
        for (int turn = -4; turn <= 4; ++turn)
        {
          // Round the ends of closed directions, too.
          const double du = (turn + 4) % 3 - 1;
          const double dv = (turn + 4) / 3 - 1;
          if ((du == 0.0 || closed[0]) && (dv == 0.0 || closed[1]))
          {
            const double u = uv[0] + du * period[0];
            const double v = uv[1] + dv * period[1];
            tree.Query({ u - a, u + a, v - c, v + c },
              [&](int other) { least = nearest(x, triangles[other], least); });
          }
        }
      }
      out.Mesh = std::max(out.Mesh, least / goal.Tolerance);
      const nurbs::SurfaceDerivatives d = nurbs::EvaluateDerivatives(
        view, std::min(b.U1 - 1e-9 * b.A(), uv[0]), std::min(b.V1 - 1e-9 * b.B(), uv[1]), 2);
      // sqrt|K| times the area element is the root of the second fundamental form's determinant.
      const Vec3 n = d.Su.cross(d.Sv).normalized();
      const double k2 = n.dot(d.Suu) * n.dot(d.Svv) - std::pow(n.dot(d.Suv), 2);
      const double share = b.A() * b.B() / ((N + 1) * (N + 1)) * double(step);
      out.Ideal += std::isfinite(k2) ? std::sqrt(std::abs(k2)) * share / (4.0 * goal.Tolerance) : 0;
    }
    for (const Triangle& t : TrianglesOf(view, leaves[k]))
    {
      Barycentric(5, [&](double b0, double b1, double b2) {
        const Vec2 p = b0 * t.UV[0] + b1 * t.UV[1] + b2 * t.UV[2];
        const Vec2 middle(0.5 * (b.U0 + b.U1), 0.5 * (b.V0 + b.V1));
        const bool atEnd =
          (!closed[0] && (p[0] < middle[0] ? b.U0 == domain.U0 : b.U1 == domain.U1)) ||
          (!closed[1] && (p[1] < middle[1] ? b.V0 == domain.V0 : b.V1 == domain.V1));
        if (atEnd && !inPlanes)
        {
          return;
        }
        const Vec3 x = b0 * t.X[0] + b1 * t.X[1] + b2 * t.X[2];
        double least = SurfaceDistance(view, x, p, DomainOf(view));
        if (least > 0.99 * goal.Tolerance)
        {
          const ParameterBox wide{ std::max(domain.U0, b.U0 - b.A()),
            std::min(domain.U1, b.U1 + b.A()), std::max(domain.V0, b.V0 - b.B()),
            std::min(domain.V1, b.V1 + b.B()) };
          least = std::min(least, SearchDistance(view, x, wide));
        }
        out.Surface = std::max(out.Surface, least / goal.Tolerance);
      });
    }
  }
  std::printf("%-28s %6zu cells, ideally %7.0f (%.2f): bound %.4f, surface to mesh %.4f, mesh to "
              "surface %.4f of the tolerance\n",
    name, out.Cells, out.Ideal, out.Cells / std::max(1.0, out.Ideal), out.Bound, out.Mesh,
    out.Surface);
  return out;
}

/// Bicubic of n x n control points with heights up to `height`; sides are in
/// planes, parameters inside uneven.
nurbs::Surface Terrain(Random& random, int n, double height)
{
  nurbs::Surface s;
  for (int d = 0; d < 2; ++d)
  {
    s.Degree[d] = 3;
    s.Count[d] = n;
    s.Knots[d].assign(4, 0.0);
    for (int k = 1; k < n - 3; ++k)
    {
      s.Knots[d].push_back(k);
    }
    s.Knots[d].insert(s.Knots[d].end(), 4, n - 3);
  }
  for (int k = 0; k < n * n; ++k)
  {
    const int i = k % n;
    const int j = k / n;
    const double move = i > 0 && i < n - 1 && j > 0 && j < n - 1 ? 0.3 : 0.0;
    s.Points.push_back(Vec3(i + move * random.Uniform(-1, 1), j + move * random.Uniform(-1, 1),
      height * random.Uniform(-1, 1)));
  }
  return s;
}

TreeGoal Goal(double tolerance, SubdivisionMethod method = SubdivisionMethod::KdTree)
{
  TreeGoal goal;
  goal.Tolerance = tolerance;
  goal.Method = method;
  return goal;
}

void ExpectWithin(const Result& r)
{
  EXPECT_LE(r.Bound, 1.0);
  EXPECT_LE(r.Mesh, 1.0);
  EXPECT_LE(r.Surface, 1.0);
}

TEST(SurfaceTree, CellsAreWithinTheTolerance)
{
  Random random(12);
  const std::pair<const char*, nurbs::Surface> shapes[] = { { "sphere", Sphere(3.0) },
    { "torus", Torus(5.0, 2.0) }, { "cylinder", Cylinder(2.0, 9.0) }, { "cone", Cone(2.0, 3.0) },
    { "saddle", Quadric(0.4, -0.7) }, { "terrain", Terrain(random, 9, 1.0) } };
  for (const auto& shape : shapes)
  {
    for (double tolerance : { 0.03, 0.003 })
    {
      for (SubdivisionMethod method :
        { SubdivisionMethod::KdTree, SubdivisionMethod::Binary, SubdivisionMethod::QuadTree })
      {
        char name[64];
        std::snprintf(name, sizeof(name), "%s, %g, %s", shape.first, tolerance,
          method == SubdivisionMethod::KdTree       ? "kd"
            : method == SubdivisionMethod::QuadTree ? "quad"
                                                    : "binary");
        ExpectWithin(Measure(shape.second, DomainOf(shape.second.View()), Goal(tolerance, method),
          name, method == SubdivisionMethod::KdTree ? 120 : 40));
      }
    }
  }
}

TEST(SurfaceTree, WildSurfacesAreWithinTheTolerance)
{
  Random random(13);
  for (int k = 0; k < 20; ++k)
  {
    const nurbs::Surface s =
      WildSurface(random, 1 + k % 6, 1 + k / 4 % 6, k % 2 == 0, Vec3(0.0, 0.0, 0.0));
    char name[64];
    std::snprintf(name, sizeof(name), "wild %d", k);
    ExpectWithin(Measure(s, DomainOf(s.View()), Goal(0.02), name, 60, false));
  }
}

// A flat ring that turns back into a shallow cone at its outer or inner rim: neither facet rises
// where the rim leaves the chord, but beyond it there is nothing.
TEST(SurfaceTree, SharpRimsAreWithinTheTolerance)
{
  for (double inner : { 1.0, 3.0 })
  {
    const nurbs::Surface rim =
      Revolve(1, { 0, 0, 1, 2, 2 }, { { inner, 0 }, { 2, 0 }, { inner, -0.1 } }, { 1, 1, 1 });
    for (SubdivisionMethod method : { SubdivisionMethod::KdTree, SubdivisionMethod::Binary })
    {
      ExpectWithin(Measure(rim, { 0.0, 1.0, 0.0, 2.0 }, Goal(0.01, method),
        inner < 2.0 ? "sharp outer rim" : "sharp inner rim", 120, false));
    }
  }
}

TEST(SurfaceTree, FlatPlateIsOneCell)
{
  Random random(14);
  const nurbs::Surface plate = Terrain(random, 8, 0.0);
  const Result r = Measure(plate, DomainOf(plate.View()), Goal(0.001), "flat plate");
  ExpectWithin(r);
  EXPECT_EQ(r.Cells, 1u);
}

TEST(SurfaceTree, NumberOfCellsIsNearTheIdeal)
{
  // Parts of shapes where curvature is elliptic.
  const nurbs::Surface torus = Torus(5.0, 2.0);
  const nurbs::Surface sphere = Sphere(3.0);
  const nurbs::Surface bowl = Quadric(0.5, 0.8);
  for (double tolerance : { 0.01, 0.001, 0.0003 })
  {
    const Result t = Measure(torus, { 0.0, 1.0, 0.0, 0.2 }, Goal(tolerance), "torus outside");
    const Result s = Measure(sphere, { 0.0, 1.0, 0.35, 0.65 }, Goal(tolerance), "sphere's equator");
    const Result b = Measure(bowl, { 0.0, 1.0, 0.0, 1.0 }, Goal(0.1 * tolerance), "bowl");
    const Result whole = Measure(sphere, { 0.0, 1.0, 0.0, 1.0 }, Goal(tolerance), "sphere");
    EXPECT_LT(t.Cells, 1.35 * t.Ideal);
    EXPECT_LT(s.Cells, 1.35 * s.Ideal);
    EXPECT_LT(b.Cells, 1.35 * b.Ideal);
    // Meridians that the equator needs run on to the poles: pi / 2.
    EXPECT_LT(whole.Cells, 1.25 * 0.5 * M_PI * whole.Ideal);
  }
}

TEST(SurfaceTree, EstimatesAndRefinement)
{
  const nurbs::Surface torus = Torus(5.0, 2.0);
  TreeGoal goal = Goal(0.01);
  const Result certified = Measure(torus, { 0.0, 1.0, 0.0, 1.0 }, goal, "torus, certified");
  goal.Error = ErrorMode::Estimated;
  const Result estimated = Measure(torus, { 0.0, 1.0, 0.0, 1.0 }, goal, "torus, estimated");
  EXPECT_LE(estimated.Cells, certified.Cells);
  EXPECT_LT(estimated.Mesh, 1.05);
  EXPECT_LT(estimated.Surface, 1.05);

  const nurbs::SurfaceView view = torus.View();
  SurfaceBound bound(view, DomainOf(view));
  SurfaceTree tree;
  goal.Error = ErrorMode::Guaranteed;
  tree.Build(bound, DomainOf(view), goal, nurbs::SerialFor);
  const std::size_t before = tree.Leaves().size();
  tree.Refine(bound, goal, { 5, 0, 5, 17, int(before) - 1 });
  EXPECT_EQ(tree.Leaves().size(), before + 4);
  ExpectTiling(tree, DomainOf(view));
}

} // namespace
