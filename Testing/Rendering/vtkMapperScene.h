// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What the tests of vtkNURBSMapper share: a window with one actor, models, and comparisons with
/// the same model tessellated finely and drawn by vtkPolyDataMapper.
#ifndef vtkMapperScene_h
#define vtkMapperScene_h

#include "vtkActor.h"
#include "vtkImageData.h"
#include "vtkNURBSEGLRenderWindow.h"
#include "vtkNURBSMapper.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNew.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <string>
#include <vector>

/// A square window with one actor, drawn by vtkNURBSMapper unless told otherwise.
struct vtkMapperScene
{
  vtkNew<vtkNURBSMapper> Mapper;
  vtkNew<vtkActor> Actor;
  vtkNew<vtkRenderer> Renderer;
  vtkSmartPointer<vtkNURBSEGLRenderWindow> Window;

  explicit vtkMapperScene(vtkDataObject* model, int size = 160);
  vtkMapperScene(const vtkMapperScene&) = delete;
  void operator=(const vtkMapperScene&) = delete;

  /// Renders; the driver's messages of OpenGL errors fail the test.
  vtkSmartPointer<vtkImageData> Picture();

  /// The same scene with this model drawn by another mapper.
  vtkSmartPointer<vtkImageData> PictureWith(vtkMapper* mapper);

  /// Cells that vtkHardwareSelector tells, -1: none. Rows from the bottom.
  std::vector<int> SelectCells();

  /// Of the last picture.
  std::vector<float> Depths();

private:
  std::string Errors;
};

namespace vtkMapperTest
{

vtkSmartPointer<vtkUnstructuredGrid> Shape(int shape);

/// The first model of a CAD file of Debian's occt-misc, e.g. "step/screw.step"; a test failure if it
/// is not there.
vtkSmartPointer<vtkUnstructuredGrid> CADModel(const std::string& file);

/// The model, or models, as triangles: tolerance 1e-5 of the diagonal.
vtkSmartPointer<vtkDataObject> Tessellate(vtkDataObject* model);

/// How two pictures of scenes differ.
struct Difference
{
  double Mean = 0.0; ///< Absolute, 0 to 255, over the components of pixels drawn in one of them.
  long Drawn = 0;    ///< Pixels drawn in one of them.
  long Strange = 0;  ///< Pixels of which a component differs by more than 8.
};
Difference Compare(vtkImageData* a, vtkImageData* b);

/// How many pixels are not the background.
long CountDrawn(vtkImageData* image);

} // namespace vtkMapperTest

#endif
