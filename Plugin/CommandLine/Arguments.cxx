// SPDX-License-Identifier: BSD-3-Clause
#include "Arguments.h"

#include "Failure.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <map>
#include <memory>
#include <sstream>
#include <vector>

namespace nurbs
{
namespace
{

const char* const Description =
  "vtknurbs: CAD files as exact trimmed NURBS, as triangles with a certified error, as pictures "
  "and\n"
  "engineering drawings.\n"
  "MODEL is a STEP, IGES or BREP file (.step .stp .iges .igs .brep), or a model saved by VTK\n"
  "(.vtu, .vtpc).";

const char* const Examples = R"(Examples:
  vtknurbs info linkrods.step
      What is in the file: faces, edges, degrees, parts, units, and what is wrong with it.

  vtknurbs tessellate linkrods.step -o linkrods.vtp
      Triangles nowhere farther from the surface than 1/1000 of the model's diagonal.

  vtknurbs tessellate linkrods.step -o linkrods.stl --absolute 0.05 --report linkrods.json
      The same within 0.05 of the model's unit, for printing, and the figures as JSON.

  vtknurbs render linkrods.step -o linkrods.png --view front --size 1920x1080 --edges
      A picture; no display, window or graphics card is needed.

  vtknurbs drawing linkrods.step -o linkrods.pdf --view front --page a4
      An engineering drawing with hidden lines dashed, as true curves.

  vtknurbs visible linkrods.step -o seen.vtu --view top
      What is visible from above, as trimmed surfaces again.

  vtknurbs convert linkrods.step -o linkrods.iges
      The same surfaces in another CAD format.

'vtknurbs COMMAND --help' tells the options of a command.
Returns 0 if all went well, 1 after an error, 2 if the command line is wrong, 3 if --strict found
a face that failed, is not valid or misses the tolerance, or an open or torn edge.)";

const char* const TessellateExamples = R"(Formats, by the ending of -o:
  .vtp .vtu   VTK: normals, parameters, FaceId, names, colours, error of each face
  .glb        binary glTF in metres, y up: one mesh a name, one material a colour
  .ply        binary, with normals, parameters and the faces' colours
  .stl        binary, triangles only
  .obj        with normals, all digits
  .stl, .ply and .glb keep 32-bit coordinates; a warning says so where that matters.

Examples:
  vtknurbs tessellate gear.step -o gear.glb
  vtknurbs tessellate gear.step -o gear.vtp --tolerance 1e-4 --method quadtree
  vtknurbs tessellate gear.step -o gear.stl --absolute 0.01 --strict && print3d gear.stl)";

const char* const RenderExamples = R"(Views, as the direction from the object to the viewer, z up:
  iso (1,-1,1)   front (0,-1,0)   back (0,1,0)   right (1,0,0)   left (-1,0,0)
  top (0,0,1)    bottom (0,0,-1)  or any x,y,z such as 0.5,-1,0.3

Examples:
  vtknurbs render gear.step -o gear.png
  vtknurbs render gear.step -o gear.png --view 1,-2,0.5 --size 2400x1800 --edges
  vtknurbs render gear.step -o gear.png --pixels 0.1 --transparent)";

const char* const DrawingExamples = R"(Views, as the direction from the object to the viewer, z up:
  iso (1,-1,1)   front (0,-1,0)   back (0,1,0)   right (1,0,0)   left (-1,0,0)
  top (0,0,1)    bottom (0,0,-1)  or any x,y,z such as 0.5,-1,0.3
  Seen from above or below, y is up.

Formats, by the ending of -o:
  .svg   a group a kind of line, paths that name the faces and edges they show; layers of Inkscape
  .pdf   one page with a layer a kind of line
  .vtp   polylines for VTK, in the model's unit, with Visibility, Kind, FaceId and EdgeId

Examples:
  vtknurbs drawing gear.step -o gear.svg
  vtknurbs drawing gear.step -o gear.pdf --view front --page a3 --scale 1:2
  vtknurbs drawing gear.step -o gear.svg --eye 300,-500,200 --no-hidden --smooth)";

const char* const VisibleExamples =
  R"(The output is a model again, the trims of which are what is visible; faces of which nothing is
visible are left out. Arrays of its faces: VisibleArea, VisibleFraction. Views are named as for
'vtknurbs drawing'.

Examples:
  vtknurbs visible gear.step -o seen.vtu --view front
  vtknurbs visible gear.step -o seen.step --view 1,-2,0.5
  vtknurbs visible gear.step -o unseen.vtu --view 1,-2,0.5 --hidden-regions
  vtknurbs tessellate seen.vtu -o seen.stl)";

const char* const ConvertExamples = R"(Formats, by the ending of -o:
  .step .stp   STEP AP214: assembly tree, names, colours, unit
  .iges .igs   IGES solids and shells: colours, unit
  .brep .brp   OpenCASCADE's own: geometry in millimetres
  .vtu .vtpc   VTK: all arrays; one model, or an assembly
  Surfaces keep their degrees, knots and weights. Faces that share edges are sewn, and what is closed
  becomes a solid.

Examples:
  vtknurbs convert gear.iges -o gear.step
  vtknurbs convert deformed.vtu -o deformed.step --gap 1e-3 --strict)";

const std::map<std::string, Page> Pages = { { "tight", Page::Tight }, { "a4", Page::A4 },
  { "a3", Page::A3 }, { "a2", Page::A2 }, { "a1", Page::A1 }, { "a0", Page::A0 } };

const std::map<std::string, Method> Methods = { { "kd-tree", Method::KdTree },
  { "quadtree", Method::QuadTree }, { "binary", Method::Binary } };

const std::map<std::string, LengthUnit> Units = { { "mm", LengthUnit::Millimetres },
  { "m", LengthUnit::Metres }, { "file", LengthUnit::File } };

const std::map<std::string, std::array<double, 3>> Views = { { "iso", { 1, -1, 1 } },
  { "front", { 0, -1, 0 } }, { "back", { 0, 1, 0 } }, { "right", { 1, 0, 0 } },
  { "left", { -1, 0, 0 } }, { "top", { 0, 0, 1 } }, { "bottom", { 0, 0, -1 } } };

std::array<int, 2> ParseSize(const std::string& text)
{
  std::array<int, 2> size = { 0, 0 };
  char x = 0;
  std::istringstream stream(text);
  if (!(stream >> size[0] >> x >> size[1]) || (x != 'x' && x != 'X') || !stream.eof() ||
    size[0] < 1 || size[1] < 1 || size[0] > 65536 || size[1] > 65536)
  {
    throw CLI::ValidationError("--size", "'" + text + "' is not WIDTHxHEIGHT such as 1200x900");
  }
  return size;
}

// x,y,z
bool ReadVector(const std::string& text, std::array<double, 3>& vector)
{
  char first = 0, second = 0;
  std::istringstream stream(text);
  const bool read =
    static_cast<bool>(stream >> vector[0] >> first >> vector[1] >> second >> vector[2]) &&
    stream.eof();
  return read && first == ',' && second == ',' &&
    std::isfinite(std::hypot(vector[0], vector[1], vector[2]));
}

// A vector of length 1.
bool ReadDirection(const std::string& text, std::array<double, 3>& vector)
{
  if (!ReadVector(text, vector))
  {
    return false;
  }
  const double length = std::hypot(vector[0], vector[1], vector[2]);
  for (double& component : vector)
  {
    component /= length;
  }
  return length > 0.0;
}

std::array<double, 3> ParseView(const std::string& text)
{
  const auto named = Views.find(text);
  std::array<double, 3> view = { 0, 0, 0 };
  if (named == Views.end() && ReadVector(text, view) && view == std::array<double, 3>{ 0, 0, 0 })
  {
    throw CLI::ValidationError("--view", "the direction '" + text + "' has length zero");
  }
  if (named == Views.end() && !ReadDirection(text, view))
  {
    throw CLI::ValidationError(
      "--view", "'" + text + "' is neither a view's name (see --help) nor x,y,z such as 1,-1,0.5");
  }
  return named == Views.end() ? view : named->second;
}

// A number greater than 0, or the quotient of two as in 1:2; "fit" is 0.
double ParseScale(const std::string& text)
{
  if (text == "fit")
  {
    return 0.0;
  }
  double paper = 0.0, model = 1.0;
  char colon = ':';
  std::istringstream stream(text);
  bool read = static_cast<bool>(stream >> paper);
  if (read && !stream.eof())
  {
    read = static_cast<bool>(stream >> colon >> model) && stream.eof();
  }
  const double scale = paper / model;
  if (!read || colon != ':' || !(paper > 0.0 && model > 0.0) || !std::isfinite(scale))
  {
    throw CLI::ValidationError("--scale", "'" + text + "' is not a scale such as 1:2, 0.5 or fit");
  }
  return scale;
}

// "a3", "a3-landscape"
void ParsePage(const std::string& text, Arguments& arguments)
{
  const size_t dash = text.find('-');
  const auto page = Pages.find(text.substr(0, dash));
  const std::string lie = dash == std::string::npos ? "" : text.substr(dash + 1);
  if (page == Pages.end() || (dash != std::string::npos && lie != "landscape" && lie != "portrait"))
  {
    throw CLI::ValidationError("--page",
      "'" + text + "' is not tight, a4, a3, ... or a0, perhaps with -landscape or -portrait");
  }
  arguments.Sheet = page->second;
  arguments.Orientation =
    lie.empty() ? Lie::Automatic : (lie == "landscape" ? Lie::Landscape : Lie::Portrait);
}

// A finite number greater than 0.
CLI::Validator Positive()
{
  return CLI::Validator(
    [](std::string& text) {
      double value = 0.0;
      const bool good =
        CLI::detail::lexical_cast(text, value) && value > 0.0 && std::isfinite(value);
      return good ? std::string() : "'" + text + "' is not a number greater than 0";
    },
    std::string());
}

void AddModel(CLI::App* command, Arguments& arguments)
{
  command->add_option("MODEL", arguments.Model, "CAD file or saved model")->required();
  command
    ->add_option_function<std::string>(
      "--unit", [&arguments](const std::string& name) { arguments.Unit = Units.at(name); },
      "unit to convert a CAD file's lengths to: mm (default), m, or file")
    ->type_name("UNIT")
    ->check(CLI::IsMember({ "mm", "m", "file" }).description(""));
  command->add_option("--report", arguments.Report, "write the figures as JSON to FILE")
    ->type_name("FILE");
  command->add_option("--threads", arguments.Threads, "threads to use; 0, the default: all")
    ->type_name("N")
    ->check(CLI::Range(0, 4096));
  command->add_flag("-q,--quiet", arguments.Quiet, "print warnings and errors only");
}

void AddTolerance(CLI::App* command, Arguments& arguments, bool pixels)
{
  const std::string group = "How finely";
  std::vector<CLI::Option*> kinds;
  const auto add = [&](const char* name, const char* unit, ToleranceKind kind, const char* text) {
    const auto set = [&arguments, kind](const double& value) {
      arguments.Kind = kind;
      arguments.Tolerance = value;
    };
    kinds.push_back(command->add_option_function<double>(name, set, text)
                      ->type_name(unit)
                      ->check(Positive())
                      ->group(group));
  };
  add("--tolerance", "T", ToleranceKind::Relative,
    pixels ? "largest error as a part of the model's diagonal"
           : "largest error as a part of the model's diagonal; default 1e-3");
  add("--absolute", "T", ToleranceKind::Absolute, "largest error in the model's unit of length");
  if (pixels)
  {
    add("--pixels", "P", ToleranceKind::Pixels, "largest error in pixels; default 0.5");
  }
  for (CLI::Option* one : kinds)
  {
    for (CLI::Option* other : kinds)
    {
      if (one != other)
      {
        one->excludes(other);
      }
    }
  }
  command
    ->add_option_function<std::string>(
      "--method", [&arguments](const std::string& name) { arguments.Split = Methods.at(name); },
      "how surfaces are split: kd-tree (default), quadtree or binary")
    ->type_name("NAME")
    ->check(CLI::IsMember({ "kd-tree", "quadtree", "binary" }).description(""))
    ->group(group);
  command
    ->add_option_function<std::string>(
      "--error",
      [&arguments](const std::string& name) { arguments.Guaranteed = name != "estimated"; },
      "guaranteed (default), a proven bound; or estimated, fewer triangles")
    ->type_name("NAME")
    ->check(CLI::IsMember({ "guaranteed", "estimated" }).description(""))
    ->group(group);
  command->add_flag("--strict", arguments.Strict,
    "return 3 if a face failed or misses the tolerance, or an edge is open");
}

void AddTessellate(CLI::App& app, Arguments& arguments)
{
  CLI::App* command = app.add_subcommand("tessellate", "turn a model into triangles");
  AddModel(command, arguments);
  command->add_option("-o,--output", arguments.Output, "mesh to write; its ending is the format")
    ->type_name("FILE")
    ->required();
  AddTolerance(command, arguments, false);
  command
    ->add_flag("--merge", arguments.MergePoints,
      "merge the points of neighbouring faces, which leaves no normals")
    ->group("How finely");
  command->group("Commands");
  command->footer(TessellateExamples);
  command->parse_complete_callback([&arguments] { arguments.What = Command::Tessellate; });
}

void AddRender(CLI::App& app, Arguments& arguments)
{
  CLI::App* command = app.add_subcommand("render", "draw a model to a picture, without a display");
  AddModel(command, arguments);
  command->add_option("-o,--output", arguments.Output, "picture to write (.png)")
    ->type_name("FILE")
    ->required();
  const std::string group = "The picture";
  command
    ->add_option_function<std::string>(
      "--size", [&arguments](const std::string& text) { arguments.Size = ParseSize(text); },
      "in pixels; default 1200x900")
    ->type_name("WxH")
    ->group(group);
  command
    ->add_option_function<std::string>(
      "--view", [&arguments](const std::string& text) { arguments.View = ParseView(text); },
      "iso (default), front, top, ..., or x,y,z")
    ->type_name("VIEW")
    ->group(group);
  command->add_flag("--edges", arguments.Edges, "draw the faces' edges")->group(group);
  command->add_flag("--transparent", arguments.Transparent, "leave the background transparent")
    ->group(group);
  command->add_option("--device", arguments.Device, "EGL device; default: the first that works")
    ->type_name("N")
    ->check(CLI::Range(0, 1024))
    ->group(group);
  AddTolerance(command, arguments, true);
  command->group("Commands");
  command->footer(RenderExamples);
  command->parse_complete_callback([&arguments, command] {
    arguments.What = Command::Render;
    if (command->count("--tolerance") + command->count("--absolute") == 0 &&
      command->count("--pixels") == 0)
    {
      arguments.Kind = ToleranceKind::Pixels;
      arguments.Tolerance = 0.5;
    }
  });
}

// Where a model is seen from, and how exactly.
void AddViewing(CLI::App* command, Arguments& arguments)
{
  const std::string group = "The view";
  const auto view = [&arguments](const std::string& text) {
    arguments.View = ParseView(text);
    arguments.ViewName = text;
  };
  const auto eye = [&arguments](const std::string& text) {
    if (!ReadVector(text, arguments.Eye))
    {
      throw CLI::ValidationError("--eye", "'" + text + "' is not x,y,z such as 100,-300,50");
    }
    arguments.Perspective = true;
  };
  const auto up = [&arguments](const std::string& text) {
    if (!ReadDirection(text, arguments.Up))
    {
      throw CLI::ValidationError("--up", "'" + text + "' is not x,y,z such as 0,1,0");
    }
  };
  CLI::Option* parallel =
    command
      ->add_option_function<std::string>("--view", view, "iso (default), front, top, ..., or x,y,z")
      ->type_name("VIEW")
      ->group(group);
  command
    ->add_option_function<std::string>(
      "--eye", eye, "perspective, from the point x,y,z of the model's coordinates")
    ->type_name("x,y,z")
    ->group(group)
    ->excludes(parallel);
  command->add_option_function<std::string>("--up", up, "what points upwards; default 0,0,1")
    ->type_name("x,y,z")
    ->group(group);
  command
    ->add_option("--precision", arguments.Precision,
      "largest error as a part of the model's diagonal; default 1e-4")
    ->type_name("P")
    ->check(Positive())
    ->group(group);
  command
    ->add_flag_callback(
      "--one-sided", [&arguments] { arguments.BothSides = false; },
      "faces seen from behind are not visible, and still hide")
    ->group(group);
}

void AddDrawing(CLI::App& app, Arguments& arguments)
{
  CLI::App* command =
    app.add_subcommand("drawing", "draw a model's lines, the hidden ones dashed, as SVG or PDF");
  AddModel(command, arguments);
  command->add_option("-o,--output", arguments.Output, "drawing to write (.svg, .pdf or .vtp)")
    ->type_name("FILE")
    ->required();
  AddViewing(command, arguments);
  const std::string group = "The drawing";
  CLI::Option* hidden = command->add_flag("--hidden", "draw hidden lines (default)")->group(group);
  command
    ->add_flag_callback(
      "--no-hidden", [&arguments] { arguments.HiddenLines = false; }, "leave hidden lines out")
    ->group(group)
    ->excludes(hidden);
  command->add_flag("--smooth", arguments.SmoothEdges, "draw edges where faces meet smoothly, too")
    ->group(group);
  command
    ->add_option_function<std::string>(
      "--scale", [&arguments](const std::string& text) { arguments.Scale = ParseScale(text); },
      "such as 1:2; default fit, to the page or to A4")
    ->type_name("SCALE")
    ->group(group);
  command
    ->add_option_function<std::string>(
      "--page", [&arguments](const std::string& text) { ParsePage(text, arguments); },
      "tight (default), a4, ..., a0; a4-landscape, a4-portrait")
    ->type_name("PAGE")
    ->group(group);
  command->group("Commands");
  command->footer(DrawingExamples);
  command->parse_complete_callback([&arguments] { arguments.What = Command::Drawing; });
}

void AddVisible(CLI::App& app, Arguments& arguments)
{
  CLI::App* command = app.add_subcommand("visible", "cut out what of a model's faces is visible");
  AddModel(command, arguments);
  command->add_option("-o,--output", arguments.Output, "model to write (.vtu, or a CAD file)")
    ->type_name("FILE")
    ->required();
  AddViewing(command, arguments);
  command->add_flag("--hidden-regions", arguments.HiddenRegions, "what is hidden instead")
    ->group("The view");
  command->group("Commands");
  command->footer(VisibleExamples);
  command->parse_complete_callback([&arguments] { arguments.What = Command::Visible; });
}

void AddConvert(CLI::App& app, Arguments& arguments)
{
  CLI::App* command =
    app.add_subcommand("convert", "write a model's surfaces to another CAD format");
  AddModel(command, arguments);
  command->add_option("-o,--output", arguments.Output, "model to write; its ending is the format")
    ->type_name("FILE")
    ->required();
  command
    ->add_option("--gap", arguments.Gap,
      "how far apart faces may be that share an edge, as a part of the model's diagonal; default "
      "1e-4")
    ->type_name("G")
    ->check(CLI::NonNegativeNumber);
  command->add_flag(
    "--strict", arguments.Strict, "return 3 if a face failed or is not valid, or an edge is torn");
  command->group("Commands");
  command->footer(ConvertExamples);
  command->parse_complete_callback([&arguments] { arguments.What = Command::Convert; });
}

// CLI11's help with usage lines that can be copied, and options without their validators.
class HelpFormatter : public CLI::Formatter
{
public:
  HelpFormatter() { this->column_width(24); }

  std::string make_usage(const CLI::App* app, std::string name) const override
  {
    std::string usage = "\nUsage: " + name;
    for (const CLI::Option* positional :
      app->get_options([](const CLI::Option* option) { return option->get_positional(); }))
    {
      usage += " " + positional->get_name(true);
    }
    for (const CLI::Option* option : app->get_options(
           [](const CLI::Option* each) { return each->get_required() && !each->get_positional(); }))
    {
      usage += " -" + option->get_snames().front() + " " + option->get_type_name();
    }
    const bool commands = !app->get_subcommands({}).empty();
    return usage + (commands ? " COMMAND" : "") + " [OPTIONS]\n";
  }

  std::string make_option_opts(const CLI::Option* option) const override
  {
    const std::string type = option->get_type_name();
    return option->get_items_expected_max() == 0 || option->get_positional()
      ? std::string()
      : " " + type.substr(0, type.find(':'));
  }

  std::string make_help(
    const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override
  {
    std::string help = this->CLI::Formatter::make_help(app, name, mode);
    for (size_t at; (at = help.find("\n\n\n")) != std::string::npos;)
    {
      help.erase(at, 1);
    }
    return help;
  }
};

} // namespace

//--------------------------------------------------------------------------------------------------
bool Parse(int argc, char** argv, Arguments& arguments, int& exitCode)
{
  CLI::App app(Description, "vtknurbs");
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_version_flag("--version", "vtknurbs " NURBS_VERSION, "print the version");
  app.set_help_flag("-h,--help", "print this help");
  app.require_subcommand(1);
  app.footer(Examples);
  CLI::App* info = app.add_subcommand("info", "tell what is in a model");
  AddModel(info, arguments);
  info->add_flag("--all", arguments.All, "print every part and problem, however many there are");
  info->group("Commands");
  info->footer("Example:\n  vtknurbs info gear.step --report gear.json");
  info->parse_complete_callback([&arguments] { arguments.What = Command::Info; });
  AddTessellate(app, arguments);
  AddRender(app, arguments);
  AddDrawing(app, arguments);
  AddVisible(app, arguments);
  AddConvert(app, arguments);
  try
  {
    app.parse(argc, argv);
    return true;
  }
  catch (const CLI::Success& success) // --help, --version
  {
    exitCode = app.exit(success);
  }
  catch (const CLI::ParseError& error)
  {
    std::cerr << "vtknurbs: " << error.what() << "\nTry 'vtknurbs --help'.\n";
    exitCode = ExitUsage;
  }
  return false;
}

} // namespace nurbs
