// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSTessellator
 * @brief Turns trimmed NURBS models into triangles within a certified distance of the surfaces.
 *
 * The input is a model of vtkNURBSModel (a vtkUnstructuredGrid), or a composite data set of models
 * (vtkPartitionedDataSetCollection, vtkMultiBlockDataSet, ...). All faces of all models are one pool
 * of work, shared out to threads by vtkSMPTools; the result does not depend on their number. Where
 * vtkSMPTools would use one thread only for want of a choice of backend, as in Debian's ParaView,
 * "STDThread" is used during the execution (see vtkNURBSParallelScope).
 *
 * Output port 0 is a vtkPolyData of triangles, or a composite data set of the input's type and
 * structure with one vtkPolyData a model. Faces that share an edge share the coordinates of its
 * points bit for bit, so closed solids have no open edge.
 *
 * | where | array | meaning |
 * |---|---|---|
 * | points | (double) | on the surfaces and edges |
 * | point data | Normals (float, 3) | unit normal of the surface, outwards |
 * | point data | UV (double, 2) | parameters in the face's own domain |
 * | cell data | FaceId and all other attributes of the model's faces | of the triangle's face |
 * | field data | FaceIds (1 a face) | identity of the faces that the next three arrays tell of |
 * | field data | FaceCertifiedError (double, 1 a face) | bound of the distance of triangles and face |
 * | field data | FaceStatus (unsigned char, 1 a face) | 0 ok, 1 repaired, 2 capped, 3 failed |
 * | field data | FaceStatusMessage (string, 1 a face) | why the status is not 0 |
 * | field data | FaceTolerance (double, 1 a face) | in PIXELS mode: the face's own tolerance |
 * | field data | CertifiedError, Tolerance (double), NumberOfTriangles | of this model |
 *
 * Output port 1 has the trim curves as polylines, each with the cell data `EdgeId` (-1 if no other
 * curve shares it) and `FaceId`; the same structure as port 0.
 *
 * Faces that failed or were capped are named in one warning. An input without NURBS arrays is an
 * error. Reports progress and obeys AbortExecute, which leaves the outputs empty; observers are
 * called in the thread that called Update.
 *
 * Source: A. Balazs, M. Guthe, R. Klein, "Efficient trimmed NURBS tessellation", Journal of WSCG 12
 * (2004). What is done differently and why is told in Documentation/Papers/balazs-2004.md.
 *
 * @sa vtkNURBSModel, vtkNURBSCADReader, vtkNURBSShapeSource
 */
#ifndef vtkNURBSTessellator_h
#define vtkNURBSTessellator_h

#include "vtkDataObjectAlgorithm.h"
#include "vtkNURBSFiltersTessellationModule.h" // For export macro

#include <vector> // For the meshes

class vtkCamera;
class vtkPolyData;

class VTKNURBSFILTERSTESSELLATION_EXPORT vtkNURBSTessellator : public vtkDataObjectAlgorithm
{
public:
  static vtkNURBSTessellator* New();
  vtkTypeMacro(vtkNURBSTessellator, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// What ToleranceMode may be.
  enum ToleranceModes
  {
    RELATIVE = 0,
    ABSOLUTE = 1,
    PIXELS = 2
  };

  ///@{
  /**
   * What the tolerance is measured in: the diagonal of the whole input (RELATIVE, default), units
   * of length (ABSOLUTE), or pixels of a view (PIXELS).
   */
  vtkSetClampMacro(ToleranceMode, int, RELATIVE, PIXELS);
  vtkGetMacro(ToleranceMode, int);
  void SetToleranceModeToRelative() { this->SetToleranceMode(RELATIVE); }
  void SetToleranceModeToAbsolute() { this->SetToleranceMode(ABSOLUTE); }
  void SetToleranceModeToPixels() { this->SetToleranceMode(PIXELS); }
  ///@}

  ///@{
  /**
   * Largest distance of triangles and surfaces in RELATIVE mode, as a share of the diagonal of the
   * box around all surfaces of the input, sampled within the boxes of their trims. Default 1e-3,
   * 1e-9 to 1.
   */
  vtkSetClampMacro(Tolerance, double, 1e-9, 1.0);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /**
   * Largest distance in ABSOLUTE mode, in the unit of the points. Default 0.1; must be positive.
   */
  vtkSetMacro(AbsoluteTolerance, double);
  vtkGetMacro(AbsoluteTolerance, double);
  ///@}

  ///@{
  /**
   * Largest distance in PIXELS mode, as it appears in the view of Camera with ViewportSize. Each
   * face has a tolerance of its own, by the depth of the nearest corner of its box, at least that of
   * the near plane; a face behind that plane has the one of its distance from the eye. An edge has
   * the smallest of its faces'. Default 0.5; at least 1e-3.
   */
  vtkSetClampMacro(PixelTolerance, double, 1e-3, VTK_DOUBLE_MAX);
  vtkGetMacro(PixelTolerance, double);
  ///@}

  ///@{
  /**
   * The camera of PIXELS mode, perspective or parallel. Default: none, which is an error in that
   * mode.
   */
  void SetCamera(vtkCamera* camera);
  vtkGetObjectMacro(Camera, vtkCamera);
  ///@}

  ///@{
  /**
   * Width and height in pixels of the view of PIXELS mode. Default 1024 x 768.
   */
  vtkSetVector2Macro(ViewportSize, int);
  vtkGetVector2Macro(ViewportSize, int);
  ///@}

  /// What Method may be.
  enum Methods
  {
    KD_TREE = 0,
    QUAD_TREE = 1,
    BINARY = 2
  };

  ///@{
  /**
   * How parameter domains are subdivided (section 5.2): where and in the direction in which the
   * surface deviates most (KD_TREE, default), both directions in the middle (QUAD_TREE), or the
   * direction that deviates most in the middle (BINARY).
   */
  vtkSetClampMacro(Method, int, KD_TREE, BINARY);
  vtkGetMacro(Method, int);
  void SetMethodToKdTree() { this->SetMethod(KD_TREE); }
  void SetMethodToQuadTree() { this->SetMethod(QUAD_TREE); }
  void SetMethodToBinary() { this->SetMethod(BINARY); }
  ///@}

  /// What ErrorMode may be.
  enum ErrorModes
  {
    GUARANTEED = 0,
    ESTIMATED = 1
  };

  ///@{
  /**
   * Whether errors are bounded (GUARANTEED, default) or sampled (ESTIMATED): fewer triangles, and
   * no proof that none exceeds the tolerance.
   */
  vtkSetClampMacro(ErrorMode, int, GUARANTEED, ESTIMATED);
  vtkGetMacro(ErrorMode, int);
  void SetErrorModeToGuaranteed() { this->SetErrorMode(GUARANTEED); }
  void SetErrorModeToEstimated() { this->SetErrorMode(ESTIMATED); }
  ///@}

  /// What CurveSubdivision may be.
  enum CurveSubdivisions
  {
    MIDPOINT = 0,
    ARBITRARY = 1
  };

  ///@{
  /**
   * Where a trim curve is split (section 5.1): in the middle (MIDPOINT, default) or beneath the
   * control point that deviates most (ARBITRARY).
   */
  vtkSetClampMacro(CurveSubdivision, int, MIDPOINT, ARBITRARY);
  vtkGetMacro(CurveSubdivision, int);
  void SetCurveSubdivisionToMidpoint() { this->SetCurveSubdivision(MIDPOINT); }
  void SetCurveSubdivisionToArbitrary() { this->SetCurveSubdivision(ARBITRARY); }
  ///@}

  /// What CurveMeasure may be.
  enum CurveMeasures
  {
    LINE = 0,
    POINT = 1
  };

  ///@{
  /**
   * What a trim curve's control points are measured against (section 5.1): the chord (LINE,
   * default), or the points of the chord at the same parameter (POINT).
   */
  vtkSetClampMacro(CurveMeasure, int, LINE, POINT);
  vtkGetMacro(CurveMeasure, int);
  void SetCurveMeasureToLine() { this->SetCurveMeasure(LINE); }
  void SetCurveMeasureToPoint() { this->SetCurveMeasure(POINT); }
  ///@}

  ///@{
  /**
   * Spread the vertices of trim curves so that there are as few as will do and all chords err
   * alike. Default: on. Off: subdivision alone, as in the paper.
   */
  vtkSetMacro(CurveBalancing, bool);
  vtkGetMacro(CurveBalancing, bool);
  vtkBooleanMacro(CurveBalancing, bool);
  ///@}

  ///@{
  /**
   * Without CurveBalancing: simplify the polylines of trim curves, which are then subdivided to 3/4
   * of the tolerance (section 5.1). Default: on.
   */
  vtkSetMacro(CurveSimplification, bool);
  vtkGetMacro(CurveSimplification, bool);
  vtkBooleanMacro(CurveSimplification, bool);
  ///@}

  ///@{
  /**
   * Longest edge of a triangle, in the unit of the points. Default 0: no limit. Holds for every
   * triangle; what remains: sides along a boundary that had to be repaired (status REPAIRED), and faces
   * that reach MaximumFaceTriangles.
   */
  vtkSetClampMacro(MaximumEdgeLength, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(MaximumEdgeLength, double);
  ///@}

  ///@{
  /**
   * Largest angle in degrees between the surface's normals at the corners of a triangle. Default 0:
   * no limit; up to 180. Trimming edges are divided by it, too. Holds for every triangle, where a
   * surface has a crease with the normals of the triangle's side (the array has one a point). What
   * remains: triangles smaller than a hundredth of the tolerance (at poles and other places where the
   * normal turns at once there would be no end), boundaries that had to be repaired (status REPAIRED),
   * and faces that reach MaximumFaceTriangles.
   */
  vtkSetClampMacro(MaximumAngle, double, 0.0, 180.0);
  vtkGetMacro(MaximumAngle, double);
  ///@}

  ///@{
  /**
   * A face that would need more triangles is capped: it keeps a larger error, which is told.
   * Default 4,000,000, at least 2.
   */
  vtkSetClampMacro(MaximumFaceTriangles, vtkIdType, 2, VTK_ID_MAX);
  vtkGetMacro(MaximumFaceTriangles, vtkIdType);
  ///@}

  ///@{
  /**
   * Make one point of all points of a model with the same coordinates, which joins its faces along
   * their edges. Normals and UV differ from face to face there and are left out; triangles that
   * lose a corner (at poles) are, too. Default: off.
   */
  vtkSetMacro(MergePoints, bool);
  vtkGetMacro(MergePoints, bool);
  vtkBooleanMacro(MergePoints, bool);
  ///@}

  /// What became of a face: the values of the field data FaceStatus.
  enum FaceStatusTypes
  {
    OK = 0,       ///< Within the tolerance.
    REPAIRED = 1, ///< Likewise; its trimming loops had to be repaired.
    CAPPED = 2,   ///< Not within the tolerance; FaceCertifiedError tells what was reached.
    FAILED = 3    ///< No triangles.
  };

  ///@{
  /**
   * What the last Update made of all models together: triangles and their points; the largest
   * certified error and the tolerance (the largest of the faces' in PIXELS mode) in the unit of the
   * points; faces by status; seconds of the tessellation and of filling the outputs. Under MPI they
   * are those of all processes but for the seconds, and NumberOfGhostFaces is how many faces processes
   * had to know of each other. All are 0
   * before the first Update and after an error.
   */
  vtkGetMacro(NumberOfTriangles, vtkIdType);
  vtkGetMacro(NumberOfPoints, vtkIdType);
  vtkGetMacro(CertifiedError, double);
  vtkGetMacro(ToleranceUsed, double);
  vtkGetMacro(NumberOfFaces, vtkIdType);
  vtkGetMacro(NumberOfRepairedFaces, vtkIdType);
  vtkGetMacro(NumberOfCappedFaces, vtkIdType);
  vtkGetMacro(NumberOfFailedFaces, vtkIdType);
  vtkGetMacro(NumberOfGhostFaces, vtkIdType);
  vtkGetMacro(TessellateSeconds, double);
  vtkGetMacro(OutputSeconds, double);
  double GetSeconds() { return this->TessellateSeconds + this->OutputSeconds; }
  ///@}

  /**
   * Includes the camera's in PIXELS mode.
   */
  vtkMTimeType GetMTime() override;

protected:
  vtkNURBSTessellator();
  ~vtkNURBSTessellator() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkNURBSTessellator(const vtkNURBSTessellator&) = delete;
  void operator=(const vtkNURBSTessellator&) = delete;

  struct Work;
  bool Make(vtkDataObject* input, Work& work, vtkInformationVector* outputs);
  void CollectModels(vtkDataObject* input, Work& work);
  void FillOptions(Work& work);
  bool Tessellate(Work& work);
  void FillOutputs(Work& work, vtkInformationVector* outputs);
  void TellWhole(Work& work, const std::vector<vtkPolyData*>& meshes) const;
  void Summarize(const Work& work);
  void ClearResults();

  int ToleranceMode = RELATIVE;
  double Tolerance = 1e-3;
  double AbsoluteTolerance = 0.1;
  double PixelTolerance = 0.5;
  vtkCamera* Camera = nullptr;
  int ViewportSize[2] = { 1024, 768 };
  int Method = KD_TREE;
  int ErrorMode = GUARANTEED;
  int CurveSubdivision = MIDPOINT;
  int CurveMeasure = LINE;
  bool CurveBalancing = true;
  bool CurveSimplification = true;
  double MaximumEdgeLength = 0.0;
  double MaximumAngle = 0.0;
  vtkIdType MaximumFaceTriangles = 4000000;
  bool MergePoints = false;

  vtkIdType NumberOfTriangles = 0;
  vtkIdType NumberOfPoints = 0;
  double CertifiedError = 0.0;
  double ToleranceUsed = 0.0;
  vtkIdType NumberOfFaces = 0;
  vtkIdType NumberOfRepairedFaces = 0;
  vtkIdType NumberOfCappedFaces = 0;
  vtkIdType NumberOfFailedFaces = 0;
  vtkIdType NumberOfGhostFaces = 0;
  double TessellateSeconds = 0.0;
  double OutputSeconds = 0.0;
};

#endif
