// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSModelBlocks
 * @brief What a representation delivers: the models of its input as a vtkMultiBlockDataSet
 *
 * ParaView 5.11 delivers no vtkPartitionedDataSetCollection, and names blocks by the paths of a
 * vtkMultiBlockDataSet of the input's structure, as vtkPVGeometryFilter makes it. Grids are shared with
 * the input; leaves of other types are left out. An input that is no composite is the only block; the
 * output has the field data SingleBlock() then, which vtkGeometryRepresentation looks for. Private to
 * this module.
 */
#ifndef vtkNURBSModelBlocks_h
#define vtkNURBSModelBlocks_h

#include "vtkMultiBlockDataSetAlgorithm.h"

class vtkNURBSModelBlocks : public vtkMultiBlockDataSetAlgorithm
{
public:
  static vtkNURBSModelBlocks* New();
  vtkTypeMacro(vtkNURBSModelBlocks, vtkMultiBlockDataSetAlgorithm);

  static const char* SingleBlock() { return "vtkGeometryRepresentationMultiBlockMaker"; }

  /// What is drawn of an output: itself, or its only block if the input was no composite.
  static vtkDataObject* GetDrawn(vtkDataObject* output);

protected:
  vtkNURBSModelBlocks() = default;
  ~vtkNURBSModelBlocks() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkNURBSModelBlocks(const vtkNURBSModelBlocks&) = delete;
  void operator=(const vtkNURBSModelBlocks&) = delete;
};

#endif
