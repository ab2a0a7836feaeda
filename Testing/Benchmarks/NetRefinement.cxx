// SPDX-License-Identifier: BSD-3-Clause
#include "NetRefinement.h"

#include "Multiversion.h"

#include <algorithm>

namespace nurbs
{

namespace
{

double Quotient(double numerator, double denominator)
{
  return denominator > 0.0 ? numerator / denominator : 0.0;
}

/// alpha_{i,p+1}(j) for i = span - p, ..., span, where t_j lies in `span` of `coarse`; `fine` points
/// at t_j.
void DiscreteBsplines(const double* fine, KnotView coarse, int degree, int span, double* alpha)
{
  std::fill(alpha, alpha + degree + 1, 0.0);
  alpha[degree] = 1.0; // order 1
  for (int order = 2; order <= degree + 1; ++order)
  {
    const double t = fine[order - 1];
    for (int i = span - order + 1; i <= span; ++i)
    {
      double* a = alpha + (i - span + degree);
      const double rising = Quotient(t - coarse[i], coarse[i + order - 1] - coarse[i]);
      const double next = i < span ? a[1] : 0.0;
      const double falling = Quotient(coarse[i + order] - t, coarse[i + order] - coarse[i + 1]);
      *a = rising * *a + falling * next;
    }
  }
}

/// The sum of alpha[i] times the i-th of `width` rows of `size` numbers.
NURBS_MULTIVERSION
void CombineRows(const double* rows, const double* alpha, int width, std::size_t size, double* sum)
{
  std::fill(sum, sum + size, 0.0);
  for (int i = 0; i < width; ++i, rows += size)
  {
    const double factor = alpha[i];
    if (factor != 0.0)
    {
      for (std::size_t k = 0; k < size; ++k)
      {
        sum[k] += factor * rows[k];
      }
    }
  }
}

} // namespace

Refinement Refine(KnotView coarse, int degree, const std::vector<double>& add)
{
  Refinement r;
  r.Knots.assign(coarse.begin(), coarse.end());
  r.Knots.insert(r.Knots.end(), add.begin(), add.end());
  std::sort(r.Knots.begin(), r.Knots.end());
  const std::size_t count = r.Knots.size() - degree - 1;
  r.First.resize(count);
  r.Coefficients.resize(count * (degree + 1));
  for (std::size_t j = 0; j < count; ++j)
  {
    const int span = FindSpan(coarse, degree, r.Knots[j]);
    r.First[j] = span - degree;
    DiscreteBsplines(
      r.Knots.data() + j, coarse, degree, span, r.Coefficients.data() + j * (degree + 1));
  }
  return r;
}

std::vector<double> MissingKnots(
  KnotView knots, const std::vector<double>& values, int multiplicity)
{
  std::vector<double> missing;
  for (const double t : values)
  {
    const auto range = std::equal_range(knots.begin(), knots.end(), t);
    const std::ptrdiff_t wanted = multiplicity - (range.second - range.first);
    missing.insert(missing.end(), static_cast<std::size_t>(std::max<std::ptrdiff_t>(wanted, 0)), t);
  }
  return missing;
}

ControlNet NetOf(const Surface& surface)
{
  ControlNet net;
  net.Dimension = surface.Weights.empty() ? 3 : 4;
  net.Count[0] = surface.Count[0];
  net.Count[1] = surface.Count[1];
  net.Values.reserve(surface.Points.size() * net.Dimension);
  for (std::size_t k = 0; k < surface.Points.size(); ++k)
  {
    const double w = surface.Weights.empty() ? 1.0 : surface.Weights[k];
    for (int d = 0; d < 3; ++d)
    {
      net.Values.push_back(w * surface.Points[k][d]);
    }
    if (net.Dimension == 4)
    {
      net.Values.push_back(w);
    }
  }
  return net;
}

void RefineNet(
  const ControlNet& net, const Refinement (&refinements)[2], ControlNet& rows, ControlNet& fine)
{
  const int dimension = rows.Dimension = fine.Dimension = net.Dimension;
  const int width[2] = { static_cast<int>(refinements[0].Coefficients.size()) /
      refinements[0].Count(),
    static_cast<int>(refinements[1].Coefficients.size()) / refinements[1].Count() };
  rows.Count[0] = fine.Count[0] = refinements[0].Count();
  rows.Count[1] = net.Count[1];
  fine.Count[1] = refinements[1].Count();
  const std::size_t stride = std::size_t(fine.Count[0]) * dimension;
  rows.Values.assign(stride * rows.Count[1], 0.0);
  double* target = rows.Values.data();
  for (int row = 0; row < net.Count[1]; ++row)
  {
    const double* alpha = refinements[0].Coefficients.data();
    for (int j = 0; j < rows.Count[0]; ++j, target += dimension, alpha += width[0])
    {
      const std::size_t first = std::size_t(row) * net.Count[0] + refinements[0].First[j];
      const double* source = net.Values.data() + first * dimension;
      for (int i = 0; i < width[0]; ++i, source += dimension)
      {
        for (int d = 0; d < dimension; ++d)
        {
          target[d] += alpha[i] * source[d];
        }
      }
    }
  }
  fine.Values.resize(stride * fine.Count[1]);
  for (int j = 0; j < fine.Count[1]; ++j)
  {
    CombineRows(rows.Values.data() + refinements[1].First[j] * stride,
      refinements[1].Coefficients.data() + std::size_t(j) * width[1], width[1], stride,
      fine.Values.data() + j * stride);
  }
}

} // namespace nurbs
