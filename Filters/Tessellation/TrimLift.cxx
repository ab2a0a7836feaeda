// SPDX-License-Identifier: BSD-3-Clause
#include "TrimCurves.h"

#include "Basis.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr int MaxExactDegree = 48;     // composed exactly; beyond: interpolated
constexpr int FitDegree = 15;          // of the interpolation
constexpr double FitTolerance = 1e-11; // relative to the control points
constexpr double Lossless = 1e-12;     // of degree reduction, relative
constexpr double OnLine = 1e-13;       // of the domain: a coordinate that does not move
constexpr double WeightShare = 1e-4;   // least weight of a piece relative to its largest
constexpr int MaxHalvings = 24;

using Piece2 = BezierCurve<2>;
using Piece3 = BezierCurve<3>;

// A polynomial in scaled Bernstein form: Value[i] is the coefficient times binomial(Degree, i), so
// that products are plain convolutions.
struct Poly
{
  int Degree = 0;
  std::array<double, MaxDegree + 1> Value{};
};

const double* Binomials(int n)
{
  static const auto table = [] {
    std::array<std::array<double, MaxExactDegree + 1>, MaxExactDegree + 1> all{};
    for (int r = 0; r <= MaxExactDegree; ++r)
    {
      all[r][0] = all[r][r] = 1.0;
      for (int i = 1; i < r; ++i)
      {
        all[r][i] = all[r - 1][i - 1] + all[r - 1][i];
      }
    }
    return all;
  }();
  return table[n].data();
}

// One coordinate of a trim piece as a quotient of polynomials of the same degree.
struct Coordinate
{
  Poly Over;
  Poly Weight;
};

double MaxNorm(const std::vector<Vec<1>>& values)
{
  double largest = 0.0;
  for (const Vec<1>& v : values)
  {
    largest = std::max(largest, std::abs(v[0]));
  }
  return largest;
}

// As few coefficients as will do: constant, or lowered in degree (polynomial curves).
Coordinate MakeCoordinate(const Piece2& piece, int dir, double domainLength)
{
  std::vector<Vec<1>> over;
  std::vector<double> weight;
  const Vec3& first = piece.Points.front();
  const double at = first[dir] / first[2];
  bool constant = true;
  bool polynomial = true;
  for (const Vec3& h : piece.Points)
  {
    over.push_back(Vec<1>(h[dir]));
    weight.push_back(h[2]);
    constant = constant && std::abs(h[dir] / h[2] - at) <= OnLine * domainLength;
    polynomial = polynomial && std::abs(h[2] - first[2]) <= 1e-15 * first[2];
  }
  if (constant)
  {
    over.assign(1, Vec<1>(at));
    weight.assign(1, 1.0);
  }
  else if (polynomial)
  {
    for (Vec<1>& x : over)
    {
      x /= first[2];
    }
    over = ReduceBezier<1>(std::move(over), 1e-15 * std::max(domainLength, MaxNorm(over)));
    weight.assign(over.size(), 1.0);
  }
  Coordinate out;
  out.Over.Degree = out.Weight.Degree = static_cast<int>(over.size()) - 1;
  const double* binomial = Binomials(out.Over.Degree);
  for (std::size_t i = 0; i < over.size(); ++i)
  {
    out.Over.Value[i] = over[i][0] * binomial[i];
    out.Weight.Value[i] = weight[i] * binomial[i];
  }
  return out;
}

// One direction of de Boor's algorithm on polynomials: `nets` holds degree + 1 polynomials of
// vectors, `stride` apart, of degree `have`; the result is left in the last one.
void DeBoorPolynomials(KnotView knots, int degree, int span, const Coordinate& x, int have,
  Vec4* nets, std::size_t stride)
{
  const int d = x.Over.Degree;
  std::array<Vec4, MaxExactDegree + 1> sum;
  for (int r = 1; r <= degree; ++r, have += d)
  {
    for (int i = degree; i >= r; --i)
    {
      const double low = knots[span - degree + i];
      const double high = knots[span + 1 - r + i];
      const double scale = 1.0 / (high - low);
      const Vec4* a = nets + (i - 1) * stride;
      Vec4* b = nets + i * stride;
      std::fill(sum.begin(), sum.begin() + have + d + 1, Vec4::Zero());
      for (int k = 0; k <= d; ++k)
      {
        const double toLow = scale * (high * x.Weight.Value[k] - x.Over.Value[k]);
        const double toHigh = scale * (x.Over.Value[k] - low * x.Weight.Value[k]);
        for (int m = 0; m <= have; ++m)
        {
          sum[k + m] += toLow * a[m] + toHigh * b[m];
        }
      }
      std::copy(sum.begin(), sum.begin() + have + d + 1, b);
    }
  }
}

// The control points of S(c(t)) for a piece within one span of the surface.
std::vector<Vec4> Compose(const SurfaceView& surface, const int (&span)[2],
  const Coordinate (&x)[2], std::vector<Vec4>& scratch)
{
  const int p = surface.Degree[0];
  const int q = surface.Degree[1];
  const int rowDegree = p * x[0].Over.Degree;
  const int degree = rowDegree + q * x[1].Over.Degree;
  const std::size_t stride = degree + 1;
  scratch.resize(stride * (p + q + 2));
  Vec4* rows = scratch.data();
  Vec4* columns = rows + stride * (q + 1);
  for (int j = 0; j <= q; ++j)
  {
    for (int i = 0; i <= p; ++i)
    {
      const std::int64_t row = span[1] - q + j;
      columns[i * stride] = surface.Homogeneous(span[0] - p + i + row * surface.Count[0]);
    }
    DeBoorPolynomials(surface.Knots[0], p, span[0], x[0], 0, columns, stride);
    std::copy_n(columns + p * stride, rowDegree + 1, rows + j * stride);
  }
  DeBoorPolynomials(surface.Knots[1], q, span[1], x[1], rowDegree, rows, stride);
  std::vector<Vec4> points(rows + q * stride, rows + q * stride + degree + 1);
  const double* binomial = Binomials(degree);
  for (int i = 0; i <= degree; ++i)
  {
    points[i] /= binomial[i];
  }
  return points;
}

// The inverse of the collocation matrix of section 4, at Chebyshev nodes for conditioning; depends
// on the degree only.
struct Collocation
{
  std::array<double, FitDegree + 1> Nodes;
  Eigen::Matrix<double, FitDegree + 1, FitDegree + 1> Inverse;
  Collocation()
  {
    const double pi = std::acos(-1.0);
    Eigen::Matrix<long double, FitDegree + 1, FitDegree + 1> matrix;
    const double* binomial = Binomials(FitDegree);
    for (int k = 0; k <= FitDegree; ++k)
    {
      this->Nodes[k] = 0.5 - 0.5 * std::cos(pi * k / FitDegree);
      const long double t = this->Nodes[k];
      for (int i = 0; i <= FitDegree; ++i)
      {
        matrix(k, i) = binomial[i] * std::pow(t, static_cast<long double>(i)) *
          std::pow(1.0L - t, static_cast<long double>(FitDegree - i));
      }
    }
    this->Inverse = matrix.fullPivLu().inverse().cast<double>();
  }
};

Vec4 SurfacePoint(const SurfaceView& surface, const int (&span)[2], const Vec2& uv)
{
  double N[2][MaxDegree + 1];
  for (int dir = 0; dir < 2; ++dir)
  {
    EvaluateBasis(surface.Knots[dir], surface.Degree[dir], span[dir], uv[dir], N[dir]);
  }
  Vec4 sum = Vec4::Zero();
  for (int j = 0; j <= surface.Degree[1]; ++j)
  {
    const std::int64_t row = std::int64_t(span[1] - surface.Degree[1] + j) * surface.Count[0];
    for (int i = 0; i <= surface.Degree[0]; ++i)
    {
      sum += N[0][i] * N[1][j] * surface.Homogeneous(row + span[0] - surface.Degree[0] + i);
    }
  }
  return sum;
}

// A piece whose exact degree is too high: interpolated, halved until it agrees between the nodes.
void Fit(const SurfaceView& surface, const int (&span)[2], const Piece2& piece, double s0,
  double s1, int depth, std::vector<Piece3>& out)
{
  static const Collocation collocation;
  const auto sample = [&](double s) {
    return SurfacePoint(surface, span, piece.Evaluate(s0 + s * (s1 - s0)));
  };
  Eigen::Matrix<double, FitDegree + 1, 4> values;
  for (int k = 0; k <= FitDegree; ++k)
  {
    values.row(k) = sample(collocation.Nodes[k]).transpose();
  }
  const Eigen::Matrix<double, FitDegree + 1, 4> solved = collocation.Inverse * values;
  Piece3 fitted;
  const double length = piece.T1 - piece.T0;
  fitted.T0 = piece.T0 + s0 * length;
  fitted.T1 = s1 == 1.0 ? piece.T1 : piece.T0 + s1 * length;
  for (int i = 0; i <= FitDegree; ++i)
  {
    fitted.Points.push_back(solved.row(i).transpose());
  }
  fitted.Points.front() = values.row(0).transpose();
  fitted.Points.back() = values.row(FitDegree).transpose();
  const double size = values.cwiseAbs().maxCoeff();
  double error = 0.0;
  for (int k = 0; k < FitDegree; ++k)
  {
    const double s = 0.5 * (collocation.Nodes[k] + collocation.Nodes[k + 1]);
    const Vec4 h = DeCasteljau<4>(fitted.Points.data(), FitDegree, s);
    error = std::max(error, (h - sample(s)).cwiseAbs().maxCoeff());
  }
  if (error <= FitTolerance * size)
  {
    out.push_back(std::move(fitted));
    return;
  }
  if (depth >= MaxHalvings)
  {
    throw Error("LiftTrimCurve: a trim curve of degree " + std::to_string(piece.Degree()) +
      " on a surface of degree " + std::to_string(surface.Degree[0]) + " x " +
      std::to_string(surface.Degree[1]) + " cannot be lifted");
  }
  const double middle = 0.5 * (s0 + s1);
  Fit(surface, span, piece, s0, middle, depth + 1, out);
  Fit(surface, span, piece, middle, s1, depth + 1, out);
}

double LargestCoefficient(const std::vector<Vec4>& points)
{
  double largest = 0.0;
  for (const Vec4& h : points)
  {
    largest = std::max(largest, h.cwiseAbs().maxCoeff());
  }
  return largest;
}

// Appends a piece: degree reduced, halved until every weight is positive (convex hull property).
void Append(Piece3 piece, int depth, std::vector<Piece3>& out)
{
  piece.Points =
    ReduceBezier<4>(std::move(piece.Points), Lossless * LargestCoefficient(piece.Points));
  double low = piece.Points[0][3];
  double high = low;
  for (const Vec4& h : piece.Points)
  {
    low = std::min(low, h[3]);
    high = std::max(high, h[3]);
  }
  if (low > WeightShare * high)
  {
    if (high - low <= 1e-13 * high)
    {
      for (Vec4& h : piece.Points)
      {
        h /= h[3];
      }
    }
    out.push_back(std::move(piece));
    return;
  }
  if (depth >= MaxHalvings)
  {
    throw Error("LiftTrimCurve: the surface's weights vanish on a trim curve");
  }
  Piece3 left = piece;
  Piece3 right = piece;
  SplitBezier<4>(piece.Points.data(), piece.Degree(), 0.5, left.Points.data(), right.Points.data());
  left.T1 = right.T0 = piece.T0 + 0.5 * (piece.T1 - piece.T0);
  Append(std::move(left), depth + 1, out);
  Append(std::move(right), depth + 1, out);
}

int LastSign(const std::vector<Vec<1>>& f, double zero)
{
  for (std::size_t i = f.size(); i-- > 0;)
  {
    if (std::abs(f[i][0]) > zero)
    {
      return f[i][0] > 0.0 ? 1 : -1;
    }
  }
  return 0;
}

int FirstSign(const std::vector<Vec<1>>& f, double zero)
{
  for (const Vec<1>& x : f)
  {
    if (std::abs(x[0]) > zero)
    {
      return x[0] > 0.0 ? 1 : -1;
    }
  }
  return 0;
}

int SignChanges(const std::vector<Vec<1>>& f, double zero)
{
  int changes = 0;
  int last = 0;
  for (const Vec<1>& x : f)
  {
    const int sign = x[0] > zero ? 1 : (x[0] < -zero ? -1 : 0);
    changes += sign != 0 && last != 0 && sign != last;
    last = sign != 0 ? sign : last;
  }
  return changes;
}

// The one sign change of f in (0, 1): bisection and secants in turn.
double SingleRoot(const std::vector<Vec<1>>& f)
{
  const int n = static_cast<int>(f.size()) - 1;
  double a = 0.0;
  double b = 1.0;
  double fa = f.front()[0];
  double fb = f.back()[0];
  double best = 0.5;
  double least = std::max(std::abs(fa), std::abs(fb));
  for (int k = 0; k < 120 && b - a > 1e-16 && least > 0.0; ++k)
  {
    const double t = k % 3 == 2 ? 0.5 * (a + b) : a + (b - a) * (fa / (fa - fb));
    if (!(a < t && t < b))
    {
      break;
    }
    const double value = DeCasteljau<1>(f.data(), n, t)[0];
    if (std::abs(value) < least)
    {
      least = std::abs(value);
      best = t;
    }
    ((value > 0.0) == (fa > 0.0) ? a : b) = t;
    ((value > 0.0) == (fa > 0.0) ? fa : fb) = value;
  }
  return best;
}

// Parameters in (0, 1) where f passes through zero; a curve that runs along it has none.
void FindRoots(const std::vector<Vec<1>>& f, double zero, double t0, double t1, int depth,
  std::vector<double>& out)
{
  const int changes = SignChanges(f, zero);
  if (changes == 0)
  {
    return;
  }
  const bool ends = std::abs(f.front()[0]) > zero && std::abs(f.back()[0]) > zero;
  if (depth >= 48 || (changes == 1 && ends))
  {
    out.push_back(t0 + (t1 - t0) * (changes == 1 && ends ? SingleRoot(f) : 0.5));
    return;
  }
  std::vector<Vec<1>> left(f.size());
  std::vector<Vec<1>> right(f.size());
  SplitBezier<1>(f.data(), static_cast<int>(f.size()) - 1, 0.5, left.data(), right.data());
  const double tm = 0.5 * (t0 + t1);
  FindRoots(left, zero, t0, tm, depth + 1, out);
  if (std::abs(left.back()[0]) <= zero && LastSign(left, zero) * FirstSign(right, zero) < 0)
  {
    out.push_back(tm);
  }
  FindRoots(right, zero, tm, t1, depth + 1, out);
}

// Where a piece crosses the knot lines of one direction.
void FindCrossings(
  const SurfaceView& surface, int dir, const Piece2& piece, std::vector<double>& cuts)
{
  const KnotView& knots = surface.Knots[dir];
  const Interval domain = surface.Domain(dir);
  double low = domain.Max;
  double high = domain.Min;
  for (const Vec3& h : piece.Points)
  {
    low = std::min(low, h[dir] / h[2]);
    high = std::max(high, h[dir] / h[2]);
  }
  const double* first = std::upper_bound(knots.begin(), knots.end(), std::max(low, domain.Min));
  std::vector<Vec<1>> f(piece.Points.size());
  for (const double* k = first; k != knots.end() && *k < high && *k < domain.Max; ++k)
  {
    if (k != first && *k == k[-1])
    {
      continue;
    }
    double weight = 0.0;
    for (std::size_t i = 0; i < f.size(); ++i)
    {
      f[i][0] = piece.Points[i][dir] - *k * piece.Points[i][2];
      weight = std::max(weight, piece.Points[i][2]);
    }
    FindRoots(f, OnLine * domain.Length() * weight, 0.0, 1.0, 0, cuts);
  }
}

// The part of a piece over the relative parameters [s0, s1].
Piece2 Part(const Piece2& piece, double s0, double s1)
{
  Piece2 part = piece;
  const int n = piece.Degree();
  std::vector<Vec3> other(n + 1);
  const std::vector<Vec3> whole = piece.Points;
  SplitBezier<3>(whole.data(), n, s1, part.Points.data(), other.data());
  if (s0 > 0.0)
  {
    const std::vector<Vec3> low = part.Points;
    SplitBezier<3>(low.data(), n, s0 / s1, other.data(), part.Points.data());
  }
  part.T0 = s0 == 0.0 ? piece.T0 : piece.T0 + s0 * (piece.T1 - piece.T0);
  part.T1 = s1 == 1.0 ? piece.T1 : piece.T0 + s1 * (piece.T1 - piece.T0);
  return part;
}

// The span that a part lies in, read where it is farthest from the knot lines.
int FindPartSpan(const SurfaceView& surface, int dir, const Piece2& part)
{
  const KnotView& knots = surface.Knots[dir];
  double farthest = -1.0;
  int found = surface.Degree[dir];
  for (double s : { 0.5, 0.125, 0.875, 0.3, 0.7 })
  {
    const double t = part.Evaluate(s)[dir];
    const int span = FindSpan(knots, surface.Degree[dir], t, found);
    const double distance = std::min(t - knots[span], knots[span + 1] - t);
    if (s == 0.5 || distance > farthest)
    {
      farthest = distance;
      found = span;
    }
    if (farthest > 0.01 * (knots[span + 1] - knots[span]))
    {
      break;
    }
  }
  return found;
}

// Lifts a piece that lies within one span of the surface.
void LiftPart(const SurfaceView& surface, const Piece2& part, std::vector<Vec4>& scratch,
  std::vector<Piece3>& out)
{
  int span[2];
  Coordinate x[2];
  int degree = 0;
  for (int dir = 0; dir < 2; ++dir)
  {
    span[dir] = FindPartSpan(surface, dir, part);
    x[dir] = MakeCoordinate(part, dir, surface.Domain(dir).Length());
    degree += surface.Degree[dir] * x[dir].Over.Degree;
  }
  if (degree <= MaxExactDegree)
  {
    Append({ part.T0, part.T1, Compose(surface, span, x, scratch) }, 0, out);
    return;
  }
  std::vector<Piece3> fitted;
  Fit(surface, span, part, 0.0, 1.0, 0, fitted);
  for (Piece3& piece : fitted)
  {
    Append(std::move(piece), 0, out);
  }
}

} // namespace

std::vector<BezierCurve<3>> LiftTrimCurve(const SurfaceView& surface, const CurveView<2>& curve)
{
  const double domain = std::max(surface.Domain(0).Length(), surface.Domain(1).Length());
  std::vector<Piece3> out;
  std::vector<Vec4> scratch;
  std::vector<double> cuts;
  for (Piece2& piece : ToBezier(curve))
  {
    double largest = domain;
    for (const Vec3& h : piece.Points)
    {
      largest = std::max(largest, h.cwiseAbs().maxCoeff());
    }
    piece.Points = ReduceBezier<3>(std::move(piece.Points), 1e-15 * largest);
    cuts.assign(1, 0.0);
    FindCrossings(surface, 0, piece, cuts);
    FindCrossings(surface, 1, piece, cuts);
    std::sort(cuts.begin(), cuts.end());
    cuts.push_back(1.0);
    double from = 0.0;
    for (std::size_t i = 1; i < cuts.size(); ++i)
    {
      const bool last = i + 1 == cuts.size();
      if (!last && (cuts[i] - from < 1e-12 || 1.0 - cuts[i] < 1e-12))
      {
        continue;
      }
      const bool whole = from == 0.0 && last;
      LiftPart(surface, whole ? piece : Part(piece, from, cuts[i]), scratch, out);
      from = cuts[i];
    }
  }
  return out;
}

} // namespace nurbs
