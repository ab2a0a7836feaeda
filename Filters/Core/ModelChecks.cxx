// SPDX-License-Identifier: BSD-3-Clause
#include "ModelChecks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace nurbs
{
namespace
{

/// Differences under this part of the domain are rounding.
constexpr double NegligiblePart = 1e-6;
/// Gaps and excesses over this part of the domain are worth a warning; CAD files are full of
/// smaller ones, and the tessellator closes them.
constexpr double WarnedPart = 1e-4;
/// A loop may leave the domain by this part of it (the tessellator clamps), no further.
constexpr double ExcessLimit = 0.02;
/// A gap where the two edges meet in a vertex may be this part of the domain; a longer one would be
/// a missing seam, whose two ends are the same vertex, too.
constexpr double VertexGapLimit = 0.1;
/// Two lifted points closer than this part of the face's size are one.
constexpr double SamePointPart = 1e-3;

/// A face's domain, for measures relative to its size.
struct DomainBox
{
  Interval U, V;
  explicit DomainBox(const SurfaceView& surface)
    : U(surface.Domain(0))
    , V(surface.Domain(1))
  {}
  Vec2 Relative(const Vec2& p) const
  {
    return Vec2((p[0] - this->U.Min) / this->U.Length(), (p[1] - this->V.Min) / this->V.Length());
  }
  Vec2 Clamp(const Vec2& p) const { return Vec2(this->U.Clamp(p[0]), this->V.Clamp(p[1])); }
  /// How far p is outside, as a part of the domain's size in the worse direction.
  double Excess(const Vec2& p) const
  {
    const Vec2 r = this->Relative(p);
    return std::max(std::max(-r[0], r[0] - 1.0), std::max(std::max(-r[1], r[1] - 1.0), 0.0));
  }
};

Box3 NetBox(const SurfaceView& surface)
{
  Box3 box;
  for (std::int64_t k = 0; k < surface.Size(); ++k)
  {
    box.extend(surface.Point(k));
  }
  return box;
}

Vec2 CurveEnd(const TrimCurve& curve, int end)
{
  const Interval domain = curve.Geometry.Domain();
  return Evaluate(curve.Geometry, (end == 1) != curve.Reversed ? domain.Max : domain.Min);
}

/// True if the straight line from a to b in the domain, lifted, stays at one point: a pole, or a
/// gap within the tolerance of the edges that should meet there; `limit` is a length.
bool IsOnePoint(
  const Face& face, const DomainBox& domain, const Vec2& a, const Vec2& b, double limit)
{
  const Vec2 ca = domain.Clamp(a), cb = domain.Clamp(b);
  const Vec3 start = Evaluate(face.Geometry, ca[0], ca[1]);
  for (int i = 1; i <= 8; ++i)
  {
    const Vec2 p = ca + (cb - ca) * (i / 8.0);
    if ((Evaluate(face.Geometry, p[0], p[1]) - start).norm() > limit)
    {
      return false;
    }
  }
  return true;
}

/// True if both curves' edges name the same vertex where the loop goes from one to the next: the
/// model says that it is closed there, whatever its geometry.
bool MeetInVertex(const Model& model, const TrimCurve& before, const TrimCurve& after)
{
  if (before.Edge < 0 || after.Edge < 0)
  {
    return false;
  }
  const std::int64_t last = model.Edges[before.Edge].Vertex[before.Reversed ? 0 : 1];
  return last >= 0 && last == model.Edges[after.Edge].Vertex[after.Reversed ? 1 : 0];
}

double EdgeToleranceOf(const Model& model, const TrimCurve& curve)
{
  return curve.Edge < 0 ? 0.0 : model.Edges[curve.Edge].Tolerance;
}

/// Largest excess of the curve over the domain: 0 if its control points are inside (convex hull),
/// else by samples.
double CurveExcess(const CurveView<2>& curve, const DomainBox& domain)
{
  double worst = 0.0;
  for (int i = 0; i < curve.Count; ++i)
  {
    worst = std::max(worst, domain.Excess(curve.Point(i)));
  }
  if (worst <= NegligiblePart)
  {
    return 0.0;
  }
  worst = 0.0;
  const Interval range = curve.Domain();
  const int samples = 8 * std::max(1, curve.Count - curve.Degree);
  for (int i = 0; i <= samples; ++i)
  {
    const double t = range.Clamp(range.Min + range.Length() * i / samples);
    worst = std::max(worst, domain.Excess(Evaluate(curve, t)));
  }
  return worst;
}

/// Twice the signed area inside a closed polygon, and its length.
struct PolygonMeasure
{
  double Area = 0.0;
  double Length = 0.0;
  explicit PolygonMeasure(const std::vector<Vec2>& polygon)
  {
    for (std::size_t i = 0; i < polygon.size(); ++i)
    {
      const Vec2 a = polygon[i] - polygon[0];
      const Vec2 b = polygon[(i + 1) % polygon.size()] - polygon[0];
      this->Area += a[0] * b[1] - a[1] * b[0];
      this->Length += (b - a).norm();
    }
  }
  bool IsFlat() const
  {
    return std::abs(this->Area) <= 1e-12 * std::max(1e-12, this->Length * this->Length);
  }
};

/// The loop's control polygon, relative to the domain.
std::vector<Vec2> ControlPolygon(const Model& model, const TrimLoop& loop, const DomainBox& domain)
{
  std::vector<Vec2> polygon;
  for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
  {
    const TrimCurve& curve = model.TrimCurves[c];
    const int last = curve.Geometry.Count - 1;
    for (int i = 0; i <= last; ++i)
    {
      polygon.push_back(domain.Relative(curve.Geometry.Point(curve.Reversed ? last - i : i)));
    }
  }
  return polygon;
}

/// Points of the loop, relative to the domain: both ends of every span and three between.
std::vector<Vec2> SampledPolygon(const Model& model, const TrimLoop& loop, const DomainBox& domain)
{
  std::vector<Vec2> polygon;
  for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
  {
    const TrimCurve& curve = model.TrimCurves[c];
    const Interval range = curve.Geometry.Domain();
    const int samples = 4 * std::max(1, curve.Geometry.Count - curve.Geometry.Degree);
    for (int i = 0; i < samples; ++i)
    {
      const double s = static_cast<double>(i) / samples;
      const double t = range.Min + range.Length() * (curve.Reversed ? 1.0 - s : s);
      polygon.push_back(domain.Relative(Evaluate(curve.Geometry, range.Clamp(t))));
    }
  }
  return polygon;
}

std::string Part(double value)
{
  std::ostringstream text;
  text.precision(3);
  text << value << " of the domain's size";
  return text.str();
}

/// What the checks of a face's loops share.
struct LoopContext
{
  const nurbs::Model& Model;
  const nurbs::Face& Face;
  DomainBox Domain;
  double GapLimit;     ///< Part of the domain.
  double OnePointSize; ///< Length under which lifted points are one.
};

/// The reason why the loop is open, or "".
std::string CheckGaps(const LoopContext& context, const TrimLoop& loop, const std::string& name,
  std::vector<std::string>& warnings)
{
  const Model& model = context.Model;
  double largest = 0.0;
  for (std::int64_t c = 0; c < loop.CurveCount; ++c)
  {
    const std::int64_t next = (c + 1) % loop.CurveCount;
    const TrimCurve& before = model.TrimCurves[loop.FirstCurve + c];
    const TrimCurve& after = model.TrimCurves[loop.FirstCurve + next];
    const Vec2 a = CurveEnd(before, 1), b = CurveEnd(after, 0);
    const double tolerance = 2.0 * (EdgeToleranceOf(model, before) + EdgeToleranceOf(model, after));
    const double gap = (context.Domain.Relative(b) - context.Domain.Relative(a)).norm();
    const bool closed = gap <= context.GapLimit ||
      (gap <= VertexGapLimit && MeetInVertex(model, before, after)) ||
      IsOnePoint(context.Face, context.Domain, a, b, std::max(tolerance, context.OnePointSize));
    if (!closed)
    {
      return name + "it is open: between its trim curves " + std::to_string(c) + " and " +
        std::to_string(next) + " is a gap of " + Part(gap);
    }
    largest = std::max(largest, gap);
  }
  if (largest > WarnedPart)
  {
    warnings.push_back(name + "it has a gap of " + Part(largest));
  }
  return std::string();
}

/// The reason why the loop leaves the domain too far, or "".
std::string CheckExcess(const LoopContext& context, const TrimLoop& loop, const std::string& name,
  std::vector<std::string>& warnings)
{
  double excess = 0.0;
  for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
  {
    excess = std::max(excess, CurveExcess(context.Model.TrimCurves[c].Geometry, context.Domain));
  }
  if (!(excess > WarnedPart)) // The usual case, and text is slow.
  {
    return std::string();
  }
  const std::string reason = name + "it leaves the surface's domain by " + Part(excess);
  if (excess <= ExcessLimit)
  {
    warnings.push_back(reason);
    return std::string();
  }
  return reason;
}

} // namespace

std::string CheckLoops(
  const Model& model, const Face& face, double gapLimit, std::vector<std::string>& warnings)
{
  const LoopContext context{ model, face, DomainBox(face.Geometry), gapLimit,
    SamePointPart * NetBox(face.Geometry).diagonal().norm() };
  for (std::int64_t l = 0; l < face.LoopCount; ++l)
  {
    const TrimLoop& loop = model.Loops[face.FirstLoop + l];
    const std::string name = "loop " + std::to_string(l) + ": ";
    std::string reason = CheckExcess(context, loop, name, warnings);
    reason = reason.empty() ? CheckGaps(context, loop, name, warnings) : reason;
    if (!reason.empty())
    {
      return reason;
    }
    // Samples cost more than control points, and a loop without area has them on a line.
    if (PolygonMeasure(ControlPolygon(model, loop, context.Domain)).IsFlat() &&
      PolygonMeasure(SampledPolygon(model, loop, context.Domain)).IsFlat())
    {
      warnings.push_back(name + "it encloses no area");
    }
  }
  return std::string();
}

bool IsNaturallyBounded(const Model& model, const Face& face)
{
  if (face.LoopCount != 1)
  {
    return face.LoopCount == 0;
  }
  const DomainBox domain(face.Geometry);
  const TrimLoop& loop = model.Loops[face.FirstLoop];
  for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
  {
    const CurveView<2>& curve = model.TrimCurves[c].Geometry;
    Box2 box;
    for (int i = 0; i < curve.Count; ++i)
    {
      box.extend(domain.Relative(curve.Point(i)));
    }
    const auto on = [&box](int dir, double side) {
      return std::abs(box.min()[dir] - side) <= NegligiblePart &&
        std::abs(box.max()[dir] - side) <= NegligiblePart;
    };
    if (!on(0, 0.0) && !on(0, 1.0) && !on(1, 0.0) && !on(1, 1.0))
    {
      return false;
    }
  }
  return PolygonMeasure(SampledPolygon(model, loop, domain)).Area > 2.0 - 8.0 * NegligiblePart;
}

namespace
{

/// The first use of an edge by a face that is sound.
struct EdgeUse
{
  std::int64_t Face = -1;
  std::int64_t Curve = -1;
};

std::vector<EdgeUse> FirstUses(const Model& model)
{
  std::vector<EdgeUse> uses(model.Edges.size());
  for (std::size_t f = 0; f < model.Faces.size(); ++f)
  {
    const Face& face = model.Faces[f];
    for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
    {
      const TrimLoop& loop = model.Loops[l];
      for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
      {
        const std::int64_t edge = model.TrimCurves[c].Edge;
        if (edge >= 0 && uses[edge].Face < 0)
        {
          uses[edge] = { static_cast<std::int64_t>(f), c };
        }
      }
    }
  }
  return uses;
}

/// Where edges are compared, as parts of their domain: both ends, and two places between that
/// symmetric deformations do not single out. A wave that leaves the ends and the middle in place moves
/// those.
constexpr std::array<double, 4> ComparedParts = { { 0.0, 1.0, 0.5683, 0.2137 } };
using ComparedPoints = std::array<Vec3, ComparedParts.size()>;

template <int D>
double ComparedParameter(const CurveView<D>& curve, double part)
{
  const Interval range = curve.Domain();
  return part == 1.0 ? range.Max : range.Clamp(range.Min + part * range.Length());
}

/// Points of a trim curve on its surface.
ComparedPoints LiftedPoints(const SurfaceView& surface, const CurveView<2>& curve)
{
  const DomainBox domain(surface);
  ComparedPoints points;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    const Vec2 uv = domain.Clamp(Evaluate(curve, ComparedParameter(curve, ComparedParts[i])));
    points[i] = Evaluate(surface, uv[0], uv[1]);
  }
  return points;
}

double SizeOf(const Box3& box)
{
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

/// Puts a moved pole to `point`, forgets any other curve.
void ReleaseEdge(AssembledModel& result, Edge& edge, const Vec3& point)
{
  if (edge.Geometry.Count == 1)
  {
    result.MovedPoles.push_back(Vec4(point[0], point[1], point[2], 1.0));
    edge.Geometry.Points = result.MovedPoles.back().data();
  }
  else
  {
    edge.Geometry = CurveView<3>();
  }
  edge.Tolerance = 0.0;
}

/// True if the edge's curve is known and farther than `limit` from the lifted trim curve.
bool CurveMoved(const Edge& edge, const ComparedPoints& lifted, double limit)
{
  const CurveView<3>& curve = edge.Geometry;
  for (std::size_t i = 0; i < lifted.size() && curve.Count > 0; ++i)
  {
    const Vec3 own = curve.Degree == 0
      ? curve.Point(0)
      : Evaluate(curve, ComparedParameter(curve, ComparedParts[i]));
    if (!((own - lifted[i]).norm() <= limit))
    {
      return true;
    }
  }
  return false;
}

} // namespace

Box3 BoxOfNets(const Model& model)
{
  Box3 box;
  for (const Face& face : model.Faces)
  {
    const Box3 net = NetBox(face.Geometry);
    if (!net.isEmpty())
    {
      box.extend(net);
    }
  }
  return box;
}

void ReleaseMovedEdges(AssembledModel& result, const Box3& around, const ParallelFor& parallel)
{
  Model& model = result.Model;
  const std::vector<EdgeUse> uses = FirstUses(model);
  const double negligible = 1e-6 * SizeOf(around.isEmpty() ? BoxOfNets(model) : around);
  std::vector<ComparedPoints> lifted(model.Edges.size());
  std::vector<char> moved(model.Edges.size(), 0);
  parallel(0, model.Edges.size(), [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t e = begin; e < end; ++e)
    {
      if (uses[e].Face >= 0)
      {
        const Edge& edge = model.Edges[e];
        lifted[e] = LiftedPoints(
          model.Faces[uses[e].Face].Geometry, model.TrimCurves[uses[e].Curve].Geometry);
        moved[e] = CurveMoved(edge, lifted[e], 4.0 * edge.Tolerance + negligible);
      }
    }
  });
  std::int64_t count = 0, first = -1;
  for (std::size_t e = 0; e < moved.size(); ++e)
  {
    Edge& edge = model.Edges[e];
    const bool unknown = edge.Geometry.Count == 0 && uses[e].Face >= 0;
    const double limit = 4.0 * edge.Tolerance + negligible;
    for (int i = 0; i < 2 && (moved[e] || unknown); ++i)
    {
      Vec3* vertex = edge.Vertex[i] >= 0 ? &model.Vertices[edge.Vertex[i]] : nullptr;
      if (vertex && !((*vertex - lifted[e][i]).norm() <= limit))
      {
        *vertex = lifted[e][i];
      }
    }
    if (moved[e])
    {
      first = ++count == 1 ? static_cast<std::int64_t>(e) : first;
      ReleaseEdge(result, edge, lifted[e][2]);
    }
  }
  if (count > 0)
  {
    result.Problems.push_back({ ModelProblem::Level::Warning, -1,
      std::to_string(count) + " of " + std::to_string(moved.size()) +
        " edges do not fit their faces (the first is edge " + std::to_string(first) +
        "), as after moving points; their 3D curves are ignored" });
  }
}

} // namespace nurbs
