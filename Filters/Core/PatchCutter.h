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

/// Takes the patches of one surface and makes what PatchRays keeps of them.
class PatchCutter
{
public:
  /// Cells are not made smaller than a small part of `size`, that of the model.
  explicit PatchCutter(double size)
    : Size(size)
  {}

  /// Adds a patch of the face, but for cells that are trimmed away and farther than `reach` (a
  /// length) from what is left.
  void Add(const BezierPatch& given, std::int32_t face, const CoverTest& test, double reach);

  std::vector<PatchRays::Patch> Patches;
  std::vector<Vec4> Points;
  std::vector<PatchRays::Cell> Cells;
  std::vector<Box3> Boxes;

private:
  /// The numerators of the derivatives of a rational patch in three dimensions, w H_u - H w_u and
  /// the same for v, and their denominator w^2: a patch of the double degrees. Unlike H_u, they do
  /// not depend on where the origin is.
  using Quotient = Eigen::Matrix<double, 7, 1>;
  using QuotientNet = std::vector<Quotient>;

  static QuotientNet MakeQuotients(const BezierPatch& patch);
  struct Context;

  void Cut(const Context& context, const BezierPatch& piece, QuotientNet& quotients, int depth);
  double Flatten(
    const BezierPatch& piece, const QuotientNet& quotients, PatchRays::Cell& cell, int& dir);

  double Size;
  std::vector<Vec3> Scratch; ///< Of Flatten, kept for its memory.
};

} // namespace nurbs
