// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceBound.h"

#include "Basis.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace nurbs
{

double SecondDerivatives::Bow(double a, double b, const Vec3& d, bool mixed) const
{
  const double scale[3] = { 0.125 * a * a, 0.25 * a * b, 0.125 * b * b };
  double above = 0.0;
  double below = 0.0;
  const Vec3 size = d.cwiseAbs();
  for (int k = 0; k < 3; ++k)
  {
    if (k == 1 && !mixed)
    {
      continue;
    }
    const double c = d.dot(this->Center[k]);
    const double r = size.dot(this->Radius[k]);
    // Where the second derivative has one sign, S leaves L to one side only; saddles do not add up.
    above += scale[k] * (k == 1 ? std::abs(c) + r : std::max(0.0, r - c));
    below += scale[k] * (k == 1 ? std::abs(c) + r : std::max(0.0, r + c));
  }
  return std::max(above, below);
}

double SecondDerivatives::Bow(double a, double b) const
{
  return 0.125 *
    (a * a * this->Greatest(0) + 2.0 * a * b * this->Greatest(1) + b * b * this->Greatest(2));
}

namespace
{
// Rows of blossom coefficients: point i of the Bezier form of [a, b] in span `k` is the blossom at
// a (p - i times) and b (i times), a combination of the p + 1 control points of the span.
void BlossomMatrix(KnotView knots, int p, int k, double a, double b, double* m)
{
  double c[(MaxDegree + 1) * (MaxDegree + 1)];
  for (int row = 0; row <= p; ++row)
  {
    std::fill_n(c, (p + 1) * (p + 1), 0.0);
    for (int i = 0; i <= p; ++i)
    {
      c[i * (p + 1) + i] = 1.0;
    }
    for (int r = 1; r <= p; ++r)
    {
      const double t = r <= p - row ? a : b;
      for (int i = p; i >= r; --i)
      {
        const double lo = knots[k - p + i];
        const double hi = knots[k + 1 + i - r];
        const double s = (t - lo) / (hi - lo);
        for (int x = i - r; x <= i; ++x)
        {
          c[i * (p + 1) + x] = (1.0 - s) * c[(i - 1) * (p + 1) + x] + s * c[i * (p + 1) + x];
        }
      }
    }
    std::copy_n(c + p * (p + 1), p + 1, m + row * (p + 1));
  }
}

struct Interval3
{
  Vec3 Low = Vec3::Constant(1e300);
  Vec3 High = Vec3::Constant(-1e300);
  void Extend(const Vec3& x)
  {
    this->Low = this->Low.cwiseMin(x);
    this->High = this->High.cwiseMax(x);
  }
};

struct Interval1
{
  double Low = 1e300;
  double High = -1e300;
  void Extend(double x)
  {
    this->Low = std::min(this->Low, x);
    this->High = std::max(this->High, x);
  }
};

Interval3 operator*(const Interval1& s, const Interval3& x)
{
  Interval3 out;
  out.Extend(s.Low * x.Low);
  out.Extend(s.Low * x.High);
  out.Extend(s.High * x.Low);
  out.Extend(s.High * x.High);
  return out;
}

Interval3 operator-(const Interval3& x, const Interval3& y)
{
  Interval3 out;
  out.Low = x.Low - y.High;
  out.High = x.High - y.Low;
  return out;
}

// A derivative of the homogeneous Bezier form as intervals of its coefficients, up to a factor.
struct Derivative
{
  Vec4 Low = Vec4::Constant(1e300);
  Vec4 High = Vec4::Constant(-1e300);
  void Extend(const Vec4& h)
  {
    this->Low = this->Low.cwiseMin(h);
    this->High = this->High.cwiseMax(h);
  }
  void Scale(double factor)
  {
    this->Low *= factor;
    this->High *= factor;
  }
  Interval3 X() const { return { this->Low.head<3>(), this->High.head<3>() }; }
  Interval1 W() const { return { this->Low[3], this->High[3] }; }
};

// The patch less the bilinear surface L through its corners: H - w L and w in Bezier form, one degree
// higher in both directions. S - L = (H - w L) / w has the second derivatives of S but for L_uv, and
// is so small that the quotient rule's intervals are narrow. Coefficient (i, j) takes the same shares
// of its neighbours for the elevated w and for the product.
void SubtractBilinear(
  const std::vector<Vec4>& c, int p, int q, const Vec3 (&corner)[4], std::vector<Vec4>& out)
{
  out.assign(std::size_t(p + 2) * (q + 2), Vec4::Zero());
  for (int j = 0; j <= q; ++j)
  {
    for (int i = 0; i <= p; ++i)
    {
      const Vec4& h = c[i + std::size_t(j) * (p + 1)];
      for (int k = 0; k < 4; ++k)
      {
        const int a = k & 1;
        const int b = k >> 1;
        const double share =
          (a ? i + 1.0 : p + 1.0 - i) / (p + 1) * ((b ? j + 1.0 : q + 1.0 - j) / (q + 1));
        Vec4& target = out[i + a + std::size_t(j + b) * (p + 2)];
        target.head<3>() += share * (h.head<3>() - h[3] * corner[k]);
        target[3] += share * h[3];
      }
    }
  }
}

// Intervals of the second derivatives of one Bezier patch over an a x b box; `scratch` is changed.
void BoundPatch(const std::vector<Vec4>& patch, int p, int q, double a, double b, bool rational,
  std::vector<Vec4>& scratch, Interval3 (&out)[3])
{
  const Vec4* c = patch.data();
  Vec3 corner[4];
  if (rational)
  {
    for (int k = 0; k < 4; ++k)
    {
      const Vec4& h = c[(k & 1 ? p : 0) + (k >> 1 ? q : 0) * (p + 1)];
      corner[k] = h.head<3>() / h[3];
    }
    SubtractBilinear(patch, p, q, corner, scratch);
    c = scratch.data();
    ++p;
    ++q;
  }
  const int s = p + 1;
  const double f[5] = { p / a, q / b, p * (p - 1) / (a * a), p * q / (a * b),
    q * (q - 1) / (b * b) };
  Interval3 x;
  Interval1 reciprocal; // Of the weight.
  Derivative d[5];      // u, v, uu, uv, vv
  for (int j = 0; j <= q; ++j)
  {
    for (int i = 0; i <= p; ++i)
    {
      const Vec4* h = c + i + j * s;
      if (rational)
      {
        x.Extend(h[0].head<3>() / h[0][3]);
        reciprocal.Extend(1.0 / h[0][3]);
      }
      if (i < p && rational)
      {
        d[0].Extend(h[1] - h[0]);
      }
      if (j < q && rational)
      {
        d[1].Extend(h[s] - h[0]);
      }
      if (i + 2 <= p)
      {
        d[2].Extend(h[2] - 2.0 * h[1] + h[0]);
      }
      if (i < p && j < q)
      {
        d[3].Extend(h[s + 1] - h[s] - h[1] + h[0]);
      }
      if (j + 2 <= q)
      {
        d[4].Extend(h[2 * s] - 2.0 * h[s] + h[0]);
      }
    }
  }
  if (p < 2)
  {
    d[2].Extend(Vec4::Zero());
  }
  if (q < 2)
  {
    d[4].Extend(Vec4::Zero());
  }
  for (int k = 0; k < 5; ++k)
  {
    d[k].Scale(f[k]);
  }
  if (!rational)
  {
    for (int k = 0; k < 3; ++k)
    {
      out[k] = d[2 + k].X();
    }
    return;
  }
  // S_u = (H_u - w_u S) / w, S_uv = (H_uv - w_u S_v - w_v S_u - w_uv S) / w.
  const Interval3 su = reciprocal * (d[0].X() - d[0].W() * x);
  const Interval3 sv = reciprocal * (d[1].X() - d[1].W() * x);
  const auto twice = [](Interval1 w) { return Interval1{ 2.0 * w.Low, 2.0 * w.High }; };
  out[0] = reciprocal * (d[2].X() - twice(d[0].W()) * su - d[2].W() * x);
  out[1] = reciprocal * (d[3].X() - d[0].W() * sv - d[1].W() * su - d[3].W() * x);
  out[2] = reciprocal * (d[4].X() - twice(d[1].W()) * sv - d[4].W() * x);
  const Vec3 twist = (corner[3] - corner[2] - corner[1] + corner[0]) / (a * b);
  out[1].Low += twist;
  out[1].High += twist;
}

constexpr double Unbounded = 1e150; // What does not fit a float; squares of it fit a double.

float Down(double x)
{
  const float f = float(x);
  return double(f) <= x ? f : std::nextafter(f, -std::numeric_limits<float>::infinity());
}

float Up(double x)
{
  return -Down(-x);
}
} // namespace

void SurfaceBound::Cell::Unite(const Cell& other)
{
  for (int k = 0; k < 9; ++k)
  {
    this->Low[k] = std::min(this->Low[k], other.Low[k]);
    this->High[k] = std::max(this->High[k], other.High[k]);
  }
}

SurfaceBound::SurfaceBound(const SurfaceView& surface, const ParameterBox& used)
  : Surface(surface)
  , Prototype(surface)
  , Used(used)
{
  this->FitPlane();
  this->FindCreases();
}

void SurfaceBound::MakeGrid(
  const std::vector<double>& linesU, const std::vector<double>& linesV, const ParallelFor& parallel)
{
  this->MakeBreaks(0, linesU);
  this->MakeBreaks(1, linesV);
  this->MakeCells(parallel);
  this->MakeLevels();
}

void SurfaceBound::FitPlane()
{
  const std::int64_t n = this->Surface.Size();
  Box3 box;
  Vec3 mean = Vec3::Zero();
  for (std::int64_t k = 0; k < n; ++k)
  {
    const Vec3 x = this->Surface.Point(k);
    box.extend(x);
    mean += x / double(n);
  }
  this->Diagonal = box.diagonal().norm();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::int64_t k = 0; k < n; ++k)
  {
    const Vec3 d = this->Surface.Point(k) - mean;
    covariance += d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  this->Normal = solver.eigenvectors().col(0).normalized();
  for (std::int64_t k = 0; k < n; ++k)
  {
    this->PlaneDistance =
      std::max(this->PlaneDistance, std::abs(this->Normal.dot(this->Surface.Point(k) - mean)));
  }
}

void SurfaceBound::FindCreases()
{
  const double low[2] = { this->Used.U0, this->Used.V0 };
  const double high[2] = { this->Used.U1, this->Used.V1 };
  for (int d = 0; d < 2; ++d)
  {
    const double eps = NegligibleSpan * (high[d] - low[d]);
    for (double t : CreaseKnots(this->Surface.Knots[d], this->Surface.Degree[d]))
    {
      if (t > low[d] + eps && t < high[d] - eps && !this->IsSmooth(d, t))
      {
        this->Crease[d].push_back(t);
      }
    }
  }
}

// True if the first derivatives on both sides of a knot of full multiplicity agree. Along the knot
// line their difference times w^2 is a polynomial of degree 2 q in every span, so that it vanishes
// if it does so at 2 q + 1 places.
bool SurfaceBound::IsSmooth(int dir, double knot) const
{
  const SurfaceView& s = this->Surface;
  const int p = s.Degree[dir];
  const KnotView& knots = s.Knots[dir];
  const int after = FindSpan(knots, p, knot);
  int before = after;
  while (before > p && knots[before] >= knot)
  {
    --before;
  }
  if (after - before > p || knots[before] >= knot)
  {
    return false;
  }
  double ders[2][2 * (MaxDegree + 1)];
  EvaluateBasisDerivatives(knots, p, before, knot, 1, ders[0]);
  EvaluateBasisDerivatives(knots, p, after, knot, 1, ders[1]);
  const int q = s.Degree[1 - dir];
  const KnotView& across = s.Knots[1 - dir];
  const std::vector<Knot> lines = DistinctKnots(across, q);
  double basis[MaxDegree + 1];
  for (std::size_t line = 0; line + 1 < lines.size(); ++line)
  {
    for (int k = 0; k <= 2 * q; ++k)
    {
      const double t =
        lines[line].Value + (lines[line + 1].Value - lines[line].Value) * (0.5 + k) / (2 * q + 1);
      const int span = FindSpan(across, q, t);
      EvaluateBasis(across, q, span, t, basis);
      Vec3 slope[2];
      for (int side = 0; side < 2; ++side)
      {
        Vec4 h = Vec4::Zero();
        Vec4 d = Vec4::Zero();
        const int first = (side == 0 ? before : after) - p;
        for (int i = 0; i <= p; ++i)
        {
          Vec4 sum = Vec4::Zero();
          for (int j = 0; j <= q; ++j)
          {
            const std::int64_t a = first + i;
            const std::int64_t b = span - q + j;
            const std::int64_t at = dir == 0 ? a + b * s.Count[0] : b + a * s.Count[0];
            sum += basis[j] * s.Homogeneous(at);
          }
          h += ders[side][i] * sum;
          d += ders[side][p + 1 + i] * sum;
        }
        slope[side] = (d.head<3>() - d[3] * (h.head<3>() / h[3])) / h[3];
      }
      if ((slope[1] - slope[0]).norm() > 1e-9 * (slope[0].norm() + slope[1].norm()) + 1e-300)
      {
        return false;
      }
    }
  }
  return true;
}

void SurfaceBound::MakeBreaks(int dir, const std::vector<double>& lines)
{
  const double low = dir == 0 ? this->Used.U0 : this->Used.V0;
  const double high = dir == 0 ? this->Used.U1 : this->Used.V1;
  std::vector<double>& breaks = this->Breaks[dir];
  breaks.assign(1, low);
  for (const Knot& knot : DistinctKnots(this->Surface.Knots[dir], this->Surface.Degree[dir]))
  {
    if (knot.Value > low && knot.Value < high)
    {
      breaks.push_back(knot.Value);
    }
  }
  breaks.push_back(high);
  // A line that is as good as a knot would only make slivers.
  const double eps = NegligibleSpan * (high - low);
  std::vector<double> add;
  for (double line : lines)
  {
    const auto next = std::lower_bound(breaks.begin(), breaks.end(), line);
    if (next != breaks.begin() && next != breaks.end() && *next - line > eps &&
      line - *(next - 1) > eps)
    {
      add.push_back(line);
    }
  }
  const std::size_t middle = breaks.size();
  breaks.insert(breaks.end(), add.begin(), add.end());
  std::inplace_merge(breaks.begin(), breaks.begin() + middle, breaks.end());
}

void SurfaceBound::MakeCells(const ParallelFor& parallel)
{
  const SurfaceView& s = this->Surface;
  const int p = s.Degree[0];
  const int q = s.Degree[1];
  this->Levels.resize(1);
  Level& level = this->Levels[0];
  const int nu = int(this->Breaks[0].size()) - 1;
  const int nv = int(this->Breaks[1].size()) - 1;
  level.Count[0] = nu;
  level.Count[1] = nv;
  level.Cells.resize(std::size_t(nu) * nv);
  const bool rational = s.IsRational();
  std::vector<int> span(nu);
  std::vector<double> mu(std::size_t(nu) * (p + 1) * (p + 1));
  for (int i = 0; i < nu; ++i)
  {
    const double a = this->Breaks[0][i];
    const double b = this->Breaks[0][i + 1];
    span[i] = FindSpan(s.Knots[0], p, 0.5 * (a + b));
    BlossomMatrix(s.Knots[0], p, span[i], a, b, &mu[std::size_t(i) * (p + 1) * (p + 1)]);
  }
  const int firstColumn = span.front() - p;
  const int columns = span.back() - firstColumn + 1;
  parallel(0, nv, [&](std::int64_t begin, std::int64_t end) {
    std::vector<Vec4> rows(std::size_t(columns) * (q + 1));
    std::vector<double> mv(std::size_t(q + 1) * (q + 1));
    std::vector<Vec4> patch(std::size_t(p + 1) * (q + 1));
    std::vector<Vec4> scratch;
    for (std::int64_t j = begin; j < end; ++j)
    {
      const double v0 = this->Breaks[1][j];
      const double v1 = this->Breaks[1][j + 1];
      const int kv = FindSpan(s.Knots[1], q, 0.5 * (v0 + v1));
      BlossomMatrix(s.Knots[1], q, kv, v0, v1, mv.data());
      std::fill(rows.begin(), rows.end(), Vec4::Zero());
      for (int y = 0; y <= q; ++y)
      {
        for (int x = 0; x < columns; ++x)
        {
          const std::int64_t at = firstColumn + x + std::int64_t(kv - q + y) * s.Count[0];
          Vec4 h = s.Homogeneous(at);
          if (!rational)
          {
            h << s.Point(at), 1.0;
          }
          for (int r = 0; r <= q; ++r)
          {
            rows[std::size_t(r) * columns + x] += mv[std::size_t(r) * (q + 1) + y] * h;
          }
        }
      }
      for (int i = 0; i < nu; ++i)
      {
        const double* m = &mu[std::size_t(i) * (p + 1) * (p + 1)];
        for (int r = 0; r <= q; ++r)
        {
          const Vec4* row = &rows[std::size_t(r) * columns + span[i] - p - firstColumn];
          for (int c = 0; c <= p; ++c)
          {
            Vec4 sum = Vec4::Zero();
            for (int x = 0; x <= p; ++x)
            {
              sum += m[c * (p + 1) + x] * row[x];
            }
            patch[std::size_t(r) * (p + 1) + c] = sum;
          }
        }
        Interval3 bounds[3];
        BoundPatch(patch, p, q, this->Breaks[0][i + 1] - this->Breaks[0][i], v1 - v0, rational,
          scratch, bounds);
        Cell& cell = level.Cells[i + std::size_t(j) * nu];
        for (int k = 0; k < 9; ++k)
        {
          cell.Low[k] = Down(bounds[k / 3].Low[k % 3]);
          cell.High[k] = Up(bounds[k / 3].High[k % 3]);
        }
      }
    }
  });
}

void SurfaceBound::MakeLevels()
{
  while (this->Levels.back().Count[0] * std::int64_t(this->Levels.back().Count[1]) > 64)
  {
    const Level& fine = this->Levels.back();
    Level coarse;
    for (int d = 0; d < 2; ++d)
    {
      coarse.Count[d] = (fine.Count[d] + 1) / 2;
    }
    coarse.Cells.resize(std::size_t(coarse.Count[0]) * coarse.Count[1]);
    for (int j = 0; j < fine.Count[1]; ++j)
    {
      for (int i = 0; i < fine.Count[0]; ++i)
      {
        Cell& target = coarse.Cells[i / 2 + std::size_t(j / 2) * coarse.Count[0]];
        const Cell& source = fine.Cells[i + std::size_t(j) * fine.Count[0]];
        if (i % 2 == 0 && j % 2 == 0)
        {
          target = source;
        }
        else
        {
          target.Unite(source);
        }
      }
    }
    this->Levels.push_back(std::move(coarse));
  }
}

// First and last cell of the grid that [low, high] touches by more than rounding. False: one cell.
bool SurfaceBound::Find(int dir, double low, double high, int& first, int& last) const
{
  const std::vector<double>& b = this->Breaks[dir];
  const double eps = NegligibleSpan * (high - low);
  const int most = int(b.size()) - 2;
  first = int(std::upper_bound(b.begin(), b.end(), low + eps) - b.begin()) - 1;
  first = std::max(0, std::min(first, most));
  last = first;
  while (last < most && b[last + 1] < high - eps)
  {
    ++last;
  }
  return last > first;
}

SecondDerivatives SurfaceBound::Over(const ParameterBox& box) const
{
  int i0, i1, j0, j1;
  this->Find(0, box.U0, box.U1, i0, i1);
  this->Find(1, box.V0, box.V1, j0, j1);
  const Level* level = this->Levels.data();
  while ((i1 - i0 + 1) * std::int64_t(j1 - j0 + 1) > 64)
  {
    ++level;
    i0 >>= 1;
    i1 >>= 1;
    j0 >>= 1;
    j1 >>= 1;
  }
  Cell all = level->Cells[i0 + std::size_t(j0) * level->Count[0]];
  for (int j = j0; j <= j1; ++j)
  {
    for (int i = i0 + (j == j0); i <= i1; ++i)
    {
      all.Unite(level->Cells[i + std::size_t(j) * level->Count[0]]);
    }
  }
  SecondDerivatives out;
  for (int k = 0; k < 9; ++k)
  {
    const double low = all.Low[k];
    const double high = all.High[k];
    const bool finite = std::isfinite(low) && std::isfinite(high);
    out.Center[k / 3][k % 3] = finite ? 0.5 * (high + low) : 0.0;
    out.Radius[k / 3][k % 3] = finite ? 0.5 * (high - low) : Unbounded;
  }
  return out;
}

bool SurfaceBound::HasGridLineInside(const ParameterBox& box) const
{
  int first, last;
  return this->Find(0, box.U0, box.U1, first, last) || this->Find(1, box.V0, box.V1, first, last);
}

bool SurfaceBound::IsCrease(int dir, double t) const
{
  return std::binary_search(this->Crease[dir].begin(), this->Crease[dir].end(), t);
}

bool SurfaceBound::CrossesCrease(const ParameterBox& box) const
{
  const double low[2] = { box.U0, box.V0 };
  const double high[2] = { box.U1, box.V1 };
  for (int d = 0; d < 2; ++d)
  {
    const double eps = NegligibleSpan * (high[d] - low[d]);
    for (double crease : this->Crease[d])
    {
      if (crease > low[d] + eps && crease < high[d] - eps)
      {
        return true;
      }
    }
  }
  return false;
}

} // namespace nurbs
