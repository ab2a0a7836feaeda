// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkNURBSMapper
 * @brief   draws trimmed NURBS models exactly, evaluated and trimmed by the GPU
 *
 * The input is a model of vtkNURBSModel (a vtkUnstructuredGrid), or a composite data set of models,
 * straight from a reader or filter: no tessellation upstream. Control points, knots and trimming
 * curves travel to the GPU, nothing else. There, surfaces are evaluated by de Boor's algorithm in two
 * directional passes into float textures that stay; the vertex stage fetches from them; the fragment
 * stage trims with the curves themselves, at any zoom.
 *
 * How finely a surface is evaluated depends on the view, frame by frame: triangles are off it by at
 * most PixelError pixels. What a view needs and the last one had is not evaluated again.
 *
 * Use it as any mapper: lights, materials, opacity, depth peeling, clipping planes, back faces,
 * picking of cells (a cell is a CAD face) come from vtkOpenGLPolyDataMapper. Colours are those of
 * cell arrays through the lookup table; arrays of control points do not colour.
 *
 * When control points move, only theirs are sent and only their surfaces evaluated again; new trims are
 * sent alone, and nothing is evaluated for them.
 *
 * Needs OpenGL 3.2. Where the device can't do it, a warning tells why, and the model is drawn by
 * vtkNURBSTessellator.
 *
 * A mapper's textures live in one window at a time: drawn in another one, it moves there.
 *
 * Source: D. Tan, G. Zhao, H. Lu, "GPU Based Evaluation and LOD Rendering of NURBS Surfaces",
 * Computer-Aided Design and Applications 9 (2012). What is done differently and why is told in
 * Documentation/Papers/tan-2012.md.
 *
 * @sa vtkNURBSTessellator, vtkNURBSModel
 */
#ifndef vtkNURBSMapper_h
#define vtkNURBSMapper_h

#include "vtkNURBSRenderingOpenGL2Module.h" // For export macro
#include "vtkOpenGLPolyDataMapper.h"
#include "vtkSmartPointer.h" // For the attributes

#include <memory> // For the internals
#include <string> // For parts of shaders

class vtkCompositeDataDisplayAttributes;
class vtkDataObject;
class vtkOpenGLRenderWindow;
class vtkScalarsToColors;
class vtkShaderProgram;
class vtkUnstructuredGrid;

class VTKNURBSRENDERINGOPENGL2_EXPORT vtkNURBSMapper : public vtkOpenGLPolyDataMapper
{
public:
  static vtkNURBSMapper* New();
  vtkTypeMacro(vtkNURBSMapper, vtkOpenGLPolyDataMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * A model or a composite data set of models, instead of a connection.
   */
  void SetInputData(vtkDataObject* input);

  ///@{
  /**
   * Bound of the distance, on screen and in pixels, between the triangles drawn and the surfaces.
   * Default 0.5, 0.001 to 100.
   */
  vtkSetClampMacro(PixelError, double, 0.001, 100.0);
  vtkGetMacro(PixelError, double);
  ///@}

  ///@{
  /**
   * Whether each pixel looks for the point of the surface that it sees, instead of taking that of the
   * triangle. Outlines, trims, edges and normals are exact then, and no gap opens between faces that
   * share an edge, at any PixelError; a fragment costs two or three evaluations of its surface.
   * Default on.
   */
  vtkSetMacro(ExactFragments, bool);
  vtkGetMacro(ExactFragments, bool);
  vtkBooleanMacro(ExactFragments, bool);
  ///@}

  ///@{
  /**
   * Whether triangles of vtkNURBSTessellator, within PixelError, are drawn instead, even if the device
   * can do better. Default off. GetDrawsTessellation tells whether the last frame was drawn that way,
   * for this or because the device can't evaluate the model; then picked cells are triangles.
   */
  vtkSetMacro(UseTessellation, bool);
  vtkGetMacro(UseTessellation, bool);
  vtkBooleanMacro(UseTessellation, bool);
  vtkGetMacro(DrawsTessellation, bool);
  ///@}

  ///@{
  /**
   * Frames a second to be reached while the window asks for many, as an interactor does while the
   * camera moves (vtkRenderWindow::SetDesiredUpdateRate). Where the whole is too slow for it, pixels take
   * the triangles' points, then what was evaluated is drawn at coarser levels, without evaluating it
   * again and with all values between levels, so that nothing jumps. Default 15; 0: always the whole.
   * GetCoarserLevels tells by how many levels the last frame was coarser, 0 to 1.5.
   */
  vtkSetClampMacro(InteractiveFrameRate, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(InteractiveFrameRate, double);
  double GetCoarserLevels();
  ///@}

  /// What surfaces show instead of their colour; see SetLook.
  enum Looks
  {
    PLAIN = 0,
    MEAN_CURVATURE,
    GAUSSIAN_CURVATURE,
    MINIMUM_CURVATURE,
    MAXIMUM_CURVATURE,
    ZEBRA,
    ISOPHOTES,
    DRAFT_ANGLE
  };

  ///@{
  /**
   * What surfaces show, found for each pixel from the exact derivatives: their colour (PLAIN, default);
   * a curvature (1 / length; its square for GAUSSIAN_CURVATURE; mean and principal ones are positive
   * where the surface bends away from its outside, as a ball does) or the angle between the surface and
   * LookDirection (DRAFT_ANGLE, in degrees, 90 where the outside looks that way) by LookTable; stripes
   * that a mirror would show of a striped room (ZEBRA), or lines of equal angle to LookDirection
   * (ISOPHOTES), as stripes of the colour and black.
   */
  vtkSetClampMacro(Look, int, PLAIN, DRAFT_ANGLE);
  vtkGetMacro(Look, int);
  void SetLookToPlain() { this->SetLook(PLAIN); }
  void SetLookToMeanCurvature() { this->SetLook(MEAN_CURVATURE); }
  void SetLookToGaussianCurvature() { this->SetLook(GAUSSIAN_CURVATURE); }
  void SetLookToMinimumCurvature() { this->SetLook(MINIMUM_CURVATURE); }
  void SetLookToMaximumCurvature() { this->SetLook(MAXIMUM_CURVATURE); }
  void SetLookToZebra() { this->SetLook(ZEBRA); }
  void SetLookToIsophotes() { this->SetLook(ISOPHOTES); }
  void SetLookToDraftAngle() { this->SetLook(DRAFT_ANGLE); }
  ///@}

  ///@{
  /**
   * Colours of curvatures and draft angles, over the table's own range. Default: none, which means blue
   * to white to red: curvatures from -10 to 10 (Gaussian -100 to 100) over the bounds' diagonal (its
   * square), angles from -90 to 90.
   */
  void SetLookTable(vtkScalarsToColors* table);
  vtkScalarsToColors* GetLookTable();
  ///@}

  /**
   * What colours curvatures and draft angles, for a legend: LookTable, or a table of the default.
   */
  vtkSmartPointer<vtkScalarsToColors> GetLookColors();

  ///@{
  /**
   * The length that takes the place of the bounds' diagonal there: that of the whole model, if other
   * processes draw the rest of it. Default 0: the diagonal.
   */
  vtkSetClampMacro(LookLength, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(LookLength, double);
  ///@}

  ///@{
  /**
   * Direction of draft, isophotes' light and the zebra's stripes, in the model's axes; of any length
   * but 0. Default (0, 0, 1).
   */
  vtkSetVector3Macro(LookDirection, double);
  vtkGetVector3Macro(LookDirection, double);
  ///@}

  ///@{
  /**
   * Stripes in 180 degrees, of ZEBRA and ISOPHOTES. Default 18, 2 to 720.
   */
  vtkSetClampMacro(NumberOfStripes, int, 2, 720);
  vtkGetMacro(NumberOfStripes, int);
  ///@}

  ///@{
  /**
   * Into how many parts lines of constant u, and of constant v, cut each face's domain; drawn as the
   * property draws edges (EdgeColor, LineWidth). Default 0, 0: no lines; up to 1000. With the property's
   * EdgeVisibility, the edges of faces are drawn the same way.
   */
  vtkSetVector2Macro(NumberOfIsoLines, int);
  vtkGetVector2Macro(NumberOfIsoLines, int);
  ///@}

  ///@{
  /**
   * Visibility, colour and opacity of the blocks of a composite input. Default: none.
   */
  void SetCompositeDataDisplayAttributes(vtkCompositeDataDisplayAttributes* attributes);
  vtkCompositeDataDisplayAttributes* GetCompositeDataDisplayAttributes();
  ///@}

  ///@{
  /**
   * Colour of the faces that the mapper's selection names (vtkMapper::SetSelection): nodes of cells by
   * indices, in a composite input with the block's COMPOSITE_INDEX, of several processes with the
   * PROCESS_ID. Default (1, 0, 1). Not where triangles of vtkNURBSTessellator are drawn instead.
   */
  vtkSetVector3Macro(SelectedColor, double);
  vtkGetVector3Macro(SelectedColor, double);
  ///@}

  /**
   * Tells in a model's field data where it comes from, for inputs that were put together of others,
   * and by other processes: its flat index in the composite there (0: it was in none), and the process
   * that has it (-1: the one that draws). Selections name faces by these, instead of their place in
   * the input.
   */
  static void SetOrigin(vtkUnstructuredGrid* model, unsigned int flatIndex, int process);

  ///@{
  /**
   * Of the last frame: triangles drawn, and the bound that they keep (over PixelError only if a span
   * would need more than 4096 cells in a direction).
   */
  vtkGetMacro(NumberOfTriangles, vtkIdType);
  vtkGetMacro(AchievedPixelError, double);
  ///@}

  ///@{
  /**
   * Since the mapper was made: bytes that were sent to the GPU, and vertices evaluated there.
   */
  vtkIdType GetNumberOfBytesSent();
  vtkIdType GetNumberOfEvaluatedVertices();
  ///@}

  ///@{
  /**
   * From vtkMapper and vtkProp's point of view.
   */
  void RenderPiece(vtkRenderer* renderer, vtkActor* actor) override;
  void RenderPieceDraw(vtkRenderer* renderer, vtkActor* actor) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;
  bool HasOpaqueGeometry() override;
  bool HasTranslucentPolygonalGeometry() override;
  void ShallowCopy(vtkAbstractMapper* other) override;
  void ProcessSelectorPixelBuffers(
    vtkHardwareSelector* selector, std::vector<unsigned int>& pixelOffsets, vtkProp* prop) override;
  vtkMTimeType GetMTime() override;
  ///@}

protected:
  vtkNURBSMapper();
  ~vtkNURBSMapper() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  void ComputeBounds() override;
  void UpdateCameraShiftScale(vtkRenderer* renderer, vtkActor* actor) override;
  void UpdateBufferObjects(vtkRenderer* renderer, vtkActor* actor) override;
  void UpdateMaximumPointCellIds(vtkRenderer* renderer, vtkActor* actor) override;
  void ReplaceShaderValues(
    std::map<vtkShader::Type, vtkShader*> shaders, vtkRenderer* renderer, vtkActor* actor) override;
  void SetMapperShaderParameters(
    vtkOpenGLHelper& helper, vtkRenderer* renderer, vtkActor* actor) override;
  bool HaveWideLines(vtkRenderer*, vtkActor*) override { return false; }
  bool DrawingEdges(vtkRenderer*, vtkActor*) override { return false; }

  double PixelError = 0.5;
  bool ExactFragments = true;
  bool UseTessellation = false;
  bool DrawsTessellation = false;
  double InteractiveFrameRate = 15.0;
  int Look = PLAIN;
  vtkSmartPointer<vtkScalarsToColors> LookTable;
  double LookLength = 0.0;
  double LookDirection[3] = { 0.0, 0.0, 1.0 };
  int NumberOfStripes = 18;
  int NumberOfIsoLines[2] = { 0, 0 };
  double SelectedColor[3] = { 1.0, 0.0, 1.0 };
  double AchievedPixelError = 0.0;
  vtkIdType NumberOfTriangles = 0;
  vtkSmartPointer<vtkCompositeDataDisplayAttributes> Attributes;

private:
  vtkNURBSMapper(const vtkNURBSMapper&) = delete;
  void operator=(const vtkNURBSMapper&) = delete;

  void TellOnce(const std::string& error);
  bool UpdateModel();
  void UpdateLooks();
  bool UpdateTextures(vtkRenderer* renderer);
  std::string SendModel();
  bool HasLook(vtkActor* actor);
  bool DrawsExactly(vtkActor* actor);
  std::string GetDefines(vtkActor* actor);
  void SetSurfaceParameters(
    vtkOpenGLRenderWindow* window, vtkShaderProgram* program, vtkActor* actor);
  void SetLookParameters(vtkOpenGLRenderWindow* window, vtkShaderProgram* program, vtkActor* actor);
  void ReplaceSelection(std::string& fragment);
  void DeleteObjects(vtkOpenGLRenderWindow* window);
  void UpdateSamples(vtkRenderer* renderer);
  void UpdateEconomy(vtkRenderer* renderer);

  struct Internals;
  std::unique_ptr<Internals> Content;
};

#endif
