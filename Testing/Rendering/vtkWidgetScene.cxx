// SPDX-License-Identifier: BSD-3-Clause
#include "vtkWidgetScene.h"

#include "vtkCallbackCommand.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkInteractorStyleTrackballCamera.h"
#include "vtkMath.h"

#include <cmath>

namespace
{

vtkUnstructuredGrid* FirstModel(vtkDataObject* data)
{
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    vtkSmartPointer<vtkCompositeDataIterator> at;
    at.TakeReference(composite->NewIterator());
    at->InitTraversal();
    return vtkUnstructuredGrid::SafeDownCast(at->GetCurrentDataObject());
  }
  return vtkUnstructuredGrid::SafeDownCast(data);
}

void Count(vtkObject*, unsigned long event, void* events, void*)
{
  ++(*static_cast<std::map<unsigned long, int>*>(events))[event];
}

} // namespace

vtkSmartPointer<vtkUnstructuredGrid> vtkWidgetShape(int type, int sheet, double height)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(type);
  source->SetSheetPoints(sheet, sheet);
  source->SetSheetAmplitude(height);
  source->Update();
  return source->GetOutput();
}

vtkWidgetScene::vtkWidgetScene(vtkDataObject* model, bool parallel)
  : Window(vtkSmartPointer<vtkNURBSEGLRenderWindow>::Take(
      vtkNURBSEGLRenderWindow::Create(Width, Height)))
{
  this->Edits->SetInputDataObject(model);
  this->Edits->AddObserver(vtkCommand::ErrorEvent, this->Errors);
  this->Mapper->SetInputConnection(this->Edits->GetOutputPort());
  this->Actor->SetMapper(this->Mapper);
  this->Renderer->AddActor(this->Actor);
  this->Renderer->SetBackground(1.0, 1.0, 1.0);
  this->Window->SetMultiSamples(0);
  this->Window->AddRenderer(this->Renderer);
  this->Interactor->SetRenderWindow(this->Window);
  vtkNew<vtkInteractorStyleTrackballCamera> style;
  this->Interactor->SetInteractorStyle(style);
  this->Interactor->Initialize();
  vtkCamera* camera = this->Renderer->GetActiveCamera();
  camera->SetParallelProjection(parallel);
  camera->SetPosition(3.0, -4.0, 5.0);
  camera->SetFocalPoint(0.0, 0.0, 0.0);
  camera->SetViewUp(0.0, 0.0, 1.0);
  this->Renderer->ResetCamera();
  this->Widget->SetInteractor(this->Interactor);
  this->Widget->SetCurrentRenderer(this->Renderer);
  this->Widget->SetEdits(this->Edits);
  this->Widget->On();
  vtkNew<vtkCallbackCommand> count;
  count->SetCallback(Count);
  count->SetClientData(&this->Events);
  this->Widget->AddObserver(vtkCommand::AnyEvent, count);
  this->Window->Render();
}

vtkNURBSControlPointRepresentation* vtkWidgetScene::Handles()
{
  return this->Widget->GetControlPointRepresentation();
}

void vtkWidgetScene::Send(unsigned long event, const nurbs::Vec2& at, bool shift, bool control)
{
  this->Interactor->SetEventInformation(int(at[0]), int(at[1]), control, shift);
  this->Interactor->InvokeEvent(event);
}

void vtkWidgetScene::Press(const nurbs::Vec2& at, bool shift, bool control)
{
  this->Send(vtkCommand::LeftButtonPressEvent, at, shift, control);
}

void vtkWidgetScene::Move(const nurbs::Vec2& at)
{
  this->Send(vtkCommand::MouseMoveEvent, at);
}

void vtkWidgetScene::Release(const nurbs::Vec2& at)
{
  this->Send(vtkCommand::LeftButtonReleaseEvent, at);
}

void vtkWidgetScene::Click(const nurbs::Vec2& at, bool shift, bool control)
{
  this->Move(at);
  this->Press(at, shift, control);
  this->Release(at);
}

void vtkWidgetScene::Key(const char* symbol, bool shift, bool control)
{
  this->Interactor->SetKeyEventInformation(control, shift, 0, 0, symbol);
  this->Interactor->InvokeEvent(vtkCommand::KeyPressEvent);
}

nurbs::Vec3 vtkWidgetScene::DisplayOf(const nurbs::Vec3& point)
{
  this->Renderer->SetWorldPoint(point[0], point[1], point[2], 1.0);
  this->Renderer->WorldToDisplay();
  return nurbs::Vec3(this->Renderer->GetDisplayPoint());
}

nurbs::Vec2 vtkWidgetScene::PixelOf(const nurbs::Vec3& point)
{
  return this->DisplayOf(point).head<2>().array().round().matrix();
}

nurbs::Vec3 vtkWidgetScene::Before(vtkIdType point)
{
  return nurbs::Vec3(FirstModel(this->Edits->GetInputDataObject(0, 0))->GetPoint(point));
}

nurbs::Vec3 vtkWidgetScene::Now(vtkIdType point)
{
  this->Edits->Update();
  return nurbs::Vec3(FirstModel(this->Edits->GetOutputDataObject(0))->GetPoint(point));
}

double vtkWidgetScene::Weight(vtkIdType point)
{
  return this->Edits->GetBlockControlPointWeight(0, point);
}

nurbs::Vec3 vtkWidgetScene::Ahead()
{
  return nurbs::Vec3(this->Renderer->GetActiveCamera()->GetDirectionOfProjection());
}

nurbs::Vec3 vtkWidgetScene::Right()
{
  const nurbs::Vec3 up(this->Renderer->GetActiveCamera()->GetViewUp());
  return this->Ahead().cross(up).normalized();
}

nurbs::Vec3 vtkWidgetScene::Up()
{
  return this->Right().cross(this->Ahead());
}

double vtkWidgetScene::PixelSize(const nurbs::Vec3& point)
{
  vtkCamera* camera = this->Renderer->GetActiveCamera();
  const double pixels = this->Renderer->GetSize()[1];
  if (camera->GetParallelProjection())
  {
    return 2.0 * camera->GetParallelScale() / pixels;
  }
  const double distance = (point - nurbs::Vec3(camera->GetPosition())).dot(this->Ahead());
  const double angle = vtkMath::RadiansFromDegrees(camera->GetViewAngle());
  return 2.0 * distance * std::tan(0.5 * angle) / pixels;
}

vtkTestImage::Colour vtkWidgetScene::PixelColour(const nurbs::Vec2& at)
{
  return vtkTestImage::Pixel(vtkTestImage::Take(this->Window), int(at[0]), int(at[1]));
}
