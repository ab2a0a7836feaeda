// SPDX-License-Identifier: BSD-3-Clause
#include "PatchErrors.h"

#include "Basis.h"
#include "EvaluatorKernel.h"
#include "PatchBound.h"

#include <array>

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

void BezierNet::Shortest(double (&squared)[2]) const
{
  const Vec2 first = SuspiciousFraction * this->First();
  squared[0] = first[0] * first[0];
  squared[1] = first[1] * first[1];
}

} // namespace nurbs
