// SPDX-License-Identifier: BSD-3-Clause
/// @file IntersectionTrim.h
/// @brief Cuts the intersection curve of two surfaces by the loops of their faces.
#pragma once

#include "FaceIntersections.h"
#include "IntersectionTracer.h"
#include "PatchCutter.h"

namespace nurbs
{

/// The trim curves of a face, found by place.
class TrimCurveTree
{
public:
  struct Piece
  {
    std::int64_t Curve;
    BezierCurve<2> Bezier;
  };

  TrimCurveTree(const Model& model, const Face& face);

  /// Calls visit(piece, t) for every place where a trim curve crosses the line through a and b, by
  /// rounding beside the chord, too.
  template <typename Visit>
  void Search(const Vec2& a, const Vec2& b, const Visit& visit) const;

private:
  std::vector<double> Crossings(const Piece& piece, const Vec2& a, const Vec2& b) const;

  Vec2 Size; ///< Of the domain.
  std::vector<Piece> Pieces;
  BoxTree Tree;
};

/// What tells the inside of a face.
struct FaceBorders
{
  const FaceTrim* Trim;
  const CoverTest* Cover;
  const TrimCurveTree* Curves;
};

/// Cuts the curves of one pair of faces.
class IntersectionCutter
{
public:
  /// `tolerance`: the faces pierce each other where both go on, beside a point of the curve, until
  /// they are that far apart.
  IntersectionCutter(SurfacePair& pair, IntersectionTracer& tracer, const FaceBorders& a,
    const FaceBorders& b, double tolerance);

  /// Appends the parts of a curve where the faces pierce each other.
  void Cut(const TracedIntersection& curve, std::vector<FaceIntersection>& out);

  /// True if nothing of a curve that is not refined can be inside both faces: each chord is trimmed
  /// away, or runs along the border of one of them in `samples` places.
  bool RunsAlongBorders(const TracedIntersection& curve, int samples);

private:
  enum class Place
  {
    Outside,
    Border, ///< Of one of the faces.
    Inside  ///< Both.
  };
  struct Crossing
  {
    std::size_t Segment;
    double Share;
    IntersectionPoint Point;
    TrimCrossing Trim;
  };
  struct Part
  {
    std::vector<IntersectionPoint> Points;
    TrimCrossing Ends[2];
    bool Pierces = false;
  };

  Place Locate(const IntersectionPoint& point);
  bool IsTrimmedAway(const IntersectionPoint& a, const IntersectionPoint& b) const;
  std::vector<Crossing> FindCrossings(const TracedIntersection& curve);
  void FindCrossings(int side, const IntersectionPoint& a, const IntersectionPoint& b,
    std::size_t segment, std::vector<Crossing>& out);
  std::vector<Part> MakeParts(
    const TracedIntersection& curve, const std::vector<Crossing>& crossings) const;
  bool PiercesAlong(const std::vector<IntersectionPoint>& points);

  SurfacePair& Pair;
  IntersectionTracer& Tracer;
  FaceBorders Borders[2];
  double Tolerance;
};

} // namespace nurbs
