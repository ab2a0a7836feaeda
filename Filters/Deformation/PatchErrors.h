// SPDX-License-Identifier: BSD-3-Clause
/// @file PatchErrors.h
/// @brief How far triangles can be from a Bezier patch, and by how much that changes when it moves.
///
/// For every triangle with corners on the surface, in a parameter box a x b,
///   |S - L| <= 1/8 (a^2 max|S_uu| + 2 a b max|S_uv| + b^2 max|S_vv|)
/// (Filters/Core/SurfaceBound.h). The maxima are those of the control points of the derivatives over
/// the box (PatchBound.h). When control points move by V and weights stay, S moves by the surface that
/// has the V as control points, and its maxima tell by how much those of S can have changed: the sums
/// of all frames' maxima, three numbers a patch, bound every cell of it without looking at the cell.
#pragma once

#include "FaceGrid.h"

namespace nurbs
{

/// Bounds of |S_uu|, |S_uv|, |S_vv|, or sums of such.
struct SecondBound
{
  double Uu = 0.0, Uv = 0.0, Vv = 0.0;
  /// The sum, entry by entry.
  void operator+=(const SecondBound& other)
  {
    this->Uu += other.Uu;
    this->Uv += other.Uv;
    this->Vv += other.Vv;
  }
  /// The greater one, entry by entry.
  void Extend(const SecondBound& other)
  {
    this->Uu = std::max(this->Uu, other.Uu);
    this->Uv = std::max(this->Uv, other.Uv);
    this->Vv = std::max(this->Vv, other.Vv);
  }
  /// The bound of |S - L| over a box a x b.
  double Bow(double a, double b) const
  {
    return 0.125 * (a * a * this->Uu + 2.0 * a * b * this->Uv + b * b * this->Vv);
  }
};

/// A patch in Bezier form, homogeneous.
class BezierNet
{
public:
  /// @param net the (p + 1) x (q + 1) control points that the patch depends on.
  void Make(const FaceGrid& grid, int patch, bool rational, const Vec4* net);

  /// Bounds over a part of the patch.
  SecondBound Second(const ParameterBox& box) const;
  /// Bounds of |S_u| and |S_v| over the patch.
  Vec2 First() const;
  /// The middle of the control points' box.
  Vec3 Middle() const;

private:
  friend class NetPath;
  int P = 0, Q = 0;
  bool Rational = false;
  ParameterBox Box;
  std::vector<Vec4> Points;
};

/// The Bezier points of a patch and of the halves of halves of it that a walk through its cells asks for.
class NetPath
{
public:
  /// A walk begins at the whole patch.
  void Start(const BezierNet& net);
  /// Goes on to a half (0, 1) in a direction, or back.
  void Push(int direction, int half) { this->Steps.push_back({ direction, half }); }
  /// Back to what the last Push went on from.
  void Pop();
  /// Bounds over the present part, times the squares and product of its extents: the sum of them, the
  /// mixed one twice, is 8 times the bound of |S - L|.
  SecondBound Scaled();

private:
  const Vec4* Top();
  struct Step
  {
    int Direction, Half;
  };
  int P = 0, Q = 0;
  bool Rational = false;
  std::vector<Step> Steps;
  std::vector<std::vector<Vec4>> Levels; ///< After so many steps.
  std::vector<double> Shares[2];
  std::size_t Made = 0; ///< The last of them that is that of the present way.
  std::vector<Vec4> Less,
    Steps4; ///< The part less a bilinear surface, with its weights; for memory.
};

/// Squared |S_u| and |S_v| under which a normal needs care: small shares of the longest steps of the
/// control points that a patch depends on. A matter of cost only, see EvaluatorKernel.h.
void ShortestDerivatives(
  const FaceGrid& grid, int patch, bool rational, const Vec4* net, double (&squared)[2]);

} // namespace nurbs
