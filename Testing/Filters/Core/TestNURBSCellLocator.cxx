// SPDX-License-Identifier: BSD-3-Clause
// vtkNURBSCellLocator on shapes with closed forms, and against a mesh's locator.
#include "../../testMessageKeeper.h"
#include "RayCaster.h"
#include "vtkNURBSCellLocator.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNURBSTessellator.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkMath.h"
#include "vtkMinimalStandardRandomSequence.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolygon.h"
#include "vtkSmartPointer.h"
#include "vtkStaticCellLocator.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace
{

vtkSmartPointer<vtkUnstructuredGrid> Shape(int type)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(type);
  source->SetNumberOfPatches(500);
  source->Update();
  return vtkUnstructuredGrid::SafeDownCast(source->GetOutputDataObject(0));
}

vtkSmartPointer<vtkNURBSCellLocator> Locate(vtkDataSet* data)
{
  auto locator = vtkSmartPointer<vtkNURBSCellLocator>::New();
  locator->SetDataSet(data);
  return locator;
}

/// What IntersectWithLine gives.
struct Hit
{
  bool Found = false;
  double T = -1.0;
  double X[3] = { 0, 0, 0 };
  double PCoords[3] = { -1, -1, -1 };
  int SubId = -1;
  vtkIdType CellId = -1;
  vtkNew<vtkGenericCell> Cell;

  Hit(vtkAbstractCellLocator* locator, const double p1[3], const double p2[3])
  {
    this->Found = locator->IntersectWithLine(p1, p2, 1e-6, this->T, this->X, this->PCoords,
                    this->SubId, this->CellId, this->Cell) != 0;
  }
};

class Random
{
public:
  double Uniform(double a, double b)
  {
    this->Sequence->Next();
    return this->Sequence->GetRangeValue(a, b);
  }

private:
  vtkNew<vtkMinimalStandardRandomSequence> Sequence;
};

TEST(NURBSCellLocator, GivesPointParametersAndTangentSquare)
{
  auto sphere = Shape(vtkNURBSShapeSource::SPHERE);
  auto locator = Locate(sphere);
  Random random;
  int found = 0;
  for (int i = 0; i < 500; ++i)
  {
    double p1[3], p2[3];
    for (int k = 0; k < 3; ++k)
    {
      p1[k] = random.Uniform(-1, 1) + (k == 0 ? 4.0 : 0.0);
      p2[k] = random.Uniform(-1, 1) - (k == 0 ? 4.0 : 0.0);
    }
    const Hit hit(locator, p1, p2);
    double direction[3];
    vtkMath::Subtract(p2, p1, direction);
    const double a = vtkMath::Dot(direction, direction), b = vtkMath::Dot(p1, direction);
    const double root = b * b - a * (vtkMath::Dot(p1, p1) - 1.0);
    ASSERT_EQ(hit.Found, root > 0.0);
    if (!hit.Found)
    {
      continue;
    }
    ++found;
    EXPECT_NEAR(hit.T, (-b - std::sqrt(root)) / a, 1e-9);
    EXPECT_NEAR(vtkMath::Norm(hit.X), 1.0, 1e-14);
    EXPECT_EQ(hit.CellId, 0);
    EXPECT_EQ(hit.SubId, 0);
    ASSERT_EQ(hit.Cell->GetCellType(), VTK_QUAD);
    double normal[3], x[3], weights[4], pcoords[3] = { hit.PCoords[0], hit.PCoords[1], 0.0 };
    vtkPolygon::ComputeNormal(hit.Cell->GetPoints(), normal);
    int subId = 0;
    hit.Cell->EvaluateLocation(subId, pcoords, x, weights);
    for (int k = 0; k < 3; ++k)
    {
      EXPECT_NEAR(normal[k], hit.X[k], 1e-12);
      EXPECT_NEAR(x[k], hit.X[k], 1e-12);
    }
    // u turns about z, v goes from the south pole to the north pole.
    const double turn = std::atan2(hit.X[1], hit.X[0]) / (2.0 * vtkMath::Pi());
    EXPECT_NEAR(hit.PCoords[0], turn < 0.0 ? turn + 1.0 : turn, 0.02);
    EXPECT_NEAR(hit.PCoords[1], 0.5 + std::asin(hit.X[2]) / vtkMath::Pi(), 0.03);
    // The segment's end short of the sphere: no hit. Without a cell: the same.
    double before[3], t, y[3];
    vtkIdType cellId;
    for (int k = 0; k < 3; ++k)
    {
      before[k] = p1[k] + (hit.T - 1e-6) * direction[k];
    }
    EXPECT_FALSE(Hit(locator, p1, before).Found);
    EXPECT_TRUE(locator->IntersectWithLine(p1, p2, 0.0, t, y, pcoords, subId, cellId, nullptr));
    EXPECT_EQ(t, hit.T);
  }
  EXPECT_GT(found, 250);
}

TEST(NURBSCellLocator, AreaOfThePlateByLines)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToPlate();
  source->Update();
  auto locator = Locate(vtkDataSet::SafeDownCast(source->GetOutputDataObject(0)));
  const double* bounds = locator->GetDataSet()->GetBounds();
  Random random;
  const int count = 200;
  int hits = 0;
  for (int i = 0; i < count * count; ++i)
  {
    const double x =
      bounds[0] + (i % count + random.Uniform(0, 1)) * (bounds[1] - bounds[0]) / count;
    const double y =
      bounds[2] + (i / count + random.Uniform(0, 1)) * (bounds[3] - bounds[2]) / count;
    const double p1[3] = { x, y, 1 }, p2[3] = { x, y, -1 };
    const Hit hit(locator, p1, p2);
    hits += hit.Found ? 1 : 0;
    EXPECT_TRUE(!hit.Found || std::abs(hit.T - 0.5) < 1e-15);
  }
  const double area = (bounds[1] - bounds[0]) * (bounds[3] - bounds[2]) * hits / (count * count);
  EXPECT_NEAR(area, source->GetPlateArea(), 1e-3 * area);
}

TEST(NURBSCellLocator, FindsTheFacesThatAMeshHas)
{
  for (const int shape : { vtkNURBSShapeSource::TEAPOT, vtkNURBSShapeSource::CAR_BODY,
         vtkNURBSShapeSource::CYLINDER, vtkNURBSShapeSource::TORUS, vtkNURBSShapeSource::CONE })
  {
    auto model = Shape(shape);
    vtkNew<vtkNURBSTessellator> tessellator;
    tessellator->SetInputData(model);
    tessellator->SetTolerance(1e-4);
    vtkNew<MessageKeeper> warnings; // at poles the bound is not reached: of no matter here
    tessellator->AddObserver(vtkCommand::WarningEvent, warnings);
    tessellator->Update();
    vtkPolyData* mesh = vtkPolyData::SafeDownCast(tessellator->GetOutputDataObject(0));
    vtkDataArray* faceIds = mesh->GetCellData()->GetArray(vtkNURBSModel::FaceIdName());
    vtkNew<vtkStaticCellLocator> meshLocator;
    meshLocator->SetDataSet(mesh);
    meshLocator->BuildLocator();
    auto locator = Locate(model);
    const double* b = mesh->GetBounds();
    const double size = mesh->GetLength();
    Random random;
    int same = 0, other = 0, hits = 0;
    for (int i = 0; i < 3000; ++i)
    {
      double p1[3], p2[3], middle[3], direction[3];
      for (int k = 0; k < 3; ++k)
      {
        middle[k] = random.Uniform(b[2 * k], b[2 * k + 1]);
        direction[k] = random.Uniform(-1, 1);
      }
      vtkMath::Normalize(direction);
      for (int k = 0; k < 3; ++k)
      {
        p1[k] = middle[k] - 1.5 * size * direction[k];
        p2[k] = middle[k] + 1.5 * size * direction[k];
      }
      const Hit exact(locator, p1, p2), meshed(meshLocator, p1, p2);
      hits += exact.Found ? 1 : 0;
      const bool agree = exact.Found == meshed.Found &&
        (!exact.Found ||
          (std::abs(exact.T - meshed.T) < 1e-3 &&
            faceIds->GetTuple1(meshed.CellId) == vtkNURBSModel::GetFaceId(model, exact.CellId)));
      (agree ? same : other) += 1;
    }
    EXPECT_GT(hits, 1000) << shape;
    EXPECT_LT(other, 10) << shape << ": of rays that pass a rim, a few may";
  }
}

TEST(NURBSCellLocator, AllIntersections)
{
  auto torus = Shape(vtkNURBSShapeSource::TORUS);
  auto locator = Locate(torus);
  vtkNew<vtkPoints> points;
  vtkNew<vtkIdList> cells;
  const double outside[3] = { -3, 0, 0 }, inside[3] = { -1, 0, 0 }, end[3] = { 3, 0, 0 };
  EXPECT_EQ(locator->IntersectWithLine(outside, end, points, cells), 1);
  ASSERT_EQ(points->GetNumberOfPoints(), 4);
  const double expected[4] = { -1.3, -0.7, 0.7, 1.3 };
  for (int i = 0; i < 4; ++i)
  {
    EXPECT_NEAR(points->GetPoint(i)[0], expected[i], 1e-6); // points are floats
    EXPECT_EQ(cells->GetId(i), 0);
  }
  EXPECT_EQ(locator->IntersectWithLine(inside, end, points, cells), -1);
  EXPECT_EQ(points->GetNumberOfPoints(), 3);
  const double beyond[3] = { 5, 0, 0 };
  EXPECT_EQ(locator->IntersectWithLine(end, beyond, points, cells), 0);
  EXPECT_EQ(points->GetNumberOfPoints(), 0);

  // Through both caps of a cylinder, and across it.
  auto cylinder = Shape(vtkNURBSShapeSource::CYLINDER);
  locator = Locate(cylinder);
  const double low[3] = { 0.1, 0.2, -1 }, high[3] = { 0.1, 0.2, 5 };
  locator->FindCellsAlongLine(low, high, 0.0, cells);
  ASSERT_EQ(cells->GetNumberOfIds(), 2);
  const std::set<vtkIdType> caps{ cells->GetId(0), cells->GetId(1) };
  EXPECT_EQ(caps.size(), 2u);
  const double left[3] = { -3, 0.2, 1 }, right[3] = { 3, 0.2, 1 };
  locator->FindCellsAlongLine(left, right, 0.0, cells);
  ASSERT_EQ(cells->GetNumberOfIds(), 1);
  EXPECT_EQ(caps.count(cells->GetId(0)), 0u);
  double all[6] = { -2, 2, -2, 2, -2, 3 }, top[6] = { -0.1, 0.1, -0.1, 0.1, 1.9, 2.1 };
  locator->FindCellsWithinBounds(all, cells);
  EXPECT_EQ(cells->GetNumberOfIds(), 3);
  locator->FindCellsWithinBounds(top, cells);
  ASSERT_EQ(cells->GetNumberOfIds(), 1);
  EXPECT_EQ(caps.count(cells->GetId(0)), 1u);
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 0)
  const double origin[3] = { 0, 0, 1 }, up[3] = { 0, 0, 2 };
  locator->FindCellsAlongPlane(origin, up, 0.01, cells);
  ASSERT_EQ(cells->GetNumberOfIds(), 1);
  EXPECT_EQ(caps.count(cells->GetId(0)), 0u);
  EXPECT_EQ(locator->IntersectWithLine(inside, end, 0.0, points, cells, nullptr), 1);
#endif
}

TEST(NURBSCellLocator, FollowsItsData)
{
  auto sphere = Shape(vtkNURBSShapeSource::SPHERE);
  auto locator = Locate(sphere);
  const double p1[3] = { 0.01, 0.02, 9 }, p2[3] = { 0.01, 0.02, -9 };
  EXPECT_NEAR(Hit(locator, p1, p2).X[2], 1.0, 1e-3);
  const auto caster = locator->GetRayCaster();
  EXPECT_EQ(locator->GetRayCaster(), caster); // not built again
  vtkPoints* points = sphere->GetPoints();
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    double x[3];
    points->GetPoint(i, x);
    points->SetPoint(i, x[0], x[1], 2.0 * x[2]);
  }
  points->Modified();
  EXPECT_NEAR(Hit(locator, p1, p2).X[2], 2.0, 1e-3);
  EXPECT_NE(locator->GetRayCaster(), caster);
  locator->UseExistingSearchStructureOn();
  points->Modified();
  EXPECT_EQ(locator->GetRayCaster(), locator->GetRayCaster());
  vtkNew<vtkPolyData> boxes;
  locator->GenerateRepresentation(0, boxes);
  EXPECT_EQ(boxes->GetNumberOfPolys(), 6 * locator->GetRayCaster()->PartCount());
  double middle[3] = { 0, 0, 0 }, far[3] = { 0, 0, 2.5 };
  EXPECT_TRUE(locator->InsideCellBounds(middle, 0));
  EXPECT_FALSE(locator->InsideCellBounds(far, 0));
}

TEST(NURBSCellLocator, TellsWhatItCannotDo)
{
  auto sphere = Shape(vtkNURBSShapeSource::SPHERE);
  auto locator = Locate(sphere);
  vtkNew<MessageKeeper> errors;
  locator->AddObserver(vtkCommand::ErrorEvent, errors);
  double x[3] = { 0, 0, 2 }, closest[3], pcoords[3], weights[64], distance;
  vtkIdType cellId = 7;
  int subId;
  vtkNew<vtkGenericCell> cell;
  locator->FindClosestPoint(x, closest, cell, cellId, subId, distance);
  EXPECT_TRUE(errors->Says("Closest points"));
  EXPECT_EQ(cellId, -1);
  EXPECT_EQ(locator->FindClosestPointWithinRadius(x, 5.0, closest, cellId, subId, distance), 0);
  EXPECT_EQ(locator->FindCell(x, 0.0, cell, pcoords, weights), -1);
  EXPECT_TRUE(errors->Says("FindCell"));
  EXPECT_EQ(locator->FindCell(x), -1);
  const double p[3] = { 1, 2, 3 }, q[3] = { 1, 2, std::nan("") };
  EXPECT_FALSE(Hit(locator, p, p).Found);
  EXPECT_TRUE(errors->Says("no direction"));
  EXPECT_FALSE(Hit(locator, p, q).Found);
  vtkNew<vtkUnstructuredGrid> nothing;
  locator->SetDataSet(nothing);
  const double r[3] = { 1, 2, 4 };
  EXPECT_FALSE(Hit(locator, p, r).Found);
  EXPECT_TRUE(errors->Says("must be a NURBS model"));
}

} // namespace
