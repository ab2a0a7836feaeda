// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSControlPointEdits.h"

#include "vtkNURBSEditedModel.h"
#include "vtkNURBSModel.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNURBSPieces.h"
#include "vtkObjectFactory.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

vtkStandardNewMacro(vtkNURBSControlPointEdits);

namespace
{

constexpr std::int64_t FirstModel = -1; // Block of an edit that names none.
constexpr std::size_t MaxNamedPoints = 8;

// Calls visit(leaf, flat index) for each data set until it returns false.
template <typename F>
void VisitLeaves(vtkDataObject* input, const F& visit)
{
  auto* composite = vtkCompositeDataSet::SafeDownCast(input);
  if (!composite)
  {
    if (input)
    {
      visit(input, 0u);
    }
    return;
  }
  vtkSmartPointer<vtkCompositeDataIterator> at;
  at.TakeReference(composite->NewIterator());
  for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
  {
    if (!visit(at->GetCurrentDataObject(), at->GetCurrentFlatIndex()))
    {
      return;
    }
  }
}

// The leaf as a model that has points; else null.
vtkUnstructuredGrid* AsModel(vtkDataObject* leaf)
{
  auto* grid = vtkUnstructuredGrid::SafeDownCast(leaf);
  return grid && grid->GetNumberOfPoints() > 0 && vtkNURBSModel::IsModel(grid) ? grid : nullptr;
}

bool HasModel(vtkDataObject* input)
{
  bool found = false;
  VisitLeaves(input, [&](vtkDataObject* leaf, unsigned int) {
    found = AsModel(leaf) != nullptr;
    return !found;
  });
  return found;
}

std::vector<vtkIdType> Values(vtkIdTypeArray* array)
{
  return array ? std::vector<vtkIdType>(
                   array->GetPointer(0), array->GetPointer(0) + array->GetNumberOfValues())
               : std::vector<vtkIdType>();
}

} // namespace

// An edit as it was asked for.
struct vtkNURBSControlPointEdits::vtkEdit
{
  enum KindType
  {
    MOVE,
    PLACE,
    WEIGHT,
    SCALE_WEIGHT,
    RESET
  };
  KindType Kind;
  std::int64_t Block;
  std::vector<vtkIdType> Points;
  nurbs::Vec3 Value = nurbs::Vec3::Zero(); // Displacement or place.
  double Weight = 1.0;                     // Weight or factor.

  // What can be said without the input: why the edit is senseless, or "".
  std::string Check() const
  {
    if ((this->Kind == MOVE || this->Kind == PLACE) && !this->Value.allFinite())
    {
      return this->Kind == MOVE ? "its displacement is not finite" : "its place is not finite";
    }
    if ((this->Kind == WEIGHT || this->Kind == SCALE_WEIGHT) &&
      !(this->Weight > 0.0 && std::isfinite(this->Weight)))
    {
      std::ostringstream text;
      text << "its weight" << (this->Kind == WEIGHT ? " is " : " is multiplied by ") << this->Weight
           << ", which must be positive and finite";
      return text.str();
    }
    return std::string();
  }
};

struct vtkNURBSControlPointEdits::vtkInternals
{
  nurbs::EditHistory History;
  std::vector<vtkEdit> Waiting; // For the input's data.
  std::map<std::int64_t, vtkNURBSEditedModel> Models;
  std::map<std::int64_t, std::vector<vtkIdType>> Touched; // Since the output of the block was made.
  std::unique_ptr<vtkNURBSPieces> Pieces;                 // Of the last request.
  vtkDataObject* Whole = nullptr; // All processes' models; null: there are no other processes.

  // The model of a block (FirstModel: of the first that is one), null if there is none. `block` is
  // then its flat index.
  vtkNURBSEditedModel* Find(vtkDataObject* input, std::int64_t& block)
  {
    vtkNURBSEditedModel* model = nullptr;
    VisitLeaves(input, [&](vtkDataObject* leaf, unsigned int index) {
      vtkUnstructuredGrid* grid =
        block == FirstModel || block == std::int64_t(index) ? AsModel(leaf) : nullptr;
      if (grid)
      {
        block = index;
        model = &this->Models[block];
        model->SetInput(grid);
      }
      return !grid;
    });
    return model;
  }

  // Place and weight at present.
  nurbs::Vec3 Place(const vtkNURBSEditedModel& model, const nurbs::ControlPointKey& key) const
  {
    return this->History.Find(key).Apply(model.GetPlace(key.Point));
  }
  double Weight(const vtkNURBSEditedModel& model, const nurbs::ControlPointKey& key) const
  {
    const double weight = this->History.Find(key).Weight;
    return weight > 0.0 ? weight : model.GetWeight(key.Point);
  }

  nurbs::ControlPointEdit Edited(
    const vtkNURBSEditedModel& model, const vtkEdit& edit, const nurbs::ControlPointKey& key) const;
};

// What `edit` makes of the point `key`, which it names or which coincides with one that it names.
nurbs::ControlPointEdit vtkNURBSControlPointEdits::vtkInternals::Edited(
  const vtkNURBSEditedModel& model, const vtkEdit& edit, const nurbs::ControlPointKey& key) const
{
  nurbs::ControlPointEdit after = this->History.Find(key);
  const nurbs::ControlPointKey named{ key.Block, edit.Points.front() };
  switch (edit.Kind)
  {
    case vtkEdit::MOVE:
      return after.Moved(edit.Value);
    case vtkEdit::PLACE:
    {
      const nurbs::Vec3 offset = this->Place(model, key) - this->Place(model, named);
      after.Kind = nurbs::ControlPointEdit::Place::Absolute;
      after.Value = edit.Value + offset;
      return after;
    }
    case vtkEdit::WEIGHT:
      after.Weight = key == named
        ? edit.Weight
        : edit.Weight * (this->Weight(model, key) / this->Weight(model, named));
      return after;
    case vtkEdit::SCALE_WEIGHT:
      after.Weight = this->Weight(model, key) * edit.Weight;
      return after;
    default:
      return nurbs::ControlPointEdit();
  }
}

vtkNURBSControlPointEdits::vtkNURBSControlPointEdits()
  : Internals(new vtkInternals)
{}

vtkNURBSControlPointEdits::~vtkNURBSControlPointEdits() = default;

int vtkNURBSControlPointEdits::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

bool vtkNURBSControlPointEdits::Accept(const vtkEdit& edit)
{
  if (edit.Points.empty())
  {
    return true;
  }
  if (HasModel(this->EditedInput()))
  {
    this->ResolveWaiting();
    if (!this->Resolve(edit))
    {
      return false;
    }
  }
  else
  {
    const std::string problem = edit.Points.front() < 0 ? "there is no such point" : edit.Check();
    if (!problem.empty())
    {
      vtkErrorMacro("Edit refused: control point " << edit.Points.front() << ": " << problem);
      return false;
    }
    this->Internals->Waiting.push_back(edit);
  }
  this->Modified();
  return true;
}

// Checks an edit against the input, and commits it.
bool vtkNURBSControlPointEdits::Resolve(const vtkEdit& edit)
{
  vtkInternals& self = *this->Internals;
  std::int64_t block = edit.Block;
  vtkNURBSEditedModel* model = self.Find(this->EditedInput(), block);
  if (!model)
  {
    vtkErrorMacro("Edit refused: block " << block << " is no NURBS model with control points");
    return false;
  }
  const auto refuse = [&](vtkIdType point, const std::string& problem) {
    vtkErrorMacro(
      "Edit refused: " << model->Describe(point) << " of block " << block << ": " << problem);
    return false;
  };
  const std::string senseless = edit.Check();
  std::vector<vtkIdType> points, group;
  const double tolerance = this->CoincidenceTolerance * model->GetDiagonal();
  for (const vtkIdType point : edit.Points)
  {
    if (point < 0 || point >= model->GetNumberOfPoints())
    {
      return refuse(point,
        "the model has control points 0 to " + std::to_string(model->GetNumberOfPoints() - 1));
    }
    if (!senseless.empty())
    {
      return refuse(point, senseless);
    }
    group.assign(1, point);
    if (this->MoveCoincident)
    {
      model->FindCoincident(point, tolerance, group);
    }
    points.insert(points.end(), group.begin(), group.end());
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());

  std::vector<nurbs::EditHistory::Change> changes;
  changes.reserve(points.size());
  for (const vtkIdType point : points)
  {
    const nurbs::ControlPointKey key{ block, point };
    changes.emplace_back(key, self.Edited(*model, edit, key));
    const nurbs::ControlPointEdit& after = changes.back().second;
    std::string problem = model->CheckPlace(after.Apply(model->GetPlace(point)));
    if (problem.empty() && (edit.Kind == vtkEdit::WEIGHT || edit.Kind == vtkEdit::SCALE_WEIGHT))
    {
      problem = model->CheckWeight(after.Weight);
    }
    if (!problem.empty() && edit.Kind != vtkEdit::RESET)
    {
      return refuse(point, problem);
    }
  }
  self.History.Commit(changes);
  return true;
}

void vtkNURBSControlPointEdits::ResolveWaiting()
{
  for (const vtkEdit& edit : std::exchange(this->Internals->Waiting, {}))
  {
    this->Resolve(edit);
  }
}

bool vtkNURBSControlPointEdits::MoveControlPoint(vtkIdType point, double dx, double dy, double dz)
{
  return this->Accept({ vtkEdit::MOVE, FirstModel, { point }, nurbs::Vec3(dx, dy, dz) });
}

bool vtkNURBSControlPointEdits::MoveBlockControlPoint(
  unsigned int block, vtkIdType point, double dx, double dy, double dz)
{
  return this->Accept({ vtkEdit::MOVE, block, { point }, nurbs::Vec3(dx, dy, dz) });
}

bool vtkNURBSControlPointEdits::SetControlPointPosition(
  vtkIdType point, double x, double y, double z)
{
  return this->Accept({ vtkEdit::PLACE, FirstModel, { point }, nurbs::Vec3(x, y, z) });
}

bool vtkNURBSControlPointEdits::SetBlockControlPointPosition(
  unsigned int block, vtkIdType point, double x, double y, double z)
{
  return this->Accept({ vtkEdit::PLACE, block, { point }, nurbs::Vec3(x, y, z) });
}

bool vtkNURBSControlPointEdits::SetControlPointWeight(vtkIdType point, double weight)
{
  return this->Accept({ vtkEdit::WEIGHT, FirstModel, { point }, nurbs::Vec3::Zero(), weight });
}

bool vtkNURBSControlPointEdits::SetBlockControlPointWeight(
  unsigned int block, vtkIdType point, double weight)
{
  return this->Accept({ vtkEdit::WEIGHT, block, { point }, nurbs::Vec3::Zero(), weight });
}

bool vtkNURBSControlPointEdits::MoveBlockControlPoints(
  unsigned int block, vtkIdTypeArray* points, double dx, double dy, double dz)
{
  return this->Accept({ vtkEdit::MOVE, block, Values(points), nurbs::Vec3(dx, dy, dz) });
}

bool vtkNURBSControlPointEdits::ScaleBlockControlPointWeights(
  unsigned int block, vtkIdTypeArray* points, double factor)
{
  return this->Accept(
    { vtkEdit::SCALE_WEIGHT, block, Values(points), nurbs::Vec3::Zero(), factor });
}

bool vtkNURBSControlPointEdits::ResetControlPoint(vtkIdType point)
{
  return this->Accept({ vtkEdit::RESET, FirstModel, { point } });
}

bool vtkNURBSControlPointEdits::ResetBlockControlPoint(unsigned int block, vtkIdType point)
{
  return this->Accept({ vtkEdit::RESET, block, { point } });
}

void vtkNURBSControlPointEdits::ResetControlPoints()
{
  vtkInternals& self = *this->Internals;
  self.Waiting.clear();
  std::vector<nurbs::EditHistory::Change> changes = self.History.All();
  for (nurbs::EditHistory::Change& change : changes)
  {
    change.second = nurbs::ControlPointEdit();
  }
  self.History.Commit(changes);
  this->Modified();
}

vtkIdType vtkNURBSControlPointEdits::GetNumberOfEdits()
{
  return vtkIdType(this->Internals->History.Size()) + vtkIdType(this->Internals->Waiting.size());
}

bool vtkNURBSControlPointEdits::GetBlockControlPoint(
  unsigned int block, vtkIdType point, double position[3])
{
  std::int64_t at = block;
  vtkNURBSEditedModel* model = this->Internals->Find(this->EditedInput(), at);
  if (!model || point < 0 || point >= model->GetNumberOfPoints())
  {
    return false;
  }
  const nurbs::Vec3 place = this->Internals->Place(*model, { at, point });
  std::copy_n(place.data(), 3, position);
  return true;
}

double vtkNURBSControlPointEdits::GetBlockControlPointWeight(unsigned int block, vtkIdType point)
{
  std::int64_t at = block;
  vtkNURBSEditedModel* model = this->Internals->Find(this->EditedInput(), at);
  return model && point >= 0 && point < model->GetNumberOfPoints()
    ? this->Internals->Weight(*model, { at, point })
    : 0.0;
}

void vtkNURBSControlPointEdits::GetCoincidentControlPoints(
  unsigned int block, vtkIdType point, vtkIdTypeArray* points)
{
  points->Initialize();
  std::int64_t at = block;
  vtkNURBSEditedModel* model = this->Internals->Find(this->EditedInput(), at);
  if (!model || point < 0 || point >= model->GetNumberOfPoints())
  {
    return;
  }
  std::vector<vtkIdType> group{ point };
  if (this->MoveCoincident)
  {
    model->FindCoincident(point, this->CoincidenceTolerance * model->GetDiagonal(), group);
  }
  for (const vtkIdType id : group)
  {
    points->InsertNextValue(id);
  }
}

bool vtkNURBSControlPointEdits::Undo()
{
  vtkInternals& self = *this->Internals;
  const bool isWaiting = !self.Waiting.empty();
  if (isWaiting)
  {
    self.Waiting.pop_back();
  }
  if (!isWaiting && !self.History.Undo())
  {
    return false;
  }
  this->Modified();
  return true;
}

bool vtkNURBSControlPointEdits::Redo()
{
  if (!this->Internals->Waiting.empty() || !this->Internals->History.Redo())
  {
    return false;
  }
  this->Modified();
  return true;
}

int vtkNURBSControlPointEdits::GetNumberOfUndos()
{
  return int(this->Internals->History.UndoCount() + this->Internals->Waiting.size());
}

int vtkNURBSControlPointEdits::GetNumberOfRedos()
{
  return int(this->Internals->History.RedoCount());
}

void vtkNURBSControlPointEdits::BeginGroup()
{
  this->Internals->History.BeginGroup();
}

void vtkNURBSControlPointEdits::EndGroup()
{
  this->Internals->History.EndGroup();
}

void vtkNURBSControlPointEdits::CancelGroup()
{
  this->Internals->History.CancelGroup();
  this->Modified();
}

// The output of one model; says which edits found no point there.
void vtkNURBSControlPointEdits::Fill(
  vtkNURBSEditedModel& model, unsigned int block, vtkUnstructuredGrid* output)
{
  vtkInternals& self = *this->Internals;
  const std::vector<vtkIdType> missing =
    model.Fill(output, self.History, block, self.Touched[block]);
  self.Touched[block].clear();
  if (missing.empty())
  {
    return;
  }
  std::ostringstream text;
  for (std::size_t k = 0; k < std::min(missing.size(), MaxNamedPoints); ++k)
  {
    text << (k ? ", " : "") << missing[k];
  }
  text << (missing.size() > MaxNamedPoints ? ", ..." : "");
  vtkErrorMacro("Edits left out: block " << block << " has no control point " << text.str());
}

// What edits are checked against; null: it is not there yet. A piece of a model says nothing of the points
// of the whole, which comes with the update that all processes make.
vtkDataObject* vtkNURBSControlPointEdits::EditedInput()
{
  if (this->Internals->Whole)
  {
    return this->Internals->Whole;
  }
  vtkDataObject* input = this->GetNumberOfInputConnections(0) > 0 ? this->GetInput() : nullptr;
  return vtkNURBSPieces::IsPiece(input) ? nullptr : input;
}

// Points are numbered over the models of all processes, and edits are checked against them.
void vtkNURBSControlPointEdits::Gather(vtkDataObject* input, std::unique_ptr<vtkNURBSPieces> pieces)
{
  vtkInternals& self = *this->Internals;
  const bool same = self.Pieces && self.Pieces->IsParallel() == pieces->IsParallel();
  if (same && pieces->IsParallel() && self.Pieces->IsUpToDate(input))
  {
    return;
  }
  self.Pieces = std::move(pieces);
  self.Whole = nullptr;
  if (self.Pieces->IsParallel())
  {
    self.Whole = self.Pieces->Gather(input);
  }
}

int vtkNURBSControlPointEdits::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkDataObject* input = vtkDataObject::GetData(inputs[0]);
  vtkDataObject* output = vtkDataObject::GetData(outputs);
  vtkInternals& self = *this->Internals;
  const vtkNURBSPieces pieces(request, outputs);
  std::string problem;
  const auto outcome = pieces.Run(
    [&]() {
      this->Gather(input, std::make_unique<vtkNURBSPieces>(request, outputs));
      this->BeforeEdits();
      this->Edit(self.Whole ? self.Whole : input, output);
      if (self.Whole)
      {
        self.Pieces->Keep(output);
      }
      return true;
    },
    problem);
  if (outcome != vtkNURBSPieces::DONE)
  {
    self.Pieces = nullptr;
    self.Whole = nullptr;
    output->ShallowCopy(input);
    vtkErrorMacro(<< problem);
  }
  return 1;
}

void vtkNURBSControlPointEdits::Edit(vtkDataObject* input, vtkDataObject* output)
{
  vtkInternals& self = *this->Internals;
  this->ResolveWaiting();
  for (const nurbs::ControlPointKey& key : self.History.TakeTouched())
  {
    self.Touched[key.Block].push_back(key.Point);
  }

  auto* from = vtkCompositeDataSet::SafeDownCast(input);
  auto* to = vtkCompositeDataSet::SafeDownCast(output);
  if (!from)
  {
    if (!AsModel(input))
    {
      output->ShallowCopy(input);
      if (input->GetNumberOfElements(vtkDataObject::CELL) > 0)
      {
        vtkErrorMacro("The input is no NURBS model");
      }
      return;
    }
    vtkNURBSEditedModel& model = self.Models[0];
    model.SetInput(AsModel(input));
    this->Fill(model, 0, vtkUnstructuredGrid::SafeDownCast(output));
    return;
  }
  output->ShallowCopy(input);
  vtkSmartPointer<vtkCompositeDataIterator> at;
  at.TakeReference(from->NewIterator());
  for (at->InitTraversal(); !at->IsDoneWithTraversal(); at->GoToNextItem())
  {
    vtkUnstructuredGrid* grid = AsModel(at->GetCurrentDataObject());
    if (!grid)
    {
      continue;
    }
    const unsigned int block = at->GetCurrentFlatIndex();
    vtkNURBSEditedModel& model = self.Models[block];
    model.SetInput(grid);
    if (!model.Output || model.FilledTime != grid->GetMTime() || !self.Touched[block].empty())
    {
      // Grids that are kept, so that those that did not change keep their time.
      model.Output = model.Output ? model.Output : vtkSmartPointer<vtkUnstructuredGrid>::New();
      model.FilledTime = grid->GetMTime();
      this->Fill(model, block, model.Output);
    }
    to->SetDataSet(at, model.Output);
  }
}

void vtkNURBSControlPointEdits::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MoveCoincident: " << (this->MoveCoincident ? "On\n" : "Off\n");
  os << indent << "CoincidenceTolerance: " << this->CoincidenceTolerance << "\n";
  os << indent << "NumberOfEdits: " << this->GetNumberOfEdits() << "\n";
  os << indent << "NumberOfUndos: " << this->GetNumberOfUndos() << "\n";
  os << indent << "NumberOfRedos: " << this->GetNumberOfRedos() << "\n";
}
