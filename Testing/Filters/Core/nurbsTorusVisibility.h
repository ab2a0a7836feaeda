// SPDX-License-Identifier: BSD-3-Clause
// What is visible of tori, without any patch: whether a ray leaves a torus for good is a question of
// one cubic or quartic polynomial's smallest value.
#ifndef nurbsTorusVisibility_h
#define nurbsTorusVisibility_h

#include "Types.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace reference
{

/// A torus around the z axis of its place.
struct PlacedTorus
{
  double Radius = 1.0, Tube = 0.3;
  Eigen::Isometry3d Place = Eigen::Isometry3d::Identity();

  nurbs::Vec3 Normal(double ring, double tube) const
  {
    return this->Place.linear() *
      nurbs::Vec3(std::cos(tube) * std::cos(ring), std::cos(tube) * std::sin(ring), std::sin(tube));
  }
  nurbs::Vec3 Point(double ring, double tube) const
  {
    return this->Place *
      nurbs::Vec3(this->Radius * std::cos(ring), this->Radius * std::sin(ring), 0) +
      this->Tube * this->Normal(ring, tube);
  }
};

/// The real roots of x^3 + a x^2 + b x + c.
inline std::vector<double> CubicRoots(double a, double b, double c)
{
  const double p = b - a * a / 3.0, q = 2.0 * a * a * a / 27.0 - a * b / 3.0 + c;
  const double discriminant = q * q / 4.0 + p * p * p / 27.0;
  if (discriminant > 0.0)
  {
    const double s = std::sqrt(discriminant);
    return { std::cbrt(-q / 2.0 + s) + std::cbrt(-q / 2.0 - s) - a / 3.0 };
  }
  const double m = 2.0 * std::sqrt(std::max(0.0, -p / 3.0));
  const double angle = m > 0.0 ? std::acos(std::clamp(3.0 * q / (p * m), -1.0, 1.0)) / 3.0 : 0.0;
  std::vector<double> roots;
  for (int k = 0; k < 3; ++k)
  {
    roots.push_back(m * std::cos(angle - 2.0943951023931953 * k) - a / 3.0);
  }
  return roots;
}

/// True if the torus blocks the ray from `point` along the unit vector `toward`. `isOn`: the point is
/// on the torus, and the ray leaves it there.
inline bool Blocks(
  const PlacedTorus& torus, const nurbs::Vec3& point, const nurbs::Vec3& toward, bool isOn)
{
  const nurbs::Vec3 p = torus.Place.inverse() * point;
  const nurbs::Vec3 d = torus.Place.linear().transpose() * toward;
  const double R = torus.Radius, r = torus.Tube;
  // Along the ray, (t^2 + b t + a)^2 - (c t^2 + e t + f) is negative inside the torus.
  const double a = p.squaredNorm() + R * R - r * r, b = 2.0 * p.dot(d);
  const double c = 4.0 * R * R * (d[0] * d[0] + d[1] * d[1]);
  const double e = 8.0 * R * R * (p[0] * d[0] + p[1] * d[1]);
  const double f = 4.0 * R * R * (p[0] * p[0] + p[1] * p[1]);
  if (isOn) // One root is 0; the rest is t^3 + 2 b t^2 + s t + (2 a b - e), positive at 0.
  {
    const double s = b * b + 2.0 * a - c, under = 4.0 * b * b - 3.0 * s;
    const double t = under > 0.0 ? (-2.0 * b + std::sqrt(under)) / 3.0 : 0.0;
    return t > 0.0 && ((t + 2.0 * b) * t + s) * t + 2.0 * a * b - e < 0.0;
  }
  for (const double t : CubicRoots(1.5 * b, 0.5 * (b * b + 2.0 * a - c), 0.25 * (2.0 * a * b - e)))
  {
    const double square = (t + b) * t + a;
    if (t > 0.0 && square * square - ((c * t + e) * t + f) < 0.0)
    {
      return true;
    }
  }
  return false;
}

/// The area of torus `which` of several that is visible from infinitely far along `toward`. On each of
/// `lines` circles around the tube, changes of visibility are found among 720 points and bisected; the
/// area between them is closed, and the sum over the circles a midpoint rule.
inline double VisibleTorusArea(
  const std::vector<PlacedTorus>& tori, std::size_t which, const nurbs::Vec3& direction, int lines)
{
  constexpr double Turn = 6.283185307179586;
  constexpr int Scan = 720;
  const nurbs::Vec3 toward = direction.normalized();
  const PlacedTorus& torus = tori[which];
  double sum = 0.0;
  for (int line = 0; line < lines; ++line)
  {
    const double ring = (line + 0.5) * Turn / lines;
    const auto visible = [&](double tube) {
      bool free = torus.Normal(ring, tube).dot(toward) > 0.0;
      const nurbs::Vec3 point = torus.Point(ring, tube);
      for (std::size_t k = 0; k < tori.size() && free; ++k)
      {
        free = !Blocks(tori[k], point, toward, k == which);
      }
      return free;
    };
    const auto upTo = [&](double tube) {
      return torus.Tube * (torus.Radius * tube + torus.Tube * std::sin(tube));
    };
    bool last = visible(0.0);
    for (int k = 1; k <= Scan; ++k)
    {
      double a = (k - 1) * Turn / Scan, b = k * Turn / Scan;
      const bool now = visible(b);
      const double from = a, to = b;
      while (now != last && b - a > 1e-14)
      {
        const double middle = 0.5 * (a + b);
        (visible(middle) == last ? a : b) = middle;
      }
      sum += now == last ? (now ? upTo(to) - upTo(from) : 0.0)
                         : (now ? upTo(to) - upTo(b) : upTo(a) - upTo(from));
      last = now;
    }
  }
  return sum * Turn / lines;
}

} // namespace reference

#endif
