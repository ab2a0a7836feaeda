// SPDX-License-Identifier: BSD-3-Clause
/// @file FaceLoops.h
/// @brief First step of a face's triangulation: its loops as directed polygons that do not cross.
///
/// Source: Balazs, Guthe, Klein 2004, sections 5.1 and 6. Loops follow the polylines of their edges;
/// polylines that cross although their curves do not ask for finer ones (SplitRequest), curves that
/// cross are repaired (LoopRepair.h).
#pragma once

#include "FaceTessellator.h"
#include "LoopRepair.h"

namespace nurbs
{

/// What the steps of a face's triangulation share.
class FaceLoops
{
protected:
  FaceLoops(const FaceJob& job, std::vector<SplitRequest>& requests);

  /// Fills Loops from the edges' polylines.
  void MakeLoops();
  /// Looks for crossings and wrong orientation; false: the face can't go on (yet).
  bool CheckLoops();
  /// Once the triangles are there: adds those that lead from the boundary as it was repaired to the
  /// one that the neighbours have.
  void Stitch();
  /// The loops where they are triangulated: in the plane of a planar face, in (u, v) otherwise.
  Loops2 FlatLoops() const;
  /// Asks for a vertex in the middle of the segment that starts at v, if its edge can have one.
  void RequestSplit(const BoundaryVertex& v);
  /// Raises the face's status and adds to its message.
  void Note(FaceStatus status, const std::string& message);

  const FaceJob& Job;
  const Model& Data;
  const Face& TheFace;
  std::vector<SplitRequest>& Requests;
  FaceMesh Mesh;
  std::vector<std::vector<BoundaryVertex>> Loops;

private:
  void AppendCurve(std::int64_t index, std::vector<BoundaryVertex>& loop);
  void PoleParameters(const TrimCurve& curve, const Interval& domain, std::vector<double>& ts);
  bool IsShort(const Vec2& a, const Vec2& b) const;
  void SnapLoop(std::vector<BoundaryVertex>& loop) const;
  Vec2 Clamp(const Vec2& uv, bool snap) const;
  void MoveToFeet(std::vector<BoundaryVertex>& part);
  Vec2 Foot(const Vec2& uv, const Vec3& x) const;
  bool IsSameCorner(const BoundaryVertex& a, const BoundaryVertex& b) const;
  void JoinCorner(const BoundaryVertex& end, BoundaryVertex& start);
  void CloseLoop(std::vector<BoundaryVertex>& loop);
  bool UseOthers(Loops2& flat, CrossingFinder& finder);
  bool IsLoopThin(const std::vector<BoundaryVertex>& loop) const;
  void RequestMiddles(const std::vector<BoundaryVertex>& loop);
  bool Repair(const Loops2& flat);

  using Loop = std::vector<BoundaryVertex>;
  bool OnCurves = false; ///< Vertices stay on the trim curves.
  double CurveGap =
    0.0; ///< Largest distance of trim curves from vertices that were moved off them.
  std::vector<Loop> Given;    ///< Loops that were changed, as the neighbours have them,
  std::vector<Loop> Replaced; ///< and as they became.
};

} // namespace nurbs
