// SPDX-License-Identifier: BSD-3-Clause
// A user's program: an exact sphere, tessellated, at a coarse level of detail, and its silhouette.
#include <vtkNURBSShapeSource.h>
#include <vtkNURBSSilhouette.h>
#include <vtkNURBSTessellator.h>
#include <vtkNURBSWaveletLOD.h>

#include <vtkNew.h>
#include <vtkPolyData.h>

#include <cstdio>

int main()
{
  vtkNew<vtkNURBSShapeSource> shape;
  vtkNew<vtkNURBSTessellator> tessellator;
  tessellator->SetInputConnection(shape->GetOutputPort());
  tessellator->Update();
  auto* mesh = vtkPolyData::SafeDownCast(tessellator->GetOutputDataObject(0));
  const long long triangles = mesh ? mesh->GetNumberOfPolys() : 0;
  std::printf("%lld triangles\n", triangles);
  vtkNew<vtkNURBSWaveletLOD> levels;
  levels->SetInputConnection(shape->GetOutputPort());
  levels->SetLevel(4);
  levels->Update();
  vtkNew<vtkNURBSSilhouette> silhouette;
  silhouette->SetInputConnection(shape->GetOutputPort());
  silhouette->Update();
  return triangles > 0 && levels->GetNumberOfTriangles() > 0 &&
      silhouette->GetNumberOfComponents() == 1
    ? 0
    : 1;
}
