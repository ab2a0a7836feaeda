// SPDX-License-Identifier: BSD-3-Clause
/// @file SurfaceBound.h
/// @brief Sound bounds of second derivatives over parameter boxes, and of a triangle's deviation.
///
/// For a triangle with corners p_i in a parameter box a x b, corners on the surface, and a point
/// p = sum b_i p_i of it, the remainder of linear interpolation of any C1 function f is
///   f(p) - sum b_i f(p_i) = -1/2 sum b_i (p_i - p)^T H_i (p_i - p),
/// H_i a mean of f's Hessian along a segment. Since sum b_i du_i^2 <= a^2/4 and, by Cauchy-Schwarz,
/// sum b_i |du_i dv_i| <= a b / 4,
///   |f - L| <= 1/8 (a^2 max|f_uu| + 2 a b max|f_uv| + b^2 max|f_vv|)
/// for *every* triangle in the box, not only for the two halves of the cell (Balazs section 5.2
/// bounds the two halves; a trimmed cell has others). With f = n . (H - w p_0) for a rational surface
/// H / w and the triangle's plane (n, p_0), f vanishes at the corners and |n . (S - p_0)| <= |f| / w.
/// Derivation: Documentation/Papers/balazs-2004-bound.md.
#pragma once

#include "SurfaceEvaluator.h"

namespace nurbs
{

/// Share of a box's extent up to which a knot span that it touches does not count.
inline constexpr double NegligibleSpan = 1e-6;

/// A rectangle of the parameter domain.
struct ParameterBox
{
  double U0 = 0.0, U1 = 0.0, V0 = 0.0, V1 = 0.0;
  double A() const { return this->U1 - this->U0; }
  double B() const { return this->V1 - this->V0; }
};

/// What is known of the second derivatives over a box: everything a triangle's bound needs.
/// Index 0: uu, 1: uv, 2: vv. Units: model units per parameter unit squared (times weight for the
/// homogeneous ones); homogeneous coordinates are taken relative to Origin.
struct CurvatureRange
{
  Vec3 Origin = Vec3::Zero(); ///< A point near the surface over the box.
  /// Orthonormal: the cell's normal and two tangents; columns zero if the box collapses.
  Eigen::Matrix3d Frame = Eigen::Matrix3d::Zero();
  double Low[3][3] = {};           ///< [k][c]: least Frame.col(c) . H''.
  double High[3][3] = {};          ///< Greatest.
  double Weight[3] = { 0, 0, 0 };  ///< Greatest |w''|.
  double Sliding[3] = { 0, 0, 0 }; ///< Greatest |S''| (the Cartesian surface).
  double MinWeight = 1.0;          ///< Least weight.
};

/// How far f = n . (H - w p0), which vanishes at a triangle's corners, gets above and below zero over
/// a triangle with a parameter box a x b; divided by the least weight: n . (S - p0).
struct Deviation
{
  double Above = 0.0;
  double Below = 0.0;
  double Largest() const { return this->Above > this->Below ? this->Above : this->Below; }
};

/// Bounds f over a triangle. Without `mixed` the term of f_uv is left out: right for segments along
/// an iso-line, and for the deviation from the bilinear interpolant of a box.
Deviation BoundDeviation(const CurvatureRange& range, double a, double b, const Vec3& n,
  const Vec3& p0, bool mixed = true);

/// Bounds |S - L| (height and sliding together) over a triangle with a parameter box a x b.
double DeviationBound(const CurvatureRange& range, double a, double b);

/// Second-derivative coefficients of one surface, for boxes of any size.
///
/// Boxes of several knot spans are bounded by the control nets of the surface's own second
/// derivatives (B-splines of lower degree), boxes inside one span by their Bezier form.
class SurfaceBound
{
public:
  explicit SurfaceBound(const SurfaceView& surface);

  const SurfaceView& View() const { return this->Surface; }
  bool Rational() const { return this->IsRational; }
  /// An evaluator to copy: copies share the control net.
  const SurfaceEvaluator& Evaluator() const { return this->Prototype; }
  /// Greatest weight (1 if all are equal).
  double MaximumWeight() const { return this->IsRational ? this->GreatestWeight : 1.0; }
  /// Length of the control net's bounding-box diagonal.
  double Size() const { return this->Diagonal; }
  /// The centre of the control net's bounding box; nets below are relative to it.
  const Vec3& Origin() const { return this->Center; }
  /// True if every control point is within `tolerance` of one plane; `normal` receives it.
  bool IsPlanar(double tolerance, Vec3& normal, double& distance) const;

  /// The Bezier form over a box inside one knot span, relative to Origin().
  void Extract(const ParameterBox& box, BezierPatch& patch) const;
  /// True if the box lies in one span of both knot vectors.
  bool InOneSpan(const ParameterBox& box) const;

  /// Second-derivative coefficients over a box; Bezier form if `patch` is given.
  struct Coefficients
  {
    std::vector<Vec4> Second[3]; ///< H'' coefficients: uu, uv, vv, per parameter unit squared.
    double FirstU = 0.0, FirstV = 0.0;   ///< Greatest |H'| (relative to `Origin`).
    double WeightU = 0.0, WeightV = 0.0; ///< Greatest |w'|.
    double MinWeight = 1.0;
    double Radius = 0.0; ///< Greatest distance of the surface from Origin.
    Vec3 Origin = Vec3::Zero();
    bool Separable = false;          ///< Weights are a product of a function of u and one of v.
    double Sliding[3] = { 0, 0, 0 }; ///< If Separable: greatest |S''|.
  };
  void Evaluate(
    const ParameterBox& box, const BezierPatch* patch, const Vec3& origin, Coefficients& out) const;

  /// Turns coefficients into ranges in a frame of `normal` and the direction `along`.
  static CurvatureRange Range(
    const Coefficients& coefficients, const Vec3& normal, const Vec3& along);

  /// Bounds by the Bezier coefficients themselves, for boxes of several spans (of knots that suit
  /// the box or lie around it): better than derivatives where the surface is rough, as a terrain.
  /// Linear and bilinear functions have exactly the coefficients of their values at Greville
  /// abscissae, so |f - B| is at most the largest difference of coefficients.
  struct Roughness
  {
    double Height = 0.0;    ///< |n . (H - w p0) - its bilinear interpolant of the box's corners|.
    double Deviation = 0.0; ///< |H - w x bilinear interpolant of the corners| / least weight.
  };
  /// @param corners S at (U0, V0), (U1, V0), (U0, V1), (U1, V1); @param values of n . (H - w p0) there.
  /// @param limit stop as soon as Height is over it.
  Roughness BoundRoughness(const ParameterBox& box, const Vec3& n, const Vec3& p0,
    const Vec3 (&corners)[4], const double (&values)[4], double limit) const;
  bool HasManySpans() const { return this->HaveNets; }

private:
  struct Net
  {
    int Count[2] = { 0, 0 };
    std::vector<Vec4> Points;
    const Vec4& At(int i, int j) const { return this->Points[i + std::size_t(j) * this->Count[0]]; }
  };
  Net Derivative(const Net& net, int dir, KnotView knots, int degree, int order) const;
  void MakeBezierNet();
  void FromNets(const ParameterBox& box, const Vec3& origin, Coefficients& out) const;
  static void FromBezier(const ParameterBox& box, const BezierPatch& patch, const Vec3& origin,
    Coefficients& out, bool rational);
  static void SeparableSliding(
    const ParameterBox& box, const BezierPatch& patch, Coefficients& out);

  SurfaceView Surface;
  SurfaceEvaluator Prototype;
  bool IsRational = false;
  double GreatestWeight = 1.0;
  Vec3 Center = Vec3::Zero();
  double Diagonal = 0.0;
  Net Control;
  Net First[2];
  Net Second[3];
  bool HaveNets = false;
  Net BezierNet;                 ///< All Bezier patches; neighbours share their boundary.
  std::vector<double> Breaks[2]; ///< Distinct knots.
};

} // namespace nurbs
