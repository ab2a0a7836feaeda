// SPDX-License-Identifier: BSD-3-Clause
#include "WaveletEdge.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{
constexpr int MaximumDepth = 12;
constexpr int ClosedIntervals = 4; // Of an edge that ends where it starts.
constexpr int CurveSamples =
  64; // Of a curve whose second derivative has no bound, a base interval.
constexpr double SampledSafety = 1.5;
constexpr double SameBreak = 1e-6; // Of the edge: base lines closer than this are one.
constexpr double SameLine = 1e-9;  // Of the box: a line of the edge that is one of the face.

// The direction along a side of a box (0: u, 1: v).
int Along(int side)
{
  return side % 2;
}

// A curve as a surface that is constant in v, whose S_uu has sound bounds.
struct Strip
{
  std::vector<double> Points, Weights;
  double Knots[4] = { 0.0, 0.0, 1.0, 1.0 };
  SurfaceView View;

  explicit Strip(const CurveView<3>& curve)
  {
    for (int row = 0; row < 2; ++row)
    {
      for (int i = 0; i < curve.Count; ++i)
      {
        const Vec3 x = curve.Point(i);
        this->Points.insert(this->Points.end(), x.data(), x.data() + 3);
        this->Weights.push_back(curve.Weight(i));
      }
    }
    this->View.Degree[0] = curve.Degree;
    this->View.Degree[1] = 1;
    this->View.Count[0] = curve.Count;
    this->View.Count[1] = 2;
    this->View.Knots[0] = curve.Knots;
    this->View.Knots[1] = KnotView(this->Knots, 4);
    this->View.Points = this->Points.data();
    this->View.Weights = this->Weights.data();
  }
};

void SortBreaks(std::vector<double>& breaks, const Interval& domain)
{
  const double near = SameBreak * domain.Length();
  std::sort(breaks.begin(), breaks.end());
  std::vector<double> out(1, domain.Min);
  for (double t : breaks)
  {
    if (t - out.back() > near && domain.Max - t > near)
    {
      out.push_back(t);
    }
  }
  out.push_back(domain.Max);
  breaks.swap(out);
}
} // namespace

WaveletEdge::WaveletEdge(const Model& model, std::int64_t edge, const std::vector<EdgeUse>& uses,
  const std::vector<std::unique_ptr<WaveletFace>>& faces, Wavelet kind, double tolerance)
  : Index(edge)
  , Pole(IsDegenerate(model.Edges[edge]))
{
  const Edge& source = model.Edges[edge];
  this->Closed = source.Vertex[0] == source.Vertex[1];
  this->Domain = EdgeDomain(model, edge, uses);
  for (const EdgeUse& use : uses)
  {
    WaveletEdgeUse where;
    where.Where = use;
    this->Where.push_back(std::move(where));
  }
  if (this->Pole)
  {
    return;
  }
  this->FindSides(model, faces);
  this->MakeBreaks(model, faces);
  // Depth: as fine as the tolerance asks for, and as the faces' grids are on whose sides it lies.
  std::vector<double> second;
  this->Lines.Depth = 0;
  while (this->Bow(model, faces, second) > tolerance && this->Lines.Depth < MaximumDepth)
  {
    ++this->Lines.Depth;
  }
  for (WaveletEdgeUse& use : this->Where)
  {
    if (use.Side >= 0)
    {
      use.SideDepth = faces[use.Where.Face]->Axis(Along(use.Side)).Depth;
      this->Lines.Depth = std::max(this->Lines.Depth, use.SideDepth);
    }
  }
  this->FineError = this->Bow(model, faces, second);
  for (int i = 0; i <= this->Lines.Intervals(); ++i)
  {
    this->Fine.push_back(this->Point(model, this->Lines.Line(i)));
  }
  this->Fine.front() = model.Vertices[source.Vertex[0]];
  this->Fine.back() = model.Vertices[source.Vertex[1]];
  for (WaveletEdgeUse& use : this->Where)
  {
    const WaveletFace& face = *faces[use.Where.Face];
    for (int i = 0; i <= this->Lines.Intervals(); ++i)
    {
      use.UV.push_back(this->Parameters(model, use, face, this->Lines.Line(i)));
    }
    if (use.Side < 0)
    {
      continue;
    }
    // Which line of the edge is at each of the face's: both in order, one of them perhaps
    // backwards.
    const DyadicAxis& axis = face.Axis(Along(use.Side));
    const int n = this->Lines.Intervals();
    const int d = Along(use.Side);
    const bool forward = use.UV[0][d] < use.UV[n][d];
    const double near = SameLine * (axis.Breaks.back() - axis.Breaks.front());
    use.AtLine.assign(axis.Intervals() + 1, -1);
    int at = 0;
    for (int i = 0; i <= axis.Intervals(); ++i)
    {
      const double line = axis.Line(i);
      while (at < n && use.UV[forward ? at : n - at][d] < line - near)
      {
        ++at;
      }
      const int own = forward ? at : n - at;
      if (std::abs(use.UV[own][d] - line) <= near)
      {
        use.UV[own][d] = line;
        use.AtLine[i] = own;
      }
    }
  }
  if (kind == Wavelet::Haar)
  {
    DyadicAxis none;
    none.Breaks = { 0.0 };
    std::vector<Vec3> samples;
    for (double t : this->Lines.Samples(kind, 0))
    {
      samples.push_back(this->Point(model, t));
    }
    samples.front() = this->Fine.front();
    samples.back() = this->Fine.back();
    this->Haar = WaveletPyramid(kind, this->Lines, none, samples);
    const std::vector<double> across(1, 0.0);
    if (this->Lines.BaseIntervals() > 1) // There may be a kink, which Haar samples pass by.
    {
      this->FineError += BilinearDistance(this->Lines.Samples(kind, 0), across, samples,
        this->Lines.Samples(Wavelet::Interpolating, 0), across, this->Fine);
    }
    for (int k = 0; k + 1 < this->Haar.Levels(); ++k)
    {
      const std::vector<Vec3> coarse = this->Haar.Level(k + 1);
      this->HaarSteps.push_back(BilinearDistance(this->Lines.Samples(kind, k), across, samples,
        this->Lines.Samples(kind, k + 1), across, coarse));
      samples = coarse;
    }
    return;
  }
  const int levels = this->Lines.Depth + 1;
  this->Deviations.resize(levels);
  this->Coefficients.resize(levels);
  for (int k = 1; k < levels; ++k)
  {
    for (int i = 0; i < this->Lines.Intervals(k); ++i)
    {
      const int a = i << k;
      const int b = (i + 1) << k;
      const double own = (this->Fine[(a + b) / 2] - 0.5 * (this->Fine[a] + this->Fine[b])).norm();
      const auto& finer = this->Deviations[k - 1];
      const auto& greater = this->Coefficients[k - 1];
      this->Deviations[k].push_back(
        float(1.0000002 * (own + (k > 1 ? std::max(finer[2 * i], finer[2 * i + 1]) : 0.0f))));
      this->Coefficients[k].push_back(
        float(std::max(own, k > 1 ? double(std::max(greater[2 * i], greater[2 * i + 1])) : 0.0)));
    }
  }
}

// The uses whose trim curve is a side of the face's box, or a part of one, run through evenly.
void WaveletEdge::FindSides(
  const Model& model, const std::vector<std::unique_ptr<WaveletFace>>& faces)
{
  for (WaveletEdgeUse& use : this->Where)
  {
    const CurveView<2>& curve = model.TrimCurves[use.Where.Curve].Geometry;
    if (curve.Degree != 1 || curve.Count != 2 || curve.Weight(0) != curve.Weight(1))
    {
      continue;
    }
    const WaveletFace& face = *faces[use.Where.Face];
    const Vec2 a = face.Snap(curve.Point(0));
    const Vec2 b = face.Snap(curve.Point(1));
    const ParameterBox& box = face.Box();
    const double side[4] = { box.V0, box.U1, box.V1, box.U0 };
    for (int s = 0; s < 4; ++s)
    {
      const int across = 1 - Along(s);
      if (a[across] == side[s] && b[across] == side[s] && a != b)
      {
        use.Side = s;
      }
    }
  }
}

void WaveletEdge::MakeBreaks(
  const Model& model, const std::vector<std::unique_ptr<WaveletFace>>& faces)
{
  std::vector<double>& breaks = this->Lines.Breaks;
  breaks.clear();
  const CurveView<3>& curve = model.Edges[this->Index].Geometry;
  if (curve.Count > 1)
  {
    const Strip strip(curve);
    const SurfaceBound bound(strip.View, { this->Domain.Min, this->Domain.Max, 0.0, 1.0 });
    breaks = bound.Creases(0);
  }
  for (const WaveletEdgeUse& use : this->Where)
  {
    const WaveletFace& face = *faces[use.Where.Face];
    const TrimCurve& trim = model.TrimCurves[use.Where.Curve];
    if (use.Side < 0)
    {
      const Interval own = trim.Geometry.Domain();
      for (double t : CreaseKnots(trim.Geometry.Knots, trim.Geometry.Degree))
      {
        breaks.push_back(this->Domain.Min + (t - own.Min) * (this->Domain.Length() / own.Length()));
      }
      this->AddCrossings(model, use, face);
      continue;
    }
    const int d = Along(use.Side);
    const double a = face.Snap(trim.Geometry.Point(0))[d];
    const double b = face.Snap(trim.Geometry.Point(1))[d];
    for (double line : face.Axis(d).Breaks)
    {
      const double share = (line - a) / (b - a);
      if (share > 0.0 && share < 1.0)
      {
        breaks.push_back(this->Domain.Min + share * this->Domain.Length());
      }
    }
  }
  SortBreaks(breaks, this->Domain);
  while (this->Closed && int(breaks.size()) - 1 < ClosedIntervals)
  {
    for (std::size_t i = breaks.size() - 1; i > 0; --i)
    {
      breaks.push_back(0.5 * (breaks[i - 1] + breaks[i]));
    }
    SortBreaks(breaks, this->Domain);
  }
}

// Where the trim curve crosses creases of the face's surface, the edge needs vertices.
void WaveletEdge::AddCrossings(
  const Model& model, const WaveletEdgeUse& use, const WaveletFace& face)
{
  const int n = CurveSamples;
  for (int d = 0; d < 2; ++d)
  {
    for (double crease : face.Bound().Creases(d))
    {
      const auto beyond = [&](
                            double t) { return this->Parameters(model, use, face, t)[d] - crease; };
      double before = this->Domain.Min;
      for (int i = 1; i <= n; ++i)
      {
        const double t = this->Domain.Min + i * this->Domain.Length() / n;
        if (beyond(before) * beyond(t) < 0.0)
        {
          double low = before;
          double high = t;
          for (int step = 0; step < 60 && low < high; ++step)
          {
            const double middle = 0.5 * (low + high);
            (beyond(low) * beyond(middle) <= 0.0 ? high : low) = middle;
          }
          this->Lines.Breaks.push_back(0.5 * (low + high));
        }
        before = t;
      }
    }
  }
}

Vec3 WaveletEdge::Point(const Model& model, double t) const
{
  const CurveView<3>& curve = model.Edges[this->Index].Geometry;
  if (curve.Count > 1)
  {
    return nurbs::Evaluate(curve, t);
  }
  const EdgeUse& use = this->Where[0].Where;
  const TrimCurve& trim = model.TrimCurves[use.Curve];
  const Vec2 uv = nurbs::Evaluate(trim.Geometry, TrimParameter(trim, this->Domain, t));
  return nurbs::Evaluate(model.Faces[use.Face].Geometry, uv[0], uv[1]);
}

Vec2 WaveletEdge::Parameters(
  const Model& model, const WaveletEdgeUse& use, const WaveletFace& face, double t) const
{
  const TrimCurve& trim = model.TrimCurves[use.Where.Curve];
  return face.Snap(nurbs::Evaluate(trim.Geometry, TrimParameter(trim, this->Domain, t)));
}

// Largest distance of the curve from its finest chords. `second`: bounds of the second derivative
// in the base intervals, found in the first call.
double WaveletEdge::Bow(const Model& model, const std::vector<std::unique_ptr<WaveletFace>>& faces,
  std::vector<double>& second) const
{
  const std::vector<double>& breaks = this->Lines.Breaks;
  const CurveView<3>& curve = model.Edges[this->Index].Geometry;
  const std::size_t n = breaks.size() - 1;
  if (second.empty() && curve.Count > 1)
  {
    const Strip strip(curve);
    SurfaceBound bound(strip.View, { this->Domain.Min, this->Domain.Max, 0.0, 1.0 });
    std::vector<double> lines;
    for (std::size_t i = 0; i < n; ++i)
    {
      for (int k = 0; k < 8; ++k)
      {
        lines.push_back(breaks[i] + 0.125 * k * (breaks[i + 1] - breaks[i]));
      }
    }
    bound.MakeGrid(lines, {}, SerialFor);
    for (std::size_t i = 0; i < n; ++i)
    {
      second.push_back(bound.Over({ breaks[i], breaks[i + 1], 0.0, 1.0 }).Greatest(0));
    }
  }
  else if (second.empty() && this->Where[0].Side >= 0)
  {
    const WaveletEdgeUse& use = this->Where[0];
    const int d = Along(use.Side);
    const WaveletFace& face = *faces[use.Where.Face];
    for (std::size_t i = 0; i < n; ++i)
    {
      const Vec2 a = this->Parameters(model, use, face, breaks[i]);
      const Vec2 b = this->Parameters(model, use, face, breaks[i + 1]);
      const ParameterBox box{ std::min(a[0], b[0]), std::max(a[0], b[0]), std::min(a[1], b[1]),
        std::max(a[1], b[1]) };
      const double speed = (b[d] - a[d]) / (breaks[i + 1] - breaks[i]);
      second.push_back(face.Bound().Over(box).Greatest(2 * d) * speed * speed);
    }
  }
  else if (second.empty())
  {
    for (std::size_t i = 0; i < n; ++i)
    {
      const double h = (breaks[i + 1] - breaks[i]) / CurveSamples;
      double largest = 0.0;
      for (int k = 1; k < CurveSamples; ++k)
      {
        const double t = breaks[i] + k * h;
        const Vec3 difference =
          this->Point(model, t - h) - 2.0 * this->Point(model, t) + this->Point(model, t + h);
        largest = std::max(largest, difference.norm() / (h * h));
      }
      second.push_back(SampledSafety * largest);
    }
  }
  double bow = 0.0;
  for (std::size_t i = 0; i < n; ++i)
  {
    const double h = std::ldexp(breaks[i + 1] - breaks[i], -this->Lines.Depth);
    bow = std::max(bow, 0.125 * h * h * second[i]);
  }
  return bow;
}

std::vector<Vec3> WaveletEdge::HaarLevel(int level) const
{
  return this->Haar.Level(std::min(level, this->Haar.Levels() - 1));
}

std::vector<Vec2> WaveletEdge::HaarUV(
  const Model& model, std::size_t use, int level, const WaveletFace& face) const
{
  std::vector<Vec2> uv;
  for (double t : this->Lines.Samples(Wavelet::Haar, level))
  {
    uv.push_back(this->Parameters(model, this->Where[use], face, t));
  }
  return uv;
}

double WaveletEdge::SegmentError(int first, int last) const
{
  // The smallest segment of a level that holds it.
  int k = 0;
  while ((first >> k) != ((last - 1) >> k))
  {
    ++k;
  }
  return this->FineError + (k == 0 ? 0.0 : double(this->Deviations[k][first >> k]));
}

double WaveletEdge::HaarError(int level) const
{
  double error = this->FineError;
  for (int k = 0; k < std::min<int>(level, int(this->HaarSteps.size())); ++k)
  {
    error += this->HaarSteps[k];
  }
  return error;
}

double WaveletEdge::LargestCoefficient(int first, int last) const
{
  int k = 0;
  while ((first >> k) != ((last - 1) >> k))
  {
    ++k;
  }
  return k == 0 ? 0.0 : double(this->Coefficients[k][first >> k]);
}

double WaveletEdge::HaarDropped(int level) const
{
  double largest = 0.0;
  for (int k = 0; k < std::min(level, this->Haar.Levels() - 1); ++k)
  {
    largest = std::max(largest, this->Haar.LargestDetail(k));
  }
  return largest;
}

std::int64_t WaveletEdge::CountSegments(double threshold) const
{
  if (this->Coefficients.empty())
  {
    int level = this->Lines.Depth;
    while (level > 0 && this->HaarDropped(level) > threshold)
    {
      --level;
    }
    return this->Lines.Intervals(level) + 1;
  }
  std::int64_t count = this->Lines.BaseIntervals();
  for (const std::vector<float>& level : this->Coefficients)
  {
    for (const float coefficient : level)
    {
      count += double(coefficient) > threshold;
    }
  }
  return count;
}

int WaveletEdge::LevelOfSides(const std::vector<int>& faces, int level) const
{
  for (const WaveletEdgeUse& use : this->Where)
  {
    if (use.Side >= 0)
    {
      const int halvings = std::min(faces[use.Where.Face], use.SideDepth);
      level = std::min(level, this->Lines.Depth - use.SideDepth + halvings);
    }
  }
  return level;
}

} // namespace nurbs
