// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceBound.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>

namespace nurbs
{

Deviation BoundDeviation(
  const CurvatureRange& range, double a, double b, const Vec3& n, const Vec3& p0, bool mixed)
{
  const Vec3 local = range.Frame.transpose() * n;
  const double offset = std::abs(n.dot(p0 - range.Origin));
  const double scale[3] = { 0.125 * a * a, 0.25 * a * b, 0.125 * b * b };
  Deviation d;
  for (int k = 0; k < 3; ++k)
  {
    if (scale[k] == 0.0 || (k == 1 && !mixed))
    {
      continue;
    }
    double most = offset * range.Weight[k];
    double least = -most;
    for (int c = 0; c < 3; ++c)
    {
      most += local[c] * (local[c] > 0.0 ? range.High[k][c] : range.Low[k][c]);
      least += local[c] * (local[c] > 0.0 ? range.Low[k][c] : range.High[k][c]);
    }
    const double up = std::max(0.0, -least); // Second derivatives below zero bend f up.
    const double down = std::max(0.0, most);
    // The mixed term has either sign.
    d.Above += scale[k] * (k == 1 ? std::max(up, down) : up);
    d.Below += scale[k] * (k == 1 ? std::max(up, down) : down);
  }
  return d;
}

double DeviationBound(const CurvatureRange& range, double a, double b)
{
  return 0.125 *
    (a * a * range.Sliding[0] + 2.0 * a * b * range.Sliding[1] + b * b * range.Sliding[2]);
}

namespace
{
// Rows of blossom coefficients: point i of the Bezier form of [a, b] in span `k` is the blossom at
// a (p - i times) and b (i times), a combination of the p + 1 control points of the span.
void BlossomMatrix(KnotView knots, int p, int k, double a, double b, std::vector<double>& m)
{
  m.assign(std::size_t(p + 1) * (p + 1), 0.0);
  std::vector<double> c(std::size_t(p + 1) * (p + 1));
  for (int row = 0; row <= p; ++row)
  {
    std::fill(c.begin(), c.end(), 0.0);
    for (int i = 0; i <= p; ++i)
    {
      c[std::size_t(i) * (p + 1) + i] = 1.0;
    }
    for (int r = 1; r <= p; ++r)
    {
      const double t = r <= p - row ? a : b;
      for (int i = p; i >= r; --i)
      {
        const double lo = knots[k - p + i];
        const double hi = knots[k + 1 + i - r];
        const double s = (t - lo) / (hi - lo);
        for (int x = 0; x <= p; ++x)
        {
          double& target = c[std::size_t(i) * (p + 1) + x];
          target = (1.0 - s) * c[std::size_t(i - 1) * (p + 1) + x] + s * target;
        }
      }
    }
    std::copy_n(
      c.begin() + std::size_t(p) * (p + 1), p + 1, m.begin() + std::size_t(row) * (p + 1));
  }
}
} // namespace

SurfaceBound::SurfaceBound(const SurfaceView& surface)
  : Surface(surface)
  , Prototype(surface)
{
  Box3 box;
  const std::int64_t size = surface.Size();
  double wmin = surface.Weight(0);
  double wmax = wmin;
  for (std::int64_t k = 0; k < size; ++k)
  {
    box.extend(surface.Point(k));
    const double w = surface.Weight(k);
    wmin = std::min(wmin, w);
    wmax = std::max(wmax, w);
  }
  this->GreatestWeight = wmax;
  this->IsRational = wmax - wmin > 1e-14 * wmax;
  this->Center = box.center();
  this->Diagonal = box.diagonal().norm();
  this->Control.Count[0] = surface.Count[0];
  this->Control.Count[1] = surface.Count[1];
  this->Control.Points.resize(size);
  // Weights that are all equal divide out: use 1 so that the polynomial bounds apply.
  for (std::int64_t k = 0; k < size; ++k)
  {
    const double w = this->IsRational ? surface.Weight(k) : 1.0;
    this->Control.Points[k] << (surface.Point(k) - this->Center) * w, w;
  }
  const bool manySpans = DistinctKnots(surface.Knots[0], surface.Degree[0]).size() > 2 ||
    DistinctKnots(surface.Knots[1], surface.Degree[1]).size() > 2;
  if (manySpans)
  {
    const KnotView* U = surface.Knots;
    const int* p = surface.Degree;
    this->First[0] = this->Derivative(this->Control, 0, U[0], p[0], 1);
    this->First[1] = this->Derivative(this->Control, 1, U[1], p[1], 1);
    this->Second[0] = this->Derivative(this->First[0], 0, U[0], p[0], 2);
    this->Second[1] = this->Derivative(this->First[0], 1, U[1], p[1], 1);
    this->Second[2] = this->Derivative(this->First[1], 1, U[1], p[1], 2);
    this->HaveNets = true;
    this->MakeBezierNet();
  }
}

// Bezier coefficients of all spans: rows first, then columns, by the same blossoms as Extract.
void SurfaceBound::MakeBezierNet()
{
  const int* p = this->Surface.Degree;
  Net rows;
  Net* const stage[2] = { &rows, &this->BezierNet };
  const Net* from = &this->Control;
  for (int d = 0; d < 2; ++d)
  {
    const KnotView& knots = this->Surface.Knots[d];
    for (const Knot& knot : DistinctKnots(knots, p[d]))
    {
      this->Breaks[d].push_back(knot.Value);
    }
    const int spans = int(this->Breaks[d].size()) - 1;
    Net& to = *stage[d];
    to.Count[d] = spans * p[d] + 1;
    to.Count[1 - d] = from->Count[1 - d];
    to.Points.assign(std::size_t(to.Count[0]) * to.Count[1], Vec4::Zero());
    std::vector<double> m;
    for (int s = 0; s < spans; ++s)
    {
      const double a = this->Breaks[d][s];
      const double b = this->Breaks[d][s + 1];
      const int k = FindSpan(knots, p[d], 0.5 * (a + b));
      BlossomMatrix(knots, p[d], k, a, b, m);
      for (int line = 0; line < to.Count[1 - d]; ++line)
      {
        for (int i = 0; i <= p[d]; ++i)
        {
          Vec4 sum = Vec4::Zero();
          for (int x = 0; x <= p[d]; ++x)
          {
            const int at = k - p[d] + x;
            sum += m[std::size_t(i) * (p[d] + 1) + x] *
              (d == 0 ? from->At(at, line) : from->At(line, at));
          }
          const int out = s * p[d] + i;
          to.Points[d == 0 ? out + std::size_t(line) * to.Count[0]
                           : line + std::size_t(out) * to.Count[0]] = sum;
        }
      }
    }
    from = stage[d];
  }
}

SurfaceBound::Roughness SurfaceBound::BoundRoughness(const ParameterBox& box, const Vec3& n,
  const Vec3& p0, const Vec3 (&corners)[4], const double (&values)[4], double limit) const
{
  const int* p = this->Surface.Degree;
  const double from[2] = { box.U0, box.V0 };
  const double to[2] = { box.U1, box.V1 };
  int lo[2];
  int hi[2];
  for (int d = 0; d < 2; ++d)
  {
    const std::vector<double>& b = this->Breaks[d];
    const double eps = NegligibleSpan * (to[d] - from[d]);
    lo[d] = int(std::upper_bound(b.begin(), b.end(), from[d] + eps) - b.begin()) - 1;
    hi[d] = int(std::lower_bound(b.begin(), b.end(), to[d] - eps) - b.begin());
    lo[d] = std::max(0, std::min(lo[d], int(b.size()) - 2));
    hi[d] = std::max(lo[d] + 1, std::min(hi[d], int(b.size()) - 1));
  }
  const auto greville = [&](int d, int i) {
    const int s = std::min(i / p[d], int(this->Breaks[d].size()) - 2);
    const double t = double(i - s * p[d]) / p[d];
    return ((1.0 - t) * this->Breaks[d][s] + t * this->Breaks[d][s + 1] - from[d]) /
      (to[d] - from[d]);
  };
  const Vec3 origin = p0 - this->Center;
  const Vec3 x0 = corners[0] - this->Center;
  const Vec3 xu = corners[1] - corners[0];
  const Vec3 xv = corners[2] - corners[0];
  const Vec3 xuv = corners[3] - corners[1] - corners[2] + corners[0];
  const double offset = n.dot(origin);
  const double fu = values[1] - values[0];
  const double fv = values[2] - values[0];
  const double fuv = values[3] - values[1] - values[2] + values[0];
  double height = 0.0;
  double deviation = 0.0;
  double wmin = 1e300;
  // A coarse look first: most boxes that fail do so at once.
  for (const int stride : { 7, 1 })
  {
    for (int j = lo[1] * p[1]; j <= hi[1] * p[1]; j += stride)
    {
      const double v = greville(1, j);
      for (int i = lo[0] * p[0]; i <= hi[0] * p[0]; i += stride)
      {
        const double u = greville(0, i);
        const Vec4& h = this->BezierNet.At(i, j);
        const double f = n[0] * h[0] + n[1] * h[1] + n[2] * h[2] - h[3] * offset;
        height = std::max(height, std::abs(f - (values[0] + u * fu + v * fv + u * v * fuv)));
        const Vec3 x = x0 + u * xu + v * xv + (u * v) * xuv;
        deviation = std::max(deviation, (h.head<3>() - h[3] * x).squaredNorm());
        wmin = std::min(wmin, h[3]);
      }
      if (height > limit)
      {
        return { height, 1e300 };
      }
    }
  }
  // For a rational surface the product w x is no bilinear function; derivatives bound the sliding.
  return { height, this->IsRational ? 1e300 : std::sqrt(deviation) / wmin };
}

// The control net of the derivative of order `order` from that of order - 1: coefficient i belongs
// to the same index window of knots, so that spans find their coefficients by index.
SurfaceBound::Net SurfaceBound::Derivative(
  const Net& net, int dir, KnotView knots, int degree, int order) const
{
  Net out;
  out.Count[0] = net.Count[0] - (dir == 0);
  out.Count[1] = net.Count[1] - (dir == 1);
  const int q = degree - order + 1;
  if (q <= 0)
  {
    return Net();
  }
  out.Points.resize(std::size_t(out.Count[0]) * out.Count[1]);
  for (int j = 0; j < out.Count[1]; ++j)
  {
    for (int i = 0; i < out.Count[0]; ++i)
    {
      const int k = dir == 0 ? i : j;
      const double d = knots[k + degree + 1] - knots[k + order];
      const Vec4 difference =
        dir == 0 ? net.At(i + 1, j) - net.At(i, j) : net.At(i, j + 1) - net.At(i, j);
      out.Points[i + std::size_t(j) * out.Count[0]] =
        d > 0.0 ? Vec4(difference * (q / d)) : Vec4(Vec4::Zero());
    }
  }
  return out;
}

bool SurfaceBound::IsPlanar(double tolerance, Vec3& normal, double& distance) const
{
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  Vec3 mean = Vec3::Zero();
  const std::size_t n = this->Control.Points.size();
  for (const Vec4& h : this->Control.Points)
  {
    mean += h.head<3>() / h[3];
  }
  mean /= double(n);
  for (const Vec4& h : this->Control.Points)
  {
    const Vec3 d = h.head<3>() / h[3] - mean;
    covariance += d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  normal = solver.eigenvectors().col(0).normalized();
  distance = 0.0;
  for (const Vec4& h : this->Control.Points)
  {
    distance = std::max(distance, std::abs(normal.dot(h.head<3>() / h[3] - mean)));
    if (!(distance <= tolerance))
    {
      return false;
    }
  }
  return true;
}

bool SurfaceBound::InOneSpan(const ParameterBox& box) const
{
  const double low[2] = { box.U0, box.V0 };
  const double high[2] = { box.U1, box.V1 };
  for (int d = 0; d < 2; ++d)
  {
    const KnotView& knots = this->Surface.Knots[d];
    const int span = FindSpan(knots, this->Surface.Degree[d], 0.5 * (low[d] + high[d]));
    const double eps = NegligibleSpan * (high[d] - low[d]);
    if (low[d] < knots[span] - eps || high[d] > knots[span + 1] + eps)
    {
      return false;
    }
  }
  return true;
}

void SurfaceBound::Extract(const ParameterBox& box, BezierPatch& patch) const
{
  const int p = this->Surface.Degree[0];
  const int q = this->Surface.Degree[1];
  const int ku = FindSpan(this->Surface.Knots[0], p, 0.5 * (box.U0 + box.U1));
  const int kv = FindSpan(this->Surface.Knots[1], q, 0.5 * (box.V0 + box.V1));
  std::vector<double> mu;
  std::vector<double> mv;
  BlossomMatrix(this->Surface.Knots[0], p, ku, box.U0, box.U1, mu);
  BlossomMatrix(this->Surface.Knots[1], q, kv, box.V0, box.V1, mv);
  std::vector<Vec4> rows(std::size_t(p + 1) * (q + 1));
  for (int j = 0; j <= q; ++j)
  {
    for (int i = 0; i <= p; ++i)
    {
      Vec4 sum = Vec4::Zero();
      for (int x = 0; x <= p; ++x)
      {
        sum += mu[std::size_t(i) * (p + 1) + x] * this->Control.At(ku - p + x, kv - q + j);
      }
      rows[i + std::size_t(j) * (p + 1)] = sum;
    }
  }
  patch.Degree[0] = p;
  patch.Degree[1] = q;
  patch.U = { box.U0, box.U1 };
  patch.V = { box.V0, box.V1 };
  patch.Points.assign(rows.size(), Vec4::Zero());
  for (int j = 0; j <= q; ++j)
  {
    for (int y = 0; y <= q; ++y)
    {
      const double f = mv[std::size_t(j) * (q + 1) + y];
      for (int i = 0; i <= p; ++i)
      {
        patch.Points[i + std::size_t(j) * (p + 1)] += f * rows[i + std::size_t(y) * (p + 1)];
      }
    }
  }
}

void SurfaceBound::Evaluate(
  const ParameterBox& box, const BezierPatch* patch, const Vec3& origin, Coefficients& out) const
{
  out.Origin = origin;
  if (patch)
  {
    FromBezier(box, *patch, origin - this->Center, out, this->IsRational);
  }
  else
  {
    this->FromNets(box, origin - this->Center, out);
  }
}

namespace
{
// H'' relative to `origin`: the weight's share moves with it.
inline Vec4 Shift(const Vec4& h, const Vec3& origin)
{
  return Vec4(h[0] - h[3] * origin[0], h[1] - h[3] * origin[1], h[2] - h[3] * origin[2], h[3]);
}
} // namespace

void SurfaceBound::FromBezier(const ParameterBox& box, const BezierPatch& patch, const Vec3& origin,
  Coefficients& out, bool rational)
{
  const int p = patch.Degree[0];
  const int q = patch.Degree[1];
  const double a = box.A();
  const double b = box.B();
  const Vec4* P = patch.Points.data();
  const int s = p + 1;
  const double f[3] = { p * (p - 1) / (a * a), p * q / (a * b), q * (q - 1) / (b * b) };
  for (auto& second : out.Second)
  {
    second.clear();
  }
  for (int j = 0; j <= q; ++j)
  {
    for (int i = 0; i <= p; ++i)
    {
      const Vec4* c = P + i + j * s;
      if (i + 2 <= p)
      {
        out.Second[0].push_back((c[2] - 2.0 * c[1] + c[0]) * f[0]);
      }
      if (i < p && j < q)
      {
        out.Second[1].push_back((c[s + 1] - c[s] - c[1] + c[0]) * f[1]);
      }
      if (j + 2 <= q)
      {
        out.Second[2].push_back((c[2 * s] - 2.0 * c[s] + c[0]) * f[2]);
      }
    }
  }
  out.MinWeight = 1.0;
  out.Separable = false;
  out.WeightU = out.WeightV = out.FirstU = out.FirstV = out.Radius = 0.0;
  if (!rational)
  {
    return;
  }
  SeparableSliding(box, patch, out);
  double wmin = P[0][3];
  double radius = 0.0;
  for (const Vec4& h : patch.Points)
  {
    wmin = std::min(wmin, h[3]);
    radius = std::max(radius, (h.head<3>() / h[3] - origin).squaredNorm());
  }
  double fu = 0.0;
  double fv = 0.0;
  for (int j = 0; j <= q; ++j)
  {
    for (int i = 0; i <= p; ++i)
    {
      const Vec4* c = P + i + j * s;
      if (i < p)
      {
        const Vec4 d = Shift(c[1] - c[0], origin);
        fu = std::max(fu, d.head<3>().squaredNorm());
        out.WeightU = std::max(out.WeightU, std::abs(d[3]));
      }
      if (j < q)
      {
        const Vec4 d = Shift(c[s] - c[0], origin);
        fv = std::max(fv, d.head<3>().squaredNorm());
        out.WeightV = std::max(out.WeightV, std::abs(d[3]));
      }
    }
  }
  out.FirstU = std::sqrt(fu) * p / a;
  out.FirstV = std::sqrt(fv) * q / b;
  out.WeightU *= p / a;
  out.WeightV *= q / b;
  out.MinWeight = wmin;
  out.Radius = std::sqrt(radius);
  for (auto& second : out.Second)
  {
    for (Vec4& h : second)
    {
      h = Shift(h, origin);
    }
  }
}

void SurfaceBound::FromNets(const ParameterBox& box, const Vec3& origin, Coefficients& out) const
{
  const int* p = this->Surface.Degree;
  int lo[2];
  int hi[2]; // First and last span that the box touches.
  const double from[2] = { box.U0, box.V0 };
  const double to[2] = { box.U1, box.V1 };
  for (int d = 0; d < 2; ++d)
  {
    const KnotView& knots = this->Surface.Knots[d];
    lo[d] = FindSpan(knots, p[d], from[d]);
    hi[d] = FindSpan(knots, p[d], to[d]);
    const double eps = NegligibleSpan * (to[d] - from[d]);
    while (hi[d] > lo[d] && knots[hi[d]] >= to[d] - eps)
    {
      --hi[d];
    }
    while (lo[d] < hi[d] && knots[lo[d] + 1] <= from[d] + eps)
    {
      ++lo[d];
    }
  }
  // Derivatives of order (ou, ov) have coefficients span - p .. span - o in the indexing above.
  const auto collect = [&](const Net& net, int ou, int ov, auto&& use) {
    for (int j = lo[1] - p[1]; j <= hi[1] - ov; ++j)
    {
      for (int i = lo[0] - p[0]; i <= hi[0] - ou; ++i)
      {
        use(net.At(i, j));
      }
    }
  };
  const int orders[3][2] = { { 2, 0 }, { 1, 1 }, { 0, 2 } };
  for (int k = 0; k < 3; ++k)
  {
    out.Second[k].clear();
    if (!this->Second[k].Points.empty())
    {
      collect(this->Second[k], orders[k][0], orders[k][1],
        [&](const Vec4& h) { out.Second[k].push_back(h); });
    }
  }
  out.MinWeight = 1.0;
  out.Separable = false;
  out.WeightU = out.WeightV = out.FirstU = out.FirstV = out.Radius = 0.0;
  if (!this->IsRational)
  {
    return;
  }
  double wmin = 1e300;
  double radius = 0.0;
  collect(this->Control, 0, 0, [&](const Vec4& h) {
    wmin = std::min(wmin, h[3]);
    radius = std::max(radius, (h.head<3>() / h[3] - origin).squaredNorm());
  });
  double f[2] = { 0.0, 0.0 };
  double w[2] = { 0.0, 0.0 };
  for (int d = 0; d < 2; ++d)
  {
    collect(this->First[d], d == 0, d == 1, [&](const Vec4& h) {
      const Vec4 x = Shift(h, origin);
      f[d] = std::max(f[d], x.head<3>().squaredNorm());
      w[d] = std::max(w[d], std::abs(x[3]));
    });
  }
  out.FirstU = std::sqrt(f[0]);
  out.FirstV = std::sqrt(f[1]);
  out.WeightU = w[0];
  out.WeightV = w[1];
  out.MinWeight = wmin;
  out.Radius = std::sqrt(radius);
  for (auto& second : out.Second)
  {
    for (Vec4& h : second)
    {
      h = Shift(h, origin);
    }
  }
}

CurvatureRange SurfaceBound::Range(const Coefficients& c, const Vec3& normal, const Vec3& along)
{
  CurvatureRange range;
  range.Origin = c.Origin;
  range.MinWeight = c.MinWeight;
  const Vec3 tangent = along - normal * normal.dot(along);
  const double size = tangent.norm();
  const Vec3 t =
    size > 0.0 && normal.squaredNorm() > 0.0 ? Vec3(tangent / size) : Vec3(Vec3::UnitX());
  if (normal.squaredNorm() > 0.0 && size > 0.0)
  {
    range.Frame << normal, t, normal.cross(t);
  }
  else
  {
    range.Frame.setIdentity();
  }
  double length[3] = { 0, 0, 0 };
  for (int k = 0; k < 3; ++k)
  {
    bool first = true;
    for (const Vec4& h : c.Second[k])
    {
      const Vec3 local = range.Frame.transpose() * h.head<3>();
      for (int d = 0; d < 3; ++d)
      {
        range.Low[k][d] = first ? local[d] : std::min(range.Low[k][d], local[d]);
        range.High[k][d] = first ? local[d] : std::max(range.High[k][d], local[d]);
      }
      length[k] = std::max(length[k], local.squaredNorm());
      range.Weight[k] = std::max(range.Weight[k], std::abs(h[3]));
      first = false;
    }
    length[k] = std::sqrt(length[k]);
  }
  // S_xy = (H_xy - w_xy S - w_x S_y - w_y S_x) / w, |S| <= Radius, |S_x| <= (|H_x| + |w_x| R) / w.
  const double su = (c.FirstU + c.WeightU * c.Radius) / c.MinWeight;
  const double sv = (c.FirstV + c.WeightV * c.Radius) / c.MinWeight;
  const double cross[3] = { 2.0 * c.WeightU * su, c.WeightU * sv + c.WeightV * su,
    2.0 * c.WeightV * sv };
  for (int k = 0; k < 3; ++k)
  {
    range.Sliding[k] = (length[k] + range.Weight[k] * c.Radius + cross[k]) / c.MinWeight;
    if (c.Separable)
    {
      range.Sliding[k] = std::min(range.Sliding[k], c.Sliding[k]);
    }
  }
  return range;
}

namespace
{
// Greatest |C''| of a rational Bezier curve over a parameter interval of length `step`, by its
// homogeneous form around its own middle; `ratio` receives greatest weight / least weight.
double CurveSecond(const Vec4* points, int degree, int stride, double step, double& ratio)
{
  const Vec4& first = points[0];
  const Vec4& last = points[degree * stride];
  const Vec3 origin = 0.5 * (first.head<3>() / first[3] + last.head<3>() / last[3]);
  double wmin = first[3];
  double wmax = first[3];
  double radius = 0.0;
  double d1 = 0.0;
  double w1 = 0.0;
  double d2 = 0.0;
  double w2 = 0.0;
  for (int i = 0; i <= degree; ++i)
  {
    const Vec4& h = points[i * stride];
    wmin = std::min(wmin, h[3]);
    wmax = std::max(wmax, h[3]);
    radius = std::max(radius, (h.head<3>() / h[3] - origin).norm());
    if (i < degree)
    {
      const Vec4 d = Shift(points[(i + 1) * stride] - h, origin);
      d1 = std::max(d1, d.head<3>().norm());
      w1 = std::max(w1, std::abs(d[3]));
    }
    if (i + 1 < degree)
    {
      const Vec4 d = Shift(points[(i + 2) * stride] - 2.0 * points[(i + 1) * stride] + h, origin);
      d2 = std::max(d2, d.head<3>().norm());
      w2 = std::max(w2, std::abs(d[3]));
    }
  }
  ratio = wmax / wmin;
  const double p = degree / step;
  const double q = p * (degree - 1) / step;
  const double speed = p * (d1 + w1 * radius) / wmin;
  return (q * (d2 + w2 * radius) + 2.0 * p * w1 * speed) / wmin;
}
} // namespace

// If w(u, v) = a(u) b(v), as on every surface of revolution or extrusion, then S is a convex
// combination of its rows' curves with factors that depend on v alone, so |S_uu| is at most that of
// a row; each row is bounded around its own middle. The mixed derivative: |S_uv| <= p q r_u^2 r_v^2
// max |P_i+1,j+1 - P_i+1,j - P_i,j+1 + P_ij|, r the ratio of weights (Floater's bound, twice).
void SurfaceBound::SeparableSliding(
  const ParameterBox& box, const BezierPatch& patch, Coefficients& out)
{
  const int p = patch.Degree[0];
  const int q = patch.Degree[1];
  const int s = p + 1;
  const std::vector<Vec4>& P = patch.Points;
  out.Separable = true;
  for (int j = 0; j <= q; ++j)
  {
    for (int i = 0; i <= p; ++i)
    {
      const double product = P[i][3] * P[std::size_t(j) * s][3];
      if (std::abs(P[i + std::size_t(j) * s][3] * P[0][3] - product) > 1e-11 * product)
      {
        out.Separable = false;
        return;
      }
    }
  }
  double ru = 1.0;
  double rv = 1.0;
  out.Sliding[0] = out.Sliding[1] = out.Sliding[2] = 0.0;
  for (int j = 0; j <= q; ++j)
  {
    out.Sliding[0] =
      std::max(out.Sliding[0], CurveSecond(&P[std::size_t(j) * s], p, 1, box.A(), ru));
  }
  for (int i = 0; i <= p; ++i)
  {
    out.Sliding[2] = std::max(out.Sliding[2], CurveSecond(&P[i], q, s, box.B(), rv));
  }
  const auto at = [&](int i, int j) -> Vec3 {
    const Vec4& h = P[i + std::size_t(j) * s];
    return h.head<3>() / h[3];
  };
  for (int j = 0; j < q; ++j)
  {
    for (int i = 0; i < p; ++i)
    {
      const Vec3 d = at(i + 1, j + 1) - at(i + 1, j) - at(i, j + 1) + at(i, j);
      out.Sliding[1] = std::max(out.Sliding[1], d.norm());
    }
  }
  out.Sliding[1] *= p * q * ru * ru * rv * rv / (box.A() * box.B());
}

} // namespace nurbs
