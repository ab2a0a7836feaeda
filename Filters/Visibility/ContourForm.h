// SPDX-License-Identifier: BSD-3-Clause
/// @file ContourForm.h
/// @brief The contour function normal . view of a Bezier patch as a polynomial in Bernstein form.
///
/// Source: X. Ruan, H. Zhang, J. Yong, "Visible region extraction from a sequence of rational Bezier
/// surfaces", Journal of Zhejiang University SCIENCE A 7 (2006), equations (2) to (4). With the
/// homogeneous patch H = (w S, w) and the homogeneous viewer E = (direction, 0) or (eye, 1),
///
///     g = det[H, H_u, H_v, E] = +- w^3 (S_u x S_v) . V,
///
/// V = direction or eye - S: one polynomial of degree (3p - 2, 3q - 2) for rational patches and
/// perspective, with the sign of normal . V; for polynomial patches in parallel light of degree
/// (2p - 1, 2q - 1).
#pragma once

#include "BernsteinForm.h"
#include "Surface.h"

namespace nurbs
{

/// Where a model is seen from.
struct Viewer
{
  bool Perspective = false;
  /// The eye, or (parallel) the direction from the model to the viewer, of unit length.
  Vec3 Place = Vec3::UnitZ();

  /// From a point to the viewer; of unit length in parallel light only.
  Vec3 Toward(const Vec3& point) const
  {
    return this->Perspective ? Vec3(this->Place - point) : this->Place;
  }
};

/// Point, normal and contour function of a patch at one parameter.
struct ContourValue
{
  Vec3 Point = Vec3::Zero();
  /// Unit normal (S_u x S_v, by the patch's own parameters) times the unit vector to the viewer; 0
  /// where there is no normal.
  double Cosine = 0.0;
  /// Its derivatives where it vanishes, by the patch's own parameters.
  Vec2 Gradient = Vec2::Zero();
};

/// Evaluates at (s, t) in [0, 1] x [0, 1], the patch's own parameters.
ContourValue EvaluateContour(const BezierPatch& patch, const Viewer& viewer, double s, double t);
/// Unit normal S_u x S_v at (s, t), 0 where there is none.
Vec3 PatchNormal(const BezierPatch& patch, double s, double t);
/// The point alone.
Vec3 EvaluatePatch(const BezierPatch& patch, double s, double t);

/// g of a patch, and what it can be at most.
struct ContourForm
{
  BernsteinForm G;
  /// Product of the largest factors of |w^3 S_u x S_v . V|: what g is small or large against.
  double Scale = 0.0;
  /// What rounding of the control points and of g's own computation can amount to.
  double Rounding = 0.0;
};

/// The polynomial g, positive where S_u x S_v faces the viewer.
ContourForm MakeContourForm(const BezierPatch& patch, const Viewer& viewer);

} // namespace nurbs
