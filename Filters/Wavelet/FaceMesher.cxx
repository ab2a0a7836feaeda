// SPDX-License-Identifier: BSD-3-Clause
#include "CutCells.h"
#include "RectangleTriangulation.h"
#include "ZoneTriangulation.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr double Clearance = 0.3; // Of a cell: grid vertices in the zone keep it from loops.

class FaceMesher : private CutCells
{
public:
  FaceMesher(const FaceMeshJob& job, FaceMeshRequests& requests)
    : CutCells(job)
    , Requests(requests)
  {}

  WaveletMesh Run()
  {
    this->AddLoops();
    this->MarkGrid();
    this->CutLeaves();
    this->KeepLeaves();
    this->MeshLeaves();
    this->MeshZone();
    this->MeasureSegments();
    this->Finish();
    return std::move(this->Mesh);
  }

private:
  // The kept leaf's boundary, counter-clockwise; sides towards the zone become walls.
  std::vector<int> Boundary(const GridLeaf& leaf)
  {
    std::vector<int> out;
    for (int side = 0; side < 4; ++side)
    {
      int i, j, i1, j1;
      Corner(leaf, side, i, j);
      Corner(leaf, (side + 1) % 4, i1, j1);
      if (this->IsOnSide(leaf, side))
      {
        std::vector<int> chain;
        this->FindTaken(leaf, side, chain);
        out.insert(out.end(), chain.begin(), chain.end());
        continue;
      }
      const int di = (i1 > i) - (i1 < i);
      const int dj = (j1 > j) - (j1 < j);
      int before = -1;
      while (true)
      {
        const bool end = i == i1 && j == j1;
        const bool mark = this->Marks[i + std::size_t(j) * (this->Cells[0] + 1)] != 0;
        if (mark || end || before < 0)
        {
          const int id = this->GridVertex(i, j);
          if (before >= 0)
          {
            // The cell on the other side of the piece that ends here.
            const int ci = side == 0 ? i - 1 : side == 1 ? i : side == 2 ? i : i - 1;
            const int cj = side == 0 ? j - 1 : side == 1 ? j - 1 : side == 2 ? j : j;
            if (this->States[this->OwnerOf(ci, cj)] != Kept)
            {
              this->Walls.push_back({ before, id });
            }
          }
          before = id;
          if (!end)
          {
            out.push_back(id);
          }
        }
        if (end)
        {
          break;
        }
        i += di;
        j += dj;
      }
    }
    return out;
  }

  // Vertices of the loop along a kept leaf's side, without the last.
  void FindTaken(const GridLeaf& leaf, int side, std::vector<int>& out) const
  {
    const int d = side % 2;
    const double low = this->Job.Lines[d][d == 0 ? leaf.I0 : leaf.J0];
    const double high = this->Job.Lines[d][d == 0 ? leaf.I1 : leaf.J1];
    std::vector<int> chain;
    auto s = this->Sides[side].lower_bound(low);
    for (; s != this->Sides[side].end() && s->first < high; ++s)
    {
      if (this->Segments[s->second].Consumed)
      {
        chain.push_back(s->second);
      }
    }
    if (side >= 2)
    {
      std::reverse(chain.begin(), chain.end());
    }
    for (const int k : chain)
    {
      out.push_back(this->EndOf(this->Segments[k], side, false));
    }
  }

  void MeshLeaves()
  {
    for (std::size_t l = 0; l < this->Job.Leaves.size(); ++l)
    {
      if (this->States[l] == Kept)
      {
        const GridLeaf& leaf = this->Job.Leaves[l];
        const std::vector<int> boundary = this->Boundary(leaf);
        this->MeshLeaf(leaf, boundary);
        const double error = this->LeafError(leaf, boundary);
        this->Mesh.Error = std::max(this->Mesh.Error, error);
        if (error > this->Job.Limit && leaf.Cell.Level > 0)
        {
          this->Requests.Leaves.push_back(int(l));
        }
      }
    }
  }

  void MeshLeaf(const GridLeaf& leaf, const std::vector<int>& boundary)
  {
    const std::vector<double>& us = this->Job.Lines[0];
    const std::vector<double>& vs = this->Job.Lines[1];
    std::vector<Vec2> corners;
    std::vector<Vec3> points;
    for (const int id : boundary)
    {
      const Vec2& uv = this->Mesh.UV[id];
      corners.emplace_back((uv[0] - us[leaf.I0]) / (us[leaf.I1] - us[leaf.I0]),
        (uv[1] - vs[leaf.J0]) / (vs[leaf.J1] - vs[leaf.J0]));
      points.push_back(this->Mesh.Points[id]);
    }
    for (const std::array<int, 3>& t : TriangulateRectangle(corners, points))
    {
      this->Triangles.push_back({ boundary[t[0]], boundary[t[1]], boundary[t[2]] });
    }
  }

  // Two bounds hold for cells with samples on the surface: through the bilinear interpolation, and
  // of any triangles in the box.
  double LeafError(const GridLeaf& leaf, const std::vector<int>& boundary) const
  {
    double offset = 0.0;
    for (const int id : boundary)
    {
      if (id < int(this->Segments.size())) // A loop's.
      {
        offset = std::max(offset, this->Offsets[id] + this->Job.Offset);
      }
    }
    Vec3 corner[4];
    for (int k = 0; k < 4; ++k)
    {
      int i, j;
      Corner(leaf, k, i, j);
      corner[k] = this->Mesh.Points[this->GridIds[i + std::size_t(j) * (this->Cells[0] + 1)]];
    }
    const double twist = (corner[0] - corner[1] + corner[2] - corner[3]).norm();
    const double through =
      (boundary.size() > 4 ? leaf.ErrorWithVertices : leaf.Error) + 0.25 * twist + offset;
    if (!this->Job.OnSurface)
    {
      return through;
    }
    const ParameterBox box = this->BoxOf(leaf);
    const double direct = this->Job.Source->Bound().Over(box).Bow(box.A(), box.B());
    return std::min(through, direct + offset);
  }

  // Grid vertices in the zone that are clear of the loops.
  void AddFreeVertices(const std::vector<std::vector<double>>& crossings, std::vector<int>& ids)
  {
    for (std::size_t l = 0; l < this->Job.Leaves.size(); ++l)
    {
      for (int k = 0; k < 4 && this->States[l] == Cut; ++k)
      {
        int i, j;
        Corner(this->Job.Leaves[l], k, i, j);
        const bool border = i == 0 || j == 0 || i == this->Cells[0] || j == this->Cells[1];
        const std::size_t at = i + std::size_t(j) * (this->Cells[0] + 1);
        if (!border && this->GridIds[at] < 0 && IsInside(crossings[j], this->Job.Lines[0][i]) &&
          this->IsClear(i, j))
        {
          ids.push_back(this->GridVertex(i, j));
        }
      }
    }
  }

  bool IsClear(int i, int j) const
  {
    const Vec2 p(this->Job.Lines[0][i], this->Job.Lines[1][j]);
    for (int k = 0; k < 4; ++k)
    {
      const int owner = this->OwnerOf(i - (k & 1), j - (k >> 1));
      const GridLeaf& leaf = this->Job.Leaves[owner];
      const ParameterBox box = this->BoxOf(leaf);
      const Vec2 scale(1.0 / box.A(), 1.0 / box.B());
      for (const int s : this->CutBy[owner])
      {
        const Vec2 a = scale.cwiseProduct(this->Mesh.UV[this->Segments[s].A] - p);
        const Vec2 d = scale.cwiseProduct(this->Mesh.UV[this->Segments[s].B] - p) - a;
        const double length = d.squaredNorm();
        const double t = length > 0.0 ? std::clamp(-a.dot(d) / length, 0.0, 1.0) : 0.0;
        if ((a + t * d).norm() < Clearance)
        {
          return false;
        }
      }
    }
    return true;
  }

  // A plane is triangulated as it is in space, other faces so that their cells are squares.
  Vec2 ZoneScale() const
  {
    const ParameterBox& box = this->Job.Source->Box();
    if (this->Job.Leaves.size() > 1)
    {
      return { this->Cells[0] / box.A(), this->Cells[1] / box.B() };
    }
    const std::vector<Vec3>& x = this->Job.Samples;
    const std::size_t width = this->Cells[0] + 1;
    const double a = (x[width - 1] - x[0]).norm() + (x.back() - x[x.size() - width]).norm();
    const double b = (x[x.size() - width] - x[0]).norm() + (x.back() - x[width - 1]).norm();
    return { (a > 0.0 ? a : 1.0) / box.A(), (b > 0.0 ? b : 1.0) / box.B() };
  }

  void MeshZone()
  {
    for (const Segment& segment : this->Segments)
    {
      if (!segment.Consumed)
      {
        this->Walls.push_back({ segment.A, segment.B });
      }
    }
    if (this->Walls.empty())
    {
      return;
    }
    const std::vector<std::vector<double>> crossings = this->Crossings(this->Job.Lines[1]);
    std::vector<int> ids;
    for (const std::array<int, 2>& wall : this->Walls)
    {
      ids.insert(ids.end(), wall.begin(), wall.end());
    }
    this->AddFreeVertices(crossings, ids);
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    const auto number = [&](int id) {
      return int(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
    };
    Zone zone;
    const Vec2 scale = this->ZoneScale();
    for (const int id : ids)
    {
      zone.Points.push_back(this->Mesh.UV[id].cwiseProduct(scale));
    }
    for (const std::array<int, 2>& wall : this->Walls)
    {
      zone.Walls.push_back({ number(wall[0]), number(wall[1]) });
    }
    this->AddCreases(ids, zone);
    const ZoneTriangles made = TriangulateZone(zone);
    if (!made.Added.empty())
    {
      std::vector<Vec2> uv;
      for (const Vec2& p : made.Added)
      {
        uv.push_back(p.cwiseQuotient(scale));
      }
      const std::vector<int> added = this->AddEvaluated(uv, nullptr);
      ids.insert(ids.end(), added.begin(), added.end());
      this->Mesh.Status = WaveletStatus::Repaired;
      this->Mesh.Message = "its loops cross";
    }
    for (const std::array<int, 3>& t : made.Triangles)
    {
      const std::array<int, 3> triangle = { ids[t[0]], ids[t[1]], ids[t[2]] };
      this->Triangles.push_back(triangle);
      this->MeasureZone(triangle);
    }
  }

  // Lines of the zone along creases of the surface, between neighbouring vertices on them.
  void AddCreases(const std::vector<int>& ids, Zone& zone) const
  {
    for (int d = 0; d < 2; ++d)
    {
      for (const double crease : this->Job.Source->Bound().Creases(d))
      {
        std::vector<std::pair<double, int>> on;
        for (std::size_t k = 0; k < ids.size(); ++k)
        {
          const Vec2& uv = this->Mesh.UV[ids[k]];
          if (uv[d] == crease)
          {
            on.emplace_back(uv[1 - d], int(k));
          }
        }
        std::sort(on.begin(), on.end());
        for (std::size_t k = 1; k < on.size(); ++k)
        {
          Vec2 middle;
          middle[d] = crease;
          middle[1 - d] = 0.5 * (on[k - 1].first + on[k].first);
          if (on[k - 1].first < on[k].first && this->IsZone(middle, d))
          {
            zone.Lines.push_back({ on[k - 1].second, on[k].second });
          }
        }
      }
    }
  }

  // True if the cells beside a point on a grid line (of direction d) are cut and it is inside.
  bool IsZone(const Vec2& p, int d) const
  {
    const std::vector<double> row(1, p[1]);
    if (!IsInside(this->Crossings(row)[0], p[0]))
    {
      return false;
    }
    for (int side = 0; side < 2; ++side)
    {
      int at[2];
      for (int e = 0; e < 2; ++e)
      {
        at[e] = this->CellOf(e, p[e]) - (e == d ? side : 0);
      }
      if (this->States[this->OwnerOf(std::max(0, at[0]), std::max(0, at[1]))] == Kept)
      {
        return false;
      }
    }
    return true;
  }

  void MeasureZone(const std::array<int, 3>& t)
  {
    ParameterBox box{ 1e300, -1e300, 1e300, -1e300 };
    double offset = 0.0;
    Vec2 middle = Vec2::Zero();
    for (const int id : t)
    {
      const Vec2& uv = this->Mesh.UV[id];
      box = { std::min(box.U0, uv[0]), std::max(box.U1, uv[0]), std::min(box.V0, uv[1]),
        std::max(box.V1, uv[1]) };
      offset = std::max(offset, this->Offsets[id]);
      middle += uv / 3.0;
    }
    const double error = offset + this->Job.Source->Bound().Over(box).Bow(box.A(), box.B());
    this->Mesh.Error = std::max(this->Mesh.Error, error);
    if (error <= this->Job.Limit)
    {
      return;
    }
    const int owner = this->OwnerOf(this->CellOf(0, middle[0]), this->CellOf(1, middle[1]));
    if (this->Job.Leaves[owner].Cell.Level > 0)
    {
      this->Requests.Leaves.push_back(owner);
    }
    for (int k = 0; k < 3; ++k)
    {
      const int a = t[k];
      const int b = t[(k + 1) % 3];
      if (a < int(this->Segments.size()) && this->Segments[a].B == b)
      {
        this->RequestSegment(this->Segments[a]);
      }
    }
  }

  void RequestSegment(const Segment& segment)
  {
    const LevelLoopVertex& v = *segment.Source;
    if (v.Edge >= 0 && v.Last > v.First + 1)
    {
      this->Requests.Segments.push_back({ v.Edge, { v.First, v.Last } });
    }
  }

  // What lies between an edge's curve and its segment belongs to the face, too.
  void MeasureSegments()
  {
    for (const Segment& segment : this->Segments)
    {
      const LevelLoopVertex& v = *segment.Source;
      if (v.Edge < 0 || v.OnSide)
      {
        continue;
      }
      const Box2& range = v.Range;
      const ParameterBox box{ range.min()[0], range.max()[0], range.min()[1], range.max()[1] };
      const double error = v.SegmentError +
        std::max(this->Offsets[segment.A], this->Offsets[segment.B]) +
        this->Job.Source->Bound().Over(box).Bow(box.A(), box.B());
      this->Mesh.Error = std::max(this->Mesh.Error, error);
      if (error > this->Job.Limit)
      {
        this->RequestSegment(segment);
      }
    }
  }

  // Triangles that are a line in space, at poles, go.
  void Finish()
  {
    for (const std::array<int, 3>& t : this->Triangles)
    {
      const Vec3& a = this->Mesh.Points[t[0]];
      const Vec3& b = this->Mesh.Points[t[1]];
      const Vec3& c = this->Mesh.Points[t[2]];
      if (a != b && b != c && c != a)
      {
        this->Mesh.Triangles.push_back(t[0]);
        this->Mesh.Triangles.push_back(t[this->Job.Reversed ? 2 : 1]);
        this->Mesh.Triangles.push_back(t[this->Job.Reversed ? 1 : 2]);
      }
    }
    this->Mesh.Level = this->Job.Leaves.front().Cell.Level;
    for (const GridLeaf& leaf : this->Job.Leaves)
    {
      this->Mesh.Level = std::min(this->Mesh.Level, leaf.Cell.Level);
    }
    if (this->Mesh.Triangles.empty())
    {
      this->Mesh.Status = WaveletStatus::Failed;
      this->Mesh.Message = "its loops enclose no area";
    }
  }

  FaceMeshRequests& Requests;
  std::vector<std::array<int, 2>> Walls;
  std::vector<std::array<int, 3>> Triangles;
};

} // namespace

WaveletMesh MeshFace(const FaceMeshJob& job, FaceMeshRequests& requests)
{
  return FaceMesher(job, requests).Run();
}

} // namespace nurbs
