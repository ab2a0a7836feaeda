// SPDX-License-Identifier: BSD-3-Clause
/// @file ParameterMap.h
/// @brief How the parameter of a conic relates to that of its exact rational form.
///
/// A rational quadratic arc is not parametrised by its angle. Over one span [b, b + h] of the angle
/// with the middle m, the arc in standard form (equal end weights) has the parameter
///     x = m + (h / 2) tan((t - m) / 2) / tan(h / 4),
/// since the stereographic parameter tan((t - m) / 2) is linear in that of the Bezier form (Piegl and
/// Tiller, The NURBS Book, 7.3). A hyperbola has tanh in place of tan. Spans begin at fixed places
/// (offset + k h), so that the map does not depend on which part of the curve is used, is periodic
/// as the circle is, and curves with the same frame get the same map. It is C1 over the breaks.
#pragma once

#include "Types.h"

#include <vector>

namespace nurbs
{

/// A strictly increasing map from a curve's own parameter t to the parameter x of its NURBS form.
/// The breaks are fixed points.
class ParameterMap
{
public:
  enum class Kind
  {
    Identity,  ///< Lines, polynomials, B-splines.
    Circular,  ///< Circles and ellipses by angle; spans of a quarter turn.
    Hyperbolic ///< Hyperbolas by cosh, sinh; spans of length 1.
  };

  ParameterMap() = default;
  static ParameterMap Circular(double offset = 0.0);
  static ParameterMap Hyperbolic();

  /// x(t).
  double Forward(double t) const;
  /// t(x).
  double Inverse(double x) const;
  Kind GetKind() const { return this->Type; }
  bool IsIdentity() const { return this->Type == Kind::Identity; }
  /// Length of a span; 0 for the identity.
  double Span() const;
  /// Where the first span begins.
  double Offset() const { return this->Start; }
  /// Appends the breaks inside (a, b) that are not within rounding of its ends, in order. Throws
  /// Error if there are over 10,000.
  void AppendBreaks(double a, double b, std::vector<double>& breaks) const;
  /// The interval moved outwards so that no end is a sliver of a span: an end within 1e-10 spans of a
  /// break snaps to it, and one within 1e-3 spans beyond a break moves to 1e-3 spans.
  Interval Widen(Interval range) const;

private:
  double Middle(double t) const;

  Kind Type = Kind::Identity;
  double Start = 0.0;
};

/// A unit circle cos t, sin t (or hyperbola cosh t, sinh t) over [t0, t1] as one rational quadratic
/// B-spline in the parameter of a ParameterMap that is not the identity.
struct UnitArc
{
  std::vector<double> Knots; ///< Clamped; double at the breaks.
  std::vector<Vec3> Points;  ///< Homogeneous (w x, w y, w); the weight is 1 at the breaks.
};

/// See UnitArc; t0 < t1.
UnitArc MakeUnitArc(const ParameterMap& map, double t0, double t1);

} // namespace nurbs
