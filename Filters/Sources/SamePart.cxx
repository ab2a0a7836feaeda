// SPDX-License-Identifier: BSD-3-Clause
#include "SamePart.h"

#include "CADSession.h"

#include <BRepBuilderAPI_Transform.hxx>
#include <Eigen/Geometry>
#include <TopoDS.hxx>
#include <gp_Quaternion.hxx>
#include <gp_Trsf.hxx>

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

constexpr double RoundOff = 1e-12; // of the largest coordinate

bool Same(KnotView a, KnotView b)
{
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
}

bool Same(const SurfaceView& a, const SurfaceView& b)
{
  bool same = (a.Weights == nullptr) == (b.Weights == nullptr);
  for (int dir = 0; dir < 2; ++dir)
  {
    same = same && a.Degree[dir] == b.Degree[dir] && a.Count[dir] == b.Count[dir] &&
      Same(a.Knots[dir], b.Knots[dir]);
  }
  for (std::int64_t k = 0; same && a.Weights && k < a.Size(); ++k)
  {
    same = a.Weight(k) == b.Weight(k);
  }
  return same;
}

bool Same(const CurveView<2>& a, const CurveView<2>& b)
{
  bool same = a.Degree == b.Degree && a.Count == b.Count && Same(a.Knots, b.Knots);
  for (int i = 0; same && i < a.Count; ++i)
  {
    same = a.Weight(i) == b.Weight(i) && a.Point(i) == b.Point(i);
  }
  return same;
}

bool Same(const Face& a, const Face& b)
{
  return a.FirstLoop == b.FirstLoop && a.LoopCount == b.LoopCount && a.Reversed == b.Reversed &&
    Same(a.Geometry, b.Geometry);
}

bool Same(const TrimLoop& a, const TrimLoop& b)
{
  return a.FirstCurve == b.FirstCurve && a.CurveCount == b.CurveCount;
}

bool Same(const TrimCurve& a, const TrimCurve& b)
{
  return a.Edge == b.Edge && a.Reversed == b.Reversed && Same(a.Geometry, b.Geometry);
}

bool Same(const Edge& a, const Edge& b)
{
  return a.Vertex[0] == b.Vertex[0] && a.Vertex[1] == b.Vertex[1];
}

template <typename T>
bool AllSame(const std::vector<T>& a, const std::vector<T>& b)
{
  return std::equal(
    a.begin(), a.end(), b.begin(), b.end(), [](const T& x, const T& y) { return Same(x, y); });
}

Eigen::Matrix3Xd PointsOf(const Model& model)
{
  std::vector<Vec3> points;
  for (const Face& face : model.Faces)
  {
    for (std::int64_t k = 0; k < face.Geometry.Size(); ++k)
    {
      points.push_back(face.Geometry.Point(k));
    }
  }
  return Eigen::Map<const Eigen::Matrix3Xd>(
    points.empty() ? nullptr : points.front().data(), 3, static_cast<Eigen::Index>(points.size()));
}

/// Of edges whose curve both models know. Models that were moved have lost the curves, and with them
/// what is stated of the edges.
double ToleranceDifference(const Model& a, const Model& b)
{
  double difference = 0.0;
  for (std::size_t e = 0; e < a.Edges.size(); ++e)
  {
    if (a.Edges[e].Geometry.Count > 0 && b.Edges[e].Geometry.Count > 0)
    {
      difference = std::max(difference, std::abs(a.Edges[e].Tolerance - b.Edges[e].Tolerance));
    }
  }
  return difference;
}

} // namespace

double MeanRadius(const Model& model)
{
  const Eigen::Matrix3Xd points = PointsOf(model);
  if (points.cols() == 0)
  {
    return 0.0;
  }
  const Vec3 center = points.rowwise().mean();
  return std::sqrt((points.colwise() - center).colwise().squaredNorm().mean());
}

std::optional<Placement> MotionBetween(const Model& from, const Model& to)
{
  if (!AllSame(from.Faces, to.Faces) || !AllSame(from.Loops, to.Loops) ||
    !AllSame(from.TrimCurves, to.TrimCurves) || !AllSame(from.Edges, to.Edges))
  {
    return std::nullopt;
  }
  const Eigen::Matrix3Xd a = PointsOf(from), b = PointsOf(to);
  if (a.cols() == 0 || !a.allFinite() || !b.allFinite())
  {
    return std::nullopt;
  }
  const double near = RoundOff * std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
  if (!(ToleranceDifference(from, to) <= near))
  {
    return std::nullopt;
  }
  const Eigen::Matrix4d motion = Eigen::umeyama(a, b, false);
  Placement placement;
  placement.Linear = motion.topLeftCorner<3, 3>();
  placement.Shift = motion.topRightCorner<3, 1>();
  const Eigen::Matrix3Xd off = (placement.Linear * a).colwise() + placement.Shift - b;
  return off.colwise().norm().maxCoeff() <= near ? std::optional<Placement>(placement)
                                                 : std::nullopt;
}

TopLoc_Location ToLocation(const Placement& motion)
{
  const Eigen::Quaterniond turn(motion.Linear);
  gp_Trsf transformation; // Made of a quaternion, its scale is 1 to the bit.
  transformation.SetTransformation(gp_Quaternion(turn.x(), turn.y(), turn.z(), turn.w()),
    gp_Vec(motion.Shift[0], motion.Shift[1], motion.Shift[2]));
  return TopLoc_Location(transformation);
}

void MovePart(const Placement& motion, CADPart& part)
{
  WithoutFailures("to move a part", [&] {
    BRepBuilderAPI_Transform moved(part.Shape, ToLocation(motion).Transformation(), Standard_True);
    part.Shape = moved.Shape();
    for (TopoDS_Face& face : part.Faces)
    {
      face = TopoDS::Face(moved.ModifiedShape(face));
    }
  });
}

} // namespace nurbs
