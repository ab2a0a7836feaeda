// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSWaveletLOD.h"

#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNURBSLevelOutput.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelPool.h"
#include "vtkNURBSParallel.h"
#include "vtkNURBSPieces.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>

vtkStandardNewMacro(vtkNURBSWaveletLOD);

namespace
{

constexpr int MaxNamedFaces = 8;      // in the warning
constexpr std::size_t QuickFaces = 8; // Models that take no time worth a report of progress.

double Now()
{
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

} // namespace

// What is kept from one Update to the next, and what it was made with.
struct vtkNURBSWaveletLOD::Pyramids
{
  Pyramids(vtkInformation* request, vtkInformationVector* outputs)
    : Pieces(request, outputs)
  {}
  vtkNURBSPieces Pieces;
  vtkDataObject* Input = nullptr; ///< Of all processes; owned by Pieces or by whom it came from.
  vtkNURBSModelPool Pool;
  double Diagonal = 1.0;
  nurbs::WaveletOptions Options;
  std::unique_ptr<nurbs::WaveletModel> Model;
};

struct vtkNURBSWaveletLOD::Meshes
{
  nurbs::WaveletMeshes Result;
  double Limit = 0.0;
};

vtkNURBSWaveletLOD::vtkNURBSWaveletLOD() = default;
vtkNURBSWaveletLOD::~vtkNURBSWaveletLOD() = default;

int vtkNURBSWaveletLOD::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

int vtkNURBSWaveletLOD::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  return vtkNURBSModelPool::MakeOutputs(vtkDataObject::GetData(inputs[0]), outputs, 1) ? 1 : 0;
}

// What the options can't be; throws nurbs::Error.
void vtkNURBSWaveletLOD::CheckOptions() const
{
  const auto check = [](const char* name, double value) {
    if (!(value > 0.0) || !std::isfinite(value))
    {
      std::ostringstream text;
      text << name << " must be positive, but is " << value;
      throw nurbs::Error(text.str());
    }
  };
  check("FinestTolerance", this->FinestTolerance);
  if (this->Mode == MAXIMUM_ERROR)
  {
    check("MaximumError", this->MaximumError);
  }
}

void vtkNURBSWaveletLOD::Analyse(vtkDataObject* input, std::unique_ptr<Pyramids> work)
{
  nurbs::WaveletOptions options;
  options.Kind = this->Wavelet == HAAR ? nurbs::Wavelet::Haar
    : this->Wavelet == LIFTED          ? nurbs::Wavelet::Lifted
                                       : nurbs::Wavelet::Interpolating;
  options.Finest.MaximumSamples = this->MaximumSamples;
  options.Parallel = vtkNURBSParallelFor;
  const auto scale = [&](const Pyramids& pyramids) {
    return this->ToleranceMode == RELATIVE ? pyramids.Diagonal : 1.0;
  };
  if (this->Kept && this->Kept->Pieces.IsParallel() == work->Pieces.IsParallel() &&
    this->Kept->Pieces.IsUpToDate(input) && this->Kept->Options.Kind == options.Kind &&
    this->Kept->Options.Finest.MaximumSamples == options.Finest.MaximumSamples &&
    this->Kept->Options.Finest.Tolerance == scale(*this->Kept) * this->FinestTolerance)
  {
    return;
  }
  const double start = Now();
  this->Kept.reset();
  work->Input = work->Pieces.Gather(input);
  vtkNURBSPieces::ThrowIf(work->Pool.Collect(work->Input));
  const double diagonal =
    nurbs::SampledDiagonal(work->Pool.Model, work->Pool.FaceErrors, vtkNURBSParallelFor);
  work->Diagonal = diagonal > 0.0 ? diagonal : 1.0;
  options.Finest.Tolerance = scale(*work) * this->FinestTolerance;
  const bool quick = work->Pool.Model.Faces.size() <= QuickFaces;
  vtkNURBSRunWithProgress(this, quick, 0.0, 0.6, [&](const std::function<bool(double)>& progress) {
    options.Progress = progress;
    work->Model =
      std::make_unique<nurbs::WaveletModel>(work->Pool.Model, work->Pool.FaceErrors, options);
  });
  work->Model->SetProgress(nullptr);
  options.Progress = nullptr;
  work->Options = options;
  this->Kept = std::move(work);
  this->AnalyseSeconds = Now() - start;
}

void vtkNURBSWaveletLOD::Mesh(Meshes& meshes)
{
  meshes.Limit =
    (this->ToleranceMode == RELATIVE ? this->Kept->Diagonal : 1.0) * this->MaximumError;
  nurbs::WaveletModel& model = *this->Kept->Model;
  const bool quick = this->Kept->Pool.Model.Faces.size() <= QuickFaces;
  vtkNURBSRunWithProgress(this, quick, 0.6, 0.95, [&](const std::function<bool(double)>& progress) {
    model.SetProgress(progress);
    meshes.Result = this->Mode == MAXIMUM_ERROR ? model.MaximumError(meshes.Limit)
      : this->Mode == TRIANGLE_BUDGET           ? model.TriangleBudget(this->TriangleBudget)
                                                : model.Level(this->Level);
  });
  model.SetProgress(nullptr);
}

void vtkNURBSWaveletLOD::FillOutputs(Meshes& meshes, vtkDataObject* output)
{
  const vtkNURBSModelPool& pool = this->Kept->Pool;
  vtkNURBSModelPool::CopyTree(this->Kept->Input, output);
  const std::vector<vtkPolyData*> leaves = pool.MakeLeaves(this->Kept->Input, output);
  for (std::size_t k = 0; k < pool.Leaves.size(); ++k)
  {
    vtkNURBSLevelOutput::Range range;
    range.Model = this->Kept->Model.get();
    range.Meshes = &meshes.Result;
    range.First = pool.Leaves[k].FirstFace;
    range.Last = pool.Leaves[k].LastFace;
    vtkNURBSLevelOutput::FillMesh(range, pool.Leaves[k].Grid, leaves[k]);
    this->NumberOfTriangles += leaves[k]->GetNumberOfPolys();
    this->NumberOfPoints += leaves[k]->GetNumberOfPoints();
  }
  this->Kept->Pieces.Keep(output);
}

// Counts the faces by status and names those that were not done in one warning.
void vtkNURBSWaveletLOD::Summarize(const Meshes& meshes)
{
  const vtkNURBSModelPool& pool = this->Kept->Pool;
  this->NumberOfLevels = this->Kept->Model->Levels();
  this->NumberOfSamples = this->Kept->Model->SampleCount();
  this->NumberOfFaces = vtkIdType(meshes.Result.Faces.size());
  std::ostringstream named;
  int count = 0;
  for (const vtkNURBSModelPool::Leaf& leaf : pool.Leaves)
  {
    for (std::size_t f = leaf.FirstFace; f < leaf.LastFace; ++f)
    {
      const nurbs::WaveletMesh& mesh = meshes.Result.Faces[f];
      this->ErrorBound = std::max(this->ErrorBound, mesh.Error);
      this->NumberOfRepairedFaces += mesh.Status == nurbs::WaveletStatus::Repaired;
      this->NumberOfCappedFaces += mesh.Status == nurbs::WaveletStatus::Capped;
      this->NumberOfFailedFaces += mesh.Status == nurbs::WaveletStatus::Failed;
      if (mesh.Status < nurbs::WaveletStatus::Capped || ++count > MaxNamedFaces)
      {
        continue;
      }
      named << "\n  face " << vtkNURBSModel::GetFaceId(leaf.Grid, vtkIdType(f - leaf.FirstFace))
            << (mesh.Status == nurbs::WaveletStatus::Failed ? " failed: " : " capped: ")
            << mesh.Message;
    }
  }
  if (count > 0)
  {
    vtkWarningMacro(<< this->NumberOfFailedFaces << " of " << this->NumberOfFaces
                    << " faces have no triangles, " << this->NumberOfCappedFaces
                    << " exceed the maximum error:" << named.str()
                    << (count > MaxNamedFaces
                           ? "\n  and " + std::to_string(count - MaxNamedFaces) + " more"
                           : ""));
  }
}

void vtkNURBSWaveletLOD::ClearResults()
{
  this->NumberOfLevels = 0;
  this->NumberOfTriangles = this->NumberOfPoints = this->NumberOfSamples = 0;
  this->NumberOfFaces = this->NumberOfRepairedFaces = 0;
  this->NumberOfCappedFaces = this->NumberOfFailedFaces = 0;
  this->ErrorBound = this->AnalyseSeconds = this->MeshSeconds = 0.0;
}

bool vtkNURBSWaveletLOD::Make(
  vtkDataObject* input, std::unique_ptr<Pyramids> work, vtkDataObject* output)
{
  const double start = Now();
  this->CheckOptions();
  this->Analyse(input, std::move(work));
  if (this->Kept->Model->IsAborted())
  {
    return false;
  }
  Meshes meshes;
  this->Mesh(meshes);
  if (meshes.Result.Aborted)
  {
    return false;
  }
  if (!meshes.Result.WithinBudget)
  {
    vtkWarningMacro("The coarsest meshes have more than " << this->TriangleBudget << " triangles");
  }
  this->Summarize(meshes);
  this->FillOutputs(meshes, output);
  this->MeshSeconds = Now() - start - this->AnalyseSeconds;
  return true;
}

int vtkNURBSWaveletLOD::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->ClearResults();
  vtkDataObject* input = vtkDataObject::GetData(inputs[0]);
  vtkDataObject* output = vtkDataObject::GetData(outputs);
  const vtkNURBSParallelScope parallel;
  const vtkNURBSPieces pieces(request, outputs);
  std::string problem;
  const auto outcome = pieces.Run(
    [&]() { return this->Make(input, std::make_unique<Pyramids>(request, outputs), output); },
    problem);
  this->SetErrorCode(
    outcome == vtkNURBSPieces::FAILED ? vtkErrorCode::UserError : vtkErrorCode::NoError);
  if (outcome == vtkNURBSPieces::DONE)
  {
    this->UpdateProgress(1.0);
    return 1;
  }
  // Meshing that is aborted leaves the analysis for the next time, where one process needs it alone.
  if (outcome == vtkNURBSPieces::FAILED ||
    (this->Kept && (this->Kept->Pieces.IsParallel() || this->Kept->Model->IsAborted())))
  {
    this->Kept.reset();
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

void vtkNURBSWaveletLOD::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  static const char* const wavelets[] = { "interpolating", "lifted", "Haar" };
  static const char* const modes[] = { "level", "maximum error", "triangle budget" };
  os << indent << "Wavelet: " << wavelets[this->Wavelet] << "\n";
  os << indent << "Mode: " << modes[this->Mode] << "\n";
  os << indent << "Level: " << this->Level << "\n";
  os << indent << "ToleranceMode: " << (this->ToleranceMode == ABSOLUTE ? "absolute" : "relative")
     << "\n";
  os << indent << "MaximumError: " << this->MaximumError << "\n";
  os << indent << "TriangleBudget: " << this->TriangleBudget << "\n";
  os << indent << "FinestTolerance: " << this->FinestTolerance << "\n";
  os << indent << "MaximumSamples: " << this->MaximumSamples << "\n";
  os << indent << "NumberOfLevels: " << this->NumberOfLevels << "\n";
  os << indent << "NumberOfTriangles: " << this->NumberOfTriangles << "\n";
  os << indent << "NumberOfPoints: " << this->NumberOfPoints << "\n";
  os << indent << "ErrorBound: " << this->ErrorBound << "\n";
  os << indent << "NumberOfSamples: " << this->NumberOfSamples << "\n";
  os << indent << "NumberOfFaces: " << this->NumberOfFaces << "\n";
  os << indent << "NumberOfRepairedFaces: " << this->NumberOfRepairedFaces << "\n";
  os << indent << "NumberOfCappedFaces: " << this->NumberOfCappedFaces << "\n";
  os << indent << "NumberOfFailedFaces: " << this->NumberOfFailedFaces << "\n";
  os << indent << "AnalyseSeconds: " << this->AnalyseSeconds << "\n";
  os << indent << "MeshSeconds: " << this->MeshSeconds << "\n";
}
