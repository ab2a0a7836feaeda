// SPDX-License-Identifier: BSD-3-Clause
#include "FaceGrid.h"

#include "Basis.h"

#include <algorithm>

namespace nurbs
{

namespace
{

constexpr double Sliver = 1e-7; // Of the range: columns that are as good as none.

// Sum of coefficients times Bernstein polynomials at t by Horner's scheme (Li, Lau, Green 1997,
// below equation (4)); `stride` numbers lie between coefficients.
double Horner(const double* coefficients, int stride, int degree, double t)
{
  const double s = 1.0 - t;
  double power = 1.0;
  double binomial = 1.0;
  double sum = coefficients[0] * s;
  for (int k = 1; k < degree; ++k)
  {
    power *= t;
    binomial *= double(degree - k + 1) / k;
    sum = (sum + binomial * power * coefficients[k * stride]) * s;
  }
  return degree == 0 ? coefficients[0] : sum + power * t * coefficients[degree * stride];
}

} // namespace

GridAxis::GridAxis(KnotView knots, int degree, const Interval& range)
  : P(degree)
{
  const double sliver = Sliver * range.Length();
  this->Breaks.push_back(range.Min);
  for (const Knot& knot : DistinctKnots(knots, degree))
  {
    if (knot.Value > range.Min + sliver && knot.Value < range.Max - sliver)
    {
      this->Breaks.push_back(knot.Value);
    }
  }
  this->Breaks.push_back(range.Max);
  const int n = degree + 1;
  for (int c = 0; c < this->Columns(); ++c)
  {
    const Interval extent = this->Extent(c);
    const int span = FindSpan(knots, degree, 0.5 * (extent.Min + extent.Max));
    this->Spans.push_back(span);
    this->Matrices.resize(std::size_t(n) * n * (c + 1));
    BlossomMatrix(
      knots, degree, span, extent.Min, extent.Max, this->Matrices.data() + std::size_t(n) * n * c);
  }
  this->Tables.resize(this->Columns());
  this->Counts.resize(this->Columns(), 0);
}

// A column in span k depends on the control points k - P to k.
void GridAxis::ColumnsOf(int control, int& first, int& last) const
{
  first =
    int(std::lower_bound(this->Spans.begin(), this->Spans.end(), control) - this->Spans.begin());
  last = int(std::upper_bound(this->Spans.begin(), this->Spans.end(), control + this->P) -
           this->Spans.begin()) -
    1;
}

int GridAxis::ColumnAt(double t) const
{
  const auto next = std::upper_bound(this->Breaks.begin(), this->Breaks.end(), t);
  return std::clamp(int(next - this->Breaks.begin()) - 1, 0, this->Columns() - 1);
}

std::int64_t GridAxis::LineBelow(double t) const
{
  const int column = this->ColumnAt(t);
  const Interval extent = this->Extent(column);
  const double part = std::clamp((t - extent.Min) / extent.Length(), 0.0, 1.0 - 1e-9);
  return (std::int64_t(column) << ColumnBits) + std::int64_t(part * ColumnUnits);
}

double GridAxis::Parameter(std::uint32_t line) const
{
  const std::uint32_t column = line >> ColumnBits;
  const std::uint32_t part = line & (ColumnUnits - 1);
  return part == 0 ? this->Breaks[column]
                   : this->Breaks[column] +
      (this->Breaks[column + 1] - this->Breaks[column]) * (double(part) / ColumnUnits);
}

void GridAxis::EvaluateAt(int column, double t, double* basis) const
{
  const Interval extent = this->Extent(column);
  const double* bezier = this->Extraction(column);
  const int n = this->P + 1;
  const double s = (t - extent.Min) / extent.Length();
  double differences[MaxDegree];
  for (int x = 0; x < n; ++x)
  {
    basis[x] = Horner(bezier + x, n, this->P, s);
    for (int k = 0; k < this->P; ++k)
    {
      differences[k] = bezier[(k + 1) * n + x] - bezier[k * n + x];
    }
    basis[n + x] = this->P / extent.Length() * Horner(differences, 1, this->P - 1, s);
  }
}

int GridAxis::Line(std::uint32_t line)
{
  const std::int32_t known = this->Index.Find(line);
  if (known >= 0)
  {
    return known;
  }
  const int column = this->ColumnOf(line);
  const int index = this->Counts[column]++;
  std::vector<double>& table = this->Tables[column];
  table.resize(table.size() + 2 * (this->P + 1));
  this->EvaluateAt(
    column, this->Parameter(line), table.data() + std::size_t(index) * 2 * (this->P + 1));
  this->Index.Set(line, index);
  return index;
}

} // namespace nurbs
