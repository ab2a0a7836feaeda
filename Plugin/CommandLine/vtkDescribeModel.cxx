// SPDX-License-Identifier: BSD-3-Clause
#include "vtkDescribeModel.h"

#include "vtkReadModel.h"

#include "vtkBoundingBox.h"
#include "vtkDataAssembly.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <iomanip>
#include <map>
#include <ostream>
#include <sstream>

namespace nurbs
{
namespace
{

// How many are printed, unless all are wanted.
constexpr size_t MostSiblings = 12;
constexpr size_t MostProblems = 10;

// Sums over a model's usable faces.
struct Sums
{
  std::map<std::pair<int, int>, std::int64_t> Degrees;
  std::int64_t Rational = 0, Trimmed = 0, Loops = 0, ControlPoints = 0;
  vtkBoundingBox Box; // of the control points
};

Sums SumUp(vtkDataObject* model)
{
  Sums sums;
  for (vtkUnstructuredGrid* part : PartsOf(model))
  {
    const auto view = vtkNURBSModel::View(part);
    for (const Face& face : view->GetModel().Faces)
    {
      const SurfaceView& surface = face.Geometry;
      if (surface.Size() == 0)
      {
        continue;
      }
      ++sums.Degrees[{ surface.Degree[0], surface.Degree[1] }];
      sums.Rational += surface.IsRational() ? 1 : 0;
      sums.Trimmed += face.LoopCount > 0 ? 1 : 0;
      sums.Loops += face.LoopCount;
      sums.ControlPoints += surface.Size();
    }
    double bounds[6];
    part->GetBounds(bounds);
    sums.Box.AddBounds(bounds);
  }
  return sums;
}

std::string Grouped(std::int64_t number)
{
  std::string text = std::to_string(number);
  for (int at = static_cast<int>(text.size()) - 3; at > 0; at -= 3)
  {
    text.insert(static_cast<size_t>(at), ",");
  }
  return text;
}

// Edges that a trim curve names, poles left out.
std::int64_t CountEdges(const Model& model)
{
  std::vector<bool> used(model.Edges.size(), false);
  for (const Face& face : model.Faces)
  {
    for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
    {
      const TrimLoop& loop = model.Loops[static_cast<size_t>(l)];
      for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
      {
        const std::int64_t edge = model.TrimCurves[static_cast<size_t>(c)].Edge;
        if (edge >= 0)
        {
          const CurveView<3>& curve = model.Edges[static_cast<size_t>(edge)].Geometry;
          used[static_cast<size_t>(edge)] = !(curve.Degree == 0 && curve.Count == 1);
        }
      }
    }
  }
  return std::count(used.begin(), used.end(), true);
}

std::string LabelOf(vtkDataAssembly* tree, int node)
{
  const char* label = tree->GetAttributeOrDefault(node, "label", static_cast<const char*>(nullptr));
  return label && *label ? label : tree->GetNodeName(node);
}

// A node of the tree of parts with all that is beneath it, so that equal siblings can be told once.
struct Branch
{
  std::string Label;
  std::int64_t Faces = 0;
  std::vector<Branch> Children;
  std::int64_t Times = 1;

  bool Same(const Branch& other) const
  {
    return this->Label == other.Label && this->Faces == other.Faces &&
      std::equal(this->Children.begin(), this->Children.end(), other.Children.begin(),
        other.Children.end(),
        [](const Branch& a, const Branch& b) { return a.Times == b.Times && a.Same(b); });
  }
};

Branch BranchOf(vtkPartitionedDataSetCollection* model, vtkDataAssembly* tree, int node)
{
  Branch branch;
  branch.Label = LabelOf(tree, node);
  for (const unsigned int index : tree->GetDataSetIndices(node, false))
  {
    for (unsigned int i = 0; i < model->GetNumberOfPartitions(index); ++i)
    {
      vtkDataSet* part = model->GetPartition(index, i);
      branch.Faces += part ? part->GetNumberOfCells() : 0;
    }
  }
  for (const int child : tree->GetChildNodes(node, false))
  {
    Branch next = BranchOf(model, tree, child);
    branch.Faces += next.Times * next.Faces;
    const auto twin = std::find_if(branch.Children.begin(), branch.Children.end(),
      [&next](const Branch& sibling) { return sibling.Same(next); });
    if (twin == branch.Children.end())
    {
      branch.Children.push_back(std::move(next));
    }
    else
    {
      ++twin->Times;
    }
  }
  // A use and the one product that it is a use of share a line.
  if (branch.Children.size() == 1 && branch.Children[0].Times == 1 &&
    branch.Children[0].Faces == branch.Faces && node != vtkDataAssembly::GetRootNode())
  {
    Branch only = std::move(branch.Children[0]);
    only.Label = only.Label == branch.Label ? branch.Label : branch.Label + ": " + only.Label;
    return only;
  }
  return branch;
}

void Print(const Branch& branch, int depth, bool whole, std::ostream& out)
{
  const std::string indent(static_cast<size_t>(2 + 2 * depth), ' ');
  out << indent << branch.Label;
  if (branch.Times > 1)
  {
    out << "  x " << branch.Times;
  }
  out << "  (" << Grouped(branch.Faces) << (branch.Faces == 1 ? " face" : " faces")
      << (branch.Times > 1 ? " each)\n" : ")\n");
  const size_t count = branch.Children.size();
  const size_t shown = whole || count <= MostSiblings ? count : MostSiblings - 1;
  for (size_t i = 0; i < shown; ++i)
  {
    Print(branch.Children[i], depth + 1, whole, out);
  }
  if (shown < count)
  {
    out << indent << "  ... and " << Grouped(static_cast<std::int64_t>(count - shown))
        << " more; --all shows all\n";
  }
}

} // namespace

//--------------------------------------------------------------------------------------------------
void Count(vtkDataObject* model, Report& report)
{
  for (vtkUnstructuredGrid* part : PartsOf(model))
  {
    const auto view = vtkNURBSModel::View(part);
    report.Faces += part->GetNumberOfCells();
    report.Edges += CountEdges(view->GetModel());
    if (report.Unit.empty())
    {
      report.Unit = vtkNURBSModel::GetLengthUnit(part);
    }
    report.Unconverted +=
      static_cast<std::int64_t>(vtkNURBSModel::GetUnconvertedFaces(part).size());
  }
}

//--------------------------------------------------------------------------------------------------
void ListProblems(vtkDataObject* model, Report& report)
{
  for (vtkUnstructuredGrid* part : PartsOf(model))
  {
    for (const std::string& reason : vtkNURBSModel::GetUnconvertedFaces(part))
    {
      report.Problems.push_back("error: face not converted, " + reason);
    }
  }
  std::istringstream lines(vtkNURBSModel::Validate(model));
  for (std::string line; std::getline(lines, line);)
  {
    report.Problems.push_back(line);
  }
}

//--------------------------------------------------------------------------------------------------
void Describe(vtkDataObject* model, const Report& report, bool whole, std::ostream& out)
{
  const Sums sums = SumUp(model);
  const auto line = [&out](const char* label) -> std::ostream& {
    return out << std::left << std::setw(16) << label;
  };
  out << report.File << "\n";
  line("Faces") << Grouped(report.Faces) << ", of which " << Grouped(sums.Trimmed) << " trimmed by "
                << Grouped(sums.Loops) << " loops and " << Grouped(sums.Rational) << " rational\n";
  line("Edges") << Grouped(report.Edges) << "\n";
  line("Control points") << Grouped(sums.ControlPoints) << "\n";
  const char* label = "Degrees";
  for (const auto& [degree, count] : sums.Degrees)
  {
    line(label) << degree.first << " x " << degree.second << ": " << Grouped(count)
                << (count == 1 ? " face\n" : " faces\n");
    label = "";
  }
  line("Unit") << (report.Unit.empty() ? "unknown" : report.Unit) << "\n";
  if (sums.Box.IsValid())
  {
    double size[3];
    sums.Box.GetLengths(size);
    line("Size") << std::setprecision(6) << size[0] << " x " << size[1] << " x " << size[2]
                 << (report.Unit.empty() ? "" : " ") << report.Unit << " (box of control points)\n";
  }
  auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(model);
  if (vtkDataAssembly* tree = collection ? collection->GetDataAssembly() : nullptr)
  {
    line("Parts") << "\n";
    Print(BranchOf(collection, tree, vtkDataAssembly::GetRootNode()), 0, whole, out);
  }
  line("Problems") << (report.Problems.empty() ? "none" : "") << "\n";
  const size_t count = report.Problems.size();
  const size_t shown = whole || count <= MostProblems ? count : MostProblems - 1;
  for (size_t i = 0; i < shown; ++i)
  {
    out << "  " << report.Problems[i] << "\n";
  }
  if (shown < count)
  {
    out << "  ... and " << Grouped(static_cast<std::int64_t>(count - shown))
        << " more; --all shows all\n";
  }
}

} // namespace nurbs
