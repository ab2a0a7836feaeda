// SPDX-License-Identifier: BSD-3-Clause
#include "PatchBound.h"

#include "Lanes.h"
#include "Multiversion.h"

#include <algorithm>

namespace nurbs
{

namespace
{
struct Interval3
{
  Vec3 Low = Vec3::Constant(1e300);
  Vec3 High = Vec3::Constant(-1e300);
  void Extend(const Vec3& x)
  {
    this->Low = this->Low.cwiseMin(x);
    this->High = this->High.cwiseMax(x);
  }
};

struct Interval1
{
  double Low = 1e300;
  double High = -1e300;
  void Extend(double x)
  {
    this->Low = std::min(this->Low, x);
    this->High = std::max(this->High, x);
  }
};

Interval3 operator*(const Interval1& s, const Interval3& x)
{
  Interval3 out;
  out.Extend(s.Low * x.Low);
  out.Extend(s.Low * x.High);
  out.Extend(s.High * x.Low);
  out.Extend(s.High * x.High);
  return out;
}

Interval3 operator-(const Interval3& x, const Interval3& y)
{
  Interval3 out;
  out.Low = x.Low - y.High;
  out.High = x.High - y.Low;
  return out;
}

// A derivative of the homogeneous Bezier form as intervals of its coefficients, up to a factor.
template <typename Quad>
struct Derivative
{
  Quad Low = Quad::All(1e300);
  Quad High = Quad::All(-1e300);

  NURBS_INLINE void Extend(Quad h)
  {
    this->Low = Quad::Min(this->Low, h);
    this->High = Quad::Max(this->High, h);
  }
  NURBS_INLINE void Get(double factor, Interval3& x, Interval1& w) const
  {
    double low[4];
    double high[4];
    (factor * this->Low).Store(low);
    (factor * this->High).Store(high);
    x = { Vec3(low[0], low[1], low[2]), Vec3(high[0], high[1], high[2]) };
    w = { low[3], high[3] };
  }
};

// The patch less the bilinear surface L through its corners: H - w L and w in Bezier form, one
// degree higher in both directions. S - L = (H - w L) / w has the second derivatives of S but for
// L_uv, and is so small that the quotient rule's intervals are narrow. Coefficient (i, j) takes the
// same shares of its neighbours for the elevated w and for the product.
void SubtractBilinear(
  const std::vector<Vec4>& c, int p, int q, const Vec3 (&corner)[4], std::vector<Vec4>& out)
{
  out.assign(std::size_t(p + 2) * (q + 2), Vec4::Zero());
  for (int j = 0; j <= q; ++j)
  {
    for (int i = 0; i <= p; ++i)
    {
      const Vec4& h = c[i + std::size_t(j) * (p + 1)];
      for (int k = 0; k < 4; ++k)
      {
        const int a = k & 1;
        const int b = k >> 1;
        const double share =
          (a ? i + 1.0 : p + 1.0 - i) / (p + 1) * ((b ? j + 1.0 : q + 1.0 - j) / (q + 1));
        Vec4& target = out[i + a + std::size_t(j + b) * (p + 2)];
        target.head<3>() += share * (h.head<3>() - h[3] * corner[k]);
        target[3] += share * h[3];
      }
    }
  }
}

// Of a patch in Bezier form: u, v, uu, uv, vv over an a x b box.
struct Derivatives
{
  Interval3 X[5];
  Interval1 W[5];
};

// First derivatives with `first` only.
template <typename Quad>
NURBS_INLINE void BoundDerivatives(
  const Vec4* c, int p, int q, double a, double b, bool first, Derivatives& out)
{
  Derivative<Quad> u, v, uu, uv, vv;
  const int s = p + 1;
  for (int j = 0; j <= q; ++j)
  {
    const Vec4* row = c + j * s;
    const auto at = [row](int k) { return Quad::Load(row[k].data()); };
    for (int i = 0; i <= p; ++i)
    {
      const Quad h = at(i);
      if (i < p && first)
      {
        u.Extend(at(i + 1) - h);
      }
      if (j < q && first)
      {
        v.Extend(at(i + s) - h);
      }
      if (i + 2 <= p)
      {
        uu.Extend(at(i + 2) - 2.0 * at(i + 1) + h);
      }
      if (i < p && j < q)
      {
        uv.Extend(at(i + s + 1) - at(i + s) - at(i + 1) + h);
      }
      if (j + 2 <= q)
      {
        vv.Extend(at(i + 2 * s) - 2.0 * at(i + s) + h);
      }
    }
  }
  if (p < 2)
  {
    uu.Extend(Quad::All(0.0));
  }
  if (q < 2)
  {
    vv.Extend(Quad::All(0.0));
  }
  u.Get(p / a, out.X[0], out.W[0]);
  v.Get(q / b, out.X[1], out.W[1]);
  uu.Get(p * (p - 1) / (a * a), out.X[2], out.W[2]);
  uv.Get(p * q / (a * b), out.X[3], out.W[3]);
  vv.Get(q * (q - 1) / (b * b), out.X[4], out.W[4]);
}

// Second derivatives from those of H - w L and w.
void DivideByWeights(const std::vector<Vec4>& points, const Vec3 (&corner)[4], const Derivatives& d,
  double a, double b, DerivativeIntervals& out)
{
  Interval3 x;
  Interval1 reciprocal; // Of the weight.
  for (const Vec4& h : points)
  {
    x.Extend(h.head<3>() / h[3]);
    reciprocal.Extend(1.0 / h[3]);
  }
  // S_u = (H_u - w_u S) / w, S_uv = (H_uv - w_u S_v - w_v S_u - w_uv S) / w.
  const Interval3 su = reciprocal * (d.X[0] - d.W[0] * x);
  const Interval3 sv = reciprocal * (d.X[1] - d.W[1] * x);
  const auto twice = [](Interval1 w) { return Interval1{ 2.0 * w.Low, 2.0 * w.High }; };
  const Interval3 second[3] = { reciprocal * (d.X[2] - twice(d.W[0]) * su - d.W[2] * x),
    reciprocal * (d.X[3] - d.W[0] * sv - d.W[1] * su - d.W[3] * x),
    reciprocal * (d.X[4] - twice(d.W[1]) * sv - d.W[4] * x) };
  const Vec3 twist = (corner[3] - corner[2] - corner[1] + corner[0]) / (a * b);
  for (int k = 0; k < 3; ++k)
  {
    out.Low[k] = k == 1 ? Vec3(second[k].Low + twist) : second[k].Low;
    out.High[k] = k == 1 ? Vec3(second[k].High + twist) : second[k].High;
  }
}

// The Bezier points of patch i.
template <typename Quad>
NURBS_INLINE void MakePatch(const PatchRow& row, int i, std::vector<Vec4>& patch)
{
  const int p = row.P;
  const double* matrix = row.Blossoms + std::int64_t(i) * (p + 1) * (p + 1);
  for (int r = 0; r <= row.Q; ++r)
  {
    const Vec4* from = row.Rows + std::int64_t(r) * row.Columns + row.First[i];
    for (int c = 0; c <= p; ++c)
    {
      const double* m = matrix + c * (p + 1);
      Quad sum = m[0] * Quad::Load(from[0].data());
      for (int x = 1; x <= p; ++x)
      {
        sum = sum + m[x] * Quad::Load(from[x].data());
      }
      sum.Store(patch[r * (p + 1) + c].data());
    }
  }
}

template <typename Quad>
NURBS_INLINE void BoundRow(const PatchRow& row, DerivativeIntervals* bounds)
{
  const int p = row.P;
  const int q = row.Q;
  std::vector<Vec4> patch(std::size_t(p + 1) * (q + 1));
  std::vector<Vec4> less;
  Derivatives d;
  for (int i = 0; i < row.Count; ++i)
  {
    const double a = row.Breaks[i + 1] - row.Breaks[i];
    const double b = row.Height;
    MakePatch<Quad>(row, i, patch);
    if (row.Rational)
    {
      Vec3 corner[4];
      for (int k = 0; k < 4; ++k)
      {
        const Vec4& h = patch[(k & 1 ? p : 0) + (k >> 1 ? q : 0) * (p + 1)];
        corner[k] = h.head<3>() / h[3];
      }
      SubtractBilinear(patch, p, q, corner, less);
      BoundDerivatives<Quad>(less.data(), p + 1, q + 1, a, b, true, d);
      DivideByWeights(less, corner, d, a, b, bounds[i]);
      continue;
    }
    BoundDerivatives<Quad>(patch.data(), p, q, a, b, false, d);
    for (int k = 0; k < 3; ++k)
    {
      bounds[i].Low[k] = d.X[2 + k].Low;
      bounds[i].High[k] = d.X[2 + k].High;
    }
  }
}

NURBS_MULTIVERSION
void WideRow(const PatchRow& row, DerivativeIntervals* bounds)
{
  BoundRow<WideLanes>(row, bounds);
}
} // namespace

void BoundPatches(const PatchRow& row, DerivativeIntervals* bounds)
{
  HasWideClones() ? WideRow(row, bounds) : BoundRow<NarrowLanes>(row, bounds);
}

} // namespace nurbs
