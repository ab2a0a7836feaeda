// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVNURBSPiecePipeline.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNURBSPieces.h"
#include "vtkObjectFactory.h"

vtkStandardNewMacro(vtkPVNURBSPiecePipeline);

vtkPVNURBSPiecePipeline::vtkPVNURBSPiecePipeline() = default;

vtkPVNURBSPiecePipeline::~vtkPVNURBSPiecePipeline() = default;

void vtkPVNURBSPiecePipeline::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

// What a file tells before it is read may be missing: the request for its data says whether it is there.
int vtkPVNURBSPiecePipeline::ForwardUpstream(vtkInformation* request)
{
  const int done = this->Superclass::ForwardUpstream(request);
  return done || (request->Has(REQUEST_INFORMATION()) && vtkNURBSPieces::HasOtherProcesses());
}

int vtkPVNURBSPiecePipeline::ExecuteData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->IsCalled = true;
  return this->Superclass::ExecuteData(request, inputs, outputs);
}

vtkTypeBool vtkPVNURBSPiecePipeline::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->IsCalled = false;
  const vtkTypeBool done = this->Superclass::ProcessRequest(request, inputs, outputs);
  if (done || this->IsCalled || !request->Has(REQUEST_DATA()) ||
    !vtkNURBSPieces(request, outputs).IsParallel())
  {
    return done;
  }
  // All that follows is as after a failure of the filter itself, in this process as in the others.
  request->Set(vtkNURBSPieces::NO_INPUT(), 1);
  this->Superclass::ExecuteData(request, inputs, outputs);
  request->Remove(vtkNURBSPieces::NO_INPUT());
  this->DataTime.Modified();
  this->InformationTime.Modified();
  this->DataObjectTime.Modified();
  return 0;
}
