// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSShapeSource
 * @brief Makes exact analytic shapes, models of papers and loads for scale tests as NURBS models.
 *
 * The output is a model of vtkNURBSModel: a vtkUnstructuredGrid whose cells are exact trimmed
 * surfaces, with true topology. Faces that touch name the same edge, a seam is one edge used twice,
 * a pole (sphere, cone, lid of the teapot) is a degenerate edge; so closed shapes stay closed when
 * they are tessellated. Outsides of closed shapes point outwards. The length unit is "mm".
 *
 * | shape | faces | parameters |
 * |---|---|---|
 * | SPHERE | 1 | Radius |
 * | TORUS | 1 | Radius (of the ring), TubeRadius |
 * | CYLINDER | 3, or 1 without Capping | Radius, Height, Capping |
 * | CONE | 2, or 1 without Capping | Radius (of the base), Height, Capping |
 * | DISC | 1 | Radius |
 * | PLATE | 1, trimmed by holes and islands | PlateSize, PlateHoles |
 * | TEAPOT | 32 | |
 * | SHEET | 1 | SheetPoints, SheetDegree, SheetSize, SheetAmplitude, SheetWaves, SheetRational |
 * | CAR_BODY | NumberOfPatches | NumberOfPatches |
 * | VASE | 76 | |
 * | MISSILE | 88 | |
 * | SPRING | 96 | |
 *
 * The teapot is Martin Newell's data set of 1975, which is in the public domain. The car body
 * stands in for the models of 8,036 and 31,040 trimmed patches of Balazs, Guthe and Klein (2004). Vase,
 * missile and spring are closed solids of rational Bezier patches after figures 7 to 9 of Ruan, Zhang
 * and Yong (2006).
 *
 * Asked for a piece, it deals the faces in order by their estimated cost (nurbs::DealFaces); a piece
 * has EdgeGlobalId and VertexGlobalId (see vtkNURBSModel).
 *
 * A parameter out of its range is clamped; a tube radius that is not smaller than the ring's is an
 * error.
 */
#ifndef vtkNURBSShapeSource_h
#define vtkNURBSShapeSource_h

#include "vtkNURBSFiltersSourcesModule.h" // For export macro
#include "vtkUnstructuredGridAlgorithm.h"

class VTKNURBSFILTERSSOURCES_EXPORT vtkNURBSShapeSource : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkNURBSShapeSource* New();
  vtkTypeMacro(vtkNURBSShapeSource, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// The shapes; see the table above.
  enum ShapeType
  {
    SPHERE = 0,
    TORUS,
    CYLINDER,
    CONE,
    DISC,
    PLATE,
    TEAPOT,
    SHEET,
    CAR_BODY,
    VASE,
    MISSILE,
    SPRING
  };

  ///@{
  /**
   * Which shape is made. Default: SPHERE.
   */
  vtkSetClampMacro(Shape, int, SPHERE, SPRING);
  vtkGetMacro(Shape, int);
  void SetShapeToSphere() { this->SetShape(SPHERE); }
  void SetShapeToTorus() { this->SetShape(TORUS); }
  void SetShapeToCylinder() { this->SetShape(CYLINDER); }
  void SetShapeToCone() { this->SetShape(CONE); }
  void SetShapeToDisc() { this->SetShape(DISC); }
  void SetShapeToPlate() { this->SetShape(PLATE); }
  void SetShapeToTeapot() { this->SetShape(TEAPOT); }
  void SetShapeToSheet() { this->SetShape(SHEET); }
  void SetShapeToCarBody() { this->SetShape(CAR_BODY); }
  void SetShapeToVase() { this->SetShape(VASE); }
  void SetShapeToMissile() { this->SetShape(MISSILE); }
  void SetShapeToSpring() { this->SetShape(SPRING); }
  ///@}

  ///@{
  /**
   * Radius of sphere, torus (from its centre to the middle of the tube), cylinder, cone and disc.
   * Default 1, at least 1e-6.
   */
  vtkSetClampMacro(Radius, double, 1e-6, VTK_FLOAT_MAX);
  vtkGetMacro(Radius, double);
  ///@}

  ///@{
  /**
   * Radius of the torus's tube, smaller than Radius. Default 0.3, at least 1e-6.
   */
  vtkSetClampMacro(TubeRadius, double, 1e-6, VTK_FLOAT_MAX);
  vtkGetMacro(TubeRadius, double);
  ///@}

  ///@{
  /**
   * Height of cylinder and cone, which stand on z = 0. Default 2, at least 1e-6.
   */
  vtkSetClampMacro(Height, double, 1e-6, VTK_FLOAT_MAX);
  vtkGetMacro(Height, double);
  ///@}

  ///@{
  /**
   * Whether cylinder and cone are closed solids or side faces only. Default on.
   */
  vtkSetMacro(Capping, bool);
  vtkGetMacro(Capping, bool);
  vtkBooleanMacro(Capping, bool);
  ///@}

  ///@{
  /**
   * Width (x) and depth (y) of the plate. Default 4, 3; positive.
   */
  vtkSetVector2Macro(PlateSize, double);
  vtkGetVector2Macro(PlateSize, double);
  ///@}

  ///@{
  /**
   * Holes of the plate in x and y, 0 to 10,000 each. Every third hole has an island in it, every
   * sixth a hole in its island. Default 4, 3.
   */
  vtkSetVector2Macro(PlateHoles, int);
  vtkGetVector2Macro(PlateHoles, int);
  ///@}

  ///@{
  /**
   * Control points of the sheet in u and v, more than its degree. Default 40, 40.
   */
  vtkSetVector2Macro(SheetPoints, int);
  vtkGetVector2Macro(SheetPoints, int);
  ///@}

  ///@{
  /**
   * Degree of the sheet in u and v, 1 to 25. Default 3, 3.
   */
  vtkSetVector2Macro(SheetDegree, int);
  vtkGetVector2Macro(SheetDegree, int);
  ///@}

  ///@{
  /**
   * Edge length of the sheet. Default 100, at least 1e-6.
   */
  vtkSetClampMacro(SheetSize, double, 1e-6, VTK_FLOAT_MAX);
  vtkGetMacro(SheetSize, double);
  ///@}

  ///@{
  /**
   * Height of the sheet's waves (of its control points). Default 5.
   */
  vtkSetMacro(SheetAmplitude, double);
  vtkGetMacro(SheetAmplitude, double);
  ///@}

  ///@{
  /**
   * Number of the sheet's waves in each direction, 0 or more. Default 3.
   */
  vtkSetClampMacro(SheetWaves, int, 0, VTK_INT_MAX);
  vtkGetMacro(SheetWaves, int);
  ///@}

  ///@{
  /**
   * Whether the sheet has weights that differ (0.5 to 1.5). Default off.
   */
  vtkSetMacro(SheetRational, bool);
  vtkGetMacro(SheetRational, bool);
  vtkBooleanMacro(SheetRational, bool);
  ///@}

  ///@{
  /**
   * Number of faces of the car body, 1 to 10,000,000. Default 1000.
   */
  vtkSetClampMacro(NumberOfPatches, int, 1, 10000000);
  vtkGetMacro(NumberOfPatches, int);
  ///@}

  /**
   * The exact area of the plate's material, for the current PlateSize and PlateHoles.
   */
  double GetPlateArea();

protected:
  vtkNURBSShapeSource();
  ~vtkNURBSShapeSource() override;

  int RequestInformation(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputVector,
    vtkInformationVector* outputVector) override;

  int Shape = SPHERE;
  double Radius = 1.0;
  double TubeRadius = 0.3;
  double Height = 2.0;
  bool Capping = true;
  double PlateSize[2] = { 4.0, 3.0 };
  int PlateHoles[2] = { 4, 3 };
  int SheetPoints[2] = { 40, 40 };
  int SheetDegree[2] = { 3, 3 };
  double SheetSize = 100.0;
  double SheetAmplitude = 5.0;
  int SheetWaves = 3;
  bool SheetRational = false;
  int NumberOfPatches = 1000;

private:
  vtkNURBSShapeSource(const vtkNURBSShapeSource&) = delete;
  void operator=(const vtkNURBSShapeSource&) = delete;
};

#endif
