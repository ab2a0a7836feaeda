// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkPVNURBSPiecePipeline
 * @brief ParaView's executive, of filters that work together in all processes.
 *
 * An executive does not call a filter whose input could not be made. Where that is so in one process
 * only, a file that it lacks say, the others' filters would wait for it: here the filter is called all the
 * same, by a request that says so, fails, and tells the others (vtkNURBSPieces::Run).
 */
#ifndef vtkPVNURBSPiecePipeline_h
#define vtkPVNURBSPiecePipeline_h

#include "vtkNURBSParaViewServerModule.h" // For export macro
#include "vtkPVCompositeDataPipeline.h"

class VTKNURBSPARAVIEWSERVER_EXPORT vtkPVNURBSPiecePipeline : public vtkPVCompositeDataPipeline
{
public:
  static vtkPVNURBSPiecePipeline* New();
  vtkTypeMacro(vtkPVNURBSPiecePipeline, vtkPVCompositeDataPipeline);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  vtkTypeBool ProcessRequest(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

protected:
  vtkPVNURBSPiecePipeline();
  ~vtkPVNURBSPiecePipeline() override;

  int ForwardUpstream(vtkInformation* request) override;
  int ExecuteData(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkPVNURBSPiecePipeline(const vtkPVNURBSPiecePipeline&) = delete;
  void operator=(const vtkPVNURBSPiecePipeline&) = delete;

  bool IsCalled = false; ///< By the request that is processed now.
};

#endif
