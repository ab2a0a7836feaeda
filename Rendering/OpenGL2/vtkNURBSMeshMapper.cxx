// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSMeshMapper.h"

#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkNURBSMeshMapper);

vtkNURBSMeshMapper::vtkNURBSMeshMapper() = default;
vtkNURBSMeshMapper::~vtkNURBSMeshMapper() = default;

// The superclass appends to TempState what the buffers depend on, and makes them if it differs from what
// it was when it made them last.
void vtkNURBSMeshMapper::BuildIBO(vtkRenderer* renderer, vtkActor* actor, vtkPolyData* mesh)
{
  this->TempState.Clear();
  this->Superclass::BuildIBO(renderer, actor, mesh);
}

void vtkNURBSMeshMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}
