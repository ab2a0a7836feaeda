// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSTessellatedDrawing.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkCompositePolyDataMapper2.h"
#include "vtkMath.h"
#include "vtkNURBSMapper.h"
#include "vtkNURBSTessellator.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkRenderer.h"

#include <algorithm>
#include <cmath>

namespace
{

// Pixels of a unit of length at the model, as the camera sees it.
double ScaleOf(vtkRenderer* renderer, const double* bounds)
{
  vtkCamera* camera = renderer->GetActiveCamera();
  const double height = renderer->GetSize()[1];
  if (camera->GetParallelProjection())
  {
    return height / (2.0 * camera->GetParallelScale());
  }
  double nearest[3];
  for (int k = 0; k < 3; ++k)
  {
    nearest[k] = std::min(std::max(camera->GetPosition()[k], bounds[2 * k]), bounds[2 * k + 1]);
  }
  const double distance = std::sqrt(vtkMath::Distance2BetweenPoints(nearest, camera->GetPosition()));
  return height /
    (2.0 * std::tan(vtkMath::RadiansFromDegrees(0.5 * camera->GetViewAngle())) *
      std::max(distance, camera->GetClippingRange()[0]));
}

// What is said of blocks of the input, said of the blocks that were made of them.
vtkSmartPointer<vtkCompositeDataDisplayAttributes> Translate(
  vtkCompositeDataDisplayAttributes* given, vtkCompositeDataSet* from, vtkCompositeDataSet* to)
{
  auto result = vtkSmartPointer<vtkCompositeDataDisplayAttributes>::New();
  auto source = vtkSmartPointer<vtkCompositeDataIterator>::Take(from->NewIterator());
  for (source->InitTraversal(); given && !source->IsDoneWithTraversal(); source->GoToNextItem())
  {
    vtkDataObject* block = source->GetCurrentDataObject();
    vtkDataObject* made = to->GetDataSet(source);
    if (made && given->HasBlockVisibility(block))
    {
      result->SetBlockVisibility(made, given->GetBlockVisibility(block));
    }
    if (made && given->HasBlockColor(block))
    {
      double color[3];
      given->GetBlockColor(block, color);
      result->SetBlockColor(made, color);
    }
    if (made && given->HasBlockOpacity(block))
    {
      result->SetBlockOpacity(made, given->GetBlockOpacity(block));
    }
  }
  return result;
}

} // namespace

vtkNURBSTessellatedDrawing::vtkNURBSTessellatedDrawing() = default;
vtkNURBSTessellatedDrawing::~vtkNURBSTessellatedDrawing() = default;

void vtkNURBSTessellatedDrawing::Render(
  vtkNURBSMapper* mapper, vtkDataObject* input, vtkRenderer* renderer, vtkActor* actor)
{
  const bool isComposite = input->IsA("vtkCompositeDataSet");
  if (!this->Triangles || isComposite != (this->Triangles->IsA("vtkCompositePolyDataMapper2") != 0))
  {
    this->Triangles = isComposite ? vtkSmartPointer<vtkPolyDataMapper>(
                                      vtkSmartPointer<vtkCompositePolyDataMapper2>::New())
                                  : vtkSmartPointer<vtkPolyDataMapper>::New();
    this->Scale = 0.0;
  }
  const double scale = ScaleOf(renderer, actor->GetBounds());
  this->Tessellator->SetInputDataObject(input);
  this->Tessellator->SetToleranceModeToAbsolute();
  if (scale > 2.0 * this->Scale || scale < 0.25 * this->Scale)
  {
    this->Scale = scale;
  }
  // Twice as fine as needed now, so that it lasts till the view is twice as large.
  this->Tessellator->SetAbsoluteTolerance(0.5 * mapper->GetPixelError() / this->Scale);
  this->Tessellator->Update();
  this->Triangles->vtkMapper::ShallowCopy(mapper);
  this->Triangles->SetInputDataObject(this->Tessellator->GetOutputDataObject(0));
  this->Triangles->SetStatic(true);
  if (auto* blocks = vtkCompositePolyDataMapper2::SafeDownCast(this->Triangles))
  {
    blocks->SetCompositeDataDisplayAttributes(Translate(mapper->GetCompositeDataDisplayAttributes(),
      vtkCompositeDataSet::SafeDownCast(input),
      vtkCompositeDataSet::SafeDownCast(this->Tessellator->GetOutputDataObject(0))));
  }
  this->Triangles->Render(renderer, actor);
  this->NumberOfTriangles =
    this->Tessellator->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL);
}

void vtkNURBSTessellatedDrawing::ReleaseGraphicsResources(vtkWindow* window)
{
  if (this->Triangles)
  {
    this->Triangles->ReleaseGraphicsResources(window);
  }
}
