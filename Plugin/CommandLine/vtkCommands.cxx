// SPDX-License-Identifier: BSD-3-Clause
#include "vtkCommands.h"

#include "Failure.h"
#include "ProgressBar.h"
#include "Report.h"
#include "vtkConvertModel.h"
#include "vtkDescribeModel.h"
#include "vtkDrawModel.h"
#include "vtkMessages.h"
#include "vtkReadModel.h"
#include "vtkRenderPicture.h"
#include "vtkTessellateModel.h"
#include "vtkWriteMesh.h"

#include "vtkCamera.h"
#include "vtkDataObject.h"
#include "vtkLogger.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkSMPTools.h"

#include <chrono>
#include <iostream>
#include <sstream>

namespace nurbs
{
namespace
{

constexpr size_t MostWarnings = 10;

class Stopwatch
{
public:
  double Seconds() const
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - this->Started).count();
  }

private:
  std::chrono::steady_clock::time_point Started = std::chrono::steady_clock::now();
};

// What the commands share: the bar, the messages, the figures.
class Session
{
public:
  explicit Session(const Arguments& arguments)
    : Options(arguments)
    , Bar(!arguments.Quiet)
  {
    vtkOutputWindow::SetInstance(this->Messages);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF); // else all is said twice
    if (arguments.Threads > 0)
    {
      vtkSMPTools::Initialize(arguments.Threads);
    }
    if (!arguments.Report.empty())
    {
      CheckWritable(arguments.Report);
    }
    this->Figures.File = arguments.Model;
    this->Figures.Guaranteed = arguments.Guaranteed;
  }

  ~Session()
  {
    this->PrintWarnings();
    vtkOutputWindow::SetInstance(nullptr);
  }

  ProgressFunction Phase(double begin, double end)
  {
    this->Bar.Phase(begin, end);
    return [this](double fraction) { this->Bar.Set(fraction); };
  }

  vtkSmartPointer<vtkDataObject> Read(bool single, double end)
  {
    const Stopwatch watch;
    auto model = ReadModel(this->Options, single, this->Phase(0.0, end));
    this->Figures.ReadSeconds = watch.Seconds();
    return model;
  }

  // Problems are for the report only, and would take another look at every face.
  void Examine(vtkDataObject* model)
  {
    Count(model, this->Figures);
    if (!this->Options.Report.empty())
    {
      ListProblems(model, this->Figures);
    }
  }

  void Warn(const std::vector<std::string>& warnings)
  {
    for (const std::string& warning : warnings)
    {
      this->Messages->DisplayWarningText(warning.c_str());
    }
  }

  // Report, warnings, and what is to be returned.
  int Finish()
  {
    if (!this->Options.Report.empty())
    {
      WriteReport(this->Figures, this->Options.Report);
    }
    this->PrintWarnings();
    const Report& figures = this->Figures;
    const bool complaint =
      figures.Unconverted + figures.FailedFaces + figures.CappedFaces + figures.OpenEdges > 0 ||
      figures.LostFaces + figures.InvalidFaces + figures.TornEdges > 0;
    return this->Options.Strict && complaint ? ExitStrict : ExitSuccess;
  }

  const Arguments& Options;
  Report Figures;

private:
  ProgressBar Bar;
  vtkNew<vtkMessages> Messages;

  void PrintWarnings()
  {
    this->Bar.Clear();
    const std::vector<std::string> warnings = this->Messages->TakeWarnings();
    for (size_t i = 0; i < std::min(warnings.size(), MostWarnings); ++i)
    {
      std::cerr << "vtknurbs: warning: " << warnings[i] << "\n";
    }
    if (warnings.size() > MostWarnings)
    {
      std::cerr << "vtknurbs: warning: and " << warnings.size() - MostWarnings << " more\n";
    }
  }
};

int Info(const Arguments& arguments)
{
  Session session(arguments);
  const auto model = session.Read(false, 1.0);
  Count(model, session.Figures);
  ListProblems(model, session.Figures);
  const int exitCode = session.Finish();
  if (!arguments.Quiet)
  {
    Describe(model, session.Figures, arguments.All, std::cout);
  }
  return exitCode;
}

void PrintSummary(const Session& session)
{
  const Report& figures = session.Figures;
  const Arguments& options = session.Options;
  if (options.Quiet)
  {
    return;
  }
  const std::string unit = figures.Unit.empty() ? "" : " " + figures.Unit;
  std::ostringstream text;
  text.precision(3);
  text << options.Output << ": " << figures.Faces << " faces, " << figures.Triangles
       << " triangles, " << (figures.Guaranteed ? "error at most " : "estimated error ")
       << figures.CertifiedError << unit << " of ";
  if (options.Kind == ToleranceKind::Pixels)
  {
    text << options.Tolerance << " pixels";
  }
  else
  {
    text << figures.Tolerance << unit;
  }
  text << " allowed";
  const auto mention = [&text](std::int64_t count, const char* what) {
    if (count > 0)
    {
      text << ", " << count << what;
    }
  };
  mention(figures.OpenEdges, " open edges");
  mention(figures.RepairedFaces, " faces repaired");
  mention(figures.CappedFaces, " faces beyond the tolerance");
  mention(figures.FailedFaces, " faces failed");
  mention(figures.Unconverted, " faces not converted");
  text << " (read " << figures.ReadSeconds << " s, tessellate " << figures.TessellateSeconds
       << " s, " << (options.What == Command::Render ? "draw " : "write ") << figures.WriteSeconds
       << " s)";
  std::cout << text.str() << "\n";
}

int TessellateCommand(const Arguments& arguments)
{
  CheckMeshPath(arguments.Output);
  Session session(arguments);
  const auto model = session.Read(true, 0.6);
  session.Examine(model);
  Triangles triangles =
    Tessellate(model, arguments, nullptr, session.Phase(0.6, 0.9), session.Figures);
  session.Phase(0.9, 1.0);
  const Stopwatch watch;
  session.Warn(
    WriteMesh(triangles.Mesh, arguments.Output, session.Figures.Unit, session.Figures.Tolerance));
  session.Figures.WriteSeconds = watch.Seconds();
  const int exitCode = session.Finish();
  PrintSummary(session);
  return exitCode;
}

int RenderCommand(const Arguments& arguments)
{
  if (Ending(arguments.Output) != ".png")
  {
    throw Failure("cannot write " + arguments.Output + ": pictures are .png");
  }
  CheckWritable(arguments.Output);
  Session session(arguments);
  const auto model = session.Read(true, 0.6);
  session.Examine(model);
  const auto camera = FitCamera(SamplesOf(model), arguments.View, arguments.Size);
  Triangles triangles =
    Tessellate(model, arguments, camera, session.Phase(0.6, 0.9), session.Figures);
  session.Phase(0.9, 1.0);
  const Stopwatch watch;
  Picture picture;
  picture.Size = arguments.Size;
  picture.View = arguments.View;
  picture.Transparent = arguments.Transparent;
  picture.Device = arguments.Device;
  RenderPicture(
    triangles.Mesh, arguments.Edges ? triangles.Edges.Get() : nullptr, picture, arguments.Output);
  session.Figures.WriteSeconds = watch.Seconds();
  const int exitCode = session.Finish();
  PrintSummary(session);
  return exitCode;
}

void PrintViewSummary(const Session& session)
{
  const Report& figures = session.Figures;
  if (session.Options.Quiet)
  {
    return;
  }
  std::ostringstream text;
  text.precision(3);
  text << session.Options.Output << ": " << figures.Faces << " faces, ";
  if (figures.HasRegions)
  {
    text << figures.VisibleFaces + figures.PartialFaces << " visible (" << figures.PartialFaces
         << " in part)";
  }
  else
  {
    text << figures.Lines << " lines, " << figures.VisibleLines << " visible";
  }
  if (figures.Drawn)
  {
    text << " as " << figures.Curves << " curves and " << figures.StraightLines
         << " straight lines";
  }
  if (figures.Unconverted + figures.UnusedFaces > 0)
  {
    text << ", " << figures.Unconverted + figures.UnusedFaces << " faces failed";
  }
  text << " (read " << figures.ReadSeconds << " s, visibility " << figures.VisibilitySeconds
       << " s, write " << figures.WriteSeconds << " s)";
  std::cout << text.str() << "\n";
}

int ViewCommand(const Arguments& arguments)
{
  CheckViewPath(arguments);
  Session session(arguments);
  const auto model = session.Read(true, 0.4);
  session.Examine(model);
  const auto seen = LookAt(model, arguments, session.Phase(0.4, 0.9), session.Figures);
  WriteView(seen, arguments, session.Phase(0.9, 1.0), session.Figures);
  const int exitCode = session.Finish();
  PrintViewSummary(session);
  return exitCode;
}

void PrintConversion(const Session& session)
{
  const Report& figures = session.Figures;
  if (session.Options.Quiet)
  {
    return;
  }
  std::ostringstream text;
  text.precision(3);
  text << session.Options.Output << ": ";
  if (figures.Converted)
  {
    text << figures.WrittenFaces << " faces, " << figures.Solids
         << (figures.Solids == 1 ? " solid, " : " solids, ") << figures.Shells
         << (figures.Shells == 1 ? " shell, " : " shells, ") << figures.SharedEdges
         << " shared edges, edge tolerance at most " << figures.EdgeTolerance
         << (figures.Unit.empty() ? "" : " ") << figures.Unit;
  }
  else
  {
    text << figures.Faces << " faces";
  }
  const auto mention = [&text](std::int64_t count, const char* what) {
    if (count > 0)
    {
      text << ", " << count << what;
    }
  };
  mention(figures.Instances, figures.Instances == 1 ? " instance" : " instances");
  mention(figures.ComputedEdges, " edge curves computed");
  mention(figures.TornEdges, " edges torn");
  mention(figures.InvalidFaces, " faces not valid");
  mention(figures.LostFaces + figures.Unconverted, " faces failed");
  text << " (read " << figures.ReadSeconds << " s, write " << figures.WriteSeconds << " s)";
  std::cout << text.str() << "\n";
}

int ConvertCommand(const Arguments& arguments)
{
  CheckModelPath(arguments.Output);
  Session session(arguments);
  const auto model = session.Read(Ending(arguments.Output) == ".vtu", 0.6);
  session.Examine(model);
  WriteModel(model, arguments, session.Phase(0.6, 1.0), session.Figures);
  const int exitCode = session.Finish();
  PrintConversion(session);
  return exitCode;
}

} // namespace

//--------------------------------------------------------------------------------------------------
int Execute(const Arguments& arguments)
{
  switch (arguments.What)
  {
    case Command::Info:
      return Info(arguments);
    case Command::Tessellate:
      return TessellateCommand(arguments);
    case Command::Render:
      return RenderCommand(arguments);
    case Command::Convert:
      return ConvertCommand(arguments);
    case Command::Drawing:
    case Command::Visible:
      break;
  }
  return ViewCommand(arguments);
}

} // namespace nurbs
