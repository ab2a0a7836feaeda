// SPDX-License-Identifier: BSD-3-Clause
#include "AnalyticForm.h"

#include "Bezier.h"

#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Line.hxx>
#include <Geom_Plane.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_ToroidalSurface.hxx>

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr double RoundOff = 1e-12; // of the largest coordinate
constexpr double Straight = 1e-6;  // sine of an angle under which three points are on a line
constexpr double Pi = 3.14159265358979323846;
// Of the minor radius: the major one of a torus. Less is a sphere, in a piece so narrow that its
// axis is not certain.
constexpr double LeastMajor = 1e-3;
constexpr int StepsASpan = 8;

gp_Pnt ToPoint(const Vec3& p)
{
  return gp_Pnt(p[0], p[1], p[2]);
}

gp_Dir ToDir(const Vec3& d)
{
  return gp_Dir(d[0], d[1], d[2]);
}

/// `steps` parameters in every span, and the domain's end.
std::vector<double> Places(KnotView knots, int degree, int steps)
{
  const std::vector<Knot> distinct = DistinctKnots(knots, degree);
  std::vector<double> places;
  for (std::size_t i = 0; i + 1 < distinct.size(); ++i)
  {
    for (int k = 0; k < steps; ++k)
    {
      places.push_back(distinct[i].Value + (distinct[i + 1].Value - distinct[i].Value) * k / steps);
    }
  }
  places.push_back(distinct.back().Value);
  return places;
}

struct CircleFit
{
  Vec3 Center, Axis; ///< The points run counterclockwise about the axis.
  double Radius = 0.0;
};

/// Nothing if the points are on a line.
std::optional<CircleFit> CircleThrough(const Vec3& p0, const Vec3& p1, const Vec3& p2)
{
  const Vec3 a = p1 - p0, b = p2 - p0;
  const Vec3 n = a.cross(b);
  if (n.norm() <= Straight * a.norm() * b.norm())
  {
    return std::nullopt;
  }
  const Vec3 c =
    (a.squaredNorm() * b.cross(n) + b.squaredNorm() * n.cross(a)) / (2.0 * n.squaredNorm());
  return CircleFit{ p0 + c, n.normalized(), c.norm() };
}

/// A polynomial of u and v: Bernstein coefficients times their binomials, so that products are sums
/// over equal indices (Farin, Curves and Surfaces for CAGD, section 6.5).
struct ScaledPolynomial
{
  Eigen::ArrayXXd Of; ///< Row: index in u.

  ScaledPolynomial operator*(const ScaledPolynomial& other) const
  {
    ScaledPolynomial product{ Eigen::ArrayXXd::Zero(
      this->Of.rows() + other.Of.rows() - 1, this->Of.cols() + other.Of.cols() - 1) };
    for (Eigen::Index j = 0; j < this->Of.cols(); ++j)
    {
      for (Eigen::Index i = 0; i < this->Of.rows(); ++i)
      {
        product.Of.block(i, j, other.Of.rows(), other.Of.cols()) += this->Of(i, j) * other.Of;
      }
    }
    return product;
  }
};

/// C(n, 0) ... C(n, n).
Eigen::ArrayXd Binomials(Eigen::Index n)
{
  Eigen::ArrayXd row = Eigen::ArrayXd::Ones(n + 1);
  for (Eigen::Index k = 1; k <= n; ++k)
  {
    row[k] = row[k - 1] * double(n - k + 1) / double(k);
  }
  return row;
}

ScaledPolynomial Scaled(const Eigen::ArrayXXd& coefficients)
{
  const Eigen::ArrayXd u = Binomials(coefficients.rows() - 1),
                       v = Binomials(coefficients.cols() - 1);
  return { coefficients * (u.matrix() * v.matrix().transpose()).array() };
}

/// 1 or -1 if a patch in the plane z = 0 has a Jacobian of one sign for sure, 0 at most at some
/// places of its boundary: if all Bernstein coefficients of the numerator, det(H, Hu, Hv) with the
/// homogeneous (x, y, w) = H, have it. 0: it may fold.
int SideOf(const BezierPatch& patch, const std::function<Vec3(const Vec4&)>& flat)
{
  const Eigen::Index m = patch.Degree[0], n = patch.Degree[1];
  if (m < 1 || n < 1)
  {
    return 0;
  }
  ScaledPolynomial h[3], hu[3], hv[3];
  Eigen::ArrayXXd net[3];
  for (int k = 0; k < 3; ++k)
  {
    net[k].resize(m + 1, n + 1);
  }
  for (Eigen::Index i = 0; i < net[0].size(); ++i)
  {
    const Vec3 point = flat(patch.Points[i]);
    for (int k = 0; k < 3; ++k)
    {
      net[k](i) = point[k];
    }
  }
  for (int k = 0; k < 3; ++k)
  {
    h[k] = Scaled(net[k]);
    hu[k] = Scaled(net[k].bottomRows(m) - net[k].topRows(m));
    hv[k] = Scaled(net[k].rightCols(n) - net[k].leftCols(n));
  }
  Eigen::ArrayXXd jacobian = Eigen::ArrayXXd::Zero(3 * m, 3 * n);
  for (int k = 0; k < 3; ++k)
  {
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    jacobian += (h[k] * ScaledPolynomial{ (hu[a] * hv[b]).Of - (hu[b] * hv[a]).Of }).Of;
  }
  jacobian /= Scaled(Eigen::ArrayXXd::Ones(3 * m, 3 * n)).Of;
  const double low = jacobian.minCoeff(), high = jacobian.maxCoeff();
  const double none = RoundOff * std::max(-low, high);
  return (low >= -none && high > none ? 1 : 0) - (high <= none && low < -none ? 1 : 0);
}

} // namespace

AngleTable::AngleTable(std::vector<double> parameters, const std::function<double(double)>& angle)
  : Parameters(std::move(parameters))
{
  for (const double parameter : this->Parameters)
  {
    const double raw = angle(parameter);
    this->Angles.push_back(this->Angles.empty()
        ? raw
        : raw - 2.0 * Pi * std::round((raw - this->Angles.back()) / (2.0 * Pi)));
  }
}

double AngleTable::Unwrap(double parameter, double raw) const
{
  const auto above =
    std::upper_bound(this->Parameters.begin() + 1, this->Parameters.end() - 1, parameter);
  const std::size_t k = above - this->Parameters.begin();
  const double middle = 0.5 * (this->Angles[k - 1] + this->Angles[k]);
  return raw - 2.0 * Pi * std::round((raw - middle) / (2.0 * Pi));
}

bool AngleTable::IsMonotone() const
{
  const bool up = this->Total() > 0.0;
  return std::adjacent_find(this->Angles.begin(), this->Angles.end(),
           [up](double a, double b) { return !(up ? a < b : a > b); }) == this->Angles.end();
}

void AngleTable::Shift(double by)
{
  for (double& angle : this->Angles)
  {
    angle += by;
  }
}

AnalyticSurface::AnalyticSurface(const SurfaceView& surface, double scale)
  : View(surface)
  , Scale(scale)
{
  for (std::int64_t k = 0; k < surface.Size(); ++k)
  {
    this->Near = std::max(this->Near, RoundOff * scale * surface.Point(k).cwiseAbs().maxCoeff());
  }
}

std::optional<AnalyticSurface> AnalyticSurface::Recognise(const SurfaceView& surface, double scale)
{
  AnalyticSurface found(surface, scale);
  if (found.FindPlane() || found.FindTurned(0) || found.FindTurned(1))
  {
    found.MakeGeometry();
    return found;
  }
  return std::nullopt;
}

bool AnalyticSurface::FindPlane()
{
  const Interval u = this->View.Domain(0), v = this->View.Domain(1);
  const Vec3 start = this->Scale * Evaluate(this->View, u.Min, v.Min);
  const auto point = [this](std::int64_t k) { return Vec3(this->Scale * this->View.Point(k)); };
  Vec3 x = Vec3::Zero(), z = Vec3::Zero();
  for (std::int64_t k = 0; k < this->View.Size(); ++k)
  {
    x = (point(k) - start).norm() > x.norm() ? Vec3(point(k) - start) : x;
  }
  for (std::int64_t k = 0; k < this->View.Size(); ++k)
  {
    const Vec3 normal = x.cross(point(k) - start);
    z = normal.norm() > z.norm() ? normal : z;
  }
  if (z.norm() <= Straight * x.squaredNorm())
  {
    return false; // A line.
  }
  z.normalize();
  for (std::int64_t k = 0; k < this->View.Size(); ++k)
  {
    if (std::abs((point(k) - start).dot(z)) > this->Near)
    {
      return false;
    }
  }
  const Vec3 across = z.cross(x.normalized());
  const double size = x.norm();
  int turned = 0, sides = 0;
  for (const BezierPatch& patch : ToBezier(this->View))
  {
    const int side = SideOf(patch, [&](const Vec4& p) {
      const Vec3 from = (this->Scale * p.head<3>() - p[3] * start) / size;
      return Vec3(from.dot(x) / size, from.dot(across), p[3]);
    });
    turned += side;
    ++sides;
  }
  if (std::abs(turned) != sides)
  {
    return false; // It folds, or may.
  }
  const Vec3 side = this->Scale * Evaluate(this->View, u.Max, v.Min) - start;
  x = side.norm() > 1e-3 * x.norm() ? side : x;
  this->Kind = Shape::Plane;
  this->Origin = start;
  this->Z = turned > 0 ? z : Vec3(-z);
  this->X = (x - x.dot(z) * z).normalized();
  return true;
}

Vec3 AnalyticSurface::Point(double along, double across) const
{
  return this->Scale *
    (this->Dir == 0 ? Evaluate(this->View, along, across) : Evaluate(this->View, across, along));
}

bool AnalyticSurface::FindTurned(int dir)
{
  this->Dir = dir;
  this->Domain[0] = this->View.Domain(dir);
  this->Domain[1] = this->View.Domain(1 - dir);
  return this->FindAxis() && this->FindProfile() && this->MakeTables() && this->HoldsEverywhere();
}

/// By the largest circle; of a cylinder by its lines, which tell it better where the circle is short.
bool AnalyticSurface::FindAxis()
{
  this->Radius = 0.0;
  this->Side = 1.0;
  for (int k = 0; k <= 4; ++k)
  {
    const double across = this->Domain[1].Min + this->Domain[1].Length() * k / 4;
    const auto at = [&](double share) {
      return this->Point(this->Domain[0].Min + share * this->Domain[0].Length(), across);
    };
    const Vec3 p = at(0.0), q = at(1.0 / 3.0), r = at(2.0 / 3.0);
    if ((q - p).norm() <= this->Near && (r - p).norm() <= this->Near)
    {
      continue; // A pole.
    }
    const std::optional<CircleFit> circle = CircleThrough(p, q, r);
    if (!circle)
    {
      return false;
    }
    if (circle->Radius > this->Radius * (1.0 + 1e-9))
    {
      this->Radius = circle->Radius;
      this->Reference = across;
      this->Origin = circle->Center;
      this->Z = circle->Axis;
      this->X = p - circle->Center;
    }
  }
  if (!(this->Radius > 0.0))
  {
    return false;
  }
  const Vec3 line = this->Point(this->Domain[0].Min, this->Domain[1].Max) -
    this->Point(this->Domain[0].Min, this->Domain[1].Min);
  if (line.norm() > 0.0 && line.cross(this->Z).norm() <= 1e-7 * line.norm())
  {
    this->Z = (line.dot(this->Z) < 0.0 ? -1.0 : 1.0) * line.normalized();
  }
  this->X = (this->X - this->X.dot(this->Z) * this->Z).normalized();
  this->Y = this->Z.cross(this->X);
  return true;
}

/// Distance from the axis, and height.
Vec2 AnalyticSurface::Profile(double across) const
{
  const Vec3 p = this->Point(this->Domain[0].Min, across) - this->Origin;
  return Vec2(p.dot(this->X), p.dot(this->Z));
}

bool AnalyticSurface::FindProfile()
{
  const Interval& across = this->Domain[1];
  const Vec2 p = this->Profile(across.Min), q = this->Profile(across.Min + across.Length() / 3.0),
             r = this->Profile(across.Min + across.Length() / 1.5), s = this->Profile(across.Max);
  const auto lift = [](const Vec2& point) { return Vec3(point[0], point[1], 0.0); };
  if (const auto circle = CircleThrough(lift(p), lift(q), lift(r)))
  {
    const double middle = circle->Center[0];
    this->Origin += circle->Center[1] * this->Z;
    this->Minor = circle->Radius;
    const bool round = std::abs(middle) <= std::max(1e-9 * this->Minor, 100.0 * this->Near);
    this->Kind = round ? Shape::Sphere : Shape::Torus;
    this->Radius = round ? this->Minor : std::abs(middle);
    if (!round && middle < 0.0) // A tube that is beyond the axis.
    {
      this->Side = -1.0;
      this->X = -this->X;
      this->Y = -this->Y;
    }
    return round ||
      (this->Radius > LeastMajor * this->Minor &&
        std::abs(this->Radius - this->Minor) > 1e-6 * this->Minor);
  }
  const Vec2 line = s - p;
  if (std::abs(line[1]) <= this->Near || std::min(p[0], s[0]) < -this->Near)
  {
    return false; // A flat ring that is no plane, or both halves of a cone.
  }
  this->Kind = std::abs(line[0]) <= this->Near ? Shape::Cylinder : Shape::Cone;
  this->HalfAngle = std::atan2(std::abs(line[0]), std::abs(line[1]));
  if (this->Kind == Shape::Cone && line[0] * line[1] < 0.0)
  {
    this->Z = -this->Z; // So that it opens along its axis; the angle runs backwards then.
    this->Y = -this->Y;
  }
  return true;
}

double AnalyticSurface::Across(double across) const
{
  const Vec2 p = this->Profile(across);
  switch (this->Kind)
  {
    case Shape::Cone:
      return (p[0] - this->Radius) * std::sin(this->HalfAngle) + p[1] * std::cos(this->HalfAngle);
    case Shape::Sphere:
      return std::atan2(p[1], p[0]);
    case Shape::Torus:
      return this->Tube.Unwrap(across, std::atan2(p[1], p[0] - this->Radius));
    default:
      return p[1];
  }
}

double AnalyticSurface::Angle(double along) const
{
  const Vec3 p = this->Side * (this->Point(along, this->Reference) - this->Origin);
  return std::atan2(p.dot(this->Y), p.dot(this->X));
}

/// The angles lie in a turn from 0 on.
bool AnalyticSurface::MakeTables()
{
  const int d = this->Dir;
  const auto usable = [](AngleTable& table) {
    table.Shift(-2.0 * Pi * std::floor((table.Least() + Straight) / (2.0 * Pi)));
    return table.IsMonotone() && std::abs(table.Total()) <= 2.0 * Pi + Straight;
  };
  this->Turn = AngleTable(Places(this->View.Knots[d], this->View.Degree[d], StepsASpan),
    [this](double along) { return this->Angle(along); });
  if (this->Kind == Shape::Torus)
  {
    this->Tube = AngleTable(
      Places(this->View.Knots[1 - d], this->View.Degree[1 - d], StepsASpan), [this](double across) {
        const Vec2 p = this->Profile(across);
        return std::atan2(p[1], p[0] - this->Radius);
      });
  }
  return usable(this->Turn) && (this->Kind != Shape::Torus || usable(this->Tube));
}

Vec3 AnalyticSurface::Expected(double angle, double across) const
{
  double distance = this->Radius, height = across;
  if (this->Kind == Shape::Cone)
  {
    distance += across * std::sin(this->HalfAngle);
    height *= std::cos(this->HalfAngle);
  }
  else if (this->Kind != Shape::Cylinder)
  {
    distance = (this->Kind == Shape::Torus ? this->Radius : 0.0) + this->Minor * std::cos(across);
    height = this->Minor * std::sin(across);
  }
  return this->Origin + distance * (std::cos(angle) * this->X + std::sin(angle) * this->Y) +
    height * this->Z;
}

/// Also sets whether the normals are opposite.
bool AnalyticSurface::HoldsEverywhere()
{
  const int order = this->Kind == Shape::Torus ? 4 : 2;
  std::vector<double> places[2], values[2];
  for (int k = 0; k < 2; ++k)
  {
    const int d = k == 0 ? this->Dir : 1 - this->Dir;
    places[k] = Places(this->View.Knots[d], this->View.Degree[d], order * this->View.Degree[d]);
    for (const double place : places[k])
    {
      values[k].push_back(
        k == 0 ? this->Turn.Unwrap(place, this->Angle(place)) : this->Across(place));
    }
  }
  // Beyond a pole a meridian is on the other side of the axis, where no latitude leads.
  if (this->Kind == Shape::Sphere &&
    std::any_of(places[1].begin(), places[1].end(),
      [this](double place) { return this->Profile(place)[0] < -this->Near; }))
  {
    return false;
  }
  for (std::size_t i = 0; i < places[0].size(); ++i)
  {
    for (std::size_t j = 0; j < places[1].size(); ++j)
    {
      const Vec3 off =
        this->Point(places[0][i], places[1][j]) - this->Expected(values[0][i], values[1][j]);
      if (!(off.norm() <= this->Near))
      {
        return false;
      }
    }
  }
  const bool forward = std::is_sorted(values[1].begin(), values[1].end());
  const bool turned = (this->Turn.Total() > 0.0) != forward;
  this->Mirrored = turned != (this->Dir == 1);
  return forward || std::is_sorted(values[1].rbegin(), values[1].rend());
}

void AnalyticSurface::MakeGeometry()
{
  const gp_Ax3 frame(ToPoint(this->Origin), ToDir(this->Z), ToDir(this->X));
  switch (this->Kind)
  {
    case Shape::Plane:
      this->Geometry = new Geom_Plane(frame);
      return;
    case Shape::Cylinder:
      this->Geometry = new Geom_CylindricalSurface(frame, this->Radius);
      return;
    case Shape::Cone:
      this->Geometry = new Geom_ConicalSurface(frame, this->HalfAngle, this->Radius);
      return;
    case Shape::Sphere:
      this->Geometry = new Geom_SphericalSurface(frame, this->Radius);
      return;
    default:
      this->Geometry = new Geom_ToroidalSurface(frame, this->Radius, this->Minor);
  }
}

Vec2 AnalyticSurface::Parameters(const Vec2& uv) const
{
  const double along = uv[this->Dir];
  return Vec2(this->Turn.Unwrap(along, this->Angle(along)), this->Across(uv[1 - this->Dir]));
}

Vec2 AnalyticSurface::UnitLengths() const
{
  const bool round = this->Kind == Shape::Sphere || this->Kind == Shape::Torus;
  const double largest = this->Radius + (this->Kind == Shape::Torus ? this->Minor : 0.0);
  return Vec2(largest, round ? this->Minor : 1.0);
}

namespace
{

std::optional<AnalyticCurve> RecogniseLine(
  const CurveView<3>& curve, const std::vector<Vec3>& points, double near)
{
  const Vec3 chord = points.back() - points.front();
  const double length = chord.norm();
  if (length <= 10.0 * near)
  {
    return std::nullopt;
  }
  double before = 0.0;
  for (const Vec3& p : points)
  {
    const Vec3 from = p - points.front();
    const double at = from.dot(chord) / length;
    if ((from - at / length * chord).norm() > near || at < before - near)
    {
      return std::nullopt;
    }
    before = at;
  }
  const bool affine = curve.Degree == 1 && curve.Count == 2 && curve.Weight(0) == curve.Weight(1);
  return AnalyticCurve{ new Geom_Line(ToPoint(points.front()), ToDir(chord)), { 0.0, length },
    affine };
}

} // namespace

std::optional<AnalyticCurve> RecogniseCurve(const CurveView<3>& curve, double scale)
{
  std::vector<Vec3> points;
  double near = 0.0;
  for (int i = 0; i < curve.Count; ++i)
  {
    points.push_back(scale * curve.Point(i));
    near = std::max(near, RoundOff * points.back().cwiseAbs().maxCoeff());
  }
  if (!IsClamped(curve.Knots, curve.Degree))
  {
    return std::nullopt;
  }
  if (auto line = RecogniseLine(curve, points, near))
  {
    return line;
  }
  const Interval domain = curve.Domain();
  const auto at = [&](double t) { return Vec3(scale * Evaluate(curve, t)); };
  const auto circle = CircleThrough(
    points.front(), at(domain.Min + domain.Length() / 3.0), at(domain.Min + domain.Length() / 1.5));
  if (!circle)
  {
    return std::nullopt;
  }
  const Vec3 x = (points.front() - circle->Center).normalized();
  const Vec3 y = circle->Axis.cross(x);
  const std::vector<double> places =
    Places(curve.Knots, curve.Degree, std::max(StepsASpan, 2 * curve.Degree));
  for (const double t : places)
  {
    const Vec3 p = at(t) - circle->Center;
    if (!(std::abs(p.dot(circle->Axis)) <= near && std::abs(p.norm() - circle->Radius) <= near))
    {
      return std::nullopt;
    }
  }
  AngleTable turn(places, [&](double t) {
    const Vec3 p = at(t) - circle->Center;
    return std::atan2(p.dot(y), p.dot(x));
  });
  if (!turn.IsMonotone() || turn.Total() <= 0.0 || turn.Total() > 2.0 * Pi + Straight)
  {
    return std::nullopt;
  }
  const gp_Ax2 frame(ToPoint(circle->Center), ToDir(circle->Axis), ToDir(x));
  const bool full = turn.Total() > 2.0 * Pi - 1e-9;
  return AnalyticCurve{ new Geom_Circle(frame, circle->Radius),
    { 0.0, full ? 2.0 * Pi : turn.Total() }, false };
}

} // namespace nurbs
