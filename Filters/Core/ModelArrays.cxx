// SPDX-License-Identifier: BSD-3-Clause
#include "ModelArrays.h"

#include "ModelChecks.h"

#include <cmath>
#include <limits>
#include <sstream>

namespace nurbs
{
namespace
{

using Integers = ModelArrays::Integers;
using Reals = ModelArrays::Reals;

std::int64_t Count(const Integers& values, int components = 1)
{
  return static_cast<std::int64_t>(values.size()) / components;
}

/// True if [start, start + count) lies in an array of `size`; no overflow whatever the numbers.
bool InRange(std::int64_t start, std::int64_t count, std::int64_t size)
{
  return start >= 0 && count >= 0 && start <= size && count <= size - start;
}

std::string RangeText(const char* array, std::int64_t start, std::int64_t count, std::int64_t size)
{
  std::ostringstream text;
  text << array << " has " << size << " entries, but " << count << " from " << start
       << " are asked for";
  return text.str();
}

/// Larger coordinates, and weights beyond these, would overflow in products of derivatives.
constexpr double LargestCoordinate = 1e50;
constexpr double LargestWeight = 1e20;

/// The reason why a control point is bad, or "".
std::string CheckPoint(const double* coordinates, int dimension, double weight, std::int64_t index)
{
  const std::string name = "control point " + std::to_string(index);
  std::ostringstream text;
  for (int c = 0; c < dimension; ++c)
  {
    if (!std::isfinite(coordinates[c]))
    {
      return name + " is not finite";
    }
    if (std::abs(coordinates[c]) > LargestCoordinate)
    {
      text << name << " has the coordinate " << coordinates[c] << "; the limit is "
           << LargestCoordinate;
      return text.str();
    }
  }
  if (!(weight > 0.0) || !std::isfinite(weight))
  {
    text << name << " has the weight " << weight << "; weights must be positive and finite";
  }
  else if (weight > LargestWeight || weight < 1.0 / LargestWeight)
  {
    text << name << " has the weight " << weight << "; the limits are " << 1.0 / LargestWeight
         << " and " << LargestWeight;
  }
  return text.str();
}

/// True if CheckPoint finds nothing; quick, for the many good ones.
bool IsGoodPoint(const double* coordinates, int dimension, double weight)
{
  bool good = weight >= 1.0 / LargestWeight && weight <= LargestWeight;
  for (int c = 0; c < dimension; ++c)
  {
    good = good && std::abs(coordinates[c]) <= LargestCoordinate;
  }
  return good;
}

/// The reason why `points` (`dimension` coordinates and the weight each) can't be control points,
/// or "".
std::string CheckPackedPoints(const double* points, std::int64_t count, int dimension)
{
  for (std::int64_t i = 0; i < count; ++i)
  {
    const double* point = points + i * (dimension + 1);
    if (!IsGoodPoint(point, dimension, point[dimension]))
    {
      return CheckPoint(point, dimension, point[dimension], i);
    }
  }
  return std::string();
}

/// A curve's arrays, the same for trim curves and edges.
struct CurveArrays
{
  Integers Degree, KnotStart, PointStart, PointCount;
  Reals Knots, Points;
  const char* KnotsName;
  const char* PointsName;
};

/// Curve `i` of the arrays. Returns the reason why it is bad, or "" and the view.
template <int D>
std::string MakeCurve(const CurveArrays& a, std::int64_t i, CurveView<D>& curve)
{
  const std::int64_t degree = a.Degree[i];
  const std::int64_t count = a.PointCount[i];
  const std::int64_t points = static_cast<std::int64_t>(a.Points.size()) / (D + 1);
  const std::int64_t knots = static_cast<std::int64_t>(a.Knots.size());
  if (degree < 0 || degree > MaxDegree)
  {
    return "degree " + std::to_string(degree) + " is not between 0 and " +
      std::to_string(MaxDegree);
  }
  if (count <= degree)
  {
    return std::to_string(count) + " control points are too few for degree " +
      std::to_string(degree);
  }
  if (count > std::numeric_limits<int>::max() || !InRange(a.PointStart[i], count, points))
  {
    return RangeText(a.PointsName, a.PointStart[i], count, points);
  }
  if (!InRange(a.KnotStart[i], count + degree + 1, knots))
  {
    return RangeText(a.KnotsName, a.KnotStart[i], count + degree + 1, knots);
  }
  CurveView<D> view;
  view.Degree = static_cast<int>(degree);
  view.Count = static_cast<int>(count);
  view.Knots = KnotView(a.Knots.data() + a.KnotStart[i], count + degree + 1);
  view.Points = a.Points.data() + (D + 1) * a.PointStart[i];
  if (degree > 0)
  {
    const std::string reason = CheckKnots(view.Knots, view.Degree, count);
    if (!reason.empty())
    {
      return reason;
    }
  }
  else if (count != 1 || !std::isfinite(view.Knots[0]) || !std::isfinite(view.Knots[1]) ||
    view.Knots[0] > view.Knots[1])
  {
    return "a curve of degree 0 needs one point and two finite knots that do not decrease";
  }
  const std::string reason = CheckPackedPoints(view.Points, count, D);
  if (reason.empty())
  {
    curve = view;
  }
  return reason;
}

/// The reason why the net's control points or weights are bad, or "".
std::string CheckNet(const SurfaceView& s, std::int64_t pointCount)
{
  for (std::int64_t k = 0; k < s.Size(); ++k)
  {
    const std::int64_t id = s.Id(k);
    if (id < 0 || id >= pointCount)
    {
      return "control point " + std::to_string(k) + " refers to point " + std::to_string(id) +
        " of " + std::to_string(pointCount);
    }
    const double* p = s.Points + 3 * id;
    if (!IsGoodPoint(p, 3, s.Weight(k)))
    {
      return CheckPoint(p, 3, s.Weight(k), k);
    }
  }
  return std::string();
}

/// The reason why surface `i` is bad, or "" and the view.
std::string MakeSurface(const ModelArrays& a, std::int64_t i, SurfaceView& surface)
{
  SurfaceView s;
  std::int64_t needed = 1;
  const std::int64_t first = a.Offsets[i], last = a.Offsets[i + 1];
  if (first < 0 || last < first || last > Count(a.Connectivity))
  {
    return "the connectivity has " + std::to_string(Count(a.Connectivity)) +
      " entries, but those from " + std::to_string(first) + " to " + std::to_string(last) +
      " are asked for";
  }
  const std::int64_t size = last - first;
  for (int dir = 0; dir < 2; ++dir)
  {
    const std::string name = dir == 0 ? " in u" : " in v";
    const std::int64_t degree = a.Degree[2 * i + dir];
    const std::int64_t count = a.NetSize[2 * i + dir];
    const std::int64_t start = a.KnotStart[2 * i + dir];
    if (degree < 1 || degree > MaxDegree)
    {
      return "degree " + std::to_string(degree) + name + " is not between 1 and " +
        std::to_string(MaxDegree);
    }
    if (count <= degree || count > std::numeric_limits<int>::max())
    {
      return "a net of " + std::to_string(count) + " control points" + name +
        " does not suit degree " + std::to_string(degree);
    }
    if (!InRange(start, count + degree + 1, static_cast<std::int64_t>(a.Knots.size())))
    {
      return RangeText("Knots", start, count + degree + 1, a.Knots.size()) + name;
    }
    s.Degree[dir] = static_cast<int>(degree);
    s.Count[dir] = static_cast<int>(count);
    s.Knots[dir] = KnotView(a.Knots.data() + start, count + degree + 1);
    const std::string reason = CheckKnots(s.Knots[dir], s.Degree[dir], count);
    if (!reason.empty())
    {
      return reason + name;
    }
    needed *= count;
  }
  if (needed != size)
  {
    return "the net is " + std::to_string(s.Count[0]) + " x " + std::to_string(s.Count[1]) +
      ", but the cell has " + std::to_string(size) + " points";
  }
  s.Points = a.Points.data();
  s.Weights = a.Weights.empty() ? nullptr : a.Weights.data();
  s.Ids = a.Connectivity.data() + first;
  const std::string reason = CheckNet(s, static_cast<std::int64_t>(a.Points.size()) / 3);
  if (reason.empty())
  {
    surface = s;
  }
  return reason;
}

/// Collects the sizes that disagree with `expected`.
struct SizeCheck
{
  std::int64_t Expected;
  std::string Reason;
  void Expect(const char* name, std::size_t size, int components, bool optional = false)
  {
    const std::int64_t wanted = this->Expected * components;
    if (this->Reason.empty() && static_cast<std::int64_t>(size) != wanted &&
      !(optional && size == 0))
    {
      this->Reason = std::string(name) + " has " + std::to_string(size) + " values instead of " +
        std::to_string(wanted);
    }
  }
};

std::string CheckFaceSizes(const ModelArrays& a)
{
  SizeCheck check{ a.FaceCount(), "" };
  check.Expect("Degree", a.Degree.size(), 2);
  check.Expect("NetSize", a.NetSize.size(), 2);
  check.Expect("KnotStart", a.KnotStart.size(), 2);
  check.Expect("LoopCount", a.LoopCount.size(), 1, true);
  check.Expect("LoopStart", a.LoopStart.size(), 1, a.LoopCount.empty());
  check.Expect("FaceId", a.FaceId.size(), 1, true);
  check.Expect("Orientation", a.Orientation.size(), 1, true);
  if (check.Reason.empty() && !a.Weights.empty() && 3 * a.Weights.size() != a.Points.size())
  {
    check.Reason = "RationalWeights has " + std::to_string(a.Weights.size()) + " values for " +
      std::to_string(a.Points.size() / 3) + " points";
  }
  return check.Reason;
}

std::string CheckTrimSizes(const ModelArrays& a)
{
  SizeCheck loops{ Count(a.LoopCurveStart), "" };
  loops.Expect("LoopCurveCount", a.LoopCurveCount.size(), 1);
  SizeCheck curves{ Count(a.TrimCurveDegree), "" };
  curves.Expect("TrimCurveKnotStart", a.TrimCurveKnotStart.size(), 1);
  curves.Expect("TrimCurvePointStart", a.TrimCurvePointStart.size(), 1);
  curves.Expect("TrimCurvePointCount", a.TrimCurvePointCount.size(), 1);
  curves.Expect("TrimCurveEdgeId", a.TrimCurveEdgeId.size(), 1, true);
  curves.Expect("TrimCurveReversed", a.TrimCurveReversed.size(), 1, true);
  return loops.Reason.empty() ? curves.Reason : loops.Reason;
}

std::string CheckEdgeSizes(const ModelArrays& a)
{
  SizeCheck check{ Count(a.EdgeDegree), "" };
  check.Expect("EdgeKnotStart", a.EdgeKnotStart.size(), 1);
  check.Expect("EdgePointStart", a.EdgePointStart.size(), 1);
  check.Expect("EdgePointCount", a.EdgePointCount.size(), 1);
  check.Expect("EdgeTolerance", a.EdgeTolerance.size(), 1, true);
  check.Expect("EdgeVertices", a.EdgeVertices.size(), 2, true);
  return check.Reason;
}

} // namespace

std::int64_t ModelArrays::FaceCount() const
{
  return this->Offsets.empty() ? 0 : Count(this->Offsets) - 1;
}

namespace
{

/// The steps of AssembleModel; one object a call.
class Assembler
{
public:
  Assembler(const ModelArrays& arrays, const AssembleOptions& options, const ParallelFor& parallel)
    : A(arrays)
    , Options(options)
    , Parallel(parallel)
  {}

  AssembledModel Run();

private:
  void Warn(std::int64_t face, const std::string& reason)
  {
    this->Result.Problems.push_back({ ModelProblem::Level::Warning, face, reason });
  }
  void Fail(const std::string& reason)
  {
    this->Result.Problems.push_back({ ModelProblem::Level::Error, -1, reason });
  }
  void AddVertices();
  void AddEdges();
  void AddEdge(std::int64_t i);
  void AddTrims();
  void AddFaces();
  void AddFace(std::int64_t i);
  void TrimFace(std::int64_t i);
  std::string FaceLoopsReason(std::int64_t i) const;

  const ModelArrays& A;
  const AssembleOptions& Options;
  const ParallelFor& Parallel;
  AssembledModel Result;
  std::string TrimReason;                ///< Why no face can be trimmed, or "".
  std::vector<std::string> CurveReasons; ///< Why a trim curve is bad, or "".
  std::vector<std::vector<std::string>> EdgeWarnings, FaceWarnings;
};

void Assembler::AddVertices()
{
  if (this->A.VertexPoints.size() % 3 != 0)
  {
    this->Fail("VertexPoints does not have 3 components");
    return;
  }
  auto& vertices = this->Result.Model.Vertices;
  vertices.resize(this->A.VertexPoints.size() / 3);
  for (std::size_t i = 0; i < vertices.size(); ++i)
  {
    vertices[i] = Eigen::Map<const Vec3>(this->A.VertexPoints.data() + 3 * i);
  }
}

void Assembler::AddEdge(std::int64_t i)
{
  Edge edge;
  const auto warn = [&](const std::string& reason) {
    this->EdgeWarnings[i].push_back("edge " + std::to_string(i) + ": " + reason);
  };
  if (this->A.EdgePointCount[i] != 0)
  {
    const CurveArrays arrays{ this->A.EdgeDegree, this->A.EdgeKnotStart, this->A.EdgePointStart,
      this->A.EdgePointCount, this->A.EdgeKnots, this->A.EdgePoints, "EdgeKnots", "EdgePoints" };
    const std::string reason = MakeCurve<3>(arrays, i, edge.Geometry);
    if (!reason.empty())
    {
      warn(reason + "; its curve is ignored");
    }
  }
  if (!this->A.EdgeTolerance.empty())
  {
    edge.Tolerance = this->A.EdgeTolerance[i];
    if (!std::isfinite(edge.Tolerance) || edge.Tolerance < 0.0)
    {
      warn("its tolerance is negative or not finite; 0 is used");
      edge.Tolerance = 0.0;
    }
  }
  const auto& vertices = this->Result.Model.Vertices;
  for (int end = 0; end < 2 && !this->A.EdgeVertices.empty(); ++end)
  {
    const std::int64_t vertex = this->A.EdgeVertices[2 * i + end];
    const bool known = vertex >= 0 && vertex < static_cast<std::int64_t>(vertices.size());
    if (known && vertices[vertex].allFinite())
    {
      edge.Vertex[end] = vertex;
    }
    else if (vertex != -1)
    {
      warn("vertex " + std::to_string(vertex) + (known ? " is not finite" : " does not exist") +
        "; it is ignored");
    }
  }
  this->Result.Model.Edges[i] = edge;
}

void Assembler::AddEdges()
{
  const std::string reason = CheckEdgeSizes(this->A);
  if (!reason.empty())
  {
    this->Fail("edges can't be used: " + reason);
    return;
  }
  this->Result.Model.Edges.resize(this->A.EdgeDegree.size());
  this->EdgeWarnings.resize(this->A.EdgeDegree.size());
  this->Parallel(0, Count(this->A.EdgeDegree), [this](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i)
    {
      this->AddEdge(i);
    }
  });
  for (const std::vector<std::string>& warnings : this->EdgeWarnings)
  {
    for (const std::string& warning : warnings)
    {
      this->Warn(-1, warning);
    }
  }
}

void Assembler::AddTrims()
{
  this->TrimReason = CheckTrimSizes(this->A);
  if (!this->TrimReason.empty())
  {
    this->Fail("trimming loops can't be used: " + this->TrimReason);
    return;
  }
  Model& model = this->Result.Model;
  model.Loops.resize(this->A.LoopCurveStart.size());
  for (std::size_t i = 0; i < model.Loops.size(); ++i)
  {
    model.Loops[i] = { this->A.LoopCurveStart[i], this->A.LoopCurveCount[i] };
  }
  const CurveArrays arrays{ this->A.TrimCurveDegree, this->A.TrimCurveKnotStart,
    this->A.TrimCurvePointStart, this->A.TrimCurvePointCount, this->A.TrimKnots, this->A.TrimPoints,
    "TrimKnots", "TrimPoints" };
  const std::int64_t count = Count(this->A.TrimCurveDegree);
  const std::int64_t edges = static_cast<std::int64_t>(model.Edges.size());
  model.TrimCurves.resize(count);
  this->CurveReasons.resize(count);
  this->Parallel(0, count, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i)
    {
      TrimCurve& curve = model.TrimCurves[i];
      std::string& reason = this->CurveReasons[i];
      reason = this->A.TrimCurveDegree[i] == 0 ? "degree 0 is not between 1 and 25"
                                               : MakeCurve<2>(arrays, i, curve.Geometry);
      curve.Edge = this->A.TrimCurveEdgeId.empty() ? -1 : this->A.TrimCurveEdgeId[i];
      curve.Reversed = !this->A.TrimCurveReversed.empty() && this->A.TrimCurveReversed[i] != 0;
      if (reason.empty() && (curve.Edge < -1 || curve.Edge >= edges))
      {
        reason = "edge " + std::to_string(curve.Edge) + " does not exist";
      }
      if (!reason.empty())
      {
        curve = TrimCurve();
      }
    }
  });
}

std::string Assembler::FaceLoopsReason(std::int64_t i) const
{
  const Model& model = this->Result.Model;
  const std::int64_t first = this->A.LoopStart[i];
  const std::int64_t count = this->A.LoopCount[i];
  if (!this->TrimReason.empty())
  {
    return "its trimming loops can't be used: " + this->TrimReason;
  }
  if (!InRange(first, count, model.Loops.size()))
  {
    return RangeText("LoopCurveStart", first, count, model.Loops.size());
  }
  std::int64_t curves = 0;
  for (std::int64_t l = first; l < first + count; ++l)
  {
    const TrimLoop& loop = model.Loops[l];
    const std::string name = "loop " + std::to_string(l - first) + ": ";
    if (!InRange(loop.FirstCurve, loop.CurveCount, model.TrimCurves.size()))
    {
      return name +
        RangeText("TrimCurveDegree", loop.FirstCurve, loop.CurveCount, model.TrimCurves.size());
    }
    if (loop.CurveCount == 0)
    {
      return name + "it has no trim curve";
    }
    curves += loop.CurveCount; // Loops that overlap could take quadratic time.
    if (curves > static_cast<std::int64_t>(model.TrimCurves.size()))
    {
      return name + "the loops up to this one use more trim curves than there are";
    }
    for (std::int64_t c = 0; c < loop.CurveCount; ++c)
    {
      const std::string& reason = this->CurveReasons[loop.FirstCurve + c];
      if (!reason.empty())
      {
        return name + "trim curve " + std::to_string(c) + ": " + reason;
      }
    }
  }
  return std::string();
}

void Assembler::TrimFace(std::int64_t i)
{
  Face& face = this->Result.Model.Faces[i];
  std::string& reason = this->Result.FaceErrors[i];
  if (this->A.LoopCount.empty() || this->A.LoopCount[i] == 0)
  {
    return;
  }
  reason = this->FaceLoopsReason(i);
  if (reason.empty())
  {
    face.FirstLoop = this->A.LoopStart[i];
    face.LoopCount = this->A.LoopCount[i];
    if (this->Options.CheckLoops)
    {
      reason = CheckLoops(this->Result.Model, face, this->Options.GapLimit, this->FaceWarnings[i]);
    }
  }
  if (!reason.empty())
  {
    face.Geometry = SurfaceView();
    face.FirstLoop = face.LoopCount = 0;
  }
}

void Assembler::AddFace(std::int64_t i)
{
  Face& face = this->Result.Model.Faces[i];
  face.FaceId = this->A.FaceId.empty() ? i : this->A.FaceId[i];
  std::string& reason = this->Result.FaceErrors[i];
  reason = MakeSurface(this->A, i, face.Geometry);
  const std::int64_t orientation = this->A.Orientation.empty() ? 1 : this->A.Orientation[i];
  face.Reversed = orientation < 0;
  if (orientation != 1 && orientation != -1)
  {
    this->FaceWarnings[i].push_back(
      "Orientation is " + std::to_string(orientation) + " instead of 1 or -1; its sign is used");
  }
  if (reason.empty())
  {
    this->TrimFace(i);
  }
}

void Assembler::AddFaces()
{
  const std::int64_t count = this->A.FaceCount();
  this->Result.Model.Faces.resize(count);
  this->Result.FaceErrors.resize(count);
  this->FaceWarnings.resize(count);
  const std::string reason = CheckFaceSizes(this->A);
  if (!reason.empty())
  {
    this->Fail(reason);
    this->Result.FaceErrors.assign(count, reason);
    return;
  }
  this->Parallel(0, count, [this](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i)
    {
      this->AddFace(i);
    }
  });
}

AssembledModel Assembler::Run()
{
  this->AddVertices();
  this->AddEdges();
  this->AddTrims();
  this->AddFaces();
  for (std::size_t i = 0; i < this->FaceWarnings.size(); ++i)
  {
    for (const std::string& warning : this->FaceWarnings[i])
    {
      this->Warn(i, warning);
    }
    if (!this->Result.FaceErrors[i].empty())
    {
      this->Result.Problems.push_back(
        { ModelProblem::Level::Error, static_cast<std::int64_t>(i), this->Result.FaceErrors[i] });
    }
  }
  if (this->Options.CheckEdges)
  {
    ReleaseMovedEdges(this->Result, this->Options.Around, this->Parallel);
  }
  return std::move(this->Result);
}

} // namespace

AssembledModel AssembleModel(
  const ModelArrays& arrays, const AssembleOptions& options, const ParallelFor& parallel)
{
  return Assembler(arrays, options, parallel).Run();
}

} // namespace nurbs
