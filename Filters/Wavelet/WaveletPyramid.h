// SPDX-License-Identifier: BSD-3-Clause
/// @file WaveletPyramid.h
/// @brief Dyadic grids of samples, and their pyramid of averages and details.
///
/// Source: Tan, Zhao, Lu 2012, section 4.3.2. Level 0 is the finest grid; each level has half the
/// intervals of the one before it, in every direction that still can be halved.
#pragma once

#include "WaveletTransform.h"

#include <algorithm>

namespace nurbs
{

/// The lines of a dyadic grid in one direction: base intervals, each halved `Depth` times.
struct DyadicAxis
{
  std::vector<double> Breaks{ 0.0, 1.0 }; ///< Ends of the base intervals, ascending.
  int Depth = 0;

  /// Intervals of the coarsest grid.
  int BaseIntervals() const { return int(this->Breaks.size()) - 1; }
  /// How many times a level has halved this direction.
  int Halvings(int level) const { return std::min(level, this->Depth); }
  /// Intervals of a level; 0: the finest.
  int Intervals(int level = 0) const
  {
    return this->BaseIntervals() << (this->Depth - this->Halvings(level));
  }
  /// The finest grid's line i, 0 <= i <= Intervals(). The same bits on every level that has it.
  double Line(int i) const;
  /// The parameters of a level's samples (see LineSamples), ascending.
  std::vector<double> Samples(Wavelet kind, int level) const;
};

/// The largest distance, over all parameters, between the bilinear interpolations of two grids of
/// samples on lines u (columns) and v (rows) with the same ends.
double BilinearDistance(const std::vector<double>& u, const std::vector<double>& v,
  const std::vector<Vec3>& grid, const std::vector<double>& otherU,
  const std::vector<double>& otherV, const std::vector<Vec3>& other);

/// A grid of samples as its coarsest level and the details of all others.
class WaveletPyramid
{
public:
  WaveletPyramid() = default;
  /// Analyses the finest grid's samples, u fastest, at the parameters of the axes' level 0. For a
  /// curve `v` has a single break.
  WaveletPyramid(Wavelet kind, const DyadicAxis& u, const DyadicAxis& v, std::vector<Vec3> samples);

  /// Levels, at least 1.
  int Levels() const { return this->Count; }
  /// The step between a level and the next coarser one.
  GridStep Step(int level) const;
  /// The samples of a level, u fastest.
  std::vector<Vec3> Level(int level) const;
  /// The samples of `level` from those of level + 1.
  std::vector<Vec3> Refine(int level, const std::vector<Vec3>& coarse) const;
  /// Coefficients as AnalyseGrid leaves them after the last step; rows as long as the finest.
  const std::vector<Vec3>& Coefficients() const { return this->Packed; }
  /// The largest coefficient that the step from `level` to level + 1 takes away.
  double LargestDetail(int level) const;

private:
  Wavelet Kind = Wavelet::Interpolating;
  int Fine[2] = { 0, 0 };
  int Depth[2] = { 0, 0 };
  int Count = 1;
  std::vector<Vec3> Packed;
};

} // namespace nurbs
