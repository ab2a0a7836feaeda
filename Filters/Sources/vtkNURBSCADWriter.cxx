// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSCADWriter.h"

#include "CADExport.h"
#include "SamePart.h"
#include "ShapeBuilder.h"
#include "vtkNURBSCADTree.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSPieces.h"

#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkObjectFactory.h"
#include "vtkSMPTools.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <sstream>
#include <tuple>

vtkStandardNewMacro(vtkNURBSCADWriter);

namespace
{

constexpr double FindPart = 0.05;     // of the progress: until copies are found
constexpr double BuildPart = 0.6;     // until all shapes are built
constexpr std::size_t MostFaces = 10; // that a warning names
constexpr double SameRadius = 1e-11;  // of the largest coordinate: of what may be the same part

std::string LowerEnding(const char* path)
{
  std::string ending = std::filesystem::u8path(path).extension().u8string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

std::string Plural(std::size_t count, const char* noun)
{
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// "3 faces are not valid: a, b, and 1 more".
std::string Listed(const std::string& start, const std::vector<std::string>& items)
{
  std::string text = start;
  for (std::size_t i = 0; i < std::min(items.size(), MostFaces); ++i)
  {
    text += (i == 0 ? ": " : "; ") + items[i];
  }
  if (items.size() > MostFaces)
  {
    text += "; and " + std::to_string(items.size() - MostFaces) + " more";
  }
  return text;
}

/// "block 2 (wheel): cell 3 (FaceId 17): reason".
std::string FaceLine(
  const vtkNURBSCADTree::Block& block, std::size_t cell, const std::string& reason)
{
  const vtkIdType id = static_cast<vtkIdType>(cell);
  std::ostringstream text;
  text << block.Prefix << "cell " << cell << " (FaceId " << vtkNURBSModel::GetFaceId(block.Grid, id)
       << "): " << reason;
  return text.str();
}

} // namespace

struct vtkNURBSCADWriter::Work
{
  nurbs::CADFormat Format = nurbs::CADFormat::STEP;
  vtkDataObject* Input = nullptr;
  std::vector<vtkNURBSCADTree::Block> Blocks;
  std::vector<double> Scales; // Millimetres a unit of each block.
  std::vector<std::shared_ptr<const vtkNURBSModelView>> Views;
  std::vector<nurbs::CADPart> Parts; // What is told of the faces of each block, by cell.
  struct Copy
  {
    std::size_t Of; // The first block that is the same part: itself, for most.
    nurbs::Placement Motion;
  };
  std::vector<Copy> Copies;
  std::vector<nurbs::BuiltShape> Shapes;
  nurbs::CADContent Content;
  vtkIdType Instances = 0;

  bool IsCopy(std::size_t block) const { return this->Copies[block].Of != block; }
  void FindCopies(const std::function<bool(double)>& progress);
  void PlaceCopies(const std::vector<std::int64_t>& parts);
};

// Blocks that are one part, moved: equal in all that is told of them. Those of one name and size are
// sorted by a radius that motions do not change, so that only such are compared that may be.
// `progress` gets the part done and returns false to stop.
void vtkNURBSCADWriter::Work::FindCopies(const std::function<bool(double)>& progress)
{
  using Key = std::tuple<std::string, double, vtkIdType, vtkIdType, double>;
  std::multimap<Key, std::size_t> known;
  double largest = 0.0;
  for (std::size_t i = 0; i < this->Blocks.size() && progress(double(i) / this->Blocks.size()); ++i)
  {
    vtkUnstructuredGrid* grid = this->Blocks[i].Grid;
    this->Views.push_back(vtkNURBSModel::View(grid));
    this->Copies.push_back({ i, nurbs::Placement() });
    std::vector<std::int64_t> cells;
    bool whole = true;
    for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
    {
      cells.push_back(cell);
      whole = whole && this->Views[i]->GetFaceError(cell).empty();
    }
    this->Parts.emplace_back();
    vtkNURBSCADTree::DescribeFaces(grid, cells, this->Parts[i]);
    const double radius = nurbs::MeanRadius(this->Views[i]->GetModel());
    if (!whole || !std::isfinite(radius))
    {
      continue; // What is wrong with it is told of each.
    }
    for (int k = 0; k < 6; ++k)
    {
      largest = std::max(largest, std::abs(grid->GetBounds()[k]));
    }
    const auto key = [&](double r) {
      return Key(this->Blocks[i].Name, this->Scales[i], grid->GetNumberOfCells(),
        grid->GetNumberOfPoints(), r);
    };
    const auto last = known.upper_bound(key(radius + SameRadius * largest));
    for (auto it = known.lower_bound(key(radius - SameRadius * largest));
         it != last && !this->IsCopy(i); ++it)
    {
      const std::size_t k = it->second;
      const auto motion = this->Parts[k].FaceNames == this->Parts[i].FaceNames &&
          this->Parts[k].Colors == this->Parts[i].Colors
        ? nurbs::MotionBetween(this->Views[k]->GetModel(), this->Views[i]->GetModel())
        : std::nullopt;
      if (motion)
      {
        this->Copies[i] = { k, *motion };
      }
    }
    if (!this->IsCopy(i))
    {
      known.emplace(key(radius), i);
    }
  }
}

// Copies become instances of one part in the assembly, if it has one name; else parts of their own.
void vtkNURBSCADWriter::Work::PlaceCopies(const std::vector<std::int64_t>& parts)
{
  std::vector<nurbs::CADNode*> nodes(this->Content.Parts.size(), nullptr);
  for (nurbs::CADNode& node : this->Content.Nodes)
  {
    if (node.Part >= 0)
    {
      nodes[node.Part] = &node;
    }
  }
  for (std::size_t i = 0; i < this->Blocks.size(); ++i)
  {
    if (!this->IsCopy(i) || parts[i] < 0)
    {
      continue;
    }
    nurbs::Placement motion = this->Copies[i].Motion;
    motion.Shift *= this->Scales[i];
    nurbs::CADNode& node = *nodes[parts[i]];
    const nurbs::CADNode& first = *nodes[parts[this->Copies[i].Of]];
    if (node.Parent >= 0 && first.Parent >= 0 && node.Name == first.Name)
    {
      node.Part = first.Part;
      node.Place = nurbs::ToLocation(motion);
      ++this->Instances;
    }
    else
    {
      nurbs::MovePart(motion, this->Content.Parts[parts[i]]);
    }
  }
}

vtkNURBSCADWriter::vtkNURBSCADWriter() = default;

vtkNURBSCADWriter::~vtkNURBSCADWriter()
{
  this->SetFileName(nullptr);
}

int vtkNURBSCADWriter::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

bool vtkNURBSCADWriter::Fail(unsigned long code, const std::string& message)
{
  this->ClearFigures();
  this->SetErrorCode(code);
  vtkErrorMacro(<< message);
  return false;
}

// Write() tells by the error code that there is no file.
bool vtkNURBSCADWriter::Aborted()
{
  this->SetErrorCode(vtkErrorCode::UserError);
  return false;
}

void vtkNURBSCADWriter::ClearFigures()
{
  this->NumberOfFaces = this->NumberOfFailedFaces = this->NumberOfInvalidFaces = 0;
  this->NumberOfSplitFaces = this->NumberOfAnalyticFaces = this->NumberOfInstances = 0;
  this->NumberOfSolids = this->NumberOfShells = 0;
  this->NumberOfEdges = this->NumberOfSharedEdges = 0;
  this->NumberOfComputedEdges = this->NumberOfTornEdges = 0;
  this->EdgeTolerance = 0.0;
}

bool vtkNURBSCADWriter::CheckOptions(Work& work)
{
  if (!this->FileName || !*this->FileName)
  {
    return this->Fail(vtkErrorCode::NoFileNameError, "FileName is not set");
  }
  std::ostringstream problem;
  if (!(this->CurveTolerance > 0.0) || !std::isfinite(this->CurveTolerance))
  {
    problem << "CurveTolerance must be positive, but is " << this->CurveTolerance;
    return this->Fail(vtkErrorCode::UserError, problem.str());
  }
  if (!(this->Gap >= 0.0) || !std::isfinite(this->Gap))
  {
    problem << "Gap must not be negative, but is " << this->Gap;
    return this->Fail(vtkErrorCode::UserError, problem.str());
  }
  const std::string ending = LowerEnding(this->FileName);
  if (this->Format == STEP ||
    (this->Format == BY_ENDING && (ending == ".step" || ending == ".stp")))
  {
    work.Format = nurbs::CADFormat::STEP;
  }
  else if (this->Format == IGES ||
    (this->Format == BY_ENDING && (ending == ".iges" || ending == ".igs")))
  {
    work.Format = nurbs::CADFormat::IGES;
  }
  else if (this->Format == BREP ||
    (this->Format == BY_ENDING && (ending == ".brep" || ending == ".brp")))
  {
    work.Format = nurbs::CADFormat::BREP;
  }
  else
  {
    return this->Fail(vtkErrorCode::UnrecognizedFileTypeError,
      "cannot write \"" + std::string(this->FileName) +
        "\": CAD files are .step, .stp, .iges, .igs, .brep or .brp");
  }
  return true;
}

bool vtkNURBSCADWriter::FindUnits(Work& work)
{
  for (const vtkNURBSCADTree::Block& block : work.Blocks)
  {
    const std::string name = vtkNURBSModel::GetLengthUnit(block.Grid);
    const nurbs::CADUnit* unit = nurbs::FindCADUnit(name.empty() ? "mm" : name);
    if (!unit)
    {
      return this->Fail(
        vtkErrorCode::UserError, block.Prefix + "the unit of length \"" + name + "\" is not known");
    }
    if (work.Scales.empty())
    {
      work.Content.Unit = *unit;
    }
    work.Scales.push_back(unit->Millimetres);
  }
  return true;
}

// Shapes of all blocks, and what is told of their faces.
bool vtkNURBSCADWriter::Build(Work& work)
{
  std::atomic<bool> abort{ false };
  double progress = FindPart, end = FindPart;
  const nurbs::ParallelFor parallel = [&](std::int64_t first, std::int64_t last, const auto& body) {
    // In pieces, so that an abort is heard.
    const std::int64_t piece = std::max<std::int64_t>(64, (last - first) / 16);
    for (std::int64_t begin = first; begin < last && !abort; begin += piece)
    {
      vtkSMPTools::For(begin, std::min(last, begin + piece), 1,
        [&](vtkIdType from, vtkIdType to) { body(from, to); });
      progress += (end - progress) / 20.0;
      this->UpdateProgress(progress);
      abort = this->GetAbortExecute() != 0;
    }
  };
  nurbs::ShapeOptions options;
  options.CurveTolerance = this->CurveTolerance;
  options.Gap = this->Gap;
  options.Analytic = this->AnalyticSurfaces;
  work.FindCopies([&](double done) {
    this->UpdateProgress(FindPart * done);
    abort = this->GetAbortExecute() != 0;
    return !abort;
  });
  std::vector<std::string> failures;
  for (std::size_t i = 0; i < work.Blocks.size() && !abort; ++i)
  {
    const vtkNURBSCADTree::Block& block = work.Blocks[i];
    if (work.IsCopy(i))
    {
      work.Shapes.push_back(work.Shapes[work.Copies[i].Of]);
    }
    else
    {
      end = FindPart + (BuildPart - FindPart) * double(i + 1) / double(work.Blocks.size());
      options.Scale = work.Scales[i];
      const auto& view = work.Views[i];
      std::vector<std::string> errors;
      for (vtkIdType cell = 0; cell < block.Grid->GetNumberOfCells(); ++cell)
      {
        errors.push_back(view->GetFaceError(cell));
      }
      work.Shapes.push_back(nurbs::BuildShape(view->GetModel(), errors, options, parallel, abort));
    }
    const std::vector<std::string>& found = work.Shapes.back().FaceErrors;
    for (std::size_t f = 0; f < found.size(); ++f)
    {
      if (!found[f].empty())
      {
        failures.push_back(FaceLine(block, f, found[f]));
      }
    }
    progress = end;
    this->UpdateProgress(progress);
    abort = abort || this->GetAbortExecute();
  }
  if (abort)
  {
    return this->Aborted();
  }
  this->NumberOfFailedFaces = static_cast<vtkIdType>(failures.size());
  const bool some = std::any_of(work.Shapes.begin(), work.Shapes.end(),
    [](const nurbs::BuiltShape& shape) { return !shape.Shape.IsNull(); });
  if (!some)
  {
    return this->Fail(
      vtkErrorCode::UserError, Listed("there is no face that can be written", failures));
  }
  if (!failures.empty())
  {
    vtkWarningMacro(<< Listed(Plural(failures.size(), "face") + " can't be written", failures));
  }
  return true;
}

void vtkNURBSCADWriter::CheckShapes(const Work& work)
{
  std::vector<std::string> faults;
  std::vector<std::vector<nurbs::ShapeFault>> found(work.Shapes.size()); // Of each, and its copies.
  vtkIdType torn = 0;
  for (std::size_t i = 0; i < work.Shapes.size(); ++i)
  {
    const nurbs::BuiltShape& shape = work.Shapes[i];
    this->NumberOfFaces += static_cast<vtkIdType>(shape.Faces.size());
    this->NumberOfSplitFaces += shape.SplitFaces;
    this->NumberOfAnalyticFaces += shape.AnalyticFaces;
    this->NumberOfSolids += shape.Solids;
    this->NumberOfShells += shape.Shells;
    this->NumberOfEdges += shape.Edges;
    this->NumberOfSharedEdges += shape.SharedEdges;
    this->NumberOfComputedEdges += shape.ComputedEdges;
    this->EdgeTolerance = std::max(this->EdgeTolerance, shape.EdgeTolerance / work.Scales[i]);
    torn += shape.TornEdges;
    if (this->Check && !work.IsCopy(i))
    {
      found[i] = nurbs::CheckShape(shape);
    }
    for (const nurbs::ShapeFault& fault : found[work.Copies[i].Of])
    {
      this->NumberOfInvalidFaces += fault.Face >= 0 ? 1 : 0;
      faults.push_back(fault.Face >= 0
          ? FaceLine(work.Blocks[i], static_cast<std::size_t>(fault.Face), fault.Reason)
          : work.Blocks[i].Prefix + fault.Reason);
    }
  }
  this->NumberOfTornEdges = torn;
  if (torn > 0)
  {
    vtkWarningMacro(<< Plural(static_cast<std::size_t>(torn), "edge")
                    << " torn: the faces are farther apart than Gap allows");
  }
  if (!faults.empty())
  {
    vtkWarningMacro(<< Listed("OpenCASCADE's check finds fault with what is written", faults));
  }
}

bool vtkNURBSCADWriter::Save(Work& work)
{
  const std::string stem = std::filesystem::u8path(this->FileName).stem().u8string();
  work.Content.Name = stem;
  std::vector<std::int64_t> parts(work.Blocks.size(), -1);
  for (std::size_t i = 0; i < work.Blocks.size(); ++i)
  {
    if (!work.Shapes[i].Shape.IsNull())
    {
      parts[i] = static_cast<std::int64_t>(work.Content.Parts.size());
      work.Content.Parts.emplace_back();
      nurbs::CADPart& part = work.Content.Parts.back();
      part.Shape = work.Shapes[i].Shape;
      part.Faces = work.Shapes[i].Faces;
      vtkNURBSCADTree::DescribeFaces(work.Blocks[i].Grid, work.Shapes[i].FaceOf, part);
    }
  }
  vtkNURBSCADTree::MakeNodes(work.Input, work.Blocks, parts, stem, work.Content);
  try
  {
    work.PlaceCopies(parts);
    this->NumberOfInstances = work.Instances;
    nurbs::SaveCADFile(work.Content, work.Format, this->FileName, [this](double done) {
      this->UpdateProgress(BuildPart + (1.0 - BuildPart) * done);
      return !this->GetAbortExecute();
    });
  }
  catch (const std::exception& problem)
  {
    return this->GetAbortExecute() ? this->Aborted()
                                   : this->Fail(vtkErrorCode::CannotOpenFileError, problem.what());
  }
  return true;
}

void vtkNURBSCADWriter::WriteData()
{
  this->ClearFigures();
  Work work;
  if (!this->CheckOptions(work))
  {
    return;
  }
  vtkNURBSPieces pieces; // Partitions of a block are put together where they are parts of a model.
  try
  {
    work.Input = pieces.Gather(this->GetInput());
    vtkNURBSPieces::ThrowIf(vtkNURBSCADTree::Find(work.Input, work.Blocks));
    if (work.Blocks.empty())
    {
      throw nurbs::Error("there is no face to write");
    }
    if (!this->FindUnits(work) || !this->Build(work))
    {
      return;
    }
    this->CheckShapes(work);
  }
  catch (const std::exception& failure)
  {
    this->Fail(vtkErrorCode::UserError, failure.what());
    return;
  }
  if (!this->Save(work))
  {
    this->ClearFigures();
    return;
  }
  this->UpdateProgress(1.0);
}

void vtkNURBSCADWriter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "Format: " << this->Format << "\n";
  os << indent << "CurveTolerance: " << this->CurveTolerance << "\n";
  os << indent << "Gap: " << this->Gap << "\n";
  os << indent << "AnalyticSurfaces: " << (this->AnalyticSurfaces ? "on" : "off") << "\n";
  os << indent << "Check: " << (this->Check ? "on" : "off") << "\n";
  os << indent << "NumberOfFaces: " << this->NumberOfFaces << "\n";
  os << indent << "NumberOfSplitFaces: " << this->NumberOfSplitFaces << "\n";
  os << indent << "NumberOfAnalyticFaces: " << this->NumberOfAnalyticFaces << "\n";
  os << indent << "NumberOfFailedFaces: " << this->NumberOfFailedFaces << "\n";
  os << indent << "NumberOfInstances: " << this->NumberOfInstances << "\n";
  os << indent << "NumberOfSolids: " << this->NumberOfSolids << "\n";
  os << indent << "NumberOfShells: " << this->NumberOfShells << "\n";
  os << indent << "NumberOfEdges: " << this->NumberOfEdges << "\n";
  os << indent << "NumberOfSharedEdges: " << this->NumberOfSharedEdges << "\n";
  os << indent << "NumberOfComputedEdges: " << this->NumberOfComputedEdges << "\n";
  os << indent << "NumberOfTornEdges: " << this->NumberOfTornEdges << "\n";
  os << indent << "NumberOfInvalidFaces: " << this->NumberOfInvalidFaces << "\n";
  os << indent << "EdgeTolerance: " << this->EdgeTolerance << "\n";
}
