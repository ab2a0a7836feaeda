// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSMapper.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCellData.h"
#include "vtkColorTransferFunction.h"
#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataObject.h"
#include "vtkExecutive.h"
#include "vtkFloatArray.h"
#include "vtkHardwareSelector.h"
#include "vtkInformation.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNURBSDrawnModel.h"
#include "vtkNURBSFaceLooks.h"
#include "vtkNURBSFrameRate.h"
#include "vtkNURBSGridIndices.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSParallel.h"
#include "vtkNURBSTessellatedDrawing.h"
#include "vtkNURBSTileTextures.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLError.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkOpenGLVertexArrayObject.h"
#include "vtkOpenGLVertexBufferObject.h"
#include "vtkOpenGLVertexBufferObjectGroup.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkScalarsToColors.h"
#include "vtkShaderProgram.h"
#include "vtkTimerLog.h"
#include "vtkTransform.h"
#include "vtkUnsignedCharArray.h"
#include "vtkWeakPointer.h"
#include "vtk_glew.h"

#include "nurbsExact.h"
#include "nurbsFragment.h"
#include "nurbsLook.h"
#include "nurbsTile.h"
#include "nurbsTrim.h"
#include "nurbsVertex.h"

#include <algorithm>
#include <array>

vtkStandardNewMacro(vtkNURBSMapper);

namespace
{

// The shape of a tile that is drawn by some levels coarser.
int Coarser(int shape, int levels)
{
  constexpr int Row = nurbs::Tile::MaxLog + 1;
  return std::max(shape % Row - levels, 0) + Row * std::max(shape / Row - levels, 0);
}

// The largest tolerance of the edges around a face.
double ToleranceOf(const nurbs::Model& model, const nurbs::Face& face)
{
  double tolerance = 0.0;
  for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
  {
    const nurbs::TrimLoop& loop = model.Loops[l];
    for (std::int64_t t = loop.FirstCurve; t < loop.FirstCurve + loop.CurveCount; ++t)
    {
      const std::int64_t edge = model.TrimCurves[t].Edge;
      tolerance = edge < 0 ? tolerance : std::max(tolerance, model.Edges[edge].Tolerance);
    }
  }
  return tolerance;
}

} // namespace

struct vtkNURBSMapper::Internals
{
  vtkNURBSDrawnModel Model;
  vtkWeakPointer<vtkOpenGLRenderWindow> Window; ///< That the objects on the device belong to.
  bool ModelIsSent = false;
  std::vector<int> MovedSinceSent;
  vtkMTimeType ModelVersion = 0; ///< Rises with every change of the model.

  vtkNURBSTileTextures Textures;
  vtkNURBSGridIndices Indices;
  vtkNURBSBufferTexture TrimPoints{ vtkNURBSBufferTexture::FLOAT4 };
  vtkNURBSBufferTexture TrimRecords{ vtkNURBSBufferTexture::INTEGER4 };
  vtkNURBSBufferTexture LookTexture{ vtkNURBSBufferTexture::COLOR };
  vtkNURBSBufferTexture FaceIds{ vtkNURBSBufferTexture::INTEGER4 };
  vtkNURBSBufferTexture LookColors{ vtkNURBSBufferTexture::COLOR };
  vtkNURBSTessellatedDrawing Tessellated;
  vtkNURBSFrameRate FrameRate;
  int Samples = 0; ///< Of a pixel, if fragments choose among them; else 0.
  vtkNURBSFaceLooks Looks;
  bool LooksAreSent = false;

  /// Stands for the input where the superclass asks for points and normals: one point.
  vtkNew<vtkPolyData> StandIn;
  bool StandInIsSent = false;

  nurbs::TileView View;
  vtkMTimeType ViewedVersion = 0;
  nurbs::TileSelection Selection;
  bool TilesAreReady = false;

  nurbs::Vec3 Shift = nurbs::Vec3::Zero();
  std::string LastError;

  Internals()
  {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToFloat();
    points->InsertNextPoint(0.0, 0.0, 0.0);
    vtkNew<vtkFloatArray> normals;
    normals->SetNumberOfComponents(3);
    normals->InsertNextTuple3(0.0, 0.0, 1.0);
    this->StandIn->SetPoints(points);
    this->StandIn->GetPointData()->SetNormals(normals);
  }
};

vtkNURBSMapper::vtkNURBSMapper()
  : Content(new Internals)
{}

vtkNURBSMapper::~vtkNURBSMapper()
{
  this->ReleaseGraphicsResources(nullptr);
}

void vtkNURBSMapper::SetCompositeDataDisplayAttributes(
  vtkCompositeDataDisplayAttributes* attributes)
{
  if (this->Attributes != attributes)
  {
    this->Attributes = attributes;
    this->Modified();
  }
}

void vtkNURBSMapper::SetLookTable(vtkScalarsToColors* table)
{
  if (this->LookTable != table)
  {
    this->LookTable = table;
    this->Modified();
  }
}

vtkScalarsToColors* vtkNURBSMapper::GetLookTable()
{
  return this->LookTable;
}

vtkCompositeDataDisplayAttributes* vtkNURBSMapper::GetCompositeDataDisplayAttributes()
{
  return this->Attributes;
}

void vtkNURBSMapper::SetInputData(vtkDataObject* input)
{
  this->SetInputDataInternal(0, input);
}

int vtkNURBSMapper::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  return 1;
}

vtkMTimeType vtkNURBSMapper::GetMTime()
{
  return std::max(
    this->Superclass::GetMTime(), this->Attributes ? this->Attributes->GetMTime() : 0);
}

double vtkNURBSMapper::GetCoarserLevels()
{
  return this->Content->FrameRate.GetCoarserLevels();
}

vtkIdType vtkNURBSMapper::GetNumberOfBytesSent()
{
  const Internals& c = *this->Content;
  return static_cast<vtkIdType>(c.Textures.GetBytesSent() + c.TrimPoints.GetBytesSent() +
    c.TrimRecords.GetBytesSent() + c.LookTexture.GetBytesSent() + c.FaceIds.GetBytesSent());
}

vtkIdType vtkNURBSMapper::GetNumberOfEvaluatedVertices()
{
  return static_cast<vtkIdType>(this->Content->Textures.GetEvaluatedVertices());
}

// Takes the input as it is. False if there is nothing to draw.
bool vtkNURBSMapper::UpdateModel()
{
  Internals& c = *this->Content;
  vtkDataObject* input = this->GetInputDataObject(0, 0);
  if (!input)
  {
    return false;
  }
  try
  {
    const vtkNURBSDrawnModel::Change change = c.Model.Update(input);
    if (change != vtkNURBSDrawnModel::Change::None)
    {
      ++c.ModelVersion;
    }
    if (change == vtkNURBSDrawnModel::Change::Surfaces)
    {
      c.ModelIsSent = false;
      if (c.Model.GetLeaves().empty())
      {
        vtkErrorMacro("The input has no NURBS model: it lacks the arrays of vtkNURBSModel.");
      }
      if (!c.Model.GetWarnings().empty())
      {
        vtkWarningMacro("Faces that can't be drawn:\n" << c.Model.GetWarnings());
      }
    }
    c.MovedSinceSent.insert(
      c.MovedSinceSent.end(), c.Model.GetMoved().begin(), c.Model.GetMoved().end());
  }
  catch (const nurbs::Error& error)
  {
    vtkErrorMacro("The model can't be drawn: " << error.what());
    return false;
  }
  return c.Model.GetTable().Size() > 0;
}

void vtkNURBSMapper::ComputeBounds()
{
  vtkMath::UninitializeBounds(this->Bounds);
  if (this->UpdateModel())
  {
    const nurbs::Box3 box = this->Content->Model.GetBounds();
    for (int k = 0; k < 3 && !box.isEmpty(); ++k)
    {
      this->Bounds[2 * k] = box.min()[k];
      this->Bounds[2 * k + 1] = box.max()[k];
    }
  }
}

// Sends what the device does not have yet. False, after a warning that tells why, if it can't take it.
bool vtkNURBSMapper::UpdateTextures(vtkRenderer* renderer)
{
  Internals& c = *this->Content;
  auto* window = static_cast<vtkOpenGLRenderWindow*>(renderer->GetRenderWindow());
  const nurbs::SurfaceTable& table = c.Model.GetTable();
  if (c.ModelIsSent)
  {
    std::sort(c.MovedSinceSent.begin(), c.MovedSinceSent.end());
    c.MovedSinceSent.erase(std::unique(c.MovedSinceSent.begin(), c.MovedSinceSent.end()),
      c.MovedSinceSent.end());
    c.Textures.MoveSurfaces(table, c.MovedSinceSent);
    c.MovedSinceSent.clear();
    return true;
  }
  std::string error = vtkNURBSTileTextures::GetMissingFeature(window);
  if (error.empty())
  {
    std::vector<vtkNURBSTileTextures::SurfaceInfo> infos(table.Size());
    std::vector<int> ids;
    for (const vtkNURBSDrawnModel::Leaf& leaf : c.Model.GetLeaves())
    {
      for (std::size_t f = 0; f < leaf.Model().Faces.size(); ++f)
      {
        const std::size_t index = leaf.First + f;
        infos[index].Reversed = leaf.Model().Faces[f].Reversed;
        infos[index].Trim = c.Model.GetTrims().FaceStart[index];
        infos[index].Tolerance = ToleranceOf(leaf.Model(), leaf.Model().Faces[f]);
        ids.insert(ids.end(), { static_cast<int>(f), static_cast<int>(leaf.FlatIndex), 0, 0 });
      }
    }
    const nurbs::TrimTexels& trims = c.Model.GetTrims();
    if (!c.Textures.SetTable(table, infos))
    {
      error = c.Textures.GetError();
    }
    else if (!c.TrimPoints.Upload(trims.Points.data(), 4 * trims.Points.size()) ||
      !c.TrimRecords.Upload(trims.Records.data(), 4 * trims.Records.size()) ||
      !c.FaceIds.Upload(ids.data(), 4 * ids.size()))
    {
      error = "the device can't hold this model's trimming curves";
    }
  }
  if (!error.empty())
  {
    if (c.LastError != error)
    {
      vtkWarningMacro("The model is drawn by the CPU's tessellator: " << error << ".");
      c.LastError = error;
    }
    return false;
  }
  c.LastError.clear();
  c.MovedSinceSent.clear();
  c.LooksAreSent = false;
  c.ModelIsSent = true;
  return true;
}

void vtkNURBSMapper::RenderPiece(vtkRenderer* renderer, vtkActor* actor)
{
  if (renderer->GetRenderWindow()->CheckAbortStatus())
  {
    return;
  }
  auto* window = static_cast<vtkOpenGLRenderWindow*>(renderer->GetRenderWindow());
  if (this->Content->Window != window)
  {
    this->ReleaseGraphicsResources(this->Content->Window);
    this->Content->Window = window;
  }
  this->CurrentInput = this->Content->StandIn;
  this->InvokeEvent(vtkCommand::StartEvent, nullptr);
  if (!this->Static)
  {
    this->GetInputAlgorithm()->Update();
  }
  this->InvokeEvent(vtkCommand::EndEvent, nullptr);
  if (!this->UpdateModel())
  {
    return;
  }
  this->DrawsTessellation = this->UseTessellation || !this->UpdateTextures(renderer);
  if (this->DrawsTessellation)
  {
    this->Content->Tessellated.Render(this, this->GetInputDataObject(0, 0), renderer, actor);
    this->NumberOfTriangles = this->Content->Tessellated.GetNumberOfTriangles();
    this->AchievedPixelError = this->PixelError;
    return;
  }
  this->UpdateCameraShiftScale(renderer, actor);
  this->RenderPieceStart(renderer, actor);
  this->RenderPieceDraw(renderer, actor);
  this->RenderPieceFinish(renderer, actor);
}

// Vertices are told relative to a point near what is looked at, so that single precision is enough
// however far away or large the model is.
void vtkNURBSMapper::UpdateCameraShiftScale(vtkRenderer* renderer, vtkActor* actor)
{
  Internals& c = *this->Content;
  double focus[4] = { 0.0, 0.0, 0.0, 1.0 };
  renderer->GetActiveCamera()->GetFocalPoint(focus);
  actor->GetModelToWorldMatrix(this->TempMatrix4);
  this->TempMatrix4->Invert();
  this->TempMatrix4->MultiplyPoint(focus, focus);
  c.Shift = nurbs::Vec3(focus[0], focus[1], focus[2]) / focus[3];
  if (!c.StandInIsSent)
  {
    this->VBOs->CacheDataArray("vertexMC", c.StandIn->GetPoints()->GetData(), renderer, VTK_FLOAT);
    this->VBOs->CacheDataArray(
      "normalMC", c.StandIn->GetPointData()->GetNormals(), renderer, VTK_FLOAT);
    this->VBOs->BuildAllVBOs(renderer);
    c.StandInIsSent = true;
  }
  this->VBOs->GetVBO("vertexMC")->SetShift(c.Shift[0], c.Shift[1], c.Shift[2]);
  this->VBOs->GetVBO("vertexMC")->SetScale(1.0, 1.0, 1.0);
  this->VBOInverseTransform->Identity();
  this->VBOInverseTransform->Translate(c.Shift.data());
  this->VBOInverseTransform->GetTranspose(this->VBOShiftScale);
}

// Selects and evaluates the tiles that this view needs.
void vtkNURBSMapper::UpdateBufferObjects(vtkRenderer* renderer, vtkActor* actor)
{
  Internals& c = *this->Content;
  auto* window = static_cast<vtkOpenGLRenderWindow*>(renderer->GetRenderWindow());
  if (c.Looks.Update(this, c.Model, this->Attributes) || !c.LooksAreSent)
  {
    c.LooksAreSent = true;
    c.LookTexture.Upload(c.Looks.GetBytes().data(), c.Looks.GetBytes().size());
    c.TilesAreReady = false; // blocks may have been hidden or shown
  }
  vtkCamera* camera = renderer->GetActiveCamera();
  nurbs::TileView view;
  vtkNew<vtkMatrix4x4> toClip;
  actor->GetModelToWorldMatrix(toClip);
  vtkMatrix4x4::Multiply4x4(
    camera->GetCompositeProjectionTransformMatrix(renderer->GetTiledAspectRatio(), -1.0, 1.0),
    toClip, toClip);
  for (int i = 0; i < 4; ++i)
  {
    for (int j = 0; j < 4; ++j)
    {
      view.ModelToClip(i, j) = toClip->GetElement(i, j);
    }
  }
  int origin[2];
  renderer->GetTiledSizeAndOrigin(&view.Size[0], &view.Size[1], &origin[0], &origin[1]);
  view.Near = camera->GetParallelProjection() ? 1.0 : camera->GetClippingRange()[0];
  view.PixelError = this->PixelError;
  const bool sameView = view.ModelToClip == c.View.ModelToClip && view.Size[0] == c.View.Size[0] &&
    view.Size[1] == c.View.Size[1] && view.Near == c.View.Near &&
    view.PixelError == c.View.PixelError;
  if (sameView && c.ViewedVersion == c.ModelVersion && c.TilesAreReady)
  {
    return;
  }
  c.View = view;
  c.ViewedVersion = c.ModelVersion;
  const nurbs::SurfaceTable& table = c.Model.GetTable();
  constexpr int Batch = 64;
  std::vector<nurbs::TileSelection> parts((table.Size() + Batch - 1) / Batch);
  vtkNURBSParallelFor(0, static_cast<std::int64_t>(parts.size()),
    [&](std::int64_t first, std::int64_t last)
    {
      for (std::int64_t p = first; p < last; ++p)
      {
        const int end = std::min(static_cast<int>(p + 1) * Batch, table.Size());
        for (int s = static_cast<int>(p) * Batch; s < end; ++s)
        {
          if (!c.Looks.IsHidden(s))
          {
            nurbs::SelectTiles(table, s, view, parts[p]);
          }
        }
      }
    });
  c.Selection = nurbs::TileSelection();
  for (const nurbs::TileSelection& part : parts)
  {
    c.Selection.Tiles.insert(c.Selection.Tiles.end(), part.Tiles.begin(), part.Tiles.end());
    c.Selection.Cells += part.Cells;
    c.Selection.PixelError = std::max(c.Selection.PixelError, part.PixelError);
  }
  c.TilesAreReady = c.Textures.Prepare(window, table, c.Selection.Tiles);
  if (!c.TilesAreReady)
  {
    vtkErrorMacro("The model can't be drawn at " << this->PixelError
                                                 << " pixels: " << c.Textures.GetError());
  }
  this->NumberOfTriangles = 2 * c.Selection.Cells;
  this->AchievedPixelError = c.Selection.PixelError;
}

void vtkNURBSMapper::UpdateMaximumPointCellIds(vtkRenderer* renderer, vtkActor*)
{
  vtkHardwareSelector* selector = renderer->GetSelector();
  for (const vtkNURBSDrawnModel::Leaf& leaf : this->Content->Model.GetLeaves())
  {
    selector->UpdateMaximumCellId(leaf.Grid->GetNumberOfCells());
  }
}

void vtkNURBSMapper::ProcessSelectorPixelBuffers(
  vtkHardwareSelector*, std::vector<unsigned int>&, vtkProp*)
{
  // The shader writes cells, not primitives that would have to be translated.
}

void vtkNURBSMapper::ReplaceShaderValues(
  std::map<vtkShader::Type, vtkShader*> shaders, vtkRenderer* renderer, vtkActor* actor)
{
  std::string fragment = shaders[vtkShader::Fragment]->GetSource();
  const auto substitute = [](std::string& source, const char* from, const std::string& to)
  { vtkShaderProgram::Substitute(source, from, to); };
  const bool exact = this->DrawsExactly(actor);
  const std::string defines = this->GetDefines(actor);
  std::string functions = defines + nurbsTile + nurbsTrim + (exact ? nurbsExact : "") + nurbsFragment;
  substitute(functions, "//NURBS::Look::Dec", exact ? nurbsLook : "");
  substitute(fragment, "//VTK::PositionVC::Dec", functions + "//VTK::PositionVC::Dec");
  if (this->Content->Samples > 0)
  {
    substitute(fragment, "//VTK::System::Dec",
      "//VTK::System::Dec\n#extension GL_ARB_sample_shading : require\n");
  }
  substitute(fragment, "//VTK::UniformFlow::Impl",
    std::string("  nurbsBeginFragment();\n") + (this->HasLook(actor) ? "  nurbsBeginLook();\n" : "") +
      "  //VTK::UniformFlow::Impl\n");
  // Before depth peeling, which looks at the depth of what stays.
  substitute(fragment, "//VTK::Depth::Impl",
    "  if (!nurbsIsSeen) { discard; }\n  //VTK::Depth::Impl\n");
  substitute(fragment, "//VTK::Color::Impl",
    "  //VTK::Color::Impl\n"
    "  nurbsColor(ambientIntensity, diffuseIntensity, ambientColor, diffuseColor, opacity);\n");
  this->ReplaceSelection(fragment);
  shaders[vtkShader::Fragment]->SetSource(fragment);

  this->Superclass::ReplaceShaderValues(shaders, renderer, actor);

  // The superclass has declared attributes; ours are variables that nurbsFetchVertex sets.
  std::string vertex = shaders[vtkShader::Vertex]->GetSource();
  std::string declarations = nurbsVertex;
  substitute(declarations, "//NURBS::Tile::Dec", defines + nurbsTile);
  substitute(vertex, "in vec3 normalMC;", "");
  substitute(vertex, "in vec4 vertexMC;", declarations);
  substitute(vertex, "void main()\n{", "void main()\n{\n  nurbsFetchVertex();\n");
  shaders[vtkShader::Vertex]->SetSource(vertex);

  if (exact)
  {
    // The surface's own normal, side and depth, instead of the triangles'.
    fragment = shaders[vtkShader::Fragment]->GetSource();
    substitute(fragment, "//VTK::Depth::Impl", "gl_FragDepth = gl_FragCoord.z;");
    substitute(fragment, "gl_FrontFacing", "nurbsFront");
    substitute(fragment, "gl_FragCoord.z", "nurbsDepth");
    substitute(fragment, "vec3 normalVCVSOutput = normalize(normalVCVSOutput);",
      "vec3 normalVCVSOutput = normalize(normalMatrix * nurbsExactNormal);");
    substitute(fragment, "  nurbsBeginFragment();\n",
      "  nurbsBeginFragment();\n"
      "  vec3 nurbsExactNormal = nurbsNormal();\n"
      "  bool nurbsFront = nurbsSeesFront(nurbsExactNormal);\n");
    shaders[vtkShader::Fragment]->SetSource(fragment);
  }
}

// Whether something is to be seen that the triangles can't show.
bool vtkNURBSMapper::HasLook(vtkActor* actor)
{
  return this->Look != PLAIN || this->NumberOfIsoLines[0] > 0 || this->NumberOfIsoLines[1] > 0 ||
    actor->GetProperty()->GetEdgeVisibility();
}

// Whether fragments look for the surface itself: not for lines and points, which are the grid's.
bool vtkNURBSMapper::DrawsExactly(vtkActor* actor)
{
  return actor->GetProperty()->GetRepresentation() == VTK_SURFACE &&
    ((this->ExactFragments && this->Content->FrameRate.LooksForPoints()) || this->HasLook(actor));
}

std::string vtkNURBSMapper::GetDefines(vtkActor* actor)
{
  const Internals& c = *this->Content;
  std::string defines = "#define NURBS_MAX_LOG " + std::to_string(nurbs::Tile::MaxLog) + "\n";
  if (actor->GetProperty()->GetRepresentation() == VTK_SURFACE)
  {
    defines += "#define NURBS_SPREAD\n";
  }
  if (this->DrawsExactly(actor))
  {
    defines += "#define NURBS_EXACT\n#define NURBS_MAX_DEGREE " +
      std::to_string(c.Model.GetMaxDegree()) + "\n";
    if (c.Samples > 0)
    {
      defines += "#define NURBS_SAMPLES " + std::to_string(c.Samples) + "\n";
    }
    if (this->HasLook(actor))
    {
      defines += "#define NURBS_LOOK\n";
    }
  }
  return defines;
}

// Passes of a hardware selection that ask what was hit: the cell, and the block of a composite.
void vtkNURBSMapper::ReplaceSelection(std::string& fragment)
{
  std::string value;
  switch (this->LastSelectionState)
  {
    case vtkHardwareSelector::CELL_ID_LOW24:
      value = "nurbsIds().x & 0xffffff";
      break;
    case vtkHardwareSelector::CELL_ID_HIGH24:
      value = "(nurbsIds().x >> 24) & 0xff";
      break;
    case vtkHardwareSelector::COMPOSITE_INDEX_PASS:
      value = "nurbsIds().y";
      break;
    default:
      return;
  }
  vtkShaderProgram::Substitute(fragment, "//VTK::Picking::Impl",
    "  int nurbsId = " + value +
      ";\n"
      "  gl_FragData[0] = vec4(float(nurbsId & 0xff), float((nurbsId >> 8) & 0xff),\n"
      "    float((nurbsId >> 16) & 0xff), 255.0) / 255.0;\n");
}

void vtkNURBSMapper::SetMapperShaderParameters(
  vtkOpenGLHelper& helper, vtkRenderer* renderer, vtkActor* actor)
{
  this->Superclass::SetMapperShaderParameters(helper, renderer, actor);
  Internals& c = *this->Content;
  auto* window = static_cast<vtkOpenGLRenderWindow*>(renderer->GetRenderWindow());
  vtkShaderProgram* program = helper.Program;
  c.Textures.Activate(window, program);
  const auto set = [&](const char* name, vtkNURBSBufferTexture& buffer)
  {
    if (program->IsUniformUsed(name))
    {
      program->SetUniformi(name, buffer.Activate(window));
    }
  };
  set("nurbsTrimPoints", c.TrimPoints);
  set("nurbsTrimRecords", c.TrimRecords);
  set("nurbsFaceLooks", c.LookTexture);
  set("nurbsFaceIds", c.FaceIds);
  const Eigen::Vector3f high = c.Shift.cast<float>();
  const Eigen::Vector3f low = (c.Shift - high.cast<double>()).cast<float>();
  program->SetUniform3f("nurbsShiftHigh", high.data());
  program->SetUniform3f("nurbsShiftLow", low.data());
  if (actor->GetProperty()->GetRepresentation() == VTK_SURFACE)
  {
    this->SetSurfaceParameters(window, program, actor);
  }
  if (this->HasLook(actor))
  {
    this->SetLookParameters(window, program, actor);
  }
}

void vtkNURBSMapper::SetSurfaceParameters(
  vtkOpenGLRenderWindow* window, vtkShaderProgram* program, vtkActor* actor)
{
  const Internals& c = *this->Content;
  Eigen::Matrix4d shift = Eigen::Matrix4d::Identity();
  shift.topRightCorner<3, 1>() = c.Shift;
  const Eigen::Matrix4d toClip = c.View.ModelToClip * shift;
  Eigen::Matrix4f matrix = toClip.cast<float>(); // column by column, as OpenGL wants it
  program->SetUniformMatrix4x4("nurbsToClip", matrix.data());
  int viewport[4];
  window->GetState()->vtkglGetIntegerv(GL_VIEWPORT, viewport);
  const float pixels[4] = { float(viewport[0]), float(viewport[1]), float(viewport[2]),
    float(viewport[3]) };
  program->SetUniform4f("nurbsViewport", pixels);
  // Each coarser level is off by four times as much; gaps of some pixels can be filled, not more.
  const double error = this->PixelError * std::pow(4.0, c.FrameRate.GetCoarserLevels());
  program->SetUniformf("nurbsMargin", static_cast<float>(std::min(0.1 + error, 4.0)));
  if (!this->DrawsExactly(actor))
  {
    return;
  }
  const Eigen::Vector3f axis = toClip.row(2).head<3>().transpose().normalized().cast<float>();
  program->SetUniform3f("nurbsDepthAxis", axis.data());
  if (c.Samples > 0)
  {
    std::vector<float> places(2 * c.Samples);
    for (int i = 0; i < c.Samples; ++i)
    {
      glGetMultisamplefv(GL_SAMPLE_POSITION, static_cast<GLuint>(i), places.data() + 2 * i);
    }
    for (float& place : places)
    {
      place -= 0.5f;
    }
    program->SetUniformi("nurbsSampleCount", c.Samples);
    program->SetUniform2fv(
      "nurbsSamples", c.Samples, reinterpret_cast<const float(*)[2]>(places.data()));
  }
}

void vtkNURBSMapper::SetLookParameters(
  vtkOpenGLRenderWindow* window, vtkShaderProgram* program, vtkActor* actor)
{
  constexpr int Colors = 256;
  Internals& c = *this->Content;
  vtkScalarsToColors* table = this->LookTable;
  vtkNew<vtkColorTransferFunction> standard;
  if (!table)
  {
    const double diagonal = c.Model.GetBounds().diagonal().norm();
    const double limit = this->Look == DRAFT_ANGLE ? 90.0
      : this->Look == GAUSSIAN_CURVATURE           ? 100.0 / (diagonal * diagonal)
                                                   : 10.0 / diagonal;
    standard->SetColorSpaceToDiverging();
    standard->AddRGBPoint(-limit, 0.230, 0.299, 0.754);
    standard->AddRGBPoint(limit, 0.706, 0.016, 0.150);
    table = standard;
  }
  const double* range = table->GetRange();
  if (program->IsUniformUsed("nurbsLookTable"))
  {
    std::vector<unsigned char> colors;
    for (int i = 0; i < Colors; ++i)
    {
      const unsigned char* color =
        table->MapValue(range[0] + (range[1] - range[0]) * i / (Colors - 1));
      colors.insert(colors.end(), color, color + 4);
    }
    c.LookColors.Upload(colors.data(), colors.size());
    program->SetUniformi("nurbsLookTable", c.LookColors.Activate(window));
  }
  const auto set = [&](const char* name, int count, const float* values)
  {
    if (program->IsUniformUsed(name))
    {
      count == 1 ? program->SetUniformf(name, values[0])
        : count == 2 ? program->SetUniform2f(name, values)
                     : program->SetUniform3f(name, values);
    }
  };
  const float limits[2] = { float(range[0]), float(range[1]) };
  set("nurbsLookRange", 2, limits);
  const Eigen::Vector3f direction =
    Eigen::Map<const nurbs::Vec3>(this->LookDirection).normalized().cast<float>();
  set("nurbsLookDirection", 3, direction.data());
  const float stripes = static_cast<float>(this->NumberOfStripes);
  set("nurbsStripes", 1, &stripes);
  const float lines[2] = { float(this->NumberOfIsoLines[0]), float(this->NumberOfIsoLines[1]) };
  set("nurbsLineCounts", 2, lines);
  vtkProperty* property = actor->GetProperty();
  const float width = property->GetLineWidth();
  set("nurbsLineWidth", 1, &width);
  const double* edge = property->GetEdgeColor();
  const float color[3] = { float(edge[0]), float(edge[1]), float(edge[2]) };
  set("nurbsLineColor", 3, color);
  program->SetUniformi("nurbsLookKind", this->Look);
  program->SetUniformi("nurbsShowEdges", property->GetEdgeVisibility() ? 1 : 0);
}

// How many samples a pixel has that fragments may choose from.
void vtkNURBSMapper::UpdateSamples(vtkRenderer* renderer)
{
  GLint samples = 0;
  if (!renderer->GetSelector() && GLEW_ARB_sample_shading)
  {
    glGetIntegerv(GL_SAMPLES, &samples);
  }
  samples = std::min(samples, 32); // bits of a mask
  if (samples != this->Content->Samples)
  {
    this->Content->Samples = samples;
    this->SelectionStateChanged.Modified(); // makes new shaders
  }
}

// Decides what to leave out of this frame, by what the last one took.
void vtkNURBSMapper::UpdateEconomy(vtkRenderer* renderer)
{
  Internals& c = *this->Content;
  const double asked = renderer->GetSelector() ? 0.0 : renderer->GetRenderWindow()->GetDesiredUpdateRate();
  const bool exact = c.FrameRate.LooksForPoints();
  c.FrameRate.Decide(asked, this->InteractiveFrameRate, this->TimeToDraw);
  if (exact != c.FrameRate.LooksForPoints())
  {
    this->SelectionStateChanged.Modified(); // makes new shaders
  }
}

void vtkNURBSMapper::RenderPieceDraw(vtkRenderer* renderer, vtkActor* actor)
{
  Internals& c = *this->Content;
  if (!c.TilesAreReady || this->PointPicking)
  {
    return;
  }
  auto* window = static_cast<vtkOpenGLRenderWindow*>(renderer->GetRenderWindow());
  this->DrawingVertices = false;
  this->DrawingSelection = false;
  this->UpdateSamples(renderer);
  this->UpdateEconomy(renderer);
  const double start = vtkTimerLog::GetUniversalTime();
  vtkOpenGLHelper& helper = this->Primitives[PrimitiveTris];
  this->UpdateShaders(helper, renderer, actor);
  if (helper.Program)
  {
    const int representation = actor->GetProperty()->GetRepresentation();
    if (representation == VTK_WIREFRAME)
    {
      window->GetState()->vtkglLineWidth(actor->GetProperty()->GetLineWidth());
    }
    helper.VAO->Bind(); // a new program has released it
    c.Indices.Bind();
    const double coarser = c.FrameRate.GetCoarserLevels();
    helper.Program->SetUniformf("nurbsCoarser", static_cast<float>(coarser));
    for (int shape = 0; shape < nurbs::Tile::ShapeCount; ++shape)
    {
      const int first = c.Textures.GetFirst(shape);
      const int count = c.Textures.GetFirst(shape + 1) - first;
      if (count > 0)
      {
        helper.Program->SetUniformi("nurbsFirstTile", first);
        c.Indices.Draw(representation, Coarser(shape, static_cast<int>(coarser)), count);
      }
    }
    if (c.FrameRate.IsMeasuring())
    {
      // Timer queries tell nothing on software renderers, which put the work off.
      glFinish();
      this->TimeToDraw = vtkTimerLog::GetUniversalTime() - start;
    }
    c.Indices.Unbind();
    vtkOpenGLCheckErrorMacro("failed after drawing tiles");
  }
  c.Textures.Deactivate(window);
  for (vtkNURBSBufferTexture* buffer : { &c.TrimPoints, &c.TrimRecords, &c.LookTexture, &c.FaceIds, &c.LookColors })
  {
    buffer->Deactivate(window);
  }
}

// Everything that was made in the window's context, ours and what we use of the superclass. If that
// window is gone, so are the objects, and only their names are to be forgotten.
void vtkNURBSMapper::ReleaseGraphicsResources(vtkWindow* window)
{
  Internals& c = *this->Content;
  vtkOpenGLRenderWindow* owner = c.Window;
  if (owner)
  {
    owner->PushContext();
    this->VBOs->ReleaseGraphicsResources(owner);
    this->Primitives[PrimitiveTris].ReleaseGraphicsResources(owner);
  }
  c.Textures.Release(owner);
  c.Indices.Release(owner != nullptr);
  for (vtkNURBSBufferTexture* buffer : { &c.TrimPoints, &c.TrimRecords, &c.LookTexture, &c.FaceIds, &c.LookColors })
  {
    buffer->Release(owner != nullptr);
  }
  if (owner)
  {
    owner->PopContext();
  }
  c.Window = nullptr;
  c.ModelIsSent = false;
  c.StandInIsSent = false;
  c.TilesAreReady = false;
  c.LooksAreSent = false;
  c.Tessellated.ReleaseGraphicsResources(window);
  this->Superclass::ReleaseGraphicsResources(window);
}

bool vtkNURBSMapper::HasOpaqueGeometry()
{
  return !this->HasTranslucentPolygonalGeometry();
}

// Translucent faces make the whole actor so, as with any mapper of VTK.
bool vtkNURBSMapper::HasTranslucentPolygonalGeometry()
{
  if (!this->UpdateModel())
  {
    return false;
  }
  Internals& c = *this->Content;
  if (c.Looks.Update(this, c.Model, this->Attributes))
  {
    c.LooksAreSent = false;
  }
  return c.Looks.HasTranslucent();
}

void vtkNURBSMapper::ShallowCopy(vtkAbstractMapper* other)
{
  if (auto* mapper = vtkNURBSMapper::SafeDownCast(other))
  {
    this->SetPixelError(mapper->GetPixelError());
    this->SetExactFragments(mapper->GetExactFragments());
    this->SetUseTessellation(mapper->GetUseTessellation());
    this->SetInteractiveFrameRate(mapper->GetInteractiveFrameRate());
    this->SetLook(mapper->GetLook());
    this->SetLookTable(mapper->GetLookTable());
    this->SetLookDirection(mapper->GetLookDirection());
    this->SetNumberOfStripes(mapper->GetNumberOfStripes());
    this->SetNumberOfIsoLines(mapper->GetNumberOfIsoLines());
    this->SetCompositeDataDisplayAttributes(mapper->GetCompositeDataDisplayAttributes());
  }
  this->Superclass::ShallowCopy(other);
}

void vtkNURBSMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "PixelError: " << this->PixelError << "\n"
     << indent << "ExactFragments: " << this->ExactFragments << "\n"
     << indent << "UseTessellation: " << this->UseTessellation << "\n"
     << indent << "DrawsTessellation: " << this->DrawsTessellation << "\n"
     << indent << "InteractiveFrameRate: " << this->InteractiveFrameRate << "\n"
     << indent << "Look: " << this->Look << "\n"
     << indent << "LookTable: " << this->LookTable.Get() << "\n"
     << indent << "LookDirection: " << this->LookDirection[0] << " " << this->LookDirection[1] << " "
     << this->LookDirection[2] << "\n"
     << indent << "NumberOfStripes: " << this->NumberOfStripes << "\n"
     << indent << "NumberOfIsoLines: " << this->NumberOfIsoLines[0] << " "
     << this->NumberOfIsoLines[1] << "\n"
     << indent << "AchievedPixelError: " << this->AchievedPixelError << "\n"
     << indent << "NumberOfTriangles: " << this->NumberOfTriangles << "\n"
     << indent << "CompositeDataDisplayAttributes: " << this->Attributes.Get() << "\n";
}
