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
 * When control points move, only theirs are sent and only their surfaces evaluated again.
 *
 * Needs OpenGL 3.2. Where the device can't do it, a warning tells why.
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

class vtkCompositeDataDisplayAttributes;
class vtkDataObject;
class vtkOpenGLRenderWindow;

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
   * Visibility, colour and opacity of the blocks of a composite input. Default: none.
   */
  void SetCompositeDataDisplayAttributes(vtkCompositeDataDisplayAttributes* attributes);
  vtkCompositeDataDisplayAttributes* GetCompositeDataDisplayAttributes();
  ///@}

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
  void ProcessSelectorPixelBuffers(vtkHardwareSelector* selector,
    std::vector<unsigned int>& pixelOffsets, vtkProp* prop) override;
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
  void ReplaceShaderValues(std::map<vtkShader::Type, vtkShader*> shaders, vtkRenderer* renderer,
    vtkActor* actor) override;
  void SetMapperShaderParameters(
    vtkOpenGLHelper& helper, vtkRenderer* renderer, vtkActor* actor) override;
  bool HaveWideLines(vtkRenderer*, vtkActor*) override { return false; }
  bool DrawingEdges(vtkRenderer*, vtkActor*) override { return false; }

  double PixelError = 0.5;
  bool ExactFragments = true;
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
  bool DrawsExactly(vtkActor* actor);
  void ReplaceSelection(std::string& fragment);
  void DeleteObjects(vtkOpenGLRenderWindow* window);

  struct Internals;
  std::unique_ptr<Internals> Content;
};

#endif
