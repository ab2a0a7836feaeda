// SPDX-License-Identifier: BSD-3-Clause
// The Utah teapot (Martin Newell, 1975; public domain). Body, rim, bottom and lid are solids of
// revolution, so a profile and the shape of a quarter turn say it all; of handle and spout one half
// is listed, the other is its mirror image.
#include "PatchStitcher.h"
#include "Shapes.h"

#include <array>

namespace nurbs
{
namespace
{

/// A point of a profile: distance from the axis and height. `Corner` is the part of the radius that
/// the inner control points of a quarter turn keep on their smaller axis.
struct ProfilePoint
{
  double Radius, Height, Corner;
};

constexpr double Round = 0.56;
constexpr double KnobRound = 0.5625; // 0.45 / 0.8 in Newell's data.

/// From the inner rim over the body to the middle of the bottom: four patches, joints shared.
constexpr ProfilePoint Body[] = { { 1.4, 2.4, Round }, { 1.3375, 2.53125, Round },
  { 1.4375, 2.53125, Round }, { 1.5, 2.4, Round }, { 1.75, 1.875, Round }, { 2.0, 1.35, Round },
  { 2.0, 0.9, Round }, { 2.0, 0.45, Round }, { 1.5, 0.225, Round }, { 1.5, 0.15, Round },
  { 1.5, 0.075, Round }, { 1.425, 0.0, Round }, { 0.0, 0.0, Round } };

/// From the top of the knob to the rim of the lid: two patches.
constexpr ProfilePoint Lid[] = { { 0.0, 3.15, Round }, { 0.8, 3.15, KnobRound },
  { 0.0, 2.85, Round }, { 0.2, 2.7, Round }, { 0.4, 2.55, Round }, { 1.3, 2.55, Round },
  { 1.3, 2.4, Round } };

/// A section of handle or spout: (x, z) on the plane y = 0, inner and outer side, and the half width.
struct Section
{
  double InnerX, InnerZ, OuterX, OuterZ, HalfWidth;
};

constexpr Section Handle[] = { { -1.6, 2.025, -1.5, 2.25, 0.3 }, { -2.3, 2.025, -2.5, 2.25, 0.3 },
  { -2.7, 2.025, -3.0, 2.25, 0.3 }, { -2.7, 1.8, -3.0, 1.8, 0.3 }, { -2.7, 1.575, -3.0, 1.35, 0.3 },
  { -2.5, 1.125, -2.65, 0.9375, 0.3 }, { -2.0, 0.9, -1.9, 0.6, 0.3 } };

constexpr Section Spout[] = { { 1.7, 1.425, 1.7, 0.6, 0.66 }, { 2.6, 1.425, 3.1, 0.825, 0.66 },
  { 2.3, 2.1, 2.4, 2.025, 0.25 }, { 2.7, 2.4, 3.3, 2.4, 0.25 },
  { 2.8, 2.475, 3.525, 2.49375, 0.25 }, { 2.9, 2.475, 3.45, 2.5125, 0.15 },
  { 2.8, 2.4, 3.2, 2.4, 0.15 } };

using Row = std::array<Vec3, 4>;

/// A bicubic Bezier patch of four rows of control points.
Surface Patch(const std::array<Row, 4>& rows)
{
  Surface patch;
  for (int dir = 0; dir < 2; ++dir)
  {
    patch.Degree[dir] = 3;
    patch.Count[dir] = 4;
    patch.Knots[dir] = { 0, 0, 0, 0, 1, 1, 1, 1 };
  }
  for (const Row& row : rows)
  {
    patch.Points.insert(patch.Points.end(), row.begin(), row.end());
  }
  return patch;
}

/// The control points of one quarter turn (clockwise seen from above), turned `quarters` times.
Row QuarterTurn(const ProfilePoint& p, int quarters)
{
  const double r = p.Radius, c = p.Corner * p.Radius;
  Row row{ { Vec3(r, 0, p.Height), Vec3(r, -c, p.Height), Vec3(c, -r, p.Height),
    Vec3(0, -r, p.Height) } };
  for (Vec3& point : row)
  {
    for (int i = 0; i < quarters; ++i)
    {
      point = Vec3(point[1] + 0.0, 0.0 - point[0], point[2]);
    }
  }
  return row;
}

template <std::size_t Count>
void AddRevolved(PatchStitcher& stitcher, const ProfilePoint (&profile)[Count], const char* name)
{
  FaceAttributes attributes;
  attributes.Name = name;
  for (std::size_t first = 0; first + 3 < Count; first += 3)
  {
    for (int quarter = 0; quarter < 4; ++quarter)
    {
      std::array<Row, 4> rows;
      for (int j = 0; j < 4; ++j)
      {
        rows[j] = QuarterTurn(profile[first + j], quarter);
      }
      stitcher.AddFace(Patch(rows), attributes);
    }
  }
}

template <std::size_t Count>
void AddMirrored(PatchStitcher& stitcher, const Section (&sections)[Count], const char* name)
{
  FaceAttributes attributes;
  attributes.Name = name;
  for (std::size_t first = 0; first + 3 < Count; first += 3)
  {
    for (const double side : { -1.0, 1.0 })
    {
      std::array<Row, 4> rows;
      for (int j = 0; j < 4; ++j)
      {
        const Section& s = sections[first + j];
        const double y = side * s.HalfWidth;
        rows[j] = Row{ { Vec3(s.InnerX, 0, s.InnerZ), Vec3(s.InnerX, y, s.InnerZ),
          Vec3(s.OuterX, y, s.OuterZ), Vec3(s.OuterX, 0, s.OuterZ) } };
      }
      attributes.Reversed = side > 0.0;
      stitcher.AddFace(Patch(rows), attributes);
    }
  }
}

} // namespace

void AddTeapot(ModelBuilder& builder)
{
  PatchStitcher stitcher(builder, 1e-11);
  AddRevolved(stitcher, Body, "body");
  AddRevolved(stitcher, Lid, "lid");
  AddMirrored(stitcher, Handle, "handle");
  AddMirrored(stitcher, Spout, "spout");
}

} // namespace nurbs
