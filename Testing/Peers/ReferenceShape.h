// SPDX-License-Identifier: BSD-3-Clause
/// @file ReferenceShape.h
/// @brief The original shape of a CAD file as OpenCASCADE reads it: what meshes are measured against.
#pragma once

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

#include <string>
#include <vector>

namespace verify
{

/// One maximal connected thing that ought to be watertight by itself: a solid, a shell, a lone face.
struct Body
{
  std::vector<int> Faces; ///< Indices into ReferenceShape::Faces.
  bool Closed = false;    ///< Every edge that is not degenerate is used an even number of times.
};

/// Largest distances between a face's lifted pcurves, the 3D curves of its edges (and so the
/// neighbours' lifted pcurves) and the vertices: what no mesh that shares its edges can undercut.
struct FaceGap
{
  double Own = 0.0;        ///< Between this face's lifted pcurves and its edges and vertices.
  double Neighbours = 0.0; ///< The same of the faces that share an edge with this one.
};

/// A shape and its faces in TopExp_Explorer order, each instance counted.
struct ReferenceShape
{
  TopoDS_Shape Root;
  std::vector<TopoDS_Face> Faces;
  std::vector<Body> Bodies;
  double Diagonal = 0.0; ///< Of the box of the exact geometry, tolerances and meshes left out.
};

/// Reads .step, .stp, .iges, .igs and OpenCASCADE's own text format.
/// @throws std::runtime_error naming the file where it cannot be read.
TopoDS_Shape ReadShape(const std::string& file);

/// Fills everything but the gaps.
ReferenceShape Describe(const TopoDS_Shape& root);

/// Gaps of every face, in the order of ReferenceShape::Faces.
std::vector<FaceGap> MeasureGaps(const ReferenceShape& shape);

/// "plane", "cylinder", "B-spline", ...
std::string SurfaceKind(const TopoDS_Face& face);

} // namespace verify
