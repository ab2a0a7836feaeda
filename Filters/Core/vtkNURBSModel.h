// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSModel
 * @brief Knows how a trimmed NURBS model is stored in a vtkUnstructuredGrid.
 *
 * One cell is one trimmed surface. Points are control points (Cartesian); a VTK_POLY_VERTEX cell
 * lists the control net of its surface, u fastest. All else is arrays:
 *
 * | where | array | components, type | meaning |
 * |---|---|---|---|
 * | point data | RationalWeights | 1 real | weight of the control point, > 0; absent: all 1 |
 * | cell data | Degree | 2 integers | degree in u and v, 1 to 25 |
 * | cell data | NetSize | 2 integers | control points in u and v |
 * | cell data | KnotStart | 2 integers | where the knots of u and v start in Knots |
 * | cell data | LoopStart, LoopCount | 1 integer | trimming loops; count 0: natural boundary |
 * | cell data | FaceId | 1 integer | identity of the face, kept by every filter |
 * | cell data | Orientation | 1 integer | +1, or -1: the outside is against Su x Sv |
 * | cell data | Color | 3 unsigned char | sRGB |
 * | cell data | Name | string | UTF-8 |
 * | field data | Knots | real | NetSize + Degree + 1 values a surface and direction |
 * | field data | LoopCurveStart, LoopCurveCount | 1 integer a loop | its trim curves |
 * | field data | TrimCurveDegree, TrimCurveKnotStart, TrimCurvePointStart, TrimCurvePointCount |
 *   1 integer a trim curve | ranges in TrimKnots and TrimPoints |
 * | field data | TrimCurveEdgeId, TrimCurveReversed | 1 integer a trim curve | edge (-1: none), and
 *   whether the loop runs from the curve's end to its start |
 * | field data | TrimPoints | 3 reals | u, v, weight |
 * | field data | EdgeDegree, EdgeKnotStart, EdgePointStart, EdgePointCount | 1 integer an edge |
 *   ranges in EdgeKnots and EdgePoints; count 0: curve unknown; degree 0: a pole |
 * | field data | EdgeTolerance | 1 real an edge | distance of the lifted trim curves from it |
 * | field data | EdgeVertices | 2 integers an edge | start and end in VertexPoints, or -1 |
 * | field data | EdgePoints | 4 reals | x, y, z, weight |
 * | field data | VertexPoints | 3 reals | positions where edges meet |
 * | field data | EdgeGlobalId, VertexGlobalId | 1 integer an edge or vertex | of a piece of a model
 *   only: its number in the whole model, by which pieces fit together |
 * | field data | WholeBounds | 6 reals | of a piece with faces of its neighbours only: xmin, xmax, ... of
 *   the control points of the whole model |
 * | field data | LengthUnit | string | unit of the points, for example "mm" |
 *
 * A face's material lies on the left of its loops in the (u, v) plane. Cells may be dropped or
 * copied and points may be moved by any VTK filter: the ranges in the field data stay right.
 * Where points were moved, the 3D curves of edges no longer fit; View notices that, keeps the
 * topology and forgets the curves.
 *
 * Every other class goes through this one and spells none of the names above.
 */
#ifndef vtkNURBSModel_h
#define vtkNURBSModel_h

#include "Types.h"
#include "vtkNURBSFiltersCoreModule.h" // For export macro
#include "vtkObject.h"

#include <cstdint> // For std::int64_t
#include <memory>  // For std::shared_ptr
#include <string>  // For std::string
#include <vector>  // For std::vector

class vtkAbstractArray;
class vtkDataArray;
class vtkDataObject;
class vtkDataSetAttributes;
class vtkFieldData;
class vtkIdTypeArray;
class vtkUnstructuredGrid;
class vtkNURBSModelView;

namespace nurbs
{
class ModelBuilder;
struct ModelProblem;
} // namespace nurbs

class VTKNURBSFILTERSCORE_EXPORT vtkNURBSModel : public vtkObject
{
public:
  static vtkNURBSModel* New();
  vtkTypeMacro(vtkNURBSModel, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * Everything that is wrong with a model, one problem a line; empty if it is fine. A line reads
   * "error: cell 3 (FaceId 17): ..." or "warning: ...". `data` is a vtkUnstructuredGrid or a
   * composite of them; there, a line starts with the block: "block 2 (wheel): error: ...", 2 being
   * the index in a vtkPartitionedDataSetCollection (else the flat index).
   */
  static std::string Validate(vtkDataObject* data);

  /**
   * True if no error was found (warnings may have been). `problems` receives all errors and
   * warnings.
   */
  static bool Validate(vtkUnstructuredGrid* grid, std::vector<nurbs::ModelProblem>& problems);

  /**
   * The grid as the kernels see it (include vtkNURBSModelView.h). Faces with an error are flagged
   * in the view and the others stay usable. Real arrays of doubles and integer arrays of 64 bits
   * are not copied; others are converted and owned by the view, which also keeps the grid's arrays
   * alive. Never null: a null grid gives an empty view. Edit neither arrays nor points meanwhile.
   */
  static std::shared_ptr<const vtkNURBSModelView> View(vtkUnstructuredGrid* grid);

  /**
   * Replaces the content of `grid` by the model built. The builder is emptied as it goes, so that
   * memory is not needed twice.
   */
  static void Store(nurbs::ModelBuilder& builder, vtkUnstructuredGrid* grid);

  /**
   * True if the grid has the arrays that no model can do without (Degree, NetSize, KnotStart,
   * Knots). Says nothing about their content.
   */
  static bool IsModel(vtkUnstructuredGrid* grid);

  /**
   * True if the cell array `name` describes the storage of a surface (Degree, NetSize, KnotStart,
   * LoopStart, LoopCount, Orientation), false if it is an attribute of the face such as FaceId,
   * Color, Name or a user's own.
   */
  static bool IsStructureArray(const char* name);

  /**
   * True if the array `name`, of cells or of the field data, describes loops, trim curves or edges; what
   * is left of a model's structure describes surfaces.
   */
  static bool IsTrimArray(const char* name);

  /**
   * The arrays that say what the surfaces, loops and edges of a grid are, in an order that depends on
   * nothing else: all of its structure but points, weights and connectivity.
   */
  static std::vector<vtkAbstractArray*> GetStructureArrays(vtkUnstructuredGrid* grid);

  /**
   * The weights of the control points; null if there are none, i.e. if all are 1.
   */
  static vtkDataArray* GetWeights(vtkUnstructuredGrid* grid);

  /**
   * Copies the faces' attributes (all cell arrays but those of IsStructureArray) to `target`: tuple
   * i of the target is that of cell `faces[i]`. Arrays that do not have one tuple a cell are left
   * out (Validate warns of them). FaceId is made from cell indices if there is none.
   */
  static void CopyFaceAttributes(
    vtkUnstructuredGrid* grid, vtkIdTypeArray* faces, vtkDataSetAttributes* target);

  /**
   * Removes the arrays that describe a model's surfaces, loops and edges from field data that a
   * filter passed on to an output that is no model. LengthUnit and foreign arrays stay.
   */
  static void RemoveStructure(vtkFieldData* field);

  /**
   * Passes the other arrays of a model's field data on, see RemoveStructure.
   */
  static void PassWithoutStructure(vtkFieldData* model, vtkFieldData* output);

  /**
   * Stores the numbers that the edges and vertices of a piece of a model have in the whole one (see
   * nurbs::PieceBuilder). The vectors are emptied.
   */
  static void SetGlobalIds(vtkUnstructuredGrid* grid, std::vector<std::int64_t>& edges,
    std::vector<std::int64_t>& vertices);

  /**
   * Stores the box of the control points of the model that the grid is a piece of.
   */
  static void SetWholeBounds(vtkUnstructuredGrid* grid, const nurbs::Box3& box);

  /**
   * True if the grid is a piece of a model that tells them.
   */
  static bool HasGlobalIds(vtkUnstructuredGrid* grid);

  ///@{
  /**
   * Identity of a cell's face: its FaceId, or the cell's index if there is no such array.
   */
  static vtkIdType GetFaceId(vtkUnstructuredGrid* grid, vtkIdType cell);
  static const char* FaceIdName();
  static const char* EdgeIdName();
  static const char* ColorName();
  static const char* NameName();
  ///@}

  /**
   * Name of the point array of the weights.
   */
  static const char* WeightsName();

  /**
   * Unit of length of the points ("mm" unless the source says otherwise); empty if not stored.
   */
  static std::string GetLengthUnit(vtkUnstructuredGrid* grid);

  /**
   * Stores that faces of a file could not be converted, as strings "FaceId: reason".
   */
  static void SetUnconvertedFaces(
    vtkUnstructuredGrid* grid, const std::vector<std::string>& reasons);

  /**
   * The reasons stored by SetUnconvertedFaces.
   */
  static std::vector<std::string> GetUnconvertedFaces(vtkUnstructuredGrid* grid);

protected:
  vtkNURBSModel();
  ~vtkNURBSModel() override;

private:
  vtkNURBSModel(const vtkNURBSModel&) = delete;
  void operator=(const vtkNURBSModel&) = delete;
};

#endif
