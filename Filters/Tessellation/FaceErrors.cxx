// SPDX-License-Identifier: BSD-3-Clause
#include "FaceErrors.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{
constexpr double SampleSlack = 1.1; // Four samples miss the greatest distance by up to a tenth.
} // namespace

// Of a triangle's own error. A gap in the model that is near the tolerance or over it can't be
// made up for by smaller triangles.
double FaceErrors::Limit() const
{
  const double tolerance = this->Job.Tolerance;
  return this->Gap < 0.7 * tolerance ? tolerance - this->Gap : tolerance;
}

bool FaceErrors::IsPole(int vertex) const
{
  if (vertex >= this->BoundaryCount)
  {
    return false;
  }
  const std::int64_t edge = this->Segments[vertex]->Edge;
  return (edge >= 0 && (*this->Job.Edges)[edge].Degenerate) ||
    this->Mesh.Points[vertex] == this->Mesh.Points[this->Next[vertex]];
}

bool FaceErrors::IsCollapsed(const int* t) const
{
  const Vec3* x = this->Mesh.Points.data();
  return x[t[0]] == x[t[1]] || x[t[1]] == x[t[2]] || x[t[2]] == x[t[0]];
}

// Slope of the mesh around a triangle against it: twice the tangent of the angle between the
// facet's normal and the surface's at the corners; 1 or more: too steep to use.
double FaceErrors::Slope(const int* t, const Vec3& n) const
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

FacetBound FaceErrors::Facet(const int* t, int leaf) const
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
  this->ForLeaves(
    t, leaf, [&](const CurvatureRange& range, const ParameterBox& box) { facet.Add(range, box); });
  return facet;
}

double FaceErrors::FacetError(const int* t, int leaf, FacetBound& facet) const
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
double FaceErrors::CloseError(const int* t) const
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
  const CurvatureRange range = SurfaceBound::Range(coefficients, facet.Normal(), X[t[1]] - X[t[0]]);
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

bool FaceErrors::CrossesCrease(const ParameterBox& box) const
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

ParameterBox FaceErrors::BoxOf(const int* t) const
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
double FaceErrors::EdgeSliverError(const int* t, const FacetBound& facet) const
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

// Estimated mode: the largest distance of the surface from the triangle's plane at its middle and at
// the middles of its edges.
double FaceErrors::SampledError(const int* t) const
{
  const Vec3* x = this->Mesh.Points.data();
  const Vec2* uv = this->Mesh.UV.data();
  Vec3 n = (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
  const double area = n.norm();
  if (!(area > 0.0))
  {
    return 0.0;
  }
  n /= area;
  SurfaceEvaluator evaluator(this->Job.Bound->Evaluator());
  const Vec2 samples[4] = { (uv[t[0]] + uv[t[1]] + uv[t[2]]) / 3.0, 0.5 * (uv[t[0]] + uv[t[1]]),
    0.5 * (uv[t[1]] + uv[t[2]]), 0.5 * (uv[t[2]] + uv[t[0]]) };
  double error = 0.0;
  for (const Vec2& p : samples)
  {
    error = std::max(error, std::abs(n.dot(evaluator.Point(p[0], p[1]) - x[t[0]])));
  }
  return SampleSlack * error;
}

// Bound of the surface's distance from a triangle; `leaf`: see Leaf.
double FaceErrors::TriangleError(const int* t, int leaf) const
{
  if (this->IsCollapsed(t))
  {
    return 0.0; // At a pole: no triangle comes out.
  }
  if (this->Job.Options->Error == ErrorMode::Estimated && leaf < 0)
  {
    return this->SampledError(t);
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

} // namespace nurbs
