// SPDX-License-Identifier: BSD-3-Clause
/// @file nurbsBoundReference.h
/// @brief What the tests of bounds compare with: wild random surfaces, distances by brute force.
#pragma once

#include "../Core/nurbsReference.h"
#include "SurfaceBound.h"

#include <cstdio>
#include <functional>

namespace reference
{

using nurbs::ParameterBox;
using nurbs::Vec2;
using nurbs::Vec3;

/// `n`, or a few under a sanitizer, which takes fifty times as long and looks for other mistakes.
inline int Rounds(int n)
{
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
  return std::max(1, n / 8);
#endif
#endif
  return n;
}

/// `Surface` of Random with weights of 0.2 to 5 and all points moved.
inline nurbs::Surface WildSurface(Random& random, int p, int q, bool rational, const Vec3& origin)
{
  nurbs::Surface s = random.Surface(p, q, random.Integer(0, 3) > 0, rational, false);
  for (double& w : s.Weights)
  {
    w = std::exp(random.Uniform(std::log(0.2), std::log(5.0)));
  }
  for (Vec3& x : s.Points)
  {
    x += origin;
  }
  return s;
}

inline ParameterBox DomainOf(const nurbs::SurfaceView& s)
{
  const nurbs::Interval u = s.Domain(0);
  const nurbs::Interval v = s.Domain(1);
  return { u.Min, u.Max, v.Min, v.Max };
}

inline nurbs::Surface Moved(nurbs::Surface s, const Vec3& by)
{
  for (Vec3& x : s.Points)
  {
    x += by;
  }
  return s;
}

/// The side of a torus or cylinder; u goes round, v along.
inline nurbs::Surface Cylinder(double radius, double height)
{
  return Revolve(1, { 0, 0, 1, 1 }, { { radius, 0 }, { radius, height } }, { 1, 1 });
}

/// `n` equal steps from a to b, both ends included.
inline std::vector<double> Steps(double a, double b, int n)
{
  std::vector<double> out;
  for (int i = 0; i <= n; ++i)
  {
    out.push_back(i == n ? b : a + (b - a) * i / n);
  }
  return out;
}

/// The point of a triangle next to p: a corner, a point of an edge or of the inside, whichever of
/// them is nearest.
inline Vec3 NearestOfTriangle(const Vec3& p, const Vec3* x)
{
  Vec3 best = x[0];
  for (int i = 0; i < 3; ++i)
  {
    const Vec3 e = x[(i + 1) % 3] - x[i];
    const double ee = e.squaredNorm();
    const double t = ee > 0.0 ? std::min(1.0, std::max(0.0, (p - x[i]).dot(e) / ee)) : 0.0;
    const Vec3 q = x[i] + t * e;
    best = (p - q).squaredNorm() < (p - best).squaredNorm() ? q : best;
  }
  const Vec3 n = (x[1] - x[0]).cross(x[2] - x[0]);
  const double nn = n.squaredNorm();
  if (nn > 0.0)
  {
    const Vec3 q = p - n * (n.dot(p - x[0]) / nn);
    bool inside = true;
    for (int i = 0; i < 3; ++i)
    {
      inside = inside && n.dot((x[(i + 1) % 3] - x[i]).cross(q - x[i])) >= 0.0;
    }
    best = inside && (p - q).squaredNorm() < (p - best).squaredNorm() ? q : best;
  }
  return best;
}

inline double TriangleDistance(const Vec3& p, const Vec3* x)
{
  return (p - NearestOfTriangle(p, x)).norm();
}

/// Calls use(b0, b1, b2) for the barycentric grid of n steps along a side.
template <typename F>
void Barycentric(int n, F&& use)
{
  for (int j = 0; j <= n; ++j)
  {
    for (int i = 0; i + j <= n; ++i)
    {
      const double b1 = double(i) / n;
      const double b2 = double(j) / n;
      use(double(n - i - j) / n, b1, b2);
    }
  }
}

/// The same by search: grids that narrow down on the nearest of their points.
inline double SearchDistance(const nurbs::SurfaceView& s, const Vec3& x, ParameterBox box)
{
  constexpr int N = 24;
  const ParameterBox all = box;
  double best = 1e300;
  for (int level = 0; level < 7; ++level)
  {
    Vec2 at(0.0, 0.0);
    double least = 1e300;
    for (int j = 0; j <= N; ++j)
    {
      for (int i = 0; i <= N; ++i)
      {
        const Vec2 p(box.U0 + box.A() * i / N, box.V0 + box.B() * j / N);
        const double there = (nurbs::Evaluate(s, p[0], p[1]) - x).norm();
        if (there < least)
        {
          least = there;
          at = p;
        }
      }
    }
    best = std::min(best, least);
    const double a = 3.0 * box.A() / N;
    const double b = 3.0 * box.B() / N;
    box = { std::max(all.U0, at[0] - a), std::min(all.U1, at[0] + a), std::max(all.V0, at[1] - b),
      std::min(all.V1, at[1] + b) };
  }
  return best;
}

/// The point of the surface found next to x by Gauss and Newton from `uv`, within `box`: an upper
/// bound of the distance.
inline double SurfaceDistance(
  const nurbs::SurfaceView& s, const Vec3& x, Vec2 uv, const ParameterBox& box)
{
  double best = (nurbs::Evaluate(s, uv[0], uv[1]) - x).norm();
  double step = 1.0;
  for (int k = 0; k < 25 && step > 1e-6; ++k)
  {
    const nurbs::SurfaceDerivatives d = nurbs::EvaluateDerivatives(s, uv[0], uv[1], 1);
    const Vec3 r = x - d.S;
    Eigen::Matrix2d m;
    m << d.Su.dot(d.Su), d.Su.dot(d.Sv), d.Su.dot(d.Sv), d.Sv.dot(d.Sv);
    m += 1e-12 * m.trace() * Eigen::Matrix2d::Identity();
    const Vec2 move = m.inverse() * Vec2(d.Su.dot(r), d.Sv.dot(r));
    const Vec2 to(std::min(box.U1, std::max(box.U0, uv[0] + step * move[0])),
      std::min(box.V1, std::max(box.V0, uv[1] + step * move[1])));
    const double there = (nurbs::Evaluate(s, to[0], to[1]) - x).norm();
    if (there >= best)
    {
      step *= 0.5;
      continue;
    }
    const bool done = best - there < 1e-7 * best;
    best = there;
    uv = to;
    if (done)
    {
      break;
    }
  }
  return best;
}

/// z = c x^2 + d y^2 over [0, 1]^2.
inline nurbs::Surface Quadric(double c, double d)
{
  nurbs::Surface s;
  s.Degree[0] = s.Degree[1] = 2;
  s.Count[0] = s.Count[1] = 3;
  s.Knots[0] = s.Knots[1] = { 0, 0, 0, 1, 1, 1 };
  for (int k = 0; k < 9; ++k)
  {
    const int i = k % 3;
    const int j = k / 3;
    s.Points.push_back(Vec3(0.5 * i, 0.5 * j, (i == 2 ? c : 0.0) + (j == 2 ? d : 0.0)));
  }
  return s;
}

} // namespace reference
