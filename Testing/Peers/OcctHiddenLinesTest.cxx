// SPDX-License-Identifier: BSD-3-Clause
// What is taken from OpenCASCADE's removers of hidden lines is what they mean: of a box and of a ball
// with a box in front.
#include "OcctHiddenLines.h"
#include "OcctMesh.h"

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Pnt.hxx>
#include <gtest/gtest.h>

#include <cmath>

namespace
{

using verify::HiddenLine;

double Length(const std::vector<HiddenLine>& lines, bool visible)
{
  double length = 0.0;
  for (const HiddenLine& line : lines)
  {
    for (std::size_t k = 0; line.Visible == visible && k + 1 < line.Points.size(); ++k)
    {
      length += (line.Points[k + 1] - line.Points[k]).norm();
    }
  }
  return length;
}

std::vector<HiddenLine> Hide(const TopoDS_Shape& shape, const Eigen::Vector3d& view, bool exact)
{
  if (exact)
  {
    return verify::HideExactly(shape, view, 1e-5);
  }
  verify::MeshByOcct(shape, 1e-3, false);
  return verify::HideByPolygons(shape, view);
}

TEST(OcctHiddenLines, OfABoxThreeEdges)
{
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(1, 2, 3), gp_Pnt(3, 5, 7)).Shape();
  for (const bool exact : { true, false })
  {
    const std::vector<HiddenLine> lines = Hide(box, Eigen::Vector3d(1, 1, 1), exact);
    EXPECT_NEAR(Length(lines, true), 3.0 * (2.0 + 3.0 + 4.0), 1e-6) << exact;
    EXPECT_NEAR(Length(lines, false), 2.0 + 3.0 + 4.0, 1e-6) << exact;
    for (const HiddenLine& line : lines)
    {
      for (const Eigen::Vector3d& p : line.Points)
      {
        // In the model's coordinates; the hidden edges meet at its lowest corner.
        EXPECT_GT((p - Eigen::Vector3d(0.999999, 1.999999, 2.999999)).minCoeff(), 0.0);
        EXPECT_LT((p - Eigen::Vector3d(3.000001, 5.000001, 7.000001)).maxCoeff(), 0.0);
        const int low = (p - Eigen::Vector3d(1, 2, 3)).cwiseAbs().minCoeff() < 1e-6;
        EXPECT_TRUE(line.Visible || low);
      }
    }
  }
}

TEST(OcctHiddenLines, OutlineOfABall)
{
  TopoDS_Compound scene;
  BRep_Builder builder;
  builder.MakeCompound(scene);
  builder.Add(scene, BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 0), 2.0).Shape());
  builder.Add(scene, BRepPrimAPI_MakeBox(gp_Pnt(0, -5, 3), gp_Pnt(5, 5, 4)).Shape());
  const double half = 2.0 * 3.14159265358979;
  for (const bool exact : { true, false })
  {
    // The box covers x > 0.
    std::vector<HiddenLine> ball;
    for (const HiddenLine& line : Hide(scene, Eigen::Vector3d(0, 0, 1), exact))
    {
      if (std::abs(line.Points[0].norm() - 2.0) < 1e-2)
      {
        ball.push_back(line);
        EXPECT_EQ(line.Kind, 0);
        for (const Eigen::Vector3d& p : line.Points)
        {
          EXPECT_NEAR(p[2], 0.0, exact ? 1e-4 : 0.1);
          EXPECT_GT(line.Visible ? -p[0] : p[0], exact ? -1e-4 : -0.1);
        }
      }
    }
    EXPECT_NEAR(Length(ball, true), half, 0.02 * half) << exact;
    EXPECT_NEAR(Length(ball, false), half, 0.02 * half) << exact;
  }
}

} // namespace
