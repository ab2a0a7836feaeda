// SPDX-License-Identifier: BSD-3-Clause
#include "TrimPieces.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr double Negligible = 1e-13; // of the domain: what coordinates are worth
constexpr double NearEnds = 1e-6;    // of the domain: gaps that need no piece
constexpr double NearSide = 1e-7;    // of the domain: rounding of files, half a step of a float
constexpr double NearCut = 1e-12;    // of a curve's parameter range

using Points3 = std::vector<Vec3>; // Homogeneous control points of a Bezier curve.

Vec2 Cartesian(const Vec3& h)
{
  return h.head<2>() / h[2];
}

/// The binomial coefficients C(n, 0), ..., C(n, n).
std::vector<double> Binomials(int n)
{
  std::vector<double> row(n + 1, 1.0);
  for (int i = 1; i < n; ++i)
  {
    row[i] = std::round(row[i - 1] * (n - i + 1) / i);
  }
  return row;
}

double EvaluateBernstein(const std::vector<double>& c, double t)
{
  double p[2 * MaxDegree];
  std::copy(c.begin(), c.end(), p);
  for (int r = int(c.size()) - 1; r > 0; --r)
  {
    for (int i = 0; i < r; ++i)
    {
      p[i] = (1.0 - t) * p[i] + t * p[i + 1];
    }
  }
  return p[0];
}

/// Splits in the middle; `low` becomes its first half, the second is returned.
std::vector<double> Halve(std::vector<double>& low)
{
  std::vector<double> high(low);
  for (std::size_t r = 1; r < low.size(); ++r)
  {
    for (std::size_t i = 0; i + r < high.size(); ++i)
    {
      high[i] = 0.5 * (high[i] + high[i + 1]);
    }
    low[r] = high[0];
  }
  return high;
}

/// Finds where a coordinate of a rational Bezier curve turns: the sign changes of its derivative's
/// numerator, by subdivision and Descartes' rule. What is less than rounding has no sign, so that
/// straight or flat parts are not cut to shreds.
class TurnFinder
{
public:
  explicit TurnFinder(std::vector<double>& turns)
    : Turns(turns)
  {}

  /// The numerator is a polynomial of degree 2n - 2 with the coefficients (Sederberg and Wang,
  /// Rational hodographs, 1987)
  ///   D_k = 1 / C(2n-2, k) sum_i (k-2i+1) C(n, i) C(n, k-i+1) w_i w_(k-i+1) (x_(k-i+1) - x_i),
  /// products of weights and differences alone, so that its sign is as good as that of these.
  void Find(const Points3& points, int dir)
  {
    const int n = int(points.size()) - 1;
    const std::vector<double> choose = Binomials(n);
    const std::vector<double> scale = Binomials(2 * n - 2);
    std::vector<double> d(2 * n - 1, 0.0);
    std::vector<double> noise(2 * n - 1, 0.0);
    for (int k = 0; k <= 2 * n - 2; ++k)
    {
      for (int i = std::max(0, k + 1 - n); 2 * i <= k; ++i)
      {
        const Vec3& a = points[i];
        const Vec3& b = points[k - i + 1];
        const double factor = (k - 2 * i + 1) * choose[i] * choose[k - i + 1] / scale[k];
        const double step = b[dir] / b[2] - a[dir] / a[2];
        d[k] += factor * a[2] * b[2] * step;
        noise[k] += factor * a[2] * b[2] * (1.0 + std::abs(step)) * 1e-15;
      }
    }
    this->LastSign = 0;
    this->Visit(std::move(d), std::move(noise), { 0.0, 1.0 }, 0);
  }

private:
  static constexpr int MaxDepth = 48;

  void Visit(std::vector<double> d, std::vector<double> noise, Interval range, int depth)
  {
    int first = 0;
    int last = 0;
    int changes = 0;
    for (std::size_t k = 0; k < d.size(); ++k)
    {
      const int sign = std::abs(d[k]) <= noise[k] ? 0 : (d[k] > 0.0 ? 1 : -1);
      if (sign != 0)
      {
        changes += last != 0 && sign != last;
        first = first == 0 ? sign : first;
        last = sign;
      }
    }
    if (last == 0)
    {
      return;
    }
    const double middle = 0.5 * (range.Min + range.Max);
    if (changes > 1 && depth < MaxDepth)
    {
      std::vector<double> high = Halve(d);
      std::vector<double> highNoise = Halve(noise);
      this->Visit(std::move(d), std::move(noise), { range.Min, middle }, depth + 1);
      this->Visit(std::move(high), std::move(highNoise), { middle, range.Max }, depth + 1);
      return;
    }
    if (this->LastSign * first < 0)
    {
      this->Turns.push_back(0.5 * (this->LastEnd + range.Min));
    }
    if (first != last)
    {
      this->Turns.push_back(range.Min + range.Length() * Root(d, first));
    }
    this->LastSign = last;
    this->LastEnd = range.Max;
  }

  /// Where the sign changes from `first` to the other one.
  static double Root(const std::vector<double>& d, int first)
  {
    Interval t;
    for (int step = 0; step < 53; ++step)
    {
      const double middle = 0.5 * (t.Min + t.Max);
      (EvaluateBernstein(d, middle) * first > 0.0 ? t.Min : t.Max) = middle;
    }
    return 0.5 * (t.Min + t.Max);
  }

  std::vector<double>& Turns;
  int LastSign = 0;     ///< Of the derivative, where it last had one,
  double LastEnd = 0.0; ///< and up to where.
};

/// True if the curve is its chord: no point beside it, none that goes back.
bool IsStraight(const Points3& points)
{
  const Vec2 a = Cartesian(points.front());
  const Vec2 chord = Cartesian(points.back()) - a;
  const double length = chord.norm();
  double at = -Negligible * length;
  for (const Vec3& h : points)
  {
    const Vec2 p = Cartesian(h) - a;
    const double along = p.dot(chord);
    if (std::abs(p[0] * chord[1] - p[1] * chord[0]) > Negligible * length ||
      along < at - Negligible * length)
    {
      return false;
    }
    at = along;
  }
  return length > 0.0 || points.size() < 3;
}

/// The curve in parts that are monotone in both coordinates; neighbours share the bits of their end.
std::vector<Points3> CutMonotone(Points3 points)
{
  const int n = int(points.size()) - 1;
  std::vector<Points3> parts;
  if (n > 1 && !IsStraight(points))
  {
    std::vector<double> cuts;
    TurnFinder(cuts).Find(points, 0);
    TurnFinder(cuts).Find(points, 1);
    std::sort(cuts.begin(), cuts.end());
    double from = 0.0;
    for (const double cut : cuts)
    {
      if (cut - from > NearCut && 1.0 - cut > NearCut)
      {
        Points3 low(n + 1);
        Points3 high(n + 1);
        SplitBezier<3>(points.data(), n, (cut - from) / (1.0 - from), low.data(), high.data());
        parts.push_back(std::move(low));
        points.swap(high);
        from = cut;
      }
    }
  }
  parts.push_back(std::move(points));
  return parts;
}

/// Part of a loop: a monotone curve, or straight if it has no points.
struct Part
{
  Vec2 Start; ///< Its end is the next part's start.
  Points3 Curve;
};

/// One loop on its way to pieces.
class Chain
{
public:
  explicit Chain(const SurfaceView& surface)
    : Origin(surface.Domain(0).Min, surface.Domain(1).Min)
    , Size(surface.Domain(0).Length(), surface.Domain(1).Length())
  {}

  void Append(const TrimCurve& curve)
  {
    std::vector<Points3> pieces;
    for (BezierCurve<2>& piece : ToBezier(curve.Geometry))
    {
      pieces.push_back(this->Normalised(std::move(piece.Points)));
    }
    if (curve.Reversed)
    {
      std::reverse(pieces.begin(), pieces.end());
      for (Points3& points : pieces)
      {
        std::reverse(points.begin(), points.end());
      }
    }
    for (Points3& points : pieces)
    {
      this->Continue(Cartesian(points.front()));
      for (Points3& part : CutMonotone(std::move(points)))
      {
        const Vec2 end = Cartesian(part.back());
        this->Add(end, IsStraight(part) ? Points3() : std::move(part));
      }
    }
  }

  /// The finished loop.
  const std::vector<Part>& Close()
  {
    if (this->Parts.empty())
    {
      return this->Parts;
    }
    if ((this->End - this->Parts[0].Start).cwiseAbs().maxCoeff() > NearEnds)
    {
      this->Add(this->Parts[0].Start, Points3());
    }
    this->SnapToSides();
    std::vector<Part> kept;
    for (std::size_t k = 0; k < this->Parts.size(); ++k)
    {
      if (this->Parts[k].Start != this->EndOf(k))
      {
        kept.push_back(std::move(this->Parts[k]));
      }
    }
    this->Parts.swap(kept);
    return this->Parts;
  }

private:
  /// In the domain's units, greatest weight 1, of the lowest degree.
  Points3 Normalised(Points3 points) const
  {
    double greatest = 0.0;
    double least = 1.0;
    for (const Vec3& h : points)
    {
      greatest = std::max(greatest, h[2]);
    }
    for (Vec3& h : points)
    {
      h /= greatest;
      h.head<2>() = (h.head<2>() - h[2] * this->Origin).cwiseQuotient(this->Size);
      least = std::min(least, h[2]);
      if (!h.allFinite())
      {
        throw Error("a trim curve has a coordinate that is not finite");
      }
    }
    return points.size() > 2 ? ReduceBezier<3>(std::move(points), Negligible * least) : points;
  }

  void Continue(const Vec2& start)
  {
    if (this->Parts.empty())
    {
      this->End = start;
    }
    else if ((start - this->End).cwiseAbs().maxCoeff() > NearEnds)
    {
      this->Add(start, Points3());
    }
  }

  void Add(Vec2 end, Points3 curve)
  {
    this->Parts.push_back({ this->End, std::move(curve) });
    this->End = end;
  }

  const Vec2& EndOf(std::size_t k) const { return this->Parts[(k + 1) % this->Parts.size()].Start; }

  void SnapToSides()
  {
    for (std::size_t k = 0; k < this->Parts.size(); ++k)
    {
      Vec2& a = this->Parts[k].Start;
      Vec2& b = this->Parts[(k + 1) % this->Parts.size()].Start;
      for (int side = 0; side < 4 && this->Parts[k].Curve.empty(); ++side)
      {
        double& low = a[side % 2];
        double& high = b[side % 2];
        const double at = side / 2;
        if (std::abs(low - at) <= NearSide && std::abs(high - at) <= NearSide)
        {
          low = high = at;
        }
      }
    }
  }

  Vec2 Origin, Size;
  std::vector<Part> Parts;
  Vec2 End = Vec2::Zero();
};

/// The part as a piece; its joints are those at its start and its end.
void AddPiece(const Part& part, const Vec2& end, const std::int32_t (&joints)[2], TrimPieces& out)
{
  const Vec2& start = part.Start;
  const bool down = start[1] > end[1];
  TrimPiece piece;
  piece.Low = start.cwiseMin(end);
  piece.High = start.cwiseMax(end);
  piece.Falling = (start[0] > end[0]) != down && start[0] != end[0];
  piece.Joint[0] = joints[down];
  piece.Joint[1] = joints[!down];
  piece.FirstInner = std::int32_t(out.Inner.size());
  Points3 points = part.Curve;
  if (!points.empty())
  {
    if (down)
    {
      std::reverse(points.begin(), points.end());
    }
    const Vec2 from = Cartesian(points.front());
    const Vec2 size = Cartesian(points.back()) - from;
    if (size.cwiseAbs().minCoeff() > Negligible)
    {
      // The factors by which reparametrisation gives both ends the weight 1 (Farin, section 13.8).
      const int n = piece.Degree = int(points.size()) - 1;
      const std::vector<double> choose = Binomials(n);
      const double ratio = points[0][2] / points[n][2];
      for (int i = 1; i < n; ++i)
      {
        const Vec2 p = (Cartesian(points[i]) - from).cwiseQuotient(size);
        const double weight =
          choose[i] * points[i][2] / points[0][2] * std::pow(ratio, double(i) / n);
        out.Inner.push_back(weight * Vec3(p[0], p[1], 1.0));
      }
    }
  }
  out.Pieces.push_back(piece);
}

} // namespace

TrimPieces CutTrimLoops(const Model& model, const Face& face)
{
  TrimPieces out;
  for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
  {
    Chain chain(face.Geometry);
    const TrimLoop& loop = model.Loops[l];
    for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
    {
      chain.Append(model.TrimCurves[c]);
    }
    const std::vector<Part>& parts = chain.Close();
    const auto first = std::int32_t(out.Pieces.size());
    const auto count = std::int32_t(parts.size());
    for (std::int32_t k = 0; k < count; ++k)
    {
      const std::int32_t next = (k + 1) % count;
      AddPiece(parts[k], parts[next].Start, { first + k, first + next }, out);
      out.Before.push_back(first + (k + count - 1) % count);
    }
  }
  return out;
}

bool LiesRight(const TrimPiece& piece, const Vec3* inner, const Vec2& p)
{
  if (piece.Degree == 1)
  {
    return (p[1] > p[0]) != piece.Falling;
  }
  const Vec3* b = inner + piece.FirstInner - 1; // b[i] is the coefficient i
  const int n = piece.Degree;
  Interval t;
  // In every step the box of what remains halves its parameter range, and loses half of its area or so.
  for (int step = 0; step < 60; ++step)
  {
    const double middle = 0.5 * (t.Min + t.Max);
    Vec3 h;
    if (middle <= 0.5) // Horner's scheme in t / (1 - t), which the projection cancels
    {
      const double r = middle / (1.0 - middle);
      h = Vec3(r, r, r);
      for (int i = n - 1; i > 0; --i)
      {
        h = (h + b[i]) * r;
      }
      h[2] += 1.0;
    }
    else
    {
      const double r = (1.0 - middle) / middle;
      h = Vec3(0.0, 0.0, r);
      for (int i = 1; i < n; ++i)
      {
        h = (h + b[i]) * r;
      }
      h += Vec3::Ones();
    }
    const bool right = h[0] > p[0] * h[2];
    const bool higher = h[1] > p[1] * h[2];
    if (right != higher)
    {
      return right != piece.Falling;
    }
    (higher ? t.Max : t.Min) = middle;
  }
  return false; // on the curve
}

} // namespace nurbs
