// SPDX-License-Identifier: BSD-3-Clause
// Vase, missile and spring: closed, turned outwards, and of the volumes that formulas which know
// nothing of patches give.
#include "RayCaster.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSShapeSource.h"

#include "vtkNew.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

namespace
{

using nurbs::Vec2;
using nurbs::Vec3;

constexpr double Pi = 3.14159265358979323846;

/// Abscissae and weights of Gauss' rule with 8 points on [0, 1].
constexpr double GaussAt[4] = { 0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
  0.9602898564975363 };
constexpr double GaussOf[4] = { 0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
  0.1012285362903763 };

/// The integral of body over [0, 1] by that rule on equal pieces.
template <typename Body>
double Integrate(int pieces, const Body& body)
{
  double sum = 0.0;
  for (int piece = 0; piece < pieces; ++piece)
  {
    for (int k = 0; k < 4; ++k)
    {
      for (const double sign : { -1.0, 1.0 })
      {
        sum += 0.5 / pieces * GaussOf[k] * body((piece + 0.5 + 0.5 * sign * GaussAt[k]) / pieces);
      }
    }
  }
  return sum;
}

std::shared_ptr<const vtkNURBSModelView> Make(int shape)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(shape);
  source->Update();
  return vtkNURBSModel::View(source->GetOutput());
}

/// The volume that faces without trims enclose, by the divergence theorem; negative if they look
/// inwards. Trusts Face::Reversed.
double EnclosedVolume(const nurbs::Model& model)
{
  double volume = 0.0;
  for (const nurbs::Face& face : model.Faces)
  {
    const nurbs::Interval u = face.Geometry.Domain(0), v = face.Geometry.Domain(1);
    const double flux = Integrate(4, [&](double s) {
      return Integrate(4, [&](double t) {
        const auto d = nurbs::EvaluateDerivatives(
          face.Geometry, u.Min + s * u.Length(), v.Min + t * v.Length(), 1);
        return d.S.dot(d.Su.cross(d.Sv));
      });
    });
    volume += (face.Reversed ? -1.0 : 1.0) * flux * u.Length() * v.Length() / 3.0;
  }
  return volume;
}

/// Every edge that is no pole is used twice, in opposite directions as seen from outside.
void ExpectClosed(const nurbs::Model& model)
{
  std::map<std::int64_t, std::array<int, 2>> uses;
  for (const nurbs::Face& face : model.Faces)
  {
    ASSERT_EQ(face.LoopCount, 1);
    const nurbs::TrimLoop& loop = model.Loops[face.FirstLoop];
    for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
    {
      const nurbs::TrimCurve& curve = model.TrimCurves[c];
      if (model.Edges[curve.Edge].Geometry.Degree > 0)
      {
        ++uses[curve.Edge][curve.Reversed != face.Reversed ? 1 : 0];
      }
    }
  }
  for (const auto& use : uses)
  {
    EXPECT_EQ(use.second[0], 1) << "edge " << use.first;
    EXPECT_EQ(use.second[1], 1) << "edge " << use.first;
  }
}

/// A ray from just outside of a face crosses the model an even number of times, one from just
/// inside an odd one: which also tells that faces do not run through each other.
void ExpectOutside(const nurbs::Model& model, double step)
{
  const nurbs::RayCaster caster(model);
  std::vector<nurbs::RayHit> hits;
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    const nurbs::Face& face = model.Faces[f];
    for (const double s : { 0.03, 0.21, 0.53, 0.81, 0.98 })
    {
      for (const double t : { 0.02, 0.27, 0.49, 0.77, 0.96 })
      {
        const Vec3 normal = (face.Reversed ? -1.0 : 1.0) * nurbs::Normal(face.Geometry, s, t);
        for (const double side : { -1.0, 1.0 })
        {
          nurbs::Ray ray;
          ray.Origin = nurbs::Evaluate(face.Geometry, s, t) + side * step * normal;
          ray.Direction = Vec3(0.3123, -0.5417, 0.7811);
          caster.All(ray, hits);
          EXPECT_EQ(hits.size() % 2, side < 0.0 ? 1u : 0u) << "face " << f << " " << s << " " << t;
        }
      }
    }
  }
}

void ExpectPatches(const nurbs::Model& model, std::size_t count)
{
  ASSERT_EQ(model.Faces.size(), count);
  for (const nurbs::Face& face : model.Faces)
  {
    for (int dir = 0; dir < 2; ++dir)
    {
      EXPECT_LE(face.Geometry.Degree[dir], 3);
      EXPECT_EQ(face.Geometry.Count[dir], face.Geometry.Degree[dir] + 1);
    }
  }
}

/// A cubic Bezier curve in the plane.
struct Cubic
{
  Vec2 P[4];
  Vec2 At(double t) const
  {
    const double s = 1.0 - t;
    return s * s * s * P[0] + 3.0 * s * s * t * P[1] + 3.0 * s * t * t * P[2] + t * t * t * P[3];
  }
  Vec2 Slope(double t) const
  {
    const double s = 1.0 - t;
    return 3.0 * (s * s * (P[1] - P[0]) + 2.0 * s * t * (P[2] - P[1]) + t * t * (P[3] - P[2]));
  }
};

/// What a profile encloses around the axis: pi r^2 dz along it.
double RevolvedVolume(const std::vector<Cubic>& profile)
{
  double volume = 0.0;
  for (const Cubic& piece : profile)
  {
    volume += Pi * Integrate(4, [&](double t) {
      const double r = piece.At(t)[0];
      return r * r * piece.Slope(t)[1];
    });
  }
  return volume;
}

/// The volume of a handle as the image of a box: the angle around the axis, v from the handle's
/// inner to its outer side, t from one root (on the body's piece `upper`) to the other.
double HandleVolume(const Cubic& upper, const Cubic& lower)
{
  const double half = 9.0 * Pi / 180.0;
  return Integrate(2, [&](double s) {
    const double angle = half * (2.0 * s - 1.0), c = std::cos(angle), n = std::sin(angle);
    return Integrate(2, [&](double v) {
      return Integrate(2, [&](double t) {
        const double r = 1.0 - t;
        const double a = r * r * (1.0 + 2.0 * t), b = t * t * (3.0 - 2.0 * t);
        const double da = -6.0 * r * t, db = 6.0 * r * t;
        const double b1 = 3.0 * r * r * t, b2 = 3.0 * r * t * t;
        const double db1 = 3.0 * r * (1.0 - 3.0 * t), db2 = 3.0 * t * (2.0 - 3.0 * t);
        const double out1 = 50.0 + 12.0 * v, out2 = 25.0 + 12.0 * v;
        const Vec2 A = upper.At(v), B = lower.At(1.0 - v);
        const Vec2 Av = upper.Slope(v), Bv = -lower.Slope(1.0 - v);
        const double ring = a * A[0] + b * B[0];
        const Vec3 byAngle = ring * Vec3(-n, c, 0.0);
        const double ringV = a * Av[0] + b * Bv[0];
        const Vec3 byV(ringV * c + 12.0 * (b1 + b2), ringV * n, a * Av[1] + b * Bv[1]);
        const double ringT = da * A[0] + db * B[0];
        const Vec3 byT(ringT * c + db1 * out1 + db2 * out2, ringT * n, da * A[1] + db * B[1]);
        return 2.0 * half * std::abs(byAngle.dot(byV.cross(byT)));
      });
    });
  });
}

TEST(RuanModels, VaseIsASolid)
{
  const auto view = Make(vtkNURBSShapeSource::VASE);
  const nurbs::Model& model = view->GetModel();
  ExpectPatches(model, 76);
  ExpectClosed(model);
  ExpectOutside(model, 1e-3);
  const std::vector<Cubic> wall = { { { { 30, 0 }, { 45, 15 }, { 60, 40 }, { 60, 70 } } },
    { { { 60, 70 }, { 60, 85 }, { 56, 98 }, { 50, 108 } } },
    { { { 50, 108 }, { 38, 128 }, { 26, 138 }, { 24, 156 } } },
    { { { 24, 156 }, { 23, 165 }, { 23, 171 }, { 24, 180 } } },
    { { { 24, 180 }, { 27, 207 }, { 32, 216 }, { 40, 222 } } },
    { { { 40, 222 }, { 42, 225 }, { 38, 226 }, { 36, 223 } } },
    { { { 36, 223 }, { 29, 217 }, { 23.5, 206 }, { 20.5, 180 } } },
    { { { 20.5, 180 }, { 19, 167 }, { 19, 165 }, { 21, 154 } } },
    { { { 21, 154 }, { 24, 134 }, { 56, 112 }, { 56, 70 } } },
    { { { 56, 70 }, { 56, 40 }, { 40, 6 }, { 26, 6 } } } };
  const double volume = RevolvedVolume(wall) + 2.0 * HandleVolume(wall[3], wall[1]);
  EXPECT_NEAR(EnclosedVolume(model) / volume, 1.0, 1e-10);
}

TEST(RuanModels, MissileIsASolid)
{
  const auto view = Make(vtkNURBSShapeSource::MISSILE);
  const nurbs::Model& model = view->GetModel();
  ExpectPatches(model, 88);
  ExpectClosed(model);
  ExpectOutside(model, 1e-3);
  const double r = 10.0, length = 40.0, arc = (r * r + length * length) / (2.0 * r);
  const double ogive = Pi *
    (length * arc * arc - length * length * length / 3.0 -
      (arc - r) * arc * arc * std::asin(length / arc));
  const double cone = Pi * 15.0 / 3.0 * (8.0 * 8.0 + 8.0 * 10.0 + 10.0 * 10.0);
  // A fin is its trapezoid, swept across 1.5 mm along a piece of the body's circle.
  const double fin = 1.5 * 22.0 * 0.5 * (30.0 + 20.0), wing = 1.5 * 14.0 * 0.5 * (25.0 + 11.0);
  const double volume = ogive + cone + Pi * r * r * 125.0 + 4.0 * (fin + wing);
  EXPECT_NEAR(EnclosedVolume(model) / volume, 1.0, 1e-10);
}

TEST(RuanModels, SpringIsASolid)
{
  const auto view = Make(vtkNURBSShapeSource::SPRING);
  const nurbs::Model& model = view->GetModel();
  ExpectPatches(model, 96);
  ExpectClosed(model);
  ExpectOutside(model, 1e-4);
  // Pappus: sections across the helix sweep their area times its length, whatever its curvature.
  // What the surface's height differs from the helix's shears sections only, and its mean is zero.
  const double rise = 5.0 / (2.0 * Pi);
  const double helix = 11.0 * Pi * std::hypot(10.0, rise);
  const double volume = Pi * 1.5 * 1.5 * helix + 4.0 / 3.0 * Pi * 1.5 * 1.5 * 1.5;
  EXPECT_NEAR(EnclosedVolume(model) / volume, 1.0, 1e-10);
  double most = 0.0;
  for (int face = 0; face < 88; ++face)
  {
    for (int k = 0; k <= 50; ++k)
    {
      // The middle of a section, from the ends of quarters of its circle.
      const nurbs::SurfaceView& patch = model.Faces[face].Geometry;
      const nurbs::SurfaceView& other = model.Faces[face % 4 < 2 ? face + 2 : face - 2].Geometry;
      const Vec3 middle =
        0.5 * (nurbs::Evaluate(patch, 0.0, k / 50.0) + nurbs::Evaluate(other, 0.0, k / 50.0));
      EXPECT_NEAR(std::hypot(middle[0], middle[1]), 10.0, 1e-12);
      EXPECT_NEAR((nurbs::Evaluate(patch, 0.3, k / 50.0) - middle).norm(), 1.5, 1e-12);
      const double turn = std::floor(face / 4 / 4) * 2.0 * Pi;
      double angle = std::atan2(middle[1], middle[0]);
      angle += angle < -1e-9 || (face / 4 % 4 == 3 && angle < 1e-9) ? 2.0 * Pi : 0.0;
      most = std::max(most, std::abs(middle[2] - rise * (turn + angle)));
    }
  }
  EXPECT_LT(most, 7.5e-4);
  EXPECT_GT(most, 5e-4);
}

} // namespace
