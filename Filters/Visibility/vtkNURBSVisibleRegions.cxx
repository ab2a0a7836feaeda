// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSVisibleRegions.h"

#include "vtkCamera.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSParallel.h"
#include "vtkNURBSPieces.h"
#include "vtkNURBSRegionOutput.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <sstream>

vtkStandardNewMacro(vtkNURBSVisibleRegions);

/// What is kept for the next view of an input that is still the same.
struct vtkNURBSVisibleRegions::Kept
{
  vtkNURBSModelPool Pool;
  nurbs::VisibilityCache Cache;
};

struct vtkNURBSVisibleRegions::Work
{
  Work(const vtkNURBSModelPool& pool, const vtkNURBSPieces& pieces)
    : Pool(pool)
    , Pieces(pieces)
  {}

  const vtkNURBSModelPool& Pool;
  const vtkNURBSPieces& Pieces;
  nurbs::VisibleRegionOptions Options;
  nurbs::VisibleRegions Result;
};

vtkNURBSVisibleRegions::vtkNURBSVisibleRegions()
{
  this->SetNumberOfOutputPorts(2);
}

vtkNURBSVisibleRegions::~vtkNURBSVisibleRegions() = default;

int vtkNURBSVisibleRegions::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataObject");
  return 1;
}

int vtkNURBSVisibleRegions::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  return vtkNURBSModelPool::MakeOutputs(vtkDataObject::GetData(inputs[0]), outputs, 2, 1) ? 1 : 0;
}

vtkPolyData* vtkNURBSVisibleRegions::GetLines()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(1));
}

void vtkNURBSVisibleRegions::Make(Work& work)
{
  nurbs::VisibleRegionOptions& options = work.Options;
  const vtkNURBSModelPool& pool = work.Pool;
  const double* up = this->GetCamera() ? this->GetCamera()->GetViewUp() : this->ViewUp;
  options.View = this->MakeViewer();
  options.Up = nurbs::Vec3(up[0], up[1], up[2]);
  options.Precision = this->AbsolutePrecision(pool);
  options.FeatureAngle = vtkMath::RadiansFromDegrees(this->GetFeatureAngle());
  options.Regions = this->ComputeRegions;
  options.SmoothLines = this->GetSmoothEdges();
  options.HiddenRegions = this->Region == HIDDEN_REGION;
  options.BothSides = this->BothSides;
  options.Clustering = this->Clustering;
  options.Parts = PartsOf(pool);
  options.Parallel = vtkNURBSParallelFor;
  options.Share = work.Pieces.GetShare();
  // Processes talk in this thread only: MPI need not know of others.
  vtkNURBSRunWithProgress(this, work.Pieces.IsParallel() || IsQuick(pool), 0.0, 0.9,
    [&](const std::function<bool(double)>& progress) {
      options.Progress = progress;
      work.Result =
        nurbs::MakeVisibleRegions(pool.Model, pool.FaceErrors, options, &this->Before->Cache);
    });
}

void vtkNURBSVisibleRegions::Summarize(const Work& work)
{
  std::ostringstream failed;
  const auto faceName = [&](std::int64_t face) {
    for (const vtkNURBSModelPool::Leaf& leaf : work.Pool.Leaves)
    {
      if (face >= std::int64_t(leaf.FirstFace) && face < std::int64_t(leaf.LastFace))
      {
        return std::to_string(
          vtkNURBSModel::GetFaceId(leaf.Grid, vtkIdType(face - std::int64_t(leaf.FirstFace))));
      }
    }
    return std::string("the background");
  };
  this->NumberOfFaces = vtkIdType(work.Pool.Model.Faces.size());
  for (std::size_t f = 0; f < work.Result.Lines.Faces.size(); ++f)
  {
    const nurbs::FaceSilhouette& lines = work.Result.Lines.Faces[f];
    if (lines.Status >= nurbs::SilhouetteStatus::Capped)
    {
      if (++this->NumberOfFailedFaces <= MaxNamed)
      {
        failed << "\n  face " << faceName(std::int64_t(f)) << ": " << lines.Message;
      }
    }
  }
  for (const nurbs::FaceRegion& face : work.Result.Faces)
  {
    const bool isSeen = face.IsWhole || face.VisibleArea > 0.0;
    this->VisibleArea += face.VisibleArea;
    this->NumberOfVisibleFaces += face.IsWhole;
    this->NumberOfPartialFaces += isSeen && !face.IsWhole;
    this->NumberOfHiddenFaces += !isSeen;
    this->NumberOfInexactFaces += face.IsInexact;
  }
  this->NumberOfCells = vtkIdType(work.Result.Cells);
  this->NumberOfPiercingPairs = vtkIdType(work.Result.Piercing.size());
  if (this->NumberOfFailedFaces > 0)
  {
    vtkWarningMacro(<< this->NumberOfFailedFaces << " of " << this->NumberOfFaces
                    << " faces have no silhouettes or gaps in them:" << failed.str());
  }
  if (!work.Result.Piercing.empty())
  {
    std::ostringstream named;
    for (std::size_t k = 0; k < work.Result.Piercing.size() && k < MaxNamed; ++k)
    {
      const auto& pair = work.Result.Piercing[k];
      named << "\n  " << faceName(pair[0]) << " and " << faceName(pair[1]);
    }
    vtkWarningMacro(<< work.Result.Piercing.size()
                    << " pairs of faces pierce or touch each other where they are seen; the border "
                       "between them is not exact there:"
                    << named.str());
  }
}

void vtkNURBSVisibleRegions::ClearResults()
{
  this->NumberOfVisibleFaces = this->NumberOfPartialFaces = this->NumberOfHiddenFaces = 0;
  this->NumberOfInexactFaces = this->NumberOfVisibleLines = 0;
  this->NumberOfCells = this->NumberOfPiercingPairs = 0;
  this->VisibleArea = 0.0;
  this->ClearCounts();
}

void vtkNURBSVisibleRegions::FillOutputs(
  const Work& work, vtkDataObject* input, vtkInformationVector* outputs)
{
  vtkNURBSRegionOutput::LineChoice choice;
  choice.Kinds[0] = this->GetSilhouettes();
  choice.Kinds[1] = this->GetBoundaryEdges();
  choice.Kinds[2] = this->GetSharpEdges();
  choice.Kinds[3] = this->GetSmoothEdges();
  choice.Kinds[4] = this->Intersections;
  choice.Hidden = this->HiddenLines;
  choice.Project = this->ProjectLines;
  for (int port = 0; port < 2; ++port)
  {
    vtkNURBSModelPool::CopyTree(input, vtkDataObject::GetData(outputs, port));
  }
  const auto grids =
    work.Pool.MakeLeaves<vtkUnstructuredGrid>(input, vtkDataObject::GetData(outputs, 0));
  const auto lines = work.Pool.MakeLeaves<vtkPolyData>(input, vtkDataObject::GetData(outputs, 1));
  for (std::size_t k = 0; k < work.Pool.Leaves.size(); ++k)
  {
    if (this->ComputeRegions)
    {
      vtkNURBSRegionOutput::FillModel(work.Result, work.Pool.Leaves[k], grids[k]);
    }
    vtkNURBSRegionOutput::FillLines(work.Result, work.Pool.Leaves[k], choice, lines[k]);
    this->NumberOfLines += lines[k]->GetNumberOfLines();
  }
  this->NumberOfVisibleLines = std::count_if(work.Result.Drawn.begin(), work.Result.Drawn.end(),
    [&](const nurbs::DrawnLine& line) { return line.Visible && choice.Kinds[int(line.Kind)]; });
}

// False: it was aborted.
bool vtkNURBSVisibleRegions::MakeOutputs(
  vtkDataObject* input, vtkNURBSPieces& pieces, vtkInformationVector* outputs)
{
  vtkNURBSPieces::ThrowIf(this->CheckOptions());
  vtkDataObject* whole = pieces.Gather(input);
  if (!(this->Before && this->Before->Pool.IsUpToDate(whole)))
  {
    this->Before = std::make_unique<Kept>();
    vtkNURBSPieces::ThrowIf(this->Before->Pool.Collect(whole));
  }
  Work work(this->Before->Pool, pieces);
  this->Make(work);
  if (work.Result.Aborted || this->GetAbortExecute())
  {
    return false;
  }
  this->Summarize(work);
  this->FillOutputs(work, whole, outputs);
  pieces.Keep(vtkDataObject::GetData(outputs, 0));
  pieces.Keep(vtkDataObject::GetData(outputs, 1));
  return true;
}

int vtkNURBSVisibleRegions::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const double start = Now();
  this->ClearResults();
  vtkDataObject* input = vtkDataObject::GetData(inputs[0]);
  const vtkNURBSParallelScope parallel;
  vtkNURBSPieces pieces(request, outputs);
  std::string problem;
  const auto outcome =
    pieces.Run([&]() { return this->MakeOutputs(input, pieces, outputs); }, problem);
  if (outcome == vtkNURBSPieces::FAILED || pieces.IsParallel())
  {
    this->Before = nullptr; // What was gathered goes with the pieces.
  }
  this->SetErrorCode(
    outcome == vtkNURBSPieces::FAILED ? vtkErrorCode::UserError : vtkErrorCode::NoError);
  if (outcome == vtkNURBSPieces::DONE)
  {
    this->Seconds = Now() - start;
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

void vtkNURBSVisibleRegions::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ViewUp: " << this->ViewUp[0] << " " << this->ViewUp[1] << " " << this->ViewUp[2]
     << "\n";
  os << indent << "ComputeRegions: " << this->ComputeRegions << "\n";
  os << indent << "Region: " << (this->Region == HIDDEN_REGION ? "hidden" : "visible") << "\n";
  os << indent << "BothSides: " << this->BothSides << "\n";
  os << indent << "Intersections: " << this->Intersections << "\n";
  os << indent << "HiddenLines: " << this->HiddenLines << "\n";
  os << indent << "ProjectLines: " << this->ProjectLines << "\n";
  os << indent << "Clustering: " << this->Clustering << "\n";
  os << indent << "NumberOfVisibleFaces: " << this->NumberOfVisibleFaces << "\n";
  os << indent << "NumberOfPartialFaces: " << this->NumberOfPartialFaces << "\n";
  os << indent << "NumberOfHiddenFaces: " << this->NumberOfHiddenFaces << "\n";
  os << indent << "NumberOfInexactFaces: " << this->NumberOfInexactFaces << "\n";
  os << indent << "VisibleArea: " << this->VisibleArea << "\n";
  os << indent << "NumberOfVisibleLines: " << this->NumberOfVisibleLines << "\n";
  os << indent << "NumberOfCells: " << this->NumberOfCells << "\n";
  os << indent << "NumberOfPiercingPairs: " << this->NumberOfPiercingPairs << "\n";
}
