// SPDX-License-Identifier: BSD-3-Clause
// A user's program: an exact sphere, tessellated, and at a coarse level of detail.
#include <vtkNURBSShapeSource.h>
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
  return triangles > 0 && levels->GetNumberOfTriangles() > 0 ? 0 : 1;
}
