// SPDX-License-Identifier: BSD-3-Clause
/// @file PatchStitcher.h
/// @brief Adds surfaces to a model and recognises the edges that they share.
///
/// Two sides of surfaces are one edge if their control points, weights and knots are the same, bit
/// for bit, forwards or backwards: shapes compute a shared side the same way twice. A side whose
/// control points are one point is a pole. Time is linear in the number of surfaces.
#pragma once

#include "ModelBuilder.h"

#include <unordered_map>

namespace nurbs
{

/// Places surfaces into a builder, which must outlive it.
class PatchStitcher
{
public:
  /// `tolerance` becomes EdgeTolerance of the exact edges (rounding only; a length).
  PatchStitcher(ModelBuilder& builder, double tolerance)
    : Builder(builder)
    , Tolerance(tolerance)
  {}

  /// The vertex at exactly this position, made on first use.
  std::int64_t Vertex(const Vec3& position);

  /// An edge and how its curve runs relative to the curve asked for.
  struct EdgeUse
  {
    std::int64_t Edge = -1;
    bool Flipped = false; ///< The edge runs from the asked curve's end to its start.
  };

  /// The edge with this 3D curve, made on first use with its end points as vertices. Call Pack on
  /// the curve first.
  EdgeUse Edge(const Curve<3>& curve);

  /// Adds a face bounded by the four sides of its domain: its loop is v = min, u = max, v = max,
  /// u = min. Further loops (holes) may follow. Returns the face's index.
  std::int64_t AddFace(const Surface& surface, const FaceAttributes& attributes);

  /// The builder given, for loops and trim curves beyond the sides.
  ModelBuilder& GetBuilder() { return this->Builder; }

  /// The tolerance given.
  double GetTolerance() const { return this->Tolerance; }

private:
  /// Adds the trim curve of side 0 to 3 (v = min, u = max, v = max, u = min) with its edge or pole.
  void AddSide(const Surface& surface, int side);

  ModelBuilder& Builder;
  double Tolerance;
  /// Indices by the bytes of a position, and of degree, knots, points and weights of a curve.
  std::unordered_map<std::string, std::int64_t> Vertices;
  std::unordered_map<std::string, std::int64_t> Edges;
};

/// The straight trim curve of degree 1 from a (at range.Min) to b (at range.Max); packed.
Curve<2> TrimLine(const Vec2& a, const Vec2& b, Interval range);

/// The full circle of `radius` around `center`, counter-clockwise from angle 0, as a rational
/// quadratic of nine points over [0, 4]; exact, C1 at its inner knots, packed.
Curve<2> TrimCircle(const Vec2& center, double radius);

/// A planar curve lifted into the plane origin + x * ex + y * ey: same parameter, degree, knots and
/// weights; packed. The edge of a trim curve on a plane that is parametrised so.
Curve<3> LiftCurve(const Curve<2>& curve, const Vec3& origin, const Vec3& ex, const Vec3& ey);

} // namespace nurbs
