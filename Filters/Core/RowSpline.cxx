// SPDX-License-Identifier: BSD-3-Clause
#include "RowSpline.h"

#include "Multiversion.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

/// to = a * x + (1 - a) * y; `to` may be x.
NURBS_MULTIVERSION
void BlendRows(double a, const double* x, const double* y, double* to, int width)
{
  const double b = 1.0 - a;
  for (int i = 0; i < width; ++i)
  {
    to[i] = a * x[i] + b * y[i];
  }
}

/// Appends degree + 1 rows of zeros and knots behind the last. They do not change the spline inside
/// its domain, but let a knot be inserted at the domain's end like anywhere else: the new rows that
/// matter get the zeros with factor 0.
void AppendPhantoms(RowSpline& spline)
{
  const double step = std::max(1.0, std::abs(spline.Knots.back()));
  for (int i = 0; i <= spline.Degree; ++i)
  {
    spline.Knots.push_back(spline.Knots.back() + step);
  }
  spline.Rows.resize(spline.Rows.size() + std::size_t(spline.Degree + 1) * spline.Width, 0.0);
}

void CheckInsertion(const RowSpline& spline, ArrayView<double> add)
{
  const Interval domain = Domain(spline.Knots, spline.Degree);
  for (std::size_t i = 0; i < add.size(); ++i)
  {
    if (!(add[i] >= domain.Min && add[i] <= domain.Max))
    {
      throw Error("knot to insert, " + std::to_string(add[i]) + ", is outside the domain");
    }
    if (i > 0 && add[i] < add[i - 1])
    {
      throw Error("knots to insert are not sorted");
    }
  }
}

/// The spline without the `rows` last rows and knots.
void DropLast(RowSpline& spline, std::int64_t rows)
{
  spline.Knots.resize(spline.Knots.size() - rows);
  spline.Rows.resize(spline.Rows.size() - rows * spline.Width);
}

int Multiplicity(const std::vector<double>& knots, double t)
{
  const auto range = std::equal_range(knots.begin(), knots.end(), t);
  return static_cast<int>(range.second - range.first);
}

/// The knot within round-off of t, or t itself.
double SnapToKnot(const std::vector<double>& knots, double t)
{
  const double reach = 1e-14 *
    std::max({ knots.back() - knots.front(), std::abs(knots.front()), std::abs(knots.back()) });
  const auto above = std::lower_bound(knots.begin(), knots.end(), t);
  if (above != knots.end() && *above - t <= reach)
  {
    return *above;
  }
  if (above != knots.begin() && t - above[-1] <= reach)
  {
    return above[-1];
  }
  return t;
}

} // namespace

void InsertKnots(RowSpline& spline, ArrayView<double> add)
{
  if (add.empty())
  {
    return;
  }
  CheckInsertion(spline, add);
  RowSpline old = std::move(spline);
  AppendPhantoms(old);
  const int p = old.Degree;
  const int width = old.Width;
  spline = RowSpline();
  spline.Degree = p;
  spline.Width = width;
  spline.Knots.resize(old.Knots.size() + add.size());
  spline.Rows.resize(old.Rows.size() + add.size() * width);
  // Everything up to the current span has moved to the result, shifted by the number of insertions;
  // everything behind it is still untouched in `old`.
  std::int64_t moved = 0;
  std::int64_t inserted = 0;
  const auto moveUpTo = [&](std::int64_t end) {
    if (end > moved)
    {
      std::copy(old.Row(moved), old.Row(end), spline.Row(moved + inserted));
      std::copy(old.Knots.begin() + moved, old.Knots.begin() + end,
        spline.Knots.begin() + moved + inserted);
      moved = end;
    }
  };
  for (double t : add)
  {
    const std::int64_t k =
      std::upper_bound(old.Knots.begin(), old.Knots.end(), t) - old.Knots.begin() - 1;
    moveUpTo(k + 1);
    const std::int64_t span = k + inserted;
    std::copy(spline.Row(span), spline.Row(span + 1), spline.Row(span + 1));
    for (std::int64_t i = span; i > span - p; --i)
    {
      const double left = spline.Knots[i];
      const double a = (t - left) / (old.Knots[i + p - inserted] - left);
      BlendRows(a, spline.Row(i), spline.Row(i - 1), spline.Row(i), width);
    }
    spline.Knots[span + 1] = t;
    ++inserted;
  }
  std::copy(old.Row(moved), old.Row(old.Count()), spline.Row(moved + inserted));
  std::copy(old.Knots.begin() + moved, old.Knots.end(), spline.Knots.begin() + moved + inserted);
  DropLast(spline, p + 1);
  for (double t : add)
  {
    if (Multiplicity(spline.Knots, t) > p + 1)
    {
      throw Error("knot " + std::to_string(t) + " would occur more than degree + 1 times");
    }
  }
}

RowSpline ClampRows(const RowSpline& spline, double t0, double t1)
{
  const int p = spline.Degree;
  const Interval domain = Domain(spline.Knots, p);
  const double a = SnapToKnot(spline.Knots, t0);
  const double b = SnapToKnot(spline.Knots, t1);
  if (!(a < b) || !(a >= domain.Min) || !(b <= domain.Max))
  {
    throw Error("[" + std::to_string(t0) + ", " + std::to_string(t1) +
      "] is empty or leaves the parameter domain [" + std::to_string(domain.Min) + ", " +
      std::to_string(domain.Max) + "]");
  }
  std::vector<double> add(std::max(0, p - Multiplicity(spline.Knots, a)), a);
  add.insert(add.end(), std::max(0, p - Multiplicity(spline.Knots, b)), b);
  RowSpline refined = spline;
  InsertKnots(refined, add);
  // Of the rows, those between the last span that starts at a and the first that ends at b count.
  const std::vector<double>& knots = refined.Knots;
  const std::int64_t first =
    std::upper_bound(knots.begin(), knots.end(), a) - knots.begin() - 1 - p;
  const std::int64_t last = std::lower_bound(knots.begin(), knots.end(), b) - knots.begin() - 1;
  RowSpline part;
  part.Degree = p;
  part.Width = spline.Width;
  part.Rows.assign(refined.Row(first), refined.Row(last + 1));
  part.Knots.assign(p + 1, t0);
  part.Knots.insert(part.Knots.end(), knots.begin() + first + p + 1, knots.begin() + last + 1);
  part.Knots.insert(part.Knots.end(), p + 1, t1);
  return part;
}

namespace
{

/// Elevates one clamped piece without breaks: distinct knots[i] occurs multiplicities[i] <= p times
/// inside.
RowSpline ElevatePiece(const RowSpline& piece)
{
  const int p = piece.Degree;
  const std::vector<Knot> knots = DistinctKnots(piece.Knots, p);
  RowSpline raised;
  raised.Degree = p + 1;
  raised.Width = piece.Width;
  for (const Knot& knot : knots)
  {
    raised.Knots.insert(raised.Knots.end(), knot.Multiplicity + 1, knot.Value);
  }
  const std::int64_t count = raised.Count();
  raised.Rows.assign(count * raised.Width, 0.0);
  // The blossom of row j of the result is the mean over c of the piece's blossoms at the p + 1
  // consecutive raised knots j + 1 ... j + p + 1 less the one whose index is c modulo p + 1. For one
  // c, they all are rows of one refinement.
  for (int c = 0; c <= p; ++c)
  {
    std::vector<double> add;
    std::int64_t index = 0; // of the raised knot
    for (std::size_t k = 0; k < knots.size(); ++k)
    {
      const std::int64_t end = index + knots[k].Multiplicity + 1;
      bool removed = false;
      for (; index < end; ++index)
      {
        removed = removed || index % (p + 1) == c;
      }
      if (!removed && k > 0 && k + 1 < knots.size())
      {
        add.push_back(knots[k].Value);
      }
    }
    RowSpline refined = piece;
    InsertKnots(refined, add);
    // The two removed copies of the first knot for c = 0 are one too many.
    std::int64_t row = c == 0 ? 1 : 0;
    for (std::int64_t j = 0; j < count; ++j)
    {
      row -= j % (p + 1) == c ? 1 : 0;
      const double* from = refined.Row(row + j);
      double* to = raised.Row(j);
      for (int i = 0; i < piece.Width; ++i)
      {
        to[i] += from[i];
      }
    }
  }
  for (double& x : raised.Rows)
  {
    x /= p + 1;
  }
  return raised;
}

/// A clamped spline in pieces that are cut at the knots of multiplicity degree + 1.
std::vector<RowSpline> CutAtBreaks(const RowSpline& spline)
{
  const int p = spline.Degree;
  std::vector<RowSpline> pieces;
  std::int64_t first = 0; // knot and row where the piece starts
  for (std::int64_t i = p + 1; i < spline.Count() + 1; ++i)
  {
    if (spline.Knots[i] != spline.Knots[i + p])
    {
      continue;
    }
    RowSpline piece;
    piece.Degree = p;
    piece.Width = spline.Width;
    piece.Knots.assign(spline.Knots.begin() + first, spline.Knots.begin() + i + p + 1);
    piece.Rows.assign(spline.Row(first), spline.Row(i));
    pieces.push_back(std::move(piece));
    first = i;
  }
  return pieces;
}

} // namespace

void ElevateRows(RowSpline& spline)
{
  const int p = spline.Degree;
  if (p + 1 > MaxDegree)
  {
    throw Error(
      "degree " + std::to_string(p) + " cannot be raised over " + std::to_string(MaxDegree));
  }
  if (!IsClamped(spline.Knots, p))
  {
    const Interval domain = Domain(spline.Knots, p);
    spline = ClampRows(spline, domain.Min, domain.Max);
  }
  RowSpline raised;
  raised.Degree = p + 1;
  raised.Width = spline.Width;
  for (const RowSpline& piece : CutAtBreaks(spline))
  {
    const RowSpline part = ElevatePiece(piece);
    const std::size_t shared = raised.Knots.empty() ? 0 : p + 2; // the knots at the break
    raised.Knots.insert(raised.Knots.end(), part.Knots.begin() + shared, part.Knots.end());
    raised.Rows.insert(raised.Rows.end(), part.Rows.begin(), part.Rows.end());
  }
  spline = std::move(raised);
}

bool ReduceRowDegree(const RowSpline& spline, RowSpline& reduced, std::vector<double>& residual)
{
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const int p = spline.Degree;
  if (p <= 1)
  {
    return false;
  }
  const Interval domain = Domain(spline.Knots, p);
  const RowSpline clamped =
    IsClamped(spline.Knots, p) ? spline : ClampRows(spline, domain.Min, domain.Max);
  reduced = RowSpline();
  reduced.Degree = p - 1;
  reduced.Width = spline.Width;
  std::vector<double> gone; // simple knots: the degree less, a knot that smooth is none
  for (const Knot& knot : DistinctKnots(clamped.Knots, p))
  {
    reduced.Knots.insert(reduced.Knots.end(), knot.Multiplicity - 1, knot.Value);
    gone.insert(gone.end(), knot.Multiplicity == 1 ? 1 : 0, knot.Value);
  }
  // The matrix of elevation: what it makes of the unit vectors.
  const std::int64_t columns = reduced.Count();
  RowSpline unit = reduced;
  unit.Width = static_cast<int>(columns);
  unit.Rows.assign(columns * columns, 0.0);
  for (std::int64_t i = 0; i < columns; ++i)
  {
    unit.Row(i)[i] = 1.0;
  }
  ElevateRows(unit);
  InsertKnots(unit, gone);
  const Eigen::Map<const Matrix> dense(unit.Rows.data(), clamped.Count(), columns);
  const Eigen::SparseMatrix<double> elevation = dense.sparseView();
  const Eigen::Map<const Matrix> rows(clamped.Rows.data(), clamped.Count(), clamped.Width);
  // Elevation is a matrix of convex combinations with a condition number of about the degree, so the
  // normal equations with one step of iterative refinement solve to round-off.
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> normal(
    elevation.transpose() * elevation);
  Matrix solution = normal.solve(elevation.transpose() * rows);
  solution += normal.solve(elevation.transpose() * (rows - elevation * solution));
  const Matrix rest = elevation * solution - rows;
  reduced.Rows.assign(solution.data(), solution.data() + solution.size());
  residual.assign(rest.data(), rest.data() + rest.size());
  return true;
}

BezierForm ToBezierForm(const RowSpline& spline)
{
  const int p = spline.Degree;
  BezierForm form;
  std::vector<double> add;
  for (const Knot& knot : DistinctKnots(spline.Knots, p))
  {
    form.Breaks.push_back(knot.Value);
    add.insert(add.end(), std::max(0, p - knot.Multiplicity), knot.Value);
  }
  form.Refined = spline;
  InsertKnots(form.Refined, add);
  const std::vector<double>& knots = form.Refined.Knots;
  auto above = knots.begin();
  for (std::size_t k = 0; k + 1 < form.Breaks.size(); ++k)
  {
    above = std::upper_bound(above, knots.end(), form.Breaks[k]);
    form.First.push_back(above - knots.begin() - 1 - p);
  }
  return form;
}

} // namespace nurbs
