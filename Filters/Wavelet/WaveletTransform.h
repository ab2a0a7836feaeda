// SPDX-License-Identifier: BSD-3-Clause
/// @file WaveletTransform.h
/// @brief One step of a wavelet transform of a grid of samples: rows, then columns.
///
/// Source: D. Tan, G. Zhao, H. Lu, "GPU based evaluation and LOD rendering of NURBS surfaces",
/// Computer-Aided Design & Applications 9 (2012), section 4.3. Both directions follow one rule that
/// is ours: the first and the last sample of a line pass through every step unchanged. So corners
/// stay where they are, and a grid's border is transformed as a curve of its own, whatever lies
/// inside: surfaces that have a border in common have it in common at every level. Why and how:
/// Documentation/Papers/tan-2012-wavelets.md.
///
/// A step halves the number n of intervals of a line, which must be even:
///
///     Interpolating, Lifted: n + 1 samples, at the ends of the intervals
///     Haar:                  n + 2 samples, the first end, the middles of the intervals, the last
///     end
///
/// and leaves the samples of the coarse line first, behind them n / 2 details.
#pragma once

#include "Types.h"

namespace nurbs
{

/// Which wavelet a grid is analysed with.
enum class Wavelet : unsigned char
{
  /// Means and half differences of two samples (equations (9) to (13)); ends as told above.
  Haar,
  /// The 5/3 wavelet's prediction alone: coarse samples are every second fine sample.
  Interpolating,
  /// The 5/3 wavelet with its update: coarse samples inside the grid keep the mean of the fine
  /// ones. Its lines along the border are predicted only, so that they stay on the border.
  Lifted
};

/// Samples of a line of `intervals` intervals.
inline int LineSamples(Wavelet wavelet, int intervals)
{
  return intervals + (wavelet == Wavelet::Haar ? 2 : 1);
}

/// What one step does to a grid.
struct GridStep
{
  Wavelet Kind = Wavelet::Interpolating;
  int Intervals[2] = { 0, 0 };       ///< Of the fine grid, u then v; 0 of v: a curve, one row.
  bool Halved[2] = { false, false }; ///< The directions that the step halves; even intervals there.

  /// Samples of the fine grid in a direction.
  int FineSamples(int dir) const { return this->Samples(this->Intervals[dir]); }
  /// Intervals of the coarse grid in a direction.
  int CoarseIntervals(int dir) const
  {
    return this->Halved[dir] ? this->Intervals[dir] / 2 : this->Intervals[dir];
  }
  /// Samples of the coarse grid in a direction.
  int CoarseSamples(int dir) const { return this->Samples(this->CoarseIntervals(dir)); }

private:
  int Samples(int intervals) const
  {
    return intervals == 0 ? 1 : LineSamples(this->Kind, intervals);
  }
};

/// Analysis in place: the fine grid's samples, u fastest, become those of the coarse grid (the
/// first CoarseSamples of rows and columns) and details (the rest).
/// @param grid rows of `pitch` samples of N values; N is 3 (float or double) or 4 (float).
template <typename Real, int N>
void AnalyseGrid(const GridStep& step, Real* grid, std::int64_t pitch);

/// Synthesis, the inverse: from the coarse grid's samples and the details to the fine grid.
/// @param coarse rows of CoarseSamples(0) samples, close-packed.
/// @param details what AnalyseGrid left, with its pitch; the coarse samples in it are not read.
/// @param fine receives rows of FineSamples(0) samples, close-packed.
template <typename Real, int N>
void SynthesiseGrid(
  const GridStep& step, const Real* coarse, const Real* details, std::int64_t pitch, Real* fine);

/// The coarse grid's samples alone, from the fine grid's, both close-packed: a step to a coarser
/// level whose details are known already. The same as AnalyseGrid's to rounding.
template <typename Real, int N>
void CoarsenGrid(const GridStep& step, const Real* fine, Real* coarse);

} // namespace nurbs
