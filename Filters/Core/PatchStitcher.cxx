// SPDX-License-Identifier: BSD-3-Clause
#include "PatchStitcher.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{
namespace
{

/// The bytes of the values, with one zero instead of two.
std::string Key(std::vector<double> values)
{
  for (double& value : values)
  {
    value += 0.0;
  }
  return std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
}

/// Everything that makes a curve, as numbers.
std::vector<double> Numbers(const Curve<3>& curve)
{
  std::vector<double> numbers{ static_cast<double>(curve.Degree) };
  numbers.insert(numbers.end(), curve.Knots.begin(), curve.Knots.end());
  for (std::size_t i = 0; i < curve.Points.size(); ++i)
  {
    numbers.insert(numbers.end(), curve.Points[i].data(), curve.Points[i].data() + 3);
    numbers.push_back(curve.Weights[i]);
  }
  return numbers;
}

/// The same curve from its end to its start, over the same domain.
Curve<3> Reverse(Curve<3> curve)
{
  const double sum = curve.Knots.front() + curve.Knots.back();
  std::reverse(curve.Points.begin(), curve.Points.end());
  std::reverse(curve.Weights.begin(), curve.Weights.end());
  std::reverse(curve.Knots.begin(), curve.Knots.end());
  for (double& knot : curve.Knots)
  {
    knot = sum - knot;
  }
  return curve;
}

/// Side 0: v = min, 1: u = max, 2: v = max, 3: u = min; runs to increasing u or v.
Curve<3> SideCurve(const Surface& surface, int side)
{
  const int dir = side % 2;
  const bool last = side == 1 || side == 2;
  Curve<3> curve;
  curve.Degree = surface.Degree[dir];
  curve.Knots = surface.Knots[dir];
  for (int k = 0; k < surface.Count[dir]; ++k)
  {
    const int i = dir == 0 ? k : (last ? surface.Count[0] - 1 : 0);
    const int j = dir == 1 ? k : (last ? surface.Count[1] - 1 : 0);
    const std::size_t id = i + static_cast<std::size_t>(j) * surface.Count[0];
    curve.Points.push_back(surface.Points[id]);
    curve.Weights.push_back(surface.Weights.empty() ? 1.0 : surface.Weights[id]);
  }
  curve.Pack();
  return curve;
}

bool IsPoint(const Curve<3>& curve)
{
  return std::all_of(curve.Points.begin(), curve.Points.end(),
    [&curve](const Vec3& point) { return point == curve.Points.front(); });
}

} // namespace

std::int64_t PatchStitcher::Vertex(const Vec3& position)
{
  const std::string key = Key({ position[0], position[1], position[2] });
  const auto found = this->Vertices.find(key);
  if (found != this->Vertices.end())
  {
    return found->second;
  }
  const std::int64_t vertex = this->Builder.AddVertex(position);
  this->Vertices.emplace(key, vertex);
  return vertex;
}

PatchStitcher::EdgeUse PatchStitcher::Edge(const Curve<3>& curve)
{
  const std::string key = Key(Numbers(curve));
  const auto found = this->Edges.find(key);
  if (found != this->Edges.end())
  {
    return { found->second, false };
  }
  const auto reversed = this->Edges.find(Key(Numbers(Reverse(curve))));
  if (reversed != this->Edges.end())
  {
    return { reversed->second, true };
  }
  const std::int64_t edge = this->Builder.AddEdge(curve.View(), this->Tolerance,
    this->Vertex(curve.Points.front()), this->Vertex(curve.Points.back()));
  this->Edges.emplace(key, edge);
  return { edge, false };
}

void PatchStitcher::AddSide(const Surface& surface, int side)
{
  const SurfaceView view = surface.View();
  const Interval u = view.Domain(0), v = view.Domain(1);
  const Interval range = side % 2 == 0 ? u : v;
  Vec2 start(side == 1 ? u.Max : u.Min, side == 2 ? v.Max : v.Min);
  Vec2 end = side % 2 == 0 ? Vec2(u.Max, start[1]) : Vec2(start[0], v.Max);
  const Curve<3> curve = SideCurve(surface, side);
  const bool backwards = side >= 2; // The loop runs against u at v = max, against v at u = min.
  if (IsPoint(curve))
  {
    const Vec3& pole = curve.Points.front();
    const std::int64_t edge =
      this->Builder.AddPole(pole, range, this->Tolerance, this->Vertex(pole));
    this->Builder.AddTrimCurve(TrimLine(start, end, range).View(), edge, backwards);
    return;
  }
  const EdgeUse use = this->Edge(curve);
  if (use.Flipped)
  {
    std::swap(start, end);
  }
  this->Builder.AddTrimCurve(
    TrimLine(start, end, range).View(), use.Edge, backwards != use.Flipped);
}

std::int64_t PatchStitcher::AddFace(const Surface& surface, const FaceAttributes& attributes)
{
  const std::int64_t face = this->Builder.BeginFace(surface.View(), attributes);
  this->Builder.BeginLoop();
  for (int side = 0; side < 4; ++side)
  {
    this->AddSide(surface, side);
  }
  return face;
}

Curve<2> TrimLine(const Vec2& a, const Vec2& b, Interval range)
{
  Curve<2> line;
  line.Degree = 1;
  line.Knots = { range.Min, range.Min, range.Max, range.Max };
  line.Points = { a, b };
  line.Weights = { 1.0, 1.0 };
  line.Pack();
  return line;
}

Curve<2> TrimCircle(const Vec2& center, double radius)
{
  constexpr int Signs[9][2] = { { 1, 0 }, { 1, 1 }, { 0, 1 }, { -1, 1 }, { -1, 0 }, { -1, -1 },
    { 0, -1 }, { 1, -1 }, { 1, 0 } };
  Curve<2> circle;
  circle.Degree = 2;
  circle.Knots = { 0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4 };
  for (int i = 0; i < 9; ++i)
  {
    circle.Points.push_back(center + radius * Vec2(Signs[i][0], Signs[i][1]));
    circle.Weights.push_back(i % 2 == 0 ? 1.0 : std::sqrt(0.5));
  }
  circle.Pack();
  return circle;
}

Curve<3> LiftCurve(const Curve<2>& curve, const Vec3& origin, const Vec3& ex, const Vec3& ey)
{
  Curve<3> lifted;
  lifted.Degree = curve.Degree;
  lifted.Knots = curve.Knots;
  lifted.Weights = curve.Weights;
  for (const Vec2& point : curve.Points)
  {
    lifted.Points.push_back(origin + point[0] * ex + point[1] * ey);
  }
  lifted.Pack();
  return lifted;
}

} // namespace nurbs
