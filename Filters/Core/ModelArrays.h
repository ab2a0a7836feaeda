// SPDX-License-Identifier: BSD-3-Clause
/// @file ModelArrays.h
/// @brief The flat arrays that a trimmed model is stored in, and their checked assembly.
///
/// ModelArrays is the model of vtkNURBSModel without VTK: every array there has one view here, with
/// the same meaning and layout. AssembleModel turns the arrays into a nurbs::Model. It trusts
/// nothing: a face whose data is wrong is reported and left out, the others stay usable.
#pragma once

#include "Model.h"

#include <deque>

namespace nurbs
{

/// Views of the arrays of a model. Nothing is copied; the owners must outlive it.
///
/// A `start` is an index into the named flat array; counts are numbers of tuples. Integers are
/// 64 bits wide here, whatever they are in the file.
struct ModelArrays
{
  /// Indices and counts.
  using Integers = ArrayView<std::int64_t>;
  /// Coordinates, weights and knots.
  using Reals = ArrayView<double>;

  Reals Points;          ///< xyz triples, Cartesian.
  Reals Weights;         ///< One a point; empty: all 1.
  Integers Connectivity; ///< Point indices of all faces' control nets, u fastest.
  Integers Offsets;      ///< Faces + 1 starts into Connectivity.

  Integers Degree;      ///< 2 a face: u, v; 1 to MaxDegree.
  Integers NetSize;     ///< 2 a face: u, v.
  Integers KnotStart;   ///< 2 a face, into Knots: u, v.
  Integers LoopStart;   ///< 1 a face, into LoopCurveStart; empty: no face is trimmed.
  Integers LoopCount;   ///< 1 a face; 0: the natural boundary.
  Integers FaceId;      ///< 1 a face; empty: the face's index.
  Integers Orientation; ///< 1 a face: +1 or -1 (outside against Su x Sv); empty: all +1.
  Reals Knots;          ///< Knot vectors of all faces.

  Integers LoopCurveStart; ///< 1 a loop, into the TrimCurve arrays.
  Integers LoopCurveCount; ///< 1 a loop.

  Integers TrimCurveDegree;     ///< 1 a trim curve, 1 to MaxDegree.
  Integers TrimCurveKnotStart;  ///< Into TrimKnots.
  Integers TrimCurvePointStart; ///< Into TrimPoints.
  Integers TrimCurvePointCount; ///< Number of control points.
  Integers TrimCurveEdgeId;     ///< Index of the edge; -1: none.
  Integers TrimCurveReversed;   ///< 1: the loop runs from the curve's end to its start.
  Reals TrimPoints;             ///< (u, v, w) triples: Cartesian, then the weight.
  Reals TrimKnots;              ///< Knot vectors of all trim curves.

  Integers EdgeDegree;     ///< 1 an edge; 0: degenerate (one point).
  Integers EdgeKnotStart;  ///< Into EdgeKnots.
  Integers EdgePointStart; ///< Into EdgePoints.
  Integers EdgePointCount; ///< 0: the 3D curve is unknown.
  Integers EdgeVertices;   ///< 2 an edge: start and end, into VertexPoints; -1: unknown.
  Reals EdgeTolerance;     ///< Length; >= 0.
  Reals EdgePoints;        ///< (x, y, z, w): Cartesian, then the weight.
  Reals EdgeKnots;         ///< Knot vectors of all edges.
  Reals VertexPoints;      ///< xyz triples.

  /// Number of faces: Offsets.size() - 1, or 0.
  std::int64_t FaceCount() const;
};

/// Something wrong with a model.
struct ModelProblem
{
  /// How bad it is.
  enum class Level
  {
    Warning, ///< The face is usable; a kernel may repair it.
    Error    ///< The face (or, with Face -1, the named array) can't be used.
  };
  Level Severity = Level::Error;
  std::int64_t Face = -1; ///< Index of the face (cell); -1: the whole model.
  std::string Reason;     ///< What is wrong, with the numbers; names curve, edge or array.
};

/// A model with what is wrong with it. Move-only by nature: its views may point into itself.
struct AssembledModel
{
  AssembledModel() = default;
  AssembledModel(const AssembledModel&) = delete;
  AssembledModel& operator=(const AssembledModel&) = delete;
  /// Views move with what they point to.
  AssembledModel(AssembledModel&&) = default;
  /// Likewise.
  AssembledModel& operator=(AssembledModel&&) = default;

  /// As many faces, loops, trim curves, edges and vertices as the arrays have, same indices. A face
  /// with an error has an empty net (Geometry.Count 0) and no loop.
  nurbs::Model Model;
  std::vector<std::string> FaceErrors; ///< One a face: "" if it is usable.
  std::vector<ModelProblem> Problems;  ///< All errors and warnings, by face.

  /// Points of degenerate edges that moved with their face (see AssembleModel).
  std::deque<Vec4> MovedPoles;
};

/// How much AssembleModel checks and repairs.
struct AssembleOptions
{
  /// Check the trimming loops: closed, inside the domain, not without area.
  bool CheckLoops = true;
  /// Compare the edges' 3D curves with the faces. Any VTK filter may have moved the control points
  /// and left edges and vertices behind: such an edge becomes "unknown" (Count 0; a degenerate edge
  /// keeps one point, at its new place), its vertices move to the end of a trim curve. One warning.
  bool CheckEdges = true;
  /// Gap of a loop, as a part of the domain's size, up to which it only warns. Default 1e-2.
  double GapLimit = 1e-2;
  /// Box of the nets of the whole model, if the arrays are a piece of one: sizes that are told from
  /// nothing are the same for all pieces then. Empty: the arrays are the whole.
  Box3 Around;
};

/// Checks all arrays and assembles a model of views into them. Never throws on bad data; the
/// result does not depend on `parallel`.
AssembledModel AssembleModel(const ModelArrays& arrays,
  const AssembleOptions& options = AssembleOptions(), const ParallelFor& parallel = SerialFor);

} // namespace nurbs
