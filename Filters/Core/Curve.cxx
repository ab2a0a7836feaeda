// SPDX-License-Identifier: BSD-3-Clause
#include "Curve.h"

#include "Basis.h"
#include "RowSpline.h"

namespace nurbs
{

namespace
{

template <int D>
RowSpline ToRows(const CurveView<D>& curve)
{
  RowSpline spline;
  spline.Degree = curve.Degree;
  spline.Width = D + 1;
  spline.Knots.assign(curve.Knots.begin(), curve.Knots.end());
  spline.Rows.resize(curve.Count * (D + 1));
  for (int i = 0; i < curve.Count; ++i)
  {
    Eigen::Map<Vec<D + 1>>(spline.Row(i)) = curve.Homogeneous(i);
  }
  return spline;
}

template <int D>
Curve<D> FromRows(RowSpline spline)
{
  Curve<D> curve;
  curve.Degree = spline.Degree;
  const std::int64_t count = spline.Count();
  curve.Points.resize(count);
  curve.Weights.resize(count);
  for (std::int64_t i = 0; i < count; ++i)
  {
    const double* row = spline.Row(i);
    curve.Weights[i] = row[D];
    curve.Points[i] = Eigen::Map<const Vec<D>>(row) / row[D];
  }
  curve.Knots = std::move(spline.Knots);
  curve.Pack();
  return curve;
}

/// Homogeneous derivatives h[0..order] at t.
template <int D>
void HomogeneousDerivatives(const CurveView<D>& curve, double t, int order, Vec<D + 1>* h)
{
  const int p = curve.Degree;
  double basis[3 * (MaxDegree + 1)];
  const int span = FindSpan(curve.Knots, p, t);
  EvaluateBasisDerivatives(curve.Knots, p, span, t, order, basis);
  for (int k = 0; k <= order; ++k)
  {
    h[k].setZero();
  }
  for (int i = 0; i <= p; ++i)
  {
    const Vec<D + 1> point = curve.Homogeneous(span - p + i);
    for (int k = 0; k <= order; ++k)
    {
      h[k] += basis[k * (p + 1) + i] * point;
    }
  }
}

} // namespace

template <int D>
void Curve<D>::Pack()
{
  if (this->Weights.size() != this->Points.size())
  {
    throw Error("curve with " + std::to_string(this->Points.size()) + " points and " +
      std::to_string(this->Weights.size()) + " weights");
  }
  this->Packed.resize(this->Points.size() * (D + 1));
  for (std::size_t i = 0; i < this->Points.size(); ++i)
  {
    Eigen::Map<Vec<D>>(this->Packed.data() + i * (D + 1)) = this->Points[i];
    this->Packed[i * (D + 1) + D] = this->Weights[i];
  }
}

template <int D>
CurveView<D> Curve<D>::View() const
{
  if (this->Packed.size() != this->Points.size() * (D + 1))
  {
    throw Error("curve viewed before Pack");
  }
  CurveView<D> view;
  view.Degree = this->Degree;
  view.Knots = this->Knots;
  view.Points = this->Packed.data();
  view.Count = static_cast<int>(this->Points.size());
  return view;
}

template <int D>
Vec<D> Evaluate(const CurveView<D>& curve, double t)
{
  const int p = curve.Degree;
  double basis[MaxDegree + 1];
  const int span = FindSpan(curve.Knots, p, t);
  EvaluateBasis(curve.Knots, p, span, t, basis);
  Vec<D + 1> h = Vec<D + 1>::Zero();
  for (int i = 0; i <= p; ++i)
  {
    h += basis[i] * curve.Homogeneous(span - p + i);
  }
  return h.template head<D>() / h[D];
}

template <int D>
void EvaluateDerivatives(const CurveView<D>& curve, double t, int order, Vec<D>* out)
{
  if (order < 0 || order > 2)
  {
    throw Error("derivatives of order " + std::to_string(order) + " are not available");
  }
  Vec<D + 1> h[3];
  HomogeneousDerivatives<D>(curve, t, order, h);
  // The quotient rule: with A the numerator, A^(k) = sum over i of binomial(k, i) w^(i) C^(k-i).
  const double w = h[0][D];
  out[0] = h[0].template head<D>() / w;
  if (order >= 1)
  {
    out[1] = (h[1].template head<D>() - h[1][D] * out[0]) / w;
  }
  if (order >= 2)
  {
    out[2] = (h[2].template head<D>() - 2.0 * h[1][D] * out[1] - h[2][D] * out[0]) / w;
  }
}

template <int D>
std::vector<BezierCurve<D>> ToBezier(const CurveView<D>& curve)
{
  const BezierForm form = ToBezierForm(ToRows<D>(curve));
  std::vector<BezierCurve<D>> pieces(form.First.size());
  for (std::size_t k = 0; k < pieces.size(); ++k)
  {
    pieces[k].T0 = form.Breaks[k];
    pieces[k].T1 = form.Breaks[k + 1];
    pieces[k].Points.resize(curve.Degree + 1);
    for (int i = 0; i <= curve.Degree; ++i)
    {
      pieces[k].Points[i] = Eigen::Map<const Vec<D + 1>>(form.Refined.Row(form.First[k] + i));
    }
  }
  return pieces;
}

template <int D>
Curve<D> RefineKnots(const CurveView<D>& curve, const std::vector<double>& add)
{
  RowSpline spline = ToRows<D>(curve);
  InsertKnots(spline, add);
  return FromRows<D>(std::move(spline));
}

template <int D>
Curve<D> ElevateDegree(const CurveView<D>& curve, int times)
{
  RowSpline spline = ToRows<D>(curve);
  for (int i = 0; i < times; ++i)
  {
    ElevateRows(spline);
  }
  return FromRows<D>(std::move(spline));
}

template <int D>
std::pair<Curve<D>, Curve<D>> Split(const CurveView<D>& curve, double t)
{
  const Interval domain = curve.Domain();
  return { Restrict<D>(curve, domain.Min, t), Restrict<D>(curve, t, domain.Max) };
}

template <int D>
Curve<D> Restrict(const CurveView<D>& curve, double t0, double t1)
{
  return FromRows<D>(ClampRows(ToRows<D>(curve), t0, t1));
}

#define NURBS_INSTANTIATE_CURVE(D)                                                   \
  template struct Curve<D>;                                                          \
  template Vec<D> Evaluate<D>(const CurveView<D>&, double);                          \
  template void EvaluateDerivatives<D>(const CurveView<D>&, double, int, Vec<D>*);   \
  template std::vector<BezierCurve<D>> ToBezier<D>(const CurveView<D>&);             \
  template Curve<D> RefineKnots<D>(const CurveView<D>&, const std::vector<double>&); \
  template Curve<D> ElevateDegree<D>(const CurveView<D>&, int);                      \
  template std::pair<Curve<D>, Curve<D>> Split<D>(const CurveView<D>&, double);      \
  template Curve<D> Restrict<D>(const CurveView<D>&, double, double);

NURBS_INSTANTIATE_CURVE(2)
NURBS_INSTANTIATE_CURVE(3)

} // namespace nurbs
