// SPDX-License-Identifier: BSD-3-Clause
#include "CurveFit.h"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr double Pi = 3.14159265358979323846;
constexpr std::array<int, 5> Degrees{ { 1, 2, 3, 5, 7 } };
constexpr int SurfaceDegree = 7;
constexpr int MaxHalvings = 10;
constexpr std::size_t MaxSpans = 256;

using Matrix = Eigen::MatrixXd;

/// Bernstein polynomials of a degree at s.
Eigen::VectorXd Bernstein(int degree, double s)
{
  Eigen::VectorXd b = Eigen::VectorXd::Zero(degree + 1);
  b[0] = 1.0;
  for (int j = 1; j <= degree; ++j)
  {
    for (int i = j; i > 0; --i)
    {
      b[i] = (1.0 - s) * b[i] + s * b[i - 1];
    }
    b[0] *= 1.0 - s;
  }
  return b;
}

/// Interpolation of one degree: values at Nodes -> Bezier points; values of the piece at Checks.
struct Interpolation
{
  explicit Interpolation(int degree)
  {
    Matrix collocation(degree + 1, degree + 1);
    for (int i = 0; i <= degree; ++i)
    {
      this->Nodes.push_back(0.5 - 0.5 * std::cos(Pi * i / degree));
      collocation.row(i) = Bernstein(degree, this->Nodes[i]).transpose();
    }
    this->ToBezier = collocation.inverse();
    // Between the nodes, where the deviation peaks, and beside, lest a wave hide.
    const int checks = degree < 3 ? 5 : 2 * degree;
    for (int i = 0; i < checks; ++i)
    {
      this->Checks.push_back(0.5 - 0.5 * std::cos(Pi * (i + 0.47) / checks));
    }
    this->AtChecks.resize(checks, degree + 1);
    for (int i = 0; i < checks; ++i)
    {
      this->AtChecks.row(i) = Bernstein(degree, this->Checks[i]).transpose();
    }
  }
  std::vector<double> Nodes, Checks;
  Matrix ToBezier, AtChecks;
};

const Interpolation& GetInterpolation(int degree)
{
  static const std::array<Interpolation, 5> all{ { Interpolation(Degrees[0]),
    Interpolation(Degrees[1]), Interpolation(Degrees[2]), Interpolation(Degrees[3]),
    Interpolation(Degrees[4]) } };
  const auto it = std::find(Degrees.begin(), Degrees.end(), degree);
  return all[static_cast<std::size_t>(it - Degrees.begin())];
}

template <int D>
struct Piece
{
  double T0, T1;
  std::vector<Vec<D>> Points;
};

template <int D>
class CurveFitter
{
public:
  CurveFitter(const std::function<Vec<D>(double)>& function, const Vec<D>& scale, double tolerance)
    : Function(function)
    , Scale(scale)
    , Tolerance(tolerance)
  {}

  /// The piece of `degree` over [t0, t1] and its deviation.
  double Interpolate(int degree, double t0, double t1, std::vector<Vec<D>>& points) const
  {
    const Interpolation& rule = GetInterpolation(degree);
    Matrix values(degree + 1, D);
    for (int i = 0; i <= degree; ++i)
    {
      values.row(i) = this->Function(this->At(t0, t1, rule.Nodes[i])).transpose();
    }
    const Matrix bezier = rule.ToBezier * values;
    points.resize(degree + 1);
    for (int i = 0; i <= degree; ++i)
    {
      points[i] = bezier.row(i).transpose();
    }
    points.front() = values.row(0).transpose();
    points.back() = values.row(degree).transpose();
    const Matrix checks = rule.AtChecks * bezier;
    double error = 0.0;
    for (std::size_t i = 0; i < rule.Checks.size(); ++i)
    {
      const Vec<D> f = this->Function(this->At(t0, t1, rule.Checks[i]));
      const Vec<D> p = checks.row(static_cast<int>(i)).transpose();
      error = std::max(error, (f - p).cwiseProduct(this->Scale).norm());
    }
    return error;
  }

  void Fit(double t0, double t1, int halvings)
  {
    std::vector<Vec<D>> points;
    double error = 0.0;
    for (const int degree : Degrees)
    {
      error = this->Interpolate(degree, t0, t1, points);
      if (error <= this->Tolerance)
      {
        break;
      }
    }
    const double middle = 0.5 * (t0 + t1);
    if (error > this->Tolerance && halvings < MaxHalvings && t0 < middle && middle < t1)
    {
      this->Fit(t0, middle, halvings + 1);
      this->Fit(middle, t1, halvings + 1);
      return;
    }
    this->Error = std::max(this->Error, error);
    this->Pieces.push_back({ t0, t1, std::move(points) });
  }

  /// One straight line over everything, if it is one.
  bool FitLine(const std::vector<double>& breaks)
  {
    std::vector<Vec<D>> points;
    const double t0 = breaks.front();
    const double t1 = breaks.back();
    double error = this->Interpolate(1, t0, t1, points);
    if (error > this->Tolerance)
    {
      return false;
    }
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
    {
      for (const double r : { 0.0, 0.23, 0.61 })
      {
        const double t = this->At(breaks[i], breaks[i + 1], r);
        const double s = (t - t0) / (t1 - t0);
        const Vec<D> line = (1.0 - s) * points[0] + s * points[1];
        error = std::max(error, (line - this->Function(t)).cwiseProduct(this->Scale).norm());
      }
    }
    if (error > this->Tolerance)
    {
      return false;
    }
    this->Error = error;
    this->Pieces.assign(1, { t0, t1, std::move(points) });
    return true;
  }

  Curve<D> Join() const
  {
    std::size_t size = 2;
    for (const Piece<D>& piece : this->Pieces)
    {
      size = std::max(size, piece.Points.size());
    }
    Curve<D> curve;
    curve.Degree = static_cast<int>(size) - 1;
    curve.Knots.assign(size, this->Pieces.front().T0);
    for (const Piece<D>& piece : this->Pieces)
    {
      std::vector<Vec<D>> points = piece.Points;
      while (points.size() < size)
      {
        points = this->Elevate(points);
      }
      curve.Points.insert(
        curve.Points.end(), points.begin() + (curve.Points.empty() ? 0 : 1), points.end());
      curve.Knots.insert(curve.Knots.end(), size - 1, piece.T1);
    }
    curve.Knots.push_back(curve.Knots.back());
    curve.Weights.assign(curve.Points.size(), 1.0);
    curve.Pack();
    return curve;
  }

  double Error = 0.0;

private:
  static double At(double t0, double t1, double s)
  {
    return s <= 0.0 ? t0 : (s >= 1.0 ? t1 : t0 + s * (t1 - t0));
  }

  static std::vector<Vec<D>> Elevate(const std::vector<Vec<D>>& points)
  {
    const std::size_t n = points.size();
    std::vector<Vec<D>> result(n + 1);
    for (std::size_t i = 0; i <= n; ++i)
    {
      const double a = double(i) / double(n);
      result[i] = (i > 0 ? Vec<D>(a * points[i - 1]) : Vec<D>(Vec<D>::Zero())) +
        (i < n ? Vec<D>((1.0 - a) * points[i]) : Vec<D>(Vec<D>::Zero()));
    }
    return result;
  }

  const std::function<Vec<D>(double)>& Function;
  Vec<D> Scale;
  double Tolerance;
  std::vector<Piece<D>> Pieces;
};

/// The function interpolated over a grid of spans.
class SurfaceFitter
{
public:
  SurfaceFitter(const std::function<Vec3(double, double)>& function)
    : Function(function)
    , Rule(GetInterpolation(SurfaceDegree))
  {}

  /// Interpolates and measures; the spans to halve are marked in `worst[dir]`.
  double Fit(const std::vector<double>* breaks, double tolerance, std::vector<bool>* worst)
  {
    this->Nodes[0] = this->NodesOf(breaks[0]);
    this->Nodes[1] = this->NodesOf(breaks[1]);
    const std::size_t nu = this->Nodes[0].size();
    this->Values.resize(nu * this->Nodes[1].size());
    for (std::size_t k = 0; k < this->Values.size(); ++k)
    {
      this->Values[k] = this->Function(this->Nodes[0][k % nu], this->Nodes[1][k / nu]);
    }
    double error = 0.0;
    for (int dir = 0; dir < 2; ++dir)
    {
      worst[dir].assign(breaks[dir].size() - 1, false);
      error = std::max(error, this->Measure(dir, breaks[dir], tolerance, worst[dir]));
    }
    return error;
  }

  Surface Make(const std::vector<double>* breaks) const
  {
    Surface surface;
    std::vector<Vec3> points = this->Values;
    for (int dir = 0; dir < 2; ++dir)
    {
      surface.Degree[dir] = SurfaceDegree;
      surface.Count[dir] = static_cast<int>(this->Nodes[dir].size());
      surface.Knots[dir].assign(SurfaceDegree + 1, breaks[dir].front());
      for (std::size_t i = 1; i < breaks[dir].size(); ++i)
      {
        surface.Knots[dir].insert(surface.Knots[dir].end(), SurfaceDegree, breaks[dir][i]);
      }
      surface.Knots[dir].push_back(breaks[dir].back());
      this->ToBezier(dir, points);
    }
    surface.Points = std::move(points);
    return surface;
  }

private:
  std::vector<double> NodesOf(const std::vector<double>& breaks) const
  {
    std::vector<double> nodes{ breaks.front() };
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
    {
      for (int k = 1; k < SurfaceDegree; ++k)
      {
        nodes.push_back(breaks[i] + this->Rule.Nodes[k] * (breaks[i + 1] - breaks[i]));
      }
      nodes.push_back(breaks[i + 1]);
    }
    return nodes;
  }

  /// Deviation of the interpolants along the lines of nodes in one direction.
  double Measure(
    int dir, const std::vector<double>& breaks, double tolerance, std::vector<bool>& worst) const
  {
    const std::size_t stride[2] = { 1, this->Nodes[0].size() };
    const std::size_t lines = this->Nodes[1 - dir].size();
    double largest = 0.0;
    for (std::size_t s = 0; s + 1 < breaks.size(); ++s)
    {
      double error = 0.0;
      for (std::size_t line = 0; line < lines; ++line)
      {
        Matrix values(SurfaceDegree + 1, 3);
        for (int k = 0; k <= SurfaceDegree; ++k)
        {
          const std::size_t at = s * SurfaceDegree + static_cast<std::size_t>(k);
          values.row(k) = this->Values[at * stride[dir] + line * stride[1 - dir]].transpose();
        }
        const Matrix fitted = this->Rule.AtChecks * (this->Rule.ToBezier * values);
        for (std::size_t i = 1; i < this->Rule.Checks.size(); i += 3)
        {
          const double t = breaks[s] + this->Rule.Checks[i] * (breaks[s + 1] - breaks[s]);
          const double other = this->Nodes[1 - dir][line];
          const Vec3 f = dir == 0 ? this->Function(t, other) : this->Function(other, t);
          error = std::max(error, (fitted.row(static_cast<int>(i)).transpose() - f).norm());
        }
      }
      worst[s] = error > tolerance;
      largest = std::max(largest, error);
    }
    return largest;
  }

  void ToBezier(int dir, std::vector<Vec3>& points) const
  {
    const std::size_t stride[2] = { 1, this->Nodes[0].size() };
    const std::size_t spans = (this->Nodes[dir].size() - 1) / SurfaceDegree;
    const std::vector<Vec3> values = points;
    for (std::size_t line = 0; line < this->Nodes[1 - dir].size(); ++line)
    {
      for (std::size_t s = 0; s < spans; ++s)
      {
        for (int i = 1; i < SurfaceDegree; ++i)
        {
          Vec3 sum = Vec3::Zero();
          for (int k = 0; k <= SurfaceDegree; ++k)
          {
            const std::size_t at = s * SurfaceDegree + static_cast<std::size_t>(k);
            sum += this->Rule.ToBezier(i, k) * values[at * stride[dir] + line * stride[1 - dir]];
          }
          const std::size_t to = s * SurfaceDegree + static_cast<std::size_t>(i);
          points[to * stride[dir] + line * stride[1 - dir]] = sum;
        }
      }
    }
  }

  const std::function<Vec3(double, double)>& Function;
  const Interpolation& Rule;
  std::vector<double> Nodes[2];
  std::vector<Vec3> Values;
};

std::vector<double> Halve(const std::vector<double>& breaks, const std::vector<bool>& worst)
{
  std::vector<double> result{ breaks.front() };
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
  {
    if (worst[i])
    {
      result.push_back(0.5 * (breaks[i] + breaks[i + 1]));
    }
    result.push_back(breaks[i + 1]);
  }
  return result;
}

} // namespace

std::vector<double> DistinctBreaks(std::vector<double> breaks, const Interval& range)
{
  std::sort(breaks.begin(), breaks.end());
  const double apart = 1e-9 * range.Length();
  std::vector<double> distinct{ range.Min };
  for (const double t : breaks)
  {
    if (t > distinct.back() + apart && t < range.Max - apart)
    {
      distinct.push_back(t);
    }
  }
  distinct.push_back(range.Max);
  return distinct;
}

template <int D>
Curve<D> FitCurve(const std::function<Vec<D>(double)>& function, const std::vector<double>& breaks,
  const Vec<D>& scale, double tolerance, double& error)
{
  CurveFitter<D> fitter(function, scale, tolerance);
  if (!fitter.FitLine(breaks))
  {
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
    {
      fitter.Fit(breaks[i], breaks[i + 1], 0);
    }
  }
  error = fitter.Error;
  return fitter.Join();
}

template Curve<2> FitCurve<2>(
  const std::function<Vec2(double)>&, const std::vector<double>&, const Vec2&, double, double&);
template Curve<3> FitCurve<3>(
  const std::function<Vec3(double)>&, const std::vector<double>&, const Vec3&, double, double&);

Surface FitSurface(const std::function<Vec3(double, double)>& function, std::vector<double> uBreaks,
  std::vector<double> vBreaks, double tolerance, double& error)
{
  std::vector<double> breaks[2] = { std::move(uBreaks), std::move(vBreaks) };
  SurfaceFitter fitter(function);
  std::vector<bool> worst[2];
  for (;;)
  {
    error = fitter.Fit(breaks, tolerance, worst);
    if (error <= tolerance || breaks[0].size() > MaxSpans || breaks[1].size() > MaxSpans)
    {
      return fitter.Make(breaks);
    }
    breaks[0] = Halve(breaks[0], worst[0]);
    breaks[1] = Halve(breaks[1], worst[1]);
  }
}

} // namespace nurbs
