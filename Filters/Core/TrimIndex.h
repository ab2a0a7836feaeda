// SPDX-License-Identifier: BSD-3-Clause
/// @file TrimIndex.h
/// @brief Is a point of a face's (u, v) domain inside its trimming loops? Exact, at any zoom.
///
/// Source: Schollmeyer and Froehlich, Direct Trimming of NURBS Surfaces on the GPU, 2009: curves are
/// cut into pieces monotone in u and v (TrimPieces.h), found through a search structure, and a point
/// is decided by a piece's box, else by bisection of the piece. The structure is ours: a k-d tree
/// whose cells know what lies to their right, so that a query looks at the pieces of one cell only
/// (TrimTree.h). It becomes two texture buffers that nurbsTrim.glsl reads; FaceTrim::Inside takes the
/// same steps in double precision.
///
/// What counts as inside: the even-odd rule over all loops of the face. For loops that do not cross,
/// whichever way they run, that is what the tessellator triangulates (LoopRepair.h turns loops by
/// their depth of nesting). Where loops cross, the two differ in what is wound around twice or only
/// by a hole: the tessellator keeps what a loop winds around twice, unites loops that overlap and
/// ignores the part of a hole beyond the other loops; here these parts are outside, outside and inside.
///
/// The domain's border belongs to the face where a loop runs along it, and points beyond it count as
/// the nearest ones of the domain: a rasteriser's rounding trims nothing there. Otherwise, of a
/// boundary that runs along u or v, the lower side belongs to the face and the upper one does not.
#pragma once

#include "TrimTree.h"

namespace nurbs
{

/// The trimmed domain of one face. Owns all that it needs; safe to query from many threads.
class FaceTrim
{
public:
  /// A face without loops: everything is inside.
  FaceTrim() = default;

  /// The loops of a face of `model`. Nothing is inside if the face has no control net (what
  /// AssembleModel leaves of a face that is wrong) or its loops enclose nothing.
  /// O(n log^2 n) for n pieces. Throws Error if a coordinate is not finite or there are more than
  /// MaxPointTexels of data.
  FaceTrim(const Model& model, std::int64_t face);

  /// True if (u, v), in the face's parameters, is inside. NaN: false.
  bool Inside(double u, double v) const
  {
    int visited = 0;
    return this->Inside(u, v, visited);
  }
  /// The same; `visited` receives the number of pieces that were looked at.
  bool Inside(double u, double v, int& visited) const;

  /// True if all of the domain is inside: no texels are needed, TrimTexels gives no start.
  bool IsWhole() const { return this->Root == TrimTree::AllInside; }

  /// Number of monotone pieces that the structure refers to.
  std::int64_t PieceCount() const { return static_cast<std::int64_t>(this->Pieces.size()); }

  /// Size in texels of 16 bytes of the face's part of TrimTexels; both 0 if IsWhole.
  std::int64_t PointTexelCount() const;
  /// Likewise.
  std::int64_t RecordTexelCount() const;
  /// Writes that part: 4 values a texel. `pointStart` is the index that the first point texel will
  /// have in its buffer; nothing else depends on the place of the two parts.
  void WriteTexels(std::int32_t pointStart, float* points, std::int32_t* records) const;

  /// The largest part of a face in the point texels (what one integer of a record can address).
  static constexpr std::int64_t MaxPointTexels = std::int64_t(1) << 23;

private:
  bool Locate(double u, double v, Vec2& p, std::int32_t& child) const;

  Interval U, V;
  std::int32_t Root = TrimTree::AllInside; ///< A child, as those of nodes.
  std::vector<TrimTree::Node> Nodes;
  std::vector<TrimPiece> Pieces;
  std::vector<Vec3> Inner;          ///< What TrimPiece::FirstInner points into.
  std::vector<std::int32_t> Leaves; ///< As in the record texels, but with piece numbers.
};

/// The trimmed domains of all faces of a model.
class TrimIndex
{
public:
  TrimIndex() = default;

  /// Faces are independent of each other; the result does not depend on `parallel`. Throws what
  /// FaceTrim throws for the first face that does.
  explicit TrimIndex(const Model& model, const ParallelFor& parallel = SerialFor);

  /// True if (u, v), in the face's parameters, is inside the face.
  bool Inside(std::int64_t face, double u, double v) const
  {
    return this->Faces[static_cast<std::size_t>(face)].Inside(u, v);
  }

  /// One face; what FaceTrim(model, face) makes anew after a change.
  const FaceTrim& Face(std::int64_t face) const
  {
    return this->Faces[static_cast<std::size_t>(face)];
  }
  /// Faces of the model.
  std::int64_t FaceCount() const { return static_cast<std::int64_t>(this->Faces.size()); }

  /// Replaces one face by what its loops in `model` are now.
  void Rebuild(const Model& model, std::int64_t face);

private:
  std::vector<FaceTrim> Faces;
};

/// The index as the two buffers of nurbsTrim.glsl.
struct TrimTexels
{
  std::vector<float> Points;            ///< RGBA32F, 4 a texel.
  std::vector<std::int32_t> Records;    ///< RGBA32I, 4 a texel.
  std::vector<std::int32_t> FaceStart;  ///< A face's first record texel; -1: IsWhole.
  std::vector<std::int32_t> PointStart; ///< A face's first point texel; -1: IsWhole.
};

/// Writes all faces one after the other. Throws Error if a buffer would exceed 2^31 - 1 texels.
TrimTexels Flatten(const TrimIndex& index);

} // namespace nurbs
