// SPDX-License-Identifier: BSD-3-Clause
#include "vtkWriteMesh.h"

#include "Failure.h"
#include "GLB.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkIdList.h"
#include "vtkNURBSModel.h"
#include "vtkNew.h"
#include "vtkOBJWriter.h"
#include "vtkPLYWriter.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSTLWriter.h"
#include "vtkStringArray.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"
#include "vtkXMLPolyDataWriter.h"
#include "vtkXMLUnstructuredGridWriter.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace nurbs
{
namespace
{

const char* const Endings[] = { ".vtp", ".vtu", ".stl", ".ply", ".obj", ".glb" };

// VTK's writers answer 1 for some failures and set their error code instead.
template <typename Writer>
void Write(Writer* writer, const std::string& path)
{
  writer->SetFileName(path.c_str());
  if (!writer->Write() || writer->GetErrorCode() != 0)
  {
    throw Failure("cannot write " + path);
  }
}

// Data in line: the VTK of Debian's ParaView 5.11 reads no appended data since an update of expat.
// Uncompressed: several times faster than the default.
template <typename Writer>
void WriteXML(vtkDataSet* data, const std::string& path)
{
  vtkNew<Writer> writer;
  writer->SetInputData(data);
  writer->SetDataModeToBinary();
  writer->SetCompressorTypeToNone();
  writer->SetHeaderTypeToUInt64();
  Write(writer.Get(), path);
}

vtkSmartPointer<vtkUnstructuredGrid> ToGrid(vtkPolyData* mesh)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(mesh->GetPoints());
  grid->SetCells(VTK_TRIANGLE, mesh->GetPolys());
  grid->GetPointData()->ShallowCopy(mesh->GetPointData());
  grid->GetCellData()->ShallowCopy(mesh->GetCellData());
  grid->GetFieldData()->ShallowCopy(mesh->GetFieldData());
  return grid;
}

vtkSmartPointer<vtkFloatArray> Floats(vtkDataArray* array)
{
  auto floats = vtkSmartPointer<vtkFloatArray>::New();
  floats->DeepCopy(array);
  return floats;
}

// vtkPLYWriter knows normals and texture coordinates of floats only.
vtkSmartPointer<vtkPolyData> WithFloats(vtkPolyData* mesh)
{
  auto copy = vtkSmartPointer<vtkPolyData>::New();
  copy->ShallowCopy(mesh);
  if (vtkDataArray* normals = mesh->GetPointData()->GetNormals())
  {
    copy->GetPointData()->SetNormals(Floats(normals));
  }
  if (vtkDataArray* parameters = mesh->GetPointData()->GetArray("UV"))
  {
    copy->GetPointData()->SetTCoords(Floats(parameters));
  }
  return copy;
}

// The last bytes of a file, fewer if it is shorter.
std::string Tail(const std::string& path, std::streamoff count)
{
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? std::streamoff(file.tellg()) : 0;
  std::string tail(static_cast<size_t>(std::clamp<std::streamoff>(count, 0, size)), '\0');
  file.seekg(size - static_cast<std::streamoff>(tail.size()));
  file.read(tail.data(), static_cast<std::streamsize>(tail.size()));
  return file ? tail : std::string();
}

// Some of VTK's writers do not notice a full disk: the last triangle's corners must be in the file.
// An .obj counts them from 1 and ends with "f 1//1 2//2 3//3"; a binary .ply ends with a byte 3,
// three 32-bit numbers, and perhaps a colour; a binary .stl has no numbers, but a known size.
bool IsComplete(vtkPolyData* mesh, const std::string& path, const std::string& ending)
{
  const vtkIdType count = mesh->GetNumberOfPolys();
  if (count == 0)
  {
    return true;
  }
  vtkNew<vtkIdList> corners;
  mesh->GetPolys()->GetCellAtId(count - 1, corners);
  if (ending == ".stl")
  {
    std::error_code error;
    return std::filesystem::file_size(path, error) == static_cast<std::uintmax_t>(84 + 50 * count);
  }
  std::string wanted;
  if (ending == ".ply")
  {
    wanted = '\3';
    for (vtkIdType i = 0; i < 3; ++i)
    {
      const auto number = static_cast<std::uint32_t>(corners->GetId(i));
      for (int shift = 0; shift < 32; shift += 8)
      {
        wanted += static_cast<char>(number >> shift & 0xff);
      }
    }
    return Tail(path, 16).find(wanted) != std::string::npos;
  }
  const std::string tail = Tail(path, 400);
  const size_t line = tail.rfind("\nf ");
  if (line == std::string::npos || tail.back() != '\n')
  {
    return false;
  }
  std::istringstream words(tail.substr(line + 2));
  bool same = true;
  for (vtkIdType i = 0; i < 3; ++i)
  {
    std::string word;
    words >> word;
    same = same && std::atoll(word.c_str()) == corners->GetId(i) + 1;
  }
  return same;
}

void WritePLY(vtkPolyData* mesh, const std::string& path)
{
  vtkNew<vtkPLYWriter> writer;
  writer->SetInputData(WithFloats(mesh));
  writer->SetFileTypeToBinary();
  writer->SetDataByteOrderToLittleEndian();
  if (mesh->GetCellData()->GetArray(vtkNURBSModel::ColorName()))
  {
    writer->SetColorModeToDefault();
    writer->SetArrayName(vtkNURBSModel::ColorName());
  }
  Write(writer.Get(), path);
}

// Doubles of a 3-component array, itself or a copy.
vtkSmartPointer<vtkDoubleArray> Doubles(vtkDataArray* array)
{
  vtkSmartPointer<vtkDoubleArray> doubles = vtkDoubleArray::SafeDownCast(array);
  if (!doubles && array)
  {
    doubles = vtkSmartPointer<vtkDoubleArray>::New();
    doubles->DeepCopy(array);
  }
  return doubles;
}

// Each cell's name and colour as one of a list of looks.
void AssignLooks(vtkPolyData* mesh, GLBMesh& glb)
{
  vtkCellData* cells = mesh->GetCellData();
  auto* names = vtkStringArray::SafeDownCast(cells->GetAbstractArray(vtkNURBSModel::NameName()));
  auto* colours =
    vtkUnsignedCharArray::SafeDownCast(cells->GetAbstractArray(vtkNURBSModel::ColorName()));
  std::map<std::pair<std::string, GLBColour>, int> looks;
  const vtkIdType count = mesh->GetNumberOfPolys();
  glb.Look.resize(static_cast<size_t>(count));
  std::pair<std::string, GLBColour> look{ "mesh", GLBMesh::Appearance().Colour };
  int number = -1;
  for (vtkIdType cell = 0; cell < count; ++cell)
  {
    std::pair<std::string, GLBColour> next = look;
    if (names)
    {
      next.first = names->GetValue(cell);
    }
    if (colours && colours->GetNumberOfComponents() >= 3)
    {
      const unsigned char* c = colours->GetPointer(cell * colours->GetNumberOfComponents());
      next.second = { c[0], c[1], c[2] };
    }
    if (number < 0 || next != look)
    {
      const auto found = looks.emplace(next, static_cast<int>(looks.size()));
      number = found.first->second;
      if (found.second)
      {
        glb.Looks.push_back({ next.first.empty() ? "mesh" : next.first, next.second });
      }
      look = next;
    }
    glb.Look[static_cast<size_t>(cell)] = number;
  }
}

void WriteGLBOf(vtkPolyData* mesh, const std::string& path, const std::string& unit)
{
  GLBMesh glb;
  const auto points = Doubles(mesh->GetPoints() ? mesh->GetPoints()->GetData() : nullptr);
  const auto normals = Doubles(mesh->GetPointData()->GetNormals());
  glb.Points = points ? points->GetPointer(0) : nullptr;
  glb.Normals = normals ? normals->GetPointer(0) : nullptr;
  glb.PointCount = static_cast<size_t>(mesh->GetNumberOfPoints());
  std::vector<std::int64_t> corners;
  corners.reserve(3 * static_cast<size_t>(mesh->GetNumberOfPolys()));
  vtkIdType size = 0;
  const vtkIdType* ids = nullptr;
  vtkCellArray* polys = mesh->GetPolys();
  for (polys->InitTraversal(); polys->GetNextCell(size, ids);)
  {
    corners.insert(corners.end(), ids, ids + 3);
  }
  glb.Triangles = corners.data();
  glb.TriangleCount = corners.size() / 3;
  glb.Metres = MetresOf(unit);
  AssignLooks(mesh, glb);
  WriteGLB(glb, path);
}

// A sentence if 32-bit coordinates lose a tenth of the tolerance or more.
std::vector<std::string> RoundingWarning(
  vtkPolyData* mesh, const std::string& ending, double tolerance)
{
  double bounds[6];
  mesh->GetBounds(bounds);
  double largest = 0.0;
  for (const double bound : bounds)
  {
    largest = std::max(largest, std::abs(bound));
  }
  const double loss = largest * std::sqrt(3.0) * 0x1p-24;
  if (mesh->GetNumberOfPoints() == 0 || loss < 0.1 * tolerance)
  {
    return {};
  }
  std::ostringstream text;
  text.precision(2);
  text << ending << " keeps 32-bit coordinates, which moves points by up to " << loss
       << "; the tolerance is " << tolerance;
  return { text.str() };
}

} // namespace

//--------------------------------------------------------------------------------------------------
std::string Ending(const std::string& path)
{
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

//--------------------------------------------------------------------------------------------------
void CheckWritable(const std::string& path)
{
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path folder = fs::path(path).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, ignored))
  {
    throw Failure("cannot write " + path + ": there is no folder " + folder.string());
  }
  if (fs::is_directory(path, ignored))
  {
    throw Failure("cannot write " + path + ": it is a folder");
  }
  const bool existed = fs::exists(path, ignored);
  if (!std::ofstream(path, std::ios::app))
  {
    throw Failure("cannot write " + path + ": permission denied or no space");
  }
  if (!existed)
  {
    fs::remove(path, ignored);
  }
}

//--------------------------------------------------------------------------------------------------
void CheckMeshPath(const std::string& path)
{
  const std::string ending = Ending(path);
  if (std::find(std::begin(Endings), std::end(Endings), ending) == std::end(Endings))
  {
    throw Failure("cannot write " + path + ": " +
      (ending.empty() ? "it has no ending" : "'" + ending + "' is no mesh format of ours") +
      "; use .vtp, .vtu, .stl, .ply, .obj or .glb");
  }
  CheckWritable(path);
}

//--------------------------------------------------------------------------------------------------
std::vector<std::string> WriteMesh(
  vtkPolyData* mesh, const std::string& path, const std::string& unit, double tolerance)
{
  const std::string ending = Ending(path);
  if (ending == ".vtp")
  {
    WriteXML<vtkXMLPolyDataWriter>(mesh, path);
    return {};
  }
  if (ending == ".vtu")
  {
    WriteXML<vtkXMLUnstructuredGridWriter>(ToGrid(mesh), path);
    return {};
  }
  if (ending == ".glb")
  {
    WriteGLBOf(mesh, path, unit);
    return RoundingWarning(mesh, ending, tolerance);
  }
  if (ending == ".obj")
  {
    // No texture coordinates: the writer takes u = -1, which a surface may have, for "none here".
    vtkNew<vtkPolyData> copy;
    copy->ShallowCopy(mesh);
    copy->GetPointData()->SetActiveTCoords(nullptr);
    vtkNew<vtkOBJWriter> writer;
    writer->SetInputData(copy);
    Write(writer.Get(), path);
  }
  else if (ending == ".stl")
  {
    vtkNew<vtkSTLWriter> writer;
    writer->SetInputData(mesh);
    writer->SetFileTypeToBinary();
    Write(writer.Get(), path);
  }
  else
  {
    WritePLY(mesh, path);
  }
  if (!IsComplete(mesh, path, ending))
  {
    throw Failure("cannot write " + path + ": no space left, or the disk failed");
  }
  return ending == ".obj" ? std::vector<std::string>() : RoundingWarning(mesh, ending, tolerance);
}

//--------------------------------------------------------------------------------------------------
double MetresOf(const std::string& unit)
{
  static const std::map<std::string, double> units = { { "um", 1e-6 }, { "mm", 1e-3 },
    { "cm", 1e-2 }, { "dm", 1e-1 }, { "m", 1.0 }, { "km", 1e3 }, { "in", 0.0254 },
    { "inch", 0.0254 }, { "ft", 0.3048 }, { "mi", 1609.344 }, { "yd", 0.9144 } };
  const auto found = units.find(unit);
  return found == units.end() ? 1.0 : found->second;
}

} // namespace nurbs
