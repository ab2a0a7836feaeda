// SPDX-License-Identifier: BSD-3-Clause
/// @file Drawing.h
/// @brief A drawing on its page, and PDF made of it. Private to this module.
#pragma once

#include "PathFit.h"

#include <string>
#include <vector>

namespace nurbs
{

/// What the page shows in one style. Millimetres; y goes up from the lower edge of the page.
struct DrawingStroke
{
  FittedPath Path;
  std::vector<std::int64_t> Faces, Edges; ///< What it shows, in ascending order; may be empty.
  std::string Part;                       ///< Of an assembly; else empty.
};

struct DrawingLayer
{
  std::string Name; ///< "hidden-sharp": a word of letters and dashes, one layer's only.
  std::string Kind; ///< "sharp"
  std::string Label;
  bool Visible = true; ///< False: dashed.
  double LineWidth = 0.35;
  std::vector<DrawingStroke> Strokes;
};

struct Drawing
{
  double Width = 0.0, Height = 0.0;
  int Digits = 3; ///< After the decimal point of a coordinate.
  std::string Title, Source, View, Scale;
  std::vector<DrawingLayer> Layers; ///< In the order of painting.
};

/// Dashes and the gaps between them, in line widths (ISO 128-2, line 02).
inline constexpr double DashWidths = 12.0, GapWidths = 3.0;

/// A number with at most `digits` after the point and no zeros at the end, the same in every
/// locale.
std::string DrawingNumber(double value, int digits);

/// The drawing's title, source, view and scale as one sentence.
std::string DrawingDescription(const Drawing& drawing);

/// A PDF file's bytes: one page, a layer that can be switched off for each of the drawing's. Throws
/// std::exception if the library fails.
std::string MakeDrawingPDF(const Drawing& drawing);

} // namespace nurbs
