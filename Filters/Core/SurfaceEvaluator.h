// SPDX-License-Identifier: BSD-3-Clause
/// @file SurfaceEvaluator.h
/// @brief Fast repeated evaluation of one surface: coherent (Balazs section 8) and in batches.
#pragma once

#include "Surface.h"

#include <memory>

namespace nurbs
{

/// Evaluates one surface many times. Keeps the homogeneous control net contiguous, remembers the
/// last knot span and the last u- or v-reduction: points along one iso-line cost one curve
/// evaluation each (coherence). One object per thread; copies are cheap and share the net.
class SurfaceEvaluator
{
public:
  explicit SurfaceEvaluator(const SurfaceView& surface);

  /// Cartesian point.
  Vec3 Point(double u, double v);

  /// Point and derivatives to `order` (1 or 2).
  SurfaceDerivatives Derivatives(double u, double v, int order);

  /// Point and unit normal, exact at poles (see nurbs::Normal).
  void PointAndNormal(double u, double v, Vec3& point, Vec3& normal);

  /// Points and, if `normals` is not null, unit normals of `count` parameters in any order;
  /// `points` and `normals` are xyz triples. Vectorised over the net, no allocation per point.
  void Batch(const Vec2* uv, std::int64_t count, double* points, double* normals);

  /// The grid of us.size() x vs.size() points, u fastest: one basis evaluation per row and column.
  void Grid(ArrayView<double> us, ArrayView<double> vs, double* points, double* normals);

  const SurfaceView& GetSurface() const { return this->View; }

private:
  SurfaceView View;
  std::shared_ptr<const std::vector<Vec4>> Net;
  bool Rational = false;
  int Span[2] = { -1, -1 };
  double LastV = 0.0;
  bool RowValid = false;
  std::vector<Vec4> Row;
};

} // namespace nurbs
