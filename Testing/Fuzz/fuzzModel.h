// SPDX-License-Identifier: BSD-3-Clause
/// @file fuzzModel.h
/// @brief The sound models that the fuzz targets start from.
#pragma once

#include "ModelBuilder.h"

#include <fuzzer/FuzzedDataProvider.h>

#include <cstdio>
#include <cstdlib>

/// Ends the process, which libFuzzer reports with its input, unless `condition` holds.
#define FUZZ_REQUIRE(condition)                                                    \
  do                                                                               \
  {                                                                                \
    if (!(condition))                                                              \
    {                                                                              \
      std::fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition); \
      std::abort();                                                                \
    }                                                                              \
  } while (false)

namespace fuzzModel
{

/// A straight trim curve from a to b over the parameter range [0, 1].
inline nurbs::Curve<2> Segment(const nurbs::Vec2& a, const nurbs::Vec2& b)
{
  nurbs::Curve<2> curve;
  curve.Degree = 1;
  curve.Knots = { 0.0, 0.0, 1.0, 1.0 };
  curve.Points = { a, b };
  curve.Weights = { 1.0, 1.0 };
  curve.Pack();
  return curve;
}

/// A slightly curved, rational biquadratic sheet over [0, 1] x [0, 1] with an inner knot in u.
inline nurbs::Surface Sheet()
{
  nurbs::Surface sheet;
  sheet.Degree[0] = sheet.Degree[1] = 2;
  sheet.Count[0] = 4;
  sheet.Count[1] = 3;
  sheet.Knots[0] = { 0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0 };
  sheet.Knots[1] = { 0.0, 0.0, 0.0, 1.0, 1.0, 1.0 };
  for (int j = 0; j < 3; ++j)
  {
    for (int i = 0; i < 4; ++i)
    {
      sheet.Points.emplace_back(i / 3.0, j / 2.0, 0.1 * (i % 2) + 0.2 * (j == 1));
      sheet.Weights.push_back(j == 1 ? 0.8 : 1.0);
    }
  }
  return sheet;
}

/// The 3D image of the straight line from a to b in the sheet's domain, by cubic interpolation: close
/// to the exact one, which is all that an edge with a tolerance has to be.
inline nurbs::Curve<3> Image(
  const nurbs::SurfaceView& sheet, const nurbs::Vec2& a, const nurbs::Vec2& b)
{
  nurbs::Vec3 at[4];
  for (int i = 0; i < 4; ++i)
  {
    const nurbs::Vec2 p = a + (b - a) * (i / 3.0);
    at[i] = nurbs::Evaluate(sheet, p[0], p[1]);
  }
  nurbs::Curve<3> curve;
  curve.Degree = 3;
  curve.Knots = { 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0 };
  curve.Points = { at[0], (-5.0 * at[0] + 18.0 * at[1] - 9.0 * at[2] + 2.0 * at[3]) / 6.0,
    (2.0 * at[0] - 9.0 * at[1] + 18.0 * at[2] - 5.0 * at[3]) / 6.0, at[3] };
  curve.Weights = { 1.0, 1.0, 1.0, 1.0 };
  curve.Pack();
  return curve;
}

/// A face: the sheet, trimmed by its natural boundary and a triangular hole, every curve with its edge.
inline void AddSquare(nurbs::ModelBuilder& builder)
{
  const nurbs::Surface sheet = Sheet();
  builder.BeginFace(sheet.View(), nurbs::FaceAttributes());
  const std::vector<std::vector<nurbs::Vec2>> loops = { { { 0.0, 0.0 }, { 1.0, 0.0 }, { 1.0, 1.0 },
                                                          { 0.0, 1.0 } },
    { { 0.3, 0.3 }, { 0.4, 0.7 }, { 0.7, 0.4 } } };
  for (const auto& loop : loops)
  {
    builder.BeginLoop();
    std::vector<std::int64_t> vertices;
    for (const nurbs::Vec2& p : loop)
    {
      vertices.push_back(builder.AddVertex(nurbs::Evaluate(sheet.View(), p[0], p[1])));
    }
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      const std::size_t j = (i + 1) % loop.size();
      const std::int64_t edge = builder.AddEdge(
        Image(sheet.View(), loop[i], loop[j]).View(), 0.02, vertices[i], vertices[j]);
      builder.AddTrimCurve(Segment(loop[i], loop[j]).View(), edge, false);
    }
  }
}

/// Half of the points lie on a coarse grid, which makes loops touch and overlap exactly.
inline nurbs::Vec2 ConsumePoint(FuzzedDataProvider& bytes)
{
  if (bytes.ConsumeBool())
  {
    const double u = bytes.ConsumeIntegralInRange(0, 8) / 8.0;
    return nurbs::Vec2(u, bytes.ConsumeIntegralInRange(0, 8) / 8.0);
  }
  const double u = bytes.ConsumeFloatingPointInRange(-0.01, 1.01);
  return nurbs::Vec2(u, bytes.ConsumeFloatingPointInRange(-0.01, 1.01));
}

/// A Bezier curve of degree 1 to 3 from a to b.
inline nurbs::Curve<2> ConsumeCurve(
  FuzzedDataProvider& bytes, const nurbs::Vec2& a, const nurbs::Vec2& b)
{
  nurbs::Curve<2> curve;
  curve.Degree = bytes.ConsumeIntegralInRange(1, 3);
  curve.Knots.assign(curve.Degree + 1, 0.0);
  curve.Knots.insert(curve.Knots.end(), curve.Degree + 1, 1.0);
  curve.Points.push_back(a);
  for (int i = 1; i < curve.Degree; ++i)
  {
    curve.Points.push_back(ConsumePoint(bytes));
  }
  curve.Points.push_back(b);
  for (int i = 0; i <= curve.Degree; ++i)
  {
    const bool rational = i > 0 && i < curve.Degree && bytes.ConsumeBool();
    curve.Weights.push_back(rational ? bytes.ConsumeFloatingPointInRange(0.1, 10.0) : 1.0);
  }
  curve.Pack();
  return curve;
}

/// A loop of the current face: curves from point to point, some reversed, mostly closed.
inline void AddLoop(nurbs::ModelBuilder& builder, FuzzedDataProvider& bytes)
{
  builder.BeginLoop();
  const int count = bytes.ConsumeIntegralInRange(1, 8);
  const nurbs::Vec2 start = ConsumePoint(bytes);
  nurbs::Vec2 at = start;
  for (int i = 0; i < count; ++i)
  {
    const bool last = i + 1 == count && bytes.ConsumeIntegralInRange(0, 9) > 0;
    const nurbs::Vec2 next = last ? start : ConsumePoint(bytes);
    const bool reversed = bytes.ConsumeIntegralInRange(0, 7) == 0;
    const nurbs::Curve<2> curve =
      reversed ? ConsumeCurve(bytes, next, at) : ConsumeCurve(bytes, at, next);
    builder.AddTrimCurve(curve.View(), -1, reversed);
    at = next;
  }
}

} // namespace fuzzModel
