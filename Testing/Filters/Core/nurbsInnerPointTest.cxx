// SPDX-License-Identifier: BSD-3-Clause
// Points well inside trimmed faces, against circles and frames whose widest places are known.
#include "InnerPoint.h"

#include "nurbsReference.h"
#include "nurbsTrimReference.h"

#include <gtest/gtest.h>

namespace
{

using nurbs::Vec2;
using reference::Polygon;
using reference::TrimmedSheet;

std::vector<Vec2> Rectangle(const Vec2& low, const Vec2& high)
{
  return { low, Vec2(high[0], low[1]), high, Vec2(low[0], high[1]) };
}

/// In the unit square's coordinates, like the loops.
Vec2 Found(const TrimmedSheet& sheet)
{
  const std::optional<Vec2> point = nurbs::InnerPoint(sheet.Model(), 0);
  EXPECT_TRUE(point);
  return point ? Vec2(((*point)[0] + 3.0) / 8.0, ((*point)[1] - 10.0) / 2.0) : Vec2(-1.0, -1.0);
}

TEST(InnerPoint, IsTheMiddleOfAnUntrimmedFace)
{
  EXPECT_LT((Found(TrimmedSheet({})) - Vec2(0.5, 0.5)).norm(), 1e-12);
}

TEST(InnerPoint, IsTheMiddleOfASmallPartOfTheDomain)
{
  const TrimmedSheet sheet({ Polygon(Rectangle({ 0.91, 0.03 }, { 0.93, 0.04 })) });
  EXPECT_LT((Found(sheet) - Vec2(0.92, 0.035)).norm(), 1e-12);
}

TEST(InnerPoint, IsInTheWidestPartBesideAHole)
{
  // 0.05 wide left of the hole, below and above it, 0.35 on the right.
  const TrimmedSheet sheet({ Polygon(Rectangle({ 0.0, 0.0 }, { 1.0, 1.0 })),
    Polygon(Rectangle({ 0.05, 0.05 }, { 0.65, 0.95 })) });
  const Vec2 p = Found(sheet);
  EXPECT_NEAR(p[0], 0.825, 1.0 / 15.0);
  EXPECT_GT(p[1], 0.15);
  EXPECT_LT(p[1], 0.85);
}

TEST(InnerPoint, IsFoundInANarrowFrame)
{
  // Narrower than the samples of the first grid are apart.
  const double width = 0.02;
  const TrimmedSheet sheet({ Polygon(Rectangle({ 0.0, 0.0 }, { 1.0, 1.0 })),
    Polygon(Rectangle({ width, width }, { 1.0 - width, 1.0 - width })) });
  const Vec2 p = Found(sheet);
  const double border = std::min({ p[0], p[1], 1.0 - p[0], 1.0 - p[1] });
  EXPECT_GT(border, 0.0);
  EXPECT_LT(border, width);
}

TEST(InnerPoint, IsNoneWithoutANet)
{
  nurbs::Model model;
  model.Faces.resize(1);
  EXPECT_FALSE(nurbs::InnerPoint(model, 0));
}

} // namespace
