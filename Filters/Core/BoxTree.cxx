// SPDX-License-Identifier: BSD-3-Clause
#include "BoxTree.h"

#include <limits>
#include <numeric>

namespace nurbs
{

namespace
{

double HalfArea(const Box3& box)
{
  const Vec3 d = box.sizes();
  return d[0] * d[1] + d[1] * d[2] + d[2] * d[0];
}

/// The float at or beyond x in the direction of `limit`.
float RoundOutwards(double x, float limit)
{
  const float f = static_cast<float>(x);
  const bool inside = limit < 0.0f ? f > x : f < x;
  return inside ? std::nextafter(f, limit) : f;
}

} // namespace

struct BoxTree::Builder
{
  const std::vector<Box3>& Boxes;
  std::vector<Vec3> Middles;
  std::vector<std::int32_t> Order;
  std::vector<Node>& Nodes;
  double Margin;

  static constexpr int Bins = 16;

  Box3 BoundsOf(std::int64_t first, std::int64_t last) const
  {
    Box3 box;
    for (std::int64_t i = first; i < last; ++i)
    {
      box.extend(this->Boxes[this->Order[i]]);
    }
    return box;
  }

  /// Where to cut [first, last), which is put in order; depth limits how uneven the halves may be.
  std::int64_t Partition(std::int64_t first, std::int64_t last, int depth)
  {
    Box3 middles;
    for (std::int64_t i = first; i < last; ++i)
    {
      middles.extend(this->Middles[this->Order[i]]);
    }
    int axis = 0;
    const double width = middles.sizes().maxCoeff(&axis);
    const auto start = this->Order.begin();
    if (width > 0.0 && depth < MaxDepth / 2)
    {
      const auto bin = [&](std::int32_t box) {
        const double x = (this->Middles[box][axis] - middles.min()[axis]) / width;
        return std::min(Bins - 1, static_cast<int>(Bins * x));
      };
      const int cut = this->BestCut(first, last, bin);
      const auto second = std::partition(
        start + first, start + last, [&](std::int32_t box) { return bin(box) < cut; });
      return second - start;
    }
    const std::int64_t middle = (first + last) / 2;
    std::nth_element(
      start + first, start + middle, start + last, [&](std::int32_t a, std::int32_t b) {
        return this->Middles[a][axis] < this->Middles[b][axis];
      });
    return middle;
  }

  /// The bin before which the sum of areas times counts is least; both sides have boxes.
  template <typename Bin>
  int BestCut(std::int64_t first, std::int64_t last, const Bin& bin) const
  {
    Box3 boxes[Bins];
    std::int64_t counts[Bins] = {};
    for (std::int64_t i = first; i < last; ++i)
    {
      const int k = bin(this->Order[i]);
      boxes[k].extend(this->Boxes[this->Order[i]]);
      ++counts[k];
    }
    double above[Bins];
    Box3 box;
    std::int64_t count = 0;
    for (int k = Bins - 1; k > 0; --k)
    {
      box.extend(boxes[k]);
      count += counts[k];
      above[k] = count > 0 ? static_cast<double>(count) * HalfArea(box) : 0.0;
    }
    box.setEmpty();
    count = 0;
    int best = 1;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 1; k < Bins; ++k)
    {
      box.extend(boxes[k - 1]);
      count += counts[k - 1];
      const double cost = static_cast<double>(count) * HalfArea(box) + above[k];
      if (count > 0 && count < last - first && cost < least)
      {
        best = k;
        least = cost;
      }
    }
    return best;
  }

  void Store(std::size_t node, int child, const Box3& box)
  {
    const float infinity = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis)
    {
      auto& bounds = this->Nodes[node].Bounds[child];
      bounds[0][axis] = RoundOutwards(box.min()[axis] - this->Margin, -infinity);
      bounds[1][axis] = RoundOutwards(box.max()[axis] + this->Margin, infinity);
    }
  }

  /// The subtree of [first, last), as a Node::Child.
  std::int32_t Build(std::int64_t first, std::int64_t last, int depth)
  {
    if (last - first == 1)
    {
      return ~this->Order[first];
    }
    const std::size_t node = this->Nodes.size();
    this->Nodes.emplace_back();
    const std::int64_t middle = this->Partition(first, last, depth);
    this->Store(node, 0, this->BoundsOf(first, middle));
    this->Store(node, 1, this->BoundsOf(middle, last));
    this->Nodes[node].Child[0] = this->Build(first, middle, depth + 1);
    this->Nodes[node].Child[1] = this->Build(middle, last, depth + 1);
    return static_cast<std::int32_t>(node);
  }
};

void BoxTree::Build(const std::vector<Box3>& boxes, double margin)
{
  this->Nodes.clear();
  this->Count = static_cast<std::int64_t>(boxes.size());
  if (boxes.size() >= std::size_t(std::numeric_limits<std::int32_t>::max()))
  {
    throw Error("BoxTree: more than 2^31 boxes");
  }
  this->Nodes.reserve(boxes.size());
  Builder builder{ boxes, {}, std::vector<std::int32_t>(boxes.size()), this->Nodes, margin };
  builder.Middles.reserve(boxes.size());
  for (const Box3& box : boxes)
  {
    builder.Middles.push_back(box.center());
  }
  std::iota(builder.Order.begin(), builder.Order.end(), 0);
  if (boxes.size() == 1)
  {
    this->Nodes.emplace_back();
    builder.Store(0, 0, boxes[0]);
    const float infinity = std::numeric_limits<float>::infinity();
    std::fill_n(this->Nodes[0].Bounds[1][0], 3, infinity);
    std::fill_n(this->Nodes[0].Bounds[1][1], 3, -infinity);
    this->Nodes[0].Child[0] = ~0;
    this->Nodes[0].Child[1] = ~0;
  }
  else if (!boxes.empty())
  {
    builder.Build(0, this->Count, 0);
  }
}

} // namespace nurbs
