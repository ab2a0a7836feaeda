// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSControlPointRepresentation.h"

#include "HandleSearch.h"
#include "vtkNURBSControlPointEdits.h"
#include "vtkNURBSHandleLayer.h"
#include "vtkNURBSHandleSet.h"
#include "vtkNURBSParallel.h"
#include "vtkNURBSScreen.h"

#include "vtkActor2D.h"
#include "vtkCellArray.h"
#include "vtkIdTypeArray.h"
#include "vtkMath.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyDataMapper2D.h"
#include "vtkProperty2D.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

vtkStandardNewMacro(vtkNURBSControlPointRepresentation);

namespace
{

constexpr double PickSlack = 1.5;      // Pixels in which the depth decides.
constexpr std::size_t MaxHits = 256;   // The nearest to the cursor that are looked at closer.
constexpr double EmphasizedPixels = 2; // How much larger selected handles are.

using Name = std::pair<unsigned int, vtkIdType>; // Block and point.

} // namespace

struct vtkNURBSControlPointRepresentation::vtkInternals
{
  vtkSmartPointer<vtkNURBSControlPointEdits> Edits;
  vtkNURBSHandleSet Set;
  vtkMTimeType SetTime = 0; // Of the data that Set was made from.
  vtkDataObject* SetData = nullptr;

  std::vector<Name> Selection;
  std::set<Name> Selected;
  Name Hovered{ 0, -1 };

  // A drag: the handle that was picked, and where the cursor was beside it.
  nurbs::Vec3 DragPlace = nurbs::Vec3::Zero();
  nurbs::Vec3 DragNormal = nurbs::Vec3::Zero();
  bool IsNormalKnown = false;
  Name DragHandle;
  nurbs::Vec2 GrabOffset = nurbs::Vec2::Zero();
  nurbs::Vec2 Cursor = nurbs::Vec2::Zero();
  nurbs::Vec2 BoxStart = nurbs::Vec2::Zero();

  vtkNURBSHandleLayer Net{ vtkNURBSHandleLayer::LINES };
  vtkNURBSHandleLayer Handles{ vtkNURBSHandleLayer::DISCS };
  vtkNURBSHandleLayer SelectedHandles{ vtkNURBSHandleLayer::DISCS };
  vtkNURBSHandleLayer HoveredHandle{ vtkNURBSHandleLayer::DISCS };
  vtkSmartPointer<vtkCellArray> NetLines, HandleVertices;
  int NetShown = -1;
  bool IsTopologyNew = true, ArePointsNew = true, IsSelectionNew = true;
  vtkSmartPointer<vtkActor2D> BoxActor;
  vtkNew<vtkPolyData> BoxOutline;

  bool Select(const Name& name)
  {
    if (this->Set.GetHandle(name.first, name.second) < 0 || !this->Selected.insert(name).second)
    {
      return false;
    }
    this->Selection.push_back(name);
    this->IsSelectionNew = true;
    return true;
  }

  // Drops what is not there any more.
  void KeepExisting()
  {
    const auto gone = [&](const Name& name) {
      return this->Set.GetHandle(name.first, name.second) < 0;
    };
    this->Selection.erase(
      std::remove_if(this->Selection.begin(), this->Selection.end(), gone), this->Selection.end());
    this->Selected = std::set<Name>(this->Selection.begin(), this->Selection.end());
    this->IsSelectionNew = true;
    if (gone(this->Hovered))
    {
      this->Hovered = Name(0, -1);
    }
  }

  nurbs::Vec3 Place(const Name& name)
  {
    const std::int64_t handle = this->Set.GetHandle(name.first, name.second);
    return Eigen::Map<const nurbs::Vec3>(this->Set.GetCoordinates() + 3 * handle);
  }

  // Copies of some handles, as vertices.
  void Show(vtkNURBSHandleLayer& layer, const std::vector<Name>& names)
  {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    vtkNew<vtkCellArray> vertices;
    for (const Name& name : names)
    {
      const vtkIdType id = points->InsertNextPoint(this->Place(name).data());
      vertices->InsertNextCell(1, &id);
    }
    layer.SetCells(points, vertices);
  }

  // The selection by blocks.
  std::map<unsigned int, vtkSmartPointer<vtkIdTypeArray>> Blocks() const
  {
    std::map<unsigned int, vtkSmartPointer<vtkIdTypeArray>> blocks;
    for (const Name& name : this->Selection)
    {
      vtkSmartPointer<vtkIdTypeArray>& points = blocks[name.first];
      points = points ? points : vtkSmartPointer<vtkIdTypeArray>::New();
      points->InsertNextValue(name.second);
    }
    return blocks;
  }
};

vtkNURBSControlPointRepresentation::vtkNURBSControlPointRepresentation()
  : Internals(new vtkInternals)
{
  this->HandleSize = 7.0;
  this->InteractionState = Outside;
  this->PickableOff();
  vtkMath::UninitializeBounds(this->HandleBounds);
}

vtkNURBSControlPointRepresentation::~vtkNURBSControlPointRepresentation() = default;

void vtkNURBSControlPointRepresentation::SetEdits(vtkNURBSControlPointEdits* edits)
{
  vtkInternals& self = *this->Internals;
  if (self.Edits == edits)
  {
    return;
  }
  this->CancelInteraction();
  self.Edits = edits;
  self.Selection.clear();
  self.Set.Clear();
  self.SetData = nullptr;
  self.KeepExisting();
  self.IsTopologyNew = self.ArePointsNew = true;
  this->Modified();
}

vtkNURBSControlPointEdits* vtkNURBSControlPointRepresentation::GetEdits()
{
  return this->Internals->Edits;
}

void vtkNURBSControlPointRepresentation::UpdateHandles()
{
  vtkInternals& self = *this->Internals;
  vtkDataObject* data = nullptr;
  if (self.Edits && self.Edits->GetNumberOfInputConnections(0) > 0)
  {
    self.Edits->Update();
    data = self.Edits->GetOutputDataObject(0);
  }
  if (data == self.SetData && (!data || data->GetUpdateTime() == self.SetTime))
  {
    return;
  }
  self.SetData = data;
  self.SetTime = data ? data->GetUpdateTime() : 0;
  self.ArePointsNew = true;
  if (self.Set.Update(data))
  {
    self.IsTopologyNew = true;
    self.KeepExisting();
    if (this->InteractionState == Dragging)
    {
      this->CancelInteraction();
    }
  }
}

bool vtkNURBSControlPointRepresentation::SelectControlPoint(unsigned int block, vtkIdType point)
{
  this->UpdateHandles();
  this->Internals->Select({ block, point });
  return this->IsSelected(block, point);
}

bool vtkNURBSControlPointRepresentation::DeselectControlPoint(unsigned int block, vtkIdType point)
{
  vtkInternals& self = *this->Internals;
  if (self.Selected.erase({ block, point }) == 0)
  {
    return false;
  }
  self.Selection.erase(std::find(self.Selection.begin(), self.Selection.end(), Name(block, point)));
  self.IsSelectionNew = true;
  return true;
}

bool vtkNURBSControlPointRepresentation::IsSelected(unsigned int block, vtkIdType point)
{
  return this->Internals->Selected.count({ block, point }) > 0;
}

void vtkNURBSControlPointRepresentation::SelectAll()
{
  this->UpdateHandles();
  vtkInternals& self = *this->Internals;
  for (const std::int64_t handle : self.Set.GetHandles())
  {
    self.Select({ self.Set.GetBlock(handle), self.Set.GetPointId(handle) });
  }
}

void vtkNURBSControlPointRepresentation::ClearSelection()
{
  this->Internals->Selection.clear();
  this->Internals->Selected.clear();
  this->Internals->IsSelectionNew = true;
}

vtkIdType vtkNURBSControlPointRepresentation::GetNumberOfSelectedControlPoints()
{
  return vtkIdType(this->Internals->Selection.size());
}

unsigned int vtkNURBSControlPointRepresentation::GetSelectedBlock(vtkIdType index)
{
  return index >= 0 && index < this->GetNumberOfSelectedControlPoints()
    ? this->Internals->Selection[std::size_t(index)].first
    : 0;
}

vtkIdType vtkNURBSControlPointRepresentation::GetSelectedControlPoint(vtkIdType index)
{
  return index >= 0 && index < this->GetNumberOfSelectedControlPoints()
    ? this->Internals->Selection[std::size_t(index)].second
    : -1;
}

vtkIdType vtkNURBSControlPointRepresentation::SelectBox(double x1, double y1, double x2, double y2)
{
  this->UpdateHandles();
  vtkInternals& self = *this->Internals;
  nurbs::ScreenView view;
  if (!vtkNURBSScreen::MakeView(this->Renderer, view))
  {
    return 0;
  }
  nurbs::Box2 box(nurbs::Vec2(x1, y1));
  box.extend(nurbs::Vec2(x2, y2));
  const auto inside =
    nurbs::FindHandlesInBox(view, self.Set.GetCoordinates(), self.Set.GetHandles(), box);
  for (const std::int64_t handle : inside)
  {
    self.Select({ self.Set.GetBlock(handle), self.Set.GetPointId(handle) });
  }
  return vtkIdType(inside.size());
}

bool vtkNURBSControlPointRepresentation::Pick(double x, double y)
{
  this->UpdateHandles();
  vtkInternals& self = *this->Internals;
  self.Hovered = Name(0, -1);
  nurbs::ScreenView view;
  if (self.Set.GetHandles().empty() || !vtkNURBSScreen::MakeView(this->Renderer, view))
  {
    return false;
  }
  const vtkNURBSParallelScope parallel;
  std::vector<nurbs::HandleHit> hits = nurbs::FindHandles(view, self.Set.GetCoordinates(),
    self.Set.GetHandles(), nurbs::Vec2(x, y), this->PickRadius, vtkNURBSParallelFor);
  hits.resize(std::min(hits.size(), MaxHits));
  std::vector<bool> hidden(hits.size(), false);
  if (this->HiddenHandles != SHOW)
  {
    hidden = vtkNURBSScreen::FindHidden(this->Renderer, view, hits, this->HandleSize);
  }
  if (this->HiddenHandles == HIDE && std::find(hidden.begin(), hidden.end(), false) == hidden.end())
  {
    return false;
  }
  const std::int64_t handle = nurbs::ChooseHandle(hits, hidden, PickSlack).Point;
  if (handle < 0)
  {
    return false;
  }
  self.Hovered = Name(self.Set.GetBlock(handle), self.Set.GetPointId(handle));
  return true;
}

vtkIdType vtkNURBSControlPointRepresentation::GetHoveredControlPoint()
{
  return this->Internals->Hovered.second;
}

unsigned int vtkNURBSControlPointRepresentation::GetHoveredBlock()
{
  return this->Internals->Hovered.first;
}

vtkIdType vtkNURBSControlPointRepresentation::GetNumberOfHandles()
{
  this->UpdateHandles();
  return vtkIdType(this->Internals->Set.GetHandles().size());
}

bool vtkNURBSControlPointRepresentation::GetHandleDisplayPosition(
  unsigned int block, vtkIdType point, double display[3])
{
  this->UpdateHandles();
  nurbs::ScreenView view;
  nurbs::Vec3 found;
  if (this->Internals->Set.GetHandle(block, point) < 0 ||
    !vtkNURBSScreen::MakeView(this->Renderer, view) ||
    !view.Project(this->Internals->Place({ block, point }), found))
  {
    return false;
  }
  std::copy_n(found.data(), 3, display);
  return true;
}

bool vtkNURBSControlPointRepresentation::ScaleSelectedWeights(double factor)
{
  vtkInternals& self = *this->Internals;
  if (!self.Edits || self.Selection.empty() || this->InteractionState == Dragging)
  {
    return false;
  }
  self.Edits->BeginGroup();
  for (const auto& block : self.Blocks())
  {
    if (!self.Edits->ScaleBlockControlPointWeights(block.first, block.second, factor))
    {
      self.Edits->CancelGroup();
      return false;
    }
  }
  self.Edits->EndGroup();
  return true;
}

void vtkNURBSControlPointRepresentation::SetConstraint(int constraint)
{
  constraint = std::min(std::max(constraint, int(VIEW_PLANE)), int(SURFACE_NORMAL));
  if (constraint == this->Constraint)
  {
    return;
  }
  this->Constraint = constraint;
  if (this->InteractionState == Dragging)
  {
    this->Drag();
  }
  this->Modified();
}

int vtkNURBSControlPointRepresentation::ComputeInteractionState(int x, int y, int)
{
  if (this->InteractionState == Outside || this->InteractionState == OnHandle)
  {
    this->InteractionState = this->Pick(x, y) ? OnHandle : Outside;
  }
  return this->InteractionState;
}

void vtkNURBSControlPointRepresentation::StartWidgetInteraction(double position[2])
{
  vtkInternals& self = *this->Internals;
  nurbs::ScreenView view;
  double display[3];
  if (self.Hovered.second < 0 || !vtkNURBSScreen::MakeView(this->Renderer, view) ||
    !this->GetHandleDisplayPosition(self.Hovered.first, self.Hovered.second, display))
  {
    return;
  }
  self.DragHandle = self.Hovered;
  self.DragPlace = self.Place(self.DragHandle);
  self.IsNormalKnown = false;
  self.Cursor = nurbs::Vec2(position[0], position[1]);
  self.GrabOffset = self.Cursor - nurbs::Vec2(display[0], display[1]);
  std::fill_n(this->Displacement, 3, 0.0);
  this->InteractionState = Dragging;
  self.Edits->BeginGroup();
}

void vtkNURBSControlPointRepresentation::WidgetInteraction(double position[2])
{
  this->Internals->Cursor = nurbs::Vec2(position[0], position[1]);
  if (this->InteractionState == Dragging)
  {
    this->Drag();
  }
}

// Moves the selection from where it was when the drag began to where the cursor wants it.
void vtkNURBSControlPointRepresentation::Drag()
{
  vtkInternals& self = *this->Internals;
  nurbs::ScreenView view;
  nurbs::Vec3 display;
  if (!vtkNURBSScreen::MakeView(this->Renderer, view) || !view.Project(self.DragPlace, display))
  {
    return;
  }
  if (this->Constraint == SURFACE_NORMAL && !self.IsNormalKnown)
  {
    self.Edits->CancelGroup(); // The normal is that before the drag.
    this->UpdateHandles();
    self.DragNormal =
      self.Set.GetNormal(self.Set.GetHandle(self.DragHandle.first, self.DragHandle.second));
    self.IsNormalKnown = true;
  }
  const nurbs::Vec2 target = self.Cursor - self.GrabOffset;
  nurbs::Vec3 displacement;
  if (this->Constraint == VIEW_PLANE)
  {
    displacement =
      view.Unproject(nurbs::Vec3(target[0], target[1], display[2])) - view.Unproject(display);
  }
  else
  {
    const nurbs::Vec3 direction = this->Constraint == SURFACE_NORMAL
      ? self.DragNormal
      : nurbs::Vec3(nurbs::Vec3::Unit(this->Constraint - X_AXIS));
    displacement = nurbs::NearestOnLine(view, target, self.DragPlace, direction) * direction -
      nurbs::NearestOnLine(view, display.head<2>(), self.DragPlace, direction) * direction;
  }
  std::copy_n(displacement.data(), 3, this->Displacement);
  if (!this->MoveSelection())
  {
    std::fill_n(this->Displacement, 3, 0.0);
  }
}

// Replaces the edits of the drag so far, so that the last one is all that counts.
bool vtkNURBSControlPointRepresentation::MoveSelection()
{
  vtkInternals& self = *this->Internals;
  const double* d = this->Displacement;
  self.Edits->CancelGroup();
  self.Edits->BeginGroup();
  for (const auto& block : self.Blocks())
  {
    if (!self.Edits->MoveBlockControlPoints(block.first, block.second, d[0], d[1], d[2]))
    {
      self.Edits->CancelGroup();
      self.Edits->BeginGroup();
      return false;
    }
  }
  return true;
}

void vtkNURBSControlPointRepresentation::EndWidgetInteraction(double position[2])
{
  vtkInternals& self = *this->Internals;
  if (this->InteractionState == Dragging)
  {
    self.Edits->EndGroup();
  }
  else if (this->InteractionState == BoxSelecting)
  {
    this->SelectBox(self.BoxStart[0], self.BoxStart[1], position[0], position[1]);
  }
  this->InteractionState = Outside;
}

void vtkNURBSControlPointRepresentation::StartBoxSelection(double position[2])
{
  this->Internals->BoxStart = this->Internals->Cursor = nurbs::Vec2(position[0], position[1]);
  this->InteractionState = BoxSelecting;
}

void vtkNURBSControlPointRepresentation::CancelInteraction()
{
  if (this->InteractionState == Dragging)
  {
    this->Internals->Edits->CancelGroup();
    std::fill_n(this->Displacement, 3, 0.0);
  }
  this->InteractionState = Outside;
}

void vtkNURBSControlPointRepresentation::Highlight(int on)
{
  if (!on)
  {
    this->Internals->Hovered = Name(0, -1);
  }
}

void vtkNURBSControlPointRepresentation::PlaceWidget(double bounds[6])
{
  double placed[6], center[3];
  this->AdjustBounds(bounds, placed, center);
  std::copy_n(placed, 6, this->InitialBounds);
  this->InitialLength =
    std::sqrt(vtkMath::Distance2BetweenPoints(nurbs::Vec3(placed[0], placed[2], placed[4]).data(),
      nurbs::Vec3(placed[1], placed[3], placed[5]).data()));
  this->Placed = 1;
  this->BuildRepresentation();
}

void vtkNURBSControlPointRepresentation::BuildRepresentation()
{
  this->UpdateHandles();
  if (this->Renderer && this->Renderer->GetRenderWindow())
  {
    this->UpdateStyles();
    this->UpdateLayers();
  }
  this->BuildTime.Modified();
}

void vtkNURBSControlPointRepresentation::UpdateStyles()
{
  vtkInternals& self = *this->Internals;
  const double visible = this->HiddenHandles == SHOW ? 0.0 : 1.0;
  const double hidden = this->HiddenHandles == SHOW ? 1.0
    : this->HiddenHandles == FAINT                  ? this->HiddenOpacity
                                                    : 0.0;
  const double large = this->HandleSize + EmphasizedPixels;
  self.Net.SetStyle(this->NetColor, this->NetWidth, visible, hidden);
  self.Handles.SetStyle(this->HandleColor, this->HandleSize, visible, hidden);
  self.SelectedHandles.SetStyle(this->SelectedColor, large, visible, hidden);
  self.HoveredHandle.SetStyle(this->HoverColor, large, 0.0, 1.0);
}

void vtkNURBSControlPointRepresentation::UpdateLayers()
{
  vtkInternals& self = *this->Internals;
  vtkPoints* points = self.Set.GetPoints();
  if (self.IsTopologyNew)
  {
    const std::vector<std::int64_t>& handles = self.Set.GetHandles();
    self.HandleVertices = vtkSmartPointer<vtkCellArray>::New();
    self.HandleVertices->InsertNextCell(int(handles.size()));
    for (const std::int64_t handle : handles)
    {
      self.HandleVertices->InsertCellPoint(handle);
    }
  }
  if (self.IsTopologyNew || self.NetShown != this->Net ||
    (self.IsSelectionNew && this->Net == NET_OF_SELECTED_FACES))
  {
    std::vector<std::int64_t> selected;
    for (const Name& name : self.Selection)
    {
      selected.push_back(self.Set.GetHandle(name.first, name.second));
    }
    self.NetLines = this->Net == NET_OFF ? nullptr
      : this->Net == NET_OF_ALL_FACES    ? self.Set.MakeNet({})
                                         : self.Set.MakeNet(self.Set.FindFaces(selected));
    self.NetShown = this->Net;
    self.ArePointsNew = true;
  }
  if (self.ArePointsNew || self.IsTopologyNew)
  {
    self.Net.SetCells(points, self.NetLines);
    self.Handles.SetCells(points, self.HandleVertices);
  }
  if (self.ArePointsNew || self.IsSelectionNew)
  {
    self.Show(self.SelectedHandles, self.Selection);
  }
  const bool isHovered = self.Hovered.second >= 0;
  self.Show(
    self.HoveredHandle, isHovered ? std::vector<Name>{ self.Hovered } : std::vector<Name>());
  self.IsTopologyNew = self.ArePointsNew = self.IsSelectionNew = false;
}

double* vtkNURBSControlPointRepresentation::GetBounds()
{
  this->UpdateHandles();
  vtkPoints* points = this->Internals->Set.GetPoints();
  if (!points || points->GetNumberOfPoints() == 0)
  {
    return nullptr;
  }
  points->GetBounds(this->HandleBounds);
  return this->HandleBounds;
}

void vtkNURBSControlPointRepresentation::ReleaseGraphicsResources(vtkWindow* window)
{
  vtkInternals& self = *this->Internals;
  for (auto* layer : { &self.Net, &self.Handles, &self.SelectedHandles, &self.HoveredHandle })
  {
    layer->ReleaseGraphicsResources(window);
  }
  if (self.BoxActor)
  {
    self.BoxActor->ReleaseGraphicsResources(window);
  }
}

// Handles are drawn last, so that layers cover each other in order; a renderer blends translucent
// geometry without regard to order.
int vtkNURBSControlPointRepresentation::RenderOverlay(vtkViewport* viewport)
{
  this->BuildRepresentation();
  vtkInternals& self = *this->Internals;
  int rendered = 0;
  for (auto* layer : { &self.Net, &self.Handles, &self.SelectedHandles })
  {
    rendered += layer->RenderHidden(viewport);
  }
  for (auto* layer : { &self.Net, &self.Handles, &self.SelectedHandles })
  {
    rendered += layer->RenderVisible(viewport);
  }
  rendered += self.HoveredHandle.RenderHidden(viewport);
  if (this->InteractionState == BoxSelecting)
  {
    this->UpdateBox();
    rendered += self.BoxActor->RenderOverlay(viewport);
  }
  return rendered;
}

void vtkNURBSControlPointRepresentation::UpdateBox()
{
  vtkInternals& self = *this->Internals;
  nurbs::ScreenView view;
  vtkNURBSScreen::MakeView(this->Renderer, view);
  const nurbs::Vec2 a = self.BoxStart - view.Origin, b = self.Cursor - view.Origin;
  vtkNew<vtkPoints> corners;
  corners->InsertNextPoint(a[0], a[1], 0.0);
  corners->InsertNextPoint(b[0], a[1], 0.0);
  corners->InsertNextPoint(b[0], b[1], 0.0);
  corners->InsertNextPoint(a[0], b[1], 0.0);
  const vtkIdType loop[5] = { 0, 1, 2, 3, 0 };
  vtkNew<vtkCellArray> line;
  line->InsertNextCell(5, loop);
  self.BoxOutline->SetPoints(corners);
  self.BoxOutline->SetLines(line);
  if (!self.BoxActor)
  {
    self.BoxActor = vtkSmartPointer<vtkActor2D>::New();
    vtkNew<vtkPolyDataMapper2D> mapper;
    mapper->SetInputData(self.BoxOutline);
    self.BoxActor->SetMapper(mapper);
  }
  self.BoxActor->GetProperty()->SetColor(this->SelectedColor);
}

void vtkNURBSControlPointRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  static const char* const constraints[] = { "view plane", "x axis", "y axis", "z axis",
    "surface normal" };
  static const char* const nets[] = { "off", "of selected faces", "of all faces" };
  static const char* const hidden[] = { "hide", "faint", "show" };
  os << indent << "Edits: " << this->Internals->Edits.Get() << "\n";
  os << indent << "Selected: " << this->GetNumberOfSelectedControlPoints() << "\n";
  os << indent << "Constraint: " << constraints[this->Constraint] << "\n";
  os << indent << "Net: " << nets[this->Net] << "\n";
  os << indent << "NetWidth: " << this->NetWidth << "\n";
  os << indent << "HiddenHandles: " << hidden[this->HiddenHandles] << "\n";
  os << indent << "HiddenOpacity: " << this->HiddenOpacity << "\n";
  os << indent << "PickRadius: " << this->PickRadius << "\n";
  const auto color = [&](const char* name, const double(&c)[3]) {
    os << indent << name << ": " << c[0] << " " << c[1] << " " << c[2] << "\n";
  };
  color("NetColor", this->NetColor);
  color("HandleColor", this->HandleColor);
  color("SelectedColor", this->SelectedColor);
  color("HoverColor", this->HoverColor);
  color("Displacement", this->Displacement);
}
