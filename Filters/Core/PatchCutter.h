// SPDX-License-Identifier: BSD-3-Clause
/// @file PatchCutter.h
/// @brief Cuts patches into nearly flat cells. Internal to PatchRays.
#pragma once

#include "PatchRays.h"

namespace nurbs
{

/// Takes the patches of one surface and makes what PatchRays keeps of them.
class PatchCutter
{
public:
  /// Cells are not made smaller than a small part of `size`, that of the model.
  explicit PatchCutter(double size)
    : Size(size)
  {}

  void Add(const BezierPatch& given, std::int32_t face);

  std::vector<PatchRays::Patch> Patches;
  std::vector<Vec4> Points;
  std::vector<PatchRays::Cell> Cells;
  std::vector<Box3> Boxes;

private:
  /// The numerators of the derivatives of a rational patch in three dimensions, w H_u - H w_u and the
  /// same for v, and their denominator w^2: a patch of the double degrees. Unlike H_u, they do not
  /// depend on where the origin is.
  using Quotient = Eigen::Matrix<double, 7, 1>;
  using QuotientNet = std::vector<Quotient>;

  static QuotientNet MakeQuotients(const BezierPatch& patch);
  void Cut(const BezierPatch& piece, const QuotientNet& quotients, int depth);
  double Flatten(
    const BezierPatch& piece, const QuotientNet& quotients, PatchRays::Cell& cell, int& dir) const;

  double Size;
};

} // namespace nurbs
