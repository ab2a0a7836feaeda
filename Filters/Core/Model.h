// SPDX-License-Identifier: BSD-3-Clause
/// @file Model.h
/// @brief A trimmed model as the kernels see it: views into data that somebody else owns.
///
/// Faces have loops, loops have trim curves, trim curves name the edge that they are the image of.
/// vtkNURBSModel builds one from a vtkUnstructuredGrid.
#pragma once

#include "Curve.h"
#include "Surface.h"

namespace nurbs
{

/// A directed curve in the (u, v) domain of a face.
///
/// It keeps the parameter of its edge: c(t) is the image of the edge's point at the same t (if the
/// two domains differ: affinely mapped). The loop runs through it from Domain().Min to Domain().Max,
/// or the other way if Reversed.
struct TrimCurve
{
  CurveView<2> Geometry;
  std::int64_t Edge = -1; ///< Index into Model::Edges; -1: the curve belongs to this loop alone.
  bool Reversed = false;
};

/// A closed sequence of trim curves; the face's material lies on its left in the (u, v) plane
/// (outer loops counter-clockwise, holes clockwise).
struct TrimLoop
{
  std::int64_t FirstCurve = 0;
  std::int64_t CurveCount = 0;
};

/// A trimmed surface. No loop: the natural boundary of the domain.
struct Face
{
  SurfaceView Geometry;
  std::int64_t FirstLoop = 0;
  std::int64_t LoopCount = 0;
  std::int64_t FaceId = -1;
  bool Reversed = false; ///< The outside is against Su x Sv.
};

/// A 3D curve that one or more faces share.
struct Edge
{
  CurveView<3> Geometry;  ///< Degree 0 with one point: a degenerate edge (pole). Count 0: unknown.
  double Tolerance = 0.0; ///< Largest distance of the faces' own lifted trim curves from it.
  std::int64_t Vertex[2] = { -1, -1 }; ///< Start and end in Model::Vertices; -1: unknown.
};

/// A model: all arrays index each other as documented above.
struct Model
{
  std::vector<Face> Faces;
  std::vector<TrimLoop> Loops;
  std::vector<TrimCurve> TrimCurves;
  std::vector<Edge> Edges;
  std::vector<Vec3> Vertices; ///< Positions where edges meet.
};

/// The part of a face's domain that its loops reach: the box of their control points, within the
/// domain; all of the domain without loops.
Box2 LoopsBox(const Model& model, const Face& face);

} // namespace nurbs
