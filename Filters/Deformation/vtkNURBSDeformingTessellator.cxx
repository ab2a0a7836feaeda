// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSDeformingTessellator.h"

#include "ModelExtent.h"
#include "vtkCamera.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkNURBSDeformingOutput.h"
#include "vtkNURBSFrameModel.h"
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

vtkStandardNewMacro(vtkNURBSDeformingTessellator);
vtkCxxSetObjectMacro(vtkNURBSDeformingTessellator, Camera, vtkCamera);

namespace
{

constexpr int MaxNamedFaces = 8;     // in the warning
constexpr std::size_t MaxFormer = 8; // Times that faces are replaced before all are.
constexpr double SameSide = 1e-7;    // Of the diagonal: sides that coincide.
constexpr double Mebibyte = 1048576.0;

double Now()
{
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

bool IsSame(const nurbs::MeshViewer& a, const nurbs::MeshViewer& b)
{
  return a.Eye == b.Eye && a.Direction == b.Direction && a.Parallel == b.Parallel &&
    a.FullDetail == b.FullDetail && a.SightAngle == b.SightAngle &&
    a.LeastImportance == b.LeastImportance;
}

// Adds what an earlier step of the same frame did.
void Include(const nurbs::FrameReport& earlier, nurbs::FrameReport& report)
{
  report.TopologyChanged = report.TopologyChanged || earlier.TopologyChanged;
  report.InsertedVertices += earlier.InsertedVertices;
  report.DeletedVertices += earlier.DeletedVertices;
  report.AdaptSeconds += earlier.AdaptSeconds;
  report.RebuildSeconds += earlier.RebuildSeconds;
  if (earlier.FirstTriangle >= 0)
  {
    report.FirstTriangle = report.FirstTriangle < 0
      ? earlier.FirstTriangle
      : std::min(report.FirstTriangle, earlier.FirstTriangle);
    report.LastTriangle = std::max(report.LastTriangle, earlier.LastTriangle);
  }
}

std::int64_t ControlPoints(const nurbs::Model& model)
{
  std::int64_t count = 0;
  for (const nurbs::Face& face : model.Faces)
  {
    count += face.Geometry.Size();
  }
  return count;
}

} // namespace

// What is kept of one model. The kernel goes first, as it works on the others' arrays.
struct vtkNURBSDeformingTessellator::Leaf
{
  explicit Leaf(vtkUnstructuredGrid* grid)
    : Source(std::make_unique<vtkNURBSFrameModel>(grid))
  {}

  std::unique_ptr<vtkNURBSFrameModel> Source;
  /// Of frames before faces were replaced: the kernel's other faces are views into them.
  std::vector<std::unique_ptr<vtkNURBSFrameModel>> Former;
  vtkNURBSDeformingOutput Output;
  std::unique_ptr<nurbs::DeformingModel> Kernel;
  nurbs::FrameReport Report;
  nurbs::MeshViewer Viewer; ///< Of the last frame, if there was one.
  bool HadViewer = false;
  bool HalfDone = false; ///< The kernel is at work on the mesh.

  void SetViewer(const Frame& frame);
  bool HasViewerOf(const Frame& frame) const;
};

// What one Update works on.
struct vtkNURBSDeformingTessellator::Frame
{
  Frame(vtkInformation* request, vtkInformationVector* outputs)
    : Pieces(request, outputs)
  {}
  vtkNURBSPieces Pieces;
  vtkDataObject* Input = nullptr; ///< Of all processes.
  std::vector<vtkNURBSModelPool::Block> Blocks;
  std::vector<std::unique_ptr<Leaf>>
    Fresh; ///< Of models of another structure; null: it is the same.
  nurbs::DeformingOptions Options;
  std::int64_t Controls = 0; ///< Control points of all models.
  nurbs::MeshViewer Viewer;
  bool HasViewer = false;
  std::vector<std::string> Problems; ///< Why frames were refused.
  std::ostringstream FaceErrors;
  int BadFaces = 0;
  std::vector<double> LookSeconds; ///< What it took to see whether structures are the same.

  std::string ProblemText() const
  {
    std::string text;
    for (const std::string& problem : this->Problems)
    {
      text += "\n  " + problem;
    }
    return text;
  }
};

void vtkNURBSDeformingTessellator::Leaf::SetViewer(const Frame& frame)
{
  this->Viewer = frame.Viewer;
  this->HadViewer = frame.HasViewer;
}

bool vtkNURBSDeformingTessellator::Leaf::HasViewerOf(const Frame& frame) const
{
  return this->HadViewer == frame.HasViewer && IsSame(this->Viewer, frame.Viewer);
}

vtkNURBSDeformingTessellator::vtkNURBSDeformingTessellator() = default;

vtkNURBSDeformingTessellator::~vtkNURBSDeformingTessellator()
{
  this->SetCamera(nullptr);
}

vtkMTimeType vtkNURBSDeformingTessellator::GetMTime()
{
  const vtkMTimeType own = this->Superclass::GetMTime();
  return this->Camera ? std::max(own, this->Camera->GetMTime()) : own;
}

void vtkNURBSDeformingTessellator::Reset()
{
  this->Leaves.clear();
  this->Modified();
}

int vtkNURBSDeformingTessellator::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

int vtkNURBSDeformingTessellator::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  return vtkNURBSModelPool::MakeOutputs(vtkDataObject::GetData(inputs[0]), outputs, 1) ? 1 : 0;
}

// Finds the models and what the options ask for. Meshes that were made with others are forgotten.
void vtkNURBSDeformingTessellator::MakeFrame(vtkDataObject* input, Frame& frame)
{
  if (this->ToleranceMode == ABSOLUTE &&
    (!(this->AbsoluteTolerance > 0.0) || !std::isfinite(this->AbsoluteTolerance)))
  {
    std::ostringstream text;
    text << "AbsoluteTolerance must be positive, but is " << this->AbsoluteTolerance;
    throw nurbs::Error(text.str());
  }
  frame.Input = frame.Pieces.Gather(input);
  vtkNURBSPieces::ThrowIf(vtkNURBSModelPool::Find(frame.Input, frame.Blocks));
  const std::vector<double> with = { double(this->ToleranceMode),
    this->ToleranceMode == ABSOLUTE ? this->AbsoluteTolerance : this->Tolerance, this->Hysteresis,
    double(this->ResolutionRefinement), double(this->PatchSubdivisions),
    double(this->CoefficientStorage), double(this->MemoryLimit), double(this->TriangleBudget),
    this->LargestMove, double(this->JoinSides) };
  if (with != this->MadeWith)
  {
    this->Leaves.clear();
    this->MadeWith = with;
  }
  nurbs::DeformingOptions& options = frame.Options;
  options.Hysteresis = this->Hysteresis;
  options.Refine = this->ResolutionRefinement != 0;
  options.FixedDepth = this->PatchSubdivisions;
  options.KeepCoefficients = this->CoefficientStorage == EAGER;
  options.LargestMove = this->LargestMove;
  options.Parallel = vtkNURBSParallelFor;
  if (this->Camera)
  {
    frame.HasViewer = true;
    frame.Viewer.Eye = nurbs::Vec3(this->Camera->GetPosition());
    frame.Viewer.Direction = nurbs::Vec3(this->Camera->GetDirectionOfProjection());
    frame.Viewer.Parallel = this->Camera->GetParallelProjection() != 0;
    frame.Viewer.FullDetail =
      this->FullDetailDistance > 0.0 ? this->FullDetailDistance : this->Camera->GetDistance();
    frame.Viewer.SightAngle = vtkMath::RadiansFromDegrees(this->SightAngle);
    frame.Viewer.LeastImportance = this->LeastImportance;
  }
}

void vtkNURBSDeformingTessellator::FindNewLeaves(Frame& frame)
{
  this->Leaves.resize(frame.Blocks.size());
  frame.Fresh.resize(frame.Blocks.size());
  for (std::size_t k = 0; k < frame.Blocks.size(); ++k)
  {
    const double start = Now();
    vtkUnstructuredGrid* grid = frame.Blocks[k].Grid;
    if (!this->Leaves[k] || !this->Leaves[k]->Source->HasStructureOf(grid))
    {
      frame.Fresh[k] = std::make_unique<Leaf>(grid);
    }
    const Leaf& leaf = frame.Fresh[k] ? *frame.Fresh[k] : *this->Leaves[k];
    frame.Controls += ControlPoints(leaf.Source->GetModel());
    frame.LookSeconds.push_back(Now() - start);
  }
}

// Relative tolerances are of the last frame in which all models were new.
void vtkNURBSDeformingTessellator::SetDiagonal(const Frame& frame)
{
  std::vector<nurbs::Box3> boxes;
  for (const std::unique_ptr<Leaf>& leaf : frame.Fresh)
  {
    if (!leaf)
    {
      return;
    }
    if (leaf->Source->GetProblem().empty())
    {
      const std::vector<nurbs::Box3> some = nurbs::FaceBoxes(
        leaf->Source->GetModel(), leaf->Source->GetFaceErrors(), vtkNURBSParallelFor);
      boxes.insert(boxes.end(), some.begin(), some.end());
    }
  }
  const double diagonal = nurbs::Diagonal(boxes);
  if (diagonal > 0.0)
  {
    this->Diagonal = diagonal;
  }
}

// Collects what is wrong with a new model's faces for the warning.
void vtkNURBSDeformingTessellator::NoteFaceErrors(
  Frame& frame, std::size_t k, const std::vector<std::string>& errors)
{
  const vtkNURBSModelPool::Block& block = frame.Blocks[k];
  for (std::size_t f = 0; f < errors.size(); ++f)
  {
    if (!errors[f].empty() && ++frame.BadFaces <= MaxNamedFaces)
    {
      frame.FaceErrors << "\n  " << block.Name << "face "
                       << vtkNURBSModel::GetFaceId(block.Grid, vtkIdType(f)) << ": " << errors[f];
    }
  }
}

// Meshes a model anew. If that can't be done what was there before stays.
vtkNURBSDeformingTessellator::Deed vtkNURBSDeformingTessellator::MakeLeaf(
  Frame& frame, std::size_t k)
{
  const vtkNURBSModelPool::Block& block = frame.Blocks[k];
  Leaf& leaf = *frame.Fresh[k];
  const std::vector<std::string>& errors = leaf.Source->GetFaceErrors();
  const bool usable =
    std::any_of(errors.begin(), errors.end(), [](const std::string& e) { return e.empty(); });
  if (!leaf.Source->GetProblem().empty() || !usable)
  {
    frame.Problems.push_back(block.Name +
      (usable || !leaf.Source->GetProblem().empty() ? leaf.Source->GetProblem()
                                                    : "no face can be used: " + errors[0]));
    return NOTHING;
  }
  this->NoteFaceErrors(frame, k, errors);
  const double share = double(ControlPoints(leaf.Source->GetModel())) / double(frame.Controls);
  nurbs::DeformingOptions options = frame.Options;
  options.Tolerance =
    this->ToleranceMode == ABSOLUTE ? this->AbsoluteTolerance : this->Diagonal * this->Tolerance;
  options.MemoryLimit = std::int64_t(share * this->MemoryLimit * Mebibyte);
  options.TriangleBudget = this->TriangleBudget > 0
    ? std::max(std::int64_t(1), std::int64_t(share * double(this->TriangleBudget)))
    : 0;
  options.SideTolerance = this->JoinSides ? SameSide * this->Diagonal : -1.0;
  leaf.Kernel = std::make_unique<nurbs::DeformingModel>(
    leaf.Source->GetModel(), errors, options, leaf.Output.GetStore());
  this->NoteFaceErrors(frame, k, leaf.Kernel->FaceProblems());
  leaf.Report = leaf.Kernel->FirstFrame();
  if (frame.HasViewer)
  {
    leaf.Report = leaf.Kernel->Update(leaf.Source->GetModel(), &frame.Viewer);
    leaf.Report.InsertedVertices = leaf.Output.GetStore().PointCount;
    leaf.Report.DeletedVertices = 0;
  }
  leaf.SetViewer(frame);
  ++this->RebuiltModels;
  this->Leaves[k] = std::move(frame.Fresh[k]);
  return MADE;
}

// Makes only those faces anew whose structure changed, if the others go on.
vtkNURBSDeformingTessellator::Deed vtkNURBSDeformingTessellator::ReplaceFaces(
  Frame& frame, std::size_t k)
{
  Leaf& leaf = *this->Leaves[k];
  std::unique_ptr<vtkNURBSFrameModel>& source = frame.Fresh[k]->Source;
  const std::vector<char> changed = source->FindChangedFaces(*leaf.Source);
  const std::size_t count = std::size_t(std::count(changed.begin(), changed.end(), 1));
  if (count == changed.size() || leaf.Former.size() >= MaxFormer || !source->GetProblem().empty())
  {
    return this->MakeLeaf(frame, k);
  }
  nurbs::FrameReport replaced;
  if (count == 0)
  {
    leaf.Source->TakeStructure(*source);
  }
  else
  {
    leaf.HalfDone = true;
    const bool fits = leaf.Kernel->Replace(source->GetModel(), source->GetFaceErrors(), changed);
    leaf.HalfDone = false;
    if (!fits)
    {
      return this->MakeLeaf(frame, k);
    }
    replaced = leaf.Kernel->FirstFrame();
    this->NoteFaceErrors(frame, k, source->GetFaceErrors());
    this->NoteFaceErrors(frame, k, leaf.Kernel->FaceProblems());
    this->ReplacedFaces += vtkIdType(count);
    leaf.Former.push_back(std::move(leaf.Source));
    leaf.Source = std::move(source);
    leaf.Source->ForgetPoints();
  }
  frame.Fresh[k].reset();
  const Deed deed = this->FollowLeaf(frame, k);
  if (count > 0 && deed != MADE)
  {
    Include(replaced, leaf.Report);
    return MADE;
  }
  return deed;
}

// Follows one model's control points.
vtkNURBSDeformingTessellator::Deed vtkNURBSDeformingTessellator::FollowLeaf(
  Frame& frame, std::size_t k)
{
  const vtkNURBSModelPool::Block& block = frame.Blocks[k];
  Leaf& leaf = *this->Leaves[k];
  if (leaf.Source->HasPointsOf(block.Grid) && leaf.HasViewerOf(frame))
  {
    return NOTHING;
  }
  leaf.Source->TakePoints(block.Grid);
  leaf.HalfDone = true;
  leaf.Report =
    leaf.Kernel->Update(leaf.Source->GetModel(), frame.HasViewer ? &frame.Viewer : nullptr);
  leaf.HalfDone = false;
  if (leaf.Report.Accepted)
  {
    leaf.SetViewer(frame);
    return FOLLOWED;
  }
  leaf.Source->ForgetPoints();
  if (leaf.Report.NeedsReplacement)
  {
    frame.Fresh[k] = std::make_unique<Leaf>(block.Grid);
    return this->MakeLeaf(frame, k);
  }
  frame.Problems.push_back(block.Name + leaf.Report.Problem);
  return NOTHING;
}

void vtkNURBSDeformingTessellator::UpdateLeaf(Frame& frame, std::size_t k)
{
  const std::size_t problems = frame.Problems.size();
  Deed deed = NOTHING;
  try
  {
    deed = !frame.Fresh[k] ? this->FollowLeaf(frame, k)
      : this->Leaves[k]    ? this->ReplaceFaces(frame, k)
                           : this->MakeLeaf(frame, k);
  }
  catch (const std::exception& problem)
  {
    frame.Problems.push_back(frame.Blocks[k].Name + "meshing failed: " + problem.what());
    if (this->Leaves[k] && this->Leaves[k]->HalfDone)
    {
      this->Leaves[k].reset();
    }
  }
  Leaf* leaf = this->Leaves[k].get();
  if (!leaf)
  {
    return;
  }
  const double start = Now();
  vtkUnstructuredGrid* grid = frame.Blocks[k].Grid;
  if (deed == NOTHING)
  {
    leaf->Output.Rest(leaf->Report, this->ChangedMask != 0);
  }
  else
  {
    const std::vector<unsigned char> all(deed == MADE ? leaf->Output.GetStore().PointCount : 0, 1);
    leaf->Output.Update(
      leaf->Report, deed == MADE ? all : leaf->Kernel->ChangedPoints(), this->ChangedMask != 0);
  }
  leaf->Report.CompareSeconds += frame.LookSeconds[k];
  if (deed != NOTHING || frame.Problems.size() == problems)
  {
    leaf->Output.TakeAttributes(grid, leaf->Report);
  }
  this->OutputSeconds += leaf->Output.Tell(grid, leaf->Report, start);
}

void vtkNURBSDeformingTessellator::FillOutput(vtkDataObject* input, vtkDataObject* output)
{
  vtkNURBSModelPool::CopyTree(input, output);
  if (auto* mesh = vtkPolyData::SafeDownCast(output))
  {
    if (!this->Leaves.empty() && this->Leaves[0])
    {
      mesh->ShallowCopy(this->Leaves[0]->Output.GetMesh());
    }
    return;
  }
  std::vector<vtkSmartPointer<vtkPolyData>> empty;
  std::vector<vtkPolyData*> meshes;
  for (const std::unique_ptr<Leaf>& leaf : this->Leaves)
  {
    if (leaf)
    {
      meshes.push_back(leaf->Output.GetMesh());
      continue;
    }
    empty.push_back(vtkSmartPointer<vtkPolyData>::New());
    meshes.push_back(empty.back());
  }
  vtkNURBSModelPool::SetLeaves(input, output, meshes);
}

void vtkNURBSDeformingTessellator::Summarize()
{
  for (const std::unique_ptr<Leaf>& leaf : this->Leaves)
  {
    if (!leaf)
    {
      continue;
    }
    const nurbs::FrameReport& report = leaf->Report;
    this->MovedControlPoints += report.MovedControlPoints;
    this->UpdatedVertices += report.UpdatedVertices;
    this->InsertedVertices += report.InsertedVertices;
    this->DeletedVertices += report.DeletedVertices;
    this->NumberOfTriangles += leaf->Output.GetStore().TriangleCount;
    this->NumberOfPoints += leaf->Output.GetStore().PointCount;
    this->ErrorBound = std::max(this->ErrorBound, report.ErrorBound);
    this->CappedCells += report.CappedCells;
    this->CrossingFaces += report.CrossingFaces;
    this->ModelGap = std::max(this->ModelGap, report.ModelGap);
    this->ToleranceUsed = std::max(this->ToleranceUsed, report.ToleranceUsed);
    this->CompareSeconds += report.CompareSeconds;
    this->MoveSeconds += report.MoveSeconds;
    this->AdaptSeconds += report.AdaptSeconds;
    this->RebuildSeconds += report.RebuildSeconds;
  }
}

// Errors and warnings of a frame; returns whether all models were done.
bool vtkNURBSDeformingTessellator::Complain(const Frame& frame)
{
  if (frame.BadFaces > 0)
  {
    vtkWarningMacro(<< frame.BadFaces << " faces have no triangles:" << frame.FaceErrors.str()
                    << (frame.BadFaces > MaxNamedFaces
                           ? "\n  and " + std::to_string(frame.BadFaces - MaxNamedFaces) + " more"
                           : ""));
  }
  if (this->CrossingFaces > this->ToldCrossing)
  {
    vtkWarningMacro(<< this->CrossingFaces
                    << " faces have loops whose polylines cross there: their "
                    << "triangles may lack or exceed parts");
  }
  this->ToldCrossing = this->CrossingFaces;
  if (!frame.Problems.empty())
  {
    vtkErrorMacro("The frame is refused:" << frame.ProblemText());
  }
  return frame.Problems.empty();
}

void vtkNURBSDeformingTessellator::ClearResults()
{
  this->MovedControlPoints = this->UpdatedVertices = 0;
  this->InsertedVertices = this->DeletedVertices = 0;
  this->NumberOfTriangles = this->NumberOfPoints = 0;
  this->RebuiltModels = this->ReplacedFaces = this->RefusedModels = 0;
  this->CappedCells = this->CrossingFaces = 0;
  this->ErrorBound = this->ModelGap = this->ToleranceUsed = 0.0;
  this->CompareSeconds = this->MoveSeconds = this->AdaptSeconds = 0.0;
  this->RebuildSeconds = this->OutputSeconds = 0.0;
}

void vtkNURBSDeformingTessellator::Make(vtkDataObject* input, Frame& frame, vtkDataObject* output)
{
  this->MakeFrame(input, frame);
  this->FindNewLeaves(frame);
  this->SetDiagonal(frame);
  for (std::size_t k = 0; k < frame.Blocks.size(); ++k)
  {
    if (this->GetAbortExecute())
    {
      if (this->Leaves[k])
      {
        this->Leaves[k]->Output.Rest(this->Leaves[k]->Report, this->ChangedMask != 0);
      }
      continue;
    }
    this->UpdateLeaf(frame, k);
    this->UpdateProgress(double(k + 1) / double(frame.Blocks.size()));
  }
  // All processes do the same work: what only some can't do is no matter of the frame.
  const auto refused = double(frame.Problems.size());
  double extremes[2] = { refused, -refused };
  frame.Pieces.Largest(extremes, 2);
  if (extremes[0] != -extremes[1])
  {
    vtkNURBSPieces::ThrowIf(frame.ProblemText());
  }
  const double start = Now();
  this->FillOutput(frame.Input, output);
  frame.Pieces.Keep(output);
  this->OutputSeconds += Now() - start;
  this->Summarize();
}

int vtkNURBSDeformingTessellator::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->ClearResults();
  vtkDataObject* input = vtkDataObject::GetData(inputs[0]);
  vtkDataObject* output = vtkDataObject::GetData(outputs);
  const vtkNURBSParallelScope parallel;
  Frame frame(request, outputs);
  std::string problem;
  const auto outcome = frame.Pieces.Run(
    [&]() {
      this->Make(input, frame, output);
      return true;
    },
    problem);
  if (outcome != vtkNURBSPieces::DONE)
  {
    vtkErrorMacro(<< problem);
    this->ClearResults();
    this->Leaves.clear();
    this->FillOutput(input, output);
    this->SetErrorCode(vtkErrorCode::UserError);
    return 0;
  }
  const bool done = this->Complain(frame);
  this->RefusedModels = vtkIdType(frame.Problems.size());
  this->SetErrorCode(done ? vtkErrorCode::NoError : vtkErrorCode::UserError);
  const bool any = std::any_of(this->Leaves.begin(), this->Leaves.end(),
    [](const std::unique_ptr<Leaf>& leaf) { return leaf != nullptr; });
  return done || any ? 1 : 0;
}

void vtkNURBSDeformingTessellator::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "ToleranceMode: " << (this->ToleranceMode == ABSOLUTE ? "absolute" : "relative")
     << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "AbsoluteTolerance: " << this->AbsoluteTolerance << "\n";
  os << indent << "Hysteresis: " << this->Hysteresis << "\n";
  os << indent << "ResolutionRefinement: " << this->ResolutionRefinement << "\n";
  os << indent << "PatchSubdivisions: " << this->PatchSubdivisions << "\n";
  os << indent
     << "CoefficientStorage: " << (this->CoefficientStorage == EAGER ? "eager" : "on demand")
     << "\n";
  os << indent << "MemoryLimit: " << this->MemoryLimit << "\n";
  os << indent << "TriangleBudget: " << this->TriangleBudget << "\n";
  os << indent << "Camera: " << this->Camera << "\n";
  os << indent << "FullDetailDistance: " << this->FullDetailDistance << "\n";
  os << indent << "SightAngle: " << this->SightAngle << "\n";
  os << indent << "LeastImportance: " << this->LeastImportance << "\n";
  os << indent << "LargestMove: " << this->LargestMove << "\n";
  os << indent << "JoinSides: " << this->JoinSides << "\n";
  os << indent << "ChangedMask: " << this->ChangedMask << "\n";
  os << indent << "MovedControlPoints: " << this->MovedControlPoints << "\n";
  os << indent << "UpdatedVertices: " << this->UpdatedVertices << "\n";
  os << indent << "InsertedVertices: " << this->InsertedVertices << "\n";
  os << indent << "DeletedVertices: " << this->DeletedVertices << "\n";
  os << indent << "NumberOfTriangles: " << this->NumberOfTriangles << "\n";
  os << indent << "NumberOfPoints: " << this->NumberOfPoints << "\n";
  os << indent << "RebuiltModels: " << this->RebuiltModels << "\n";
  os << indent << "ReplacedFaces: " << this->ReplacedFaces << "\n";
  os << indent << "RefusedModels: " << this->RefusedModels << "\n";
  os << indent << "CappedCells: " << this->CappedCells << "\n";
  os << indent << "CrossingFaces: " << this->CrossingFaces << "\n";
  os << indent << "ErrorBound: " << this->ErrorBound << "\n";
  os << indent << "ModelGap: " << this->ModelGap << "\n";
  os << indent << "ToleranceUsed: " << this->ToleranceUsed << "\n";
  os << indent << "CompareSeconds: " << this->CompareSeconds << "\n";
  os << indent << "MoveSeconds: " << this->MoveSeconds << "\n";
  os << indent << "AdaptSeconds: " << this->AdaptSeconds << "\n";
  os << indent << "RebuildSeconds: " << this->RebuildSeconds << "\n";
  os << indent << "OutputSeconds: " << this->OutputSeconds << "\n";
}
