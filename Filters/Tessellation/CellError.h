// SPDX-License-Identifier: BSD-3-Clause
/// @file CellError.h
/// @brief Decides whether two triangles can replace the surface over a cell, and where to split.
#pragma once

#include "FacetBound.h"

namespace nurbs
{

struct TreeGoal;
struct TreeLeaf;

/// Examines cells of one surface (Balazs, Guthe, Klein 2004, section 5.2). One object per thread.
class CellError
{
public:
  CellError(const SurfaceBound& bound, const TreeGoal& goal);

  /// Returns -1 if the cell `leaf.Box` is good enough, else the direction (0: u, 1: v) to split.
  /// Fills the leaf's Error, Axis and Diagonal. No crease crosses the box.
  int Examine(TreeLeaf& leaf);
  /// The sampled error of the better pair of triangles, whatever it is.
  double Sampled(const ParameterBox& box);

private:
  double Measure(TreeLeaf& leaf);
  SampleDistance Corners(const Facet& facet, const int* f) const;
  void MakeCorners(const ParameterBox& box);
  void AddSamples(const Facet& facet, int diagonal, int half, bool alone, int last, int k,
    SampleDistance& samples);
  double Halves(int diagonal, double best);
  bool IsCollapsed(const int* facet) const;
  void SampleGrid(int k);
  int CheaperAxis() const;
  double DenseError(const Facet& facet, const Remainder& rest, int diagonal, int half, bool alone);
  bool LooksBack(const Facet& facet, const int* f) const;
  bool IsBeyond(const Vec3& middle) const;
  bool ExceedsLimits(int& axis);

  const SurfaceBound& Bound;
  const TreeGoal& Goal;
  SurfaceEvaluator Evaluator;
  SecondDerivatives Second;
  ParameterBox Box;      ///< The cell.
  Vec3 At[4];            ///< Its corners (0,0), (1,0), (0,1), (1,1),
  Vec3 Normal[4];        ///< and normals there.
  bool AtCrease = false; ///< A side of the cell is a crease.
  /// Samples of the cell, u fastest, of which every (DensestSamples / Density)-th is known in each
  /// direction.
  Vec3 Sample[(DensestSamples + 1) * (DensestSamples + 1)];
  int Density = 0;
};

} // namespace nurbs
