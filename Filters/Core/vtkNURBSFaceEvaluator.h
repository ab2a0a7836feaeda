// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSFaceEvaluator
 * @brief Points, derivatives and normals of a model's faces, and what the faces are made of.
 *
 * For programs that compute with surfaces, in Python above all (vtknurbs.Evaluator): all parameters
 * of a call are evaluated at once, in parallel (vtkSMPTools); the result does not depend on the
 * number of threads. A face is a cell of the model.
 *
 * The model is checked when it is first used, and again after a change that Modified() was called
 * for (vtkPoints::Modified, if control points were written to). Faces with an error can't be
 * evaluated; GetFaceError tells why.
 *
 * Methods that return a bool return false after an error, which vtkErrorMacro and GetErrorMessage
 * tell with the cell and the reason: no such cell, loop or curve, a face that can't be used,
 * parameters that are not an array of two components.
 *
 * @sa vtkNURBSModel, vtkNURBSModelBuilder, vtkNURBSCellLocator
 */
#ifndef vtkNURBSFaceEvaluator_h
#define vtkNURBSFaceEvaluator_h

#include "vtkNURBSFiltersCoreModule.h" // For export macro
#include "vtkObject.h"
#include "vtkSmartPointer.h" // For the model

#include <memory> // For what is kept of the model
#include <string> // For messages

class vtkDataArray;
class vtkDoubleArray;
class vtkUnsignedCharArray;
class vtkUnstructuredGrid;

class VTKNURBSFILTERSCORE_EXPORT vtkNURBSFaceEvaluator : public vtkObject
{
public:
  static vtkNURBSFaceEvaluator* New();
  vtkTypeMacro(vtkNURBSFaceEvaluator, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The model (see vtkNURBSModel). Default: none, which has no face.
   */
  void SetModel(vtkUnstructuredGrid* model);
  vtkUnstructuredGrid* GetModel();
  ///@}

  /// Faces of the model that was given.
  vtkIdType GetNumberOfFaces();

  /**
   * Why the face can't be used; empty if it can.
   */
  std::string GetFaceError(vtkIdType cell);

  /**
   * Points and, up to `order` (0 to 2), partial derivatives at parameters (u, v) of the face's own
   * domain; `parameters` has 2 components. `results` gets as many tuples of 3, 9 or 18 components:
   * S, Su, Sv, Suu, Suv, Svv, 3 each. At a knot derivatives are those after it (at the domain's
   * end: before it). Parameters outside the domain extrapolate the first or last span.
   */
  bool Evaluate(vtkIdType cell, vtkDataArray* parameters, int order, vtkDoubleArray* results);

  /**
   * Unit normals, outwards as the face's Orientation tells; at poles the limit (see nurbs::Normal).
   */
  bool EvaluateNormals(vtkIdType cell, vtkDataArray* parameters, vtkDoubleArray* normals);

  /**
   * 1 where the parameters are inside the trimming loops, else 0 (see nurbs::FaceTrim).
   */
  bool EvaluateInside(vtkIdType cell, vtkDataArray* parameters, vtkUnsignedCharArray* inside);

  ///@{
  /**
   * Of a face: its domain as u0, u1, v0, v1; its degrees and its number of control points in u and
   * v; the knots of direction 0 (u) or 1 (v); control points (3 components, u fastest) and weights
   * (all 1 if it is polynomial; IsRational tells whether some differ); whether the outside is
   * against Su x Sv.
   */
  bool GetDomain(vtkIdType cell, double domain[4]);
  bool GetDegree(vtkIdType cell, int degree[2]);
  bool GetNetSize(vtkIdType cell, int size[2]);
  bool GetKnots(vtkIdType cell, int direction, vtkDoubleArray* knots);
  bool GetControlPoints(vtkIdType cell, vtkDoubleArray* points);
  bool GetWeights(vtkIdType cell, vtkDoubleArray* weights);
  bool IsRational(vtkIdType cell);
  bool IsReversed(vtkIdType cell);
  ///@}

  ///@{
  /**
   * Its trimming loops and their curves: points (u, v, weight) and knots (as many, and degree + 1
   * more), the edge that the curve is the image of (an index that faces have in common where they
   * share it; -1: none), and whether the loop runs from the curve's end to its start. Numbers are
   * -1 after an error.
   */
  vtkIdType GetNumberOfLoops(vtkIdType cell);
  vtkIdType GetNumberOfTrimCurves(vtkIdType cell, vtkIdType loop);
  bool GetTrimCurve(
    vtkIdType cell, vtkIdType loop, vtkIdType curve, vtkDoubleArray* points, vtkDoubleArray* knots);
  vtkIdType GetTrimCurveEdge(vtkIdType cell, vtkIdType loop, vtkIdType curve);
  bool IsTrimCurveReversed(vtkIdType cell, vtkIdType loop, vtkIdType curve);
  ///@}

  /**
   * Why the last call failed; empty if it did not.
   */
  const std::string& GetErrorMessage() const { return this->ErrorMessage; }

protected:
  vtkNURBSFaceEvaluator();
  ~vtkNURBSFaceEvaluator() override;

private:
  vtkNURBSFaceEvaluator(const vtkNURBSFaceEvaluator&) = delete;
  void operator=(const vtkNURBSFaceEvaluator&) = delete;

  bool Refuse(const std::string& reason);
  /// True if the cell is a face that can be used; the model is checked first if need be.
  bool HasFace(vtkIdType cell);
  bool CanFill(vtkIdType cell, vtkDataArray* results);
  bool HasParameters(vtkIdType cell, vtkDataArray* parameters, vtkDataArray* results);
  /// The index of a trim curve in the model, or -1.
  vtkIdType FindTrimCurve(vtkIdType cell, vtkIdType loop, vtkIdType curve);

  struct Internals;
  std::unique_ptr<Internals> Content;
  vtkSmartPointer<vtkUnstructuredGrid> Model;
  std::string ErrorMessage;
};

#endif
