// SPDX-License-Identifier: BSD-3-Clause
/// @file ViewLines.h
/// @brief All lines at which what is seen of a model can change: silhouettes, edges and intersection
/// curves, projected.
#pragma once

#include "FaceIntersections.h"
#include "ImagePlane.h"
#include "Silhouette.h"

#include <memory>

namespace nurbs
{

/// A point on a line: segment + share of that segment.
using LinePosition = double;

/// A polyline on a face or an edge, and its image.
struct ViewLine
{
  LineKind Kind = LineKind::Silhouette;
  /// A silhouette's face; an edge's first use; an intersection's first face. UV of the points are in its
  /// domain.
  std::int64_t Face = -1;
  /// Intersections: the second face, and the points in its domain.
  std::int64_t OtherFace = -1;
  std::vector<Vec2> OtherUV;
  std::int64_t Edge = -1; ///< Of the completed model; -1: within the face.
  std::vector<ContourPoint> Points;
  /// Edges: shares of every use's trim curve, 0 at its Domain().Min, that belong to the points.
  std::vector<double> Shares;
  /// Edges: where silhouettes end on it, increasing; the face beside it turns away there.
  std::vector<LinePosition> Turns;
  std::vector<Vec2> Image;
  /// Edges: a silhouette runs along it, or ends on it but at its ends.
  bool MeetsSilhouette = false;
  /// All of its faces face away, and the outside of a closed shell is all that can be seen.
  bool IsBehind = false;

  /// True for edges of the model.
  bool IsEdge() const { return !this->Shares.empty(); }
  /// True where faces pierce each other.
  bool IsIntersection() const { return this->OtherFace >= 0; }
};

/// What the lines are made of.
struct ViewLines
{
  CompletedModel Whole;
  std::vector<std::vector<EdgeUse>> Uses; ///< One an edge.
  std::vector<ViewLine> Lines;
  std::vector<FaceSilhouette> Faces;
  /// Pairs of faces whose intersection curves may be missing; see FaceIntersections::Unresolved.
  std::vector<std::array<std::int64_t, 2>> Unresolved;
  /// That the lines were made with.
  std::shared_ptr<const FaceIntersections> Intersections;
  std::vector<char> IsShell; ///< One a face: it belongs to a closed, consistently oriented shell.
  /// One a face: the lowest of those that it goes on in across smooth edges that were left out.
  std::vector<std::int64_t> Cluster;
  bool Aborted = false;

  /// True if faces, or nothing (-1), are the same or in one cluster.
  bool AreJoined(std::int64_t a, std::int64_t b) const
  {
    return a == b || (a >= 0 && b >= 0 && this->Cluster[a] == this->Cluster[b]);
  }
  /// Around the images of all lines.
  Box2 Box() const;
};

/// Makes silhouettes (on their faces' left, as in Silhouette.h; closed ones repeat their first point),
/// intersection curves and all edges but degenerate ones, smooth ones and seams, too, with chords within
/// the precision of `options`. `trims`: of the model. Without `allSmooth`, smooth edges that hide
/// nothing are left out, see FaceTheSameWay. `intersections`: of the model, with the precision of
/// `options`, if they are known.
ViewLines MakeViewLines(const Model& model, const TrimIndex& trims,
  const std::vector<std::string>& faceErrors, const SilhouetteOptions& options,
  const ImagePlane& image, bool allSmooth = true,
  std::shared_ptr<const FaceIntersections> intersections = nullptr);

/// True if the line may border what is seen of a face or its cluster: it is an edge that the face uses,
/// its silhouette, or where it is pierced.
bool IsOfFace(const ViewLines& lines, const ViewLine& line, std::int64_t face);

/// The same of the face alone.
bool UsesLine(const ViewLines& lines, const ViewLine& line, std::int64_t face);

/// False if all of the face turns away from the viewer, or is seen edge-on.
bool MayFaceViewer(const FaceSilhouette& face);

/// Point of a line, and its image.
Vec3 PointAt(const ViewLine& line, LinePosition at);
/// The image point at a position.
Vec2 ImageAt(const ViewLine& line, LinePosition at);
/// (u, v) on the line's own face; on the face given, which may be the other one of an intersection.
Vec2 ParametersAt(const ViewLine& line, LinePosition at);
/// The parameters on a face at a position.
Vec2 ParametersAt(const ViewLine& line, LinePosition at, std::int64_t face);
/// The same, moved from the chord to the edge's or intersection curve; silhouettes: to the surface.
ContourPoint ExactPointAt(const ViewLines& lines, const ViewLine& line, LinePosition at);
/// Share of the trim curves; of edges only.
double ShareAt(const ViewLine& line, LinePosition at);

} // namespace nurbs
