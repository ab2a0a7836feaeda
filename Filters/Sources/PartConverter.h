// SPDX-License-Identifier: BSD-3-Clause
/// @file PartConverter.h
/// @brief A shape of OpenCASCADE as trimmed NURBS faces that share edges and vertices.
///
/// Each face's own geometry is converted (SurfaceConverter), each edge's 3D curve (CurveConverter),
/// and each trim curve so that it keeps the parameter of its edge: both are functions of the same t.
/// What of this is exact: surfaces; edges; trim curves on planes (the edge projected), trim curves
/// that are straight in the converted parameters (edges of cylinders, cones, spheres, tori along
/// u or v), and splines on splines. Other trim curves are fitted to a small part of the edge's own
/// tolerance. The distance between lifted trim curves and the edge's curve is measured densely and
/// becomes the edge's tolerance.
#pragma once

#include "Curve.h"
#include "Surface.h"

#include <TopoDS_Shape.hxx>

#include <atomic>
#include <memory>

namespace nurbs
{

class ModelBuilder;
struct FaceAttributes;

/// A converted shape; indices refer to its own arrays.
struct Part
{
  struct TrimCurve
  {
    Curve<2> Geometry;
    std::int64_t Edge = -1;
    bool Reversed = false;
  };
  using Loop = std::vector<TrimCurve>;
  struct Face
  {
    Surface Geometry;
    std::vector<Loop> Loops;
    bool Reversed = false;
    double Error = 0.0;  ///< Measured deviation from the original surface, length.
    std::string Failure; ///< Why it could not be converted; "" if it was.
  };
  enum class EdgeKind
  {
    Curve,
    Pole,   ///< Degenerate; at Vertex[0].
    Unknown ///< No 3D curve.
  };
  struct Edge
  {
    EdgeKind Kind = EdgeKind::Unknown;
    Curve<3> Geometry;
    Interval Range; ///< Of a pole.
    double Tolerance = 0.0;
    std::int64_t Vertex[2] = { -1, -1 };
  };

  std::vector<Face> Faces; ///< In the order of TopExp_Explorer over the shape.
  std::vector<Edge> Edges;
  std::vector<Vec3> Vertices;
};

/// Converts all faces of a shape. Needs exclusive use of the shape: missing curves are added to it.
/// A face that fails has a reason and no geometry. Does nothing more for faces that are not begun
/// when `abort` becomes true. The result does not depend on `parallel`.
Part ConvertPart(
  const TopoDS_Shape& shape, const ParallelFor& parallel, const std::atomic<bool>& abort);

/// Where a part is placed: x -> Linear x + Shift.
struct Placement
{
  Eigen::Matrix3d Linear = Eigen::Matrix3d::Identity();
  Vec3 Shift = Vec3::Zero();
};

/// Appends a placed copy of the part to the builder: `attributes` has one entry a face, of which
/// Reversed is set here. Mirrored placements turn the orientation. `errors` receives the conversion
/// error of each face appended. Faces that failed are left out.
void AppendPart(const Part& part, const Placement& placement,
  std::vector<FaceAttributes>& attributes, ModelBuilder& builder, std::vector<double>& errors);

} // namespace nurbs
