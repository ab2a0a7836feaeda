// SPDX-License-Identifier: BSD-3-Clause
// Silhouettes of analytic shapes against their closed forms, and of other ones against dense grids of
// signs.
#include "Shapes.h"
#include "nurbsSilhouetteReference.h"

#include <chrono>

using namespace reference;

namespace
{

const double Pi = std::acos(-1.0);

// A model of Shapes.h that owns its arrays.
struct Shape
{
  nurbs::ModelBuilder Builder;
  nurbs::AssembledModel Assembled;

  template <typename Add>
  explicit Shape(const Add& add)
  {
    add(this->Builder);
    this->Assembled = nurbs::AssembleModel(this->Builder.Arrays());
  }
  const Model& Get() const { return this->Assembled.Model; }
};

int Dump(const char* name, const Silhouettes& s, const Measure& m, double sec = 0)
{
  std::printf(
    "%s: lines %zu chains %d points %zu length %.9g cos %.2g off %.2g chord %.3g wrong %d", name,
    s.Lines.size(), int(s.Chains[0]), m.Points, m.Length, m.Cosine, m.Offset, m.Chord, m.WrongSide);
  for (auto& f : s.Faces)
    if (f.Status != nurbs::SilhouetteStatus::Ok)
    {
      std::printf(" [%s]", f.Message.c_str());
      break;
    }
  std::printf(" %.4f s\n", sec);
  return 0;
}

Silhouettes Timed(const char* name, const Model& m, const Viewer& v, double p)
{
  auto t0 = std::chrono::steady_clock::now();
  Silhouettes s = Make(m, v, p);
  double sec = std::chrono::duration<double>(std::chrono::steady_clock::now() - t0).count();
  Dump(name, s, MeasureLines(m, s, v), sec);
  return s;
}

TEST(Explore, All)
{
  Shape sphere([](nurbs::ModelBuilder& b) { nurbs::AddSphere(b, 1.0); });
  for (auto v : { Direction(0, 0, 1), Direction(1, 0, 0), Direction(0, 1, 0), Direction(1, 1, 0),
         Direction(1, 2, 3), Direction(1, 2, 0), Direction(0, 1, 1), Eye(0, 0, 3), Eye(3, 0, 0),
         Eye(1, 2, 3), Eye(0.1, 0.2, 0.3), Eye(1, 0, 0), Eye(0.6, 0.8, 0) })
  {
    std::printf("%d %g %g %g ", v.Perspective, v.Place[0], v.Place[1], v.Place[2]);
    Timed("sphere", sphere.Get(), v, 1e-4);
  }
  Shape torus([](nurbs::ModelBuilder& b) { nurbs::AddTorus(b, 1.0, 0.3); });
  for (auto v : { Direction(0, 0, 1), Direction(1, 0, 0), Direction(1, 1, 0), Direction(1, 2, 3),
         Direction(1, 2, 0), Direction(0, 1, 1), Eye(0, 0, 3), Eye(3, 0, 0), Eye(1, 2, 3) })
  {
    std::printf("%d %g %g %g ", v.Perspective, v.Place[0], v.Place[1], v.Place[2]);
    auto s = Timed("torus", torus.Get(), v, 1e-4);
    auto g = CheckGrid(torus.Get(), 0, s, v);
    std::printf("  grid %d missed %d\n", g.Changes, g.Missed);
  }
  for (double p = 1e-2; p > 0.5e-8; p /= 10)
  {
    Timed("torus", torus.Get(), Direction(1, 2, 3), p);
  }
  for (bool cone : { false, true })
  {
    Shape c([&](nurbs::ModelBuilder& b) {
      cone ? nurbs::AddCone(b, 1.0, 2.0, true) : nurbs::AddCylinder(b, 1.0, 2.0, true);
    });
    for (auto v : { Direction(0, 0, 1), Direction(1, 0, 0), Direction(0, 1, 0), Direction(1, 1, 0),
           Direction(1, 2, 3), Direction(1, 2, 0), Direction(0, 1, 1), Eye(0, 0, 3), Eye(3, 0, 0),
           Eye(1, 2, 3) })
    {
      std::printf("%d %g %g %g ", v.Perspective, v.Place[0], v.Place[1], v.Place[2]);
      auto s = Timed(cone ? "cone" : "cylinder", c.Get(), v, 1e-4);
      int kinds[4] = {};
      for (auto& l : s.Lines)
        ++kinds[int(l.Kind)];
      std::printf("   kinds %d %d %d %d\n", kinds[0], kinds[1], kinds[2], kinds[3]);
    }
  }
  Shape teapot([](nurbs::ModelBuilder& b) { nurbs::AddTeapot(b); });
  for (auto v : { Direction(0, 0, 1), Direction(1, 0, 0), Direction(0, 1, 0), Direction(1, 2, 3),
         Eye(10, 20, 30) })
  {
    std::printf("%d %g %g %g ", v.Perspective, v.Place[0], v.Place[1], v.Place[2]);
    auto s = Timed("teapot", teapot.Get(), v, 1e-4);
    int c = 0, m = 0;
    for (int f = 0; f < 32; ++f)
    {
      auto g = CheckGrid(teapot.Get(), f, s, v, 100);
      c += g.Changes;
      m += g.Missed;
    }
    std::printf("  grid %d missed %d\n", c, m);
  }
  std::mt19937 random(7);
  std::uniform_real_distribution<double> real(-1, 1);
  for (int k = 0; k < 40; ++k)
  {
    auto s = BezierSurface(1 + k % 5, 1 + k / 5 % 5, [&](double u, double v) {
      return Vec3(u + 0.2 * real(random), v + 0.2 * real(random), 0.5 * real(random));
    });
    if (k % 2)
      for (auto& p : s.Points)
      {
        (void)p;
        s.Weights.push_back(std::exp(real(random)));
      }
    Model m = OneFace(s);
    Viewer v = k % 3 == 2 ? Eye(real(random), real(random), 1 + real(random))
                          : Direction(real(random), real(random), 1);
    auto r = Timed("random", m, v, 1e-4);
    auto g = CheckGrid(m, 0, r, v);
    std::printf("  deg %d %d grid %d missed %d regions %d\n", s.Degree[0], s.Degree[1], g.Changes,
      g.Missed, g.Regions);
  }
}

} // namespace
