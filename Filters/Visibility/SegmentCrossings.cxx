// SPDX-License-Identifier: BSD-3-Clause
#include "SegmentCrossings.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace nurbs
{

namespace
{

__extension__ using Wide = __int128;

// A line that is not vertical, with the events (ranks of distinct abscissae) that it starts and
// ends at.
struct SweepLine
{
  std::int32_t X0, Y0, X1, Y1;
  std::int32_t First, Last;
  double Slope;

  std::int64_t Width() const { return std::int64_t(this->X1) - this->X0; }
  std::int64_t Height() const { return std::int64_t(this->Y1) - this->Y0; }
};

// Over 0 if (x, y) is above a line, below 0 if it is below.
std::int64_t Side(const SweepLine& line, std::int64_t x, std::int64_t y)
{
  return line.Width() * (y - line.Y0) - line.Height() * (x - line.X0);
}

std::int64_t CompareSlopes(const SweepLine& a, const SweepLine& b)
{
  return a.Height() * b.Width() - b.Height() * a.Width();
}

// The sign of the height of a over b at x.
int CompareAt(const SweepLine& a, const SweepLine& b, std::int64_t x)
{
  // Ordinates are below 2^30 and come from three roundings: right within 2^-21.
  constexpr double Sure = 1.0 / (1 << 19);
  const double difference =
    (a.Y0 + a.Slope * double(x - a.X0)) - (b.Y0 + b.Slope * double(x - b.X0));
  if (std::abs(difference) > Sure)
  {
    return difference > 0.0 ? 1 : -1;
  }
  const Wide exact = Wide((std::int64_t(a.Y0) - b.Y0) * a.Width()) * b.Width() +
    Wide(a.Height() * (x - a.X0)) * b.Width() - Wide(b.Height() * (x - b.X0)) * a.Width();
  return exact > 0 ? 1 : (exact < 0 ? -1 : 0);
}

// If a is below b just to the left of x.
bool IsBelowBefore(const SweepLine& a, const SweepLine& b, std::int64_t x)
{
  const int order = CompareAt(a, b, x);
  return order != 0 ? order < 0 : CompareSlopes(a, b) > 0;
}

// floor(length * part / whole + 1/2) for part / whole in [0, 1].
std::int64_t RoundedShare(std::int64_t length, std::int64_t part, std::int64_t whole)
{
  constexpr double Sure = 1.0 / (1 << 18);
  const double about = double(length) * (double(part) / double(whole)) + 0.5;
  const double floor = std::floor(about);
  if (about - floor > Sure && about - floor < 1.0 - Sure)
  {
    return std::int64_t(floor);
  }
  Wide top = 2 * Wide(length) * part + whole;
  Wide bottom = 2 * Wide(whole);
  if (bottom < 0)
  {
    top = -top;
    bottom = -bottom;
  }
  const Wide quotient = top / bottom;
  return std::int64_t(top % bottom < 0 ? quotient - 1 : quotient);
}

// Grid points in no order, each a few times at most, kept small while many equal ones come in.
class PointBag
{
public:
  void Add(const GridPoint& p)
  {
    this->Points.push_back(p);
    if (this->Points.size() >= this->Limit)
    {
      this->Tidy();
      this->Limit = std::max(this->Limit, 2 * this->Points.size());
    }
  }
  void Tidy()
  {
    std::sort(this->Points.begin(), this->Points.end());
    this->Points.erase(std::unique(this->Points.begin(), this->Points.end()), this->Points.end());
  }
  std::vector<GridPoint> Points;

private:
  std::size_t Limit = std::size_t(1) << 22;
};

// Lines sorted by their start, and verticals, by events. Event e has the lines
// [StartOf[e], StartOf[e + 1]) and the verticals [VerticalOf[e], VerticalOf[e + 1]).
struct SweepInput
{
  std::vector<std::int64_t> X; // of the events, increasing
  std::vector<SweepLine> Lines;
  std::vector<GridLine> Verticals;
  std::vector<std::int32_t> StartOf;
  std::vector<std::int32_t> VerticalOf;

  explicit SweepInput(const std::vector<GridLine>& lines);
  int Last() const { return int(this->X.size()) - 1; }
  std::int32_t Event(std::int64_t x) const
  {
    return std::int32_t(std::lower_bound(this->X.begin(), this->X.end(), x) - this->X.begin());
  }
};

SweepInput::SweepInput(const std::vector<GridLine>& lines)
{
  for (const GridLine& line : lines)
  {
    this->X.push_back(line.Start.X);
    this->X.push_back(line.End.X);
  }
  std::sort(this->X.begin(), this->X.end());
  this->X.erase(std::unique(this->X.begin(), this->X.end()), this->X.end());
  this->StartOf.assign(this->X.size() + 1, 0);
  this->VerticalOf.assign(this->X.size() + 1, 0);
  for (const GridLine& l : lines)
  {
    const std::int32_t first = this->Event(l.Start.X);
    if (l.Start.X == l.End.X)
    {
      this->Verticals.push_back(l);
      ++this->VerticalOf[first + 1];
      continue;
    }
    this->Lines.push_back({ std::int32_t(l.Start.X), std::int32_t(l.Start.Y), std::int32_t(l.End.X),
      std::int32_t(l.End.Y), first, this->Event(l.End.X),
      double(l.End.Y - l.Start.Y) / double(l.End.X - l.Start.X) });
    ++this->StartOf[first + 1];
  }
  // Lines that start in one point as they leave it, from below.
  std::sort(this->Lines.begin(), this->Lines.end(), [](const SweepLine& a, const SweepLine& b) {
    return a.First != b.First ? a.First < b.First
                              : (a.Y0 != b.Y0 ? a.Y0 < b.Y0 : CompareSlopes(a, b) < 0);
  });
  std::sort(this->Verticals.begin(), this->Verticals.end(),
    [](const GridLine& a, const GridLine& b) { return a.Start < b.Start; });
  for (std::size_t e = 0; e < this->X.size(); ++e)
  {
    this->StartOf[e + 1] += this->StartOf[e];
    this->VerticalOf[e + 1] += this->VerticalOf[e];
  }
}

// Balaban's search in the strip between two events. Lines that touch at the strip's left end only,
// or whose order just to the left of it is not the one in the strip, count as crossing there; each
// candidate is tested exactly, so that it does no harm to find one in vain or twice.
class StripSearch
{
public:
  StripSearch(const SweepInput& input, std::function<bool()> goOn)
    : Input(input)
    , GoOn(std::move(goOn))
  {}

  // `passing`: the lines that start before and end after event `begin`, in any order.
  void Run(int begin, int end, std::vector<std::int32_t> passing)
  {
    this->List = std::move(passing);
    const std::int64_t x = this->Input.X[begin];
    std::sort(this->List.begin(), this->List.end(), [this, x](std::int32_t a, std::int32_t b) {
      return IsBelowBefore(this->Line(a), this->Line(b), x);
    });
    this->PassEvent(begin);
    this->Search(begin, end);
    this->Found.Tidy();
  }

  PointBag Found;

private:
  const SweepLine& Line(std::int32_t line) const { return this->Input.Lines[line]; }

  // TreeSearch: List holds the lines that meet the strip's left end, in their order there, and on
  // return those that meet its right end, in the order just to the left of that.
  void Search(int begin, int end)
  {
    if (this->Stopped)
    {
      return;
    }
    if (end - begin == 1)
    {
      this->SearchLeaf(begin);
      return;
    }
    const std::size_t base = this->Stairs.size();
    this->Split(end, base);
    if (this->Stairs.size() > base)
    {
      this->MeetStarts(begin, end, base);
      this->MeetVerticals(begin, end, this->Stairs.data() + base, this->Stairs.size() - base);
    }
    const int middle = begin + (end - begin) / 2;
    this->Search(begin, middle);
    this->PassEvent(middle);
    this->Search(middle, end);
    if (this->Stairs.size() > base)
    {
      const std::int64_t x = this->Input.X[end];
      this->Scratch.resize(this->List.size() + this->Stairs.size() - base);
      std::merge(this->List.begin(), this->List.end(), this->Stairs.begin() + base,
        this->Stairs.end(), this->Scratch.begin(), [this, x](std::int32_t a, std::int32_t b) {
          return IsBelowBefore(this->Line(a), this->Line(b), x);
        });
      this->List.swap(this->Scratch);
      this->Stairs.resize(base);
    }
  }

  // Split: moves a staircase, lines that span the strip without crossing each other, from List to
  // Stairs and finds the crossings of it with the rest.
  void Split(int end, std::size_t base)
  {
    const std::int64_t x = this->Input.X[end];
    this->Places.clear();
    std::size_t kept = 0;
    for (const std::int32_t line : this->List)
    {
      if (this->Line(line).Last >= end &&
        (this->Stairs.size() == base ||
          CompareAt(this->Line(this->Stairs.back()), this->Line(line), x) <= 0))
      {
        this->Stairs.push_back(line);
        continue;
      }
      this->List[kept++] = line;
      this->Places.push_back(this->Stairs.size() - base);
    }
    this->List.resize(kept);
    for (std::size_t i = 0; i<kept&& this->Stairs.size()> base; ++i)
    {
      this->Walk(this->List[i], this->Places[i], end, base);
    }
  }

  // The lines that start within the strip against the staircase.
  void MeetStarts(int begin, int end, std::size_t base)
  {
    for (std::int32_t s = this->Input.StartOf[begin + 1]; s < this->Input.StartOf[end]; ++s)
    {
      const SweepLine& line = this->Line(s);
      const std::size_t place =
        this->CountBelow(this->Stairs.data() + base, this->Stairs.size() - base, line.X0, line.Y0);
      this->Walk(s, place, end, base);
    }
  }

  // How many of `count` lines, from below, have the point on or above them.
  std::size_t CountBelow(
    const std::int32_t* lines, std::size_t count, std::int64_t x, std::int64_t y) const
  {
    return std::partition_point(lines, lines + count,
             [&](std::int32_t line) { return Side(this->Line(line), x, y) >= 0; }) -
      lines;
  }

  // From its place in the staircase, the steps that a line crosses until it ends or leaves the
  // strip.
  void Walk(std::int32_t line, std::size_t place, int end, std::size_t base)
  {
    const std::size_t count = this->Stairs.size() - base;
    std::size_t up = place;
    while (up<count&& this->SideAtEnd(line, this->Stairs[base + up], end)> 0)
    {
      this->Check(line, this->Stairs[base + up++]);
    }
    std::size_t down = up == place ? place : 0;
    while (down > 0 && this->SideAtEnd(line, this->Stairs[base + down - 1], end) < 0)
    {
      this->Check(line, this->Stairs[base + --down]);
    }
  }

  int SideAtEnd(std::int32_t line, std::int32_t step, int end) const
  {
    const SweepLine& a = this->Line(line);
    const SweepLine& b = this->Line(step);
    if (a.Last > end)
    {
      return CompareAt(a, b, this->Input.X[end]);
    }
    const std::int64_t side = Side(b, a.X1, a.Y1);
    return side > 0 ? 1 : (side < 0 ? -1 : 0);
  }

  // Lines that have an order at the verticals' place, from below, and that go on to its right.
  void MeetVerticals(int begin, int end, const std::int32_t* lines, std::size_t count)
  {
    for (int v = this->Input.VerticalOf[begin]; v < this->Input.VerticalOf[end]; ++v)
    {
      const GridLine& vertical = this->Input.Verticals[v];
      const GridPoint& top = vertical.End;
      std::size_t i = this->CountBelow(lines, count, vertical.Start.X, vertical.Start.Y);
      for (; i < count && Side(this->Line(lines[i]), top.X, top.Y) > 0; ++i)
      {
        this->Check(lines[i], vertical);
      }
    }
  }

  // All lines of List span a leaf: what is out of order at its right end crosses.
  void SearchLeaf(int begin)
  {
    this->MeetVerticals(begin, begin + 1, this->List.data(), this->List.size());
    const std::int64_t x = this->Input.X[begin + 1];
    for (std::size_t i = 1; i < this->List.size() && !this->Stopped; ++i)
    {
      const std::int32_t line = this->List[i];
      std::size_t to = i;
      for (; to > 0 && CompareAt(this->Line(this->List[to - 1]), this->Line(line), x) > 0; --to)
      {
        this->Check(line, this->List[to - 1]);
        this->List[to] = this->List[to - 1];
      }
      this->List[to] = line;
    }
    this->CountWork();
  }

  // Takes the lines that end at an event out of List, those that start there in.
  void PassEvent(int event)
  {
    this->List.erase(std::remove_if(this->List.begin(), this->List.end(),
                       [&](std::int32_t line) { return this->Line(line).Last == event; }),
      this->List.end());
    std::int32_t start = this->Input.StartOf[event];
    const std::int32_t last = this->Input.StartOf[event + 1];
    if (start == last)
    {
      return;
    }
    this->Scratch.clear();
    std::size_t at = 0;
    for (; start < last; ++start)
    {
      const SweepLine& line = this->Line(start);
      const std::size_t to =
        at + this->CountBelow(this->List.data() + at, this->List.size() - at, line.X0, line.Y0);
      this->Scratch.insert(this->Scratch.end(), this->List.begin() + at, this->List.begin() + to);
      this->Scratch.push_back(start);
      at = to;
    }
    this->Scratch.insert(this->Scratch.end(), this->List.begin() + at, this->List.end());
    this->List.swap(this->Scratch);
  }

  void Check(std::int32_t a, std::int32_t b)
  {
    const SweepLine& line = this->Line(b);
    this->Check(a, GridLine{ { line.X0, line.Y0 }, { line.X1, line.Y1 } });
  }

  void Check(std::int32_t first, const GridLine& b)
  {
    this->CountWork();
    const SweepLine& line = this->Line(first);
    const GridLine a{ { line.X0, line.Y0 }, { line.X1, line.Y1 } };
    const std::int64_t fromA = Turn(b.Start, b.End, a.Start);
    const std::int64_t toA = Turn(b.Start, b.End, a.End);
    const std::int64_t fromB = Turn(a.Start, a.End, b.Start);
    const std::int64_t toB = Turn(a.Start, a.End, b.End);
    const auto apart = [](std::int64_t s, std::int64_t t) {
      return (s < 0 && t > 0) || (s > 0 && t < 0);
    };
    if (!apart(fromA, toA) || !apart(fromB, toB))
    {
      return;
    }
    // The crossing is a.Start + (a.End - a.Start) fromA / (fromA - toA), as `fromA` and `toA` are
    // distances to b. The difference is a cross product of two directions, so below 2^61 as well.
    this->Found.Add({ a.Start.X + RoundedShare(a.End.X - a.Start.X, fromA, fromA - toA),
      a.Start.Y + RoundedShare(a.End.Y - a.Start.Y, fromA, fromA - toA) });
  }

  void CountWork()
  {
    if (++this->Work % 65536 == 0 && !this->GoOn())
    {
      this->Stopped = true;
    }
  }

  const SweepInput& Input;
  std::function<bool()> GoOn;
  std::vector<std::int32_t> List;
  std::vector<std::int32_t> Stairs; // of the strip and those around it
  std::vector<std::int32_t> Scratch;
  std::vector<std::size_t> Places;
  std::int64_t Work = 0;
  bool Stopped = false;
};

struct Slab
{
  int Begin, End; // events
  std::vector<std::int32_t> Passing;
};

// Strips to be searched at a time. There are fewer if many lines would be in several of them.
std::vector<Slab> MakeSlabs(const SweepInput& input)
{
  constexpr int Most = 32;
  for (int count = std::min(Most, input.Last());; count /= 2)
  {
    std::vector<Slab> slabs;
    std::vector<int> slabOf(input.X.size());
    for (int s = 0; s < count; ++s)
    {
      slabs.push_back({ int(std::int64_t(input.Last()) * s / count),
        int(std::int64_t(input.Last()) * (s + 1) / count), {} });
      std::fill(slabOf.begin() + slabs[s].Begin, slabOf.begin() + slabs[s].End + 1, s);
    }
    std::size_t passing = 0;
    for (std::size_t i = 0; i < input.Lines.size() && passing <= input.Lines.size(); ++i)
    {
      // An event between two slabs counts as the right one's.
      for (int s = slabOf[input.Lines[i].First] + 1;
           s < count && slabs[s].Begin < input.Lines[i].Last; ++s)
      {
        slabs[s].Passing.push_back(std::int32_t(i));
        ++passing;
      }
    }
    if (count == 1 || passing <= input.Lines.size())
    {
      return slabs;
    }
  }
}

} // namespace

std::vector<GridPoint> CrossingPixels(const std::vector<GridLine>& lines,
  const ParallelFor& parallel, const std::function<bool(double)>& goOn)
{
  const SweepInput input(lines);
  if (input.Last() < 1)
  {
    return {};
  }
  std::vector<Slab> slabs = MakeSlabs(input);
  std::vector<std::vector<GridPoint>> found(slabs.size());
  std::atomic<int> done{ 0 };
  parallel(0, std::int64_t(slabs.size()), [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t s = begin; s < end; ++s)
    {
      const auto share = [&] { return double(done) / double(slabs.size()); };
      if (!goOn(share()))
      {
        return;
      }
      StripSearch search(input, [&] { return goOn(share()); });
      search.Run(slabs[s].Begin, slabs[s].End, std::move(slabs[s].Passing));
      found[s].swap(search.Found.Points);
      ++done;
    }
  });
  PointBag all;
  for (const std::vector<GridPoint>& points : found)
  {
    all.Points.insert(all.Points.end(), points.begin(), points.end());
  }
  all.Tidy();
  return all.Points;
}

} // namespace nurbs
