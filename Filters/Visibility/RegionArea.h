// SPDX-License-Identifier: BSD-3-Clause
/// @file RegionArea.h
/// @brief The area of a region of a surface, from its border.
#pragma once

#include "RegionLoops.h"

#include <memory>

namespace nurbs
{

/// Areas of regions of one face. Not for more than one thread.
class FaceArea
{
public:
  /// The model must outlive this.
  FaceArea(const Model& model, std::int64_t face);
  ~FaceArea();

  /// Area of what loops in (u, v) enclose (the ones on the left of which it lies count positive), by
  /// Green's theorem: the integral of P dv along them, P_u = |S_u x S_v|. P comes from Legendre series
  /// of |S_u x S_v| on every knot span, made at the first call that needs them, whose degree grows until
  /// the last coefficients are below 1e-11 of the largest (or 24 is reached).
  double Of(const std::vector<RegionLoop>& loops);

private:
  class SpeedIntegral;
  const Model& Source;
  std::int64_t Index;
  std::unique_ptr<SpeedIntegral> Speed;
  double Whole = 0.0; ///< About the area of the untrimmed surface.
};

/// The loops of a face as it is.
std::vector<RegionLoop> WholeRegion(const Model& model, std::int64_t face);

} // namespace nurbs
