// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSDeformingOutput.h
 * @brief One model's mesh as vtkPolyData, kept from frame to frame. Private to this module.
 */
#ifndef vtkNURBSDeformingOutput_h
#define vtkNURBSDeformingOutput_h

#include "vtkNURBSFaceAttributes.h"
#include "vtkNURBSMeshStore.h"

class vtkFieldData;
class vtkPolyData;
class vtkUnsignedCharArray;

/// The output of vtkNURBSDeformingTessellator for one model.
class vtkNURBSDeformingOutput
{
public:
  vtkNURBSDeformingOutput();
  ~vtkNURBSDeformingOutput();

  vtkNURBSMeshStore& GetStore() { return this->Store; }
  vtkPolyData* GetMesh() { return this->Mesh; }

  /// After a frame that did something.
  /// @param changed one a point: whether the frame changed it.
  /// @param mask whether the mesh shall have it.
  void Update(
    const nurbs::FrameReport& report, const std::vector<unsigned char>& changed, bool mask);
  /// After a frame that did nothing: no point changed, and the report says so from now on.
  void Rest(nurbs::FrameReport& report, bool mask);
  /// Cell data from the attributes of a grid of the mesh's structure.
  void TakeAttributes(vtkUnstructuredGrid* grid, const nurbs::FrameReport& report);
  /// Writes the field data; returns the seconds since `start` (of the steady clock).
  double Tell(vtkUnstructuredGrid* grid, const nurbs::FrameReport& report, double start);

private:
  void SetMask(const std::vector<unsigned char>* changed, bool mask);

  vtkNURBSMeshStore Store;
  vtkNURBSFaceAttributes Attributes;
  vtkNew<vtkPolyData> Mesh;
  vtkNew<vtkUnsignedCharArray> Changed;
  vtkIdType ChangedRange[2] = { -1, -1 };
};

#endif
