// SPDX-License-Identifier: BSD-3-Clause
// Fuzzes the point-in-trim structure: whatever loops a face has, its tree says of every point what the
// parity of all pieces says, also where coordinates are those of pieces' ends.
#include "fuzzModel.h"

#include "../Filters/Core/nurbsTrimReference.h"
#include "TrimIndex.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  FuzzedDataProvider bytes(data, size);
  nurbs::ModelBuilder builder;
  const nurbs::Surface sheet = fuzzModel::Sheet();
  builder.BeginFace(sheet.View(), nurbs::FaceAttributes());
  const int loops = bytes.ConsumeIntegralInRange(1, 4);
  for (int i = 0; i < loops; ++i)
  {
    fuzzModel::AddLoop(builder, bytes);
  }
  nurbs::AssembleOptions options;
  options.CheckLoops = false; // open loops, too
  const nurbs::AssembledModel assembled = nurbs::AssembleModel(builder.Arrays(), options);
  const nurbs::TrimIndex index(assembled.Model);
  const nurbs::TrimPieces cut = nurbs::CutTrimLoops(assembled.Model, assembled.Model.Faces[0]);
  for (const nurbs::TrimPiece& piece : cut.Pieces)
  {
    FUZZ_REQUIRE((piece.Low.array() <= piece.High.array()).all() && piece.Low != piece.High);
    FUZZ_REQUIRE(piece.Degree >= 1 && piece.Degree <= nurbs::MaxDegree);
  }
  std::vector<nurbs::Vec2> points = reference::CriticalPoints(cut, 200);
  for (int k = 0; k < 81; ++k)
  {
    points.emplace_back(k % 9 / 9.0, k / 9 / 9.0);
  }
  for (const nurbs::Vec2& p : points)
  {
    FUZZ_REQUIRE(
      reference::IsOnPiece(cut, p) || index.Inside(0, p[0], p[1]) == reference::IsInside(cut, p));
  }
  const nurbs::TrimTexels texels = nurbs::Flatten(index);
  FUZZ_REQUIRE(texels.FaceStart.size() == 1 && texels.Points.size() % 4 == 0);
  return 0;
}
