// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSViewAlgorithm
 * @brief What filters have in common that make lines of a model seen from somewhere.
 *
 * Input: a model of vtkNURBSModel, or a composite data set of models.
 *
 * @sa vtkNURBSSilhouette vtkNURBSVisibleRegions
 */
#ifndef vtkNURBSViewAlgorithm_h
#define vtkNURBSViewAlgorithm_h

#include "vtkDataObjectAlgorithm.h"
#include "vtkNURBSFiltersVisibilityModule.h" // For export macro

#include <string> // For what is wrong with the options
#include <vector> // For the parts of a pool

class vtkCamera;
class vtkNURBSModelPool;

namespace nurbs
{
struct Viewer;
}

class VTKNURBSFILTERSVISIBILITY_EXPORT vtkNURBSViewAlgorithm : public vtkDataObjectAlgorithm
{
public:
  vtkTypeMacro(vtkNURBSViewAlgorithm, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// What Projection may be.
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

  /// What PrecisionMode may be.
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
   * The largest distance between the lines and the exact curves. Default 1e-4; must be positive. Useful
   * down to 1e-8 (relative).
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
   * Which lines the output has: silhouettes, edges that one face uses (default on), edges sharper than
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

  ///@{
  /**
   * Of the last Update: faces; those that have no lines, or lines with gaps; lines of all outputs;
   * seconds. All are 0 before the first Update and after an error.
   */
  vtkGetMacro(NumberOfFaces, vtkIdType);
  vtkGetMacro(NumberOfFailedFaces, vtkIdType);
  vtkGetMacro(NumberOfLines, vtkIdType);
  vtkGetMacro(Seconds, double);
  ///@}

  /**
   * Includes the camera's.
   */
  vtkMTimeType GetMTime() override;

protected:
  vtkNURBSViewAlgorithm();
  ~vtkNURBSViewAlgorithm() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;

  /// What is wrong with the options, "" if nothing is.
  std::string CheckOptions() const;
  /// Where the model is seen from.
  nurbs::Viewer MakeViewer() const;
  /// Precision as a length.
  double AbsolutePrecision(const vtkNURBSModelPool& pool) const;
  /// The number of the leaf of every face.
  static std::vector<int> PartsOf(const vtkNURBSModelPool& pool);
  /// True for models that take no time worth a report of progress.
  static bool IsQuick(const vtkNURBSModelPool& pool);
  /// A clock, in seconds.
  static double Now();
  void ClearCounts();

  static constexpr int MaxNamed = 8; ///< Faces and pairs in a warning.

  vtkIdType NumberOfFaces = 0;
  vtkIdType NumberOfFailedFaces = 0;
  vtkIdType NumberOfLines = 0;
  double Seconds = 0.0;

private:
  vtkNURBSViewAlgorithm(const vtkNURBSViewAlgorithm&) = delete;
  void operator=(const vtkNURBSViewAlgorithm&) = delete;

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
};

#endif
