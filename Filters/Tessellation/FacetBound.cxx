// SPDX-License-Identifier: BSD-3-Clause
#include "FacetBound.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

double SurfaceDistance(double height, double sliding, double slope)
{
  const double apart = std::sqrt(height * height + sliding * sliding);
  return slope < 0.5 ? std::min(apart, height + sliding * slope) : apart;
}

FacetBound::FacetBound(
  const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec2& uv0, const Vec2& uv1, const Vec2& uv2)
  : X{ x0, x1, x2 }
{
  const Vec2 uv[3] = { uv0, uv1, uv2 };
  this->N = (x1 - x0).cross(x2 - x0);
  const double area = this->N.norm();
  double longest = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    const int j = (i + 1) % 3;
    this->Du[i] = std::abs(uv[j][0] - uv[i][0]);
    this->Dv[i] = std::abs(uv[j][1] - uv[i][1]);
    this->A = std::max(this->A, this->Du[i]);
    this->B = std::max(this->B, this->Dv[i]);
    longest = std::max(longest, (this->X[j] - this->X[i]).squaredNorm());
  }
  this->Plane = area > 1e-10 * longest;
  if (this->Plane)
  {
    this->N /= area;
    for (int i = 0; i < 3; ++i)
    {
      const Vec3 edge = this->X[(i + 1) % 3] - this->X[i];
      const double length = edge.norm();
      this->Out[i] = edge.cross(this->N) / length;
      this->Altitude[i] = area / length;
    }
  }
}

void FacetBound::SetPole(int k)
{
  const int before = (k + 2) % 3;
  const int base = (k + 1) % 3;
  const bool along = this->Dv[base] <= 1e-9 * this->B;  // The base runs along u.
  const bool across = this->Du[base] <= 1e-9 * this->A; // Or along v.
  if (along)
  {
    this->Du[before] = this->Du[k] = 0.0;
  }
  else if (across)
  {
    this->Dv[before] = this->Dv[k] = 0.0;
  }
  this->Mixed = !along && !across;
}

void FacetBound::SetFourthCorner(const Vec3& x, double weight)
{
  // On the half without the fourth corner the bilinear interpolant of f is at most a quarter of its
  // value there.
  this->Mixed = false;
  this->Twist = this->Plane ? 0.25 * weight * std::abs(this->N.dot(x - this->X[0])) : 0.0;
}

namespace
{
constexpr double Narrow = 1.0 / 64.0; // Boxes narrower than this share of a triangle add up.

double Effective(double extent, double width)
{
  return width < Narrow * extent ? 2.0 * std::sqrt(extent * width) : extent;
}
} // namespace

void FacetBound::Add(const CurvatureRange& range, const ParameterBox& box)
{
  const double w = box.A();
  const double h = box.B();
  const bool sum = w < Narrow * this->A || h < Narrow * this->B;
  const auto merge = [sum](double& target, double value) {
    target = sum ? target + value : std::max(target, value);
  };
  const double a = Effective(this->A, w);
  const double b = Effective(this->B, h);
  merge(this->Full, DeviationBound(range, a, b));
  if (!this->Plane)
  {
    this->Weight = 1.0;
    return;
  }
  this->Weight = std::min(this->Weight, range.MinWeight);
  merge(this->HeightOver, BoundDeviation(range, a, b, this->N, this->X[0], this->Mixed).Largest());
}

void FacetBound::AddEdges(const CurvatureRange& range, const ParameterBox& box)
{
  if (!this->Plane)
  {
    return;
  }
  const double w = box.A();
  const double h = box.B();
  const bool sum = w < Narrow * this->A || h < Narrow * this->B;
  const auto merge = [sum](double& target, double value) {
    target = sum ? target + value : std::max(target, value);
  };
  const double a = Effective(this->A, w);
  const double b = Effective(this->B, h);
  for (int i = 0; i < 3; ++i)
  {
    merge(this->Along[i],
      BoundDeviation(
        range, Effective(this->Du[i], w), Effective(this->Dv[i], h), this->N, this->X[i])
        .Largest());
    merge(this->Across[i], BoundDeviation(range, a, b, this->Out[i], this->X[i]).Largest());
    for (int j = 0; j < 3; ++j)
    {
      const double d = BoundDeviation(
        range, Effective(this->Du[j], w), Effective(this->Dv[j], h), this->Out[i], this->X[i])
                         .Above;
      merge(i == j ? this->Bow[i] : this->Pull[i], d);
    }
  }
}

int FacetBound::LongestEdge() const
{
  return int(std::min_element(this->Altitude, this->Altitude + 3) - this->Altitude);
}

double FacetBound::SegmentDeviation() const
{
  if (!this->Plane)
  {
    return this->Full;
  }
  const int longest = int(std::min_element(this->Altitude, this->Altitude + 3) - this->Altitude);
  // Across the edge the third corner is an altitude away from zero: 2 altitudes cover its share in
  // the rational case, where the weights differ by less than a factor of two in a cell.
  const double across = this->Across[longest] / this->Weight + 2.0 * this->Altitude[longest];
  return std::hypot(this->Height(), across);
}

double FacetBound::Sliding() const
{
  if (!this->Plane)
  {
    return this->Full;
  }
  double first = 0.0;
  double second = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    // Inside the triangle the other two edges pull a point out by at most 4 Pull per unit of its
    // relative height over edge i; if the altitude outweighs that, only the edge's own bow counts.
    if (4.0 * this->Pull[i] > this->Altitude[i] * this->Weight)
    {
      return this->Full;
    }
    const double bow = this->Bow[i] / this->Weight;
    second = std::max(second, std::min(first, bow));
    first = std::max(first, bow);
  }
  return std::min(this->Full, first + second);
}

} // namespace nurbs
