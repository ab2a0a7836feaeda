// SPDX-License-Identifier: BSD-3-Clause
/// @file CellError.h
/// @brief Decides whether two triangles can replace the surface over a cell, and where to split.
#pragma once

#include "SurfaceBound.h"
#include "SurfaceEvaluator.h"

namespace nurbs
{

struct TreeGoal;
struct TreeLeaf;

/// Examines cells of one surface. One object per thread.
class CellError
{
public:
  CellError(const SurfaceBound& bound, const TreeGoal& goal);

  /// Returns -1 if the cell `leaf.Box` is good enough, else the direction (0: u, 1: v) to split.
  /// Fills the leaf's Range (bounds for any triangle inside the box), Height, Sliding, Diagonal.
  /// @param patch the Bezier form over exactly this box, or null for boxes of several spans.
  int Examine(const BezierPatch* patch, TreeLeaf& leaf);

private:
  struct Corner
  {
    Vec3 X, Du, Dv;
  };
  void Corners(const ParameterBox& box, const BezierPatch* patch);
  double Slope(const Vec3& n) const;
  double Bounded(TreeLeaf& leaf, const BezierPatch* patch);
  double Estimated(TreeLeaf& leaf, const BezierPatch* patch);
  bool ExceedsLimits(int& axis) const;

  const SurfaceBound& Bound;
  const TreeGoal& Goal;
  SurfaceEvaluator Evaluator;
  SurfaceBound::Coefficients Coefficients;
  Corner At[4];           ///< (0,0), (1,0), (0,1), (1,1).
  double MaxWeight = 1.0; ///< Of the corners.
  double CostU = 0.0, CostV = 0.0;
};

} // namespace nurbs
