// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSSurfaceRepresentation.h"

#include "vtkAlgorithmOutput.h"
#include "vtkCellArray.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommunicator.h"
#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkDataArray.h"
#include "vtkDataLabelRepresentation.h"
#include "vtkDataObjectTree.h"
#include "vtkDataObjectTreeRange.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiProcessController.h"
#include "vtkNURBSFaceMarks.h"
#include "vtkNURBSLookLegend.h"
#include "vtkNURBSMapper.h"
#include "vtkNURBSModelBlocks.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPVExtractSelection.h"
#include "vtkPVLODActor.h"
#include "vtkPVRenderView.h"
#include "vtkPVSession.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkProcessModule.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkScalarBarActor.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"
#include "vtkSelectionRepresentation.h"
#include "vtkTextProperty.h"
#include "vtkView.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

vtkStandardNewMacro(vtkNURBSSurfaceRepresentation);

namespace
{

using Attributes = vtkCompositeDataDisplayAttributes;

constexpr int SelectionPort = 1; // Of what is delivered; 0 are the models.

// What a block has of its own or of the blocks around it.
struct Style
{
  bool Visible = true;
  std::optional<double> Opacity;
  std::optional<std::array<double, 3>> Color;

  Style Inside(vtkDataObject* block, Attributes* given) const
  {
    Style style = *this;
    if (given->HasBlockVisibility(block))
    {
      style.Visible = given->GetBlockVisibility(block);
    }
    if (given->HasBlockOpacity(block))
    {
      style.Opacity = given->GetBlockOpacity(block);
    }
    if (given->HasBlockColor(block))
    {
      style.Color.emplace();
      given->GetBlockColor(block, style.Color->data());
    }
    return style;
  }
};

// The mapper looks at leaves only: tells them what was said of the blocks around them.
void SetLeaves(vtkDataObject* block, const Style& around, Attributes* given, Attributes* leaves)
{
  const Style style = around.Inside(block, given);
  if (auto* tree = vtkDataObjectTree::SafeDownCast(block))
  {
    for (vtkDataObject* child : vtk::Range(tree, vtk::DataObjectTreeOptions::SkipEmptyNodes))
    {
      SetLeaves(child, style, given, leaves);
    }
    return;
  }
  leaves->SetBlockVisibility(block, style.Visible);
  if (style.Opacity)
  {
    leaves->SetBlockOpacity(block, *style.Opacity);
  }
  if (style.Color)
  {
    leaves->SetBlockColor(block, style.Color->data());
  }
}

// The diagonal of the box around what all processes have; 0: nothing, or there are no others.
double LengthOfAll(const double (&bounds)[6])
{
  vtkMultiProcessController* all = vtkMultiProcessController::GetGlobalController();
  if (!all || all->GetNumberOfProcesses() < 2)
  {
    return 0.0;
  }
  const bool some = vtkMath::AreBoundsInitialized(bounds);
  double own[6], largest[6];
  for (int k = 0; k < 6; ++k)
  {
    own[k] = some ? (k % 2 ? bounds[k] : -bounds[k]) : VTK_DOUBLE_MIN;
  }
  all->AllReduce(own, largest, 6, vtkCommunicator::MAX_OP);
  double squares = 0.0;
  for (int k = 0; k < 6; k += 2)
  {
    const double side = largest[k] + largest[k + 1];
    squares += side >= 0.0 ? side * side : 0.0;
  }
  return std::sqrt(squares);
}

// Where the data of a connection come from, without the filters that ParaView puts behind each output.
vtkAlgorithmOutput* OriginOf(vtkAlgorithm* consumer)
{
  vtkAlgorithmOutput* origin = nullptr;
  while (consumer && consumer->GetNumberOfInputPorts() > 0 &&
    consumer->GetNumberOfInputConnections(0) > 0)
  {
    origin = consumer->GetInputConnection(0, 0);
    consumer = origin->GetProducer()->IsA("vtkPVPostFilter") ? origin->GetProducer() : nullptr;
  }
  return origin;
}

// Tells what has no question of its own.
struct Labels : vtkDataLabelRepresentation
{
  static bool ArePointsShown(vtkDataLabelRepresentation* labels)
  {
    return labels->*(&Labels::PointLabelVisibility) != 0;
  }
};

// The number of this process among several that have data, or -1.
int OwnProcess()
{
  vtkMultiProcessController* all = vtkMultiProcessController::GetGlobalController();
  return all && all->GetNumberOfProcesses() > 1 ? all->GetLocalProcessId() : -1;
}

// The cells of a selection as something that ParaView delivers, from all processes: a point (flat index
// of the block, or -1; index of the cell; process) each. Selected points are no faces.
vtkSmartPointer<vtkPolyData> PackedSelection(vtkSelection* selection)
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (unsigned int n = 0; n < selection->GetNumberOfNodes(); ++n)
  {
    vtkSelectionNode* node = selection->GetNode(n);
    if (node->GetFieldType() != vtkSelectionNode::CELL ||
      node->GetContentType() != vtkSelectionNode::INDICES)
    {
      continue;
    }
    vtkInformation* about = node->GetProperties();
    const bool hasBlock = about->Has(vtkSelectionNode::COMPOSITE_INDEX());
    const int block = hasBlock ? about->Get(vtkSelectionNode::COMPOSITE_INDEX()) : -1;
    auto* ids = vtkDataArray::SafeDownCast(node->GetSelectionList());
    const int last = ids ? ids->GetNumberOfComponents() - 1 : 0;
    for (vtkIdType id = 0; ids && id < ids->GetNumberOfTuples(); ++id)
    {
      points->InsertNextPoint(block, ids->GetComponent(id, last), OwnProcess());
    }
  }
  auto packed = vtkSmartPointer<vtkPolyData>::New();
  packed->SetPoints(points);
  vtkNew<vtkCellArray> vertices; // Points that no cell uses get lost on the way.
  for (vtkIdType n = 0; n < points->GetNumberOfPoints(); ++n)
  {
    vertices->InsertNextCell(1, &n);
  }
  packed->SetVerts(vertices);
  return packed;
}

// And back.
vtkSmartPointer<vtkSelection> UnpackedSelection(vtkPolyData* packed)
{
  auto selection = vtkSmartPointer<vtkSelection>::New();
  std::map<std::pair<int, int>, vtkSmartPointer<vtkIdTypeArray>> blocks;
  for (vtkIdType n = 0; packed && n < packed->GetNumberOfPoints(); ++n)
  {
    double row[3];
    packed->GetPoint(n, row);
    auto& ids = blocks[{ static_cast<int>(row[0]), static_cast<int>(row[2]) }];
    ids = ids ? ids : vtkSmartPointer<vtkIdTypeArray>::New();
    ids->InsertNextValue(static_cast<vtkIdType>(row[1]));
  }
  for (const auto& [place, ids] : blocks)
  {
    const auto [block, process] = place;
    vtkNew<vtkSelectionNode> node;
    node->SetContentType(vtkSelectionNode::INDICES);
    node->SetFieldType(vtkSelectionNode::CELL);
    node->SetSelectionList(ids);
    if (block >= 0)
    {
      node->GetProperties()->Set(vtkSelectionNode::COMPOSITE_INDEX(), block);
    }
    node->GetProperties()->Set(vtkSelectionNode::PROCESS_ID(), process);
    selection->AddNode(node);
  }
  return selection;
}

} // namespace

vtkNURBSSurfaceRepresentation::vtkNURBSSurfaceRepresentation()
{
  // One filter instead of a surface filter and one that makes blocks of its output.
  this->GeometryFilter->Delete();
  this->MultiBlockMaker->Delete();
  auto* blocks = vtkNURBSModelBlocks::New();
  this->GeometryFilter = blocks;
  this->MultiBlockMaker = blocks;
  blocks->Register(nullptr);

  this->Mapper->Delete();
  auto* mapper = vtkNURBSMapper::New();
  this->Mapper = mapper;
  vtkNew<vtkSelection> selection;
  mapper->SetSelection(selection);
  vtkNew<Attributes> attributes;
  mapper->SetCompositeDataDisplayAttributes(attributes);
  this->Actor->SetMapper(mapper);
  this->SuppressLOD = true;
  this->Legend = vtkNURBSLookLegend::Make();
}

vtkNURBSSurfaceRepresentation::~vtkNURBSSurfaceRepresentation() = default;

void vtkNURBSSurfaceRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "UseModelColors: " << this->UseModelColors << "\n";
  os << indent << "FaceEdges: " << this->FaceEdges << "\n";
  os << indent << "ShowLegend: " << this->ShowLegend << "\n";
  os << indent << "UseLookRange: " << this->UseLookRange << "\n";
  os << indent << "LookRange: " << this->LookRange[0] << " " << this->LookRange[1] << "\n";
}

vtkNURBSMapper* vtkNURBSSurfaceRepresentation::GetNURBSMapper()
{
  return static_cast<vtkNURBSMapper*>(this->Mapper);
}

int vtkNURBSSurfaceRepresentation::ProcessViewRequest(
  vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo)
{
  if (request == vtkPVView::REQUEST_RENDER())
  {
    if (!this->vtkPVDataRepresentation::ProcessViewRequest(request, inInfo, outInfo))
    {
      return 0;
    }
    this->SetDrawnData(vtkPVView::GetDeliveredPiece(inInfo, this));
    if (this->IsApart())
    {
      this->ShowDeliveredSelection(vtkPVView::GetDeliveredPiece(inInfo, this, SelectionPort));
    }
    this->Actor->SetEnableLOD(0);
    this->UpdateColoringParameters();
    vtkNURBSLookLegend::Update(this->Legend, this->GetNURBSMapper(), this->ShowLegend);
    return 1;
  }
  if (request == vtkPVView::REQUEST_UPDATE())
  {
    this->PutLabelsOnFaces();
    if (this->IsApart())
    {
      this->RenewSelection();
    }
  }
  if (!this->Superclass::ProcessViewRequest(request, inInfo, outInfo))
  {
    return 0;
  }
  if (request == vtkPVView::REQUEST_UPDATE())
  {
    if (this->IsApart())
    {
      vtkPVView::SetPiece(
        inInfo, this, PackedSelection(this->FindSelectedFaces()), 0, SelectionPort);
    }
    // Faces can't be cut between processes as polygons can.
    vtkPVRenderView::SetOrderedCompositingConfiguration(
      inInfo, this, vtkPVRenderView::USE_BOUNDS_FOR_REDISTRIBUTION);
    // Control points can lie far from what trims leave of a surface: the mapper knows better.
    this->SetDrawnData(this->MultiBlockMaker->GetOutputDataObject(0));
    double bounds[6];
    this->Mapper->GetBounds(bounds);
    vtkNew<vtkMatrix4x4> matrix;
    this->Actor->GetMatrix(matrix);
    vtkPVRenderView::SetGeometryBounds(inInfo, this, bounds, matrix);
    this->GetNURBSMapper()->SetLookLength(LengthOfAll(bounds));
    if (!this->IsApart())
    {
      this->ShowSelectedFaces();
    }
  }
  return 1;
}

void vtkNURBSSurfaceRepresentation::SetDrawnData(vtkDataObject* delivered)
{
  this->UpdateBlockAttributes(delivered);
  vtkDataObject* drawn = vtkNURBSModelBlocks::GetDrawn(delivered);
  if (this->Mapper->GetInputDataObject(0, 0) != drawn)
  {
    this->Mapper->SetInputDataObject(drawn);
  }
}

// Whether the data are in another process than the user, or the other way round.
bool vtkNURBSSurfaceRepresentation::IsApart()
{
  auto* session =
    vtkPVSession::SafeDownCast(vtkProcessModule::GetProcessModule()->GetActiveSession());
  return session &&
    session->HasProcessRole(vtkPVSession::CLIENT) !=
    session->HasProcessRole(vtkPVSession::DATA_SERVER);
}

// Has our pieces made anew where something about selections in the view changed, which all processes
// see: what is selected only the one with the data knows.
void vtkNURBSSurfaceRepresentation::RenewSelection()
{
  vtkMTimeType time = 0;
  for (int i = 0; i < this->GetView()->GetNumberOfRepresentations(); ++i)
  {
    auto* selection =
      vtkSelectionRepresentation::SafeDownCast(this->GetView()->GetRepresentation(i));
    time = std::max(time, selection ? selection->GetMTime() : 0);
  }
  if (this->SelectionViewTime != time)
  {
    this->SelectionViewTime = time;
    this->MarkModified();
  }
}

// ParaView extracts what is selected of our input, and shows that by a representation beside this one.
// It is looked for where the data are; elsewhere nothing is found.
vtkSmartPointer<vtkSelection> vtkNURBSSurfaceRepresentation::FindSelectedFaces()
{
  auto selection = vtkSmartPointer<vtkSelection>::New();
  this->FoundTimes.clear();
  vtkView* view = this->GetView();
  vtkAlgorithmOutput* input = OriginOf(this);
  for (int i = 0; input && view && i < view->GetNumberOfRepresentations(); ++i)
  {
    auto* shown = vtkGeometryRepresentation::SafeDownCast(view->GetRepresentation(i));
    vtkAlgorithmOutput* origin = shown && shown->GetVisibility() ? OriginOf(shown) : nullptr;
    auto* extraction =
      origin ? vtkPVExtractSelection::SafeDownCast(origin->GetProducer()) : nullptr;
    if (extraction && OriginOf(extraction) == input)
    {
      // For this process's piece, as its own representation does: without a word it would be for all.
      vtkMultiProcessController* all = vtkMultiProcessController::GetGlobalController();
      extraction->UpdatePiece(
        all ? all->GetLocalProcessId() : 0, all ? all->GetNumberOfProcesses() : 1, 0);
      auto* faces = vtkSelection::SafeDownCast(
        extraction->GetOutputDataObject(vtkPVExtractSelection::OUTPUT_PORT_SELECTION_IDS));
      this->FoundTimes.push_back(faces->GetMTime());
      for (unsigned int n = 0; n < faces->GetNumberOfNodes(); ++n)
      {
        // What is found here is of this process, whichever it was looked for in.
        vtkNew<vtkSelectionNode> own;
        own->ShallowCopy(faces->GetNode(n));
        own->GetProperties()->Set(vtkSelectionNode::PROCESS_ID(), OwnProcess());
        selection->AddNode(own);
      }
    }
  }
  return selection;
}

// Labels of what is selected of our input get a filter between them and the selection.
void vtkNURBSSurfaceRepresentation::PutLabelsOnFaces()
{
  vtkView* view = this->GetView();
  vtkAlgorithmOutput* input = OriginOf(this);
  for (int i = 0; input && view && i < view->GetNumberOfRepresentations(); ++i)
  {
    auto* labels = vtkDataLabelRepresentation::SafeDownCast(view->GetRepresentation(i));
    if (!labels || labels->GetNumberOfInputConnections(0) == 0)
    {
      continue;
    }
    vtkAlgorithmOutput* source = labels->GetInputConnection(0, 0);
    vtkSmartPointer<vtkNURBSFaceMarks> marks =
      vtkNURBSFaceMarks::SafeDownCast(source->GetProducer());
    auto* extraction = vtkPVExtractSelection::SafeDownCast(OriginOf(labels)->GetProducer());
    if (!marks && extraction && OriginOf(extraction) == input)
    {
      marks = vtkSmartPointer<vtkNURBSFaceMarks>::New();
      marks->SetInputConnection(source);
      labels->SetInputConnection(marks->GetOutputPort());
    }
    if (marks && marks->GetKeepModels() != Labels::ArePointsShown(labels))
    {
      marks->SetKeepModels(Labels::ArePointsShown(labels));
      labels->MarkModified();
    }
  }
}

void vtkNURBSSurfaceRepresentation::ShowSelectedFaces()
{
  const vtkSmartPointer<vtkSelection> selection = this->FindSelectedFaces();
  if (this->FoundTimes != this->SelectionTimes)
  {
    this->SelectionTimes = this->FoundTimes;
    this->Mapper->SetSelection(selection);
  }
}

void vtkNURBSSurfaceRepresentation::ShowDeliveredSelection(vtkDataObject* delivered)
{
  const vtkMTimeType time = delivered ? delivered->GetMTime() : 0;
  if (this->DeliveredTime != time)
  {
    this->DeliveredTime = time;
    this->Mapper->SetSelection(UnpackedSelection(vtkPolyData::SafeDownCast(delivered)));
  }
}

void vtkNURBSSurfaceRepresentation::UpdateBlockAttributes(vtkDataObject* delivered)
{
  // Data are told apart by their time of modification, which no two objects have in common.
  const vtkMTimeType time = delivered ? delivered->GetMTime() : 0;
  if (this->BlocksOf == time && !this->BlockAttrChanged)
  {
    return;
  }
  this->BlocksOf = time;
  this->BlockAttrChanged = false;
  vtkNew<Attributes> given;
  Attributes* leaves = this->GetNURBSMapper()->GetCompositeDataDisplayAttributes();
  leaves->RemoveBlockVisibilities();
  leaves->RemoveBlockOpacities();
  leaves->RemoveBlockColors();
  if (delivered)
  {
    this->PopulateBlockAttributes(given, delivered);
    SetLeaves(delivered, Style(), given, leaves);
  }
  leaves->Modified();
}

// The array that colours, and whether its values are colours themselves.
bool vtkNURBSSurfaceRepresentation::ColorsByArray(const char*& name, bool& direct)
{
  name = this->GetColorArrayName();
  direct = !this->MapScalars;
  if (name && name[0])
  {
    return true;
  }
  name = "Color";
  direct = true;
  return this->UseModelColors;
}

// As the superclass, without a change to and fro that would make the mapper start anew every frame.
void vtkNURBSSurfaceRepresentation::UpdateColoringParameters()
{
  const char* name = nullptr;
  bool direct = false;
  if (this->ColorsByArray(name, direct))
  {
    this->Mapper->SetScalarVisibility(1);
    this->Mapper->SelectColorArray(name);
    this->Mapper->SetUseLookupTableScalarRange(1);
    this->Mapper->SetScalarMode(VTK_SCALAR_MODE_USE_CELL_FIELD_DATA);
    this->Mapper->SetColorMode(direct ? VTK_COLOR_MODE_DIRECT_SCALARS : VTK_COLOR_MODE_MAP_SCALARS);
  }
  else
  {
    this->Mapper->SetScalarVisibility(0);
    this->Mapper->SelectColorArray(nullptr);
  }
  this->Property->SetAmbient(this->Ambient);
  this->Property->SetSpecular(this->Specular);
  this->Property->SetDiffuse(this->Diffuse);
  this->Property->SetRepresentation(VTK_SURFACE);
  this->Property->SetEdgeVisibility(this->FaceEdges);
}

void vtkNURBSSurfaceRepresentation::SetMapScalars(int map)
{
  this->MapScalars = map != 0;
}

void vtkNURBSSurfaceRepresentation::SetUseLookRange(bool use)
{
  if (this->UseLookRange != use)
  {
    this->UseLookRange = use;
    this->UpdateLookTable();
  }
}

void vtkNURBSSurfaceRepresentation::SetLookRange(double least, double largest)
{
  if (this->LookRange[0] != least || this->LookRange[1] != largest)
  {
    this->LookRange[0] = least;
    this->LookRange[1] = largest;
    this->UpdateLookTable();
  }
}

void vtkNURBSSurfaceRepresentation::UpdateLookTable()
{
  if (!this->UseLookRange)
  {
    this->GetNURBSMapper()->SetLookTable(nullptr);
    return;
  }
  const auto [least, largest] = this->LookRange;
  vtkNew<vtkColorTransferFunction> table;
  table->AddRGBPoint(least, 0.23, 0.30, 0.75);
  table->AddRGBPoint(0.5 * (least + largest), 0.87, 0.87, 0.87);
  table->AddRGBPoint(largest, 0.71, 0.02, 0.15);
  this->GetNURBSMapper()->SetLookTable(table);
}

bool vtkNURBSSurfaceRepresentation::AddToView(vtkView* view)
{
  auto* renderView = vtkPVRenderView::SafeDownCast(view);
  if (renderView)
  {
    renderView->GetNonCompositedRenderer()->AddActor(this->Legend);
  }
  return this->Superclass::AddToView(view);
}

bool vtkNURBSSurfaceRepresentation::RemoveFromView(vtkView* view)
{
  auto* renderView = vtkPVRenderView::SafeDownCast(view);
  if (renderView)
  {
    renderView->GetNonCompositedRenderer()->RemoveActor(this->Legend);
  }
  return this->Superclass::RemoveFromView(view);
}

// Representations that do not show are not asked to render.
void vtkNURBSSurfaceRepresentation::SetVisibility(bool visible)
{
  this->Superclass::SetVisibility(visible);
  if (!visible)
  {
    this->Legend->SetVisibility(0);
  }
}

void vtkNURBSSurfaceRepresentation::SetLegendColor(double red, double green, double blue)
{
  this->Legend->GetTitleTextProperty()->SetColor(red, green, blue);
  this->Legend->GetLabelTextProperty()->SetColor(red, green, blue);
}

void vtkNURBSSurfaceRepresentation::SetPixelError(double pixels)
{
  this->GetNURBSMapper()->SetPixelError(pixels);
}

void vtkNURBSSurfaceRepresentation::SetExactFragments(bool exact)
{
  this->GetNURBSMapper()->SetExactFragments(exact);
}

void vtkNURBSSurfaceRepresentation::SetUseTessellation(bool use)
{
  this->GetNURBSMapper()->SetUseTessellation(use);
}

void vtkNURBSSurfaceRepresentation::SetInteractiveFrameRate(double rate)
{
  this->GetNURBSMapper()->SetInteractiveFrameRate(rate);
}

void vtkNURBSSurfaceRepresentation::SetLook(int look)
{
  this->GetNURBSMapper()->SetLook(look);
}

void vtkNURBSSurfaceRepresentation::SetLookDirection(double x, double y, double z)
{
  this->GetNURBSMapper()->SetLookDirection(x, y, z);
}

void vtkNURBSSurfaceRepresentation::SetNumberOfStripes(int stripes)
{
  this->GetNURBSMapper()->SetNumberOfStripes(stripes);
}

void vtkNURBSSurfaceRepresentation::SetNumberOfIsoLines(int u, int v)
{
  this->GetNURBSMapper()->SetNumberOfIsoLines(u, v);
}

vtkIdType vtkNURBSSurfaceRepresentation::GetNumberOfTriangles()
{
  return this->GetNURBSMapper()->GetNumberOfTriangles();
}

double vtkNURBSSurfaceRepresentation::GetAchievedPixelError()
{
  return this->GetNURBSMapper()->GetAchievedPixelError();
}

bool vtkNURBSSurfaceRepresentation::GetDrawsTessellation()
{
  return this->GetNURBSMapper()->GetDrawsTessellation();
}
