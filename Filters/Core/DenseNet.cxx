// SPDX-License-Identifier: BSD-3-Clause
#include "DenseNet.h"

#include "ModelArrays.h"
#include "ModelChecks.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nurbs
{
namespace
{

/// Pieces of a span in which the speed of the net is measured.
constexpr int ProbePieces = 4;
/// Relative excess that is rounding.
constexpr double Rounding = 1e-9;
/// Narrower strips at the border of a cut, as a part of it, would be spans too thin to be of use.
constexpr double ThinPart = 1e-3;
/// Halvings of the spacing's scale until the net fits a cap, to 1e-6 of it.
constexpr int ScaleSteps = 40;

/// Of every line i - (i + 1) of the net along `dir`, the longest edge.
std::vector<double> EdgeLengths(const SurfaceView& s, int dir)
{
  const std::int64_t step = dir == 0 ? 1 : s.Count[0];
  const std::int64_t stepAcross = dir == 0 ? s.Count[0] : 1;
  std::vector<double> longest(s.Count[dir] - 1, 0.0);
  for (std::int64_t j = 0; j < s.Count[1 - dir]; ++j)
  {
    for (std::int64_t i = 0; i + 1 < s.Count[dir]; ++i)
    {
      const std::int64_t k = i * step + j * stepAcross;
      longest[i] = std::max(longest[i], (s.Point(k + step) - s.Point(k)).norm());
    }
  }
  return longest;
}

/// Width of the knots that edge i depends on; 0: a break.
double SupportOf(const SurfaceView& s, int dir, std::size_t i)
{
  return s.Knots[dir][i + s.Degree[dir] + 1] - s.Knots[dir][i + 1];
}

std::vector<double> Breaks(const SurfaceView& s, int dir)
{
  std::vector<double> breaks;
  for (const Knot& knot : DistinctKnots(s.Knots[dir], s.Degree[dir]))
  {
    breaks.push_back(knot.Value);
  }
  return breaks;
}

/// The narrowest interval at t that is worth having.
double LeastInterval(const SurfaceView& s, int dir, double t)
{
  const double size = std::max(s.Domain(dir).Length(), std::abs(t));
  return 64.0 * std::numeric_limits<double>::epsilon() * size;
}

/// The knots that cut span k into pieces[k] even ones.
std::vector<double> EvenKnots(const std::vector<double>& breaks, const std::vector<double>& pieces)
{
  std::vector<double> knots;
  for (std::size_t k = 0; k + 1 < breaks.size(); ++k)
  {
    for (double i = 1.0; i < pieces[k]; ++i)
    {
      knots.push_back(breaks[k] + (breaks[k + 1] - breaks[k]) * (i / pieces[k]));
    }
  }
  return knots;
}

/// Lengths of net edges per parameter, the largest of every span. An edge is as long as the mean of
/// the `degree` knot intervals that it depends on, times the derivative there.
class SpanSpeeds
{
public:
  SpanSpeeds(const SurfaceView& s, int dir)
    : Places(Breaks(s, dir))
    , Speeds(Places.size() - 1, 0.0)
    , Most(Places.size() - 1, 1.0)
  {
    std::vector<double> probed(this->Speeds.size(), 1.0);
    for (std::size_t k = 0; k < this->Speeds.size(); ++k)
    {
      const double length = this->Places[k + 1] - this->Places[k];
      this->Most[k] =
        std::max(1.0, std::floor(length / LeastInterval(s, dir, this->Places[k + 1])));
      probed[k] = std::min<double>(this->Most[k], ProbePieces);
    }
    const Surface probe = RefineKnots(s, dir, EvenKnots(this->Places, probed));
    this->Measure(probe.View(), dir);
  }

  /// Pieces a span, so that edges are no longer than `spacing`; at most about `limit` each.
  std::vector<double> Pieces(double spacing, double limit) const
  {
    std::vector<double> pieces(this->Speeds.size());
    for (std::size_t k = 0; k < pieces.size(); ++k)
    {
      const double length = this->Places[k + 1] - this->Places[k];
      const double wanted = std::ceil(length * this->Speeds[k] / spacing - Rounding);
      pieces[k] = std::clamp(wanted, 1.0, std::min(this->Most[k], std::max(1.0, limit)));
    }
    return pieces;
  }

  const std::vector<double>& At() const { return this->Places; }

private:
  void Measure(const SurfaceView& probe, int dir)
  {
    const int p = probe.Degree[dir];
    const std::vector<double> lengths = EdgeLengths(probe, dir);
    for (std::size_t i = 0; i < lengths.size(); ++i)
    {
      const double support = SupportOf(probe, dir, i);
      if (!(support > 0.0))
      {
        continue;
      }
      const auto first =
        std::upper_bound(this->Places.begin(), this->Places.end() - 1, probe.Knots[dir][i + 1]);
      for (std::size_t k = std::max<std::ptrdiff_t>(0, first - this->Places.begin() - 1);
           k < this->Speeds.size() && this->Places[k] < probe.Knots[dir][i + p + 1]; ++k)
      {
        this->Speeds[k] = std::max(this->Speeds[k], p * lengths[i] / support);
      }
    }
  }

  std::vector<double> Places;
  std::vector<double> Speeds, Most;
};

double Added(const std::vector<double>& pieces)
{
  double added = 0.0;
  for (const double n : pieces)
  {
    added += n - 1.0;
  }
  return added;
}

/// Inserts even knots in both directions; with a wider spacing if there would be too many points.
void InsertEvenKnots(Surface& surface, const NetDensity& wanted, bool& capped)
{
  const SpanSpeeds speeds[2] = { { surface.View(), 0 }, { surface.View(), 1 } };
  const double limit = double(wanted.MaximumPoints);
  std::vector<double> pieces[2];
  const auto fits = [&](double spacing) {
    double size = 1.0;
    for (int dir = 0; dir < 2; ++dir)
    {
      pieces[dir] = speeds[dir].Pieces(spacing, limit);
      size *= surface.Count[dir] + Added(pieces[dir]);
    }
    return size <= limit;
  };
  if (!fits(wanted.Spacing))
  {
    capped = true;
    double low = 0.0, high = 1.0; // exponents of 2
    while (high < 1000.0 && !fits(wanted.Spacing * std::exp2(high)))
    {
      low = high;
      high *= 2.0;
    }
    for (int i = 0; i < ScaleSteps; ++i)
    {
      const double middle = 0.5 * (low + high);
      (fits(wanted.Spacing * std::exp2(middle)) ? high : low) = middle;
    }
    if (!fits(wanted.Spacing * std::exp2(high)))
    {
      return;
    }
  }
  for (int dir = 0; dir < 2; ++dir)
  {
    const std::vector<double> add = EvenKnots(speeds[dir].At(), pieces[dir]);
    surface = add.empty() ? std::move(surface) : RefineKnots(surface.View(), dir, add);
  }
}

/// Knots in the middle of the widest interval of every edge that is too long.
std::vector<double> Halvings(const SurfaceView& s, int dir, double spacing)
{
  const KnotView& knots = s.Knots[dir];
  const std::vector<double> lengths = EdgeLengths(s, dir);
  std::vector<double> add;
  for (std::size_t i = 0; i < lengths.size(); ++i)
  {
    if (!(lengths[i] > spacing * (1.0 + Rounding)))
    {
      continue;
    }
    std::size_t widest = i + 1;
    for (std::size_t k = i + 1; k <= i + s.Degree[dir]; ++k)
    {
      widest = knots[k + 1] - knots[k] > knots[widest + 1] - knots[widest] ? k : widest;
    }
    const double width = knots[widest + 1] - knots[widest];
    const double middle = knots[widest] + 0.5 * width;
    if (width > 2.0 * LeastInterval(s, dir, middle))
    {
      add.push_back(middle);
    }
  }
  std::sort(add.begin(), add.end());
  add.erase(std::unique(add.begin(), add.end()), add.end());
  return add;
}

/// Shortens the edges that even knots left too long: where speeds differ within a span, and those
/// of lines that rational refinement brought in.
void InsertMissingKnots(Surface& surface, const NetDensity& wanted, bool& capped)
{
  for (;;)
  {
    const std::vector<double> add[2] = { Halvings(surface.View(), 0, wanted.Spacing),
      Halvings(surface.View(), 1, wanted.Spacing) };
    if (add[0].empty() && add[1].empty())
    {
      return;
    }
    const double size =
      double(surface.Count[0] + add[0].size()) * double(surface.Count[1] + add[1].size());
    if (size > double(wanted.MaximumPoints))
    {
      capped = true;
      return;
    }
    for (int dir = 0; dir < 2; ++dir)
    {
      surface = add[dir].empty() ? std::move(surface) : RefineKnots(surface.View(), dir, add[dir]);
    }
  }
}

/// [low, high] of the domain, extended so that neither a strip left away nor a span at the ends is
/// very thin.
Interval CutFor(const SurfaceView& s, int dir, double low, double high)
{
  const Interval domain = s.Domain(dir);
  const double thin = ThinPart * (high - low);
  Interval cut{ low, high };
  for (const double t : Breaks(s, dir))
  {
    cut.Min = t > low && t - low < thin ? std::min(cut.Min, t - thin) : cut.Min;
    cut.Max = t < high && high - t < thin ? std::max(cut.Max, t + thin) : cut.Max;
  }
  cut.Min = cut.Min - domain.Min < thin ? domain.Min : cut.Min;
  cut.Max = domain.Max - cut.Max < thin ? domain.Max : cut.Max;
  return cut;
}

/// The surface cut to its trims. False: there is nothing to cut off, or the loops would suffer.
bool CutToTrims(const Model& model, const Face& face, Surface& surface)
{
  const Box2 box = LoopsBox(model, face);
  if (face.LoopCount == 0 || box.isEmpty() || !(box.sizes().minCoeff() > 0.0))
  {
    return false;
  }
  Interval cut[2];
  bool whole = true;
  for (int dir = 0; dir < 2; ++dir)
  {
    cut[dir] = CutFor(face.Geometry, dir, box.min()[dir], box.max()[dir]);
    const Interval domain = face.Geometry.Domain(dir);
    whole = whole && cut[dir].Min == domain.Min && cut[dir].Max == domain.Max;
    if (!(cut[dir].Length() > LeastInterval(face.Geometry, dir, cut[dir].Max)))
    {
      return false;
    }
  }
  if (whole)
  {
    return false;
  }
  surface = Restrict(face.Geometry, cut[0], cut[1]);
  Face part = face;
  part.Geometry = surface.View();
  const double gap = AssembleOptions().GapLimit;
  std::vector<std::string> before, after;
  const bool valid = CheckLoops(model, part, gap, after).empty();
  return valid &&
    (after.empty() ||
      (CheckLoops(model, face, gap, before).empty() && after.size() <= before.size()));
}

/// The whole surface, clamped.
Surface Clamped(const SurfaceView& s)
{
  const bool clamped = IsClamped(s.Knots[0], s.Degree[0]) && IsClamped(s.Knots[1], s.Degree[1]);
  return clamped ? Copy(s) : Restrict(s, s.Domain(0), s.Domain(1));
}

bool HasKnotsOf(const Surface& a, const SurfaceView& b)
{
  const auto same = [&](int dir) {
    return std::equal(
      a.Knots[dir].begin(), a.Knots[dir].end(), b.Knots[dir].begin(), b.Knots[dir].end());
  };
  return same(0) && same(1);
}

/// Raises the degrees, unless there would be too many points; then false.
bool RaiseDegree(Surface& surface, const NetDensity& wanted)
{
  double size = 1.0;
  int times[2];
  for (int dir = 0; dir < 2; ++dir)
  {
    times[dir] = std::max(0, wanted.MinimumDegree - surface.Degree[dir]);
    const auto spans = double(Breaks(surface.View(), dir).size()) - 1.0;
    size *= surface.Count[dir] + times[dir] * spans;
  }
  if (size > double(wanted.MaximumPoints))
  {
    return false;
  }
  for (int dir = 0; dir < 2; ++dir)
  {
    surface = times[dir] == 0 ? std::move(surface) : ElevateDegree(surface.View(), dir, times[dir]);
  }
  return true;
}

bool IsMet(const SurfaceView& s, const NetDensity& wanted)
{
  return std::min(s.Degree[0], s.Degree[1]) >= wanted.MinimumDegree &&
    std::max(LongestNetEdge(s, 0), LongestNetEdge(s, 1)) <= wanted.Spacing * (1.0 + Rounding);
}

} // namespace

double LongestNetEdge(const SurfaceView& surface, int dir)
{
  const std::vector<double> lengths = EdgeLengths(surface, dir);
  double longest = 0.0;
  for (std::size_t i = 0; i < lengths.size(); ++i)
  {
    longest = SupportOf(surface, dir, i) > 0.0 ? std::max(longest, lengths[i]) : longest;
  }
  return longest;
}

DenseNet MakeDense(const Model& model, const Face& face, const NetDensity& wanted)
{
  if (wanted.MinimumDegree < 1 || wanted.MinimumDegree > MaxDegree)
  {
    throw Error("the degree to have, " + std::to_string(wanted.MinimumDegree) + ", is not 1 to " +
      std::to_string(MaxDegree));
  }
  if (!(wanted.Spacing > 0.0))
  {
    throw Error("the spacing of control points must be positive");
  }
  DenseNet net;
  if (IsMet(face.Geometry, wanted))
  {
    return net;
  }
  Surface surface;
  if (!wanted.ClampToTrims || !CutToTrims(model, face, surface))
  {
    surface = Clamped(face.Geometry);
  }
  if (!RaiseDegree(surface, wanted))
  {
    net.Capped = true;
    return net;
  }
  InsertEvenKnots(surface, wanted, net.Capped);
  if (!net.Capped)
  {
    InsertMissingKnots(surface, wanted, net.Capped);
  }
  net.Changed = !HasKnotsOf(surface, face.Geometry);
  if (net.Changed)
  {
    net.Geometry = std::move(surface);
  }
  return net;
}

} // namespace nurbs
