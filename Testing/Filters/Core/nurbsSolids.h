// SPDX-License-Identifier: BSD-3-Clause
// Closed solids at any place, several in one model: for closed forms of what is visible of them.
#ifndef nurbsSolids_h
#define nurbsSolids_h

#include "PatchStitcher.h"

#include <cmath>
#include <vector>

namespace solids
{

using nurbs::ModelBuilder;
using nurbs::Surface;
using nurbs::Vec2;
using nurbs::Vec3;
using Place = Eigen::Isometry3d;

/// A rotation that turns the z axis into `axis`, then a move to `center`.
inline Place At(const Vec3& center, const Vec3& axis = Vec3::UnitZ())
{
  Place place = Place::Identity();
  place.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), axis).toRotationMatrix();
  place.translation() = center;
  return place;
}

/// A rational quadratic profile (distance from the axis, z), swept once around the axis of `place`;
/// its outside is right if it runs upwards outside.
inline void AddRevolved(ModelBuilder& builder, const std::vector<Vec2>& profile,
  const std::vector<double>& weights, const std::vector<double>& knots, const Place& place)
{
  const int sign[9][2] = { { 1, 0 }, { 1, 1 }, { 0, 1 }, { -1, 1 }, { -1, 0 }, { -1, -1 },
    { 0, -1 }, { 1, -1 }, { 1, 0 } };
  Surface s;
  s.Degree[0] = s.Degree[1] = 2;
  s.Count[0] = 9;
  s.Count[1] = static_cast<int>(profile.size());
  s.Knots[0] = { 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4 };
  s.Knots[1] = knots;
  double size = 0.0;
  for (std::size_t j = 0; j < profile.size(); ++j)
  {
    for (int i = 0; i < 9; ++i)
    {
      s.Points.push_back(
        place * Vec3(profile[j][0] * sign[i][0], profile[j][0] * sign[i][1], profile[j][1]));
      s.Weights.push_back(weights[j] * (i % 2 ? std::sqrt(0.5) : 1.0));
      size = std::max(size, s.Points.back().norm());
    }
  }
  nurbs::PatchStitcher(builder, 1e-12 * size).AddFace(s, nurbs::FaceAttributes());
}

inline void AddTorus(ModelBuilder& builder, double radius, double tube, const Place& place)
{
  const nurbs::Curve<2> circle = nurbs::TrimCircle(Vec2(radius, 0.0), tube);
  AddRevolved(builder, circle.Points, circle.Weights, circle.Knots, place);
}

inline void AddSphere(ModelBuilder& builder, double radius, const Place& place)
{
  const double w = std::sqrt(0.5);
  AddRevolved(builder,
    { Vec2(0, -radius), Vec2(radius, -radius), Vec2(radius, 0), Vec2(radius, radius),
      Vec2(0, radius) },
    { 1, w, 1, w, 1 }, { 0, 0, 0, 1, 1, 2, 2, 2 }, place);
}

/// A box of six bilinear faces with shared edges, [-half, half] in the directions of `place`.
inline void AddBox(ModelBuilder& builder, const Vec3& half, const Place& place)
{
  nurbs::PatchStitcher stitcher(builder, 1e-12 * (half.norm() + place.translation().norm()));
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const double side : { -1.0, 1.0 })
    {
      Surface s;
      s.Count[0] = s.Count[1] = 2;
      s.Knots[0] = s.Knots[1] = { 0, 0, 1, 1 };
      for (int k = 0; k < 4; ++k)
      {
        Vec3 corner;
        corner[axis] = side;
        corner[(axis + 1) % 3] = side * (k % 2 ? 1.0 : -1.0);
        corner[(axis + 2) % 3] = k / 2 ? 1.0 : -1.0;
        s.Points.push_back(place * Vec3(corner.cwiseProduct(half)));
      }
      stitcher.AddFace(s, nurbs::FaceAttributes());
    }
  }
}

} // namespace solids

#endif
