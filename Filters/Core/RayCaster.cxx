// SPDX-License-Identifier: BSD-3-Clause
#include "RayCaster.h"

#include "Model.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

/// Hits that are one differ by less than this part of the model, beyond the edges' tolerance.
constexpr double SamePart = 1e-9;
/// Hits that touch are known less well.
constexpr double SameTouchPart = 1e-6;
/// A cross product of derivatives under this part of their lengths' product gives no normal.
constexpr double SafeSine = 1e-6;

double LargestTolerance(const Model& model, const Face& face)
{
  double tolerance = 0.0;
  for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
  {
    const TrimLoop& loop = model.Loops[l];
    for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
    {
      const std::int64_t edge = model.TrimCurves[c].Edge;
      tolerance = edge >= 0 ? std::max(tolerance, model.Edges[edge].Tolerance) : tolerance;
    }
  }
  return tolerance;
}

} // namespace

/// A ray with its origin moved to where it is next to the model's middle, and t a length from there:
/// numbers are as small as they can be, however far the ray comes from.
struct RayCaster::Cast
{
  double Speed; ///< Length of the ray's direction.
  double Shift; ///< Length from the ray's origin to that of Planes.
  RayPlanes Planes;
  double Min, Max; ///< The range as lengths from there.

  Cast(const Ray& ray, const Box3& box)
    : Speed(ray.Direction.norm())
    , Shift((box.center() - ray.Origin).dot(ray.Direction) / this->Speed)
    , Planes(ray.Origin + this->Shift / this->Speed * ray.Direction, ray.Direction)
    , Min(ray.Min * this->Speed - this->Shift)
    , Max(ray.Max * this->Speed - this->Shift)
  {}
  double Length(const Vec3& point) const
  {
    return (point - this->Planes.Origin).dot(this->Planes.Direction);
  }
};

RayCaster::RayCaster(const Model& model, const ParallelFor& parallel)
  : Source(&model)
  , Trims(model, parallel)
{
  this->Surfaces.Build(model, parallel);
  // Where a box is flat, rounding must not lose it.
  this->Tree.Build(this->Surfaces.Boxes(), 4.0 * this->Surfaces.GetRounding());
  this->Surfaces.ReleaseBoxes();
  this->Tolerance.reserve(model.Faces.size());
  for (const Face& face : model.Faces)
  {
    this->Tolerance.push_back(LargestTolerance(model, face));
  }
}

std::size_t RayCaster::MemoryUse() const
{
  return this->Surfaces.MemoryUse() + this->Tree.MemoryUse() +
    this->Tolerance.capacity() * sizeof(double);
}

/// Whether the face has material at the hit, or within twice its edges' tolerance of it.
bool RayCaster::IsInside(const PatchHit& hit) const
{
  const std::int64_t face = this->Surfaces.FaceOf(hit.Patch);
  const FaceTrim& trim = this->Trims.Face(face);
  if (trim.Inside(hit.UV[0], hit.UV[1]))
  {
    return true;
  }
  const double reach =
    2.0 * this->Tolerance[face] + SamePart * 1e-2 * this->Surfaces.Bounds().diagonal().norm();
  const double tiny = std::numeric_limits<double>::min();
  const double du = reach / std::max(hit.Su.norm(), tiny);
  const double dv = reach / std::max(hit.Sv.norm(), tiny);
  for (int k = 0; k < 8; ++k)
  {
    const double angle = k * 0.78539816339744831;
    if (trim.Inside(hit.UV[0] + du * std::cos(angle), hit.UV[1] + dv * std::sin(angle)))
    {
      return true;
    }
  }
  return false;
}

void RayCaster::Finish(const Cast& cast, const PatchHit& hit, RayHit& out) const
{
  out.Face = this->Surfaces.FaceOf(hit.Patch);
  out.U = hit.UV[0];
  out.V = hit.UV[1];
  out.Point = hit.Point;
  out.T = (cast.Length(hit.Point) + cast.Shift) / cast.Speed;
  const Face& face = this->Source->Faces[out.Face];
  const Vec3 cross = hit.Su.cross(hit.Sv);
  const double length = cross.norm();
  out.Normal = length > SafeSine * hit.Su.norm() * hit.Sv.norm() && !hit.Singular
    ? Vec3(cross / length)
    : Normal(face.Geometry, out.U, out.V);
  out.Normal = face.Reversed ? Vec3(-out.Normal) : out.Normal;
  const double cosine = out.Normal.dot(cast.Planes.Direction);
  const bool touches = hit.Singular && std::abs(cosine) < 1e-4;
  out.Crossing = touches || cosine == 0.0 ? 0 : (cosine < 0.0 ? 1 : -1);
}

/// Calls `found(hit, t)` for the hits in the range, which may shorten it by tMax. May give a hit more
/// than once.
template <typename Found>
void RayCaster::Walk(const Cast& cast, double& tMax, const Found& found) const
{
  const Vec3& origin = cast.Planes.Origin;
  const Vec3& direction = cast.Planes.Direction;
  if (!origin.allFinite() || !direction.allFinite() || std::isnan(cast.Min) || std::isnan(cast.Max))
  {
    throw Error("RayCaster: the ray has no direction, or a number that is not finite");
  }
  std::vector<PatchHit> hits;
  this->Tree.Walk(BoxRay(origin, direction), cast.Min, tMax, [&](std::int32_t cell) {
    hits.clear();
    this->Surfaces.Intersect(cell, cast.Planes, hits);
    for (const PatchHit& hit : hits)
    {
      const double t = cast.Length(hit.Point);
      if (t >= cast.Min && t <= tMax && this->IsInside(hit))
      {
        found(hit, t);
      }
    }
    return tMax;
  });
}

bool RayCaster::Nearest(const Ray& ray, RayHit& hit) const
{
  const Cast cast(ray, this->Bounds());
  double tMax = cast.Max;
  bool any = false;
  PatchHit nearest;
  this->Walk(cast, tMax, [&](const PatchHit& found, double t) {
    nearest = found;
    any = true;
    tMax = t;
  });
  if (any)
  {
    this->Finish(cast, nearest, hit);
  }
  return any;
}

bool RayCaster::IsBlocked(const Ray& ray) const
{
  const Cast cast(ray, this->Bounds());
  double tMax = cast.Max;
  bool any = false;
  this->Walk(cast, tMax, [&](const PatchHit&, double) {
    any = true;
    tMax = -std::numeric_limits<double>::infinity();
  });
  return any;
}

void RayCaster::All(const Ray& ray, std::vector<RayHit>& hits) const
{
  const Cast cast(ray, this->Bounds());
  double tMax = cast.Max;
  hits.clear();
  this->Walk(cast, tMax, [&](const PatchHit& found, double) {
    hits.emplace_back();
    this->Finish(cast, found, hits.back());
  });
  std::sort(hits.begin(), hits.end(),
    [](const RayHit& a, const RayHit& b) { return a.T != b.T ? a.T < b.T : a.Face < b.Face; });
  this->Merge(hits, cast.Planes.Direction);
}

/// How far apart two hits of one crossing may be.
double RayCaster::Spread(const RayHit& a, const RayHit& b, const Vec3& direction) const
{
  const double cosine =
    std::min(std::abs(a.Normal.dot(direction)), std::abs(b.Normal.dot(direction)));
  return SamePart * this->Bounds().diagonal().norm() +
    4.0 * (this->Tolerance[a.Face] + this->Tolerance[b.Face]) / std::max(cosine, 1e-3) +
    16.0 * this->Surfaces.GetRounding() / std::max(cosine, 1e-8);
}

/// Leaves one hit of those that are at one place and cross in one direction. Two that remain there
/// cross in opposite directions: in the order that goes on from the hit before.
void RayCaster::Merge(std::vector<RayHit>& hits, const Vec3& direction) const
{
  const double touchSpread = SameTouchPart * this->Bounds().diagonal().norm();
  std::vector<RayHit> kept;
  for (const RayHit& hit : hits)
  {
    bool repeated = false;
    for (auto other = kept.rbegin(); other != kept.rend() && !repeated; ++other)
    {
      const double distance = (hit.Point - other->Point).norm();
      const double spread = this->Spread(hit, *other, direction);
      if (distance > std::max(touchSpread, spread))
      {
        break;
      }
      const bool touches = hit.Crossing == 0 || other->Crossing == 0;
      repeated = touches || (hit.Crossing == other->Crossing && distance <= spread);
      if (repeated && other->Crossing == 0)
      {
        *other = hit; // a crossing tells more
      }
    }
    if (!repeated)
    {
      kept.push_back(hit);
    }
  }
  int last = -1;
  for (std::size_t i = 0; i < kept.size(); ++i)
  {
    if (i + 1 < kept.size() && kept[i].Crossing == last && kept[i + 1].Crossing == -last &&
      (kept[i + 1].Point - kept[i].Point).norm() <= this->Spread(kept[i], kept[i + 1], direction))
    {
      std::swap(kept[i], kept[i + 1]);
    }
    last = kept[i].Crossing != 0 ? kept[i].Crossing : last;
  }
  hits.swap(kept);
}

} // namespace nurbs
