// SPDX-License-Identifier: BSD-3-Clause
/// @file FrontMap.h
/// @brief The image of a model as a planar map: which surface is in front where.
///
/// All lines at which the front surface can change are snapped to a grid (SnapRounding.h) and cut the
/// image into cells (PlanarMap.h). One line of sight a cell then tells its surface. So regions are
/// unions of cells whatever coincides or nearly does in the image, and a wrong answer is never wider
/// than what is narrower than a pixel. The paper takes pairs of projected surfaces and finds who hides
/// whom by one line of sight (Ruan, Zhang, Yong 2006, section 4).
#pragma once

#include "PlanarMap.h"
#include "ViewLines.h"

#include <algorithm>

namespace nurbs
{

/// What a line of sight meets first.
struct FrontHit
{
  std::int64_t Face = -1; ///< -1: nothing.
  Vec2 UV = Vec2::Zero();
  Vec3 Point = Vec3::Zero();
  bool FromBehind = false; ///< Its inside faces the viewer.
};

/// A part of a line.
struct LinePart
{
  std::int32_t Line = -1;
  LinePosition From = 0.0, To = 0.0; ///< From <= To.
  /// It is an edge of another map of the same lines, and runs straight between these vertices of it, so
  /// that what met there meets again.
  bool IsSnapped = false;
  GridPoint Ends[2];
};

/// A line that runs along an edge of the map.
struct LineSource
{
  std::int32_t Line = -1;
  std::int32_t Segment = 0; ///< Index into FrontMap::Segments.
  bool Backward = false;    ///< The line runs from the edge's end to its start.
  /// Bits 0 and 1: the surface seen on the left and right of the edge (from start to end) ends here,
  /// at this line of its own. Of a curve in which two faces pierce each other: it is seen.
  std::uint8_t Shows = 0;
  /// Nothing is in front of the line here, though its own surface is too narrow to have a cell, or seen
  /// edge-on.
  bool IsBare = false;
};

/// The map of the image: its cells, what is in front in each, and where edges come from.
struct FrontMap
{
  double Pixel = 1.0;         ///< Size, a length in the image.
  Vec2 Center = Vec2::Zero(); ///< Image point of grid point (0, 0).
  SnappedSegments Snapped;
  PlanarMap Plane;
  /// What was given to SnapRound: parts of lines between two of their points, or less; by line, and in
  /// order along it.
  std::vector<LinePart> Segments;
  std::vector<std::int64_t> FirstSegment; ///< One a line, into Segments; and the end.
  std::vector<std::int64_t> SourceStart;  ///< One an edge of the map, into Sources; and the end.
  std::vector<LineSource> Sources;        ///< Of an edge by their segments.
  std::vector<FrontHit> Cells;            ///< What is in front, by cell.
  /// A front surface that is seen in one place of a cell, and another one in another: the surfaces
  /// pierce each other, or touch. Pairs of faces, each once, sorted.
  std::vector<std::array<std::int64_t, 2>> Piercing;

  /// True for cells that are too narrow to be looked into: under about a pixel and a half.
  bool IsSliver(std::int32_t cell) const;
  /// The cell to the left (0) or right (1) of an edge.
  std::int32_t Cell(std::int32_t edge, int side) const { return this->Plane.Sides[edge][side]; }
  /// What is in front in that cell.
  const FrontHit& Front(std::int32_t edge, int side) const
  {
    return this->Cells[this->Cell(edge, side)];
  }
  /// The image point of a point of the grid.
  Vec2 ToImage(const Vec2& grid) const { return this->Center + this->Pixel * grid; }
  /// The image point of a vertex.
  Vec2 VertexImage(std::int32_t vertex) const
  {
    const GridPoint& p = this->Snapped.Vertices[vertex];
    return this->ToImage(Vec2(double(p.X), double(p.Y)));
  }
  /// The edge of an entry of Snapped.Path, and the sources of an edge.
  static std::int32_t EdgeOf(std::int32_t entry) { return entry < 0 ? ~entry : entry; }
  /// Likewise.
  ArrayView<LineSource> SourcesOf(std::int32_t edge) const
  {
    return { this->Sources.data() + this->SourceStart[edge],
      std::size_t(this->SourceStart[edge + 1] - this->SourceStart[edge]) };
  }
  /// The source of an edge that a segment is.
  const LineSource& SourceOf(std::int32_t edge, std::int64_t segment) const
  {
    const ArrayView<LineSource> sources = this->SourcesOf(edge);
    return *std::lower_bound(sources.begin(), sources.end(), std::int32_t(segment),
      [](const LineSource& source, std::int32_t s) { return source.Segment < s; });
  }
  /// A point of the image within a side's cell, a few pixels from the middle of an edge, or nearer
  /// where the cell is narrow.
  Vec2 Beside(std::int32_t edge, int side) const
  {
    return this->ToImage(this->Plane.SideSamples[edge][side].Point);
  }
  /// Where a source's line passes a vertex of its segment's path, as near as the vertex is to it.
  LinePosition At(
    const std::vector<ViewLine>& lines, const LineSource& source, std::int32_t vertex) const;
};

/// A line along one edge of the map.
struct LineStep
{
  std::int32_t Edge;
  std::int64_t Source; ///< Index into FrontMap::Sources.
};

/// Follows lines through a map.
class LineWalk
{
public:
  /// Both must outlive this.
  LineWalk(const std::vector<ViewLine>& lines, const FrontMap& map);

  /// All steps of a line, in order.
  std::vector<LineStep> Steps(std::int64_t line) const;
  /// The side of the step's edge that is the line's left (0) or right (1) side.
  int Side(const LineStep& step, int lineSide) const
  {
    return this->Map.Sources[step.Source].Backward ? 1 - lineSide : lineSide;
  }
  /// The cell on a side of the line.
  std::int32_t Cell(const LineStep& step, int lineSide) const
  {
    return this->Map.Cell(step.Edge, this->Side(step, lineSide));
  }
  /// Positions of a step's ends on its line.
  LinePosition Start(const LineStep& step) const;
  /// Likewise.
  LinePosition End(const LineStep& step) const;
  /// The end of the steps from `first` on along which nothing changes beside the line: no other line
  /// meets it, and no silhouette ends on it. (A line may become hidden where its cell goes on: all
  /// lines touch the silhouette at which they turn away.)
  std::size_t GroupEnd(const std::vector<LineStep>& steps, std::size_t first) const;
  /// The step of a group where there is most room on a side; about the middle one if there is enough.
  const LineStep& Widest(
    const std::vector<LineStep>& steps, std::size_t first, std::size_t last, int lineSide) const;

private:
  bool TurnsBetween(const LineStep& before, const LineStep& step) const;

  const std::vector<ViewLine>& Lines;
  const FrontMap& Map;
  std::vector<std::int32_t> Degree; // Edges at each vertex.
};

/// Looks along a line of sight.
FrontHit LookAt(const RayCaster& caster, const ImagePlane& image, const Vec2& at);

/// All lines that are not IsBehind, whole.
std::vector<LinePart> LinesInView(const ViewLines& lines);

/// The map without a look at its cells: Cells and Piercing stay empty.
FrontMap MakeLineMap(const ViewLines& lines, const std::vector<LinePart>& parts, double pixel,
  const ParallelFor& parallel);

/// Makes the map of parts of lines, given by line and in order. `pixel`: a length. Stops early, with no cells, when
/// `progress`, which is called from this thread, returns false.
FrontMap MakeFrontMap(const ViewLines& lines, const std::vector<LinePart>& parts,
  const ImagePlane& image, const RayCaster& caster, double pixel, const ParallelFor& parallel,
  const std::function<bool(double)>& progress);

/// Gives cells narrower than about a pixel to a neighbour: to the one that keeps as much as possible
/// of lines that a surface seen beside ends at.
void AbsorbSlivers(const ViewLines& lines, FrontMap& map);

/// Finds for every source on which sides of the edge the surface that is seen ends at that line.
void FindShownLines(const ViewLines& lines, const ImagePlane& image, const RayCaster& caster,
  FrontMap& map, const ParallelFor& parallel);

} // namespace nurbs
