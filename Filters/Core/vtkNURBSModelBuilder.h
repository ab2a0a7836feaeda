// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSModelBuilder
 * @brief Makes a NURBS model of arrays of knots, control points, weights and trim curves.
 *
 * For programs that have surfaces in memory, in Python above all (vtknurbs.make_model):
 *
 *     builder->AddFace(3, 3, knotsU, knotsV, points, weights);
 *     builder->SetFaceName("wing");
 *     builder->BeginLoop();                               // only if the face is trimmed
 *     builder->AddTrimCurve(2, knots, uvw, -1, false);
 *     builder->Build(grid);                               // a model of vtkNURBSModel
 *
 * Arrays are copied. A call with data that can't be a face's is refused: vtkErrorMacro and
 * GetErrorMessage name the face and the reason, and all stays as it was. What only the whole model
 * can tell (loops that do not close, for example) is vtkNURBSModel::Validate's.
 *
 * @sa vtkNURBSModel, vtkNURBSFaceEvaluator
 */
#ifndef vtkNURBSModelBuilder_h
#define vtkNURBSModelBuilder_h

#include "vtkNURBSFiltersCoreModule.h" // For export macro
#include "vtkObject.h"

#include <memory> // For the faces
#include <string> // For names and messages

class vtkDataArray;
class vtkUnstructuredGrid;

class VTKNURBSFILTERSCORE_EXPORT vtkNURBSModelBuilder : public vtkObject
{
public:
  static vtkNURBSModelBuilder* New();
  vtkTypeMacro(vtkNURBSModelBuilder, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Adds a surface. `knotsU` and `knotsV` are whole knot vectors (1 component); a direction has as
   * many control points as knots, less degree + 1. `points` (3 components, Cartesian) has u
   * fastest; `weights` (1 component, > 0) may be null: all 1. Degrees are 1 to 25. Returns the
   * index of the face, which is its cell in the model; -1 after an error.
   */
  vtkIdType AddFace(int degreeU, int degreeV, vtkDataArray* knotsU, vtkDataArray* knotsV,
    vtkDataArray* points, vtkDataArray* weights);

  ///@{
  /**
   * Of the face added last: its identity (default: its index; at least 0), its name (UTF-8, default
   * none), its colour (sRGB, 0 to 255, default 204, 204, 204), and whether the outside is against
   * Su x Sv (default: along it). False after an error.
   */
  bool SetFaceId(vtkIdType id);
  bool SetFaceName(const std::string& name);
  bool SetFaceColor(int red, int green, int blue);
  bool SetFaceReversed(bool reversed);
  ///@}

  /**
   * Starts a trimming loop of the face added last; the face's material lies on its left in the (u,
   * v) plane. A face without loops has the natural boundary. False after an error.
   */
  bool BeginLoop();

  /**
   * Appends a curve to the loop begun last. `points` has 2 components (u, v) or 3 (u, v, weight);
   * `knots` as many values as points, and degree + 1 more. `edge`: a number of the caller's choice,
   * at least 0, that two curves have in common where their faces share an edge (they must then be
   * the images of the same curve in space, parameter by parameter); -1: none. `reversed`: the loop
   * runs from the curve's end to its start. False after an error.
   */
  bool AddTrimCurve(
    int degree, vtkDataArray* knots, vtkDataArray* points, vtkIdType edge, bool reversed);

  ///@{
  /**
   * Whether sides of untrimmed faces that are the same in space, bit for bit (control points,
   * weights and knots, forwards or backwards), become one edge that the faces share, so that their
   * meshes have no gap there; such faces get a loop of their four sides. Concerns clamped knots
   * only. Default on.
   */
  vtkSetMacro(JoinSides, bool);
  vtkGetMacro(JoinSides, bool);
  vtkBooleanMacro(JoinSides, bool);
  ///@}

  ///@{
  /**
   * The unit of the control points, stored in the model. Default "mm".
   */
  vtkSetMacro(LengthUnit, std::string);
  vtkGetMacro(LengthUnit, std::string);
  ///@}

  /**
   * Replaces the content of `grid` by the model of all faces added. The builder keeps them.
   */
  void Build(vtkUnstructuredGrid* grid);

  /**
   * Forgets all faces.
   */
  void Reset();

  /// Faces so far.
  vtkIdType GetNumberOfFaces() const;

  /**
   * Why the last call was refused; empty if it was not.
   */
  const std::string& GetErrorMessage() const { return this->ErrorMessage; }

protected:
  vtkNURBSModelBuilder();
  ~vtkNURBSModelBuilder() override;

private:
  vtkNURBSModelBuilder(const vtkNURBSModelBuilder&) = delete;
  void operator=(const vtkNURBSModelBuilder&) = delete;

  /// True if there is a face to set something of.
  bool HasFace();
  bool Refuse(const std::string& reason);

  struct Internals;
  std::unique_ptr<Internals> Content;
  bool JoinSides = true;
  std::string LengthUnit = "mm";
  std::string ErrorMessage;
};

#endif
