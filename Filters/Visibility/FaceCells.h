// SPDX-License-Identifier: BSD-3-Clause
/// @file FaceCells.h
/// @brief The map of one face's (u, v) domain, and what of it is seen.
///
/// The domain is cut along the face's trim curves and other lines, snapped to a grid of 2^-28 of it
/// (SnapRounding.h). Each cell is looked at in a few places. If the looks differ, or those beside a
/// cell's border tell otherwise, a line is missing there or is not where it should be. Then the line is
/// searched for: the cell is divided into triangles, points of the line are found by bisection between
/// looks that differ, and become vertices of the triangles, till the line runs along their sides. This is
/// Delaunay refinement, as in J.-D. Boissonnat, S. Oudot, "Provably good sampling and meshing of
/// surfaces", 2005, in the plane, with looks in place of intersections with a surface.
#pragma once

#include "HalfEdges.h"
#include "PlanarMap.h"
#include "RegionLoops.h"

#include <map>
#include <optional>

namespace nurbs
{

/// How a face is looked at.
struct FaceView
{
  std::function<bool(const Vec2&)> IsSeen;  ///< True if the viewer sees the point at (u, v).
  std::function<Vec2(const Vec2&)> ImageOf; ///< Where it is in the image.
};

// A segment of the map.
struct DomainSegment
{
  std::int64_t Curve = -1;     // Trim curve; -1: a line within the face.
  double From = 0.0, To = 1.0; // Shares of the curve's domain at its ends.
  bool IsTrim = false;         // The face ends there; also gaps between trim curves.
  bool IsShadow = false;       // What hides the face ends there.
};

// A segment that runs along an edge of the map.
struct DomainSource
{
  std::int32_t Segment = 0;
  bool Backward = false;
};

// What is known of a cell.
enum class Sight : char
{
  Outside,
  Unknown,
  Hidden,
  Visible
};

/// Made of lines, then looked at, then asked for loops.
class FaceCells
{
public:
  /// @param precision a length in the image, and of chords on the surface. The model must outlive it.
  FaceCells(const Model& model, std::int64_t face, double precision)
    : Data(model)
    , Index(face)
    , Surface(model.Faces[face].Geometry)
    , Precision(precision)
    , Corner(this->Surface.Domain(0).Min, this->Surface.Domain(1).Min)
    , Size(this->Surface.Domain(0).Length(), this->Surface.Domain(1).Length())
  {}

  /// The face's trim curves, cut where pieces of `traced` end.
  void AddTrims(const std::vector<RegionLoop>& traced);
  /// A line within the domain. `isShadow`: what hides the face ends there.
  void AddPolyline(const std::vector<Vec2>& points, bool isShadow);
  /// Divides the domain and looks at the cells within the face, `besideShadows` also from both sides of
  /// these; returns the number of places where what is
  /// seen and what is not are not told apart to the precision.
  std::int64_t Look(const FaceView& view, bool besideShadows);
  /// All cells within the face are so, and there are some.
  bool All(Sight sight) const;
  /// The borders of the union of such cells, with it on the left.
  std::vector<RegionLoop> Loops(Sight sight) const;

private:
  GridPoint ToGrid(const Vec2& uv) const;
  Vec2 ToDomain(const Vec2& grid) const;
  void AddPoint(const Vec2& uv);
  void AddSegment(const DomainSegment& segment);
  std::vector<double> SharesOf(std::int64_t curve, std::vector<double> cuts) const;
  void AddChords(const BezierCurve<2>& piece, double s, double t, int depth,
    const std::function<void(double)>& add) const;
  Vec2 OnCurve(std::int64_t curve, double share) const;
  void MakeMap(double sideReach = SideReach);
  void CollectSources();
  void PlaceVertices();
  void FindInside();
  void JoinUnknown();
  std::vector<PlanarSample> LooksOf(std::int32_t cell) const;
  std::vector<char> LookAtCells(const FaceView& view);
  bool IsShadow(std::int32_t edge) const;
  std::optional<Vec2> Aside(const FaceView& view, const Vec2& at, const Vec2& along,
    const Vec2& inside, double reach, double least) const;
  void LookBesideShadows(const FaceView& view, std::vector<char>& mixed) const;
  // A triangle by its corners, what its middle shows, and points within at which that ends.
  using Triangle = std::array<GridPoint, 3>;
  struct TriangleLook
  {
    Sight Middle = Sight::Unknown;
    std::vector<GridPoint> Border;
  };
  using TriangleLooks = std::map<Triangle, TriangleLook>;
  std::vector<std::int32_t> Divide(const std::vector<char>& cells);
  void AddVertices(std::vector<GridPoint> added);
  std::optional<GridPoint> BorderBetween(
    const FaceView& view, const Vec2& from, const Vec2& to, const Triangle& within) const;
  TriangleLook LookAtTriangle(
    const FaceView& view, const Triangle& corners, const PlanarSample& middle) const;
  std::vector<GridPoint> LookAtTriangles(const FaceView& view, const std::vector<Sight>& known,
    std::int64_t& unsettled, TriangleLooks& looks);
  std::int64_t Refine(const FaceView& view, const std::vector<char>& mixed);
  double ShareAt(const DomainSource& source, std::int32_t vertex) const;
  std::int32_t SourceOf(HalfEdge half) const;
  RegionLoop LoopOf(std::vector<HalfEdge> halves) const;

  const Model& Data;
  std::int64_t Index;
  const SurfaceView& Surface;
  double Precision;
  Vec2 Corner, Size; // Of the domain.
  std::vector<GridPoint> Points;
  std::vector<Vec2> Exact; // One a point.
  std::vector<GridSegment> Segments;
  std::vector<DomainSegment> Origins; // One a segment.
  SnappedSegments Snapped;
  PlanarMap Plane;
  std::vector<std::int64_t> SourceStart; // One an edge, into Sources; and the end.
  std::vector<DomainSource> Sources;
  std::vector<Vec2> Places;  // One a vertex.
  std::vector<Sight> Sights; // One a cell.
};

} // namespace nurbs
