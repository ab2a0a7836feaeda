// SPDX-License-Identifier: BSD-3-Clause
/// @file PatchCutter.h
/// @brief Cuts patches into nearly flat cells. Internal to PatchRays.
#pragma once

#include "PatchRays.h"
#include "TrimIndex.h"

namespace nurbs
{

/// How much of a rectangle is left of a face.
enum class TrimCover
{
  None,
  Part, ///< Or it is not known.
  Whole
};

/// Tells what trimming leaves of rectangles of one face's domain.
class CoverTest
{
public:
  CoverTest(const Model& model, const nurbs::Face& face, const FaceTrim& trim);

  /// Exact but for rectangles that a trim curve's box meets: Part. Coordinates are normalised to
  /// the face's domain.
  TrimCover Cover(const Box2& rectangle) const;

  /// In the parameters of the face, to normalised ones.
  double Normalise(int dir, double t) const
  {
    return (t - this->Domain[dir].Min) / this->Domain[dir].Length();
  }

private:
  const FaceTrim& Trim;
  Interval Domain[2];
  std::vector<Box2> Boxes; ///< Of short pieces of the trim curves.
};

/// The numerators of the derivatives of a rational patch in three dimensions, w H_u - H w_u and the
/// same for v, and their denominator w^2: a patch of the double degrees. Unlike H_u, they do not depend
/// on where the origin is.
using QuotientNet = std::vector<Eigen::Matrix<double, 7, 1>>;

/// A part of a patch on the way to be a cell.
struct CutPiece
{
  enum class Verdict
  {
    Empty, ///< Nothing of it is left by trimming.
    Cell,  ///< It is a cell.
    Halve
  };

  BezierPatch Patch;     ///< U and V: the part of the patch's parameters.
  QuotientNet Quotients; ///< Empty if all weights are the same.
  int Depth = 0;         ///< Halvings that it took.
  // What Judge finds:
  Verdict Is = Verdict::Halve;
  int Direction = 0; ///< To be halved in.
  PatchRays::Cell Cell;
  double Slowest[2] = { 0.0, 0.0 }; ///< Lower bounds on the lengths of the derivatives; 0: none.

  /// Of the control points.
  Box3 Box() const;
};

/// Takes the patches of one surface and makes what PatchRays keeps of them.
class PatchCutter
{
public:
  /// What stays the same while a patch is cut.
  struct Context
  {
    const CoverTest& Test;
    double Reach;
    Interval Domain[2]; ///< The patch's, normalised to the face's.

    /// `given`: of the face's own domain. Cells that are trimmed away and farther than `reach` (a
    /// length) from what is left are left out.
    Context(const CoverTest& test, double reach, const BezierPatch& given);
    /// What is left of a piece, or within reach of that.
    TrimCover Cover(const CutPiece& piece) const;
  };

  static constexpr int MaxHalvings = 10; ///< Of a patch, at most.

  /// Cells are not made smaller than a small part of `size`, that of the model.
  explicit PatchCutter(double size)
    : Size(size)
  {}

  /// Adds a patch of the face.
  void Add(const BezierPatch& given, std::int32_t face, const CoverTest& test, double reach);

  /// The whole of a patch, its largest weight 1, its parameters 0 to 1, not judged.
  static CutPiece Whole(const BezierPatch& given);
  /// What is to be done with a piece; fills in its cell but for the patch.
  void Judge(const Context& context, CutPiece& piece);
  /// Cuts a judged piece, which is left without points, into two that are not judged.
  static void Halve(CutPiece& piece, CutPiece& low, CutPiece& high);

  std::vector<PatchRays::Patch> Patches;
  std::vector<Vec4> Points;
  std::vector<PatchRays::Cell> Cells;
  std::vector<Box3> Boxes;

private:
  void Cut(const Context& context, CutPiece& piece);
  double Flatten(CutPiece& piece);

  double Size;
  std::vector<Vec3> Scratch; ///< Of Flatten, kept for its memory.
};

} // namespace nurbs
