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
  Render,
  Drawing,
  Visible,
  Convert
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

/// The page of a drawing.
enum class Page
{
  Tight, ///< as large as the drawing
  A4,
  A3,
  A2,
  A1,
  A0
};

/// How a page lies.
enum class Lie
{
  Automatic,
  Landscape,
  Portrait
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
  std::string ViewName = "iso";                    ///< as it was given
  bool Edges = false;
  bool Transparent = false;
  int Device = -1;

  std::array<double, 3> Up = { 0.0, 0.0, 1.0 };
  bool Perspective = false;
  std::array<double, 3> Eye = { 0.0, 0.0, 1.0 };
  double Precision = 1e-4; ///< of the model's diagonal
  bool HiddenLines = true;
  bool SmoothEdges = false;
  bool HiddenRegions = false;
  bool BothSides = true;
  double Scale = 0.0; ///< paper by model; 0: as large as fits
  Page Sheet = Page::Tight;
  Lie Orientation = Lie::Automatic;

  double Gap = 1e-4; ///< of faces that share an edge, of the model's diagonal
};

/// Parse. True if there is something to run; otherwise `exitCode` is what the process returns, and
/// help, version or the error has been printed.
bool Parse(int argc, char** argv, Arguments& arguments, int& exitCode);

} // namespace nurbs

#endif
