// SPDX-License-Identifier: BSD-3-Clause
#include "FaceLoops.h"

#include "ChainStitch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace nurbs
{

namespace
{
constexpr double LargeGap = 1.0;   // Of trim curves from their edge, in tolerances.
constexpr double ShortPole = 1e-4; // Of the domain.
} // namespace

FaceLoops::FaceLoops(const FaceJob& job, std::vector<SplitRequest>& requests)
  : Job(job)
  , Data(*job.Data)
  , TheFace(job.Data->Faces[job.Face])
  , Requests(requests)
{}

void FaceLoops::MakeLoops()
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
        this->Given.push_back(loop);
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

void FaceLoops::AppendCurve(std::int64_t index, std::vector<BoundaryVertex>& loop)
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
    part[k].UV = this->Clamp(Evaluate(curve.Geometry, TrimParameter(curve, domain, ts[i])), false);
    part[k].Other = part[k].UV;
    part[k].X = edge.Degenerate ? edge.Points[0] : edge.Points[i];
    part[k].Edge = curve.Edge;
    part[k].T0 = ts[i];
    part[k].T1 = k + 1 < n ? ts[curve.Reversed ? i - 1 : i + 1] : ts[i];
  }
  if (edge.Degenerate && this->IsShort(part.front().UV, part.back().UV))
  {
    return; // The curves beside it meet in one corner.
  }
  if (edge.Gap > LargeGap * this->Job.Tolerance && this->Job.Tree && !this->OnCurves)
  {
    this->MoveToFeet(part);
  }
  if (!loop.empty() && this->IsSameCorner(loop.back(), part.front()))
  {
    this->JoinCorner(loop.back(), part.front());
    loop.pop_back();
  }
  else if (!loop.empty())
  {
    loop.back().Edge = -1; // A jump along a pole or from side to side of a closed surface.
  }
  loop.insert(loop.end(), part.begin(), part.end());
}

// Too short in (u, v) to be a pole's side.
bool FaceLoops::IsShort(const Vec2& a, const Vec2& b) const
{
  const SurfaceView& s = this->TheFace.Geometry;
  return std::abs(a[0] - b[0]) <= ShortPole * s.Domain(0).Length() &&
    std::abs(a[1] - b[1]) <= ShortPole * s.Domain(1).Length();
}

// Where a face's trim curve misses the edge by as much as the tolerance, vertices are moved in (u, v)
// to where they are on the surface: else they would be out of order with those inside the face.
void FaceLoops::MoveToFeet(std::vector<BoundaryVertex>& part)
{
  const SurfaceView& s = this->TheFace.Geometry;
  for (BoundaryVertex& v : part)
  {
    const double apart = (Evaluate(s, v.UV[0], v.UV[1]) - v.X).norm();
    if (apart <= LargeGap * this->Job.Tolerance)
    {
      continue;
    }
    Vec2 foot = this->Clamp(this->Foot(v.UV, v.X), false);
    for (int d = 0; d < 2; ++d)
    {
      const std::vector<double>& creases = this->Job.Tree->Creases(d);
      const bool on = std::find(creases.begin(), creases.end(), v.UV[d]) != creases.end();
      foot[d] = on ? v.UV[d] : foot[d]; // The edge has its vertex there for the crease's sake.
    }
    if ((Evaluate(s, foot[0], foot[1]) - v.X).norm() < 0.5 * apart)
    {
      v.Other = v.UV;
      v.UV = foot;
      this->CurveGap = std::max(this->CurveGap, apart);
    }
  }
}

// The point of the surface next to x, from uv on: Gauss-Newton, inside the domain.
Vec2 FaceLoops::Foot(const Vec2& uv, const Vec3& x) const
{
  const SurfaceView& s = this->TheFace.Geometry;
  Vec2 p = uv;
  for (int step = 0; step < 8; ++step)
  {
    const SurfaceDerivatives d = EvaluateDerivatives(s, p[0], p[1], 1);
    const Vec3 r = x - d.S;
    const double a = d.Su.squaredNorm();
    const double b = d.Su.dot(d.Sv);
    const double c = d.Sv.squaredNorm();
    const double det = a * c - b * b;
    if (!(det > 1e-6 * a * c))
    {
      break;
    }
    const double ru = d.Su.dot(r);
    const double rv = d.Sv.dot(r);
    const Vec2 next(s.Domain(0).Clamp(p[0] + (c * ru - b * rv) / det),
      s.Domain(1).Clamp(p[1] + (a * rv - b * ru) / det));
    if ((next - p).cwiseAbs().maxCoeff() == 0.0)
    {
      break;
    }
    p = next;
  }
  return p;
}

// A degenerate side has one point, but as many parameters as the cells there have corners.
void FaceLoops::PoleParameters(
  const TrimCurve& curve, const Interval& domain, std::vector<double>& ts)
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

// Puts vertices beside a crease on it unless others of the loop are as near.
void FaceLoops::SnapLoop(std::vector<BoundaryVertex>& loop) const
{
  const std::size_t n = loop.size();
  std::vector<Vec2> raw;
  for (const BoundaryVertex& v : loop)
  {
    raw.push_back(v.UV);
  }
  const auto apart = [&](std::size_t i, std::size_t j) {
    const Vec2 d = (raw[i] - raw[j]).cwiseAbs();
    return d[0] > 4.0 * this->Job.Snap[0] || d[1] > 4.0 * this->Job.Snap[1];
  };
  // Neighbours are moved together or not at all: else the boundary would go to and fro.
  std::vector<Vec2> near(raw);
  std::vector<char> keep(n, 0);
  const SurfaceView& s = this->TheFace.Geometry;
  for (std::size_t k = 0; k < n; ++k)
  {
    if (apart(k, (k + n - 1) % n) && apart(k, (k + 1) % n))
    {
      near[k] = this->Clamp(raw[k], true);
    }
    keep[k] = near[k] != raw[k] &&
      (Evaluate(s, near[k][0], near[k][1]) - Evaluate(s, raw[k][0], raw[k][1])).norm() >
        0.03 * this->Job.Tolerance;
  }
  for (std::size_t step = 0; step < 2 * n; ++step)
  {
    const std::size_t k = step % n;
    const std::size_t after = (k + 1) % n;
    if (near[k] != raw[k] && near[after] != raw[after])
    {
      keep[after] = keep[after] || keep[k];
    }
  }
  for (std::size_t step = 2 * n; step-- > 0;)
  {
    const std::size_t k = step % n;
    const std::size_t after = (k + 1) % n;
    if (near[k] != raw[k] && near[after] != raw[after])
    {
      keep[k] = keep[k] || keep[after];
    }
  }
  for (std::size_t k = 0; k < n; ++k)
  {
    if (near[k] != raw[k] && !keep[k])
    {
      loop[k].Other = raw[k];
      loop[k].UV = near[k];
    }
  }
}

Vec2 FaceLoops::Clamp(const Vec2& uv, bool snap) const
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
  }
  return p;
}

// Consecutive curves of a loop meet in a vertex of the model. Where their ends in (u, v) differ a
// little, as far as the model's gaps, they are still one corner: a side between the two, whose ends
// are one point in space, could only cross its neighbours.
bool FaceLoops::IsSameCorner(const BoundaryVertex& a, const BoundaryVertex& b) const
{
  const SurfaceView& s = this->TheFace.Geometry;
  const double near = a.X == b.X ? 1e-2 : 1e-5;
  return std::abs(a.UV[0] - b.UV[0]) <= near * s.Domain(0).Length() &&
    std::abs(a.UV[1] - b.UV[1]) <= near * s.Domain(1).Length();
}

// Makes `start` the corner: of the two ends the one whose point of the surface is nearer to it.
void FaceLoops::JoinCorner(const BoundaryVertex& end, BoundaryVertex& start)
{
  const SurfaceView& s = this->TheFace.Geometry;
  if (std::abs(end.UV[0] - start.UV[0]) <= 1e-5 * s.Domain(0).Length() &&
    std::abs(end.UV[1] - start.UV[1]) <= 1e-5 * s.Domain(1).Length())
  {
    start.Other = end.UV;
    return;
  }
  const Vec3 x = Evaluate(s, end.UV[0], end.UV[1]);
  const Vec3 y = Evaluate(s, start.UV[0], start.UV[1]);
  if ((x - y).norm() > this->Job.Tolerance)
  {
    this->Note(
      FaceStatus::Repaired, "a loop's gap of " + std::to_string((x - y).norm()) + " was closed");
  }
  start.Other = end.UV;
  if ((x - end.X).norm() < (y - start.X).norm())
  {
    std::swap(start.UV, start.Other);
  }
}

void FaceLoops::CloseLoop(std::vector<BoundaryVertex>& loop)
{
  if (loop.size() > 1 && this->IsSameCorner(loop.back(), loop.front()))
  {
    this->JoinCorner(loop.back(), loop.front());
    loop.pop_back();
  }
  this->SnapLoop(loop);
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
  if (distinct.size() < loop.size())
  {
    this->Given.push_back(loop);
    this->Replaced.push_back(distinct);
  }
  loop.swap(distinct);
}

// A loop whose polygon collapsed, in (u, v) or in space, although its curves enclose something.
bool FaceLoops::IsLoopThin(const std::vector<BoundaryVertex>& loop) const
{
  std::vector<Vec3> spots;
  for (std::size_t k = 0; k < loop.size() && spots.size() < 3; ++k)
  {
    if (std::find(spots.begin(), spots.end(), loop[k].X) == spots.end())
    {
      spots.push_back(loop[k].X);
    }
  }
  if (spots.size() < 3)
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

void FaceLoops::RequestMiddles(const std::vector<BoundaryVertex>& loop)
{
  for (const BoundaryVertex& v : loop)
  {
    if (v.Edge >= 0 && !(*this->Job.Edges)[v.Edge].Degenerate && !this->Job.LastPass)
    {
      this->Requests.push_back({ v.Edge, 0.5 * (v.T0 + v.T1) });
    }
  }
}

// The loops where they are triangulated: in the plane of a planar face, in (u, v) otherwise.
Loops2 FaceLoops::FlatLoops() const
{
  Loops2 flat(this->Loops.size());
  const Vec3& normal = this->Job.Bound->PlaneNormal();
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

// Where sides cross, tries the other place of their ends, should they have one; true if less cross.
bool FaceLoops::UseOthers(Loops2& flat, CrossingFinder& finder)
{
  const std::vector<std::pair<int, int>> crossings = finder.Find(flat);
  if (crossings.empty() || !this->Job.Tree)
  {
    return false;
  }
  std::vector<std::pair<std::size_t, std::size_t>> at; // Loop and place of each vertex.
  for (std::size_t l = 0; l < flat.size(); ++l)
  {
    for (std::size_t k = 0; k < flat[l].size(); ++k)
    {
      at.emplace_back(l, k);
    }
  }
  for (const auto& pair : crossings)
  {
    for (const int side : { pair.first, pair.second })
    {
      for (const int end : { 0, 1 })
      {
        const std::size_t l = at[side].first;
        const std::size_t k = (at[side].second + end) % flat[l].size();
        BoundaryVertex& v = this->Loops[l][k];
        if (v.Other == v.UV)
        {
          continue;
        }
        flat[l][k] = v.Other;
        if (finder.Find(flat).size() < crossings.size())
        {
          v.UV = v.Other;
          return true;
        }
        flat[l][k] = v.UV;
      }
    }
  }
  return false;
}

// Loops that cross: polylines too coarse ask for finer ones; loops that cross as curves, or run the
// wrong way, are repaired. False: the face can't go on.
bool FaceLoops::CheckLoops()
{
  Loops2 flat = this->FlatLoops();
  CrossingFinder finder;
  finder.Find(flat);
  while (this->UseOthers(flat, finder))
  {}
  if (this->CurveGap > 0.0 && !finder.Find(flat).empty())
  {
    // Vertices that were moved off their curves make sides cross, perhaps.
    this->OnCurves = true;
    this->CurveGap = 0.0;
    this->Mesh = FaceMesh();
    this->Loops.clear();
    this->Given.clear();
    this->Replaced.clear();
    this->MakeLoops();
    if (this->Loops.empty() || !this->Requests.empty())
    {
      return false;
    }
    flat = this->FlatLoops();
    while (this->UseOthers(flat, finder))
    {}
  }
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
  if (crossings.empty() && outer == 1 && largest > 0.0 && (flat.size() == 1 || LoopsRunRight(flat)))
  {
    return true;
  }
  return this->Repair(flat);
}

bool FaceLoops::Repair(const Loops2& flat)
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
  this->Given.insert(this->Given.end(), loops.begin(), loops.end());
  this->Replaced.insert(this->Replaced.end(), this->Loops.begin(), this->Loops.end());
  if (this->Loops.empty())
  {
    this->Note(FaceStatus::Failed, "its loops enclose no area");
  }
  return !this->Loops.empty();
}

void FaceLoops::Stitch()
{
  if (this->CurveGap > 0.0)
  {
    double error = 0.0;
    for (const Loop& loop : this->Loops)
    {
      for (const BoundaryVertex& v : loop)
      {
        error = std::max(error, v.Edge < 0 ? 0.0 : (*this->Job.Edges)[v.Edge].Error);
      }
    }
    this->Mesh.CertifiedError = std::max(this->Mesh.CertifiedError, error + this->CurveGap);
  }
  if (this->Given.empty())
  {
    return;
  }
  std::map<std::array<double, 3>, int> numbers;
  std::vector<const BoundaryVertex*> vertices;
  std::vector<Vec3> points;
  const auto chains = [&](const std::vector<Loop>& loops) {
    Chains out;
    for (const Loop& loop : loops)
    {
      out.emplace_back();
      for (const BoundaryVertex& v : loop)
      {
        const auto at =
          numbers.emplace(std::array<double, 3>{ v.X[0], v.X[1], v.X[2] }, int(vertices.size()));
        out.back().push_back(at.first->second);
        if (at.second)
        {
          vertices.push_back(&v);
          points.push_back(v.X);
        }
      }
    }
    return out;
  };
  const Chains given = chains(this->Given);
  const Chains made = chains(this->Replaced);
  const Stitches stitches = StitchChains(given, made, points, this->Job.Tolerance);
  SurfaceEvaluator evaluator(this->Job.Bound->Evaluator());
  for (const std::array<int, 3>& t : stitches.Triangles)
  {
    for (const int k : t)
    {
      Vec3 x;
      Vec3 normal;
      evaluator.Batch(&vertices[k]->UV, 1, x.data(), normal.data());
      this->Mesh.Triangles.push_back(int(this->Mesh.Points.size()));
      this->Mesh.Points.push_back(points[k]);
      this->Mesh.Normals.push_back(normal);
      this->Mesh.UV.push_back(vertices[k]->UV);
    }
  }
  if (!stitches.Triangles.empty())
  {
    this->Mesh.CertifiedError += stitches.Error;
  }
}

void FaceLoops::Note(FaceStatus status, const std::string& message)
{
  this->Mesh.Status = std::max(this->Mesh.Status, status);
  this->Mesh.Message += (this->Mesh.Message.empty() ? "" : "; ") + message;
}

void FaceLoops::RequestSplit(const BoundaryVertex& v)
{
  if (v.Edge >= 0 && !this->Job.LastPass && !(*this->Job.Edges)[v.Edge].Degenerate)
  {
    this->Requests.push_back({ v.Edge, 0.5 * (v.T0 + v.T1) });
  }
}

} // namespace nurbs
