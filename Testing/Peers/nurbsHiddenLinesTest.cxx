// SPDX-License-Identifier: BSD-3-Clause
// Our line drawings before the judge: outlines that run within a pixel of other lines.
#include "LineTruth.h"
#include "ModelExtent.h"
#include "Shapes.h"
#include "VisibleRegions.h"

#include <gtest/gtest.h>

namespace
{

using nurbs::Vec3;

struct Drawing
{
  double Size = 0.0;
  verify::LineLengths Lengths;

  Drawing(nurbs::ModelBuilder& builder, const Vec3& view, double precision)
  {
    const nurbs::AssembledModel made = nurbs::AssembleModel(builder.Arrays());
    this->Size = nurbs::Diagonal(nurbs::FaceBoxes(made.Model, made.FaceErrors, nurbs::SerialFor));
    nurbs::VisibleRegionOptions options;
    options.View.Place = view;
    options.Precision = precision * this->Size;
    options.Regions = false;
    options.SmoothLines = false;
    const nurbs::VisibleRegions result =
      nurbs::MakeVisibleRegions(made.Model, made.FaceErrors, options);
    const nurbs::RayCaster caster(made.Model);
    const verify::LineTruth truth(caster, view, options.Precision);
    for (const nurbs::DrawnLine& line : result.Drawn)
    {
      std::vector<Vec3> points;
      for (const nurbs::ContourPoint& point : line.Points)
      {
        points.push_back(point.Point);
      }
      if (line.Kind != nurbs::LineKind::Smooth)
      {
        truth.Judge(points, line.Visible, 1e-3 * this->Size, this->Lengths);
      }
    }
  }
};

} // namespace

// Along its axis nearly: outlines of one turn run beside those of the next.
TEST(HiddenLines, Spring)
{
  nurbs::ModelBuilder builder;
  nurbs::AddSpring(builder);
  const Drawing drawing(builder, Vec3(1.0, 0.02, 0.01), 1e-4);
  EXPECT_GT(drawing.Lengths.Visible, 7.0 * drawing.Size);
  EXPECT_GT(drawing.Lengths.Hidden, 3.0 * drawing.Size);
  EXPECT_LT(drawing.Lengths.WrongHidden, 1e-3 * drawing.Size);
  EXPECT_LT(drawing.Lengths.WrongVisible, 5e-4 * drawing.Size);
}

// Edges that are smooth and outlines of the faces beside them coincide to a fraction of a pixel.
TEST(HiddenLines, Vase)
{
  nurbs::ModelBuilder builder;
  nurbs::AddVase(builder);
  const Drawing drawing(builder, Vec3(0.3, -0.9, 0.2), 1e-3);
  EXPECT_GT(drawing.Lengths.Visible, 4.0 * drawing.Size);
  EXPECT_LT(drawing.Lengths.WrongHidden, 2e-3 * drawing.Size);
  EXPECT_LT(drawing.Lengths.WrongVisible, 5e-4 * drawing.Size);
}
