// SPDX-License-Identifier: BSD-3-Clause
// The three models of Ruan, Zhang and Yong (2006), figures 7 to 9, built again from what the paper
// tells of them: closed solids of rational Bezier patches of degree 3 at most, each patch a face
// with its natural boundary. The control points themselves were not published.
#include "PatchStitcher.h"
#include "Shapes.h"

#include <array>
#include <cmath>

namespace nurbs
{
namespace
{

constexpr double Pi = 3.14159265358979323846;
constexpr double Rounding = 1e-10; ///< Of the edges' curves, mm; the models are 30 to 300 mm long.

/// Points and weights of a Bezier curve in the half plane (distance from the z axis, z).
struct ProfilePiece
{
  std::vector<Vec2> Points;
  std::vector<double> Weights;
};

ProfilePiece Polynomial(const std::vector<Vec2>& points)
{
  return { points, std::vector<double>(points.size(), 1.0) };
}

/// The profile's curve of degree 1 between two points.
ProfilePiece Straight(const Vec2& a, const Vec2& b)
{
  return Polynomial({ a, b });
}

/// A part of the unit circle of less than a half turn, as a rational quadratic.
struct Sector
{
  Vec2 Points[3];
  double Weights[3];
};

Sector MakeSector(const Vec2& from, const Vec2& to)
{
  const double c = from.dot(to);
  return { { from, (from + to) / (1.0 + c), to }, { 1.0, std::sqrt(0.5 * (1.0 + c)), 1.0 } };
}

std::vector<double> BezierKnots(int degree)
{
  std::vector<double> knots(degree + 1, 0.0);
  knots.insert(knots.end(), degree + 1, 1.0);
  return knots;
}

/// A Bezier patch of rows of control points, to be filled.
Surface EmptyPatch(int degreeU, int degreeV)
{
  Surface patch;
  patch.Degree[0] = degreeU;
  patch.Degree[1] = degreeV;
  for (int dir = 0; dir < 2; ++dir)
  {
    patch.Count[dir] = patch.Degree[dir] + 1;
    patch.Knots[dir] = BezierKnots(patch.Degree[dir]);
  }
  return patch;
}

FaceAttributes Named(const char* name, bool reversed = false)
{
  FaceAttributes attributes;
  attributes.Name = name;
  attributes.Reversed = reversed;
  return attributes;
}

Vec3 RingPoint(const Vec2& direction, const Vec2& profile)
{
  return Vec3(profile[0] * direction[0], profile[0] * direction[1], profile[1]);
}

/// What a piece of profile sweeps through a sector. A profile that runs upwards on the outside has
/// its outside at Su x Sv.
Surface Revolved(const Sector& sector, const ProfilePiece& piece)
{
  Surface patch = EmptyPatch(2, static_cast<int>(piece.Points.size()) - 1);
  for (std::size_t j = 0; j < piece.Points.size(); ++j)
  {
    for (int i = 0; i < 3; ++i)
    {
      patch.Points.push_back(RingPoint(sector.Points[i], piece.Points[j]));
      patch.Weights.push_back(sector.Weights[i] * piece.Weights[j]);
    }
  }
  return patch;
}

} // namespace

namespace
{

/// One of the two handles: a cubic sweep between two patches that are left out of the body, whose
/// boundaries its section starts and ends with.
struct HandleShape
{
  std::size_t Upper, Lower;  ///< Their pieces of the profile.
  double UpperOut, LowerOut; ///< How far the inner control points stand out, on the inner side.
  double Thickness;          ///< By how much more they do on the outer side.
};
constexpr HandleShape Handle = { 4, 2, 50.0, 25.0, 12.0 };

std::vector<ProfilePiece> VaseProfile()
{
  return { Straight({ 0, 0 }, { 30, 0 }),
    Polynomial({ { 30, 0 }, { 45, 15 }, { 60, 40 }, { 60, 70 } }),
    Polynomial({ { 60, 70 }, { 60, 85 }, { 56, 98 }, { 50, 108 } }),
    Polynomial({ { 50, 108 }, { 38, 128 }, { 26, 138 }, { 24, 156 } }),
    Polynomial({ { 24, 156 }, { 23, 165 }, { 23, 171 }, { 24, 180 } }),
    Polynomial({ { 24, 180 }, { 27, 207 }, { 32, 216 }, { 40, 222 } }),
    Polynomial({ { 40, 222 }, { 42, 225 }, { 38, 226 }, { 36, 223 } }),
    Polynomial({ { 36, 223 }, { 29, 217 }, { 23.5, 206 }, { 20.5, 180 } }),
    Polynomial({ { 20.5, 180 }, { 19, 167 }, { 19, 165 }, { 21, 154 } }),
    Polynomial({ { 21, 154 }, { 24, 134 }, { 56, 112 }, { 56, 70 } }),
    Polynomial({ { 56, 70 }, { 56, 40 }, { 40, 6 }, { 26, 6 } }), Straight({ 26, 6 }, { 0, 6 }) };
}

/// A side of a handle: from `upper` over two rows further out along `side` to `lower`. `outer` is
/// the place of each control point between the inner (0) and the outer (1) side of the handle.
void AddHandleSide(PatchStitcher& stitcher, double side, const std::vector<Vec3>& upper,
  const std::vector<Vec3>& lower, const std::vector<double>& weights,
  const std::vector<double>& outer, bool reversed)
{
  Surface patch = EmptyPatch(static_cast<int>(upper.size()) - 1, 3);
  for (int row = 0; row < 4; ++row)
  {
    for (std::size_t k = 0; k < upper.size(); ++k)
    {
      const double more = Handle.Thickness * outer[k];
      const double out =
        row == 1 ? Handle.UpperOut + more : (row == 2 ? Handle.LowerOut + more : 0.0);
      patch.Points.push_back((row < 2 ? upper[k] : lower[k]) + Vec3(side * out, 0.0, 0.0));
      patch.Weights.push_back(weights[k]);
    }
  }
  stitcher.AddFace(patch, Named("handle", reversed));
}

void AddHandle(PatchStitcher& stitcher, double side, const Sector& sector,
  const ProfilePiece& upper, const ProfilePiece& lower)
{
  const std::vector<double> arc(sector.Weights, sector.Weights + 3);
  for (int end = 0; end < 2; ++end) // The inner side, then the outer one.
  {
    std::vector<Vec3> from, to;
    for (const Vec2& direction : sector.Points)
    {
      from.push_back(RingPoint(direction, end ? upper.Points.back() : upper.Points.front()));
      to.push_back(RingPoint(direction, end ? lower.Points.front() : lower.Points.back()));
    }
    AddHandleSide(stitcher, side, from, to, arc, std::vector<double>(3, end), end == 1);
  }
  for (int end = 0; end < 2; ++end) // Where the sector starts, and where it ends.
  {
    std::vector<Vec3> from, to;
    for (int k = 0; k < 4; ++k)
    {
      from.push_back(RingPoint(sector.Points[2 * end], upper.Points[k]));
      to.push_back(RingPoint(sector.Points[2 * end], lower.Points[3 - k]));
    }
    AddHandleSide(stitcher, side, from, to, std::vector<double>(4, 1.0),
      { 0.0, 1.0 / 3.0, 2.0 / 3.0, 1.0 }, end == 0);
  }
}

} // namespace

void AddVase(ModelBuilder& builder)
{
  PatchStitcher stitcher(builder, Rounding);
  const double half = 9.0 * Pi / 180.0; // Of a handle's sector.
  const double c = std::cos(half), s = std::sin(half);
  const Vec2 cuts[7] = { { c, -s }, { c, s }, { 0, 1 }, { -c, s }, { -c, -s }, { 0, -1 },
    { c, -s } };
  const std::vector<ProfilePiece> profile = VaseProfile();
  for (int k = 0; k < 6; ++k)
  {
    const Sector sector = MakeSector(cuts[k], cuts[k + 1]);
    const bool hasHandle = k % 3 == 0;
    for (std::size_t j = 0; j < profile.size(); ++j)
    {
      if (!hasHandle || (j != Handle.Upper && j != Handle.Lower))
      {
        stitcher.AddFace(Revolved(sector, profile[j]), Named("body"));
      }
    }
    if (hasHandle)
    {
      AddHandle(
        stitcher, k == 0 ? 1.0 : -1.0, sector, profile[Handle.Upper], profile[Handle.Lower]);
    }
  }
}

namespace
{

constexpr double MissileRadius = 10.0;
constexpr double FinHalfThickness = 0.75;

/// A fin in the half plane (distance from the body's surface, z): a trapezoid with its root from
/// z = Bottom to Top, and its tip, `Span` away, from TipBottom to TipTop.
struct Fin
{
  double Bottom, Top, Span, TipBottom, TipTop;
};
constexpr Fin TailFin = { 15, 45, 22, 5, 25 };
constexpr Fin Wing = { 95, 120, 14, 97, 108 };

/// The four quarters' fins: ruled faces between arcs of the body and the same arcs moved outwards.
void AddFin(PatchStitcher& stitcher, const Sector& sector, const Vec2& out, const Fin& fin)
{
  const auto point = [&](int i, bool tip, double z) {
    const Vec3 root = RingPoint(sector.Points[i], Vec2(MissileRadius, z));
    return tip ? Vec3(root + fin.Span * Vec3(out[0], out[1], 0.0)) : root;
  };
  const auto add = [&](bool tipA, double zA, bool tipB, double zB, bool reversed) {
    Surface patch = EmptyPatch(2, 1);
    for (int j = 0; j < 2; ++j)
    {
      for (int i = 0; i < 3; ++i)
      {
        patch.Points.push_back(j ? point(i, tipB, zB) : point(i, tipA, zA));
        patch.Weights.push_back(sector.Weights[i]);
      }
    }
    stitcher.AddFace(patch, Named("fin", reversed));
  };
  add(false, fin.Bottom, true, fin.TipBottom, false);
  add(false, fin.Top, true, fin.TipTop, true);
  add(true, fin.TipBottom, true, fin.TipTop, false);
  for (int end = 0; end < 2; ++end)
  {
    Surface side = EmptyPatch(1, 1);
    const int i = 2 * end;
    side.Points = { point(i, false, fin.Bottom), point(i, true, fin.TipBottom),
      point(i, false, fin.Top), point(i, true, fin.TipTop) };
    stitcher.AddFace(side, Named("fin", end == 1));
  }
}

/// The arc of a tangent ogive: a circle that leaves the body without a crease.
ProfilePiece Ogive(double z, double length)
{
  const double r = MissileRadius;
  const double arcRadius = (r * r + length * length) / (2.0 * r);
  const double cosine = (arcRadius - r) / arcRadius;
  return { { Vec2(r, z), Vec2(r, z + length - r * (arcRadius - r) / length), Vec2(0, z + length) },
    { 1.0, std::sqrt(0.5 * (1.0 + cosine)), 1.0 } };
}

} // namespace

void AddMissile(ModelBuilder& builder)
{
  PatchStitcher stitcher(builder, Rounding);
  const double s = FinHalfThickness / MissileRadius, c = std::sqrt(1.0 - s * s);
  const double r = MissileRadius;
  const ProfilePiece profile[] = { Straight({ 0, 0 }, { 8, 0 }), Straight({ 8, 0 }, { r, 15 }),
    Straight({ r, 15 }, { r, 45 }), Straight({ r, 45 }, { r, 95 }), Straight({ r, 95 }, { r, 120 }),
    Straight({ r, 120 }, { r, 140 }), Ogive(140, 40) };
  Vec2 out(1, 0), left(0, 1);
  for (int quarter = 0; quarter < 4; ++quarter)
  {
    const Vec2 next = left, behind = -out;
    const Vec2 cuts[3] = { c * out - s * left, c * out + s * left, c * next - s * behind };
    const Sector fins = MakeSector(cuts[0], cuts[1]), body = MakeSector(cuts[1], cuts[2]);
    for (int j = 0; j < 7; ++j)
    {
      stitcher.AddFace(Revolved(body, profile[j]), Named("body"));
      if (j != 2 && j != 4)
      {
        stitcher.AddFace(Revolved(fins, profile[j]), Named("body"));
      }
    }
    AddFin(stitcher, fins, out, TailFin);
    AddFin(stitcher, fins, out, Wing);
    out = next;
    left = behind;
  }
}

namespace
{

constexpr double SpringRadius = 10.0;
constexpr double WireRadius = 1.5;
constexpr double SpringRise = 5.0 / (2.0 * Pi); ///< Of a radian.
constexpr int SpringQuarters = 22;

/// The control points of a section's circle, by the normal and the binormal of the helix: nine, of
/// which the last is the first.
Vec2 SectionPoint(int i)
{
  static constexpr int Signs[8][2] = { { 1, 0 }, { 1, 1 }, { 0, 1 }, { -1, 1 }, { -1, 0 },
    { -1, -1 }, { 0, -1 }, { 1, -1 } };
  return WireRadius * Vec2(Signs[i % 8][0], Signs[i % 8][1]);
}

double SectionWeight(int i)
{
  return i % 2 ? std::sqrt(0.5) : 1.0;
}

Vec2 QuarterDirection(int quarter)
{
  static constexpr int Turn[4][2] = { { 1, 0 }, { 0, 1 }, { -1, 0 }, { 0, -1 } };
  return Vec2(Turn[quarter % 4][0], Turn[quarter % 4][1]);
}

/// The point of the section's control point i in the direction `radial` with the helix at height z:
/// normal (-radial, 0), binormal (rise * (radial turned by -90 degrees), radius) / length.
Vec3 SpringPoint(const Vec2& radial, double z, int i)
{
  const Vec2 section = SectionPoint(i);
  const double length = std::hypot(SpringRadius, SpringRise);
  const double along = SpringRadius - section[0];
  const double across = section[1] * SpringRise / length;
  return Vec3(along * radial[0] + across * radial[1], along * radial[1] - across * radial[0],
    z + section[1] * SpringRadius / length);
}

Vec3 SpringEnd(int quarter, int i)
{
  return SpringPoint(QuarterDirection(quarter), SpringRise * (0.5 * Pi * quarter), i);
}

/// A quarter of the wire's circumference over a quarter turn: a circle of degree 2 by an arc raised
/// to degree 3. All but the height is exact; the height's numerator is the cubic that has the
/// helix's height and slope at both ends.
Surface SpringPatch(int quarter, int side)
{
  const double w = std::sqrt(0.5), w1 = (1.0 + 2.0 * w) / 3.0;
  const Vec2 from = QuarterDirection(quarter), to = QuarterDirection(quarter + 1);
  const double angle[2] = { 0.5 * Pi * quarter, 0.5 * Pi * (quarter + 1) };
  const double speed = std::sqrt(2.0);        // Of the angle by the parameter, at both ends.
  const double weightSlope = 2.0 * (w - 1.0); // Of the arc's denominator, at its start.
  const double first = angle[0] + (weightSlope * angle[0] + speed) / 3.0;
  const double second = angle[1] - (-weightSlope * angle[1] + speed) / 3.0;
  Surface patch = EmptyPatch(2, 3);
  for (int row = 0; row < 4; ++row)
  {
    for (int i = 2 * side; i <= 2 * side + 2; ++i)
    {
      if (row % 3 == 0)
      {
        patch.Points.push_back(SpringEnd(quarter + row / 3, i));
        patch.Weights.push_back(SectionWeight(i));
        continue;
      }
      const Vec2 radial = ((row == 1 ? from : to) + 2.0 * w * ((from + to))) / (3.0 * w1);
      patch.Points.push_back(SpringPoint(radial, SpringRise * (row == 1 ? first : second) / w1, i));
      patch.Weights.push_back(SectionWeight(i) * w1);
    }
  }
  return patch;
}

/// An eighth of the ball that closes an end of the wire, which goes on in `direction` from there.
Surface SpringCap(int quarter, int side, const Vec3& direction)
{
  Vec3 middle = Vec3::Zero();
  for (int i = 0; i < 8; i += 2)
  {
    middle += 0.25 * SpringEnd(quarter, i);
  }
  Surface patch = EmptyPatch(2, 2);
  for (int row = 0; row < 3; ++row)
  {
    for (int i = 2 * side; i <= 2 * side + 2; ++i)
    {
      const Vec3 base = row == 2 ? middle : SpringEnd(quarter, i);
      patch.Points.push_back(row == 0 ? base : Vec3(base + WireRadius * direction));
      patch.Weights.push_back(SectionWeight(i) * (row == 1 ? std::sqrt(0.5) : 1.0));
    }
  }
  return patch;
}

} // namespace

void AddSpring(ModelBuilder& builder)
{
  PatchStitcher stitcher(builder, Rounding);
  for (int quarter = 0; quarter < SpringQuarters; ++quarter)
  {
    for (int side = 0; side < 4; ++side)
    {
      stitcher.AddFace(SpringPatch(quarter, side), Named("wire"));
    }
  }
  for (int end = 0; end < 2; ++end)
  {
    const int quarter = end * SpringQuarters;
    const Vec2 radial = QuarterDirection(quarter);
    Vec3 ahead(-SpringRadius * radial[1], SpringRadius * radial[0], SpringRise);
    ahead.normalize();
    for (int side = 0; side < 4; ++side)
    {
      stitcher.AddFace(
        SpringCap(quarter, side, end ? ahead : Vec3(-ahead)), Named("end", end == 0));
    }
  }
}

} // namespace nurbs
