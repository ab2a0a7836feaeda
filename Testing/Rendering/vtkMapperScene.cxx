// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMapperScene.h"

#include "vtkCamera.h"
#include "vtkHardwareSelector.h"
#include "vtkNURBSCADReader.h"
#include "vtkNURBSTessellator.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkTestImage.h"
#include "vtk_glew.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace
{

constexpr vtkTestImage::Colour Background = { 26, 51, 102 };

void GLAPIENTRY KeepError(
  GLenum, GLenum type, GLuint, GLenum, GLsizei, const GLchar* text, const void* errors)
{
  if (type == GL_DEBUG_TYPE_ERROR)
  {
    *static_cast<std::string*>(const_cast<void*>(errors)) += std::string(text) + "\n";
  }
}

} // namespace

vtkMapperScene::vtkMapperScene(vtkDataObject* model, int size)
{
  this->Mapper->SetInputData(model);
  this->Actor->SetMapper(this->Mapper);
  this->Renderer->AddActor(this->Actor);
  this->Renderer->SetBackground(
    Background[0] / 255.0, Background[1] / 255.0, Background[2] / 255.0);
  this->Window =
    vtkSmartPointer<vtkNURBSEGLRenderWindow>::Take(vtkNURBSEGLRenderWindow::Create(size, size));
  this->Window->SetMultiSamples(0);
  this->Window->AddRenderer(this->Renderer);
  if (GLEW_KHR_debug)
  {
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(KeepError, &this->Errors);
  }
  vtkCamera* camera = this->Renderer->GetActiveCamera();
  camera->SetPosition(3.0, -4.0, 2.5);
  camera->SetViewUp(0.0, 0.0, 1.0);
  this->Renderer->ResetCamera();
}

vtkSmartPointer<vtkImageData> vtkMapperScene::Picture()
{
  auto picture = vtkTestImage::Take(this->Window);
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
  EXPECT_EQ(this->Errors, "");
  this->Errors.clear();
  return picture;
}

vtkSmartPointer<vtkImageData> vtkMapperScene::PictureWith(vtkMapper* mapper)
{
  this->Actor->SetMapper(mapper);
  auto picture = this->Picture();
  this->Actor->SetMapper(this->Mapper);
  return picture;
}

std::vector<int> vtkMapperScene::SelectCells()
{
  const int* size = this->Window->GetSize();
  vtkNew<vtkHardwareSelector> selector;
  selector->SetRenderer(this->Renderer);
  selector->SetArea(0, 0, size[0] - 1, size[1] - 1);
  selector->SetFieldAssociation(vtkDataObject::FIELD_ASSOCIATION_CELLS);
  EXPECT_TRUE(selector->CaptureBuffers());
  std::vector<int> cells;
  for (unsigned int y = 0; y < unsigned(size[1]); ++y)
  {
    for (unsigned int x = 0; x < unsigned(size[0]); ++x)
    {
      const unsigned int place[2] = { x, y };
      const vtkHardwareSelector::PixelInformation info = selector->GetPixelInformation(place);
      cells.push_back(info.Valid ? static_cast<int>(info.AttributeID) : -1);
    }
  }
  return cells;
}

std::vector<float> vtkMapperScene::Depths()
{
  const int* size = this->Window->GetSize();
  std::vector<float> depths(std::size_t(size[0]) * size[1]);
  this->Window->GetZbufferData(0, 0, size[0] - 1, size[1] - 1, depths.data());
  return depths;
}

namespace vtkMapperTest
{

vtkSmartPointer<vtkUnstructuredGrid> Shape(int shape)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(shape);
  source->SetNumberOfPatches(150);
  source->SetSheetPoints(12, 12);
  source->Update();
  return source->GetOutput();
}

vtkSmartPointer<vtkUnstructuredGrid> CADModel(const std::string& file)
{
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(("/usr/share/opencascade/data/" + file).c_str());
  reader->SingleModelOn();
  reader->Update();
  vtkSmartPointer<vtkUnstructuredGrid> model = vtkUnstructuredGrid::SafeDownCast(
    vtkPartitionedDataSetCollection::SafeDownCast(reader->GetOutputDataObject(0))
      ->GetPartition(0, 0));
  EXPECT_TRUE(model) << file << " can't be read (Debian package occt-misc)";
  return model;
}

vtkSmartPointer<vtkDataObject> Tessellate(vtkDataObject* model)
{
  vtkNew<vtkNURBSTessellator> tessellator;
  tessellator->SetInputDataObject(model);
  tessellator->SetTolerance(1e-5);
  tessellator->Update();
  return tessellator->GetOutputDataObject(0);
}

Difference Compare(vtkImageData* a, vtkImageData* b)
{
  Difference result;
  double sum = 0.0;
  const auto* p = static_cast<const unsigned char*>(a->GetScalarPointer());
  const auto* q = static_cast<const unsigned char*>(b->GetScalarPointer());
  for (vtkIdType k = 0; k < a->GetNumberOfPoints(); ++k, p += 3, q += 3)
  {
    bool drawn = false, strange = false;
    for (std::size_t i = 0; i < 3; ++i)
    {
      const int difference = std::abs(p[i] - q[i]);
      drawn = drawn || p[i] != Background[i] || q[i] != Background[i];
      strange = strange || difference > 8;
      sum += difference;
    }
    result.Drawn += drawn;
    result.Strange += strange;
  }
  result.Mean = result.Drawn ? sum / (3.0 * static_cast<double>(result.Drawn)) : 0.0;
  return result;
}

long CountDrawn(vtkImageData* image)
{
  return vtkTestImage::CountOthers(image, Background);
}

} // namespace vtkMapperTest
