// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSMeshMapper.h"

#include "vtkActor.h"
#include "vtkDoubleArray.h"
#include "vtkNURBSDeformingTessellator.h"
#include "vtkNURBSEGLRenderWindow.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkRenderer.h"
#include "vtkTestImage.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

// Shows what the superclass compares to know whether its index buffers are those of the cells.
template <typename MapperT>
class StateMapper : public MapperT
{
public:
  static StateMapper* New() { return new StateMapper; }
  const vtkStateStorage& State() const { return this->IBOBuildState; }
};

struct Scene
{
  vtkNew<vtkUnstructuredGrid> Model;
  vtkNew<vtkNURBSDeformingTessellator> Filter;
  vtkNew<vtkActor> Actor;
  vtkNew<vtkRenderer> Renderer;
  vtkSmartPointer<vtkNURBSEGLRenderWindow> Window;

  explicit Scene(vtkPolyDataMapper* mapper)
  {
    vtkNew<vtkNURBSShapeSource> source;
    source->SetShapeToTeapot();
    source->Update();
    this->Model->DeepCopy(source->GetOutputDataObject(0));
    this->Filter->SetInputData(this->Model);
    mapper->SetInputConnection(this->Filter->GetOutputPort());
    mapper->ScalarVisibilityOff();
    this->Actor->SetMapper(mapper);
    this->Renderer->AddActor(this->Actor);
    this->Window =
      vtkSmartPointer<vtkNURBSEGLRenderWindow>::Take(vtkNURBSEGLRenderWindow::Create(160, 160));
    this->Window->AddRenderer(this->Renderer);
    this->Renderer->ResetCamera();
  }
  void Move(double height)
  {
    vtkPoints* points = this->Model->GetPoints();
    for (vtkIdType k = 0; k < points->GetNumberOfPoints(); ++k)
    {
      double x[3];
      points->GetPoint(k, x);
      x[2] += height * std::sin(x[0]);
      points->SetPoint(k, x);
    }
    points->Modified();
  }
};

// Points that move leave the index buffers alone; cells that change do not.
TEST(TestNURBSMeshMapper, KeepsItsIndices)
{
  vtkNew<StateMapper<vtkNURBSMeshMapper>> mapper;
  Scene scene(mapper);
  scene.Filter->ResolutionRefinementOff();
  scene.Window->Render();
  vtkStateStorage first;
  first = mapper->State();
  auto* mesh = vtkPolyData::SafeDownCast(scene.Filter->GetOutputDataObject(0));
  const vtkMTimeType points = mesh->GetPoints()->GetMTime();
  for (int frame = 0; frame < 3; ++frame)
  {
    scene.Move(0.01);
    scene.Window->Render();
    EXPECT_EQ(scene.Filter->GetRebuiltModels(), 0);
    EXPECT_FALSE(mapper->State() != first);
  }
  EXPECT_GT(mesh->GetPoints()->GetMTime(), points);
  scene.Filter->SetTolerance(1e-4);
  scene.Window->Render();
  EXPECT_TRUE(mapper->State() != first);
}

// What is drawn is what VTK's mapper draws, frame after frame, whether cells change or not.
TEST(TestNURBSMeshMapper, DrawsWhatItShould)
{
  vtkNew<vtkNURBSMeshMapper> ours;
  vtkNew<vtkPolyDataMapper> vtks;
  Scene a(ours);
  Scene b(vtks);
  for (int frame = 0; frame < 4; ++frame)
  {
    for (Scene* scene : { &a, &b })
    {
      scene->Move(frame == 0 ? 0.0 : 0.1);
      scene->Window->Render();
    }
    const vtkSmartPointer<vtkImageData> picture = vtkTestImage::Take(a.Window);
    EXPECT_EQ(vtkTestImage::MeanDifference(picture, vtkTestImage::Take(b.Window)), 0.0) << frame;
    EXPECT_GT(vtkTestImage::CountOthers(picture, { 0, 0, 0 }), 160 * 160 / 10);
  }
}

} // namespace
