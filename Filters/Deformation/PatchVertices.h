// SPDX-License-Identifier: BSD-3-Clause
/// @file PatchVertices.h
/// @brief Vertices of one Bezier patch: moved by what their control points moved by, or evaluated.
///
/// Li, Lau, Green 1997, section 3.1, in homogeneous form. With H = sum N_s N_t (w P, w)_st the point is
/// the projection of H, and H + sum N_s N_t d(w P, w)_st is that after points and weights changed: one
/// rule for both. Equation (2) is the case of weights that stay. H, H_u and H_v are kept, which makes
/// the normal H_u x H_v (less w's part) as exact as that of an evaluation.
#pragma once

#include "FaceGrid.h"

namespace nurbs
{

/// A patch's vertices.
struct PatchVertices
{
  std::vector<std::int32_t> I, J;     ///< Lines of the patch's column and row.
  std::vector<std::int32_t> LineUses; ///< How many vertices are on each line of I.
  std::vector<std::int32_t> Points;   ///< Where they are in the mesh.
  std::vector<std::uint64_t> Keys;    ///< Their lines' coordinates, u's in the upper half.
  std::vector<double> Sums;           ///< H, H_u, H_v of each, 12 numbers; or nothing.
  int Updates = 0;                    ///< Since Sums were evaluated.

  /// Appends a vertex; see the members.
  void Add(std::int32_t i, std::int32_t j, std::int32_t point, std::uint64_t key);
  /// Removes a vertex; the last one takes its place.
  void Remove(std::size_t index);
  /// Number of vertices.
  std::size_t Size() const { return this->Points.size(); }
  /// True if Sums are kept.
  bool HasSums() const { return !this->Sums.empty(); }
};

/// What is added to (or makes) the vertices of a patch.
struct PatchUpdate
{
  const FaceGrid* Grid = nullptr;
  int Patch = 0;
  bool Rational = false;
  bool Reversed = false;   ///< Normals are against H_u x H_v.
  bool Accumulate = false; ///< Add to Sums; else evaluate afresh.
  bool Keep = false;       ///< Fill Sums.
  /// Homogeneous numbers of the control points (FirstU.., FirstV..) that the patch depends on, or their
  /// changes: (p + 1) x (q + 1), u fastest.
  const Vec4* Net = nullptr;
  int FirstRow = 0, LastRow = 0;     ///< Rows of Net that are not zero, inclusive.
  double Shortest[2] = { 0.0, 0.0 }; ///< Squared |S_u|, |S_v| under which a normal needs care.
};

/// Updates the vertices from `begin` on. Returns the indices of those whose normals need care, as the
/// cross product (nearly) vanishes there.
std::vector<std::int32_t> UpdateVertices(const PatchUpdate& update, PatchVertices& vertices,
  std::size_t begin, double* points, float* normals);

/// What PatchVertices::Sums takes a vertex.
constexpr std::int64_t BytesPerSum = 12 * sizeof(double);

/// H, H_u, H_v of a vertex whose basis functions are given, from all control points of its patch.
void SumVertex(
  const double* basisU, int p, const double* basisV, int q, const Vec4* net, Vec4 (&h)[3]);

/// Point and normal from H, H_u, H_v; false: the normal needs care.
bool FinishVertex(const Vec4 (&h)[3], bool rational, bool reversed, const double (&shortest)[2],
  double* point, float* normal);

} // namespace nurbs
