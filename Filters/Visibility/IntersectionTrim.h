// SPDX-License-Identifier: BSD-3-Clause
/// @file IntersectionTrim.h
/// @brief Cuts the intersection curve of two surfaces by the loops of their faces.
#pragma once

#include "FaceIntersections.h"
#include "IntersectionTracer.h"

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

/// Cuts the curves of one pair of faces.
class IntersectionCutter
{
public:
  /// `tolerance`: see Pierces.
  IntersectionCutter(SurfacePair& pair, IntersectionTracer& tracer, const FaceTrim& trimA,
    const TrimCurveTree& curvesA, const FaceTrim& trimB, const TrimCurveTree& curvesB,
    double tolerance);

  /// Appends the parts of a curve where the faces pierce each other.
  void Cut(const TracedIntersection& curve, std::vector<FaceIntersection>& out);

  /// True if both faces go on, beside a point of the curve, until they are `tolerance` apart.
  bool Pierces(const IntersectionPoint& point);

private:
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

  std::vector<Crossing> FindCrossings(const TracedIntersection& curve);
  void FindCrossings(int side, const IntersectionPoint& a, const IntersectionPoint& b,
    std::size_t segment, std::vector<Crossing>& out);
  std::vector<Part> MakeParts(
    const TracedIntersection& curve, const std::vector<Crossing>& crossings) const;
  bool PiercesAlong(const std::vector<IntersectionPoint>& points);

  SurfacePair& Pair;
  IntersectionTracer& Tracer;
  const FaceTrim* Trims[2];
  const TrimCurveTree* Curves[2];
  double Tolerance;
};

} // namespace nurbs
