// SPDX-License-Identifier: BSD-3-Clause
/// @file ContourTrim.h
/// @brief Cuts the contours of a surface by the trimming loops of its face.
#pragma once

#include "BoxTree.h"
#include "FaceContour.h"
#include "TrimIndex.h"

namespace nurbs
{

/// Where a contour ends on a trim curve.
struct TrimCrossing
{
  std::int64_t Curve = -1; ///< Index into Model::TrimCurves; -1: the contour does not end there.
  double Parameter = 0.0;
};

/// A contour, or what the loops leave of it.
struct TrimmedContour
{
  SurfaceContour Contour;
  TrimCrossing Ends[2]; ///< First and last point.
  /// The trim curve that the contour runs along, -1 if none.
  std::int64_t Along = -1;
};

/// Cuts the contours of one face. Crossings are the common roots of trim curve and contour function:
/// found on the polyline's chords by the signs of the trim curve's distance in Bernstein form, then
/// moved along the exact trim curve to normal . view = 0. Where a chord crosses a trim curve but the
/// contour does not, or elsewhere, the chord is divided on the exact contour first.
class ContourTrimmer
{
public:
  /// The model must outlive the trimmer.
  ContourTrimmer(const Model& model, std::int64_t face, const Viewer& viewer, double precision);

  /// True if a point is inside the face.
  bool IsInside(const Vec2& uv) const { return this->Trim.Inside(uv[0], uv[1]); }

  /// Appends what is inside the face. What runs along a trim curve (within 1e-7 of the domain)
  /// counts as inside.
  void Cut(const SurfaceContour& contour, std::vector<TrimmedContour>& out) const;

private:
  /// A crossing on segment Segment of a polyline, at Share of it.
  struct Crossing
  {
    std::size_t Segment;
    double Share;
    ContourPoint Point;
    TrimCrossing Trim;
  };
  struct Piece
  {
    std::int64_t Curve;
    BezierCurve<2> Bezier;
  };
  enum class Place
  {
    Outside = 0,
    Inside,
    Along
  };

  class Parts;

  /// What FindCrossings has to say about a chord.
  struct Meeting
  {
    bool Sharp = true;  ///< All crossings are crossings of the contour itself.
    double Gap = 1e300; ///< Least distance of control points of trim curves, of the domain.
  };

  Meeting FindCrossings(
    const Vec2& a, const Vec2& b, std::size_t segment, std::vector<Crossing>& out) const;
  double Bulge(const Vec2& a, const Vec2& b, const Vec2& middle) const;
  bool Sharpen(const Piece& piece, double t, Crossing& crossing) const;
  bool FindMiddle(const ContourPoint& a, const ContourPoint& b, ContourPoint& middle) const;
  void AddSegment(const ContourPoint& a, const ContourPoint& b, int depth,
    std::vector<ContourPoint>& points, std::vector<Crossing>& crossings) const;
  Place Locate(const std::vector<ContourPoint>& points) const;
  std::int64_t CurveAt(const Vec2& uv) const;
  void Add(const SurfaceContour& contour, std::vector<ContourPoint> points, Place place,
    const TrimCrossing& start, const TrimCrossing& end, std::vector<TrimmedContour>& out) const;

  const Model& Source;
  const Face& Owner;
  Viewer View;
  double Precision;
  FaceTrim Trim;
  Vec2 Size; ///< Of the domain.
  std::vector<Piece> Pieces;
  BoxTree Tree;
};

} // namespace nurbs
