// SPDX-License-Identifier: BSD-3-Clause
#include "RegionArea.h"

#include "SurfaceEvaluator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace nurbs
{

namespace
{

constexpr double SeriesTolerance = 1e-11;
constexpr int Orders[] = { 3, 6, 12, 24 }; // Numbers of coefficients that are tried.
constexpr int MaxOrder = 24;
constexpr double LineTolerance = 1e-10; // Of integrals along curves, as a share of the area.
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
  int Count[2] = { 0, 0 }; // Of coefficients, u and v; 0: not made.
  std::vector<double> C;   // Of u fastest.

  // Sums over v, and integrates over u from the span's start to x in [-1, 1]; `v`: Legendre
  // polynomials at the place in v.
  double Integral(double x, const double* v) const
  {
    double u[MaxOrder + 2];
    Legendre(x, this->Count[0], u);
    double sum = 0.0;
    for (int i = 0; i < this->Count[0]; ++i)
    {
      double c = 0.0;
      for (int j = 0; j < this->Count[1]; ++j)
      {
        c += this->C[i + j * this->Count[0]] * v[j];
      }
      // The integral of P_i from -1 to x.
      sum += c * (i == 0 ? x + 1.0 : (u[i + 1] - u[i - 1]) / (2 * i + 1));
    }
    return sum;
  }

  // Takes the coefficients that matter of order x order ones; false if there may be more.
  bool Settle(const std::vector<double>& all, int order)
  {
    double largest = 0.0;
    for (const double c : all)
    {
      largest = std::max(largest, std::abs(c));
    }
    this->Count[0] = this->Count[1] = 1;
    for (int j = 0; j < order; ++j)
    {
      for (int i = 0; i < order; ++i)
      {
        if (std::abs(all[i + j * order]) > SeriesTolerance * largest)
        {
          this->Count[0] = std::max(this->Count[0], i + 1);
          this->Count[1] = std::max(this->Count[1], j + 1);
        }
      }
    }
    this->C.clear();
    for (int j = 0; j < this->Count[1]; ++j)
    {
      const auto row = all.begin() + j * order;
      this->C.insert(this->C.end(), row, row + this->Count[0]);
    }
    return std::max(this->Count[0], this->Count[1]) <= order - 2;
  }
};

// The spans between two knots of v.
struct SpanRow
{
  std::vector<Series> Spans;
  /// MaxOrder numbers a span: the series in v of the integral over u of all spans before.
  std::vector<double> Before;
};

} // namespace

// P(u, v) = the integral of |S_u x S_v| over u from the start of the domain.
class FaceArea::SpeedIntegral
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
    this->Rows.resize(this->Breaks[1].size() - 1);
  }

  double operator()(const Vec2& uv)
  {
    const int i = this->Span(0, uv[0]);
    const int j = this->Span(1, uv[1]);
    const double* before = this->Before(i, j);
    double v[MaxOrder + 2];
    Legendre(this->Local(1, j, uv[1]), MaxOrder, v);
    double sum = this->Half(i) * this->At(i, j).Integral(this->Local(0, i, uv[0]), v);
    for (int k = 0; k < MaxOrder; ++k)
    {
      sum += before[k] * v[k];
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
  double Half(int i) const { return 0.5 * (this->Breaks[0][i + 1] - this->Breaks[0][i]); }
  const double* Before(int i, int j);
  const Series& At(int i, int j);
  void Expand(int i, int j, int n);

  SurfaceEvaluator Surface;
  std::vector<double> Breaks[2];
  std::vector<SpanRow> Rows;
  std::size_t Likely = 0; // Of Orders: what the last span took.
  std::vector<SurfaceDerivatives> Points;
  std::vector<double> Places[2], Coefficients;
};

const Series& FaceArea::SpeedIntegral::At(int i, int j)
{
  SpanRow& row = this->Rows[j];
  row.Spans.resize(this->Breaks[0].size() - 1);
  Series& series = row.Spans[i];
  bool isSettled = series.Count[0] > 0;
  for (std::size_t k = this->Likely; k < std::size(Orders) && !isSettled; ++k)
  {
    this->Expand(i, j, Orders[k]);
    isSettled = series.Settle(this->Coefficients, Orders[k]);
    const bool wouldDo = k > 0 && std::max(series.Count[0], series.Count[1]) <= Orders[k - 1] - 2;
    this->Likely = wouldDo ? k - 1 : k;
  }
  return series;
}

// Of a span before, only the constant in u has an integral.
const double* FaceArea::SpeedIntegral::Before(int i, int j)
{
  std::vector<double>& before = this->Rows[j].Before;
  before.reserve(MaxOrder * (this->Breaks[0].size() - 1));
  if (before.empty())
  {
    before.assign(MaxOrder, 0.0);
  }
  for (int k = int(before.size() / MaxOrder) - 1; k < i; ++k)
  {
    const Series& series = this->At(k, j);
    before.resize(before.size() + MaxOrder);
    double* next = before.data() + before.size() - MaxOrder;
    std::copy_n(next - MaxOrder, MaxOrder, next);
    for (int m = 0; m < series.Count[1]; ++m)
    {
      next[m] += 2.0 * this->Half(k) * series.C[m * series.Count[0]];
    }
  }
  return before.data() + MaxOrder * i;
}

void FaceArea::SpeedIntegral::Expand(int i, int j, int n)
{
  const Rule& rule = Gauss(n);
  const int spans[2] = { i, j };
  for (int dir = 0; dir < 2; ++dir)
  {
    const double a = this->Breaks[dir][spans[dir]];
    const double length = this->Breaks[dir][spans[dir] + 1] - a;
    this->Places[dir].clear();
    for (const double x : rule.X)
    {
      this->Places[dir].push_back(a + 0.5 * (x + 1.0) * length);
    }
    // In the order of the parameters.
    std::reverse(this->Places[dir].begin(), this->Places[dir].end());
  }
  this->Points.resize(n * n);
  this->Surface.DerivativesGrid(this->Places[0], this->Places[1], this->Points.data());
  this->Coefficients.assign(n * n, 0.0);
  std::vector<double> row(n);
  double p[MaxOrder + 2];
  for (int b = 0; b < n; ++b)
  {
    std::fill(row.begin(), row.end(), 0.0);
    for (int a = 0; a < n; ++a)
    {
      const SurfaceDerivatives& d = this->Points[(n - 1 - b) * n + n - 1 - a];
      const double speed = rule.W[a] * d.Su.cross(d.Sv).norm();
      Legendre(rule.X[a], n, p);
      for (int k = 0; k < n; ++k)
      {
        row[k] += (k + 0.5) * speed * p[k];
      }
    }
    Legendre(rule.X[b], n, p);
    for (int m = 0; m < n; ++m)
    {
      const double factor = (m + 0.5) * rule.W[b] * p[m];
      for (int k = 0; k < n; ++k)
      {
        this->Coefficients[k + m * n] += factor * row[k];
      }
    }
  }
}

namespace
{

// The integral of P dv along a path t -> (u, v), v_t, by n points.
template <typename Speed, typename Path>
double SumAlong(Speed& speed, const Path& path, double from, double to, int n)
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
template <typename Speed, typename Path>
double AlongPath(Speed& speed, const Path& path, double a, double b, double tolerance, int depth)
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

FaceArea::FaceArea(const Model& model, std::int64_t face)
  : Source(model)
  , Index(face)
  , Speed(std::make_unique<SpeedIntegral>(model.Faces[face].Geometry))
{
  const SurfaceView& surface = model.Faces[face].Geometry;
  const Interval v = surface.Domain(1);
  this->Whole = (*this->Speed)(Vec2(surface.Domain(0).Max, 0.5 * (v.Min + v.Max))) * v.Length();
}

FaceArea::~FaceArea() = default;

double FaceArea::Of(const std::vector<RegionLoop>& loops)
{
  const Model& model = this->Source;
  const SurfaceView& surface = model.Faces[this->Index].Geometry;
  SpeedIntegral& speed = *this->Speed;
  const Interval u = surface.Domain(0);
  const Interval v = surface.Domain(1);
  const double tolerance = LineTolerance * this->Whole;
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
