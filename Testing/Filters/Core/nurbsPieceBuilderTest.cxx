// SPDX-License-Identifier: BSD-3-Clause
// Models dealt to pieces and put together again.
#include "PieceBuilder.h"
#include "nurbsModelShapes.h"
#include "nurbsSolids.h"

#include <gtest/gtest.h>

#include <numeric>

namespace
{

using nurbs::ModelBuilder;
using nurbs::PieceBuilder;

ModelBuilder Solids()
{
  ModelBuilder builder;
  solids::AddBox(builder, nurbs::Vec3(1, 2, 3), solids::At(nurbs::Vec3(0, 0, 0)));
  solids::AddTorus(builder, 3.0, 1.0, solids::At(nurbs::Vec3(9, 0, 0)));
  solids::AddBox(builder, nurbs::Vec3(2, 1, 1), solids::At(nurbs::Vec3(0, 9, 0)));
  solids::AddSphere(builder, 2.0, solids::At(nurbs::Vec3(0, 0, 9)));
  shapes::AddHoles(builder);
  return builder;
}

TEST(PieceBuilder, DealsAllFacesInOrderByCost)
{
  std::vector<double> costs(1000);
  for (std::size_t f = 0; f < costs.size(); ++f)
  {
    costs[f] = 1.0 + double((f * 7919) % 13);
  }
  const double all = std::accumulate(costs.begin(), costs.end(), 0.0);
  for (const int pieces : { 1, 2, 3, 7, 64 })
  {
    const std::vector<std::int64_t> first = nurbs::DealFaces(costs, pieces);
    ASSERT_EQ(first.size(), std::size_t(pieces) + 1);
    EXPECT_EQ(first.front(), 0);
    EXPECT_EQ(first.back(), 1000);
    for (int p = 0; p < pieces; ++p)
    {
      ASSERT_LE(first[p], first[p + 1]);
      const double cost =
        std::accumulate(costs.begin() + first[p], costs.begin() + first[p + 1], 0.0);
      EXPECT_NEAR(cost, all / pieces, 13.0) << "piece " << p << " of " << pieces;
    }
  }
}

TEST(PieceBuilder, DealsFewFacesToManyPieces)
{
  EXPECT_EQ(nurbs::DealFaces({ 5.0 }, 4), (std::vector<std::int64_t>{ 0, 0, 0, 1, 1 }));
  EXPECT_EQ(nurbs::DealFaces({}, 2), (std::vector<std::int64_t>{ 0, 0, 0 }));
}

// The arrays of the whole come out of its pieces, edges and vertices in their order and once each.
TEST(PieceBuilder, PiecesMakeTheWholeAgain)
{
  const ModelBuilder whole = Solids();
  const std::int64_t faces = whole.FaceCount();
  for (const int pieces : { 1, 2, 5 })
  {
    std::vector<PieceBuilder> parts;
    for (int p = 0; p < pieces; ++p)
    {
      const auto range = nurbs::DealModels({ &whole }, p, pieces).front();
      parts.push_back(nurbs::TakeFaces(whole, range.first, range.second));
    }
    PieceBuilder again;
    for (const PieceBuilder& part : parts)
    {
      again.Begin(part.Model.Arrays(), part.EdgeIds, part.VertexIds);
      for (std::int64_t f = 0; f < part.Model.FaceCount(); ++f)
      {
        again.AddFace(f);
      }
    }
    again.Finish();
    const ModelBuilder::Storage& a = whole.Data;
    const ModelBuilder::Storage& b = again.Model.Data;
    ASSERT_EQ(again.Model.FaceCount(), faces);
    EXPECT_EQ(a.Points, b.Points);
    EXPECT_EQ(a.Weights, b.Weights);
    EXPECT_EQ(a.Knots, b.Knots);
    EXPECT_EQ(a.FaceId, b.FaceId);
    EXPECT_EQ(a.LoopCount, b.LoopCount);
    EXPECT_EQ(a.TrimPoints, b.TrimPoints);
    EXPECT_EQ(a.TrimCurveEdgeId, b.TrimCurveEdgeId);
    EXPECT_EQ(a.EdgePoints, b.EdgePoints);
    EXPECT_EQ(a.EdgeTolerance, b.EdgeTolerance);
    EXPECT_EQ(a.EdgeVertices, b.EdgeVertices);
    EXPECT_EQ(a.VertexPoints, b.VertexPoints);
    std::vector<std::int64_t> ids(again.EdgeIds.size());
    std::iota(ids.begin(), ids.end(), 0);
    EXPECT_EQ(again.EdgeIds, ids);
  }
}

// Edges of sources that tell no ids are not mixed up.
TEST(PieceBuilder, SourcesWithoutIdsStayApart)
{
  ModelBuilder box;
  solids::AddBox(box, nurbs::Vec3(1, 1, 1), solids::At(nurbs::Vec3(0, 0, 0)));
  PieceBuilder two;
  for (int copy = 0; copy < 2; ++copy)
  {
    two.Begin(box.Arrays(), {}, {});
    for (std::int64_t f = 0; f < box.FaceCount(); ++f)
    {
      two.AddFace(f);
    }
  }
  two.Finish();
  EXPECT_EQ(two.Model.EdgeCount(), 2 * box.EdgeCount());
  const nurbs::AssembledModel model = nurbs::AssembleModel(two.Model.Arrays());
  EXPECT_TRUE(model.Problems.empty());
}

// What is wrong with a face is wrong with it in its piece, too, for the same reason.
TEST(PieceBuilder, BadFacesStayBad)
{
  ModelBuilder bad;
  solids::AddBox(bad, nurbs::Vec3(1, 1, 1), solids::At(nurbs::Vec3(0, 0, 0)));
  bad.Data.Knots[1] = 5.0;         // Decreasing knots of face 0.
  bad.Data.Connectivity[4] = 1000; // No such point, of face 1.
  bad.Data.KnotStart[4] = 1 << 20; // No such knots, of face 2.
  bad.Data.LoopStart[3] = 1 << 20; // No such loops, of face 3.
  const nurbs::AssembledModel whole = nurbs::AssembleModel(bad.Arrays());
  const PieceBuilder piece = nurbs::TakeFaces(bad, 0, 6);
  const nurbs::AssembledModel taken = nurbs::AssembleModel(piece.Model.Arrays());
  for (int f = 0; f < 6; ++f)
  {
    EXPECT_EQ(whole.FaceErrors[f].empty(), taken.FaceErrors[f].empty()) << f;
    EXPECT_EQ(whole.FaceErrors[f].empty(), f >= 4) << f << ": " << whole.FaceErrors[f];
  }
  EXPECT_EQ(whole.FaceErrors[0], taken.FaceErrors[0]);
}

} // namespace
