// SPDX-License-Identifier: BSD-3-Clause
#include "CADExport.h"

#include "CrashGuard.h"
#include "Types.h"

#include <APIHeaderSection_MakeHeader.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <IGESCAFControl_Writer.hxx>
#include <IGESControl_Controller.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <Standard_Failure.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopoDS_Compound.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>

namespace nurbs
{

namespace
{

namespace fs = std::filesystem;

/// Sets one of OpenCASCADE's global options while it lives.
class Setting
{
public:
  Setting(const char* name, const char* value)
    : Name(name)
    , Old(Interface_Static::CVal(name))
  {
    Interface_Static::SetCVal(name, value);
  }
  ~Setting() { Interface_Static::SetCVal(this->Name, this->Old.c_str()); }
  Setting(const Setting&) = delete;
  Setting& operator=(const Setting&) = delete;

private:
  const char* Name;
  const std::string Old;
};

using Rgb = std::array<std::uint8_t, 3>;

Quantity_Color ToColor(const Rgb& rgb)
{
  return Quantity_Color(rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0, Quantity_TOC_sRGB);
}

TCollection_ExtendedString ToName(const std::string& name)
{
  return TCollection_ExtendedString(name.c_str(), Standard_True);
}

/// The colour that most of the faces have.
Rgb CommonColor(const CADPart& part)
{
  std::map<Rgb, int> counts;
  Rgb common = part.Colors.front();
  for (std::size_t f = 0; f < part.Faces.size(); ++f)
  {
    if (++counts[part.Colors[f]] > counts[common])
    {
      common = part.Colors[f];
    }
  }
  return common;
}

/// Fills an XDE document.
class DocumentFiller
{
public:
  DocumentFiller(const CADContent& content, const Handle(TDocStd_Document) & document)
    : Content(content)
    , Shapes(XCAFDoc_DocumentTool::ShapeTool(document->Main()))
    , Colors(XCAFDoc_DocumentTool::ColorTool(document->Main()))
  {}

  void Run()
  {
    std::vector<TDF_Label> labels, parts(this->Content.Parts.size());
    for (const CADNode& node : this->Content.Nodes)
    {
      TDF_Label label = node.Part >= 0 ? parts[node.Part] : TDF_Label();
      if (label.IsNull())
      {
        label =
          node.Part >= 0 ? this->AddPart(this->Content.Parts[node.Part]) : this->Shapes->NewShape();
        TDataStd_Name::Set(label, ToName(node.Name));
      }
      if (node.Part >= 0)
      {
        parts[node.Part] = label;
      }
      labels.push_back(label);
    }
    for (std::size_t i = 0; i < labels.size(); ++i)
    {
      const CADNode& node = this->Content.Nodes[i];
      if (node.Parent >= 0)
      {
        const TDF_Label use =
          this->Shapes->AddComponent(labels[node.Parent], labels[i], node.Place);
        TDataStd_Name::Set(use, ToName(node.InstanceName.empty() ? node.Name : node.InstanceName));
      }
    }
    this->Shapes->UpdateAssemblies();
  }

private:
  TDF_Label AddPart(const CADPart& part)
  {
    const TDF_Label label = this->Shapes->AddShape(part.Shape, Standard_False);
    const Rgb common = part.Colors.empty() ? Rgb() : CommonColor(part);
    if (!part.Colors.empty())
    {
      this->Colors->SetColor(label, ToColor(common), XCAFDoc_ColorSurf);
    }
    for (std::size_t f = 0; f < part.Faces.size(); ++f)
    {
      const bool colored = !part.Colors.empty() && part.Colors[f] != common;
      const bool named =
        !part.FaceNames.empty() && !part.FaceNames[f].empty() && part.FaceNames[f] != part.Name;
      if (!colored && !named)
      {
        continue;
      }
      const TDF_Label face = this->Shapes->AddSubShape(label, part.Faces[f]);
      if (face.IsNull())
      {
        continue;
      }
      if (colored)
      {
        this->Colors->SetColor(face, ToColor(part.Colors[f]), XCAFDoc_ColorSurf);
      }
      if (named)
      {
        TDataStd_Name::Set(face, ToName(part.FaceNames[f]));
      }
    }
    return label;
  }

  const CADContent& Content;
  Handle(XCAFDoc_ShapeTool) Shapes;
  Handle(XCAFDoc_ColorTool) Colors;
};

Handle(TDocStd_Document) MakeDocument(const CADContent& content)
{
  const Handle(TDocStd_Document) document = NewCADDocument();
  DocumentFiller(content, document).Run();
  return document;
}

const char* UnitKeyword(const CADContent& content)
{
  return content.Unit.Keyword ? content.Unit.Keyword : "MM";
}

bool WriteStep(
  const CADContent& content, const std::string& path, const Message_ProgressRange& range)
{
  STEPCAFControl_Controller::Init();
  const Setting schema("write.step.schema", "AP214IS");
  const Setting unit("write.step.unit", UnitKeyword(content));
  const Setting names("write.stepcaf.subshapes.name", "On");
  STEPCAFControl_Writer writer;
  writer.SetColorMode(true);
  writer.SetNameMode(true);
  writer.SetLayerMode(false);
  writer.SetPropsMode(false);
  if (!writer.Transfer(MakeDocument(content), STEPControl_AsIs, nullptr, range))
  {
    return false;
  }
  APIHeaderSection_MakeHeader header(writer.ChangeWriter().Model());
  header.SetName(new TCollection_HAsciiString(content.Name.c_str()));
  header.SetOriginatingSystem(new TCollection_HAsciiString("vtkNURBS"));
  return writer.Write(path.c_str()) == IFSelect_RetDone;
}

bool WriteIges(
  const CADContent& content, const std::string& path, const Message_ProgressRange& range)
{
  IGESControl_Controller::Init();
  const Setting unit("write.iges.unit", UnitKeyword(content));
  const Setting entities("write.iges.brep.mode", "BRep");
  IGESCAFControl_Writer writer;
  writer.SetColorMode(true);
  writer.SetNameMode(true);
  writer.SetLayerMode(false);
  if (!writer.Transfer(MakeDocument(content), range))
  {
    return false;
  }
  writer.ComputeModel();
  return writer.Write(path.c_str());
}

bool WriteBrep(
  const CADContent& content, const std::string& path, const Message_ProgressRange& range)
{
  std::vector<TopoDS_Shape> shapes;
  for (const CADNode& node : content.Nodes)
  {
    if (node.Part >= 0)
    {
      shapes.push_back(content.Parts[node.Part].Shape.Moved(node.Place));
    }
  }
  if (shapes.size() == 1)
  {
    return BRepTools::Write(shapes.front(), path.c_str(), range);
  }
  BRep_Builder builder;
  TopoDS_Compound all;
  builder.MakeCompound(all);
  for (const TopoDS_Shape& shape : shapes)
  {
    builder.Add(all, shape);
  }
  return BRepTools::Write(all, path.c_str(), range);
}

bool Write(const CADContent& content, CADFormat format, const std::string& path,
  const Message_ProgressRange& range)
{
  switch (format)
  {
    case CADFormat::STEP:
      return WriteStep(content, path, range);
    case CADFormat::IGES:
      return WriteIges(content, path, range);
    default:
      return WriteBrep(content, path, range);
  }
}

/// Throws unless the file can be opened. An existing file keeps its content.
void CheckPath(const std::string& path)
{
  const bool existed = fs::exists(fs::u8path(path));
  if (fs::is_directory(fs::u8path(path)))
  {
    throw Error("cannot write \"" + path + "\": it is a directory");
  }
  std::ofstream file(path, std::ios::binary | std::ios::app);
  if (!file)
  {
    throw Error("cannot write \"" + path + "\": " + std::strerror(errno));
  }
  file.close();
  std::error_code ignored;
  if (!existed)
  {
    fs::remove(fs::u8path(path), ignored);
  }
}

/// Where the file is written until it is whole: beside `path`, if that is a plain file or none yet
/// (a device or a link is written itself). Removes what is left there at the end.
class Draft
{
public:
  explicit Draft(const std::string& path)
    : Path(path)
    , Own(path)
  {
    std::error_code ignored;
    const fs::file_status status = fs::symlink_status(fs::u8path(path), ignored);
    if (fs::is_regular_file(status) || !fs::exists(status))
    {
      const fs::path whole = fs::u8path(path);
      for (int i = 0; this->Own == path || fs::exists(fs::u8path(this->Own), ignored); ++i)
      {
        const std::string name =
          whole.stem().u8string() + ".part" + std::to_string(i) + whole.extension().u8string();
        this->Own = (whole.parent_path() / fs::u8path(name)).u8string();
      }
    }
  }
  ~Draft()
  {
    std::error_code ignored;
    if (this->Own != this->Path)
    {
      fs::remove(fs::u8path(this->Own), ignored);
    }
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  const std::string& Get() const { return this->Own; }

  /// Puts it in the place of `path`; returns what went wrong.
  std::string Keep() const
  {
    std::error_code error;
    if (this->Own != this->Path)
    {
      fs::rename(fs::u8path(this->Own), fs::u8path(this->Path), error);
    }
    return error ? error.message() : "";
  }

private:
  const std::string Path;
  std::string Own;
};

/// Writes; returns what went wrong, "" if nothing did.
std::string TryToWrite(const CADContent& content, CADFormat format, const std::string& path,
  const Message_ProgressRange& range)
{
  bool written = false;
  try
  {
    const int signal = RunGuarded([&] { written = Write(content, format, path, range); });
    if (signal != 0)
    {
      return std::string("OpenCASCADE fails to make ") + NameOf(format) + " of it";
    }
  }
  catch (const Standard_Failure& failure)
  {
    return std::string("OpenCASCADE fails to make ") + NameOf(format) +
      " of it: " + ReasonOf(failure);
  }
  catch (const std::exception& failure) // OpenCASCADE's streams throw when a disk is full.
  {
    return std::string("the disk may be full (") + failure.what() + ")";
  }
  return written ? "" : "the disk may be full, or OpenCASCADE could not translate the shape";
}

} // namespace

void SaveCADFile(
  const CADContent& content, CADFormat format, const std::string& path, const CADProgress& report)
{
  CheckPath(path);
  const CADSession session;
  const Handle(CADProgressIndicator) progress = new CADProgressIndicator(report);
  const Draft draft(path);
  std::string problem = TryToWrite(content, format, draft.Get(), progress->Start());
  if (progress->Stopped())
  {
    throw Error("aborted");
  }
  if (problem.empty())
  {
    try
    {
      DetectCADFormat(draft.Get()); // Is it whole?
      problem = draft.Keep();
    }
    catch (const Error&)
    {
      problem = "the file is cut short, the disk may be full";
    }
  }
  if (!problem.empty())
  {
    throw Error("cannot write \"" + path + "\": " + problem);
  }
}

} // namespace nurbs
