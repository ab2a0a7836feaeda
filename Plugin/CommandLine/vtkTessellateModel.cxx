// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTessellateModel.h"

#include "Arguments.h"
#include "Failure.h"
#include "Report.h"

#include "vtkCamera.h"
#include "vtkCellArray.h"
#include "vtkDataObject.h"
#include "vtkNURBSTessellator.h"
#include "vtkNew.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <unordered_map>

namespace nurbs
{
namespace
{

void Configure(vtkNURBSTessellator* tessellator, const Arguments& arguments, vtkCamera* camera)
{
  switch (arguments.Kind)
  {
    case ToleranceKind::Relative:
      tessellator->SetToleranceModeToRelative();
      tessellator->SetTolerance(arguments.Tolerance);
      break;
    case ToleranceKind::Absolute:
      tessellator->SetToleranceModeToAbsolute();
      tessellator->SetAbsoluteTolerance(arguments.Tolerance);
      break;
    case ToleranceKind::Pixels:
      tessellator->SetToleranceModeToPixels();
      tessellator->SetPixelTolerance(arguments.Tolerance);
      tessellator->SetCamera(camera);
      tessellator->SetViewportSize(arguments.Size[0], arguments.Size[1]);
      break;
  }
  switch (arguments.Split)
  {
    case Method::KdTree:
      tessellator->SetMethodToKdTree();
      break;
    case Method::QuadTree:
      tessellator->SetMethodToQuadTree();
      break;
    case Method::Binary:
      tessellator->SetMethodToBinary();
      break;
  }
  if (arguments.Guaranteed)
  {
    tessellator->SetErrorModeToGuaranteed();
  }
  else
  {
    tessellator->SetErrorModeToEstimated();
  }
  tessellator->SetMergePoints(arguments.MergePoints);
}

struct Position
{
  std::array<std::uint64_t, 3> Bits;
  explicit Position(const double* p)
  {
    for (size_t c = 0; c < 3; ++c)
    {
      const double value = p[c] + 0.0; // -0 is 0
      std::memcpy(&this->Bits[c], &value, sizeof(value));
    }
  }
  bool operator==(const Position& other) const { return this->Bits == other.Bits; }
};

struct PositionHash
{
  size_t operator()(const Position& position) const
  {
    std::uint64_t hash = 0;
    for (const std::uint64_t bits : position.Bits)
    {
      hash = (hash ^ bits) * 0x9E3779B97F4A7C15u;
      hash ^= hash >> 29;
    }
    return static_cast<size_t>(hash);
  }
};

// For each point the first point with its coordinates.
std::vector<std::uint64_t> FirstTwins(vtkPolyData* mesh)
{
  std::vector<std::uint64_t> twins(static_cast<size_t>(mesh->GetNumberOfPoints()));
  std::unordered_map<Position, std::uint64_t, PositionHash> seen;
  seen.reserve(twins.size());
  for (size_t i = 0; i < twins.size(); ++i)
  {
    double p[3];
    mesh->GetPoint(static_cast<vtkIdType>(i), p);
    twins[i] = seen.emplace(Position(p), i).first->second;
  }
  return twins;
}

} // namespace

//--------------------------------------------------------------------------------------------------
std::int64_t CountOpenEdges(vtkPolyData* mesh)
{
  const std::vector<std::uint64_t> twins = FirstTwins(mesh);
  std::vector<std::pair<std::uint64_t, std::uint64_t>> edges;
  edges.reserve(3 * static_cast<size_t>(mesh->GetNumberOfPolys()));
  vtkCellArray* polys = mesh->GetPolys();
  vtkIdType size = 0;
  const vtkIdType* ids = nullptr;
  for (polys->InitTraversal(); polys->GetNextCell(size, ids);)
  {
    for (vtkIdType corner = 0; corner < size; ++corner)
    {
      const std::uint64_t a = twins[static_cast<size_t>(ids[corner])];
      const std::uint64_t b = twins[static_cast<size_t>(ids[(corner + 1) % size])];
      if (a != b)
      {
        edges.emplace_back(std::min(a, b), std::max(a, b));
      }
    }
  }
  std::sort(edges.begin(), edges.end());
  std::int64_t open = 0;
  for (auto edge = edges.begin(); edge != edges.end();)
  {
    const auto next = std::find_if(edge, edges.end(), [&](const auto& e) { return e != *edge; });
    open += next - edge == 1 ? 1 : 0;
    edge = next;
  }
  return open;
}

//--------------------------------------------------------------------------------------------------
Triangles Tessellate(vtkDataObject* model, const Arguments& arguments, vtkCamera* camera,
  const ProgressFunction& progress, Report& report)
{
  const auto started = std::chrono::steady_clock::now();
  vtkNew<vtkNURBSTessellator> tessellator;
  Configure(tessellator, arguments, camera);
  tessellator->SetInputDataObject(0, model);
  Run(tessellator, progress);
  Triangles triangles;
  triangles.Mesh = Joined(tessellator->GetOutputDataObject(0));
  triangles.Edges = Joined(tessellator->GetOutputDataObject(1));
  report.TessellateSeconds =
    std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  if (triangles.Mesh->GetNumberOfPolys() == 0)
  {
    throw Failure("no face of " + arguments.Model + " could be tessellated");
  }
  report.Tessellated = true;
  report.Triangles = triangles.Mesh->GetNumberOfPolys();
  report.Points = triangles.Mesh->GetNumberOfPoints();
  report.Tolerance = tessellator->GetToleranceUsed();
  report.CertifiedError = tessellator->GetCertifiedError();
  // Takes longer than drawing: not for a picture alone.
  if (arguments.What == Command::Tessellate || !arguments.Report.empty() || arguments.Strict)
  {
    report.OpenEdges = CountOpenEdges(triangles.Mesh);
  }
  report.FailedFaces = tessellator->GetNumberOfFailedFaces();
  report.RepairedFaces = tessellator->GetNumberOfRepairedFaces();
  report.CappedFaces = tessellator->GetNumberOfCappedFaces();
  return triangles;
}

} // namespace nurbs
