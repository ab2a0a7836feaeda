// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSModelNames.h
 * @brief Names of the arrays of a model; see vtkNURBSModel for their meaning.
 *
 * Private to this module: code elsewhere asks vtkNURBSModel.
 */
#ifndef vtkNURBSModelNames_h
#define vtkNURBSModelNames_h

namespace vtkNURBSModelNames
{
// Point data.
inline constexpr char RationalWeights[] = "RationalWeights";
// Cell data.
inline constexpr char Degree[] = "Degree";
inline constexpr char NetSize[] = "NetSize";
inline constexpr char KnotStart[] = "KnotStart";
inline constexpr char LoopStart[] = "LoopStart";
inline constexpr char LoopCount[] = "LoopCount";
inline constexpr char FaceId[] = "FaceId";
inline constexpr char Orientation[] = "Orientation";
inline constexpr char Color[] = "Color";
inline constexpr char Name[] = "Name";
// Field data.
inline constexpr char Knots[] = "Knots";
inline constexpr char LoopCurveStart[] = "LoopCurveStart";
inline constexpr char LoopCurveCount[] = "LoopCurveCount";
inline constexpr char TrimCurveDegree[] = "TrimCurveDegree";
inline constexpr char TrimCurveKnotStart[] = "TrimCurveKnotStart";
inline constexpr char TrimCurvePointStart[] = "TrimCurvePointStart";
inline constexpr char TrimCurvePointCount[] = "TrimCurvePointCount";
inline constexpr char TrimCurveEdgeId[] = "TrimCurveEdgeId";
inline constexpr char TrimCurveReversed[] = "TrimCurveReversed";
inline constexpr char TrimPoints[] = "TrimPoints";
inline constexpr char TrimKnots[] = "TrimKnots";
inline constexpr char EdgeDegree[] = "EdgeDegree";
inline constexpr char EdgeKnotStart[] = "EdgeKnotStart";
inline constexpr char EdgePointStart[] = "EdgePointStart";
inline constexpr char EdgePointCount[] = "EdgePointCount";
inline constexpr char EdgeVertices[] = "EdgeVertices";
inline constexpr char EdgeTolerance[] = "EdgeTolerance";
inline constexpr char EdgePoints[] = "EdgePoints";
inline constexpr char EdgeKnots[] = "EdgeKnots";
inline constexpr char VertexPoints[] = "VertexPoints";
inline constexpr char EdgeGlobalId[] = "EdgeGlobalId";
inline constexpr char VertexGlobalId[] = "VertexGlobalId";
inline constexpr char WholeBounds[] = "WholeBounds";
inline constexpr char LengthUnit[] = "LengthUnit";
inline constexpr char UnconvertedFaces[] = "UnconvertedFaces";
// Cell data of outputs.
inline constexpr char EdgeId[] = "EdgeId";
inline constexpr char PatchDomain[] = "PatchDomain";
inline constexpr char Trimmed[] = "Trimmed";
} // namespace vtkNURBSModelNames

#endif
