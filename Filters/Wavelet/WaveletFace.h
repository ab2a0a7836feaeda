// SPDX-License-Identifier: BSD-3-Clause
/// @file WaveletFace.h
/// @brief One face as a pyramid of samples, with a bound of the error of every cell of every level.
///
/// A level's mesh is compared with the surface at equal parameters: the finest grid's bilinear
/// interpolation is within bounds of the second derivatives (SurfaceBound.h), each level's within
/// the largest distance from the next finer one (bilinear patches lie in the hull of their corners,
/// so that their corners tell it), and two triangles within a quarter of the twist of their cell.
#pragma once

#include "CompletedModel.h"
#include "SurfaceBound.h"
#include "WaveletPyramid.h"

#include <memory>

namespace nurbs
{

/// A cell of a level.
struct WaveletCell
{
  int Level = 0;
  int I = 0, J = 0;
};

/// Limits of the finest grids.
struct FinestGrid
{
  double Tolerance = 0.0;                    ///< Model units, > 0.
  std::int64_t MaximumSamples = 1024 * 1024; ///< Of one face.
};

/// The box of a face's loops in its domain: that of their curves' control points; without loops,
/// the domain. Throws Error if it is empty.
ParameterBox LoopBox(const Model& model, const Face& face);

/// The box of a face's loops, the dyadic grid over it, and what evaluation and analysis gave.
class WaveletFace
{
public:
  /// Evaluates and analyses a face of a completed model. Throws Error if it can't be used.
  WaveletFace(const Model& model, std::int64_t face, Wavelet kind, const FinestGrid& finest);

  /// The box of the loops.
  const ParameterBox& Box() const { return this->Used; }
  /// Lines of the grid in a direction.
  const DyadicAxis& Axis(int dir) const { return this->Axes[dir]; }
  /// Bounds of the surface's derivatives.
  const SurfaceBound& Bound() const { return *this->Bounds; }
  /// What evaluation and analysis gave.
  const WaveletPyramid& Pyramid() const { return this->Samples; }
  /// Levels, at least 1. Coarser ones are the same as the last.
  int Levels() const { return this->Samples.Levels(); }
  /// Bound of the distance of the finest level's bilinear interpolation from the surface.
  double FineError() const { return this->Fine; }
  /// True if MaximumSamples kept the finest grid from its tolerance.
  bool IsCapped() const { return this->Capped; }

  /// Bound of the distance of a level's bilinear interpolation from the surface, at equal
  /// parameters.
  double BilinearError(int level) const;
  /// Bound of the distance of the mesh of a level over its grid.
  double LevelError(int level) const;
  /// Largest coefficient that the levels finer than this one lack.
  double LargestDropped(int level) const;

  /// Unit normals at a level's samples.
  std::vector<Eigen::Vector3f> Normals(int level) const;

  // The following are known for the interpolating wavelet.

  /// Bound of the distance of a cell's bilinear interpolation from the finest level's.
  double Deviation(const WaveletCell& cell) const;
  /// Bound of the distance between any two vectors from the one interpolation to the other, which
  /// is how far linear interpolation of some of them is from the others.
  double Spread(const WaveletCell& cell) const;
  /// Largest coefficient in the cell, on all finer levels.
  double LargestCoefficient(const WaveletCell& cell) const;
  /// The cells of the next finer level, 2 or 4. Level must not be 0.
  int Children(const WaveletCell& cell, WaveletCell (&children)[4]) const;
  /// Cell as lines of the finest level: i0, i1, j0, j1.
  void Extent(const WaveletCell& cell, int (&lines)[4]) const;

  /// Puts parameters within rounding of a side of the box or a crease onto it.
  Vec2 Snap(const Vec2& uv) const;

private:
  void MakeBreaks(const SurfaceView& surface);
  void MakeDepths(Wavelet kind, const FinestGrid& finest);
  void Evaluate(Wavelet kind);
  void MeasureLevels(Wavelet kind, const std::vector<Vec3>& finest);
  void AddCreases(const std::vector<Vec3>& finest);
  void MeasureCells(const std::vector<Vec3>& finest);
  std::size_t IndexOf(const WaveletCell& cell) const;

  bool Turned = false; ///< Normals are against Su x Sv.
  ParameterBox Used;
  DyadicAxis Axes[2];
  std::unique_ptr<SurfaceBound> Bounds;
  WaveletPyramid Samples;
  Wavelet Kind = Wavelet::Interpolating;
  double Fine = 0.0;
  bool Capped = false;
  std::vector<Eigen::Vector3f> FineNormals;
  std::vector<double> Steps; ///< Distance of level k's from level k + 1's bilinear interpolation.
  std::vector<double> Twist; ///< Largest of a level.
  std::vector<std::vector<float>> Deviations, Coefficients; ///< Of the cells of level k >= 1.
  std::vector<std::vector<Eigen::AlignedBox3f>> Ranges;     ///< Of the vectors of the deviation.
};

} // namespace nurbs
