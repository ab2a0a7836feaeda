// SPDX-License-Identifier: BSD-3-Clause
/// @file PieceSearch.h
/// @brief Isolates the roots of a bivariate Bezier polynomial with two components. Internal to
/// PatchRays.
#pragma once

#include "PatchRays.h"

namespace nurbs
{

/// Homogeneous point of a patch, and derivatives with respect to its parameters in [0, 1].
struct PatchPoint
{
  Vec4 H;
  Vec4 D[2];
};

/// Evaluates a patch of p + 1 times q + 1 homogeneous points, u fastest. Exact at its corners.
void EvaluatePatch(const Vec4* net, int p, int q, double u, double v, PatchPoint& out);

/// A map with at most these (positive) derivatives, row by row, contracts by this factor in the
/// norm max |s_k| / unit[k]: the largest eigenvalue and its vector, which make the factor as small
/// as it can be (Perron, Frobenius).
double ContractionFactor(const Eigen::Matrix2d& bound, Vec2& unit);
/// Below this factor there is one root at most, and the iteration is quick.
constexpr double MaxFactor = 0.5;

/// Where a root may be.
struct RootPiece
{
  PatchPiece Piece;
  bool Isolated = false; ///< One root at most: by Newton's method from Start, within Piece.
  Vec2 Start = Vec2::Zero();
  /// Inverse of the mean derivative over the piece: s - Chord g(s) contracts there by a half or
  /// more.
  Eigen::Matrix2d Chord = Eigen::Matrix2d::Zero();
  /// By how much it contracts, in the norm max |s_k| / Unit[k].
  double Factor = 0.5;
  Vec2 Unit = Vec2::Ones();
  bool IsCartesian = false; ///< g divided by the weight is meant.
};

/// Finds the pieces by halving, see PatchRays.h.
///
/// Roots that are not isolated in the end are double (the ray touches the surface), belong to a
/// pole or lie on a curve: along that, there would be no end of pieces, and the search is given up.
class PieceSearch
{
public:
  /// g(s) = planes[k] . H(s) for the patch H; `noise` is how large g is for a root by rounding.
  PieceSearch(const Vec4* net, int p, int q, const Vec4 (&planes)[2], double noise);

  /// The pieces of `piece` that have, or may have, a root.
  const std::vector<RootPiece>& Run(const PatchPiece& piece);

private:
  enum class Verdict
  {
    Empty,
    Done,
    Halve
  };

  void Restrict(const PatchPiece& piece);
  void Cut(double* net, int dir, double t, bool keepLow) const;
  Verdict Judge(const double* net, const PatchPiece& piece, int& dir);
  bool IsOffPlane(const double* net, double a, double b, bool& within) const;
  Verdict Contract(const double* net, const PatchPiece& piece, int& dir);

  int Degree[2];
  int Size; ///< Control points.
  double Noise;
  std::vector<double> Nets; ///< A stack: all first components of a piece, then all second ones.
  std::vector<PatchPiece> Pieces;
  std::vector<RootPiece> Found;
};

} // namespace nurbs
