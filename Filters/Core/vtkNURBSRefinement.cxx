// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSRefinement.h"

#include "DenseNet.h"
#include "ModelExtent.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelNames.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSNewArray.h"
#include "vtkNURBSParallel.h"
#include "vtkNURBSPieces.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace names = vtkNURBSModelNames;

vtkStandardNewMacro(vtkNURBSRefinement);

// One model of the input.
struct vtkNURBSRefinement::Part
{
  vtkUnstructuredGrid* Grid = nullptr; ///< The output's, with the input's content.
  std::shared_ptr<const vtkNURBSModelView> View;
  std::vector<nurbs::DenseNet> Nets; ///< One a face.
  std::vector<std::string> Failures; ///< One a face: why it got no net, or "".
};

namespace
{

constexpr int MaxNamedFaces = 8;           // in the warning
constexpr std::int64_t FacesAReport = 256; // from one report of progress to the next
constexpr std::size_t FewFaces = 256;

/// The output becomes a copy of the input that shares all arrays. Returns the models in it, which
/// are objects of their own.
std::vector<vtkUnstructuredGrid*> ShareModels(vtkDataObject* input, vtkDataObject* output)
{
  output->ShallowCopy(input);
  auto* composite = vtkCompositeDataSet::SafeDownCast(output);
  if (!composite)
  {
    return { vtkUnstructuredGrid::SafeDownCast(output) };
  }
  std::vector<vtkUnstructuredGrid*> models;
  vtkSmartPointer<vtkCompositeDataIterator> at;
  at.TakeReference(composite->NewIterator());
  for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
  {
    auto* shared = vtkUnstructuredGrid::SafeDownCast(at->GetCurrentDataObject());
    if (vtkNURBSModel::IsModel(shared))
    {
      vtkNew<vtkUnstructuredGrid> own;
      own->ShallowCopy(shared);
      composite->SetDataSet(at, own);
      models.push_back(own);
    }
  }
  return models;
}

/// Assemblies have hundreds of models too small to start threads for.
nurbs::ParallelFor LoopOver(std::size_t faces)
{
  return faces < FewFaces ? nurbs::ParallelFor(nurbs::SerialFor) : vtkNURBSParallelFor;
}

/// Puts new nets in the place of a model's, in the arrays that describe them. Cells that have no
/// new net, bad ones among them, keep theirs.
class NetWriter
{
public:
  NetWriter(vtkUnstructuredGrid* grid, const std::vector<nurbs::DenseNet>& nets)
    : Grid(grid)
    , Nets(nets)
    , Weights(grid->GetPointData()->GetArray(names::RationalWeights))
  {
    this->Weights = this->Weights && this->Weights->GetNumberOfTuples() == grid->GetNumberOfPoints()
      ? this->Weights
      : nullptr;
  }

  void Write()
  {
    this->CountPoints();
    this->WritePoints();
    this->WriteCells();
    this->WriteSurfaces();
  }

private:
  std::int64_t SizeOf(vtkIdType cell) const
  {
    return this->Nets[cell].Changed ? this->Nets[cell].Geometry.View().Size()
                                    : this->Grid->GetCells()->GetCellSize(cell);
  }

  /// Calls visit(position in the cell, id) for an unchanged cell; -1 for points that do not exist.
  template <typename F>
  void VisitPoints(vtkIdType cell, F visit) const
  {
    vtkIdType count;
    const vtkIdType* ids;
    this->Grid->GetCells()->GetCellAtId(cell, count, ids);
    for (vtkIdType k = 0; k < count; ++k)
    {
      visit(k, ids[k] >= 0 && ids[k] < this->Grid->GetNumberOfPoints() ? ids[k] : -1);
    }
  }

  /// Kept points come first, in the input's order.
  void CountPoints()
  {
    const vtkIdType cells = this->Grid->GetNumberOfCells();
    this->NewId.assign(this->Grid->GetNumberOfPoints(), -1);
    for (vtkIdType cell = 0; cell < cells; ++cell)
    {
      if (!this->Nets[cell].Changed)
      {
        this->VisitPoints(cell,
          [this](vtkIdType, vtkIdType id) { (id < 0 ? this->Ignored : this->NewId[id]) = 0; });
      }
    }
    for (vtkIdType& id : this->NewId)
    {
      id = id < 0 ? -1 : this->Points++;
    }
    for (vtkIdType cell = 0; cell < cells; ++cell)
    {
      this->FirstPoint.push_back(this->Points);
      this->Points += this->Nets[cell].Changed ? this->SizeOf(cell) : 0;
    }
  }

  void WritePoints()
  {
    const auto xyz = vtkNURBSNewArray<vtkDoubleArray>(nullptr, 3, this->Points);
    vtkSmartPointer<vtkDoubleArray> weights;
    double* to = xyz->GetPointer(0);
    double* toWeight = nullptr;
    if (this->Weights)
    {
      weights = vtkNURBSNewArray<vtkDoubleArray>(names::RationalWeights, 1, this->Points);
      toWeight = weights->GetPointer(0);
    }
    for (std::size_t id = 0; id < this->NewId.size(); ++id)
    {
      const vtkIdType k = this->NewId[id];
      if (k >= 0)
      {
        this->Grid->GetPoint(vtkIdType(id), to + 3 * k);
        weights ? toWeight[k] = this->Weights->GetComponent(vtkIdType(id), 0) : 1.0;
      }
    }
    LoopOver(this->Nets.size())(0, this->Nets.size(), [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t cell = begin; cell < end; ++cell)
      {
        const nurbs::Surface& net = this->Nets[cell].Geometry;
        const vtkIdType first = this->FirstPoint[cell];
        for (std::size_t k = 0; k < net.Points.size(); ++k)
        {
          std::copy_n(net.Points[k].data(), 3, to + 3 * (first + k));
          weights ? toWeight[first + k] = net.Weights.empty() ? 1.0 : net.Weights[k] : 1.0;
        }
      }
    });
    vtkNew<vtkPoints> points;
    points->SetData(xyz);
    this->Grid->SetPoints(points);
    this->Grid->GetPointData()->Initialize();
    if (weights)
    {
      this->Grid->GetPointData()->AddArray(weights);
    }
  }

  void WriteCells()
  {
    const vtkIdType cells = this->Grid->GetNumberOfCells();
    const auto offsets = vtkNURBSNewArray<vtkTypeInt64Array>(nullptr, 1, cells + 1);
    offsets->SetValue(0, 0);
    for (vtkIdType cell = 0; cell < cells; ++cell)
    {
      offsets->SetValue(cell + 1, offsets->GetValue(cell) + this->SizeOf(cell));
    }
    const auto connectivity =
      vtkNURBSNewArray<vtkTypeInt64Array>(nullptr, 1, offsets->GetValue(cells));
    for (vtkIdType cell = 0; cell < cells; ++cell)
    {
      vtkTypeInt64* to = connectivity->GetPointer(offsets->GetValue(cell));
      if (this->Nets[cell].Changed)
      {
        const std::int64_t size = this->SizeOf(cell);
        for (std::int64_t k = 0; k < size; ++k)
        {
          to[k] = this->FirstPoint[cell] + k;
        }
        continue;
      }
      this->VisitPoints(
        cell, [&](vtkIdType k, vtkIdType id) { to[k] = id < 0 ? -1 : this->NewId[id]; });
    }
    vtkNew<vtkCellArray> array;
    array->SetData(offsets, connectivity);
    const vtkSmartPointer<vtkUnsignedCharArray> types = this->Grid->GetCellTypesArray();
    this->Grid->SetCells(types, array);
  }

  /// Degrees, net sizes and knots. Unchanged cells read the old knots, which stay where they are.
  void WriteSurfaces()
  {
    vtkCellData* data = this->Grid->GetCellData();
    vtkDataArray* oldKnots = this->Grid->GetFieldData()->GetArray(names::Knots);
    const bool keep = std::any_of(this->Nets.begin(), this->Nets.end(),
      [](const nurbs::DenseNet& net) { return !net.Changed; });
    std::vector<double> knots;
    for (vtkIdType k = 0; keep && k < oldKnots->GetNumberOfTuples(); ++k)
    {
      knots.push_back(oldKnots->GetComponent(k, 0));
    }
    const auto cells = vtkIdType(this->Nets.size());
    const auto degree = vtkNURBSNewArray<vtkIntArray>(names::Degree, 2, cells);
    const auto size = vtkNURBSNewArray<vtkIntArray>(names::NetSize, 2, cells);
    const auto start = vtkNURBSNewArray<vtkTypeInt64Array>(names::KnotStart, 2, cells);
    for (vtkIdType cell = 0; cell < cells; ++cell)
    {
      const nurbs::DenseNet& net = this->Nets[cell];
      for (int dir = 0; dir < 2; ++dir)
      {
        const std::pair<vtkDataArray*, std::int64_t> values[3] = { { degree,
                                                                     net.Geometry.Degree[dir] },
          { size, net.Geometry.Count[dir] }, { start, std::int64_t(knots.size()) } };
        for (const auto& [array, value] : values)
        {
          vtkDataArray* old = data->GetArray(array->GetName());
          array->SetComponent(
            cell, dir, net.Changed ? double(value) : old->GetComponent(cell, dir));
        }
        if (net.Changed)
        {
          knots.insert(knots.end(), net.Geometry.Knots[dir].begin(), net.Geometry.Knots[dir].end());
        }
      }
    }
    const auto flat = vtkNURBSNewArray<vtkDoubleArray>(names::Knots, 1, vtkIdType(knots.size()));
    std::copy(knots.begin(), knots.end(), flat->GetPointer(0));
    data->AddArray(degree);
    data->AddArray(size);
    data->AddArray(start);
    this->Grid->GetFieldData()->AddArray(flat);
  }

  vtkUnstructuredGrid* Grid;
  const std::vector<nurbs::DenseNet>& Nets;
  vtkSmartPointer<vtkDataArray> Weights;
  std::vector<vtkIdType> NewId;      ///< Of the input's points; -1: gone.
  std::vector<vtkIdType> FirstPoint; ///< Of every changed cell.
  vtkIdType Points = 0;
  vtkIdType Ignored = 0;
};

} // namespace

vtkNURBSRefinement::vtkNURBSRefinement() = default;
vtkNURBSRefinement::~vtkNURBSRefinement() = default;

int vtkNURBSRefinement::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

int vtkNURBSRefinement::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataObject");
  return 1;
}

int vtkNURBSRefinement::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[0]);
  if (!input)
  {
    return 0;
  }
  vtkInformation* info = outputs->GetInformationObject(0);
  vtkDataObject* output = vtkDataObject::GetData(info);
  if (!output || std::string(output->GetClassName()) != input->GetClassName())
  {
    vtkSmartPointer<vtkDataObject> made;
    made.TakeReference(input->NewInstance());
    info->Set(vtkDataObject::DATA_OBJECT(), made);
  }
  return 1;
}

double vtkNURBSRefinement::AbsoluteSpacing(
  const std::vector<Part>& parts, const vtkNURBSPieces& pieces) const
{
  if (this->SpacingMode == ABSOLUTE)
  {
    return this->MaximumSpacing;
  }
  nurbs::Box3 box;
  for (const Part& part : parts)
  {
    const nurbs::Model& model = part.View->GetModel();
    std::vector<std::string> errors;
    for (std::size_t f = 0; f < model.Faces.size(); ++f)
    {
      errors.push_back(part.View->GetFaceError(vtkIdType(f)));
    }
    for (const nurbs::Box3& some : nurbs::FaceBoxes(model, errors, LoopOver(errors.size())))
    {
      box.extend(some);
    }
  }
  const double diagonal = nurbs::Diagonal({ pieces.Around(box) });
  return this->MaximumSpacing * (diagonal > 0.0 ? diagonal : 1.0);
}

// Makes the nets of all sound faces. False: it was aborted.
bool vtkNURBSRefinement::Refine(std::vector<Part>& parts, double spacing)
{
  nurbs::NetDensity wanted;
  wanted.MinimumDegree = this->MinimumDegree;
  wanted.Spacing = spacing;
  wanted.MaximumPoints = this->MaximumControlPoints;
  wanted.ClampToTrims = this->ClampToTrims;
  std::vector<std::pair<Part*, std::size_t>> faces;
  for (Part& part : parts)
  {
    const std::vector<nurbs::Face>& all = part.View->GetModel().Faces;
    part.Nets.resize(all.size());
    part.Failures.resize(all.size());
    for (std::size_t f = 0; f < all.size(); ++f)
    {
      if (all[f].Geometry.Size() > 0)
      {
        faces.emplace_back(&part, f);
      }
    }
  }
  const auto count = std::int64_t(faces.size());
  for (std::int64_t done = 0; done < count && !this->GetAbortExecute();)
  {
    const std::int64_t next = std::min(count, done + FacesAReport);
    vtkNURBSParallelFor(done, next, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t k = begin; k < end; ++k)
      {
        const auto [part, f] = faces[k];
        const nurbs::Model& model = part->View->GetModel();
        try
        {
          part->Nets[f] = nurbs::MakeDense(model, model.Faces[f], wanted);
        }
        catch (const nurbs::Error& problem)
        {
          part->Failures[f] = problem.what();
        }
      }
    });
    done = next;
    this->UpdateProgress(0.9 * double(done) / double(count));
  }
  return !this->GetAbortExecute();
}

void vtkNURBSRefinement::Summarize(const std::vector<Part>& parts, const vtkNURBSPieces& pieces)
{
  std::vector<std::string> bad, capped;
  for (const Part& part : parts)
  {
    const std::string errors = part.View->DescribeFaceErrors();
    if (!errors.empty())
    {
      bad.push_back("\n" + errors);
    }
    for (std::size_t f = 0; f < part.Nets.size(); ++f)
    {
      const std::string face =
        "face " + std::to_string(vtkNURBSModel::GetFaceId(part.Grid, vtkIdType(f)));
      if (!part.Failures[f].empty())
      {
        bad.push_back("\n" + face + ": " + part.Failures[f]);
      }
      this->NumberOfRefinedFaces += part.Nets[f].Changed;
      if (part.Nets[f].Capped && ++this->NumberOfCappedFaces <= MaxNamedFaces)
      {
        capped.push_back("\n  " + face);
      }
    }
  }
  vtkIdType figures[] = { this->NumberOfRefinedFaces, this->NumberOfCappedFaces };
  pieces.Sum(figures, 2);
  this->NumberOfRefinedFaces = figures[0];
  this->NumberOfCappedFaces = figures[1];
  pieces.Join(bad);
  pieces.Join(capped);
  const auto text = [](const std::vector<std::string>& lines) {
    return std::accumulate(lines.begin(), lines.end(), std::string());
  };
  if (!bad.empty())
  {
    vtkWarningMacro("Faces with errors are passed on as they are:" << text(bad));
  }
  if (this->NumberOfCappedFaces > 0)
  {
    capped.resize(std::min(capped.size(), std::size_t(MaxNamedFaces)));
    const vtkIdType more = this->NumberOfCappedFaces - MaxNamedFaces;
    vtkWarningMacro(<< this->NumberOfCappedFaces << " faces would need more than "
                    << this->MaximumControlPoints
                    << " control points (MaximumControlPoints) and are coarser than asked for:"
                    << text(capped)
                    << (more > 0 ? "\n  and " + std::to_string(more) + " more" : ""));
  }
}

// False: it was aborted.
bool vtkNURBSRefinement::Make(
  vtkDataObject* input, const vtkNURBSPieces& pieces, vtkDataObject* output)
{
  if (!(this->MaximumSpacing > 0.0) || !std::isfinite(this->MaximumSpacing))
  {
    throw nurbs::Error(
      "MaximumSpacing must be positive, but is " + std::to_string(this->MaximumSpacing));
  }
  auto* single = vtkUnstructuredGrid::SafeDownCast(input);
  if (single && single->GetNumberOfCells() > 0 && !vtkNURBSModel::IsModel(single))
  {
    throw nurbs::Error(
      "The input is not a NURBS model: it lacks the arrays that describe surfaces");
  }
  std::vector<Part> parts;
  for (vtkUnstructuredGrid* grid : ShareModels(input, output))
  {
    parts.push_back({ grid, vtkNURBSModel::View(grid), {}, {} });
  }
  if (!this->Refine(parts, this->AbsoluteSpacing(parts, pieces)))
  {
    return false;
  }
  this->Summarize(parts, pieces);
  for (Part& part : parts)
  {
    if (std::any_of(part.Nets.begin(), part.Nets.end(),
          [](const nurbs::DenseNet& net) { return net.Changed; }))
    {
      NetWriter(part.Grid, part.Nets).Write();
    }
    this->NumberOfControlPoints += part.Grid->GetNumberOfPoints();
    part.Nets.clear();
  }
  pieces.Sum(&this->NumberOfControlPoints, 1);
  return true;
}

int vtkNURBSRefinement::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[0]);
  vtkDataObject* output = vtkDataObject::GetData(outputs, 0);
  this->NumberOfRefinedFaces = this->NumberOfCappedFaces = this->NumberOfControlPoints = 0;
  const vtkNURBSParallelScope parallel;
  const vtkNURBSPieces pieces(request, outputs);
  std::string problem;
  const auto outcome = pieces.Run([&]() { return this->Make(input, pieces, output); }, problem);
  this->SetErrorCode(
    outcome == vtkNURBSPieces::FAILED ? vtkErrorCode::UserError : vtkErrorCode::NoError);
  this->UpdateProgress(1.0);
  if (outcome == vtkNURBSPieces::DONE)
  {
    return 1;
  }
  output->Initialize();
  this->NumberOfRefinedFaces = this->NumberOfCappedFaces = this->NumberOfControlPoints = 0;
  if (outcome == vtkNURBSPieces::ABORTED)
  {
    return 1;
  }
  vtkErrorMacro(<< problem);
  return 0;
}

void vtkNURBSRefinement::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MinimumDegree: " << this->MinimumDegree << "\n";
  os << indent << "MaximumSpacing: " << this->MaximumSpacing
     << (this->SpacingMode == RELATIVE ? " of the diagonal\n" : "\n");
  os << indent << "MaximumControlPoints: " << this->MaximumControlPoints << "\n";
  os << indent << "ClampToTrims: " << (this->ClampToTrims ? "On\n" : "Off\n");
  os << indent << "NumberOfRefinedFaces: " << this->NumberOfRefinedFaces << "\n";
  os << indent << "NumberOfCappedFaces: " << this->NumberOfCappedFaces << "\n";
  os << indent << "NumberOfControlPoints: " << this->NumberOfControlPoints << "\n";
}
