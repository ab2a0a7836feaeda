// SPDX-License-Identifier: BSD-3-Clause
#include "CADSession.h"

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <XCAFApp_Application.hxx>

#include <cctype>

namespace nurbs
{

namespace
{

std::mutex OneAtATime;

constexpr CADUnit Units[] = { { "millimetre", "mm", "MM", 1.0 }, { "millimeter", "mm", "MM", 1.0 },
  { "metre", "m", "M", 1000.0 }, { "meter", "m", "M", 1000.0 }, { "centimetre", "cm", "CM", 10.0 },
  { "centimeter", "cm", "CM", 10.0 }, { "decimetre", "dm", nullptr, 100.0 },
  { "kilometre", "km", "KM", 1e6 }, { "kilometer", "km", "KM", 1e6 },
  { "micrometre", "um", "UM", 1e-3 }, { "micrometer", "um", "UM", 1e-3 },
  { "micron", "um", "UM", 1e-3 }, { "nanometre", "nm", nullptr, 1e-6 },
  { "inch", "in", "INCH", 25.4 }, { "foot", "ft", "FT", 304.8 }, { "yard", "yd", nullptr, 914.4 },
  { "mile", "mi", "MI", 1609344.0 }, { "mil", "mil", "MIL", 0.0254 },
  { "uin", "uin", "UIN", 2.54e-5 } };

} // namespace

CADSession::CADSession()
  : Turn(OneAtATime)
  , Printers(Message::DefaultMessenger()->Printers())
{
  Message::DefaultMessenger()->ChangePrinters().Clear();
}

CADSession::~CADSession()
{
  Message::DefaultMessenger()->ChangePrinters() = this->Printers;
}

void CADProgressIndicator::Show(const Message_ProgressScope&, const Standard_Boolean)
{
  // Called under a lock, in steps of our own choosing.
  const double now = this->GetPosition();
  if (now >= this->Next && !this->Stop)
  {
    this->Next = now + 0.01;
    this->Stop = !this->Report(now);
  }
}

std::string ReasonOf(const Standard_Failure& failure)
{
  const char* text = failure.GetMessageString();
  return text && *text ? text : failure.DynamicType()->Name();
}

Handle(TDocStd_Document) NewCADDocument()
{
  // Not registered with the application: closed when the last handle goes.
  Handle(TDocStd_Document) document = new TDocStd_Document("BinXCAF");
  XCAFApp_Application::GetApplication()->InitDocument(document);
  return document;
}

const CADUnit* FindCADUnit(std::string name)
{
  for (char& c : name)
  {
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  for (const CADUnit& unit : Units)
  {
    if (name == unit.Name || name == unit.Symbol)
    {
      return &unit;
    }
  }
  return nullptr;
}

} // namespace nurbs
