// SPDX-License-Identifier: BSD-3-Clause
#include "RayCaster.h"

#include "CellTrees.h"
#include "Model.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

/// Hits that are one differ by less than this part of the model, beyond the edges' tolerance.
constexpr double SamePart = 1e-9;
/// An edge without a tolerance has this part of the model as one.
constexpr double EdgePart = 1e-11;
/// Hits that touch are known less well.
constexpr double SameTouchPart = 1e-6;
/// A cross product of derivatives under this part of their lengths' product gives no normal.
constexpr double SafeSine = 1e-6;

constexpr double Infinity = std::numeric_limits<double>::infinity();

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

/// A hit that may be one.
struct RayCaster::Candidate
{
  RayHit Hit;
  bool Sure = false; ///< It is: inside of its face, or in the gap between two.
};

/// A ray with its origin moved to where it is next to the model's middle, and t a length from
/// there: numbers are as small as they can be, however far the ray comes from.
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
  : RayCaster(model, Cutting::AtOnce, parallel)
{}

RayCaster::RayCaster(const Model& model, Cutting cutting, const ParallelFor& parallel)
  : Source(&model)
  , Trims(model, parallel)
{
  Box3 box;
  for (const Face& face : model.Faces)
  {
    this->Tolerance.push_back(LargestTolerance(model, face));
    for (std::int64_t k = 0; k < face.Geometry.Size(); ++k)
    {
      box.extend(face.Geometry.Point(k));
    }
  }
  const double least = box.isEmpty() ? 0.0 : EdgePart * box.diagonal().norm();
  for (const double tolerance : this->Tolerance)
  {
    this->Reach.push_back(2.0 * tolerance + least);
  }
  if (cutting == Cutting::AtOnce)
  {
    this->Surfaces.Build(model, this->Trims, this->Reach, parallel);
  }
  else
  {
    double size, rounding;
    PatchRays::Measure(model, size, rounding);
    const auto forest =
      std::make_shared<CellTrees>(model, this->Trims, this->Reach, size, rounding, parallel);
    this->Surfaces.Build(model, *forest);
    this->Forest = forest;
  }
  // Where a box is flat, rounding must not lose it.
  this->Tree.Build(this->Surfaces.Boxes(), 4.0 * this->Surfaces.GetRounding());
  this->Surfaces.ReleaseBoxes();
}

std::size_t RayCaster::MemoryUse() const
{
  return this->Surfaces.MemoryUse() + this->Tree.MemoryUse() +
    (this->Forest ? this->Forest->MemoryUse() : 0) +
    (this->Tolerance.capacity() + this->Reach.capacity()) * sizeof(double);
}

/// Whether the face has material at the hit, or else within twice its edges' tolerance of it.
RayCaster::Place RayCaster::Locate(const PatchHit& hit) const
{
  const std::int64_t face = this->Surfaces.FaceOf(hit.Patch);
  const FaceTrim& trim = this->Trims.Face(face);
  if (hit.IsInside || trim.Inside(hit.UV[0], hit.UV[1]))
  {
    return Place::Inside;
  }
  const double reach = this->Reach[face];
  const double tiny = std::numeric_limits<double>::min();
  const double du = reach / std::max(hit.Su.norm(), tiny);
  const double dv = reach / std::max(hit.Sv.norm(), tiny);
  constexpr double part = 0.70710678118654752;
  constexpr double around[8][2] = { { 1, 0 }, { -1, 0 }, { 0, 1 }, { 0, -1 }, { part, part },
    { part, -part }, { -part, part }, { -part, -part } };
  for (const double(&step)[2] : around)
  {
    if (trim.Inside(hit.UV[0] + step[0] * du, hit.UV[1] + step[1] * dv))
    {
      return Place::Beside;
    }
  }
  return Place::Outside;
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

/// Calls `found(hit, t, place)` for the hits in the range, which may shorten it by tMax. May give a
/// hit more than once.
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
  const auto look = [&](const PatchRays::Cell& cell) {
    hits.clear();
    this->Surfaces.Intersect(cell, cast.Planes, hits);
    for (const PatchHit& hit : hits)
    {
      const double t = cast.Length(hit.Point);
      const Place place = t >= cast.Min && t <= tMax ? this->Locate(hit) : Place::Outside;
      if (place != Place::Outside)
      {
        found(hit, t, place);
      }
    }
  };
  const BoxRay ray(origin, direction);
  this->Tree.Walk(ray, cast.Min, tMax, [&](std::int32_t part) {
    if (this->Forest)
    {
      this->Forest->Walk(part, ray, cast.Min, tMax, look);
    }
    else
    {
      look(this->Surfaces.CellAt(part));
    }
    return tMax;
  });
}

bool RayCaster::Nearest(const Ray& ray, RayHit& hit) const
{
  const Cast cast(ray, this->Bounds());
  // Of surfaces that lie on each other it is always the first, or else rounding would tell.
  const double same = SamePart * this->Bounds().diagonal().norm();
  double tMax = cast.Max;
  double tNearest = Infinity;
  Place place = Place::Outside;
  PatchHit nearest;
  this->Walk(cast, tMax, [&](const PatchHit& found, double t, Place where) {
    if (place == Place::Outside || t < tNearest - same || found.Patch < nearest.Patch)
    {
      nearest = found;
      place = where;
      tNearest = t;
      tMax = std::min(cast.Max, t + same);
    }
  });
  if (place == Place::Beside)
  {
    std::vector<RayHit> hits;
    this->All(ray, hits);
    if (!hits.empty())
    {
      hit = hits.front();
    }
    return !hits.empty();
  }
  if (place == Place::Inside)
  {
    this->Finish(cast, nearest, hit);
  }
  return place == Place::Inside;
}

bool RayCaster::IsBlocked(const Ray& ray) const
{
  const Cast cast(ray, this->Bounds());
  double tMax = cast.Max;
  bool inside = false;
  bool beside = false;
  this->Walk(cast, tMax, [&](const PatchHit&, double, Place where) {
    inside = inside || where == Place::Inside;
    beside = beside || where == Place::Beside;
    tMax = inside ? -Infinity : tMax;
  });
  RayHit hit;
  return inside || (beside && this->Nearest(ray, hit));
}

void RayCaster::All(const Ray& ray, std::vector<RayHit>& hits) const
{
  const Cast cast(ray, this->Bounds());
  std::vector<Candidate> found;
  bool beside = this->Gather(cast, found);
  if (beside && (ray.Min > -Infinity || ray.Max < Infinity))
  {
    // What is beside a face is judged by the hits before and after it, in the range or not.
    Ray line = ray;
    line.Min = -Infinity;
    line.Max = Infinity;
    this->Gather(Cast(line, this->Bounds()), found);
  }
  this->Merge(found, cast.Planes.Direction);
  if (beside)
  {
    KeepNeeded(found);
  }
  hits.clear();
  for (const Candidate& one : found)
  {
    if (one.Hit.T >= ray.Min && one.Hit.T <= ray.Max)
    {
      hits.push_back(one.Hit);
    }
  }
}

/// Replaces `found` by all hits in the range, sorted. Returns true if one lies beside its face.
bool RayCaster::Gather(const Cast& cast, std::vector<Candidate>& found) const
{
  found.clear();
  double tMax = cast.Max;
  bool beside = false;
  this->Walk(cast, tMax, [&](const PatchHit& hit, double, Place where) {
    found.emplace_back();
    this->Finish(cast, hit, found.back().Hit);
    found.back().Sure = where == Place::Inside;
    beside = beside || where == Place::Beside;
  });
  std::sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) {
    return a.Hit.T != b.Hit.T ? a.Hit.T < b.Hit.T : a.Hit.Face < b.Hit.Face;
  });
  return beside;
}

/// How far apart rounding may move two hits that are one.
double RayCaster::Noise(const RayHit& a, const RayHit& b, const Vec3& direction) const
{
  const double cosine =
    std::min(std::abs(a.Normal.dot(direction)), std::abs(b.Normal.dot(direction)));
  return SamePart * this->Bounds().diagonal().norm() +
    16.0 * this->Surfaces.GetRounding() / std::max(cosine, 1e-8);
}

/// How far apart two hits may be where two faces overlap, or leave a gap, within their tolerance.
double RayCaster::Spread(const RayHit& a, const RayHit& b, const Vec3& direction) const
{
  const double cosine =
    std::min(std::abs(a.Normal.dot(direction)), std::abs(b.Normal.dot(direction)));
  return this->Noise(a, b, direction) +
    4.0 * (this->Tolerance[a.Face] + this->Tolerance[b.Face]) / std::max(cosine, 0.1);
}

/// Leaves one hit of those that are at one place and cross in one direction. If they lie beside two
/// faces, the ray goes through the gap between these: the hit is sure. Two that remain at one place
/// cross in opposite directions: in the order that goes on from the hit before.
void RayCaster::Merge(std::vector<Candidate>& found, const Vec3& direction) const
{
  const double touchSpread = SameTouchPart * this->Bounds().diagonal().norm();
  std::vector<Candidate> kept;
  for (const Candidate& one : found)
  {
    bool repeated = false;
    bool between = false; // is there a hit that crosses the other way?
    for (auto other = kept.rbegin(); other != kept.rend() && !repeated; ++other)
    {
      const RayHit& a = other->Hit;
      const RayHit& b = one.Hit;
      const double distance = (a.Point - b.Point).norm();
      const double spread = this->Spread(a, b, direction);
      if (distance > std::max(touchSpread, spread))
      {
        break;
      }
      const bool touches = a.Crossing == 0 || b.Crossing == 0;
      const double reach = between ? this->Noise(a, b, direction) : spread;
      repeated = touches ? distance <= touchSpread : a.Crossing == b.Crossing && distance <= reach;
      between = between || a.Crossing == -b.Crossing;
      if (repeated)
      {
        const bool sure = a.Face != b.Face || one.Sure || other->Sure;
        // A crossing tells more than a touch, and a place inside more than one beside.
        if (a.Crossing == 0 || (b.Crossing != 0 && one.Sure && !other->Sure))
        {
          *other = one;
        }
        other->Sure = sure;
      }
    }
    if (!repeated)
    {
      kept.push_back(one);
    }
  }
  int last = -1;
  for (std::size_t i = 0; i < kept.size(); ++i)
  {
    if (i + 1 < kept.size() && kept[i].Hit.Crossing == last && kept[i + 1].Hit.Crossing == -last &&
      (kept[i + 1].Hit.Point - kept[i].Hit.Point).norm() <=
        this->Noise(kept[i].Hit, kept[i + 1].Hit, direction))
    {
      std::swap(kept[i], kept[i + 1]);
    }
    last = kept[i].Hit.Crossing != 0 ? kept[i].Hit.Crossing : last;
  }
  found.swap(kept);
}

/// Of the hits that lie beside one face only, leaves those without which two hits on end would
/// cross in the same direction. The others pass the face's border.
void RayCaster::KeepNeeded(std::vector<Candidate>& found)
{
  const auto surelyCrosses = [](const Candidate& one) { return one.Sure && one.Hit.Crossing != 0; };
  std::vector<Candidate> kept;
  int last = -1; // outside
  for (auto one = found.begin(); one != found.end(); ++one)
  {
    if (!one->Sure)
    {
      const auto next = std::find_if(one, found.end(), surelyCrosses);
      const int after = next != found.end() ? next->Hit.Crossing : 1;
      if (one->Hit.Crossing != -last || after != last)
      {
        continue;
      }
    }
    kept.push_back(*one);
    last = one->Hit.Crossing != 0 ? one->Hit.Crossing : last;
  }
  found.swap(kept);
}

} // namespace nurbs
