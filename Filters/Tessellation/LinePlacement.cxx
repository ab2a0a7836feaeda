// SPDX-License-Identifier: BSD-3-Clause
#include "LinePlacement.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{
constexpr double EvenShare = 0.75; // Mean demand over greatest demand from which on lines fit all.
constexpr std::size_t FewSpans = 16;    // Fewer are sampled too thinly to tell.
constexpr std::size_t Interpolated = 9; // Fewer knots: samples are interpolated,
constexpr int Finer = 4;                // to so many times as many.
constexpr double FewCells = 4.0;        // No search for the best shares is worth while.
constexpr std::int64_t RowsAtOnce = 8;  // Of samples.
constexpr double NegligibleBow = 1e-6;  // In tolerances, across the whole surface.
constexpr double LeastRoom = 0.1;       // Of the tolerance, for the second direction.

int SamplesOfSpan(int degree, std::size_t spans)
{
  const int wish = degree == 1 ? 1 : (degree <= 3 ? 3 : degree);
  return spans > 24 ? std::min(wish, 2) : wish;
}

// Segments in an interval that wants `total`; the samples are not so exact that 2 % count.
int Segments(double total)
{
  return std::min(20000, std::max(1, int(std::ceil(total - 0.02))));
}
} // namespace

void LinePlacement::Samples::MakeCells()
{
  this->At.clear();
  this->Middle.clear();
  for (std::size_t k = 0; k + 1 < this->Knots.size(); ++k)
  {
    const double step = (this->Knots[k + 1] - this->Knots[k]) / this->PerSpan;
    for (int i = 0; i < this->PerSpan; ++i)
    {
      this->At.push_back(this->Knots[k] + step * i);
      this->Middle.push_back(this->Knots[k] + step * (i + 0.5));
    }
  }
  this->At.push_back(this->Knots.back());
  this->Wanted.assign(this->At.size() - 1, 0.0);
}

LinePlacement::LinePlacement(const SurfaceBound& bound, const ParameterBox& domain,
  double tolerance, const ParallelFor& parallel)
{
  const SurfaceView& surface = bound.View();
  const double low[2] = { domain.U0, domain.V0 };
  const double high[2] = { domain.U1, domain.V1 };
  for (int d = 0; d < 2; ++d)
  {
    Samples& s = this->Direction[d];
    const int degree = surface.Degree[d];
    s.Stops = bound.Creases(d);
    s.Stops.insert(s.Stops.begin(), low[d]);
    s.Stops.push_back(high[d]);
    // Spans of no width to speak of at the ends are noise of CAD kernels; they would make slivers.
    const double eps = NegligibleSpan * (high[d] - low[d]);
    s.Knots.push_back(low[d]);
    for (const Knot& knot : DistinctKnots(surface.Knots[d], degree))
    {
      if (knot.Value > low[d] + eps && knot.Value < high[d] - eps)
      {
        s.Knots.push_back(knot.Value);
      }
    }
    s.Knots.push_back(high[d]);
    s.PerSpan = SamplesOfSpan(degree, s.Knots.size() - 1);
    s.MakeCells();
    if (degree == 1 && s.At.size() == 2)
    {
      // A cone is widest at one end.
      s.Middle = { low[d] + 0.02 * (high[d] - low[d]), high[d] - 0.02 * (high[d] - low[d]) };
    }
  }
  this->Sample(bound, tolerance, parallel);
  this->Refine(0);
  this->Refine(1);
  for (int d = 0; d < 2; ++d)
  {
    this->Direction[d].Even = this->Direction[d].Knots.size() <= FewSpans || this->IsEven(d);
  }
  if (!this->FollowsDemand(0) || !this->FollowsDemand(1))
  {
    this->DropNearKnots(bound, tolerance);
  }
  // Which direction comes first, and what it may use of the tolerance: whatever makes fewest cells.
  double least = this->Share(0, 0.5);
  if (least <= FewCells || !this->AddUp() || !this->FollowsDemand(0) || !this->FollowsDemand(1))
  {
    return;
  }
  int best = 0;
  double bestShare = 0.5;
  for (int first = 0; first < 2; ++first)
  {
    for (int tenth = 3; tenth <= 7; ++tenth)
    {
      const double cells = this->Share(first, 0.1 * tenth);
      if (cells < least)
      {
        least = cells;
        best = first;
        bestShare = 0.1 * tenth;
      }
    }
  }
  this->Share(best, bestShare);
}

// Lines on two knots whose distance in space is beneath the tolerance would only make slivers.
void LinePlacement::DropNearKnots(const SurfaceBound& bound, double tolerance)
{
  constexpr int Steps = 4;
  SurfaceEvaluator evaluator(bound.Evaluator());
  double speed[2] = { 0.0, 0.0 };
  const auto at = [&](int d, int i) {
    const std::vector<double>& knots = this->Direction[d].Knots;
    return knots.front() + (knots.back() - knots.front()) * i / Steps;
  };
  for (int j = 0; j <= Steps; ++j)
  {
    for (int i = 0; i <= Steps; ++i)
    {
      const SurfaceDerivatives s = evaluator.Derivatives(at(0, i), at(1, j), 1);
      speed[0] = std::max(speed[0], s.Su.norm());
      speed[1] = std::max(speed[1], s.Sv.norm());
    }
  }
  for (int d = 0; d < 2; ++d)
  {
    Samples& s = this->Direction[d];
    s.Lines.assign(1, s.Knots.front());
    for (std::size_t k = 1; k + 1 < s.Knots.size(); ++k)
    {
      const double t = s.Knots[k];
      const bool apart = speed[d] * (t - s.Lines.back()) >= tolerance &&
        speed[d] * (s.Knots.back() - t) >= tolerance;
      if (apart || std::binary_search(s.Stops.begin(), s.Stops.end(), t))
      {
        s.Lines.push_back(t);
      }
    }
    s.Lines.push_back(s.Knots.back());
  }
}

void LinePlacement::Sample(const SurfaceBound& bound, double tolerance, const ParallelFor& parallel)
{
  const std::vector<double>& us = this->Direction[0].Middle;
  const std::vector<double>& vs = this->Direction[1].Middle;
  this->Bends[0].assign(us.size() * vs.size(), 0.0);
  this->Bends[1].assign(us.size() * vs.size(), 0.0);
  double negligible[2]; // Round-off of a direction that is straight.
  for (int dir = 0; dir < 2; ++dir)
  {
    const std::vector<double>& knots = this->Direction[dir].Knots;
    negligible[dir] = NegligibleBow / std::pow(knots.back() - knots.front(), 2);
  }
  parallel(0, std::int64_t(vs.size()), [&](std::int64_t begin, std::int64_t end) {
    SurfaceEvaluator evaluator(bound.Evaluator());
    std::vector<SurfaceDerivatives> at(us.size() * std::size_t(std::min(RowsAtOnce, end - begin)));
    for (std::int64_t j = begin; j < end; j += RowsAtOnce)
    {
      const std::size_t rows = std::size_t(std::min(RowsAtOnce, end - j));
      evaluator.DerivativesGrid(us, ArrayView<double>(&vs[j], rows), at.data());
      for (std::size_t k = 0; k < rows * us.size(); ++k)
      {
        const SurfaceDerivatives& d = at[k];
        const Vec3 n = d.Su.cross(d.Sv);
        const double length = n.norm();
        if (length > 1e-12 * d.Su.norm() * d.Sv.norm() && length > 0.0)
        {
          const double scale = 1.0 / (8.0 * tolerance * length);
          const double bends[2] = { scale * n.dot(d.Suu), scale * n.dot(d.Svv) };
          for (int dir = 0; dir < 2; ++dir)
          {
            this->Bends[dir][k + j * us.size()] =
              std::abs(bends[dir]) > negligible[dir] ? bends[dir] : 0.0;
          }
        }
      }
    }
  });
}

// Interpolates the samples inside each knot span, linearly, to a finer grid of cells.
void LinePlacement::Refine(int dir)
{
  Samples& s = this->Direction[dir];
  const int n = s.PerSpan;
  if (n == 1 || s.Knots.size() > Interpolated)
  {
    return;
  }
  const std::size_t before = s.Middle.size();
  s.PerSpan *= Finer;
  s.MakeCells();
  const std::size_t after = s.Middle.size();
  const std::size_t others = this->Direction[1 - dir].Middle.size();
  for (std::vector<double>& bends : this->Bends)
  {
    const std::vector<double> old = std::move(bends);
    bends.resize(after * others);
    for (std::size_t k = 0; k < after; ++k)
    {
      const std::size_t span = k / s.PerSpan;
      const double at = (double(k % s.PerSpan) + 0.5) / Finer - 0.5;
      const int low = std::min(n - 2, std::max(0, int(std::floor(at))));
      const double t = at - low;
      for (std::size_t j = 0; j < others; ++j)
      {
        const auto index = [&](std::size_t own, std::size_t count) {
          return dir == 0 ? own + j * count : j + own * others;
        };
        const std::size_t from = span * n + low;
        bends[index(k, after)] =
          (1.0 - t) * old[index(from, before)] + t * old[index(from + 1, before)];
      }
    }
  }
}

// The bend of direction `dir` at sample `own` of that direction and `other` of the other one.
double LinePlacement::Bend(int dir, std::size_t own, std::size_t other) const
{
  const std::size_t i = dir == 0 ? own : other;
  const std::size_t j = dir == 0 ? other : own;
  return this->Bends[dir][i + j * this->Direction[0].Middle.size()];
}

// True if the demand is much the same across the surface, so that lines all over it suit it; where
// it is not, halving spans where needed makes fewer cells.
bool LinePlacement::IsEven(int dir) const
{
  const Samples& s = this->Direction[dir];
  const std::size_t others = this->Direction[1 - dir].Middle.size();
  double most = 0.0;
  double mean = 0.0;
  for (std::size_t i = 0; i < s.Middle.size(); ++i)
  {
    double greatest = 0.0;
    double sum = 0.0;
    for (std::size_t j = 0; j < others; ++j)
    {
      const double wanted = std::sqrt(std::abs(this->Bend(dir, i, j)));
      greatest = std::max(greatest, wanted);
      sum += wanted;
    }
    most += greatest * s.Length(s.CellOf(i));
    mean += sum / double(others) * s.Length(s.CellOf(i));
  }
  return mean >= EvenShare * most;
}

// True if the directions bend to the same side anywhere, so that one must leave room to the other.
bool LinePlacement::AddUp() const
{
  for (std::size_t k = 0; k < this->Bends[0].size(); ++k)
  {
    if (this->Bends[0][k] * this->Bends[1][k] > 0.0)
    {
      return true;
    }
  }
  return false;
}

// Segments between all stops; `spacing` receives their length in each cell.
double LinePlacement::CountSegments(const Samples& s, std::vector<double>* spacing) const
{
  double count = 0.0;
  std::size_t cell = 0;
  for (std::size_t k = 0; k + 1 < s.Stops.size(); ++k)
  {
    double total = 0.0;
    std::size_t end = cell;
    for (; end < s.Wanted.size() && s.At[end] < s.Stops[k + 1]; ++end)
    {
      total += s.Wanted[end] * s.Length(end);
    }
    const int n = Segments(total);
    count += n;
    for (; cell < end && spacing; ++cell)
    {
      const double whole = s.Stops[k + 1] - s.Stops[k];
      (*spacing)[cell] =
        std::min(whole, s.Wanted[cell] > 0.0 ? total / (n * s.Wanted[cell]) : whole);
    }
    cell = end;
  }
  return count;
}

// Fills Wanted: the first direction may use `share` of the tolerance, the second one what the first
// leaves where they add up. Where they bend to opposite sides each may use all. Returns the number
// of cells.
double LinePlacement::Share(int first, double share)
{
  Samples& a = this->Direction[first];
  Samples& b = this->Direction[1 - first];
  std::fill(a.Wanted.begin(), a.Wanted.end(), 0.0);
  std::fill(b.Wanted.begin(), b.Wanted.end(), 0.0);
  const auto adds = [&](std::size_t i, std::size_t j) {
    return this->Bend(first, i, j) * this->Bend(1 - first, j, i) > 0.0;
  };
  for (std::size_t i = 0; i < a.Middle.size(); ++i)
  {
    double& wanted = a.Wanted[a.CellOf(i)];
    double most = 0.0;
    for (std::size_t j = 0; j < b.Middle.size(); ++j)
    {
      const double part = adds(i, j) ? share : 1.0;
      most = std::max(most, std::abs(this->Bend(first, i, j)) / part);
    }
    wanted = std::max(wanted, std::sqrt(most));
  }
  std::vector<double> spacing(a.Wanted.size());
  const double segments = this->CountSegments(a, &spacing);
  for (std::size_t j = 0; j < b.Middle.size(); ++j)
  {
    double& wanted = b.Wanted[b.CellOf(j)];
    double most = 0.0;
    for (std::size_t i = 0; i < a.Middle.size(); ++i)
    {
      const double used = std::abs(this->Bend(first, i, j)) * std::pow(spacing[a.CellOf(i)], 2);
      const double room = adds(i, j) ? std::max(LeastRoom, 1.0 - used) : 1.0;
      most = std::max(most, std::abs(this->Bend(1 - first, j, i)) / room);
    }
    wanted = std::max(wanted, std::sqrt(most));
  }
  return segments * this->CountSegments(b, nullptr);
}

// Every stop (or knot) is a line, and between two of them the quantiles of the demand.
void LinePlacement::Place(double margin, ParameterLines& u, ParameterLines& v) const
{
  ParameterLines* const out[2] = { &u, &v };
  for (int d = 0; d < 2; ++d)
  {
    const Samples& s = this->Direction[d];
    const std::vector<double>& stops = s.Even ? s.Stops : s.Lines;
    std::vector<double>& lines = out[d]->At;
    std::vector<double>& demand = out[d]->Demand;
    lines.assign(1, stops.front());
    demand.assign(1, 0.0);
    std::size_t cell = 0;
    for (std::size_t k = 0; k + 1 < stops.size(); ++k)
    {
      double total = 0.0;
      std::size_t end = cell;
      for (; end < s.Wanted.size() && s.At[end] < stops[k + 1]; ++end)
      {
        total += s.Wanted[end] * s.Length(end);
      }
      const double start = demand.back();
      const int n = s.Even ? Segments(margin * total) : 1;
      double done = 0.0;
      for (int m = 1; m < n; ++m)
      {
        const double target = total * m / n;
        while (cell + 1 < end && done + s.Wanted[cell] * s.Length(cell) < target)
        {
          done += s.Wanted[cell] * s.Length(cell);
          ++cell;
        }
        const double t = std::min(s.At[cell + 1], s.At[cell] + (target - done) / s.Wanted[cell]);
        if (t > lines.back())
        {
          lines.push_back(t);
          demand.push_back(start + target);
        }
      }
      lines.push_back(stops[k + 1]);
      demand.push_back(start + total);
      cell = end;
    }
  }
}

} // namespace nurbs
