// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceBound.h"

#include "Basis.h"
#include "PatchBound.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstring>
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
constexpr double Unbounded = 1e150; // What does not fit a float; squares of it fit a double.

// std::nextafter towards minus infinity, which is slow.
float Below(float x)
{
  std::int32_t bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  bits += x < 0.0f ? 1 : -1;
  std::memcpy(&x, &bits, sizeof bits);
  return x;
}

float Down(double x)
{
  const float f = float(x);
  return double(f) <= x ? f : f == 0.0f ? -std::numeric_limits<float>::denorm_min() : Below(f);
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
  std::vector<int> first(nu); // Columns of the net,
  std::vector<double> mu(std::size_t(nu) * (p + 1) * (p + 1));
  for (int i = 0; i < nu; ++i)
  {
    const double a = this->Breaks[0][i];
    const double b = this->Breaks[0][i + 1];
    const int span = FindSpan(s.Knots[0], p, 0.5 * (a + b));
    first[i] = span - p;
    BlossomMatrix(s.Knots[0], p, span, a, b, &mu[std::size_t(i) * (p + 1) * (p + 1)]);
  }
  const int firstColumn = first.front();
  const int columns = first.back() + p - firstColumn + 1;
  for (int& column : first)
  {
    column -= firstColumn; // from here on those of `rows`.
  }
  parallel(0, nv, [&](std::int64_t begin, std::int64_t end) {
    std::vector<Vec4> rows(std::size_t(columns) * (q + 1));
    std::vector<double> mv(std::size_t(q + 1) * (q + 1));
    std::vector<DerivativeIntervals> bounds(nu);
    PatchRow row{ p, q, rational, nu, this->Breaks[0].data(), first.data(), mu.data(), 0.0, columns,
      rows.data() };
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
      row.Height = v1 - v0;
      BoundPatches(row, bounds.data());
      for (int i = 0; i < nu; ++i)
      {
        Cell& cell = level.Cells[i + std::size_t(j) * nu];
        for (int k = 0; k < 9; ++k)
        {
          cell.Low[k] = Down(bounds[i].Low[k / 3][k % 3]);
          cell.High[k] = Up(bounds[i].High[k / 3][k % 3]);
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
