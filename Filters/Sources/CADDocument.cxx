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
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_ProgressIndicator.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <StepShape_FaceSurface.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <Transfer_Binder.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <mutex>

namespace nurbs
{

namespace
{

/// Passes OpenCASCADE's progress on and its wish to stop back.
class Progress : public Message_ProgressIndicator
{
public:
  explicit Progress(const CADProgress& report)
    : Report(report)
  {}
  bool Stopped() const { return this->Stop; }

protected:
  Standard_Boolean UserBreak() override { return this->Stop; }
  void Show(const Message_ProgressScope&, const Standard_Boolean) override
  {
    // Called under a lock, in steps of our own choosing.
    const double now = this->GetPosition();
    if (now >= this->Next && !this->Stop)
    {
      this->Next = now + 0.01;
      this->Stop = !this->Report(now);
    }
  }

private:
  const CADProgress& Report;
  std::atomic<bool> Stop{ false };
  double Next = 0.0;
};

/// Keeps OpenCASCADE's messages off the console and its unit at millimetres while it lives.
class Quiet
{
public:
  Quiet()
    : Printers(Message::DefaultMessenger()->Printers())
  {
    Message::DefaultMessenger()->ChangePrinters().Clear();
  }
  ~Quiet() { Message::DefaultMessenger()->ChangePrinters() = this->Printers; }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

private:
  Message_SequenceOfPrinters Printers;
};

struct Unit
{
  const char* Name; ///< As in STEP and IGES files, lower case.
  const char* Symbol;
  double Millimetres;
};

constexpr Unit Units[] = { { "millimetre", "mm", 1.0 }, { "millimeter", "mm", 1.0 },
  { "metre", "m", 1000.0 }, { "meter", "m", 1000.0 }, { "centimetre", "cm", 10.0 },
  { "centimeter", "cm", 10.0 }, { "kilometre", "km", 1e6 }, { "kilometer", "km", 1e6 },
  { "micrometre", "um", 1e-3 }, { "micrometer", "um", 1e-3 }, { "micron", "um", 1e-3 },
  { "inch", "in", 25.4 }, { "foot", "ft", 304.8 }, { "mile", "mi", 1609344.0 },
  { "mil", "mil", 0.0254 }, { "uin", "uin", 2.54e-5 }, { "mm", "mm", 1.0 }, { "m", "m", 1000.0 },
  { "cm", "cm", 10.0 }, { "km", "km", 1e6 }, { "um", "um", 1e-3 }, { "in", "in", 25.4 },
  { "ft", "ft", 304.8 }, { "mi", "mi", 1609344.0 } };

void SetUnit(CADDocument& document, std::string name)
{
  for (char& c : name)
  {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  for (const Unit& unit : Units)
  {
    if (name == unit.Name)
    {
      document.FileUnit = unit.Symbol;
      document.FileUnitLength = unit.Millimetres;
      return;
    }
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

Handle(TDocStd_Document) NewDocument()
{
  // Not registered with the application: closed when the last handle goes.
  Handle(TDocStd_Document) document = new TDocStd_Document("BinXCAF");
  XCAFApp_Application::GetApplication()->InitDocument(document);
  return document;
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
  TColStd_SequenceOfAsciiString lengths, angles, solidAngles;
  reader.ChangeReader().FileUnits(lengths, angles, solidAngles);
  if (!lengths.IsEmpty())
  {
    SetUnit(document, lengths.First().ToCString());
  }
  Handle(TDocStd_Document) data = NewDocument();
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
  Handle(TDocStd_Document) data = NewDocument();
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

  static std::mutex turn;
  const std::lock_guard<std::mutex> lock(turn);
  const Quiet quiet;
  const Handle(Progress) progress = new Progress(report);
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
    const char* text = failure.GetMessageString();
    throw Error("\"" + path + "\" is a broken " + NameOf(document.Format) +
      " file: " + (text && *text ? text : failure.DynamicType()->Name()));
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
