// SPDX-License-Identifier: BSD-3-Clause
/// @file FaceIntersections.h
/// @brief The curves in which the trimmed faces of a model pierce each other.
///
/// Method: pairs of patches by a tree of their boxes, refuted by planes between their hulls; seeds
/// of all curves by subdivision (IntersectionSeeds.h); tracing (IntersectionTracer.h); cutting by
/// the loops of both faces (IntersectionTrim.h). See N. Patrikalakis, T. Maekawa, "Shape
/// Interrogation for Computer Aided Design and Manufacturing", 2002, chapter 5.
#pragma once

#include "ContourTrim.h"
#include "SurfacePair.h"

namespace nurbs
{

/// A curve that two faces have in common, inside both, or on the border of one at its ends.
struct FaceIntersection
{
  std::int64_t Face[2] = { -1, -1 }; ///< Face[0] < Face[1].
  /// UV[k] is of Face[k]; a closed one repeats its first point.
  std::vector<IntersectionPoint> Points;
  bool Closed = false;
  /// The trim curve, of either face, on which the first and the last point lie. Curve -1: of none,
  /// where the faces become tangent to each other.
  TrimCrossing Ends[2];
};

/// How curves are looked for.
struct FaceIntersectionOptions
{
  double Precision = 1e-4; ///< Largest distance of chords from the exact curve, a length over 0.
  ParallelFor Parallel = SerialFor;
  /// Called from any thread with the share done; false: stop.
  std::function<bool(double)> Progress;
};

/// What was found.
struct FaceIntersections
{
  std::vector<FaceIntersection> Curves; ///< By pair of faces, in order.
  /// Pairs of faces that so many parts of are near to each other that curves may be missing.
  std::vector<std::array<std::int64_t, 2>> Unresolved;
  std::int64_t Pairs = 0; ///< Of faces that were looked at.
  bool Aborted = false;
};

/// Finds all curves where two different faces without an error pierce each other. A face that
/// pierces itself is not looked at.
///
/// Faces pierce each other along a curve if each goes on beyond it on both sides until they are
/// more than the precision apart (or twice the tolerance of an edge they share, if that is more),
/// and their planes differ by more than 0.6 degrees. So nothing is reported of faces that share an
/// edge, have edges at the same place, end on each other, are tangent or coincide; nor along an
/// edge of one of them, which is a line already. Curves end where a face does: on a trim curve,
/// exactly, or at a seam, where another one goes on.
///
/// Curves are found however small they are where the two surfaces are nowhere parallel around them.
/// Where they are, patches are halved to four times the precision, or till they are apart but for
/// the precision; closed curves of that size may be missed. Patches of faces that share an edge, or
/// have one at the same place, and are still parallel somewhere at an eighth of their size are
/// taken to be tangent there.
///
/// `model`: completed (CompleteModel), so that all borders are trim curves. `trims`: its index, or
/// that of the model before. `faceErrors`: one a face, why it can't be used, or "". The result does
/// not depend on `Parallel`. Throws Error if the precision is not positive.
FaceIntersections FindIntersections(const Model& model, const TrimIndex& trims,
  const std::vector<std::string>& faceErrors, const FaceIntersectionOptions& options);

} // namespace nurbs
