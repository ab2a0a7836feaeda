// SPDX-License-Identifier: BSD-3-Clause
/// @file Silhouette.h
/// @brief The lines of a trimmed model seen from somewhere: silhouettes and edges.
///
/// Source: X. Ruan, H. Zhang, J. Yong, "Visible region extraction from a sequence of rational Bezier
/// surfaces", 2006, sections 2 and 3. See Documentation/Papers/ruan-2006.md.
#pragma once

#include "ContourTrim.h"
#include "FeatureEdges.h"
#include "WorkShare.h"

namespace nurbs
{

/// Where from, how exact, which lines.
struct SilhouetteOptions
{
  Viewer View;
  double Precision = 1e-4; ///< Largest distance of chords from the exact curve; a length over 0.
  double FeatureAngle = 0.5235987755982988;                ///< Of sharp edges, radians; 30 degrees.
  bool Kinds[LineKindCount] = { true, true, true, false }; ///< Which lines are made, by LineKind.
  std::int64_t MaximumCells = 20000; ///< Of one patch; contours that need more are told.
  /// The part of a face, one a face: lines of different parts are not chained. Empty: one part.
  std::vector<int> Parts;
  ParallelFor Parallel = SerialFor;
  WorkShare Share; ///< Processes that all make the lines of the same model.
  /// Called from any thread with the share done, one call at a time or more; false: stop.
  std::function<bool(double)> Progress;
};

/// A directed polyline on one face. The front is on the left of a silhouette, seen from outside.
struct SilhouetteLine
{
  LineKind Kind = LineKind::Silhouette;
  std::int64_t Face = -1;
  std::int64_t Edge =
    -1;                ///< Index into the given model's edges; -1: none, or one it does not have.
  bool Crease = false; ///< Silhouette: along a knot line or smooth edge where the normal jumps.
  bool Closed = false; ///< The first point is not repeated.
  std::vector<ContourPoint> Points;
  TrimCrossing Ends[2]; ///< Silhouettes: the trim curves that they end on.
  /// The lines that go on at the first and last point, -1: none; and their ends: 0 first, 1 last.
  std::int64_t Next[2] = { -1, -1 };
  int NextEnd[2] = { 0, 0 };
  std::int64_t Chain = -1; ///< Lines with the same number are connected.
};

/// How a face's silhouette came out.
enum class SilhouetteStatus
{
  Ok = 0,
  Singular, ///< Contours cross, end or close in cells of the smallest size.
  Capped,   ///< A patch needed more than MaximumCells; its contour has gaps.
  Failed    ///< The face can't be used.
};

/// What is told of a face.
struct FaceSilhouette
{
  SilhouetteStatus Status = SilhouetteStatus::Ok;
  std::string Message; ///< Why the status is not Ok.
  std::int64_t Patches[PatchVisibilityCount] = { 0, 0, 0, 0 };
};

/// All lines of a model, and what is told of its faces.
struct Silhouettes
{
  std::vector<SilhouetteLine> Lines; ///< Silhouettes by face, then edges by their index.
  std::vector<FaceSilhouette> Faces; ///< One a face.
  /// Of the edges of the model, completed (CompleteModel); of those that are not used or degenerate it
  /// says nothing.
  std::vector<LineKind> EdgeKinds;
  std::int64_t Chains[LineKindCount] = { 0, 0, 0, 0 }; ///< Components by kind.
  /// Points of silhouettes, but those along creases, with |normal . view| over 1e-9: in singular
  /// cells, and where a trim curve runs so near to the contour that they can't be told apart.
  std::int64_t InexactPoints = 0;
  bool Aborted = false;
};

/// Makes the lines. `faceErrors`: one a face, why it can't be used, or "". The result does not depend
/// on `Parallel`. Throws Error if the precision or feature angle is not positive, the direction zero
/// or a coordinate of the viewer not finite.
Silhouettes MakeSilhouettes(
  const Model& model, const std::vector<std::string>& faceErrors, const SilhouetteOptions& options);

} // namespace nurbs
