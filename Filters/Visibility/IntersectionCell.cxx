// SPDX-License-Identifier: BSD-3-Clause
#include "IntersectionCell.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

const double Pi = std::acos(-1.0);

// Steps of the search for a separating plane.
constexpr int MaxPlaneSteps = 8;
// Vectors shorter than that share of the longest are none: at poles.
constexpr double TinyShare = 1e-9;
// Of arc cosines near 1.
constexpr double AngleRounding = 1e-7;
// Cones of an arc and a cell, together: as far as the first linear step is good.
constexpr double WidestArcCones = 0.4;
constexpr double ConesOfSlope = 0.6;

// Directions of all vectors that differ from a positive combination of the given ones by less than
// `ball` a vector.
DirectionCone ConeOf(const std::vector<Vec3>& vectors, double ball)
{
  DirectionCone out;
  double longest = 0.0;
  Vec3 sum = Vec3::Zero();
  for (const Vec3& v : vectors)
  {
    longest = std::max(longest, v.norm());
    sum += v;
  }
  const double length = sum.norm();
  if (!(length > TinyShare * longest))
  {
    return out;
  }
  out.Axis = sum / length;
  double cosine = 1.0;
  double shortest = longest;
  for (const Vec3& v : vectors)
  {
    const double norm = v.norm();
    if (norm > TinyShare * longest || ball > TinyShare * longest)
    {
      shortest = std::min(shortest, norm);
      cosine = std::min(cosine, out.Axis.dot(v) / std::max(norm, 1e-300));
    }
  }
  if (ball < shortest)
  {
    out.Angle = std::acos(std::max(cosine, -1.0)) + std::asin(ball / shortest) + AngleRounding;
  }
  return out;
}

// The differences of homogeneous points along one direction, as vectors in space around `middle`:
// S_u w is H_u - S w_u, so what the weights add is within the largest |S - middle| times their
// difference.
DirectionCone ConeOfDifferences(const std::vector<Vec4>& points, int step, int count, int rows,
  int rowStep, const Vec3& middle, double radius)
{
  std::vector<Vec3> vectors;
  double ball = 0.0;
  for (int r = 0; r < rows; ++r)
  {
    for (int k = 0; k + 1 < count; ++k)
    {
      const Vec4 d = points[r * rowStep + (k + 1) * step] - points[r * rowStep + k * step];
      vectors.push_back(d.head<3>() - d[3] * middle);
      ball = std::max(ball, radius * std::abs(d[3]));
    }
  }
  return ConeOf(vectors, ball);
}

// Sederberg, Meyers 1988: the normals of a patch whose derivatives have directions in two cones.
DirectionCone NormalCone(const DirectionCone& u, const DirectionCone& v)
{
  DirectionCone out;
  if (!u.IsKnown() || !v.IsKnown())
  {
    return out;
  }
  const Vec3 cross = u.Axis.cross(v.Axis);
  const double sine = cross.norm();
  const double cosine = std::abs(u.Axis.dot(v.Axis));
  const double between = std::atan2(sine, cosine);
  if (u.Angle + v.Angle >= 0.999 * between)
  {
    return out;
  }
  const double a = std::sin(u.Angle);
  const double b = std::sin(v.Angle);
  const double s = std::sqrt(a * a + 2.0 * a * b * cosine + b * b) / sine;
  if (s < 1.0)
  {
    out.Axis = cross / sine;
    out.Angle = std::asin(s);
  }
  return out;
}

Box3 BoxOf(const std::vector<Vec3>& hull)
{
  Box3 box;
  for (const Vec3& p : hull)
  {
    box.extend(p);
  }
  return box;
}

std::vector<Vec3> HullOf(const std::vector<Vec4>& points)
{
  std::vector<Vec3> hull;
  hull.reserve(points.size());
  for (const Vec4& h : points)
  {
    hull.push_back(h.head<3>() / h[3]);
  }
  return hull;
}

Interval Along(const std::vector<Vec3>& hull, const Vec3& axis)
{
  Interval out{ 1e300, -1e300 };
  for (const Vec3& p : hull)
  {
    const double d = axis.dot(p);
    out.Min = std::min(out.Min, d);
    out.Max = std::max(out.Max, d);
  }
  return out;
}

// Which sides of a cell, as bits 2 dir + end, have all control points that are not below `least`
// along the axis.
int SidesAbove(const IntersectionCell& cell, const Vec3& axis, double least)
{
  const int m = cell.Patch.Degree[0] + 1;
  const int n = cell.Patch.Degree[1] + 1;
  int sides = 15;
  for (int k = 0; k < m * n; ++k)
  {
    if (axis.dot(cell.Hull[k]) >= least)
    {
      const int i = k % m;
      const int j = k / m;
      sides &= (i == 0 ? 1 : 0) | (i == m - 1 ? 2 : 0) | (j == 0 ? 4 : 0) | (j == n - 1 ? 8 : 0);
    }
  }
  return sides;
}

// What it means that cell a ends at `last` along an axis and cell b begins at `first`, which is
// less by `tolerance` at most.
CellMeeting Touch(const IntersectionCell& a, const IntersectionCell& b, const Vec3& axis,
  double last, double first, double tolerance)
{
  const double rounding = 1e-13 * (std::abs(last) + std::abs(first));
  if (last - first < -rounding)
  {
    return CellMeeting::Apart;
  }
  const IntersectionCell* cells[2] = { &a, &b };
  bool goesOn = false;
  for (int c = 0; c < 2; ++c)
  {
    const Vec3 outward = c == 0 ? axis : Vec3(-axis);
    const double level = c == 0 ? first - tolerance - rounding : -(last + tolerance + rounding);
    const int sides = SidesAbove(*cells[c], outward, level);
    for (int k = 0; k < 4; ++k)
    {
      if (sides >> k & 1)
      {
        if (cells[c]->IsOuter[k / 2][k % 2])
        {
          return CellMeeting::Apart;
        }
        goesOn = true;
      }
    }
  }
  return goesOn ? CellMeeting::Touching : CellMeeting::Apart;
}

// Looks for a plane between two hulls by mirroring its normal at the vector between the points that
// overlap most (Chung, Wang, "Quick collision detection of polytopes in virtual environments",
// 1996). Zero: there may be none.
Vec3 FindPlane(const std::vector<Vec3>& a, const std::vector<Vec3>& b, Vec3 axis, double tolerance)
{
  for (int k = 0; k < MaxPlaneSteps; ++k)
  {
    const double length = axis.norm();
    if (!(length > 0.0))
    {
      break;
    }
    axis /= length;
    const auto before = [&](const Vec3& p, const Vec3& q) { return axis.dot(p) < axis.dot(q); };
    const Vec3& last = *std::max_element(a.begin(), a.end(), before);
    const Vec3& first = *std::min_element(b.begin(), b.end(), before);
    const Vec3 gap = first - last;
    if (axis.dot(gap) >= -tolerance)
    {
      return axis;
    }
    const Vec3 r = gap.normalized();
    axis -= 2.0 * r.dot(axis) * r;
  }
  return Vec3::Zero();
}

} // namespace

IntersectionArc::IntersectionArc(std::vector<Vec4> points, const Interval& range)
  : Points(std::move(points))
  , Range(range)
  , Hull(HullOf(this->Points))
  , Box(BoxOf(this->Hull))
{
  for (std::size_t k = 1; k < this->Hull.size(); ++k)
  {
    this->Size += (this->Hull[k] - this->Hull[k - 1]).norm();
  }
  this->Tangents = ConeOfDifferences(this->Points, 1, int(this->Points.size()), 1, 0,
    this->Box.center(), 0.5 * this->Box.diagonal().norm());
}

Vec3 IntersectionArc::At(double t) const
{
  const Vec4 h = DeCasteljau<4>(this->Points.data(), int(this->Points.size()) - 1, t);
  return h.head<3>() / h[3];
}

std::array<IntersectionArc, 2> IntersectionArc::Halves() const
{
  std::vector<Vec4> low(this->Points.size());
  std::vector<Vec4> high(this->Points.size());
  SplitBezier<4>(this->Points.data(), int(this->Points.size()) - 1, 0.5, low.data(), high.data());
  const double middle = 0.5 * (this->Range.Min + this->Range.Max);
  return { IntersectionArc(std::move(low), { this->Range.Min, middle }),
    IntersectionArc(std::move(high), { middle, this->Range.Max }) };
}

IntersectionCell::IntersectionCell(BezierPatch patch)
  : Patch(std::move(patch))
  , Hull(HullOf(this->Patch.Points))
  , Box(BoxOf(this->Hull))
{
  const int m = this->Patch.Degree[0] + 1;
  const int n = this->Patch.Degree[1] + 1;
  const auto at = [&](int i, int j) -> const Vec3& { return this->Hull[i + j * m]; };
  for (int dir = 0; dir < 2; ++dir)
  {
    for (int r = 0; r < (dir == 0 ? n : m); ++r)
    {
      double length = 0.0;
      for (int k = 1; k < (dir == 0 ? m : n); ++k)
      {
        length += dir == 0 ? (at(k, r) - at(k - 1, r)).norm() : (at(r, k) - at(r, k - 1)).norm();
      }
      this->Size[dir] = std::max(this->Size[dir], length);
    }
  }
  const Vec3 corners[4] = { at(0, 0), at(m - 1, 0), at(m - 1, n - 1), at(0, n - 1) };
  const Vec3 inner[4] = { at(m / 2, 0), at(m - 1, n / 2), at(m / 2, n - 1), at(0, n / 2) };
  const Vec3 normal = (corners[2] - corners[0]).cross(corners[3] - corners[1]);
  this->Axes[0] = normal.stableNormalized();
  for (int k = 0; k < 4; ++k)
  {
    const Vec3 chord = corners[(k + 1) % 4] - corners[k];
    Vec3 axis = chord.cross(inner[k] - corners[k]);
    if (axis.norm() <= 1e-6 * chord.squaredNorm())
    {
      axis = chord.cross(this->Axes[0]);
    }
    this->Axes[k + 1] = axis.stableNormalized();
  }
  for (std::size_t k = 0; k < this->Axes.size(); ++k)
  {
    this->Extents[k] = Along(this->Hull, this->Axes[k]);
  }
}

const DirectionCone& IntersectionCell::GetNormals()
{
  if (!this->Normals)
  {
    const int m = this->Patch.Degree[0] + 1;
    const int n = this->Patch.Degree[1] + 1;
    const Vec3 middle = this->Box.center();
    const double radius = 0.5 * this->Box.diagonal().norm();
    this->Normals = NormalCone(ConeOfDifferences(this->Patch.Points, 1, m, n, m, middle, radius),
      ConeOfDifferences(this->Patch.Points, m, n, m, 1, middle, radius));
  }
  return *this->Normals;
}

std::array<IntersectionCell, 2>& IntersectionCell::Split()
{
  if (!this->Halves)
  {
    BezierPatch low;
    BezierPatch high;
    const int dir = this->Size[0] >= this->Size[1] ? 0 : 1;
    SplitBezierPatch(this->Patch, dir, 0.5, low, high);
    this->Halves.reset(new std::array<IntersectionCell, 2>{
      IntersectionCell(std::move(low)), IntersectionCell(std::move(high)) });
    for (int k = 0; k < 4; ++k)
    {
      for (int half = 0; half < 2; ++half)
      {
        const bool isCut = k / 2 == dir && k % 2 != half;
        (*this->Halves)[half].IsOuter[k / 2][k % 2] = !isCut && this->IsOuter[k / 2][k % 2];
      }
    }
  }
  return *this->Halves;
}

IntersectionArc IntersectionCell::Side(int dir, int end) const
{
  const int m = this->Patch.Degree[0] + 1;
  const int n = this->Patch.Degree[1] + 1;
  std::vector<Vec4> points;
  for (int k = 0; k < (dir == 0 ? n : m); ++k)
  {
    points.push_back(dir == 0 ? this->Patch.Points[(end == 0 ? 0 : m - 1) + k * m]
                              : this->Patch.Points[k + (end == 0 ? 0 : n - 1) * m]);
  }
  return IntersectionArc(std::move(points), dir == 0 ? this->Patch.V : this->Patch.U);
}

CellMeeting Meet(const IntersectionCell& a, const IntersectionCell& b, double tolerance)
{
  if (!a.Box.intersects(b.Box))
  {
    return CellMeeting::Apart;
  }
  CellMeeting out = CellMeeting::Unknown;
  // True if the extents along an axis tell that they are apart.
  const auto look = [&](const Vec3& axis, const Interval& ia, const Interval& ib) {
    const bool isBefore = ia.Max - ib.Min <= ib.Max - ia.Min;
    if (isBefore && ia.Max - ib.Min <= tolerance)
    {
      out = Touch(a, b, axis, ia.Max, ib.Min, tolerance);
    }
    else if (!isBefore && ib.Max - ia.Min <= tolerance)
    {
      out = Touch(a, b, -axis, -ia.Min, -ib.Max, tolerance);
    }
    return out == CellMeeting::Apart;
  };
  for (int k = 0; k < 3; ++k)
  {
    if (look(Vec3::Unit(k), { a.Box.min()[k], a.Box.max()[k] }, { b.Box.min()[k], b.Box.max()[k] }))
    {
      return out;
    }
  }
  for (std::size_t k = 0; k < a.Axes.size(); ++k)
  {
    if ((!a.Axes[k].isZero() && look(a.Axes[k], a.Extents[k], Along(b.Hull, a.Axes[k]))) ||
      (!b.Axes[k].isZero() && look(b.Axes[k], Along(a.Hull, b.Axes[k]), b.Extents[k])))
    {
      return out;
    }
  }
  if (out == CellMeeting::Unknown)
  {
    const Vec3 axis = FindPlane(a.Hull, b.Hull, b.Box.center() - a.Box.center(), tolerance);
    if (!axis.isZero())
    {
      out = Touch(a, b, axis, Along(a.Hull, axis).Max, Along(b.Hull, axis).Min, tolerance);
    }
  }
  return out;
}

bool AreApart(const IntersectionArc& arc, const IntersectionCell& cell)
{
  const double rounding = 1e-12 * (cell.Box.diagonal().norm() + cell.Box.center().norm());
  Box3 box = cell.Box;
  box.min().array() -= rounding;
  box.max().array() += rounding;
  if (!arc.Box.intersects(box))
  {
    return true;
  }
  const Interval extent = Along(arc.Hull, cell.Axes[0]);
  return extent.Min > cell.Extents[0].Max + rounding || extent.Max < cell.Extents[0].Min - rounding;
}

bool AreTransversal(IntersectionCell& a, IntersectionCell& b)
{
  const DirectionCone& na = a.GetNormals();
  const DirectionCone& nb = b.GetNormals();
  if (!na.IsKnown() || !nb.IsKnown())
  {
    return false;
  }
  const double angle = std::atan2(na.Axis.cross(nb.Axis).norm(), na.Axis.dot(nb.Axis));
  return na.Angle + nb.Angle < std::min(angle, Pi - angle);
}

bool IsTransversal(const IntersectionArc& arc, IntersectionCell& cell)
{
  const DirectionCone& normals = cell.GetNormals();
  if (!arc.Tangents.IsKnown() || !normals.IsKnown())
  {
    return false;
  }
  const double slope = std::asin(std::min(1.0, std::abs(arc.Tangents.Axis.dot(normals.Axis))));
  const double sum = arc.Tangents.Angle + normals.Angle;
  return sum < ConesOfSlope * slope && sum < WidestArcCones;
}

} // namespace nurbs
