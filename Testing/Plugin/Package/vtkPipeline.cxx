// SPDX-License-Identifier: BSD-3-Clause
// A user's program: an exact sphere, tessellated.
#include <vtkNURBSShapeSource.h>
#include <vtkNURBSTessellator.h>

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
  return triangles > 0 ? 0 : 1;
}
