// SPDX-License-Identifier: BSD-3-Clause
#include "ContourTrim.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

// What is as near to a trim curve, of the domain, runs along it.
constexpr double AlongShare = 1e-7;
// Each makes a chord four times as near to the contour.
constexpr int MaxHalvings = 16;
// Chords are not as far from the contour as that, of the domain.
constexpr double LargestBulge = 0.1;

ContourPoint Between(const ContourPoint& a, const ContourPoint& b, double t)
{
  return { (1.0 - t) * a.UV + t * b.UV, (1.0 - t) * a.Point + t * b.Point, 0.0 };
}

Box3 Flat(const Box2& box)
{
  return Box3(Vec3(box.min()[0], box.min()[1], 0.0), Vec3(box.max()[0], box.max()[1], 0.0));
}

// Puts a point on the surface at uv.
ContourPoint PointAt(const SurfaceView& surface, const Viewer& viewer, const Vec2& uv)
{
  ContourPoint out;
  out.UV = Vec2(surface.Domain(0).Clamp(uv[0]), surface.Domain(1).Clamp(uv[1]));
  out.Point = Evaluate(surface, out.UV[0], out.UV[1]);
  const Vec3 view = viewer.Toward(out.Point);
  const double length = view.norm();
  out.Cosine = length > 0.0 ? Normal(surface, out.UV[0], out.UV[1]).dot(view) / length : 1.0;
  return out;
}

double LengthOf(const std::vector<ContourPoint>& points)
{
  double length = 0.0;
  for (std::size_t k = 1; k < points.size(); ++k)
  {
    length += (points[k].Point - points[k - 1].Point).norm();
  }
  return length;
}

// Parts of a closed contour, from `first` on: it was cut at its first point, too, where the last part
// goes on in the first one.
void JoinEnds(std::size_t first, std::vector<TrimmedContour>& out)
{
  if (out.size() == first || out.back().Ends[1].Curve >= 0 || out[first].Ends[0].Curve >= 0)
  {
    return;
  }
  TrimmedContour& head = out[first];
  TrimmedContour& tail = out.back();
  if (&head == &tail)
  {
    head.Contour.Closed = true;
    head.Contour.Points.pop_back();
  }
  else if (head.Along == tail.Along)
  {
    tail.Contour.Points.insert(
      tail.Contour.Points.end(), head.Contour.Points.begin() + 1, head.Contour.Points.end());
    tail.Ends[1] = head.Ends[1];
    head = std::move(tail);
    out.pop_back();
  }
}

} // namespace

ContourTrimmer::ContourTrimmer(
  const Model& model, std::int64_t face, const Viewer& viewer, double precision)
  : Source(model)
  , Owner(model.Faces[face])
  , View(viewer)
  , Precision(precision)
  , Trim(model, face)
  , Size(this->Owner.Geometry.Domain(0).Length(), this->Owner.Geometry.Domain(1).Length())
{
  std::vector<Box3> boxes;
  for (std::int64_t l = 0; l < this->Owner.LoopCount; ++l)
  {
    const TrimLoop& loop = model.Loops[this->Owner.FirstLoop + l];
    for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
    {
      for (BezierCurve<2>& bezier : ToBezier(model.TrimCurves[c].Geometry))
      {
        Box2 box;
        for (const Vec3& h : bezier.Points)
        {
          box.extend(Vec2(h.head<2>() / h[2]));
        }
        boxes.push_back(Flat(box));
        this->Pieces.push_back({ c, std::move(bezier) });
      }
    }
  }
  this->Tree.Build(boxes, AlongShare * this->Size.maxCoeff());
}

// Moves a crossing along the trim curve till it lies on the contour, by the secant. False if that
// fails or leaves the place.
bool ContourTrimmer::Sharpen(const Piece& piece, double t, Crossing& crossing) const
{
  const auto evaluate = [&](double s) {
    return PointAt(this->Owner.Geometry, this->View, piece.Bezier.Evaluate(s));
  };
  ContourPoint best = evaluate(t);
  const Vec3 start = best.Point;
  double before = t + (t < 0.5 ? 1e-6 : -1e-6);
  double valueBefore = evaluate(before).Cosine;
  for (int k = 0; k < 20 && std::abs(best.Cosine) > 1e-15 && best.Cosine != valueBefore; ++k)
  {
    const double next = t - best.Cosine * (t - before) / (best.Cosine - valueBefore);
    if (!(next >= 0.0 && next <= 1.0))
    {
      break;
    }
    const ContourPoint point = evaluate(next);
    if (!(std::abs(point.Cosine) < std::abs(best.Cosine)) ||
      (point.Point - start).norm() > 4.0 * this->Precision)
    {
      break;
    }
    before = t;
    valueBefore = best.Cosine;
    t = next;
    best = point;
  }
  crossing.Point = best;
  crossing.Trim.Curve = piece.Curve;
  crossing.Trim.Parameter = piece.Bezier.T0 + t * (piece.Bezier.T1 - piece.Bezier.T0);
  return std::abs(best.Cosine) <= 0.1 * ContourCosine;
}

// The point of the contour nearest to the middle of a chord, about: by Newton's method along the
// gradient of normal . view. False: it fails or leaves the place.
bool ContourTrimmer::FindMiddle(
  const ContourPoint& a, const ContourPoint& b, ContourPoint& middle) const
{
  const SurfaceView& surface = this->Owner.Geometry;
  middle = PointAt(surface, this->View, 0.5 * (a.UV + b.UV));
  for (int k = 0; k < 20 && std::abs(middle.Cosine) > 1e-14; ++k)
  {
    const SurfaceDerivatives d = EvaluateDerivatives(surface, middle.UV[0], middle.UV[1], 2);
    const Vec3 view = this->View.Toward(d.S).normalized();
    const double length = d.Su.cross(d.Sv).norm();
    const Vec2 gradient(this->Size[0] * (d.Suu.cross(d.Sv) + d.Su.cross(d.Suv)).dot(view),
      this->Size[1] * (d.Suv.cross(d.Sv) + d.Su.cross(d.Svv)).dot(view));
    const double steep = gradient.squaredNorm();
    if (!(length > 0.0 && steep > 0.0))
    {
      return false;
    }
    const Vec2 step = (-middle.Cosine * length / steep * gradient).cwiseProduct(this->Size);
    const ContourPoint next = PointAt(surface, this->View, middle.UV + step);
    if (!(std::abs(next.Cosine) < std::abs(middle.Cosine)))
    {
      break;
    }
    middle = next;
  }
  const double chord = (b.Point - a.Point).norm();
  return std::abs(middle.Cosine) <= 0.1 * ContourCosine &&
    (middle.Point - 0.5 * (a.Point + b.Point)).norm() < 0.5 * chord;
}

// Where the chord from a to b meets trim curves.
ContourTrimmer::Meeting ContourTrimmer::FindCrossings(
  const Vec2& a, const Vec2& b, std::size_t segment, std::vector<Crossing>& out) const
{
  Box2 box(a);
  box.extend(b);
  const Box3 flat = Flat(box);
  // Scaled to the domain, as u and v need not have the same unit.
  const Vec2 scale = this->Size.cwiseInverse();
  const Vec2 along = (b - a).cwiseProduct(scale);
  const double length = along.norm();
  const std::size_t first = out.size();
  Meeting meeting;
  if (!(length > 0.0))
  {
    return meeting;
  }
  const Vec2 across = Vec2(-along[1], along[0]) / length;
  this->Tree.Search([&](const Box3& bounds) { return bounds.intersects(flat); },
    [&](std::int32_t index, const Box3&) {
      const Piece& piece = this->Pieces[index];
      std::vector<double> distance;
      double gap = 1e300;
      for (const Vec3& h : piece.Bezier.Points)
      {
        distance.push_back(across.dot((h.head<2>() - a * h[2]).cwiseProduct(scale)));
        gap = std::min(gap, std::abs(distance.back()) / h[2]);
      }
      meeting.Gap = std::min(meeting.Gap, gap);
      for (const double t : SignChanges(distance))
      {
        const double share =
          along.dot((piece.Bezier.Evaluate(t) - a).cwiseProduct(scale)) / (length * length);
        if (share >= 0.0 && share < 1.0)
        {
          Crossing crossing;
          crossing.Segment = segment;
          crossing.Share = share;
          meeting.Sharp = this->Sharpen(piece, t, crossing) && meeting.Sharp;
          out.push_back(crossing);
        }
      }
    });
  std::sort(
    out.begin() + std::ptrdiff_t(first), out.end(), [](const Crossing& x, const Crossing& y) {
      return x.Share != y.Share ? x.Share < y.Share : x.Trim.Curve < y.Trim.Curve;
    });
  return meeting;
}

// Distance of a point of the contour from its chord, in the domain as scaled above.
double ContourTrimmer::Bulge(const Vec2& a, const Vec2& b, const Vec2& middle) const
{
  const Vec2 along = (b - a).cwiseQuotient(this->Size).normalized();
  const Vec2 aside = (middle - a).cwiseQuotient(this->Size);
  return std::abs(along[0] * aside[1] - along[1] * aside[0]);
}

// The crossings from a to b. The chord is halved, which appends points, where it crosses trim curves
// but the contour does not, or crosses elsewhere; and where a trim curve is so near that it could be
// the other way around.
void ContourTrimmer::AddSegment(const ContourPoint& a, const ContourPoint& b, int depth,
  std::vector<ContourPoint>& points, std::vector<Crossing>& crossings) const
{
  const std::size_t first = crossings.size();
  const Meeting meeting = this->FindCrossings(a.UV, b.UV, points.size() - 1, crossings);
  const bool near = crossings.size() == first && meeting.Gap < LargestBulge;
  ContourPoint middle;
  if (depth > 0 && (!meeting.Sharp || near) && this->FindMiddle(a, b, middle))
  {
    const double bulge = this->Bulge(a.UV, b.UV, middle.UV);
    if (!meeting.Sharp || (bulge > AlongShare && meeting.Gap < 2.0 * bulge))
    {
      crossings.resize(first);
      this->AddSegment(a, middle, depth - 1, points, crossings);
      this->AddSegment(middle, b, depth - 1, points, crossings);
      return;
    }
  }
  points.push_back(b);
}

// Where a part between two crossings lies: looked at in its middle, and beside its middle.
ContourTrimmer::Place ContourTrimmer::Locate(const std::vector<ContourPoint>& points) const
{
  // The longest chord in the middle half.
  const std::size_t chords = points.size() - 1;
  std::size_t longest = chords / 2;
  double length = -1.0;
  for (std::size_t k = chords / 4; k <= std::min(chords - 1, 3 * chords / 4); ++k)
  {
    const double d = (points[k + 1].UV - points[k].UV).cwiseQuotient(this->Size).norm();
    if (d > length)
    {
      length = d;
      longest = k;
    }
  }
  const Vec2 a = points[longest].UV;
  const Vec2 b = points[longest + 1].UV;
  const Vec2 direction = (b - a).cwiseQuotient(this->Size).normalized();
  const Vec2 aside = AlongShare * Vec2(-direction[1], direction[0]).cwiseProduct(this->Size);
  int along = 0;
  for (const double share : { 0.25, 0.5, 0.75 })
  {
    const Vec2 p = a + share * (b - a);
    const Vec2 left = p + aside;
    const Vec2 right = p - aside;
    along += this->Trim.Inside(left[0], left[1]) != this->Trim.Inside(right[0], right[1]);
  }
  if (along == 3)
  {
    return Place::Along;
  }
  const Vec2 middle = 0.5 * (a + b);
  return this->Trim.Inside(middle[0], middle[1]) ? Place::Inside : Place::Outside;
}

// The trim curve nearest to a point, of those within reach; -1: none.
std::int64_t ContourTrimmer::CurveAt(const Vec2& uv) const
{
  constexpr int Samples = 64;
  const Vec2 reach = 2.0 * AlongShare * this->Size;
  const Box3 flat = Flat(Box2(Vec2(uv - reach), Vec2(uv + reach)));
  double nearest = 1e300;
  std::int64_t curve = -1;
  this->Tree.Search([&](const Box3& bounds) { return bounds.intersects(flat); },
    [&](std::int32_t index, const Box3&) {
      const Piece& piece = this->Pieces[index];
      const auto distance = [&](double t) {
        return (piece.Bezier.Evaluate(t) - uv).cwiseQuotient(this->Size).norm();
      };
      double best = 0.0;
      for (int k = 0; k <= Samples; ++k)
      {
        best = distance(double(k) / Samples) < distance(best) ? double(k) / Samples : best;
      }
      double low = std::max(0.0, best - 1.0 / Samples);
      double high = std::min(1.0, best + 1.0 / Samples);
      for (int k = 0; k < 60; ++k)
      {
        const double third = (high - low) / 3.0;
        const bool left = distance(low + third) < distance(high - third);
        (left ? high : low) += left ? -third : third;
      }
      const double d = distance(0.5 * (low + high));
      if (d < nearest || (d == nearest && piece.Curve < curve))
      {
        nearest = d;
        curve = piece.Curve;
      }
    });
  return nearest <= 10.0 * AlongShare ? curve : -1;
}

void ContourTrimmer::Add(const SurfaceContour& contour, std::vector<ContourPoint> points,
  Place place, const TrimCrossing& start, const TrimCrossing& end,
  std::vector<TrimmedContour>& out) const
{
  TrimmedContour piece;
  piece.Contour.Kind = contour.Kind;
  piece.Contour.Points = std::move(points);
  piece.Ends[0] = start;
  piece.Ends[1] = end;
  if (place == Place::Along || contour.Kind == ContourArcKind::Border)
  {
    const std::vector<ContourPoint>& p = piece.Contour.Points;
    const std::size_t k = (p.size() - 1) / 2;
    piece.Along = this->CurveAt(Between(p[k], p[k + 1], 0.5).UV);
  }
  out.push_back(std::move(piece));
}

// The parts of one contour between its crossings; those at the same place that follow each other become
// one.
class ContourTrimmer::Parts
{
public:
  Parts(
    const ContourTrimmer& trimmer, const SurfaceContour& contour, std::vector<TrimmedContour>& out)
    : Trimmer(trimmer)
    , Source(contour)
    , Out(out)
  {}

  // Adds a part that ends in `end`.
  void Add(const std::vector<ContourPoint>& part, const TrimCrossing& end)
  {
    // What is left of a contour that ends on a trim curve is too short to be anywhere.
    if (LengthOf(part) <= 1e-3 * this->Trimmer.Precision)
    {
      this->Last = end.Curve >= 0 ? end : this->Last;
      return;
    }
    const Place place = this->Trimmer.Locate(part);
    if (!this->Points.empty() && place == this->At)
    {
      this->Points.pop_back(); // The crossing is none.
      this->Points.insert(this->Points.end(), part.begin() + 1, part.end());
    }
    else
    {
      this->Flush();
      this->Points = part;
      this->At = place;
      this->Start = this->Last;
    }
    this->Last = end;
  }

  void Flush()
  {
    if (this->Points.size() > 1 && this->At != Place::Outside)
    {
      this->Trimmer.Add(
        this->Source, std::move(this->Points), this->At, this->Start, this->Last, this->Out);
    }
    this->Points.clear();
  }

private:
  const ContourTrimmer& Trimmer;
  const SurfaceContour& Source;
  std::vector<TrimmedContour>& Out;
  std::vector<ContourPoint> Points; // Of the part so far.
  Place At = Place::Outside;
  TrimCrossing Start, Last;
};

void ContourTrimmer::Cut(const SurfaceContour& contour, std::vector<TrimmedContour>& out) const
{
  const std::size_t count = contour.Points.size();
  if (count < 2)
  {
    return;
  }
  std::vector<ContourPoint> points(1, contour.Points.front());
  std::vector<Crossing> crossings;
  const int depth = contour.Kind == ContourArcKind::Inner ? MaxHalvings : 0;
  for (std::size_t k = 1; !this->Trim.IsWhole() && k < count + (contour.Closed ? 1 : 0); ++k)
  {
    this->AddSegment(points.back(), contour.Points[k % count], depth, points, crossings);
  }
  if (crossings.empty())
  {
    const Place place = this->Trim.IsWhole() ? Place::Inside : this->Locate(points);
    if (place != Place::Outside)
    {
      this->Add(contour, contour.Points, place, {}, {}, out);
      out.back().Contour.Closed = contour.Closed;
    }
    return;
  }
  const std::size_t firstOut = out.size();
  Parts parts(*this, contour, out);
  std::vector<ContourPoint> part{ points.front() };
  std::size_t next = 0;
  for (std::size_t k = 0; k + 1 < points.size(); ++k)
  {
    for (; next < crossings.size() && crossings[next].Segment == k; ++next)
    {
      part.push_back(crossings[next].Point);
      parts.Add(part, crossings[next].Trim);
      part.assign(1, crossings[next].Point);
    }
    part.push_back(points[k + 1]);
  }
  parts.Add(part, {});
  parts.Flush();
  if (contour.Closed)
  {
    JoinEnds(firstOut, out);
  }
}

} // namespace nurbs
