// SPDX-License-Identifier: BSD-3-Clause
#include "LineTruth.h"

#include <algorithm>
#include <cmath>

namespace verify
{

namespace
{

using nurbs::Vec3;

/// What is in front of a point on one side of its line.
enum class Front
{
  Free,      ///< Nothing.
  Connected, ///< A surface that comes near the point.
  Blocked,   ///< A surface that does not.
  Unsure
};

Front Classify(double farGap, double nearGap, double middleGap, double limit)
{
  if (nearGap <= limit)
  {
    return Front::Free;
  }
  if (farGap <= limit)
  {
    return Front::Unsure;
  }
  // The side of a silhouette comes nearer with the square root of the distance (a half), a plane with
  // the distance itself (a quarter). Lines beside the contour make it 0.56 at most, and the gap of the
  // point itself half of the near one.
  const double ratio = nearGap / farGap;
  if (ratio < 0.57 && middleGap <= std::max(limit, 0.5 * nearGap))
  {
    return Front::Connected;
  }
  return ratio > 0.8 ? Front::Blocked : Front::Unsure;
}

} // namespace

LineTruth::LineTruth(const nurbs::RayCaster& caster, const Vec3& view, double tolerance)
  : Caster(caster)
  , View(view.normalized())
  , Tolerance(tolerance)
{
  const nurbs::Box3& box = caster.Bounds();
  this->Far = -std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner)
  {
    const Vec3 p = box.corner(static_cast<nurbs::Box3::CornerType>(corner));
    this->Far = std::max(this->Far, p.dot(this->View));
  }
  this->Far += 0.1 * box.diagonal().norm();
}

LineTruth::Foremost LineTruth::Look(const Vec3& place, double depth, double limit) const
{
  nurbs::Ray ray;
  ray.Origin = place + (this->Far - place.dot(this->View)) * this->View;
  ray.Direction = -this->View;
  nurbs::RayHit hit;
  if (!this->Caster.Nearest(ray, hit))
  {
    return { -std::numeric_limits<double>::infinity(), true };
  }
  const double gap = this->Far - hit.T - depth;
  if (std::abs(gap) > limit)
  {
    return { gap, true };
  }
  ray.Min = this->Far - depth - limit;
  ray.Max = this->Far - depth + limit;
  std::vector<nurbs::RayHit> hits;
  this->Caster.All(ray, hits);
  return { gap, hits.size() < 2 };
}

Truth LineTruth::At(const Vec3& point, const Vec3& tangent, double tolerance) const
{
  const Vec3 across = this->View.cross(tangent);
  if (!(across.norm() > 1e-6 * tangent.norm()))
  {
    return Truth::Undecided; // Seen end on.
  }
  const Vec3 side = across.normalized();
  const double depth = point.dot(this->View), limit = 10.0 * tolerance;
  const Foremost middle = this->Look(point, depth, limit);
  int blocked = 0, connected = 0;
  bool alone = true;
  for (const double sign : { -1.0, 1.0 })
  {
    const Foremost far = this->Look(point + sign * 16.0 * tolerance * side, depth, limit);
    const Foremost near = this->Look(point + sign * 4.0 * tolerance * side, depth, limit);
    const Front front = Classify(far.Gap, near.Gap, middle.Gap, limit);
    alone = alone && near.IsAlone;
    if (front == Front::Unsure)
    {
      return Truth::Undecided;
    }
    blocked += front == Front::Blocked ? 1 : 0;
    connected += front == Front::Connected ? 1 : 0;
  }
  if (blocked == 0)
  {
    if (connected == 0 && middle.Gap > limit)
    {
      return Truth::Undecided; // Under a corner of what hides it, past which the rays ran.
    }
    return alone && middle.IsAlone ? Truth::Visible : Truth::Foremost;
  }
  return blocked == 2 ? Truth::Hidden : Truth::Undecided;
}

void LineTruth::Judge(
  const std::vector<Vec3>& line, bool isVisible, double step, LineLengths& lengths) const
{
  for (std::size_t k = 0; k + 1 < line.size(); ++k)
  {
    const Vec3 chord = line[k + 1] - line[k];
    const double length = this->View.cross(chord).norm();
    if (!(length > 0.0))
    {
      continue;
    }
    const int parts = std::max(1, static_cast<int>(std::ceil(length / step)));
    (isVisible ? lengths.Visible : lengths.Hidden) += length;
    for (int i = 0; i < parts; ++i)
    {
      const Vec3 point = line[k] + (i + 0.5) / parts * chord;
      Truth truth = this->At(point, chord);
      for (const double factor : { 0.25, 4.0 })
      {
        if (!isVisible && truth == Truth::Visible)
        {
          truth = this->At(point, chord, factor * this->Tolerance);
          truth = truth == Truth::Visible ? truth : Truth::Undecided;
        }
      }
      if (truth == Truth::Undecided || (truth == Truth::Foremost && !isVisible))
      {
        lengths.Undecided += length / parts;
      }
      else if ((truth == Truth::Hidden) == isVisible)
      {
        (isVisible ? lengths.WrongVisible : lengths.WrongHidden) += length / parts;
        lengths.WrongPoints.push_back(point);
      }
    }
  }
}

} // namespace verify
