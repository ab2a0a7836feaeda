// SPDX-License-Identifier: BSD-3-Clause
#include "CubicFit.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace nurbs
{
namespace
{

constexpr std::size_t SampleCount = 40; // Of a fit, evenly along the polyline.
constexpr int Rounds = 8;               // Of fitting and better parameters.
constexpr int NewtonSteps = 2;
constexpr double Hopeless = 30.0; // Tolerances that more rounds won't mend.
constexpr double Slow = 0.9;      // Neither will they if a round leaves this part of the distance.
constexpr double AlongCurve = 0.01; // What a residual along the curve weighs, across it 1.
constexpr int DeepestSplit = 5;     // Of a bound: the control polygon is off by 4^-5 of its bow.

Vec2 Evaluate(const Cubic& c, double u)
{
  const double v = 1.0 - u;
  return v * v * v * c[0] + 3.0 * v * v * u * c[1] + 3.0 * v * u * u * c[2] + u * u * u * c[3];
}

Vec2 Derivative(const Cubic& c, double u)
{
  const double v = 1.0 - u;
  return 3.0 * (v * v * (c[1] - c[0]) + 2.0 * v * u * (c[2] - c[1]) + u * u * (c[3] - c[2]));
}

Vec2 SecondDerivative(const Cubic& c, double u)
{
  return 6.0 * ((1.0 - u) * (c[2] - 2.0 * c[1] + c[0]) + u * (c[3] - 2.0 * c[2] + c[1]));
}

std::pair<Cubic, Cubic> Split(const Cubic& c, double u)
{
  const auto mix = [u](const Vec2& a, const Vec2& b) { return Vec2(a + u * (b - a)); };
  const Vec2 ab = mix(c[0], c[1]), bc = mix(c[1], c[2]), cd = mix(c[2], c[3]);
  const Vec2 abc = mix(ab, bc), bcd = mix(bc, cd), middle = mix(abc, bcd);
  return { { c[0], ab, abc, middle }, { middle, bcd, cd, c[3] } };
}

Cubic Part(const Cubic& c, double from, double to)
{
  const Cubic rest = from > 0.0 ? Split(c, from).second : c;
  return to < 1.0 ? Split(rest, (to - from) / (1.0 - from)).first : rest;
}

// Whether all of a curve is within the tolerance of a segment. The distance from a segment is
// convex, so it is largest at a control point.
bool IsNear(const Cubic& c, const Vec2& a, const Vec2& b, double tolerance, int depth)
{
  const double ends = std::max(SegmentDistance(c[0], a, b), SegmentDistance(c[3], a, b));
  const double inner = std::max(SegmentDistance(c[1], a, b), SegmentDistance(c[2], a, b));
  if (std::max(ends, inner) <= tolerance)
  {
    return true;
  }
  if (ends > tolerance || depth == DeepestSplit)
  {
    return false;
  }
  const auto halves = Split(c, 0.5);
  return IsNear(halves.first, a, b, tolerance, depth + 1) &&
    IsNear(halves.second, a, b, tolerance, depth + 1);
}

// Whether no point of the cubic is farther than the tolerance from the polyline, and none of the
// polyline from the cubic; parameters do not decrease. From the curve to the polyline: IsNear. The
// other way: the part of a curve that belongs to a segment starts and ends near the segment's ends,
// and its projection onto the segment has no gap between.
bool KeepsWithin(const Cubic& cubic, const Vec2* points, const double* parameters,
  std::size_t count, double tolerance)
{
  for (std::size_t k = 0; k + 1 < count; ++k)
  {
    const Cubic part = Part(cubic, parameters[k], parameters[k + 1]);
    if ((part[0] - points[k]).norm() > tolerance || (part[3] - points[k + 1]).norm() > tolerance ||
      !IsNear(part, points[k], points[k + 1], tolerance, 0))
    {
      return false;
    }
  }
  return true;
}

// Points of a polyline, with parameters for them.
struct Samples
{
  std::vector<Vec2> Points;
  std::vector<double> Parameters;
};

// The lengths of a polyline up to its points, as parts of the whole.
std::vector<double> LengthsOf(const Vec2* points, std::size_t count)
{
  std::vector<double> lengths(count, 0.0);
  for (std::size_t k = 1; k < count; ++k)
  {
    lengths[k] = lengths[k - 1] + (points[k] - points[k - 1]).norm();
  }
  const double all = lengths.back();
  for (double& length : lengths)
  {
    length /= all;
  }
  return lengths;
}

Samples MakeSamples(const Vec2* points, const std::vector<double>& lengths)
{
  Samples samples;
  std::size_t k = 0;
  for (std::size_t s = 0; s <= SampleCount; ++s)
  {
    const double at = double(s) / SampleCount;
    while (k + 2 < lengths.size() && lengths[k + 1] < at)
    {
      ++k;
    }
    const double step = lengths[k + 1] - lengths[k];
    const double part = step > 0.0 ? std::clamp((at - lengths[k]) / step, 0.0, 1.0) : 0.0;
    samples.Points.emplace_back(points[k] + part * (points[k + 1] - points[k]));
    samples.Parameters.push_back(at);
  }
  samples.Points.back() = points[lengths.size() - 1];
  return samples;
}

// Least squares: each inner control point is two numbers, or the distance along a given tangent.
// With distances that are not positive, the curve would turn back at once; a third of the chord is
// taken then, after Wu and Barsky. Parameters follow residuals along the curve anyway, which
// therefore weigh little if a curve that is near (`last`) tells the directions: this converges in a
// few rounds, where equal weights crawl.
Cubic Solve(const Samples& samples, const CubicEnds& ends, const Cubic* last)
{
  Cubic c;
  c[0] = samples.Points.front();
  c[3] = samples.Points.back();
  const int columns[2] = { ends.Free[0] ? 2 : 1, ends.Free[1] ? 2 : 1 };
  const int size = columns[0] + columns[1];
  Eigen::Matrix4d left = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (std::size_t k = 0; k < samples.Points.size(); ++k)
  {
    const double u = samples.Parameters[k], v = 1.0 - u;
    const double basis[2] = { 3.0 * v * v * u, 3.0 * v * u * u };
    Eigen::Matrix<double, 2, 4> row = Eigen::Matrix<double, 2, 4>::Zero();
    // Control points count from their ends: c1 = c0 + ..., c2 = c3 - ...
    Vec2 rest = samples.Points[k] - (v * v * v + basis[0]) * c[0] - (u * u * u + basis[1]) * c[3];
    for (int side = 0, at = 0; side < 2; at += columns[side], ++side)
    {
      const double sign = side == 0 ? basis[0] : -basis[1];
      if (!ends.Free[side])
      {
        row.col(at) = sign * ends.Tangent[side];
      }
      else
      {
        row(0, at) = row(1, at + 1) = sign;
      }
    }
    if (last)
    {
      const Vec2 along = Derivative(*last, u).normalized();
      Eigen::Matrix2d weights;
      weights << AlongCurve * along.transpose(), -along.y(), along.x();
      row = weights * row;
      rest = weights * rest;
    }
    left += row.transpose() * row;
    right += row.transpose() * rest;
  }
  left.bottomRightCorner(4 - size, 4 - size).setIdentity();
  const Eigen::Vector4d x = left.ldlt().solve(right);
  const double third = (c[3] - c[0]).norm() / 3.0;
  for (int side = 0, at = 0; side < 2; at += columns[side], ++side)
  {
    Vec2 offset = x.segment<2>(std::min(at, 2));
    if (!ends.Free[side])
    {
      const double distance = x[at] > 1e-3 * third ? x[at] : third;
      offset = distance * ends.Tangent[side];
    }
    c[std::size_t(1 + side)] = side == 0 ? Vec2(c[0] + offset) : Vec2(c[3] - offset);
  }
  return c;
}

// Moves the parameters to the nearest points of the curve by Newton's method; returns the largest
// distance.
double Improve(const Cubic& c, Samples& samples)
{
  double largest = 0.0, before = 0.0;
  for (std::size_t k = 1; k + 1 < samples.Points.size(); ++k)
  {
    double& u = samples.Parameters[k];
    Vec2 off = Evaluate(c, u) - samples.Points[k];
    for (int step = 0; step < NewtonSteps; ++step)
    {
      const Vec2 first = Derivative(c, u);
      const double slope = first.squaredNorm() + off.dot(SecondDerivative(c, u));
      if (slope > 0.0)
      {
        u = std::clamp(u - off.dot(first) / slope, before, 1.0);
        off = Evaluate(c, u) - samples.Points[k];
      }
    }
    before = u;
    largest = std::max(largest, off.norm());
  }
  return largest;
}

// The polyline's own points, with parameters by those of the samples.
Samples AllPoints(const Vec2* points, const std::vector<double>& lengths, const Samples& samples)
{
  Samples all;
  all.Points.assign(points, points + lengths.size());
  all.Parameters.resize(lengths.size());
  for (std::size_t k = 0; k < lengths.size(); ++k)
  {
    const double at = lengths[k] * SampleCount;
    const auto s = std::min(std::size_t(at), SampleCount - 1);
    const double from = samples.Parameters[s];
    all.Parameters[k] = from + (at - double(s)) * (samples.Parameters[s + 1] - from);
  }
  all.Parameters.back() = 1.0;
  return all;
}

} // namespace

//--------------------------------------------------------------------------------------------------
double SegmentDistance(const Vec2& point, const Vec2& a, const Vec2& b)
{
  const Vec2 chord = b - a;
  const double square = chord.squaredNorm();
  const double t = square > 0.0 ? std::clamp((point - a).dot(chord) / square, 0.0, 1.0) : 0.0;
  return (point - a - t * chord).norm();
}

//--------------------------------------------------------------------------------------------------
std::optional<Cubic> FitCubic(
  const Vec2* points, std::size_t count, const CubicEnds& ends, double tolerance)
{
  const std::vector<double> lengths = LengthsOf(points, count);
  Samples samples = MakeSamples(points, lengths);
  Cubic cubic;
  double before = std::numeric_limits<double>::max();
  for (int round = 0; round < Rounds; ++round)
  {
    const Cubic last = cubic;
    cubic = Solve(samples, ends, round > 0 ? &last : nullptr);
    const double distance = Improve(cubic, samples);
    if (round > 1 && (distance > Hopeless * tolerance || distance > Slow * before))
    {
      break;
    }
    if (distance <= tolerance)
    {
      Samples all = AllPoints(points, lengths, samples);
      if (Improve(cubic, all) <= tolerance &&
        KeepsWithin(cubic, points, all.Parameters.data(), count, tolerance))
      {
        return cubic;
      }
    }
    before = distance;
  }
  return std::nullopt;
}

} // namespace nurbs
