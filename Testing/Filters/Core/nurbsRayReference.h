// SPDX-License-Identifier: BSD-3-Clause
/// @file nurbsRayReference.h
/// @brief Shapes, rays and plain ways to intersect them, for the tests of ray casting.
#pragma once

#include "Model.h"
#include "RayCaster.h"
#include "nurbsReference.h"

#include <gtest/gtest.h>

namespace reference
{

using nurbs::BezierPatch;
using nurbs::Box3;
using nurbs::Face;
using nurbs::Interval;
using nurbs::Model;
using nurbs::Ray;
using nurbs::RayCaster;
using nurbs::RayHit;
using nurbs::Surface;
using nurbs::SurfaceDerivatives;
using nurbs::SurfaceView;
using nurbs::Vec3;
using nurbs::Vec4;

constexpr double Pi = 3.14159265358979323846;

/// A model of untrimmed faces that keeps its surfaces.
struct Shape
{
  std::vector<Surface> Surfaces;
  Model Content;

  explicit Shape(std::vector<Surface> surfaces)
    : Surfaces(std::move(surfaces))
  {
    for (const Surface& surface : this->Surfaces)
    {
      this->Content.Faces.emplace_back();
      this->Content.Faces.back().Geometry = surface.View();
    }
  }
};

inline Vec3 RandomDirection(Random& random)
{
  Vec3 d;
  do
  {
    d = Vec3(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1));
  } while (d.norm() > 1.0 || d.norm() < 0.1);
  return d.normalized();
}

inline Vec3 RandomPoint(const Box3& box, Random& random)
{
  Vec3 p;
  for (int k = 0; k < 3; ++k)
  {
    p[k] = random.Uniform(box.min()[k], box.max()[k]);
  }
  return p;
}

/// The line through a point, starting outside of a model of size `size`.
inline Ray LineThrough(const Vec3& point, const Vec3& direction, double size)
{
  Ray ray;
  ray.Origin = point - 2.0 * size * direction;
  ray.Direction = direction;
  return ray;
}

/// Real roots of a polynomial, lowest coefficient first: between those of its derivative, by
/// bisection. Double roots may be found or not.
inline std::vector<Real> Roots(const std::vector<Real>& c, Real limit)
{
  std::vector<Real> turns{ -limit };
  if (c.size() > 2)
  {
    std::vector<Real> derivative;
    for (std::size_t i = 1; i < c.size(); ++i)
    {
      derivative.push_back(Real(i) * c[i]);
    }
    for (Real t : Roots(derivative, limit))
    {
      turns.push_back(t);
    }
  }
  turns.push_back(limit);
  const auto value = [&](Real t) {
    Real sum = 0.0L;
    for (std::size_t i = c.size(); i-- > 0;)
    {
      sum = sum * t + c[i];
    }
    return sum;
  };
  std::vector<Real> roots;
  for (std::size_t i = 1; i < turns.size(); ++i)
  {
    Real a = turns[i - 1], b = turns[i];
    if ((value(a) < 0.0L) == (value(b) < 0.0L))
    {
      continue;
    }
    const bool rising = value(a) < 0.0L;
    for (int step = 0; step < 100; ++step)
    {
      const Real middle = 0.5L * (a + b);
      ((value(middle) < 0.0L) == rising ? a : b) = middle;
    }
    roots.push_back(0.5L * (a + b));
  }
  return roots;
}

/// Polynomial (as above) products.
inline std::vector<Real> Product(const std::vector<Real>& a, const std::vector<Real>& b)
{
  std::vector<Real> c(a.size() + b.size() - 1, 0.0L);
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    for (std::size_t j = 0; j < b.size(); ++j)
    {
      c[i + j] += a[i] * b[j];
    }
  }
  return c;
}

/// Expects hits at the given t, and that each lies on its surface and on the ray.
inline void ExpectHits(const RayCaster& caster, const Model& model, const Ray& ray,
  const std::vector<Real>& expected, double tolerance)
{
  std::vector<RayHit> hits;
  caster.All(ray, hits);
  ASSERT_EQ(hits.size(), expected.size());
  for (std::size_t i = 0; i < hits.size(); ++i)
  {
    const RayHit& hit = hits[i];
    EXPECT_NEAR(hit.T, double(expected[i]), tolerance);
    EXPECT_LT((ray.Origin + hit.T * ray.Direction - hit.Point).norm(), tolerance);
    EXPECT_LT((Point(model.Faces[hit.Face].Geometry, hit.U, hit.V) - hit.Point).norm(), 1e-13);
    EXPECT_NEAR(hit.Normal.norm(), 1.0, 1e-14);
  }
  RayHit nearest;
  ASSERT_EQ(caster.Nearest(ray, nearest), !hits.empty());
  EXPECT_EQ(caster.IsBlocked(ray), !hits.empty());
  if (!hits.empty())
  {
    EXPECT_NEAR(nearest.T, hits[0].T, 1e-12);
  }
}

/// Expects that hits enter and leave by turns, and that none is left over.
inline void ExpectClosed(const std::vector<RayHit>& hits)
{
  ASSERT_EQ(hits.size() % 2, 0u);
  for (std::size_t i = 0; i < hits.size(); ++i)
  {
    ASSERT_EQ(hits[i].Crossing, i % 2 == 0 ? 1 : -1) << i << " of " << hits.size();
  }
}

inline std::vector<RayHit> WithoutTouches(std::vector<RayHit> hits)
{
  hits.erase(
    std::remove_if(hits.begin(), hits.end(), [](const RayHit& hit) { return hit.Crossing == 0; }),
    hits.end());
  return hits;
}

inline Surface Plate(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
  Surface s;
  s.Count[0] = s.Count[1] = 2;
  s.Knots[0] = s.Knots[1] = { 0, 0, 1, 1 };
  s.Points = { a, b, c, d };
  return s;
}

/// The unit cube, normals outwards.
inline std::vector<Surface> Cube()
{
  std::vector<Surface> sides;
  for (int axis = 0; axis < 3; ++axis)
  {
    const Vec3 u = Vec3::Unit((axis + 1) % 3), v = Vec3::Unit((axis + 2) % 3), n = Vec3::Unit(axis);
    sides.push_back(Plate(n, n + u, n + v, n + u + v));
    sides.push_back(Plate(Vec3::Zero(), v, u, u + v));
  }
  return sides;
}

/// Intersections by plain means: patches whose box the ray meets are halved until they are small,
/// and Newton's method for S(u, v) = o + t d starts from the middle of each.
class PlainSearch
{
public:
  PlainSearch(const Surface& surface, const Ray& ray)
    : View(surface.View())
    , Given(ray)
  {
    for (const BezierPatch& patch : ToBezier(this->View))
    {
      this->Halve(patch, 0);
    }
    std::sort(this->Found.begin(), this->Found.end(),
      [](const Vec3& a, const Vec3& b) { return a[2] < b[2]; });
  }

  std::vector<Vec3> Found; ///< (u, v, t), sorted by t.

private:
  void Halve(const BezierPatch& patch, int depth)
  {
    Box3 box;
    for (const Vec4& h : patch.Points)
    {
      box.extend(h.head<3>() / h[3]);
    }
    double low = -1e9, high = 1e9;
    for (int k = 0; k < 3; ++k)
    {
      const double a = (box.min()[k] - 1e-9 - this->Given.Origin[k]) / this->Given.Direction[k];
      const double b = (box.max()[k] + 1e-9 - this->Given.Origin[k]) / this->Given.Direction[k];
      low = std::max(low, std::min(a, b));
      high = std::min(high, std::max(a, b));
    }
    if (low > high)
    {
      return;
    }
    if (depth == 12)
    {
      this->Refine(Vec3(
        0.5 * (patch.U.Min + patch.U.Max), 0.5 * (patch.V.Min + patch.V.Max), 0.5 * (low + high)));
      return;
    }
    BezierPatch a, b;
    SplitBezierPatch(patch, depth % 2, 0.5, a, b);
    this->Halve(a, depth + 1);
    this->Halve(b, depth + 1);
  }

  void Refine(Vec3 x)
  {
    const Interval u = this->View.Domain(0), v = this->View.Domain(1);
    for (int step = 0; step < 30; ++step)
    {
      const SurfaceDerivatives d = EvaluateDerivatives(this->View, x[0], x[1], 1);
      Eigen::Matrix3d jacobian;
      jacobian << d.Su, d.Sv, -this->Given.Direction;
      x -= jacobian.inverse() * (d.S - this->Given.Origin - x[2] * this->Given.Direction);
      x[0] = u.Clamp(x[0]);
      x[1] = v.Clamp(x[1]);
    }
    const Vec3 off =
      Evaluate(this->View, x[0], x[1]) - this->Given.Origin - x[2] * this->Given.Direction;
    bool known = off.norm() > 1e-11;
    for (const Vec3& other : this->Found)
    {
      known = known || (other - x).norm() < 1e-7;
    }
    if (!known)
    {
      this->Found.push_back(x);
    }
  }

  SurfaceView View;
  Ray Given;
};

/// A closed surface like a torus, and like nothing else: its seams agree bit for bit.
inline Surface Blob(Random& random)
{
  Surface s = Torus(1.0, 0.5);
  for (int j = 0; j < 9; ++j)
  {
    for (int i = 0; i < 9; ++i)
    {
      const int first = i % 8 + 9 * (j % 8);
      if (first == i + 9 * j)
      {
        s.Points[first] += 0.25 * RandomDirection(random);
        s.Weights[first] *= random.Uniform(0.7, 1.4);
      }
      s.Points[i + 9 * j] = s.Points[first];
      s.Weights[i + 9 * j] = s.Weights[first];
    }
  }
  return s;
}

/// A sphere of 6 x 4 faces whose borders agree bit for bit, normals outwards.
inline std::vector<Surface> CutSphere()
{
  const Surface sphere = Sphere(1.0);
  std::vector<Surface> parts;
  for (int i = 0; i < 6; ++i)
  {
    for (int j = 0; j < 4; ++j)
    {
      parts.push_back(Restrict(
        sphere.View(), { i / 6.0, i == 5 ? 1.0 : (i + 1) / 6.0 }, { j / 4.0, (j + 1) / 4.0 }));
    }
  }
  return parts;
}

} // namespace reference
