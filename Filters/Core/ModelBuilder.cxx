// SPDX-License-Identifier: BSD-3-Clause
#include "ModelBuilder.h"

#include <algorithm>

namespace nurbs
{
namespace
{

void Append(std::vector<double>& target, KnotView values)
{
  target.insert(target.end(), values.begin(), values.end());
}

std::int64_t Size(const std::vector<double>& values, int components = 1)
{
  return static_cast<std::int64_t>(values.size()) / components;
}

std::int64_t Size(const std::vector<std::int64_t>& values)
{
  return static_cast<std::int64_t>(values.size());
}

} // namespace

std::int64_t ModelBuilder::AddVertex(const Vec3& position)
{
  this->Data.VertexPoints.insert(
    this->Data.VertexPoints.end(), position.data(), position.data() + 3);
  return Size(this->Data.VertexPoints, 3) - 1;
}

std::int64_t ModelBuilder::AddEdge(
  const CurveView<3>& curve, double tolerance, std::int64_t start, std::int64_t end)
{
  Storage& d = this->Data;
  d.EdgeDegree.push_back(curve.Degree);
  d.EdgeKnotStart.push_back(Size(d.EdgeKnots));
  d.EdgePointStart.push_back(Size(d.EdgePoints, 4));
  d.EdgePointCount.push_back(curve.Count);
  d.EdgeTolerance.push_back(tolerance);
  d.EdgeVertices.push_back(start);
  d.EdgeVertices.push_back(end);
  Append(d.EdgeKnots, curve.Knots);
  d.EdgePoints.insert(d.EdgePoints.end(), curve.Points, curve.Points + 4 * curve.Count);
  return Size(d.EdgeDegree) - 1;
}

std::int64_t ModelBuilder::AddPole(
  const Vec3& point, Interval range, double tolerance, std::int64_t vertex)
{
  const double knots[2] = { range.Min, range.Max };
  const double packed[4] = { point[0], point[1], point[2], 1.0 };
  CurveView<3> curve;
  curve.Degree = 0;
  curve.Knots = KnotView(knots, 2);
  curve.Points = packed;
  curve.Count = 1;
  return this->AddEdge(curve, tolerance, vertex, vertex);
}

std::int64_t ModelBuilder::AddUnknownEdge(double tolerance, std::int64_t start, std::int64_t end)
{
  return this->AddEdge(CurveView<3>(), tolerance, start, end);
}

void ModelBuilder::RaiseEdgeTolerance(std::int64_t edge, double tolerance)
{
  double& stored = this->Data.EdgeTolerance.at(edge);
  stored = std::max(stored, tolerance);
}

void ModelBuilder::AddNet(const SurfaceView& surface)
{
  Storage& d = this->Data;
  const std::int64_t first = Size(d.Points, 3);
  if (surface.Weights && d.Weights.empty())
  {
    d.Weights.assign(first, 1.0);
  }
  for (std::int64_t k = 0; k < surface.Size(); ++k)
  {
    const double* p = surface.Points + 3 * surface.Id(k);
    d.Points.insert(d.Points.end(), p, p + 3);
    d.Connectivity.push_back(first + k);
    if (surface.Weights || !d.Weights.empty())
    {
      d.Weights.push_back(surface.Weight(k));
    }
  }
  d.Offsets.push_back(Size(d.Connectivity));
}

std::int64_t ModelBuilder::BeginFace(const SurfaceView& surface, const FaceAttributes& attributes)
{
  Storage& d = this->Data;
  const std::int64_t face = this->FaceCount();
  for (int dir = 0; dir < 2; ++dir)
  {
    d.Degree.push_back(surface.Degree[dir]);
    d.NetSize.push_back(surface.Count[dir]);
    d.KnotStart.push_back(Size(d.Knots));
    Append(d.Knots, surface.Knots[dir]);
  }
  d.LoopStart.push_back(Size(d.LoopCurveStart));
  d.LoopCount.push_back(0);
  d.FaceId.push_back(attributes.FaceId < 0 ? face : attributes.FaceId);
  d.Orientation.push_back(attributes.Reversed ? -1 : 1);
  d.Color.insert(d.Color.end(), attributes.Color.begin(), attributes.Color.end());
  d.Name.push_back(attributes.Name);
  this->AddNet(surface);
  return face;
}

void ModelBuilder::BeginLoop()
{
  Storage& d = this->Data;
  if (d.LoopCount.empty())
  {
    throw Error("a loop was started before any face");
  }
  d.LoopCurveStart.push_back(Size(d.TrimCurveDegree));
  d.LoopCurveCount.push_back(0);
  ++d.LoopCount.back();
}

void ModelBuilder::AddTrimCurve(const CurveView<2>& curve, std::int64_t edge, bool reversed)
{
  Storage& d = this->Data;
  if (d.LoopCount.empty() || d.LoopCount.back() == 0)
  {
    throw Error("a trim curve was added before any loop of the face");
  }
  d.TrimCurveDegree.push_back(curve.Degree);
  d.TrimCurveKnotStart.push_back(Size(d.TrimKnots));
  d.TrimCurvePointStart.push_back(Size(d.TrimPoints, 3));
  d.TrimCurvePointCount.push_back(curve.Count);
  d.TrimCurveEdgeId.push_back(edge);
  d.TrimCurveReversed.push_back(reversed ? 1 : 0);
  Append(d.TrimKnots, curve.Knots);
  d.TrimPoints.insert(d.TrimPoints.end(), curve.Points, curve.Points + 3 * curve.Count);
  ++d.LoopCurveCount.back();
}

void ModelBuilder::DropFace()
{
  Storage& d = this->Data;
  if (this->FaceCount() == 0)
  {
    throw Error("there is no face to drop");
  }
  const std::int64_t loop = d.LoopStart.back();
  if (loop < Size(d.LoopCurveStart))
  {
    const std::int64_t curve = d.LoopCurveStart[loop];
    if (curve < Size(d.TrimCurveDegree))
    {
      d.TrimKnots.resize(d.TrimCurveKnotStart[curve]);
      d.TrimPoints.resize(3 * d.TrimCurvePointStart[curve]);
    }
    for (auto* values : { &d.TrimCurveDegree, &d.TrimCurveKnotStart, &d.TrimCurvePointStart,
           &d.TrimCurvePointCount, &d.TrimCurveEdgeId, &d.TrimCurveReversed })
    {
      values->resize(curve);
    }
    d.LoopCurveStart.resize(loop);
    d.LoopCurveCount.resize(loop);
  }
  const std::size_t face = this->FaceCount() - 1;
  d.Knots.resize(d.KnotStart[2 * face]);
  for (auto* values : { &d.Degree, &d.NetSize, &d.KnotStart })
  {
    values->resize(2 * face);
  }
  for (auto* values : { &d.LoopStart, &d.LoopCount, &d.FaceId, &d.Orientation })
  {
    values->resize(face);
  }
  d.Color.resize(3 * face);
  d.Name.resize(face);
  d.Offsets.pop_back();
  const std::int64_t points = d.Offsets.back();
  d.Connectivity.resize(points);
  d.Points.resize(3 * points);
  d.Weights.resize(d.Weights.empty() ? 0 : points);
}

std::int64_t ModelBuilder::FaceCount() const
{
  return Size(this->Data.LoopCount);
}

std::int64_t ModelBuilder::EdgeCount() const
{
  return Size(this->Data.EdgeDegree);
}

ModelArrays ModelBuilder::Arrays() const
{
  const Storage& d = this->Data;
  ModelArrays a;
  a.Points = d.Points;
  a.Weights = d.Weights;
  a.Connectivity = d.Connectivity;
  a.Offsets = d.Offsets;
  a.Degree = d.Degree;
  a.NetSize = d.NetSize;
  a.KnotStart = d.KnotStart;
  a.LoopStart = d.LoopStart;
  a.LoopCount = d.LoopCount;
  a.FaceId = d.FaceId;
  a.Orientation = d.Orientation;
  a.Knots = d.Knots;
  a.LoopCurveStart = d.LoopCurveStart;
  a.LoopCurveCount = d.LoopCurveCount;
  a.TrimCurveDegree = d.TrimCurveDegree;
  a.TrimCurveKnotStart = d.TrimCurveKnotStart;
  a.TrimCurvePointStart = d.TrimCurvePointStart;
  a.TrimCurvePointCount = d.TrimCurvePointCount;
  a.TrimCurveEdgeId = d.TrimCurveEdgeId;
  a.TrimCurveReversed = d.TrimCurveReversed;
  a.TrimPoints = d.TrimPoints;
  a.TrimKnots = d.TrimKnots;
  a.EdgeDegree = d.EdgeDegree;
  a.EdgeKnotStart = d.EdgeKnotStart;
  a.EdgePointStart = d.EdgePointStart;
  a.EdgePointCount = d.EdgePointCount;
  a.EdgeVertices = d.EdgeVertices;
  a.EdgeTolerance = d.EdgeTolerance;
  a.EdgePoints = d.EdgePoints;
  a.EdgeKnots = d.EdgeKnots;
  a.VertexPoints = d.VertexPoints;
  return a;
}

} // namespace nurbs
