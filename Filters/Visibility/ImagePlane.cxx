// SPDX-License-Identifier: BSD-3-Clause
#include "ImagePlane.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr int MaxIterations = 24;
constexpr int MaxHalvings = 12;
// Steps longer than this share of the domain are looked at in so many places.
constexpr double LongStep = 1e-3;
constexpr int StepLooks = 8;
// The nearest depth of a perspective view, as a share of the farthest.
constexpr double NearestDepth = 1e-6;

Vec3 Corner(const Box3& box, int k)
{
  return Vec3(k & 1 ? box.max()[0] : box.min()[0], k & 2 ? box.max()[1] : box.min()[1],
    k & 4 ? box.max()[2] : box.min()[2]);
}

void CheckViewer(const Viewer& viewer)
{
  const std::string name = viewer.Perspective ? "eye" : "direction to the viewer";
  if (!viewer.Place.allFinite())
  {
    throw Error("The " + name + " is not finite");
  }
  if (!viewer.Perspective && viewer.Place.isZero(0.0))
  {
    throw Error("The " + name + " has length zero");
  }
}

} // namespace

ImagePlane::ImagePlane(const Viewer& viewer, const Vec3& up, const Box3& bounds)
  : View(viewer)
{
  CheckViewer(viewer);
  if (!up.allFinite())
  {
    throw Error("The up direction is not finite");
  }
  const Vec3 middle = bounds.center();
  const Vec3 away = viewer.Perspective ? Vec3(middle - viewer.Place) : Vec3(-viewer.Place);
  const double largest = away.cwiseAbs().maxCoeff();
  this->Axes[2] = largest > 0.0 ? Vec3((away / largest).normalized()) : Vec3(0.0, 0.0, -1.0);
  const double height = up.cwiseAbs().maxCoeff();
  Vec3 upwards = height > 0.0 ? Vec3(up / height) : up;
  for (const Vec3& other : { Vec3(Vec3::UnitZ()), Vec3(Vec3::UnitY()) })
  {
    if (this->Axes[2].cross(upwards).norm() > 1e-9 * upwards.norm())
    {
      break;
    }
    upwards = other;
  }
  this->Axes[0] = this->Axes[2].cross(upwards).normalized();
  this->Axes[1] = this->Axes[0].cross(this->Axes[2]);
  if (!viewer.Perspective)
  {
    this->View.Place = -this->Axes[2];
    this->Origin = middle - bounds.diagonal().norm() * this->Axes[2];
    return;
  }
  this->Origin = viewer.Place;
  double nearest = 1e300;
  this->Focus = 0.0;
  for (int k = 0; k < 8; ++k)
  {
    const double depth = this->Depth(Corner(bounds, k));
    nearest = std::min(nearest, depth);
    this->Focus = std::max(this->Focus, depth);
  }
  if (!(nearest > NearestDepth * this->Focus))
  {
    throw Error(
      "The eye is within the model's box, or so near to it that parts would lie behind it: "
      "visible regions are made for an eye in front of the model");
  }
}

Vec2 ImagePlane::Project(const Vec3& point) const
{
  const Vec3 d = point - this->Origin;
  const Vec2 image(this->Axes[0].dot(d), this->Axes[1].dot(d));
  return this->View.Perspective ? Vec2(image * (this->Focus / this->Axes[2].dot(d))) : image;
}

Ray ImagePlane::Sight(const Vec2& image) const
{
  Ray ray;
  const Vec3 aside = image[0] * this->Axes[0] + image[1] * this->Axes[1];
  if (this->View.Perspective)
  {
    ray.Origin = this->Origin;
    ray.Direction = (aside + this->Focus * this->Axes[2]).normalized();
    ray.Min = 0.0;
  }
  else
  {
    ray.Origin = this->Origin + aside;
    ray.Direction = this->Axes[2];
    ray.Min = -std::numeric_limits<double>::infinity();
  }
  return ray;
}

SightPlanes ImagePlane::Planes(const Vec2& image) const
{
  SightPlanes out;
  for (int k = 0; k < 2; ++k)
  {
    out.Normal[k] = this->Axes[k];
    if (this->View.Perspective)
    {
      out.Normal[k] -= image[k] / this->Focus * this->Axes[2];
    }
    out.Offset[k] = out.Normal[k].dot(this->Origin) + (this->View.Perspective ? 0.0 : image[k]);
  }
  return out;
}

bool ImagePlane::Lift(
  const SurfaceView& surface, const Vec2& image, double tolerance, int sheet, Vec2& uv) const
{
  const Interval u = surface.Domain(0);
  const Interval v = surface.Domain(1);
  const SightPlanes planes = this->Planes(image);
  struct State
  {
    Vec2 UV, Miss;
    Eigen::Matrix2d Jacobian;
  };
  const auto at = [&](const Vec2& where) {
    State out;
    out.UV = Vec2(u.Clamp(where[0]), v.Clamp(where[1]));
    const SurfaceDerivatives d = EvaluateDerivatives(surface, out.UV[0], out.UV[1], 1);
    for (int k = 0; k < 2; ++k)
    {
      out.Miss[k] = planes.Normal[k].dot(d.S) - planes.Offset[k];
      out.Jacobian(k, 0) = planes.Normal[k].dot(d.Su);
      out.Jacobian(k, 1) = planes.Normal[k].dot(d.Sv);
    }
    return out;
  };
  State now = at(uv);
  uv = now.UV;
  double least = now.Miss.norm();
  for (int k = 0; k < MaxIterations && least > 1e-3 * tolerance; ++k)
  {
    const double size = now.Jacobian.norm();
    if (!(std::abs(now.Jacobian.determinant()) > 1e-14 * size * size))
    {
      break;
    }
    // Steps of half the domain at most: farther, the linear model says nothing.
    Vec2 step = now.Jacobian.inverse() * now.Miss;
    const double share = std::max(std::abs(step[0]) / u.Length(), std::abs(step[1]) / v.Length());
    step *= share > 0.5 ? 0.5 / share : 1.0;
    State next = at(now.UV - step);
    // Not beyond the fold, and, if the step is long, not to another sheet behind it.
    const auto leavesSheet = [&]() {
      bool leaves = next.Jacobian.determinant() * sheet < 0.0;
      const int looks =
        std::max(std::abs(step[0]) / u.Length(), std::abs(step[1]) / v.Length()) > LongStep
        ? StepLooks
        : 1;
      for (int i = 1; i < looks && !leaves; ++i)
      {
        leaves = at(now.UV - double(i) / looks * step).Jacobian.determinant() * sheet < 0.0;
      }
      return leaves;
    };
    for (int half = 0; half < MaxHalvings && sheet != 0 && leavesSheet(); ++half)
    {
      step *= 0.5;
      next = at(now.UV - step);
    }
    if (next.UV == now.UV)
    {
      break;
    }
    now = next;
    if (now.Miss.norm() < least && now.Jacobian.determinant() * sheet >= 0.0)
    {
      least = now.Miss.norm();
      uv = now.UV;
    }
  }
  return least <= tolerance;
}

} // namespace nurbs
