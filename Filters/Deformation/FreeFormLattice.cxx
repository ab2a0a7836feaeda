// SPDX-License-Identifier: BSD-3-Clause
#include "FreeFormLattice.h"

#include "KnotVector.h"
#include "Lanes.h"
#include "Multiversion.h"

#include <Eigen/LU>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr double BorderTolerance = 1e-12; // of the box
constexpr std::int64_t BlockSize = 1024;  // points that one task maps

int ChosenDegree(int count, int degree)
{
  const int largest = std::min(count - 1, MaxDegree);
  return degree == 0 ? std::min(3, largest) : std::min(degree, largest);
}

} // namespace

LatticeBox LatticeBox::Of(const Box3& bounds)
{
  LatticeBox box;
  box.Origin = bounds.min();
  box.Axes = bounds.sizes().asDiagonal();
  return box;
}

FreeFormLattice::Axis FreeFormLattice::MakeAxis(int count, int degree)
{
  if (count < 2 || count > MaxLatticeCount)
  {
    throw Error("a lattice has 2 to " + std::to_string(MaxLatticeCount) +
      " points in each direction, not " + std::to_string(count));
  }
  if (degree < 0)
  {
    throw Error("the degree of a lattice can't be " + std::to_string(degree));
  }
  Axis axis;
  axis.Count = count;
  axis.Degree = ChosenDegree(count, degree);
  axis.Spans = count - axis.Degree;
  axis.Knots = UniformKnots(axis.Degree, count);
  axis.Rest = GrevilleAbscissae(axis.Knots, axis.Degree);
  for (int k = axis.Degree; k < count; ++k)
  {
    for (int d = 1; d <= axis.Degree; ++d)
    {
      for (int r = 0; r < d; ++r)
      {
        axis.Inverse.push_back(1.0 / (axis.Knots[k + r + 1] - axis.Knots[k + r + 1 - d]));
      }
    }
  }
  return axis;
}

FreeFormLattice::FreeFormLattice(
  const LatticeBox& box, const std::array<int, 3>& counts, const std::array<int, 3>& degrees)
  : Box(box)
{
  if (!box.Origin.allFinite() || !box.Axes.allFinite())
  {
    throw Error("the lattice's box is not finite");
  }
  const Vec3 lengths = box.Axes.colwise().norm();
  const Eigen::Matrix3d unit = box.Axes * lengths.cwiseInverse().asDiagonal();
  if (!lengths.allFinite() || !(lengths.minCoeff() > 0.0) || !(std::abs(unit.determinant()) > 1e-9))
  {
    throw Error("the lattice's box is flat, or too large");
  }
  this->ToLocal = lengths.cwiseInverse().asDiagonal() * unit.inverse();
  std::size_t size = 4;
  for (int a = 0; a < 3; ++a)
  {
    this->Axes[a] = MakeAxis(counts[a], degrees[a]);
    size *= counts[a];
  }
  this->Displacements.assign(size, 0.0);
}

std::array<int, 3> FreeFormLattice::Position(std::int64_t index) const
{
  const int rows = this->Count(0), columns = this->Count(1);
  return { { int(index % rows), int(index / rows % columns), int(index / rows / columns) } };
}

Vec3 FreeFormLattice::RestPoint(std::int64_t index) const
{
  const std::array<int, 3> at = this->Position(index);
  const Vec3 local(this->Axes[0].Rest[at[0]], this->Axes[1].Rest[at[1]], this->Axes[2].Rest[at[2]]);
  return this->Box.Origin + this->Box.Axes * local;
}

Vec3 FreeFormLattice::Displacement(std::int64_t index) const
{
  return Eigen::Map<const Vec3>(this->Displacements.data() + 4 * index);
}

void FreeFormLattice::SetDisplacements(ArrayView<double> xyz, int frozen)
{
  if (std::int64_t(xyz.size()) != 3 * this->Size())
  {
    throw Error("the lattice has " + std::to_string(this->Size()) + " points, but " +
      std::to_string(xyz.size() / 3) + " displacements are given");
  }
  for (std::int64_t n = 0; n < this->Size(); ++n)
  {
    if (!Eigen::Map<const Vec3>(xyz.data() + 3 * n).allFinite())
    {
      const std::array<int, 3> at = this->Position(n);
      throw Error("the displacement of lattice point " + std::to_string(n) + " (" +
        std::to_string(at[0]) + ", " + std::to_string(at[1]) + ", " + std::to_string(at[2]) +
        ") is not finite");
    }
  }
  for (Axis& axis : this->Axes)
  {
    axis.FirstMoving = axis.Spans;
    axis.LastMoving = -1;
  }
  for (std::int64_t n = 0; n < this->Size(); ++n)
  {
    const std::array<int, 3> at = this->Position(n);
    bool moves = xyz[3 * n] != 0.0 || xyz[3 * n + 1] != 0.0 || xyz[3 * n + 2] != 0.0;
    for (int a = 0; a < 3; ++a)
    {
      moves = moves && at[a] >= frozen && at[a] < this->Count(a) - frozen;
    }
    for (int c = 0; c < 3; ++c)
    {
      this->Displacements[4 * n + c] = moves ? xyz[3 * n + c] : 0.0;
    }
    for (int a = 0; a < 3 && moves; ++a)
    {
      Axis& axis = this->Axes[a];
      axis.FirstMoving = std::min(axis.FirstMoving, std::max(0, at[a] - axis.Degree));
      axis.LastMoving = std::max(axis.LastMoving, std::min(axis.Spans - 1, at[a]));
    }
  }
}

Vec3 FreeFormLattice::LocalCoordinates(const Vec3& point) const
{
  return this->ToLocal * (point - this->Box.Origin);
}

bool FreeFormLattice::Contains(const Vec3& point) const
{
  const Vec3 local = this->LocalCoordinates(point);
  return local.minCoeff<Eigen::PropagateNaN>() >= -BorderTolerance &&
    local.maxCoeff<Eigen::PropagateNaN>() <= 1.0 + BorderTolerance;
}

/// The loop over points; Quad is as wide as the machine's registers (Lanes.h).
struct LatticeKernel
{
  /// The basis functions of `span` at t: EvaluateBasis with its divisions done in advance. P > 0 is
  /// the degree at compile time, P = 0 takes the axis's.
  template <int P>
  static NURBS_INLINE void Basis(const FreeFormLattice::Axis& axis, int span, double t, double* N)
  {
    const int p = P > 0 ? P : axis.Degree;
    const double* knots = axis.Knots.data() + span + p;
    const double* inverse = axis.Inverse.data() + span * (p * (p + 1) / 2);
    N[0] = 1.0;
    for (int d = 1; d <= p; ++d)
    {
      double saved = 0.0;
      for (int r = 0; r < d; ++r)
      {
        const double scaled = N[r] * *inverse++;
        N[r] = saved + (knots[r + 1] - t) * scaled;
        saved = (t - knots[r + 1 - d]) * scaled;
      }
      N[d] = saved;
    }
  }

  /// The sum over the control points that reach the spans.
  template <class Quad, int P>
  static NURBS_INLINE Quad Sum(
    const FreeFormLattice& lattice, const int (&span)[3], const double (&N)[3][MaxDegree + 1])
  {
    const auto& axes = lattice.Axes;
    const int p = P > 0 ? P : axes[0].Degree;
    const int q = P > 0 ? P : axes[1].Degree;
    const int r = P > 0 ? P : axes[2].Degree;
    Quad sum = Quad::All(0.0);
    for (int k = 0; k <= r; ++k)
    {
      for (int j = 0; j <= q; ++j)
      {
        const std::int64_t row = std::int64_t(span[2] + k) * axes[1].Count + span[1] + j;
        const double* d = lattice.Displacements.data() + 4 * (row * axes[0].Count + span[0]);
        Quad line = N[0][0] * Quad::Load(d);
        for (int i = 1; i <= p; ++i)
        {
          line = line + N[0][i] * Quad::Load(d + 4 * i);
        }
        sum = sum + (N[2][k] * N[1][j]) * line;
      }
    }
    return sum;
  }

  /// Where a point goes; false if it stays.
  template <class Quad, int P>
  static NURBS_INLINE bool Move(const FreeFormLattice& lattice, const double* x, double (&to)[4])
  {
    const double* m = lattice.ToLocal.data(); // columns
    const double* o = lattice.Box.Origin.data();
    const double d[3] = { x[0] - o[0], x[1] - o[1], x[2] - o[2] };
    int span[3];
    double local[3];
    for (int a = 0; a < 3; ++a)
    {
      const FreeFormLattice::Axis& axis = lattice.Axes[a];
      double t = m[a] * d[0] + m[3 + a] * d[1] + m[6 + a] * d[2];
      if (!(t >= -BorderTolerance && t <= 1.0 + BorderTolerance))
      {
        return false;
      }
      local[a] = t = t < 0.0 ? 0.0 : (t > 1.0 ? 1.0 : t);
      span[a] = std::min(int(t * axis.Spans), axis.Spans - 1);
      if (span[a] < axis.FirstMoving || span[a] > axis.LastMoving)
      {
        return false;
      }
    }
    double N[3][MaxDegree + 1];
    for (int a = 0; a < 3; ++a)
    {
      Basis<P>(lattice.Axes[a], span[a], local[a], N[a]);
    }
    Sum<Quad, P>(lattice, span, N).Store(to);
    for (int c = 0; c < 3; ++c)
    {
      to[c] += x[c];
    }
    return true;
  }

  template <class Quad, int P>
  static NURBS_INLINE LatticeMoves Each(
    const FreeFormLattice& lattice, const double* points, std::int64_t count, double* target)
  {
    LatticeMoves moves;
    for (std::int64_t n = 0; n < count; ++n)
    {
      const double* x = points + 3 * n;
      double* y = target + 3 * n;
      double to[4];
      const bool moved = Move<Quad, P>(lattice, x, to);
      const double* z = moved ? to : x;
      moves.Moved += moved && (z[0] != x[0] || z[1] != x[1] || z[2] != x[2]);
      for (int c = 0; c < 3; ++c)
      {
        moves.Changed = moves.Changed || y[c] != z[c];
        y[c] = z[c];
      }
    }
    return moves;
  }

  template <class Quad>
  static NURBS_INLINE LatticeMoves Points(
    const FreeFormLattice& lattice, const double* points, std::int64_t count, double* target)
  {
    const bool cubic = lattice.Degree(0) == 3 && lattice.Degree(1) == 3 && lattice.Degree(2) == 3;
    return cubic ? Each<Quad, 3>(lattice, points, count, target)
                 : Each<Quad, 0>(lattice, points, count, target);
  }
};

namespace
{

NURBS_MULTIVERSION
LatticeMoves WidePoints(
  const FreeFormLattice& lattice, const double* points, std::int64_t count, double* target)
{
  return LatticeKernel::Points<WideLanes>(lattice, points, count, target);
}

LatticeMoves MapBlock(
  const FreeFormLattice& lattice, const double* points, std::int64_t count, double* target)
{
  return HasWideClones() ? WidePoints(lattice, points, count, target)
                         : LatticeKernel::Points<NarrowLanes>(lattice, points, count, target);
}

} // namespace

Vec3 FreeFormLattice::Map(const Vec3& point) const
{
  Vec3 place = point;
  this->Map(point.data(), 1, place.data());
  return place;
}

LatticeMoves FreeFormLattice::Map(
  const double* points, std::int64_t count, double* target, const ParallelFor& parallel) const
{
  std::atomic<std::int64_t> moved{ 0 };
  std::atomic<bool> changed{ false };
  const std::int64_t blocks = (count + BlockSize - 1) / BlockSize;
  parallel(0, blocks, [&](std::int64_t begin, std::int64_t end) {
    const std::int64_t first = begin * BlockSize, last = std::min(end * BlockSize, count);
    const LatticeMoves moves =
      MapBlock(*this, points + 3 * first, last - first, target + 3 * first);
    moved += moves.Moved;
    changed = changed || moves.Changed;
  });
  return { moved, changed };
}

Box3 BoxOfFinitePoints(const double* points, std::int64_t count)
{
  Box3 box;
  for (std::int64_t n = 0; n < count; ++n)
  {
    const Eigen::Map<const Vec3> point(points + 3 * n);
    if (point.allFinite())
    {
      box.extend(point);
    }
  }
  return box;
}

} // namespace nurbs
