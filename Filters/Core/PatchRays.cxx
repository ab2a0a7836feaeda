// SPDX-License-Identifier: BSD-3-Clause
#include "PatchRays.h"

#include "CellTrees.h"
#include "Model.h"
#include "PatchCutter.h"
#include "PieceSearch.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

/// How far outside of its piece a root may lie, in parameters of the patch: more than rounding
/// moves it, so that none is lost between two pieces.
constexpr double Overlap = 1e-11;
/// Where a ray touches the surface, the piece that can't be told from a double root is about the
/// square root of the rounding in size; larger ones contain the ray.
constexpr double TouchSize = 1e-5;
/// Newton's method ends with a step of this size, in parameters of the patch: the next one would be
/// of rounding only.
constexpr double NewtonEnd = 1e-9;
/// The same for the iteration that contracts by a half.
constexpr double ChordEnd = 1e-13;

/// The degree - 1 Bernstein polynomials.
template <int Degree>
inline void Bernstein(int degree, double t, double* b)
{
  const int n = Degree > 0 ? Degree : degree;
  b[0] = 1.0;
  for (int k = 1; k < n; ++k)
  {
    double carry = 0.0;
    for (int i = 0; i < k; ++i)
    {
      const double now = b[i];
      b[i] = carry + (1.0 - t) * now;
      carry = t * now;
    }
    b[k] = carry;
  }
}

/// Point and derivatives by de Casteljau's algorithm, its last step made for both directions at
/// once: the four points before it give them all (Farin, Curves and Surfaces for CAGD, section
/// 14.4).
template <int P, int Q>
void EvaluatePatch(const Vec4* net, int p, int q, double u, double v, PatchPoint& out)
{
  const int m = P > 0 ? P : p;
  const int n = Q > 0 ? Q : q;
  double bu[P > 0 ? P : MaxDegree];
  double bv[Q > 0 ? Q : MaxDegree];
  Bernstein<P>(m, u, bu);
  Bernstein<Q>(n, v, bv);
  Vec4 corner[2][2] = { { Vec4::Zero(), Vec4::Zero() }, { Vec4::Zero(), Vec4::Zero() } };
  for (int j = 0; j <= n; ++j)
  {
    const Vec4* row = net + j * (m + 1);
    Vec4 low = bu[0] * row[0];
    Vec4 high = bu[0] * row[1];
    for (int i = 1; i < m; ++i)
    {
      low += bu[i] * row[i];
      high += bu[i] * row[i + 1];
    }
    if (j < n)
    {
      corner[0][0] += bv[j] * low;
      corner[1][0] += bv[j] * high;
    }
    if (j > 0)
    {
      corner[0][1] += bv[j - 1] * low;
      corner[1][1] += bv[j - 1] * high;
    }
  }
  const Vec4 low = (1.0 - u) * corner[0][0] + u * corner[1][0];
  const Vec4 high = (1.0 - u) * corner[0][1] + u * corner[1][1];
  out.H = (1.0 - v) * low + v * high;
  out.D[0] = m * ((1.0 - v) * (corner[1][0] - corner[0][0]) + v * (corner[1][1] - corner[0][1]));
  out.D[1] = n * (high - low);
}

} // namespace

void EvaluatePatch(const Vec4* net, int p, int q, double u, double v, PatchPoint& out)
{
  if (p <= 3 && q <= 3)
  {
    using Function = void (*)(const Vec4*, int, int, double, double, PatchPoint&);
    static constexpr Function functions[3][3] = { { &EvaluatePatch<1, 1>, &EvaluatePatch<1, 2>,
                                                    &EvaluatePatch<1, 3> },
      { &EvaluatePatch<2, 1>, &EvaluatePatch<2, 2>, &EvaluatePatch<2, 3> },
      { &EvaluatePatch<3, 1>, &EvaluatePatch<3, 2>, &EvaluatePatch<3, 3> } };
    functions[p - 1][q - 1](net, p, q, u, v, out);
  }
  else
  {
    EvaluatePatch<-1, -1>(net, p, q, u, v, out);
  }
}

RayPlanes::RayPlanes(const Vec3& origin, const Vec3& direction)
  : Origin(origin)
  , Direction(direction.normalized())
{
  this->Normal[0] = this->Direction.unitOrthogonal();
  this->Normal[1] = this->Direction.cross(this->Normal[0]);
  for (int k = 0; k < 2; ++k)
  {
    this->Homogeneous[k] << this->Normal[k], -this->Normal[k].dot(origin);
  }
}

void PatchRays::Measure(const Model& model, double& size, double& rounding)
{
  Box3 box;
  for (const Face& face : model.Faces)
  {
    for (std::int64_t k = 0; k < face.Geometry.Size(); ++k)
    {
      box.extend(face.Geometry.Point(k));
    }
  }
  size = box.isEmpty() ? 0.0 : box.diagonal().norm();
  rounding = box.isEmpty()
    ? 0.0
    : 4e-15 * std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
}

void PatchRays::Build(const Model& model, const CellTrees& forest)
{
  Measure(model, this->Size, this->Rounding);
  for (std::int32_t k = 0; k < forest.Count(); ++k)
  {
    const BezierPatch& patch = forest.GivenPatch(k);
    this->Patches.push_back({ { patch.Degree[0], patch.Degree[1] }, forest.FaceOf(k),
      static_cast<std::int64_t>(this->Points.size()), { patch.U, patch.V } });
    double heaviest = 0.0;
    for (const Vec4& h : patch.Points)
    {
      heaviest = std::max(heaviest, h[3]);
    }
    for (const Vec4& h : patch.Points)
    {
      this->Points.push_back(h / heaviest);
    }
  }
  this->CellBoxes = forest.Boxes();
  this->Box = forest.Bounds();
  this->Size = this->Box.isEmpty() ? 0.0 : this->Box.diagonal().norm();
}

void PatchRays::Build(const Model& model, const TrimIndex& trims, const std::vector<double>& reach,
  const ParallelFor& parallel)
{
  Measure(model, this->Size, this->Rounding);
  const std::int64_t count = static_cast<std::int64_t>(model.Faces.size());
  std::vector<PatchCutter> cut(count, PatchCutter(this->Size));
  parallel(0, count, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i)
    {
      if (model.Faces[i].Geometry.Size() > 0)
      {
        const CoverTest test(model, model.Faces[i], trims.Face(i));
        for (const BezierPatch& patch : ToBezier(model.Faces[i].Geometry))
        {
          cut[i].Add(patch, static_cast<std::int32_t>(i), test, reach[i]);
        }
      }
    }
  });
  this->Join(cut);
}

void PatchRays::Join(std::vector<PatchCutter>& cut)
{
  std::size_t patches = 0, points = 0, cells = 0;
  for (const PatchCutter& surface : cut)
  {
    patches += surface.Patches.size();
    points += surface.Points.size();
    cells += surface.Cells.size();
  }
  if (std::max(patches, cells) > std::size_t(std::numeric_limits<std::int32_t>::max()))
  {
    throw Error("PatchRays: more than 2^31 patches or cells");
  }
  this->Patches.reserve(patches);
  this->Points.reserve(points);
  this->Cells.reserve(cells);
  this->CellBoxes.reserve(cells);
  this->Box.setEmpty();
  for (PatchCutter& surface : cut)
  {
    for (const Box3& box : surface.Boxes)
    {
      this->Box.extend(box);
    }
    const std::int32_t firstPatch = static_cast<std::int32_t>(this->Patches.size());
    const std::int64_t firstPoint = static_cast<std::int64_t>(this->Points.size());
    for (Patch patch : surface.Patches)
    {
      patch.First += firstPoint;
      this->Patches.push_back(patch);
    }
    for (Cell cell : surface.Cells)
    {
      cell.Patch += firstPatch;
      this->Cells.push_back(cell);
    }
    this->Points.insert(this->Points.end(), surface.Points.begin(), surface.Points.end());
    this->CellBoxes.insert(this->CellBoxes.end(), surface.Boxes.begin(), surface.Boxes.end());
    surface = PatchCutter(this->Size);
  }
  this->Size = this->Box.isEmpty() ? 0.0 : this->Box.diagonal().norm();
}

std::size_t PatchRays::MemoryUse() const
{
  return this->Patches.capacity() * sizeof(Patch) + this->Points.capacity() * sizeof(Vec4) +
    this->Cells.capacity() * sizeof(Cell) + this->CellBoxes.capacity() * sizeof(Box3);
}

void PatchRays::Intersect(const Cell& cell, const RayPlanes& ray, std::vector<PatchHit>& hits) const
{
  const Vec3 offset = cell.Middle - ray.Origin;
  const double x = ray.Normal[0].dot(offset);
  const double y = ray.Normal[1].dot(offset);
  const double radius = cell.Radius + this->Rounding;
  if (x * x + y * y > radius * radius)
  {
    return;
  }
  // Where the ray meets the tangent plane, by Cramer's rule.
  const double a = ray.Normal[0].dot(cell.D[0]);
  const double b = ray.Normal[0].dot(cell.D[1]);
  const double c = ray.Normal[1].dot(cell.D[0]);
  const double d = ray.Normal[1].dot(cell.D[1]);
  const double det = a * d - b * c;
  const double rows[2] = { std::sqrt(b * b + d * d), std::sqrt(a * a + c * c) };
  if (std::abs(det) <= 1e-13 * rows[0] * rows[1])
  {
    this->Search(cell, ray, hits);
    return;
  }
  const double inverse = 1.0 / det;
  const Vec2 step(inverse * (d * x - b * y), inverse * (a * y - c * x));
  // The same for the normal: how far along the surface a point moves that is off the tangent plane.
  const Vec3 normal = cell.D[0].cross(cell.D[1]);
  const double nx = ray.Normal[0].dot(normal);
  const double ny = ray.Normal[1].dot(normal);
  const Vec2 slope(inverse * (d * nx - b * ny), inverse * (a * ny - c * nx));
  // Bounds on 1 - Y Dg over the cell: Y Dg in the tangent frame. Krawczyk's test.
  Eigen::Matrix2d bound;
  for (int k = 0; k < 2; ++k)
  {
    for (int e = 0; e < 2; ++e)
    {
      bound(k, e) = double(cell.Along[k][e]) + std::abs(slope[k]) * cell.Across[e];
    }
    const double reach = 0.5 * (bound(k, 0) + bound(k, 1));
    if (std::abs(step[k]) > 0.5 + 1e-9 + reach + rows[k] * std::abs(inverse) * this->Rounding)
    {
      return;
    }
  }
  RootPiece root;
  root.Factor = ContractionFactor(bound, root.Unit);
  if (root.Factor >= MaxFactor)
  {
    this->Search(cell, ray, hits);
    return;
  }
  root.Chord << d, -b, -c, a;
  root.Chord *= inverse;
  root.IsCartesian = true;
  for (int k = 0; k < 2; ++k)
  {
    root.Piece.Low[k] = cell.Low[k];
    root.Piece.High[k] = cell.High[k];
    const double length = double(cell.High[k]) - cell.Low[k];
    root.Chord.row(k) *= length;
    root.Unit[k] *= length;
    root.Start[k] = cell.Low[k] + (0.5 - step[k]) * length;
  }
  this->Polish(cell, ray, root, hits);
}

/// The cells that the linear test can't decide: poles, and what is seen at a grazing angle.
void PatchRays::Search(const Cell& cell, const RayPlanes& ray, std::vector<PatchHit>& hits) const
{
  const Patch& patch = this->Patches[cell.Patch];
  PatchPiece piece;
  for (int k = 0; k < 2; ++k)
  {
    piece.Low[k] = cell.Low[k];
    piece.High[k] = cell.High[k];
  }
  PieceSearch search(this->Points.data() + patch.First, patch.Degree[0], patch.Degree[1],
    ray.Homogeneous, this->Rounding);
  for (const RootPiece& root : search.Run(piece))
  {
    if (root.Isolated)
    {
      this->Polish(cell, ray, root, hits);
    }
    else
    {
      this->Touch(cell, ray, root.Piece, hits);
    }
  }
}

PatchPoint PatchRays::Evaluate(std::int32_t index, const Vec2& at) const
{
  const Patch& patch = this->Patches[index];
  PatchPoint point;
  EvaluatePatch(
    this->Points.data() + patch.First, patch.Degree[0], patch.Degree[1], at[0], at[1], point);
  return point;
}

namespace
{

/// g and, as columns, its derivatives.
void Project(
  const PatchPoint& point, const RayPlanes& ray, Vec2& value, Eigen::Matrix2d& derivative)
{
  for (int k = 0; k < 2; ++k)
  {
    value[k] = ray.Homogeneous[k].dot(point.H);
    derivative(k, 0) = ray.Homogeneous[k].dot(point.D[0]);
    derivative(k, 1) = ray.Homogeneous[k].dot(point.D[1]);
  }
}

Vec2 Clamp(const Vec2& at, const PatchPiece& piece, const Vec2& slack)
{
  return Vec2(std::max(piece.Low[0] - slack[0], std::min(at[0], piece.High[0] + slack[0])),
    std::max(piece.Low[1] - slack[1], std::min(at[1], piece.High[1] + slack[1])));
}

/// True if a root in the piece would be too far from at - chord: where s - Chord g(s) contracts by
/// the factor f, the root is within f / (1 - f) of its step.
bool IsOutside(const RootPiece& root, const Vec2& slack, const Vec2& at, const Vec2& chord)
{
  const double reach = 1.01 * root.Factor / (1.0 - root.Factor) *
    std::max(std::abs(chord[0]) / root.Unit[0], std::abs(chord[1]) / root.Unit[1]);
  for (int k = 0; k < 2; ++k)
  {
    const double next = at[k] - chord[k];
    const double off =
      std::max(root.Piece.Low[k] - slack[k] - next, next - root.Piece.High[k] - slack[k]);
    if (off > reach * root.Unit[k])
    {
      return true;
    }
  }
  return false;
}

} // namespace

/// Newton's method within a piece that has one root at most; where it does not get on, the
/// iteration with a constant matrix, which contracts.
void PatchRays::Polish(
  const Cell& cell, const RayPlanes& ray, const RootPiece& root, std::vector<PatchHit>& hits) const
{
  constexpr int newtonSteps = 6;
  constexpr int maxSteps = 64;
  const Vec2 noise(
    root.Chord.row(0).norm() * this->Rounding, root.Chord.row(1).norm() * this->Rounding);
  const Vec2 slack(std::min(1e-3, Overlap + noise[0]), std::min(1e-3, Overlap + noise[1]));
  Vec2 at = Clamp(root.Start, root.Piece, slack);
  for (int step = 0; step < maxSteps; ++step)
  {
    const PatchPoint point = this->Evaluate(cell.Patch, at);
    Vec2 value;
    Eigen::Matrix2d derivative;
    Project(point, ray, value, derivative);
    const Vec2 chord = root.Chord * (root.IsCartesian ? Vec2(value / point.H[3]) : value);
    if (IsOutside(root, slack, at, chord))
    {
      return;
    }
    const double det = derivative.determinant();
    const bool newton = step < newtonSteps &&
      std::abs(det) > 1e-14 * derivative.col(0).norm() * derivative.col(1).norm();
    const Vec2 move = newton ? Vec2(Vec2(derivative(1, 1) * value[0] - derivative(0, 1) * value[1],
                                      derivative(0, 0) * value[1] - derivative(1, 0) * value[0]) *
                                 (1.0 / det))
                             : chord;
    const double enough = newton ? NewtonEnd : ChordEnd;
    if (std::abs(move[0]) <= enough + noise[0] && std::abs(move[1]) <= enough + noise[1])
    {
      if (Clamp(at - move, root.Piece, slack) == Vec2(at - move))
      {
        this->AddHit(cell, at - move, false, hits);
      }
      return;
    }
    const Vec2 last = at;
    at = Clamp(at - move, root.Piece, slack);
    if ((at - last).cwiseAbs().maxCoeff() < 1e-16)
    {
      return; // pushed against the border: the root is outside
    }
  }
}

/// A piece whose control points all lie within rounding of a plane through the ray. If it is small,
/// it holds a pole, or the ray touches the surface there: the point next to the ray by the damped
/// Gauss-Newton method. If it is not, the ray runs within the surface.
void PatchRays::Touch(const Cell& cell, const RayPlanes& ray, const PatchPiece& piece,
  std::vector<PatchHit>& hits) const
{
  Box3 box;
  for (int i = 0; i < 9; ++i)
  {
    const Vec2 part(0.5 * (i % 3), 0.5 * (i / 3));
    const Vec2 low(piece.Low[0], piece.Low[1]), high(piece.High[0], piece.High[1]);
    const Vec4 h = this->Evaluate(cell.Patch, low + part.cwiseProduct(high - low)).H;
    box.extend(h.head<3>() / h[3]);
  }
  if (box.diagonal().norm() > TouchSize * this->Size)
  {
    return;
  }
  const Vec2 slack(piece.High[0] - piece.Low[0], piece.High[1] - piece.Low[1]);
  Vec2 at(0.5 * (piece.Low[0] + piece.High[0]), 0.5 * (piece.Low[1] + piece.High[1]));
  for (int step = 0; step < 10; ++step)
  {
    Vec2 value;
    Eigen::Matrix2d derivative;
    Project(this->Evaluate(cell.Patch, at), ray, value, derivative);
    Eigen::Matrix2d square = derivative.transpose() * derivative;
    square.diagonal().array() += 1e-14 * square.trace() + std::numeric_limits<double>::min();
    at = Clamp(at - square.inverse() * derivative.transpose() * value, piece, slack);
    at = at.cwiseMax(0.0).cwiseMin(1.0);
  }
  const PatchPoint point = this->Evaluate(cell.Patch, at);
  const Vec2 value(ray.Homogeneous[0].dot(point.H), ray.Homogeneous[1].dot(point.H));
  if (value.norm() <= 10.0 * this->Rounding * point.H[3])
  {
    this->AddHit(cell, at, true, hits);
  }
}

void PatchRays::AddHit(
  const Cell& cell, const Vec2& found, bool singular, std::vector<PatchHit>& hits) const
{
  const Patch& patch = this->Patches[cell.Patch];
  const Vec2 at = found.cwiseMax(0.0).cwiseMin(1.0);
  const PatchPoint point = this->Evaluate(cell.Patch, at);
  PatchHit hit;
  hit.Patch = cell.Patch;
  hit.IsInside = cell.IsWhole;
  hit.Singular = singular;
  hit.Point = point.H.head<3>() / point.H[3];
  for (int k = 0; k < 2; ++k)
  {
    const Interval& domain = patch.Domain[k];
    hit.UV[k] = domain.Clamp(domain.Min + at[k] * domain.Length());
    (k == 0 ? hit.Su : hit.Sv) =
      (point.D[k].head<3>() - point.D[k][3] * hit.Point) / (point.H[3] * domain.Length());
  }
  hits.push_back(hit);
}

} // namespace nurbs
