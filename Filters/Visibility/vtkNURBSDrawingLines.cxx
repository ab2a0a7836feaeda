// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSDrawingLines.h"

#include "CoincidentLines.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkInformation.h"
#include "vtkNURBSModel.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace
{

using vtkNURBSDrawingLines::KindCount;
using vtkNURBSDrawingLines::Lines;
using vtkNURBSDrawingLines::Origin;

// A cell array of numbers, or null. Cells of lines follow those of vertices.
class CellValues
{
public:
  CellValues(vtkPolyData* data, const char* name, std::int64_t missing)
    : Array(data->GetCellData()->GetArray(name))
    , First(data->GetNumberOfVerts())
    , Missing(missing)
  {}
  std::int64_t operator()(vtkIdType line) const
  {
    return this->Array ? std::int64_t(this->Array->GetComponent(this->First + line, 0))
                       : this->Missing;
  }

private:
  vtkDataArray* Array;
  vtkIdType First;
  std::int64_t Missing;
};

std::string Unit(vtkPolyData* data)
{
  auto* unit = vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray("LengthUnit"));
  return unit && unit->GetNumberOfValues() > 0 ? unit->GetValue(0) : std::string();
}

std::string CollectPart(vtkPolyData* data, std::size_t part, bool hidden, Lines& lines)
{
  const CellValues visibility(data, "Visibility", 1), kind(data, "Kind", 2);
  const CellValues face(data, vtkNURBSModel::FaceIdName(), -1);
  const CellValues edge(data, vtkNURBSModel::EdgeIdName(), -1);
  vtkCellArray* cells = data->GetLines();
  vtkIdType size = 0, line = 0;
  const vtkIdType* ids = nullptr;
  for (cells->InitTraversal(); cells->GetNextCell(size, ids); ++line)
  {
    Origin origin;
    origin.Visible = visibility(line) != 0;
    if (size == 0 || (!origin.Visible && !hidden))
    {
      continue;
    }
    const std::int64_t value = kind(line);
    if (value < 0 || value >= KindCount)
    {
      return "the Kind of a line is " + std::to_string(value) + ", which is none of 0 to 4";
    }
    origin.Kind = int(value);
    origin.Face = face(line);
    origin.Edge = edge(line);
    origin.Part = part;
    nurbs::PlaneLine geometry;
    for (vtkIdType k = 0; k < size; ++k)
    {
      double p[3];
      data->GetPoint(ids[k], p);
      if (!std::isfinite(p[0]) || !std::isfinite(p[1]))
      {
        return "point " + std::to_string(ids[k]) + " is not finite";
      }
      geometry.Points.emplace_back(p[0], p[1]);
      lines.Box.extend(geometry.Points.back());
    }
    lines.Geometry.push_back(std::move(geometry));
    lines.Origins.push_back(origin);
  }
  return "";
}

// Lines of one part, kind and visibility may be joined.
void NumberGroups(Lines& lines)
{
  std::map<std::tuple<std::size_t, std::int64_t, std::int64_t>, std::int64_t> sources;
  for (std::size_t k = 0; k < lines.Geometry.size(); ++k)
  {
    const Origin& origin = lines.Origins[k];
    lines.Geometry[k].Group =
      (std::int64_t(origin.Part) * KindCount + origin.Kind) * 2 + (origin.Visible ? 1 : 0);
    // A line that tells nothing of where it comes from is a source of its own.
    lines.Geometry[k].Source = -1 - std::int64_t(k);
    if (origin.Face >= 0 || origin.Edge >= 0)
    {
      const auto key =
        std::make_tuple(origin.Part, origin.Edge, origin.Edge < 0 ? origin.Face : std::int64_t(-1));
      lines.Geometry[k].Source = sources.emplace(key, std::int64_t(sources.size())).first->second;
    }
  }
}

} // namespace

std::string vtkNURBSDrawingLines::Collect(vtkDataObject* input, bool hidden, Lines& lines)
{
  if (auto* single = vtkPolyData::SafeDownCast(input))
  {
    lines.Parts.emplace_back();
    lines.Unit = Unit(single);
    const std::string problem = CollectPart(single, 0, hidden, lines);
    NumberGroups(lines);
    return problem;
  }
  auto* composite = vtkCompositeDataSet::SafeDownCast(input);
  if (!composite)
  {
    return "the input is neither vtkPolyData nor a composite data set";
  }
  vtkSmartPointer<vtkCompositeDataIterator> each;
  each.TakeReference(composite->NewIterator());
  for (each->InitTraversal(); !each->IsDoneWithTraversal(); each->GoToNextItem())
  {
    auto* leaf = vtkPolyData::SafeDownCast(each->GetCurrentDataObject());
    if (!leaf)
    {
      return "a block of the input is no vtkPolyData";
    }
    const char* name = each->HasCurrentMetaData()
      ? each->GetCurrentMetaData()->Get(vtkCompositeDataSet::NAME())
      : nullptr;
    lines.Parts.push_back(name && *name ? name : std::to_string(lines.Parts.size()));
    if (lines.Unit.empty())
    {
      lines.Unit = Unit(leaf);
    }
    const std::string problem = CollectPart(leaf, lines.Parts.size() - 1, hidden, lines);
    if (!problem.empty())
    {
      return problem;
    }
  }
  NumberGroups(lines);
  return "";
}

void vtkNURBSDrawingLines::DropHiddenCopies(Lines& lines, double tolerance)
{
  std::vector<char> isVisible;
  for (const Origin& origin : lines.Origins)
  {
    isVisible.push_back(origin.Visible);
  }
  if (std::find(isVisible.begin(), isVisible.end(), 0) == isVisible.end())
  {
    return;
  }
  std::vector<Origin> origins;
  for (const std::size_t line : nurbs::DropHiddenCopies(lines.Geometry, isVisible, tolerance))
  {
    origins.push_back(lines.Origins[line]);
  }
  lines.Origins = std::move(origins);
}
