// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSCellLocator
 * @brief Finds where lines meet the exact trimmed surfaces of a model.
 *
 * The data set is a model of vtkNURBSModel; a cell is a face. Surfaces are intersected as they are,
 * see nurbs::RayCaster; no mesh is made and the tolerances of the methods' signatures are not
 * needed. Faces with an error are left out, with a warning when the locator is built.
 *
 * To pick faces of a model that a mapper draws:
 *
 *     locator->SetDataSet(mapper's input grid);  // one locator a grid, for an assembly
 *     picker->AddLocator(locator);               // a vtkCellPicker
 *     picker->Pick(x, y, 0, renderer);
 *
 * gives the face as CellId of DataSet, the exact point as PickPosition, the surface's outward
 * normal as PickNormal, u and v as PCoords, SubId 0, and the corner of the control net next to (u,
 * v) as PointId. Without a locator, vtkCellPicker looks for control points near the ray.
 *
 * PCoords are u and v, each mapped from the face's domain to 0 to 1. The cell that
 * IntersectWithLine hands back is not that of the data set, which has no surface, but a VTK_QUAD: a
 * square in the tangent plane at the hit, seen from its outside counter-clockwise, which has the
 * point at its PCoords; its point ids are the corners of the control net.
 *
 * Queries build the locator if it is older than its data set. Call BuildLocator first if several
 * threads will ask; queries with a cell to fill in are then safe. For millions of rays,
 * GetRayCaster saves the check for changes.
 */
#ifndef vtkNURBSCellLocator_h
#define vtkNURBSCellLocator_h

#include "vtkAbstractCellLocator.h"
#include "vtkNURBSFiltersCoreModule.h" // For export macro
#include "vtkVersionMacros.h"          // For VTK_VERSION_NUMBER

#include <memory> // For std::shared_ptr

namespace nurbs
{
class RayCaster;
}

class VTKNURBSFILTERSCORE_EXPORT vtkNURBSCellLocator : public vtkAbstractCellLocator
{
public:
  static vtkNURBSCellLocator* New();
  vtkTypeMacro(vtkNURBSCellLocator, vtkAbstractCellLocator);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  using vtkAbstractCellLocator::FindCell;
  using vtkAbstractCellLocator::FindClosestPoint;
  using vtkAbstractCellLocator::FindClosestPointWithinRadius;
  using vtkAbstractCellLocator::IntersectWithLine;

  /**
   * The first intersection of the segment from p1 to p2 with a face: t is 0 at p1 and 1 at p2.
   * Returns 0, and leaves the other arguments, if there is none. `cell` may be null.
   */
  int IntersectWithLine(const double p1[3], const double p2[3], double tol, double& t, double x[3],
    double pcoords[3], int& subId, vtkIdType& cellId, vtkGenericCell* cell) override;

  /**
   * All intersections of the segment, from p1 to p2. Returns 0 if there is none, else 1 if the
   * first one comes from the outside of its face or -1 if it comes from the inside: for a closed
   * model, p1 lies there. `points` and `cellIds` may be null.
   */
  int IntersectWithLine(
    const double p1[3], const double p2[3], vtkPoints* points, vtkIdList* cellIds) override;

  /**
   * The faces that the segment intersects, by the order of their first intersections.
   */
  void FindCellsAlongLine(
    const double p1[3], const double p2[3], double tolerance, vtkIdList* cells) override;

  /**
   * The faces with a part whose box meets `bbox`, in ascending order. A part is a piece of surface
   * that is not all trimmed away.
   */
  void FindCellsWithinBounds(double* bbox, vtkIdList* cells) override;

#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 0)
  /**
   * As the method above of the same result; returns 1 if there is an intersection. `cell` is not
   * used.
   */
  int IntersectWithLine(const double p1[3], const double p2[3], const double tol, vtkPoints* points,
    vtkIdList* cellIds, vtkGenericCell* cell) override;

  /**
   * The faces with a part whose box is within `tolerance` of the plane, in ascending order.
   */
  void FindCellsAlongPlane(
    const double o[3], const double n[3], double tolerance, vtkIdList* cells) override;
#endif

  /**
   * True if the point lies in the bounds of the cell's control points.
   */
  bool InsideCellBounds(double x[3], vtkIdType cellId) override;

  ///@{
  /**
   * Not available: emit an error, return 0 or set cellId to -1. The closest point of a trimmed
   * surface is another problem than an intersection, and a surface contains no point of space.
   */
  void FindClosestPoint(const double x[3], double closestPoint[3], vtkGenericCell* cell,
    vtkIdType& cellId, int& subId, double& dist2) override;
  vtkIdType FindClosestPointWithinRadius(double x[3], double radius, double closestPoint[3],
    vtkGenericCell* cell, vtkIdType& cellId, int& subId, double& dist2, int& inside) override;
  vtkIdType FindCell(
    double x[3], double tol2, vtkGenericCell* cell, double pcoords[3], double* weights) override;
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 0)
  vtkIdType FindCell(double x[3], double tol2, vtkGenericCell* cell, int& subId, double pcoords[3],
    double* weights) override;
#endif
  ///@}

  ///@{
  /**
   * Builds what queries search in, unless it is up to date (or UseExistingSearchStructure is on and
   * there is one). Emits an error if the data set is no model.
   */
  void BuildLocator() override;
  void FreeSearchStructure() override;
  ///@}

  /**
   * Gives the boxes of the faces' parts, as quads; `level` is not used.
   */
  void GenerateRepresentation(int level, vtkPolyData* pd) override;

#ifndef __VTK_WRAP__
  /**
   * What the queries use, built if need be. Null if there is none. It keeps the model alive, and
   * stays as it is when the locator is built anew.
   */
  std::shared_ptr<const nurbs::RayCaster> GetRayCaster();
#endif

protected:
  vtkNURBSCellLocator();
  ~vtkNURBSCellLocator() override;

private:
  vtkNURBSCellLocator(const vtkNURBSCellLocator&) = delete;
  void operator=(const vtkNURBSCellLocator&) = delete;

  struct Structure;
  std::shared_ptr<const Structure> Content;
};

#endif
