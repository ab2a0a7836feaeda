// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSFreeFormDeformation.h"

#include "FreeFormLattice.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNURBSParallel.h"
#include "vtkNURBSPieces.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkStructuredGrid.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cstring>
#include <set>
#include <string>

vtkStandardNewMacro(vtkNURBSFreeFormDeformation);

namespace
{

constexpr int ModelPort = 0;
constexpr int LatticePort = 1;
constexpr vtkIdType FewPoints = 10000; // Too few to be worth threads.
constexpr double FlatPart = 1e-9;      // of the diagonal
constexpr double FlatMargin = 0.1;     // of the diagonal

/// Coordinates as doubles: the points' own array if it is one.
vtkSmartPointer<vtkDoubleArray> Coordinates(vtkPoints* points)
{
  vtkSmartPointer<vtkDoubleArray> doubles = vtkDoubleArray::SafeDownCast(points->GetData());
  if (!doubles)
  {
    doubles = vtkSmartPointer<vtkDoubleArray>::New();
    doubles->DeepCopy(points->GetData());
  }
  return doubles;
}

vtkSmartPointer<vtkPoints> NewPoints(vtkIdType count)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(count);
  points->GetData()->Fill(0.0);
  return points;
}

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
    if (auto* shared = vtkUnstructuredGrid::SafeDownCast(at->GetCurrentDataObject()))
    {
      vtkNew<vtkUnstructuredGrid> own;
      own->ShallowCopy(shared);
      composite->SetDataSet(at, own);
      models.push_back(own);
    }
  }
  return models;
}

/// Around the models of all processes.
nurbs::Box3 BoxOf(const std::vector<vtkUnstructuredGrid*>& models, const vtkNURBSPieces& pieces)
{
  nurbs::Box3 box;
  for (vtkUnstructuredGrid* model : models)
  {
    if (vtkPoints* points = model->GetPoints())
    {
      const auto xyz = Coordinates(points);
      box.extend(nurbs::BoxOfFinitePoints(xyz->GetPointer(0), xyz->GetNumberOfTuples()));
    }
  }
  return pieces.Around(box);
}

/// The box with a margin, a part of its diagonal, and not flat.
nurbs::Box3 Widened(const nurbs::Box3& box, double margin)
{
  const nurbs::Vec3 sizes = box.sizes();
  const double diagonal = sizes.norm() > 0.0 ? sizes.norm() : 1.0;
  nurbs::Vec3 more = nurbs::Vec3::Constant(margin * diagonal);
  for (int a = 0; a < 3; ++a)
  {
    more[a] += sizes[a] > FlatPart * diagonal ? 0.0 : FlatMargin * diagonal;
  }
  return nurbs::Box3(box.min() - more, box.max() + more);
}

/// Throws nurbs::Error if a grid of places has other dimensions than the lattice.
void CheckDimensions(vtkStructuredGrid* places, const int (&wanted)[3])
{
  int has[3] = { 0, 0, 0 };
  if (places)
  {
    places->GetDimensions(has);
  }
  if (places && places->GetNumberOfPoints() > 0 && !std::equal(wanted, wanted + 3, has))
  {
    const auto text = [](const int(&n)[3]) {
      return std::to_string(n[0]) + " x " + std::to_string(n[1]) + " x " + std::to_string(n[2]);
    };
    throw nurbs::Error(
      "input 1 has the dimensions " + text(has) + "; the lattice has " + text(wanted));
  }
}

/// The points of the first process that has some: a lattice is for all, and may be there only.
vtkSmartPointer<vtkPoints> PlacesOfAll(vtkPoints* own, const vtkNURBSPieces& pieces)
{
  if (!pieces.IsParallel())
  {
    return own;
  }
  std::vector<char> message;
  for (vtkIdType n = 0; own && n < own->GetNumberOfPoints(); ++n)
  {
    double place[3];
    own->GetPoint(n, place);
    const auto* bytes = reinterpret_cast<const char*>(place);
    message.insert(message.end(), bytes, bytes + sizeof place);
  }
  for (const std::vector<char>& heard : pieces.Exchange(message))
  {
    if (!heard.empty())
    {
      auto all = NewPoints(vtkIdType(heard.size() / (3 * sizeof(double))));
      auto* places = vtkDoubleArray::SafeDownCast(all->GetData());
      std::memcpy(places->GetPointer(0), heard.data(), heard.size());
      return all;
    }
  }
  return own;
}

/// Adds to the displacements what the places differ from the lattice at rest. Throws nurbs::Error
/// if they are too many or too few.
void AddPlaces(vtkPoints* places, const std::string& where, const nurbs::FreeFormLattice& lattice,
  std::vector<double>& displacements)
{
  const vtkIdType count = places ? places->GetNumberOfPoints() : 0;
  if (count != lattice.Size())
  {
    throw nurbs::Error(where + " has " + std::to_string(count) + " points; the lattice has " +
      std::to_string(lattice.Count(0)) + " x " + std::to_string(lattice.Count(1)) + " x " +
      std::to_string(lattice.Count(2)));
  }
  for (vtkIdType n = 0; n < count; ++n)
  {
    nurbs::Vec3 place;
    places->GetPoint(n, place.data());
    const nurbs::Vec3 rest = lattice.RestPoint(n);
    for (int c = 0; c < 3; ++c)
    {
      displacements[3 * n + c] += place[c] - rest[c];
    }
  }
}

} // namespace

vtkNURBSFreeFormDeformation::vtkNURBSFreeFormDeformation()
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
  this->Displacements.assign(3 * this->GetNumberOfLatticePoints(), 0.0);
}

vtkNURBSFreeFormDeformation::~vtkNURBSFreeFormDeformation() = default;

void vtkNURBSFreeFormDeformation::SetDimensions(int l, int m, int n)
{
  const int wanted[3] = { l, m, n };
  bool same = true;
  for (int a = 0; a < 3; ++a)
  {
    const int count = std::clamp(wanted[a], 2, nurbs::MaxLatticeCount);
    same = same && count == this->Dimensions[a];
    this->Dimensions[a] = count;
  }
  if (!same)
  {
    this->Displacements.assign(3 * this->GetNumberOfLatticePoints(), 0.0);
    this->Modified();
  }
}

vtkIdType vtkNURBSFreeFormDeformation::GetNumberOfLatticePoints() const
{
  return vtkIdType(this->Dimensions[0]) * this->Dimensions[1] * this->Dimensions[2];
}

vtkIdType vtkNURBSFreeFormDeformation::IndexOf(int i, int j, int k) const
{
  const int* size = this->Dimensions;
  const bool inside = i >= 0 && i < size[0] && j >= 0 && j < size[1] && k >= 0 && k < size[2];
  return inside ? i + size[0] * (j + vtkIdType(size[1]) * k) : -1;
}

bool vtkNURBSFreeFormDeformation::HasLatticePoint(vtkIdType index)
{
  const bool has = index >= 0 && index < this->GetNumberOfLatticePoints();
  if (!has)
  {
    vtkErrorMacro("There is no such lattice point; the lattice has "
      << this->Dimensions[0] << " x " << this->Dimensions[1] << " x " << this->Dimensions[2]);
  }
  return has;
}

void vtkNURBSFreeFormDeformation::SetLatticeDisplacement(
  vtkIdType index, double x, double y, double z)
{
  if (!this->HasLatticePoint(index))
  {
    return;
  }
  const double wanted[3] = { x, y, z };
  double* kept = this->Displacements.data() + 3 * index;
  if (!std::equal(wanted, wanted + 3, kept))
  {
    std::copy(wanted, wanted + 3, kept);
    this->Modified();
  }
}

void vtkNURBSFreeFormDeformation::SetLatticeDisplacement(
  int i, int j, int k, double x, double y, double z)
{
  this->SetLatticeDisplacement(this->IndexOf(i, j, k), x, y, z);
}

void vtkNURBSFreeFormDeformation::GetLatticeDisplacement(vtkIdType index, double displacement[3])
{
  std::fill(displacement, displacement + 3, 0.0);
  if (this->HasLatticePoint(index))
  {
    std::copy_n(this->Displacements.data() + 3 * index, 3, displacement);
  }
}

void vtkNURBSFreeFormDeformation::GetLatticeDisplacement(
  int i, int j, int k, double displacement[3])
{
  this->GetLatticeDisplacement(this->IndexOf(i, j, k), displacement);
}

void vtkNURBSFreeFormDeformation::ResetLattice()
{
  std::fill(this->Displacements.begin(), this->Displacements.end(), 0.0);
  this->Lattice = nullptr;
  this->Modified();
}

void vtkNURBSFreeFormDeformation::SetLattice(vtkPoints* points)
{
  if (this->Lattice != points)
  {
    this->Lattice = points;
    this->Modified();
  }
}

vtkPoints* vtkNURBSFreeFormDeformation::GetLattice()
{
  return this->Lattice;
}

vtkMTimeType vtkNURBSFreeFormDeformation::GetMTime()
{
  return std::max(this->Superclass::GetMTime(), this->Lattice ? this->Lattice->GetMTime() : 0);
}

int vtkNURBSFreeFormDeformation::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == LatticePort)
  {
    info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPointSet");
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
    return 1;
  }
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

int vtkNURBSFreeFormDeformation::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(
    vtkDataObject::DATA_TYPE_NAME(), port == LatticePort ? "vtkStructuredGrid" : "vtkDataObject");
  return 1;
}

int vtkNURBSFreeFormDeformation::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[ModelPort]);
  if (!input)
  {
    return 0;
  }
  vtkInformation* model = outputs->GetInformationObject(ModelPort);
  vtkDataObject* output = vtkDataObject::GetData(model);
  if (!output || std::string(output->GetClassName()) != input->GetClassName())
  {
    vtkSmartPointer<vtkDataObject> made;
    made.TakeReference(input->NewInstance());
    model->Set(vtkDataObject::DATA_OBJECT(), made);
  }
  vtkInformation* lattice = outputs->GetInformationObject(LatticePort);
  if (!vtkStructuredGrid::GetData(lattice))
  {
    vtkNew<vtkStructuredGrid> made;
    lattice->Set(vtkDataObject::DATA_OBJECT(), made);
  }
  return 1;
}

int vtkNURBSFreeFormDeformation::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  const int extent[6] = { 0, this->Dimensions[0] - 1, 0, this->Dimensions[1] - 1, 0,
    this->Dimensions[2] - 1 };
  outputs->GetInformationObject(LatticePort)
    ->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
  return 1;
}

int vtkNURBSFreeFormDeformation::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const vtkNURBSPieces pieces(request, outputs);
  if (pieces.GetRank() > 0 || (pieces.IsParallel() && this->HasFailed))
  {
    // The first process has the lattice. Who is asked for more than he makes would be asked again, and
    // wait for the others, who are not.
    static const int nothing[6] = { 0, -1, 0, -1, 0, -1 };
    outputs->GetInformationObject(LatticePort)->Set(Pipeline::UPDATE_EXTENT(), nothing, 6);
  }
  vtkInformation* places = inputs[LatticePort]->GetInformationObject(0);
  if (places && places->Has(Pipeline::WHOLE_EXTENT()))
  {
    places->Set(Pipeline::UPDATE_EXTENT(), places->Get(Pipeline::WHOLE_EXTENT()), 6);
  }
  return 1;
}

nurbs::FreeFormLattice vtkNURBSFreeFormDeformation::MakeLattice(
  const Grids& models, vtkPointSet* places, const vtkNURBSPieces& pieces) const
{
  const double* b = this->Bounds;
  nurbs::Box3 box(nurbs::Vec3(b[0], b[2], b[4]), nurbs::Vec3(b[1], b[3], b[5]));
  const nurbs::Box3 around = this->UseInputBounds ? BoxOf(models, pieces) : nurbs::Box3();
  if (!around.isEmpty())
  {
    box = Widened(around, this->Margin);
  }
  if (!((box.max() - box.min()).minCoeff<Eigen::PropagateNaN>() > 0.0))
  {
    throw nurbs::Error("the lattice's Bounds are flat, turned over or not a number");
  }
  const int* n = this->Dimensions;
  const int* p = this->Degree;
  nurbs::FreeFormLattice lattice(
    nurbs::LatticeBox::Of(box), { { n[0], n[1], n[2] } }, { { p[0], p[1], p[2] } });
  std::vector<double> displacements = this->Displacements;
  if (places)
  {
    CheckDimensions(vtkStructuredGrid::SafeDownCast(places), this->Dimensions);
    AddPlaces(PlacesOfAll(places->GetPoints(), pieces), "input 1", lattice, displacements);
  }
  else if (this->Lattice)
  {
    AddPlaces(this->Lattice, "SetLattice", lattice, displacements);
  }
  lattice.SetDisplacements(displacements, this->FrozenLayers);
  return lattice;
}

// Gives the models new points. Kept arrays are written in place, if they are nobody's input.
void vtkNURBSFreeFormDeformation::Deform(const nurbs::FreeFormLattice& lattice, const Grids& models)
{
  std::set<vtkDataArray*> inputs;
  for (vtkUnstructuredGrid* model : models)
  {
    inputs.insert(model->GetPoints() ? model->GetPoints()->GetData() : nullptr);
  }
  this->Kept.resize(models.size());
  for (std::size_t m = 0; m < models.size() && !this->GetAbortExecute(); ++m)
  {
    vtkPoints* points = models[m]->GetPoints();
    if (!points)
    {
      continue;
    }
    const vtkIdType count = points->GetNumberOfPoints();
    vtkSmartPointer<vtkPoints>& kept = this->Kept[m];
    if (!kept || kept->GetNumberOfPoints() != count || inputs.count(kept->GetData()) > 0)
    {
      kept = NewPoints(count);
    }
    const auto from = Coordinates(points);
    const nurbs::LatticeMoves moves = lattice.Map(from->GetPointer(0), count,
      vtkDoubleArray::SafeDownCast(kept->GetData())->GetPointer(0),
      count < FewPoints ? nurbs::ParallelFor(nurbs::SerialFor) : vtkNURBSParallelFor);
    if (moves.Changed)
    {
      kept->Modified();
    }
    this->NumberOfMovedPoints += moves.Moved;
    models[m]->SetPoints(kept);
    this->UpdateProgress(double(m + 1) / models.size());
  }
}

void vtkNURBSFreeFormDeformation::FillLattice(
  const nurbs::FreeFormLattice& lattice, vtkStructuredGrid* output) const
{
  const auto points = NewPoints(lattice.Size());
  vtkNew<vtkDoubleArray> displacements;
  displacements->SetName("Displacement");
  displacements->SetNumberOfComponents(3);
  displacements->SetNumberOfTuples(lattice.Size());
  for (vtkIdType n = 0; n < lattice.Size(); ++n)
  {
    const nurbs::Vec3 displacement = lattice.Displacement(n);
    const nurbs::Vec3 place = lattice.RestPoint(n) + displacement;
    points->SetPoint(n, place.data());
    displacements->SetTuple(n, displacement.data());
  }
  output->SetDimensions(lattice.Count(0), lattice.Count(1), lattice.Count(2));
  output->SetPoints(points);
  output->GetPointData()->SetVectors(displacements);
}

int vtkNURBSFreeFormDeformation::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[ModelPort]);
  vtkDataObject* output = vtkDataObject::GetData(outputs, ModelPort);
  vtkStructuredGrid* shown = vtkStructuredGrid::GetData(outputs, LatticePort);
  this->NumberOfMovedPoints = 0;
  const vtkNURBSParallelScope parallel;
  const vtkNURBSPieces pieces(request, outputs);
  std::string problem;
  const auto outcome = pieces.Run(
    [&]() {
      const Grids models = ShareModels(input, output);
      const nurbs::FreeFormLattice lattice =
        this->MakeLattice(models, vtkPointSet::GetData(inputs[LatticePort]), pieces);
      this->Deform(lattice, models);
      if (this->GetAbortExecute())
      {
        return false;
      }
      pieces.Sum(&this->NumberOfMovedPoints, 1);
      // There is one lattice, whatever pieces of the model there are.
      shown->Initialize();
      if (pieces.GetRank() == 0)
      {
        this->FillLattice(lattice, shown);
      }
      return true;
    },
    problem);
  this->SetErrorCode(
    outcome == vtkNURBSPieces::FAILED ? vtkErrorCode::UserError : vtkErrorCode::NoError);
  this->HasFailed = outcome != vtkNURBSPieces::DONE;
  if (!this->HasFailed)
  {
    return 1;
  }
  output->Initialize();
  shown->Initialize();
  if (outcome == vtkNURBSPieces::ABORTED)
  {
    return 1;
  }
  vtkErrorMacro("Free-form deformation: " << problem);
  return 0;
}

void vtkNURBSFreeFormDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  const auto print = [&](const char* name, const auto& values) {
    os << indent << name << ":";
    for (const auto value : values)
    {
      os << " " << value;
    }
    os << "\n";
  };
  print("Dimensions", this->Dimensions);
  print("Degree", this->Degree);
  os << indent << "UseInputBounds: " << (this->UseInputBounds ? "On\n" : "Off\n");
  os << indent << "Margin: " << this->Margin << "\n";
  print("Bounds", this->Bounds);
  os << indent << "FrozenLayers: " << this->FrozenLayers << "\n";
  os << indent << "Lattice: " << this->Lattice.GetPointer() << "\n";
  os << indent << "NumberOfMovedPoints: " << this->NumberOfMovedPoints << "\n";
}
