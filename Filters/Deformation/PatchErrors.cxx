// SPDX-License-Identifier: BSD-3-Clause
#include "PatchErrors.h"

#include "Basis.h"
#include "EvaluatorKernel.h"
#include "PatchBound.h"

#include <array>
#include <cmath>

namespace nurbs
{

namespace
{

// The matrix from the Bezier points over [0, 1] to those over [a, b].
void PartMatrix(int degree, double a, double b, double* m)
{
  double knots[2 * (MaxDegree + 1)];
  std::fill_n(knots, degree + 1, 0.0);
  std::fill_n(knots + degree + 1, degree + 1, 1.0);
  BlossomMatrix(KnotView(knots, 2 * (degree + 1)), degree, degree, a, b, m);
}

// rows[j] = sum of m[j][t] net[t], row by row of the net.
void CombineRows(const double* m, int q, int width, const Vec4* net, Vec4* rows)
{
  for (int j = 0; j <= q; ++j)
  {
    for (int i = 0; i < width; ++i)
    {
      Vec4 sum = m[j * (q + 1)] * net[i];
      for (int t = 1; t <= q; ++t)
      {
        sum += m[j * (q + 1) + t] * net[i + t * width];
      }
      rows[i + j * width] = sum;
    }
  }
}

// Halves `count` points that lie `stride` apart by de Casteljau's algorithm, in place.
void HalveLine(Vec4* points, int count, int stride, int half)
{
  if (half == 0)
  {
    for (int r = 1; r < count; ++r)
    {
      for (int i = count - 1; i >= r; --i)
      {
        points[i * stride] = 0.5 * (points[(i - 1) * stride] + points[i * stride]);
      }
    }
    return;
  }
  for (int r = 1; r < count; ++r)
  {
    for (int i = 0; i < count - r; ++i)
    {
      points[i * stride] = 0.5 * (points[i * stride] + points[(i + 1) * stride]);
    }
  }
}

// Largest lengths of differences of Bezier points; of their first three numbers, or of the fourth.
struct Differences
{
  double U = 0.0, V = 0.0, Uu = 0.0, Uv = 0.0, Vv = 0.0;
};

void Track(const Vec4& difference, double& xyz, double& w)
{
  const Vec4 square = difference.cwiseProduct(difference);
  xyz = std::max(xyz, square[0] + square[1] + square[2]);
  w = std::max(w, square[3]);
}

void TakeRoots(Differences& d)
{
  for (double* square : { &d.U, &d.V, &d.Uu, &d.Uv, &d.Vv })
  {
    *square = std::sqrt(*square);
  }
}

// Of a net of n x m points, u fastest. First differences with `First` only. `steps` is for its memory.
template <bool First>
void LargestDifferences(
  const Vec4* x, int n, int m, std::vector<Vec4>& steps, Differences& xyz, Differences& w)
{
  const int width = n - 1;
  steps.resize(std::size_t(std::max(1, width)) * m);
  for (int j = 0; j < m; ++j)
  {
    for (int i = 0; i < width; ++i)
    {
      const Vec4 step = x[i + 1 + j * n] - x[i + j * n];
      steps[i + j * width] = step;
      if (First)
      {
        Track(step, xyz.U, w.U);
      }
      if (i > 0)
      {
        Track(step - steps[i - 1 + j * width], xyz.Uu, w.Uu);
      }
      if (j > 0)
      {
        Track(step - steps[i + (j - 1) * width], xyz.Uv, w.Uv);
      }
    }
  }
  for (int i = 0; i < n; ++i)
  {
    Vec4 before = Vec4::Zero();
    for (int j = 0; j + 1 < m; ++j)
    {
      const Vec4 step = x[i + (j + 1) * n] - x[i + j * n];
      if (First)
      {
        Track(step, xyz.V, w.V);
      }
      if (j > 0)
      {
        Track(step - before, xyz.Vv, w.Vv);
      }
      before = step;
    }
  }
  TakeRoots(xyz);
  TakeRoots(w);
}

double Greatest(const DerivativeIntervals& d, int k)
{
  return d.Low[k].cwiseAbs().cwiseMax(d.High[k].cwiseAbs()).norm();
}

} // namespace

void BezierNet::Make(const FaceGrid& grid, int patch, bool rational, const Vec4* net)
{
  this->P = grid.Axis[0].Degree();
  this->Q = grid.Axis[1].Degree();
  this->Rational = rational;
  this->Box = grid.Box(patch);
  const int n = this->P + 1;
  std::array<Vec4, (MaxDegree + 1) * (MaxDegree + 1)> rows;
  CombineRows(grid.Axis[1].Extraction(grid.Row(patch)), this->Q, n, net, rows.data());
  this->Points.resize(std::size_t(n) * (this->Q + 1));
  const double* m = grid.Axis[0].Extraction(grid.Column(patch));
  for (int j = 0; j <= this->Q; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      Vec4 sum = m[i * n] * rows[j * n];
      for (int s = 1; s < n; ++s)
      {
        sum += m[i * n + s] * rows[j * n + s];
      }
      this->Points[i + j * n] = sum;
    }
  }
}

SecondBound BezierNet::Second(const ParameterBox& box) const
{
  const int n = this->P + 1;
  const double a = this->Box.A();
  const double b = this->Box.B();
  double blossom[(MaxDegree + 1) * (MaxDegree + 1)];
  std::array<Vec4, (MaxDegree + 1) * (MaxDegree + 1)> rows;
  PartMatrix(this->Q, (box.V0 - this->Box.V0) / b, (box.V1 - this->Box.V0) / b, blossom);
  CombineRows(blossom, this->Q, n, this->Points.data(), rows.data());
  PartMatrix(this->P, (box.U0 - this->Box.U0) / a, (box.U1 - this->Box.U0) / a, blossom);
  const double breaks[2] = { box.U0, box.U1 };
  const int first = 0;
  const PatchRow row{ this->P, this->Q, this->Rational, 1, breaks, &first, blossom, box.B(), n,
    rows.data() };
  DerivativeIntervals intervals;
  BoundPatches(row, &intervals);
  return { Greatest(intervals, 0), Greatest(intervals, 1), Greatest(intervals, 2) };
}

// S_u = (H_u - w_u S) / w; about the middle of the net, so that the second term is small.
Vec2 BezierNet::First() const
{
  const int n = this->P + 1;
  Box3 box;
  double weight = this->Points[0][3];
  for (const Vec4& h : this->Points)
  {
    box.extend(Vec3(h.head<3>() / (this->Rational ? h[3] : 1.0)));
    weight = std::min(weight, h[3]);
  }
  if (!this->Rational)
  {
    weight = 1.0;
  }
  const Vec3 center = box.center();
  const double radius = 0.5 * box.diagonal().norm();
  Vec2 most = Vec2::Zero();
  for (int d = 0; d < 2; ++d)
  {
    const int step = d == 0 ? 1 : n;
    const double scale = d == 0 ? this->P / this->Box.A() : this->Q / this->Box.B();
    for (int j = 0; j <= this->Q - (d == 1); ++j)
    {
      for (int i = 0; i <= this->P - (d == 0); ++i)
      {
        const Vec4 difference = this->Points[i + j * n + step] - this->Points[i + j * n];
        const double length = this->Rational
          ? (difference.head<3>() - difference[3] * center).norm() +
            std::abs(difference[3]) * radius
          : difference.head<3>().norm();
        most[d] = std::max(most[d], scale * length / weight);
      }
    }
  }
  return most;
}

Vec3 BezierNet::Middle() const
{
  Box3 box;
  for (const Vec4& h : this->Points)
  {
    box.extend(Vec3(h.head<3>() / (this->Rational ? h[3] : 1.0)));
  }
  return box.center();
}

void NetPath::Start(const BezierNet& net)
{
  this->P = net.P;
  this->Q = net.Q;
  this->Rational = net.Rational;
  this->Steps.clear();
  this->Levels.resize(std::max<std::size_t>(this->Levels.size(), 1));
  this->Levels[0] = net.Points;
  this->Made = 0;
  // Of a Bezier point in those of the product with a linear function, one degree higher.
  for (int d = 0; d < 2; ++d)
  {
    const int degree = d == 0 ? this->P : this->Q;
    this->Shares[d].clear();
    for (int i = 0; i <= degree; ++i)
    {
      this->Shares[d].push_back((degree + 1.0 - i) / (degree + 1));
      this->Shares[d].push_back((i + 1.0) / (degree + 1));
    }
  }
}

void NetPath::Pop()
{
  this->Steps.pop_back();
  this->Made = std::min(this->Made, this->Steps.size());
}

// Halves as far as the way has gone.
const Vec4* NetPath::Top()
{
  const int n = this->P + 1;
  const int m = this->Q + 1;
  if (this->Levels.size() <= this->Steps.size())
  {
    this->Levels.resize(this->Steps.size() + 1);
  }
  for (; this->Made < this->Steps.size(); ++this->Made)
  {
    const Step& step = this->Steps[this->Made];
    std::vector<Vec4>& points = this->Levels[this->Made + 1];
    points = this->Levels[this->Made];
    const int lines = step.Direction == 0 ? m : n;
    for (int k = 0; k < lines; ++k)
    {
      HalveLine(points.data() + (step.Direction == 0 ? k * n : k), step.Direction == 0 ? n : m,
        step.Direction == 0 ? 1 : n, step.Half);
    }
  }
  return this->Levels[this->Made].data();
}

// Polynomial patches: the control points of the second derivatives. Rational ones: with L the bilinear
// surface through the corners and G = H - w L, S - L = G / w has the second derivatives of S but for
// L_uv. By the quotient rule
//   (S - L)_uu = (G_uu - 2 w_u (S - L)_u - w_uu (S - L)) / w,
// and so on; S - L is so small that the terms with w hardly count.
SecondBound NetPath::Scaled()
{
  const Vec4* points = this->Top();
  const int p = this->P;
  const int q = this->Q;
  const int n = p + 1;
  Differences g, w;
  if (!this->Rational)
  {
    LargestDifferences<false>(points, n, q + 1, this->Steps4, g, w);
    return { p * (p - 1) * g.Uu, p * q * g.Uv, q * (q - 1) * g.Vv };
  }
  const auto corner = [&](int k) -> Vec4 {
    Vec4 place = points[k] / points[k][3];
    place[3] = 0.0;
    return place;
  };
  const Vec4 corners[4] = { corner(0), corner(p), corner(q * n), corner(p + q * n) };
  this->Less.assign(std::size_t(p + 2) * (q + 2), Vec4::Zero());
  double weight = points[0][3];
  for (int j = 0; j <= q; ++j)
  {
    for (int i = 0; i <= p; ++i)
    {
      const Vec4& h = points[i + j * n];
      weight = std::min(weight, h[3]);
      for (int k = 0; k < 4; ++k)
      {
        const int a = k & 1;
        const int b = k >> 1;
        const double share = this->Shares[0][2 * i + a] * this->Shares[1][2 * j + b];
        const Vec4 less = h - h[3] * corners[k]; // The corners' fourth number is 0: w stays.
        this->Less[i + a + std::size_t(j + b) * (p + 2)] += share * less;
      }
    }
  }
  double radius = 0.0;
  for (const Vec4& l : this->Less)
  {
    radius = std::max(radius, l.head<3>().squaredNorm());
  }
  radius = std::sqrt(radius) / weight;
  LargestDifferences<true>(this->Less.data(), p + 2, q + 2, this->Steps4, g, w);
  const double wu = (p + 1) * w.U;
  const double wv = (q + 1) * w.V;
  const double u = ((p + 1) * g.U + wu * radius) / weight;
  const double v = ((q + 1) * g.V + wv * radius) / weight;
  const double twist = (corners[3] - corners[2] - corners[1] + corners[0]).norm();
  return { ((p + 1) * p * (g.Uu + w.Uu * radius) + 2.0 * wu * u) / weight,
    twist + ((p + 1) * (q + 1) * (g.Uv + w.Uv * radius) + wu * v + wv * u) / weight,
    ((q + 1) * q * (g.Vv + w.Vv * radius) + 2.0 * wv * v) / weight };
}

void ShortestDerivatives(
  const FaceGrid& grid, int patch, bool rational, const Vec4* net, double (&squared)[2])
{
  const int n = grid.Axis[0].Degree() + 1;
  const int m = grid.Axis[1].Degree() + 1;
  const auto point = [&](int k) -> Vec3 { return net[k].head<3>() / (rational ? net[k][3] : 1.0); };
  double longest[2] = { 0.0, 0.0 };
  for (int j = 0; j < m; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      const Vec3 at = point(i + j * n);
      if (i + 1 < n)
      {
        longest[0] = std::max(longest[0], (point(i + 1 + j * n) - at).squaredNorm());
      }
      if (j + 1 < m)
      {
        longest[1] = std::max(longest[1], (point(i + (j + 1) * n) - at).squaredNorm());
      }
    }
  }
  const ParameterBox box = grid.Box(patch);
  const double share = SuspiciousFraction * SuspiciousFraction;
  squared[0] = share * longest[0] / (box.A() * box.A());
  squared[1] = share * longest[1] / (box.B() * box.B());
}

} // namespace nurbs
