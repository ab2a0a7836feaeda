// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSSurfaceRepresentation
 * @brief Shows NURBS models in ParaView's render view by vtkNURBSMapper: surfaces, not triangles.
 *
 * The models travel to where they are drawn as they are: control points, knots and trims. Colours by
 * cell arrays, opacity, material, transforms, and the visibility, colours and opacities of blocks work
 * as in vtkGeometryRepresentation. A selected cell is a CAD face, and is shown in the selection's
 * colour; its label stands on it, unless control points have labels, too (see vtkNURBSFaceMarks).
 * While the user moves the camera the mapper itself keeps to InteractiveFrameRate; ParaView's own
 * levels of detail are not asked for.
 *
 * Where a client draws a server's models, which faces are selected travels as a second piece beside
 * them. ParaView delivers all pieces of a representation or none: models are sent again with it.
 *
 * @sa vtkNURBSMapper
 */
#ifndef vtkNURBSSurfaceRepresentation_h
#define vtkNURBSSurfaceRepresentation_h

#include "vtkGeometryRepresentation.h"
#include "vtkNURBSParaViewServerModule.h" // For export macro
#include "vtkSmartPointer.h"              // For the selection and the legend

#include <vector> // For the selections

class vtkNURBSMapper;
class vtkScalarBarActor;
class vtkSelection;

class VTKNURBSPARAVIEWSERVER_EXPORT vtkNURBSSurfaceRepresentation : public vtkGeometryRepresentation
{
public:
  static vtkNURBSSurfaceRepresentation* New();
  vtkTypeMacro(vtkNURBSSurfaceRepresentation, vtkGeometryRepresentation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Colour faces by the cell data Color (sRGB bytes) of their model, where no other array colours them
   * and the model has it. Default on.
   */
  vtkSetMacro(UseModelColors, bool);
  vtkGetMacro(UseModelColors, bool);
  vtkBooleanMacro(UseModelColors, bool);
  ///@}

  ///@{
  /**
   * Draw the edges of faces, in the property's edge colour and line width. Default off.
   */
  vtkSetMacro(FaceEdges, bool);
  vtkGetMacro(FaceEdges, bool);
  vtkBooleanMacro(FaceEdges, bool);
  ///@}

  ///@{
  /**
   * Curvatures and draft angles go from blue over white to red over LookRange, instead of the
   * mapper's own range. Default off; 0 to 1.
   */
  void SetUseLookRange(bool use);
  vtkGetMacro(UseLookRange, bool);
  void SetLookRange(double least, double largest);
  vtkGetVector2Macro(LookRange, double);
  ///@}

  ///@{
  /**
   * A bar with the colours of curvatures and draft angles, where surfaces show these (see SetLook), at
   * the left border of the view. Default on, white.
   */
  vtkSetMacro(ShowLegend, bool);
  vtkGetMacro(ShowLegend, bool);
  vtkBooleanMacro(ShowLegend, bool);
  void SetLegendColor(double red, double green, double blue);
  ///@}

  ///@{
  /**
   * See vtkNURBSMapper.
   */
  void SetPixelError(double pixels);
  void SetExactFragments(bool exact);
  void SetUseTessellation(bool use);
  void SetInteractiveFrameRate(double rate);
  void SetLook(int look);
  void SetLookDirection(double x, double y, double z);
  void SetNumberOfStripes(int stripes);
  void SetNumberOfIsoLines(int u, int v);
  vtkIdType GetNumberOfTriangles();
  double GetAchievedPixelError();
  bool GetDrawsTessellation();
  ///@}

  ///@{
  /**
   * From vtkGeometryRepresentation's point of view. A cell needs no array that tells its index.
   */
  int ProcessViewRequest(
    vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo) override;
  void SetMapScalars(int map) override;
  void SetVisibility(bool visible) override;
  void SetSuppressLOD(bool) override {}
  void SetArrayIdNames(const char*, const char*) override {}
  ///@}

protected:
  vtkNURBSSurfaceRepresentation();
  ~vtkNURBSSurfaceRepresentation() override;

  bool AddToView(vtkView* view) override;
  bool RemoveFromView(vtkView* view) override;
  void UpdateColoringParameters() override;

private:
  vtkNURBSSurfaceRepresentation(const vtkNURBSSurfaceRepresentation&) = delete;
  void operator=(const vtkNURBSSurfaceRepresentation&) = delete;

  vtkNURBSMapper* GetNURBSMapper();
  void SetDrawnData(vtkDataObject* delivered);
  void UpdateBlockAttributes(vtkDataObject* delivered);
  bool IsApart();
  void PutLabelsOnFaces();
  void RenewSelection();
  vtkSmartPointer<vtkSelection> FindSelectedFaces();
  void ShowSelectedFaces();
  void ShowDeliveredSelection(vtkDataObject* delivered);
  void UpdateLookTable();
  bool ColorsByArray(const char*& name, bool& direct);

  bool UseModelColors = true;
  bool FaceEdges = false;
  vtkSmartPointer<vtkScalarBarActor> Legend;
  bool ShowLegend = true;
  bool UseLookRange = false;
  double LookRange[2] = { 0.0, 1.0 };
  bool MapScalars = true;
  vtkMTimeType BlocksOf = 0;                ///< MTime of the data whose blocks the mapper knows.
  std::vector<vtkMTimeType> FoundTimes;     ///< Of the selections that FindSelectedFaces found.
  std::vector<vtkMTimeType> SelectionTimes; ///< Of the selections that the mapper knows.
  vtkMTimeType SelectionViewTime = 0;       ///< Of the representations of selections in the view.
  vtkMTimeType DeliveredTime = 0;           ///< Of the delivered selection that the mapper knows.
};

#endif
