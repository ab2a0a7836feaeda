// SPDX-License-Identifier: BSD-3-Clause
/// @file DeformingModel.h
/// @brief The triangles of a trimmed model whose control points move: updated, not made again.
///
/// Source: F. W. B. Li, R. W. H. Lau, M. Green, "Interactive rendering of deforming NURBS surfaces",
/// Computer Graphics Forum 16 (1997). Where and why we differ: Documentation/Papers/li-1997.md.
#pragma once

#include "DeformingEdge.h"

namespace nurbs
{

/// Who looks, for section 5: patches count the less, the farther they are from the eye and from the
/// line of sight.
struct MeshViewer
{
  Vec3 Eye = Vec3::Zero();
  Vec3 Direction = -Vec3::UnitZ(); ///< Unit: the line of sight.
  bool Parallel = false;           ///< Distance does not count.
  double FullDetail = 1.0;         ///< Patches up to this distance count in full; > 0.
  double SightAngle = 0.26;        ///< Radians from the line of sight up to which they do; > 0.
  double LeastImportance = 0.1;    ///< Of patches far beside it; (0, 1].

  /// I_dist times I_sight, in (0, 1].
  double Importance(const Vec3& place) const;
};

/// Options of DeformingModel.
struct DeformingOptions
{
  double Tolerance = 0.0;  ///< Model units, > 0: bound of the distance of triangles and surface.
  double Hysteresis = 0.5; ///< Cells are merged if that keeps them within this share of it; (0, 1].
  bool Refine = true;      ///< Else the cells of the first frame stay.
  /// >= 0, <= 12: each patch is halved so often in u and v, whatever it errs; loops keep the tolerance.
  int FixedDepth = -1;
  bool KeepCoefficients = true; ///< Of vertices on loops: stored, or computed when needed.
  std::int64_t MemoryLimit = std::int64_t(1) << 30; ///< Bytes of sums, see PatchVertices.h.
  std::int64_t TriangleBudget = 0; ///< 0: none. One too small is kept as nearly as can be.
  double LargestMove = 1e6;        ///< Sizes of the model that a control point may move by; > 0.
  double SideTolerance = -1.0;     ///< See CompleteModel.
  ParallelFor Parallel = SerialFor;
};

/// What a frame took.
struct FrameReport
{
  bool Accepted = true;
  std::string Problem;           ///< Why the frame was refused; names the control point.
  bool NeedsReplacement = false; ///< It was, as a pole opened: call for a new DeformingModel.
  std::int64_t MovedControlPoints = 0, UpdatedVertices = 0;
  std::int64_t InsertedVertices = 0, DeletedVertices = 0;
  bool TopologyChanged = false;
  std::int64_t FirstTriangle = -1, LastTriangle = -1; ///< That changed; -1: none.
  double ErrorBound = 0.0; ///< Model units; without Refine: of the frame in which cells were made.
  double ModelGap = 0.0;   ///< Largest distance between faces at the vertices of shared edges.
  double ToleranceUsed = 0.0; ///< Of a patch that counts in full: larger if there is a budget.
  std::int64_t CrossingFaces =
    0; ///< Whose loops' polylines cross: their mesh may lack or exceed parts.
  std::int64_t CappedCells = 0; ///< That err by more and are as small as cells become.
  double CompareSeconds = 0.0, MoveSeconds = 0.0, AdaptSeconds = 0.0, RebuildSeconds = 0.0;
};

/// A deforming model. Not for several threads at once; what it does itself is spread over them, with
/// the same result for any number.
class DeformingModel
{
public:
  /// Makes the first mesh in `mesh`, which must outlive this and not be changed by others.
  /// @param faceErrors one string a face: "" or why it can't be used (it has no triangles).
  /// The model's knots and trims must stay valid. Throws Error unless the options are in their ranges
  /// and faces have no more than 65,535 spans in a direction.
  DeformingModel(const Model& model, const std::vector<std::string>& faceErrors,
    const DeformingOptions& options, MeshArrays& mesh);
  ~DeformingModel();

  /// Follows the control points and weights of `model`, which is the first one but for them. A frame
  /// with a control point that is not finite, moved by more than LargestMove or has a weight <= 0, or
  /// with all control points of a face in one place, is refused as a whole: the mesh stays.
  FrameReport Update(const Model& model, const MeshViewer* viewer = nullptr);
  /// Makes the faces that are marked anew, whose knots or trims changed, and keeps the others; the edges
  /// between them follow. Control points of those that stay are for the next Update. Returns false, and does nothing, if the models' topologies differ: a new
  /// DeformingModel is called for then. Otherwise FirstFrame tells what it did.
  bool Replace(const Model& model, const std::vector<std::string>& faceErrors,
    const std::vector<char>& changed);
  /// What the constructor (or Replace) did.
  const FrameReport& FirstFrame() const { return this->Report; }
  /// True for points that the last frame moved or added; one a point of the mesh.
  std::vector<unsigned char> ChangedPoints() const;
  /// Why a face has no triangles although it was given without an error; one a face, "" if it has.
  const std::vector<std::string>& FaceProblems() const { return this->Problems; }
  /// Memory of H, H_u, H_v of all vertices.
  std::int64_t BytesOfSums() const;
  /// A face; null if it can't be used.
  const DeformingFace* GetFace(std::int64_t face) const { return this->Faces[face].get(); }

private:
  struct Corner
  {
    std::int32_t Face, Vertex;
  };

  void Measure(const std::vector<std::string>& faceErrors);
  void MakeFaces(const std::vector<char>& marked, const std::vector<std::string>& faceErrors);
  void MakeFace(std::int32_t face);
  void MakeCorner(std::int32_t face, std::int64_t curve);
  void MakeEdges();
  void RemoveFaces(const std::vector<char>& marked);
  bool HasOpenPole(const Model& model) const;
  std::string Check(const Model& model) const;
  void Adapt(const MeshViewer* viewer, bool everything, double hysteresis);
  void KeepBudget(const MeshViewer* viewer);
  std::int64_t EstimateTriangles() const;
  void Rebuild(const MeshViewer* viewer);
  void UpdateEdges(const MeshViewer* viewer, bool adapt);
  void MakeLoops(std::int32_t face, bool inside);
  bool IsTouched(const DeformingEdge& edge) const;
  bool Honour(const RefinementRequests& requests);
  void Share(bool measure);
  void ForFaces(const std::function<void(std::int64_t)>& f);
  void SumErrors();
  void Finish();
  bool Refines() const { return this->Options.Refine && this->Options.FixedDepth < 0; }
  double Scale(const MeshViewer* viewer, const Vec3& place) const;

  DeformingOptions Options;
  CompletedModel Data;
  MeshSlots Slots;
  DeformingEdge::Faces Faces;                        ///< Null: can't be used.
  std::vector<std::unique_ptr<DeformingEdge>> Edges; ///< Null: not used.
  std::vector<std::vector<std::int32_t>> EdgesOf;    ///< Of each face.
  std::vector<std::int32_t> CornerOf;         ///< Loop vertex where a trim curve's way begins.
  std::vector<std::vector<Corner>> CornersAt; ///< Of each vertex of the model.
  std::vector<int> UseOf;                     ///< Of each trim curve in its edge.
  std::vector<char> FaceTouched, EdgeChanged;
  double Coarsening = 1.0;     ///< Of all tolerances, for the budget's sake.
  double BytesOfControl = 0.0; ///< A control point's share of MemoryLimit.
  double Size = 0.0;           ///< Of the first frame's control points.
  bool HadViewer = false;
  bool Making = true;               ///< The frame makes cells, even if others do not.
  std::vector<std::int32_t> Shared; ///< Points that the frame moved to others'.
  std::vector<double> GapAt;        ///< Of vertices, then of edges: distance of the faces there.
  FrameReport Report;
  std::vector<std::string> Problems;
  std::vector<double> FaceError;
  std::vector<std::int64_t> FaceCapped;
};

} // namespace nurbs
