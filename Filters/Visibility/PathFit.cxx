// SPDX-License-Identifier: BSD-3-Clause
#include "PathFit.h"

#include "CubicFit.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{
namespace
{

constexpr double Pi = 3.14159265358979323846;
// Lengths here are parts of the tolerance.
constexpr double SamePoint = 1e-6; // Neighbours as near as this are one point.
constexpr double WindowBow = 0.5;  // Chords that tell a corner bow by this at most...
constexpr double CornerBow = 2.0;  // ...and by this at least, were there no corner.
constexpr double TangentBow = 0.125;
constexpr double LineBow = 0.05; // A straight run bows by this at most...
constexpr double AnyBow = 16.0;
constexpr double LinePart =
  0.7; // ...and is this part at least of the chord that may bow by AnyBow.
constexpr double LeastLine = 4.0;
constexpr double ShortestBow = 1.0 / 16.0; // To where pieces are evened out,
constexpr int EveningRounds = 2;           // each round for the cost of a fit.

double AngleBetween(const Vec2& a, const Vec2& b)
{
  return std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
}

// The angle at the common point of two chords, as the bow of a curve through their ends whose
// tangent there divides the angle best: an arc over a chord c that leaves it at an angle t bows by
// c t / 4.
double LeastBow(const Vec2& before, const Vec2& after)
{
  const double a = before.norm(), b = after.norm();
  return a > 0.0 && b > 0.0 ? AngleBetween(before, after) * a * b / (4.0 * (a + b)) : 0.0;
}

// Points without neighbours that repeat. The first and the last one stay.
std::vector<Vec2> WithoutRepeats(const std::vector<Vec2>& polyline, double tolerance)
{
  std::vector<Vec2> points;
  points.reserve(polyline.size());
  for (const Vec2& p : polyline)
  {
    if (points.empty() || (p - points.back()).norm() > SamePoint * tolerance)
    {
      points.push_back(p);
    }
  }
  if (points.size() > 1)
  {
    points.back() = polyline.back();
  }
  return points;
}

// A part of a polyline between corners, or all of a closed one without corners.
class Section
{
public:
  Section(std::vector<Vec2> points, bool loop, double tolerance)
    : Points(std::move(points))
    , Loop(loop)
    , Tolerance(tolerance)
    , Last(std::ptrdiff_t(this->Points.size()) - 1)
  {}

  std::vector<PathPiece> Fit();

  // The farthest vertex from `from` on, forwards or backwards, to which a straight line keeps
  // within `bow` of all vertices between, by the sector of directions that they leave; the first
  // neighbour at least, or `from` where there is none. Indices of a loop go on past its ends.
  std::ptrdiff_t Reach(std::ptrdiff_t from, int step, double bow) const;

  Vec2 At(std::ptrdiff_t k) const
  {
    const std::ptrdiff_t n = this->Last;
    return this->Points[std::size_t(this->Loop ? ((k % n) + n) % n : k)];
  }

private:
  struct Run
  {
    std::size_t First, Last;
    bool Straight;
  };

  std::vector<Run> FindLines() const;
  std::vector<Run> FindRuns();
  Vec2 Tangent(std::size_t at) const;
  bool KeepsToChord(std::size_t first, std::size_t last, double tolerance) const;
  PathPiece Chord(std::size_t first, std::size_t last) const;
  std::vector<PathPiece> FitRun(const Run& run, const CubicEnds& ends) const;
  std::vector<PathPiece> FitRun(const Run& run, const CubicEnds& ends, double tolerance) const;
  std::pair<std::size_t, PathPiece> LongestPiece(
    std::size_t first, const Run& run, const CubicEnds& ends, double tolerance) const;

  std::vector<Vec2> Points;
  bool Loop;
  double Tolerance;
  std::ptrdiff_t Last;
};

std::ptrdiff_t Section::Reach(std::ptrdiff_t from, int step, double bow) const
{
  const std::ptrdiff_t end =
    this->Loop ? from + step * (this->Last - 1) : (step > 0 ? this->Last : 0);
  if (from == end)
  {
    return from;
  }
  const Vec2 origin = this->At(from);
  Vec2 axis = Vec2::Zero();
  double low = -Pi, high = Pi, farthest = 0.0;
  std::ptrdiff_t reached = from + step;
  for (std::ptrdiff_t k = from + step;; k += step)
  {
    const Vec2 to = this->At(k) - origin;
    const double length = to.norm();
    if (length < farthest - bow)
    {
      break; // The line turns back.
    }
    farthest = std::max(farthest, length);
    if (length > bow)
    {
      if (axis.isZero())
      {
        axis = to;
      }
      const double angle = std::atan2(axis.x() * to.y() - axis.y() * to.x(), axis.dot(to));
      if (angle < low || angle > high)
      {
        break;
      }
      const double half = std::asin(bow / length);
      low = std::max(low, angle - half);
      high = std::min(high, angle + half);
    }
    reached = k;
    if (k == end)
    {
      break;
    }
  }
  return reached;
}

bool Section::KeepsToChord(std::size_t first, std::size_t last, double tolerance) const
{
  for (std::size_t k = first + 1; k < last; ++k)
  {
    if (SegmentDistance(this->Points[k], this->Points[first], this->Points[last]) > tolerance)
    {
      return false;
    }
  }
  return true;
}

PathPiece Section::Chord(std::size_t first, std::size_t last) const
{
  const Vec2 &a = this->Points[first], &b = this->Points[last];
  return { { a, a + (b - a) / 3.0, b - (b - a) / 3.0, b }, true };
}

// Runs that are straight while what surrounds them is not: a curve's chords are a small part of the
// chord that bows by more, a straight run is most of it.
std::vector<Section::Run> Section::FindLines() const
{
  std::vector<Run> lines;
  for (std::ptrdiff_t i = 0; i < this->Last;)
  {
    const std::ptrdiff_t j = std::min(this->Reach(i, 1, LineBow * this->Tolerance), this->Last);
    const double length = (this->At(j) - this->At(i)).norm();
    const auto reach = [&](std::ptrdiff_t from, int step) {
      const std::ptrdiff_t to = this->Reach(from, step, AnyBow * this->Tolerance);
      return (this->At(to) - this->At(from)).norm();
    };
    if (length > LeastLine * this->Tolerance && length > LinePart * reach(i, 1) &&
      length > LinePart * reach(j, -1) &&
      this->KeepsToChord(std::size_t(i), std::size_t(j), this->Tolerance))
    {
      lines.push_back({ std::size_t(i), std::size_t(j), true });
      i = j;
    }
    else
    {
      ++i;
    }
  }
  return lines;
}

// Straight and curved runs by turns. A loop is turned so that it starts where a straight run ends.
std::vector<Section::Run> Section::FindRuns()
{
  const auto last = std::size_t(this->Last);
  if (!this->Loop && this->KeepsToChord(0, last, WindowBow * this->Tolerance))
  {
    return { { 0, last, true } };
  }
  std::vector<Run> lines = this->FindLines();
  if (this->Loop && !lines.empty() && lines.front().Last < last)
  {
    std::vector<Vec2>& points = this->Points;
    points.pop_back();
    std::rotate(points.begin(), points.begin() + std::ptrdiff_t(lines.front().Last), points.end());
    points.push_back(points.front());
    lines = this->FindLines();
  }
  std::vector<Run> runs;
  std::size_t at = 0;
  for (const Run& line : lines)
  {
    if (line.First > at)
    {
      runs.push_back({ at, line.First, false });
    }
    runs.push_back(line);
    at = line.Last;
  }
  if (at < last)
  {
    runs.push_back({ at, last, false });
  }
  return runs;
}

// The tangent at a vertex within smooth surroundings: that of the circle through it and one vertex
// to each side.
Vec2 Section::Tangent(std::size_t at) const
{
  const auto k = std::ptrdiff_t(at);
  const double bow = TangentBow * this->Tolerance;
  const Vec2 before = this->At(k) - this->At(this->Reach(k, -1, bow));
  const Vec2 after = this->At(this->Reach(k, 1, bow)) - this->At(k);
  const double a = before.squaredNorm(), b = after.squaredNorm();
  const Vec2 tangent = before * b + after * a;
  return !tangent.isZero() ? tangent.normalized() : (b > 0.0 ? after : before).normalized();
}

// The longest piece that starts at `first` and keeps within the tolerance, by doubling and
// bisection.
std::pair<std::size_t, PathPiece> Section::LongestPiece(
  std::size_t first, const Run& run, const CubicEnds& ends, double tolerance) const
{
  const auto fit = [&](std::size_t to) {
    CubicEnds own = ends;
    if (to != run.Last)
    {
      own.Set(1, this->Tangent(to));
    }
    return FitCubic(this->Points.data() + first, to - first + 1, own, tolerance);
  };
  if (auto whole = fit(run.Last))
  {
    return { run.Last, { *whole, false } };
  }
  std::size_t good = first, bad = run.Last;
  PathPiece best = this->Chord(first, first + 1);
  for (std::size_t step = 1; good + step < bad; step *= 2)
  {
    if (auto piece = fit(first + step))
    {
      good = first + step;
      best = { *piece, false };
    }
    else
    {
      bad = first + step;
    }
  }
  while (bad - good > 1 && bad > first + 1)
  {
    const std::size_t middle = good + (bad - good) / 2;
    if (auto piece = fit(middle))
    {
      good = middle;
      best = { *piece, false };
    }
    else
    {
      bad = middle;
    }
  }
  return { std::max(good, first + 1), best };
}

std::vector<PathPiece> Section::FitRun(
  const Run& run, const CubicEnds& ends, double tolerance) const
{
  std::vector<PathPiece> pieces;
  CubicEnds own = ends;
  for (std::size_t at = run.First; at < run.Last;)
  {
    const auto next = this->LongestPiece(at, run, own, tolerance);
    pieces.push_back(next.second);
    at = next.first;
    own.Set(0, this->Tangent(std::min(at, run.Last - 1)));
  }
  return pieces;
}

// As few pieces as the tolerance allows, then the smallest tolerance that takes no more: the pieces
// become alike, and better than they must be.
std::vector<PathPiece> Section::FitRun(const Run& run, const CubicEnds& ends) const
{
  std::vector<PathPiece> best = this->FitRun(run, ends, this->Tolerance);
  double low = ShortestBow, high = 1.0;
  for (int k = 0; k < EveningRounds && best.size() > 1; ++k)
  {
    const double middle = std::sqrt(low * high);
    std::vector<PathPiece> pieces = this->FitRun(run, ends, middle * this->Tolerance);
    if (pieces.size() <= best.size())
    {
      best = std::move(pieces);
      high = middle;
    }
    else
    {
      low = middle;
    }
  }
  return best;
}

std::vector<PathPiece> Section::Fit()
{
  std::vector<PathPiece> pieces;
  const std::vector<Run> runs = this->FindRuns();
  const auto direction = [this](const Run& line) {
    return Vec2((this->Points[line.Last] - this->Points[line.First]).normalized());
  };
  for (std::size_t r = 0; r < runs.size(); ++r)
  {
    const Run& run = runs[r];
    if (run.Straight)
    {
      pieces.push_back(this->Chord(run.First, run.Last));
      continue;
    }
    CubicEnds ends;
    const std::size_t before = r > 0 ? r - 1 : runs.size() - 1;
    const std::size_t after = r + 1 < runs.size() ? r + 1 : 0;
    if (r > 0 || this->Loop)
    {
      ends.Set(0, runs[before].Straight ? direction(runs[before]) : this->Tangent(run.First));
    }
    if (r + 1 < runs.size() || this->Loop)
    {
      ends.Set(1, runs[after].Straight ? direction(runs[after]) : this->Tangent(run.Last));
    }
    const std::vector<PathPiece> own = this->FitRun(run, ends);
    pieces.insert(pieces.end(), own.begin(), own.end());
  }
  return pieces;
}

// Corners of points without repeats; of a closed polyline also 0, the seam.
std::vector<std::size_t> CornersOf(const std::vector<Vec2>& points, bool closed, double tolerance)
{
  const Section all(points, closed, tolerance);
  std::vector<std::size_t> corners;
  double last = 0.0; // The bow at the last corner.
  const std::size_t first = closed ? 0 : 1;
  for (std::size_t k = first; k + 1 < points.size(); ++k)
  {
    const auto i = std::ptrdiff_t(k);
    const Vec2 before = points[k] - all.At(all.Reach(i, -1, WindowBow * tolerance));
    const Vec2 after = all.At(all.Reach(i, 1, WindowBow * tolerance)) - points[k];
    const double bow = LeastBow(before, after);
    if (bow <= CornerBow * tolerance)
    {
      continue;
    }
    // Of vertices that are closer than corners can be told apart, the sharpest.
    const bool near =
      !corners.empty() && (points[k] - points[corners.back()]).norm() < CornerBow * tolerance;
    if (near && bow <= last)
    {
      continue;
    }
    if (near)
    {
      corners.pop_back();
    }
    corners.push_back(k);
    last = bow;
  }
  return corners;
}

} // namespace

//--------------------------------------------------------------------------------------------------
bool IsCorner(const Vec2& before, const Vec2& after, double tolerance)
{
  return LeastBow(before, after) > CornerBow * tolerance;
}

//--------------------------------------------------------------------------------------------------
Vec2 ChordAtEnd(const std::vector<Vec2>& polyline, int end, double tolerance)
{
  const std::vector<Vec2> points = WithoutRepeats(polyline, tolerance);
  if (points.size() < 2)
  {
    return Vec2::Zero();
  }
  const auto last = std::ptrdiff_t(points.size()) - 1;
  const Section all(points, false, tolerance);
  return end == 0 ? Vec2(all.At(all.Reach(0, 1, WindowBow * tolerance)) - points.front())
                  : Vec2(points.back() - all.At(all.Reach(last, -1, WindowBow * tolerance)));
}

//--------------------------------------------------------------------------------------------------
std::vector<std::size_t> FindCorners(const std::vector<Vec2>& polyline, double tolerance)
{
  const std::vector<Vec2> points = WithoutRepeats(polyline, tolerance);
  std::vector<std::size_t> corners;
  if (points.size() < 3)
  {
    return corners;
  }
  std::size_t k = 0;
  for (const std::size_t corner : CornersOf(points, points.front() == points.back(), tolerance))
  {
    while (polyline[k] != points[corner])
    {
      ++k;
    }
    corners.push_back(k);
  }
  return corners;
}

//--------------------------------------------------------------------------------------------------
FittedPath FitPath(const std::vector<Vec2>& polyline, double tolerance)
{
  FittedPath path;
  std::vector<Vec2> points = WithoutRepeats(polyline, tolerance);
  if (points.size() < 2)
  {
    return path;
  }
  // What is left out by WithoutRepeats must not count.
  tolerance *= 1.0 - 2.0 * SamePoint;
  path.Closed = points.size() > 2 && points.front() == points.back();
  std::vector<std::size_t> corners = CornersOf(points, path.Closed, tolerance);
  if (path.Closed && corners.empty())
  {
    path.Pieces = Section(std::move(points), true, tolerance).Fit();
    return path;
  }
  if (path.Closed) // Starts at a corner.
  {
    const std::size_t start = corners.front();
    points.pop_back();
    std::rotate(points.begin(), points.begin() + std::ptrdiff_t(start), points.end());
    points.push_back(points.front());
    for (std::size_t& corner : corners)
    {
      corner -= start;
    }
    corners.erase(corners.begin());
  }
  corners.push_back(points.size() - 1);
  std::size_t first = 0;
  for (const std::size_t last : corners)
  {
    const auto begin = points.begin();
    Section section(
      { begin + std::ptrdiff_t(first), begin + std::ptrdiff_t(last) + 1 }, false, tolerance);
    const std::vector<PathPiece> pieces = section.Fit();
    path.Pieces.insert(path.Pieces.end(), pieces.begin(), pieces.end());
    first = last;
  }
  return path;
}

} // namespace nurbs
