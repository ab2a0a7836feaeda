// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSVisibleRegions
 * @brief What is seen of a model from somewhere: a model of the visible regions, and a line drawing.
 *
 * All surfaces of the input, or of all models of a composite input, hide each other and themselves.
 * Silhouettes and edges are projected to the image plane, snapped to a grid of half the precision and
 * made a planar map; one line of sight a cell, cast at the exact trimmed surfaces, tells what is in
 * front. Works without a window.
 *
 * Output 0 is a model again, or a composite of the input's type and structure: faces keep their
 * surface and get the visible region as trims (with SetRegion(HIDDEN_REGION): what is not visible).
 * Borders that are edges are parts of the exact trim curves and stay shared by neighbours, whose edges
 * are numbered anew. Silhouettes and shadows are polylines in (u, v). Faces without a region are left
 * out. Without ComputeRegions models of output 0 are empty.
 *
 * | where | array | meaning |
 * |---|---|---|
 * | cell data | all attributes of the input's faces | |
 * | cell data | VisibleArea (double) | on the surface, in squared units of length |
 * | cell data | VisibleFraction (double) | of the area of the face; 0 for a hidden face |
 *
 * Output 1 is a drawing: polylines, each on one face and visible or hidden as a whole.
 *
 * | where | array | meaning |
 * |---|---|---|
 * | points (double) | | on the surface; with ProjectLines: x (right) and y (up) in the image plane |
 * | point data | UV (double, 2) | parameters in the domain of the line's face |
 * | cell data | Visibility (unsigned char) | 1 visible, 0 hidden |
 * | cell data | Kind (unsigned char) | 0 silhouette (or a smooth edge that is an outline), 1 boundary, 2 sharp edge, 3 smooth edge, 4 intersection of faces |
 * | cell data | EdgeId | the edge that the line is part of, as the input's trim curves name it; -1: none |
 * | cell data | FaceId and all other attributes of the input's faces | of the line's face (of an edge: the first that uses it; of an intersection: the first of the two) |
 *
 * Precision is that of the image: borders of regions and ends of visible lines are within it, and what
 * is narrower may be left out; it must be at least 2e-9 of the image's size. In perspective the image
 * plane passes through the farthest point of the model's bounding box, across the line from the eye to
 * the box's middle; the eye must have all of the box before it.
 *
 * Where different faces pierce each other, their intersection curves are found and border the regions
 * (FaceIntersections.h says which curves are). Faces that still pierce or touch each other within a cell
 * of the map are told in one warning and by NumberOfPiercingPairs: the border between their regions is
 * not exact there. Of faces that lie on each other, within a billionth of the model's size, the first one
 * is seen. Faces that can't be used hide nothing, and are named in one warning with those whose
 * silhouettes have gaps. A view that is not valid, or an input without NURBS arrays, is an error. Work is
 * spread by vtkSMPTools, the result does not depend on the number of threads. Reports progress and obeys
 * AbortExecute, which leaves the outputs empty.
 *
 * What is the same from every view (the surfaces as rays see them, the curves in which faces pierce each
 * other) is kept for the next update, until the input or the precision changes. Arrays whose numbers are
 * changed in place (as by numpy) have to be told so by Modified(), as everywhere in VTK.
 *
 * Source: X. Ruan, H. Zhang, J. Yong, "Visible region extraction from a sequence of rational Bezier
 * surfaces", Journal of Zhejiang University SCIENCE A 7 (2006), section 4. What is done differently and
 * why is told in Documentation/Papers/ruan-2006.md.
 *
 * @sa vtkNURBSSilhouette vtkNURBSModel
 */
#ifndef vtkNURBSVisibleRegions_h
#define vtkNURBSVisibleRegions_h

#include "vtkNURBSViewAlgorithm.h"

#include <memory> // For std::unique_ptr

class vtkPolyData;

class vtkNURBSPieces;

class VTKNURBSFILTERSVISIBILITY_EXPORT vtkNURBSVisibleRegions : public vtkNURBSViewAlgorithm
{
public:
  static vtkNURBSVisibleRegions* New();
  vtkTypeMacro(vtkNURBSVisibleRegions, vtkNURBSViewAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * What points upwards in the image; a Camera's own view-up goes before. Parallel to the view or zero:
   * the z axis does, or the y axis if the view is along z. Default (0, 0, 1).
   */
  vtkSetVector3Macro(ViewUp, double);
  vtkGetVector3Macro(ViewUp, double);
  ///@}

  /// What Region may be.
  enum Regions
  {
    VISIBLE_REGION = 0,
    HIDDEN_REGION = 1
  };

  ///@{
  /**
   * Whether output 0 and the figures of it are made. Off: only the drawing is, which takes about half of
   * the time; output 0 has no cells, and what is counted of visible faces and areas stays 0. Default
   * on.
   */
  vtkSetMacro(ComputeRegions, bool);
  vtkGetMacro(ComputeRegions, bool);
  vtkBooleanMacro(ComputeRegions, bool);
  ///@}

  ///@{
  /**
   * What of the faces output 0 has. Default VISIBLE_REGION.
   */
  vtkSetClampMacro(Region, int, VISIBLE_REGION, HIDDEN_REGION);
  vtkGetMacro(Region, int);
  void SetRegionToVisible() { this->SetRegion(VISIBLE_REGION); }
  void SetRegionToHidden() { this->SetRegion(HIDDEN_REGION); }
  ///@}

  ///@{
  /**
   * Whether faces are visible from behind, too, as those of open shells must be to be seen from all
   * around. Off: a region that is seen from behind counts as hidden, and still hides what is behind
   * it. Default on.
   */
  vtkSetMacro(BothSides, bool);
  vtkGetMacro(BothSides, bool);
  vtkBooleanMacro(BothSides, bool);
  ///@}

  ///@{
  /**
   * Whether output 1 has the curves in which faces pierce each other. Default on.
   */
  vtkSetMacro(Intersections, bool);
  vtkGetMacro(Intersections, bool);
  vtkBooleanMacro(Intersections, bool);
  ///@}

  ///@{
  /**
   * Whether output 1 has the hidden parts of lines. Default on.
   */
  vtkSetMacro(HiddenLines, bool);
  vtkGetMacro(HiddenLines, bool);
  vtkBooleanMacro(HiddenLines, bool);
  ///@}

  ///@{
  /**
   * Whether the points of output 1 are projected to the image plane: x to the right, y upwards, z 0, in
   * the model's units; in parallel light true to size. Default off.
   */
  vtkSetMacro(ProjectLines, bool);
  vtkGetMacro(ProjectLines, bool);
  vtkBooleanMacro(ProjectLines, bool);
  ///@}

  ///@{
  /**
   * Whether faces that face the viewer and share edges are taken together where these do not fold over:
   * edges within such a cluster hide nothing, and a first map of the other lines tells what can be
   * left out of the one that regions are made of. That has up to 30 times fewer cells, but the first
   * map costs more than it saves (Documentation/Papers/ruan-2006.md). Default off.
   */
  vtkSetMacro(Clustering, bool);
  vtkGetMacro(Clustering, bool);
  vtkBooleanMacro(Clustering, bool);
  ///@}

  ///@{
  /**
   * Of the last Update: faces that are visible as a whole, in part, and not at all; those of whose
   * region a part of the border was not found, and is right about only; the visible area; visible
   * lines; cells of the planar map; pairs of faces that pierce each other. All are 0 before the first
   * Update and after an error; without ComputeRegions, all but the last three are.
   */
  vtkGetMacro(NumberOfVisibleFaces, vtkIdType);
  vtkGetMacro(NumberOfPartialFaces, vtkIdType);
  vtkGetMacro(NumberOfHiddenFaces, vtkIdType);
  vtkGetMacro(NumberOfInexactFaces, vtkIdType);
  vtkGetMacro(VisibleArea, double);
  vtkGetMacro(NumberOfVisibleLines, vtkIdType);
  vtkGetMacro(NumberOfCells, vtkIdType);
  vtkGetMacro(NumberOfPiercingPairs, vtkIdType);
  ///@}

  ///@{
  /**
   * The drawing: output 1 if the input is one model, else null.
   */
  vtkPolyData* GetLines();
  ///@}

protected:
  vtkNURBSVisibleRegions();
  ~vtkNURBSVisibleRegions() override;

  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkNURBSVisibleRegions(const vtkNURBSVisibleRegions&) = delete;
  void operator=(const vtkNURBSVisibleRegions&) = delete;

  struct Kept;
  struct Work;
  void Make(Work& work);
  bool MakeOutputs(vtkDataObject* input, vtkNURBSPieces& pieces, vtkInformationVector* outputs);
  void Summarize(const Work& work);
  void FillOutputs(const Work& work, vtkDataObject* input, vtkInformationVector* outputs);
  void ClearResults();

  std::unique_ptr<Kept> Before;

  double ViewUp[3] = { 0.0, 0.0, 1.0 };
  bool ComputeRegions = true;
  int Region = VISIBLE_REGION;
  bool BothSides = true;
  bool Intersections = true;
  bool HiddenLines = true;
  bool ProjectLines = false;
  bool Clustering = false;

  vtkIdType NumberOfVisibleFaces = 0;
  vtkIdType NumberOfPartialFaces = 0;
  vtkIdType NumberOfHiddenFaces = 0;
  vtkIdType NumberOfInexactFaces = 0;
  double VisibleArea = 0.0;
  vtkIdType NumberOfVisibleLines = 0;
  vtkIdType NumberOfCells = 0;
  vtkIdType NumberOfPiercingPairs = 0;
};

#endif
