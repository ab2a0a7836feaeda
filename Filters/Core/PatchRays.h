// SPDX-License-Identifier: BSD-3-Clause
/// @file PatchRays.h
/// @brief All intersections of a ray with rational Bezier patches, in double precision.
///
/// A point of the surface lies on a ray if it lies on two planes through it, so that a hit is a
/// root of g(s) = (N1 . H(s), N2 . H(s)), H the homogeneous patch and N1, N2 the planes (Kajiya
/// 1982). g is itself a patch, of two components. Where its derivative varies little over a piece
/// of the patch, Krawczyk's operator s - Y g(s) (Krawczyk 1969) tells that the piece has no root,
/// or at most one, which Newton's method finds from there; elsewhere the piece is halved, and left
/// out once its control points lie on one side of a plane through the ray (Nishita, Sederberg,
/// Kakimoto 1990 clip there; halving costs the same for curved patches and never stalls).
///
/// For speed, patches are cut in advance into cells, over which the surface's derivatives turn by
/// some ten degrees. A cell keeps its tangent plane and a bound on how much it varies, which is all
/// that most rays need: the first test is a 2 x 2 linear system.
#pragma once

#include "Bezier.h"

namespace nurbs
{

class CellTrees;
class PatchCutter;
struct Model;
class TrimIndex;
struct PatchPoint;
struct RootPiece;

/// A rectangle of a patch's parameters, which are 0 to 1 for all of it.
struct PatchPiece
{
  double Low[2] = { 0.0, 0.0 };
  double High[2] = { 1.0, 1.0 };
};

/// A ray and two planes that meet in it.
struct RayPlanes
{
  Vec3 Origin;
  Vec3 Direction;      ///< Of unit length.
  Vec3 Normal[2];      ///< Unit normals of the planes, orthogonal to each other.
  Vec4 Homogeneous[2]; ///< Normal and offset: positive on the side that the normal points to.

  /// The direction need not have unit length.
  RayPlanes(const Vec3& origin, const Vec3& direction);
};

/// An intersection of a ray with a patch.
struct PatchHit
{
  std::int32_t Patch;
  double UV[2]; ///< The surface's parameters, in the patch's part of the domain.
  Vec3 Point;
  Vec3 Su, Sv;   ///< Derivatives with respect to UV.
  bool IsInside; ///< Surely not trimmed away; if false, that is not known.
  bool Singular; ///< The ray touches the surface or meets a pole: Su, Sv and it are dependent.
};

/// The patches of the surfaces of a model. Constant once built, and safe to use from many threads.
class PatchRays
{
public:
  /// Cuts the surfaces of the model's faces; one without a control net has no patches. What is
  /// trimmed away is left out, if it is farther than `reach` (a length for each face) from what is
  /// not. Faces are independent of each other, the result does not depend on `parallel`. Copies
  /// what it needs.
  void Build(const Model& model, const TrimIndex& trims, const std::vector<double>& reach,
    const ParallelFor& parallel);

  /// Takes the patches only, of a forest that makes their cells when they are needed: its boxes become
  /// Boxes(), its bounds Bounds().
  void Build(const Model& model, const CellTrees& forest);
  /// Diagonal of the box of all control points, as patches are cut for, and what evaluating may err by.
  static void Measure(const Model& model, double& size, double& rounding);

  /// Cells of all patches.
  std::int64_t CellCount() const { return static_cast<std::int64_t>(this->Cells.size()); }
  /// Patches of all faces.
  std::int64_t PatchCount() const { return static_cast<std::int64_t>(this->Patches.size()); }

  /// The boxes of the cells.
  const std::vector<Box3>& Boxes() const { return this->CellBoxes; }
  /// Forgets them; whoever asked for them has a tree by now.
  void ReleaseBoxes() { std::vector<Box3>().swap(this->CellBoxes); }

  /// The box of the cells' control points, empty if there are none.
  const Box3& Bounds() const { return this->Box; }

  /// The face of a patch.
  std::int32_t FaceOf(std::int32_t patch) const { return this->Patches[patch].Face; }
  /// The face of a cell.
  std::int32_t FaceOfCell(std::int32_t cell) const { return this->FaceOf(this->Cells[cell].Patch); }

  /// A part of a patch that is nearly flat.
  struct Cell
  {
    Vec3 Middle; ///< The point in the middle of its parameters.
    Vec3 D[2];   ///< Derivatives there with respect to the cell's own parameters in [0, 1].
    /// Bounds on how far the surface's derivatives (of u and v; last index) differ from D:
    /// coordinates along D[0], D[1] (first index) and along their cross product.
    float Along[2][2];
    float Across[2];
    float Radius;          ///< Of a ball around Middle that holds the cell.
    float Low[2], High[2]; ///< The cell's part of the patch, exact (dyadic).
    std::int32_t Patch;
    bool IsWhole; ///< Nothing of it is trimmed away.
  };

  /// A cell by its index.
  const Cell& CellAt(std::int32_t cell) const { return this->Cells[cell]; }

  /// Appends the intersections of the whole line (not only t >= 0) with a cell. One on the border
  /// of cells, or within rounding of it, is found by each of them. Where a ray runs within the
  /// surface along a curve, it has no intersections.
  void Intersect(const Cell& cell, const RayPlanes& ray, std::vector<PatchHit>& hits) const;

  /// Distances below this are rounding.
  double GetRounding() const { return this->Rounding; }

  /// Bytes occupied.
  std::size_t MemoryUse() const;

private:
  friend class PatchCutter;
  friend class CellTrees;

  struct Patch
  {
    std::int32_t Degree[2];
    std::int32_t Face;
    std::int64_t First; ///< Of its (Degree[0] + 1) x (Degree[1] + 1) control points in Points.
    Interval Domain[2];
  };

  void Join(std::vector<PatchCutter>& cut);
  PatchPoint Evaluate(std::int32_t patch, const Vec2& at) const;
  void Search(const Cell& cell, const RayPlanes& ray, std::vector<PatchHit>& hits) const;
  void Polish(const Cell& cell, const RayPlanes& ray, const RootPiece& root,
    std::vector<PatchHit>& hits) const;
  void Touch(const Cell& cell, const RayPlanes& ray, const PatchPiece& piece,
    std::vector<PatchHit>& hits) const;
  void AddHit(const Cell& cell, const Vec2& at, bool singular, std::vector<PatchHit>& hits) const;

  std::vector<Patch> Patches;
  std::vector<Vec4> Points; ///< Homogeneous; the largest weight of a patch is 1.
  std::vector<Cell> Cells;
  std::vector<Box3> CellBoxes;
  Box3 Box;
  double Size = 0.0;     ///< Diagonal of Box; while cells are made, of all control points.
  double Rounding = 0.0; ///< What evaluating a point may err by.
};

} // namespace nurbs
