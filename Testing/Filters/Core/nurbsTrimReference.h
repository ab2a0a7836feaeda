// SPDX-License-Identifier: BSD-3-Clause
/// @file nurbsTrimReference.h
/// @brief A sheet with trimming loops, and the winding number of its loops as dense polylines.
#pragma once

#include "TrimPieces.h"

#include <cmath>
#include <deque>
#include <limits>
#include <utility>
#include <vector>

namespace reference
{

/// A trim curve in the sheet's normalised coordinates.
struct LoopCurve
{
  nurbs::Curve<2> Geometry;
  bool Reversed = false;
};
using Loops = std::vector<std::vector<LoopCurve>>;

inline LoopCurve Line(const nurbs::Vec2& a, const nurbs::Vec2& b)
{
  LoopCurve line;
  line.Geometry.Knots = { 0, 0, 1, 1 };
  line.Geometry.Points = { a, b };
  line.Geometry.Weights = { 1, 1 };
  line.Geometry.Pack();
  return line;
}

inline std::vector<LoopCurve> Polygon(const std::vector<nurbs::Vec2>& corners)
{
  std::vector<LoopCurve> loop;
  for (std::size_t i = 0; i < corners.size(); ++i)
  {
    loop.push_back(Line(corners[i], corners[(i + 1) % corners.size()]));
  }
  return loop;
}

/// One bilinear face. Its domain is [-3, 5] x [10, 12] (or the unit square), onto which the loops,
/// given over the unit square, are mapped. Stays where it is: its model points into it.
class TrimmedSheet
{
public:
  explicit TrimmedSheet(const Loops& loops, bool elsewhere = true)
    : Given(loops)
  {
    if (elsewhere)
    {
      this->Low = nurbs::Vec2(-3.0, 10.0);
      this->Size = nurbs::Vec2(8.0, 2.0);
    }
    const nurbs::Vec2 high = this->Low + this->Size;
    this->Sheet.Count[0] = this->Sheet.Count[1] = 2;
    this->Sheet.Knots[0] = { this->Low[0], this->Low[0], high[0], high[0] };
    this->Sheet.Knots[1] = { this->Low[1], this->Low[1], high[1], high[1] };
    for (int k = 0; k < 4; ++k)
    {
      this->Sheet.Points.push_back(
        nurbs::Vec3(k % 2 == 0 ? this->Low[0] : high[0], k / 2 == 0 ? this->Low[1] : high[1], 0.0));
    }
    this->TheModel.Faces.resize(1);
    this->TheModel.Faces[0].Geometry = this->Sheet.View();
    for (const std::vector<LoopCurve>& loop : loops)
    {
      this->TheModel.Loops.push_back(
        { std::int64_t(this->TheModel.TrimCurves.size()), std::int64_t(loop.size()) });
      for (const LoopCurve& curve : loop)
      {
        this->Curves.push_back(curve.Geometry);
        for (nurbs::Vec2& p : this->Curves.back().Points)
        {
          p = this->Parameters(p);
        }
        this->Curves.back().Pack();
        nurbs::TrimCurve trim;
        trim.Geometry = this->Curves.back().View();
        trim.Reversed = curve.Reversed;
        this->TheModel.TrimCurves.push_back(trim);
      }
    }
    this->TheModel.Faces[0].LoopCount = std::int64_t(loops.size());
  }
  TrimmedSheet(const TrimmedSheet&) = delete;
  TrimmedSheet& operator=(const TrimmedSheet&) = delete;

  const nurbs::Model& Model() const { return this->TheModel; }
  nurbs::Vec2 Parameters(const nurbs::Vec2& p) const
  {
    return this->Low + p.cwiseProduct(this->Size);
  }
  const Loops Given;

private:
  nurbs::Vec2 Low = nurbs::Vec2(0.0, 0.0);
  nurbs::Vec2 Size = nurbs::Vec2(1.0, 1.0);
  nurbs::Surface Sheet;
  std::deque<nurbs::Curve<2>> Curves;
  nurbs::Model TheModel;
};

/// The loops of a sheet as polylines over the unit square.
class Polyline
{
public:
  /// `steps` chords a knot span (lines: one).
  Polyline(const TrimmedSheet& sheet, int steps)
  {
    for (const std::vector<LoopCurve>& loop : sheet.Given)
    {
      const std::size_t first = this->Points.size();
      for (const LoopCurve& curve : loop)
      {
        this->Append(curve, curve.Geometry.Points.size() == 2 ? 1 : steps);
      }
      for (std::size_t k = first; k < this->Points.size(); ++k)
      {
        this->Next.push_back(k + 1 < this->Points.size() ? k + 1 : first);
      }
    }
  }

  /// How often the loops go round p: signed crossings of the ray to the right.
  int Winding(const nurbs::Vec2& p) const
  {
    int winding = 0;
    for (std::size_t k = 0; k < this->Points.size(); ++k)
    {
      const double* a = this->Points[k].data();
      const double* b = this->Points[this->Next[k]].data();
      const double turn = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
      winding += a[1] <= p[1] && b[1] > p[1] && turn > 0.0;
      winding -= a[1] > p[1] && b[1] <= p[1] && turn < 0.0;
    }
    return winding;
  }

  /// True if the curve may run on the other side of p than the polyline.
  bool IsNear(const nurbs::Vec2& p) const
  {
    for (std::size_t k = 0; k < this->Points.size(); ++k)
    {
      const double* a = this->Points[k].data();
      const double* b = this->Points[this->Next[k]].data();
      const double d[2] = { b[0] - a[0], b[1] - a[1] };
      const double e[2] = { p[0] - a[0], p[1] - a[1] };
      const double square = d[0] * d[0] + d[1] * d[1];
      const double along = square > 0.0 ? (d[0] * e[0] + d[1] * e[1]) / square : 0.0;
      const double t = std::min(1.0, std::max(0.0, along));
      const double distance = std::hypot(t * d[0] - e[0], t * d[1] - e[1]);
      if (distance < 4.0 * this->Bow[k] + 1e-11)
      {
        return true;
      }
    }
    return false;
  }

  std::vector<nurbs::Vec2> Points;

private:
  void Append(const LoopCurve& curve, int steps)
  {
    const nurbs::CurveView<2> view = curve.Geometry.View();
    const std::vector<nurbs::Knot> knots = nurbs::DistinctKnots(view.Knots, view.Degree);
    std::vector<nurbs::Vec2> points;
    std::vector<double> bow;
    for (std::size_t s = 0; s + 1 < knots.size(); ++s)
    {
      const double from = knots[s].Value;
      // Up to just before the next knot, where the curve may break.
      const double to = std::nextafter(knots[s + 1].Value, from);
      for (int k = 0; k <= steps; ++k)
      {
        const auto at = [&](double part) {
          return nurbs::Evaluate<2>(view, from + (to - from) * part / steps);
        };
        points.push_back(at(k));
        bow.push_back(k < steps ? (at(k + 0.5) - 0.5 * (at(k) + at(k + 1))).norm() : 0.0);
      }
    }
    if (curve.Reversed)
    {
      std::reverse(points.begin(), points.end());
      std::reverse(bow.begin(), bow.end() - 1);
    }
    this->Points.insert(this->Points.end(), points.begin(), points.end());
    this->Bow.insert(this->Bow.end(), bow.begin(), bow.end());
  }

  std::vector<std::size_t> Next;
  std::vector<double> Bow; ///< How far the curve is from the middle of a chord.
};

/// True if a ray from p to the right crosses the piece.
inline bool IsCrossed(const nurbs::TrimPieces& cut, const nurbs::TrimPiece& piece, nurbs::Vec2 p)
{
  if (p[1] < piece.Low[1] || p[1] >= piece.High[1] || p[0] >= piece.High[0])
  {
    return false;
  }
  const nurbs::Vec2 size = piece.High - piece.Low;
  nurbs::Vec2 local = (p - piece.Low).cwiseQuotient(size);
  local[0] = piece.Falling ? (piece.High[0] - p[0]) / size[0] : local[0];
  return p[0] < piece.Low[0] || LiesRight(piece, cut.Inner.data(), local);
}

/// The parity of all pieces right of p, without any search structure.
inline bool IsInside(const nurbs::TrimPieces& cut, const nurbs::Vec2& p)
{
  bool inside = false;
  for (const nurbs::TrimPiece& piece : cut.Pieces)
  {
    inside = inside != IsCrossed(cut, piece, p);
  }
  return inside;
}

/// True if p is on a piece but for rounding; not if the piece is upright, which is no matter of
/// rounding.
inline bool IsOnPiece(const nurbs::TrimPieces& cut, const nurbs::Vec2& p)
{
  const nurbs::Vec2 off(1e-12, 0.0);
  for (const nurbs::TrimPiece& piece : cut.Pieces)
  {
    if (piece.Low[0] < piece.High[0] &&
      IsCrossed(cut, piece, p - off) != IsCrossed(cut, piece, p + off))
    {
      return true;
    }
  }
  return false;
}

/// The corners of all pieces' boxes, with each other's coordinates: where rounding could go wrong.
inline std::vector<nurbs::Vec2> CriticalPoints(const nurbs::TrimPieces& cut, std::size_t most)
{
  std::vector<nurbs::Vec2> points;
  const std::size_t n = cut.Pieces.size();
  for (std::size_t k = 0; k < n * n && points.size() < most; ++k)
  {
    const nurbs::TrimPiece& a = cut.Pieces[k % n];
    const nurbs::TrimPiece& b = cut.Pieces[(k % n + k / n) % n];
    for (const nurbs::Vec2& p : { nurbs::Vec2(a.Low[0], b.Low[1]), nurbs::Vec2(a.Low[0], b.High[1]),
           nurbs::Vec2(a.High[0], b.Low[1]), nurbs::Vec2(a.High[0], b.High[1]) })
    {
      if (p.minCoeff() >= 0.0 && p.maxCoeff() < 1.0)
      {
        points.push_back(p);
      }
    }
  }
  return points;
}

} // namespace reference
