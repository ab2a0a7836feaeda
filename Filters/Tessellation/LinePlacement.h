// SPDX-License-Identifier: BSD-3-Clause
/// @file LinePlacement.h
/// @brief Parameter lines across a whole surface between which two triangles a cell suffice.
///
/// Ours, beside the splits of Balazs, Guthe, Klein 2004, section 5.2: cells of a kd-tree that end at
/// lines which all share align with their neighbours, and between two creases there may be any
/// number of lines rather than a power of two. Derivation: Documentation/Papers/balazs-2004-bound.md.
#pragma once

#include "SurfaceBound.h"

namespace nurbs
{

/// The lines of one direction.
struct ParameterLines
{
  std::vector<double> At;     ///< Ascending, both ends of the domain included.
  std::vector<double> Demand; ///< Accumulated number of segments wanted up to each line.
};

/// Samples a surface's curvature and places lines by it.
class LinePlacement
{
public:
  /// @param tolerance model units. Parameters as of SurfaceTree::Build.
  LinePlacement(const SurfaceBound& bound, const ParameterBox& domain, double tolerance,
    const ParallelFor& parallel);

  /// Lines for `margin` times as many segments as the samples want.
  void Place(double margin, ParameterLines& u, ParameterLines& v) const;
  /// True if a direction's lines follow the demand. False: it differs so much across the surface
  /// that lines lie on knots only, and cells are halved where they need to be.
  bool FollowsDemand(int dir) const { return this->Direction[dir].Even; }

private:
  struct Samples
  {
    std::vector<double> Knots;  ///< Distinct, with the ends of the domain.
    std::vector<double> Lines;  ///< Those knots that are lines if lines lie on knots.
    std::vector<double> Stops;  ///< Creases, with the ends of the domain.
    int PerSpan = 1;            ///< Cells in each knot span.
    std::vector<double> At;     ///< Boundaries of cells, ascending, knots among them.
    std::vector<double> Middle; ///< Sample positions: of the cells, or two in a single one.
    std::vector<double> Wanted; ///< Segments per parameter unit in each cell.
    bool Even = true;
    void MakeCells();
    std::size_t CellOf(std::size_t sample) const
    {
      return this->Middle.size() + 1 == this->At.size() ? sample : 0;
    }
    double Length(std::size_t cell) const { return this->At[cell + 1] - this->At[cell]; }
  };
  void DropNearKnots(const SurfaceBound& bound, double tolerance);
  void Sample(const SurfaceBound& bound, double tolerance, const ParallelFor& parallel);
  void Refine(int dir);
  double Bend(int dir, std::size_t own, std::size_t other) const;
  bool IsEven(int dir) const;
  bool AddUp() const;
  double Share(int first, double share);
  double CountSegments(const Samples& s, std::vector<double>* spacing) const;

  Samples Direction[2];
  std::vector<double> Bends[2]; ///< n . S'' over 8 tolerances at each sample, u fastest.
};

} // namespace nurbs
