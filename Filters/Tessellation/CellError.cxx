// SPDX-License-Identifier: BSD-3-Clause
#include "CellError.h"

#include "FacetBound.h"
#include "SurfaceTree.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

CellError::CellError(const SurfaceBound& bound, const TreeGoal& goal)
  : Bound(bound)
  , Goal(goal)
  , Evaluator(bound.Evaluator())
{}

void CellError::Corners(const ParameterBox& box, const BezierPatch* patch)
{
  if (!patch)
  {
    const double us[2] = { box.U0, box.U1 };
    const double vs[2] = { box.V0, box.V1 };
    for (int k = 0; k < 4; ++k)
    {
      const SurfaceDerivatives d = this->Evaluator.Derivatives(us[k & 1], vs[k >> 1], 1);
      this->At[k] = { d.S, d.Su, d.Sv };
    }
    this->MaxWeight = this->Bound.MaximumWeight();
    return;
  }
  const int p = patch->Degree[0];
  const int q = patch->Degree[1];
  this->MaxWeight = 0.0;
  for (int k = 0; k < 4; ++k)
  {
    const int i = (k & 1) ? p : 0;
    const int j = (k >> 1) ? q : 0;
    const int in = (k & 1) ? p - 1 : 1;
    const int jn = (k >> 1) ? q - 1 : 1;
    const Vec4& c = patch->Points[i + j * (p + 1)];
    const Vec4 du =
      ((k & 1) ? c - patch->Points[in + j * (p + 1)] : patch->Points[in + j * (p + 1)] - c) *
      (p / box.A());
    const Vec4 dv =
      ((k >> 1) ? c - patch->Points[i + jn * (p + 1)] : patch->Points[i + jn * (p + 1)] - c) *
      (q / box.B());
    const Vec3 x = c.head<3>() / c[3];
    this->MaxWeight = std::max(this->MaxWeight, c[3]);
    this->At[k].X = x + this->Bound.Origin();
    this->At[k].Du = (du.head<3>() - du[3] * x) / c[3];
    this->At[k].Dv = (dv.head<3>() - dv[3] * x) / c[3];
  }
}

// Twice the tangent of the angle between `n` and the surface's normals at the corners: facets of
// neighbours meet at about that slope.
double CellError::Slope(const Vec3& n) const
{
  double slope = 0.0;
  for (const Corner& c : this->At)
  {
    const Vec3 m = c.Du.cross(c.Dv);
    const double along = m.dot(n);
    const double square = m.squaredNorm();
    if (along * along > 0.25 * square && square > 0.0)
    {
      slope = std::max(slope, std::sqrt(std::max(0.0, square / (along * along) - 1.0)));
    }
    else if (square > 0.0)
    {
      return 1.0;
    }
  }
  return 2.0 * slope;
}

namespace
{
// Facets of the two diagonals: corner indices of the triangles (counter-clockwise in u, v).
constexpr int Facets[2][2][3] = { { { 0, 1, 3 }, { 0, 3, 2 } }, { { 0, 1, 2 }, { 1, 3, 2 } } };
} // namespace

double CellError::Bounded(TreeLeaf& leaf, const BezierPatch* patch)
{
  const ParameterBox& box = leaf.Box;
  CurvatureRange& range = leaf.Range;
  const double a = box.A();
  const double b = box.B();
  const Vec3 d1 = this->At[3].X - this->At[0].X;
  const Vec3 d2 = this->At[2].X - this->At[1].X;
  Vec3 n = d1.cross(d2);
  const double area = n.norm();
  const Vec3 middle = 0.25 * (this->At[0].X + this->At[1].X + this->At[2].X + this->At[3].X);
  this->Bound.Evaluate(box, patch, middle, this->Coefficients);
  const double longest = std::max(d1.squaredNorm(), d2.squaredNorm());
  const bool flat = area > 1e-10 * longest && longest > 0.0;
  n = flat ? Vec3(n / area) : Vec3(Vec3::Zero());
  range = SurfaceBound::Range(
    this->Coefficients, n, this->At[1].X - this->At[0].X + this->At[3].X - this->At[2].X);
  const double sliding = DeviationBound(range, a, b);
  const double w = 0.125 / range.MinWeight;
  const auto most = [&](int k) { return std::max(range.High[k][0], -range.Low[k][0]) * w; };
  if (!flat)
  {
    this->CostU = a * a * range.Sliding[0];
    this->CostV = b * b * range.Sliding[2];
    leaf.Height = sliding;
    leaf.Sliding = 0.0;
    return sliding;
  }
  const Vec2 uv[4] = { Vec2(box.U0, box.V0), Vec2(box.U1, box.V0), Vec2(box.U0, box.V1),
    Vec2(box.U1, box.V1) };
  double worst = 1e300;
  for (int diagonal = 0; diagonal < 2; ++diagonal)
  {
    double error = 0.0;
    double height = 0.0;
    double slide = 0.0;
    for (const int* f : Facets[diagonal])
    {
      FacetBound facet(
        this->At[f[0]].X, this->At[f[1]].X, this->At[f[2]].X, uv[f[0]], uv[f[1]], uv[f[2]]);
      if (!facet.HasPlane())
      {
        continue; // A corner at a pole: no triangle there.
      }
      facet.SetFourthCorner(this->At[6 - f[0] - f[1] - f[2]].X, this->MaxWeight);
      facet.Add(range, box);
      double h = facet.Height();
      double d = facet.Deviation();
      const double slope = this->Slope(facet.Normal());
      if (h <= this->Goal.Tolerance && SurfaceDistance(h, d, slope) > this->Goal.Tolerance)
      {
        facet.AddEdges(range, box);
        d = facet.Sliding();
      }
      if (!patch && h > this->Goal.Tolerance)
      {
        const Vec3 corners[4] = { this->At[0].X, this->At[1].X, this->At[2].X, this->At[3].X };
        double values[4] = { 0.0, 0.0, 0.0, 0.0 };
        const int fourth = 6 - f[0] - f[1] - f[2];
        const double twist = facet.Normal().dot(corners[fourth] - corners[f[0]]);
        values[fourth] = this->MaxWeight * twist;
        const double share = 0.25 * std::abs(values[fourth]);
        const double goal = this->Goal.Tolerance * range.MinWeight - share;
        const SurfaceBound::Roughness rough =
          this->Bound.BoundRoughness(box, facet.Normal(), corners[f[0]], corners, values, goal);
        h = std::min(h, (rough.Height + share) / range.MinWeight);
        d = std::min(d, rough.Deviation);
      }
      height = std::max(height, h);
      slide = std::max(slide, d);
      error = std::max(error, SurfaceDistance(h, d, slope));
    }
    if (error < worst)
    {
      worst = error;
      leaf.Height = height;
      leaf.Sliding = slide;
      leaf.Diagonal = diagonal;
    }
  }
  const double slope = std::min(1.0, this->Slope(n));
  this->CostU = a * a * (most(0) + slope * 0.125 * range.Sliding[0]);
  this->CostV = b * b * (most(2) + slope * 0.125 * range.Sliding[2]);
  const double mixed = 2.0 * a * b * most(1);
  if (mixed > 4.0 * std::max(this->CostU, this->CostV))
  {
    // Twist alone: split the longer side.
    this->CostU = (this->At[1].X - this->At[0].X).norm() + (this->At[3].X - this->At[2].X).norm();
    this->CostV = (this->At[2].X - this->At[0].X).norm() + (this->At[3].X - this->At[1].X).norm();
  }
  return worst;
}

double CellError::Estimated(TreeLeaf& leaf, const BezierPatch* patch)
{
  const ParameterBox& box = leaf.Box;
  CurvatureRange& range = leaf.Range;
  const double a = box.A();
  const double b = box.B();
  // Second derivatives at the middle stand for those of the cell.
  const SurfaceDerivatives d =
    this->Evaluator.Derivatives(0.5 * (box.U0 + box.U1), 0.5 * (box.V0 + box.V1), 2);
  Vec3 n = (this->At[3].X - this->At[0].X).cross(this->At[2].X - this->At[1].X);
  const double area = n.norm();
  n = area > 0.0 ? Vec3(n / area) : Vec3(Vec3::Zero());
  range = CurvatureRange();
  range.Origin = d.S;
  range.Frame.setIdentity();
  const Vec3* second[3] = { &d.Suu, &d.Suv, &d.Svv };
  for (int k = 0; k < 3; ++k)
  {
    for (int c = 0; c < 3; ++c)
    {
      range.Low[k][c] = range.High[k][c] = (*second[k])[c];
    }
    range.Sliding[k] = second[k]->norm();
  }
  this->CostU = a * a * std::abs(n.dot(d.Suu));
  this->CostV = b * b * std::abs(n.dot(d.Svv));

  // Distances of samples from the facets' planes; several knot spans need more of them.
  const int m = patch ? 2 : 6;
  double worst[2] = { 0.0, 0.0 };
  Vec3 normal[2][2];
  for (int diagonal = 0; diagonal < 2; ++diagonal)
  {
    for (int f = 0; f < 2; ++f)
    {
      const int* t = Facets[diagonal][f];
      const Vec3& x = this->At[t[0]].X;
      normal[diagonal][f] = (this->At[t[1]].X - x).cross(this->At[t[2]].X - x);
      const double size = normal[diagonal][f].norm();
      normal[diagonal][f] /= size > 0.0 ? size : 1.0;
    }
  }
  for (int j = 0; j <= m; ++j)
  {
    for (int i = 0; i <= m; ++i)
    {
      if ((i == 0 || i == m) && (j == 0 || j == m))
      {
        continue;
      }
      const Vec3 x = this->Evaluator.Point(box.U0 + a * i / m, box.V0 + b * j / m);
      // Facet 0 lies beneath the diagonal from (0,0), or left of that from (1,0).
      const int side[2] = { i - j, m - i - j };
      for (int diagonal = 0; diagonal < 2; ++diagonal)
      {
        for (int f = 0; f < 2; ++f)
        {
          if ((f == 0 && side[diagonal] >= 0) || (f == 1 && side[diagonal] <= 0))
          {
            const Vec3& at = this->At[Facets[diagonal][f][0]].X;
            worst[diagonal] = std::max(worst[diagonal], std::abs(normal[diagonal][f].dot(x - at)));
          }
        }
      }
    }
  }
  leaf.Diagonal = worst[0] <= worst[1] ? 0 : 1;
  leaf.Height = worst[leaf.Diagonal];
  leaf.Sliding = 0.0;
  return leaf.Height;
}

bool CellError::ExceedsLimits(int& axis) const
{
  const auto length = [&](int i, int j) { return (this->At[i].X - this->At[j].X).norm(); };
  const double lu = std::max(length(0, 1), length(2, 3));
  const double lv = std::max(length(0, 2), length(1, 3));
  if (this->Goal.MaximumEdgeLength > 0.0 && std::hypot(lu, lv) > this->Goal.MaximumEdgeLength)
  {
    axis = lu >= lv ? 0 : 1;
    return true;
  }
  if (this->Goal.MaximumAngle > 0.0)
  {
    const auto angle = [&](int i, int j) {
      const Vec3 a = this->At[i].Du.cross(this->At[i].Dv);
      const Vec3 b = this->At[j].Du.cross(this->At[j].Dv);
      return std::atan2(a.cross(b).norm(), a.dot(b));
    };
    const double au = std::max(angle(0, 1), angle(2, 3));
    const double av = std::max(angle(0, 2), angle(1, 3));
    if (std::max({ au, av, angle(0, 3), angle(1, 2) }) > this->Goal.MaximumAngle)
    {
      axis = au >= av ? 0 : 1;
      return true;
    }
  }
  return false;
}

int CellError::Examine(const BezierPatch* patch, TreeLeaf& leaf)
{
  this->Corners(leaf.Box, patch);
  const double error = this->Goal.Error == ErrorMode::Guaranteed ? this->Bounded(leaf, patch)
                                                                 : this->Estimated(leaf, patch);
  leaf.Error = error;
  int axis = this->CostU >= this->CostV ? 0 : 1;
  leaf.Axis = axis;
  if (error <= this->Goal.Tolerance && !this->ExceedsLimits(axis))
  {
    return -1;
  }
  return axis;
}

} // namespace nurbs
