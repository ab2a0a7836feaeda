// SPDX-License-Identifier: BSD-3-Clause
// PDF by QPDF, which keeps the file's structure; what the page shows is written here. References
// are to ISO 32000-1:2008.
#include "Drawing.h"

#define POINTERHOLDER_TRANSITION 4 // QPDF's own name for: std::shared_ptr, as of QPDF 11.
#include <qpdf/QPDF.hh>
#include <qpdf/QPDFObjectHandle.hh>
#include <qpdf/QPDFPageDocumentHelper.hh>
#include <qpdf/QPDFWriter.hh>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace nurbs
{
namespace
{

constexpr double PointsPerMillimetre = 72.0 / 25.4;
constexpr double LargestPage = 14400.0; // In units of user space: Annex C.2.

using Handle = QPDFObjectHandle;

Handle Real(double value)
{
  return Handle::newReal(DrawingNumber(value, 6));
}

void AppendPoint(const Vec2& p, int digits, std::string& text)
{
  text += DrawingNumber(p.x(), digits) + ' ' + DrawingNumber(p.y(), digits) + ' ';
}

// 8.5.2: m moves, l draws a line, c a Bezier curve, h closes, S strokes.
void AppendPath(const FittedPath& path, int digits, std::string& text)
{
  AppendPoint(path.Pieces.front().Points[0], digits, text);
  text += "m\n";
  for (std::size_t k = 0; k < path.Pieces.size(); ++k)
  {
    const PathPiece& piece = path.Pieces[k];
    const bool last = path.Closed && k + 1 == path.Pieces.size();
    if (piece.Straight && last)
    {
      continue; // h draws it.
    }
    for (std::size_t p = piece.Straight ? 3 : 1; p < 4; ++p)
    {
      AppendPoint(piece.Points[p], digits, text);
    }
    text += piece.Straight ? "l\n" : "c\n";
  }
  text += path.Closed ? "h S\n" : "S\n";
}

// 8.4.3: w is the width, d the dashes; q and Q keep and restore. 14.6: BDC begins what belongs to a
// layer.
std::string PageContent(const Drawing& drawing, double unit)
{
  std::string text = DrawingNumber(PointsPerMillimetre / unit, 9);
  text += " 0 0 " + text + " 0 0 cm\n0 G 1 j\n";
  for (std::size_t k = 0; k < drawing.Layers.size(); ++k)
  {
    const DrawingLayer& layer = drawing.Layers[k];
    const auto number = [](double value) { return DrawingNumber(value, 4); };
    text += "/OC /L" + std::to_string(k) + " BDC\nq " + number(layer.LineWidth) + " w ";
    text += layer.Visible ? "1 J\n"
                          : "0 J [" + number(DashWidths * layer.LineWidth) + ' ' +
        number(GapWidths * layer.LineWidth) + "] 0 d\n";
    for (const DrawingStroke& stroke : layer.Strokes)
    {
      AppendPath(stroke.Path, drawing.Digits, text);
    }
    text += "Q\nEMC\n";
  }
  return text;
}

// 8.11: a layer is an optional content group.
std::vector<Handle> AddLayers(const Drawing& drawing, QPDF& pdf)
{
  std::vector<Handle> groups;
  Handle all = Handle::newArray();
  for (const DrawingLayer& layer : drawing.Layers)
  {
    Handle group = Handle::newDictionary();
    group.replaceKey("/Type", Handle::newName("/OCG"));
    group.replaceKey("/Name", Handle::newUnicodeString(layer.Label));
    groups.push_back(pdf.makeIndirectObject(group));
    all.appendItem(groups.back());
  }
  Handle settings = Handle::newDictionary();
  settings.replaceKey("/Order", all);
  Handle properties = Handle::newDictionary();
  properties.replaceKey("/OCGs", all);
  properties.replaceKey("/D", settings);
  pdf.getRoot().replaceKey("/OCProperties", properties);
  return groups;
}

Handle MakePage(const Drawing& drawing, QPDF& pdf)
{
  const double width = drawing.Width * PointsPerMillimetre;
  const double height = drawing.Height * PointsPerMillimetre;
  // 14.11.1: what a unit is, where a page would be too large in points.
  const double unit = std::max(1.0, std::ceil(std::max(width, height) / LargestPage));
  Handle box = Handle::newArray();
  for (const double side : { 0.0, 0.0, width / unit, height / unit })
  {
    box.appendItem(Real(side));
  }
  Handle properties = Handle::newDictionary();
  const std::vector<Handle> groups = AddLayers(drawing, pdf);
  for (std::size_t k = 0; k < groups.size(); ++k)
  {
    properties.replaceKey("/L" + std::to_string(k), groups[k]);
  }
  Handle resources = Handle::newDictionary();
  resources.replaceKey("/Properties", properties);
  Handle page = Handle::newDictionary();
  page.replaceKey("/Type", Handle::newName("/Page"));
  page.replaceKey("/MediaBox", box);
  page.replaceKey("/Resources", resources);
  page.replaceKey("/Contents", Handle::newStream(&pdf, PageContent(drawing, unit)));
  if (unit > 1.0)
  {
    page.replaceKey("/UserUnit", Real(unit));
  }
  return pdf.makeIndirectObject(page);
}

} // namespace

//--------------------------------------------------------------------------------------------------
std::string DrawingNumber(double value, int digits)
{
  char text[400]; // The largest double has 309 digits before the point.
  auto end = std::to_chars(text, text + sizeof(text), value, std::chars_format::fixed, digits).ptr;
  if (digits > 0)
  {
    while (end[-1] == '0')
    {
      --end;
    }
    end -= end[-1] == '.' ? 1 : 0;
  }
  const std::string number(text, end);
  return number == "-0" ? "0" : number;
}

//--------------------------------------------------------------------------------------------------
std::string DrawingDescription(const Drawing& drawing)
{
  std::string text = "Line drawing";
  text += drawing.Source.empty() ? "" : " of " + drawing.Source;
  text += drawing.View.empty() ? "" : ", view " + drawing.View;
  return text + ", scale " + drawing.Scale;
}

//--------------------------------------------------------------------------------------------------
std::string MakeDrawingPDF(const Drawing& drawing)
{
  QPDF pdf;
  pdf.emptyPDF();
  QPDFPageDocumentHelper(pdf).addPage(QPDFPageObjectHelper(MakePage(drawing, pdf)), false);
  Handle information = Handle::newDictionary();
  information.replaceKey("/Title", Handle::newUnicodeString(drawing.Title));
  information.replaceKey("/Subject", Handle::newUnicodeString(DrawingDescription(drawing)));
  information.replaceKey("/Creator", Handle::newUnicodeString("vtkNURBS"));
  pdf.getTrailer().replaceKey("/Info", pdf.makeIndirectObject(information));
  QPDFWriter writer(pdf);
  writer.setOutputMemory();
  writer.setDeterministicID(true);
  writer.setMinimumPDFVersion(PDFVersion(1, 6)); // UserUnit
  writer.write();
  const auto buffer = writer.getBufferSharedPointer();
  return std::string(reinterpret_cast<const char*>(buffer->getBuffer()), buffer->getSize());
}

} // namespace nurbs
