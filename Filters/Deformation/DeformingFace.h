// SPDX-License-Identifier: BSD-3-Clause
/// @file DeformingFace.h
/// @brief One face of a deforming model: its cells, their vertices, and what follows from a move.
///
/// Cells that no loop touches have triangles of their own, of their corners and of those of their
/// neighbours on their sides: as all vertices are on the surface and both sides of a line have the same
/// ones, there are no cracks to prevent (Li, Lau, Green 1997, section 4.3, move vertices onto their
/// coarser neighbours' sides). What lies between these cells and the loops is the zone, a constrained
/// Delaunay triangulation (FaceZone.cxx). Cells along a side of the grid take the vertices of the edge
/// that runs there.
#pragma once

#include "CellForest.h"
#include "MeshSlots.h"
#include "PatchErrors.h"
#include "PatchVertices.h"
#include "ZoneTriangulation.h"

#include <algorithm>
#include <memory>
#include <string>

namespace nurbs
{

/// A vertex of a face's loops.
struct LoopVertex
{
  Vec2 UV = Vec2::Zero();
  std::int32_t Patch = -1;
  std::int32_t Point = -1;           ///< In the mesh; -1: not in use.
  std::int64_t Line[2] = { -1, -1 }; ///< The grid's lines that it is on.
  std::int64_t Vertex = -1;          ///< Of the model; all at one have one place.
};

/// A piece of a loop, from one vertex to the next.
struct LoopSegment
{
  std::int32_t A = -1, B = -1; ///< Loop vertices, along the loop.
  std::int32_t Edge = -1;
  std::int32_t Piece = -1; ///< Of the edge; -1: none of its own.
  int Side = -1;           ///< Of the grid: 0 first v, 1 last u, 2 last v, 3 first u; -1: inside.
};

/// A cell that has to be narrower in one direction.
struct CellRequest
{
  std::int64_t I, J; ///< A place in the cell, by lines.
  int Direction;
  double Extent; ///< That it should have at most.
};
/// What has to be finer, as triangles of the zone err by too much.
struct RefinementRequests
{
  std::vector<CellRequest> Cells;
  std::vector<std::pair<std::int32_t, std::int32_t>> Pieces; ///< Edge, its piece.
  /// Likewise, of loops that cross.
  std::vector<std::pair<std::int32_t, std::int32_t>> Crossing;
};

/// How a face follows.
struct FaceOptions
{
  double Tolerance = 0.0;
  bool Refine = true;
  int FixedDepth = -1;                  ///< >= 0: every patch is halved so often in u and in v.
  std::int64_t MaximumLeaves = 1000000; ///< Cells; beyond, they are not halved.
  bool KeepCoefficients = true;         ///< Of loop vertices.
  std::int64_t MaximumSums = 0; ///< Bytes for H, H_u, H_v; beyond, vertices are evaluated afresh.
};

/// A face. Not to be copied or moved: its parts refer to each other.
class DeformingFace
{
public:
  /// Without vertices and triangles as yet. `used`: the box of the loops; `index`: of the face.
  DeformingFace(const SurfaceView& surface, bool reversed, const ParameterBox& used,
    std::int32_t index, MeshSlots& slots, const FaceOptions& options);
  DeformingFace(const DeformingFace&) = delete;
  DeformingFace& operator=(const DeformingFace&) = delete;

  /// The lines that cells are cut along.
  const FaceGrid& Grid() const { return this->Lines; }
  /// The part of the domain that loops use.
  const ParameterBox& Used() const { return this->Box; }
  /// The cells.
  const CellForest& Cells() const { return this->Forest; }
  /// Where the list of a cell's triangles starts; cell -1: the zone's.
  std::int32_t& FirstTriangle(std::int32_t cell)
  {
    return cell < 0 ? this->ZoneHead : this->Forest[cell].Triangles;
  }

  // A frame, in this order.

  /// Compares the control points with those of the last frame. Returns how many have moved.
  std::int64_t Compare(const SurfaceView& surface);
  /// Why those that moved can't be used, with the point's number; "" if they can.
  /// @param largestMove of a control point.
  /// @param onePlace extent of control points that are all in one place.
  std::string Check(const SurfaceView& surface, double largestMove, double onePlace) const;
  /// True if the last Move changed any vertices.
  bool HasMoved() const { return !this->Touched.empty(); }
  /// Takes the new control points and updates all vertices that depend on those that moved; returns
  /// how many did. For one thread a face.
  std::int64_t Move(const SurfaceView& surface);
  /// Halves and merges cells of the patches that moved; `scale(place)` times the tolerance is theirs,
  /// and `hysteresis` times that what merged cells may err by. For one thread a face.
  void Adapt(const std::function<double(const Vec3&)>& scale, bool everything, double hysteresis);

  /// Tells whole patches that are outside the loops, whose cells need not be small. To be called once,
  /// with the first loops.
  void ClassifyPatches();
  /// Adapts patches with cells that were outside the loops until the last Rebuild, or else may err by
  /// too much. `last`: they are only measured, as nothing will be built any more.
  void AdaptLate(bool last);
  /// Halves a cell for the zone's sake.
  void Force(const CellRequest& request);
  /// Takes the same control points in another place.
  void SetSurface(const SurfaceView& surface) { this->Surface = surface; }
  /// True if cells along a side were halved or merged since the last Rebuild.
  bool HasNewOnSide(int side) const { return this->NewOnSide[side]; }
  /// True if cells were halved or merged since the last Rebuild.
  bool HasNewCells() const { return !this->Fresh.empty() || !this->Retired.empty(); }
  /// The leaves' lines along a side of the grid, ascending.
  void SideLines(int side, std::vector<std::uint32_t>& lines) const;

  /// Removes all points and triangles.
  void Clear();

  // Loop vertices, by those who know the edges.

  /// Returns its number. `modelVertex` -1: it is at none.
  std::int32_t AddLoopVertex(const Vec2& uv, std::int64_t modelVertex);
  /// Its number may be given to another one.
  void RemoveLoopVertex(std::int32_t vertex);
  /// A vertex of the loops.
  const LoopVertex& GetLoopVertex(std::int32_t vertex) const { return this->LoopVertices[vertex]; }
  /// Says which line of the grid across a side a vertex on that side is on; -1: none.
  void SetLine(std::int32_t vertex, int side, std::int64_t line);
  /// Knots inside the used part where the surface may not be smooth.
  const std::vector<double>& Creases(int direction) const { return this->CreaseLines[direction]; }
  /// Where a loop vertex is on this face's surface.
  Vec3 PlaceOf(std::int32_t vertex) const;
  /// Replaces the loops. `inside`: pieces that are not along sides changed.
  void SetLoops(std::vector<std::vector<LoopSegment>> loops, bool inside);
  /// Evaluates loop vertices that were added since.
  void EvaluateLoopVertices();
  /// True if loops or sides changed since the last Rebuild.
  bool HasNewLoops() const { return this->LoopsChanged || this->SidesChanged; }

  /// Triangles of all that changed. For one thread a model.
  void Rebuild(RefinementRequests& requests);
  /// Renumbers the points, see MeshSlots::Compact.
  void Renumber(const std::vector<std::int32_t>& places);

  /// Bounds over any box of the used part, of |S_uu|, |S_uv|, |S_vv| and of |S_u|, |S_v|.
  SecondBound Second(const ParameterBox& box);
  /// Likewise.
  Vec2 First(const ParameterBox& box);
  /// Sums over all frames of the largest of these of all moves; see PatchErrors.h. Infinite after a
  /// frame in which weights changed.
  const SecondBound& MovedSecond() const { return this->SumSecond; }
  /// Likewise.
  const Vec2& MovedFirst() const { return this->SumFirst; }
  /// Counts the frames after which nothing that was known of errors holds any more.
  int Resets() const { return this->ResetCount; }

  /// Bound of the distance between the triangles and the surface; the largest since cells were checked.
  double ErrorBound() const;
  /// Cells that cannot be halved any more although they err by more than the tolerance.
  std::int64_t CappedCells() const;
  /// True if polylines of the loops crossed in the last Rebuild.
  bool HasCrossingLoops() const { return this->Crossing; }
  /// Asks for all pieces of the loops to be halved.
  void RequestLoops(RefinementRequests& requests) const;
  /// Of the cells that there are now, without those that their neighbours' vertices add.
  std::int64_t EstimateTriangles() const;
  /// Calls f(point) for every point that the last move changed.
  template <typename F>
  void ForMoved(const F& f) const
  {
    for (const int patch : this->Touched)
    {
      std::for_each(this->Patches[patch].Vertices.Points.begin(),
        this->Patches[patch].Vertices.Points.end(), f);
    }
    for (const LoopVertex& vertex : this->LoopVertices)
    {
      if (vertex.Point >= 0 && this->Patches[vertex.Patch].Touched)
      {
        f(vertex.Point);
      }
    }
  }
  /// Memory of H, H_u, H_v.
  std::int64_t BytesOfSums() const { return this->SumBytes; }

private:
  struct Patch
  {
    PatchVertices Vertices;
    FlatIndex PointAt; ///< By lines, see Key; loop vertices, too.
    SecondBound Moved; ///< Sums over frames, see PatchErrors.h.
    double Tolerance = 0.0;
    double Error = 0.0;      ///< Bound of its cells'.
    std::int64_t Capped = 0; ///< Cells that err by more and are as small as cells become.
    BezierNet Net;
    double Shortest[2] = { 0.0, 0.0 }; ///< See ShortestDerivatives.
    bool HasNet = false;               ///< Net is that of the present control points.
    bool Touched = false;              ///< By the last move.
    bool Recheck = true;               ///< Nothing is known of its cells' errors.
    std::size_t Evaluated = 0;         ///< Vertices from here on are new.
  };

  // DeformingFace.cxx: control points and vertices.
  void Gather(int patch, const std::vector<Vec4>& from, std::vector<Vec4>& net) const;
  BezierNet& NetOf(int patch);
  void Remember(const SurfaceView& surface);
  void MarkPatches();
  void SumMove(int patch, SecondBound& second, Vec2& first);
  std::int64_t MovePatch(int patch);
  void UpdatePatch(int patch, PatchUpdate& update, std::size_t begin, const Vec4* control);
  std::int64_t MoveLoopVertices();
  std::size_t CoefficientCount() const
  {
    return 2 * std::size_t(this->Lines.Axis[0].Degree() + this->Lines.Axis[1].Degree() + 2);
  }
  void EvaluateCoefficients(std::int32_t vertex, double* to) const;
  void SumLoopVertex(std::int32_t vertex, Vec4 (&h)[3], double (*shortest)[2]) const;
  void EvaluateLoopVertex(std::int32_t vertex);
  void EvaluateNew();
  void MendNormal(std::int32_t point);

  // DeformingCells.cxx: the cells and their triangles.
  struct BoundaryVertex
  {
    std::int32_t Point;
    std::uint32_t I, J;
    int Side; ///< That starts with it or has it inside; see LoopSegment.
  };
  void AdaptPatch(int patch);
  void HalveEvenly(std::int32_t cell);
  void AdaptCell(std::int32_t cell, double a, double b, NetPath& path);
  void AdaptHalves(std::int32_t cell, double a, double b, NetPath& path);
  int DirectionOf(std::int32_t cell, const SecondBound& scaled) const;
  void MergeCell(std::int32_t cell);
  bool CanSplit(std::int32_t cell, int direction) const;
  void MarkSides(const Cell& cell);
  void SplitCell(std::int32_t cell, int direction);
  std::uint64_t Key(std::uint32_t i, std::uint32_t j) const { return std::uint64_t(i) << 32 | j; }
  void Corner(const Cell& cell, int k, std::uint32_t& i, std::uint32_t& j) const;
  FlatIndex& TableOf(std::uint32_t i, std::uint32_t j)
  {
    const int column = this->Lines.Axis[0].ColumnOf(i);
    return this->Patches[this->Lines.Patch(column, this->Lines.Axis[1].ColumnOf(j))].PointAt;
  }
  std::int32_t PointAt(std::uint32_t i, std::uint32_t j) const
  {
    const int column = this->Lines.Axis[0].ColumnOf(i);
    return this->Patches[this->Lines.Patch(column, this->Lines.Axis[1].ColumnOf(j))].PointAt.Find(
      this->Key(i, j));
  }
  std::int32_t Acquire(std::int32_t near, std::uint32_t i, std::uint32_t j);
  void Release(std::int32_t near, std::int32_t point);
  void AcquireCorners(std::int32_t cell);
  void Retire(std::int32_t cell);
  void MarkAround(std::int32_t near, std::uint32_t i, std::uint32_t j);
  bool IsOnSide(const Cell& cell, int side) const;
  bool FindChain(const Cell& cell, int side, std::vector<std::int32_t>& segments) const;
  bool TakesSides(const Cell& cell) const;
  void MarkDirty(std::int32_t leaf);
  void AppendInner(std::uint32_t i0, std::uint32_t j0, std::uint32_t i1, std::uint32_t j1,
    std::vector<BoundaryVertex>& out) const;
  void Boundary(const Cell& cell, std::vector<BoundaryVertex>& out) const;
  bool IsFlat(std::int32_t a, std::int32_t b, std::int32_t c);
  void AddTriangle(std::int32_t cell, std::int32_t a, std::int32_t b, std::int32_t c);
  void PlaceInSquare(const ParameterBox& box, const std::vector<BoundaryVertex>& boundary,
    std::vector<Vec2>& places) const;
  void BuildCell(std::int32_t leaf);

  // LeafStates.cxx: which cells the loops leave whole. FaceZone.cxx: the zone.
  using GridVertex = std::pair<std::uint32_t, std::uint32_t>;
  using Wall = std::array<std::int32_t, 2>;
  void ClassifyLeaves();
  void Classify(std::int32_t leaf, bool cut, bool inside);
  std::vector<std::int32_t> LeavesToClassify() const;
  void Unregister(const LoopVertex& vertex);
  std::vector<char> CutCells() const;
  void MarkCut(std::int32_t cell, const Vec2& a, const Vec2& b, std::vector<char>& cut) const;
  bool IsInside(const Vec2& uv) const;
  std::vector<char> AreInside(const std::vector<Vec2>& uv) const;
  bool IsClear(const Vec2& uv, const Vec2& scale) const;
  std::vector<GridVertex> AcquireZone();
  void BuildZone(RefinementRequests& requests);
  void AddWalls(std::vector<Wall>& walls);
  void AddWallsOf(std::int32_t leaf, std::vector<Wall>& walls);
  Vec2 CellScale(const GridVertex& vertex) const;
  bool IsBesideZone(std::int32_t leaf) const;
  std::int32_t NearestPoint(
    const std::vector<std::int32_t>& points, const Vec2& place, const Vec2& scale) const;
  double ToleranceAt(const ParameterBox& box) const;
  bool IsInZone(const Vec2& place, int direction) const;
  bool RequestPiece(std::int32_t a, std::int32_t b, RefinementRequests& requests) const;
  Vec2 ZoneScale();
  void AddCreases(const std::vector<std::int32_t>& points, Zone& zone) const;
  void CheckZone(RefinementRequests& requests, bool everything);
  void RequestFor(std::size_t triangle, RefinementRequests& requests);

  const std::int32_t Index;
  MeshSlots& Slots;
  const FaceOptions Options;
  const bool Reversed;
  const ParameterBox Box;
  SurfaceView Surface;
  FaceGrid Lines;
  CellForest Forest;
  std::int64_t LeafCount = 0;
  bool Rational = false;
  std::vector<double> Places;        ///< Control points, as they were given last.
  std::vector<Vec4> Control, Change; ///< Homogeneous; what a move changes.
  std::vector<std::int32_t> MovedPoints;
  std::vector<int> Touched; ///< Patches.
  bool WeightsMoved = false;
  std::int64_t SumBytes = 0; ///< Of H, H_u, H_v.
  std::vector<Patch> Patches;
  std::vector<double> CreaseLines[2];
  double MergeShare = 0.5; ///< Of the tolerance, for merged cells.
  bool Frozen = false;     ///< Cells are measured, and stay.
  SecondBound SumSecond;
  Vec2 SumFirst = Vec2::Zero();
  int ResetCount = 0;

  std::vector<std::int32_t> PatchesWithNew;
  std::vector<std::int32_t> Fresh;   ///< New leaves.
  std::vector<std::int32_t> Late;    ///< Patches for AdaptLate.
  std::vector<std::int32_t> Retired; ///< Cells that are leaves no more.
  std::vector<std::int32_t> RetiredPairs;
  std::vector<std::int32_t> Dirty; ///< Leaves whose triangles have to be made again.
  bool NewOnSide[4] = { false, false, false, false };

  std::vector<LoopVertex> LoopVertices;
  std::vector<std::int32_t> FreeLoopVertices, NewLoopVertices;
  std::vector<double>
    Coefficients; ///< Of loop vertices, as many as in the basis of both directions.
  std::vector<std::vector<LoopSegment>> Loops;
  std::vector<const LoopSegment*> SegmentFrom; ///< That starts at a loop vertex; null: none.
  struct SideSegment
  {
    double Start = 0.0;     ///< Parameter along the side.
    std::int64_t Line[2];   ///< The grid's at its ends, ascending; -1: none.
    std::int32_t Vertex[2]; ///< Of the loop.
    std::int32_t A, B;      ///< Points, along the loop.
    bool Taken = false;     ///< It is a side of a cell.
  };
  std::vector<SideSegment> Sides[4]; ///< Ascending.
  bool HasInnerPieces = false;
  bool LoopsChanged = false, SidesChanged = false;

  bool ZoneChanged = false;
  std::int32_t ZoneHead = -1;
  std::vector<GridVertex> ZoneVertices;
  struct ZoneTriangle
  {
    std::array<std::int32_t, 3> Points;
    ParameterBox Box;
    std::int32_t Patch; ///< -1: in more than one.
    int Resets;
    double Up; ///< As of cells.
  };
  std::vector<ZoneTriangle> Zones;
  double ZoneError = 0.0;
  std::int64_t CappedTriangles = 0;
  bool Crossing = false;
};

} // namespace nurbs
