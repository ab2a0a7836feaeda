// SPDX-License-Identifier: BSD-3-Clause
// Certified errors of triangles against distances found by dense sampling, in patches of triangles:
// beyond an inner edge it is the neighbour's facet that lies beneath the surface.
#include "nurbsPatchReference.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{

using namespace reference;
using nurbs::ErrorMode;
using nurbs::SurfaceBound;

constexpr double Infinity = std::numeric_limits<double>::infinity();

struct Tally
{
  int Triangles = 0;
  int Certified = 0; ///< Triangles times limits.
  int Violations = 0;
  int Uncounted = 0;       ///< Bounds beside triangles that failed, or look back.
  double Worst = 0.0;      ///< Distance from the triangle to the surface over the bound,
  double WorstMesh = 0.0;  ///< from the surface to the patch over the greatest bound round about.
  double WorstAlone = 0.0; ///< Both distances over the triangle's own bound.
  double WorstOwn = 0.0;   ///< Distance to the triangle alone over its bound.
  double Ratios = 0.0;     ///< Sum of bound over distance at the tightest limit that is certified.
  double Loosest = 0.0;
  int Tight = 0;
  double Mean() const { return this->Ratios / std::max(1, this->Tight); }
  void Print(const char* name) const
  {
    std::printf(
      "%-26s %5d triangles, %5d bounds: triangle to surface at most %.4f of the bound, surface to "
      "mesh %.4f of the bounds round about, both %.4f of the own one, to the own triangle %.3f; "
      "bound over distance %.2f on average, %.2f at most; %d "
      "violations; %d bounds do not count\n",
      name, this->Triangles, this->Certified, this->Worst, this->WorstMesh, this->WorstAlone,
      this->WorstOwn, this->Mean(), this->Loosest, this->Violations, this->Uncounted);
  }
};

/// The triangle and its neighbours' neighbours.
std::vector<int> Ring(const Patch& patch, int t)
{
  std::vector<int> ring{ t };
  for (std::size_t rings = 0, first = 0; rings < 2; ++rings)
  {
    const std::size_t last = ring.size();
    for (; first < last; ++first)
    {
      for (int k : patch.Neighbours[ring[first]])
      {
        if (k >= 0 && std::find(ring.begin(), ring.end(), k) == ring.end())
        {
          ring.push_back(k);
        }
      }
    }
  }
  return ring;
}

/// True if one looks against the surface at all its corners: such are never asked for
/// (FaceTessellator).
bool LooksBack(const Patch& patch, const std::vector<int>& ring)
{
  for (int k : ring)
  {
    const FacetBound::Triangle f = patch.Facet(k);
    const Vec3 n = (f.X[1] - f.X[0]).cross(f.X[2] - f.X[0]);
    if (n.dot(f.Normal[0]) < 0.0 && n.dot(f.Normal[1]) < 0.0 && n.dot(f.Normal[2]) < 0.0)
    {
      return true;
    }
  }
  return false;
}

/// Bounds of all inner triangles under limits from the distance itself to none. From the surface
/// to the patch they count where the triangles round about are certified, too; from the triangle
/// to the surface anywhere (`own`), or there.
void Check(
  const SurfaceBound& bound, const Patch& patch, Tally& tally, const char* what, bool own = true)
{
  const nurbs::SurfaceView& s = bound.View();
  FacetBound facets(bound, ErrorMode::Guaranteed);
  for (int t : patch.Inner)
  {
    const FacetBound::Triangle facet = patch.Facet(t);
    Distances d = Measure(s, patch, t, false);
    bool searched = false;
    const std::vector<int> ring = Ring(patch, t);
    const bool back = LooksBack(patch, ring);
    const double noise = 1e-13 * (bound.Size() + facet.X[0].norm());
    if (d.Both() < 100 * noise)
    {
      continue;
    }
    ++tally.Triangles;
    bool tight = true;
    for (double factor : { 0.7, 0.9, 0.97, 1.03, 1.1, 1.2, 1.4, 2.0, 4.0, Infinity })
    {
      const double limit = factor * d.Both();
      const double error = facets.Error(facet, limit);
      // Feet beyond an edge rely on the triangles there, all of which a mesh has certified.
      double all = error;
      for (std::size_t k = 1; k < ring.size() && all <= limit; ++k)
      {
        all = std::max(all, facets.Error(patch.Facet(ring[k]), limit));
      }
      if (error <= limit && tight)
      {
        tally.Ratios += error / d.Both();
        tally.Loosest = std::max(tally.Loosest, error / d.Both());
        ++tally.Tight;
        tight = false;
      }
      if (error > limit || back)
      {
        tally.Uncounted += error <= limit;
        continue;
      }
      if (d.Surface > 0.98 * error && !searched)
      {
        d = Measure(s, patch, t, true);
        searched = true;
      }
      const bool counts = all <= limit;
      tally.Certified += counts;
      tally.Uncounted += !counts;
      const double ratio = own || counts ? (d.Surface - noise) / error : 0.0;
      const double ratioMesh = counts ? (d.Mesh - noise) / all : 0.0;
      tally.Violations += ratio > 1.0 || ratioMesh > 1.0;
      if (std::max(ratio, ratioMesh) > std::max({ 1.0, tally.Worst, tally.WorstMesh }))
      {
        std::printf("  %s: limit %.6g, bound %.6g, of neighbours %.6g < surface to mesh %.6g, mesh "
                    "to surface %.6g (own %.6g)\n",
          what, limit, error, all, d.Mesh, d.Surface, d.Own);
      }
      tally.Worst = std::max(tally.Worst, ratio);
      tally.WorstMesh = std::max(tally.WorstMesh, ratioMesh);
      tally.WorstAlone = std::max(tally.WorstAlone, (d.Both() - noise) / error);
      tally.WorstOwn = std::max(tally.WorstOwn, d.Own / error);
    }
  }
}

void MakeGridOf(SurfaceBound& bound, int n)
{
  const ParameterBox domain = DomainOf(bound.View());
  bound.MakeGrid(Steps(domain.U0, domain.U1, n), Steps(domain.V0, domain.V1, n), nurbs::SerialFor);
}

nurbs::Surface RandomShape(Random& random, int k)
{
  switch (k % 6)
  {
    case 0:
      return Torus(5.0, 2.0);
    case 1:
      return Sphere(3.0);
    case 2:
      return Cylinder(2.0, 5.0);
    default:
      return WildSurface(
        random, random.Integer(1, 6), random.Integer(1, 6), k % 2 == 0, Vec3(0.0, 0.0, 0.0));
  }
}

/// Grids of cells of any size and shape at random places of many surfaces.
Tally CheckGrids(unsigned seed, int surfaces, double slender, double jitter, double gap,
  double largest, const char* what)
{
  Random random(seed);
  Tally tally;
  for (int k = 0; k < Rounds(surfaces); ++k)
  {
    const nurbs::Surface shape = RandomShape(random, k);
    const nurbs::SurfaceView view = shape.View();
    const ParameterBox domain = DomainOf(view);
    SurfaceBound bound(view, domain);
    MakeGridOf(bound, 30);
    for (int n = 0; n < 2; ++n)
    {
      double a = std::exp(random.Uniform(std::log(0.004), std::log(largest)));
      double b = a * std::exp(random.Uniform(-0.7, 0.7));
      (n == 0 ? a : b) *= slender;
      // Feet slide over several slivers.
      const int nu = slender < 1.0 && n == 0 ? 31 : 3;
      const int nv = slender < 1.0 && n == 1 ? 31 : 3;
      a = domain.A() * std::min(a, 1.0 / (nu + 2.0 * jitter));
      b = domain.B() * std::min(b, 1.0 / (nv + 2.0 * jitter));
      const double u = random.Uniform(domain.U0 + a * jitter, domain.U1 - (nu + jitter) * a);
      const double v = random.Uniform(domain.V0 + b * jitter, domain.V1 - (nv + jitter) * b);
      const double sag = (nurbs::Evaluate(view, u + 0.5 * a, v + 0.5 * b) -
        0.5 * (nurbs::Evaluate(view, u, v) + nurbs::Evaluate(view, u + a, v + b)))
                           .norm();
      const Patch patch = MakeGrid(view, random, u, v, a, b, jitter, gap * sag, nu, nv);
      if (bound.CrossesCrease(patch.Box()))
      {
        continue;
      }
      Check(bound, patch, tally, what);
    }
  }
  tally.Print(what);
  return tally;
}

TEST(FacetBound, HoldsForWellShapedTriangles)
{
  const Tally tally = CheckGrids(1, 36, 1.0, 0.2, 0.0, 0.08, "well shaped");
  EXPECT_EQ(tally.Violations, 0);
}

TEST(FacetBound, HoldsForSlivers)
{
  const Tally tally = CheckGrids(2, 18, 0.005, 0.2, 0.0, 0.08, "slivers");
  EXPECT_EQ(tally.Violations, 0);
}

TEST(FacetBound, HoldsForLargeTriangles)
{
  const Tally tally = CheckGrids(3, 36, 1.0, 0.3, 0.0, 0.25, "large and skew");
  EXPECT_EQ(tally.Violations, 0);
}

TEST(FacetBound, HoldsWithGaps)
{
  const Tally tally = CheckGrids(4, 30, 1.0, 0.2, 1.0, 0.08, "with gaps");
  EXPECT_EQ(tally.Violations, 0);
}

TEST(FacetBound, HoldsForCaps)
{
  Random random(5);
  Tally tally;
  for (int k = 0; k < Rounds(120); ++k)
  {
    const nurbs::Surface shape = RandomShape(random, k);
    const nurbs::SurfaceView view = shape.View();
    const ParameterBox domain = DomainOf(view);
    SurfaceBound bound(view, domain);
    MakeGridOf(bound, 30);
    const double share = std::pow(10.0, -random.Uniform(0.5, 9.0));
    const double a = domain.A() * std::exp(random.Uniform(std::log(0.004), std::log(0.15)));
    const double b = domain.B() * std::exp(random.Uniform(std::log(0.002), std::log(0.04)));
    const double u = random.Uniform(domain.U0 + a, domain.U1 - 2.0 * a);
    const double v = random.Uniform(domain.V0 + 10.0 * b, domain.V1 - 11.0 * b);
    if (!bound.CrossesCrease({ u - a, u + 2.0 * a, v - 10.0 * b, v + 11.0 * b }))
    {
      Check(bound, MakeCap(view, u, v, a, b, share), tally, "caps", false);
    }
  }
  tally.Print("caps");
  EXPECT_EQ(tally.Violations, 0);
}

TEST(FacetBound, HoldsAtPoles)
{
  Random random(6);
  Tally tally;
  const nurbs::Surface sphere = Sphere(3.0);
  const nurbs::SurfaceView view = sphere.View();
  SurfaceBound bound(view, DomainOf(view));
  MakeGridOf(bound, 60);
  for (int k = 0; k < Rounds(48); ++k)
  {
    const double b = std::exp(random.Uniform(std::log(0.005), std::log(0.1)));
    Check(bound, MakePole(view, random, 1.0 - b, random.Integer(3, 8), k % 2 == 0 ? 0.0 : 0.2),
      tally, "pole");
  }
  tally.Print("pole of a sphere");
  EXPECT_EQ(tally.Violations, 0);
}

/// Two patches of degree 2 joined along u = 1 with a kink, that of degree 1 with many, or both.
nurbs::Surface Kinked(Random& random, int k)
{
  nurbs::Surface s;
  const int p = k % 3 == 0 ? 1 : 2;
  s.Degree[0] = p;
  s.Degree[1] = k % 2 == 0 ? 3 : 1;
  s.Count[0] = p == 1 ? 6 : 5;
  s.Count[1] = 5;
  s.Knots[0] = p == 1 ? std::vector<double>{ 0, 0, 0.3, 0.7, 1.1, 1.3, 2, 2 }
                      : std::vector<double>{ 0, 0, 0, 1, 1, 2, 2, 2 };
  s.Knots[1] = s.Degree[1] == 3 ? std::vector<double>{ 0, 0, 0, 0, 0.9, 2, 2, 2, 2 }
                                : std::vector<double>{ 0, 0, 0.4, 1, 1.5, 2, 2 };
  for (int j = 0; j < s.Count[1]; ++j)
  {
    for (int i = 0; i < s.Count[0]; ++i)
    {
      s.Points.push_back(Vec3(i, j, 0.4 * random.Uniform(-1, 1)));
    }
  }
  return s;
}

TEST(FacetBound, HoldsAcrossCreases)
{
  Random random(7);
  Tally tally;
  for (int k = 0; k < Rounds(48); ++k)
  {
    const nurbs::Surface shape = Kinked(random, k);
    const nurbs::SurfaceView view = shape.View();
    const ParameterBox domain = DomainOf(view);
    SurfaceBound bound(view, domain);
    MakeGridOf(bound, 16);
    const double a = std::exp(random.Uniform(std::log(0.05), std::log(0.5)));
    const double b = a * random.Uniform(0.5, 1.3);
    const double u = random.Uniform(0.2 * a, 2.0 - 3.2 * a);
    const double v = random.Uniform(0.2 * b, 2.0 - 3.2 * b);
    Check(bound, MakeGrid(view, random, u, v, a, b, 0.2), tally, "creases");
  }
  tally.Print("across creases");
  EXPECT_EQ(tally.Violations, 0);
}

// A ring that turns back into a shallow cone at its rim, flat enough for slopes to say nothing.
TEST(FacetBound, HoldsForEdgesOnCreases)
{
  Random random(8);
  Tally tally;
  for (int k = 0; k < Rounds(10); ++k)
  {
    const double inner = k % 2 == 0 ? 1.0 : 3.0;
    const double drop = -random.Uniform(0.02, 0.6);
    const nurbs::Surface rim =
      Revolve(1, { 0, 0, 1, 2, 2 }, { { inner, 0 }, { 2, 0 }, { inner, drop } }, { 1, 1, 1 });
    const nurbs::SurfaceView view = rim.View();
    SurfaceBound bound(view, DomainOf(view));
    MakeGridOf(bound, 32);
    const double a = std::exp(random.Uniform(std::log(0.004), std::log(0.08)));
    const double b = k % 3 == 0 ? 0.25 : 0.0625;
    Check(
      bound, MakeGrid(view, random, random.Uniform(0.0, 0.7), 1.0 - b, a, b, 0.0), tally, "rims");
    Check(bound, MakeGrid(view, random, random.Uniform(0.0, 0.7), 1.0 - 2 * b, a, b, 0.0), tally,
      "rims");
  }
  tally.Print("edges on creases");
  EXPECT_EQ(tally.Violations, 0);
}

/// Shapes whose curvature varies slowly, the size of cells and the rows to look at. Where the
/// iso-lines curve inside the surface (a torus from top to inside) what feet slide beyond edges
/// has its price.
struct SmoothShape
{
  const char* Name;
  nurbs::Surface Shape;
  double StepU;
  double StepV;
  double FirstV;
  double LastV;
  double Limit; ///< Over the distance; all triangles have a bound beneath it.
};

std::vector<SmoothShape> SmoothShapes()
{
  nurbs::Surface dune;
  dune.Degree[0] = dune.Degree[1] = 3;
  dune.Count[0] = dune.Count[1] = 4;
  dune.Knots[0] = dune.Knots[1] = { 0, 0, 0, 0, 1, 1, 1, 1 };
  for (int k = 0; k < 16; ++k)
  {
    const double x = k % 4;
    const double y = k / 4;
    dune.Points.push_back(Vec3(x, y, 0.1 * x * x + 0.15 * y * y));
  }
  const nurbs::Surface torus = Torus(5.0, 2.0);
  return { { "cylinder", Cylinder(2.0, 5.0), 0.25 / 20, 1.0 / 3, 0.0, 0.0, 1.15 },
    { "sphere", Sphere(3.0), 0.25 / 20, 0.5 / 20, 0.35, 0.55, 1.15 },
    { "torus outside", torus, 0.25 / 20, 0.25 / 12, 0.0, 0.08, 1.15 },
    { "torus inside", torus, 0.25 / 20, 0.25 / 12, 0.25, 0.5, 1.4 },
    { "dune", dune, 1.0 / 16, 1.0 / 16, 0.0, 0.7, 1.15 } };
}

/// Bounds and estimates over distances.
struct Ratios
{
  double Cells = 0.0; ///< Without a limit, when the first, cheapest bound does: cells of the grid,
  double Skew = 0.0;  ///< triangles across it.
  double Near = 0.0;  ///< With one near the distance.
  int Failed = 0;     ///< Bounds that do not meet it.
  double Least = 1e300;
  double Most = 0.0; ///< Estimates.
};

Ratios MeasureRatios(const SmoothShape& smooth, double scale)
{
  const nurbs::SurfaceView view = smooth.Shape.View();
  const ParameterBox domain = DomainOf(view);
  SurfaceBound bound(view, domain);
  const double a = smooth.StepU * scale;
  const double b = smooth.StepV * (smooth.StepV > 0.3 ? 1.0 : scale);
  const int nu = int(std::lround(domain.A() / a));
  const int nv = int(std::lround(domain.B() / b));
  bound.MakeGrid(
    Steps(domain.U0, domain.U1, nu), Steps(domain.V0, domain.V1, nv), nurbs::SerialFor);
  FacetBound facets(bound, ErrorMode::Guaranteed);
  FacetBound samples(bound, ErrorMode::Estimated);
  Random random(9);
  Ratios out;
  for (int k = 0; k < Rounds(24); ++k)
  {
    const bool skew = k % 2 == 1;
    const double aside = skew && nv > 5 ? 0.3 : 0.0;
    const int row = random.Integer(int(std::ceil(smooth.FirstV / b - 1e-9)), int(smooth.LastV / b));
    const double u = domain.U0 + a * (random.Integer(1, nu - 5) + aside);
    const double v = domain.V0 + b * (row + aside);
    const Patch patch = MakeGrid(view, random, u, v, a, b, skew && nv > 5 ? 0.2 : 0.0);
    for (int t : patch.Inner)
    {
      FacetBound::Triangle facet = patch.Facet(t);
      const double distance = Measure(view, patch, t, false).Both();
      const double none = facets.Error(facet, Infinity) / distance;
      (skew ? out.Skew : out.Cells) = std::max(skew ? out.Skew : out.Cells, none);
      const double error = facets.Error(facet, smooth.Limit * distance) / distance;
      out.Near = std::max(out.Near, error);
      out.Failed += error > smooth.Limit;
      const double estimate = samples.Error(facet, Infinity) / distance;
      out.Least = std::min(out.Least, estimate);
      out.Most = std::max(out.Most, estimate);
      facet.Boundary[0] = facet.Boundary[1] = facet.Boundary[2] = true;
      EXPECT_LE(facets.Error(facet, Infinity), none * distance * (1.0 + 1e-12));
    }
  }
  std::printf("%-13s steps %.4f: bound over distance without limit: cells %.3f, skew %.3f; under "
              "%.2f of it: %.3f, %d fail; estimates %.3f to %.3f of it\n",
    smooth.Name, a, out.Cells, out.Skew, smooth.Limit, out.Near, out.Failed, out.Least, out.Most);
  return out;
}

TEST(FacetBound, IsTightOnSmoothShapes)
{
  for (const SmoothShape& smooth : SmoothShapes())
  {
    const Ratios coarse = MeasureRatios(smooth, 1.0);
    const Ratios fine = MeasureRatios(smooth, 0.5);
    EXPECT_LT(fine.Cells, 1.3);
    EXPECT_EQ(fine.Failed, 0);
    EXPECT_GT(fine.Least, 0.94);
    EXPECT_LT(fine.Most, smooth.Limit - 0.05);
    // What is not exact falls with the cells' size.
    EXPECT_LT(fine.Cells - 1.0, 0.65 * (coarse.Cells - 1.0) + 0.02);
    EXPECT_LT(fine.Most - 1.0, 0.65 * (coarse.Most - 1.0) + 0.02);
  }
}

} // namespace
