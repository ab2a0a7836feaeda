// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSMapper.h"

#include "vtkActor.h"
#include "vtkCamera.h"
#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataObject.h"
#include "vtkExecutive.h"
#include "vtkHardwareSelector.h"
#include "vtkInformation.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNURBSMapperInternals.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSParallel.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLError.h"
#include "vtkOpenGLRenderWindow.h"
#include "vtkOpenGLState.h"
#include "vtkOpenGLVertexArrayObject.h"
#include "vtkOpenGLVertexBufferObject.h"
#include "vtkOpenGLVertexBufferObjectGroup.h"
#include "vtkProperty.h"
#include "vtkRenderer.h"
#include "vtkScalarsToColors.h"
#include "vtkShaderProgram.h"
#include "vtkTimerLog.h"
#include "vtkTransform.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVersionMacros.h"
#include "vtk_glew.h"

#include <algorithm>
#include <optional>

vtkStandardNewMacro(vtkNURBSMapper);

namespace
{

// The shape of a tile that is drawn by some levels coarser.
int Coarser(int shape, int levels)
{
  constexpr int Row = nurbs::Tile::MaxLog + 1;
  return std::max(shape % Row - levels, 0) + Row * std::max(shape / Row - levels, 0);
}

// Draws no more than a selector reads: it draws many frames, often for a pixel. `area`: x and y of the
// first pixel and of the last.
void ScissorTo(vtkOpenGLState* state, const unsigned int* area)
{
  int box[4];
  state->vtkglGetIntegerv(GL_SCISSOR_BOX, box);
  const bool on = state->GetEnumState(GL_SCISSOR_TEST);
  int low[2], high[2];
  for (int k = 0; k < 2; ++k)
  {
    low[k] = static_cast<int>(area[k]);
    high[k] = static_cast<int>(area[k + 2]) + 1;
    if (on)
    {
      low[k] = std::max(low[k], box[k]);
      high[k] = std::min(high[k], box[k] + box[k + 2]);
    }
  }
  state->vtkglEnable(GL_SCISSOR_TEST);
  state->vtkglScissor(low[0], low[1], std::max(high[0] - low[0], 0), std::max(high[1] - low[1], 0));
}

// The actor's matrix, from the model's coordinates to the world's.
void GetModelToWorld(vtkActor* actor, vtkMatrix4x4* matrix)
{
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 0)
  actor->GetModelToWorldMatrix(matrix);
#else
  actor->GetMatrix(matrix);
#endif
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

vtkNURBSMapper::vtkNURBSMapper()
  : Content(new Internals)
{
  this->Content->Watch->OnRelease = [this](vtkOpenGLRenderWindow* window) {
    this->DeleteObjects(window);
  };
}

vtkNURBSMapper::~vtkNURBSMapper()
{
  this->Content->Watch->Release();
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

// An error that holds for as long as the model does not change.
void vtkNURBSMapper::TellOnce(const std::string& error)
{
  if (this->Content->LastError != error)
  {
    vtkErrorMacro("The model can't be drawn: " << error);
    this->Content->LastError = error;
  }
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
  const int degree = c.Model.GetMaxDegree();
  try
  {
    const vtkNURBSDrawnModel::Change change = c.Model.Update(input);
    c.ModelVersion += change.Any();
    c.TrimsAreSent = c.TrimsAreSent && !change.Trims && !change.Surfaces;
    if (change.Surfaces)
    {
      c.ModelIsSent = false;
      c.LastError.clear();
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
    this->TellOnce(error.what());
  }
  if (c.Model.HasOtherData())
  {
    this->TellOnce("the input has no NURBS model, it lacks the arrays of vtkNURBSModel");
  }
  if (c.Model.GetMaxDegree() != degree)
  {
    this->Modified(); // the shader knows it
  }
  return c.Model.GetTable().Size() > 0;
}

void vtkNURBSMapper::UpdateLooks()
{
  Internals& c = *this->Content;
  if (c.Looks.Update(this, c.Model, this->Attributes, this->SelectedColor))
  {
    c.LooksAreSent = false;
  }
}

void vtkNURBSMapper::ComputeBounds()
{
  vtkMath::UninitializeBounds(this->Bounds);
  if (this->UpdateModel())
  {
    this->UpdateLooks();
    const nurbs::Box3 box = this->Content->Model.GetBounds(
      [this](int surface) { return this->Content->Looks.IsHidden(surface); });
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
  std::string error;
  if (!c.ModelIsSent || !c.TrimsAreSent)
  {
    error = vtkNURBSTileTextures::GetMissingFeature(window);
    if (error.empty())
    {
      error = this->SendModel();
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
  std::sort(c.MovedSinceSent.begin(), c.MovedSinceSent.end());
  c.MovedSinceSent.erase(
    std::unique(c.MovedSinceSent.begin(), c.MovedSinceSent.end()), c.MovedSinceSent.end());
  c.Textures.MoveSurfaces(c.Model.GetTable(), c.MovedSinceSent);
  c.MovedSinceSent.clear();
  return true;
}

// Sends surfaces and trims, or trims alone. Returns why the device can't hold them; "" if it can.
std::string vtkNURBSMapper::SendModel()
{
  Internals& c = *this->Content;
  const nurbs::SurfaceTable& table = c.Model.GetTable();
  const nurbs::TrimTexels& trims = c.Model.GetTrims();
  std::vector<vtkNURBSTileTextures::SurfaceInfo> infos(table.Size());
  std::vector<int> ids;
  for (const vtkNURBSDrawnModel::Leaf& leaf : c.Model.GetLeaves())
  {
    for (std::size_t f = 0; f < leaf.Model().Faces.size(); ++f)
    {
      const std::size_t index = leaf.First + f;
      infos[index].Reversed = leaf.Model().Faces[f].Reversed;
      infos[index].Trim = trims.FaceStart[index];
      infos[index].Tolerance = ToleranceOf(leaf.Model(), leaf.Model().Faces[f]);
      ids.insert(
        ids.end(), { static_cast<int>(f), static_cast<int>(leaf.FlatIndex), leaf.Process + 1, 0 });
    }
  }
  if (!(c.ModelIsSent ? c.Textures.SetInfos(table, infos) : c.Textures.SetTable(table, infos)))
  {
    return c.Textures.GetError();
  }
  if (!c.TrimPoints.Upload(trims.Points.data(), 4 * trims.Points.size()) ||
    !c.TrimRecords.Upload(trims.Records.data(), 4 * trims.Records.size()) ||
    (!c.ModelIsSent && !c.FaceIds.Upload(ids.data(), 4 * ids.size())))
  {
    return "the device can't hold this model's trimming curves";
  }
  if (!c.ModelIsSent)
  {
    c.MovedSinceSent.clear();
    c.LooksAreSent = false;
  }
  c.ModelIsSent = c.TrimsAreSent = true;
  return "";
}

void vtkNURBSMapper::RenderPiece(vtkRenderer* renderer, vtkActor* actor)
{
  if (renderer->GetRenderWindow()->CheckAbortStatus())
  {
    return;
  }
  this->Content->Watch->Watch(static_cast<vtkOpenGLRenderWindow*>(renderer->GetRenderWindow()));
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
  GetModelToWorld(actor, this->TempMatrix4);
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

// Sets Selection: the tiles that View needs.
void vtkNURBSMapper::Internals::SelectTiles()
{
  constexpr int Batch = 64;
  constexpr std::size_t Many = 32; // batches that are worth starting threads
  const nurbs::SurfaceTable& table = this->Model.GetTable();
  std::vector<nurbs::TileSelection> parts((table.Size() + Batch - 1) / Batch);
  std::optional<vtkNURBSParallelScope> parallel;
  if (parts.size() > Many)
  {
    parallel.emplace();
  }
  vtkNURBSParallelFor(
    0, static_cast<std::int64_t>(parts.size()), [&](std::int64_t first, std::int64_t last) {
      for (std::int64_t p = first; p < last; ++p)
      {
        const int end = std::min(static_cast<int>(p + 1) * Batch, table.Size());
        for (int s = static_cast<int>(p) * Batch; s < end; ++s)
        {
          if (!this->Looks.IsHidden(s))
          {
            nurbs::SelectTiles(table, s, this->View, parts[p]);
          }
        }
      }
    });
  this->Selection = nurbs::TileSelection();
  for (const nurbs::TileSelection& part : parts)
  {
    this->Selection.Tiles.insert(this->Selection.Tiles.end(), part.Tiles.begin(), part.Tiles.end());
    this->Selection.Cells += part.Cells;
    this->Selection.PixelError = std::max(this->Selection.PixelError, part.PixelError);
  }
}

// Selects and evaluates the tiles that this view needs.
void vtkNURBSMapper::UpdateBufferObjects(vtkRenderer* renderer, vtkActor* actor)
{
  Internals& c = *this->Content;
  auto* window = static_cast<vtkOpenGLRenderWindow*>(renderer->GetRenderWindow());
  this->UpdateLooks();
  if (!c.LooksAreSent)
  {
    c.LooksAreSent = true;
    c.LookTexture.Upload(c.Looks.GetBytes().data(), c.Looks.GetBytes().size());
    c.TilesAreReady = false; // blocks may have been hidden or shown
  }
  vtkCamera* camera = renderer->GetActiveCamera();
  nurbs::TileView view;
  vtkNew<vtkMatrix4x4> toClip;
  GetModelToWorld(actor, toClip);
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
  c.SelectTiles();
  c.TilesAreReady = c.Textures.Prepare(window, c.Model.GetTable(), c.Selection.Tiles);
  if (!c.TilesAreReady)
  {
    vtkErrorMacro(
      "The model can't be drawn at " << this->PixelError << " pixels: " << c.Textures.GetError());
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

void vtkNURBSMapper::SetOrigin(vtkUnstructuredGrid* model, unsigned int flatIndex, int process)
{
  vtkNURBSDrawnModel::SetOrigin(model, flatIndex, process);
}

void vtkNURBSMapper::ProcessSelectorPixelBuffers(
  vtkHardwareSelector*, std::vector<unsigned int>&, vtkProp*)
{
  // The shader writes cells, not primitives that would have to be translated.
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
  const double asked =
    renderer->GetSelector() ? 0.0 : renderer->GetRenderWindow()->GetDesiredUpdateRate();
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
    vtkOpenGLState::ScopedglEnableDisable culling(window->GetState(), GL_CULL_FACE);
    vtkOpenGLState::ScopedglScissor scissor(window->GetState());
    if (vtkHardwareSelector* selector = renderer->GetSelector())
    {
      ScissorTo(window->GetState(), selector->GetArea());
    }
    if (this->DrawsExactly(actor))
    {
      window->GetState()->vtkglDisable(GL_CULL_FACE); // fragments know their side better
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
  for (vtkNURBSBufferTexture* buffer :
    { &c.TrimPoints, &c.TrimRecords, &c.LookTexture, &c.FaceIds, &c.LookColors })
  {
    buffer->Deactivate(window);
  }
}

// Everything is deleted in the context that it was made in.
void vtkNURBSMapper::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Content->Watch->Release();
  this->Content->Tessellated.ReleaseGraphicsResources(window);
  this->Superclass::ReleaseGraphicsResources(window);
}

// With the window's context current: deletes what was made in it, ours and what we use of the
// superclass.
void vtkNURBSMapper::DeleteObjects(vtkOpenGLRenderWindow* window)
{
  Internals& c = *this->Content;
  this->VBOs->ReleaseGraphicsResources(window);
  this->Primitives[PrimitiveTris].ReleaseGraphicsResources(window);
  c.Textures.Release(window);
  c.Indices.Release();
  for (vtkNURBSBufferTexture* buffer :
    { &c.TrimPoints, &c.TrimRecords, &c.LookTexture, &c.FaceIds, &c.LookColors })
  {
    buffer->Release();
  }
  c.ModelIsSent = c.TrimsAreSent = false;
  c.StandInIsSent = false;
  c.TilesAreReady = false;
  c.LooksAreSent = false;
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
  this->UpdateLooks();
  return this->Content->Looks.HasTranslucent();
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
    this->SetLookLength(mapper->GetLookLength());
    this->SetLookDirection(mapper->GetLookDirection());
    this->SetNumberOfStripes(mapper->GetNumberOfStripes());
    this->SetNumberOfIsoLines(mapper->GetNumberOfIsoLines());
    this->SetSelectedColor(mapper->GetSelectedColor());
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
     << indent << "LookLength: " << this->LookLength << "\n"
     << indent << "LookDirection: " << this->LookDirection[0] << " " << this->LookDirection[1]
     << " " << this->LookDirection[2] << "\n"
     << indent << "NumberOfStripes: " << this->NumberOfStripes << "\n"
     << indent << "NumberOfIsoLines: " << this->NumberOfIsoLines[0] << " "
     << this->NumberOfIsoLines[1] << "\n"
     << indent << "SelectedColor: " << this->SelectedColor[0] << " " << this->SelectedColor[1]
     << " " << this->SelectedColor[2] << "\n"
     << indent << "AchievedPixelError: " << this->AchievedPixelError << "\n"
     << indent << "NumberOfTriangles: " << this->NumberOfTriangles << "\n"
     << indent << "CompositeDataDisplayAttributes: " << this->Attributes.Get() << "\n";
}
