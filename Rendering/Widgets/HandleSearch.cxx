// SPDX-License-Identifier: BSD-3-Clause
#include "HandleSearch.h"

#include <Eigen/LU>

#include <algorithm>
#include <mutex>

namespace nurbs
{

namespace
{

constexpr std::int64_t SerialPoints = 20000; // Fewer are not worth a second thread.

} // namespace

bool ScreenView::Project(const Vec3& point, Vec3& display) const
{
  const Vec4 clip = this->WorldToClip * point.homogeneous();
  if (!(clip[3] > 0.0) || !(std::abs(clip[2]) <= clip[3]))
  {
    return false;
  }
  display[0] = this->Origin[0] + this->Size[0] * 0.5 * (clip[0] / clip[3] + 1.0);
  display[1] = this->Origin[1] + this->Size[1] * 0.5 * (clip[1] / clip[3] + 1.0);
  display[2] = clip[2] / clip[3];
  return true;
}

Vec3 ScreenView::Unproject(const Vec3& display) const
{
  const Vec2 normalized =
    2.0 * (display.head<2>() - this->Origin).cwiseQuotient(this->Size) - Vec2::Ones();
  const Vec4 world =
    this->WorldToClip.fullPivLu().solve(Vec4(normalized[0], normalized[1], display[2], 1.0));
  return world.head<3>() / world[3];
}

Vec3 ScreenView::Sight(const Vec2& display) const
{
  const Vec3 near = this->Unproject(Vec3(display[0], display[1], -1.0));
  return (this->Unproject(Vec3(display[0], display[1], 1.0)) - near).normalized();
}

double ScreenView::DepthInFront(const Vec3& display, double pixels) const
{
  const Vec3 point = this->Unproject(display);
  const double size =
    (this->Unproject(display + Vec3(pixels, 0.0, 0.0)) - this->Unproject(display)).norm();
  Vec3 moved;
  return this->Project(point - size * this->Sight(display.head<2>()), moved) ? moved[2] : -1.0;
}

std::vector<HandleHit> FindHandles(const ScreenView& view, const double* xyz,
  const std::vector<std::int64_t>& points, const Vec2& cursor, double radius,
  const ParallelFor& parallel)
{
  std::vector<HandleHit> hits;
  std::mutex guard;
  const auto search = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k)
    {
      HandleHit hit;
      hit.Point = points[k];
      if (!view.Project(Eigen::Map<const Vec3>(xyz + 3 * hit.Point), hit.Display))
      {
        continue;
      }
      hit.Distance = (hit.Display.head<2>() - cursor).norm();
      if (hit.Distance <= radius)
      {
        const std::lock_guard<std::mutex> lock(guard);
        hits.push_back(hit);
      }
    }
  };
  const auto count = std::int64_t(points.size());
  (count < SerialPoints ? ParallelFor(SerialFor) : parallel)(0, count, search);
  std::sort(hits.begin(), hits.end(), [](const HandleHit& a, const HandleHit& b) {
    return std::make_pair(a.Distance, a.Point) < std::make_pair(b.Distance, b.Point);
  });
  return hits;
}

std::vector<std::int64_t> FindHandlesInBox(const ScreenView& view, const double* xyz,
  const std::vector<std::int64_t>& points, const Box2& box)
{
  std::vector<std::int64_t> found;
  for (const std::int64_t point : points)
  {
    Vec3 display;
    if (view.Project(Eigen::Map<const Vec3>(xyz + 3 * point), display) &&
      box.contains(Vec2(display.head<2>())))
    {
      found.push_back(point);
    }
  }
  return found;
}

HandleHit ChooseHandle(
  const std::vector<HandleHit>& hits, const std::vector<bool>& hidden, double slack)
{
  const bool allHidden = std::find(hidden.begin(), hidden.end(), false) == hidden.end();
  HandleHit best;
  double limit = 0.0;
  for (std::size_t k = 0; k < hits.size(); ++k)
  {
    if (!allHidden && hidden[k])
    {
      continue;
    }
    if (best.Point < 0)
    {
      limit = hits[k].Distance + slack;
      best = hits[k];
    }
    else if (hits[k].Distance <= limit && hits[k].Display[2] < best.Display[2])
    {
      best = hits[k];
    }
  }
  return best;
}

double NearestOnLine(
  const ScreenView& view, const Vec2& display, const Vec3& start, const Vec3& direction)
{
  constexpr double parallel = 1e-6; // Square of the sine of the angle.
  const Vec3 sight = view.Sight(display);
  const Vec3 offset = start - view.Unproject(Vec3(display[0], display[1], -1.0));
  const double cosine = direction.dot(sight);
  const double square = 1.0 - cosine * cosine;
  return square < parallel ? 0.0 : (cosine * sight.dot(offset) - direction.dot(offset)) / square;
}

} // namespace nurbs
