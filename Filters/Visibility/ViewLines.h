// SPDX-License-Identifier: BSD-3-Clause
/// @file ViewLines.h
/// @brief All lines at which what is seen of a model can change: silhouettes and edges, projected.
#pragma once

#include "ImagePlane.h"
#include "Silhouette.h"

namespace nurbs
{

/// A point on a line: segment + share of that segment.
using LinePosition = double;

/// A polyline on a face or an edge, and its image.
struct ViewLine
{
  LineKind Kind = LineKind::Silhouette;
  bool Crease = false;
  /// A silhouette's face; an edge's first use. UV of the points are in its domain.
  std::int64_t Face = -1;
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

  bool IsEdge() const { return !this->Shares.empty(); }
};

/// What the lines are made of.
struct ViewLines
{
  CompletedModel Whole;
  std::vector<std::vector<EdgeUse>> Uses; ///< One an edge.
  std::vector<ViewLine> Lines;
  std::vector<FaceSilhouette> Faces;
  std::vector<char> IsShell; ///< One a face: it belongs to a closed, consistently oriented shell.
  bool Aborted = false;
};

/// Makes silhouettes (on their faces' left, as in Silhouette.h; closed ones repeat their first point)
/// and all edges but degenerate ones, smooth ones and seams, too, with chords within `precision`.
ViewLines MakeViewLines(const Model& model, const std::vector<std::string>& faceErrors,
  const SilhouetteOptions& options, const ImagePlane& image);

/// True if the line lies on the border of a face: it is an edge that the face uses, or its silhouette.
bool IsOfFace(const ViewLines& lines, const ViewLine& line, std::int64_t face);

/// Point of a line, and its image.
Vec3 PointAt(const ViewLine& line, LinePosition at);
Vec2 ImageAt(const ViewLine& line, LinePosition at);
/// (u, v) on the line's own face.
Vec2 ParametersAt(const ViewLine& line, LinePosition at);
/// The same, moved from the chord to the edge's curve; silhouettes: to the surface.
ContourPoint ExactPointAt(const ViewLines& lines, const ViewLine& line, LinePosition at);
/// Share of the trim curves; of edges only.
double ShareAt(const ViewLine& line, LinePosition at);

} // namespace nurbs
