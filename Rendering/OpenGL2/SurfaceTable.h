// SPDX-License-Identifier: BSD-3-Clause
/// @file SurfaceTable.h
/// @brief Surfaces as the GPU evaluates them: control points and knots in flat float arrays.
///
/// What travels to the GPU is the surface itself: its control points, homogeneous and relative to a
/// local origin, and for every non-empty knot span the 2 p knots that de Boor's algorithm needs there,
/// so that no shader has to search a span (Tan, Zhao, Lu 2012, section 3.3, draw a quad a span for the
/// same reason). Knots are relative to their span, which is [0, 1] then: parameters in a span are
/// exact binary fractions, and single precision is lost neither to a large domain nor to a far
/// surface.
#pragma once

#include "Surface.h"

#include <array>

namespace nurbs
{

class SurfaceBound;

/// Bounds of one pair of spans (a "patch" of the surface).
struct PatchBound
{
  Eigen::AlignedBox3f Box; ///< Of the patch, relative to the surface's origin.
  /// Greatest |S_uu|, |S_uv|, |S_vv| with respect to the spans' own parameters in [0, 1].
  std::array<float, 3> Second = { 0.0f, 0.0f, 0.0f };
};

/// One surface in a SurfaceTable.
struct TableSurface
{
  SurfaceView View;               ///< The surface in double precision; Count 0: not drawable.
  int FirstPoint = 0;             ///< Of its Count[0] * Count[1] texels in Points, u fastest.
  int FirstBlock[2] = { 0, 0 };   ///< Of its spans' blocks in Knots, per direction.
  Vec3 Origin = Vec3::Zero();     ///< What Points are relative to.
  double Radius = -1.0;           ///< Half the diagonal of the control points' box.
  Box3 Bounds;                    ///< Of the part that trims leave over, in model coordinates.
  Box2 Left;                      ///< That part of the domain, as shares.
  std::vector<Interval> Spans[2]; ///< Non-empty knot spans, as shares of the domain.
  bool SidesChanged = false;      ///< By the last Move: blocks of Knots are new.
  int Used[2][2] = { { 0, 0 }, { 0, 0 } }; ///< First and end of the spans that trims leave over.
  std::vector<PatchBound> Patches;         ///< Spans[0].size() x Spans[1].size(), u fastest.

  /// False if the face can't be used.
  bool IsDrawable() const { return this->View.Count[0] > 0; }
  /// Numbers in Knots for a span.
  int BlockSize(int dir) const { return 4 + 2 * this->View.Degree[dir]; }
  /// The bounds of the patch of two spans.
  const PatchBound& Patch(int i, int j) const
  {
    return this->Patches[i + j * this->Spans[0].size()];
  }
};

/// The surfaces of one or more models.
class SurfaceTable
{
public:
  /// Adds a surface, which must stay alive as long as the table is used. Returns its index.
  /// @param used the part of the domain (shares, 0 to 1) that is not trimmed away.
  /// Throws Error if a direction has more than 65535 spans, or the table more than 2^31 - 1 points.
  int Add(const SurfaceView& surface, const Box2& used);

  /// Adds a place for a surface that can't be drawn, so that indices stay those of the faces.
  int AddNothing();

  /// Computes bounds and float points of surfaces first to last - 1 (thread-safe for distinct ones).
  void Fill(int first, int last);

  /// Replaces the control points and weights of a surface of the same degrees and knots. False if
  /// they are the same in single precision. Thread-safe for distinct surfaces.
  bool Move(int index, const SurfaceView& surface);

  /// Tells what part of the domain trims leave now, as Add did. Thread-safe for distinct surfaces.
  void Use(int index, const Box2& used);

  /// Number of surfaces.
  int Size() const { return static_cast<int>(this->Surfaces.size()); }
  /// A surface by its index.
  const TableSurface& operator[](int index) const { return this->Surfaces[index]; }

  /// Homogeneous control points relative to their surface's origin: (w x, w y, w z, w) a point.
  const std::vector<float>& GetPoints() const { return this->Points; }
  /// Blocks, one a span: start and length of the span as shares of the domain, index of the first
  /// control point in this direction, its open sides (1: the start, 2: the end, where the surface
  /// ends or has a crease), then the 2 p knots around the span relative to it.
  const std::vector<float>& GetKnots() const { return this->Knots; }

private:
  void AddSpans(TableSurface& surface, int dir);
  static bool FindUsed(TableSurface& surface, const Box2& used);
  bool FillPoints(TableSurface& surface);
  void FillBounds(TableSurface& surface);
  static void TightenBounds(TableSurface& surface);
  void FillSides(TableSurface& surface, const SurfaceBound& bound);

  std::vector<TableSurface> Surfaces;
  std::vector<float> Points;
  std::vector<float> Knots;
};

} // namespace nurbs
