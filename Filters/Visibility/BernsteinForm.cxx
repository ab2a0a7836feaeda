// SPDX-License-Identifier: BSD-3-Clause
#include "BernsteinForm.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

// Depth at which an interval of roots is narrower than rounding.
constexpr int MaxRootDepth = 52;

bool IsNegative(double x)
{
  return x < 0.0;
}

int SignVariations(const std::vector<double>& c)
{
  int count = 0;
  for (std::size_t k = 1; k < c.size(); ++k)
  {
    count += IsNegative(c[k]) != IsNegative(c[k - 1]);
  }
  return count;
}

// De Casteljau's algorithm in place for `count` values `stride` apart, from the low end: what is left
// are the coefficients over [t, 1]; those over [0, t] go to `low`, as far apart.
void SplitRow(double* row, int count, int stride, double t, double* low)
{
  for (int r = 0; r < count; ++r)
  {
    low[r * stride] = row[0];
    for (int k = 0; k + 1 < count - r; ++k)
    {
      row[k * stride] = (1.0 - t) * row[k * stride] + t * row[(k + 1) * stride];
    }
  }
}

// The only sign change in [0, 1], by bisection and the secant in turn.
double OnlyRoot(const std::vector<double>& c)
{
  double a = 0.0, b = 1.0;
  double fa = c.front(), fb = c.back();
  const bool negative = IsNegative(fa);
  double before = fa;
  for (int k = 0; k < 200; ++k)
  {
    double t = 0.5 * (a + b);
    if (k % 3 != 2 && fb != fa)
    {
      t = a - fa * (b - a) / (fb - fa);
    }
    t = t > a && t < b ? t : 0.5 * (a + b);
    if (!(t > a && t < b))
    {
      break;
    }
    const double f = EvaluateBernstein(c, t);
    const bool left = IsNegative(f) == negative;
    (left ? a : b) = t;
    (left ? fa : fb) = f;
    // The end that stays weighs less (the Illinois rule).
    if (IsNegative(f) == IsNegative(before))
    {
      (left ? fb : fa) *= 0.5;
    }
    before = f;
    if (f == 0.0 || b - a < 1e-17)
    {
      return f == 0.0 ? t : 0.5 * (a + b);
    }
  }
  return 0.5 * (a + b);
}

void AddRoots(std::vector<double>& c, double low, double high, int depth, std::vector<double>& out)
{
  const int variations = SignVariations(c);
  if (variations == 0)
  {
    return;
  }
  if (variations == 1)
  {
    out.push_back(low + (high - low) * OnlyRoot(c));
    return;
  }
  if (depth == MaxRootDepth)
  {
    if (IsNegative(c.front()) != IsNegative(c.back()))
    {
      out.push_back(0.5 * (low + high));
    }
    return;
  }
  std::vector<double> first(c.size());
  SplitRow(c.data(), static_cast<int>(c.size()), 1, 0.5, first.data());
  const double middle = 0.5 * (low + high);
  AddRoots(first, low, middle, depth + 1, out);
  AddRoots(c, middle, high, depth + 1, out);
}

} // namespace

double EvaluateBernstein(const std::vector<double>& c, double t)
{
  // Sum of c_i C(n, i) t^i (1 - t)^(n - i), by Horner's rule in t / (1 - t) or its reciprocal.
  const int n = static_cast<int>(c.size()) - 1;
  const bool upper = t > 0.5;
  const double x = upper ? 1.0 - t : t;
  const double ratio = x / (1.0 - x);
  double binomial = 1.0;
  double power = 1.0;
  double sum = 0.0;
  for (int i = 0; i <= n; ++i)
  {
    sum += c[upper ? n - i : i] * binomial * power;
    power *= ratio;
    binomial *= double(n - i) / (i + 1);
  }
  return sum * std::pow(1.0 - x, n);
}

std::vector<double> SignChanges(const std::vector<double>& coefficients)
{
  std::vector<double> roots;
  std::vector<double> c = coefficients;
  AddRoots(c, 0.0, 1.0, 0, roots);
  return roots;
}

std::vector<double> Binomials(int n)
{
  std::vector<double> out(n + 1, 1.0);
  for (int i = 1; i <= n; ++i)
  {
    out[i] = out[i - 1] * (n - i + 1) / i;
  }
  return out;
}

double BernsteinForm::Evaluate(double u, double v) const
{
  return EvaluateBernstein(this->OnLine(1, v), u);
}

double BernsteinForm::Magnitude() const
{
  double largest = 0.0;
  for (const double c : this->Coefficients)
  {
    largest = std::max(largest, std::abs(c));
  }
  return largest;
}

std::vector<double> BernsteinForm::OnLine(int dir, double at) const
{
  const int m = this->Degree[dir];
  const int n = this->Degree[1 - dir];
  const int along = dir == 0 ? 1 : this->Degree[0] + 1;
  const int across = dir == 0 ? this->Degree[0] + 1 : 1;
  std::vector<double> out(n + 1);
  std::vector<double> row(m + 1);
  for (int k = 0; k <= n; ++k)
  {
    if (at == 0.0 || at == 1.0)
    {
      out[k] = this->Coefficients[k * across + (at == 0.0 ? 0 : m) * along];
      continue;
    }
    for (int i = 0; i <= m; ++i)
    {
      row[i] = this->Coefficients[k * across + i * along];
    }
    out[k] = EvaluateBernstein(row, at);
  }
  return out;
}

void BernsteinForm::DivideBySide(int dir, int end)
{
  const int n = this->Degree[dir];
  BernsteinForm out;
  out.Degree[dir] = n - 1;
  out.Degree[1 - dir] = this->Degree[1 - dir];
  out.Coefficients.reserve((out.Degree[0] + 1) * (out.Degree[1] + 1));
  for (int j = 0; j <= out.Degree[1]; ++j)
  {
    for (int i = 0; i <= out.Degree[0]; ++i)
    {
      // C(n, k) c_k t^k (1 - t)^(n - k) over t is of degree n - 1 and index k - 1.
      const int k = dir == 0 ? i : j;
      const int shift = end == 0 ? 1 : 0;
      const double c = this->At(i + (dir == 0 ? shift : 0), j + (dir == 1 ? shift : 0));
      out.Coefficients.push_back(c * n / (end == 0 ? k + 1 : n - k));
    }
  }
  *this = std::move(out);
}

void Split(const BernsteinForm& form, int dir, double t, BernsteinForm& low, BernsteinForm& high)
{
  high = form;
  low.Degree[0] = form.Degree[0];
  low.Degree[1] = form.Degree[1];
  low.Coefficients.resize(form.Coefficients.size());
  const int width = form.Degree[0] + 1;
  const int height = form.Degree[1] + 1;
  for (int k = 0; k < (dir == 0 ? height : width); ++k)
  {
    const int first = dir == 0 ? k * width : k;
    SplitRow(high.Coefficients.data() + first, dir == 0 ? width : height, dir == 0 ? 1 : width, t,
      low.Coefficients.data() + first);
  }
}

ScaledForm::ScaledForm(int m, int n)
  : Degree{ m, n }
  , Coefficients((m + 1) * (n + 1), 0.0)
{}

void ScaledForm::AddProduct(double factor, const ScaledForm& a, const ScaledForm& b)
{
  const int wa = a.Degree[0] + 1;
  const int wb = b.Degree[0] + 1;
  const int width = this->Degree[0] + 1;
  for (int ja = 0; ja <= a.Degree[1]; ++ja)
  {
    for (int jb = 0; jb <= b.Degree[1]; ++jb)
    {
      double* const out = this->Coefficients.data() + (ja + jb) * width;
      const double* const rowB = b.Coefficients.data() + jb * wb;
      for (int ia = 0; ia < wa; ++ia)
      {
        const double c = factor * a.Coefficients[ja * wa + ia];
        for (int ib = 0; ib < wb; ++ib)
        {
          out[ia + ib] += c * rowB[ib];
        }
      }
    }
  }
}

void ScaledForm::AddTimesBilinear(double factor, const ScaledForm& a, bool u, bool v)
{
  for (int j = 0; j <= a.Degree[1]; ++j)
  {
    for (int i = 0; i <= a.Degree[0]; ++i)
    {
      this->Coefficients[i + u + (j + v) * (this->Degree[0] + 1)] +=
        factor * a.Coefficients[i + j * (a.Degree[0] + 1)];
    }
  }
}

BernsteinForm ScaledForm::Unscaled() const
{
  BernsteinForm out;
  out.Degree[0] = this->Degree[0];
  out.Degree[1] = this->Degree[1];
  out.Coefficients = this->Coefficients;
  const std::vector<double> bu = Binomials(out.Degree[0]);
  const std::vector<double> bv = Binomials(out.Degree[1]);
  for (int j = 0; j <= out.Degree[1]; ++j)
  {
    for (int i = 0; i <= out.Degree[0]; ++i)
    {
      out.Coefficients[i + j * (out.Degree[0] + 1)] /= bu[i] * bv[j];
    }
  }
  return out;
}

} // namespace nurbs
