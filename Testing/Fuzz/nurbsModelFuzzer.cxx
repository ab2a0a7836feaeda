// SPDX-License-Identifier: BSD-3-Clause
// Fuzzes the model validator: a sound model whose arrays were damaged must be judged without a
// crash, and whatever the validator lets through must be safe to evaluate.
#include "fuzzModel.h"

#include <cmath>

namespace
{

/// Values that break things.
double OddReal(FuzzedDataProvider& bytes)
{
  static const double odd[] = { 0.0, -0.0, -1.0, 0.5, 1.0, 2.0, 1e100, -1e100, 1e49, 1e-19, 1e-310,
    1e18, std::nan(""), HUGE_VAL, -HUGE_VAL };
  return bytes.ConsumeBool() ? bytes.PickValueInArray(odd)
                             : bytes.ConsumeFloatingPointInRange(-2.0, 3.0);
}

std::int64_t OddInteger(FuzzedDataProvider& bytes)
{
  static const std::int64_t odd[] = { 0, -1, 1, 2, 3, 24, 25, 26, 1000, INT32_MAX, INT32_MIN,
    INT64_MAX, INT64_MIN, std::int64_t(1) << 32, std::int64_t(1) << 61 };
  return bytes.ConsumeBool() ? bytes.PickValueInArray(odd)
                             : bytes.ConsumeIntegralInRange<std::int64_t>(-3, 40);
}

/// Overwrites, removes or appends an element, or empties the array.
template <typename T, typename Odd>
void Damage(std::vector<T>& array, FuzzedDataProvider& bytes, Odd odd)
{
  const int action = bytes.ConsumeIntegralInRange(0, 9);
  if (action == 0)
  {
    array.clear();
  }
  else if (action == 1 && !array.empty())
  {
    array.pop_back();
  }
  else if (action == 2)
  {
    array.push_back(odd(bytes));
  }
  else if (!array.empty())
  {
    array[bytes.ConsumeIntegralInRange<std::size_t>(0, array.size() - 1)] = odd(bytes);
  }
}

void DamageOneArray(nurbs::ModelBuilder::Storage& data, FuzzedDataProvider& bytes)
{
  nurbs::ModelBuilder::Storage::Reals* reals[] = { &data.Points, &data.Weights, &data.Knots,
    &data.TrimPoints, &data.TrimKnots, &data.EdgeTolerance, &data.EdgePoints, &data.EdgeKnots,
    &data.VertexPoints };
  nurbs::ModelBuilder::Storage::Integers* integers[] = { &data.Connectivity, &data.Offsets,
    &data.Degree, &data.NetSize, &data.KnotStart, &data.LoopStart, &data.LoopCount, &data.FaceId,
    &data.Orientation, &data.LoopCurveStart, &data.LoopCurveCount, &data.TrimCurveDegree,
    &data.TrimCurveKnotStart, &data.TrimCurvePointStart, &data.TrimCurvePointCount,
    &data.TrimCurveEdgeId, &data.TrimCurveReversed, &data.EdgeDegree, &data.EdgeKnotStart,
    &data.EdgePointStart, &data.EdgePointCount, &data.EdgeVertices };
  if (bytes.ConsumeBool())
  {
    Damage(*bytes.PickValueInArray(reals), bytes, OddReal);
  }
  else
  {
    Damage(*bytes.PickValueInArray(integers), bytes, OddInteger);
  }
}

/// A face without an error has a sound surface: finite inside its domain.
void EvaluateFace(const nurbs::Face& face)
{
  const nurbs::Interval u = face.Geometry.Domain(0), v = face.Geometry.Domain(1);
  for (double s : { 0.0, 0.3, 1.0 })
  {
    const double at[2] = { u.Clamp(u.Min + s * u.Length()), v.Clamp(v.Min + s * v.Length()) };
    FUZZ_REQUIRE(nurbs::Evaluate(face.Geometry, at[0], at[1]).array().isFinite().all());
    FUZZ_REQUIRE(nurbs::Normal(face.Geometry, at[0], at[1]).array().isFinite().all());
  }
}

/// Its trim curves lie within reach of the domain and name edges that exist.
void EvaluateTrim(const nurbs::Model& model, const nurbs::Face& face)
{
  FUZZ_REQUIRE(
    face.FirstLoop >= 0 && face.FirstLoop + face.LoopCount <= std::int64_t(model.Loops.size()));
  for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
  {
    const nurbs::TrimLoop& loop = model.Loops[l];
    FUZZ_REQUIRE(loop.FirstCurve >= 0 &&
      loop.FirstCurve + loop.CurveCount <= std::int64_t(model.TrimCurves.size()));
    for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
    {
      const nurbs::TrimCurve& curve = model.TrimCurves[c];
      const nurbs::Interval t = curve.Geometry.Domain();
      FUZZ_REQUIRE(nurbs::Evaluate(curve.Geometry, t.Min).array().isFinite().all());
      FUZZ_REQUIRE(nurbs::Evaluate(curve.Geometry, t.Max).array().isFinite().all());
      FUZZ_REQUIRE(curve.Edge >= -1 && curve.Edge < std::int64_t(model.Edges.size()));
    }
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  FuzzedDataProvider bytes(data, size);
  nurbs::ModelBuilder builder;
  fuzzModel::AddSquare(builder);
  fuzzModel::AddSquare(builder);
  const int damages = bytes.ConsumeIntegralInRange(0, 6);
  for (int i = 0; i < damages; ++i)
  {
    DamageOneArray(builder.Data, bytes);
  }
  const nurbs::AssembledModel assembled = nurbs::AssembleModel(builder.Arrays());
  FUZZ_REQUIRE(assembled.FaceErrors.size() == assembled.Model.Faces.size());
  for (std::size_t f = 0; f < assembled.Model.Faces.size(); ++f)
  {
    const nurbs::Face& face = assembled.Model.Faces[f];
    if (!assembled.FaceErrors[f].empty())
    {
      FUZZ_REQUIRE(face.Geometry.Size() == 0 && face.LoopCount == 0);
      continue;
    }
    EvaluateFace(face);
    EvaluateTrim(assembled.Model, face);
  }
  // What was not damaged is accepted.
  FUZZ_REQUIRE(damages > 0 || assembled.Problems.empty());
  return 0;
}
