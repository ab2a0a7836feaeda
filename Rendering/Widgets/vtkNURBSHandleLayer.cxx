// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSHandleLayer.h"

#include "vtkActor.h"
#include "vtkCellArray.h"
#include "vtkPoints.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkShaderProperty.h"

vtkNURBSHandleLayer::vtkNURBSHandleLayer(KindType kind)
  : Kind(kind)
{}

vtkNURBSHandleLayer::~vtkNURBSHandleLayer() = default;

void vtkNURBSHandleLayer::SetCells(vtkPoints* points, vtkCellArray* cells)
{
  this->Data->SetPoints(points);
  this->Data->SetVerts(this->Kind == DISCS ? cells : nullptr);
  this->Data->SetLines(this->Kind == LINES ? cells : nullptr);
  this->Data->Modified();
}

// The actors are made late: without a VTK that can draw there are none, and still handles.
void vtkNURBSHandleLayer::MakePass(Pass& pass, bool hidden)
{
  if (pass.Actor)
  {
    return;
  }
  pass.Mapper = vtkSmartPointer<vtkPolyDataMapper>::New();
  pass.Mapper->SetInputData(this->Data);
  pass.Mapper->ScalarVisibilityOff();
  pass.Actor = vtkSmartPointer<vtkActor>::New();
  pass.Actor->SetMapper(pass.Mapper);
  pass.Actor->ForceTranslucentOn();
  pass.Actor->GetProperty()->LightingOff();
  pass.Actor->GetProperty()->SetRenderPointsAsSpheres(this->Kind == DISCS);
  if (hidden)
  {
    const std::string depth = this->Kind == DISCS ? "gl_FragDepth" : "gl_FragCoord.z";
    pass.Actor->GetShaderProperty()->AddFragmentShaderReplacement("//VTK::Depth::Impl", true,
      "//VTK::Depth::Impl\n  gl_FragDepth = 0.01 * " + depth + ";\n", false);
  }
}

void vtkNURBSHandleLayer::SetStyle(
  const double color[3], double size, double opacity, double hiddenOpacity)
{
  this->Opacity = opacity;
  this->HiddenOpacity = hiddenOpacity;
  this->MakePass(this->Visible, false);
  this->MakePass(this->Hidden, true);
  for (Pass* pass : { &this->Visible, &this->Hidden })
  {
    vtkProperty* look = pass->Actor->GetProperty();
    look->SetColor(color[0], color[1], color[2]);
    look->SetPointSize(float(size));
    look->SetLineWidth(float(size));
  }
  this->Visible.Actor->GetProperty()->SetOpacity(opacity);
  this->Hidden.Actor->GetProperty()->SetOpacity(hiddenOpacity);
}

bool vtkNURBSHandleLayer::IsEmpty() const
{
  return this->Data->GetNumberOfCells() == 0;
}

int vtkNURBSHandleLayer::Render(Pass& pass, double opacity, vtkViewport* viewport)
{
  return this->IsEmpty() || opacity <= 0.0
    ? 0
    : pass.Actor->RenderTranslucentPolygonalGeometry(viewport);
}

int vtkNURBSHandleLayer::RenderHidden(vtkViewport* viewport)
{
  return this->Render(this->Hidden, this->HiddenOpacity, viewport);
}

int vtkNURBSHandleLayer::RenderVisible(vtkViewport* viewport)
{
  return this->Render(this->Visible, this->Opacity, viewport);
}

void vtkNURBSHandleLayer::ReleaseGraphicsResources(vtkWindow* window)
{
  for (Pass* pass : { &this->Visible, &this->Hidden })
  {
    if (pass->Actor)
    {
      pass->Actor->ReleaseGraphicsResources(window);
    }
  }
}
