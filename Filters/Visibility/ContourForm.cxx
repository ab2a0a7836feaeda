// SPDX-License-Identifier: BSD-3-Clause
#include "ContourForm.h"

#include <array>
#include <cmath>
#include <limits>

namespace nurbs
{

namespace
{

// Bernstein functions of degree n and their first and second derivatives.
struct BernsteinBasis
{
  double Value[3][MaxDegree + 1];

  BernsteinBasis(int n, double t)
  {
    double lower[2][MaxDegree + 1] = {}; // Of degrees n - 1 and n - 2.
    double row[MaxDegree + 1] = { 1.0 };
    for (int k = 1; k <= n; ++k)
    {
      if (k == n - 1)
      {
        std::copy(row, row + n - 1, lower[1]);
      }
      if (k == n)
      {
        std::copy(row, row + n, lower[0]);
      }
      for (int i = k; i >= 0; --i)
      {
        row[i] = (i < k ? (1.0 - t) * row[i] : 0.0) + (i > 0 ? t * row[i - 1] : 0.0);
      }
    }
    for (int i = 0; i <= n; ++i)
    {
      const auto at = [&](int order, int k) {
        return k >= 0 && k <= n - order ? lower[order - 1][k] : 0.0;
      };
      this->Value[0][i] = row[i];
      this->Value[1][i] = n > 0 ? n * (at(1, i - 1) - at(1, i)) : 0.0;
      this->Value[2][i] =
        n > 1 ? n * (n - 1) * (at(2, i - 2) - 2.0 * at(2, i - 1) + at(2, i)) : 0.0;
    }
  }
};

using Net = std::vector<Vec3>; // Homogeneous in the plane of the image.

// H seen along three axes: two across the view and the view itself (perspective) or the weight. Two
// of them are measured from the patch's middle, so that g does not suffer from its place.
Net ProjectedNet(const BezierPatch& patch, const Viewer& viewer, ContourForm& form)
{
  Box3 box;
  double weight = 0.0;
  bool rational = false;
  for (const Vec4& h : patch.Points)
  {
    box.extend(Vec3(h.head<3>() / h[3]));
    weight = std::max(weight, h[3]);
    rational = rational || h[3] != 1.0;
  }
  const Vec3 middle = box.center();
  Vec3 axis = viewer.Toward(middle);
  const double length = axis.norm();
  axis = length > 0.0 ? Vec3(axis / length) : Vec3(Vec3::UnitZ());
  const Vec3 a = axis.unitOrthogonal();
  const Vec3 b = axis.cross(a);
  Net net;
  net.reserve(patch.Points.size());
  double view = viewer.Perspective ? 0.0 : 1.0;
  std::vector<Vec3> centred;
  centred.reserve(patch.Points.size());
  for (const Vec4& h : patch.Points)
  {
    const Vec3 c = h.head<3>() - middle * h[3];
    centred.push_back(c);
    // Perspective: minus the depth, which makes the determinant's sign that of the parallel one.
    const double third = viewer.Perspective ? length * h[3] - axis.dot(c) : h[3];
    net.emplace_back(a.dot(c), b.dot(c), third);
    if (viewer.Perspective)
    {
      view = std::max(view, viewer.Toward(h.head<3>() / h[3]).norm());
    }
  }
  double step[2] = { 0.0, 0.0 };
  const int width = patch.Degree[0] + 1;
  for (int j = 0; j <= patch.Degree[1]; ++j)
  {
    for (int i = 0; i <= patch.Degree[0]; ++i)
    {
      const int k = i + j * width;
      step[0] = i > 0 ? std::max(step[0], (centred[k] - centred[k - 1]).norm()) : step[0];
      step[1] = j > 0 ? std::max(step[1], (centred[k] - centred[k - width]).norm()) : step[1];
    }
  }
  form.Scale = step[0] * step[1] * view * (rational ? weight : 1.0);
  // Differences of control points are as inexact as the points.
  constexpr double Epsilon = 4.0 * std::numeric_limits<double>::epsilon();
  const double place = weight * box.max().cwiseAbs().cwiseMax(box.min().cwiseAbs()).maxCoeff();
  const double inexact =
    (step[0] > 0.0 ? place / step[0] : 0.0) + (step[1] > 0.0 ? place / step[1] : 0.0);
  form.Rounding = Epsilon * form.Scale * (4.0 + inexact);
  return net;
}

// Coordinate `axis` of the net in the scaled basis: its part of m x n differences or corners from
// (i, j) on. `du`, `dv`: differences instead of points.
ScaledForm Coordinate(const Net& net, const BezierPatch& patch, int axis,
  const std::array<int, 2>& degree, const std::array<int, 2>& first, bool du, bool dv)
{
  const int width = patch.Degree[0] + 1;
  ScaledForm out(degree[0], degree[1]);
  const std::vector<double> bu = Binomials(degree[0]);
  const std::vector<double> bv = Binomials(degree[1]);
  for (int j = 0; j <= degree[1]; ++j)
  {
    for (int i = 0; i <= degree[0]; ++i)
    {
      const int k = i + first[0] + (j + first[1]) * width;
      double c = net[k][axis];
      c = du ? net[k + 1][axis] - c : (dv ? net[k + width][axis] - c : c);
      out.Coefficients[i + j * (degree[0] + 1)] = c * bu[i] * bv[j];
    }
  }
  return out;
}

// a_u b_v - a_v b_u over p q.
BernsteinForm PlanarForm(const Net& net, const BezierPatch& patch)
{
  const int p = patch.Degree[0];
  const int q = patch.Degree[1];
  ScaledForm g(2 * p - 1, 2 * q - 1);
  for (int axis = 0; axis < 2; ++axis)
  {
    g.AddProduct(axis == 0 ? 1.0 : -1.0,
      Coordinate(net, patch, axis, { p - 1, q }, { 0, 0 }, true, false),
      Coordinate(net, patch, 1 - axis, { p, q - 1 }, { 0, 0 }, false, true));
  }
  return g.Unscaled();
}

using ScaledVector = std::array<ScaledForm, 3>;

ScaledVector Corner(const Net& net, const BezierPatch& patch, int i, int j)
{
  const std::array<int, 2> degree{ { patch.Degree[0] - 1, patch.Degree[1] - 1 } };
  const auto part = [&](int axis) {
    return Coordinate(net, patch, axis, degree, { { i, j } }, false, false);
  };
  return { { part(0), part(1), part(2) } };
}

ScaledVector Cross(const ScaledVector& a, const ScaledVector& b)
{
  const int m = 2 * a[0].Degree[0];
  const int n = 2 * a[0].Degree[1];
  ScaledVector out{ { ScaledForm(m, n), ScaledForm(m, n), ScaledForm(m, n) } };
  for (int k = 0; k < 3; ++k)
  {
    out[k].AddProduct(1.0, a[(k + 1) % 3], b[(k + 2) % 3]);
    out[k].AddProduct(-1.0, a[(k + 2) % 3], b[(k + 1) % 3]);
  }
  return out;
}

ScaledForm Dot(const ScaledVector& a, const ScaledVector& b)
{
  ScaledForm out(a[0].Degree[0] + b[0].Degree[0], a[0].Degree[1] + b[0].Degree[1]);
  for (int k = 0; k < 3; ++k)
  {
    out.AddProduct(1.0, a[k], b[k]);
  }
  return out;
}

// det[h, h_u, h_v] over p q. The four corners b_ij of what de Casteljau's algorithm leaves before its
// last step in each direction span h, h_u and h_v: L = (1 - v) b00 + v b01, R = (1 - v) b10 + v b11,
// h ^ h_u = L ^ R, and h_v = (1 - u) (b01 - b00) + u (b11 - b10).
BernsteinForm SpatialForm(const Net& net, const BezierPatch& patch)
{
  const ScaledVector b00 = Corner(net, patch, 0, 0);
  const ScaledVector b10 = Corner(net, patch, 1, 0);
  const ScaledVector b01 = Corner(net, patch, 0, 1);
  const ScaledVector b11 = Corner(net, patch, 1, 1);
  const ScaledVector left = Cross(b00, b01);
  const ScaledVector right = Cross(b10, b11);
  ScaledForm g(3 * patch.Degree[0] - 2, 3 * patch.Degree[1] - 2);
  g.AddTimesBilinear(-1.0, Dot(left, b10), false, false);
  g.AddTimesBilinear(-1.0, Dot(left, b11), false, true);
  g.AddTimesBilinear(1.0, Dot(right, b00), true, false);
  g.AddTimesBilinear(1.0, Dot(right, b01), true, true);
  return g.Unscaled();
}

// Point and derivatives to order 2 at (s, t).
SurfaceDerivatives DerivativesOf(const BezierPatch& patch, double s, double t)
{
  const BernsteinBasis u(patch.Degree[0], s);
  const BernsteinBasis v(patch.Degree[1], t);
  Vec4 h[3][3];
  for (auto& row : h)
  {
    for (Vec4& x : row)
    {
      x.setZero();
    }
  }
  const Vec4* p = patch.Points.data();
  for (int j = 0; j <= patch.Degree[1]; ++j)
  {
    Vec4 row[3] = { Vec4::Zero(), Vec4::Zero(), Vec4::Zero() };
    for (int i = 0; i <= patch.Degree[0]; ++i, ++p)
    {
      for (int a = 0; a < 3; ++a)
      {
        row[a] += u.Value[a][i] * *p;
      }
    }
    for (int a = 0; a < 3; ++a)
    {
      for (int b = 0; a + b < 3; ++b)
      {
        h[a][b] += v.Value[b][j] * row[a];
      }
    }
  }
  return ProjectDerivatives(h, 2);
}

} // namespace

Vec3 EvaluatePatch(const BezierPatch& patch, double s, double t)
{
  const BernsteinBasis u(patch.Degree[0], s);
  const BernsteinBasis v(patch.Degree[1], t);
  Vec4 h = Vec4::Zero();
  const Vec4* p = patch.Points.data();
  for (int j = 0; j <= patch.Degree[1]; ++j)
  {
    Vec4 row = Vec4::Zero();
    for (int i = 0; i <= patch.Degree[0]; ++i)
    {
      row += u.Value[0][i] * *p++;
    }
    h += v.Value[0][j] * row;
  }
  return h.head<3>() / h[3];
}

ContourValue EvaluateContour(const BezierPatch& patch, const Viewer& viewer, double s, double t)
{
  const SurfaceDerivatives d = DerivativesOf(patch, s, t);
  ContourValue out;
  out.Point = d.S;
  const Vec3 normal = d.Su.cross(d.Sv);
  const Vec3 view = viewer.Toward(d.S);
  const double length = normal.norm() * view.norm();
  // Where the eye is, nothing is seen edge-on.
  out.Cosine = view.isZero(0.0) ? 1.0 : 0.0;
  if (length > 0.0)
  {
    out.Cosine = normal.dot(view) / length;
    out.Gradient = Vec2((d.Suu.cross(d.Sv) + d.Su.cross(d.Suv)).dot(view),
                     (d.Suv.cross(d.Sv) + d.Su.cross(d.Svv)).dot(view)) /
      length;
  }
  return out;
}

Vec3 PatchNormal(const BezierPatch& patch, double s, double t)
{
  const SurfaceDerivatives d = DerivativesOf(patch, s, t);
  const Vec3 normal = d.Su.cross(d.Sv);
  const double length = normal.norm();
  return length > 0.0 ? Vec3(normal / length) : normal;
}

ContourForm MakeContourForm(const BezierPatch& patch, const Viewer& viewer)
{
  ContourForm out;
  const Net net = ProjectedNet(patch, viewer, out);
  bool planar = !viewer.Perspective;
  for (const Vec4& h : patch.Points)
  {
    planar = planar && h[3] == 1.0;
  }
  out.G = planar ? PlanarForm(net, patch) : SpatialForm(net, patch);
  return out;
}

} // namespace nurbs
