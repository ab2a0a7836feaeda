// SPDX-License-Identifier: BSD-3-Clause
#include "Shapes.h"

#include "PatchStitcher.h"

#include <cmath>
#include <sstream>

namespace nurbs
{
namespace
{

constexpr double Pi = 3.14159265358979323846;

/// Rounding of an exact edge's curve, as a part of the shape's size.
constexpr double RoundingPart = 1e-12;

void RequirePositive(const char* name, double value)
{
  if (!(value > 0.0) || !std::isfinite(value))
  {
    std::ostringstream text;
    text << name << " must be positive and finite, but is " << value;
    throw Error(text.str());
  }
}

/// A curve in the half plane (distance from the z axis, z).
struct Profile
{
  int Degree;
  std::vector<double> Knots;
  std::vector<Vec2> Points;
  std::vector<double> Weights;
};

/// The surface that a profile sweeps around the z axis (rational quadratic in u, profile in v). The
/// last column equals the first, bit for bit.
Surface Revolve(const Profile& profile)
{
  const Curve<2> circle = TrimCircle(Vec2(0, 0), 1.0);
  Surface surface;
  surface.Degree[0] = 2;
  surface.Degree[1] = profile.Degree;
  surface.Count[0] = 9;
  surface.Count[1] = static_cast<int>(profile.Points.size());
  surface.Knots[0] = circle.Knots;
  surface.Knots[1] = profile.Knots;
  for (int j = 0; j < surface.Count[1]; ++j)
  {
    for (int i = 0; i < 9; ++i)
    {
      const Vec2 xy = profile.Points[j][0] * circle.Points[i];
      surface.Points.emplace_back(xy[0] + 0.0, xy[1] + 0.0, profile.Points[j][1]);
      surface.Weights.push_back(circle.Weights[i] * profile.Weights[j]);
    }
  }
  return surface;
}

FaceAttributes Named(const char* name, bool reversed = false)
{
  FaceAttributes attributes;
  attributes.Name = name;
  attributes.Reversed = reversed;
  return attributes;
}

/// The bilinear square [-half, half]^2 at height z; u and v are x and y.
Surface PlaneSquare(const Vec2& low, const Vec2& high, double z)
{
  Surface plane;
  plane.Count[0] = plane.Count[1] = 2;
  for (int dir = 0; dir < 2; ++dir)
  {
    plane.Knots[dir] = { low[dir], low[dir], high[dir], high[dir] };
  }
  plane.Points = { Vec3(low[0], low[1], z), Vec3(high[0], low[1], z), Vec3(low[0], high[1], z),
    Vec3(high[0], high[1], z) };
  return plane;
}

/// A loop of one closed curve in a plane whose u and v are x and y.
void AddPlanarLoop(PatchStitcher& stitcher, const Curve<2>& trim, double z, bool reversed)
{
  const Curve<3> lifted = LiftCurve(trim, Vec3(0, 0, z), Vec3::UnitX(), Vec3::UnitY());
  stitcher.GetBuilder().BeginLoop();
  stitcher.GetBuilder().AddTrimCurve(trim.View(), stitcher.Edge(lifted).Edge, reversed);
}

/// A round plane of the given radius around the z axis.
void AddRoundPlane(
  PatchStitcher& stitcher, double radius, double z, const FaceAttributes& attributes)
{
  const double half = 1.25 * radius;
  stitcher.GetBuilder().BeginFace(
    PlaneSquare(Vec2(-half, -half), Vec2(half, half), z).View(), attributes);
  AddPlanarLoop(stitcher, TrimCircle(Vec2(0, 0), radius), z, false);
}

} // namespace

void AddSphere(ModelBuilder& builder, double radius)
{
  RequirePositive("the radius of a sphere", radius);
  const double w = std::sqrt(0.5);
  const Profile half{ 2, { 0, 0, 0, 1, 1, 2, 2, 2 },
    { Vec2(0, -radius), Vec2(radius, -radius), Vec2(radius, 0), Vec2(radius, radius),
      Vec2(0, radius) },
    { 1, w, 1, w, 1 } };
  PatchStitcher(builder, RoundingPart * radius).AddFace(Revolve(half), Named("sphere"));
}

void AddTorus(ModelBuilder& builder, double radius, double tube)
{
  RequirePositive("the radius of a torus", radius);
  RequirePositive("the tube radius of a torus", tube);
  if (tube >= radius)
  {
    throw Error("the tube radius of a torus must be smaller than its radius");
  }
  const Curve<2> circle = TrimCircle(Vec2(radius, 0), tube);
  const Profile profile{ 2, circle.Knots, circle.Points, circle.Weights };
  PatchStitcher(builder, RoundingPart * (radius + tube)).AddFace(Revolve(profile), Named("torus"));
}

void AddCylinder(ModelBuilder& builder, double radius, double height, bool capped)
{
  RequirePositive("the radius of a cylinder", radius);
  RequirePositive("the height of a cylinder", height);
  PatchStitcher stitcher(builder, RoundingPart * (radius + height));
  const Profile line{ 1, { 0, 0, height, height }, { Vec2(radius, 0), Vec2(radius, height) },
    { 1, 1 } };
  stitcher.AddFace(Revolve(line), Named("cylinder"));
  if (capped)
  {
    AddRoundPlane(stitcher, radius, 0.0, Named("bottom", true));
    AddRoundPlane(stitcher, radius, height, Named("top"));
  }
}

void AddCone(ModelBuilder& builder, double radius, double height, bool capped)
{
  RequirePositive("the radius of a cone", radius);
  RequirePositive("the height of a cone", height);
  PatchStitcher stitcher(builder, RoundingPart * (radius + height));
  const Profile line{ 1, { 0, 0, height, height }, { Vec2(radius, 0), Vec2(0, height) }, { 1, 1 } };
  stitcher.AddFace(Revolve(line), Named("cone"));
  if (capped)
  {
    AddRoundPlane(stitcher, radius, 0.0, Named("base", true));
  }
}

void AddDisc(ModelBuilder& builder, double radius)
{
  RequirePositive("the radius of a disc", radius);
  PatchStitcher stitcher(builder, RoundingPart * radius);
  AddRoundPlane(stitcher, radius, 0.0, Named("disc"));
}

namespace
{

/// One hole of the plate with what is nested in it; radii 0: absent.
struct PlateHole
{
  Vec2 Center;
  double Half = 0.0; ///< Radius of a round hole, half the side of a square one.
  bool Square = false;
  double Island = 0.0; ///< Radius of the island in the hole.
  double Inner = 0.0;  ///< Radius of the hole in the island.
};

std::vector<PlateHole> PlateHoles(double width, double depth, int holesX, int holesY)
{
  std::vector<PlateHole> holes;
  const Vec2 pitch(width / std::max(1, holesX), depth / std::max(1, holesY));
  const double half = 0.35 * std::min(pitch[0], pitch[1]);
  for (int j = 0; j < holesY; ++j)
  {
    for (int i = 0; i < holesX; ++i)
    {
      const std::size_t k = holes.size();
      PlateHole hole;
      hole.Center = Vec2((i + 0.5) * pitch[0], (j + 0.5) * pitch[1]);
      hole.Half = half * (1.0 - 0.1 * (k % 5));
      hole.Square = k % 2 == 1;
      hole.Island = k % 3 == 0 ? 0.6 * hole.Half : 0.0;
      hole.Inner = k % 6 == 0 ? 0.5 * hole.Island : 0.0;
      holes.push_back(hole);
    }
  }
  return holes;
}

void CheckPlate(double width, double depth, int holesX, int holesY)
{
  RequirePositive("the width of a plate", width);
  RequirePositive("the depth of a plate", depth);
  if (holesX < 0 || holesY < 0 || holesX > 10000 || holesY > 10000)
  {
    throw Error("a plate has 0 to 10,000 holes in each direction");
  }
}

/// A square hole as four straight edges, clockwise.
void AddSquareHole(PatchStitcher& stitcher, const PlateHole& hole)
{
  const double h = hole.Half;
  const Vec2 corners[5] = { hole.Center + Vec2(-h, -h), hole.Center + Vec2(-h, h),
    hole.Center + Vec2(h, h), hole.Center + Vec2(h, -h), hole.Center + Vec2(-h, -h) };
  stitcher.GetBuilder().BeginLoop();
  for (int i = 0; i < 4; ++i)
  {
    const Curve<2> trim = TrimLine(corners[i], corners[i + 1], { 0.0, 2.0 * h });
    const Curve<3> lifted = LiftCurve(trim, Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY());
    stitcher.GetBuilder().AddTrimCurve(trim.View(), stitcher.Edge(lifted).Edge, false);
  }
}

} // namespace

void AddPlate(ModelBuilder& builder, double width, double depth, int holesX, int holesY)
{
  CheckPlate(width, depth, holesX, holesY);
  PatchStitcher stitcher(builder, RoundingPart * (width + depth));
  stitcher.AddFace(PlaneSquare(Vec2(0, 0), Vec2(width, depth), 0.0), Named("plate"));
  for (const PlateHole& hole : PlateHoles(width, depth, holesX, holesY))
  {
    if (hole.Square)
    {
      AddSquareHole(stitcher, hole);
    }
    else
    {
      AddPlanarLoop(stitcher, TrimCircle(hole.Center, hole.Half), 0.0, true);
    }
    if (hole.Island > 0.0)
    {
      AddPlanarLoop(stitcher, TrimCircle(hole.Center, hole.Island), 0.0, false);
    }
    if (hole.Inner > 0.0)
    {
      AddPlanarLoop(stitcher, TrimCircle(hole.Center, hole.Inner), 0.0, true);
    }
  }
}

double PlateArea(double width, double depth, int holesX, int holesY)
{
  CheckPlate(width, depth, holesX, holesY);
  double area = width * depth;
  for (const PlateHole& hole : PlateHoles(width, depth, holesX, holesY))
  {
    const double half = hole.Half * hole.Half;
    area -= hole.Square ? 4.0 * half : Pi * half;
    area += Pi * (hole.Island * hole.Island - hole.Inner * hole.Inner);
  }
  return area;
}

void AddSheet(ModelBuilder& builder, const SheetOptions& options)
{
  RequirePositive("the size of a sheet", options.Size);
  Surface sheet;
  std::vector<double> places[2];
  for (int dir = 0; dir < 2; ++dir)
  {
    const int degree = options.Degree[dir], count = options.Points[dir];
    if (degree < 1 || degree > MaxDegree || count <= degree)
    {
      throw Error("a sheet of degree " + std::to_string(degree) + " with " + std::to_string(count) +
        " control points is not possible: 1 <= degree <= " + std::to_string(MaxDegree) +
        " and more points than the degree are needed");
    }
    sheet.Degree[dir] = degree;
    sheet.Count[dir] = count;
    sheet.Knots[dir] = UniformKnots(degree, count);
    places[dir] = GrevilleAbscissae(sheet.Knots[dir], degree);
  }
  sheet.Points.reserve(static_cast<std::size_t>(sheet.Count[0]) * sheet.Count[1]);
  for (const double v : places[1])
  {
    for (const double u : places[0])
    {
      const double wave =
        std::sin(2.0 * Pi * options.Waves * u) * std::cos(2.0 * Pi * options.Waves * v);
      sheet.Points.emplace_back(options.Size * u, options.Size * v, options.Amplitude * wave);
      if (options.Rational)
      {
        sheet.Weights.push_back(1.0 + 0.5 * std::sin(5.0 * u + 7.0 * v));
      }
    }
  }
  builder.BeginFace(sheet.View(), Named("sheet"));
}

} // namespace nurbs
