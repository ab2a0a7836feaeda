// SPDX-License-Identifier: BSD-3-Clause
#include "Basis.h"

#include <algorithm>

namespace nurbs
{

namespace
{

/// One step of the Cox-de Boor recursion: the `degree` functions of degree - 1 in N become the
/// degree + 1 functions of `degree`. On a span that is not empty no denominator vanishes.
void RaiseBasis(const double* knots, int span, double t, int degree, double* N)
{
  double saved = 0.0;
  for (int r = 0; r < degree; ++r)
  {
    const double right = knots[span + r + 1];
    const double left = knots[span + r + 1 - degree];
    const double scaled = N[r] / (right - left);
    N[r] = saved + (right - t) * scaled;
    saved = (t - left) * scaled;
  }
  N[degree] = saved;
}

} // namespace

void EvaluateBasis(KnotView knots, int degree, int span, double t, double* N)
{
  N[0] = 1.0;
  for (int d = 1; d <= degree; ++d)
  {
    RaiseBasis(knots.data(), span, t, d, N);
  }
}

void EvaluateBasisDerivatives(
  KnotView knots, int degree, int span, double t, int order, double* ders)
{
  const int width = degree + 1;
  std::fill(ders, ders + (order + 1) * width, 0.0);
  // Row k starts with the functions of degree - k, taken from the recursion as it passes there.
  double N[MaxDegree + 1] = { 1.0 };
  for (int d = 0; d <= degree; ++d)
  {
    if (d > 0)
    {
      RaiseBasis(knots.data(), span, t, d, N);
    }
    if (degree - d <= order)
    {
      std::copy(N, N + d + 1, ders + (degree - d) * width);
    }
  }
  // N'_{i,q} = q (N_{i,q-1} / (u_{i+q} - u_i) - N_{i+1,q-1} / (u_{i+q+1} - u_{i+1})): k times.
  for (int k = 1; k <= std::min(order, degree); ++k)
  {
    double* row = ders + k * width;
    for (int q = degree - k + 1; q <= degree; ++q)
    {
      double saved = 0.0;
      for (int r = 0; r < q; ++r)
      {
        const double scaled = q * row[r] / (knots[span + r + 1] - knots[span + r + 1 - q]);
        row[r] = saved - scaled;
        saved = scaled;
      }
      row[q] = saved;
    }
  }
}

void BlossomMatrix(KnotView knots, int degree, int span, double a, double b, double* m)
{
  const int p = degree;
  const int k = span;
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

} // namespace nurbs
