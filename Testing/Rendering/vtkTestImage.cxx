// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTestImage.h"

#include "vtkImageDifference.h"
#include "vtkNew.h"
#include "vtkPNGReader.h"
#include "vtkPNGWriter.h"
#include "vtkWindowToImageFilter.h"

#include <cstdlib>
#include <fstream>

namespace vtkTestImage
{
namespace
{

const unsigned char* Bytes(vtkImageData* image)
{
  return static_cast<const unsigned char*>(image->GetScalarPointer());
}

bool SameShape(vtkImageData* a, vtkImageData* b)
{
  const int* p = a->GetDimensions();
  const int* q = b->GetDimensions();
  return p[0] == q[0] && p[1] == q[1] &&
    a->GetNumberOfScalarComponents() == b->GetNumberOfScalarComponents();
}

} // namespace

vtkSmartPointer<vtkImageData> Take(vtkRenderWindow* window)
{
  vtkNew<vtkWindowToImageFilter> grab;
  grab->SetInput(window);
  grab->ReadFrontBufferOff();
  grab->Update();
  vtkSmartPointer<vtkImageData> image = vtkSmartPointer<vtkImageData>::New();
  image->DeepCopy(grab->GetOutput());
  return image;
}

Colour Pixel(vtkImageData* image, int x, int y)
{
  const auto* p = static_cast<const unsigned char*>(image->GetScalarPointer(x, y, 0));
  return { p[0], p[1], p[2] };
}

long CountOthers(vtkImageData* image, const Colour& background, int margin)
{
  const unsigned char* p = Bytes(image);
  long count = 0;
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i, p += 3)
  {
    bool other = false;
    for (int c = 0; c < 3; ++c)
    {
      other = other || std::abs(p[c] - background[static_cast<size_t>(c)]) > margin;
    }
    count += other ? 1 : 0;
  }
  return count;
}

double MeanDifference(vtkImageData* a, vtkImageData* b)
{
  if (!SameShape(a, b))
  {
    return -1.0;
  }
  const vtkIdType size = a->GetNumberOfPoints() * a->GetNumberOfScalarComponents();
  double sum = 0.0;
  for (vtkIdType i = 0; i < size; ++i)
  {
    sum += std::abs(Bytes(a)[i] - Bytes(b)[i]);
  }
  return sum / static_cast<double>(size);
}

double Difference(vtkImageData* image, const std::string& name)
{
  const std::string baseline = std::string(NURBS_DATA) + "/Baselines/" + name + ".png";
  if (!std::ifstream(baseline))
  {
    return -1.0;
  }
  vtkNew<vtkPNGReader> reader;
  reader->SetFileName(baseline.c_str());
  reader->Update();
  if (!SameShape(image, reader->GetOutput()))
  {
    return -1.0;
  }
  vtkNew<vtkImageDifference> difference;
  difference->SetInputData(image);
  difference->SetImageConnection(reader->GetOutputPort());
  difference->SetThreshold(16); // of 255, per pixel; the default hides whole rims
  difference->Update();
  return difference->GetThresholdedError();
}

testing::AssertionResult Matches(vtkImageData* image, const std::string& name, double threshold)
{
  const double difference = Difference(image, name);
  if (difference >= 0.0 && difference <= threshold)
  {
    return testing::AssertionSuccess();
  }
  const std::string taken = std::string(NURBS_TEST_OUTPUT) + "/" + name + ".png";
  Write(image, taken);
  testing::AssertionResult failure = testing::AssertionFailure();
  return difference < 0.0
    ? failure << "no baseline Data/Baselines/" << name << ".png of that size; see " << taken
    : failure << taken << " differs from its baseline by " << difference << ", allowed are "
              << threshold;
}

void Write(vtkImageData* image, const std::string& path)
{
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(image);
  writer->SetFileName(path.c_str());
  writer->Write();
}

} // namespace vtkTestImage
