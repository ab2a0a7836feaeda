// SPDX-License-Identifier: BSD-3-Clause
#include "EdgeDiscretizer.h"

#include "CompletedModel.h"
#include "FacetBound.h"
#include "SurfaceEvaluator.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{
constexpr int VotePasses = 6;
constexpr double CurveShare = 0.95; // Of the tolerance, for an edge without gaps.
constexpr double NearVertex = 0.01; // In tolerances.
constexpr int GapSamples = 9;       // Steps between the places where gaps are sampled,
constexpr double CleanShare = 1e-3; // gaps below this share of the tolerance need no closer look,
constexpr int GapPasses = 3;        // which can be repeated as often as this.

} // namespace

namespace
{
// Parameters in (0, 1) where a Bezier function changes sign, by subdivision.
void FindRoots(
  const std::vector<Vec<1>>& f, double t0, double t1, int depth, std::vector<double>& roots)
{
  bool positive = false;
  bool negative = false;
  for (const Vec<1>& c : f)
  {
    positive = positive || c[0] > 0.0;
    negative = negative || c[0] < 0.0;
  }
  if (!positive || !negative)
  {
    return;
  }
  if (depth == 0)
  {
    roots.push_back(0.5 * (t0 + t1));
    return;
  }
  std::vector<Vec<1>> left(f.size());
  std::vector<Vec<1>> right(f.size());
  SplitBezier<1>(f.data(), int(f.size()) - 1, 0.5, left.data(), right.data());
  const double tm = 0.5 * (t0 + t1);
  FindRoots(left, t0, tm, depth - 1, roots);
  if (left.back()[0] == 0.0)
  {
    roots.push_back(tm);
  }
  FindRoots(right, tm, t1, depth - 1, roots);
}

bool IsStraight(const CurveView<2>& c)
{
  const Vec2 a = c.Point(0);
  const Vec2 d = c.Point(c.Count - 1) - a;
  const double length = d.squaredNorm();
  for (int i = 1; i + 1 < c.Count; ++i)
  {
    const Vec2 p = c.Point(i) - a;
    if (std::abs(d[0] * p[1] - d[1] * p[0]) > 1e-10 * length)
    {
      return false;
    }
  }
  return length > 0.0;
}

class Discretizer
{
public:
  Discretizer(const Model& model, std::int64_t edge, const std::vector<EdgeUse>& uses,
    const std::vector<FaceContext>& faces, double tolerance, const TessellatorOptions& options)
    : Data(model)
    , EdgeIndex(edge)
    , Uses(uses)
    , Faces(faces)
    , Tolerance(tolerance)
    , Options(options)
    , Domain(EdgeDomain(model, edge, uses))
  {
    this->Evaluators.reserve(uses.size());
    for (const EdgeUse& use : uses)
    {
      this->Evaluators.push_back(faces[use.Face].Bound->Evaluator());
    }
  }

  EdgePolyline Run(const std::vector<double>& extra)
  {
    this->ChooseCurve();
    this->Subdivide(extra);
    // Gaps where the vertices came to lie can be larger than those of the samples; each repetition
    // leaves more room for them.
    for (int pass = 0; this->Out.Gap > CleanShare * this->Tolerance && pass < GapPasses; ++pass)
    {
      const double gap = this->GapOfVertices();
      const bool enough =
        gap <= this->Out.Gap || this->Out.Error + this->Out.VertexGap + gap <= this->Tolerance;
      this->Out.Gap = std::max(this->Out.Gap, gap);
      if (enough)
      {
        break;
      }
      this->Subdivide(extra);
    }
    return std::move(this->Out);
  }

private:
  // Parameters and points, by what the gaps known so far leave of the tolerance.
  void Subdivide(const std::vector<double>& extra)
  {
    std::vector<double>& ts = this->Out.Parameters;
    std::vector<double> inner =
      ApproximateCurve(this->Pieces, this->Goal(), this->Options.Curves, this->Out.Error);
    ts = { this->Domain.Min, this->Domain.Max };
    this->Insert(inner);
    std::vector<double> forced = extra;
    this->CreaseCrossings(forced);
    this->DropNearVertices(forced, extra.size());
    std::sort(forced.begin(), forced.end());
    this->Insert(forced);
    this->LimitLength();
    const Edge& edge = this->Data.Edges[this->EdgeIndex];
    if (edge.Vertex[0] == edge.Vertex[1] && ts.size() < 4)
    {
      const double quarter = 0.25 * this->Domain.Length();
      this->Insert({ this->Domain.Min + quarter, this->Domain.Min + 2.0 * quarter,
        this->Domain.Min + 3.0 * quarter });
    }
    for (int pass = 0; this->Vote(pass < VotePasses); ++pass)
    {}
    this->Out.Error = std::max(this->Out.Error, this->ChordError);
    this->MakePoints();
  }

  double Gap() const { return this->Out.Gap + this->Out.VertexGap; }

  // Like Out.Gap, measured at the polyline's parameters.
  double GapOfVertices() const
  {
    double gap = 0.0;
    for (double t : this->Out.Parameters)
    {
      const Vec3 x = this->At(t);
      for (const EdgeUse& use : this->Uses)
      {
        gap = std::max(gap, (this->Lifted(use, t) - x).norm());
      }
    }
    return gap;
  }

  // What the polyline may be off its curve: what gaps leave, should that be enough to be worth it.
  double Goal() const
  {
    const double room = CurveShare * this->Tolerance - this->Gap();
    return room > 0.1 * this->Tolerance ? room : 0.3 * this->Tolerance;
  }

  // Where gaps are sampled: both ends, and places that no regular knots share, for curves that were
  // fitted to a trim curve have no gap at their knots.
  double GapSample(int k) const
  {
    const double phase = 0.618034 * k - std::floor(0.618034 * k);
    const double s = k == 0 ? 0.0
      : k == GapSamples     ? 1.0
                            : (k - 0.75 + 0.5 * phase) / (GapSamples - 1);
    return this->Domain.Min + this->Domain.Length() * s;
  }

  // Curves of dirty models leave the domain, beyond which a surface says nothing.
  Vec2 UV(const EdgeUse& use, double t) const
  {
    const TrimCurve& curve = this->Data.TrimCurves[use.Curve];
    const SurfaceView& s = this->Data.Faces[use.Face].Geometry;
    const Vec2 uv = Evaluate(curve.Geometry, TrimParameter(curve, this->Domain, t));
    return { s.Domain(0).Clamp(uv[0]), s.Domain(1).Clamp(uv[1]) };
  }

  Vec3 Lifted(const EdgeUse& use, double t) const
  {
    const Vec2 uv = this->UV(use, t);
    return this->Evaluator(use).Point(uv[0], uv[1]);
  }

  SurfaceEvaluator& Evaluator(const EdgeUse& use) const
  {
    return this->Evaluators[&use - this->Uses.data()];
  }

  // The edge's own 3D curve if it fits its faces and several share it; else the lowest face's lifted trim curve (control
  // points that a filter moved, models without edge curves).
  void ChooseCurve()
  {
    const Edge& edge = this->Data.Edges[this->EdgeIndex];
    double gap = 0.0;
    double size = 0.0;
    const bool known = edge.Geometry.Count > 1;
    for (const EdgeUse& use : this->Uses)
    {
      size = std::max(size, this->Faces[use.Face].Bound->Size());
    }
    for (int k = 0; k <= GapSamples && (known || this->Uses.size() > 1); ++k)
    {
      const double t = this->GapSample(k);
      const Vec3 x = known ? Evaluate(edge.Geometry, t) : this->Lifted(this->Uses[0], t);
      for (const EdgeUse& use : this->Uses)
      {
        gap = std::max(gap, (this->Lifted(use, t) - x).norm());
      }
    }
    const bool alone = this->Uses.size() == 1 && gap > 0.02 * this->Tolerance;
    this->OwnCurve = known && !alone && gap <= std::max(4.0 * edge.Tolerance, 1e-5 * size);
    if (known && !this->OwnCurve)
    {
      gap = 0.0;
      for (std::size_t i = 1; i < this->Uses.size(); ++i)
      {
        for (int k = 0; k <= GapSamples; ++k)
        {
          const double t = this->GapSample(k);
          gap =
            std::max(gap, (this->Lifted(this->Uses[i], t) - this->Lifted(this->Uses[0], t)).norm());
        }
      }
    }
    this->Out.Gap = this->OwnCurve ? std::max(gap, std::min(edge.Tolerance, 2.0 * gap)) : gap;
    // The first and last chord end in the model's vertices, a little beside the curve.
    this->Out.VertexGap =
      std::max((this->At(this->Domain.Min) - this->Data.Vertices[edge.Vertex[0]]).norm(),
        (this->At(this->Domain.Max) - this->Data.Vertices[edge.Vertex[1]]).norm());
    if (this->OwnCurve)
    {
      this->Pieces = ToBezier(edge.Geometry);
      return;
    }
    const EdgeUse& use = this->Uses.front();
    const TrimCurve& curve = this->Data.TrimCurves[use.Curve];
    this->Pieces = LiftTrimCurve(this->Data.Faces[use.Face].Geometry, curve.Geometry);
    const Interval own = curve.Geometry.Domain();
    const double scale = this->Domain.Length() / own.Length();
    if (own.Min != this->Domain.Min || own.Max != this->Domain.Max)
    {
      for (BezierCurve<3>& piece : this->Pieces)
      {
        piece.T0 = this->Domain.Min + (piece.T0 - own.Min) * scale;
        piece.T1 = this->Domain.Min + (piece.T1 - own.Min) * scale;
      }
    }
  }

  // Merges ascending parameters in, leaving out those that are too near to others.
  void Insert(const std::vector<double>& add)
  {
    const std::vector<double> old = this->Out.Parameters;
    const double eps = 1e-6 * this->Domain.Length();
    std::vector<double>& ts = this->Out.Parameters;
    ts.clear();
    std::size_t k = 0;
    for (double t : old)
    {
      for (; k < add.size() && add[k] < t; ++k)
      {
        if (!ts.empty() && add[k] - ts.back() > eps && t - add[k] > eps)
        {
          ts.push_back(add[k]);
        }
      }
      ts.push_back(t);
    }
  }

  // Triangles may not cross a crease of the surface: the edge has a vertex where it does.
  void CreaseCrossings(std::vector<double>& forced) const
  {
    for (const EdgeUse& use : this->Uses)
    {
      const SurfaceTree* tree = this->Faces[use.Face].Tree;
      if (!tree || (tree->Creases(0).empty() && tree->Creases(1).empty()))
      {
        continue;
      }
      const CurveView<2>& c = this->Data.TrimCurves[use.Curve].Geometry;
      const Interval own = c.Domain();
      for (const BezierCurve<2>& piece : ToBezier(c))
      {
        for (int d = 0; d < 2; ++d)
        {
          for (double knot : tree->Creases(d))
          {
            std::vector<Vec<1>> f;
            for (const Vec3& h : piece.Points)
            {
              f.push_back(Vec<1>(h[d] - knot * h[2]));
            }
            std::vector<double> roots;
            FindRoots(f, piece.T0, piece.T1, 40, roots);
            for (double t : roots)
            {
              forced.push_back(
                this->Domain.Min + (t - own.Min) * (this->Domain.Length() / own.Length()));
            }
          }
        }
      }
    }
  }

  // Of `forced`, from `first` on, leaves out what a vertex is so near to that faces put it on the crease.
  void DropNearVertices(std::vector<double>& forced, std::size_t first) const
  {
    const std::vector<double>& ts = this->Out.Parameters;
    const auto near = [&](double t) {
      const auto after = std::lower_bound(ts.begin(), ts.end(), t);
      const Vec3 x = this->At(t);
      const auto isNear = [&](double vertex) {
        return (this->At(vertex) - x).norm() < NearVertex * this->Tolerance;
      };
      return (after != ts.end() && isNear(*after)) || (after != ts.begin() && isNear(*(after - 1)));
    };
    forced.erase(
      std::remove_if(forced.begin() + std::ptrdiff_t(first), forced.end(), near), forced.end());
  }

  // Parameters are not lengths: pieces can come out longer than others, and once more too long.
  void LimitLength()
  {
    const double limit = this->Options.MaximumEdgeLength;
    for (int pass = 0; limit > 0.0 && pass < VotePasses; ++pass)
    {
      const std::vector<double> ts = this->Out.Parameters;
      std::vector<double> add;
      for (std::size_t k = 0; k + 1 < ts.size(); ++k)
      {
        const double length = (this->At(ts[k + 1]) - this->At(ts[k])).norm();
        const int n = int(std::min(1e6, std::ceil(length / limit)));
        for (int i = 1; i < n; ++i)
        {
          add.push_back(ts[k] + (ts[k + 1] - ts[k]) * i / n);
        }
      }
      if (add.empty())
      {
        return;
      }
      this->Insert(add);
    }
  }

  Vec3 At(double t) const
  {
    return this->OwnCurve ? Evaluate(this->Data.Edges[this->EdgeIndex].Geometry, t)
                          : this->Lifted(this->Uses.front(), t);
  }

  // Segments that the chord between two parameter points needs to stay at the surface; 1: fine.
  int ChordSegments(const EdgeUse& use, const Vec2& a, const Vec2& b, double& error) const
  {
    const SurfaceBound& bound = *this->Faces[use.Face].Bound;
    const double goal = this->Goal();
    const ParameterBox box{ std::min(a[0], b[0]), std::max(a[0], b[0]), std::min(a[1], b[1]),
      std::max(a[1], b[1]) };
    const double rest = bound.Over(box).Bow(box.A(), box.B());
    error = rest;
    if (error <= goal)
    {
      return 1;
    }
    // Between samples the curve is a mean of them plus the remainder (FacetBound.h).
    const bool guaranteed = this->Options.Error == ErrorMode::Guaranteed;
    SurfaceEvaluator& s = this->Evaluator(use);
    const Vec3 x0 = s.Point(a[0], a[1]);
    const Facet chord(x0, s.Point(b[0], b[1]), x0);
    double far = 0.0;
    for (int k = 4; k <= 16; k *= 2)
    {
      for (int i = 1; i < k; ++i)
      {
        const Vec2 p = a + (b - a) * (double(i) / k);
        double height;
        double distance;
        chord.Measure(s.Point(p[0], p[1]), height, distance);
        far = std::max(far, distance);
      }
      error = far + (guaranteed ? rest / (k * k) : 0.0);
      if (error <= goal || far > goal || !guaranteed)
      {
        break;
      }
    }
    return error <= goal ? 1 : std::max(2, std::min(64, int(std::ceil(std::sqrt(error / goal)))));
  }

  // Segments that a chord needs so that a triangle beside it, as deep as the tree's cells, can stay
  // within the tolerance; 1: fine.
  int DepthSegments(const EdgeUse& use, const Vec2& a, const Vec2& b) const
  {
    const FaceContext& face = this->Faces[use.Face];
    const double du = std::abs(b[0] - a[0]);
    const double dv = std::abs(b[1] - a[1]);
    const ParameterBox box{ std::min(a[0], b[0]), std::max(a[0], b[0]), std::min(a[1], b[1]),
      std::max(a[1], b[1]) };
    // Curvature as it is in the middle: what is certain comes with the triangles.
    const Vec2 middle = 0.5 * (a + b);
    const SurfaceView& s = face.Bound->View();
    const SurfaceDerivatives d = this->Evaluator(use).Derivatives(middle[0], middle[1], 2);
    const Vec3 cross = d.Su.cross(d.Sv);
    const double size = cross.norm();
    const Vec3 n = size > 1e-6 * d.Su.norm() * d.Sv.norm() ? Vec3(cross / size)
                                                           : Normal(s, middle[0], middle[1]);
    const double height[3] = { std::abs(n.dot(d.Suu)), std::abs(n.dot(d.Suv)),
      std::abs(n.dot(d.Svv)) };
    const double along =
      0.125 * (du * du * height[0] + 2.0 * du * dv * height[1] + dv * dv * height[2]);
    double most = 1.0;
    const std::vector<TreeLeaf>& leaves = face.Tree->Leaves();
    face.Tree->Query(box, [&](int k) {
      const ParameterBox& cell = leaves[k].Box;
      if (cell.A() < 0.02 * du || cell.B() < 0.02 * dv)
      {
        return;
      }
      const bool mostlyU = du * cell.B() > dv * cell.A();
      const double depth =
        0.7 * 0.125 * (mostlyU ? cell.B() * cell.B() * height[2] : cell.A() * cell.A() * height[0]);
      const double room = std::max(0.3 * this->Tolerance, CurveShare * this->Tolerance - depth);
      most = std::max(most, std::sqrt(along / room));
    });
    return std::min(64, int(std::ceil(most - 1e-3)));
  }

  // Segments that a chord needs so that the face's normals at its ends differ by no more than
  // MaximumAngle; 1: fine. Ends on creases have the normals of the chord's side.
  int AngleSegments(const EdgeUse& use, double t0, double t1) const
  {
    const double limit = this->Options.MaximumAngle;
    if (!(limit > 0.0))
    {
      return 1;
    }
    const SurfaceView& s = this->Faces[use.Face].Bound->View();
    const double inwards = BesideCrease * (t1 - t0);
    const Vec2 a = this->UV(use, t0 + inwards);
    const Vec2 b = this->UV(use, t1 - inwards);
    const double angle = Angle(Normal(s, a[0], a[1]), Normal(s, b[0], b[1]));
    return std::min(64, std::max(1, int(std::ceil(angle / limit * (1.0 - 1e-6)))));
  }

  // Every face looks at every chord in its own domain; returns true if it had to add parameters,
  // which it may with `mayAdd` only.
  bool Vote(bool mayAdd)
  {
    std::vector<double> add;
    this->ChordError = 0.0;
    for (const EdgeUse& use : this->Uses)
    {
      const FaceContext& face = this->Faces[use.Face];
      if (!face.Tree)
      {
        continue;
      }
      const bool straight = IsStraight(this->Data.TrimCurves[use.Curve].Geometry);
      const std::vector<double>& ts = this->Out.Parameters;
      Vec2 a = this->UV(use, ts[0]);
      for (std::size_t k = 0; k + 1 < ts.size(); ++k)
      {
        const Vec2 b = this->UV(use, ts[k + 1]);
        double error = 0.0;
        int n = straight ? 1 : this->ChordSegments(use, a, b, error);
        this->ChordError = std::max(this->ChordError, error);
        n = std::max(n, this->DepthSegments(use, a, b));
        n = std::max(n, this->AngleSegments(use, ts[k], ts[k + 1]));
        for (int i = 1; i < n; ++i)
        {
          add.push_back(ts[k] + (ts[k + 1] - ts[k]) * i / n);
        }
        a = b;
      }
    }
    if (!mayAdd)
    {
      return false;
    }
    std::sort(add.begin(), add.end());
    const std::size_t before = this->Out.Parameters.size();
    this->Insert(add);
    return this->Out.Parameters.size() > before;
  }

  void MakePoints()
  {
    const Edge& edge = this->Data.Edges[this->EdgeIndex];
    const std::vector<double>& ts = this->Out.Parameters;
    this->Out.Points.resize(ts.size());
    this->Out.Points.front() = this->Data.Vertices[edge.Vertex[0]];
    this->Out.Points.back() = this->Data.Vertices[edge.Vertex[1]];
    for (std::size_t k = 1; k + 1 < ts.size(); ++k)
    {
      this->Out.Points[k] = this->At(ts[k]);
    }
  }

  const Model& Data;
  std::int64_t EdgeIndex;
  const std::vector<EdgeUse>& Uses;
  const std::vector<FaceContext>& Faces;
  double Tolerance;
  const TessellatorOptions& Options;
  Interval Domain;
  bool OwnCurve = false;
  std::vector<BezierCurve<3>> Pieces;
  mutable std::vector<SurfaceEvaluator> Evaluators; ///< One a use.
  EdgePolyline Out;
  double ChordError = 0.0; ///< Of the chords in the faces' domains.
};
} // namespace

EdgePolyline DiscretizeEdge(const Model& model, std::int64_t edge, const std::vector<EdgeUse>& uses,
  const std::vector<FaceContext>& faces, double tolerance, const TessellatorOptions& options,
  const std::vector<double>& extra)
{
  if (IsDegenerate(model.Edges[edge]))
  {
    EdgePolyline pole;
    pole.Degenerate = true;
    const Interval domain = EdgeDomain(model, edge, uses);
    pole.Parameters = { domain.Min, domain.Max };
    pole.Points.assign(2, model.Vertices[model.Edges[edge].Vertex[0]]);
    return pole;
  }
  return Discretizer(model, edge, uses, faces, tolerance, options).Run(extra);
}

} // namespace nurbs
