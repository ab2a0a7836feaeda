// SPDX-License-Identifier: BSD-3-Clause
/// @file Tessellator.h
/// @brief Trimmed NURBS models to triangles within a certified error.
///
/// Source: A. Balazs, M. Guthe, R. Klein, "Efficient trimmed NURBS tessellation", Journal of WSCG
/// 12 (2004). Where and why we differ: Documentation/Papers/balazs-2004.md.
#pragma once

#include "Model.h"
#include "PieceLinks.h"
#include "TrimCurves.h"

#include <atomic>

namespace nurbs
{

/// How a surface's parameter domain is subdivided (Balazs section 5.2).
enum class SubdivisionMethod
{
  KdTree,   ///< Split the direction that deviates most, where the demand is halved (default).
  QuadTree, ///< Split both directions at once.
  Binary    ///< Split at the middle of the parameter range, direction that deviates most.
};

/// What the tolerance means.
enum class ErrorMode
{
  Guaranteed, ///< Sound bounds on Bernstein and B-spline coefficients; the error is certified.
  Estimated   ///< Sampled deviations: fewer triangles, no proof.
};

/// Options of Tessellate.
struct TessellatorOptions
{
  double Tolerance = 0.0;             ///< Absolute, model units, > 0; largest distance allowed.
  std::vector<double> FaceTolerances; ///< Absolute, one a face (pixels); empty: Tolerance.
  SubdivisionMethod Method = SubdivisionMethod::KdTree;
  ErrorMode Error = ErrorMode::Guaranteed;
  CurveOptions Curves;            ///< How trim curves become polylines (section 5.1).
  double MaximumEdgeLength = 0.0; ///< Model units; 0: no limit.
  double MaximumAngle = 0.0;      ///< Radians between the normals at a triangle's corners; 0: none.
  std::int64_t MaximumFaceTriangles = 4000000; ///< A face that would need more is capped.
  const PieceLinks* Pieces = nullptr;          ///< If other processes have the rest of the model.
  ParallelFor Parallel = SerialFor;
  std::function<bool(double)> Progress; ///< Called with 0..1 (any thread); false: abort.
};

/// What became of a face.
enum class FaceStatus : unsigned char
{
  Ok = 0,       ///< Within the tolerance, certified.
  Repaired = 1, ///< Its loops needed repair (crossings, gaps, orientation); see Message.
  Capped = 2,   ///< The tolerance is not met: triangle limit, or beneath the model's own gaps.
  Failed = 3    ///< No triangles; see Message.
};

/// The triangles of one face.
struct FaceMesh
{
  std::vector<Vec3> Points;
  std::vector<Vec3> Normals;   ///< Unit, outward (turned if the face is reversed).
  std::vector<Vec2> UV;        ///< In the face's own parameter domain.
  std::vector<int> Triangles;  ///< Three point indices each, counter-clockwise from outside.
  double CertifiedError = 0.0; ///< Model units; an estimate in ErrorMode::Estimated.
  double ModelGap = 0.0;       ///< Largest distance of the shared edges' points from this surface.
  FaceStatus Status = FaceStatus::Ok;
  std::string Message; ///< Why the status is not Ok.
};

/// A trim curve's use as a polyline on its face (second output).
struct TrimPolyline
{
  std::int64_t Edge = -1; ///< EdgeId; -1: unshared.
  std::int64_t Face = -1; ///< Index into Model::Faces.
  std::vector<Vec3> Points;
};

/// The result; Meshes has one entry a face of the model.
struct TessellationResult
{
  std::vector<FaceMesh> Meshes;
  std::vector<TrimPolyline> Polylines;
  bool Aborted = false;
};

/// Tessellates a model. Every edge is discretised once; all faces that use it have its points bit
/// for bit. The result does not depend on the number of threads.
///
/// @param model the faces, loops, trim curves and edges.
/// @param faceErrors one string a face: "" or why it can't be used (it comes out as Failed).
/// With Pieces, ghosts get no triangles, and own faces those that they get where one process has the
/// whole model. All processes must call it, with the same options.
/// Throws Error if the tolerance is not positive and finite.
TessellationResult Tessellate(const Model& model, const std::vector<std::string>& faceErrors,
  const TessellatorOptions& options);

} // namespace nurbs
