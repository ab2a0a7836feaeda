// SPDX-License-Identifier: BSD-3-Clause
#include "KnotVector.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{
namespace
{

/// Second derivatives divide by a step twice, and must not overflow.
constexpr double SmallestKnotStep = 1e-100;

} // namespace

std::string CheckKnots(KnotView knots, int degree, std::int64_t count)
{
  if (degree < 0 || degree > MaxDegree)
  {
    return "degree " + std::to_string(degree) + " is not between 0 and " +
      std::to_string(MaxDegree);
  }
  if (count < degree + 1)
  {
    return std::to_string(count) + " control points are too few for degree " +
      std::to_string(degree);
  }
  const std::int64_t size = static_cast<std::int64_t>(knots.size());
  if (size != count + degree + 1)
  {
    return std::to_string(size) + " knots instead of " + std::to_string(count + degree + 1);
  }
  int multiplicity = 1;
  for (std::int64_t i = 0; i < size; ++i)
  {
    if (!std::isfinite(knots[i]))
    {
      return "knot " + std::to_string(i) + " is not a finite number";
    }
    if (i == 0)
    {
      continue;
    }
    if (knots[i] < knots[i - 1])
    {
      return "knot " + std::to_string(i) + " is smaller than the one before it";
    }
    const double step = knots[i] - knots[i - 1];
    if (step > 0.0 && step < SmallestKnotStep)
    {
      return "knot " + std::to_string(i) +
        " differs too little from the one before it to divide by";
    }
    multiplicity = step == 0.0 ? multiplicity + 1 : 1;
    if (multiplicity > degree + 1)
    {
      return "knot " + std::to_string(i) + " occurs more than degree + 1 times";
    }
  }
  const Interval domain = Domain(knots, degree);
  if (!(domain.Min < domain.Max))
  {
    return "the parameter domain is empty";
  }
  if (!std::isfinite(knots.back() - knots.front()))
  {
    return "the range of the knots overflows";
  }
  return "";
}

Interval Domain(KnotView knots, int degree)
{
  return { knots[degree], knots[knots.size() - degree - 1] };
}

int FindSpan(KnotView knots, int degree, double t)
{
  const double* first = knots.begin() + degree;
  const double* last = knots.end() - degree - 1; // the domain's end
  if (last - first == 1)
  {
    return degree; // There is one span only, as in the planes and lines of CAD models.
  }
  const double* above = std::upper_bound(first, last, t);
  if (above == first) // before the domain, or NaN
  {
    above = std::upper_bound(first, last, *first);
  }
  else if (above == last) // in the last span, at the domain's end or after it
  {
    above = std::lower_bound(first, last, *last);
  }
  return static_cast<int>(above - knots.begin()) - 1;
}

int FindSpan(KnotView knots, int degree, double t, int hint)
{
  const int last = static_cast<int>(knots.size()) - degree - 2;
  for (int k = std::max(hint, degree); k <= std::min(hint + 1, last); ++k)
  {
    if (knots[k] <= t && t < knots[k + 1])
    {
      return k;
    }
  }
  return FindSpan(knots, degree, t);
}

std::vector<Knot> DistinctKnots(KnotView knots, int degree)
{
  const Interval domain = Domain(knots, degree);
  std::vector<Knot> distinct;
  for (double t : knots)
  {
    if (t < domain.Min || t > domain.Max)
    {
      continue;
    }
    if (!distinct.empty() && distinct.back().Value == t)
    {
      ++distinct.back().Multiplicity;
    }
    else
    {
      distinct.push_back({ t, 1 });
    }
  }
  return distinct;
}

std::vector<double> CreaseKnots(KnotView knots, int degree)
{
  const Interval domain = Domain(knots, degree);
  std::vector<double> creases;
  for (const Knot& knot : DistinctKnots(knots, degree))
  {
    if (knot.Multiplicity >= degree && knot.Value > domain.Min && knot.Value < domain.Max)
    {
      creases.push_back(knot.Value);
    }
  }
  return creases;
}

std::vector<double> GrevilleAbscissae(KnotView knots, int degree)
{
  const int count = static_cast<int>(knots.size()) - degree - 1;
  std::vector<double> abscissae(count);
  for (int i = 0; i < count; ++i)
  {
    if (degree == 0)
    {
      abscissae[i] = 0.5 * (knots[i] + knots[i + 1]);
      continue;
    }
    // Offsets from the first knot: the mean of equal knots is that knot, without round-off.
    double sum = 0.0;
    for (int j = 2; j <= degree; ++j)
    {
      sum += knots[i + j] - knots[i + 1];
    }
    abscissae[i] = std::min(knots[i + 1] + sum / degree, knots[i + degree]);
  }
  return abscissae;
}

bool IsClamped(KnotView knots, int degree)
{
  const std::size_t last = knots.size() - 1;
  return knots[0] == knots[degree] && knots[last - degree] == knots[last];
}

std::vector<double> UniformKnots(int degree, int count)
{
  if (degree < 0 || count < degree + 1)
  {
    throw Error("UniformKnots: " + std::to_string(count) + " points are too few for degree " +
      std::to_string(degree));
  }
  const int spans = count - degree;
  std::vector<double> knots(count + degree + 1);
  for (int i = 0; i < static_cast<int>(knots.size()); ++i)
  {
    knots[i] = static_cast<double>(std::clamp(i - degree, 0, spans)) / spans;
  }
  return knots;
}

} // namespace nurbs
