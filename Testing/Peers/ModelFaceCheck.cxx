// SPDX-License-Identifier: BSD-3-Clause
#include "ModelFaceCheck.h"

#include "FaceSurface.h"
#include "FaceTrim.h"

#include <algorithm>
#include <array>
#include <limits>

namespace verify
{

namespace
{

constexpr double Infinity = std::numeric_limits<double>::infinity();

struct LiftedLoops
{
  std::vector<std::pair<Vec2, Vec2>> Segments;
  std::vector<Vec3> Points;
  std::vector<std::array<int, 3>> Lines;
  Vec2 Low = Vec2::Constant(Infinity), High = Vec2::Constant(-Infinity);

  bool Covers(const Vec2& uv) const
  {
    bool inside = false;
    for (const auto& [a, b] : this->Segments)
    {
      if ((a[1] > uv[1]) != (b[1] > uv[1]) &&
        uv[0] < a[0] + (uv[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
      {
        inside = !inside;
      }
    }
    return inside;
  }
};

class ModelFaceCheck
{
public:
  ModelFaceCheck(
    const TopoDS_Face& face, const nurbs::Model& model, std::size_t index, double scale)
    : Model(model)
    , Face(model.Faces[index])
    , Surface(face, 1e-9 * scale)
    , Trim(face, Surface, 1e-6 * scale)
    , Scale(scale)
  {
    this->Surface.SetRegion(this->Trim.Low(), this->Trim.High());
    this->Report.Seen = true;
  }

  ModelFaceReport Run()
  {
    for (std::int64_t l = 0; l < this->Face.LoopCount; ++l)
    {
      this->CheckLoop(this->Model.Loops[std::size_t(this->Face.FirstLoop + l)]);
    }
    this->CheckInside();
    ClosestTriangle tree;
    tree.Build(this->Loops.Points, this->Loops.Lines);
    for (const Vec3& p : this->Trim.BoundarySamples(this->Trim.Length() / 100.0))
    {
      const double d = this->Face.LoopCount > 0 ? tree.Find(p).Distance : 0.0;
      this->Report.Boundary = std::max(this->Report.Boundary, d);
    }
    return this->Report;
  }

private:
  void CheckLoop(const nurbs::TrimLoop& loop)
  {
    Vec3 firstStart = Vec3::Zero(), lastEnd = Vec3::Zero();
    Vec3 start = Vec3::Zero(), end = Vec3::Zero();
    for (std::int64_t c = 0; c < loop.CurveCount; ++c)
    {
      const auto& curve = this->Model.TrimCurves[std::size_t(loop.FirstCurve + c)];
      this->CheckCurve(curve, start, end);
      if (c > 0)
      {
        this->Report.LoopGap = std::max(this->Report.LoopGap, (start - lastEnd).norm());
      }
      firstStart = c == 0 ? start : firstStart;
      lastEnd = end;
    }
    this->Report.LoopGap = std::max(this->Report.LoopGap, (firstStart - lastEnd).norm());
  }

  void CheckCurve(const nurbs::TrimCurve& curve, Vec3& start, Vec3& end)
  {
    const nurbs::Interval domain = curve.Geometry.Domain();
    const int steps = 128 + 16 * curve.Geometry.Count;
    const nurbs::Edge* edge =
      curve.Edge >= 0 ? &this->Model.Edges[std::size_t(curve.Edge)] : nullptr;
    Vec2 before = Vec2::Zero();
    for (int i = 0; i <= steps; ++i)
    {
      const double s = curve.Reversed ? 1.0 - double(i) / steps : double(i) / steps;
      const double t = domain.Min + s * domain.Length();
      const Vec2 uv = nurbs::Evaluate(curve.Geometry, t);
      const Vec3 p = nurbs::Evaluate(this->Face.Geometry, uv[0], uv[1]);
      double d = this->Trim.BoundaryDistance(p, Infinity);
      d = d > 1e-7 * this->Scale ? this->Trim.BoundaryDistanceExactly(p) : d;
      this->Report.Loops = std::max(this->Report.Loops, d);
      this->Loops.Points.push_back(p);
      this->Loops.Low = this->Loops.Low.cwiseMin(uv);
      this->Loops.High = this->Loops.High.cwiseMax(uv);
      (i == 0 ? start : end) = p;
      if (i > 0)
      {
        const int at = int(this->Loops.Points.size()) - 1;
        this->Loops.Lines.push_back({ at - 1, at, at - 1 });
        this->Loops.Segments.emplace_back(before, uv);
        this->Report.Area += 0.5 * (before[0] * uv[1] - before[1] * uv[0]);
      }
      before = uv;
      if (edge && edge->Geometry.Count > 0)
      {
        const nurbs::Interval range = edge->Geometry.Domain();
        const Vec3 q = edge->Geometry.Degree == 0
          ? Vec3(edge->Geometry.Point(0))
          : nurbs::Evaluate(edge->Geometry, range.Min + s * range.Length());
        this->Report.Edges = std::max(this->Report.Edges, (p - q).norm());
        this->Report.Excess = std::max(this->Report.Excess, (p - q).norm() - edge->Tolerance);
      }
    }
  }

  void CheckInside()
  {
    const bool trimmed = this->Face.LoopCount > 0;
    Vec2 low = this->Loops.Low, high = this->Loops.High;
    for (int k = 0; k < 2 && !trimmed; ++k)
    {
      low[k] = this->Face.Geometry.Domain(k).Min;
      high[k] = this->Face.Geometry.Domain(k).Max;
    }
    const int steps = 14;
    int against = 0, along = 0;
    for (int i = 0; i < steps; ++i)
    {
      for (int j = 0; j < steps; ++j)
      {
        const Vec2 uv = low + (high - low).cwiseProduct(Vec2(i + 0.5, j + 0.5) / steps);
        if (trimmed && !this->Loops.Covers(uv))
        {
          continue;
        }
        const Vec3 p = nurbs::Evaluate(this->Face.Geometry, uv[0], uv[1]);
        Foot foot = this->Surface.ProjectGlobally(p);
        Vec2 theirs = foot.UV;
        double d = foot.Distance;
        if (!this->Trim.Covers(theirs) || d > 1e-6 * this->Scale)
        {
          foot = this->Surface.ProjectExhaustively(p, foot);
          theirs = foot.UV;
          d = this->Trim.Covers(theirs) ? foot.Distance : this->Trim.BoundaryDistance(p, Infinity);
        }
        this->Report.Surface = std::max(this->Report.Surface, d);
        const Vec3 normal = nurbs::Normal(this->Face.Geometry, uv[0], uv[1]);
        const double agreement =
          normal.dot(this->Surface.OuterNormal(theirs)) * (this->Face.Reversed ? -1.0 : 1.0);
        against += agreement < -0.1;
        along += agreement > 0.1;
      }
    }
    this->Report.Inverted = against > along;
  }

  const nurbs::Model& Model;
  const nurbs::Face& Face;
  FaceSurface Surface;
  FaceTrim Trim;
  double Scale;
  LiftedLoops Loops;
  ModelFaceReport Report;
};

} // namespace

ModelFaceReport CheckModelFace(
  const TopoDS_Face& face, const nurbs::Model& model, std::size_t index, double scale)
{
  return ModelFaceCheck(face, model, index, scale).Run();
}

} // namespace verify
