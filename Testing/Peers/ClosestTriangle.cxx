// SPDX-License-Identifier: BSD-3-Clause
#include "ClosestTriangle.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <numeric>

namespace verify
{

namespace
{

double BoxDistance2(const Vec3& p, const Vec3& low, const Vec3& high)
{
  return (low - p).cwiseMax(p - high).cwiseMax(0.0).squaredNorm();
}

} // namespace

Vec3 NearestWeights(const Vec3& p, const std::array<Vec3, 3>& c)
{
  const Vec3 ab = c[1] - c[0], ac = c[2] - c[0], ap = p - c[0];
  const Vec3 n = ab.cross(ac);
  const double n2 = n.squaredNorm();
  const double longest2 = std::max({ ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm() });
  if (n2 > 1e-24 * longest2 * longest2)
  {
    const double v = ap.cross(ac).dot(n) / n2, w = ab.cross(ap).dot(n) / n2;
    if (v >= 0.0 && w >= 0.0 && v + w <= 1.0)
    {
      return { 1.0 - v - w, v, w };
    }
  }
  Vec3 best = Vec3::UnitX();
  double best2 = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k)
  {
    const Vec3& a = c[std::size_t(k)];
    const Vec3 d = c[std::size_t((k + 1) % 3)] - a;
    const double length2 = d.squaredNorm();
    const double t = length2 > 0.0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0.0;
    const double d2 = (a + t * d - p).squaredNorm();
    if (d2 < best2)
    {
      best2 = d2;
      best.setZero();
      best[k] = 1.0 - t;
      best[(k + 1) % 3] = t;
    }
  }
  return best;
}

void ClosestTriangle::Build(
  const std::vector<Vec3>& points, const std::vector<std::array<int, 3>>& triangles)
{
  const int count = int(triangles.size());
  this->Nodes.clear();
  this->Corners.clear();
  this->Order.resize(triangles.size());
  std::iota(this->Order.begin(), this->Order.end(), 0);
  std::vector<Vec3> centres;
  for (const auto& t : triangles)
  {
    this->Corners.push_back(
      { points[std::size_t(t[0])], points[std::size_t(t[1])], points[std::size_t(t[2])] });
    const auto& c = this->Corners.back();
    centres.push_back((c[0] + c[1] + c[2]) / 3.0);
  }
  if (count > 0)
  {
    this->Nodes.emplace_back();
    this->Split(0, 0, count, centres);
  }
}

void ClosestTriangle::Split(int node, int first, int count, std::vector<Vec3>& centres)
{
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  Vec3 centreLow = low, centreHigh = high;
  for (int i = first; i < first + count; ++i)
  {
    const auto index = std::size_t(this->Order[std::size_t(i)]);
    for (const Vec3& c : this->Corners[index])
    {
      low = low.cwiseMin(c);
      high = high.cwiseMax(c);
    }
    centreLow = centreLow.cwiseMin(centres[index]);
    centreHigh = centreHigh.cwiseMax(centres[index]);
  }
  this->Nodes[std::size_t(node)].Low = low;
  this->Nodes[std::size_t(node)].High = high;
  if (count <= 4)
  {
    this->Nodes[std::size_t(node)].First = first;
    this->Nodes[std::size_t(node)].Count = count;
    return;
  }
  int axis = 0;
  (centreHigh - centreLow).maxCoeff(&axis);
  const int half = count / 2;
  const auto begin = this->Order.begin() + first;
  std::nth_element(begin, begin + half, begin + count,
    [&](int a, int b) { return centres[std::size_t(a)][axis] < centres[std::size_t(b)][axis]; });
  const int child = int(this->Nodes.size());
  this->Nodes[std::size_t(node)].First = child;
  this->Nodes.resize(this->Nodes.size() + 2);
  this->Split(child, first, half, centres);
  this->Split(child + 1, first + half, count - half, centres);
}

ClosestTriangle::Hit ClosestTriangle::Find(const Vec3& p, double bound) const
{
  Hit hit;
  double best2 = bound * bound;
  if (this->Nodes.empty())
  {
    return hit;
  }
  std::array<std::pair<int, double>, 128> stack;
  int top = 0;
  stack[std::size_t(top++)] = { 0, BoxDistance2(p, this->Nodes[0].Low, this->Nodes[0].High) };
  while (top > 0)
  {
    const auto [index, reach2] = stack[std::size_t(--top)];
    if (reach2 >= best2)
    {
      continue;
    }
    const Node& node = this->Nodes[std::size_t(index)];
    for (int i = node.First; i < node.First + node.Count; ++i)
    {
      const int t = this->Order[std::size_t(i)];
      const auto& c = this->Corners[std::size_t(t)];
      const Vec3 w = NearestWeights(p, c);
      const double d2 = (w[0] * c[0] + w[1] * c[1] + w[2] * c[2] - p).squaredNorm();
      if (d2 < best2)
      {
        best2 = d2;
        hit = { std::sqrt(d2), t, w };
      }
    }
    if (node.Count == 0)
    {
      const Node& a = this->Nodes[std::size_t(node.First)];
      const Node& b = this->Nodes[std::size_t(node.First) + 1];
      std::pair<int, double> near{ node.First, BoxDistance2(p, a.Low, a.High) };
      std::pair<int, double> far{ node.First + 1, BoxDistance2(p, b.Low, b.High) };
      if (far.second < near.second)
      {
        std::swap(near, far);
      }
      stack[std::size_t(top++)] = far;
      stack[std::size_t(top++)] = near;
    }
  }
  return hit;
}

} // namespace verify
