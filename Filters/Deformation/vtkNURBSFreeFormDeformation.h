// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSFreeFormDeformation
 * @brief Bends models by a lattice of control points around them.
 *
 * The lattice fills a box along x, y and z. Moving its points bends the space in the box, and the
 * models' control points with it; see FreeFormLattice.h for the mathematics. Surfaces stay NURBS
 * surfaces of the same degrees, knots, weights and trims. Their control points are where the
 * deformation puts them; the surface between them follows as closely as its control net is dense,
 * and exactly where the lattice is moved by an affine map. A plane of 2 x 2 control points does not
 * bend at all. Hence faces stay together exactly where their coinciding sides have the same control
 * points (the teapot); others of a bent solid part at their common edge by as much as their nets
 * are too coarse, which a tessellator closes and tells of (capped faces). vtkNURBSRefinement before
 * this filter makes nets denser: the gap falls with the square of their spacing.
 *
 * Input 0: a model of vtkNURBSModel (any vtkUnstructuredGrid is deformed the same way), or a
 * composite data set of models: one lattice is around all of them; other blocks are passed on as
 * they are. Input 1, optional: a vtkPointSet with the points of the lattice in their places, such
 * as output 1 of another vtkNURBSFreeFormDeformation after Warp By Vector.
 *
 * Output 0: the same type and structure as the input. Only the points are new (in double
 * precision); cells and all other arrays are the input's own objects. The array of points is kept
 * from update to update as long as the number of points is the same, written in place, and marked
 * as modified only if a value changed, so that a mapper or tessellator downstream updates no more
 * than that. Copy it (vtkPoints::DeepCopy) to keep a frame. The input is never written to.
 *
 * Output 1 (of the first process, where several share the model): the lattice as a vtkStructuredGrid in
 * its present places, with the point data
 * "Displacement" (3 doubles, the vectors) from the places at rest.
 *
 * The field data passes through, the 3D curves of edges in it too. Moved by the lattice, an edge's
 * curve would fit neither face exactly; vtkNURBSModel finds that it does not fit and takes the
 * faces' own geometry, as after any filter that moves points
 * (Documentation/decisions/moved-edges.md).
 *
 * A lattice point lies at
 *
 *     base + displacement
 *
 * where base is its place in input 1 if that is connected, else in SetLattice's points if they are
 * set, else its place at rest: the Greville abscissae of the box. A place or displacement that is
 * not finite, or a number of places that is not that of the lattice's points, is an error that
 * names the lattice point; the outputs are empty then, and filters downstream are not executed. The
 * next good update recovers.
 *
 * Points outside the box stay, as do those that are not finite. How smoothly the deformation ends
 * at the box's border is told by SetFrozenLayers.
 *
 * Work is spread by vtkSMPTools, the result does not depend on the number of threads. AbortExecute
 * is obeyed between models and leaves the outputs empty.
 *
 * Source: T. W. Sederberg, S. R. Parry, "Free-form deformation of solid geometric models", SIGGRAPH
 * 1986.
 */
#ifndef vtkNURBSFreeFormDeformation_h
#define vtkNURBSFreeFormDeformation_h

#include "vtkDataObjectAlgorithm.h"
#include "vtkNURBSFiltersDeformationModule.h" // For export macro
#include "vtkSmartPointer.h"                  // For the lattice's points

#include <memory> // For std::unique_ptr
#include <vector> // For the displacements

class vtkNURBSPieces;
class vtkPointSet;
class vtkPoints;
class vtkStructuredGrid;
class vtkUnstructuredGrid;

namespace nurbs
{
class FreeFormLattice;
} // namespace nurbs

class VTKNURBSFILTERSDEFORMATION_EXPORT vtkNURBSFreeFormDeformation : public vtkDataObjectAlgorithm
{
public:
  static vtkNURBSFreeFormDeformation* New();
  vtkTypeMacro(vtkNURBSFreeFormDeformation, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Number of lattice points along x, y and z, 2 to 32 each (clamped). Default 4, 4, 4. A change
   * puts all displacements back to zero.
   */
  void SetDimensions(int l, int m, int n);
  void SetDimensions(const int dimensions[3])
  {
    this->SetDimensions(dimensions[0], dimensions[1], dimensions[2]);
  }
  vtkGetVector3Macro(Dimensions, int);
  ///@}

  ///@{
  /**
   * Degree of the lattice's B-splines along x, y and z. 0, the default, is 3 or what the number of
   * points allows. The number of points less one, the largest up to 25, makes Bernstein polynomials
   * of them, with which every point moves the whole inside of the box; what is larger is lowered to
   * that.
   */
  vtkSetVector3Macro(Degree, int);
  vtkGetVector3Macro(Degree, int);
  ///@}

  ///@{
  /**
   * Whether the box is that of the input's control points (default), or Bounds. Where the input
   * itself moves, fixed Bounds keep the lattice in its place.
   */
  vtkSetMacro(UseInputBounds, bool);
  vtkGetMacro(UseInputBounds, bool);
  vtkBooleanMacro(UseInputBounds, bool);
  ///@}

  ///@{
  /**
   * With UseInputBounds: how far the box goes beyond the control points on every side, as a part of
   * their box's diagonal. Default 0, at least 0. Where the models are flat (under 1e-9 of the
   * diagonal) the box goes a tenth of the diagonal further. If there are no finite points Bounds
   * are used. Mind that control points on a side of the box follow only the outermost layer of
   * lattice points there: with no margin, those of a sphere, which all lie on sides, do not feel
   * the inner ones.
   */
  vtkSetClampMacro(Margin, double, 0.0, VTK_FLOAT_MAX);
  vtkGetMacro(Margin, double);
  ///@}

  ///@{
  /**
   * Without UseInputBounds: the box, xmin, xmax, ymin, ymax, zmin, zmax. Default -1 to 1. A box
   * that is flat, turned over or not finite is an error.
   */
  vtkSetVector6Macro(Bounds, double);
  vtkGetVector6Macro(Bounds, double);
  ///@}

  ///@{
  /**
   * Layers of lattice points at every side of the box that stay at rest whatever is set for them.
   * Default 0, at least 0. Only points outside the box make a difference: with 0, those in the box
   * part from them where the outermost layer is moved. With n layers the deformation is C^(n-1)
   * across the border, for n up to the degree p, and C^(p-1) for more.
   */
  vtkSetClampMacro(FrozenLayers, int, 0, VTK_INT_MAX);
  vtkGetMacro(FrozenLayers, int);
  ///@}

  /**
   * The product of the dimensions. Lattice point (i, j, k) has the index i + l (j + m k).
   */
  vtkIdType GetNumberOfLatticePoints() const;

  ///@{
  /**
   * Displacement of a lattice point, in units of length. All are 0 at first. An index out of range
   * is an error and changes nothing (as a result: 0, 0, 0).
   */
  void SetLatticeDisplacement(vtkIdType index, double x, double y, double z);
  void SetLatticeDisplacement(int i, int j, int k, double x, double y, double z);
  void GetLatticeDisplacement(vtkIdType index, double displacement[3]);
  void GetLatticeDisplacement(int i, int j, int k, double displacement[3]);
  ///@}

  /**
   * All displacements to zero, and no points of SetLattice: the lattice at rest.
   */
  void ResetLattice();

  ///@{
  /**
   * The places of all lattice points, to which displacements are added; null (default): at rest.
   * The points are referenced, so that changing them and calling their Modified moves the lattice.
   */
  void SetLattice(vtkPoints* points);
  vtkPoints* GetLattice();
  ///@}

  /**
   * Control points that the last update put elsewhere than they are in the input.
   */
  vtkGetMacro(NumberOfMovedPoints, vtkIdType);

  /// The lattice's included.
  vtkMTimeType GetMTime() override;

protected:
  vtkNURBSFreeFormDeformation();
  ~vtkNURBSFreeFormDeformation() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestInformation(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestUpdateExtent(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkNURBSFreeFormDeformation(const vtkNURBSFreeFormDeformation&) = delete;
  void operator=(const vtkNURBSFreeFormDeformation&) = delete;

  using Grids = std::vector<vtkUnstructuredGrid*>;
  vtkIdType IndexOf(int i, int j, int k) const;
  bool HasLatticePoint(vtkIdType index);
  nurbs::FreeFormLattice MakeLattice(
    const Grids& models, vtkPointSet* places, const vtkNURBSPieces& pieces) const;
  void Deform(const nurbs::FreeFormLattice& lattice, const Grids& models);
  void FillLattice(const nurbs::FreeFormLattice& lattice, vtkStructuredGrid* output) const;

  int Dimensions[3] = { 4, 4, 4 };
  int Degree[3] = { 0, 0, 0 };
  bool UseInputBounds = true;
  double Margin = 0.0;
  double Bounds[6] = { -1.0, 1.0, -1.0, 1.0, -1.0, 1.0 };
  int FrozenLayers = 0;
  std::vector<double> Displacements; ///< 3 a lattice point.
  vtkSmartPointer<vtkPoints> Lattice;
  vtkIdType NumberOfMovedPoints = 0;
  bool HasFailed = false; ///< The last update, in some process.

  /// The points of the output's models, kept from update to update.
  std::vector<vtkSmartPointer<vtkPoints>> Kept;
};

#endif
