// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSSilhouette.h"

#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkNURBSLineOutput.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelPool.h"
#include "vtkNURBSParallel.h"
#include "vtkNURBSPieces.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <sstream>

vtkStandardNewMacro(vtkNURBSSilhouette);

struct vtkNURBSSilhouette::Work
{
  Work(vtkInformation* request, vtkInformationVector* outputs)
    : Pieces(request, outputs)
  {}
  vtkNURBSPieces Pieces;
  vtkNURBSModelPool Pool;
  nurbs::SilhouetteOptions Options;
  nurbs::Silhouettes Result;
};

vtkNURBSSilhouette::vtkNURBSSilhouette() = default;

vtkNURBSSilhouette::~vtkNURBSSilhouette() = default;

int vtkNURBSSilhouette::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  return vtkNURBSModelPool::MakeOutputs(vtkDataObject::GetData(inputs[0]), outputs, 1) ? 1 : 0;
}

void vtkNURBSSilhouette::Make(Work& work)
{
  nurbs::SilhouetteOptions& options = work.Options;
  const vtkNURBSModelPool& pool = work.Pool;
  options.View = this->MakeViewer();
  options.Precision = this->AbsolutePrecision(pool);
  options.FeatureAngle = vtkMath::RadiansFromDegrees(this->GetFeatureAngle());
  const bool kinds[] = { this->GetSilhouettes(), this->GetBoundaryEdges(), this->GetSharpEdges(),
    this->GetSmoothEdges() };
  std::copy(std::begin(kinds), std::end(kinds), options.Kinds);
  options.Parts = PartsOf(pool);
  options.Parallel = vtkNURBSParallelFor;
  options.Share = work.Pieces.GetShare();
  // Processes talk in this thread only: MPI need not know of others.
  vtkNURBSRunWithProgress(this, work.Pieces.IsParallel() || IsQuick(pool), 0.0, 0.95,
    [&](const std::function<bool(double)>& progress) {
      options.Progress = progress;
      work.Result = nurbs::MakeSilhouettes(pool.Model, pool.FaceErrors, options);
    });
}

// Counts, and names faces that were not done in one warning.
void vtkNURBSSilhouette::Summarize(const Work& work)
{
  using nurbs::SilhouetteStatus;
  std::ostringstream named;
  int count = 0;
  for (const vtkNURBSModelPool::Leaf& leaf : work.Pool.Leaves)
  {
    for (std::size_t f = leaf.FirstFace; f < leaf.LastFace; ++f)
    {
      const nurbs::FaceSilhouette& face = work.Result.Faces[f];
      this->NumberOfVisiblePatches += face.Patches[0];
      this->NumberOfInvisiblePatches += face.Patches[1];
      this->NumberOfPartialPatches += face.Patches[2];
      this->NumberOfEdgeOnPatches += face.Patches[3];
      ++this->NumberOfFaces;
      this->NumberOfSingularFaces += face.Status == SilhouetteStatus::Singular;
      this->NumberOfCappedFaces += face.Status == SilhouetteStatus::Capped;
      this->NumberOfFailedFaces += face.Status == SilhouetteStatus::Failed;
      if (face.Status >= SilhouetteStatus::Capped && ++count <= MaxNamed)
      {
        named << "\n  face " << vtkNURBSModel::GetFaceId(leaf.Grid, vtkIdType(f - leaf.FirstFace))
              << (face.Status == SilhouetteStatus::Failed ? " failed: " : " capped: ")
              << face.Message;
      }
    }
  }
  this->NumberOfComponents = work.Result.Chains[SILHOUETTE];
  this->NumberOfInexactPoints = work.Result.InexactPoints;
  if (count > 0)
  {
    vtkWarningMacro(<< this->NumberOfFailedFaces << " of " << this->NumberOfFaces
                    << " faces have no silhouette, " << this->NumberOfCappedFaces
                    << " have one with gaps:" << named.str()
                    << (count > MaxNamed ? "\n  and " + std::to_string(count - MaxNamed) + " more"
                                         : ""));
  }
}

void vtkNURBSSilhouette::ClearResults()
{
  this->NumberOfVisiblePatches = this->NumberOfInvisiblePatches = 0;
  this->NumberOfPartialPatches = this->NumberOfEdgeOnPatches = 0;
  this->NumberOfComponents = this->NumberOfPoints = this->NumberOfInexactPoints = 0;
  this->NumberOfSingularFaces = this->NumberOfCappedFaces = 0;
  this->ClearCounts();
}

void vtkNURBSSilhouette::FillOutput(Work& work, vtkDataObject* whole, vtkDataObject* output)
{
  vtkNURBSModelPool::CopyTree(whole, output);
  const std::vector<vtkPolyData*> leaves = work.Pool.MakeLeaves(whole, output);
  for (std::size_t k = 0; k < leaves.size(); ++k)
  {
    const vtkNURBSModelPool::Leaf& leaf = work.Pool.Leaves[k];
    vtkNURBSLineOutput::Range range;
    range.Result = &work.Result;
    range.First = leaf.FirstFace;
    range.Last = leaf.LastFace;
    range.FirstEdge = leaf.FirstEdge;
    vtkNURBSLineOutput::FillLines(range, leaf.Grid, leaves[k]);
    this->NumberOfLines += leaves[k]->GetNumberOfLines();
    this->NumberOfPoints += leaves[k]->GetNumberOfPoints();
  }
}

int vtkNURBSSilhouette::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const double start = Now();
  this->ClearResults();
  vtkDataObject* input = vtkDataObject::GetData(inputs[0]);
  vtkDataObject* output = vtkDataObject::GetData(outputs);
  const vtkNURBSParallelScope parallel;
  Work work(request, outputs);
  std::string problem;
  const auto outcome = work.Pieces.Run(
    [&]() {
      vtkNURBSPieces::ThrowIf(this->CheckOptions());
      vtkDataObject* whole = work.Pieces.Gather(input);
      vtkNURBSPieces::ThrowIf(work.Pool.Collect(whole));
      this->Make(work);
      if (work.Result.Aborted)
      {
        return false;
      }
      this->Summarize(work);
      this->FillOutput(work, whole, output);
      work.Pieces.Keep(output);
      return true;
    },
    problem);
  this->SetErrorCode(
    outcome == vtkNURBSPieces::FAILED ? vtkErrorCode::UserError : vtkErrorCode::NoError);
  if (outcome == vtkNURBSPieces::DONE)
  {
    this->Seconds = Now() - start;
    this->UpdateProgress(1.0);
    return 1;
  }
  this->ClearResults();
  vtkNURBSModelPool::CopyTree(input, output);
  if (outcome == vtkNURBSPieces::ABORTED)
  {
    return 1;
  }
  vtkErrorMacro(<< problem);
  return 0;
}

void vtkNURBSSilhouette::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "NumberOfVisiblePatches: " << this->NumberOfVisiblePatches << "\n";
  os << indent << "NumberOfInvisiblePatches: " << this->NumberOfInvisiblePatches << "\n";
  os << indent << "NumberOfPartialPatches: " << this->NumberOfPartialPatches << "\n";
  os << indent << "NumberOfEdgeOnPatches: " << this->NumberOfEdgeOnPatches << "\n";
  os << indent << "NumberOfComponents: " << this->NumberOfComponents << "\n";
  os << indent << "NumberOfPoints: " << this->NumberOfPoints << "\n";
  os << indent << "NumberOfInexactPoints: " << this->NumberOfInexactPoints << "\n";
  os << indent << "NumberOfSingularFaces: " << this->NumberOfSingularFaces << "\n";
  os << indent << "NumberOfCappedFaces: " << this->NumberOfCappedFaces << "\n";
}
