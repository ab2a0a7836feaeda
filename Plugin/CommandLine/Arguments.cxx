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
  "vtknurbs: CAD files as exact trimmed NURBS, as triangles with a certified error, as pictures.\n"
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

'vtknurbs COMMAND --help' tells the options of a command.
Returns 0 if all went well, 1 after an error, 2 if the command line is wrong, 3 if --strict found
a face that failed or misses the tolerance, or an open edge.)";

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

std::array<double, 3> ParseView(const std::string& text)
{
  const auto named = Views.find(text);
  if (named != Views.end())
  {
    return named->second;
  }
  std::array<double, 3> view = { 0, 0, 0 };
  char first = 0, second = 0;
  std::istringstream stream(text);
  const bool read =
    static_cast<bool>(stream >> view[0] >> first >> view[1] >> second >> view[2]) && stream.eof();
  const double length = std::hypot(view[0], view[1], view[2]);
  if (!read || first != ',' || second != ',' || !(length > 0.0) || !std::isfinite(length))
  {
    throw CLI::ValidationError(
      "--view", "'" + text + "' is neither a view's name (see --help) nor x,y,z such as 1,-1,0.5");
  }
  for (double& component : view)
  {
    component /= length;
  }
  return view;
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
