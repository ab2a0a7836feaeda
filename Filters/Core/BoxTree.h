// SPDX-License-Identifier: BSD-3-Clause
/// @file BoxTree.h
/// @brief A binary tree of boxes that a ray walks through from near to far.
///
/// Built top down by the surface area heuristic in 16 bins (Wald, "On fast construction of
/// SAH-based bounding volume hierarchies", 2007); each leaf is one box. Boxes are kept as floats,
/// rounded outwards.
#pragma once

#include "Types.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

/// A ray as the slab test wants it.
struct BoxRay
{
  Vec3 Origin;
  Vec3 Inverse; ///< 1 / direction, finite: components that vanish are replaced by tiny ones.
  int Near[3];  ///< 1 where the direction is negative: the near slab is the upper one.

  /// The direction need not have unit length.
  BoxRay(const Vec3& origin, const Vec3& direction)
    : Origin(origin)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const double d = direction[axis];
      this->Inverse[axis] = 1.0 / (std::abs(d) < 1e-200 ? std::copysign(1e-200, d) : d);
      this->Near[axis] = this->Inverse[axis] < 0.0 ? 1 : 0;
    }
  }
};

/// A tree of boxes that rays and searches walk through.
class BoxTree
{
public:
  /// Builds the tree. Each box is first widened by `margin` on all sides (>= 0, a length), what
  /// covers the rounding of the slab test where a box is flat. Empty boxes are not allowed.
  void Build(const std::vector<Box3>& boxes, double margin);

  /// True if there are no boxes.
  bool IsEmpty() const { return this->Count == 0; }

  /// Calls `visit(box)` for every box that the ray meets between tMin and tMax, about from near to
  /// far. `visit` returns the new tMax (the old one, or less to cut the ray short), which it also
  /// finds in `tMax`.
  template <typename Visit>
  void Walk(const BoxRay& ray, double tMin, double& tMax, const Visit& visit) const;

  /// Calls `visit(box, bounds)` for every box, its bounds widened as they are kept, to which and to
  /// whose parents `meets(const Box3& bounds)` says yes, in no useful order.
  template <typename Meets, typename Visit>
  void Search(const Meets& meets, Visit&& visit) const;

  /// Bytes that the tree occupies.
  std::size_t MemoryUse() const { return this->Nodes.capacity() * sizeof(Node); }

private:
  /// Two children with their boxes. A child >= 0 is a node, one < 0 is the box ~child.
  struct Node
  {
    float Bounds[2][2][3]; ///< Child; lower or upper; axis.
    std::int32_t Child[2];
  };
  static constexpr int MaxDepth = 96;

  struct Builder;

  static bool IsMet(
    const Node& node, int child, const BoxRay& ray, double tMin, double tMax, double& entry)
  {
    const auto& bounds = node.Bounds[child];
    double near = tMin;
    double far = tMax;
    for (int axis = 0; axis < 3; ++axis)
    {
      const int side = ray.Near[axis];
      const double a = (bounds[side][axis] - ray.Origin[axis]) * ray.Inverse[axis];
      const double b = (bounds[1 - side][axis] - ray.Origin[axis]) * ray.Inverse[axis];
      near = a > near ? a : near;
      far = b < far ? b : far;
    }
    entry = near;
    return near <= far;
  }

  std::vector<Node>
    Nodes; ///< The first is the root; if there is one box: its second child is void.
  std::int64_t Count = 0;
};

template <typename Visit>
void BoxTree::Walk(const BoxRay& ray, double tMin, double& tMax, const Visit& visit) const
{
  struct Waiting
  {
    std::int32_t Child;
    double Entry;
  };
  Waiting stack[MaxDepth + 2];
  int size = 0;
  if (!this->IsEmpty())
  {
    stack[size++] = { 0, tMin };
  }
  while (size > 0)
  {
    const Waiting next = stack[--size];
    if (next.Entry > tMax)
    {
      continue;
    }
    if (next.Child < 0)
    {
      tMax = visit(~next.Child);
      continue;
    }
    const Node& node = this->Nodes[next.Child];
    double entry[2];
    const bool met[2] = { IsMet(node, 0, ray, tMin, tMax, entry[0]),
      IsMet(node, 1, ray, tMin, tMax, entry[1]) };
    const int first = met[1] && (!met[0] || entry[1] < entry[0]) ? 1 : 0;
    if (met[1 - first])
    {
      stack[size++] = { node.Child[1 - first], entry[1 - first] };
    }
    if (met[first])
    {
      stack[size++] = { node.Child[first], entry[first] };
    }
  }
}

template <typename Meets, typename Visit>
void BoxTree::Search(const Meets& meets, Visit&& visit) const
{
  std::vector<std::int32_t> stack;
  if (!this->IsEmpty())
  {
    stack.push_back(0);
  }
  while (!stack.empty())
  {
    const Node& node = this->Nodes[stack.back()];
    stack.pop_back();
    for (int c = 0; c < 2; ++c)
    {
      const auto& b = node.Bounds[c];
      const Box3 box(Vec3(b[0][0], b[0][1], b[0][2]), Vec3(b[1][0], b[1][1], b[1][2]));
      if (box.isEmpty() || !meets(box))
      {
        continue;
      }
      if (node.Child[c] >= 0)
      {
        stack.push_back(node.Child[c]);
      }
      else
      {
        visit(~node.Child[c], box);
      }
    }
  }
}

} // namespace nurbs
