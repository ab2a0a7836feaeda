// SPDX-License-Identifier: BSD-3-Clause
/// @file WaveletEdge.h
/// @brief One edge as a pyramid of samples of its own, the same for every face that uses it.
///
/// Faces that share an edge take its polyline's points bit for bit, whatever their own levels are;
/// that is what keeps them together at mixed levels.
#pragma once

#include "WaveletFace.h"

namespace nurbs
{

/// Where a face's loop runs along an edge.
struct WaveletEdgeUse
{
  EdgeUse Where;
  int Side = -1; ///< Of the face's box, all along: 0 v = min, 1 u = max, 2 v = max, 3 u = min.
  std::vector<Vec2> UV;    ///< In the face's domain, at the edge's finest lines.
  int SideDepth = 0;       ///< With a Side: how often the face's grid halves it.
  std::vector<int> AtLine; ///< With a Side: the edge's line at the face's finest line; -1: none.
};

/// An edge of a completed model: dyadic samples and their errors.
class WaveletEdge
{
public:
  /// Evaluates and analyses an edge.
  /// @param faces the faces that use it, by index of the model; null: can't be used.
  WaveletEdge(const Model& model, std::int64_t edge, const std::vector<EdgeUse>& uses,
    const std::vector<std::unique_ptr<WaveletFace>>& faces, Wavelet kind, double tolerance);

  /// A pole; it has one point and nothing else.
  bool IsPole() const { return this->Pole; }
  /// The dyadic lines along the edge.
  const DyadicAxis& Axis() const { return this->Lines; }
  /// The trim curves that run along the edge.
  const std::vector<WaveletEdgeUse>& Uses() const { return this->Where; }
  /// Points at the finest lines (Interpolating and Lifted, whose curves are the same).
  const std::vector<Vec3>& Points() const { return this->Fine; }
  /// Haar: the samples of a level.
  std::vector<Vec3> HaarLevel(int level) const;
  /// Haar: the parameters in a face of a level's samples.
  std::vector<Vec2> HaarUV(
    const Model& model, std::size_t use, int level, const WaveletFace& face) const;

  /// Bound of the distance between the curve and the samples' polyline from line `first` to `last`
  /// of the finest lines (Haar: the whole polyline of a level). The curve's own part of it is
  /// certified for edges with a 3D curve and sides of surfaces, and sampled for others.
  double SegmentError(int first, int last) const;
  /// Likewise, of a level of Haar's wavelet.
  double HaarError(int level) const;
  /// The largest coefficient between two lines (Haar: that a level lacks).
  double LargestCoefficient(int first, int last) const;
  /// Likewise, of a level of Haar's wavelet.
  double HaarDropped(int level) const;
  /// Segments that are left when those with a coefficient over a threshold are halved.
  std::int64_t CountSegments(double threshold) const;
  /// The coarsest level as fine as the grids of the faces whose side it is, and not coarser than
  /// `level`.
  int LevelOfSides(const std::vector<int>& faces, int level) const;

private:
  void FindSides(const Model& model, const std::vector<std::unique_ptr<WaveletFace>>& faces);
  void MakeBreaks(const Model& model, const std::vector<std::unique_ptr<WaveletFace>>& faces);
  void AddCrossings(const Model& model, const WaveletEdgeUse& use, const WaveletFace& face);
  Vec3 Point(const Model& model, double t) const;
  Vec2 Parameters(
    const Model& model, const WaveletEdgeUse& use, const WaveletFace& face, double t) const;
  double Bow(const Model& model, const std::vector<std::unique_ptr<WaveletFace>>& faces,
    std::vector<double>& second) const;

  std::int64_t Index = -1;
  bool Pole = false;
  bool Closed = false;
  Interval Domain;
  DyadicAxis Lines;
  std::vector<WaveletEdgeUse> Where;
  std::vector<Vec3> Fine;
  WaveletPyramid Haar;
  std::vector<double> HaarSteps;
  double FineError = 0.0;
  std::vector<std::vector<float>> Deviations, Coefficients; ///< Of segments of level k >= 1.
};

} // namespace nurbs
