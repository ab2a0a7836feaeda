// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSTessellator.h"

#include "vtkCamera.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataAssembly.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkNURBSFaceExtent.h"
#include "vtkNURBSMeshOutput.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSParallel.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <future>
#include <numeric>
#include <sstream>

vtkStandardNewMacro(vtkNURBSTessellator);
vtkCxxSetObjectMacro(vtkNURBSTessellator, Camera, vtkCamera);

namespace
{

constexpr int MaxNamedFaces = 8; // in the warning
constexpr std::chrono::milliseconds ProgressInterval(20);
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

// Appends a model to one that has others already.
void AppendModel(const nurbs::Model& part, nurbs::Model& all)
{
  const auto loops = std::int64_t(all.Loops.size());
  const auto curves = std::int64_t(all.TrimCurves.size());
  const auto edges = std::int64_t(all.Edges.size());
  const auto vertices = std::int64_t(all.Vertices.size());
  for (nurbs::Face face : part.Faces)
  {
    face.FirstLoop += loops;
    all.Faces.push_back(face);
  }
  for (nurbs::TrimLoop loop : part.Loops)
  {
    loop.FirstCurve += curves;
    all.Loops.push_back(loop);
  }
  for (nurbs::TrimCurve curve : part.TrimCurves)
  {
    curve.Edge = curve.Edge < 0 ? -1 : curve.Edge + edges;
    all.TrimCurves.push_back(curve);
  }
  for (nurbs::Edge edge : part.Edges)
  {
    for (std::int64_t& vertex : edge.Vertex)
    {
      vertex = vertex < 0 ? -1 : vertex + vertices;
    }
    all.Edges.push_back(edge);
  }
  all.Vertices.insert(all.Vertices.end(), part.Vertices.begin(), part.Vertices.end());
}

vtkPolyData* NewLeaf(vtkDataObject* output, vtkCompositeDataIterator* at)
{
  auto* composite = vtkCompositeDataSet::SafeDownCast(output);
  if (!composite)
  {
    return vtkPolyData::SafeDownCast(output);
  }
  vtkNew<vtkPolyData> leaf;
  composite->SetDataSet(at, leaf);
  return leaf;
}

void CopyTree(vtkDataObject* input, vtkDataObject* output)
{
  auto* from = vtkCompositeDataSet::SafeDownCast(input);
  auto* to = vtkCompositeDataSet::SafeDownCast(output);
  if (!from || !to)
  {
    output->Initialize();
    return;
  }
  to->CopyStructure(from);
  auto* models = vtkPartitionedDataSetCollection::SafeDownCast(from);
  auto* meshes = vtkPartitionedDataSetCollection::SafeDownCast(to);
  if (models && meshes && models->GetDataAssembly())
  {
    vtkNew<vtkDataAssembly> assembly;
    assembly->DeepCopy(models->GetDataAssembly());
    meshes->SetDataAssembly(assembly);
  }
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
  struct Leaf
  {
    vtkUnstructuredGrid* Grid = nullptr;
    std::shared_ptr<const vtkNURBSModelView> View;
    std::size_t FirstFace = 0;
    std::int64_t FirstEdge = 0;
  };
  std::vector<Leaf> Leaves;
  nurbs::Model Model;
  std::vector<std::string> FaceErrors;
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
  vtkDataObject* input = vtkDataObject::GetData(inputs[0]);
  if (!input)
  {
    return 0;
  }
  const bool composite = input->IsA("vtkCompositeDataSet");
  const char* type = composite ? input->GetClassName() : "vtkPolyData";
  for (int port = 0; port < 2; ++port)
  {
    vtkInformation* info = outputs->GetInformationObject(port);
    vtkDataObject* output = info->Get(vtkDataObject::DATA_OBJECT());
    if (output && std::string(output->GetClassName()) == type)
    {
      continue;
    }
    vtkSmartPointer<vtkDataObject> made;
    made.TakeReference(composite ? input->NewInstance() : vtkPolyData::New());
    info->Set(vtkDataObject::DATA_OBJECT(), made);
  }
  return 1;
}

// The models of the input in one, with offset indices.
bool vtkNURBSTessellator::CollectModels(vtkDataObject* input, Work& work)
{
  const auto add = [&](vtkDataObject* leaf, unsigned int index) {
    auto* grid = vtkUnstructuredGrid::SafeDownCast(leaf);
    if (grid && grid->GetNumberOfCells() == 0)
    {
      return true;
    }
    if (!grid || !vtkNURBSModel::IsModel(grid))
    {
      vtkErrorMacro(
        "The input" << (input == leaf ? std::string() : "'s data set " + std::to_string(index))
                    << " is not a NURBS model: "
                    << (grid ? "it lacks the arrays that describe surfaces"
                             : "it is no vtkUnstructuredGrid"));
      return false;
    }
    Work::Leaf entry;
    entry.Grid = grid;
    entry.View = vtkNURBSModel::View(grid);
    entry.FirstFace = work.Model.Faces.size();
    entry.FirstEdge = std::int64_t(work.Model.Edges.size());
    const nurbs::Model& model = entry.View->GetModel();
    AppendModel(model, work.Model);
    for (std::size_t f = 0; f < model.Faces.size(); ++f)
    {
      work.FaceErrors.push_back(entry.View->GetFaceError(vtkIdType(f)));
    }
    work.Leaves.push_back(std::move(entry));
    return true;
  };
  auto* composite = vtkCompositeDataSet::SafeDownCast(input);
  if (!composite)
  {
    return add(input, 0);
  }
  vtkSmartPointer<vtkCompositeDataIterator> at;
  at.TakeReference(composite->NewIterator());
  for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
  {
    if (!add(at->GetCurrentDataObject(), at->GetCurrentFlatIndex()))
    {
      return false;
    }
  }
  return true;
}

bool vtkNURBSTessellator::FillOptions(Work& work)
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
      vtkErrorMacro("AbsoluteTolerance must be positive, but is " << this->AbsoluteTolerance);
      return false;
    }
    options.Tolerance = this->AbsoluteTolerance;
    return true;
  }
  const std::vector<nurbs::Box3> boxes =
    vtkNURBSFaceExtent::FaceBoxes(work.Model, work.FaceErrors, vtkNURBSParallelFor);
  const double diagonal = vtkNURBSFaceExtent::Diagonal(boxes);
  options.Tolerance = (diagonal > 0.0 ? diagonal : 1.0) * this->Tolerance;
  if (this->ToleranceMode == RELATIVE)
  {
    return true;
  }
  if (!this->Camera || this->ViewportSize[0] < 1 || this->ViewportSize[1] < 1)
  {
    vtkErrorMacro("A tolerance in pixels needs a Camera and a ViewportSize of at least 1 x 1");
    return false;
  }
  options.FaceTolerances = vtkNURBSFaceExtent::PixelTolerances(
    boxes, this->Camera, this->ViewportSize, this->PixelTolerance, 1e-7 * diagonal);
  if (!options.FaceTolerances.empty())
  {
    options.Tolerance =
      *std::min_element(options.FaceTolerances.begin(), options.FaceTolerances.end());
  }
  return true;
}

// The work is done in another thread, whichever threads it is spread over there, so that observers
// of the progress run in this one, are called while it lasts, and can abort it. What takes less time
// than a thread needs to start is done here.
bool vtkNURBSTessellator::Tessellate(Work& work)
{
  std::atomic<double> progress{ 0.0 };
  std::atomic<bool> abort{ false };
  const auto report = [this, &progress, &abort]() {
    this->UpdateProgress(0.95 * progress);
    abort = abort || this->GetAbortExecute() != 0;
  };
  work.Options.Progress = [&progress, &abort](double done) {
    progress = done;
    return !abort;
  };
  report();
  const bool quick =
    work.Model.Faces.size() <= QuickFaces && ControlPoints(work.Model) <= QuickPoints;
  auto result = std::async(quick ? std::launch::deferred : std::launch::async,
    [&work]() { return nurbs::Tessellate(work.Model, work.FaceErrors, work.Options); });
  while (!quick && result.wait_for(ProgressInterval) != std::future_status::ready)
  {
    report();
  }
  try
  {
    work.Result = result.get();
  }
  catch (const std::exception& problem)
  {
    vtkErrorMacro("Tessellation failed: " << problem.what());
    return false;
  }
  work.Result.Aborted = work.Result.Aborted || abort;
  return true;
}

void vtkNURBSTessellator::FillOutputs(
  Work& work, vtkDataObject* input, vtkInformationVector* outputs)
{
  vtkDataObject* meshes = vtkDataObject::GetData(outputs, 0);
  vtkDataObject* lines = vtkDataObject::GetData(outputs, 1);
  auto* composite = vtkCompositeDataSet::SafeDownCast(input);
  vtkSmartPointer<vtkCompositeDataIterator> at;
  if (composite)
  {
    at.TakeReference(composite->NewIterator());
    at->InitTraversal();
  }
  std::size_t line = 0;
  for (std::size_t k = 0; k < work.Leaves.size(); ++k)
  {
    const Work::Leaf& leaf = work.Leaves[k];
    while (at && at->GetCurrentDataObject() != leaf.Grid)
    {
      at->GoToNextItem();
    }
    vtkNURBSMeshOutput::Range range;
    range.Result = &work.Result;
    range.FirstMesh = leaf.FirstFace;
    range.LastMesh =
      k + 1 < work.Leaves.size() ? work.Leaves[k + 1].FirstFace : work.Result.Meshes.size();
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
    range.MergePoints = this->MergePoints;
    vtkPolyData* mesh = NewLeaf(meshes, at);
    vtkNURBSMeshOutput::FillMesh(range, leaf.Grid, mesh);
    vtkNURBSMeshOutput::FillLines(range, leaf.Grid, leaf.FirstEdge, NewLeaf(lines, at));
    this->NumberOfTriangles += mesh->GetNumberOfPolys();
    this->NumberOfPoints += mesh->GetNumberOfPoints();
    if (at)
    {
      at->GoToNextItem();
    }
  }
}

// Counts the faces by status and names those that were not done in one warning.
void vtkNURBSTessellator::Summarize(const Work& work)
{
  this->NumberOfFaces = vtkIdType(work.Result.Meshes.size());
  this->ToleranceUsed = work.Options.FaceTolerances.empty() ? work.Options.Tolerance : 0.0;
  std::ostringstream named;
  int count = 0;
  std::size_t leaf = 0;
  for (std::size_t f = 0; f < work.Result.Meshes.size(); ++f)
  {
    while (leaf + 1 < work.Leaves.size() && work.Leaves[leaf + 1].FirstFace <= f)
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
    const Work::Leaf& of = work.Leaves[leaf];
    const auto cell = vtkIdType(f - of.FirstFace);
    named << "\n  face " << vtkNURBSModel::GetFaceId(of.Grid, cell)
          << (mesh.Status == nurbs::FaceStatus::Failed ? " failed: " : " capped: ") << mesh.Message;
  }
  if (count > 0)
  {
    vtkWarningMacro(<< this->NumberOfFailedFaces << " of " << this->NumberOfFaces
                    << " faces have no triangles, " << this->NumberOfCappedFaces
                    << " exceed the tolerance:" << named.str()
                    << (count > MaxNamedFaces
                           ? "\n  and " + std::to_string(count - MaxNamedFaces) + " more"
                           : ""));
  }
}

int vtkNURBSTessellator::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const double start = Now();
  this->NumberOfTriangles = this->NumberOfPoints = this->NumberOfFaces = 0;
  this->NumberOfRepairedFaces = 0;
  this->NumberOfCappedFaces = this->NumberOfFailedFaces = 0;
  this->CertifiedError = this->ToleranceUsed = this->TessellateSeconds = this->OutputSeconds = 0.0;
  vtkDataObject* input = vtkDataObject::GetData(inputs[0]);
  for (int port = 0; port < 2; ++port)
  {
    CopyTree(input, vtkDataObject::GetData(outputs, port));
  }
  const vtkNURBSParallelScope parallel;
  Work work;
  if (!this->CollectModels(input, work) || !this->FillOptions(work) || !this->Tessellate(work))
  {
    this->SetErrorCode(vtkErrorCode::UserError);
    return 0;
  }
  this->SetErrorCode(vtkErrorCode::NoError);
  this->TessellateSeconds = Now() - start;
  if (work.Result.Aborted)
  {
    return 1;
  }
  this->Summarize(work);
  this->FillOutputs(work, input, outputs);
  this->OutputSeconds = Now() - start - this->TessellateSeconds;
  this->UpdateProgress(1.0);
  return 1;
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
  os << indent << "TessellateSeconds: " << this->TessellateSeconds << "\n";
  os << indent << "OutputSeconds: " << this->OutputSeconds << "\n";
}
