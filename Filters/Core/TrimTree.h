// SPDX-License-Identifier: BSD-3-Clause
/// @file TrimTree.h
/// @brief The search structure of TrimIndex.h: a k-d tree over the monotone pieces of a face.
///
/// Whether a point p of a cell is inside is the parity of the pieces that a ray from p to the right
/// (u upwards) crosses. A leaf lists the pieces that pass through its cell and stands in for all
/// others:
/// - What lies above, below or left of the cell is never crossed.
/// - A piece right of the cell is crossed where v is in its half-open range [low, high): the parity
///   changes at two values of v. Along a loop such pieces follow each other, and the changes at a
///   joint of two of them cancel. What is left are joints with a piece that does pass through the
///   cell, which carries the change for the other: flags tell what it counts below and above its own
///   range. (Nehab and Hoppe, Random-access rendering of general vector graphics, 2008, add
///   "shortcut segments" to cells for the same end; here no curve has to be intersected.)
///
/// All decisions are comparisons of the bits of shared ends with each other and with cells' sides.
/// Rounding to float keeps the order of numbers, so that the tree is as right in float as in double.
#pragma once

#include "TrimPieces.h"

namespace nurbs
{

/// Builds the tree of a face.
class TrimTree
{
public:
  /// A line that splits a part of the domain.
  struct Node
  {
    double Split;          ///< Low child: coordinates < Split.
    int Dir;               ///< 0: of u, 1: of v.
    std::int32_t Child[2]; ///< Low, high: a node, AllOutside, AllInside or a leaf.
  };
  // What a child is, if not (>= 0) the index of a node.
  static constexpr std::int32_t AllOutside = -1;
  static constexpr std::int32_t AllInside = -2;
  static constexpr std::int32_t FirstLeaf = -3; ///< The leaf that starts at texel k: FirstLeaf - k.

  // A reference to a piece: its number << FlagBits, and what it counts below and above its range.
  static constexpr int FlagBits = 2;
  static constexpr std::int32_t Below = 1;
  static constexpr std::int32_t Above = 2;

  /// Of a leaf with `count` references: whole texels of four integers.
  static constexpr std::size_t LeafSize(std::int32_t count)
  {
    return (LeafHeader + static_cast<std::size_t>(count) + 3) / 4 * 4;
  }
  static constexpr std::size_t LeafHeader = 2;

  /// Builds the tree over [0, 1] x [0, 1]. At most 16 n + 16 references for n pieces.
  explicit TrimTree(TrimPieces pieces);

  std::int32_t Root = AllOutside;
  std::vector<Node> Nodes;
  /// 2 x (number of references) + (parity of what is not referred to); how many of them are ordered;
  /// the references, ordered ones first, from right to left: they span the cell's height and do not
  /// cross there, so that bisection finds how many lie right of a point. Zeros up to a whole texel.
  std::vector<std::int32_t> Leaves;
  TrimPieces Cut; ///< Those pieces that are referred to.

private:
  /// A cell's references and the parity of everything else.
  struct Content
  {
    std::vector<std::int32_t> References;
    bool Parity = false;
  };
  struct SplitPlane
  {
    int Dir = -1; ///< -1: none is worth it.
    double At = 0.0;
  };

  std::int32_t Build(const Box2& cell, const Content& content, std::int64_t budget, int depth);
  Content Restrict(const Content& content, const Box2& cell);
  int Side(const TrimPiece& piece, const Box2& cell) const;
  bool IsRightOf(const TrimPiece& piece, double u, double v) const;
  void Carry(const std::vector<std::int32_t>& joints, Content& content);
  SplitPlane BestSplit(const Box2& cell, const Content& content) const;
  std::int32_t MakeLeaf(const Box2& cell, const Content& content);
  std::int32_t Order(const Box2& cell, std::vector<std::int32_t>& references) const;
  const TrimPiece& PieceOf(std::int32_t reference) const
  {
    return this->Cut.Pieces[static_cast<std::size_t>(reference >> FlagBits)];
  }
  void DropUnused();

  std::vector<std::int32_t> Slot; ///< A piece's place in the content at hand, -1: not there.
};

} // namespace nurbs
