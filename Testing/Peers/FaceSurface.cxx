// SPDX-License-Identifier: BSD-3-Clause
#include "FaceSurface.h"

#include <Eigen/Geometry>
#include <ElSLib.hxx>
#include <TColStd_Array1OfReal.hxx>

#include <algorithm>
#include <cmath>

namespace verify
{

namespace
{

Vec3 ToVec(const gp_XYZ& p)
{
  return { p.X(), p.Y(), p.Z() };
}

// Parameters of grid lines: every knot span gets two cells, others are spread evenly.
std::vector<double> GridLines(const BRepAdaptor_Surface& s, bool alongU, double low, double high)
{
  const GeomAbs_Shape order = GeomAbs_CN;
  const int spans = alongU ? s.NbUIntervals(order) : s.NbVIntervals(order);
  std::vector<double> lines{ low };
  if (spans > 1 && spans < 5000)
  {
    TColStd_Array1OfReal knots(1, spans + 1);
    alongU ? s.UIntervals(knots, order) : s.VIntervals(knots, order);
    for (int i = 1; i <= spans; ++i)
    {
      for (double t : { knots(i), 0.5 * (knots(i) + knots(i + 1)) })
      {
        if (t > lines.back() + 1e-9 * (high - low) && t < high - 1e-9 * (high - low))
        {
          lines.push_back(t);
        }
      }
    }
  }
  lines.push_back(high);
  const std::size_t wanted = 24;
  const std::size_t parts = std::max<std::size_t>(1, wanted / (lines.size() - 1));
  std::vector<double> fine;
  for (std::size_t i = 0; i + 1 < lines.size(); ++i)
  {
    for (std::size_t k = 0; k < parts; ++k)
    {
      fine.push_back(lines[i] + (lines[i + 1] - lines[i]) * double(k) / double(parts));
    }
  }
  fine.push_back(high);
  const std::size_t limit = 400;
  if (fine.size() > limit)
  {
    std::vector<double> fewer;
    for (std::size_t i = 0; i < limit; ++i)
    {
      fewer.push_back(fine[i * (fine.size() - 1) / (limit - 1)]);
    }
    return fewer;
  }
  return fine;
}

} // namespace

FaceSurface::FaceSurface(const TopoDS_Face& face, double accuracy)
  : Surface(face, Standard_False)
  , Accuracy(accuracy)
  , Reversed(face.Orientation() == TopAbs_REVERSED)
{
  switch (this->Surface.GetType())
  {
    case GeomAbs_Plane:
    case GeomAbs_Cylinder:
    case GeomAbs_Cone:
    case GeomAbs_Sphere:
      this->Elementary = true;
      break;
    case GeomAbs_Torus:
      // One that crosses itself has a second sheet, which may be nearer and yet not the face's.
      this->Elementary = this->Surface.Torus().MinorRadius() < this->Surface.Torus().MajorRadius();
      break;
    default:
      break;
  }
  this->Low = { this->Surface.FirstUParameter(), this->Surface.FirstVParameter() };
  this->High = { this->Surface.LastUParameter(), this->Surface.LastVParameter() };
  if (this->Surface.IsUPeriodic())
  {
    this->Periods[0] = this->Surface.UPeriod();
  }
  if (this->Surface.IsVPeriodic())
  {
    this->Periods[1] = this->Surface.VPeriod();
  }
  this->Closed[0] = this->Periods[0] == 0.0 && this->Surface.IsUClosed();
  this->Closed[1] = this->Periods[1] == 0.0 && this->Surface.IsVClosed();
  this->RegionLow = this->Low;
  this->RegionHigh = this->High;
}

Vec3 FaceSurface::Point(const Vec2& uv) const
{
  return ToVec(this->Surface.Value(uv[0], uv[1]).XYZ());
}

Vec2 FaceSurface::Clamped(Vec2 uv) const
{
  for (int k = 0; k < 2; ++k)
  {
    if (this->Periods[k] == 0.0)
    {
      uv[k] = std::clamp(uv[k], this->Low[k], this->High[k]);
    }
  }
  return uv;
}

void FaceSurface::Derivatives(const Vec2& uv, Vec3& p, Vec3& su, Vec3& sv) const
{
  gp_Pnt point;
  gp_Vec u, v;
  this->Surface.D1(uv[0], uv[1], point, u, v);
  p = ToVec(point.XYZ());
  su = ToVec(u.XYZ());
  sv = ToVec(v.XYZ());
}

Vec3 FaceSurface::OuterNormal(const Vec2& uv) const
{
  Vec3 p, su, sv;
  this->Derivatives(uv, p, su, sv);
  Vec3 n = su.cross(sv);
  const double scale = su.norm() * sv.norm();
  if (!(n.norm() > 1e-9 * scale))
  {
    return Vec3::Zero();
  }
  return (this->Reversed ? -1.0 : 1.0) * n.normalized();
}

double FaceSurface::BendingDensity(const Vec2& uv) const
{
  gp_Pnt p;
  gp_Vec u, v, uu, vv, uv2;
  this->Surface.D2(uv[0], uv[1], p, u, v, uu, vv, uv2);
  const Vec3 su = ToVec(u.XYZ()), sv = ToVec(v.XYZ());
  const Vec3 cross = su.cross(sv);
  const double area = cross.norm();
  if (!(area > 1e-12 * su.norm() * sv.norm()))
  {
    return 0.0;
  }
  const Vec3 n = cross / area;
  const double E = su.dot(su), F = su.dot(sv), G = sv.dot(sv);
  const double L = ToVec(uu.XYZ()).dot(n), M = ToVec(uv2.XYZ()).dot(n), N = ToVec(vv.XYZ()).dot(n);
  const double mean2 = (E * N - 2.0 * F * M + G * L) / (area * area);
  const double gauss = (L * N - M * M) / (area * area);
  // |k1| + |k2| is |k1 + k2| where they have one sign, else |k1 - k2|.
  return area * std::sqrt(std::max(mean2 * mean2, mean2 * mean2 - 4.0 * gauss));
}

void FaceSurface::SetRegion(const Vec2& low, const Vec2& high)
{
  this->RegionLow = low;
  this->RegionHigh = high;
}

Foot FaceSurface::ClosedForm(const Vec3& p) const
{
  const gp_Pnt point(p[0], p[1], p[2]);
  Foot foot;
  double u = 0.0, v = 0.0;
  switch (this->Surface.GetType())
  {
    case GeomAbs_Plane:
      ElSLib::Parameters(this->Surface.Plane(), point, u, v);
      break;
    case GeomAbs_Cylinder:
      ElSLib::Parameters(this->Surface.Cylinder(), point, u, v);
      break;
    case GeomAbs_Cone:
      ElSLib::Parameters(this->Surface.Cone(), point, u, v);
      break;
    case GeomAbs_Sphere:
      ElSLib::Parameters(this->Surface.Sphere(), point, u, v);
      break;
    default:
      ElSLib::Parameters(this->Surface.Torus(), point, u, v);
      break;
  }
  foot.UV = { u, v };
  foot.Distance = (this->Point(foot.UV) - p).norm();
  return foot;
}

// Near a pole a small distance in space is a large step around it.
Vec2 FaceSurface::Limited(Vec2& step) const
{
  for (int k = 0; k < 2; ++k)
  {
    const double most = 0.25 * (this->High[k] - this->Low[k]);
    step[k] = std::clamp(step[k], -most, most);
  }
  return step;
}

Foot FaceSurface::Newton(const Vec3& p, Vec2 uv) const
{
  Foot best;
  Vec2 step = Vec2::Zero();
  for (int iteration = 0; iteration < 40; ++iteration)
  {
    uv = this->Clamped(uv);
    gp_Pnt s;
    gp_Vec gu, gv, guu, gvv, guv;
    this->Surface.D2(uv[0], uv[1], s, gu, gv, guu, gvv, guv);
    const Vec3 r = ToVec(s.XYZ()) - p;
    const double d = r.norm();
    if (!(d < best.Distance))
    {
      // No progress: halve the last step, or stop if it no longer matters.
      step *= 0.5;
      if (!best.UV.allFinite() || step.norm() < 1e-13 * (1.0 + best.UV.norm()))
      {
        break;
      }
      uv = best.UV + step;
      continue;
    }
    best = { uv, d };
    const Vec3 su = ToVec(gu.XYZ()), sv = ToVec(gv.XYZ());
    Vec2 g(r.dot(su), r.dot(sv));
    bool fixed[2];
    double tangential = 0.0;
    for (int k = 0; k < 2; ++k)
    {
      const double length = k == 0 ? su.norm() : sv.norm();
      fixed[k] = this->Periods[k] == 0.0 &&
        ((uv[k] <= this->Low[k] && g[k] > 0.0) || (uv[k] >= this->High[k] && g[k] < 0.0));
      fixed[k] = fixed[k] || length == 0.0;
      tangential = std::max(tangential, fixed[k] ? 0.0 : std::abs(g[k]) / length);
    }
    if (tangential <= std::max(1e-5 * d, 1e-3 * this->Accuracy))
    {
      break;
    }
    double a = su.dot(su), b = su.dot(sv), c = sv.dot(sv);
    const double a2 = a + r.dot(ToVec(guu.XYZ())), b2 = b + r.dot(ToVec(guv.XYZ())),
                 c2 = c + r.dot(ToVec(gvv.XYZ()));
    if (a2 > 0.05 * a && c2 > 0.05 * c && a2 * c2 - b2 * b2 > 0.05 * (a * c - b * b))
    {
      a = a2;
      b = b2;
      c = c2;
    }
    const double determinant = a * c - b * b;
    if (fixed[0] || fixed[1] || !(determinant > 1e-14 * a * c))
    {
      step = { fixed[0] || a == 0.0 ? 0.0 : -g[0] / a, fixed[1] || c == 0.0 ? 0.0 : -g[1] / c };
    }
    else
    {
      step = { (-g[0] * c + g[1] * b) / determinant, (g[0] * b - g[1] * a) / determinant };
    }
    uv = best.UV + this->Limited(step);
    for (int k = 0; k < 2; ++k)
    {
      const double period = this->Periods[k];
      if (period > 0.0 && std::abs(uv[k] - this->Low[k]) > 2.0 * period)
      {
        uv[k] -= period * std::floor((uv[k] - this->Low[k]) / period);
      }
    }
  }
  return best;
}

Foot FaceSurface::Project(const Vec3& p, const Vec2& seed) const
{
  if (this->Elementary)
  {
    return this->ClosedForm(p);
  }
  Foot foot = this->Newton(p, seed);
  for (int k = 0; k < 2; ++k)
  {
    if (this->Closed[k] && (foot.UV[k] <= this->Low[k] || foot.UV[k] >= this->High[k]))
    {
      Vec2 across = foot.UV;
      across[k] = foot.UV[k] <= this->Low[k] ? this->High[k] : this->Low[k];
      const Foot other = this->Newton(p, across);
      foot = other.Distance < foot.Distance ? other : foot;
    }
  }
  return foot;
}

void FaceSurface::BuildGrid() const
{
  const auto us = GridLines(this->Surface, true, this->RegionLow[0], this->RegionHigh[0]);
  const auto vs = GridLines(this->Surface, false, this->RegionLow[1], this->RegionHigh[1]);
  const int n = int(us.size());
  for (std::size_t j = 0; j < vs.size(); ++j)
  {
    for (std::size_t i = 0; i < us.size(); ++i)
    {
      this->GridUV.emplace_back(us[i], vs[j]);
      this->GridPoints.push_back(this->Point(this->GridUV.back()));
      if (i > 0 && j > 0)
      {
        const int d = int(this->GridPoints.size()) - 1;
        this->GridTriangles.push_back({ d - n - 1, d - n, d });
        this->GridTriangles.push_back({ d - n - 1, d, d - 1 });
      }
    }
  }
  this->Grid.Build(this->GridPoints, this->GridTriangles);
}

Foot FaceSurface::ProjectGlobally(const Vec3& p) const
{
  if (this->Elementary)
  {
    return this->ClosedForm(p);
  }
  if (this->Grid.Empty())
  {
    this->BuildGrid();
  }
  const ClosestTriangle::Hit hit = this->Grid.Find(p);
  if (hit.Triangle < 0)
  {
    return {};
  }
  const auto& t = this->GridTriangles[std::size_t(hit.Triangle)];
  Vec2 seed = Vec2::Zero();
  for (int k = 0; k < 3; ++k)
  {
    seed += hit.Weights[k] * this->GridUV[std::size_t(t[std::size_t(k)])];
  }
  return this->Project(p, seed);
}

Foot FaceSurface::PatternSearch(const Vec3& p, Foot foot) const
{
  Vec2 step = 1e-3 * (this->RegionHigh - this->RegionLow);
  for (int evaluations = 0; evaluations < 400; evaluations += 4)
  {
    Foot next = foot;
    for (const Vec2& direction : { Vec2(1, 0), Vec2(-1, 0), Vec2(0, 1), Vec2(0, -1) })
    {
      const Vec2 uv = this->Clamped(foot.UV + step.cwiseProduct(direction));
      const double d = (this->Point(uv) - p).norm();
      next = d < next.Distance ? Foot{ uv, d } : next;
    }
    next.Distance < foot.Distance ? void(foot = next) : void(step *= 0.5);
  }
  return foot;
}

Foot FaceSurface::ProjectExhaustively(const Vec3& p, const Foot& start) const
{
  Foot best = start;
  if (this->Elementary)
  {
    return best;
  }
  const Foot global = this->ProjectGlobally(p);
  best = global.Distance < best.Distance ? global : best;
  std::vector<std::pair<double, int>> nodes;
  for (std::size_t i = 0; i < this->GridPoints.size(); ++i)
  {
    nodes.emplace_back((this->GridPoints[i] - p).norm(), int(i));
  }
  const std::size_t count = std::min<std::size_t>(24, nodes.size());
  std::partial_sort(nodes.begin(), nodes.begin() + std::ptrdiff_t(count), nodes.end());
  for (std::size_t i = 0; i < count; ++i)
  {
    const Foot foot = this->Project(p, this->GridUV[std::size_t(nodes[i].second)]);
    best = foot.Distance < best.Distance ? foot : best;
  }
  return this->PatternSearch(p, best);
}

} // namespace verify
