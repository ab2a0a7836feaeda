// SPDX-License-Identifier: BSD-3-Clause
/// @file FaceTrim.h
/// @brief The trimmed domain of an OpenCASCADE face and its boundary in space.
#pragma once

#include "FaceSurface.h"

#include <Geom2d_Curve.hxx>
#include <TopoDS_Edge.hxx>

#include <memory>

class BRepTopAdaptor_FClass2d;

namespace verify
{

/// A closely inscribed polygon of the face's wires; its chords stay within @a accuracy of the lifted
/// pcurves in space. Wires whose pcurves do not join in (u, v) are left to OpenCASCADE's classifier.
class FaceTrim
{
public:
  FaceTrim(const TopoDS_Face& face, const FaceSurface& surface, double accuracy);
  ~FaceTrim();

  const Vec2& Low() const { return this->BoxLow; }
  const Vec2& High() const { return this->BoxHigh; }
  bool Broken() const { return this->Classifier != nullptr; }

  /// Whether the material covers @a uv, moved by whole periods if need be; the move is applied.
  bool Covers(Vec2& uv) const;

  /// Distance to the lifted boundary; infinite if it is not below @a bound.
  double BoundaryDistance(const Vec3& p, double bound) const;
  /// The same, not misled by the polygon where two parts of the boundary are about as near.
  double BoundaryDistanceExactly(const Vec3& p) const;

  double Length() const { return this->TotalLength; }
  /// Points of the lifted boundary, at most @a step apart.
  std::vector<Vec3> BoundarySamples(double step) const;

private:
  struct Curve
  {
    Handle(Geom2d_Curve) PCurve;
    double First = 0.0, Last = 0.0;
    bool Reversed = false;
  };
  struct Sample
  {
    double T;
    Vec2 UV;
    Vec3 Point;
  };
  Sample At(const Curve& curve, double t) const;
  void Refine(const Curve& curve, const Sample& a, const Sample& b, int depth,
    std::vector<Sample>& out) const;
  void AddWire(const std::vector<Curve>& curves);
  void AddSegment(const Vec2& a, const Vec2& b);
  bool CoversExactly(const Vec2& uv) const;
  double RefineFrom(std::size_t line, double along, const Vec3& p) const;
  double RefineOnCurve(const Curve& curve, const Vec3& p, double t) const;

  const FaceSurface& Surface;
  double Accuracy;
  Vec2 BoxLow, BoxHigh;
  double TotalLength = 0.0;
  std::vector<std::pair<Vec2, Vec2>> Segments;
  std::vector<std::vector<int>> Slabs; ///< Segments by horizontal slab of the box.
  std::vector<Curve> Curves;
  std::vector<Vec3> LinePoints;
  std::vector<std::array<int, 3>> Lines;
  std::vector<std::pair<int, double>> LineOrigins; ///< Curve and parameter at each line's start.
  ClosestTriangle Boundary;
  std::unique_ptr<BRepTopAdaptor_FClass2d> Classifier;
};

} // namespace verify
