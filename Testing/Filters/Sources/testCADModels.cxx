// SPDX-License-Identifier: BSD-3-Clause
#include "testCADModels.h"

#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <GeomAPI_ProjectPointOnSurf.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>

#include <gtest/gtest.h>

#include <map>

std::string OutputPath(const std::string& name)
{
  return std::string(NURBS_TEST_OUTPUT) + "/" + name;
}

std::string WriteBrep(const TopoDS_Shape& shape, const std::string& name)
{
  const std::string path = OutputPath(name + ".brep");
  EXPECT_TRUE(BRepTools::Write(shape, path.c_str()));
  return path;
}

Grids Models(vtkNURBSCADReader* reader)
{
  reader->Update();
  Grids grids;
  vtkPartitionedDataSetCollection* output = reader->GetOutput();
  for (unsigned int i = 0; i < output->GetNumberOfPartitionedDataSets(); ++i)
  {
    grids.emplace_back(vtkUnstructuredGrid::SafeDownCast(output->GetPartitionAsDataObject(i, 0)));
  }
  return grids;
}

vtkSmartPointer<vtkUnstructuredGrid> ReadOne(const std::string& path)
{
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(path.c_str());
  const Grids grids = Models(reader);
  EXPECT_EQ(grids.size(), 1u) << path;
  return grids.empty() ? vtkSmartPointer<vtkUnstructuredGrid>::New() : grids[0];
}

vtkSmartPointer<vtkUnstructuredGrid> Convert(const TopoDS_Shape& shape, const std::string& name)
{
  return ReadOne(WriteBrep(shape, name));
}

void ExpectSameFaces(
  vtkUnstructuredGrid* grid, const TopoDS_Shape& shape, double tolerance, double edgeTolerance)
{
  EXPECT_EQ(vtkNURBSModel::Validate(grid), "");
  const auto view = vtkNURBSModel::View(grid);
  const nurbs::Model& model = view->GetModel();
  std::size_t i = 0;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next(), ++i)
  {
    ASSERT_LT(i, model.Faces.size());
    const nurbs::Face& face = model.Faces[i];
    EXPECT_EQ(face.FaceId, static_cast<std::int64_t>(i));
    EXPECT_EQ(face.Reversed, it.Current().Orientation() == TopAbs_REVERSED) << "face " << i;
    const Handle(Geom_Surface) original = BRep_Tool::Surface(TopoDS::Face(it.Current()));
    for (int k = 0; k < 49; ++k)
    {
      const nurbs::Interval u = face.Geometry.Domain(0), v = face.Geometry.Domain(1);
      const nurbs::Vec3 p = nurbs::Evaluate(face.Geometry,
        u.Min + u.Length() * ((k % 7) + 0.31) / 7.0, v.Min + v.Length() * ((k / 7) + 0.43) / 7.0);
      const GeomAPI_ProjectPointOnSurf foot(gp_Pnt(p[0], p[1], p[2]), original);
      ASSERT_GT(foot.NbPoints(), 0) << "face " << i;
      EXPECT_LT(foot.LowerDistance(), tolerance) << "face " << i;
    }
  }
  EXPECT_EQ(i, model.Faces.size());
  const EdgeFit fit = MeasureEdges(model);
  EXPECT_LT(fit.Distance, edgeTolerance);
  EXPECT_LT(fit.Excess, 1e-12);
}

EdgeFit MeasureEdges(const nurbs::Model& model)
{
  EdgeFit fit;
  constexpr int Samples = 517;
  for (const nurbs::Face& face : model.Faces)
  {
    for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
    {
      const nurbs::TrimLoop& loop = model.Loops[l];
      for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
      {
        const nurbs::TrimCurve& trim = model.TrimCurves[c];
        const nurbs::Edge& edge = model.Edges[trim.Edge];
        if (edge.Geometry.Count < 2)
        {
          continue;
        }
        const nurbs::Interval range = trim.Geometry.Domain();
        EXPECT_EQ(range.Min, edge.Geometry.Domain().Min);
        EXPECT_EQ(range.Max, edge.Geometry.Domain().Max);
        for (int k = 0; k <= Samples; ++k)
        {
          const double t = range.Clamp(range.Min + range.Length() * k / Samples);
          const nurbs::Vec2 uv = nurbs::Evaluate(trim.Geometry, t);
          const double d =
            (nurbs::Evaluate(face.Geometry, uv[0], uv[1]) - nurbs::Evaluate(edge.Geometry, t))
              .norm();
          fit.Distance = std::max(fit.Distance, d);
          fit.Excess = std::max(fit.Excess, d - edge.Tolerance);
        }
      }
    }
  }
  return fit;
}

void ExpectClosed(vtkUnstructuredGrid* grid)
{
  const auto view = vtkNURBSModel::View(grid);
  const nurbs::Model& model = view->GetModel();
  std::vector<int> uses(model.Edges.size(), 0), balance(model.Edges.size(), 0);
  for (const nurbs::Face& face : model.Faces)
  {
    for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
    {
      const nurbs::TrimLoop& loop = model.Loops[l];
      for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
      {
        const nurbs::TrimCurve& trim = model.TrimCurves[c];
        ASSERT_GE(trim.Edge, 0);
        ++uses[trim.Edge];
        balance[trim.Edge] += trim.Reversed != face.Reversed ? 1 : -1;
      }
    }
  }
  for (std::size_t e = 0; e < uses.size(); ++e)
  {
    if (model.Edges[e].Geometry.Degree > 0)
    {
      EXPECT_EQ(uses[e], 2) << "edge " << e;
      EXPECT_EQ(balance[e], 0) << "edge " << e;
    }
    else
    {
      EXPECT_EQ(uses[e], 1) << "pole " << e;
    }
  }
}

nurbs::Vec3 Outside(const nurbs::Face& face, double u, double v)
{
  const nurbs::Interval us = face.Geometry.Domain(0), vs = face.Geometry.Domain(1);
  const nurbs::Vec3 normal =
    nurbs::Normal(face.Geometry, us.Min + u * us.Length(), vs.Min + v * vs.Length());
  return face.Reversed ? nurbs::Vec3(-normal) : normal;
}
