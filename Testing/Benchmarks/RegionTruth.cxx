// SPDX-License-Identifier: BSD-3-Clause
#include "RegionTruth.h"

#include <algorithm>
#include <array>
#include <functional>
#include <random>

namespace truth
{

using nurbs::Vec2;
using nurbs::Vec3;

namespace
{

/// Of the size: surfaces that are nearer to each other are at the same place.
constexpr double SamePlace = 1e-6;
/// Chords of borders, as a share of the precision, and how often they are halved at most.
constexpr double ChordShare = 0.05;
constexpr int MaxDepth = 12;
constexpr double Infinite = std::numeric_limits<double>::infinity();

using UVCurve = std::function<Vec2(double)>;

void ChooseAxes(ImageView& view)
{
  const Vec3 up = std::abs(view.Toward[2]) < 0.9 ? Vec3::UnitZ() : Vec3::UnitY();
  view.Right = up.cross(view.Toward).normalized();
  view.Up = view.Toward.cross(view.Right);
}

double DistanceToSegment(const Vec2& p, const Vec2& a, const Vec2& b)
{
  const Vec2 chord = b - a;
  const double length = chord.squaredNorm();
  const double part = length > 0.0 ? std::clamp((p - a).dot(chord) / length, 0.0, 1.0) : 0.0;
  return (a + part * chord - p).norm();
}

using Cell2 = std::array<std::int64_t, 2>;

Cell2 CellOf(const Vec2& image, double size)
{
  return { std::llround(image[0] / size), std::llround(image[1] / size) };
}

std::int64_t Key(const Cell2& cell)
{
  return cell[0] * (std::int64_t(1) << 32) + cell[1];
}

/// The box of the model in the image.
nurbs::Box2 ImageBox(const ImageView& view, const nurbs::Box3& box)
{
  nurbs::Box2 image;
  for (int corner = 0; corner < 8; ++corner)
  {
    image.extend(view.Project(box.corner(static_cast<nurbs::Box3::CornerType>(corner))));
  }
  return image;
}

void Merge(const RegionCheck& part, RegionCheck& all, std::size_t list)
{
  all.Rays += part.Rays;
  all.Hits += part.Hits;
  all.Agree += part.Agree;
  all.Within += part.Within;
  all.Narrow += part.Narrow;
  all.Near += part.Near;
  all.Wrong += part.Wrong;
  all.Coincident += part.Coincident;
  all.Bridged += part.Bridged;
  all.MissedFaces += part.MissedFaces;
  all.Worst = std::max(all.Worst, part.Worst);
  for (std::size_t k = 0; k < part.List.size() && all.List.size() < list; ++k)
  {
    all.List.push_back(part.List[k]);
  }
}

} // namespace

ImageView ImageView::Parallel(const nurbs::Box3& box, const Vec3& direction)
{
  ImageView view;
  view.Toward = direction.normalized();
  view.Center = box.center();
  ChooseAxes(view);
  return view;
}

ImageView ImageView::FromEye(const nurbs::Box3& box, const Vec3& eye)
{
  ImageView view;
  view.Perspective = true;
  view.Eye = eye;
  view.Center = box.center();
  view.Toward = (eye - view.Center).normalized();
  ChooseAxes(view);
  return view;
}

double ImageView::Scale(const Vec3& point) const
{
  return this->Perspective
    ? (this->Eye - this->Center).norm() / (this->Eye - point).dot(this->Toward)
    : 1.0;
}

Vec2 ImageView::Project(const Vec3& point) const
{
  const Vec3 from =
    this->Perspective ? Vec3(this->Scale(point) * (point - this->Eye)) : Vec3(point - this->Center);
  return Vec2(from.dot(this->Right), from.dot(this->Up));
}

nurbs::Ray ImageView::RayOf(const Vec2& image, double size) const
{
  const Vec3 place = this->Center + image[0] * this->Right + image[1] * this->Up;
  nurbs::Ray ray;
  ray.Origin = this->Perspective ? this->Eye : Vec3(place + size * this->Toward);
  ray.Direction = this->Perspective ? Vec3((place - this->Eye).normalized()) : Vec3(-this->Toward);
  return ray;
}

RegionTruth::RegionTruth(const nurbs::RayCaster& caster, const nurbs::Model& regions,
  const std::vector<std::int64_t>& sources, const ImageView& view, double precision, bool areHidden,
  const nurbs::ParallelFor& parallel)
  : Caster(caster)
  , Regions(regions)
  , Trims(regions, parallel)
  , View(view)
  , Precision(precision)
  , AreHidden(areHidden)
  , Parallel(parallel)
  , RegionsOf(caster.GetModel().Faces.size())
  , Borders(caster.GetModel().Faces.size())
{
  for (std::size_t f = 0; f < sources.size(); ++f)
  {
    this->RegionsOf.at(sources[f]).push_back(static_cast<std::int64_t>(f));
    this->AddBorder(regions.Faces[f], this->Borders[sources[f]]);
  }
  this->SortSegments();
  const nurbs::Model& model = caster.GetModel();
  for (const nurbs::Face& face : model.Faces)
  {
    double largest = 0.0;
    for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
    {
      const nurbs::TrimLoop& loop = model.Loops[l];
      for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
      {
        const std::int64_t edge = model.TrimCurves[c].Edge;
        largest = edge < 0 ? largest : std::max(largest, model.Edges[edge].Tolerance);
      }
    }
    this->Tolerances.push_back(largest);
  }
}

bool RegionTruth::IsCoincident(const nurbs::RayHit& hit) const
{
  const nurbs::RayCaster* caster = nullptr;
  {
    const std::lock_guard<std::mutex> lock(this->OthersMutex);
    std::unique_ptr<Others>& others = this->OthersOf[hit.Face];
    if (!others)
    {
      others = std::make_unique<Others>();
      others->Model = this->Caster.GetModel();
      others->Model.Faces[hit.Face].Geometry = nurbs::SurfaceView();
      others->Caster = std::make_unique<nurbs::RayCaster>(others->Model);
    }
    caster = others->Caster.get();
  }
  nurbs::Ray ray;
  ray.Origin = hit.Point;
  ray.Direction = this->View.Perspective ? Vec3((hit.Point - this->View.Eye).normalized())
                                         : Vec3(-this->View.Toward);
  const double size = this->Caster.Bounds().diagonal().norm();
  const double widest = *std::max_element(this->Tolerances.begin(), this->Tolerances.end());
  ray.Min = -std::max(SamePlace * size, 2.0 * widest);
  ray.Max = -ray.Min;
  std::vector<nurbs::RayHit> hits;
  caster->All(ray, hits);
  return std::any_of(hits.begin(), hits.end(), [&](const nurbs::RayHit& other) {
    const double tolerance = std::max(this->Tolerances[hit.Face], this->Tolerances[other.Face]);
    return std::abs(other.T) <= std::max(SamePlace * size, 2.0 * tolerance);
  });
}

void RegionTruth::SortSegments()
{
  this->Cell = std::max(4.0 * this->Precision, this->Caster.Bounds().diagonal().norm() / 1000.0);
  for (const std::vector<Segment>& border : this->Borders)
  {
    for (const Segment& segment : border)
    {
      const double reach = this->Precision * segment.Scale;
      const Vec2 low = segment.From.cwiseMin(segment.To), high = segment.From.cwiseMax(segment.To);
      const Cell2 first = CellOf(Vec2(low.array() - reach), this->Cell);
      const Cell2 last = CellOf(Vec2(high.array() + reach), this->Cell);
      for (std::int64_t j = first[1]; j <= last[1]; ++j)
      {
        for (std::int64_t i = first[0]; i <= last[0]; ++i)
        {
          this->Cells[Key({ i, j })].push_back(&segment);
        }
      }
    }
  }
}

bool RegionTruth::IsBesideAnyBorder(const Vec3& point) const
{
  const Vec2 image = this->View.Project(point);
  const auto found = this->Cells.find(Key(CellOf(image, this->Cell)));
  return found != this->Cells.end() &&
    std::any_of(found->second.begin(), found->second.end(), [&](const Segment* segment) {
      return DistanceToSegment(image, segment->From, segment->To) <=
        this->Precision * segment->Scale;
    });
}

void RegionTruth::AddBorder(const nurbs::Face& face, std::vector<Segment>& border) const
{
  constexpr int Parts = 8; // Of a knot span, at least: borders are lifted to the surface.
  if (face.Geometry.Size() == 0)
  {
    return; // The face has an error.
  }
  const auto pointAt = [&](const Vec2& uv) { return nurbs::Evaluate(face.Geometry, uv[0], uv[1]); };
  const std::function<void(const UVCurve&, double, double, int)> add =
    [&](const UVCurve& curve, double s, double t, int depth) {
      const double middle = 0.5 * (s + t);
      const Vec3 from = pointAt(curve(s)), to = pointAt(curve(t)), exact = pointAt(curve(middle));
      if (depth > 0 && (exact - 0.5 * (from + to)).norm() > ChordShare * this->Precision)
      {
        add(curve, s, middle, depth - 1);
        add(curve, middle, t, depth - 1);
        return;
      }
      border.push_back({ this->View.Project(from), this->View.Project(to), this->View.Scale(to) });
    };
  const auto addParts = [&](const UVCurve& curve, int parts) {
    for (int k = 0; k < parts; ++k)
    {
      add(curve, double(k) / parts, double(k + 1) / parts, MaxDepth);
    }
  };
  for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
  {
    const nurbs::TrimLoop& loop = this->Regions.Loops[l];
    for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
    {
      for (const nurbs::BezierCurve<2>& piece :
        nurbs::ToBezier(this->Regions.TrimCurves[c].Geometry))
      {
        addParts([&](double t) { return Vec2(piece.Evaluate(t)); }, Parts);
      }
    }
  }
  const nurbs::Interval u = face.Geometry.Domain(0), v = face.Geometry.Domain(1);
  const Vec2 corners[5] = { { u.Min, v.Min }, { u.Max, v.Min }, { u.Max, v.Max }, { u.Min, v.Max },
    { u.Min, v.Min } };
  for (int side = 0; side < 4 && face.LoopCount == 0; ++side)
  {
    addParts(
      [&](double t) { return Vec2(corners[side] + t * (corners[side + 1] - corners[side])); },
      Parts * face.Geometry.Count[side % 2]);
  }
}

double RegionTruth::DistanceToBorder(std::int64_t face, const Vec3& point) const
{
  const Vec2 image = this->View.Project(point);
  double nearest = Infinite;
  for (const Segment& segment : this->Borders[face])
  {
    const double distance = DistanceToSegment(image, segment.From, segment.To);
    nearest = std::min(nearest, distance / segment.Scale);
  }
  return nearest;
}

// True if the tolerance of edges of the face, or of the one in front, is what the point depends on.
bool RegionTruth::IsBridged(const nurbs::RayHit& hit, const nurbs::RayHit& front) const
{
  if (&hit == &front && !this->AreHidden && !this->Caster.GetTrims().Inside(hit.Face, hit.U, hit.V))
  {
    return true;
  }
  const double reach = 2.0 * std::max(this->Tolerances[hit.Face], this->Tolerances[front.Face]);
  for (std::size_t face = 0; face < this->Borders.size() && reach > 0.0; ++face)
  {
    if (this->DistanceToBorder(std::int64_t(face), hit.Point) <= this->Precision + reach)
    {
      return true;
    }
  }
  return false;
}

void RegionTruth::Judge(
  const nurbs::RayHit& hit, const nurbs::RayHit& front, RegionCheck& check, std::size_t list) const
{
  const bool isFront = &hit == &front;
  bool inside = false;
  for (const std::int64_t region : this->RegionsOf[hit.Face])
  {
    inside = inside || this->Trims.Inside(region, hit.U, hit.V);
  }
  ++check.Hits;
  if (inside == (isFront != this->AreHidden))
  {
    ++check.Agree;
    return;
  }
  const double distance = this->DistanceToBorder(hit.Face, hit.Point);
  if (distance <= this->Precision)
  {
    ++check.Within;
    return;
  }
  if (this->IsBesideAnyBorder(hit.Point))
  {
    ++check.Narrow;
    return;
  }
  const bool isCoincident = this->IsCoincident(hit);
  if (isCoincident || this->IsBridged(hit, front))
  {
    ++check.Coincident;
    check.Bridged += isCoincident ? 0 : 1;
    return;
  }
  ++(distance <= 10.0 * this->Precision ? check.Near : check.Wrong);
  check.MissedFaces += distance == Infinite ? 1 : 0;
  if (distance != Infinite)
  {
    check.Worst = std::max(check.Worst, distance / this->Precision);
  }
  if (check.List.size() < list)
  {
    check.List.push_back({ hit.Face, Vec2(hit.U, hit.V), hit.Point, isFront, distance });
  }
}

RegionCheck RegionTruth::Check(std::int64_t rays, std::size_t list) const
{
  const nurbs::Box2 image = ImageBox(this->View, this->Caster.Bounds());
  const double size = this->Caster.Bounds().diagonal().norm();
  const double cell =
    std::sqrt(image.volume() / static_cast<double>(std::max<std::int64_t>(1, rays)));
  const auto columns = std::max<std::int64_t>(1, std::llround(image.sizes()[0] / cell));
  const auto rows = std::max<std::int64_t>(1, std::llround(image.sizes()[1] / cell));
  RegionCheck all;
  std::mutex mutex;
  this->Parallel(0, rows, [&](std::int64_t begin, std::int64_t end) {
    std::vector<nurbs::RayHit> hits;
    for (std::int64_t row = begin; row < end; ++row)
    {
      std::mt19937_64 engine(static_cast<std::uint64_t>(row));
      std::uniform_real_distribution<double> random(0.0, 1.0);
      RegionCheck part;
      for (std::int64_t column = 0; column < columns; ++column)
      {
        const Vec2 at((column + random(engine)) / columns, (row + random(engine)) / rows);
        this->Caster.All(
          this->View.RayOf(image.min() + at.cwiseProduct(image.sizes()), size), hits);
        ++part.Rays;
        for (std::size_t k = 0; k < hits.size(); ++k)
        {
          this->Judge(hits[k], hits[0], part, list);
        }
      }
      const std::lock_guard<std::mutex> lock(mutex);
      Merge(part, all, list);
    }
  });
  return all;
}

} // namespace truth
