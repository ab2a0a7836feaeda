// SPDX-License-Identifier: BSD-3-Clause
/// @file BernsteinForm.h
/// @brief Real polynomials of one and two variables in Bernstein form: signs, roots, factors.
///
/// A polynomial lies between its smallest and largest coefficient, and a univariate one has at most
/// as many roots as its coefficients change sign (Farin, Curves and Surfaces for CAGD, 5.3): all
/// that the subdivision of contours rests on. The domain is [0, 1] or [0, 1] x [0, 1].
#pragma once

#include "Types.h"

namespace nurbs
{

/// A tensor-product polynomial; coefficient (i, j) has index i + j * (Degree[0] + 1).
struct BernsteinForm
{
  int Degree[2] = { 0, 0 };
  std::vector<double> Coefficients;

  /// Coefficient (i, j).
  double At(int i, int j) const { return this->Coefficients[i + j * (this->Degree[0] + 1)]; }
  /// The polynomial's value.
  double Evaluate(double u, double v) const;
  /// Largest magnitude of a coefficient.
  double Magnitude() const;
  /// The univariate polynomial on the line u = at (dir 0) or v = at (dir 1).
  std::vector<double> OnLine(int dir, double at) const;
  /// The polynomial divided by u (dir 0, end 0), 1 - u (dir 0, end 1), v or 1 - v; the coefficients
  /// of that side, which must vanish, are dropped.
  void DivideBySide(int dir, int end);
};

/// Splits at t in direction `dir` by de Casteljau's algorithm; both halves hold the same bits along
/// the cut.
void Split(const BernsteinForm& form, int dir, double t, BernsteinForm& low, BernsteinForm& high);

/// Value of a univariate polynomial.
double EvaluateBernstein(const std::vector<double>& coefficients, double t);

/// All places in [0, 1] where a univariate polynomial changes its sign, in order, to rounding. A
/// root of even multiplicity is none; roots that rounding can't tell apart count by their parity. A
/// value of 0 counts as positive.
std::vector<double> SignChanges(const std::vector<double>& coefficients);

/// Products in the scaled Bernstein basis u^i (1 - u)^(m - i) v^j (1 - v)^(n - j), where they are
/// convolutions: `a` has (m1 + 1) x (n1 + 1) coefficients, `b` (m2 + 1) x (n2 + 1); factor times
/// their product is added to `product`, with m1 + m2 and n1 + n2.
struct ScaledForm
{
  int Degree[2] = { 0, 0 };
  std::vector<double> Coefficients;

  /// Zero, of degree m in u and n in v.
  ScaledForm(int m, int n);
  /// Adds factor a b; the degrees of a and b add up to this one's.
  void AddProduct(double factor, const ScaledForm& a, const ScaledForm& b);
  /// Adds `a`, of a degree lower by one in both directions, times u or 1 - u and v or 1 - v.
  void AddTimesBilinear(double factor, const ScaledForm& a, bool u, bool v);
  /// The same polynomial in the Bernstein basis.
  BernsteinForm Unscaled() const;
};

/// Binomial coefficients C(n, 0) to C(n, n).
std::vector<double> Binomials(int n);

} // namespace nurbs
