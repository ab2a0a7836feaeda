// SPDX-License-Identifier: BSD-3-Clause
#include "FaceCheck.h"

#include "FaceSurface.h"
#include "FaceTrim.h"

#include <BRepGProp.hxx>
#include <Eigen/Geometry>
#include <GProp_GProps.hxx>

#include <algorithm>
#include <cmath>
#include <queue>

namespace verify
{

namespace
{

constexpr double Infinity = std::numeric_limits<double>::infinity();

struct Candidate
{
  double Distance;
  Vec3 Point;
  Foot Nearest;
  int Triangle;
  bool operator<(const Candidate& other) const { return this->Distance > other.Distance; }
};

/// The few largest values seen; the smallest of them on top.
class Largest
{
public:
  explicit Largest(std::size_t count)
    : Count(count)
  {}
  void Add(const Candidate& c)
  {
    if (this->Kept.size() < this->Count || c.Distance > this->Kept.top().Distance)
    {
      this->Kept.push(c);
      if (this->Kept.size() > this->Count)
      {
        this->Kept.pop();
      }
    }
  }
  std::vector<Candidate> Take()
  {
    std::vector<Candidate> all;
    for (; !this->Kept.empty(); this->Kept.pop())
    {
      all.push_back(this->Kept.top());
    }
    std::reverse(all.begin(), all.end());
    return all;
  }

private:
  std::size_t Count;
  std::priority_queue<Candidate> Kept;
};

/// Barycentric weights of the samples of a triangle that is one of @a count.
std::vector<Vec3> SamplePattern(std::size_t count, double density)
{
  const double wanted = 4000.0 * density / double(std::max<std::size_t>(count, 1));
  if (wanted < 8.0 * density && density <= 1.0)
  {
    return { { 0.5, 0.5, 0.0 }, { 0.0, 0.5, 0.5 }, { 0.5, 0.0, 0.5 },
      { 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0 }, { 2.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0 },
      { 1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0 }, { 1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0 } };
  }
  const int n = wanted < 60.0 ? 6 : wanted < 250.0 ? 12 : 24;
  std::vector<Vec3> pattern;
  for (int i = 0; i <= n; ++i)
  {
    for (int j = 0; i + j <= n; ++j)
    {
      if (std::max({ i, j, n - i - j }) < n)
      {
        pattern.emplace_back(double(i) / n, double(j) / n, double(n - i - j) / n);
      }
    }
  }
  return pattern;
}

class Checker
{
public:
  Checker(const TopoDS_Face& face, const FaceMesh& mesh, const CheckOptions& options)
    : Face(face)
    , Mesh(mesh)
    , Options(options)
    , Surface(face, 1e-3 * options.Tolerance)
    , Trim(face, Surface, 0.02 * options.Tolerance)
  {
    this->Surface.SetRegion(this->Trim.Low(), this->Trim.High());
  }

  FaceReport Run()
  {
    this->Report.Triangles = long(this->Mesh.Triangles.size());
    this->Report.BrokenWires = this->Trim.Broken();
    this->MeasureExactArea();
    this->Report.Missing = this->Mesh.Triangles.empty();
    if (this->Report.Missing)
    {
      this->Report.MeshToFace = this->Report.FaceToMesh = Infinity;
      return this->Report;
    }
    this->ProjectVertices();
    this->MeasureMesh();
    this->MeasureFace();
    return this->Report;
  }

private:
  void MeasureExactArea()
  {
    GProp_GProps properties;
    BRepGProp::SurfaceProperties(this->Face, properties, 1e-6);
    this->Report.ExactArea = std::abs(properties.Mass());
  }

  // Every vertex's foot, starting from that of a neighbour; global where that gives a large distance.
  void ProjectVertices()
  {
    const std::size_t count = this->Mesh.Points.size();
    this->Feet.assign(count, Foot{});
    std::vector<std::vector<int>> neighbours(count);
    for (const auto& t : this->Mesh.Triangles)
    {
      for (std::size_t k = 0; k < 3; ++k)
      {
        neighbours[std::size_t(t[k])].push_back(t[(k + 1) % 3]);
        neighbours[std::size_t(t[k])].push_back(t[(k + 2) % 3]);
      }
    }
    std::vector<char> seen(count, 0);
    std::vector<int> queue;
    for (std::size_t start = 0; start < count; ++start)
    {
      if (seen[start] || neighbours[start].empty())
      {
        continue;
      }
      seen[start] = 1;
      this->Feet[start] = this->Surface.ProjectGlobally(this->Mesh.Points[start]);
      queue.assign(1, int(start));
      for (std::size_t at = 0; at < queue.size(); ++at)
      {
        for (int n : neighbours[std::size_t(queue[at])])
        {
          if (!seen[std::size_t(n)])
          {
            seen[std::size_t(n)] = 1;
            queue.push_back(n);
            this->ProjectVertex(std::size_t(n), this->Feet[std::size_t(queue[at])].UV);
          }
        }
      }
    }
  }

  void ProjectVertex(std::size_t v, const Vec2& seed)
  {
    const Vec3& p = this->Mesh.Points[v];
    Foot foot = this->Surface.Project(p, seed);
    if (foot.Distance > 0.5 * this->Options.Tolerance)
    {
      const Foot global = this->Surface.ProjectGlobally(p);
      foot = global.Distance < foot.Distance ? global : foot;
    }
    this->Feet[v] = foot;
  }

  /// The corners' parameters on one sheet of a periodic surface.
  std::array<Vec2, 3> CornerUV(const std::array<int, 3>& t) const
  {
    std::array<Vec2, 3> uv;
    for (std::size_t k = 0; k < 3; ++k)
    {
      uv[k] = this->Feet[std::size_t(t[k])].UV;
      for (int d = 0; d < 2; ++d)
      {
        const double period = this->Surface.Period(d);
        if (period > 0.0)
        {
          uv[k][d] -= period * std::round((uv[k][d] - uv[0][d]) / period);
        }
      }
    }
    return uv;
  }

  double TrimmedDistance(const Vec3& p, const Foot& foot) const
  {
    Vec2 uv = foot.UV;
    return this->Trim.Covers(uv) ? foot.Distance : this->Trim.BoundaryDistance(p, Infinity);
  }

  Candidate Measure(const Vec3& p, const Vec2& seed, int triangle) const
  {
    Candidate c{ 0.0, p, this->Surface.Project(p, seed), triangle };
    c.Distance = this->TrimmedDistance(p, c.Nearest);
    if (c.Distance > this->Options.Tolerance && !this->Surface.IsElementary())
    {
      const Foot global = this->Surface.ProjectGlobally(p);
      const double d = this->TrimmedDistance(p, global);
      if (d < c.Distance)
      {
        c.Nearest = global;
        c.Distance = d;
      }
    }
    return c;
  }

  void SampleTriangle(int index, const std::vector<Vec3>& pattern, Largest& largest)
  {
    const auto& t = this->Mesh.Triangles[std::size_t(index)];
    const auto uv = this->CornerUV(t);
    for (const Vec3& w : pattern)
    {
      Vec3 p = Vec3::Zero();
      Vec2 seed = Vec2::Zero();
      for (int k = 0; k < 3; ++k)
      {
        p += w[k] * this->Mesh.Points[std::size_t(t[std::size_t(k)])];
        seed += w[k] * uv[std::size_t(k)];
      }
      largest.Add(this->Measure(p, seed, index));
    }
    this->Report.Samples += long(pattern.size());
  }

  void CheckOrientation(const std::array<int, 3>& t)
  {
    const Vec3& a = this->Mesh.Points[std::size_t(t[0])];
    const Vec3 ab = this->Mesh.Points[std::size_t(t[1])] - a;
    const Vec3 ac = this->Mesh.Points[std::size_t(t[2])] - a;
    const Vec3 normal = ab.cross(ac);
    this->Report.MeshArea += 0.5 * normal.norm();
    const double longest = std::max({ ab.norm(), ac.norm(), (ac - ab).norm() });
    if (!(normal.norm() > 1e-6 * this->Options.Tolerance * longest))
    {
      ++this->Report.Degenerate;
      return;
    }
    const auto uv = this->CornerUV(t);
    // Against the face's normal at its middle and against the mean of those at its corners: on a rough
    // face the surface may be steep at one place of a triangle that is within the tolerance.
    const Foot foot = this->Surface.Project(a + (ab + ac) / 3.0, (uv[0] + uv[1] + uv[2]) / 3.0);
    const Vec3 middle = this->Surface.OuterNormal(foot.UV);
    Vec3 corners = Vec3::Zero();
    for (const Vec2& corner : uv)
    {
      corners += this->Surface.OuterNormal(corner);
    }
    const Vec3 n = normal.normalized();
    this->Report.Folded += n.dot(middle) < -1e-6 && n.dot(corners) < -1e-6;
  }

  void MeasureMesh()
  {
    const auto pattern = SamplePattern(this->Mesh.Triangles.size(), this->Options.Density);
    Largest largest(48);
    for (std::size_t i = 0; i < this->Mesh.Triangles.size(); ++i)
    {
      this->SampleTriangle(int(i), pattern, largest);
      this->CheckOrientation(this->Mesh.Triangles[i]);
    }
    for (std::size_t v = 0; v < this->Feet.size(); ++v)
    {
      if (this->Feet[v].Distance < Infinity)
      {
        largest.Add(this->Measure(this->Mesh.Points[v], this->Feet[v].UV, -1));
      }
    }
    auto worst = largest.Take();
    this->SharpenAround(worst, largest);
    this->Confirm(worst);
  }

  /// Samples the worst triangles once more, densely.
  void SharpenAround(std::vector<Candidate>& worst, Largest& largest)
  {
    std::vector<int> done;
    for (const Candidate& c : worst)
    {
      largest.Add(c);
      if (done.size() < 4 && c.Triangle >= 0 &&
        std::find(done.begin(), done.end(), c.Triangle) == done.end())
      {
        done.push_back(c.Triangle);
        this->SampleTriangle(c.Triangle, SamplePattern(60, 1.0), largest);
      }
    }
    worst = largest.Take();
  }

  /// Worst first: a global search may find the surface nearer; stops once nothing can exceed.
  void Confirm(std::vector<Candidate>& worst)
  {
    double confirmed = 0.0;
    for (const Candidate& c : worst)
    {
      if (c.Distance <= confirmed)
      {
        break;
      }
      double d = c.Distance;
      if (!this->Surface.IsElementary())
      {
        const Foot foot = this->Surface.ProjectExhaustively(c.Point, c.Nearest);
        d = std::min(d, this->TrimmedDistance(c.Point, foot));
      }
      d = std::min(d, this->Trim.BoundaryDistanceExactly(c.Point));
      if (d > confirmed)
      {
        confirmed = d;
        this->Report.WorstOnMesh = c.Point;
      }
    }
    this->Report.MeshToFace = confirmed;
  }

  /// Parameters that cut the region into @a count parts of about equal length in space.
  std::vector<double> EvenLines(int direction, int count, double* length) const
  {
    const Vec2 low = this->Trim.Low(), size = this->Trim.High() - low;
    const int steps = 96, across = 5;
    std::vector<double> travelled{ 0.0 };
    for (int i = 0; i < steps; ++i)
    {
      double speed = 0.0;
      for (int k = 0; k < across; ++k)
      {
        Vec2 uv = low;
        uv[direction] += size[direction] * (i + 0.5) / steps;
        uv[1 - direction] += size[1 - direction] * (k + 0.5) / across;
        Vec3 p, su, sv;
        this->Surface.Derivatives(uv, p, su, sv);
        speed += (direction == 0 ? su : sv).norm();
      }
      travelled.push_back(travelled.back() + speed * size[direction] / (steps * across));
    }
    *length = travelled.back();
    std::vector<double> lines;
    std::size_t at = 0;
    for (int i = 0; i <= count; ++i)
    {
      const double target = *length * i / count;
      while (at + 2 < travelled.size() && travelled[at + 1] < target)
      {
        ++at;
      }
      const double part = travelled[at + 1] - travelled[at];
      const double s = part > 0.0 ? (target - travelled[at]) / part : 0.0;
      lines.push_back(low[direction] + size[direction] * (double(at) + s) / steps);
    }
    return lines;
  }

  void CompareWithMesh(const ClosestTriangle& tree, const Vec3& p)
  {
    const double d = tree.Find(p).Distance;
    if (d > this->Report.FaceToMesh)
    {
      this->Report.FaceToMesh = d;
      this->Report.WorstOnFace = p;
    }
    ++this->Report.Samples;
  }

  void MeasureFace()
  {
    ClosestTriangle tree;
    tree.Build(this->Mesh.Points, this->Mesh.Triangles);
    const double wanted =
      this->Options.Density * std::max(2000.0, 2.0 * double(this->Mesh.Triangles.size()));
    const double step = this->Trim.Length() / (this->Options.Density * 800.0);
    for (const Vec3& p : this->Trim.BoundarySamples(step))
    {
      this->CompareWithMesh(tree, p);
    }
    double lengthU = 0.0, lengthV = 0.0, bending = 0.0;
    this->EvenLines(0, 1, &lengthU);
    this->EvenLines(1, 1, &lengthV);
    long covered = 0;
    for (double factor = 1.0; factor < 100.0 && covered < long(wanted) / 4; factor *= 4.0)
    {
      const double ratio = std::clamp(lengthU / std::max(lengthV, 1e-300), 1e-2, 1e2);
      const int nu = std::max(4, int(std::sqrt(factor * wanted * ratio)));
      const int nv = std::max(4, int(std::sqrt(factor * wanted / ratio)));
      const auto us = this->EvenLines(0, nu, &lengthU), vs = this->EvenLines(1, nv, &lengthV);
      covered = 0;
      bending = 0.0;
      for (std::size_t i = 0; i + 1 < us.size(); ++i)
      {
        for (std::size_t j = 0; j + 1 < vs.size(); ++j)
        {
          Vec2 uv(0.5 * (us[i] + us[i + 1]), 0.5 * (vs[j] + vs[j + 1]));
          if (this->Trim.Covers(uv))
          {
            ++covered;
            bending += this->Surface.BendingDensity(uv) * (us[i + 1] - us[i]) * (vs[j + 1] - vs[j]);
            this->CompareWithMesh(tree, this->Surface.Point(uv));
          }
        }
      }
    }
    this->Report.AreaSpread = this->Trim.Length() + bending;
  }

  const TopoDS_Face& Face;
  const FaceMesh& Mesh;
  const CheckOptions& Options;
  FaceSurface Surface;
  FaceTrim Trim;
  std::vector<Foot> Feet;
  FaceReport Report;
};

} // namespace

FaceReport CheckFace(const TopoDS_Face& face, const FaceMesh& mesh, const CheckOptions& options)
{
  return Checker(face, mesh, options).Run();
}

} // namespace verify
