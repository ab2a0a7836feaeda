// SPDX-License-Identifier: BSD-3-Clause
// The judge of lines against scenes where it is plain what is visible.
#include "LineTruth.h"
#include "nurbsSolids.h"

#include <gtest/gtest.h>

namespace
{

using nurbs::Vec3;
using verify::Truth;

/// A slab [-4, 4]^2 x [-1, 0] with a block [-1, 1]^3 on it, and a ball of radius 1 beside it.
class LineTruthTest : public testing::Test
{
protected:
  LineTruthTest()
  {
    solids::AddBox(this->Builder, Vec3(4, 4, 0.5), solids::At(Vec3(0, 0, -0.5)));
    solids::AddBox(this->Builder, Vec3(1, 1, 1), solids::At(Vec3(0, 0, 1)));
    solids::AddSphere(this->Builder, 1.0, solids::At(Vec3(-2.5, 2.5, 1.5)));
    this->Assembled = nurbs::AssembleModel(this->Builder.Arrays());
    this->Caster = std::make_unique<nurbs::RayCaster>(this->Assembled.Model);
  }
  Truth At(const Vec3& point, const Vec3& tangent, const Vec3& view) const
  {
    return verify::LineTruth(*this->Caster, view, 1e-4).At(point, tangent);
  }

  nurbs::ModelBuilder Builder;
  nurbs::AssembledModel Assembled;
  std::unique_ptr<nurbs::RayCaster> Caster;
};

TEST_F(LineTruthTest, EdgesOfBlocks)
{
  const Vec3 view(1.0, 2.0, 1.5);
  EXPECT_EQ(this->At({ 0.3, 1, 2 }, Vec3::UnitX(), view), Truth::Visible);
  EXPECT_EQ(this->At({ 1, 1, 0.7 }, Vec3::UnitZ(), view), Truth::Visible);
  EXPECT_EQ(this->At({ 0.3, -1, 2 }, Vec3::UnitX(), view), Truth::Foremost); // An outline.
  EXPECT_EQ(this->At({ -1, -1, 0.7 }, Vec3::UnitZ(), view), Truth::Hidden);
  EXPECT_EQ(this->At({ 0.3, -4, -1 }, Vec3::UnitX(), view), Truth::Hidden);
  // Seen end on.
  EXPECT_EQ(this->At({ 1, 1, 0.7 }, Vec3::UnitZ(), Vec3::UnitZ()), Truth::Undecided);
}

TEST_F(LineTruthTest, Valleys)
{
  // Where the block stands on the slab: the walls rise in front of either side, and hide nothing;
  // also where the view is so low that they rise steeply.
  for (const double height : { 1.5, 0.1, 0.02 })
  {
    EXPECT_LE(this->At({ 0.3, 1, 0 }, Vec3::UnitX(), Vec3(1.0, 2.0, height)), Truth::Foremost);
    EXPECT_EQ(this->At({ 0.3, -1, 0 }, Vec3::UnitX(), Vec3(1.0, 2.0, height)), Truth::Hidden);
  }
}

TEST_F(LineTruthTest, Silhouettes)
{
  const Vec3 view = Vec3(0.2, -0.1, 1.0).normalized();
  const Vec3 across = view.cross(Vec3::UnitX()).normalized();
  const Vec3 contour = Vec3(-2.5, 2.5, 1.5) + across;
  EXPECT_LE(this->At(contour, view.cross(across), view), Truth::Foremost);
  // A little inside or outside of the contour is no other answer.
  EXPECT_LE(this->At(contour - 1e-4 * across, view.cross(across), view), Truth::Foremost);
  EXPECT_EQ(this->At(contour + 1e-4 * across, view.cross(across), view), Truth::Visible);
  // From below the slab hides it.
  EXPECT_EQ(this->At(contour, view.cross(across), -view), Truth::Hidden);
  EXPECT_EQ(this->At(contour - 1e-4 * across, view.cross(across), -view), Truth::Hidden);
}

TEST_F(LineTruthTest, BordersOfWhatHidesAreNotJudged)
{
  // Straight below the slab's upper edge is its lower one; seen from the side, both are free.
  EXPECT_EQ(this->At({ 4, 2, -1 }, Vec3::UnitY(), Vec3::UnitZ()), Truth::Undecided);
  EXPECT_EQ(this->At({ 4, 2, 0 }, Vec3::UnitY(), Vec3(0.1, 0, 1)), Truth::Visible);
  // A plate too thin to tell its lower edge from its upper one.
  const Vec3 low(0.0, 1.0, 1.0);
  EXPECT_EQ(
    verify::LineTruth(*this->Caster, low, 0.1).At({ 3, -4, 0 }, Vec3::UnitX()), Truth::Foremost);
  EXPECT_EQ(this->At({ 0, 4, 0 }, Vec3::UnitX(), low), Truth::Visible);
  // Under a corner of the block, where a line across it is a little in its shadow.
  EXPECT_EQ(this->At({ 0.9997, 0.9997, 0.1 }, Vec3(1, 1, 0), Vec3::UnitZ()), Truth::Undecided);
}

TEST_F(LineTruthTest, LengthsOfALineThatIsPartlyHidden)
{
  // On the slab, seen along y from above: the block's shadow is 2 + 2 long, 45 degrees.
  const Vec3 view(0.0, 1.0, 1.0);
  const verify::LineTruth truth(*this->Caster, view, 1e-4);
  const std::vector<Vec3> line = { Vec3(0, -4, 0), Vec3(0, -1, 0) }; // Behind the block.
  verify::LineLengths lengths;
  truth.Judge(line, true, 1e-3, lengths);
  truth.Judge(line, false, 1e-3, lengths);
  const double scale = std::sqrt(0.5);
  EXPECT_NEAR(lengths.Visible, 3.0 * scale, 1e-12);
  EXPECT_NEAR(lengths.Hidden, 3.0 * scale, 1e-12);
  EXPECT_NEAR(lengths.WrongVisible, 2.0 * scale, 5e-3); // From y = -3 to -1.
  EXPECT_NEAR(lengths.WrongHidden, 1.0 * scale, 5e-3);
  EXPECT_LT(lengths.Undecided, 5e-3);
}

} // namespace
