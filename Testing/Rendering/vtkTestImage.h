// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Pictures in tests: taken from a window, counted, and compared with Data/Baselines.
///
/// Figures first: a test that counts pixels against a closed form says what is wrong; a baseline
/// says only that something changed. To accept a new look, copy the picture that the failing test
/// names from the build's Testing/Output to Data/Baselines, after looking at it.
#ifndef vtkTestImage_h
#define vtkTestImage_h

#include "vtkImageData.h"
#include "vtkRenderWindow.h"
#include "vtkSmartPointer.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace vtkTestImage
{

using Colour = std::array<int, 3>; ///< red, green, blue, 0 to 255

/// The window's picture, 3 bytes a pixel, rows from the bottom; renders first.
vtkSmartPointer<vtkImageData> Take(vtkRenderWindow* window);

/// One pixel, counted from the lower left corner.
Colour Pixel(vtkImageData* image, int x, int y);

/// How many pixels differ from a colour by more than `margin` in some component.
long CountOthers(vtkImageData* image, const Colour& background, int margin = 0);

/// The mean absolute difference per component, 0 to 255; -1 if the sizes differ.
double MeanDifference(vtkImageData* a, vtkImageData* b);

/// How much a picture differs from Data/Baselines/<name>.png by vtkImageDifference, which forgives
/// shifts by a pixel, as between two drivers' rasterisers. About the number of pixels that differ;
/// -1 if there is no such baseline or its size is another.
double Difference(vtkImageData* image, const std::string& name);

/// Whether that difference is at most `threshold`. On failure the picture is left in the build's
/// Testing/Output.
testing::AssertionResult Matches(vtkImageData* image, const std::string& name, double threshold);

/// Write a PNG; for looking at, and for baselines.
void Write(vtkImageData* image, const std::string& path);

} // namespace vtkTestImage

#endif
