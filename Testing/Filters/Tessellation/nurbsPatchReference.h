// SPDX-License-Identifier: BSD-3-Clause
/// @file nurbsPatchReference.h
/// @brief Patches of triangles over surfaces, and their distances from them by brute force.
#pragma once

#include "FacetBound.h"
#include "nurbsBoundReference.h"

#include <map>

namespace reference
{

using nurbs::FacetBound;

struct Patch
{
  std::vector<Vec2> UV;
  std::vector<Vec3> X;
  std::vector<Vec3> Normal;
  struct Triangle
  {
    int Corner[3];
    int Pole = -1; ///< Corner that is one; its side runs along u.
  };
  std::vector<Triangle> Triangles;
  double Gap = 0.0;
  std::vector<int> Inner; ///< Triangles with three neighbours.
  std::vector<std::array<int, 3>> Neighbours;

  int Add(const nurbs::SurfaceView& s, const Vec2& uv)
  {
    this->UV.push_back(uv);
    this->X.push_back(nurbs::Evaluate(s, uv[0], uv[1]));
    this->Normal.push_back(nurbs::Normal(s, uv[0], uv[1]));
    return int(this->UV.size()) - 1;
  }

  void Link()
  {
    std::map<std::pair<int, int>, int> side;
    for (std::size_t t = 0; t < this->Triangles.size(); ++t)
    {
      const int* c = this->Triangles[t].Corner;
      for (int i = 0; i < 3; ++i)
      {
        side[{ c[i], c[(i + 1) % 3] }] = int(t);
      }
    }
    this->Neighbours.assign(this->Triangles.size(), { -1, -1, -1 });
    for (std::size_t t = 0; t < this->Triangles.size(); ++t)
    {
      const int* c = this->Triangles[t].Corner;
      bool inner = true;
      for (int i = 0; i < 3; ++i)
      {
        const auto found = side.find({ c[(i + 1) % 3], c[i] });
        inner = inner && found != side.end();
        this->Neighbours[t][i] = found != side.end() ? found->second : -1;
      }
      if (inner)
      {
        this->Inner.push_back(int(t));
      }
    }
  }

  ParameterBox Box() const
  {
    Eigen::AlignedBox2d box;
    for (const Vec2& p : this->UV)
    {
      box.extend(p);
    }
    return { box.min()[0], box.max()[0], box.min()[1], box.max()[1] };
  }

  void Corners(int t, Vec3* x) const
  {
    for (int i = 0; i < 3; ++i)
    {
      x[i] = this->X[this->Triangles[t].Corner[i]];
    }
  }

  FacetBound::Triangle Facet(int t) const
  {
    FacetBound::Triangle out;
    for (int i = 0; i < 3; ++i)
    {
      const int c = this->Triangles[t].Corner[i];
      out.X[i] = this->X[c];
      out.UV[i] = this->UV[c];
      out.Normal[i] = this->Normal[c];
      out.Boundary[i] = false;
    }
    out.Gap = this->Gap;
    out.Pole = this->Triangles[t].Pole;
    out.PoleDirection = 0;
    return out;
  }
};

/// nu x nv cells of a x b at (u, v), vertices moved by up to `jitter` of a cell. Those in the
/// middle are checked.
inline Patch MakeGrid(const nurbs::SurfaceView& s, Random& random, double u, double v, double a,
  double b, double jitter, double gap = 0.0, int nu = 3, int nv = 3)
{
  Patch patch;
  for (int j = 0; j <= nv; ++j)
  {
    for (int i = 0; i <= nu; ++i)
    {
      patch.Add(s,
        Vec2(u + a * (i + jitter * random.Uniform(-1, 1)),
          v + b * (j + jitter * random.Uniform(-1, 1))));
      if (gap > 0.0)
      {
        const Vec3 d(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1));
        patch.X.back() += gap * random.Uniform(0, 1) * d.normalized();
      }
    }
  }
  patch.Gap = gap;
  for (int j = 0; j < nv; ++j)
  {
    for (int i = 0; i < nu; ++i)
    {
      const int k = i + j * (nu + 1);
      if (random.Integer(0, 1) == 0)
      {
        patch.Triangles.push_back({ { k, k + 1, k + nu + 2 } });
        patch.Triangles.push_back({ { k, k + nu + 2, k + nu + 1 } });
      }
      else
      {
        patch.Triangles.push_back({ { k, k + 1, k + nu + 1 } });
        patch.Triangles.push_back({ { k + 1, k + nu + 2, k + nu + 1 } });
      }
    }
  }
  patch.Link();
  const auto outside = [&](int t) {
    return std::abs(t / 2 % nu - nu / 2) > 1 || std::abs(t / 2 / nu - nv / 2) > 1;
  };
  patch.Inner.erase(
    std::remove_if(patch.Inner.begin(), patch.Inner.end(), outside), patch.Inner.end());
  return patch;
}

/// A cap on the iso-line v, of height `share` of b over its base a, amid many cells of a x b.
inline Patch MakeCap(
  const nurbs::SurfaceView& s, double u, double v, double a, double b, double share)
{
  Patch patch;
  constexpr int Columns = 3;
  constexpr int Rows = 21;
  constexpr int Cell = 1 + Rows / 2 * (Columns + 1);
  for (int j = 0; j <= Rows; ++j)
  {
    for (int i = 0; i <= Columns; ++i)
    {
      patch.Add(s, Vec2(u + a * (i - 1), v + b * (j - Rows / 2)));
    }
  }
  const int middle = patch.Add(s, Vec2(u + 0.45 * a, v + share * b));
  const int above = Cell + Columns + 1;
  patch.Triangles = { { { Cell, Cell + 1, middle } }, { { Cell, middle, above } },
    { { middle, Cell + 1, above + 1 } }, { { middle, above + 1, above } } };
  for (int k = 0; k < Rows * (Columns + 1); ++k)
  {
    if (k != Cell && k % (Columns + 1) < Columns)
    {
      patch.Triangles.push_back({ { k, k + 1, k + Columns + 2 } });
      patch.Triangles.push_back({ { k, k + Columns + 2, k + Columns + 1 } });
    }
  }
  patch.Link();
  patch.Inner = { 0, 1, 2, 3 };
  return patch;
}

/// The fan of `n` triangles round the north pole of a sphere from v on, and a row beneath it.
inline Patch MakePole(const nurbs::SurfaceView& s, Random& random, double v, int n, double jitter)
{
  const ParameterBox domain = DomainOf(s);
  Patch patch;
  const double a = 0.3 * domain.A() / n;
  const double u = random.Uniform(domain.U0, domain.U1 - a * n);
  const double b = domain.V1 - v;
  for (int row = 0; row < 2; ++row)
  {
    for (int i = 0; i <= n; ++i)
    {
      const double move = jitter * random.Uniform(-1, 1);
      patch.Add(s, Vec2(u + a * (i + jitter * random.Uniform(-1, 1)), v - b * (1 - row + move)));
    }
  }
  // One vertex in space; each triangle has its own parameters there.
  const int pole = patch.Add(s, Vec2(u + random.Uniform(0, 1) * a * n, domain.V1));
  for (int i = 0; i < n; ++i)
  {
    patch.Triangles.push_back({ { i, i + 1, n + 2 + i } });
    patch.Triangles.push_back({ { i, n + 2 + i, n + 1 + i } });
    Patch::Triangle fan{ { n + 1 + i, n + 2 + i, pole }, 2 };
    if (i % 3 == 1)
    {
      fan = { { pole, n + 1 + i, n + 2 + i }, 0 };
    }
    patch.Triangles.push_back(fan);
  }
  patch.Link();
  return patch;
}

struct Distances
{
  double Own = 0.0;     ///< From the surface over the triangle to the triangle,
  double Mesh = 0.0;    ///< to the patch.
  double Surface = 0.0; ///< From the triangle to the surface.
  double Both() const { return std::max(this->Mesh, this->Surface); }
};

/// The distance from the surface over the patch and a little more, found by search from many
/// places.
inline double SearchRoundAbout(const nurbs::SurfaceView& s, const Patch& patch, const Vec3& x)
{
  const ParameterBox box = patch.Box();
  const nurbs::Interval u = s.Domain(0);
  const nurbs::Interval v = s.Domain(1);
  double least = 1e300;
  constexpr int Pieces = 3;
  for (int i = -1; i <= Pieces; ++i)
  {
    for (int j = -1; j <= Pieces; ++j)
    {
      const double u0 = box.U0 + box.A() * i / Pieces;
      const double v0 = box.V0 + box.B() * j / Pieces;
      least = std::min(least,
        SearchDistance(s, x,
          { u.Clamp(u0), u.Clamp(u0 + box.A() / Pieces), v.Clamp(v0),
            v.Clamp(v0 + box.B() / Pieces) }));
    }
  }
  return least;
}

/// By dense sampling. Without `search` the distance to the surface may come out too large.
inline Distances Measure(const nurbs::SurfaceView& s, const Patch& patch, int t, bool search)
{
  Distances out;
  std::vector<std::array<Vec3, 3>> x(1);
  patch.Corners(t, x[0].data());
  for (std::size_t k = 0; k < patch.Triangles.size(); ++k)
  {
    x.emplace_back();
    patch.Corners(int(k), x.back().data());
  }
  const Patch::Triangle& triangle = patch.Triangles[t];
  std::vector<std::array<Vec2, 3>> pieces;
  std::array<Vec2, 3> uv;
  for (int i = 0; i < 3; ++i)
  {
    uv[i] = patch.UV[triangle.Corner[i]];
  }
  if (triangle.Pole < 0)
  {
    pieces.push_back(uv);
  }
  else
  {
    const Vec2 a = uv[(triangle.Pole + 1) % 3];
    const Vec2 b = uv[(triangle.Pole + 2) % 3];
    const double end = uv[triangle.Pole][1];
    pieces.push_back({ Vec2(a[0], end), a, b });
    pieces.push_back({ Vec2(a[0], end), b, Vec2(b[0], end) });
  }
  for (const auto& piece : pieces)
  {
    Barycentric(20, [&](double b0, double b1, double b2) {
      const Vec2 p = b0 * piece[0] + b1 * piece[1] + b2 * piece[2];
      const Vec3 q = nurbs::Evaluate(s, p[0], p[1]);
      const double own = TriangleDistance(q, x[0].data());
      out.Own = std::max(out.Own, own);
      if (own > out.Mesh)
      {
        double least = own;
        for (std::size_t i = 1; i < x.size() && least > out.Mesh; ++i)
        {
          least = std::min(least, TriangleDistance(q, x[i].data()));
        }
        out.Mesh = std::max(out.Mesh, least);
      }
    });
  }
  std::vector<std::pair<double, Vec3>> found;
  Barycentric(9, [&](double b0, double b1, double b2) {
    const Vec3 q = b0 * x[0][0] + b1 * x[0][1] + b2 * x[0][2];
    double least = 1e300;
    for (int k = 0; k < (triangle.Pole < 0 ? 1 : 5) && least > out.Surface; ++k)
    {
      Vec2 p = b0 * uv[0] + b1 * uv[1] + b2 * uv[2];
      if (triangle.Pole >= 0)
      {
        // Any u: in steps over the base.
        p[0] = patch.UV[triangle.Corner[(triangle.Pole + 1) % 3]][0] * (1 - 0.25 * k) +
          patch.UV[triangle.Corner[(triangle.Pole + 2) % 3]][0] * 0.25 * k;
      }
      const double there = (nurbs::Evaluate(s, p[0], p[1]) - q).norm();
      least = std::min(least, there <= out.Surface ? there : SurfaceDistance(s, q, p, DomainOf(s)));
    }
    found.emplace_back(least, q);
    out.Surface = std::max(out.Surface, search ? 0.0 : least);
  });
  // The farthest first; search only brings them nearer.
  const auto farther = [](const auto& a, const auto& b) { return a.first > b.first; };
  std::sort(found.begin(), found.end(), farther);
  for (std::size_t k = 0; search && k < found.size() && found[k].first > out.Surface; ++k)
  {
    const double least = std::min(found[k].first, SearchRoundAbout(s, patch, found[k].second));
    out.Surface = std::max(out.Surface, least);
  }
  return out;
}

} // namespace reference
