// SPDX-License-Identifier: BSD-3-Clause
#include "FaceTessellator.h"

#include "BorderTriangulation.h"
#include "FaceErrors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace nurbs
{

namespace
{
constexpr double NearTolerance = 40.0; // In units of FaceJob::Snap: 0.8 tolerances.
constexpr double CutMargin = 0.08; // Leaves this near to a trim line (in their size) count as cut.

class FaceBuilder : public FaceErrors
{
public:
  FaceBuilder(const FaceJob& job, std::vector<SplitRequest>& requests, std::vector<int>& weakLeaves)
    : FaceErrors(job, requests)
    , WeakLeaves(weakLeaves)
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
    TrimRegion region(this->Loops, NearTolerance * this->Job.Snap);
    this->AddBoundary();
    if (this->Job.Tree ? this->Curved(region) : this->Planar(region))
    {
      this->Certify();
      this->Stitch();
    }
    return this->Finish();
  }

private:
  void AddBoundary()
  {
    for (const auto& loop : this->Loops)
    {
      const int first = int(this->Mesh.UV.size());
      for (std::size_t k = 0; k < loop.size(); ++k)
      {
        const BoundaryVertex& v = loop[k];
        this->Next.push_back(first + int((k + 1) % loop.size()));
        this->Previous.push_back(first + int((k + loop.size() - 1) % loop.size()));
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
        this->Gaps.push_back((x - this->Mesh.Points[first + k]).norm());
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
    this->Scale = region.CellScale(*this->Job.Tree);
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
      [&](FacetBound& bound, const CellZone::Triangle& t) {
        const int corner[3] = { t.Corner[0] + first, t.Corner[1] + first, t.Corner[2] + first };
        const bool bad = this->LooksBack(corner) || this->ExceedsLimits(corner);
        const double error = bad ? CellZone::NotGood : this->TriangleError(bound, corner);
        return error <= this->Job.Tolerance ? error : CellZone::NotGood;
      },
      FacetBound(*this->Job.Bound, this->Job.Options->Error), *this->Job.States,
      this->Job.Parallel);
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

  // Points of a crease opposite to the vertices of trim lines that run beside it. The strip between
  // the two can be narrower than their chords bow: triangles between vertices that are not opposite
  // to each other would overlap.
  std::vector<Vec2> Rungs(int d, double crease, const TrimRegion& region) const
  {
    struct Rung
    {
      double At, Room; // Room: how near another rung may come.
    };
    std::vector<Rung> rungs;
    std::vector<int> previous(this->BoundaryCount);
    for (int k = 0; k < this->BoundaryCount; ++k)
    {
      previous[this->Next[k]] = k;
    }
    for (int k = 0; k < this->BoundaryCount; ++k)
    {
      const Vec2& p = this->Mesh.UV[k];
      const auto length = [&](int other) {
        return std::abs(this->Mesh.UV[other][1 - d] - p[1 - d]) * this->Scale[1 - d];
      };
      const double apart = std::abs(p[d] - crease) * this->Scale[d];
      const double chord = std::max(length(previous[k]), length(this->Next[k]));
      if (apart > 0.0 && apart < 0.25 * chord &&
        !region.Crosses(1 - d, p[1 - d], std::min(p[d], crease), std::max(p[d], crease)))
      {
        rungs.push_back({ p[1 - d], 0.2 * chord });
      }
      else if (apart == 0.0)
      {
        rungs.push_back({ p[1 - d], 0.0 }); // A vertex there already.
      }
    }
    std::sort(rungs.begin(), rungs.end(), [](const Rung& a, const Rung& b) { return a.At < b.At; });
    std::vector<Vec2> points;
    double last = -1e300;
    for (std::size_t k = 0; k < rungs.size(); ++k)
    {
      const double room = rungs[k].Room / this->Scale[1 - d];
      const bool free =
        k + 1 == rungs.size() || rungs[k + 1].Room > 0.0 || rungs[k + 1].At - rungs[k].At > room;
      if (rungs[k].Room == 0.0)
      {
        last = rungs[k].At;
      }
      else if (free && rungs[k].At - last > room)
      {
        last = rungs[k].At;
        points.emplace_back();
        points.back()[d] = crease;
        points.back()[1 - d] = last;
      }
    }
    return points;
  }

  // Vertices along every crease, joined where the face goes on between them.
  void AddCreases(BorderTriangulation& border, std::vector<int>& vertexOf, const TrimRegion& region)
  {
    if (!this->Job.Tree)
    {
      return;
    }
    const std::size_t before = this->Mesh.UV.size();
    const auto add = [&](const Vec2& p, bool known) {
      if (region.Inside(p) && !known)
      {
        const int id = border.AddPoint(p.cwiseProduct(this->Scale));
        if (id == int(vertexOf.size()))
        {
          vertexOf.push_back(int(this->Mesh.UV.size()));
          this->Mesh.UV.push_back(p);
        }
      }
    };
    for (double u : this->Job.Tree->Creases(0))
    {
      for (double v : this->Job.Tree->Creases(1))
      {
        const Vec2 p(u, v);
        add(p, this->IsInWholeCell(p) || region.IsOnLine(0, p) || region.IsOnLine(1, p));
      }
    }
    for (int d = 0; d < 2; ++d)
    {
      for (double crease : this->Job.Tree->Creases(d))
      {
        for (const Vec2& rung : this->Rungs(d, crease, region))
        {
          add(rung, this->TouchesWholeCell(rung) || region.IsOnLine(d, rung));
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

  // True if p is on the side of a whole cell, which has no vertex there.
  bool TouchesWholeCell(const Vec2& p) const
  {
    bool whole = false;
    this->Job.Tree->Query(
      { p[0], p[0], p[1], p[1] }, [&](int k) { whole = whole || this->IsWholeLeaf[k]; });
    return whole;
  }

  // Adds vertices to the border zone until every triangle is good enough.
  void Refine(BorderTriangulation& border, std::vector<int>& vertexOf)
  {
    const std::size_t base = this->Mesh.Triangles.size();
    const bool limits = this->HasLimits();
    const std::size_t budget = this->Mesh.UV.size() +
      (limits ? this->Job.Options->MaximumFaceTriangles / 2 : 3 * vertexOf.size() + 1000);
    std::vector<std::array<int, 3>> triangles;
    this->BorderErrors.clear();
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
      for (const auto& t : triangles)
      {
        this->Mesh.Triangles.insert(this->Mesh.Triangles.end(), t.begin(), t.end());
        this->Leaf.push_back(NoLeaf);
      }
      if (!this->Job.Tree)
      {
        return;
      }
      const std::size_t before = this->Mesh.UV.size();
      const bool splits = pass < (limits ? 32 : 16) && before <= budget;
      this->ExamineBorder(triangles, border, vertexOf, splits);
      if (this->Mesh.UV.size() == before)
      {
        return;
      }
      this->EvaluateFrom(before, false);
    }
  }

  // Measures the triangles of the border zone; with `splits`, adds vertices where they fail.
  void ExamineBorder(const std::vector<std::array<int, 3>>& triangles, BorderTriangulation& border,
    std::vector<int>& vertexOf, bool splits)
  {
    FacetBound bound(*this->Job.Bound, this->Job.Options->Error);
    std::set<std::pair<int, int>> split;
    std::vector<int> idOf(this->Mesh.UV.size(), -1);
    for (std::size_t id = 0; id < vertexOf.size(); ++id)
    {
      idOf[vertexOf[id]] = int(id);
    }
    for (const auto& t : triangles)
    {
      const double error = this->BorderError(bound, t);
      const bool exceeds = splits && this->ExceedsLimits(t.data());
      if (!splits || this->IsCollapsed(t.data()) || (!exceeds && this->IsTiny(t.data())))
      {
        continue;
      }
      const Facet facet(this->Mesh.Points[t[0]], this->Mesh.Points[t[1]], this->Mesh.Points[t[2]]);
      const bool folded = this->IsFolded(t.data(), facet.Normal()) && !this->IsGap(t.data());
      const bool fails = folded || error > this->Limit(t.data());
      if ((folded && this->SplitSegments(t.data())) || (!fails && !exceeds))
      {
        continue;
      }
      const SecondDerivatives second = this->Job.Bound->Over(this->BoxOf(t.data()));
      double longest = -1.0;
      std::pair<int, int> edge(-1, -1);
      for (int i = 0; i < 3; ++i)
      {
        const int a = t[i];
        const int b = t[(i + 1) % 3];
        const Vec2 d = (this->Mesh.UV[a] - this->Mesh.UV[b]).cwiseAbs();
        const double length = !fails ? this->SideExcess(t.data(), i)
          : facet.HasPlane()         ? second.Bow(d[0], d[1], facet.Normal())
                                     : d.cwiseProduct(this->Scale).norm();
        if (length > longest && !border.IsWall(idOf[a], idOf[b]))
        {
          longest = length;
          edge = std::minmax(a, b);
        }
      }
      if (fails ? this->SplitsWall(t.data(), edge, folded ? 0.5 : 0.05)
                : this->SplitsExceedingWall(t.data(), edge))
      {
        continue;
      }
      if (edge.first >= 0 && !split.insert(edge).second)
      {
        continue;
      }
      const Vec2 p = this->SplitPoint(t.data(), edge);
      const int id = border.AddPoint(p.cwiseProduct(this->Scale));
      if (id == int(vertexOf.size()))
      {
        vertexOf.push_back(int(this->Mesh.UV.size()));
        this->Mesh.UV.push_back(p);
      }
    }
  }

  // The error of a triangle of the border zone, computed once as long as the triangle stays.
  double BorderError(FacetBound& bound, const std::array<int, 3>& t)
  {
    std::array<int, 3> key = t;
    std::sort(key.begin(), key.end());
    const auto found = this->BorderErrors.emplace(key, 0.0);
    if (found.second)
    {
      found.first->second = this->TriangleError(bound, t.data());
    }
    return found.first->second;
  }

  // Asks for vertices on a triangle's boundary segments; false: it has none that can be split.
  bool SplitSegments(const int* t)
  {
    const std::size_t before = this->Requests.size();
    const auto length = [&](int i) {
      return (this->Mesh.Points[t[(i + 1) % 3]] - this->Mesh.Points[t[i]]).norm();
    };
    const double longest = this->Longest(t);
    for (int i = 0; i < 3; ++i)
    {
      // A long inner edge may be what folds it.
      if (this->IsSegment(t[i], t[(i + 1) % 3]) && length(i) >= 0.5 * longest)
      {
        this->RequestSplit(*this->Segments[t[i]]);
      }
    }
    return this->Requests.size() > before;
  }

  // Where a triangle is split: the middle of `edge`, or its own if there is none.
  Vec2 SplitPoint(const int* t, const std::pair<int, int>& edge) const
  {
    const std::vector<Vec2>& uv = this->Mesh.UV;
    return edge.first < 0 ? Vec2((uv[t[0]] + uv[t[1]] + uv[t[2]]) / 3.0)
                          : Vec2(0.5 * (uv[edge.first] + uv[edge.second]));
  }

  // A split of `edge` would leave a sliver at one of the triangle's boundary segments or at a side of a
  // whole cell (flatter than `flat`): asks for a vertex there instead.
  bool SplitsWall(const int* t, const std::pair<int, int>& edge, double flat)
  {
    bool asked = false;
    const Vec2 p = this->SplitPoint(t, edge);
    for (int i = 0; i < 3; ++i)
    {
      const int a = t[i];
      const int b = t[(i + 1) % 3];
      const Vec2 d = (this->Mesh.UV[b] - this->Mesh.UV[a]).cwiseProduct(this->Scale);
      const Vec2 e = (p - this->Mesh.UV[a]).cwiseProduct(this->Scale);
      const double length = d.squaredNorm();
      const bool boundary = this->IsSegment(a, b);
      if (std::abs(d[0] * e[1] - d[1] * e[0]) >= (boundary ? 0.2 : flat) * length)
      {
        continue;
      }
      if (!boundary)
      {
        asked = this->WeakenWholeCells(0.5 * (this->Mesh.UV[a] + this->Mesh.UV[b])) || asked;
      }
      else if (this->Segments[a]->Edge >= 0)
      {
        this->RequestSplit(*this->Segments[a]);
        asked = true;
      }
    }
    return asked;
  }

  // Of a triangle over MaximumEdgeLength or MaximumAngle: if `edge`, of its inner sides the one most
  // over them, is not, asks for vertices on its walls that are.
  bool SplitsExceedingWall(const int* t, const std::pair<int, int>& edge)
  {
    for (int i = 0; i < 3; ++i)
    {
      const std::pair<int, int> side = std::minmax(t[i], t[(i + 1) % 3]);
      if (side == edge && this->SideExcess(t, i) > 1.0)
      {
        return false;
      }
    }
    for (int i = 0; i < 3; ++i)
    {
      const int a = t[i];
      const int b = t[(i + 1) % 3];
      if (!(this->SideExcess(t, i) > 1.0))
      {
        continue;
      }
      if (this->IsSegment(a, b))
      {
        this->RequestSplit(*this->Segments[a]);
      }
      else
      {
        this->WeakenWholeCells(0.5 * (this->Mesh.UV[a] + this->Mesh.UV[b]));
      }
    }
    return true;
  }

  // Asks for finer cells where p is on the side of a whole one; false: there is none, or too late.
  bool WeakenWholeCells(const Vec2& p)
  {
    bool found = false;
    this->Job.Tree->Query({ p[0], p[0], p[1], p[1] }, [&](int k) {
      if (this->IsWholeLeaf[k] && !this->Job.LastPass)
      {
        this->WeakLeaves.push_back(k);
        found = true;
      }
    });
    return found;
  }

  // --- Step 4: certification --------------------------------------------------------------------
  void Certify()
  {
    double worst = 0.0;
    double gap = 0.0;
    for (double g : this->Gaps)
    {
      gap = std::max(gap, g);
    }
    if (this->Job.Tree)
    {
      std::vector<double> error(this->Leaf.size());
      this->Job.Parallel(
        0, std::int64_t(this->Leaf.size()), [&](std::int64_t begin, std::int64_t end) {
          FacetBound bound(*this->Job.Bound, this->Job.Options->Error);
          for (std::int64_t k = begin; k < end; ++k)
          {
            error[k] = this->FinalError(bound, std::size_t(k));
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
        const int* t = &this->Mesh.Triangles[3 * k];
        if (leaf != NoLeaf &&
          (error[k] > this->Job.Tolerance || this->ExceedsLimits(t) || this->LooksBack(t)))
        {
          this->WeakLeaves.push_back(leaf >= 0 ? leaf : -1 - leaf);
        }
      }
    }
    else
    {
      worst = this->Job.Bound->Flatness() + gap;
    }
    double edges = 0.0;
    for (int k = 0; k < this->BoundaryCount; ++k)
    {
      if (this->Segments[k]->Edge >= 0)
      {
        const EdgePolyline& edge = (*this->Job.Edges)[this->Segments[k]->Edge];
        const double ends = std::max(this->Gaps[k], this->Gaps[this->Next[k]]);
        edges = std::max(edges, edge.Error + std::max(edge.Gap + edge.VertexGap, ends));
      }
    }
    this->Mesh.CertifiedError = std::max(worst, edges);
    this->Mesh.ModelGap = gap;
  }

  double FinalError(FacetBound& bound, std::size_t k) const
  {
    const int leaf = this->Leaf[k];
    const int* t = &this->Mesh.Triangles[3 * k];
    if (leaf >= 0)
    {
      return this->Job.Tree->Leaves()[leaf].Error;
    }
    if (leaf == NoLeaf)
    {
      std::array<int, 3> key = { t[0], t[1], t[2] };
      std::sort(key.begin(), key.end());
      return this->BorderErrors.at(key);
    }
    const double known = (*this->Job.States)[-1 - leaf].Error;
    return known >= 0.0 ? known : this->TriangleError(bound, t);
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

  std::vector<int>& WeakLeaves;
  Vec2 Scale = Vec2(1.0, 1.0);
  std::vector<char> IsWholeLeaf;
  static constexpr int NoLeaf = -2147483647 - 1;
  /// Per triangle: the leaf whose own two triangles it is one of; -1 - leaf: another triangle inside
  /// that leaf; NoLeaf: in the border zone.
  std::vector<int> Leaf;
  std::map<std::array<int, 3>, double> BorderErrors; ///< By ascending vertices.
};
} // namespace

FaceMesh TessellateFace(
  const FaceJob& job, std::vector<SplitRequest>& requests, std::vector<int>& weakLeaves)
{
  return FaceBuilder(job, requests, weakLeaves).Run();
}

} // namespace nurbs
