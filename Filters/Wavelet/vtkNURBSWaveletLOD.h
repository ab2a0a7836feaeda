// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSWaveletLOD
 * @brief Evaluates trimmed NURBS models once and meshes them at any level of detail, by wavelets.
 *
 * Every surface is evaluated on a dyadic grid over the box of its trimming loops, as fine as
 * FinestTolerance asks for, and analysed, rows first and then columns, into a pyramid of averages
 * and details; edges are analysed as curves of their own. From then on a change of Mode, Level,
 * MaximumError or TriangleBudget needs no evaluation of surfaces but at the vertices of edges: the
 * pyramids are kept until the input or the options of the analysis change.
 *
 * Faces that share an edge have its points bit for bit, at every level and where their levels
 * differ, so that closed models have no open edge. Faces without loops share those sides that
 * coincide. Trimmed faces keep the cells that their loops leave whole; what is between these and
 * the polylines of the loops is triangulated. Where coarse polylines of a face would cross each
 * other their edges become finer.
 *
 * | wavelet | coarse samples | modes |
 * |---|---|---|
 * | INTERPOLATING | fine samples, on the surface (5/3, predicted) | cells adapt within a face |
 * | LIFTED | keep the mean of the fine ones (5/3); corners and borders stay | one level a face |
 * | HAAR | means, as in the paper; corners stay, borders are curves | one level a face |
 *
 * The input is a model of vtkNURBSModel or a composite data set of models. The output is a
 * vtkPolyData of triangles, or a composite of the input's type and structure:
 *
 * | where | array | meaning |
 * |---|---|---|
 * | points | (double) | of the level |
 * | point data | Normals (float, 3) | unit normal of the surface, outwards |
 * | point data | UV (double, 2) | parameters in the face's own domain |
 * | cell data | FaceId and all other attributes of the model's faces | of the triangle's face |
 * | field data | FaceIds (1 a face) | identity of the faces that the next arrays tell of |
 * | field data | FaceErrorBound (double) | bound of the distance between triangles and face |
 * | field data | FaceLevel, FaceNumberOfLevels (int) | finest level in the mesh, number of levels |
 * | field data | FaceLevelErrorBounds (double, NumberOfLevels) | of the whole grid of each level |
 * | field data | FaceStatus (unsigned char) | 0 ok, 1 repaired, 2 capped, 3 failed |
 * | field data | FaceStatusMessage (string) | why the status is not 0 |
 * | field data | ErrorBound, Threshold (double), NumberOfTriangles, NumberOfLevels | of all |
 *
 * The bound compares mesh and surface at equal parameters, so it is larger than the distance where
 * a parametrisation is uneven. Of edges that have no 3D curve and do not run along a side of a
 * surface, the finest polyline's own distance is sampled, not bounded.
 *
 * Faces that failed or were capped are named in one warning. An input without NURBS arrays is an
 * error. Work is spread by vtkSMPTools, the result does not depend on the number of threads.
 * Reports progress and obeys AbortExecute, which leaves the output empty.
 *
 * Source: D. Tan, G. Zhao, H. Lu, "GPU based evaluation and LOD rendering of NURBS surfaces",
 * Computer-Aided Design & Applications 9 (2012), section 4.3. What is done differently and why is
 * told in Documentation/Papers/tan-2012-wavelets.md.
 *
 * @sa vtkNURBSModel, vtkNURBSTessellator
 */
#ifndef vtkNURBSWaveletLOD_h
#define vtkNURBSWaveletLOD_h

#include "vtkDataObjectAlgorithm.h"
#include "vtkNURBSFiltersWaveletModule.h" // For export macro

#include <memory> // For the pyramids

class VTKNURBSFILTERSWAVELET_EXPORT vtkNURBSWaveletLOD : public vtkDataObjectAlgorithm
{
public:
  static vtkNURBSWaveletLOD* New();
  vtkTypeMacro(vtkNURBSWaveletLOD, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// What Wavelet may be.
  enum Wavelets
  {
    INTERPOLATING = 0,
    LIFTED = 1,
    HAAR = 2
  };

  ///@{
  /**
   * The wavelet of the pyramids; see the table above. Default: INTERPOLATING.
   */
  vtkSetClampMacro(Wavelet, int, INTERPOLATING, HAAR);
  vtkGetMacro(Wavelet, int);
  void SetWaveletToInterpolating() { this->SetWavelet(INTERPOLATING); }
  void SetWaveletToLifted() { this->SetWavelet(LIFTED); }
  void SetWaveletToHaar() { this->SetWavelet(HAAR); }
  ///@}

  /// What Mode may be.
  enum Modes
  {
    LEVEL = 0,
    MAXIMUM_ERROR = 1,
    TRIANGLE_BUDGET = 2
  };

  ///@{
  /**
   * Which mesh is made: that of a Level (default), the coarsest within MaximumError, or the one
   * with the largest coefficients that keeps within TriangleBudget.
   */
  vtkSetClampMacro(Mode, int, LEVEL, TRIANGLE_BUDGET);
  vtkGetMacro(Mode, int);
  void SetModeToLevel() { this->SetMode(LEVEL); }
  void SetModeToMaximumError() { this->SetMode(MAXIMUM_ERROR); }
  void SetModeToTriangleBudget() { this->SetMode(TRIANGLE_BUDGET); }
  ///@}

  ///@{
  /**
   * In LEVEL mode: how many times the finest grids are halved. 0, the default, is the finest; faces
   * and directions that can't be halved so often stay on their coarsest grid. At least 0.
   */
  vtkSetClampMacro(Level, int, 0, 64);
  vtkGetMacro(Level, int);
  ///@}

  /// What ToleranceMode may be.
  enum ToleranceModes
  {
    RELATIVE = 0,
    ABSOLUTE = 1
  };

  ///@{
  /**
   * What MaximumError and FinestTolerance are measured in: the diagonal of the box around points of
   * all surfaces of the input (RELATIVE, default), or units of length (ABSOLUTE).
   */
  vtkSetClampMacro(ToleranceMode, int, RELATIVE, ABSOLUTE);
  vtkGetMacro(ToleranceMode, int);
  void SetToleranceModeToRelative() { this->SetToleranceMode(RELATIVE); }
  void SetToleranceModeToAbsolute() { this->SetToleranceMode(ABSOLUTE); }
  ///@}

  ///@{
  /**
   * In MAXIMUM_ERROR mode: the largest bound of the distance between triangles and surfaces.
   * Default 1e-3; must be positive.
   */
  vtkSetMacro(MaximumError, double);
  vtkGetMacro(MaximumError, double);
  ///@}

  ///@{
  /**
   * In TRIANGLE_BUDGET mode: how many triangles all models together may have. Default 100,000, at
   * least 1. If the coarsest meshes have more they are made, with a warning.
   */
  vtkSetClampMacro(TriangleBudget, vtkIdType, 1, VTK_ID_MAX);
  vtkGetMacro(TriangleBudget, vtkIdType);
  ///@}

  ///@{
  /**
   * The bound of the finest grids' distance from the surfaces. Default 1e-4; must be positive.
   */
  vtkSetMacro(FinestTolerance, double);
  vtkGetMacro(FinestTolerance, double);
  ///@}

  ///@{
  /**
   * The largest number of samples of one face; a face that needs more has a finest grid with a
   * larger error, which is told. Default 1,048,576, at least 16.
   */
  vtkSetClampMacro(MaximumSamples, vtkIdType, 16, VTK_INT_MAX);
  vtkGetMacro(MaximumSamples, vtkIdType);
  ///@}

  /// What became of a face: the values of the field data FaceStatus.
  enum FaceStatusTypes
  {
    OK = 0,       ///< As asked for.
    REPAIRED = 1, ///< Its trimming loops cross, even on their finest level.
    CAPPED = 2,   ///< MAXIMUM_ERROR: not within it; FaceErrorBound tells what was reached.
    FAILED = 3    ///< No triangles.
  };

  ///@{
  /**
   * What the last Update made of all models together: levels of the face that has most; triangles
   * and points; the largest bound of an error, in units of length; samples in the pyramids; faces
   * by status; seconds of evaluation and analysis (0 if the pyramids were still there), and of
   * meshing and filling the output. All are 0 before the first Update and after an error.
   */
  vtkGetMacro(NumberOfLevels, int);
  vtkGetMacro(NumberOfTriangles, vtkIdType);
  vtkGetMacro(NumberOfPoints, vtkIdType);
  vtkGetMacro(ErrorBound, double);
  vtkGetMacro(NumberOfSamples, vtkIdType);
  vtkGetMacro(NumberOfFaces, vtkIdType);
  vtkGetMacro(NumberOfRepairedFaces, vtkIdType);
  vtkGetMacro(NumberOfCappedFaces, vtkIdType);
  vtkGetMacro(NumberOfFailedFaces, vtkIdType);
  vtkGetMacro(AnalyseSeconds, double);
  vtkGetMacro(MeshSeconds, double);
  ///@}

protected:
  vtkNURBSWaveletLOD();
  ~vtkNURBSWaveletLOD() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkNURBSWaveletLOD(const vtkNURBSWaveletLOD&) = delete;
  void operator=(const vtkNURBSWaveletLOD&) = delete;

  struct Pyramids;
  struct Meshes;
  void CheckOptions() const;
  bool Make(vtkDataObject* input, std::unique_ptr<Pyramids> work, vtkDataObject* output);
  void Analyse(vtkDataObject* input, std::unique_ptr<Pyramids> work);
  void Mesh(Meshes& meshes);
  void FillOutputs(Meshes& meshes, vtkDataObject* output);
  void Summarize(const Meshes& meshes);
  void ClearResults();

  int Wavelet = INTERPOLATING;
  int Mode = LEVEL;
  int Level = 0;
  int ToleranceMode = RELATIVE;
  double MaximumError = 1e-3;
  vtkIdType TriangleBudget = 100000;
  double FinestTolerance = 1e-4;
  vtkIdType MaximumSamples = 1024 * 1024;

  std::unique_ptr<Pyramids> Kept;

  int NumberOfLevels = 0;
  vtkIdType NumberOfTriangles = 0;
  vtkIdType NumberOfPoints = 0;
  double ErrorBound = 0.0;
  vtkIdType NumberOfSamples = 0;
  vtkIdType NumberOfFaces = 0;
  vtkIdType NumberOfRepairedFaces = 0;
  vtkIdType NumberOfCappedFaces = 0;
  vtkIdType NumberOfFailedFaces = 0;
  double AnalyseSeconds = 0.0;
  double MeshSeconds = 0.0;
};

#endif
