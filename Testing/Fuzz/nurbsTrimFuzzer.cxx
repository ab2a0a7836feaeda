// SPDX-License-Identifier: BSD-3-Clause
// Fuzzes trimming: whatever loops a face has, crossing, touching, open, doubled, inside out, the
// tessellator comes back, and what it gives is a mesh or a reason.
#include "fuzzModel.h"

#include "Tessellator.h"

namespace
{

constexpr double Tolerance = 0.02;

/// Half of the points lie on a coarse grid, which makes loops touch and overlap exactly.
nurbs::Vec2 ConsumePoint(FuzzedDataProvider& bytes)
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
nurbs::Curve<2> ConsumeCurve(FuzzedDataProvider& bytes, const nurbs::Vec2& a, const nurbs::Vec2& b)
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

void AddLoop(nurbs::ModelBuilder& builder, FuzzedDataProvider& bytes)
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

void CheckMesh(const nurbs::FaceMesh& mesh, const nurbs::TessellatorOptions& options)
{
  if (mesh.Status == nurbs::FaceStatus::Failed)
  {
    FUZZ_REQUIRE(mesh.Triangles.empty() && !mesh.Message.empty());
    return;
  }
  FUZZ_REQUIRE(mesh.Status == nurbs::FaceStatus::Ok || !mesh.Message.empty());
  FUZZ_REQUIRE(mesh.Status == nurbs::FaceStatus::Capped ||
    mesh.CertifiedError <= options.Tolerance * (1.0 + 1e-9));
  FUZZ_REQUIRE(mesh.Normals.size() == mesh.Points.size() && mesh.UV.size() == mesh.Points.size());
  FUZZ_REQUIRE(mesh.Triangles.size() % 3 == 0);
  for (std::size_t i = 0; i < mesh.Points.size(); ++i)
  {
    FUZZ_REQUIRE(
      mesh.Points[i].array().isFinite().all() && mesh.Normals[i].array().isFinite().all());
    FUZZ_REQUIRE((mesh.UV[i].array() >= -0.02).all() && (mesh.UV[i].array() <= 1.02).all());
  }
  for (int corner : mesh.Triangles)
  {
    FUZZ_REQUIRE(corner >= 0 && corner < static_cast<int>(mesh.Points.size()));
  }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  FuzzedDataProvider bytes(data, size);
  nurbs::ModelBuilder builder;
  const nurbs::Surface sheet = fuzzModel::Sheet();
  builder.BeginFace(sheet.View(), nurbs::FaceAttributes());
  const int loops = bytes.ConsumeIntegralInRange(0, 4);
  for (int i = 0; i < loops; ++i)
  {
    AddLoop(builder, bytes);
  }
  const nurbs::AssembledModel assembled = nurbs::AssembleModel(builder.Arrays());
  nurbs::TessellatorOptions options;
  options.Tolerance = Tolerance;
  options.MaximumFaceTriangles = 2000;
  options.Method = bytes.PickValueInArray({ nurbs::SubdivisionMethod::KdTree,
    nurbs::SubdivisionMethod::QuadTree, nurbs::SubdivisionMethod::Binary });
  options.Curves.Simplify = bytes.ConsumeBool();
  const nurbs::TessellationResult result =
    nurbs::Tessellate(assembled.Model, assembled.FaceErrors, options);
  FUZZ_REQUIRE(!result.Aborted && result.Meshes.size() == 1);
  CheckMesh(result.Meshes[0], options);
  return 0;
}
