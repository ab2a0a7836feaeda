// SPDX-License-Identifier: BSD-3-Clause
/// @file FaceGrid.h
/// @brief The lines that a face's cells lie between, and the scalar coefficients of their points.
///
/// Knots and the box of the loops divide a direction into columns, over each of which every basis
/// function is one polynomial. A line halves a column, a half of it, and so on. The coefficient of
/// control point (s, t) at the crossing of two lines (Li, Lau, Green 1997, equation (2), times the sum
/// of weights) is a product of one number a line: N_s(u) N_t(v). So they are kept by lines, not by
/// points: as many numbers as a row and a column of the mesh have, instead of one a point and control
/// point. A line's numbers come from the basis functions' Bezier coefficients over its column by
/// Horner's scheme (equation (4)).
#pragma once

#include "FlatIndex.h"
#include "Surface.h"
#include "SurfaceBound.h"

namespace nurbs
{

/// Coordinates of lines are whole numbers: column * ColumnUnits + part of it.
constexpr int ColumnBits = 16;
constexpr std::uint32_t ColumnUnits = 1u << ColumnBits;

/// One direction of a face's grid.
class GridAxis
{
public:
  /// @param range the part of the domain that is used.
  GridAxis(KnotView knots, int degree, const Interval& range);

  /// Non-empty knot spans of the range.
  int Columns() const { return int(this->Breaks.size()) - 1; }
  /// Of the surface in this direction.
  int Degree() const { return this->P; }
  /// The first control point that a column's points depend on, of Degree() + 1.
  int First(int column) const { return this->Spans[column] - this->P; }
  /// The parameters of a column.
  Interval Extent(int column) const { return { this->Breaks[column], this->Breaks[column + 1] }; }
  /// The first parameter.
  double Start() const { return this->Breaks.front(); }
  /// The last parameter.
  double End() const { return this->Breaks.back(); }
  /// The coordinate of the last line.
  std::uint32_t Last() const { return std::uint32_t(this->Columns()) << ColumnBits; }
  /// The column whose points a line belongs to: the one after it, but for the last line.
  int ColumnOf(std::uint32_t line) const
  {
    return line == this->Last() ? this->Columns() - 1 : int(line >> ColumnBits);
  }
  /// The columns whose points depend on a control point, inclusive; first > last: none in the range.
  void ColumnsOf(int control, int& first, int& last) const;
  /// The column that a parameter lies in.
  int ColumnAt(double t) const;
  /// The parameter of a line.
  double Parameter(std::uint32_t line) const;
  /// The coordinate of the line at a parameter or before it, of the smallest cells there can be.
  std::int64_t LineBelow(double t) const;

  /// The index of a line among those of its column; made if it is new.
  int Line(std::uint32_t line);
  /// A line's basis functions, Degree() + 1, and then their derivatives.
  const double* Basis(int column, int index) const
  {
    return this->Tables[column].data() + std::size_t(index) * 2 * (this->P + 1);
  }
  /// Bezier coefficients over a column: row i takes the control points to Bezier point i.
  const double* Extraction(int column) const
  {
    return this->Matrices.data() + std::size_t(column) * (this->P + 1) * (this->P + 1);
  }
  /// Basis functions and derivatives at any parameter of a column, as Basis gives them.
  void EvaluateAt(int column, double t, double* basis) const;

private:
  int P = 1;
  std::vector<double> Breaks;
  std::vector<int> Spans;
  std::vector<double> Matrices;
  std::vector<std::vector<double>> Tables; ///< One a column.
  std::vector<int> Counts;
  FlatIndex Index;
};

/// Both directions.
struct FaceGrid
{
  /// A grid of the used part of the domain.
  FaceGrid(const SurfaceView& surface, const ParameterBox& used)
    : Axis{ GridAxis(surface.Knots[0], surface.Degree[0], { used.U0, used.U1 }),
      GridAxis(surface.Knots[1], surface.Degree[1], { used.V0, used.V1 }) }
  {}
  GridAxis Axis[2];

  /// Number of patches.
  int Patches() const { return this->Axis[0].Columns() * this->Axis[1].Columns(); }
  /// The patch of a column and row.
  int Patch(int column, int row) const { return column + row * this->Axis[0].Columns(); }
  /// The column of a patch.
  int Column(int patch) const { return patch % this->Axis[0].Columns(); }
  /// The row of a patch.
  int Row(int patch) const { return patch / this->Axis[0].Columns(); }
  /// A patch's part of the domain.
  ParameterBox Box(int patch) const
  {
    const Interval u = this->Axis[0].Extent(this->Column(patch));
    const Interval v = this->Axis[1].Extent(this->Row(patch));
    return { u.Min, u.Max, v.Min, v.Max };
  }
  /// The parameters where two lines cross.
  Vec2 UV(std::uint32_t i, std::uint32_t j) const
  {
    return { this->Axis[0].Parameter(i), this->Axis[1].Parameter(j) };
  }
};

} // namespace nurbs
