// SPDX-License-Identifier: BSD-3-Clause
/// @file FaceMesher.h
/// @brief The triangles of one face: cells of its grid, and what is between them and its loops.
///
/// Cells that the loops leave whole become two triangles, or more where neighbours have vertices on
/// their sides. What the loops cut is triangulated together with their polylines
/// (ZoneTriangulation.h). Sides of the grid's box that are edges need no cutting: their cells take
/// the edge's vertices.
#pragma once

#include "WaveletFace.h"

namespace nurbs
{

/// What became of a face.
enum class WaveletStatus : unsigned char
{
  Ok = 0,       ///< As asked for.
  Repaired = 1, ///< Its loops cross or enclose nothing; see Message.
  Capped = 2,   ///< The finest level there is errs more than asked for.
  Failed = 3    ///< No triangles; see Message.
};

/// The triangles of a face.
struct WaveletMesh
{
  std::vector<Vec3> Points;
  std::vector<Eigen::Vector3f> Normals; ///< Unit, outwards.
  std::vector<Vec2> UV;                 ///< In the face's domain.
  std::vector<int> Triangles;           ///< Three indices each, counter-clockwise from outside.
  double Error = 0.0;                   ///< Bound of the distance between triangles and face.
  int Level = 0;                        ///< The finest level in it.
  WaveletStatus Status = WaveletStatus::Ok;
  std::string Message; ///< Why the status is not Ok.
};

/// A vertex of a face's loop and the segment that starts there.
struct LevelLoopVertex
{
  Vec2 UV;
  Vec3 X;
  std::int64_t Edge = -1;    ///< -1: the segment is on no edge.
  int First = 0, Last = 0;   ///< The segment's lines of the edge, First < Last.
  bool OnSide = false;       ///< It runs evenly along a side of the box.
  Box2 Range;                ///< Not OnSide: the parameters of the piece of the curve.
  double SegmentError = 0.0; ///< Bound of the distance between the edge's curve and the segment.
};

/// A cell to be meshed: from line I0 to I1 and J0 to J1 of the grid.
struct GridLeaf
{
  int I0, I1, J0, J1;
  WaveletCell Cell;
  double Error = 0.0; ///< Bound of the distance between its bilinear interpolation and the surface.
  /// Likewise if some of the surface's points are vertices, but for the cell's twist.
  double ErrorWithVertices = 0.0;
};

/// What a face is meshed from.
struct FaceMeshJob
{
  const WaveletFace* Source = nullptr;
  bool Reversed = false;
  bool OnSurface = true; ///< Samples are on the surface at their parameters.
  double Offset = 0.0;   ///< Else, bound of their distance from it.
  std::vector<double> Lines[2];
  std::vector<Vec3> Samples;
  std::vector<Eigen::Vector3f> Normals;
  std::vector<GridLeaf> Leaves; ///< They cover the grid.
  std::vector<std::vector<LevelLoopVertex>> Loops;
  double Limit = 1e300; ///< Errors above it ask for refinement.
};

/// What has to be finer for the Limit's sake.
struct FaceMeshRequests
{
  std::vector<int> Leaves;                                            ///< Indices of the job's.
  std::vector<std::pair<std::int64_t, std::pair<int, int>>> Segments; ///< Edge, its lines.
};

/// Meshes a face.
WaveletMesh MeshFace(const FaceMeshJob& job, FaceMeshRequests& requests);

} // namespace nurbs
