// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSDeformingTessellator
 * @brief Triangles of trimmed NURBS models whose control points move: updated, not made again.
 *
 * The input is a model of vtkNURBSModel, or a composite data set of models, whose points, weights or
 * both change from one update to the next by any means: Warp By Vector, a transform, a programmable
 * filter, time steps, an interactor. The first frame is meshed as Tolerance asks for. From then on the
 * filter compares control points with the last ones, updates the vertices that depend on those that
 * moved, makes cells finer or coarser where they need it, and keeps all else. Faces whose structure
 * changed (degrees, knots, trims, connectivity) are meshed anew, all of their model where faces, edges
 * or vertices are not those that there were.
 *
 * Faces that share an edge have its points bit for bit at every frame, so that closed models have no
 * open edge. Where such faces are pulled apart the mesh is where the first of them is, and ModelGap
 * tells how far the others are.
 *
 * The output is a vtkPolyData of triangles, or a composite of the input's type and structure:
 *
 * | where | array | meaning |
 * |---|---|---|
 * | points | (double) | on the surfaces |
 * | point data | Normals (float, 3) | unit normal of the surface, outwards |
 * | point data | UV (double, 2) | parameters in the face's own domain |
 * | point data | Changed (unsigned char) | 1: the last frame moved or added the point |
 * | cell data | FaceId and all other attributes of the model's faces | of the triangle's face |
 * | field data | MovedControlPoints, UpdatedVertices, InsertedVertices, DeletedVertices (id type) |
 *   of the last frame |
 * | field data | ChangedPointRange (id type, 2) | first and last point with Changed; -1, -1: none |
 * | field data | ChangedTriangleRange (id type, 2) | likewise of triangles whose corners changed |
 * | field data | CappedCells (id type) | cells that err by more and are as small as cells become |
 * | field data | CrossingFaces (id type) | faces whose loops' polylines cross; a warning tells of new ones |
 * | field data | ErrorBound (double) | bound of the distance of triangles and surfaces, ModelGap in it |
 * | field data | ModelGap (double) | largest distance of faces at the vertices of a shared edge |
 * | field data | ToleranceUsed (double) | of patches that count in full, see TriangleBudget |
 * | field data | NumberOfTriangles (id type) | |
 * | field data | CompareSeconds, MoveSeconds, AdaptSeconds, RebuildSeconds, OutputSeconds (double) |
 *   what the last frame took |
 *
 * Arrays are the same objects from frame to frame until a model's structure or the options change, and
 * Modified() is called for those that a frame changed: when only points moved, for points, Normals,
 * Changed and field data, so that a mapper uploads points and normals only. Points that a frame
 * removed stay, unused, at the place of another one until their number is worth numbering all anew.
 *
 * The arrays are edited in place. A shallow copy of the output sees that and has to be made again when
 * triangles changed (as the pipeline does), for its own tables of cells and links; a deep copy keeps
 * the frame. Arrays outlive the filter. They must not be written to by others.
 *
 * A frame with a control point that is not finite or moved by more than LargestMove, with a weight that
 * is not positive, or with all control points of a face in one place, is an error that names the block,
 * the face and the control point. The model's last good mesh stays, and the next good frame is
 * followed. If there is no such mesh the output is empty. Faces with errors are named in one warning
 * and have no triangles; an input without NURBS arrays is an error.
 *
 * Reports progress and obeys AbortExecute between the models of a composite: models that were not
 * done keep their last meshes. Work is spread by vtkSMPTools, the result does not depend on the number
 * of threads.
 *
 * Source: F. W. B. Li, R. W. H. Lau, M. Green, "Interactive rendering of deforming NURBS surfaces",
 * Computer Graphics Forum 16 (1997).
 *
 * @sa vtkNURBSModel, vtkNURBSTessellator
 */
#ifndef vtkNURBSDeformingTessellator_h
#define vtkNURBSDeformingTessellator_h

#include "vtkDataObjectAlgorithm.h"
#include "vtkNURBSFiltersDeformationModule.h" // For export macro

#include <memory> // For the models
#include <vector> // For std::vector

class vtkCamera;

class VTKNURBSFILTERSDEFORMATION_EXPORT vtkNURBSDeformingTessellator : public vtkDataObjectAlgorithm
{
public:
  static vtkNURBSDeformingTessellator* New();
  vtkTypeMacro(vtkNURBSDeformingTessellator, vtkDataObjectAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// What ToleranceMode may be.
  enum ToleranceModes
  {
    RELATIVE = 0,
    ABSOLUTE = 1
  };

  ///@{
  /**
   * Whether the distance of triangles and surfaces is bounded by Tolerance (RELATIVE, default) or by
   * AbsoluteTolerance.
   */
  vtkSetClampMacro(ToleranceMode, int, RELATIVE, ABSOLUTE);
  vtkGetMacro(ToleranceMode, int);
  void SetToleranceModeToRelative() { this->SetToleranceMode(RELATIVE); }
  void SetToleranceModeToAbsolute() { this->SetToleranceMode(ABSOLUTE); }
  ///@}

  ///@{
  /**
   * The tolerance as a share of the diagonal of the box around all surfaces in the last frame in which
   * all models were meshed anew. Default 1e-3, 1e-9 to 1.
   */
  vtkSetClampMacro(Tolerance, double, 1e-9, 1.0);
  vtkGetMacro(Tolerance, double);
  ///@}

  ///@{
  /**
   * The tolerance of ABSOLUTE mode, in the unit of the points. Default 0.1; must be positive.
   */
  vtkSetMacro(AbsoluteTolerance, double);
  vtkGetMacro(AbsoluteTolerance, double);
  ///@}

  ///@{
  /**
   * Cells are merged only if that keeps them within this share of their tolerance, so that a surface
   * that trembles does not change its mesh each frame. Default 0.5; 0.01 to 1.
   */
  vtkSetClampMacro(Hysteresis, double, 0.01, 1.0);
  vtkGetMacro(Hysteresis, double);
  ///@}

  ///@{
  /**
   * On (default): cells are halved and merged as the surfaces bend. Off: the cells of the first frame
   * stay, whatever they err by, and ErrorBound is of the first frame.
   */
  vtkSetMacro(ResolutionRefinement, vtkTypeBool);
  vtkGetMacro(ResolutionRefinement, vtkTypeBool);
  vtkBooleanMacro(ResolutionRefinement, vtkTypeBool);
  ///@}

  ///@{
  /**
   * How many times every patch between two knots is halved in u and in v, whatever it errs by; -1, the
   * default: as the tolerance asks for. -1 to 10.
   */
  vtkSetClampMacro(PatchSubdivisions, int, -1, 10);
  vtkGetMacro(PatchSubdivisions, int);
  ///@}

  /// What CoefficientStorage may be.
  enum CoefficientStorages
  {
    EAGER = 0,
    ON_DEMAND = 1
  };

  ///@{
  /**
   * Whether the coefficients (equation 2) of vertices on loops are stored (EAGER, default) or computed
   * when they are needed. Vertices of patches need none of their own, as their parameters form a grid.
   */
  vtkSetClampMacro(CoefficientStorage, int, EAGER, ON_DEMAND);
  vtkGetMacro(CoefficientStorage, int);
  void SetCoefficientStorageToEager() { this->SetCoefficientStorage(EAGER); }
  void SetCoefficientStorageToOnDemand() { this->SetCoefficientStorage(ON_DEMAND); }
  ///@}

  ///@{
  /**
   * Memory in MiB for the sums that moves of few control points are added to; beyond, vertices are
   * evaluated. Each model has a share by its number of control points. Default 1024, at least 0.
   */
  vtkSetClampMacro(MemoryLimit, int, 0, VTK_INT_MAX);
  vtkGetMacro(MemoryLimit, int);
  ///@}

  ///@{
  /**
   * How many triangles all models together may have: while they would have more, the tolerances of all
   * patches grow alike. Each model has a share by its number of control points. Default 0: as many as
   * it takes.
   */
  vtkSetClampMacro(TriangleBudget, vtkIdType, 0, VTK_ID_MAX);
  vtkGetMacro(TriangleBudget, vtkIdType);
  ///@}

  ///@{
  /**
   * Who looks (section 5): patches far from the camera or from its line of sight have a larger
   * tolerance, the one asked for divided by their importance. Default: none, all count in full.
   */
  void SetCamera(vtkCamera* camera);
  vtkGetObjectMacro(Camera, vtkCamera);
  ///@}

  ///@{
  /**
   * Patches up to this distance from the camera count in full; beyond, their importance falls as its
   * inverse. 0, the default: the distance of the camera's focal point. At least 0. With a parallel
   * projection, distance and angle do not count.
   */
  vtkSetClampMacro(FullDetailDistance, double, 0.0, VTK_DOUBLE_MAX);
  vtkGetMacro(FullDetailDistance, double);
  ///@}

  ///@{
  /**
   * Degrees from the line of sight up to which patches count in full; beyond, their importance falls as
   * the inverse of the angle. Default 15, 0.1 to 180.
   */
  vtkSetClampMacro(SightAngle, double, 0.1, 180.0);
  vtkGetMacro(SightAngle, double);
  ///@}

  ///@{
  /**
   * The least importance of a patch, however far away. Default 0.1; 1e-3 to 1.
   */
  vtkSetClampMacro(LeastImportance, double, 1e-3, 1.0);
  vtkGetMacro(LeastImportance, double);
  ///@}

  ///@{
  /**
   * By how much a control point may move in one frame, in diagonals of the box around the model's
   * first control points; a frame with one that moves farther is refused. Default 1e6, at least 1e-6.
   */
  vtkSetClampMacro(LargestMove, double, 1e-6, 1e30);
  vtkGetMacro(LargestMove, double);
  ///@}

  ///@{
  /**
   * On (default): sides of faces without trims that coincide when the model is meshed (within 1e-7 of
   * the diagonal) are one edge from then on, as in models that do not say which edges faces share.
   * Off: only edges that the model names are shared, besides a closed face's own sides.
   */
  vtkSetMacro(JoinSides, vtkTypeBool);
  vtkGetMacro(JoinSides, vtkTypeBool);
  vtkBooleanMacro(JoinSides, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Whether the output has the point data Changed. Default on.
   */
  vtkSetMacro(ChangedMask, vtkTypeBool);
  vtkGetMacro(ChangedMask, vtkTypeBool);
  vtkBooleanMacro(ChangedMask, vtkTypeBool);
  ///@}

  /**
   * Forgets the meshes: the next update makes all of them anew.
   */
  void Reset();

  ///@{
  /**
   * What the last Update did, all models together: as the field data of the output, where ErrorBound,
   * ModelGap and ToleranceUsed are the largest of all models. RebuiltModels counts those that were
   * meshed anew, ReplacedFaces the faces that alone were, RefusedModels the models whose frame was refused. All are 0 before the first Update.
   */
  vtkGetMacro(MovedControlPoints, vtkIdType);
  vtkGetMacro(UpdatedVertices, vtkIdType);
  vtkGetMacro(InsertedVertices, vtkIdType);
  vtkGetMacro(DeletedVertices, vtkIdType);
  vtkGetMacro(NumberOfTriangles, vtkIdType);
  vtkGetMacro(NumberOfPoints, vtkIdType);
  vtkGetMacro(RebuiltModels, vtkIdType);
  vtkGetMacro(ReplacedFaces, vtkIdType);
  vtkGetMacro(RefusedModels, vtkIdType);
  vtkGetMacro(CappedCells, vtkIdType);
  vtkGetMacro(CrossingFaces, vtkIdType);
  vtkGetMacro(ErrorBound, double);
  vtkGetMacro(ModelGap, double);
  vtkGetMacro(ToleranceUsed, double);
  vtkGetMacro(CompareSeconds, double);
  vtkGetMacro(MoveSeconds, double);
  vtkGetMacro(AdaptSeconds, double);
  vtkGetMacro(RebuildSeconds, double);
  vtkGetMacro(OutputSeconds, double);
  ///@}

  /// The camera's included.
  vtkMTimeType GetMTime() override;

protected:
  vtkNURBSDeformingTessellator();
  ~vtkNURBSDeformingTessellator() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestDataObject(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;
  int RequestData(
    vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  vtkNURBSDeformingTessellator(const vtkNURBSDeformingTessellator&) = delete;
  void operator=(const vtkNURBSDeformingTessellator&) = delete;

  struct Leaf;
  struct Frame;
  void MakeFrame(vtkDataObject* input, Frame& frame);
  void Make(vtkDataObject* input, Frame& frame, vtkDataObject* output);
  void FindNewLeaves(Frame& frame);
  void SetDiagonal(const Frame& frame);
  void UpdateLeaf(Frame& frame, std::size_t k);
  enum Deed
  {
    NOTHING,
    FOLLOWED,
    MADE
  };
  void NoteFaceErrors(Frame& frame, std::size_t k, const std::vector<std::string>& errors);
  Deed MakeLeaf(Frame& frame, std::size_t k);
  Deed ReplaceFaces(Frame& frame, std::size_t k);
  Deed FollowLeaf(Frame& frame, std::size_t k);
  void FillOutput(vtkDataObject* input, vtkDataObject* output);
  bool Complain(const Frame& frame);
  void Summarize();
  void ClearResults();

  int ToleranceMode = RELATIVE;
  double Tolerance = 1e-3;
  double AbsoluteTolerance = 0.1;
  double Hysteresis = 0.5;
  vtkTypeBool ResolutionRefinement = 1;
  int PatchSubdivisions = -1;
  int CoefficientStorage = EAGER;
  int MemoryLimit = 1024;
  vtkIdType TriangleBudget = 0;
  vtkCamera* Camera = nullptr;
  double FullDetailDistance = 0.0;
  double SightAngle = 15.0;
  double LeastImportance = 0.1;
  double LargestMove = 1e6;
  vtkTypeBool JoinSides = 1;
  vtkTypeBool ChangedMask = 1;

  std::vector<std::unique_ptr<Leaf>> Leaves; ///< One a model; null: it has no mesh.
  std::vector<double> MadeWith;              ///< Options of the leaves.
  double Diagonal = 1.0;

  vtkIdType MovedControlPoints = 0;
  vtkIdType UpdatedVertices = 0;
  vtkIdType InsertedVertices = 0;
  vtkIdType DeletedVertices = 0;
  vtkIdType NumberOfTriangles = 0;
  vtkIdType NumberOfPoints = 0;
  vtkIdType RebuiltModels = 0;
  vtkIdType ReplacedFaces = 0;
  vtkIdType RefusedModels = 0;
  vtkIdType CappedCells = 0;
  vtkIdType CrossingFaces = 0, ToldCrossing = 0;
  double ErrorBound = 0.0;
  double ModelGap = 0.0;
  double ToleranceUsed = 0.0;
  double CompareSeconds = 0.0;
  double MoveSeconds = 0.0;
  double AdaptSeconds = 0.0;
  double RebuildSeconds = 0.0;
  double OutputSeconds = 0.0;
};

#endif
