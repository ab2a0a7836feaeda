// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSControlPointRepresentation
 * @brief Handles on the control points of NURBS models: what vtkNURBSControlPointWidget drags.
 *
 * A handle is a disc of HandleSize pixels at a control point of the output of a
 * vtkNURBSControlPointEdits; all of them are one drawing call. Handles of the selection and the one
 * under the cursor have colours of their own. The net is drawn as lines.
 *
 * Picking needs no picker: of the handles within PickRadius pixels of the cursor, those that the
 * model does not hide go first (by the depths of the last picture); among them the nearest to the
 * cursor is taken, and of several within 1.5 pixels of it the one next to the viewer.
 *
 * A drag moves the selection in the plane through the picked handle that is parallel to the view,
 * so that this handle stays under the cursor; constrained to a line, to where the line passes
 * nearest to the cursor's line of sight. The lines are parallel to an axis of the world, or normal
 * to the surface at the handle's Greville abscissae before the drag; on a line seen end-on nothing
 * moves. A drag is one edit for Undo. Control points that coincide move together as
 * vtkNURBSControlPointEdits decides.
 *
 * Models are drawn as they are: an actor that transforms them would leave its handles behind.
 *
 * The bounds given to PlaceWidget are only noted: handles are where control points are. The
 * representation is not pickable, so that it is not in the way of other pickers.
 */
#ifndef vtkNURBSControlPointRepresentation_h
#define vtkNURBSControlPointRepresentation_h

#include "vtkNURBSRenderingWidgetsModule.h" // For export macro
#include "vtkWidgetRepresentation.h"

#include <memory> // For std::unique_ptr

class vtkNURBSControlPointEdits;

class VTKNURBSRENDERINGWIDGETS_EXPORT vtkNURBSControlPointRepresentation
  : public vtkWidgetRepresentation
{
public:
  static vtkNURBSControlPointRepresentation* New();
  vtkTypeMacro(vtkNURBSControlPointRepresentation, vtkWidgetRepresentation);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// States of the interaction.
  enum InteractionStateType
  {
    Outside = 0, ///< No handle under the cursor.
    OnHandle,
    Dragging,
    BoxSelecting
  };

  /// Where a drag may lead.
  enum ConstraintType
  {
    VIEW_PLANE = 0,
    X_AXIS,
    Y_AXIS,
    Z_AXIS,
    SURFACE_NORMAL
  };

  /// Of which faces the net is drawn.
  enum NetType
  {
    NET_OFF = 0,
    NET_OF_SELECTED_FACES, ///< Faces that use a selected control point.
    NET_OF_ALL_FACES
  };

  /// What is drawn of handles and lines that the model hides.
  enum HiddenHandlesType
  {
    HIDE = 0,
    FAINT, ///< With HiddenOpacity.
    SHOW   ///< As if nothing were before them.
  };

  ///@{
  /**
   * The edits whose output is shown and that a drag changes. None: no handles.
   */
  void SetEdits(vtkNURBSControlPointEdits* edits);
  vtkNURBSControlPointEdits* GetEdits();
  ///@}

  ///@{
  /**
   * The selection, in the order in which it was made. Points are named by the flat index of their
   * block (0 for a single model) and their index there. SelectControlPoint returns false if there
   * is no such handle.
   */
  bool SelectControlPoint(unsigned int block, vtkIdType point);
  bool DeselectControlPoint(unsigned int block, vtkIdType point);
  bool IsSelected(unsigned int block, vtkIdType point);
  void SelectAll();
  void ClearSelection();
  vtkIdType GetNumberOfSelectedControlPoints();
  unsigned int GetSelectedBlock(vtkIdType index);
  vtkIdType GetSelectedControlPoint(vtkIdType index);
  ///@}

  /**
   * Select all handles inside a rectangle of the window, given in display coordinates of opposite
   * corners, besides those selected before. Returns how many were inside.
   */
  vtkIdType SelectBox(double x1, double y1, double x2, double y2);

  /**
   * Look for the handle at a place of the window; what is found is the hovered one. True if there
   * is one.
   */
  bool Pick(double x, double y);

  ///@{
  /**
   * The handle under the cursor: its point (-1: none) and block.
   */
  vtkIdType GetHoveredControlPoint();
  unsigned int GetHoveredBlock();
  ///@}

  /**
   * Multiply the weights of the selection by a factor, as one edit. False if that was refused or
   * nothing is selected.
   */
  virtual bool ScaleSelectedWeights(double factor);

  ///@{
  /**
   * The constraint of drags. If it changes during a drag, the drag goes on from its start as
   * constrained. Default VIEW_PLANE.
   */
  void SetConstraint(int constraint);
  vtkGetMacro(Constraint, int);
  ///@}

  /**
   * Displacement of the selection by the present drag, or the last one.
   */
  vtkGetVector3Macro(Displacement, double);

  /**
   * End a drag or box selection and leave everything as it was before it.
   */
  void CancelInteraction();

  ///@{
  /**
   * Of which faces the net is drawn, how wide, and in which colour. Defaults NET_OF_ALL_FACES, 1
   * pixel, (0.55, 0.6, 0.65).
   */
  vtkSetClampMacro(Net, int, NET_OFF, NET_OF_ALL_FACES);
  vtkGetMacro(Net, int);
  vtkSetClampMacro(NetWidth, double, 0.1, 100.0);
  vtkGetMacro(NetWidth, double);
  vtkSetVector3Macro(NetColor, double);
  vtkGetVector3Macro(NetColor, double);
  ///@}

  ///@{
  /**
   * What is drawn of handles and lines behind the model, and how opaque it is there. HIDE also
   * keeps them from being picked. Defaults FAINT, 0.25.
   */
  vtkSetClampMacro(HiddenHandles, int, HIDE, SHOW);
  vtkGetMacro(HiddenHandles, int);
  vtkSetClampMacro(HiddenOpacity, double, 0.01, 1.0);
  vtkGetMacro(HiddenOpacity, double);
  ///@}

  ///@{
  /**
   * How far from the cursor a handle is found, in pixels. Default 8. (HandleSize, the diameter of
   * the discs, is 7 pixels by default; those selected or hovered are 2 larger.)
   */
  vtkSetClampMacro(PickRadius, double, 0.0, 1000.0);
  vtkGetMacro(PickRadius, double);
  ///@}

  ///@{
  /**
   * Colours of handles, red, green, blue in 0 to 1. Defaults (0.1, 0.35, 0.8), (1, 0.45, 0) and (1,
   * 0.85, 0).
   */
  vtkSetVector3Macro(HandleColor, double);
  vtkGetVector3Macro(HandleColor, double);
  vtkSetVector3Macro(SelectedColor, double);
  vtkGetVector3Macro(SelectedColor, double);
  vtkSetVector3Macro(HoverColor, double);
  vtkGetVector3Macro(HoverColor, double);
  ///@}

  ///@{
  /**
   * How many handles there are, and where in the window one is: x, y in pixels and the depth, -1
   * (near) to 1 (far). False if it is not before the camera or there is no such handle.
   */
  vtkIdType GetNumberOfHandles();
  bool GetHandleDisplayPosition(unsigned int block, vtkIdType point, double display[3]);
  ///@}

  ///@{
  /**
   * The parts of an interaction, called by the widget. Positions are display coordinates.
   */
  void PlaceWidget(double bounds[6]) override;
  void BuildRepresentation() override;
  int ComputeInteractionState(int x, int y, int modify = 0) override;
  void StartWidgetInteraction(double position[2]) override;
  void WidgetInteraction(double position[2]) override;
  void EndWidgetInteraction(double position[2]) override;
  void StartBoxSelection(double position[2]);
  void Highlight(int on) override;
  ///@}

  ///@{
  /**
   * Drawing.
   */
  double* GetBounds() VTK_SIZEHINT(6) override;
  void ReleaseGraphicsResources(vtkWindow* window) override;
  int RenderOverlay(vtkViewport* viewport) override;
  ///@}

protected:
  vtkNURBSControlPointRepresentation();
  ~vtkNURBSControlPointRepresentation() override;

  int Constraint = VIEW_PLANE;
  int Net = NET_OF_ALL_FACES;
  int HiddenHandles = FAINT;
  double HiddenOpacity = 0.25;
  double PickRadius = 8.0;
  double NetWidth = 1.0;
  double NetColor[3] = { 0.55, 0.6, 0.65 };
  double HandleColor[3] = { 0.1, 0.35, 0.8 };
  double SelectedColor[3] = { 1.0, 0.45, 0.0 };
  double HoverColor[3] = { 1.0, 0.85, 0.0 };
  double Displacement[3] = { 0.0, 0.0, 0.0 };

private:
  vtkNURBSControlPointRepresentation(const vtkNURBSControlPointRepresentation&) = delete;
  void operator=(const vtkNURBSControlPointRepresentation&) = delete;

  struct vtkInternals;

  void UpdateHandles();
  void UpdateLayers();
  void UpdateStyles();
  void UpdateBox();
  void Drag();
  bool MoveSelection();

  std::unique_ptr<vtkInternals> Internals;
  double HandleBounds[6];
};

#endif
