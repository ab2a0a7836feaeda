// SPDX-License-Identifier: BSD-3-Clause
/// @file SurfaceBound.h
/// @brief Sound bounds of a surface's second derivatives over any parameter box.
///
/// For a triangle with corners p_i in a parameter box a x b and a point p = sum b_i p_i of it, the
/// remainder of linear interpolation of any C1 function f is
///   f(p) - sum b_i f(p_i) = -1/2 sum b_i (p_i - p)^T H_i (p_i - p),
/// H_i a mean of f's Hessian along a segment. Since sum b_i du_i^2 <= a^2/4 and, by Cauchy-Schwarz,
/// sum b_i |du_i dv_i| <= a b / 4,
///   |f - L| <= 1/8 (a^2 max|f_uu| + 2 a b max|f_uv| + b^2 max|f_vv|)
/// for *every* triangle in the box, not only for the two halves of a cell (Balazs, Guthe, Klein 2004,
/// section 5.2, bound the two halves; a trimmed cell has others). f is the surface S itself, not its
/// homogeneous form: a circle's quarters join C1 in space, whatever their weights do.
/// Derivation: Documentation/Papers/balazs-2004-bound.md.
#pragma once

#include "SurfaceEvaluator.h"

namespace nurbs
{

/// Share of a box's extent up to which a knot span that it touches does not count.
inline constexpr double NegligibleSpan = 1e-6;

/// A rectangle of the parameter domain.
struct ParameterBox
{
  double U0 = 0.0, U1 = 0.0, V0 = 0.0, V1 = 0.0;
  /// Extent in u.
  double A() const { return this->U1 - this->U0; }
  /// Extent in v.
  double B() const { return this->V1 - this->V0; }
};

/// Intervals that hold S_uu, S_uv, S_vv (index 0, 1, 2) over a box, coordinate by coordinate.
/// Units: model units per parameter unit squared.
struct SecondDerivatives
{
  Vec3 Center[3];
  Vec3 Radius[3];

  /// Greatest |d . S''| of index k.
  double Greatest(int k, const Vec3& d) const
  {
    return std::abs(d.dot(this->Center[k])) + d.cwiseAbs().dot(this->Radius[k]);
  }
  /// Greatest |S''| of index k.
  double Greatest(int k) const { return (this->Center[k].cwiseAbs() + this->Radius[k]).norm(); }
  /// Bound of |d . (S - L)| over any triangle of an a x b box, L its linear interpolation. Without
  /// `mixed` the term of S_uv is left out: right against the bilinear interpolation of the box.
  double Bow(double a, double b, const Vec3& d, bool mixed = true) const;
  /// Bound of |S - L|.
  double Bow(double a, double b) const;
};

/// A surface with bounds of its second derivatives on a fine grid.
class SurfaceBound
{
public:
  /// @param used the part of the domain that will be asked for.
  SurfaceBound(const SurfaceView& surface, const ParameterBox& used);
  /// Makes the grid between the knots and the given lines (ascending): bounds are tightest over boxes
  /// between two of them. Until then the surface has no bounds.
  void MakeGrid(const std::vector<double>& linesU, const std::vector<double>& linesV,
    const ParallelFor& parallel);

  /// The surface given.
  const SurfaceView& View() const { return this->Surface; }
  /// An evaluator to copy: copies share the control net.
  const SurfaceEvaluator& Evaluator() const { return this->Prototype; }
  /// Length of the control net's bounding-box diagonal.
  double Size() const { return this->Diagonal; }
  /// The plane that fits the control points: its normal, and their largest distance from it.
  const Vec3& PlaneNormal() const { return this->Normal; }
  /// Likewise.
  double Flatness() const { return this->PlaneDistance; }

  /// Knots strictly inside the used part where the surface is not C1: no triangle may cross them.
  const std::vector<double>& Creases(int dir) const { return this->Crease[dir]; }
  /// True if t is a crease of a direction.
  bool IsCrease(int dir, double t) const;
  /// True if the box crosses a crease by more than NegligibleSpan of its extent.
  bool CrossesCrease(const ParameterBox& box) const;
  /// Bounds over a box in the used part. Creases inside it are ignored, see CrossesCrease.
  SecondDerivatives Over(const ParameterBox& box) const;
  /// True if the box is not inside one cell of the grid: samples should be denser there.
  bool HasGridLineInside(const ParameterBox& box) const;

private:
  struct Cell
  {
    float Low[9];
    float High[9];
    void Unite(const Cell& other);
  };
  struct Level
  {
    int Count[2];
    std::vector<Cell> Cells;
  };
  void FitPlane();
  void FindCreases();
  bool IsSmooth(int dir, double knot) const;
  void MakeBreaks(int dir, const std::vector<double>& lines);
  void MakeCells(const ParallelFor& parallel);
  void MakeLevels();
  bool Find(int dir, double low, double high, int& first, int& last) const;

  SurfaceView Surface;
  SurfaceEvaluator Prototype;
  ParameterBox Used;
  double Diagonal = 0.0;
  Vec3 Normal = Vec3::Zero();
  double PlaneDistance = 0.0;
  std::vector<double> Crease[2];
  std::vector<double> Breaks[2]; ///< Lines of the grid, the distinct knots among them.
  std::vector<Level> Levels;     ///< The grid, and coarser ones: 2 x 2 cells in one.
};

} // namespace nurbs
