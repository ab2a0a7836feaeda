// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMeshOpenEdges.h"

#include "vtkCellArray.h"
#include "vtkCellArrayIterator.h"
#include "vtkDataArray.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

namespace
{

using Edge = std::pair<vtkIdType, vtkIdType>;

// Of every point, the first one at the same place.
std::vector<vtkIdType> MergePoints(vtkPoints* points)
{
  const vtkIdType count = points->GetNumberOfPoints();
  std::vector<std::array<double, 3>> places(static_cast<std::size_t>(count));
  for (vtkIdType k = 0; k < count; ++k)
  {
    points->GetPoint(k, places[std::size_t(k)].data());
  }
  std::vector<vtkIdType> order(places.size()), first(places.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](vtkIdType a, vtkIdType b) {
    return std::make_pair(places[std::size_t(a)], a) < std::make_pair(places[std::size_t(b)], b);
  });
  for (std::size_t k = 0; k < order.size(); ++k)
  {
    const bool same = k > 0 && places[std::size_t(order[k])] == places[std::size_t(order[k - 1])];
    first[std::size_t(order[k])] = same ? first[std::size_t(order[k - 1])] : order[k];
  }
  return first;
}

std::vector<Edge> SortedEdges(vtkCellArray* triangles, const std::vector<vtkIdType>& point)
{
  std::vector<Edge> edges;
  edges.reserve(3 * std::size_t(triangles->GetNumberOfCells()));
  vtkIdType count = 0;
  const vtkIdType* corners = nullptr;
  auto at = vtk::TakeSmartPointer(triangles->NewIterator());
  for (at->GoToFirstCell(); !at->IsDoneWithTraversal(); at->GoToNextCell())
  {
    at->GetCurrentCell(count, corners);
    for (vtkIdType k = 0; k < count; ++k)
    {
      const vtkIdType a = point[std::size_t(corners[k])];
      const vtkIdType b = point[std::size_t(corners[(k + 1) % count])];
      if (a != b)
      {
        edges.emplace_back(std::min(a, b), std::max(a, b));
      }
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

// Whether two points are on the same side of the domain.
class Border
{
public:
  /// @param parameters null: there is no border
  explicit Border(vtkDataArray* parameters)
    : Parameters(parameters)
  {
    for (int dir = 0; parameters && dir < 2; ++dir)
    {
      parameters->GetRange(this->Range[dir].data(), dir);
    }
  }
  bool Has(const Edge& edge) const
  {
    for (int dir = 0; this->Parameters && dir < 2; ++dir)
    {
      const double a = this->Parameters->GetComponent(edge.first, dir);
      const double b = this->Parameters->GetComponent(edge.second, dir);
      if (a == b && (a == this->Range[dir][0] || a == this->Range[dir][1]))
      {
        return true;
      }
    }
    return false;
  }

private:
  vtkDataArray* Parameters;
  std::array<std::array<double, 2>, 2> Range;
};

} // namespace

vtkIdType CountOpenEdges(vtkPolyData* mesh, bool ignoreBorder)
{
  const std::vector<Edge> edges = SortedEdges(mesh->GetPolys(), MergePoints(mesh->GetPoints()));
  const Border border(ignoreBorder ? mesh->GetPointData()->GetArray("UV") : nullptr);
  vtkIdType open = 0;
  for (auto edge = edges.begin(); edge != edges.end();)
  {
    const auto next = std::upper_bound(edge, edges.end(), *edge);
    if ((next - edge) % 2 != 0 && !border.Has(*edge))
    {
      ++open;
    }
    edge = next;
  }
  return open;
}
