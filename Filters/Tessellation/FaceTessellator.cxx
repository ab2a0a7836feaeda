// SPDX-License-Identifier: BSD-3-Clause
#include "FaceTessellator.h"

#include "BorderTriangulation.h"
#include "FacetBound.h"
#include "LoopRepair.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace nurbs
{

namespace
{
constexpr double CutMargin = 0.08; // Leaves this near to a trim line (in their size) count as cut.

class FaceBuilder
{
public:
  FaceBuilder(const FaceJob& job, std::vector<SplitRequest>& requests, std::vector<int>& weakLeaves)
    : Job(job)
    , Data(*job.Data)
    , TheFace(job.Data->Faces[job.Face])
    , Requests(requests)
    , WeakLeaves(weakLeaves)
    , Evaluator(job.Bound->Evaluator())
  {}

  FaceMesh Run()
  {
    this->MakeLoops();
    if (!this->Requests.empty() || this->Loops.empty())
    {
      return this->Finish();
    }
    if (!this->CheckLoops())
    {
      return this->Finish();
    }
    TrimRegion region(this->Loops);
    this->AddBoundary();
    if (this->Job.Tree ? this->Curved(region) : this->Planar(region))
    {
      this->Certify();
    }
    return this->Finish();
  }

private:
  // --- Step 1: the loops as directed polygons -------------------------------------------------

  void MakeLoops()
  {
    const std::int64_t end = this->TheFace.FirstLoop + this->TheFace.LoopCount;
    for (std::int64_t l = this->TheFace.FirstLoop; l < end; ++l)
    {
      std::vector<BoundaryVertex> loop;
      const TrimLoop& source = this->Data.Loops[l];
      for (std::int64_t k = 0; k < source.CurveCount; ++k)
      {
        this->AppendCurve(source.FirstCurve + k, loop);
      }
      this->CloseLoop(loop);
      if (this->IsLoopThin(loop))
      {
        this->RequestMiddles(loop);
        if (this->Job.LastPass)
        {
          this->Note(FaceStatus::Repaired, "a loop without area was dropped");
        }
        continue;
      }
      this->Loops.push_back(std::move(loop));
    }
    if (this->Loops.empty() && this->Requests.empty())
    {
      this->Note(FaceStatus::Failed, "its loops enclose no area");
    }
  }

  void AppendCurve(std::int64_t index, std::vector<BoundaryVertex>& loop)
  {
    const TrimCurve& curve = this->Data.TrimCurves[index];
    const EdgePolyline& edge = (*this->Job.Edges)[curve.Edge];
    const Interval domain{ edge.Parameters.front(), edge.Parameters.back() };
    std::vector<double> ts = edge.Parameters;
    if (edge.Degenerate)
    {
      this->PoleParameters(curve, domain, ts);
    }
    const int n = int(ts.size());
    std::vector<BoundaryVertex> part(n);
    for (int k = 0; k < n; ++k)
    {
      const int i = curve.Reversed ? n - 1 - k : k;
      part[k].UV = Evaluate(curve.Geometry, TrimParameter(curve, domain, ts[i]));
      part[k].X = edge.Degenerate ? edge.Points[0] : edge.Points[i];
      part[k].Edge = curve.Edge;
      part[k].T0 = ts[i];
      part[k].T1 = k + 1 < n ? ts[curve.Reversed ? i - 1 : i + 1] : ts[i];
    }
    this->ClampPart(part);
    if (!loop.empty() && this->SameSpot(loop.back().UV, part.front().UV))
    {
      loop.pop_back();
    }
    else if (!loop.empty())
    {
      loop.back().Edge = -1; // A jump along a pole, or a gap that is closed by a straight segment.
      this->NoteGap(loop.back(), part.front());
    }
    loop.insert(loop.end(), part.begin(), part.end());
  }

  // A degenerate side has one point, but as many parameters as the cells there have corners.
  void PoleParameters(const TrimCurve& curve, const Interval& domain, std::vector<double>& ts)
  {
    if (!this->Job.Tree)
    {
      return;
    }
    const Vec2 a = Evaluate(curve.Geometry, TrimParameter(curve, domain, domain.Min));
    const Vec2 b = Evaluate(curve.Geometry, TrimParameter(curve, domain, domain.Max));
    const int d = std::abs(b[0] - a[0]) >= std::abs(b[1] - a[1]) ? 0 : 1;
    std::vector<double> inner;
    const auto add = [&](double line) {
      const double t = (line - a[d]) / (b[d] - a[d]);
      if (t > 1e-6 && t < 1.0 - 1e-6)
      {
        inner.push_back(domain.Min + t * domain.Length());
      }
    };
    this->Job.Tree->QuerySegment(a, b, 1e-9, [&](int k) {
      const ParameterBox& box = this->Job.Tree->Leaves()[k].Box;
      add(d == 0 ? box.U0 : box.V0);
      add(d == 0 ? box.U1 : box.V1);
    });
    std::sort(inner.begin(), inner.end());
    inner.erase(std::unique(inner.begin(), inner.end()), inner.end());
    ts.insert(ts.begin() + 1, inner.begin(), inner.end());
  }

  // Puts vertices inside the domain, and those beside a crease on it unless others are as near.
  void ClampPart(std::vector<BoundaryVertex>& part) const
  {
    std::vector<Vec2> raw;
    for (const BoundaryVertex& v : part)
    {
      raw.push_back(v.UV);
    }
    const auto apart = [&](std::size_t i, std::size_t j) {
      const Vec2 d = (raw[i] - raw[j]).cwiseAbs();
      return d[0] > 4.0 * this->Job.Snap[0] || d[1] > 4.0 * this->Job.Snap[1];
    };
    for (std::size_t k = 0; k < part.size(); ++k)
    {
      const bool free = (k == 0 || apart(k, k - 1)) && (k + 1 == part.size() || apart(k, k + 1));
      part[k].UV = this->Clamp(raw[k], free);
    }
  }

  Vec2 Clamp(const Vec2& uv, bool snap) const
  {
    Vec2 p = uv;
    for (int d = 0; d < 2; ++d)
    {
      const Interval domain = this->TheFace.Geometry.Domain(d);
      const double eps = 1e-10 * domain.Length();
      p[d] = p[d] < domain.Min + eps ? domain.Min : p[d] > domain.Max - eps ? domain.Max : p[d];
      if (!this->Job.Tree)
      {
        continue;
      }
      const double near = std::max(snap ? this->Job.Snap[d] : 0.0, 3e3 * eps);
      for (double crease : this->Job.Tree->Creases(d))
      {
        p[d] = std::abs(p[d] - crease) <= near ? crease : p[d];
      }
      // The tree may begin at a knot a little inside the boundary.
      const std::vector<double>& lines = this->Job.Tree->Lines(d);
      if (snap)
      {
        p[d] = Interval{ lines.front(), lines.back() }.Clamp(p[d]);
      }
    }
    return p;
  }

  bool SameSpot(const Vec2& a, const Vec2& b) const
  {
    const SurfaceView& s = this->TheFace.Geometry;
    return std::abs(a[0] - b[0]) <= 1e-5 * s.Domain(0).Length() &&
      std::abs(a[1] - b[1]) <= 1e-5 * s.Domain(1).Length();
  }

  void NoteGap(const BoundaryVertex& a, const BoundaryVertex& b)
  {
    const double gap = (a.X - b.X).norm();
    if (gap > this->Job.Tolerance)
    {
      this->Note(FaceStatus::Repaired, "a loop's gap of " + std::to_string(gap) + " was closed");
    }
  }

  void CloseLoop(std::vector<BoundaryVertex>& loop)
  {
    if (loop.size() > 1 && this->SameSpot(loop.back().UV, loop.front().UV))
    {
      loop.pop_back();
    }
    std::vector<BoundaryVertex> distinct;
    for (const BoundaryVertex& v : loop)
    {
      if (distinct.empty() || distinct.back().UV != v.UV)
      {
        distinct.push_back(v);
      }
    }
    while (distinct.size() > 1 && distinct.back().UV == distinct.front().UV)
    {
      distinct.pop_back();
    }
    loop.swap(distinct);
  }

  // A loop whose polygon collapsed although its curves enclose something.
  bool IsLoopThin(const std::vector<BoundaryVertex>& loop) const
  {
    if (loop.size() < 3)
    {
      return true;
    }
    Box2 box;
    double area = 0.0;
    for (std::size_t k = 0; k < loop.size(); ++k)
    {
      const Vec2 a = loop[k].UV - loop[0].UV;
      const Vec2 b = loop[(k + 1) % loop.size()].UV - loop[0].UV;
      area += a[0] * b[1] - a[1] * b[0];
      box.extend(loop[k].UV);
    }
    return std::abs(area) <= 1e-13 * box.diagonal().squaredNorm();
  }

  void RequestMiddles(const std::vector<BoundaryVertex>& loop)
  {
    for (const BoundaryVertex& v : loop)
    {
      if (v.Edge >= 0 && !(*this->Job.Edges)[v.Edge].Degenerate && !this->Job.LastPass)
      {
        this->Requests.push_back({ v.Edge, 0.5 * (v.T0 + v.T1) });
      }
    }
  }

  void Note(FaceStatus status, const std::string& message)
  {
    this->Mesh.Status = std::max(this->Mesh.Status, status);
    this->Mesh.Message += (this->Mesh.Message.empty() ? "" : "; ") + message;
  }

  // The loops where they are triangulated: in the plane of a planar face, in (u, v) otherwise.
  Loops2 FlatLoops() const
  {
    Loops2 flat(this->Loops.size());
    Vec3 normal = Vec3::Zero();
    double distance = 0.0;
    if (!this->Job.Tree)
    {
      this->Job.Bound->IsPlanar(1e300, normal, distance);
    }
    const Vec3 e1 = normal.unitOrthogonal();
    Vec3 e2 = normal.cross(e1);
    double plane = 0.0;
    double parameters = 0.0;
    const Vec3 o = this->Loops[0][0].X;
    for (int pass = 0; pass < 2; ++pass)
    {
      for (std::size_t l = 0; l < this->Loops.size(); ++l)
      {
        std::vector<Vec2> uv;
        flat[l].clear();
        for (const BoundaryVertex& v : this->Loops[l])
        {
          uv.push_back(v.UV);
          flat[l].push_back(this->Job.Tree ? v.UV : Vec2(e1.dot(v.X - o), e2.dot(v.X - o)));
        }
        plane += SignedArea2(flat[l]);
        parameters += SignedArea2(uv);
      }
      if (pass == 0 && (plane < 0.0) == (parameters < 0.0))
      {
        break;
      }
      e2 = -e2; // The plane's frame turns as (u, v) does.
    }
    return flat;
  }

  // Loops that cross: polylines too coarse ask for finer ones; loops that cross as curves, or run the
  // wrong way, are repaired. False: the face can't go on.
  bool CheckLoops()
  {
    const Loops2 flat = this->FlatLoops();
    CrossingFinder finder;
    const auto& crossings = finder.Find(flat);
    if (!crossings.empty() && !this->Job.LastPass)
    {
      std::vector<const BoundaryVertex*> sides;
      for (const auto& loop : this->Loops)
      {
        for (const BoundaryVertex& v : loop)
        {
          sides.push_back(&v);
        }
      }
      for (const auto& pair : crossings)
      {
        this->RequestSplit(*sides[pair.first]);
        this->RequestSplit(*sides[pair.second]);
      }
      if (!this->Requests.empty())
      {
        return false;
      }
    }
    int outer = 0;
    double largest = 0.0;
    for (const auto& loop : flat)
    {
      const double area = SignedArea2(loop);
      outer += area > 0.0;
      largest = std::abs(area) > std::abs(largest) ? area : largest;
    }
    if (crossings.empty() && outer == 1 && largest > 0.0)
    {
      return true;
    }
    return this->Repair(flat);
  }

  bool Repair(const Loops2& flat)
  {
    RepairedLoops repaired;
    try
    {
      repaired = RepairLoops(flat);
    }
    catch (const Error& error)
    {
      this->Note(FaceStatus::Failed, error.what());
      return false;
    }
    if (!repaired.Changed)
    {
      return true;
    }
    this->Note(FaceStatus::Repaired, repaired.Message);
    std::vector<BoundaryVertex> from;
    std::vector<int> next;
    for (const auto& loop : this->Loops)
    {
      const int first = int(from.size());
      for (std::size_t k = 0; k < loop.size(); ++k)
      {
        from.push_back(loop[k]);
        next.push_back(first + int((k + 1) % loop.size()));
      }
    }
    std::vector<std::vector<BoundaryVertex>> loops;
    for (const auto& loop : repaired.Loops)
    {
      std::vector<BoundaryVertex> out;
      for (const RepairedVertex& r : loop)
      {
        const BoundaryVertex& a = from[r.Side];
        const BoundaryVertex& b = from[next[r.Side]];
        BoundaryVertex v = r.Source >= 0 ? from[r.Source] : a;
        if (r.Source < 0)
        {
          // On the shared chord, so that no gap opens to the neighbour.
          v.X = a.X + r.S0 * (b.X - a.X);
          v.UV = this->Job.Tree ? r.P : Vec2(a.UV + r.S0 * (b.UV - a.UV));
        }
        v.Edge = a.Edge;
        v.T0 = a.T0 + r.S0 * (a.T1 - a.T0);
        v.T1 = a.T0 + r.S1 * (a.T1 - a.T0);
        out.push_back(v);
      }
      if (out.size() >= 3)
      {
        loops.push_back(std::move(out));
      }
    }
    this->Loops.swap(loops);
    if (this->Loops.empty())
    {
      this->Note(FaceStatus::Failed, "its loops enclose no area");
    }
    return !this->Loops.empty();
  }

  void AddBoundary()
  {
    for (const auto& loop : this->Loops)
    {
      const int first = int(this->Mesh.UV.size());
      for (std::size_t k = 0; k < loop.size(); ++k)
      {
        const BoundaryVertex& v = loop[k];
        this->Next.push_back(first + int((k + 1) % loop.size()));
        this->Mesh.UV.push_back(v.UV);
        this->Mesh.Points.push_back(v.X);
        this->Segments.push_back(&v);
      }
    }
    this->BoundaryCount = int(this->Mesh.UV.size());
    this->EvaluateFrom(0, true);
  }

  // Points (unless they are given) and normals of vertices from `first` on.
  void EvaluateFrom(std::size_t first, bool pointsGiven)
  {
    const std::int64_t n = std::int64_t(this->Mesh.UV.size() - first);
    std::vector<double> points(3 * n);
    std::vector<double> normals(3 * n);
    const auto body = [&](std::int64_t begin, std::int64_t end) {
      SurfaceEvaluator evaluator(this->Job.Bound->Evaluator());
      evaluator.Batch(this->Mesh.UV.data() + first + begin, end - begin, points.data() + 3 * begin,
        normals.data() + 3 * begin);
    };
    if (n > 8192)
    {
      this->Job.Parallel(0, n, body);
    }
    else
    {
      body(0, n);
    }
    this->Mesh.Points.resize(this->Mesh.UV.size());
    this->Mesh.Normals.resize(this->Mesh.UV.size());
    for (std::int64_t k = 0; k < n; ++k)
    {
      const Vec3 x = Eigen::Map<const Vec3>(points.data() + 3 * k);
      this->Mesh.Normals[first + k] = Eigen::Map<const Vec3>(normals.data() + 3 * k);
      if (pointsGiven)
      {
        this->Gap = std::max(this->Gap, (x - this->Mesh.Points[first + k]).norm());
      }
      else
      {
        this->Mesh.Points[first + k] = x;
      }
    }
  }

  // --- Step 2: planar faces: the loops in their plane -------------------------------------------

  bool Planar(const TrimRegion& region)
  {
    Vec3 normal = Vec3::Zero();
    this->Job.Bound->IsPlanar(1e300, normal, this->Flatness);
    this->Scale = Vec2(1.0, 1.0);
    std::vector<Vec2> flat;
    for (const auto& loop : this->FlatLoops())
    {
      flat.insert(flat.end(), loop.begin(), loop.end());
    }
    return this->FillBorder(region, flat, {}, {});
  }

  // --- Step 3: curved faces: whole cells, and the zone between them and the trim lines -----------

  bool Curved(const TrimRegion& region)
  {
    CellZone zone(*this->Job.Tree, region, CutMargin);
    this->Scale = zone.Scale();
    this->IsWholeLeaf.assign(this->Job.Tree->Leaves().size(), 0);
    for (int k : zone.WholeLeaves())
    {
      this->IsWholeLeaf[k] = 1;
    }
    const int first = int(this->Mesh.UV.size());
    for (const Vec2& uv : zone.Points())
    {
      this->Mesh.UV.push_back(uv);
    }
    this->EvaluateFrom(first, false);
    const std::size_t corners = zone.Points().size();
    zone.TriangulateWhole(
      [&](const CellZone::Triangle& t) {
        const int corner[3] = { t.Corner[0] + first, t.Corner[1] + first, t.Corner[2] + first };
        return this->TriangleError(corner, -1 - t.Leaf) <= this->Limit();
      },
      *this->Job.States, this->Job.Parallel);
    const std::size_t middles = this->Mesh.UV.size();
    this->Mesh.UV.insert(this->Mesh.UV.end(), zone.Points().begin() + corners, zone.Points().end());
    this->EvaluateFrom(middles, false);
    for (const CellZone::Triangle& t : zone.Triangles())
    {
      this->Mesh.Triangles.insert(this->Mesh.Triangles.end(),
        { t.Corner[0] + first, t.Corner[1] + first, t.Corner[2] + first });
      this->Leaf.push_back(t.Whole ? t.Leaf : -1 - t.Leaf);
    }
    std::vector<Vec2> flat(this->Mesh.UV.size());
    for (std::size_t k = 0; k < flat.size(); ++k)
    {
      flat[k] = this->Mesh.UV[k].cwiseProduct(this->Scale);
    }
    std::vector<std::pair<int, int>> sides;
    for (const auto& side : zone.OpenSides())
    {
      sides.emplace_back(side.first + first, side.second + first);
    }
    return this->FillBorder(region, flat, sides, zone.FreePoints());
  }

  // The zone with `flat` coordinates (one a vertex so far): loops, sides of whole cells, and the
  // vertices `free` (indices relative to the boundary's end).
  bool FillBorder(const TrimRegion& region, const std::vector<Vec2>& flat,
    const std::vector<std::pair<int, int>>& sides, const std::vector<int>& free)
  {
    BorderTriangulation border;
    std::vector<int> idOf(flat.size(), -1);
    std::vector<int> vertexOf;
    const auto add = [&](int vertex, const Vec2& p) {
      const int id = border.AddPoint(p);
      if (id == int(vertexOf.size()))
      {
        vertexOf.push_back(vertex);
      }
      return id;
    };
    for (int k = 0; k < this->BoundaryCount; ++k)
    {
      idOf[k] = add(k, flat[k]);
    }
    for (const auto& side : region.Segments())
    {
      if (!border.AddSegment(idOf[side.first], idOf[side.second]))
      {
        this->Note(FaceStatus::Failed, "its loops cross and could not be repaired");
        return false;
      }
    }
    for (const auto& side : sides)
    {
      for (int end : { side.first, side.second })
      {
        idOf[end] = idOf[end] < 0 ? add(end, flat[end]) : idOf[end];
      }
    }
    for (const auto& side : sides)
    {
      border.AddSegment(idOf[side.first], idOf[side.second]);
    }
    for (int k : free)
    {
      const int vertex = k + this->BoundaryCount;
      idOf[vertex] = add(vertex, flat[vertex]);
    }
    this->AddCreases(border, vertexOf, region);
    this->Refine(border, vertexOf);
    return true;
  }

  void RequestSplit(const BoundaryVertex& v)
  {
    if (v.Edge >= 0 && !this->Job.LastPass && !(*this->Job.Edges)[v.Edge].Degenerate)
    {
      this->Requests.push_back({ v.Edge, 0.5 * (v.T0 + v.T1) });
    }
  }

  // Vertices along every crease, joined where the face goes on between them.
  void AddCreases(BorderTriangulation& border, std::vector<int>& vertexOf, const TrimRegion& region)
  {
    if (!this->Job.Tree)
    {
      return;
    }
    const std::size_t before = this->Mesh.UV.size();
    for (double u : this->Job.Tree->Creases(0))
    {
      for (double v : this->Job.Tree->Creases(1))
      {
        const Vec2 p(u, v);
        if (region.Inside(p) && !this->IsInWholeCell(p))
        {
          const int id = border.AddPoint(p.cwiseProduct(this->Scale));
          if (id == int(vertexOf.size()))
          {
            vertexOf.push_back(int(this->Mesh.UV.size()));
            this->Mesh.UV.push_back(p);
          }
        }
      }
    }
    this->EvaluateFrom(before, false);
    for (int d = 0; d < 2; ++d)
    {
      for (double crease : this->Job.Tree->Creases(d))
      {
        std::vector<std::pair<double, int>> on;
        for (std::size_t id = 0; id < vertexOf.size(); ++id)
        {
          const Vec2& uv = this->Mesh.UV[vertexOf[id]];
          if (uv[d] == crease)
          {
            on.emplace_back(uv[1 - d], int(id));
          }
        }
        std::sort(on.begin(), on.end());
        for (std::size_t k = 0; k + 1 < on.size(); ++k)
        {
          Vec2 middle;
          middle[d] = crease;
          middle[1 - d] = 0.5 * (on[k].first + on[k + 1].first);
          if (!border.IsConstrained(on[k].second, on[k + 1].second) && region.Inside(middle) &&
            !this->IsInWholeCell(middle) &&
            !region.Crosses(d, crease, on[k].first, on[k + 1].first))
          {
            border.AddCrease(on[k].second, on[k + 1].second);
          }
        }
      }
    }
  }

  // True if all cells around p are whole: they have their own vertices.
  bool IsInWholeCell(const Vec2& p) const
  {
    bool whole = true;
    this->Job.Tree->Query(
      { p[0], p[0], p[1], p[1] }, [&](int k) { whole = whole && this->IsWholeLeaf[k]; });
    return whole;
  }

  // Adds vertices to the border zone until every triangle is good enough.
  void Refine(BorderTriangulation& border, std::vector<int>& vertexOf)
  {
    const std::size_t base = this->Mesh.Triangles.size();
    const std::size_t budget = this->Mesh.UV.size() + 3 * vertexOf.size() + 1000;
    std::vector<std::array<int, 3>> triangles;
    for (int pass = 0;; ++pass)
    {
      border.Triangles(triangles);
      this->Mesh.Triangles.resize(base);
      this->Leaf.resize(base / 3);
      for (auto& t : triangles)
      {
        for (int& id : t)
        {
          id = vertexOf[id];
        }
      }
      this->FlipEars(triangles);
      for (const auto& t : triangles)
      {
        this->Mesh.Triangles.insert(this->Mesh.Triangles.end(), t.begin(), t.end());
        this->Leaf.push_back(NoLeaf);
      }
      if (!this->Job.Tree || pass == 16 || this->Mesh.UV.size() > budget)
      {
        return;
      }
      const std::size_t before = this->Mesh.UV.size();
      this->SplitFailing(triangles, border, vertexOf);
      if (this->Mesh.UV.size() == before)
      {
        return;
      }
      this->EvaluateFrom(before, false);
    }
  }

  bool IsSegment(int a, int b) const { return a < this->BoundaryCount && this->Next[a] == b; }

  // Twice the area in (u, v), in units of cells.
  double ScaledArea2(int a, int b, int c) const
  {
    const Vec2 d = (this->Mesh.UV[b] - this->Mesh.UV[a]).cwiseProduct(this->Scale);
    const Vec2 e = (this->Mesh.UV[c] - this->Mesh.UV[a]).cwiseProduct(this->Scale);
    return d[0] * e[1] - d[1] * e[0];
  }

  // Thin triangles between two boundary segments stand across the surface, however short they are:
  // their third edge is exchanged for the other diagonal.
  void FlipEars(std::vector<std::array<int, 3>>& triangles) const
  {
    std::map<std::pair<int, int>, std::size_t> ears; // By the directed third edge.
    for (std::size_t k = 0; k < triangles.size(); ++k)
    {
      for (int i = 0; i < 3; ++i)
      {
        const int a = triangles[k][i];
        const int b = triangles[k][(i + 1) % 3];
        const int c = triangles[k][(i + 2) % 3];
        if (this->IsSegment(a, b) && this->IsSegment(b, c) && !this->IsSegment(c, a))
        {
          const double base =
            (this->Mesh.UV[c] - this->Mesh.UV[a]).cwiseProduct(this->Scale).squaredNorm();
          if (this->ScaledArea2(a, b, c) < 0.1 * base)
          {
            ears[{ c, a }] = k;
          }
        }
      }
    }
    for (std::size_t k = 0; k < triangles.size() && !ears.empty(); ++k)
    {
      for (int i = 0; i < 3; ++i)
      {
        const int a = triangles[k][i];
        const int c = triangles[k][(i + 1) % 3];
        const int d = triangles[k][(i + 2) % 3];
        const auto ear = ears.find({ c, a });
        if (ear == ears.end() || ear->second == k)
        {
          continue;
        }
        const auto& t = triangles[ear->second];
        const int b = t[0] != a && t[0] != c ? t[0] : (t[1] != a && t[1] != c ? t[1] : t[2]);
        if (this->ScaledArea2(a, b, d) > 0.0 && this->ScaledArea2(b, c, d) > 0.0)
        {
          triangles[ear->second] = { a, b, d };
          triangles[k] = { b, c, d };
          ears.erase(ear);
          break;
        }
      }
    }
  }

  void SplitFailing(const std::vector<std::array<int, 3>>& triangles, BorderTriangulation& border,
    std::vector<int>& vertexOf)
  {
    std::set<std::pair<int, int>> split;
    std::vector<int> idOf(this->Mesh.UV.size(), -1);
    for (std::size_t id = 0; id < vertexOf.size(); ++id)
    {
      idOf[vertexOf[id]] = int(id);
    }
    for (const auto& t : triangles)
    {
      if (this->IsCollapsed(t.data()) || this->IsTiny(t.data()))
      {
        continue;
      }
      FacetBound facet = this->Facet(t.data(), NoLeaf);
      const bool folded = facet.HasPlane() && this->IsFolded(t.data(), facet.Normal());
      if ((folded && this->SplitSegments(t.data())) ||
        (!folded && this->FacetError(t.data(), NoLeaf, facet) <= this->Limit()))
      {
        continue;
      }
      double longest = -1.0;
      std::pair<int, int> edge(-1, -1);
      for (int i = 0; i < 3; ++i)
      {
        const int a = t[i];
        const int b = t[(i + 1) % 3];
        const double length = facet.HasPlane()
          ? facet.EdgeHeight(i)
          : (this->Mesh.UV[a] - this->Mesh.UV[b]).cwiseProduct(this->Scale).norm();
        if (length > longest && !border.IsWall(idOf[a], idOf[b]))
        {
          longest = length;
          edge = std::minmax(a, b);
        }
      }
      Vec2 p;
      if (this->SplitsBoundary(t.data(), edge))
      {
        continue;
      }
      if (edge.first < 0)
      {
        p = (this->Mesh.UV[t[0]] + this->Mesh.UV[t[1]] + this->Mesh.UV[t[2]]) / 3.0;
      }
      else if (!split.insert(edge).second)
      {
        continue;
      }
      else
      {
        p = 0.5 * (this->Mesh.UV[edge.first] + this->Mesh.UV[edge.second]);
      }
      const int id = border.AddPoint(p.cwiseProduct(this->Scale));
      if (id == int(vertexOf.size()))
      {
        vertexOf.push_back(int(this->Mesh.UV.size()));
        this->Mesh.UV.push_back(p);
      }
    }
  }

  // Too small to gain from a split: the tolerance, or the gap of its boundary vertices, is as large.
  bool IsTiny(const int* t) const
  {
    double longest = 0.0;
    for (int i = 0; i < 3; ++i)
    {
      longest =
        std::max(longest, (this->Mesh.Points[t[(i + 1) % 3]] - this->Mesh.Points[t[i]]).norm());
    }
    return longest < std::max(0.5 * this->Job.Tolerance, 16.0 * this->Gap);
  }

  bool IsFolded(const int* t, const Vec3& n) const
  {
    return n.dot(this->Mesh.Normals[t[0]]) < 0.0 && n.dot(this->Mesh.Normals[t[1]]) < 0.0 &&
      n.dot(this->Mesh.Normals[t[2]]) < 0.0;
  }

  // Asks for vertices on a triangle's boundary segments; false: it has none that can be split.
  bool SplitSegments(const int* t)
  {
    const std::size_t before = this->Requests.size();
    for (int i = 0; i < 3; ++i)
    {
      if (this->IsSegment(t[i], t[(i + 1) % 3]))
      {
        this->RequestSplit(*this->Segments[t[i]]);
      }
    }
    return this->Requests.size() > before;
  }

  // A split of `edge` would leave a sliver at one of the triangle's boundary segments: asks for a
  // vertex on that segment instead.
  bool SplitsBoundary(const int* t, const std::pair<int, int>& edge)
  {
    bool asked = false;
    const Vec2 p = edge.first < 0
      ? Vec2((this->Mesh.UV[t[0]] + this->Mesh.UV[t[1]] + this->Mesh.UV[t[2]]) / 3.0)
      : Vec2(0.5 * (this->Mesh.UV[edge.first] + this->Mesh.UV[edge.second]));
    for (int i = 0; i < 3; ++i)
    {
      const int a = t[i];
      const int b = t[(i + 1) % 3];
      if (a >= this->BoundaryCount || b != this->Next[a] || this->Segments[a]->Edge < 0)
      {
        continue;
      }
      const Vec2 d = (this->Mesh.UV[b] - this->Mesh.UV[a]).cwiseProduct(this->Scale);
      const Vec2 e = (p - this->Mesh.UV[a]).cwiseProduct(this->Scale);
      const double length = d.squaredNorm();
      if (std::abs(d[0] * e[1] - d[1] * e[0]) < 0.2 * length)
      {
        this->RequestSplit(*this->Segments[a]);
        asked = true;
      }
    }
    return asked;
  }

  // --- Step 4: certification --------------------------------------------------------------------

  // Of a triangle's own error. A gap in the model that is near the tolerance or over it can't be
  // made up for by smaller triangles.
  double Limit() const
  {
    const double tolerance = this->Job.Tolerance;
    return this->Gap < 0.7 * tolerance ? tolerance - this->Gap : tolerance;
  }

  bool IsPole(int vertex) const
  {
    if (vertex >= this->BoundaryCount)
    {
      return false;
    }
    const std::int64_t edge = this->Segments[vertex]->Edge;
    return (edge >= 0 && (*this->Job.Edges)[edge].Degenerate) ||
      this->Mesh.Points[vertex] == this->Mesh.Points[this->Next[vertex]];
  }

  bool IsCollapsed(const int* t) const
  {
    const Vec3* x = this->Mesh.Points.data();
    return x[t[0]] == x[t[1]] || x[t[1]] == x[t[2]] || x[t[2]] == x[t[0]];
  }

  // Slope of the mesh around a triangle against it: twice the tangent of the angle between the
  // facet's normal and the surface's at the corners; 1 or more: too steep to use.
  double Slope(const int* t, const Vec3& n) const
  {
    double slope = 0.0;
    for (int i = 0; i < 3; ++i)
    {
      const double c = this->Mesh.Normals[t[i]].dot(n);
      if (c <= 0.5)
      {
        return 1.0;
      }
      slope = std::max(slope, 2.0 * std::sqrt(std::max(0.0, 1.0 / (c * c) - 1.0)));
    }
    return slope;
  }

  // Calls use(range, box) for the leaves that a triangle touches.
  template <typename F>
  void ForLeaves(const int* t, int leaf, F&& use) const
  {
    const std::vector<TreeLeaf>& leaves = this->Job.Tree->Leaves();
    if (leaf != NoLeaf)
    {
      use(leaves[-1 - leaf].Range, leaves[-1 - leaf].Box);
      return;
    }
    const ParameterBox box = this->BoxOf(t);
    const double a = 1e-7 * box.A();
    const double b = 1e-7 * box.B();
    this->Job.Tree->Query({ box.U0 + a, box.U1 - a, box.V0 + b, box.V1 - b },
      [&](int k) { use(leaves[k].Range, leaves[k].Box); });
  }

  FacetBound Facet(const int* t, int leaf) const
  {
    FacetBound facet(this->Mesh.Points[t[0]], this->Mesh.Points[t[1]], this->Mesh.Points[t[2]],
      this->Mesh.UV[t[0]], this->Mesh.UV[t[1]], this->Mesh.UV[t[2]]);
    for (int i = 0; i < 3; ++i)
    {
      if (this->IsPole(t[i]))
      {
        facet.SetPole(i);
      }
    }
    this->ForLeaves(t, leaf,
      [&](const CurvatureRange& range, const ParameterBox& box) { facet.Add(range, box); });
    return facet;
  }

  double FacetError(const int* t, int leaf, FacetBound& facet) const
  {
    if (!facet.HasPlane())
    {
      return facet.Deviation();
    }
    // From the cheapest bound to the dearest.
    const double slope = this->Slope(t, facet.Normal());
    double error =
      std::min(facet.Deviation(), SurfaceDistance(facet.Height(), facet.Deviation(), slope));
    if (error <= this->Limit())
    {
      return error;
    }
    this->ForLeaves(t, leaf,
      [&](const CurvatureRange& range, const ParameterBox& box) { facet.AddEdges(range, box); });
    error = std::min(error, SurfaceDistance(facet.Height(), facet.Sliding(), slope));
    if (error <= this->Limit())
    {
      return error;
    }
    return std::min(
      { error, facet.SegmentDeviation(), this->EdgeSliverError(t, facet), this->CloseError(t) });
  }

  // The bound from coefficients over the triangle's own parameter box: dearer and tighter than what
  // the tree's leaves know.
  double CloseError(const int* t) const
  {
    const SurfaceBound& bound = *this->Job.Bound;
    const Vec3* X = this->Mesh.Points.data();
    const Vec2* uv = this->Mesh.UV.data();
    FacetBound facet(X[t[0]], X[t[1]], X[t[2]], uv[t[0]], uv[t[1]], uv[t[2]]);
    const ParameterBox box = this->BoxOf(t);
    if (!facet.HasPlane() || !(box.A() > 0.0) || !(box.B() > 0.0) || this->CrossesCrease(box))
    {
      return 1e300;
    }
    BezierPatch patch;
    const bool single = bound.InOneSpan(box);
    if (single)
    {
      bound.Extract(box, patch);
    }
    SurfaceBound::Coefficients coefficients;
    bound.Evaluate(box, single ? &patch : nullptr, X[t[0]], coefficients);
    const CurvatureRange range =
      SurfaceBound::Range(coefficients, facet.Normal(), X[t[1]] - X[t[0]]);
    facet.Add(range, box);
    facet.AddEdges(range, box);
    double height = facet.Height();
    double sliding = facet.Sliding();
    if (!single)
    {
      // Against the plane itself, and the affine map that the triangle is.
      const Vec2 e1 = uv[t[1]] - uv[t[0]];
      const Vec2 e2 = uv[t[2]] - uv[t[0]];
      const double det = e1[0] * e2[1] - e1[1] * e2[0];
      const auto map = [&](double u, double v) -> Vec3 {
        const Vec2 d = Vec2(u, v) - uv[t[0]];
        const double b1 = (d[0] * e2[1] - d[1] * e2[0]) / det;
        const double b2 = (e1[0] * d[1] - e1[1] * d[0]) / det;
        return X[t[0]] + b1 * (X[t[1]] - X[t[0]]) + b2 * (X[t[2]] - X[t[0]]);
      };
      if (det == 0.0)
      {
        return 1e300;
      }
      const Vec3 corners[4] = { map(box.U0, box.V0), map(box.U1, box.V0), map(box.U0, box.V1),
        map(box.U1, box.V1) };
      const double zero[4] = { 0.0, 0.0, 0.0, 0.0 };
      const SurfaceBound::Roughness rough =
        bound.BoundRoughness(box, facet.Normal(), X[t[0]], corners, zero, 1e300);
      height = std::min(height, rough.Height / range.MinWeight);
      sliding = std::min(sliding, rough.Deviation);
    }
    return SurfaceDistance(height, sliding, this->Slope(t, facet.Normal()));
  }

  bool CrossesCrease(const ParameterBox& box) const
  {
    const double low[2] = { box.U0, box.V0 };
    const double high[2] = { box.U1, box.V1 };
    for (int d = 0; d < 2; ++d)
    {
      const double eps = NegligibleSpan * (high[d] - low[d]);
      for (double crease : this->Job.Tree->Creases(d))
      {
        if (crease > low[d] + eps && crease < high[d] - eps)
        {
          return true;
        }
      }
    }
    return false;
  }

  ParameterBox BoxOf(const int* t) const
  {
    ParameterBox box{ 1e300, -1e300, 1e300, -1e300 };
    for (int i = 0; i < 3; ++i)
    {
      const Vec2& p = this->Mesh.UV[t[i]];
      box = { std::min(box.U0, p[0]), std::max(box.U1, p[0]), std::min(box.V0, p[1]),
        std::max(box.V1, p[1]) };
    }
    return box;
  }

  // A sliver whose longest edge, or whose other two edges, are boundary segments: its points are an
  // altitude away from segments that are certified already.
  double EdgeSliverError(const int* t, const FacetBound& facet) const
  {
    const int longest = facet.LongestEdge();
    double error[3];
    for (int i = 0; i < 3; ++i)
    {
      const int a = t[i];
      const bool boundary =
        a < this->BoundaryCount && this->Next[a] == t[(i + 1) % 3] && this->Segments[a]->Edge >= 0;
      error[i] = boundary ? (*this->Job.Edges)[this->Segments[a]->Edge].Error : 1e300;
    }
    const double legs = std::max(error[(longest + 1) % 3], error[(longest + 2) % 3]);
    return std::min(error[longest], legs) + 2.0 * facet.AltitudeOver(longest);
  }

  // Bound of the surface's distance from a triangle; `leaf`: see Leaf.
  double TriangleError(const int* t, int leaf) const
  {
    if (this->IsCollapsed(t))
    {
      return 0.0; // At a pole: no triangle comes out.
    }
    if (leaf < 0)
    {
      FacetBound facet = this->Facet(t, leaf);
      return this->FacetError(t, leaf, facet);
    }
    const TreeLeaf& cell = this->Job.Tree->Leaves()[leaf];
    const Vec3& x0 = this->Mesh.Points[t[0]];
    const Vec3 n = (this->Mesh.Points[t[1]] - x0).cross(this->Mesh.Points[t[2]] - x0).normalized();
    return SurfaceDistance(cell.Height, cell.Sliding, this->Slope(t, n));
  }

  void Certify()
  {
    double worst = this->Flatness;
    if (this->Job.Tree)
    {
      std::vector<double> error(this->Leaf.size());
      this->Job.Parallel(
        0, std::int64_t(this->Leaf.size()), [&](std::int64_t begin, std::int64_t end) {
          for (std::int64_t k = begin; k < end; ++k)
          {
            const int leaf = this->Leaf[k];
            const double known =
              leaf < 0 && leaf != NoLeaf ? (*this->Job.States)[-1 - leaf].Error : -1.0;
            error[k] =
              known >= 0.0 ? known : this->TriangleError(&this->Mesh.Triangles[3 * k], leaf);
          }
        });
      for (std::size_t k = 0; k < this->Leaf.size(); ++k)
      {
        worst = std::max(worst, error[k]);
        const int leaf = this->Leaf[k];
        if (leaf < 0 && leaf != NoLeaf)
        {
          double& known = (*this->Job.States)[-1 - leaf].Error;
          known = std::max(known, error[k]);
        }
        if (error[k] > this->Limit() && leaf != NoLeaf)
        {
          this->WeakLeaves.push_back(leaf >= 0 ? leaf : -1 - leaf);
        }
      }
    }
    double edges = 0.0;
    for (const BoundaryVertex* v : this->Segments)
    {
      if (v->Edge >= 0)
      {
        const EdgePolyline& edge = (*this->Job.Edges)[v->Edge];
        edges = std::max(edges, edge.Error + edge.Gap);
      }
    }
    this->Mesh.CertifiedError = std::max(worst + this->Gap, edges);
    this->Mesh.ModelGap = this->Gap;
  }

  // Drops triangles at poles and turns reversed faces.
  FaceMesh Finish()
  {
    std::vector<int>& t = this->Mesh.Triangles;
    const std::vector<Vec3>& x = this->Mesh.Points;
    std::size_t kept = 0;
    for (std::size_t k = 0; k + 2 < t.size(); k += 3)
    {
      const int a = t[k];
      const int b = t[k + 1];
      const int c = t[k + 2];
      if (x[a] == x[b] || x[b] == x[c] || x[c] == x[a])
      {
        continue;
      }
      t[kept] = a;
      t[kept + 1] = this->TheFace.Reversed ? c : b;
      t[kept + 2] = this->TheFace.Reversed ? b : c;
      kept += 3;
    }
    t.resize(kept);
    if (this->TheFace.Reversed)
    {
      for (Vec3& n : this->Mesh.Normals)
      {
        n = -n;
      }
    }
    return std::move(this->Mesh);
  }

  static constexpr int NoLeaf = -2147483647 - 1;

  const FaceJob& Job;
  const Model& Data;
  const Face& TheFace;
  std::vector<SplitRequest>& Requests;
  std::vector<int>& WeakLeaves;
  SurfaceEvaluator Evaluator;
  FaceMesh Mesh;
  std::vector<std::vector<BoundaryVertex>> Loops;
  std::vector<const BoundaryVertex*> Segments; ///< The segment that starts at each boundary vertex.
  std::vector<int> Next;                       ///< The boundary vertex after each.
  int BoundaryCount = 0;
  Vec2 Scale = Vec2(1.0, 1.0);
  /// Per triangle: the leaf whose own two triangles it is one of; -1 - leaf: another triangle inside
  /// that leaf; NoLeaf: anywhere.
  std::vector<int> Leaf;
  std::vector<char> IsWholeLeaf;
  double Gap = 0.0;
  double Flatness = 0.0;
};
} // namespace

FaceMesh TessellateFace(
  const FaceJob& job, std::vector<SplitRequest>& requests, std::vector<int>& weakLeaves)
{
  return FaceBuilder(job, requests, weakLeaves).Run();
}

} // namespace nurbs
