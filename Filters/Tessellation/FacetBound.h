// SPDX-License-Identifier: BSD-3-Clause
/// @file FacetBound.h
/// @brief Bound of the distance between a piece of a surface and the facet that replaces it.
///
/// From the surface to the facet: a facet is convex, so the distance from it is a convex function.
/// Between samples S(p_i) at the corners of a small parameter triangle the surface is a mean of them
/// plus the remainder of SurfaceBound.h; so no point is farther from the facet than the farthest
/// sample plus the remainder, which falls with the square of the samples' spacing. Sliding of
/// parameters along the facet costs nothing. From the facet to the surface: feet of surface points
/// cover all of the facet but what lies between its edges and curves that bow inwards (SampleDistance).
/// Derivation: Documentation/Papers/balazs-2004-bound.md.
#pragma once

#include "SurfaceBound.h"
#include "Tessellator.h"

namespace nurbs
{

/// The normal of a triangle's side of a crease is taken this share of the triangle's size beside it.
inline constexpr double BesideCrease = 1e-6;

/// In tolerances: where the surface is this small it needs no small angles. Else there would be no end at
/// singular points, where the normal turns at once.
inline constexpr double SmallForAngles = 0.01;

/// Angle between two vectors, radians.
double Angle(const Vec3& a, const Vec3& b);

/// A triangle in space; it may be a line or a point.
class Facet
{
public:
  Facet(const Vec3& x0, const Vec3& x1, const Vec3& x2);
  /// False if it has no plane to speak of.
  bool HasPlane() const { return this->Plane; }
  const Vec3& Normal() const { return this->N; }
  const Vec3& Tangent(int k) const { return this->T[k]; }
  /// Height of p over the plane, and the distance of its foot from the triangle. Without a plane:
  /// 0 and the distance.
  void Measure(const Vec3& p, double& height, double& outside) const;
  /// Distance of p's foot from the line of edge i (from corner i to i + 1) if it is on the facet's
  /// side of that, else 0; 0 without a plane.
  double Inside(int i, const Vec3& p) const;

private:
  Vec3 X[3];
  Vec3 Edge[3];
  double Square[3]; ///< Squared length of Edge.
  Vec3 Outward[3];  ///< In the plane, of edge i; as long as the edge.
  Vec3 N = Vec3::Zero();
  Vec3 T[2] = { Vec3::Zero(), Vec3::Zero() };
  bool Plane = false;
};

/// Largest distances of samples from a facet.
///
/// A sample whose foot is beyond an edge has the neighbour's facet beneath it, which goes on with a
/// slope against this one; beyond the face's boundary, the boundary's own error covers it. What lies
/// between an edge and its curve that bows inwards has the surface beyond the curve above it.
struct SampleDistance
{
  double Height = 0.0;
  double Outside = 0.0;
  double Far = 0.0;  ///< Both together, of one sample.
  double Edge = 0.0; ///< Height and distance inside the edge together, of one sample on its curve.
  double Inside = 0.0; ///< That distance alone.
  double Slope = 0.0;  ///< Greatest slope of the surface against the facet at its corners.
  /// @param edge the edge whose curve the sample is on; -1: none, or one on the boundary.
  void Add(const Facet& facet, const Vec3& p, int edge = -1);
  void AddSlope(const Facet& facet, const Vec3& normal);
  /// Says that an edge lies on a crease: the surface may turn back there, so that distances along the
  /// facet count in full.
  void SetCrease();
  /// The error that the samples alone tell.
  double Largest() const;
};

/// Remainders of linear interpolation over a triangle in an a x b box: across a facet and along it.
/// With samples k times as dense they are k^2 times as small.
struct Remainder
{
  double Across = 0.0;
  double Along = 0.0;
  double Height = 1e300; ///< Bound of the height that needs no samples, as soon as it is known.
  /// @param twist bound of the bilinear part of the height if it is known (two halves of a cell);
  /// negative: S_uv bounds it.
  Remainder(
    const SecondDerivatives& second, double a, double b, const Facet& facet, double twist = -1.0);
};

/// The bound that samples and remainders give together.
double CombineError(const SampleDistance& samples, const Remainder& rest, int density);

/// Steps along a side of the densest grid of samples: more are dearer than smaller triangles.
inline constexpr int DensestSamples = 8;

/// The number of steps to try after `density` failed: the least that can make the bound meet `limit`;
/// 0: none can.
int NextDensity(const SampleDistance& samples, const Remainder& rest, int density, double limit);

/// Bounds the errors of any triangles of one surface. One object per thread.
class FacetBound
{
public:
  FacetBound(const SurfaceBound& bound, ErrorMode mode);

  /// A triangle of the mesh.
  struct Triangle
  {
    Vec3 X[3];
    Vec2 UV[3];
    Vec3 Normal[3];   ///< The surface's, of unit length.
    bool Boundary[3]; ///< Edge i (from corner i to i + 1) lies on the face's boundary.
    double Gap = 0.0; ///< Largest distance of a corner from the surface at its parameters.
    /// The corner that is a pole whose other parameters have no triangles of their own, so that this
    /// one stands for the whole region between its base and the pole's side; -1: none.
    int Pole = -1;
    int PoleDirection = 0; ///< In which (0: u, 1: v) that side runs.
  };

  /// Bound (or estimate, ErrorMode::Estimated) of the distance between a triangle and the surface over
  /// its parameters. The work ends as soon as the result is known to be at most `limit`, or over it.
  double Error(const Triangle& t, double limit);

private:
  double Piece(const Triangle& t, const Facet& facet, const Vec2 (&uv)[3], double limit);
  double Part(const Triangle& t, const Facet& facet, const Vec2 (&uv)[3], bool whole, double limit);
  double Cut(const Triangle& t, const Facet& facet, const Vec2 (&uv)[3], double limit, int dir,
    double crease);
  void Sample(const Triangle& t, const Facet& facet, const Vec2 (&uv)[3], int last, int k,
    bool whole, SampleDistance& samples);
  void AddCorners(const Triangle& t, const Facet& facet, SampleDistance& samples) const;
  double EdgeError(const Triangle& t, const Facet& facet, int edge, const Vec2& a, const Vec2& b);

  const SurfaceBound& Bound;
  SurfaceEvaluator Evaluator;
  bool Guaranteed;
};

} // namespace nurbs
