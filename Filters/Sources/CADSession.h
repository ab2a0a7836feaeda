// SPDX-License-Identifier: BSD-3-Clause
/// @file CADSession.h
/// @brief What reading and writing with OpenCASCADE's data exchange share: turns, silence, progress.
#pragma once

#include "Types.h"

#include <Message_ProgressIndicator.hxx>
#include <Message_SequenceOfPrinters.hxx>
#include <Standard_Failure.hxx>
#include <TDocStd_Document.hxx>

#include <atomic>
#include <functional>
#include <mutex>
#include <string>

namespace nurbs
{

/// Called with the part done (0 to 1); returns false to stop. From the calling thread.
using CADProgress = std::function<bool(double)>;

/// Lets one thread at a time use OpenCASCADE's readers and writers, which share global state, and
/// keeps their messages from the console while it lives.
class CADSession
{
public:
  CADSession();
  ~CADSession();
  CADSession(const CADSession&) = delete;
  CADSession& operator=(const CADSession&) = delete;

private:
  std::lock_guard<std::mutex> Turn;
  Message_SequenceOfPrinters Printers;
};

/// Passes OpenCASCADE's progress on and the caller's wish to stop back.
class CADProgressIndicator : public Message_ProgressIndicator
{
public:
  explicit CADProgressIndicator(const CADProgress& report)
    : Report(report)
  {}
  bool Stopped() const { return this->Stop; }

protected:
  Standard_Boolean UserBreak() override { return this->Stop; }
  void Show(const Message_ProgressScope& scope, const Standard_Boolean force) override;

private:
  const CADProgress& Report;
  std::atomic<bool> Stop{ false };
  double Next = 0.0;
};

/// An empty XDE document, which goes when its last handle goes.
Handle(TDocStd_Document) NewCADDocument();

/// OpenCASCADE's message, or the kind of failure if it has none.
std::string ReasonOf(const Standard_Failure& failure);

/// What the call returns. Where OpenCASCADE throws, which is no std::exception, throws Error:
/// "OpenCASCADE fails `doing`: reason".
template <class Call>
auto WithoutFailures(const char* doing, const Call& call)
{
  try
  {
    return call();
  }
  catch (const Standard_Failure& failure)
  {
    throw Error(std::string("OpenCASCADE fails ") + doing + ": " + ReasonOf(failure));
  }
}

/// A unit of length.
struct CADUnit
{
  const char* Name;    ///< As in STEP and IGES files, lower case.
  const char* Symbol;  ///< As in the field data LengthUnit: "mm", "m", "in", ...
  const char* Keyword; ///< As OpenCASCADE's writers call it; null: they do not know it.
  double Millimetres;
};

/// The unit of this name or symbol, in any case; null if it is not known.
const CADUnit* FindCADUnit(std::string name);

} // namespace nurbs
