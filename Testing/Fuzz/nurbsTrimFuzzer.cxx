// SPDX-License-Identifier: BSD-3-Clause
// Fuzzes trimming: whatever loops a face has, crossing, touching, open, doubled, inside out, the
// tessellator comes back, and what it gives is a mesh or a reason.
#include "fuzzModel.h"

#include "Tessellator.h"

namespace
{

constexpr double Tolerance = 0.02;

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
    fuzzModel::AddLoop(builder, bytes);
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
