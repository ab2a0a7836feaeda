// SPDX-License-Identifier: BSD-3-Clause
#include "TrimLoops.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nurbs
{

namespace
{

constexpr std::size_t MaxTops = 12; // searched by LargestValue

/// Whole periods that bring `p` nearest to `target`.
Vec2 PeriodsTo(const Vec2& target, const Vec2& p, const Vec2& period)
{
  Vec2 shift = Vec2::Zero();
  for (int dir = 0; dir < 2; ++dir)
  {
    if (period[dir] > 0.0)
    {
      shift[dir] = std::round((target[dir] - p[dir]) / period[dir]) * period[dir];
    }
  }
  return shift;
}

class Orderer
{
public:
  Orderer(const std::vector<TrimEnds>& ends, const Vec2& period)
    : Ends(ends)
    , Period(period)
    , Used(ends.size(), false)
  {
    Box2 box;
    for (const TrimEnds& e : ends)
    {
      box.extend(e.Start);
      box.extend(e.End);
    }
    this->Near = ends.empty() ? 0.0 : 1e-6 * box.diagonal().norm();
  }

  std::vector<OrderedLoop> Run()
  {
    std::vector<OrderedLoop> loops;
    for (std::size_t first = 0; first < this->Ends.size(); ++first)
    {
      if (!this->Used[first])
      {
        loops.push_back(this->Follow(first));
      }
    }
    return loops;
  }

private:
  OrderedLoop Follow(std::size_t first)
  {
    OrderedLoop loop;
    const std::size_t none = this->Ends.size();
    this->Shift = Vec2::Zero();
    for (std::size_t current = first; current != none;)
    {
      this->Used[current] = true;
      loop.Items.push_back({ current, this->Shift });
      const Vec2 end = this->Ends[current].End + this->Shift;
      const bool closed =
        this->Meets(current, first) && (end - this->Ends[first].Start).norm() <= this->Near;
      const std::size_t next = this->Next(current, end, closed);
      if (next != none && this->Gap(end, next) > this->Near)
      {
        this->Shift = PeriodsTo(end, this->Ends[next].Start, this->Period);
      }
      current = next;
    }
    return loop;
  }

  bool Meets(std::size_t a, std::size_t b) const
  {
    return this->Ends[a].EndVertex >= 0 && this->Ends[a].EndVertex == this->Ends[b].StartVertex;
  }

  /// Distance to a curve's start that is where the loop has come to by now.
  double Gap(const Vec2& end, std::size_t next) const
  {
    return (end - this->Ends[next].Start - this->Shift).norm();
  }

  /// Gap, or the distance with the best whole periods if that is smaller. Periods come last: on a
  /// torus all ends are the same but for periods.
  double Distance(const Vec2& end, std::size_t next) const
  {
    const double gap = this->Gap(end, next);
    const Vec2& start = this->Ends[next].Start;
    const double wrapped = (end - start - PeriodsTo(end, start, this->Period)).norm();
    return gap <= this->Near ? gap : std::min(gap, wrapped + this->Near);
  }

  /// The curve after `current`; none (the number of curves) if the loop ends here.
  std::size_t Next(std::size_t current, const Vec2& end, bool closed)
  {
    const std::size_t none = this->Ends.size();
    for (const std::size_t neighbour : { current + 1, current - 1 })
    {
      if (neighbour < none && !this->Used[neighbour] && this->Meets(current, neighbour) &&
        this->Gap(end, neighbour) <= this->Near)
      {
        return neighbour;
      }
    }
    std::size_t best = none;
    std::size_t bestMeeting = none;
    double distance = std::numeric_limits<double>::max();
    double distanceMeeting = distance;
    for (std::size_t i = 0; i < none; ++i)
    {
      if (this->Used[i])
      {
        continue;
      }
      const double d = this->Distance(end, i);
      if (d < distance)
      {
        distance = d;
        best = i;
      }
      if (d < distanceMeeting && this->Meets(current, i))
      {
        distanceMeeting = d;
        bestMeeting = i;
      }
    }
    // A closed loop goes on only into a curve that meets it as closely as the loop meets itself.
    if (closed)
    {
      return bestMeeting != none && distanceMeeting <= this->Near ? bestMeeting : none;
    }
    return bestMeeting != none ? bestMeeting : best;
  }

  const std::vector<TrimEnds>& Ends;
  const Vec2 Period;
  double Near = 0.0; ///< Ends this close in (u, v) are one.
  std::vector<bool> Used;
  Vec2 Shift = Vec2::Zero(); ///< Whole periods that the loop has run through.
};

} // namespace

std::vector<OrderedLoop> OrderLoops(const std::vector<TrimEnds>& ends, const Vec2& period)
{
  return Orderer(ends, period).Run();
}

std::vector<Vec2> GatherLoops(const std::vector<LoopBox>& boxes, const Vec2& period)
{
  std::vector<Vec2> shifts(boxes.size(), Vec2::Zero());
  if (boxes.size() < 2 || period == Vec2::Zero())
  {
    return shifts;
  }
  std::size_t largest = 0;
  for (std::size_t i = 1; i < boxes.size(); ++i)
  {
    if (boxes[i].diagonal().norm() > boxes[largest].diagonal().norm())
    {
      largest = i;
    }
  }
  for (std::size_t i = 0; i < boxes.size(); ++i)
  {
    for (int dir = 0; dir < 2; ++dir)
    {
      const double low = boxes[largest].min()[dir];
      const double high = boxes[largest].max()[dir];
      const double middle = boxes[i].center()[dir];
      if (period[dir] > 0.0 && (middle < low || middle > high))
      {
        shifts[i][dir] = -std::floor((middle - low) / period[dir]) * period[dir];
      }
    }
  }
  return shifts;
}

void AppendCrossings(const std::function<double(double)>& function,
  const std::vector<double>& breaks, double offset, double span, std::vector<double>& crossings)
{
  constexpr int Steps = 8;
  constexpr double MaxCrossings = 1e4; // between two samples
  auto place = [&](double x) { return (function(x) - offset) / span; };
  double x0 = breaks.front();
  double f0 = place(x0);
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
  {
    for (int step = 1; step <= Steps; ++step)
    {
      const double x1 = breaks[i] + (breaks[i + 1] - breaks[i]) * step / Steps;
      const double f1 = place(x1);
      const double low = std::min(f0, f1);
      const double high = std::max(f0, f1);
      if (!(high - low < MaxCrossings))
      {
        throw Error("a trim curve winds too often around the surface, or is not a number");
      }
      for (double k = std::ceil(low); k <= high && high - low > 1e-12; k += 1.0)
      {
        double a = x0;
        double b = x1;
        const bool rising = f1 > f0;
        for (int halving = 0; halving < 60 && a < b; ++halving)
        {
          const double m = 0.5 * (a + b);
          ((place(m) < k) == rising ? a : b) = m;
        }
        crossings.push_back(0.5 * (a + b));
      }
      x0 = x1;
      f0 = f1;
    }
  }
}

std::vector<double> SampleParameters(const CurveView<2>& trim, const CurveView<3>& edge)
{
  std::vector<double> knots;
  for (const Knot& knot : DistinctKnots(trim.Knots, trim.Degree))
  {
    knots.push_back(knot.Value);
  }
  for (const Knot& knot : DistinctKnots(edge.Knots, edge.Degree))
  {
    knots.push_back(knot.Value);
  }
  std::sort(knots.begin(), knots.end());
  const Interval domain = trim.Domain();
  // Even, so that the middle of a span, where a curve may touch the domain's border, is among them.
  const int spans = static_cast<int>(std::max<std::size_t>(knots.size() / 2, 1));
  const int inSpan = std::max(2 * std::max(trim.Degree, edge.Degree) + 4, 32 / spans);
  std::vector<double> samples{ domain.Min };
  for (std::size_t i = 0; i + 1 < knots.size(); ++i)
  {
    const double a = domain.Clamp(knots[i]);
    const double b = domain.Clamp(knots[i + 1]);
    for (int k = 1; k <= inSpan && b > a; ++k)
    {
      samples.push_back(a + (b - a) * k / inSpan);
    }
  }
  return samples;
}

double LargestValue(const std::function<double(double)>& function,
  const std::vector<double>& samples, double negligible)
{
  std::vector<double> values;
  for (const double t : samples)
  {
    values.push_back(function(t));
  }
  double largest = *std::max_element(values.begin(), values.end());
  if (largest <= negligible)
  {
    return largest;
  }
  std::vector<std::size_t> tops;
  for (std::size_t i = 0; i < samples.size(); ++i)
  {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, samples.size() - 1);
    if (values[i] >= 0.6 * largest && values[i] >= values[before] && values[i] >= values[after])
    {
      tops.push_back(i);
    }
  }
  std::sort(
    tops.begin(), tops.end(), [&](std::size_t i, std::size_t k) { return values[i] > values[k]; });
  tops.resize(std::min(tops.size(), MaxTops));
  for (const std::size_t i : tops)
  {
    double a = samples[i == 0 ? 0 : i - 1];
    double b = samples[std::min(i + 1, samples.size() - 1)];
    for (int step = 0; step < 10; ++step)
    {
      const double p = a + 0.382 * (b - a);
      const double q = a + 0.618 * (b - a);
      const double fp = function(p);
      const double fq = function(q);
      largest = std::max(largest, std::max(fp, fq));
      (fp < fq ? a : b) = fp < fq ? p : q;
    }
  }
  return largest;
}

} // namespace nurbs
