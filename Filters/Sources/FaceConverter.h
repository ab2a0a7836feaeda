// SPDX-License-Identifier: BSD-3-Clause
/// @file FaceConverter.h
/// @brief One face of OpenCASCADE as a trimmed NURBS surface; see PartConverter.
#pragma once

#include "ParameterMap.h"
#include "PartConverter.h"

#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>

namespace nurbs
{

/// What faces need to know of an edge beside its converted curve.
struct EdgeSource
{
  TopoDS_Edge Shape;              ///< As first met; its orientation says nothing.
  ParameterMap Map;               ///< Edge parameter t -> parameter of the converted curve.
  double Range[2] = { 0.0, 0.0 }; ///< Of t, where the converted curve begins and ends.
  double Tolerance = 0.0;         ///< OpenCASCADE's.
};

/// The edges of a part, all converted.
struct EdgeTable
{
  TopTools_IndexedMapOfShape Index; ///< Edge i + 1 of this is edge i of the part.
  std::vector<EdgeSource> Sources;
  const std::vector<Part::Edge>* Edges = nullptr;
  double Size = 0.0; ///< Diagonal of the part's bounding box.

  /// What fits on the edge may deviate.
  double FitTolerance(std::int64_t edge) const;
};

/// A converted face and what it tells about its edges.
struct FaceResult
{
  struct Deviation
  {
    std::int64_t Edge;
    double Distance; ///< Largest distance of the lifted trim curve from the edge's curve.
  };
  struct Pole
  {
    std::int64_t Edge;
    Box3 Box; ///< Of the lifted trim curve, a point if the edge is truly degenerate.
  };
  struct End
  {
    std::int64_t Vertex;
    Vec3 Point; ///< Where the face sees the vertex.
  };
  Part::Face Face;
  std::vector<Deviation> Deviations;
  std::vector<Pole> Poles;
  std::vector<End> Ends;
};

/// Converts a face; never throws, see Part::Face::Failure.
FaceResult ConvertFace(const TopoDS_Face& face, const EdgeTable& edges);

/// How a transformation of OpenCASCADE moves points.
Placement ToPlacement(const gp_Trsf& transformation);

} // namespace nurbs
