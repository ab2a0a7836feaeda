// SPDX-License-Identifier: BSD-3-Clause
/// @file DeformingEdge.h
/// @brief An edge of a deforming model: one set of vertices that all its faces take.
///
/// A use along a side of a face's grid needs a vertex at every corner of a cell there, and none
/// besides: the cells' errors cover the edge's. Other uses are halved until their pieces are as near
/// to their chords as the tolerance asks for. All faces have the union.
#pragma once

#include "CompletedModel.h"
#include "DeformingFace.h"

namespace nurbs
{

/// Where a face's loop runs along an edge.
struct DeformingUse
{
  std::int32_t Face = -1;
  std::int64_t Curve = -1;
  int Side = -1;                      ///< Of the face's grid, see LoopSegment; -1: inside.
  std::int32_t Ends[2] = { -1, -1 };  ///< The loop's vertices at the edge's start and end.
  std::vector<std::int32_t> Vertices; ///< Of the face's loops, one a vertex of the edge.
};

/// An edge.
class DeformingEdge
{
public:
  /// All faces of the model, by index.
  using Faces = std::vector<std::unique_ptr<DeformingFace>>;

  /// An edge of the model with its uses.
  DeformingEdge(
    const Model& model, std::int64_t edge, std::vector<DeformingUse> uses, const Faces& faces);

  /// Where loops run along it.
  const std::vector<DeformingUse>& Uses() const { return this->Where; }
  /// True if the edge is one point.
  bool IsPole() const { return this->Pole; }
  /// True if some use is not along a side.
  bool HasInner() const { return !this->Pieces.empty(); }
  /// Number of vertices, both ends included.
  std::size_t Vertices() const { return this->T.size(); }
  /// The piece of its own that the segment after a vertex is part of; -1: none.
  std::int32_t PieceAt(std::size_t vertex) const
  {
    return this->PieceOf.empty() ? -1 : this->PieceOf[vertex];
  }

  /// Halves and merges pieces by their errors.
  void Adapt(const Model& model, const Faces& faces, double tolerance, double hysteresis);
  /// True if pieces changed since the last Update.
  bool HasNewPieces() const { return this->PiecesChanged; }
  /// Halves a piece, if it is not very small.
  bool Force(const Model& model, const Faces& faces, std::int32_t piece);
  /// Halves a piece that is bent, for good: loops' polylines cross.
  bool Straighten(const Model& model, std::int32_t piece);
  /// Gives faces and edge the vertices that pieces and cells ask for. Returns whether they changed.
  bool Update(const Model& model, const Faces& faces);
  /// Removes the faces' vertices that are the edge's alone.
  void RemoveVertices(const Faces& faces);
  /// True if a pole's side was a point and is none any more.
  bool HasOpened(const Model& model) const;
  /// The largest bound of a piece's error when it was checked.
  double Error() const { return this->LargestError; }

private:
  struct PieceUse
  {
    ParameterBox Box;
    Vec2 Extent, Bend; ///< Of the chord, and of the curve from it.
    double Up = 0.0, Low = 0.0;
    int Resets = -1;
  };
  struct Piece
  {
    double T0 = 0.0, T1 = 0.0;
    std::int32_t Child = -1; ///< The first of two.
    bool Free = false;
    bool ForGood = false;       ///< Its halves are not merged.
    double ForcedAt = 0.0;      ///< The error with which a face asked for halves; 0: none did.
    std::vector<PieceUse> Uses; ///< One an inner use.
  };
  struct Mark
  {
    double T;
    std::int32_t Use;
    std::int64_t Line;
  };

  Vec2 Parameters(const Model& model, const Faces& faces, std::size_t use, double t) const;
  double ParameterOn(const Model& model, std::size_t use, int direction, double value) const;
  void AddCreases(const Model& model, const Faces& faces, std::vector<double>& breaks) const;
  Piece MakePiece(const Model& model, double t0, double t1) const;
  bool CanSplit(std::int32_t piece) const;
  void Split(const Model& model, std::int32_t piece);
  void AdaptPiece(const Model& model, const Faces& faces, std::int32_t piece, double tolerance,
    double hysteresis);
  bool Errs(const Faces& faces, Piece& piece, double limit, bool above, double& error) const;
  void AddLines(const Model& model, const Faces& faces, std::vector<Mark>& marks) const;
  void AddPieces(std::int32_t piece, std::vector<Mark>& marks) const;
  void SetVertices(const Model& model, const Faces& faces, const std::vector<double>& t,
    const std::vector<std::vector<std::int64_t>>& lines);

  Interval Domain;
  bool IsPoint(const Model& model, const DeformingUse& use) const;

  std::int64_t PoleVertex = -1;
  std::vector<char> WasPoint; ///< A pole's uses along sides.
  bool Pole = false;
  std::vector<DeformingUse> Where;
  std::vector<std::size_t> Inner; ///< Uses that are not along sides.
  std::vector<Piece> Pieces;      ///< First those that nothing is coarser than.
  std::size_t Roots = 0;
  std::vector<std::int32_t> FreePairs;
  std::vector<double> T;                          ///< Of its vertices, ascending.
  std::vector<std::vector<std::int64_t>> LinesAt; ///< Of each vertex and use; -1: no line of cells.
  std::vector<std::int32_t> PieceOf;
  bool PiecesChanged = true;
  double LargestError = 0.0;
};

} // namespace nurbs
