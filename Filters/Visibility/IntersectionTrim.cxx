// SPDX-License-Identifier: BSD-3-Clause
#include "IntersectionTrim.h"

#include "BernsteinForm.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

// Widens boxes of trim curves, of the domain.
constexpr double BoxMargin = 1e-7;
// Crossings are looked for beyond a chord's ends by that share of it.
constexpr double EndShare = 1e-6;
// Places on a trim curve that are as near, of the curve, are the same.
constexpr double SameParameter = 1e-9;
// Sines of angles between surfaces smaller than this count as this.
constexpr double LeastSine = 0.01;
// How far the curve may be from a chord that turns by a fifth of a radian, of the chord.
constexpr double ChordBulge = 0.1;

Box3 Flat(const Box2& box)
{
  return Box3(Vec3(box.min()[0], box.min()[1], 0.0), Vec3(box.max()[0], box.max()[1], 0.0));
}

// Finds the chord that a point of the curve near a given one belongs to.
void PlaceOnCurve(
  const TracedIntersection& curve, const Vec3& point, std::size_t& segment, double& share)
{
  const auto shareOf = [&](std::size_t k) {
    const Vec3& a = curve.Points[k].Point;
    const Vec3 way = curve.Points[k + 1].Point - a;
    const double length = way.squaredNorm();
    return length > 0.0 ? way.dot(point - a) / length : 0.0;
  };
  share = shareOf(segment);
  while (share > 1.0 && segment + 2 < curve.Points.size() && shareOf(segment + 1) >= 0.0)
  {
    share = shareOf(++segment);
  }
  while (share < 0.0 && segment > 0 && shareOf(segment - 1) <= 1.0)
  {
    share = shareOf(--segment);
  }
  share = std::clamp(share, 0.0, 1.0);
}

} // namespace

TrimCurveTree::TrimCurveTree(const Model& model, const Face& face)
  : Size(face.Geometry.Domain(0).Length(), face.Geometry.Domain(1).Length())
{
  std::vector<Box3> boxes;
  for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
  {
    const TrimLoop& loop = model.Loops[l];
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
  this->Tree.Build(boxes, BoxMargin * this->Size.maxCoeff());
}

std::vector<double> TrimCurveTree::Crossings(const Piece& piece, const Vec2& a, const Vec2& b) const
{
  const Vec2 scale = this->Size.cwiseInverse();
  const Vec2 along = (b - a).cwiseProduct(scale);
  const Vec2 across(-along[1], along[0]);
  std::vector<double> distance;
  for (const Vec3& h : piece.Bezier.Points)
  {
    distance.push_back(across.dot((h.head<2>() - a * h[2]).cwiseProduct(scale)));
  }
  std::vector<double> out = SignChanges(distance);
  out.erase(std::remove_if(out.begin(), out.end(),
              [&](double t) {
                const double share = along.dot((piece.Bezier.Evaluate(t) - a).cwiseProduct(scale)) /
                  along.squaredNorm();
                return share < -EndShare || share > 1.0 + EndShare;
              }),
    out.end());
  return out;
}

template <typename Visit>
void TrimCurveTree::Search(const Vec2& a, const Vec2& b, const Visit& visit) const
{
  Box2 box(a);
  box.extend(b);
  const Box3 flat = Flat(box);
  if (!((b - a).cwiseQuotient(this->Size).norm() > 0.0))
  {
    return;
  }
  this->Tree.Search([&](const Box3& bounds) { return bounds.intersects(flat); },
    [&](std::int32_t index, const Box3&) {
      const Piece& piece = this->Pieces[index];
      for (const double t : this->Crossings(piece, a, b))
      {
        visit(piece, t);
      }
    });
}

IntersectionCutter::IntersectionCutter(SurfacePair& pair, IntersectionTracer& tracer,
  const FaceBorders& a, const FaceBorders& b, double tolerance)
  : Pair(pair)
  , Tracer(tracer)
  , Borders{ a, b }
  , Tolerance(tolerance)
{}

IntersectionCutter::Place IntersectionCutter::Locate(const IntersectionPoint& point)
{
  const CrossingFrame frame = this->Pair.Frame(point);
  if (frame.Sine < LeastSine)
  {
    return Place::Outside;
  }
  const double aside = this->Tolerance / frame.Sine;
  bool isOnBorder = false;
  for (int side = 0; side < 2; ++side)
  {
    int inside = 0;
    for (const double step : { 0.0, -aside, aside })
    {
      const Vec2 uv = point.UV[side] + step * frame.AcrossUV[side];
      // Points beyond the domain count as those on its border, which would be inside.
      inside +=
        this->Pair.IsInBox(side, uv, 1e-9) && this->Borders[side].Trim->Inside(uv[0], uv[1]);
    }
    if (inside == 0)
    {
      return Place::Outside;
    }
    isOnBorder = isOnBorder || inside < 3;
  }
  return isOnBorder ? Place::Border : Place::Inside;
}

// True if the boxes of a chord, larger by what it may bulge, are outside of one of the faces.
bool IntersectionCutter::IsTrimmedAway(const IntersectionPoint& a, const IntersectionPoint& b) const
{
  for (int side = 0; side < 2; ++side)
  {
    Box2 box(a.UV[side]);
    box.extend(b.UV[side]);
    const double margin = ChordBulge * box.sizes().maxCoeff();
    const CoverTest& cover = *this->Borders[side].Cover;
    const auto normalise = [&](const Vec2& uv) {
      return Vec2(cover.Normalise(0, uv[0]), cover.Normalise(1, uv[1]));
    };
    const Box2 wide(
      normalise(box.min() - Vec2(margin, margin)), normalise(box.max() + Vec2(margin, margin)));
    if (cover.Cover(wide) == TrimCover::None)
    {
      return true;
    }
  }
  return false;
}

bool IntersectionCutter::RunsAlongBorders(const TracedIntersection& curve, int samples)
{
  const std::size_t last = curve.Points.size() - 1;
  for (std::size_t k = 0; k < last; ++k)
  {
    const IntersectionPoint& a = curve.Points[k];
    const IntersectionPoint& b = curve.Points[k + 1];
    const bool isBeyond = (k == 0 && curve.Beyond[0]) || (k + 1 == last && curve.Beyond[1]);
    if (isBeyond || this->IsTrimmedAway(a, b))
    {
      continue;
    }
    for (int s = 0; s < samples; ++s)
    {
      const double share = (s + 0.5) / samples;
      if (this->Locate(this->Tracer.Between(a, b, share)) != Place::Border)
      {
        return false;
      }
    }
  }
  return true;
}

// Looks at the middle of the longest chord in the middle half.
bool IntersectionCutter::PiercesAlong(const std::vector<IntersectionPoint>& points)
{
  const std::size_t chords = points.size() - 1;
  std::size_t longest = chords / 2;
  double length = -1.0;
  for (std::size_t k = chords / 4; k <= std::min(chords - 1, 3 * chords / 4); ++k)
  {
    const double d = (points[k + 1].Point - points[k].Point).norm();
    if (d > length)
    {
      length = d;
      longest = k;
    }
  }
  return this->Locate(this->Tracer.Between(points[longest], points[longest + 1], 0.5)) ==
    Place::Inside;
}

// Where a chord of the curve crosses trim curves of one face, moved to where the curve does.
void IntersectionCutter::FindCrossings(int side, const IntersectionPoint& a,
  const IntersectionPoint& b, std::size_t segment, std::vector<Crossing>& out)
{
  const Vec3 way = b.Point - a.Point;
  this->Borders[side].Curves->Search(
    a.UV[side], b.UV[side], [&](const TrimCurveTree::Piece& piece, double t) {
      const int degree = piece.Bezier.Degree();
      const auto curve = [&](double s, Vec2& uv, Vec2& along) {
        const Vec3 h = DeCasteljau<3>(piece.Bezier.Points.data(), degree, s);
        uv = h.head<2>() / h[2];
        std::vector<Vec3> d(piece.Bezier.Points.size() - 1);
        for (std::size_t k = 0; k < d.size(); ++k)
        {
          d[k] = degree * (piece.Bezier.Points[k + 1] - piece.Bezier.Points[k]);
        }
        const Vec3 dh = DeCasteljau<3>(d.data(), degree - 1, s);
        along = (dh.head<2>() - dh[2] * uv) / h[2];
      };
      Crossing crossing;
      const Vec2 chord = b.UV[side] - a.UV[side];
      const double share = std::clamp(
        chord.dot(piece.Bezier.Evaluate(t) - a.UV[side]) / chord.squaredNorm(), 0.0, 1.0);
      for (int s = 0; s < 2; ++s)
      {
        crossing.Point.UV[s] = a.UV[s] + share * (b.UV[s] - a.UV[s]);
      }
      crossing.Point.Point = a.Point + share * way;
      if (!this->Pair.MoveAlongCurve(side, curve, t, crossing.Point) || t < -EndShare ||
        t > 1.0 + EndShare)
      {
        return;
      }
      crossing.Segment = segment;
      crossing.Trim.Curve = piece.Curve;
      crossing.Trim.Parameter =
        piece.Bezier.T0 + std::clamp(t, 0.0, 1.0) * (piece.Bezier.T1 - piece.Bezier.T0);
      out.push_back(crossing);
    });
}

std::vector<IntersectionCutter::Crossing> IntersectionCutter::FindCrossings(
  const TracedIntersection& curve)
{
  std::vector<Crossing> out;
  for (std::size_t k = 0; k + 1 < curve.Points.size(); ++k)
  {
    for (int side = 0; side < 2; ++side)
    {
      this->FindCrossings(side, curve.Points[k], curve.Points[k + 1], k, out);
    }
  }
  for (Crossing& crossing : out)
  {
    PlaceOnCurve(curve, crossing.Point.Point, crossing.Segment, crossing.Share);
  }
  std::sort(out.begin(), out.end(), [](const Crossing& a, const Crossing& b) {
    return std::make_pair(a.Segment, a.Share) < std::make_pair(b.Segment, b.Share);
  });
  const double same = SameParameter * this->Pair.Size();
  out.erase(std::unique(out.begin(), out.end(),
              [&](const Crossing& a, const Crossing& b) {
                return a.Trim.Curve == b.Trim.Curve &&
                  (a.Point.Point - b.Point.Point).norm() <= same;
              }),
    out.end());
  return out;
}

// The curve between its crossings, in order; of a closed one the last part goes on in the first.
std::vector<IntersectionCutter::Part> IntersectionCutter::MakeParts(
  const TracedIntersection& curve, const std::vector<Crossing>& crossings) const
{
  std::vector<Part> out(1);
  out.back().Points.push_back(curve.Points.front());
  std::size_t next = 0;
  for (std::size_t k = 0; k + 1 < curve.Points.size(); ++k)
  {
    for (; next < crossings.size() && crossings[next].Segment == k; ++next)
    {
      out.back().Points.push_back(crossings[next].Point);
      out.back().Ends[1] = crossings[next].Trim;
      out.emplace_back();
      out.back().Points.push_back(crossings[next].Point);
      out.back().Ends[0] = crossings[next].Trim;
    }
    out.back().Points.push_back(curve.Points[k + 1]);
  }
  if (curve.Closed && out.size() > 1)
  {
    Part& first = out.front();
    Part& last = out.back();
    last.Points.insert(last.Points.end(), first.Points.begin() + 1, first.Points.end());
    last.Ends[1] = first.Ends[1];
    first = std::move(last);
    out.pop_back();
  }
  // What lies beyond the boxes is no part of the faces.
  const auto drop = [&](bool beyond, Part& part, bool last) {
    if (beyond && part.Points.size() > 1)
    {
      part.Points.erase(last ? part.Points.end() - 1 : part.Points.begin());
    }
  };
  drop(curve.Beyond[0], out.front(), false);
  drop(curve.Beyond[1], out.back(), true);
  return out;
}

void IntersectionCutter::Cut(const TracedIntersection& curve, std::vector<FaceIntersection>& out)
{
  const std::vector<Crossing> crossings = this->FindCrossings(curve);
  std::vector<Part> parts = this->MakeParts(curve, crossings);
  // Where both sides of a crossing are inside, it is none.
  std::vector<Part> joined;
  for (Part& part : parts)
  {
    double length = 0.0;
    for (std::size_t k = 1; k < part.Points.size(); ++k)
    {
      length += (part.Points[k].Point - part.Points[k - 1].Point).norm();
    }
    part.Pierces = length > this->Tolerance && this->PiercesAlong(part.Points);
    if (part.Pierces && !joined.empty() && joined.back().Pierces)
    {
      std::vector<IntersectionPoint>& points = joined.back().Points;
      points.insert(points.end(), part.Points.begin() + 1, part.Points.end());
      joined.back().Ends[1] = part.Ends[1];
    }
    else
    {
      joined.push_back(std::move(part));
    }
  }
  for (Part& part : joined)
  {
    if (part.Pierces)
    {
      FaceIntersection piece;
      piece.Points = std::move(part.Points);
      piece.Closed = curve.Closed && crossings.empty();
      std::copy(part.Ends, part.Ends + 2, piece.Ends);
      out.push_back(std::move(piece));
    }
  }
}

} // namespace nurbs
