// SPDX-License-Identifier: BSD-3-Clause
/// @file TrimPieces.h
/// @brief A face's trimming loops as closed chains of pieces that are monotone in u and v.
///
/// Coordinates are normalised to the face's domain: [0, 1] x [0, 1], pieces may leave it. A piece is
/// given from its end with the lower v to the one with the higher v, in the coordinates of its own
/// box, turned so that it runs from (0, 0) to (1, 1): a rational Bezier curve in standard form (both
/// end weights 1) whose ends need not be stored, and a straight piece has no other data than its box.
#pragma once

#include "Model.h"

namespace nurbs
{

/// One monotone piece.
struct TrimPiece
{
  Vec2 Low;  ///< Corner of its box with the smallest u and v.
  Vec2 High; ///< Corner with the largest u and v.
  int Degree = 1;
  bool Falling = false; ///< u decreases as v increases: u is mirrored in the box's coordinates.
  std::int32_t FirstInner =
    0; ///< First of its Degree - 1 inner coefficients, in TrimPieces::Inner.
  /// Where it is joined to its neighbours: joint k lies between piece k and the piece before it in
  /// its loop. The end with the lower v, then the other.
  std::int32_t Joint[2] = { 0, 0 };
};

/// All pieces of a face.
struct TrimPieces
{
  std::vector<TrimPiece> Pieces; ///< Loop by loop, in order.
  /// Homogeneous Bernstein coefficients times their binomials, C(n, i) w_i (x_i, y_i, 1), 0 < i < n.
  std::vector<Vec3> Inner;
  std::vector<std::int32_t> Before; ///< A joint's piece before it in the loop; the one after it: k.
};

/// Cuts the loops of a face.
///
/// Curves are cut at all extrema of u and v. Consecutive pieces share their end bit for bit. Ends of
/// curves within 1e-6 of the domain are made one (the curve moves by no more than the gap); larger
/// gaps, also from the loop's end to its start, are closed by a straight piece, as are missing sides
/// along a pole or a seam. Straight pieces within 1e-7 of a side of the domain are put on it. Curves
/// that are straight to 1e-13 become lines, degrees are lowered where that costs no more than that,
/// and pieces of no length vanish.
///
/// Throws Error if a coordinate is not finite.
TrimPieces CutTrimLoops(const Model& model, const Face& face);

/// True if, at height p.y, the piece lies to the right of p: p in its box's coordinates (0 < p < 1,
/// u mirrored if the piece is Falling). By bisection, until p is outside the box of what remains.
bool LiesRight(const TrimPiece& piece, const Vec3* inner, const Vec2& p);

} // namespace nurbs
