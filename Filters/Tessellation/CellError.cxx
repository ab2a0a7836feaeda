// SPDX-License-Identifier: BSD-3-Clause
#include "CellError.h"

#include "SurfaceTree.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{
constexpr double SlidingShare = 0.1; // What second derivatives along the surface weigh in a split.

// The facets of each diagonal by corner index; the first lies beneath the diagonal from (0,0), or
// left of that from (1,0).
constexpr int Facets[2][2][3] = { { { 0, 1, 3 }, { 0, 3, 2 } }, { { 0, 1, 2 }, { 1, 3, 2 } } };

// Where their edges run.
constexpr int Bottom = 1, Top = 2, Left = 4, Right = 8, Across = 16;
constexpr int Edges[2][2][3] = { { { Bottom, Right, Across }, { Across, Top, Left } },
  { { Bottom, Across, Left }, { Right, Top, Across } } };
} // namespace

CellError::CellError(const SurfaceBound& bound, const TreeGoal& goal)
  : Bound(bound)
  , Goal(goal)
  , Evaluator(bound.Evaluator())
{}

// True if two corners are one point, a pole of the surface.
bool CellError::IsCollapsed(const int* f) const
{
  double sides[3];
  for (int i = 0; i < 3; ++i)
  {
    sides[i] = (this->At[f[(i + 1) % 3]] - this->At[f[i]]).squaredNorm();
  }
  return *std::min_element(sides, sides + 3) <= 1e-18 * *std::max_element(sides, sides + 3);
}

// The corners of a cell, of which no samples are known yet.
void CellError::MakeCorners(const ParameterBox& box)
{
  this->Box = box;
  this->Density = 0;
  const Vec2 uv[4] = { Vec2(box.U0, box.V0), Vec2(box.U1, box.V0), Vec2(box.U0, box.V1),
    Vec2(box.U1, box.V1) };
  this->Evaluator.Batch(uv, 4, this->At[0].data(), this->Normal[0].data());
  this->AtCrease = this->Bound.IsCrease(0, box.U0) || this->Bound.IsCrease(0, box.U1) ||
    this->Bound.IsCrease(1, box.V0) || this->Bound.IsCrease(1, box.V1);
}

// Samples of the cell, k steps in each direction.
void CellError::SampleGrid(int k)
{
  if (this->Density >= k)
  {
    return;
  }
  this->Density = k;
  double us[DensestSamples + 1];
  double vs[DensestSamples + 1];
  for (int i = 0; i <= k; ++i)
  {
    us[i] = this->Box.U0 + this->Box.A() * i / k;
    vs[i] = this->Box.V0 + this->Box.B() * i / k;
  }
  const std::size_t n = std::size_t(k) + 1;
  Vec3 points[(DensestSamples + 1) * (DensestSamples + 1)];
  this->Evaluator.Grid(
    ArrayView<double>(us, n), ArrayView<double>(vs, n), points[0].data(), nullptr);
  const int step = DensestSamples / k;
  for (int j = 0; j <= k; ++j)
  {
    for (int i = 0; i <= k; ++i)
    {
      this->Sample[step * (i + j * (DensestSamples + 1))] = points[i + j * (k + 1)];
    }
  }
}

// What the corners of a facet tell.
SampleDistance CellError::Corners(const Facet& facet, const int* f) const
{
  SampleDistance samples;
  for (int i = 0; i < 3; ++i)
  {
    samples.AddSlope(facet, this->Normal[f[i]]);
  }
  if (this->AtCrease)
  {
    samples.SetCrease();
  }
  return samples;
}

// Adds the samples of k steps that those of `last` steps (0: none) do not have, in one half of the
// cell or (`alone`) all of it, against its facet.
void CellError::AddSamples(
  const Facet& facet, int diagonal, int half, bool alone, int last, int k, SampleDistance& samples)
{
  this->SampleGrid(k);
  const int step = DensestSamples / k;
  const int known = last > 0 ? k / last : k + 1; // Every so many have been added.
  for (int j = 0; j <= k; ++j)
  {
    for (int i = 0; i <= k; ++i)
    {
      const int side = diagonal == 0 ? i - j : k - i - j;
      if ((!alone && (half == 0 ? side < 0 : side > 0)) ||
        (last > 0 && i % known == 0 && j % known == 0))
      {
        continue;
      }
      const int on = (j == 0      ? Bottom
                         : j == k ? Top
                                  : 0) |
        (i == 0      ? Left
            : i == k ? Right
                     : 0) |
        (side == 0 && !alone ? Across : 0);
      int edge = -1;
      for (int e = 0; e < 3; ++e)
      {
        edge = on & Edges[diagonal][half][e] ? e : edge;
      }
      samples.Add(facet, this->Sample[step * (i + j * (DensestSamples + 1))], edge);
    }
  }
}

double CellError::Sampled(const ParameterBox& box)
{
  this->MakeCorners(box);
  double best = 1e300;
  for (int diagonal = 0; diagonal < 2; ++diagonal)
  {
    double worst = 0.0;
    for (int half = 0; half < 2; ++half)
    {
      const int* f = Facets[diagonal][half];
      if (!this->IsCollapsed(f))
      {
        const Facet facet(this->At[f[0]], this->At[f[1]], this->At[f[2]]);
        const bool alone = this->IsCollapsed(Facets[diagonal][1 - half]);
        SampleDistance samples = this->Corners(facet, f);
        this->AddSamples(facet, diagonal, half, alone, 0, 2, samples);
        worst = std::max(worst, samples.Largest());
      }
    }
    best = std::min(best, worst);
  }
  return best;
}

// The error of the two facets of a diagonal; not examined further once it is known to be over the
// tolerance, or over `best`.
double CellError::Halves(int diagonal, double best)
{
  const double tolerance = this->Goal.Tolerance;
  const bool guaranteed = this->Goal.Error == ErrorMode::Guaranteed;
  double worst = 0.0;
  for (int half = 0; half < 2; ++half)
  {
    const int* f = Facets[diagonal][half];
    if (this->IsCollapsed(f))
    {
      continue; // At a pole: no triangle comes out.
    }
    const Facet facet(this->At[f[0]], this->At[f[1]], this->At[f[2]]);
    if (this->LooksBack(facet, f))
    {
      return 1e300;
    }
    const bool alone = this->IsCollapsed(Facets[diagonal][1 - half]);
    double error = 1e300;
    Remainder rest(this->Second, this->Box.A(), this->Box.B(), facet);
    if (guaranteed)
    {
      // The bilinear interpolant of the heights is a quarter of that of the fourth corner at most.
      const double twist = alone
        ? -1.0
        : 0.25 * std::abs(facet.Normal().dot(this->At[6 - f[0] - f[1] - f[2]] - this->At[f[0]]));
      const Remainder whole(this->Second, this->Box.A(), this->Box.B(), facet, twist);
      error = CombineError(this->Corners(facet, f), whole, 1);
      rest.Height = facet.HasPlane() ? whole.Across : 1e300;
    }
    if (error > tolerance)
    {
      error = std::min(error, this->DenseError(facet, rest, diagonal, half, alone));
    }
    worst = std::max(worst, error);
    if (worst > tolerance || worst >= best)
    {
      return worst;
    }
  }
  return worst;
}

// True if a facet larger than the tolerance looks against the surface at all its corners.
bool CellError::LooksBack(const Facet& facet, const int* f) const
{
  double longest = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    if (!facet.HasPlane() || facet.Normal().dot(this->Normal[f[i]]) >= 0.0)
    {
      return false;
    }
    longest = std::max(longest, (this->At[f[(i + 1) % 3]] - this->At[f[i]]).norm());
  }
  return longest > this->Goal.Tolerance;
}

// The error by samples, as many as it takes to tell.
double CellError::DenseError(
  const Facet& facet, const Remainder& rest, int diagonal, int half, bool alone)
{
  const double tolerance = this->Goal.Tolerance;
  const bool guaranteed = this->Goal.Error == ErrorMode::Guaranteed;
  SampleDistance samples = this->Corners(facet, Facets[diagonal][half]);
  double error = 0.0;
  for (int last = 0, k = 2; k > 0;)
  {
    this->AddSamples(facet, diagonal, half, alone, last, k, samples);
    error = guaranteed ? CombineError(samples, rest, k) : samples.Largest();
    last = k;
    if (error > tolerance)
    {
      k = guaranteed ? NextDensity(samples, rest, k, tolerance) : 0;
    }
    else
    {
      k = guaranteed || k == 4 || !this->Bound.HasGridLineInside(this->Box) ? 0 : 4;
    }
  }
  return error;
}

double CellError::Measure(TreeLeaf& leaf)
{
  const ParameterBox& box = leaf.Box;
  const double tolerance = this->Goal.Tolerance;
  // The middle lies on both diagonals: if it is too far from both, the cell has failed.
  const Vec3 middle = this->Evaluator.Point(0.5 * (box.U0 + box.U1), 0.5 * (box.V0 + box.V1));
  double far[2];
  for (int diagonal = 0; diagonal < 2; ++diagonal)
  {
    const Vec3& x = this->At[diagonal == 0 ? 0 : 1];
    const Vec3 edge = this->At[diagonal == 0 ? 3 : 2] - x;
    const double square = edge.squaredNorm();
    const double s = square > 0.0 ? edge.dot(middle - x) / square : 0.0;
    far[diagonal] = (middle - x - std::min(1.0, std::max(0.0, s)) * edge).norm();
  }
  leaf.Diagonal = far[0] <= far[1] ? 0 : 1;
  if (far[leaf.Diagonal] > tolerance && this->IsBeyond(middle))
  {
    return far[leaf.Diagonal];
  }
  double error = this->Halves(leaf.Diagonal, 1e300);
  if (error > tolerance)
  {
    const double other = this->Halves(1 - leaf.Diagonal, error);
    if (other < error)
    {
      error = other;
      leaf.Diagonal = 1 - leaf.Diagonal;
    }
  }
  return error;
}

// True if the cell's middle is too far from the facets of both diagonals.
bool CellError::IsBeyond(const Vec3& middle) const
{
  for (const auto& diagonal : Facets)
  {
    for (const int* f : { diagonal[0], diagonal[1] })
    {
      SampleDistance sample;
      sample.Add(Facet(this->At[f[0]], this->At[f[1]], this->At[f[2]]), middle);
      if (sample.Far <= this->Goal.Tolerance)
      {
        return false;
      }
    }
  }
  return true;
}

int CellError::CheaperAxis() const
{
  const Vec3 diagonal = this->At[3] - this->At[0];
  const Vec3 other = this->At[2] - this->At[1];
  const Vec3 n = diagonal.cross(other).normalized();
  const double a = this->Box.A();
  const double b = this->Box.B();
  const auto cost = [&](int k) {
    return this->Second.Greatest(k, n) + SlidingShare * this->Second.Greatest(k);
  };
  double u = a * a * cost(0);
  double v = b * b * cost(2);
  if (2.0 * a * b * this->Second.Greatest(1, n) > 4.0 * std::max(u, v))
  {
    // Twist alone: split the longer side.
    u = (this->At[1] - this->At[0]).norm() + (this->At[3] - this->At[2]).norm();
    v = (this->At[2] - this->At[0]).norm() + (this->At[3] - this->At[1]).norm();
  }
  return u >= v ? 0 : 1;
}

// Sides and diagonals against the limits; `axis` receives the direction to split.
bool CellError::ExceedsLimits(int& axis)
{
  int longer = axis;
  const auto exceeds = [&longer](double limit, const auto& apart) {
    const double u = std::max(apart(0, 1), apart(2, 3));
    const double v = std::max(apart(0, 2), apart(1, 3));
    longer = u >= v ? 0 : 1;
    return std::max({ u, v, apart(0, 3), apart(1, 2) }) > limit;
  };
  const auto length = [&](int i, int j) { return (this->At[i] - this->At[j]).norm(); };
  const auto angle = [&](int i, int j) { return Angle(this->Normal[i], this->Normal[j]); };
  const double longest = this->Goal.MaximumEdgeLength;
  bool over = longest > 0.0 && exceeds(longest, length);
  if (!over && this->Goal.MaximumAngle > 0.0 &&
    exceeds(SmallForAngles * this->Goal.Tolerance, length))
  {
    if (!this->Bound.Creases(0).empty() || !this->Bound.Creases(1).empty())
    {
      // Normals of the cell's side of creases.
      const ParameterBox box = this->Box;
      const double a = BesideCrease * box.A();
      const double b = BesideCrease * box.B();
      this->MakeCorners({ box.U0 + a, box.U1 - a, box.V0 + b, box.V1 - b });
    }
    over = exceeds(this->Goal.MaximumAngle, angle);
  }
  axis = over ? longer : axis;
  return over;
}

int CellError::Examine(TreeLeaf& leaf)
{
  this->MakeCorners(leaf.Box);
  this->Second = this->Bound.Over(leaf.Box);
  leaf.Error = this->Measure(leaf);
  int axis = leaf.Axis = this->CheaperAxis();
  return leaf.Error <= this->Goal.Tolerance && !this->ExceedsLimits(axis) ? -1 : axis;
}

} // namespace nurbs
