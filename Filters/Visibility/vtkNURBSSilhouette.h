// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSSilhouette
 * @brief Silhouettes and edges of trimmed NURBS models, exact to any precision, without a mesh.
 *
 * A silhouette is where a surface turns away from the viewer: normal . view = 0. All components are
 * found, also closed ones, several in a patch, and those that run through corners, poles or along
 * seams, knot lines and edges; they are traced on the surfaces themselves, cut by the trimming loops
 * and chained across faces. Works without a window.
 *
 * The input is a model of vtkNURBSModel or a composite data set of models. The output is a
 * vtkPolyData of polylines, or a composite of the input's type and structure. A line belongs to one
 * face; lines that go on in each other share the point. A closed line ends with its first point.
 *
 * | where | array | meaning |
 * |---|---|---|
 * | points | (double) | on the surface (of the first line's face, where lines meet) |
 * | point data | UV (double, 2) | parameters in that face's domain |
 * | point data | NormalDotView (double) | of unit vectors; of silhouettes, else 0 |
 * | cell data | FaceId and all other attributes of the model's faces | of the line's face |
 * | cell data | EdgeId | the edge that the line runs along, as trim curves name it; -1: none |
 * | cell data | Kind (unsigned char) | 0 silhouette, 1 boundary, 2 sharp edge, 3 smooth edge |
 * | cell data | OnCrease (unsigned char) | 1: a silhouette along a crease or smooth edge, where the normal jumps |
 * | cell data | Chain | lines of one number are connected |
 * | field data | FaceIds (1 a face) | identity of the faces that the next arrays tell of |
 * | field data | FacePatches (4) | Bezier patches: visible, invisible, partial, edge-on |
 * | field data | FaceStatus (unsigned char) | 0 ok, 1 singular, 2 capped, 3 failed |
 * | field data | FaceStatusMessage (string) | why the status is not 0 |
 *
 * Lines are within Precision of the exact curves; |normal . view| at the points of silhouettes is 1e-9
 * at most, whatever the precision. Silhouettes are directed: the part that faces the viewer lies on the left, seen from outside.
 * A face that is edge-on as a whole has no silhouette; its neighbours have one along their common
 * edges, and its edges are lines of their own kind. Faces where contours cross or end (status 1) are
 * complete but for what happens within a millionth of the model's size there. Capped and failed faces
 * are named in one warning. A direction that is zero or not finite, or an input without NURBS arrays,
 * is an error. Work is spread by vtkSMPTools, the result does not depend on the number of threads.
 * Reports progress and obeys AbortExecute, which leaves the output empty.
 *
 * Source: X. Ruan, H. Zhang, J. Yong, "Visible region extraction from a sequence of rational Bezier
 * surfaces", Journal of Zhejiang University SCIENCE A 7 (2006), sections 2 and 3. What is done
 * differently and why is told in Documentation/Papers/ruan-2006.md.
 *
 * @sa vtkNURBSModel
 */
#ifndef vtkNURBSSilhouette_h
#define vtkNURBSSilhouette_h

#include "vtkNURBSViewAlgorithm.h"

class VTKNURBSFILTERSVISIBILITY_EXPORT vtkNURBSSilhouette : public vtkNURBSViewAlgorithm
{
public:
  static vtkNURBSSilhouette* New();
  vtkTypeMacro(vtkNURBSSilhouette, vtkNURBSViewAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The values of the cell data Kind.
  enum LineKinds
  {
    SILHOUETTE = 0,
    BOUNDARY = 1,
    SHARP = 2,
    SMOOTH = 3
  };

  /// What became of a face: the values of the field data FaceStatus.
  enum FaceStatusTypes
  {
    OK = 0, ///< All is found.
    SINGULAR =
      1,        ///< normal . view is singular somewhere: contours cross, end, or close in a point.
    CAPPED = 2, ///< A patch needed too many cells; its contour has gaps.
    FAILED = 3  ///< No lines.
  };

  ///@{
  /**
   * What the last Update made of all models together: Bezier patches by self-visible type; connected
   * silhouettes; points of all kinds; points of silhouettes with |normal . view| over 1e-9 (in singular
   * places only); faces by status (NumberOfFailedFaces: without lines). All are 0 before the first
   * Update and after an error.
   */
  vtkGetMacro(NumberOfVisiblePatches, vtkIdType);
  vtkGetMacro(NumberOfInvisiblePatches, vtkIdType);
  vtkGetMacro(NumberOfPartialPatches, vtkIdType);
  vtkGetMacro(NumberOfEdgeOnPatches, vtkIdType);
  vtkGetMacro(NumberOfComponents, vtkIdType);
  vtkGetMacro(NumberOfPoints, vtkIdType);
  vtkGetMacro(NumberOfInexactPoints, vtkIdType);
  vtkGetMacro(NumberOfSingularFaces, vtkIdType);
  vtkGetMacro(NumberOfCappedFaces, vtkIdType);
  ///@}

protected:
  vtkNURBSSilhouette();
  ~vtkNURBSSilhouette() override;

  int RequestDataObject(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkNURBSSilhouette(const vtkNURBSSilhouette&) = delete;
  void operator=(const vtkNURBSSilhouette&) = delete;

  struct Work;
  void Make(Work& work);
  void Summarize(const Work& work);
  void FillOutput(Work& work, vtkDataObject* whole, vtkDataObject* output);
  void ClearResults();

  vtkIdType NumberOfVisiblePatches = 0;
  vtkIdType NumberOfInvisiblePatches = 0;
  vtkIdType NumberOfPartialPatches = 0;
  vtkIdType NumberOfEdgeOnPatches = 0;
  vtkIdType NumberOfComponents = 0;
  vtkIdType NumberOfPoints = 0;
  vtkIdType NumberOfInexactPoints = 0;
  vtkIdType NumberOfSingularFaces = 0;
  vtkIdType NumberOfCappedFaces = 0;
};

#endif
