// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSDrawingWriter.h"

#include "Drawing.h"
#include "vtkInformation.h"
#include "vtkNURBSDrawingLines.h"
#include "vtkNURBSDrawingSVG.h"
#include "vtkNURBSParallel.h"

#include "vtkCommand.h"
#include "vtkErrorCode.h"
#include "vtkObjectFactory.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

vtkStandardNewMacro(vtkNURBSDrawingWriter);

namespace
{

using vtkNURBSDrawingLines::KindCount;
using vtkNURBSDrawingLines::Origin;

const char* const KindNames[KindCount] = { "silhouette", "boundary", "sharp", "smooth",
  "intersection" };
const char* const KindLabels[KindCount] = { "silhouettes", "boundaries", "sharp edges",
  "smooth edges", "intersections" };
// Kinds in the order of painting: the more important, the later.
constexpr int PaintingOrder[KindCount] = { 3, 2, 4, 1, 0 };

constexpr double SheetSides[][2] = { { 210, 297 }, { 297, 420 }, { 420, 594 }, { 594, 841 },
  { 841, 1189 } }; // A4 to A0, ISO 216.

// Of the tolerance, what joints of lines and rounded coordinates may take.
constexpr double JointPart = 0.01;
constexpr double RoundingPart = 0.005;

double MillimetresOf(const std::string& unit)
{
  static const std::map<std::string, double> units = { { "um", 1e-3 }, { "cm", 10.0 },
    { "dm", 100.0 }, { "m", 1000.0 }, { "km", 1e6 }, { "in", 25.4 }, { "inch", 25.4 },
    { "ft", 304.8 }, { "yd", 914.4 }, { "mi", 1609344.0 } };
  const auto found = units.find(unit);
  return found == units.end() ? 1.0 : found->second;
}

// "1:2", as ISO 5455 writes scales.
std::string ScaleText(double scale, const std::string& unit)
{
  const double ratio = scale / MillimetresOf(unit);
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(4);
  if (ratio >= 1.0)
  {
    text << ratio << ":1";
  }
  else
  {
    text << "1:" << 1.0 / ratio;
  }
  return text.str();
}

// The bytes of a character by its first byte; 0 if none starts so (RFC 3629).
int Utf8Length(unsigned char first)
{
  if (first < 0x80)
  {
    return 1;
  }
  if (first < 0xC2 || first > 0xF4)
  {
    return 0;
  }
  return first < 0xE0 ? 2 : (first < 0xF0 ? 3 : 4);
}

// Text that XML and PDF can hold: control characters and what is no UTF-8 become question marks.
std::string Utf8(const char* text)
{
  std::string result;
  for (const char* at = text ? text : ""; *at;)
  {
    const auto first = static_cast<unsigned char>(*at);
    const int length = Utf8Length(first);
    int good = length > 0 ? 1 : 0;
    while (good > 0 && good < length && (static_cast<unsigned char>(at[good]) & 0xC0) == 0x80)
    {
      ++good;
    }
    const bool control = length == 1 && first < 0x20;
    if (length > 0 && good == length && !control)
    {
      result.append(at, std::size_t(length));
      at += length;
    }
    else
    {
      result += '?';
      ++at;
    }
  }
  return result;
}

std::string StemOf(const std::string& path)
{
  const std::size_t slash = path.find_last_of("/\\");
  const std::string name = slash == std::string::npos ? path : path.substr(slash + 1);
  const std::size_t dot = name.rfind('.');
  return dot == std::string::npos || dot == 0 ? name : name.substr(0, dot);
}

std::string LowerEnding(const std::string& path)
{
  const std::string stem = StemOf(path);
  const std::size_t slash = path.find_last_of("/\\");
  std::string ending = path.substr((slash == std::string::npos ? 0 : slash + 1) + stem.size());
  std::transform(ending.begin(), ending.end(), ending.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

// What a path shows: the faces and edges of the lines that it was joined from.
void AddOrigins(const nurbs::JoinedLine& joined, const vtkNURBSDrawingLines::Lines& lines,
  nurbs::DrawingStroke& stroke)
{
  for (const std::size_t member : joined.Members)
  {
    const Origin& origin = lines.Origins[member];
    if (origin.Face >= 0)
    {
      stroke.Faces.push_back(origin.Face);
    }
    if (origin.Edge >= 0)
    {
      stroke.Edges.push_back(origin.Edge);
    }
  }
  for (auto* numbers : { &stroke.Faces, &stroke.Edges })
  {
    std::sort(numbers->begin(), numbers->end());
    numbers->erase(std::unique(numbers->begin(), numbers->end()), numbers->end());
  }
  stroke.Part = Utf8(lines.Parts[lines.Origins[joined.Members.front()].Part].c_str());
}

} // namespace

struct vtkNURBSDrawingWriter::Work
{
  vtkNURBSDrawingLines::Lines Lines;
  int Format = SVG;
  double Tolerance = 0.0; // In model units.
  nurbs::Vec2 Origin;     // Where the page's lower left corner is, in model units.
  nurbs::Drawing Drawing;
};

vtkNURBSDrawingWriter::vtkNURBSDrawingWriter() = default;

vtkNURBSDrawingWriter::~vtkNURBSDrawingWriter()
{
  this->SetFileName(nullptr);
  this->SetTitle(nullptr);
  this->SetSource(nullptr);
  this->SetView(nullptr);
}

int vtkNURBSDrawingWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

bool vtkNURBSDrawingWriter::Fail(unsigned long code, const std::string& message)
{
  vtkErrorMacro(<< message);
  this->SetErrorCode(code);
  return false;
}

bool vtkNURBSDrawingWriter::CheckOptions()
{
  const std::pair<const char*, double> positive[] = { { "Tolerance", this->Tolerance },
    { "OutlineWidth", this->OutlineWidth }, { "EdgeWidth", this->EdgeWidth },
    { "SmoothWidth", this->SmoothWidth }, { "HiddenWidth", this->HiddenWidth } };
  std::ostringstream problem;
  for (const auto& [name, value] : positive)
  {
    if (!(value > 0.0) || !std::isfinite(value))
    {
      problem << name << " must be positive, but is " << value;
      return this->Fail(vtkErrorCode::UserError, problem.str());
    }
  }
  const std::pair<const char*, double> others[] = { { "Margin", this->Margin },
    { "Scale", this->Scale } };
  for (const auto& [name, value] : others)
  {
    if (!(value >= 0.0) || !std::isfinite(value))
    {
      problem << name << " must not be negative, but is " << value;
      return this->Fail(vtkErrorCode::UserError, problem.str());
    }
  }
  return true;
}

bool vtkNURBSDrawingWriter::ChooseFormat(Work& work)
{
  if (!this->FileName || !*this->FileName)
  {
    return this->Fail(vtkErrorCode::NoFileNameError, "there is no file name");
  }
  work.Format = this->Format;
  if (this->Format != BY_ENDING)
  {
    return true;
  }
  const std::string ending = LowerEnding(this->FileName);
  if (ending != ".svg" && ending != ".pdf")
  {
    return this->Fail(vtkErrorCode::UnrecognizedFileTypeError,
      "cannot write " + std::string(this->FileName) + ": drawings are .svg or .pdf");
  }
  work.Format = ending == ".svg" ? SVG : PDF;
  return true;
}

// The scale, and the page with the drawing in its middle.
bool vtkNURBSDrawingWriter::Layout(Work& work)
{
  const nurbs::Box2& box = work.Lines.Box;
  const nurbs::Vec2 size = box.sizes();
  const double* sheet = SheetSides[std::max(0, this->PageSize - 1)];
  const bool wide =
    this->Orientation == LANDSCAPE || (this->Orientation == AUTOMATIC && size.x() > size.y());
  nurbs::Vec2 page(sheet[wide ? 1 : 0], sheet[wide ? 0 : 1]);
  const nurbs::Vec2 room = page - nurbs::Vec2::Constant(2.0 * this->Margin);
  double scale = this->Scale;
  if (scale == 0.0)
  {
    if (room.minCoeff() <= 0.0)
    {
      return this->Fail(vtkErrorCode::UserError, "the margin leaves no room on the page");
    }
    // A line that is upright or level has no width or no height.
    scale = std::min(size.x() > 0.0 ? room.x() / size.x() : VTK_DOUBLE_MAX,
      size.y() > 0.0 ? room.y() / size.y() : VTK_DOUBLE_MAX);
  }
  const nurbs::Vec2 drawn = scale * size;
  if (this->PageSize == TIGHT)
  {
    page = drawn + nurbs::Vec2::Constant(2.0 * this->Margin);
    page = page.cwiseMax(this->OutlineWidth);
  }
  else if ((drawn - room).maxCoeff() > 1e-9 * page.maxCoeff())
  {
    std::ostringstream problem;
    problem << "the drawing is " << drawn.x() << " x " << drawn.y() << " mm at scale "
            << ScaleText(scale, work.Lines.Unit) << ", and the page has room for " << room.x()
            << " x " << room.y() << " mm";
    return this->Fail(vtkErrorCode::UserError, problem.str());
  }
  nurbs::Drawing& drawing = work.Drawing;
  drawing.Width = page.x();
  drawing.Height = page.y();
  drawing.Scale = ScaleText(scale, work.Lines.Unit);
  work.Origin = box.center() - page / (2.0 * scale);
  this->ScaleUsed = scale;
  std::copy(page.data(), page.data() + 2, this->PageUsed);
  const double step = RoundingPart * work.Tolerance * scale;
  drawing.Digits = int(std::clamp(std::ceil(-std::log10(step)), 2.0, 12.0));
  return true;
}

// Joins the lines, fits paths to them and sorts these into layers.
void vtkNURBSDrawingWriter::Draw(Work& work)
{
  const std::vector<nurbs::JoinedLine> joined =
    nurbs::JoinLines(work.Lines.Geometry, JointPart * work.Tolerance, work.Tolerance);
  this->UpdateProgress(0.2);
  const double tolerance = (1.0 - JointPart - RoundingPart) * work.Tolerance;
  std::vector<nurbs::FittedPath> paths(joined.size());
  vtkNURBSParallelFor(0, std::int64_t(joined.size()), [&](std::int64_t begin, std::int64_t end) {
    for (auto k = std::size_t(begin); k < std::size_t(end); ++k)
    {
      paths[k] = nurbs::FitPath(joined[k].Points, tolerance);
      for (nurbs::PathPiece& piece : paths[k].Pieces)
      {
        for (nurbs::Vec2& p : piece.Points)
        {
          p = (p - work.Origin) * this->ScaleUsed;
        }
      }
    }
  });
  this->UpdateProgress(0.8);
  nurbs::DrawingLayer layers[2][KindCount];
  for (std::size_t k = 0; k < joined.size(); ++k)
  {
    if (paths[k].Pieces.empty())
    {
      continue; // Seen end-on: a point but for rounding.
    }
    const Origin& origin = work.Lines.Origins[joined[k].Members.front()];
    nurbs::DrawingStroke stroke;
    AddOrigins(joined[k], work.Lines, stroke);
    for (const nurbs::PathPiece& piece : paths[k].Pieces)
    {
      ++(piece.Straight ? this->NumberOfStraightLines : this->NumberOfCurves);
    }
    ++(origin.Visible ? this->NumberOfVisiblePaths : this->NumberOfHiddenPaths);
    stroke.Path = std::move(paths[k]);
    layers[origin.Visible ? 1 : 0][origin.Kind].Strokes.push_back(std::move(stroke));
  }
  const double visibleWidths[KindCount] = { this->OutlineWidth, this->OutlineWidth, this->EdgeWidth,
    this->SmoothWidth, this->EdgeWidth };
  for (const int visible : { 0, 1 })
  {
    for (const int kind : PaintingOrder)
    {
      nurbs::DrawingLayer& layer = layers[visible][kind];
      if (!layer.Strokes.empty())
      {
        layer.Kind = KindNames[kind];
        layer.Name = (visible ? "visible-" : "hidden-") + layer.Kind;
        layer.Label = std::string(visible ? "Visible " : "Hidden ") + KindLabels[kind];
        layer.Visible = visible != 0;
        layer.LineWidth = visible
          ? visibleWidths[kind]
          : (layer.Kind == "smooth" ? this->SmoothWidth : this->HiddenWidth);
        work.Drawing.Layers.push_back(std::move(layer));
      }
    }
  }
}

bool vtkNURBSDrawingWriter::Save(const Work& work)
{
  std::string bytes;
  try
  {
    bytes = work.Format == SVG ? vtkNURBSDrawingSVG::Make(work.Drawing)
                               : nurbs::MakeDrawingPDF(work.Drawing);
  }
  catch (const std::exception& error)
  {
    return this->Fail(
      vtkErrorCode::UnknownError, "cannot make the file: " + std::string(error.what()));
  }
  std::ofstream file(this->FileName, std::ios::binary);
  if (!file)
  {
    return this->Fail(
      vtkErrorCode::CannotOpenFileError, "cannot write " + std::string(this->FileName));
  }
  file.write(bytes.data(), std::streamsize(bytes.size()));
  file.close();
  if (!file)
  {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(
          std::filesystem::symlink_status(this->FileName, ignored))) // No device, no link.
    {
      std::filesystem::remove(this->FileName, ignored);
    }
    return this->Fail(vtkErrorCode::OutOfDiskSpaceError,
      "cannot write " + std::string(this->FileName) + ": no space left");
  }
  return true;
}

void vtkNURBSDrawingWriter::WriteData()
{
  this->NumberOfVisiblePaths = this->NumberOfHiddenPaths = 0;
  this->NumberOfCurves = this->NumberOfStraightLines = 0;
  this->ScaleUsed = this->PageUsed[0] = this->PageUsed[1] = 0.0;
  Work work;
  if (!this->CheckOptions() || !this->ChooseFormat(work))
  {
    return;
  }
  const std::string problem =
    vtkNURBSDrawingLines::Collect(this->GetInput(), this->HiddenLines, work.Lines);
  if (!problem.empty())
  {
    this->Fail(vtkErrorCode::UserError, problem);
    return;
  }
  const double diagonal = work.Lines.Box.isEmpty() ? 0.0 : work.Lines.Box.diagonal().norm();
  if (!(diagonal > 0.0))
  {
    this->Fail(vtkErrorCode::UserError, "there are no lines to draw");
    return;
  }
  work.Tolerance = this->Tolerance * (this->ToleranceMode == RELATIVE ? diagonal : 1.0);
  vtkNURBSDrawingLines::DropHiddenCopies(work.Lines, work.Tolerance);
  work.Drawing.Title = Utf8(this->Title ? this->Title : StemOf(this->FileName).c_str());
  work.Drawing.Source = Utf8(this->Source);
  work.Drawing.View = Utf8(this->View);
  if (!this->Layout(work))
  {
    return;
  }
  this->Draw(work);
  if (!this->Save(work))
  {
    this->NumberOfVisiblePaths = this->NumberOfHiddenPaths = 0;
    this->NumberOfCurves = this->NumberOfStraightLines = 0;
    this->ScaleUsed = this->PageUsed[0] = this->PageUsed[1] = 0.0;
  }
}

void vtkNURBSDrawingWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto text = [](const char* value) { return value ? value : "(none)"; };
  os << indent << "FileName: " << text(this->FileName) << "\n";
  os << indent << "Format: " << this->Format << "\n";
  os << indent << "Scale: " << this->Scale << "\n";
  os << indent << "PageSize: " << this->PageSize << "\n";
  os << indent << "Orientation: " << this->Orientation << "\n";
  os << indent << "Margin: " << this->Margin << "\n";
  os << indent << "HiddenLines: " << this->HiddenLines << "\n";
  os << indent << "OutlineWidth: " << this->OutlineWidth << "\n";
  os << indent << "EdgeWidth: " << this->EdgeWidth << "\n";
  os << indent << "SmoothWidth: " << this->SmoothWidth << "\n";
  os << indent << "HiddenWidth: " << this->HiddenWidth << "\n";
  os << indent << "ToleranceMode: " << this->ToleranceMode << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "Title: " << text(this->Title) << "\n";
  os << indent << "Source: " << text(this->Source) << "\n";
  os << indent << "View: " << text(this->View) << "\n";
  os << indent << "NumberOfVisiblePaths: " << this->NumberOfVisiblePaths << "\n";
  os << indent << "NumberOfHiddenPaths: " << this->NumberOfHiddenPaths << "\n";
  os << indent << "NumberOfCurves: " << this->NumberOfCurves << "\n";
  os << indent << "NumberOfStraightLines: " << this->NumberOfStraightLines << "\n";
  os << indent << "ScaleUsed: " << this->ScaleUsed << "\n";
  os << indent << "PageUsed: " << this->PageUsed[0] << " " << this->PageUsed[1] << "\n";
}
