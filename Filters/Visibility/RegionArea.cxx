// SPDX-License-Identifier: BSD-3-Clause
#include "RegionArea.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>

namespace nurbs
{

namespace
{

constexpr double SeriesTolerance = 1e-11;
constexpr int Orders[] = { 3, 6, 12, 24 }; // Numbers of coefficients that are tried.
constexpr double LineTolerance = 1e-10;    // Of integrals along curves, as a share of the area.
constexpr int MaxHalvings = 12;
constexpr double ShortStep = 0.02; // Of a polyline, as a share of the domain: three points do.
constexpr double PI = 3.141592653589793238462643383280;

struct Rule
{
  std::vector<double> X, W; // On [-1, 1].
};

// Gauss-Legendre nodes by Newton's method.
Rule GaussRule(int n)
{
  Rule out;
  for (int k = 0; k < n; ++k)
  {
    double x = std::cos(PI * (k + 0.75) / (n + 0.5));
    double derivative = 1.0;
    for (int step = 0; step < 100; ++step)
    {
      double before = 1.0;
      double p = x;
      for (int i = 2; i <= n; ++i)
      {
        const double next = ((2 * i - 1) * x * p - (i - 1) * before) / i;
        before = p;
        p = next;
      }
      derivative = n * (x * p - before) / (x * x - 1.0);
      const double change = p / derivative;
      x -= change;
      if (std::abs(change) < 1e-16)
      {
        break;
      }
    }
    out.X.push_back(x);
    out.W.push_back(2.0 / ((1.0 - x * x) * derivative * derivative));
  }
  return out;
}

const Rule& Gauss(int n)
{
  static const std::array<Rule, 25> rules = []() {
    std::array<Rule, 25> all;
    for (int k = 2; k <= 24; ++k)
    {
      all[k] = GaussRule(k);
    }
    return all;
  }();
  return rules[n];
}

// p[k] = Legendre polynomial of degree k, k <= n.
void Legendre(double x, int n, double* p)
{
  p[0] = 1.0;
  p[1] = x;
  for (int k = 2; k <= n; ++k)
  {
    p[k] = ((2 * k - 1) * x * p[k - 1] - (k - 1) * p[k - 2]) / k;
  }
}

// |S_u x S_v| on one knot span, as a series in both parameters.
struct Series
{
  int Order = 0;
  int Count[2] = { 0, 0 }; // Of coefficients that matter, u and v; 1: constant.
  std::vector<double> C;   // Order x Order, of u fastest.

  // Sums over v, and integrates over u from the span's start to x in [-1, 1].
  double Integral(double x, double y) const
  {
    double u[26];
    double v[26];
    Legendre(x, this->Count[0], u);
    Legendre(y, this->Count[1], v);
    double sum = 0.0;
    for (int i = 0; i < this->Count[0]; ++i)
    {
      double c = 0.0;
      for (int j = 0; j < this->Count[1]; ++j)
      {
        c += this->C[i + j * this->Order] * v[j];
      }
      // The integral of P_i from -1 to x.
      sum += c * (i == 0 ? x + 1.0 : (u[i + 1] - u[i - 1]) / (2 * i + 1));
    }
    return sum;
  }

  // Finds how many coefficients matter; false if there may be more than there are.
  bool Settle()
  {
    double largest = 0.0;
    for (const double c : this->C)
    {
      largest = std::max(largest, std::abs(c));
    }
    this->Count[0] = this->Count[1] = 1;
    for (int j = 0; j < this->Order; ++j)
    {
      for (int i = 0; i < this->Order; ++i)
      {
        if (std::abs(this->C[i + j * this->Order]) > SeriesTolerance * largest)
        {
          this->Count[0] = std::max(this->Count[0], i + 1);
          this->Count[1] = std::max(this->Count[1], j + 1);
        }
      }
    }
    return std::max(this->Count[0], this->Count[1]) <= this->Order - 2;
  }
};

class SpeedIntegral
{
public:
  explicit SpeedIntegral(const SurfaceView& surface)
    : Surface(surface)
  {
    for (int dir = 0; dir < 2; ++dir)
    {
      const Interval domain = surface.Domain(dir);
      this->Breaks[dir].push_back(domain.Min);
      for (const double knot : surface.Knots[dir])
      {
        if (knot > this->Breaks[dir].back() && knot < domain.Max)
        {
          this->Breaks[dir].push_back(knot);
        }
      }
      this->Breaks[dir].push_back(domain.Max);
    }
  }

  // P(u, v).
  double operator()(const Vec2& uv)
  {
    const int i = this->Span(0, uv[0]);
    const int j = this->Span(1, uv[1]);
    const double y = this->Local(1, j, uv[1]);
    double sum = 0.0;
    for (int k = 0; k <= i; ++k)
    {
      const double half = 0.5 * (this->Breaks[0][k + 1] - this->Breaks[0][k]);
      sum += half * this->At(k, j).Integral(k < i ? 1.0 : this->Local(0, i, uv[0]), y);
    }
    return sum;
  }

private:
  int Span(int dir, double t) const
  {
    const std::vector<double>& b = this->Breaks[dir];
    const auto k = std::upper_bound(b.begin() + 1, b.end() - 1, t) - b.begin() - 1;
    return int(k);
  }
  double Local(int dir, int span, double t) const
  {
    const std::vector<double>& b = this->Breaks[dir];
    return std::clamp(2.0 * (t - b[span]) / (b[span + 1] - b[span]) - 1.0, -1.0, 1.0);
  }
  const Series& At(int i, int j)
  {
    Series& series = this->All[{ i, j }];
    bool settled = series.Order > 0;
    for (std::size_t k = 0; k < std::size(Orders) && !settled; ++k)
    {
      this->Expand(i, j, Orders[k], series);
      settled = series.Settle();
    }
    return series;
  }
  void Expand(int i, int j, int n, Series& series) const;

  const SurfaceView& Surface;
  std::vector<double> Breaks[2];
  std::map<std::array<int, 2>, Series> All;
};

void SpeedIntegral::Expand(int i, int j, int n, Series& series) const
{
  const Rule& rule = Gauss(n);
  series.Order = n;
  series.C.assign(n * n, 0.0);
  const auto at = [&](int dir, int span, double x) {
    const double a = this->Breaks[dir][span];
    return a + 0.5 * (x + 1.0) * (this->Breaks[dir][span + 1] - a);
  };
  double p[26];
  double q[26];
  for (int b = 0; b < n; ++b)
  {
    std::vector<double> row(n, 0.0);
    for (int a = 0; a < n; ++a)
    {
      const SurfaceDerivatives d =
        EvaluateDerivatives(this->Surface, at(0, i, rule.X[a]), at(1, j, rule.X[b]), 1);
      const double speed = d.Su.cross(d.Sv).norm();
      Legendre(rule.X[a], n, p);
      for (int k = 0; k < n; ++k)
      {
        row[k] += (k + 0.5) * rule.W[a] * speed * p[k];
      }
    }
    Legendre(rule.X[b], n, q);
    for (int m = 0; m < n; ++m)
    {
      for (int k = 0; k < n; ++k)
      {
        series.C[k + m * n] += (m + 0.5) * rule.W[b] * q[m] * row[k];
      }
    }
  }
}

// The integral of P dv along a path t -> (u, v), v_t, by n points.
template <typename Path>
double SumAlong(SpeedIntegral& speed, const Path& path, double from, double to, int n)
{
  const Rule& rule = Gauss(n);
  double out = 0.0;
  for (int k = 0; k < n; ++k)
  {
    Vec2 uv;
    double slope = 0.0;
    path(0.5 * (from + to) + 0.5 * (to - from) * rule.X[k], uv, slope);
    out += rule.W[k] * slope * speed(uv);
  }
  return 0.5 * (to - from) * out;
}

// The same, by halving until it settles.
template <typename Path>
double AlongPath(
  SpeedIntegral& speed, const Path& path, double a, double b, double tolerance, int depth)
{
  const double coarse = SumAlong(speed, path, a, b, 5);
  const double fine = SumAlong(speed, path, a, b, 8);
  if (depth == 0 || std::abs(fine - coarse) <= tolerance)
  {
    return fine;
  }
  const double middle = 0.5 * (a + b);
  return AlongPath(speed, path, a, middle, 0.5 * tolerance, depth - 1) +
    AlongPath(speed, path, middle, b, 0.5 * tolerance, depth - 1);
}

} // namespace

std::vector<RegionLoop> WholeRegion(const Model& model, std::int64_t index)
{
  const Face& face = model.Faces[index];
  std::vector<RegionLoop> out(face.LoopCount);
  for (std::int64_t l = 0; l < face.LoopCount; ++l)
  {
    const TrimLoop& loop = model.Loops[face.FirstLoop + l];
    for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
    {
      RegionPiece piece;
      piece.Curve = c;
      piece.From = model.TrimCurves[c].Reversed ? 1.0 : 0.0;
      piece.To = 1.0 - piece.From;
      out[l].push_back(piece);
    }
  }
  return out;
}

double RegionArea(const Model& model, std::int64_t index, const std::vector<RegionLoop>& loops)
{
  const SurfaceView& surface = model.Faces[index].Geometry;
  SpeedIntegral speed(surface);
  const Interval u = surface.Domain(0);
  const Interval v = surface.Domain(1);
  const double whole = speed(Vec2(u.Max, 0.5 * (v.Min + v.Max))) * v.Length();
  const double tolerance = LineTolerance * whole;
  double area = 0.0;
  for (const RegionLoop& loop : loops)
  {
    for (const RegionPiece& piece : loop)
    {
      if (piece.Curve >= 0)
      {
        const CurveView<2>& curve = model.TrimCurves[piece.Curve].Geometry;
        const Interval domain = curve.Domain();
        const auto path = [&](double share, Vec2& uv, double& slope) {
          Vec2 d[2];
          EvaluateDerivatives(curve, domain.Min + share * domain.Length(), 1, d);
          uv = d[0];
          slope = d[1][1] * domain.Length();
        };
        // From one knot to the next.
        std::vector<double> breaks{ std::min(piece.From, piece.To) };
        for (const double knot : curve.Knots)
        {
          const double share = (knot - domain.Min) / domain.Length();
          if (share > breaks.back() && share < std::max(piece.From, piece.To))
          {
            breaks.push_back(share);
          }
        }
        breaks.push_back(std::max(piece.From, piece.To));
        double sum = 0.0;
        for (std::size_t k = 0; k + 1 < breaks.size(); ++k)
        {
          sum += AlongPath(speed, path, breaks[k], breaks[k + 1], tolerance, MaxHalvings);
        }
        area += piece.From > piece.To ? -sum : sum;
      }
      for (std::size_t k = 0; k + 1 < piece.Polyline.size(); ++k)
      {
        const Vec2& a = piece.Polyline[k];
        const Vec2 step = piece.Polyline[k + 1] - a;
        const auto path = [&](double t, Vec2& uv, double& slope) {
          uv = a + t * step;
          slope = step[1];
        };
        const bool isShort =
          std::abs(step[0]) < ShortStep * u.Length() && std::abs(step[1]) < ShortStep * v.Length();
        area += step[1] == 0.0 ? 0.0
          : isShort            ? SumAlong(speed, path, 0.0, 1.0, 3)
                               : AlongPath(speed, path, 0.0, 1.0, tolerance, MaxHalvings);
      }
    }
  }
  return area;
}

} // namespace nurbs
