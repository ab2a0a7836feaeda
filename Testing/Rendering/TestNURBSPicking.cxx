// SPDX-License-Identifier: BSD-3-Clause
// vtkCellPicker with vtkNURBSCellLocator, on a mapper whose input is a model.
#include "vtkNURBSCellLocator.h"
#include "vtkNURBSEGLRenderWindow.h"
#include "vtkNURBSShapeSource.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCellPicker.h"
#include "vtkCompositePolyDataMapper2.h"
#include "vtkDataSetMapper.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPlane.h"
#include "vtkRenderer.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

vtkSmartPointer<vtkUnstructuredGrid> Shape(int type)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(type);
  source->Update();
  return vtkUnstructuredGrid::SafeDownCast(source->GetOutputDataObject(0));
}

/// A model seen from z in parallel projection: 200 x 200 pixels for [-2, 2] x [-2, 2].
struct Scene
{
  vtkSmartPointer<vtkUnstructuredGrid> Model;
  vtkNew<vtkDataSetMapper> Mapper;
  vtkNew<vtkActor> Actor;
  vtkNew<vtkRenderer> Renderer;
  vtkSmartPointer<vtkNURBSEGLRenderWindow> Window;
  vtkNew<vtkNURBSCellLocator> Locator;
  vtkNew<vtkCellPicker> Picker;

  explicit Scene(int shape)
    : Model(Shape(shape))
    , Window(
        vtkSmartPointer<vtkNURBSEGLRenderWindow>::Take(vtkNURBSEGLRenderWindow::Create(200, 200)))
  {
    this->Mapper->SetInputData(this->Model);
    this->Actor->SetMapper(this->Mapper);
    this->Renderer->AddActor(this->Actor);
    vtkCamera* camera = this->Renderer->GetActiveCamera();
    camera->ParallelProjectionOn();
    camera->SetParallelScale(2.0);
    camera->SetPosition(0, 0, 10);
    camera->SetFocalPoint(0, 0, 0);
    camera->SetClippingRange(1, 20);
    if (this->Window)
    {
      this->Window->AddRenderer(this->Renderer);
      this->Window->Render();
    }
    this->Locator->SetDataSet(this->Model);
    this->Picker->AddLocator(this->Locator);
  }
  bool Pick(double x, double y)
  {
    // Display coordinates of a point are those of its pixel's lower left corner.
    return this->Picker->Pick((x + 2.0) * 50.0, (y + 2.0) * 50.0, 0.0, this->Renderer) != 0;
  }
};

void ExpectNear(const double a[3], double x, double y, double z, double tolerance)
{
  EXPECT_NEAR(a[0], x, tolerance);
  EXPECT_NEAR(a[1], y, tolerance);
  EXPECT_NEAR(a[2], z, tolerance);
}

TEST(NURBSPicking, PointNormalAndFace)
{
  Scene scene(vtkNURBSShapeSource::SPHERE);
  ASSERT_TRUE(scene.Window);
  int picked = 0;
  for (int i = 0; i < 41; ++i)
  {
    for (int j = 0; j < 41; ++j)
    {
      const double x = 0.0613 * (i - 20), y = 0.0587 * (j - 20);
      const double square = 1.0 - x * x - y * y;
      ASSERT_EQ(scene.Pick(x, y), square > 0.0) << x << " " << y;
      if (square > 0.0)
      {
        ++picked;
        const double z = std::sqrt(square);
        ExpectNear(scene.Picker->GetPickPosition(), x, y, z, 1e-9 / z);
        ExpectNear(scene.Picker->GetPickNormal(), x, y, z, 1e-9 / z);
        EXPECT_EQ(scene.Picker->GetCellId(), 0);
        EXPECT_EQ(scene.Picker->GetDataSet(), scene.Model);
        EXPECT_EQ(scene.Picker->GetSubId(), 0);
        EXPECT_GT(scene.Picker->GetPCoords()[1], 0.5);
      }
      else
      {
        EXPECT_EQ(scene.Picker->GetCellId(), -1);
      }
    }
  }
  EXPECT_GT(picked, 800);
}

TEST(NURBSPicking, OneOfSeveralFacesOfAMovedActor)
{
  Scene scene(vtkNURBSShapeSource::CYLINDER); // radius 1 on z = 0, height 2
  ASSERT_TRUE(scene.Window);
  ASSERT_TRUE(scene.Pick(0.3, 0.4));
  const vtkIdType top = scene.Picker->GetCellId();
  ExpectNear(scene.Picker->GetPickPosition(), 0.3, 0.4, 2.0, 1e-9);
  ExpectNear(scene.Picker->GetPickNormal(), 0.0, 0.0, 1.0, 1e-12);

  // Lying down, half as long.
  scene.Actor->RotateX(90.0);
  scene.Actor->SetScale(1.0, 1.0, 0.5);
  ASSERT_TRUE(scene.Pick(0.6, -0.5));
  const vtkIdType side = scene.Picker->GetCellId();
  EXPECT_NE(side, top);
  ExpectNear(scene.Picker->GetPickPosition(), 0.6, -0.5, 0.8, 1e-9);
  ExpectNear(scene.Picker->GetPickNormal(), 0.6, 0.0, 0.8, 1e-9);
  EXPECT_FALSE(scene.Pick(0.6, 0.1));
  scene.Actor->RotateX(180.0);
  ASSERT_TRUE(scene.Pick(0.6, 0.5));
  EXPECT_EQ(scene.Picker->GetCellId(), side);

  // From below, the other cap.
  Scene below(vtkNURBSShapeSource::CYLINDER);
  below.Actor->RotateX(180.0);
  ASSERT_TRUE(below.Pick(0.3, 0.4));
  EXPECT_NE(below.Picker->GetCellId(), top);
  EXPECT_NE(below.Picker->GetCellId(), side);
  ExpectNear(below.Picker->GetPickNormal(), 0.0, 0.0, 1.0, 1e-12);
}

TEST(NURBSPicking, TrimmedAwayAndClipped)
{
  Scene plate(vtkNURBSShapeSource::PLATE);
  ASSERT_TRUE(plate.Window);
  int picked = 0;
  for (int i = 0; i < 100; ++i)
  {
    picked += plate.Pick(-1.9 + 0.038 * i, 0.01) ? 1 : 0;
  }
  EXPECT_GT(picked, 10);
  EXPECT_LT(picked, 90);

  Scene sphere(vtkNURBSShapeSource::SPHERE);
  vtkNew<vtkPlane> plane; // keeps z < 0.25
  plane->SetOrigin(0, 0, 0.25);
  plane->SetNormal(0, 0, -1);
  sphere.Mapper->AddClippingPlane(plane);
  ASSERT_TRUE(sphere.Pick(0.3, 0.0));
  ExpectNear(sphere.Picker->GetPickPosition(), 0.3, 0.0, -std::sqrt(0.91), 1e-9);
}

TEST(NURBSPicking, ALocatorForEachModelOfAnAssembly)
{
  Scene scene(vtkNURBSShapeSource::SPHERE);
  ASSERT_TRUE(scene.Window);
  auto cylinder = Shape(vtkNURBSShapeSource::CYLINDER);
  vtkNew<vtkPartitionedDataSetCollection> assembly;
  assembly->SetNumberOfPartitions(0, 1);
  assembly->SetNumberOfPartitions(1, 1);
  assembly->SetPartition(0, 0, scene.Model);
  assembly->SetPartition(1, 0, cylinder);
  vtkNew<vtkCompositePolyDataMapper2> mapper; // draws nothing of it, but has it as its input
  mapper->SetInputDataObject(assembly);
  scene.Actor->SetMapper(mapper);
  vtkNew<vtkNURBSCellLocator> second;
  second->SetDataSet(cylinder);
  scene.Picker->AddLocator(second);
  ASSERT_TRUE(scene.Pick(0.3, 0.4));
  EXPECT_EQ(scene.Picker->GetDataSet(), cylinder);
  EXPECT_EQ(scene.Picker->GetPickPosition()[2], 2.0);
  EXPECT_GT(scene.Picker->GetFlatBlockIndex(), 0);
}

} // namespace
