// SPDX-License-Identifier: BSD-3-Clause
#include "WaveletFace.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nurbs
{

namespace
{
constexpr int MaximumDepth = 12; // Halvings of a base interval.
constexpr int ClosedIntervals =
  4;                          // Of a closed direction's base grid, so that it encloses something.
constexpr int BoundLines = 8; // Cells of the grid of bounds in a base interval.
constexpr double SnapDistance = 1e-9; // Of the box, to its sides.
constexpr double Sliver = 1e-7;       // Of the box: sides that are as good as a knot.
constexpr double SnapToCrease = 1e-6; // Likewise, to creases.
constexpr double SameSide = 1e-9;     // Of the control net: closed or degenerate sides.

float Up(double x)
{
  const float f = float(x);
  return double(f) >= x ? f : std::nextafter(f, std::numeric_limits<float>::infinity());
}

// Cuts base intervals in halves until there are at least `count`.
void Halve(std::vector<double>& breaks, int count)
{
  while (int(breaks.size()) - 1 < count)
  {
    std::vector<double> finer(1, breaks[0]);
    for (std::size_t i = 1; i < breaks.size(); ++i)
    {
      finer.push_back(0.5 * (breaks[i - 1] + breaks[i]));
      finer.push_back(breaks[i]);
    }
    breaks.swap(finer);
  }
}
} // namespace

ParameterBox LoopBox(const Model& model, const Face& face)
{
  Box2 box;
  for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
  {
    const TrimLoop& loop = model.Loops[l];
    for (std::int64_t k = loop.FirstCurve; k < loop.FirstCurve + loop.CurveCount; ++k)
    {
      const CurveView<2>& c = model.TrimCurves[k].Geometry;
      for (int i = 0; i < c.Count; ++i)
      {
        box.extend(c.Point(i));
      }
    }
  }
  double range[2][2];
  for (int d = 0; d < 2; ++d)
  {
    const Interval domain = face.Geometry.Domain(d);
    const double eps = SnapDistance * domain.Length();
    const bool any = face.LoopCount > 0 && !box.isEmpty();
    range[d][0] = any && box.min()[d] > domain.Min + eps ? box.min()[d] : domain.Min;
    range[d][1] = any && box.max()[d] < domain.Max - eps ? box.max()[d] : domain.Max;
    if (!(range[d][1] - range[d][0] > eps))
    {
      throw Error("its loops enclose no area");
    }
    // Slivers between a side and a knot would have no sensible bounds.
    const double sliver = Sliver * (range[d][1] - range[d][0]);
    for (const Knot& knot : DistinctKnots(face.Geometry.Knots[d], face.Geometry.Degree[d]))
    {
      for (double& side : range[d])
      {
        side = std::abs(knot.Value - side) <= sliver ? knot.Value : side;
      }
    }
  }
  return { range[0][0], range[0][1], range[1][0], range[1][1] };
}

WaveletFace::WaveletFace(
  const Model& model, std::int64_t index, Wavelet kind, const FinestGrid& finest)
  : Kind(kind)
{
  const Face& face = model.Faces[index];
  this->Turned = face.Reversed;
  this->Used = LoopBox(model, face);
  this->Bounds = std::make_unique<SurfaceBound>(face.Geometry, this->Used);
  this->MakeBreaks(face.Geometry);
  this->MakeDepths(kind, finest);
  this->Evaluate(kind);
}

// Base lines: the box's sides and the creases between; more where the coarsest grid would collapse.
void WaveletFace::MakeBreaks(const SurfaceView& surface)
{
  const double near = SameSide * this->Bounds->Size();
  for (int d = 0; d < 2; ++d)
  {
    std::vector<double>& breaks = this->Axes[d].Breaks;
    breaks.assign(1, d == 0 ? this->Used.U0 : this->Used.V0);
    const std::vector<double>& creases = this->Bounds->Creases(d);
    breaks.insert(breaks.end(), creases.begin(), creases.end());
    breaks.push_back(d == 0 ? this->Used.U1 : this->Used.V1);
    const Interval domain = surface.Domain(d);
    const double eps = Sliver * domain.Length();
    const bool whole = breaks.front() <= domain.Min + eps && breaks.back() >= domain.Max - eps;
    const bool poles =
      IsDegenerateSide(surface, d, 0, near) || IsDegenerateSide(surface, d, 1, near);
    Halve(breaks, whole && IsClosed(surface, d, near) ? ClosedIntervals : poles ? 2 : 1);
  }
}

// Halves base intervals until the finest cells err by no more than the tolerance.
void WaveletFace::MakeDepths(Wavelet kind, const FinestGrid& finest)
{
  std::vector<double> lines[2];
  for (int d = 0; d < 2; ++d)
  {
    lines[d] = this->Axes[d].Breaks;
    Halve(lines[d], BoundLines);
  }
  this->Bounds->MakeGrid(lines[0], lines[1], SerialFor);
  struct Cell
  {
    double A, B;
    double Second[3];
  };
  std::vector<Cell> cells;
  for (std::size_t j = 0; j + 1 < lines[1].size(); ++j)
  {
    for (std::size_t i = 0; i + 1 < lines[0].size(); ++i)
    {
      const ParameterBox box{ lines[0][i], lines[0][i + 1], lines[1][j], lines[1][j + 1] };
      const SecondDerivatives second = this->Bounds->Over(box);
      Cell cell{ 0.0, 0.0, { second.Greatest(0), second.Greatest(1), second.Greatest(2) } };
      const auto length = [](const std::vector<double>& breaks, double t) {
        const auto next = std::upper_bound(breaks.begin(), breaks.end(), t);
        return *next - *(next - 1);
      };
      cell.A = length(this->Axes[0].Breaks, 0.5 * (box.U0 + box.U1));
      cell.B = length(this->Axes[1].Breaks, 0.5 * (box.V0 + box.V1));
      cells.push_back(cell);
    }
  }
  const auto samples = [&](int du, int dv) {
    return double(LineSamples(kind, this->Axes[0].BaseIntervals() << du)) *
      LineSamples(kind, this->Axes[1].BaseIntervals() << dv);
  };
  for (;;)
  {
    int* const depth[2] = { &this->Axes[0].Depth, &this->Axes[1].Depth };
    double worst[3] = { 0.0, 0.0, 0.0 };
    double bow = 0.0;
    this->Fine = 0.0;
    for (const Cell& cell : cells)
    {
      const double a = std::ldexp(cell.A, -*depth[0]);
      const double b = std::ldexp(cell.B, -*depth[1]);
      const double part[3] = { 0.125 * a * a * cell.Second[0], 0.25 * a * b * cell.Second[1],
        0.125 * b * b * cell.Second[2] };
      for (int k = 0; k < 3; ++k)
      {
        worst[k] = std::max(worst[k], part[k]);
      }
      this->Fine = std::max(this->Fine, part[0] + part[2]);
      bow = std::max(bow, part[0] + part[1] + part[2]);
    }
    if (bow <= finest.Tolerance)
    {
      return;
    }
    int d = worst[0] > worst[2] ? 0 : worst[2] > worst[0] ? 1 : *depth[0] > *depth[1];
    if (worst[1] > worst[0] + worst[2])
    {
      d = *depth[0] > *depth[1]; // The twist falls with either.
    }
    if (*depth[d] == MaximumDepth ||
      samples(*depth[0] + (d == 0), *depth[1] + (d == 1)) > double(finest.MaximumSamples))
    {
      this->Capped = true;
      return;
    }
    ++*depth[d];
  }
}

void WaveletFace::Evaluate(Wavelet kind)
{
  const std::vector<double> us = this->Axes[0].Samples(kind, 0);
  const std::vector<double> vs = this->Axes[1].Samples(kind, 0);
  std::vector<Vec3> points(us.size() * vs.size());
  std::vector<Vec3> normals(points.size());
  SurfaceEvaluator evaluator(this->Bounds->Evaluator());
  evaluator.Grid(us, vs, points[0].data(), normals[0].data());
  this->FineNormals.reserve(normals.size());
  for (const Vec3& n : normals)
  {
    this->FineNormals.push_back((this->Turned ? Vec3(-n) : n).cast<float>());
  }
  normals = {};
  this->Samples = WaveletPyramid(kind, this->Axes[0], this->Axes[1], points);
  this->MeasureLevels(kind, points);
  if (kind == Wavelet::Interpolating)
  {
    this->MeasureCells(points);
  }
}

void WaveletFace::MeasureLevels(Wavelet kind, const std::vector<Vec3>& finest)
{
  std::vector<std::vector<Vec3>> grids(this->Levels());
  grids.back() = this->Samples.Level(this->Levels() - 1);
  for (int k = this->Levels() - 2; k > 0; --k)
  {
    grids[k] = this->Samples.Refine(k, grids[k + 1]);
  }
  grids[0] = finest;
  if (kind == Wavelet::Haar &&
    !(this->Bounds->Creases(0).empty() && this->Bounds->Creases(1).empty()))
  {
    this->AddCreases(finest);
  }
  std::vector<double> u, v;
  for (int k = 0; k < this->Levels(); ++k)
  {
    u = this->Axes[0].Samples(kind, k);
    v = this->Axes[1].Samples(kind, k);
    double twist = 0.0;
    const std::size_t width = u.size();
    for (std::size_t j = 0; j + 1 < v.size(); ++j)
    {
      const Vec3* row = &grids[k][j * width];
      for (std::size_t i = 0; i + 1 < width; ++i)
      {
        twist = std::max(
          twist, (row[i] - row[i + 1] - row[i + width] + row[i + width + 1]).squaredNorm());
      }
    }
    this->Twist.push_back(std::sqrt(twist));
    if (k + 1 < this->Levels())
    {
      this->Steps.push_back(BilinearDistance(u, v, grids[k], this->Axes[0].Samples(kind, k + 1),
        this->Axes[1].Samples(kind, k + 1), grids[k + 1]));
    }
  }
}

// Haar samples lie beside a crease, where the bounds say nothing: the grid of lines, which are on
// it, leads from one to the other.
void WaveletFace::AddCreases(const std::vector<Vec3>& finest)
{
  const std::vector<double> us = this->Axes[0].Samples(Wavelet::Interpolating, 0);
  const std::vector<double> vs = this->Axes[1].Samples(Wavelet::Interpolating, 0);
  std::vector<Vec3> lines(us.size() * vs.size());
  SurfaceEvaluator(this->Bounds->Evaluator()).Grid(us, vs, lines[0].data(), nullptr);
  this->Fine += BilinearDistance(this->Axes[0].Samples(Wavelet::Haar, 0),
    this->Axes[1].Samples(Wavelet::Haar, 0), finest, us, vs, lines);
}

// Bottom up: a cell deviates by no more than its new samples do, and the worst of its parts.
void WaveletFace::MeasureCells(const std::vector<Vec3>& finest)
{
  const std::size_t width = this->Axes[0].Intervals() + 1;
  this->Deviations.resize(this->Levels());
  this->Coefficients.resize(this->Levels());
  this->Ranges.resize(this->Levels());
  for (int k = 1; k < this->Levels(); ++k)
  {
    const int nu = this->Axes[0].Intervals(k);
    const int nv = this->Axes[1].Intervals(k);
    this->Deviations[k].resize(std::size_t(nu) * nv);
    this->Coefficients[k].resize(std::size_t(nu) * nv);
    this->Ranges[k].resize(std::size_t(nu) * nv);
    for (int j = 0; j < nv; ++j)
    {
      for (int i = 0; i < nu; ++i)
      {
        const WaveletCell cell{ k, i, j };
        int at[4];
        this->Extent(cell, at);
        const auto x = [&](int a, int b) -> const Vec3& { return finest[a + b * width]; };
        // The lines of the new samples; those of a direction that is not halved are the ends.
        const bool halved[2] = { this->Axes[0].Halvings(k) > this->Axes[0].Halvings(k - 1),
          this->Axes[1].Halvings(k) > this->Axes[1].Halvings(k - 1) };
        const int a[3] = { at[0], (at[0] + at[1]) / 2, at[1] };
        const int b[3] = { at[2], (at[2] + at[3]) / 2, at[3] };
        double own = 0.0;
        const Vec3 none = Vec3::Zero();
        Box3 range(none);
        for (int t = 0; t < 3; ++t)
        {
          for (int s = 0; s < 3; ++s)
          {
            if ((s == 1 && !halved[0]) || (t == 1 && !halved[1]) || (s != 1 && t != 1))
            {
              continue;
            }
            const double p = 0.5 * s;
            const double q = 0.5 * t;
            const Vec3 bilinear = (1.0 - q) * ((1.0 - p) * x(a[0], b[0]) + p * x(a[2], b[0])) +
              q * ((1.0 - p) * x(a[0], b[2]) + p * x(a[2], b[2]));
            const Vec3 deviation = x(a[s], b[t]) - bilinear;
            own = std::max(own, deviation.norm());
            range.extend(deviation);
          }
        }
        double finer = 0.0;
        double coefficient = own;
        Box3 finerRange(none);
        WaveletCell children[4];
        const int count = k > 1 ? this->Children(cell, children) : 0;
        for (int c = 0; c < count; ++c)
        {
          finer = std::max(finer, this->Deviation(children[c]));
          coefficient = std::max(coefficient, this->LargestCoefficient(children[c]));
          finerRange.extend(this->Ranges[k - 1][this->IndexOf(children[c])].cast<double>());
        }
        const std::size_t index = this->IndexOf(cell);
        this->Deviations[k][index] = Up(own + finer);
        this->Coefficients[k][index] = Up(coefficient);
        Eigen::AlignedBox3f& all = this->Ranges[k][index];
        for (int c = 0; c < 3; ++c)
        {
          all.min()[c] = -Up(-(range.min()[c] + finerRange.min()[c]));
          all.max()[c] = Up(range.max()[c] + finerRange.max()[c]);
        }
      }
    }
  }
}

double WaveletFace::BilinearError(int level) const
{
  double error = this->Fine;
  for (int k = 0; k < std::min<int>(level, int(this->Steps.size())); ++k)
  {
    error += this->Steps[k];
  }
  return error;
}

double WaveletFace::LevelError(int level) const
{
  return this->BilinearError(level) +
    0.25 * this->Twist[std::min<std::size_t>(level, this->Twist.size() - 1)];
}

double WaveletFace::LargestDropped(int level) const
{
  double largest = 0.0;
  for (int k = 0; k < std::min(level, this->Levels() - 1); ++k)
  {
    largest = std::max(largest, this->Samples.LargestDetail(k));
  }
  return largest;
}

std::vector<Eigen::Vector3f> WaveletFace::Normals(int level) const
{
  std::vector<Eigen::Vector3f> out;
  const std::size_t width = LineSamples(this->Kind, this->Axes[0].Intervals());
  const int step[2] = { 1 << this->Axes[0].Halvings(level), 1 << this->Axes[1].Halvings(level) };
  const int count[2] = { LineSamples(this->Kind, this->Axes[0].Intervals(level)),
    LineSamples(this->Kind, this->Axes[1].Intervals(level)) };
  // The fine samples beside sample i of the level: one, or the two in the middle of a Haar cell.
  const auto beside = [&](int dir, int i, int(&at)[2]) {
    if (this->Kind != Wavelet::Haar)
    {
      at[0] = at[1] = i * step[dir];
      return;
    }
    const int first = (i - 1) * step[dir] + 1;
    const int last = LineSamples(this->Kind, this->Axes[dir].Intervals()) - 1;
    at[0] = i == 0 ? 0 : i + 1 == count[dir] ? last : first + (step[dir] - 1) / 2;
    at[1] = i == 0 ? 0 : i + 1 == count[dir] ? last : first + step[dir] / 2;
  };
  for (int j = 0; j < count[1]; ++j)
  {
    int row[2];
    beside(1, j, row);
    for (int i = 0; i < count[0]; ++i)
    {
      int column[2];
      beside(0, i, column);
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (int k = 0; k < 4; ++k)
      {
        sum += this->FineNormals[column[k & 1] + row[k >> 1] * width];
      }
      out.push_back(sum.norm() > 0.0f ? Eigen::Vector3f(sum.normalized()) : sum);
    }
  }
  return out;
}

std::size_t WaveletFace::IndexOf(const WaveletCell& cell) const
{
  return cell.I + std::size_t(cell.J) * this->Axes[0].Intervals(cell.Level);
}

double WaveletFace::Deviation(const WaveletCell& cell) const
{
  return cell.Level == 0 ? 0.0 : double(this->Deviations[cell.Level][this->IndexOf(cell)]);
}

double WaveletFace::Spread(const WaveletCell& cell) const
{
  return cell.Level == 0
    ? 0.0
    : this->Ranges[cell.Level][this->IndexOf(cell)].diagonal().cast<double>().norm();
}

double WaveletFace::LargestCoefficient(const WaveletCell& cell) const
{
  return cell.Level == 0 ? 0.0 : double(this->Coefficients[cell.Level][this->IndexOf(cell)]);
}

int WaveletFace::Children(const WaveletCell& cell, WaveletCell (&children)[4]) const
{
  const int k = cell.Level - 1;
  const int parts[2] = { this->Axes[0].Depth > k ? 2 : 1, this->Axes[1].Depth > k ? 2 : 1 };
  int count = 0;
  for (int b = 0; b < parts[1]; ++b)
  {
    for (int a = 0; a < parts[0]; ++a)
    {
      children[count++] = { k, cell.I * parts[0] + a, cell.J * parts[1] + b };
    }
  }
  return count;
}

void WaveletFace::Extent(const WaveletCell& cell, int (&lines)[4]) const
{
  const int u = this->Axes[0].Halvings(cell.Level);
  const int v = this->Axes[1].Halvings(cell.Level);
  lines[0] = cell.I << u;
  lines[1] = (cell.I + 1) << u;
  lines[2] = cell.J << v;
  lines[3] = (cell.J + 1) << v;
}

Vec2 WaveletFace::Snap(const Vec2& uv) const
{
  Vec2 p = uv;
  for (int d = 0; d < 2; ++d)
  {
    const std::vector<double>& breaks = this->Axes[d].Breaks;
    const double eps = SnapDistance * (breaks.back() - breaks.front());
    p[d] = p[d] < breaks.front() + eps ? breaks.front()
      : p[d] > breaks.back() - eps     ? breaks.back()
                                       : p[d];
    for (double crease : this->Bounds->Creases(d))
    {
      p[d] =
        std::abs(p[d] - crease) <= SnapToCrease * (breaks.back() - breaks.front()) ? crease : p[d];
    }
  }
  return p;
}

} // namespace nurbs
