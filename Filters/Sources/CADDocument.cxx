// SPDX-License-Identifier: BSD-3-Clause
#include "CADDocument.h"

#include "AssemblyTree.h"
#include "CrashGuard.h"
#include "FaceConverter.h"

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <IGESData_IGESModel.hxx>
#include <IGESGeom_TrimmedSurface.hxx>
#include <IGESSolid_Face.hxx>
#include <Interface_Static.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <StepShape_FaceSurface.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <Transfer_Binder.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include <filesystem>
#include <fstream>
#include <memory>

namespace nurbs
{

namespace
{

void SetUnit(CADDocument& document, const std::string& name)
{
  if (const CADUnit* unit = FindCADUnit(name))
  {
    document.FileUnit = unit->Symbol;
    document.FileUnitLength = unit->Millimetres;
  }
}

bool HasFace(const TopoDS_Shape& shape)
{
  return !shape.IsNull() && TopExp_Explorer(shape, TopAbs_FACE).More();
}

void RequireFaces(bool some, const std::string& path, CADFormat format)
{
  if (!some)
  {
    throw Error("\"" + path + "\": the " + NameOf(format) + " file holds no face");
  }
}

void CheckRead(IFSelect_ReturnStatus status, const std::string& path, CADFormat format)
{
  if (status != IFSelect_RetDone)
  {
    throw Error("\"" + path + "\" is a broken " + NameOf(format) +
      " file: " + (status == IFSelect_RetVoid ? "it has no data" : "its syntax is wrong"));
  }
}

/// OpenCASCADE leaves out faces that it fails to make and says so in a log only.
void WarnOfLostFaces(const Handle(XSControl_WorkSession) & session, CADDocument& document)
{
  const Handle(Interface_InterfaceModel) model = session->Model();
  const Handle(Transfer_TransientProcess) process = session->TransferReader()->TransientProcess();
  if (model.IsNull() || process.IsNull())
  {
    return;
  }
  int lost = 0;
  std::string first;
  for (int i = 1; i <= model->NbEntities(); ++i)
  {
    const Handle(Standard_Transient) entity = model->Value(i);
    if (!entity->IsKind(STANDARD_TYPE(StepShape_FaceSurface)) &&
      !entity->IsKind(STANDARD_TYPE(IGESGeom_TrimmedSurface)) &&
      !entity->IsKind(STANDARD_TYPE(IGESSolid_Face)))
    {
      continue;
    }
    const Handle(Transfer_Binder) binder = process->Find(entity);
    if (binder.IsNull() || !binder->HasResult())
    {
      first = lost++ == 0 ? model->StringLabel(entity)->ToCString() : first;
    }
  }
  if (lost > 0)
  {
    document.Warnings.push_back("OpenCASCADE could not make " + std::to_string(lost) +
      " faces of the file's data, the first of them " + first);
  }
}

/// Some entity could not be read, or refers to one that is not there.
bool HasBrokenEntity(const Handle(Interface_InterfaceModel) & model)
{
  for (int i = 1; !model.IsNull() && i <= model->NbEntities(); ++i)
  {
    if (model->IsErrorEntity(i))
    {
      return true;
    }
  }
  return false;
}

void LoadStep(const std::string& path, const Message_ProgressRange& range, CADDocument& document)
{
  STEPCAFControl_Reader reader;
  reader.SetColorMode(true);
  reader.SetNameMode(true);
  reader.SetSHUOMode(true);
  reader.SetLayerMode(false);
  reader.SetPropsMode(false);
  reader.SetGDTMode(false);
  reader.SetMatMode(false);
  reader.SetViewMode(false);
  CheckRead(reader.ReadFile(path.c_str()), path, document.Format);
  // OpenCASCADE looks for names of faces without end where an entity is missing.
  Interface_Static::SetIVal(
    "read.stepcaf.subshapes.name", HasBrokenEntity(reader.ChangeReader().WS()->Model()) ? 0 : 1);
  TColStd_SequenceOfAsciiString lengths, angles, solidAngles;
  reader.ChangeReader().FileUnits(lengths, angles, solidAngles);
  if (!lengths.IsEmpty())
  {
    SetUnit(document, lengths.First().ToCString());
  }
  Handle(TDocStd_Document) data = NewCADDocument();
  if (!reader.Transfer(data, range))
  {
    throw Error("\"" + path + "\": no shape could be made from the STEP file's data");
  }
  WarnOfLostFaces(reader.ChangeReader().WS(), document);
  ReadAssembly(data, document);
}

void LoadIges(const std::string& path, const Message_ProgressRange& range, CADDocument& document)
{
  IGESCAFControl_Reader reader;
  reader.SetColorMode(true);
  reader.SetNameMode(true);
  reader.SetLayerMode(false);
  CheckRead(reader.ReadFile(path.c_str()), path, document.Format);
  const Handle(IGESData_IGESModel) model = Handle(IGESData_IGESModel)::DownCast(reader.Model());
  if (!model.IsNull())
  {
    const Handle(TCollection_HAsciiString) name = model->GlobalSection().UnitName();
    SetUnit(document, name.IsNull() ? "" : name->ToCString());
  }
  Handle(TDocStd_Document) data = NewCADDocument();
  if (!reader.Transfer(data, range))
  {
    throw Error("\"" + path + "\": no shape could be made from the IGES file's data");
  }
  WarnOfLostFaces(reader.WS(), document);
  const TopoDS_Shape shape = reader.OneShape();
  if (HasFace(shape))
  {
    ReadSingleShape(shape, data, document);
  }
}

void LoadBrep(const std::string& path, const Message_ProgressRange& range, CADDocument& document)
{
  // A read that fails throws: OpenCASCADE does not ask, and would go on with garbage or for ever.
  std::ifstream file(path, std::ios::binary);
  file.exceptions(std::ios::failbit | std::ios::badbit);
  TopoDS_Shape shape;
  if (document.Format == CADFormat::BinaryBREP)
  {
    BinTools::Read(shape, file, range);
  }
  else
  {
    BRep_Builder builder;
    BRepTools::Read(shape, file, builder, range);
  }
  if (shape.IsNull())
  {
    throw Error("\"" + path + "\" is a broken BREP file: no shape could be read");
  }
  if (HasFace(shape))
  {
    ReadSingleShape(shape, Handle(TDocStd_Document)(), document);
  }
}

void Load(const std::string& path, const Message_ProgressRange& range, CADDocument& document)
{
  switch (document.Format)
  {
    case CADFormat::STEP:
      return LoadStep(path, range, document);
    case CADFormat::IGES:
      return LoadIges(path, range, document);
    default:
      return LoadBrep(path, range, document);
  }
}

} // namespace

CADDocument LoadCADFile(const std::string& path, const CADProgress& report)
{
  CADDocument document;
  document.Format = DetectCADFormat(path);
  document.Nodes.emplace_back();
  document.Nodes[0].Name = std::filesystem::u8path(path).stem().u8string();

  const CADSession session;
  const Handle(CADProgressIndicator) progress = new CADProgressIndicator(report);
  try
  {
    // Allocated apart: what a crash leaves behind is never touched again.
    auto loaded = std::make_unique<CADDocument>(document);
    const int signal = RunGuarded([&] {
      const Message_ProgressRange range = progress->Start();
      Load(path, range, *loaded);
    });
    if (signal != 0)
    {
      static_cast<void>(loaded.release());
      throw Error("\"" + path + "\" is a broken " + NameOf(document.Format) +
        " file: OpenCASCADE fails on its data");
    }
    document = std::move(*loaded);
  }
  catch (const Standard_Failure& failure)
  {
    throw Error(
      "\"" + path + "\" is a broken " + NameOf(document.Format) + " file: " + ReasonOf(failure));
  }
  catch (const std::ios_base::failure&)
  {
    throw Error("\"" + path + "\" is a truncated or broken " + NameOf(document.Format) +
      " file: it ends, or holds a wrong value, where a number is expected");
  }
  catch (const std::bad_alloc&)
  {
    throw Error("\"" + path + "\" is a broken " + std::string(NameOf(document.Format)) +
      " file, or too large for the memory");
  }
  if (progress->Stopped())
  {
    throw Error("aborted");
  }
  RequireFaces(!document.Instances.empty(), path, document.Format);
  return document;
}

} // namespace nurbs
