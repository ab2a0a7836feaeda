// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSSilhouette.h"

#include "ModelExtent.h"
#include "vtkCamera.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkNURBSLineOutput.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelPool.h"
#include "vtkNURBSParallel.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <sstream>

vtkStandardNewMacro(vtkNURBSSilhouette);
vtkCxxSetObjectMacro(vtkNURBSSilhouette, Camera, vtkCamera);

namespace
{

constexpr int MaxNamedFaces = 8; // in the warning
constexpr std::chrono::milliseconds ProgressInterval(20);
constexpr std::size_t QuickFaces = 8; // Models that take no time worth a report of progress.

double Now()
{
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

} // namespace

struct vtkNURBSSilhouette::Work
{
  vtkNURBSModelPool Pool;
  nurbs::SilhouetteOptions Options;
  nurbs::Silhouettes Result;
};

vtkNURBSSilhouette::vtkNURBSSilhouette() = default;

vtkNURBSSilhouette::~vtkNURBSSilhouette()
{
  this->SetCamera(nullptr);
}

vtkMTimeType vtkNURBSSilhouette::GetMTime()
{
  const vtkMTimeType own = this->Superclass::GetMTime();
  return this->Camera ? std::max(own, this->Camera->GetMTime()) : own;
}

int vtkNURBSSilhouette::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

int vtkNURBSSilhouette::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  return vtkNURBSModelPool::MakeOutputs(vtkDataObject::GetData(inputs[0]), outputs, 1) ? 1 : 0;
}

std::string vtkNURBSSilhouette::CheckOptions() const
{
  std::ostringstream problem;
  if (!(this->Precision > 0.0) || !std::isfinite(this->Precision))
  {
    problem << "Precision must be positive, but is " << this->Precision;
  }
  else if (!(this->FeatureAngle > 0.0 && this->FeatureAngle <= 180.0))
  {
    problem << "FeatureAngle must be in (0, 180], but is " << this->FeatureAngle;
  }
  return problem.str();
}

// Fills in where the model is seen from, and makes the lines in another thread, so that observers of
// the progress run in this one and can abort it.
void vtkNURBSSilhouette::Make(Work& work)
{
  nurbs::SilhouetteOptions& options = work.Options;
  const double* place = this->Projection == PERSPECTIVE ? this->EyePoint : this->Direction;
  options.View.Perspective = this->Projection == PERSPECTIVE;
  double back[3];
  if (this->Camera)
  {
    options.View.Perspective = !this->Camera->GetParallelProjection();
    this->Camera->GetDirectionOfProjection(back);
    vtkMath::MultiplyScalar(back, -1.0);
    place = options.View.Perspective ? this->Camera->GetPosition() : back;
  }
  options.View.Place = nurbs::Vec3(place[0], place[1], place[2]);
  options.FeatureAngle = vtkMath::RadiansFromDegrees(this->FeatureAngle);
  const bool kinds[] = { this->Silhouettes, this->BoundaryEdges, this->SharpEdges,
    this->SmoothEdges };
  std::copy(std::begin(kinds), std::end(kinds), options.Kinds);
  options.Parallel = vtkNURBSParallelFor;
  const vtkNURBSModelPool& pool = work.Pool;
  const double size =
    nurbs::Diagonal(nurbs::FaceBoxes(pool.Model, pool.FaceErrors, vtkNURBSParallelFor));
  options.Precision =
    this->Precision * (this->PrecisionMode == RELATIVE && size > 0.0 ? size : 1.0);
  options.Parts.resize(pool.Model.Faces.size());
  for (std::size_t k = 0; k < pool.Leaves.size(); ++k)
  {
    std::fill(options.Parts.begin() + pool.Leaves[k].FirstFace,
      options.Parts.begin() + pool.Leaves[k].LastFace, int(k));
  }
  std::atomic<double> progress{ 0.0 };
  std::atomic<bool> abort{ false };
  options.Progress = [&](double done) {
    progress = done;
    return !abort;
  };
  const auto report = [&]() {
    this->UpdateProgress(0.95 * progress);
    abort = abort || this->GetAbortExecute() != 0;
  };
  report();
  const bool quick = pool.Model.Faces.size() <= QuickFaces;
  auto result = std::async(quick ? std::launch::deferred : std::launch::async,
    [&]() { return nurbs::MakeSilhouettes(pool.Model, pool.FaceErrors, options); });
  while (!quick && result.wait_for(ProgressInterval) != std::future_status::ready)
  {
    report();
  }
  work.Result = result.get();
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
      if (face.Status >= SilhouetteStatus::Capped && ++count <= MaxNamedFaces)
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
                    << (count > MaxNamedFaces
                           ? "\n  and " + std::to_string(count - MaxNamedFaces) + " more"
                           : ""));
  }
}

void vtkNURBSSilhouette::ClearResults()
{
  this->NumberOfVisiblePatches = this->NumberOfInvisiblePatches = 0;
  this->NumberOfPartialPatches = this->NumberOfEdgeOnPatches = 0;
  this->NumberOfComponents = this->NumberOfLines = this->NumberOfPoints = 0;
  this->NumberOfInexactPoints = this->NumberOfFaces = this->NumberOfSingularFaces = 0;
  this->NumberOfCappedFaces = this->NumberOfFailedFaces = 0;
  this->Seconds = 0.0;
}

int vtkNURBSSilhouette::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const double start = Now();
  this->ClearResults();
  vtkDataObject* input = vtkDataObject::GetData(inputs[0]);
  vtkDataObject* output = vtkDataObject::GetData(outputs);
  vtkNURBSModelPool::CopyTree(input, output);
  const vtkNURBSParallelScope parallel;
  Work work;
  try
  {
    std::string problem = this->CheckOptions();
    problem = problem.empty() ? work.Pool.Collect(input) : problem;
    if (!problem.empty())
    {
      throw nurbs::Error(problem);
    }
    this->Make(work);
  }
  catch (const std::exception& problem)
  {
    vtkErrorMacro(<< problem.what());
    this->SetErrorCode(vtkErrorCode::UserError);
    return 0;
  }
  this->SetErrorCode(vtkErrorCode::NoError);
  if (work.Result.Aborted)
  {
    return 1;
  }
  this->Summarize(work);
  const std::vector<vtkPolyData*> leaves = work.Pool.MakeLeaves(input, output);
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
  this->Seconds = Now() - start;
  this->UpdateProgress(1.0);
  return 1;
}

void vtkNURBSSilhouette::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Projection: " << (this->Projection == PERSPECTIVE ? "perspective" : "parallel")
     << "\n";
  os << indent << "Direction: " << this->Direction[0] << " " << this->Direction[1] << " "
     << this->Direction[2] << "\n";
  os << indent << "EyePoint: " << this->EyePoint[0] << " " << this->EyePoint[1] << " "
     << this->EyePoint[2] << "\n";
  os << indent << "Camera: " << this->Camera << "\n";
  os << indent << "PrecisionMode: " << (this->PrecisionMode == ABSOLUTE ? "absolute" : "relative")
     << "\n";
  os << indent << "Precision: " << this->Precision << "\n";
  os << indent << "FeatureAngle: " << this->FeatureAngle << "\n";
  os << indent << "Silhouettes: " << this->Silhouettes << "\n";
  os << indent << "BoundaryEdges: " << this->BoundaryEdges << "\n";
  os << indent << "SharpEdges: " << this->SharpEdges << "\n";
  os << indent << "SmoothEdges: " << this->SmoothEdges << "\n";
  os << indent << "NumberOfVisiblePatches: " << this->NumberOfVisiblePatches << "\n";
  os << indent << "NumberOfInvisiblePatches: " << this->NumberOfInvisiblePatches << "\n";
  os << indent << "NumberOfPartialPatches: " << this->NumberOfPartialPatches << "\n";
  os << indent << "NumberOfEdgeOnPatches: " << this->NumberOfEdgeOnPatches << "\n";
  os << indent << "NumberOfComponents: " << this->NumberOfComponents << "\n";
  os << indent << "NumberOfLines: " << this->NumberOfLines << "\n";
  os << indent << "NumberOfPoints: " << this->NumberOfPoints << "\n";
  os << indent << "NumberOfInexactPoints: " << this->NumberOfInexactPoints << "\n";
  os << indent << "NumberOfFaces: " << this->NumberOfFaces << "\n";
  os << indent << "NumberOfSingularFaces: " << this->NumberOfSingularFaces << "\n";
  os << indent << "NumberOfCappedFaces: " << this->NumberOfCappedFaces << "\n";
  os << indent << "NumberOfFailedFaces: " << this->NumberOfFailedFaces << "\n";
  os << indent << "Seconds: " << this->Seconds << "\n";
}
