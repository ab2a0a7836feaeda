// SPDX-License-Identifier: BSD-3-Clause
// vtkNURBSDrawingWriter: files read again by pugixml and QPDF, compared with the lines that went
// in.
#include "../../testMessageKeeper.h"
#include "vtkNURBSDrawingWriter.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkErrorCode.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"
#include "vtk_pugixml.h"

#define POINTERHOLDER_TRANSITION 4
#include <qpdf/QPDF.hh>
#include <qpdf/QPDFPageDocumentHelper.hh>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <sstream>

namespace
{

constexpr double Pi = 3.14159265358979323846;

using Point = std::array<double, 2>;
using Polyline = std::vector<Point>;

double Distance(const Point& a, const Point& b)
{
  return std::hypot(a[0] - b[0], a[1] - b[1]);
}

double Distance(const Point& p, const Polyline& line)
{
  double nearest = 1e300;
  for (std::size_t k = 0; k + 1 < line.size(); ++k)
  {
    const Point &a = line[k], &b = line[k + 1];
    const double x = b[0] - a[0], y = b[1] - a[1], square = x * x + y * y;
    const double t =
      square > 0.0 ? std::clamp(((p[0] - a[0]) * x + (p[1] - a[1]) * y) / square, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, Distance(p, Point{ a[0] + t * x, a[1] + t * y }));
  }
  return nearest;
}

Polyline Arc(double x, double y, double radius, double from, double to, int steps)
{
  Polyline line;
  for (int k = 0; k <= steps; ++k)
  {
    const double angle = from + (to - from) * k / steps;
    line.push_back({ x + radius * std::cos(angle), y + radius * std::sin(angle) });
  }
  return line;
}

// Lines for the writer, with the arrays of vtkNURBSVisibleRegions.
class Scene
{
public:
  Scene()
  {
    this->Kinds->SetName("Kind");
    this->Visibility->SetName("Visibility");
    this->Edges->SetName("EdgeId");
    this->Faces->SetName("FaceId");
    this->Data->SetPoints(this->Points);
    this->Data->SetLines(this->Cells);
    for (vtkDataArray* array :
      { static_cast<vtkDataArray*>(this->Kinds), static_cast<vtkDataArray*>(this->Visibility),
        static_cast<vtkDataArray*>(this->Edges), static_cast<vtkDataArray*>(this->Faces) })
    {
      this->Data->GetCellData()->AddArray(array);
    }
  }

  void Add(const Polyline& line, int kind = 2, int visible = 1, int edge = -1, int face = -1)
  {
    this->Cells->InsertNextCell(int(line.size()));
    for (const Point& p : line)
    {
      this->Cells->InsertCellPoint(this->Points->InsertNextPoint(p[0], p[1], 5.0));
    }
    this->Kinds->InsertNextValue(static_cast<unsigned char>(kind));
    this->Visibility->InsertNextValue(static_cast<unsigned char>(visible));
    this->Edges->InsertNextValue(edge);
    this->Faces->InsertNextValue(face);
  }

  void SetUnit(const char* name)
  {
    vtkNew<vtkStringArray> unit;
    unit->SetName("LengthUnit");
    unit->InsertNextValue(name);
    this->Data->GetFieldData()->AddArray(unit);
  }

  vtkNew<vtkPolyData> Data;

private:
  struct DoublePoints : public vtkNew<vtkPoints>
  {
    DoublePoints() { (*this)->SetDataTypeToDouble(); }
  } Points;
  vtkNew<vtkCellArray> Cells;
  vtkNew<vtkUnsignedCharArray> Kinds, Visibility;
  vtkNew<vtkIdTypeArray> Edges, Faces;
};

std::string FileName(const std::string& name)
{
  return std::string(NURBS_TEST_OUTPUT) + "/drawing-" + name;
}

// Writes to `writer`'s file, as SVG, and reads that.
pugi::xml_node Written(vtkNURBSDrawingWriter* writer, pugi::xml_document& document)
{
  EXPECT_EQ(writer->Write(), 1);
  const auto result = document.load_file(writer->GetFileName());
  EXPECT_TRUE(result) << result.description();
  return document.child("svg");
}

pugi::xml_node Group(pugi::xml_node svg, const std::string& name)
{
  return svg.find_node(
    [&](const pugi::xml_node& node) { return name == node.attribute("id").value(); });
}

// The points of a path of M, L, C and Z: of curves, some; closed where it says so.
Polyline Sampled(const std::string& data)
{
  std::string spaced;
  for (const char c : data)
  {
    spaced +=
      std::isalpha(static_cast<unsigned char>(c)) ? std::string{ ' ', c, ' ' } : std::string{ c };
  }
  std::istringstream stream(spaced);
  Polyline line;
  for (std::string command; stream >> command;)
  {
    if (command == "Z")
    {
      line.push_back(line.front());
      continue;
    }
    const std::size_t count = command == "C" ? 3 : 1;
    std::array<Point, 4> p;
    for (std::size_t k = 4 - count; k < 4; ++k)
    {
      EXPECT_TRUE(stream >> p[k][0] >> p[k][1]) << data;
    }
    p[0] = line.empty() ? p[3] : line.back();
    for (int s = command == "C" ? 1 : 100; s <= 100; ++s)
    {
      const double u = s / 100.0, v = 1.0 - u;
      Point at = p[3];
      for (int c = 0; c < 2 && count == 3; ++c)
      {
        at[c] = v * v * v * p[0][c] + 3.0 * v * v * u * p[1][c] + 3.0 * v * u * u * p[2][c] +
          u * u * u * p[3][c];
      }
      line.push_back(at);
    }
  }
  return line;
}

std::vector<pugi::xml_node> Paths(pugi::xml_node node)
{
  std::vector<pugi::xml_node> paths;
  for (const auto& found : node.select_nodes(".//path"))
  {
    paths.push_back(found.node());
  }
  return paths;
}

TEST(NURBSDrawingWriter, CircleOfThreeEdgesIsOnePathOfFewCurves)
{
  Scene scene;
  // The second runs the other way round.
  scene.Add(Arc(7.0, 3.0, 2.0, 0.0, 2.0, 200), 2, 1, 11, 4);
  scene.Add(Arc(7.0, 3.0, 2.0, 4.0, 2.0, 200), 2, 1, 12, 5);
  scene.Add(Arc(7.0, 3.0, 2.0, 4.0, 2.0 * Pi, 200), 2, 1, 13, 4);
  vtkNew<vtkNURBSDrawingWriter> writer;
  writer->SetInputData(scene.Data);
  writer->SetFileName(FileName("circle.svg").c_str());
  writer->SetScale(10.0);
  writer->SetMargin(5.0);
  pugi::xml_document document;
  const pugi::xml_node svg = Written(writer, document);
  const auto paths = Paths(svg);
  ASSERT_EQ(paths.size(), 1u);
  EXPECT_EQ(paths[0].attribute("data-edge").value(), std::string("11 12 13"));
  EXPECT_EQ(paths[0].attribute("data-face").value(), std::string("4 5"));
  const std::string data = paths[0].attribute("d").value();
  EXPECT_EQ(data.back(), 'Z');
  const auto curves = std::count(data.begin(), data.end(), 'C');
  EXPECT_GE(curves, 4);
  EXPECT_LE(curves, 8);
  EXPECT_EQ(writer->GetNumberOfCurves(), curves);
  EXPECT_EQ(writer->GetNumberOfStraightLines(), 0);
  EXPECT_EQ(writer->GetNumberOfVisiblePaths(), 1);
  // A disc of 40 mm in a page of 50 mm: radius and centre to the tolerance, 1e-4 of the diagonal.
  EXPECT_NEAR(svg.attribute("width").as_double(), 50.0, 1e-3);
  EXPECT_NEAR(svg.attribute("height").as_double(), 50.0, 1e-3);
  const std::string width = svg.attribute("width").value(),
                    height = svg.attribute("height").value();
  EXPECT_EQ(width.substr(width.size() - 2), "mm");
  EXPECT_EQ(svg.attribute("viewBox").value() + std::string("mm"),
    "0 0 " + width.substr(0, width.size() - 2) + ' ' + height);
  for (const Point& p : Sampled(data))
  {
    EXPECT_NEAR(Distance(p, Point{ 25.0, 25.0 }), 20.0, 40.0 * std::sqrt(2.0) * 1e-4 + 1e-3);
  }
}

TEST(NURBSDrawingWriter, LinesAreWhereTheyWere)
{
  Scene scene;
  std::vector<Polyline> lines = { Arc(0.0, 0.0, 1.0, 0.3, 2.0, 60),
    { { -1.0, -1.0 }, { 2.0, 1.5 } }, { { 0.0, 2.0 }, { 1.0, 2.0 }, { 1.0, 3.0 } } };
  Polyline wave;
  for (int k = 0; k <= 300; ++k)
  {
    wave.push_back({ 0.01 * k - 1.0, 0.4 * std::sin(0.05 * k) });
  }
  lines.push_back(wave);
  for (const Polyline& line : lines)
  {
    scene.Add(line);
  }
  vtkNew<vtkNURBSDrawingWriter> writer;
  writer->SetInputData(scene.Data);
  writer->SetFileName(FileName("lines.svg").c_str());
  writer->SetScale(3.0);
  writer->SetToleranceModeToAbsolute();
  for (const double tolerance : { 1e-3, 1e-4 })
  {
    writer->SetTolerance(tolerance);
    pugi::xml_document document;
    const auto paths = Paths(Written(writer, document));
    ASSERT_EQ(paths.size(), lines.size());
    // The box is (-1, -1) to (2, 3); y goes down.
    for (std::size_t k = 0; k < lines.size(); ++k)
    {
      Polyline drawn = Sampled(paths[k].attribute("d").value());
      for (Point& p : drawn)
      {
        p = { (p[0] - 10.0) / 3.0 - 1.0, 3.0 - (p[1] - 10.0) / 3.0 };
        EXPECT_LE(Distance(p, lines[k]), tolerance);
      }
      for (const Point& p : lines[k])
      {
        EXPECT_LE(Distance(p, drawn), 1.01 * tolerance); // The samples' chords bow, too.
      }
    }
    const std::string corner = paths[2].attribute("d").value();
    EXPECT_EQ(corner, "M13 13L16 13L16 10");
  }
}

TEST(NURBSDrawingWriter, KindsAreGroupsWithWidthsAndHiddenOnesBelow)
{
  Scene scene;
  for (int kind = 0; kind < 5; ++kind)
  {
    scene.Add({ { 0.0, kind * 1.0 }, { 1.0, kind * 1.0 } }, kind, 1);
    scene.Add({ { 2.0, kind * 1.0 }, { 3.0, kind * 1.0 } }, kind, 0);
  }
  vtkNew<vtkNURBSDrawingWriter> writer;
  writer->SetInputData(scene.Data);
  writer->SetFileName(FileName("kinds.svg").c_str());
  pugi::xml_document document;
  pugi::xml_node svg = Written(writer, document);
  std::vector<std::string> order;
  for (const pugi::xml_node& group : svg.children("g"))
  {
    order.push_back(group.attribute("id").value());
  }
  EXPECT_EQ(order, (std::vector<std::string>{ "hidden", "visible" }));
  const std::map<std::string, std::string> widths = { { "visible-silhouette", "0.5" },
    { "visible-boundary", "0.5" }, { "visible-sharp", "0.35" }, { "visible-intersection", "0.35" },
    { "visible-smooth", "0.18" }, { "hidden-silhouette", "0.25" }, { "hidden-boundary", "0.25" },
    { "hidden-sharp", "0.25" }, { "hidden-intersection", "0.25" }, { "hidden-smooth", "0.18" } };
  for (const auto& [name, width] : widths)
  {
    const pugi::xml_node group = Group(svg, name);
    ASSERT_TRUE(group) << name;
    EXPECT_EQ(Paths(group).size(), 1u) << name;
    EXPECT_EQ(group.attribute("stroke-width").value(), width) << name;
    std::string style = name;
    std::replace(style.begin(), style.end(), '-', ' ');
    EXPECT_EQ(group.attribute("class").value(), style);
    EXPECT_EQ(group.attribute("inkscape:groupmode").value(), std::string("layer"));
    const bool hidden = name[0] == 'h';
    EXPECT_EQ(group.parent().attribute("id").value(), std::string(hidden ? "hidden" : "visible"));
    EXPECT_EQ(bool(group.attribute("stroke-dasharray")), hidden) << name;
  }
  EXPECT_EQ(
    Group(svg, "hidden-sharp").attribute("stroke-dasharray").value(), std::string("3 0.75"));
  EXPECT_EQ(writer->GetNumberOfVisiblePaths(), 5);
  EXPECT_EQ(writer->GetNumberOfHiddenPaths(), 5);

  writer->HiddenLinesOff();
  writer->SetEdgeWidth(0.7);
  svg = Written(writer, document);
  EXPECT_FALSE(Group(svg, "hidden"));
  EXPECT_EQ(Group(svg, "visible-sharp").attribute("stroke-width").value(), std::string("0.7"));
  EXPECT_EQ(writer->GetNumberOfHiddenPaths(), 0);
  // Hidden lines do not count for the size either: 1 x 4 instead of 3 x 4.
  EXPECT_NEAR((writer->GetPageUsed()[0] - 20.0) / (writer->GetPageUsed()[1] - 20.0), 0.25, 1e-9);
}

TEST(NURBSDrawingWriter, MissingArraysMeanVisibleSharpEdges)
{
  Scene scene;
  scene.Add({ { 0.0, 0.0 }, { 1.0, 2.0 } });
  scene.Data->GetCellData()->Initialize();
  vtkNew<vtkNURBSDrawingWriter> writer;
  writer->SetInputData(scene.Data);
  writer->SetFileName(FileName("missing.svg").c_str());
  pugi::xml_document document;
  const pugi::xml_node svg = Written(writer, document);
  const auto paths = Paths(Group(svg, "visible-sharp"));
  ASSERT_EQ(paths.size(), 1u);
  EXPECT_FALSE(paths[0].attribute("data-face"));
  EXPECT_FALSE(paths[0].attribute("data-edge"));
}

TEST(NURBSDrawingWriter, JoinsWhatGoesOnAndNothingElse)
{
  Scene scene;
  scene.Add({ { 0.0, 0.0 }, { 1.0, 1.0 } }, 2, 1, 1); // A crossing: straight on, both times.
  scene.Add({ { 2.0, 2.0 }, { 1.0, 1.0 } }, 2, 1, 2);
  scene.Add({ { 0.0, 2.0 }, { 1.0, 1.0 } }, 2, 1, 3);
  scene.Add({ { 1.0, 1.0 }, { 2.0, 0.0 } }, 2, 1, 4);
  scene.Add({ { 5.0, 0.0 }, { 6.0, 0.0 } }, 2, 1, 5); // A corner of two edges,
  scene.Add({ { 6.0, 0.0 }, { 6.0, 1.0 } }, 2, 1, 6);
  scene.Add({ { 8.0, 0.0 }, { 9.0, 0.0 } }, 2, 1, 7); // and of one.
  scene.Add({ { 9.0, 0.0 }, { 9.0, 1.0 } }, 2, 1, 7);
  scene.Add({ { 0.0, 5.0 }, { 1.0, 5.0 } }, 2, 1, 8); // Half hidden, and of two kinds.
  scene.Add({ { 1.0, 5.0 }, { 2.0, 5.0 } }, 2, 0, 8);
  scene.Add({ { 2.0, 5.0 }, { 3.0, 5.0 } }, 0, 0, 8);
  vtkNew<vtkNURBSDrawingWriter> writer;
  writer->SetInputData(scene.Data);
  writer->SetFileName(FileName("joints.svg").c_str());
  pugi::xml_document document;
  const pugi::xml_node svg = Written(writer, document);
  std::vector<std::string> edges;
  for (const pugi::xml_node& path : Paths(svg))
  {
    edges.push_back(path.attribute("data-edge").value());
  }
  std::sort(edges.begin(), edges.end());
  EXPECT_EQ(edges, (std::vector<std::string>{ "1 2", "3 4", "5", "6", "7", "8", "8", "8" }));
}

// Edges that are seen end-on are points, but for rounding.
TEST(NURBSDrawingWriter, LeavesPointsOut)
{
  Scene scene;
  scene.Add({ { 0.0, 0.0 }, { 1.0, 2.0 } });
  scene.Add({ { 0.3, 0.2 }, { 0.3, 0.2 }, { 0.3, 0.2 } });
  scene.Add({ { 0.7, 0.2 }, { 0.7 + 1e-16, 0.2 }, { 0.7, 0.2 - 1e-16 } });
  scene.Add({ { 0.5, 0.5 } });
  vtkNew<vtkNURBSDrawingWriter> writer;
  writer->SetInputData(scene.Data);
  writer->SetFileName(FileName("points.svg").c_str());
  pugi::xml_document document;
  EXPECT_EQ(Paths(Written(writer, document)).size(), 1u);
  EXPECT_EQ(writer->GetNumberOfVisiblePaths(), 1);
}

TEST(NURBSDrawingWriter, PagesAndScales)
{
  Scene scene;
  scene.Add({ { 0.0, 0.0 }, { 400.0, 0.0 }, { 400.0, 100.0 } });
  vtkNew<vtkNURBSDrawingWriter> writer;
  writer->SetInputData(scene.Data);
  writer->SetFileName(FileName("pages.svg").c_str());
  const auto expect = [&](double scale, double width, double height, const char* text) {
    pugi::xml_document document;
    const pugi::xml_node svg = Written(writer, document);
    EXPECT_NEAR(writer->GetScaleUsed(), scale, 1e-9);
    EXPECT_NEAR(writer->GetPageUsed()[0], width, 1e-9);
    EXPECT_NEAR(writer->GetPageUsed()[1], height, 1e-9);
    EXPECT_EQ(svg.child("metadata").child("drawing").attribute("scale").value(), std::string(text));
    // In the middle of the page.
    const Polyline line = Sampled(Paths(svg).at(0).attribute("d").value());
    EXPECT_NEAR(line.front()[0] + line.back()[0], width, 1e-2);
    EXPECT_NEAR(line.front()[1] + line.back()[1], height, 1e-2);
  };
  expect(277.0 / 400.0, 297.0, 20.0 + 277.0 / 4.0, "1:1.444"); // As large as an A4 sheet
  writer->SetPageSize(vtkNURBSDrawingWriter::A3);
  expect(1.0, 420.0, 297.0, "1:1");
  writer->SetOrientation(vtkNURBSDrawingWriter::PORTRAIT);
  expect(277.0 / 400.0, 297.0, 420.0, "1:1.444");
  writer->SetScale(0.5);
  expect(0.5, 297.0, 420.0, "1:2");
  writer->SetPageSize(vtkNURBSDrawingWriter::TIGHT);
  writer->SetMargin(0.0);
  expect(0.5, 200.0, 50.0, "1:2");
  scene.SetUnit("m");
  writer->Modified();
  expect(0.5, 200.0, 50.0, "1:2000");
}

TEST(NURBSDrawingWriter, TellsOfItselfWhateverTheName)
{
  Scene scene;
  scene.Add({ { 0.0, 0.0 }, { 1.0, 2.0 } });
  vtkNew<vtkNURBSDrawingWriter> writer;
  writer->SetInputData(scene.Data);
  writer->SetFileName(FileName("a.b.svg").c_str());
  writer->SetSource("<&\">\xC3\xA9\x01\xFF\xC3.step");
  writer->SetView("1,-1,1");
  pugi::xml_document document;
  pugi::xml_node svg = Written(writer, document);
  EXPECT_EQ(svg.child("title").text().get(), std::string("drawing-a.b"));
  const pugi::xml_node facts = svg.child("metadata").child("drawing");
  EXPECT_EQ(facts.attribute("source").value(), std::string("<&\">\xC3\xA9???.step"));
  EXPECT_EQ(facts.attribute("view").value(), std::string("1,-1,1"));
  writer->SetTitle("Bracket");
  svg = Written(writer, document);
  EXPECT_EQ(svg.child("title").text().get(), std::string("Bracket"));
}

TEST(NURBSDrawingWriter, PartsOfAssembliesAreNamed)
{
  Scene first, second, third;
  first.Add({ { 0.0, 0.0 }, { 1.0, 0.0 } }, 2, 1, 3);
  second.Add({ { 1.0, 0.0 }, { 2.0, 0.0 } }, 2, 1, 3);
  third.Add({ { 2.0, 0.0 }, { 2.0, 1.0 } }, 2, 1, 4);
  vtkNew<vtkMultiBlockDataSet> assembly;
  assembly->SetBlock(0, first.Data);
  assembly->SetBlock(1, second.Data);
  assembly->SetBlock(3, third.Data);
  assembly->GetMetaData(0u)->Set(vtkCompositeDataSet::NAME(), "rod");
  vtkNew<vtkNURBSDrawingWriter> writer;
  writer->SetInputDataObject(assembly);
  writer->SetFileName(FileName("assembly.svg").c_str());
  pugi::xml_document document;
  const auto paths = Paths(Written(writer, document));
  ASSERT_EQ(paths.size(), 3u); // Not joined, as they are of different parts.
  EXPECT_EQ(paths[0].attribute("data-part").value(), std::string("rod"));
  EXPECT_EQ(paths[1].attribute("data-part").value(), std::string("1"));
  EXPECT_EQ(paths[2].attribute("data-part").value(), std::string("2"));
}

//--------------------------------------------------------------------------------------------------
// PDF

// The numbers before each operator of a content stream that draws.
std::vector<std::pair<std::string, std::vector<double>>> Operators(const std::string& content)
{
  std::vector<std::pair<std::string, std::vector<double>>> all;
  std::istringstream stream(content);
  std::vector<double> numbers;
  for (std::string word; stream >> word;)
  {
    char* end = nullptr;
    const double number = std::strtod(word.c_str(), &end);
    if (*end == '\0')
    {
      numbers.push_back(number);
    }
    else
    {
      all.emplace_back(word, numbers);
      numbers.clear();
    }
  }
  return all;
}

std::string ContentOf(QPDFObjectHandle page)
{
  const auto buffer = page.getKey("/Contents").getStreamData();
  return std::string(reinterpret_cast<const char*>(buffer->getBuffer()), buffer->getSize());
}

TEST(NURBSDrawingWriter, PDFShowsWhatSVGShows)
{
  Scene scene;
  scene.Add(Arc(0.0, 0.0, 1.0, 0.0, 2.0 * Pi, 100), 0, 1);
  scene.Add({ { 0.0, 0.0 }, { 1.0, 0.5 } }, 2, 0);
  vtkNew<vtkNURBSDrawingWriter> writer;
  writer->SetInputData(scene.Data);
  writer->SetFileName(FileName("both.svg").c_str());
  writer->SetTitle("Gr\xC3\xBC\xC3\x9F");
  pugi::xml_document document;
  const pugi::xml_node svg = Written(writer, document);
  const double height = writer->GetPageUsed()[1];
  std::vector<double> wanted;
  for (const pugi::xml_node& path : Paths(svg))
  {
    std::string data = path.attribute("d").value();
    for (char& c : data)
    {
      c = std::isalpha(static_cast<unsigned char>(c)) ? ' ' : c;
    }
    std::istringstream stream(data);
    for (double x, y; stream >> x >> y;)
    {
      wanted.insert(wanted.end(), { x, height - y });
    }
  }

  writer->SetFileName(FileName("both.pdf").c_str());
  ASSERT_EQ(writer->Write(), 1);
  QPDF pdf;
  pdf.processFile(writer->GetFileName());
  EXPECT_TRUE(pdf.getWarnings().empty());
  const auto pages = QPDFPageDocumentHelper(pdf).getAllPages();
  ASSERT_EQ(pages.size(), 1u);
  QPDFObjectHandle page = pages[0].getObjectHandle();
  const double points = 72.0 / 25.4;
  EXPECT_NEAR(page.getKey("/MediaBox").getArrayItem(2).getNumericValue(),
    points * writer->GetPageUsed()[0], 1e-5);
  EXPECT_NEAR(page.getKey("/MediaBox").getArrayItem(3).getNumericValue(), points * height, 1e-5);
  std::vector<double> drawn;
  for (const auto& [name, numbers] : Operators(ContentOf(page)))
  {
    if (name == "m" || name == "l" || name == "c")
    {
      drawn.insert(drawn.end(), numbers.begin(), numbers.end());
    }
    if (name == "cm")
    {
      EXPECT_NEAR(numbers.at(0), points, 1e-8);
      EXPECT_EQ(numbers.at(0), numbers.at(3));
    }
  }
  ASSERT_EQ(drawn.size(), wanted.size());
  for (std::size_t k = 0; k < drawn.size(); ++k)
  {
    EXPECT_NEAR(drawn[k], wanted[k], 1e-3); // A unit of the last digit, y turned round.
  }
  EXPECT_EQ(pdf.getTrailer().getKey("/Info").getKey("/Title").getUTF8Value(), "Gr\xC3\xBC\xC3\x9F");
  // Layers, named in the page's resources.
  QPDFObjectHandle layers = pdf.getRoot().getKey("/OCProperties").getKey("/OCGs");
  ASSERT_EQ(layers.getArrayNItems(), 2);
  EXPECT_EQ(layers.getArrayItem(0).getKey("/Name").getUTF8Value(), "Hidden sharp edges");
  EXPECT_EQ(layers.getArrayItem(1).getKey("/Name").getUTF8Value(), "Visible silhouettes");
  EXPECT_TRUE(page.getKey("/Resources").getKey("/Properties").hasKey("/L1"));
}

TEST(NURBSDrawingWriter, LargePDFPagesHaveLargerUnits)
{
  Scene scene;
  scene.Add({ { 0.0, 0.0 }, { 12000.0, 1000.0 } });
  vtkNew<vtkNURBSDrawingWriter> writer;
  writer->SetInputData(scene.Data);
  writer->SetFileName(FileName("large").c_str());
  writer->SetFormatToPDF();
  writer->SetScale(1.0);
  ASSERT_EQ(writer->Write(), 1);
  QPDF pdf;
  pdf.processFile(writer->GetFileName());
  QPDFObjectHandle page = QPDFPageDocumentHelper(pdf).getAllPages().at(0).getObjectHandle();
  const double unit = page.getKey("/UserUnit").getNumericValue();
  EXPECT_EQ(unit, 3.0);
  EXPECT_NEAR(
    page.getKey("/MediaBox").getArrayItem(2).getNumericValue(), 12020.0 / 25.4 * 72.0 / 3.0, 1e-4);
}

//--------------------------------------------------------------------------------------------------
TEST(NURBSDrawingWriter, Errors)
{
  const std::string file = FileName("errors.svg");
  const auto fails = [&](unsigned long code, const std::string& says, auto change) {
    SCOPED_TRACE(says);
    std::filesystem::remove(file);
    Scene scene;
    scene.Add({ { 0.0, 0.0 }, { 1.0, 2.0 } });
    vtkNew<vtkNURBSDrawingWriter> writer;
    vtkNew<MessageKeeper> keeper;
    writer->AddObserver(vtkCommand::ErrorEvent, keeper);
    writer->SetInputData(scene.Data);
    writer->SetFileName(file.c_str());
    change(writer.Get(), scene);
    EXPECT_EQ(writer->Write(), 0);
    EXPECT_EQ(writer->GetErrorCode(), code);
    EXPECT_TRUE(keeper->Says(says)) << keeper->Text;
    EXPECT_FALSE(std::filesystem::exists(file));
    EXPECT_EQ(writer->GetNumberOfVisiblePaths(), 0);
    EXPECT_EQ(writer->GetScaleUsed(), 0.0);
  };
  using Writer = vtkNURBSDrawingWriter*;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  fails(vtkErrorCode::NoFileNameError, "no file name",
    [](Writer w, Scene&) { w->SetFileName(nullptr); });
  fails(vtkErrorCode::UnrecognizedFileTypeError, "drawings are .svg or .pdf",
    [](Writer w, Scene&) { w->SetFileName("drawing.dxf"); });
  fails(vtkErrorCode::CannotOpenFileError, "cannot write /nowhere/a.svg",
    [](Writer w, Scene&) { w->SetFileName("/nowhere/a.svg"); });
  fails(vtkErrorCode::UserError, "no lines",
    [](Writer, Scene& s) { s.Data->GetLines()->Initialize(); });
  fails(vtkErrorCode::UserError, "no lines", [](Writer, Scene& s) { s.Data->Initialize(); });
  fails(vtkErrorCode::UserError, "point 3 is not finite", [&](Writer, Scene& s) {
    s.Add({ { 0.0, 0.0 }, { nan, 1.0 } });
  });
  fails(vtkErrorCode::UserError, "Kind of a line is 9", [](Writer, Scene& s) {
    s.Add({ { 0.0, 0.0 }, { 1.0, 1.0 } }, 9);
  });
  fails(vtkErrorCode::UserError, "Tolerance must be positive",
    [](Writer w, Scene&) { w->SetTolerance(0.0); });
  fails(vtkErrorCode::UserError, "Margin must not be negative",
    [&](Writer w, Scene&) { w->SetMargin(nan); });
  fails(vtkErrorCode::UserError, "HiddenWidth must be positive",
    [](Writer w, Scene&) { w->SetHiddenWidth(-1.0); });
  fails(vtkErrorCode::UserError, "margin leaves no room",
    [](Writer w, Scene&) { w->SetMargin(120.0); });
  fails(
    vtkErrorCode::UserError, "the drawing is 1000 x 2000 mm at scale 1000:1", [](Writer w, Scene&) {
      w->SetScale(1000.0);
      w->SetPageSize(vtkNURBSDrawingWriter::A4);
    });
}

} // namespace
