// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSTessellator.h"

#include "vtkCamera.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkNURBSFaceExtent.h"
#include "vtkNURBSMeshOutput.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelPool.h"
#include "vtkNURBSParallel.h"
#include "vtkNURBSPieces.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <map>
#include <numeric>
#include <sstream>

vtkStandardNewMacro(vtkNURBSTessellator);
vtkCxxSetObjectMacro(vtkNURBSTessellator, Camera, vtkCamera);

namespace
{

constexpr int MaxNamedFaces = 8;      // in the warning
constexpr std::size_t QuickFaces = 8; // Models that take no time worth a report of progress.
constexpr std::int64_t QuickPoints = 512;

std::int64_t ControlPoints(const nurbs::Model& model)
{
  return std::accumulate(model.Faces.begin(), model.Faces.end(), std::int64_t(0),
    [](std::int64_t sum, const nurbs::Face& face) { return sum + face.Geometry.Size(); });
}

double Now()
{
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

const char* ModeName(int mode)
{
  return mode == vtkNURBSTessellator::PIXELS
    ? "pixels"
    : (mode == vtkNURBSTessellator::ABSOLUTE ? "absolute" : "relative");
}

} // namespace

// What one Update works on.
struct vtkNURBSTessellator::Work
{
  Work(vtkInformation* request, vtkInformationVector* outputs)
    : Pieces(request, outputs)
  {}
  vtkNURBSPieces Pieces;
  vtkDataObject* Input = nullptr; ///< With faces of other processes beside the own ones.
  nurbs::PieceLinks Links;

  bool IsGhost(std::size_t face) const
  {
    return !this->Links.IsGhost.empty() && this->Links.IsGhost[face] != 0;
  }
  vtkNURBSModelPool Pool;
  nurbs::TessellatorOptions Options;
  nurbs::TessellationResult Result;
};

vtkNURBSTessellator::vtkNURBSTessellator()
{
  this->SetNumberOfInputPorts(1);
  this->SetNumberOfOutputPorts(2);
}

vtkNURBSTessellator::~vtkNURBSTessellator()
{
  this->SetCamera(nullptr);
}

vtkMTimeType vtkNURBSTessellator::GetMTime()
{
  const vtkMTimeType own = this->Superclass::GetMTime();
  return this->Camera && this->ToleranceMode == PIXELS ? std::max(own, this->Camera->GetMTime())
                                                       : own;
}

int vtkNURBSTessellator::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

int vtkNURBSTessellator::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  return vtkNURBSModelPool::MakeOutputs(vtkDataObject::GetData(inputs[0]), outputs, 2) ? 1 : 0;
}

// The models of the input in one, with offset indices.
void vtkNURBSTessellator::CollectModels(vtkDataObject* input, Work& work)
{
  work.Input = work.Pieces.Gather(input, vtkNURBSPieces::NEIGHBOURS);
  vtkNURBSPieces::ThrowIf(work.Pool.Collect(work.Input));
  if (work.Pieces.IsParallel())
  {
    const vtkNURBSPieces::Identity identity = work.Pieces.GetIdentity();
    work.Links.IsGhost = identity.IsGhost;
    work.Links.Faces = identity.Faces;
    work.Links.Edges = identity.Edges;
    work.Links.Vertices = identity.Vertices;
    work.Links.Exchange = [&work](
                            const std::vector<char>& own) { return work.Pieces.Exchange(own); };
    work.Options.Pieces = &work.Links;
  }
}

void vtkNURBSTessellator::FillOptions(Work& work)
{
  nurbs::TessellatorOptions& options = work.Options;
  options.Method = this->Method == QUAD_TREE ? nurbs::SubdivisionMethod::QuadTree
    : this->Method == BINARY                 ? nurbs::SubdivisionMethod::Binary
                                             : nurbs::SubdivisionMethod::KdTree;
  options.Error =
    this->ErrorMode == ESTIMATED ? nurbs::ErrorMode::Estimated : nurbs::ErrorMode::Guaranteed;
  options.Curves.Subdivision = this->CurveSubdivision == ARBITRARY
    ? nurbs::CurveSubdivision::Arbitrary
    : nurbs::CurveSubdivision::Midpoint;
  options.Curves.Measure =
    this->CurveMeasure == POINT ? nurbs::CurveMeasure::Point : nurbs::CurveMeasure::Line;
  options.Curves.Balanced = this->CurveBalancing;
  options.Curves.Simplify = this->CurveSimplification;
  options.MaximumEdgeLength = this->MaximumEdgeLength;
  options.MaximumAngle = vtkMath::RadiansFromDegrees(this->MaximumAngle);
  options.MaximumFaceTriangles = this->MaximumFaceTriangles;
  options.Parallel = vtkNURBSParallelFor;
  if (this->ToleranceMode == ABSOLUTE)
  {
    if (!(this->AbsoluteTolerance > 0.0) || !std::isfinite(this->AbsoluteTolerance))
    {
      std::ostringstream text;
      text << "AbsoluteTolerance must be positive, but is " << this->AbsoluteTolerance;
      throw nurbs::Error(text.str());
    }
    options.Tolerance = this->AbsoluteTolerance;
    return;
  }
  const std::vector<nurbs::Box3> boxes =
    nurbs::FaceBoxes(work.Pool.Model, work.Pool.FaceErrors, vtkNURBSParallelFor);
  nurbs::Box3 all;
  for (const nurbs::Box3& box : boxes)
  {
    all.extend(box);
  }
  const double diagonal = nurbs::Diagonal({ work.Pieces.Around(all) });
  options.Tolerance = (diagonal > 0.0 ? diagonal : 1.0) * this->Tolerance;
  if (this->ToleranceMode == RELATIVE)
  {
    return;
  }
  if (!this->Camera || this->ViewportSize[0] < 1 || this->ViewportSize[1] < 1)
  {
    throw nurbs::Error("A tolerance in pixels needs a Camera and a ViewportSize of at least 1 x 1");
  }
  options.FaceTolerances = vtkNURBSFaceExtent::PixelTolerances(
    boxes, this->Camera, this->ViewportSize, this->PixelTolerance, 1e-7 * diagonal);
  if (!options.FaceTolerances.empty())
  {
    options.Tolerance =
      *std::min_element(options.FaceTolerances.begin(), options.FaceTolerances.end());
  }
}

bool vtkNURBSTessellator::Tessellate(Work& work)
{
  // Processes talk in this thread only: MPI need not know of others.
  const bool quick = work.Pieces.IsParallel() ||
    (work.Pool.Model.Faces.size() <= QuickFaces && ControlPoints(work.Pool.Model) <= QuickPoints);
  try
  {
    vtkNURBSRunWithProgress(
      this, quick, 0.0, 0.95, [&work](const std::function<bool(double)>& progress) {
        work.Options.Progress = progress;
        work.Result = nurbs::Tessellate(work.Pool.Model, work.Pool.FaceErrors, work.Options);
      });
  }
  catch (const std::exception& problem)
  {
    throw nurbs::Error(std::string("Tessellation failed: ") + problem.what());
  }
  return !work.Result.Aborted && this->GetAbortExecute() == 0;
}

void vtkNURBSTessellator::FillOutputs(Work& work, vtkInformationVector* outputs)
{
  for (int port = 0; port < 2; ++port)
  {
    vtkNURBSModelPool::CopyTree(work.Input, vtkDataObject::GetData(outputs, port));
  }
  const std::vector<vtkPolyData*> meshes =
    work.Pool.MakeLeaves(work.Input, vtkDataObject::GetData(outputs, 0));
  const std::vector<vtkPolyData*> lines =
    work.Pool.MakeLeaves(work.Input, vtkDataObject::GetData(outputs, 1));
  std::size_t line = 0;
  for (std::size_t k = 0; k < work.Pool.Leaves.size(); ++k)
  {
    const vtkNURBSModelPool::Leaf& leaf = work.Pool.Leaves[k];
    vtkNURBSMeshOutput::Range range;
    range.Result = &work.Result;
    range.FirstMesh = leaf.FirstFace;
    range.LastMesh = leaf.LastFace;
    range.FirstLine = line;
    while (line < work.Result.Polylines.size() &&
      work.Result.Polylines[line].Face < std::int64_t(range.LastMesh))
    {
      ++line;
    }
    range.LastLine = line;
    range.Tolerance = this->ToleranceUsed;
    range.FaceTolerances = work.Options.FaceTolerances.empty()
      ? nullptr
      : work.Options.FaceTolerances.data() + range.FirstMesh;
    range.IsGhost =
      work.Links.IsGhost.empty() ? nullptr : work.Links.IsGhost.data() + range.FirstMesh;
    range.MergePoints = this->MergePoints;
    vtkNURBSMeshOutput::FillMesh(range, leaf.Grid, meshes[k]);
    vtkNURBSMeshOutput::FillLines(range, leaf.Grid, leaf.FirstEdge, lines[k]);
    this->NumberOfTriangles += meshes[k]->GetNumberOfPolys();
    this->NumberOfPoints += meshes[k]->GetNumberOfPoints();
  }
  work.Pieces.Sum(&this->NumberOfTriangles, 1);
  work.Pieces.Sum(&this->NumberOfPoints, 1);
  if (work.Pieces.IsParallel())
  {
    this->TellWhole(work, meshes);
  }
}

// What the field data tell of a model they tell of all processes' pieces of it.
void vtkNURBSTessellator::TellWhole(Work& work, const std::vector<vtkPolyData*>& meshes) const
{
  const std::vector<unsigned int> blocks = work.Pieces.GetBlocks();
  std::map<unsigned int, double> errors;
  std::map<unsigned int, vtkIdType> triangles;
  for (std::size_t k = 0; k < meshes.size(); ++k)
  {
    errors[blocks[k]] = vtkNURBSMeshOutput::GetCertifiedError(meshes[k]);
    triangles[blocks[k]] = meshes[k]->GetNumberOfPolys();
  }
  work.Pieces.Largest(errors);
  work.Pieces.Sum(triangles);
  for (std::size_t k = 0; k < meshes.size(); ++k)
  {
    vtkNURBSMeshOutput::SetFigures(meshes[k], errors[blocks[k]], triangles[blocks[k]]);
  }
}

// Counts the faces by status and names those that were not done in one warning.
void vtkNURBSTessellator::Summarize(const Work& work)
{
  this->NumberOfFaces = vtkIdType(work.Result.Meshes.size());
  this->ToleranceUsed = this->ToleranceMode == PIXELS ? 0.0 : work.Options.Tolerance;
  std::vector<std::string> named;
  vtkIdType count = 0;
  std::size_t leaf = 0;
  for (std::size_t f = 0; f < work.Result.Meshes.size(); ++f)
  {
    if (work.IsGhost(f))
    {
      --this->NumberOfFaces;
      ++this->NumberOfGhostFaces;
      continue;
    }
    while (leaf + 1 < work.Pool.Leaves.size() && work.Pool.Leaves[leaf + 1].FirstFace <= f)
    {
      ++leaf;
    }
    const nurbs::FaceMesh& mesh = work.Result.Meshes[f];
    this->CertifiedError = std::max(this->CertifiedError, mesh.CertifiedError);
    if (!work.Options.FaceTolerances.empty() && mesh.Status != nurbs::FaceStatus::Failed)
    {
      this->ToleranceUsed = std::max(this->ToleranceUsed, work.Options.FaceTolerances[f]);
    }
    this->NumberOfRepairedFaces += mesh.Status == nurbs::FaceStatus::Repaired;
    this->NumberOfCappedFaces += mesh.Status == nurbs::FaceStatus::Capped;
    this->NumberOfFailedFaces += mesh.Status == nurbs::FaceStatus::Failed;
    if (mesh.Status < nurbs::FaceStatus::Capped || ++count > MaxNamedFaces)
    {
      continue;
    }
    const vtkNURBSModelPool::Leaf& of = work.Pool.Leaves[leaf];
    const auto cell = vtkIdType(f - of.FirstFace);
    named.push_back("\n  face " + std::to_string(vtkNURBSModel::GetFaceId(of.Grid, cell)) +
      (mesh.Status == nurbs::FaceStatus::Failed ? " failed: " : " capped: ") + mesh.Message);
  }
  double* const largest[] = { &this->CertifiedError, &this->ToleranceUsed };
  vtkIdType* const sums[] = { &this->NumberOfFaces, &this->NumberOfRepairedFaces,
    &this->NumberOfCappedFaces, &this->NumberOfFailedFaces, &this->NumberOfGhostFaces, &count };
  for (double* value : largest)
  {
    work.Pieces.Largest(value, 1);
  }
  for (vtkIdType* value : sums)
  {
    work.Pieces.Sum(value, 1);
  }
  work.Pieces.Join(named);
  if (count > 0)
  {
    named.resize(std::min(named.size(), std::size_t(MaxNamedFaces)));
    vtkWarningMacro(<< this->NumberOfFailedFaces << " of " << this->NumberOfFaces
                    << " faces have no triangles, " << this->NumberOfCappedFaces
                    << " exceed the tolerance:"
                    << std::accumulate(named.begin(), named.end(), std::string())
                    << (count > MaxNamedFaces
                           ? "\n  and " + std::to_string(count - MaxNamedFaces) + " more"
                           : ""));
  }
}

void vtkNURBSTessellator::ClearResults()
{
  this->NumberOfTriangles = this->NumberOfPoints = this->NumberOfFaces = 0;
  this->NumberOfRepairedFaces = this->NumberOfGhostFaces = 0;
  this->NumberOfCappedFaces = this->NumberOfFailedFaces = 0;
  this->CertifiedError = this->ToleranceUsed = this->TessellateSeconds = this->OutputSeconds = 0.0;
}

bool vtkNURBSTessellator::Make(vtkDataObject* input, Work& work, vtkInformationVector* outputs)
{
  const double start = Now();
  this->CollectModels(input, work);
  this->FillOptions(work);
  if (!this->Tessellate(work))
  {
    return false;
  }
  this->TessellateSeconds = Now() - start;
  this->Summarize(work);
  this->FillOutputs(work, outputs);
  work.Pieces.Keep(vtkDataObject::GetData(outputs, 0));
  work.Pieces.Keep(vtkDataObject::GetData(outputs, 1));
  this->OutputSeconds = Now() - start - this->TessellateSeconds;
  return true;
}

int vtkNURBSTessellator::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->ClearResults();
  vtkDataObject* input = vtkDataObject::GetData(inputs[0]);
  const vtkNURBSParallelScope parallel;
  Work work(request, outputs);
  std::string problem;
  const auto outcome = work.Pieces.Run([&]() { return this->Make(input, work, outputs); }, problem);
  this->SetErrorCode(
    outcome == vtkNURBSPieces::FAILED ? vtkErrorCode::UserError : vtkErrorCode::NoError);
  if (outcome == vtkNURBSPieces::DONE)
  {
    this->UpdateProgress(1.0);
    return 1;
  }
  this->ClearResults();
  for (int port = 0; port < 2; ++port)
  {
    vtkNURBSModelPool::CopyTree(input, vtkDataObject::GetData(outputs, port));
  }
  if (outcome == vtkNURBSPieces::ABORTED)
  {
    return 1;
  }
  vtkErrorMacro(<< problem);
  return 0;
}

void vtkNURBSTessellator::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  static const char* const methods[] = { "kd-tree", "quadtree", "binary" };
  os << indent << "ToleranceMode: " << ModeName(this->ToleranceMode) << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "AbsoluteTolerance: " << this->AbsoluteTolerance << "\n";
  os << indent << "PixelTolerance: " << this->PixelTolerance << "\n";
  os << indent << "Camera: " << this->Camera << "\n";
  os << indent << "ViewportSize: " << this->ViewportSize[0] << " x " << this->ViewportSize[1]
     << "\n";
  os << indent << "Method: " << methods[this->Method] << "\n";
  os << indent << "ErrorMode: " << (this->ErrorMode == ESTIMATED ? "estimated" : "guaranteed")
     << "\n";
  os << indent
     << "CurveSubdivision: " << (this->CurveSubdivision == ARBITRARY ? "arbitrary" : "midpoint")
     << "\n";
  os << indent << "CurveMeasure: " << (this->CurveMeasure == POINT ? "point" : "line") << "\n";
  os << indent << "CurveBalancing: " << this->CurveBalancing << "\n";
  os << indent << "CurveSimplification: " << this->CurveSimplification << "\n";
  os << indent << "MaximumEdgeLength: " << this->MaximumEdgeLength << "\n";
  os << indent << "MaximumAngle: " << this->MaximumAngle << "\n";
  os << indent << "MaximumFaceTriangles: " << this->MaximumFaceTriangles << "\n";
  os << indent << "MergePoints: " << this->MergePoints << "\n";
  os << indent << "NumberOfTriangles: " << this->NumberOfTriangles << "\n";
  os << indent << "NumberOfPoints: " << this->NumberOfPoints << "\n";
  os << indent << "CertifiedError: " << this->CertifiedError << "\n";
  os << indent << "ToleranceUsed: " << this->ToleranceUsed << "\n";
  os << indent << "NumberOfFaces: " << this->NumberOfFaces << "\n";
  os << indent << "NumberOfRepairedFaces: " << this->NumberOfRepairedFaces << "\n";
  os << indent << "NumberOfCappedFaces: " << this->NumberOfCappedFaces << "\n";
  os << indent << "NumberOfFailedFaces: " << this->NumberOfFailedFaces << "\n";
  os << indent << "NumberOfGhostFaces: " << this->NumberOfGhostFaces << "\n";
  os << indent << "TessellateSeconds: " << this->TessellateSeconds << "\n";
  os << indent << "OutputSeconds: " << this->OutputSeconds << "\n";
}
