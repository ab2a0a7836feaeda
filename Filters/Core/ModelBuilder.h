// SPDX-License-Identifier: BSD-3-Clause
/// @file ModelBuilder.h
/// @brief Builds a trimmed model face by face into flat arrays that it owns.
///
/// Readers and sources fill one; vtkNURBSModel::Store turns it into a vtkUnstructuredGrid, and
/// tests of kernels assemble a nurbs::Model from it directly:
///
///     ModelBuilder builder;
///     auto a = builder.AddVertex(...), b = builder.AddVertex(...);
///     auto edge = builder.AddEdge(curve.View(), 1e-7, a, b);
///     builder.BeginFace(surface.View(), attributes);
///     builder.BeginLoop();
///     builder.AddTrimCurve(trim.View(), edge, false);
///     AssembledModel model = AssembleModel(builder.Arrays());
///
/// Nothing is checked here beyond what is needed to copy (AssembleModel does). Not for concurrent
/// use.
#pragma once

#include "ModelArrays.h"

#include <array>

namespace nurbs
{

/// Identity and looks of a face.
struct FaceAttributes
{
  std::int64_t FaceId = -1;                                  ///< -1: the face's index.
  std::array<std::uint8_t, 3> Color = { { 204, 204, 204 } }; ///< sRGB; default light grey.
  std::string Name;                                          ///< UTF-8.
  bool Reversed = false;                                     ///< The outside is against Su x Sv.
};

/// Collects faces, loops, trim curves, edges and vertices. All indices start at 0.
class ModelBuilder
{
public:
  /// A position where edges meet. Returns its index.
  std::int64_t AddVertex(const Vec3& position);

  /// An edge with its 3D curve from vertex `start` to `end` (-1: unknown; equal: closed).
  /// `tolerance`: the largest distance of the faces' lifted trim curves from it. Returns its index.
  std::int64_t AddEdge(
    const CurveView<3>& curve, double tolerance, std::int64_t start, std::int64_t end);

  /// A degenerate edge: the pole `point` over the parameter range of its trim curve.
  std::int64_t AddPole(const Vec3& point, Interval range, double tolerance, std::int64_t vertex);

  /// An edge without a 3D curve.
  std::int64_t AddUnknownEdge(double tolerance, std::int64_t start, std::int64_t end);

  /// Raises the tolerance of an edge to at least `tolerance`.
  void RaiseEdgeTolerance(std::int64_t edge, double tolerance);

  /// Starts a face; loops and trim curves that follow are its own. Returns its index.
  std::int64_t BeginFace(const SurfaceView& surface, const FaceAttributes& attributes);

  /// Starts a loop of the current face. A face without a loop has its natural boundary.
  void BeginLoop();

  /// Appends a curve to the current loop. `edge` -1: the curve belongs to no edge.
  void AddTrimCurve(const CurveView<2>& curve, std::int64_t edge, bool reversed);

  /// Removes the current face with its loops and trim curves (not its edges).
  void DropFace();

  /// Faces so far.
  std::int64_t FaceCount() const;
  /// Edges so far.
  std::int64_t EdgeCount() const;

  /// Views of what was built; valid until the next change.
  ModelArrays Arrays() const;

  /// Length unit of the points, for example "mm".
  std::string LengthUnit = "mm";

  /// The arrays themselves, see ModelArrays for their meaning.
  struct Storage
  {
    /// Indices and counts.
    using Integers = std::vector<std::int64_t>;
    /// Coordinates, weights and knots.
    using Reals = std::vector<double>;
    Reals Points, Weights; ///< Weights stay empty until the first rational face.
    Integers Connectivity, Offsets{ 0 };
    Integers Degree, NetSize, KnotStart, LoopStart, LoopCount, FaceId, Orientation;
    std::vector<std::uint8_t> Color; ///< 3 a face.
    std::vector<std::string> Name;
    Reals Knots;
    Integers LoopCurveStart, LoopCurveCount;
    Integers TrimCurveDegree, TrimCurveKnotStart, TrimCurvePointStart, TrimCurvePointCount;
    Integers TrimCurveEdgeId, TrimCurveReversed;
    Reals TrimPoints, TrimKnots;
    Integers EdgeDegree, EdgeKnotStart, EdgePointStart, EdgePointCount, EdgeVertices;
    Reals EdgeTolerance, EdgePoints, EdgeKnots, VertexPoints;
  };
  Storage Data;

private:
  void AddNet(const SurfaceView& surface);
};

} // namespace nurbs
