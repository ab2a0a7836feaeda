// SPDX-License-Identifier: BSD-3-Clause
// Closed and trimmed models for tests of meshes.
#ifndef nurbsModelShapes_h
#define nurbsModelShapes_h

#include "PatchStitcher.h"

#include <cmath>

namespace shapes
{

using nurbs::Curve;
using nurbs::ModelBuilder;
using nurbs::Surface;
using nurbs::Vec2;
using nurbs::Vec3;

/// A rational circle of nine points in a plane, as weights and points.
inline void Circle(std::vector<Vec2>& points, std::vector<double>& weights)
{
  const int sign[9][2] = { { 1, 0 }, { 1, 1 }, { 0, 1 }, { -1, 1 }, { -1, 0 }, { -1, -1 },
    { 0, -1 }, { 1, -1 }, { 1, 0 } };
  for (int k = 0; k < 9; ++k)
  {
    points.emplace_back(sign[k][0], sign[k][1]);
    weights.push_back(k % 2 ? std::sqrt(0.5) : 1.0);
  }
}

/// A torus without loops: both directions are closed.
inline void AddTorus(ModelBuilder& builder, double radius, double tube)
{
  std::vector<Vec2> circle;
  std::vector<double> weights;
  Circle(circle, weights);
  Surface s;
  for (int d = 0; d < 2; ++d)
  {
    s.Degree[d] = 2;
    s.Count[d] = 9;
    s.Knots[d] = { 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4 };
  }
  for (int j = 0; j < 9; ++j)
  {
    for (int i = 0; i < 9; ++i)
    {
      const double r = radius + tube * circle[j][0];
      s.Points.emplace_back(r * circle[i][0], r * circle[i][1], tube * circle[j][1]);
      s.Weights.push_back(weights[i] * weights[j]);
    }
  }
  builder.BeginFace(s.View(), nurbs::FaceAttributes());
}

/// The six bicubic patches of a dented ball. With `loops` they name their edges; else their sides
/// only coincide, and some patches run over other parameters, the other way around.
inline void AddBall(ModelBuilder& builder, bool loops)
{
  nurbs::PatchStitcher stitcher(builder, 1e-12);
  for (int f = 0; f < 6; ++f)
  {
    const int axis = f / 2;
    const double side = f % 2 ? 1.0 : -1.0;
    Surface s;
    for (int d = 0; d < 2; ++d)
    {
      s.Degree[d] = 3;
      s.Count[d] = 5;
      s.Knots[d] = { 0, 0, 0, 0, 0.5, 1, 1, 1, 1 };
      for (double& knot : s.Knots[d])
      {
        knot = loops ? knot : f + (2.0 + d) * knot;
      }
    }
    for (int j = 0; j < 5; ++j)
    {
      for (int i = 0; i < 5; ++i)
      {
        // Seen from outside, u x v points outwards.
        const int a = f % 2 ? i : 4 - i;
        Vec3 p;
        p[axis] = side;
        p[(axis + 1) % 3] = 0.5 * a - 1.0;
        p[(axis + 2) % 3] = 0.5 * j - 1.0;
        const double dent = 1.0 + 0.15 * std::sin(2.0 * p[0] + 1.0) * std::cos(3.0 * p[1] - p[2]);
        s.Points.push_back(dent / p.norm() * p);
      }
    }
    if (loops)
    {
      stitcher.AddFace(s, nurbs::FaceAttributes());
    }
    else
    {
      builder.BeginFace(s.View(), nurbs::FaceAttributes());
    }
  }
}

/// A closed prism over a pentagon: a side with creases, and two trimmed planes.
inline void AddPrism(ModelBuilder& builder)
{
  const double pi = 3.14159265358979323846;
  std::vector<Vec2> corners;
  for (int k = 0; k <= 5; ++k)
  {
    const double angle = 2.0 * pi * (k % 5) / 5.0;
    corners.emplace_back(std::cos(angle), std::sin(angle));
  }
  const std::vector<double> knots = { 0, 0, 1, 2, 3, 4, 5, 5 };
  std::int64_t vertex[2], ring[2];
  Curve<2> polygon;
  polygon.Knots = knots;
  polygon.Points = corners;
  polygon.Weights.assign(6, 1.0);
  polygon.Pack();
  for (int end = 0; end < 2; ++end)
  {
    const Vec3 origin(0.0, 0.0, 2.0 * end);
    vertex[end] = builder.AddVertex(origin + Vec3(1.0, 0.0, 0.0));
    const Curve<3> curve = nurbs::LiftCurve(polygon, origin, Vec3::UnitX(), Vec3::UnitY());
    ring[end] = builder.AddEdge(curve.View(), 1e-12, vertex[end], vertex[end]);
  }
  Curve<3> line;
  line.Knots = { 0, 0, 1, 1 };
  line.Points = { Vec3(1, 0, 0), Vec3(1, 0, 2) };
  line.Weights = { 1, 1 };
  line.Pack();
  const std::int64_t seam = builder.AddEdge(line.View(), 1e-12, vertex[0], vertex[1]);
  Surface side;
  side.Degree[0] = side.Degree[1] = 1;
  side.Count[0] = 6;
  side.Count[1] = 2;
  side.Knots[0] = knots;
  side.Knots[1] = { 0, 0, 1, 1 };
  for (int j = 0; j < 2; ++j)
  {
    for (const Vec2& c : corners)
    {
      side.Points.emplace_back(c[0], c[1], 2.0 * j);
    }
  }
  builder.BeginFace(side.View(), nurbs::FaceAttributes());
  builder.BeginLoop();
  builder.AddTrimCurve(nurbs::TrimLine({ 0, 0 }, { 5, 0 }, { 0, 5 }).View(), ring[0], false);
  builder.AddTrimCurve(nurbs::TrimLine({ 5, 0 }, { 5, 1 }, { 0, 1 }).View(), seam, false);
  builder.AddTrimCurve(nurbs::TrimLine({ 0, 1 }, { 5, 1 }, { 0, 5 }).View(), ring[1], true);
  builder.AddTrimCurve(nurbs::TrimLine({ 0, 0 }, { 0, 1 }, { 0, 1 }).View(), seam, true);
  for (int end = 0; end < 2; ++end)
  {
    Surface plane;
    plane.Degree[0] = plane.Degree[1] = 1;
    plane.Count[0] = plane.Count[1] = 2;
    plane.Knots[0] = plane.Knots[1] = { -2, -2, 2, 2 };
    plane.Points = { Vec3(-2, -2, 2.0 * end), Vec3(2, -2, 2.0 * end), Vec3(-2, 2, 2.0 * end),
      Vec3(2, 2, 2.0 * end) };
    nurbs::FaceAttributes attributes;
    attributes.Reversed = end == 0;
    builder.BeginFace(plane.View(), attributes);
    builder.BeginLoop();
    builder.AddTrimCurve(polygon.View(), ring[end], false);
  }
}

/// A wavy sheet [0, 10] x [0, 10] with two round holes near each other, and the discs cut out. Its
/// border alone is open: 4 sides.
inline void AddHoles(ModelBuilder& builder)
{
  Surface s;
  for (int d = 0; d < 2; ++d)
  {
    s.Degree[d] = 3;
    s.Count[d] = 9;
    s.Knots[d] = nurbs::UniformKnots(3, 9);
    for (double& knot : s.Knots[d])
    {
      knot *= 10.0;
    }
  }
  for (int j = 0; j < 9; ++j)
  {
    for (int i = 0; i < 9; ++i)
    {
      s.Points.emplace_back(1.25 * i, 1.25 * j, 0.6 * std::sin(1.3 * i) * std::cos(0.9 * j));
    }
  }
  const Vec2 centers[2] = { { 3.5, 5.0 }, { 6.6, 5.2 } };
  Curve<2> circles[2];
  std::int64_t edges[2];
  for (int k = 0; k < 2; ++k)
  {
    circles[k] = nurbs::TrimCircle(centers[k], 1.5);
    const std::int64_t vertex =
      builder.AddVertex(nurbs::Evaluate(s.View(), centers[k][0] + 1.5, centers[k][1]));
    edges[k] = builder.AddUnknownEdge(1e-12, vertex, vertex);
  }
  builder.BeginFace(s.View(), nurbs::FaceAttributes());
  builder.BeginLoop();
  const Vec2 corners[4] = { { 0, 0 }, { 10, 0 }, { 10, 10 }, { 0, 10 } };
  for (int k = 0; k < 4; ++k)
  {
    builder.AddTrimCurve(
      nurbs::TrimLine(corners[k], corners[(k + 1) % 4], { 0, 10 }).View(), -1, false);
  }
  for (int k = 0; k < 2; ++k)
  {
    builder.BeginLoop();
    builder.AddTrimCurve(circles[k].View(), edges[k], true);
  }
  for (int k = 0; k < 2; ++k)
  {
    builder.BeginFace(s.View(), nurbs::FaceAttributes());
    builder.BeginLoop();
    builder.AddTrimCurve(circles[k].View(), edges[k], false);
  }
}

} // namespace shapes

#endif
