// SPDX-License-Identifier: BSD-3-Clause
#include "TrimCurves.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nurbs
{

namespace
{

constexpr int MaxPoints = MaxPieceDegree + 1;
constexpr int MaxDepth = 30;         // halvings of one piece
constexpr int MaxSegments = 200000;  // of one curve
constexpr int MaxRounds = 16;        // of balancing
constexpr double FirstShare = 8.0;   // tolerance of the partition that balancing starts from
constexpr double Even = 0.995;       // mean over largest demand of chords that are spread well
constexpr double ClosedShare = 1e-9; // of the curve's size: its ends coincide
constexpr double Infinite = std::numeric_limits<double>::infinity();

using Pieces = std::vector<BezierCurve<3>>;

struct Node
{
  double T;
  Vec3 X;
  double Error; // bound of the chord that ends here
};

// The chord that control points are measured against, and the curve's parameters at its ends.
struct Chord
{
  Chord(const Vec3& a, const Vec3& b, double t0, double t1, CurveMeasure measure)
    : Start(a)
    , Span(b - a)
    , T0(t0)
    , PerT(t1 > t0 ? 1.0 / (t1 - t0) : 0.0)
    , PerLength2(this->Span.squaredNorm())
    , Measure(measure)
  {
    this->PerLength2 = this->PerLength2 > 0.0 ? 1.0 / this->PerLength2 : 0.0;
  }

  // Squared distance from the segment (Line), or from its point that belongs to t (Point). Both are
  // sound: every curve point is a convex combination of control points, and the same combination of
  // chord points is on the chord.
  double Distance2(const Vec4& h, double t) const
  {
    const Vec3 d = h.head<3>() * (1.0 / h[3]) - this->Start;
    const double lambda = this->Measure == CurveMeasure::Line ? d.dot(this->Span) * this->PerLength2
                                                              : (t - this->T0) * this->PerT;
    return (d - std::min(1.0, std::max(0.0, lambda)) * this->Span).squaredNorm();
  }

  Vec3 Start;
  Vec3 Span;
  double T0;
  double PerT;
  double PerLength2;
  CurveMeasure Measure;
};

// The largest distance of the control points of both halves of a piece over [t0, t1] from a chord
// (section 5.1; the halving makes the bound tight).
double HalvesDistance(
  const Vec4* left, const Vec4* right, int n, double t0, double t1, const Chord& chord)
{
  double largest = 0.0;
  for (int i = 0; i <= 2 * n; ++i)
  {
    const double s = 0.5 * i / n;
    const Vec4& h = i <= n ? left[i] : right[i - n];
    largest = std::max(largest, chord.Distance2(h, t0 + s * (t1 - t0)));
  }
  return std::sqrt(largest);
}

double PieceDistance(const Vec4* points, int n, double t0, double t1, const Chord& chord)
{
  if (n <= 1)
  {
    return std::sqrt(std::max(chord.Distance2(points[0], t0), chord.Distance2(points[n], t1)));
  }
  Vec4 left[MaxPoints];
  Vec4 right[MaxPoints];
  SplitBezier<4>(points, n, 0.5, left, right);
  return HalvesDistance(left, right, n, t0, t1, chord);
}

// The part [s0, s1] of a piece, 0 <= s0 < s1 <= 1.
void RestrictPiece(const BezierCurve<3>& piece, double s0, double s1, Vec4* out)
{
  const int n = piece.Degree();
  std::copy(piece.Points.begin(), piece.Points.end(), out);
  if (s1 < 1.0)
  {
    for (int r = 1; r <= n; ++r)
    {
      for (int i = n; i >= r; --i)
      {
        out[i] = (1.0 - s1) * out[i - 1] + s1 * out[i];
      }
    }
  }
  const double q = s1 > 0.0 ? s0 / s1 : 0.0;
  if (q > 0.0)
  {
    for (int r = 1; r <= n; ++r)
    {
      for (int i = 0; i <= n - r; ++i)
      {
        out[i] = (1.0 - q) * out[i] + q * out[i + 1];
      }
    }
  }
}

Vec3 Project(const Vec4& h)
{
  return h.head<3>() / h[3];
}

Vec3 StartPoint(const BezierCurve<3>& piece)
{
  return Project(piece.Points.front());
}

Vec3 EndPoint(const BezierCurve<3>& piece)
{
  return Project(piece.Points.back());
}

// A stretch of pieces without a corner between them: [First, Last).
class Stretch
{
public:
  Stretch(const Pieces& pieces, std::size_t first, std::size_t last, const CurveOptions& options)
    : All(pieces)
    , First(first)
    , Last(last)
    , Options(options)
  {}

  Node StartNode() const
  {
    return { this->All[this->First].T0, StartPoint(this->All[First]), 0.0 };
  }
  Node EndNode() const
  {
    return { this->All[this->Last - 1].T1, EndPoint(this->All[this->Last - 1]), 0.0 };
  }

  // Subdivision as in section 5.1: `nodes` receives the end of every chord after the start node.
  void Subdivide(double tolerance, std::vector<Node>& nodes) const
  {
    for (std::size_t k = this->First; k < this->Last; ++k)
    {
      const BezierCurve<3>& piece = this->All[k];
      this->SubdividePiece(
        piece.Points.data(), piece.Degree(), piece.T0, piece.T1, tolerance, 0, nodes);
    }
  }

  // The nodes' points and chord errors for given parameters, ascending, from the start node on.
  // Returns the largest error; stops early once it exceeds `limit`.
  double Measure(std::vector<Node>& nodes, double limit) const
  {
    std::size_t k = this->First;
    double largest = 0.0;
    for (std::size_t i = 1; i < nodes.size(); ++i)
    {
      std::size_t end = k;
      if (i + 1 < nodes.size())
      {
        end = this->Find(nodes[i].T, k);
        nodes[i].X = this->All[end].Evaluate(this->Relative(end, nodes[i].T));
      }
      else
      {
        end = this->Last - 1;
      }
      nodes[i].Error = this->ChordError(nodes[i - 1], nodes[i], k, end, limit);
      largest = std::max(largest, nodes[i].Error);
      if (largest > limit)
      {
        return largest;
      }
      k = end;
    }
    return largest;
  }

private:
  std::size_t Find(double t, std::size_t k) const
  {
    while (k + 1 < this->Last && t > this->All[k].T1)
    {
      ++k;
    }
    return k;
  }

  double Relative(std::size_t k, double t) const
  {
    const BezierCurve<3>& piece = this->All[k];
    const double s = (t - piece.T0) / (piece.T1 - piece.T0);
    return std::min(1.0, std::max(0.0, s));
  }

  double ChordError(
    const Node& a, const Node& b, std::size_t first, std::size_t last, double limit) const
  {
    const Chord chord(a.X, b.X, a.T, b.T, this->Options.Measure);
    double largest = 0.0;
    Vec4 part[MaxPoints];
    for (std::size_t k = first; k <= last && largest <= limit; ++k)
    {
      const BezierCurve<3>& piece = this->All[k];
      const double s0 = k == first ? this->Relative(k, a.T) : 0.0;
      const double s1 = k == last ? this->Relative(k, b.T) : 1.0;
      if (s0 >= s1)
      {
        continue;
      }
      const bool whole = s0 == 0.0 && s1 == 1.0;
      if (!whole)
      {
        RestrictPiece(piece, s0, s1, part);
      }
      const double length = piece.T1 - piece.T0;
      largest = std::max(largest,
        PieceDistance(whole ? piece.Points.data() : part, piece.Degree(), piece.T0 + s0 * length,
          piece.T0 + s1 * length, chord));
    }
    return largest;
  }

  void SubdividePiece(const Vec4* points, int n, double t0, double t1, double tolerance, int depth,
    std::vector<Node>& nodes) const
  {
    const Vec3 end = Project(points[n]);
    if (n <= 1)
    {
      Append(nodes, { t1, end, 0.0 });
      return;
    }
    Vec4 left[MaxPoints];
    Vec4 right[MaxPoints];
    SplitBezier<4>(points, n, 0.5, left, right);
    const Chord chord(Project(points[0]), end, t0, t1, this->Options.Measure);
    double cut = 0.5;
    const double error = HalvesDistance(left, right, n, t0, t1, chord);
    const double middle = t0 + 0.5 * (t1 - t0);
    if (error <= tolerance || depth >= MaxDepth || int(nodes.size()) >= MaxSegments ||
      !(t0 < middle && middle < t1))
    {
      Append(nodes, { t1, end, error });
      return;
    }
    if (this->Options.Subdivision == CurveSubdivision::Arbitrary)
    {
      cut = WorstControlPoint(points, n, t0, t1, chord);
      if (cut != 0.5)
      {
        SplitBezier<4>(points, n, cut, left, right);
      }
    }
    const double t = t0 + cut * (t1 - t0);
    this->SubdividePiece(left, n, t0, t, tolerance, depth + 1, nodes);
    this->SubdividePiece(right, n, t, t1, tolerance, depth + 1, nodes);
  }

  // A piece that is a point makes no chord.
  static void Append(std::vector<Node>& nodes, const Node& node)
  {
    if (nodes.size() > 1 && node.Error == 0.0 && node.X == nodes.back().X)
    {
      nodes.back().T = node.T;
      return;
    }
    nodes.push_back(node);
  }

  // The parameter i/n beneath the control point that deviates most (section 5.1), the one nearest
  // to the middle if several do.
  static double WorstControlPoint(
    const Vec4* points, int n, double t0, double t1, const Chord& chord)
  {
    double largest = -1.0;
    int worst = 0;
    for (int k = 1; k < n; ++k)
    {
      // n/2, n/2 + 1, n/2 - 1, ...
      const int i = n / 2 + (k % 2 == 0 ? k / 2 : -(k / 2));
      const double d = chord.Distance2(points[i], t0 + i * (t1 - t0) / n);
      if (d > largest * (1.0 + 1e-9))
      {
        largest = d;
        worst = i;
      }
    }
    return worst == 0 ? 0.5 : static_cast<double>(worst) / n;
  }

  const Pieces& All;
  const std::size_t First;
  const std::size_t Last;
  const CurveOptions& Options;
};

double SegmentDistance2(const Vec3& p, const Vec3& a, const Vec3& b)
{
  const Vec3 ab = b - a;
  const double length2 = ab.squaredNorm();
  const double lambda = length2 > 0.0 ? (p - a).dot(ab) / length2 : 0.0;
  return (p - a - std::min(1.0, std::max(0.0, lambda)) * ab).squaredNorm();
}

// The largest distance of the nodes strictly between i and j from the chord i..j.
double SkippedDistance(const std::vector<Node>& nodes, std::size_t i, std::size_t j)
{
  double largest = 0.0;
  for (std::size_t k = i + 1; k < j; ++k)
  {
    largest = std::max(largest, SegmentDistance2(nodes[k].X, nodes[i].X, nodes[j].X));
  }
  return std::sqrt(largest);
}

// Line simplification of section 5.1: from each kept node as far as the nodes between stay within
// `tolerance` of the chord. The farthest node is sought with doubling steps, then halved ones. At
// least `minimum` segments remain.
void Simplify(std::vector<Node>& nodes, double tolerance, std::size_t minimum)
{
  const std::size_t last = nodes.size() - 1;
  const std::size_t longest = std::max<std::size_t>(1, last / minimum);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < last;)
  {
    const std::size_t limit = std::min(last, i + longest);
    std::size_t j = i + 1;
    std::size_t step = 1;
    for (bool growing = true; step > 0; step = growing ? step * 2 : step / 2)
    {
      const bool fits = j + step <= limit && SkippedDistance(nodes, i, j + step) <= tolerance;
      j += fits ? step : 0;
      growing = growing && fits;
    }
    double error = 0.0;
    for (std::size_t k = i + 1; k <= j; ++k)
    {
      error = std::max(error, nodes[k].Error);
    }
    error += SkippedDistance(nodes, i, j);
    nodes[++kept] = { nodes[j].T, nodes[j].X, error };
    i = j;
  }
  nodes.resize(kept + 1);
}

// The share of the segments that a chord of this error asks for: errors grow with the square of
// the chord's length.
double Demand(double error, double tolerance)
{
  return std::sqrt(error / tolerance);
}

double TotalDemand(const std::vector<Node>& nodes, double tolerance)
{
  double sum = 0.0;
  for (std::size_t i = 1; i < nodes.size(); ++i)
  {
    sum += Demand(nodes[i].Error, tolerance);
  }
  return sum;
}

// Slope at the joint of two intervals by the harmonic mean: keeps the interpolant monotone.
double JointSlope(double h0, double slope0, double h1, double slope1)
{
  const double a = h0 + 2.0 * h1;
  const double b = 2.0 * h0 + h1;
  return (a + b) / (a / slope0 + b / slope1);
}

// `count` chords such that each has the same share of the demand measured on `from`: the parameter
// as a function of the demand summed up to it, monotone piecewise cubic, at equal steps.
void Spread(const std::vector<Node>& from, double tolerance, int count, std::vector<Node>& to)
{
  const std::size_t m = from.size() - 1;
  const double total = TotalDemand(from, tolerance);
  const double least = std::max(1e-3 * total, 1e-12) / static_cast<double>(m);
  const auto demand = [&](std::size_t i) { // of interval i, from node i to i + 1
    return std::max(least, Demand(from[i + 1].Error, tolerance));
  };
  const auto slope = [&](std::size_t i) { return (from[i + 1].T - from[i].T) / demand(i); };
  double sum = 0.0;
  for (std::size_t i = 0; i < m; ++i)
  {
    sum += demand(i);
  }
  to.clear();
  to.push_back(from.front());
  std::size_t i = 0;
  double before = 0.0;
  double h = demand(0);
  for (int k = 1; k < count; ++k)
  {
    const double target = sum * k / count;
    while (i + 1 < m && before + h < target)
    {
      before += h;
      h = demand(++i);
    }
    const double s = slope(i);
    const double s0 = i > 0 ? JointSlope(demand(i - 1), slope(i - 1), h, s) : s;
    const double s1 = i + 1 < m ? JointSlope(h, s, demand(i + 1), slope(i + 1)) : s;
    const double x = std::min(1.0, std::max(0.0, (target - before) / h));
    const double y = 1.0 - x;
    // Cubic Hermite form relative to the interval's start.
    const double rise = h * (x * x * (3.0 - 2.0 * x) * s + x * y * y * s0 - x * x * y * s1);
    const double t = std::min(from[i + 1].T, std::max(from[i].T, from[i].T + rise));
    if (t > to.back().T && t < from.back().T)
    {
      to.push_back({ t, Vec3::Zero(), 0.0 });
    }
  }
  to.push_back(from.back());
}

// Subdivision into at least `minimum` chords.
void SubdivideAtLeast(
  const Stretch& stretch, double tolerance, int minimum, std::vector<Node>& nodes)
{
  nodes.assign(1, stretch.StartNode());
  stretch.Subdivide(tolerance, nodes);
  if (int(nodes.size()) <= minimum)
  {
    std::vector<Node> spread;
    Spread(nodes, tolerance, minimum, spread);
    stretch.Measure(spread, Infinite);
    nodes.swap(spread);
  }
}

// Spreads the nodes again while that lowers the largest error by more than a little.
void EvenOut(const Stretch& stretch, double tolerance, std::vector<Node>& nodes)
{
  std::vector<Node> next;
  const auto largest = [](const std::vector<Node>& of) {
    double error = 0.0;
    for (const Node& node : of)
    {
      error = std::max(error, node.Error);
    }
    return error;
  };
  const int count = static_cast<int>(nodes.size()) - 1;
  double worst = largest(nodes);
  for (int round = 0; round < 4; ++round)
  {
    if (TotalDemand(nodes, tolerance) >= Even * count * Demand(worst, tolerance))
    {
      return;
    }
    Spread(nodes, tolerance, count, next);
    const double error = stretch.Measure(next, worst);
    if (!(error < worst) || next.size() != nodes.size())
    {
      return;
    }
    worst = error;
    nodes.swap(next);
  }
}

// Ours: the fewest chords within the tolerance, all of about the same error. Starts from a coarse
// subdivision, spreads the nodes by the measured errors and measures again; the number of chords
// follows the demand, between the largest number known to fail and the smallest known to do.
void Balance(const Stretch& stretch, double tolerance, int minimum, std::vector<Node>& nodes)
{
  nodes.assign({ stretch.StartNode(), stretch.EndNode() });
  if (minimum <= 1 && stretch.Measure(nodes, tolerance) <= tolerance)
  {
    return;
  }
  std::vector<Node> current(1, stretch.StartNode());
  stretch.Subdivide(FirstShare * tolerance, current);
  if (int(current.size()) < 4)
  {
    current.assign(1, stretch.StartNode());
    stretch.Subdivide(tolerance, current);
  }
  std::vector<Node> next;
  std::vector<Node> best;
  int fails = std::max(1, minimum) - 1;
  int retries = 0;
  double demand = TotalDemand(current, tolerance);
  int count = std::max(fails + 1, static_cast<int>(std::ceil(std::min(demand - 0.02, 1e6))));
  for (int round = 0; round < MaxRounds && count < MaxSegments; ++round)
  {
    Spread(current, tolerance, count, next);
    const double worst = stretch.Measure(next, Infinite);
    demand = TotalDemand(next, tolerance);
    current.swap(next);
    const int wanted = static_cast<int>(std::ceil(std::min(demand - 0.02, 1e6)));
    if (worst <= tolerance)
    {
      best = current;
      count = std::max(fails + 1, std::min(wanted, count - 1));
      retries = 0;
      if (count >= int(best.size()) - 1 || wanted >= int(best.size()) - 1)
      {
        break;
      }
      continue;
    }
    if (demand <= count && ++retries < 4)
    {
      continue; // the sum fits, the spread does not yet
    }
    retries = 0;
    fails = std::max(fails, count);
    count = std::max(count + 1, wanted);
    if (!best.empty() && count >= int(best.size()) - 1)
    {
      break;
    }
  }
  if (!best.empty())
  {
    EvenOut(stretch, tolerance, best);
    nodes.swap(best);
    return;
  }
  SubdivideAtLeast(stretch, tolerance, minimum, nodes);
}

// Subdivision and simplification as in section 5.1.
void SubdivideAndSimplify(const Stretch& stretch, double tolerance, const CurveOptions& options,
  int minimum, std::vector<Node>& nodes)
{
  const double gamma = options.Simplify ? options.Gamma : 1.0;
  SubdivideAtLeast(stretch, gamma * tolerance, minimum, nodes);
  if (options.Simplify)
  {
    Simplify(nodes, (1.0 - gamma) * tolerance, minimum);
  }
}

// The unit direction in which a piece starts (end 0) or ends (end 1); zero for a point.
Vec3 Direction(const BezierCurve<3>& piece, int end)
{
  const int n = piece.Degree();
  const Vec3 at = end == 0 ? StartPoint(piece) : EndPoint(piece);
  double size2 = 0.0;
  for (const Vec4& h : piece.Points)
  {
    size2 = std::max(size2, (Project(h) - at).squaredNorm());
  }
  for (int i = 1; i <= n; ++i)
  {
    const Vec3 d = Project(piece.Points[end == 0 ? i : n - i]) - at;
    if (d.squaredNorm() > 1e-18 * size2)
    {
      return (end == 0 ? d : Vec3(-d)).normalized();
    }
  }
  return Vec3::Zero();
}

// First pieces of the stretches, and the number of pieces.
std::vector<std::size_t> FindCorners(const Pieces& pieces)
{
  static const double cosine = std::cos(CornerAngle);
  std::vector<std::size_t> corners(1, 0);
  Vec3 last = Direction(pieces[0], 1);
  for (std::size_t k = 1; k < pieces.size(); ++k)
  {
    const Vec3 next = Direction(pieces[k], 0);
    if (next.isZero(0.0))
    {
      continue;
    }
    if (!last.isZero(0.0) && last.dot(next) < cosine)
    {
      corners.push_back(k);
    }
    last = Direction(pieces[k], 1);
  }
  corners.push_back(pieces.size());
  return corners;
}

bool EndsCoincide(const Pieces& pieces)
{
  const Vec3 start = StartPoint(pieces.front());
  double size2 = 0.0;
  for (const BezierCurve<3>& piece : pieces)
  {
    for (const Vec4& h : piece.Points)
    {
      size2 = std::max(size2, (Project(h) - start).squaredNorm());
    }
  }
  return size2 > 0.0 &&
    (EndPoint(pieces.back()) - start).squaredNorm() <= ClosedShare * ClosedShare * size2;
}

void CheckPieces(const Pieces& pieces)
{
  if (pieces.empty())
  {
    throw Error("ApproximateCurve: no curve");
  }
  for (const BezierCurve<3>& piece : pieces)
  {
    if (piece.Degree() < 0 || piece.Degree() > MaxPieceDegree)
    {
      throw Error("ApproximateCurve: degree " + std::to_string(piece.Degree()) + " of a piece");
    }
  }
}

} // namespace

double ChordDeviation(const BezierCurve<3>& piece, CurveMeasure measure)
{
  CheckPieces({ piece });
  const Chord chord(StartPoint(piece), EndPoint(piece), piece.T0, piece.T1, measure);
  return PieceDistance(piece.Points.data(), piece.Degree(), piece.T0, piece.T1, chord);
}

std::vector<double> ApproximateCurve(const std::vector<BezierCurve<3>>& pieces, double tolerance,
  const CurveOptions& options, double& certified)
{
  CheckPieces(pieces);
  const std::vector<std::size_t> corners = FindCorners(pieces);
  const std::size_t stretches = corners.size() - 1;
  const int minimum = stretches < 3 && EndsCoincide(pieces) ? (stretches == 1 ? 3 : 2) : 1;
  std::vector<double> parameters(1, pieces.front().T0);
  std::vector<Node> nodes;
  certified = 0.0;
  for (std::size_t k = 0; k < stretches; ++k)
  {
    const Stretch stretch(pieces, corners[k], corners[k + 1], options);
    if (options.Balanced)
    {
      Balance(stretch, tolerance, minimum, nodes);
    }
    else
    {
      SubdivideAndSimplify(stretch, tolerance, options, minimum, nodes);
    }
    for (std::size_t i = 1; i < nodes.size(); ++i)
    {
      parameters.push_back(nodes[i].T);
      certified = std::max(certified, nodes[i].Error);
    }
  }
  return parameters;
}

} // namespace nurbs
