// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The command line, parsed and checked as far as it can be without opening the model.
#ifndef nurbsArguments_h
#define nurbsArguments_h

#include <array>
#include <string>

namespace nurbs
{

enum class Command
{
  Info,
  Tessellate,
  Render
};

enum class ToleranceKind
{
  Relative, ///< of the diagonal of the model's bounding box
  Absolute, ///< in the model's unit of length
  Pixels    ///< of the picture that is rendered
};

enum class Method
{
  KdTree,
  QuadTree,
  Binary
};

/// The unit that a CAD file's lengths are converted to.
enum class LengthUnit
{
  Millimetres,
  Metres,
  File ///< what the file is written in
};

/// All options of all commands; a command looks at its own.
struct Arguments
{
  Command What = Command::Info;
  std::string Model;
  std::string Output;
  LengthUnit Unit = LengthUnit::Millimetres;
  std::string Report; ///< file of the JSON report; empty: none
  ToleranceKind Kind = ToleranceKind::Relative;
  double Tolerance = 1e-3;
  Method Split = Method::KdTree;
  bool Guaranteed = true;
  bool MergePoints = false;
  int Threads = 0; ///< 0: as many as there are processors
  bool Quiet = false;
  bool Strict = false;
  bool All = false; ///< info: every part and problem, however many

  std::array<int, 2> Size = { 1200, 900 };
  std::array<double, 3> View = { 1.0, -1.0, 1.0 }; ///< from the object to the viewer
  bool Edges = false;
  bool Transparent = false;
  int Device = -1;
};

/// Parse. True if there is something to run; otherwise `exitCode` is what the process returns, and
/// help, version or the error has been printed.
bool Parse(int argc, char** argv, Arguments& arguments, int& exitCode);

} // namespace nurbs

#endif
