// SPDX-License-Identifier: BSD-3-Clause
/// @file ShapeBuilder.h
/// @brief A trimmed model as a shape of OpenCASCADE: faces sewn to shells and solids.
///
/// Every face keeps its surface (AnalyticForm, SplineExport), its loops as wires of trim curves, and its
/// orientation; one of several pieces becomes several faces on one surface. Faces that share an edge
/// of the model share a TopoDS_Edge (EdgeExport tells what its curve and tolerance are). Faces that
/// hang together so become a shell; a closed shell whose outside is outside becomes a solid, with the
/// closed shells inside it that are turned inwards as its cavities. One that is turned inwards and
/// lies in no solid stays a shell. Faces without loops get their natural boundary, and share the sides that coincide.
#pragma once

#include "Model.h"

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

#include <atomic>

namespace nurbs
{

struct ShapeOptions
{
  double Scale = 1.0;           ///< OpenCASCADE's unit, millimetres, a unit of the model.
  double CurveTolerance = 1e-7; ///< What computed edge curves may deviate, of the model's diagonal.
  bool Analytic = true;         ///< Planes, cylinders, lines ... are told as such: AnalyticForm.h.
  double Gap = 1e-4;            ///< How far apart faces may be that share an edge, of the diagonal.
};

/// What became of a model. Lengths are millimetres.
struct BuiltShape
{
  TopoDS_Shape Shape;                  ///< A body or a compound of bodies; null without a face.
  std::vector<TopoDS_Face> Faces;      ///< Those that could be built, by face of the model.
  std::vector<std::int64_t> FaceOf;    ///< The face of the model that each of Faces is, or is of.
  std::vector<std::string> FaceErrors; ///< One a face of the model: why it can't be built, or "".
  std::int64_t AnalyticFaces =
    0; ///< Faces of the model on planes, cylinders, cones, spheres and tori.
  std::int64_t SplitFaces = 0; ///< Faces of the model that are several of Faces.
  std::int64_t Solids = 0;
  std::int64_t Shells = 0;        ///< That are no part of a solid.
  std::int64_t Edges = 0;         ///< Poles left out.
  std::int64_t SharedEdges = 0;   ///< Of them: with two uses or more.
  std::int64_t ComputedEdges = 0; ///< Of them: the curve is not the model's.
  std::int64_t TornEdges = 0;     ///< Edges of the model whose faces are too far apart to share it.
  double EdgeTolerance = 0.0;     ///< The largest.
};

/// Builds the faces that `faceErrors` has no word against. Gives up, with a null shape, when `abort`
/// becomes true. Throws Error where OpenCASCADE fails as a whole.
BuiltShape BuildShape(const Model& model, const std::vector<std::string>& faceErrors,
  const ShapeOptions& options, const ParallelFor& parallel, const std::atomic<bool>& abort);

/// What BRepCheck_Analyzer finds wrong, one sentence for each face and shell that is not valid, with
/// the index of the face (-1: no face). Empty: the shape is valid.
struct ShapeFault
{
  std::int64_t Face = -1;
  std::string Reason;
};
std::vector<ShapeFault> CheckShape(const BuiltShape& built);

} // namespace nurbs
