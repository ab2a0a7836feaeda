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
 * Silhouettes are directed: the part that faces the viewer lies on the left, seen from outside.
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

#include "vtkDataObjectAlgorithm.h"
#include "vtkNURBSFiltersVisibilityModule.h" // For export macro

#include <memory> // For what one update makes

class vtkCamera;

class VTKNURBSFILTERSVISIBILITY_EXPORT vtkNURBSSilhouette : public vtkDataObjectAlgorithm
{
public:
  static vtkNURBSSilhouette* New();
  vtkTypeMacro(vtkNURBSSilhouette, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum Projections
  {
    PARALLEL = 0,
    PERSPECTIVE = 1
  };

  ///@{
  /**
   * Where the model is seen from: along Direction (PARALLEL, default), or from EyePoint. A Camera
   * goes before all three.
   */
  vtkSetClampMacro(Projection, int, PARALLEL, PERSPECTIVE);
  vtkGetMacro(Projection, int);
  void SetProjectionToParallel() { this->SetProjection(PARALLEL); }
  void SetProjectionToPerspective() { this->SetProjection(PERSPECTIVE); }
  ///@}

  ///@{
  /**
   * The direction from the model to the viewer; of any length but 0. Default (0, 0, 1).
   */
  vtkSetVector3Macro(Direction, double);
  vtkGetVector3Macro(Direction, double);
  ///@}

  ///@{
  /**
   * The viewer's eye, in the model's coordinates. Default (0, 0, 1).
   */
  vtkSetVector3Macro(EyePoint, double);
  vtkGetVector3Macro(EyePoint, double);
  ///@}

  ///@{
  /**
   * A camera whose position (perspective) or direction (parallel projection) is taken. Default: none.
   */
  void SetCamera(vtkCamera* camera);
  vtkGetObjectMacro(Camera, vtkCamera);
  ///@}

  enum PrecisionModes
  {
    RELATIVE = 0,
    ABSOLUTE = 1
  };

  ///@{
  /**
   * What Precision is measured in: the diagonal of the box around points of all surfaces of the input
   * (RELATIVE, default), or units of length (ABSOLUTE).
   */
  vtkSetClampMacro(PrecisionMode, int, RELATIVE, ABSOLUTE);
  vtkGetMacro(PrecisionMode, int);
  void SetPrecisionModeToRelative() { this->SetPrecisionMode(RELATIVE); }
  void SetPrecisionModeToAbsolute() { this->SetPrecisionMode(ABSOLUTE); }
  ///@}

  ///@{
  /**
   * The largest distance between the lines and the exact curves; |normal . view| at the points of
   * silhouettes is 1e-9 at most, whatever the precision. Default 1e-4; must be positive. Useful down
   * to 1e-8 (relative).
   */
  vtkSetMacro(Precision, double);
  vtkGetMacro(Precision, double);
  ///@}

  ///@{
  /**
   * The angle between the normals of two faces above which their edge is sharp, in degrees. Default
   * 30, in (0, 180].
   */
  vtkSetMacro(FeatureAngle, double);
  vtkGetMacro(FeatureAngle, double);
  ///@}

  ///@{
  /**
   * Which lines are made: silhouettes, edges that one face uses (default on), edges sharper than
   * FeatureAngle (default on), other edges and seams (default off).
   */
  vtkSetMacro(Silhouettes, bool);
  vtkGetMacro(Silhouettes, bool);
  vtkBooleanMacro(Silhouettes, bool);
  vtkSetMacro(BoundaryEdges, bool);
  vtkGetMacro(BoundaryEdges, bool);
  vtkBooleanMacro(BoundaryEdges, bool);
  vtkSetMacro(SharpEdges, bool);
  vtkGetMacro(SharpEdges, bool);
  vtkBooleanMacro(SharpEdges, bool);
  vtkSetMacro(SmoothEdges, bool);
  vtkGetMacro(SmoothEdges, bool);
  vtkBooleanMacro(SmoothEdges, bool);
  ///@}

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
   * silhouettes; lines and points of all kinds; points of silhouettes with |normal . view| over 1e-9
   * (in singular places only); faces by status; seconds. All are 0 before the first Update and after
   * an error.
   */
  vtkGetMacro(NumberOfVisiblePatches, vtkIdType);
  vtkGetMacro(NumberOfInvisiblePatches, vtkIdType);
  vtkGetMacro(NumberOfPartialPatches, vtkIdType);
  vtkGetMacro(NumberOfEdgeOnPatches, vtkIdType);
  vtkGetMacro(NumberOfComponents, vtkIdType);
  vtkGetMacro(NumberOfLines, vtkIdType);
  vtkGetMacro(NumberOfPoints, vtkIdType);
  vtkGetMacro(NumberOfInexactPoints, vtkIdType);
  vtkGetMacro(NumberOfFaces, vtkIdType);
  vtkGetMacro(NumberOfSingularFaces, vtkIdType);
  vtkGetMacro(NumberOfCappedFaces, vtkIdType);
  vtkGetMacro(NumberOfFailedFaces, vtkIdType);
  vtkGetMacro(Seconds, double);
  ///@}

  /**
   * Includes the camera's.
   */
  vtkMTimeType GetMTime() override;

protected:
  vtkNURBSSilhouette();
  ~vtkNURBSSilhouette() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkNURBSSilhouette(const vtkNURBSSilhouette&) = delete;
  void operator=(const vtkNURBSSilhouette&) = delete;

  struct Work;
  std::string CheckOptions() const;
  void Make(Work& work);
  void Summarize(const Work& work);
  void ClearResults();

  int Projection = PARALLEL;
  double Direction[3] = { 0.0, 0.0, 1.0 };
  double EyePoint[3] = { 0.0, 0.0, 1.0 };
  vtkCamera* Camera = nullptr;
  int PrecisionMode = RELATIVE;
  double Precision = 1e-4;
  double FeatureAngle = 30.0;
  bool Silhouettes = true;
  bool BoundaryEdges = true;
  bool SharpEdges = true;
  bool SmoothEdges = false;

  vtkIdType NumberOfVisiblePatches = 0;
  vtkIdType NumberOfInvisiblePatches = 0;
  vtkIdType NumberOfPartialPatches = 0;
  vtkIdType NumberOfEdgeOnPatches = 0;
  vtkIdType NumberOfComponents = 0;
  vtkIdType NumberOfLines = 0;
  vtkIdType NumberOfPoints = 0;
  vtkIdType NumberOfInexactPoints = 0;
  vtkIdType NumberOfFaces = 0;
  vtkIdType NumberOfSingularFaces = 0;
  vtkIdType NumberOfCappedFaces = 0;
  vtkIdType NumberOfFailedFaces = 0;
  double Seconds = 0.0;
};

#endif
