// SPDX-License-Identifier: BSD-3-Clause
#include "HotPixelTree.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

bool PassesPixel(const GridLine& line, const GridPoint& p)
{
  const std::int64_t dx = line.End.X - line.Start.X;
  const std::int64_t dy = line.End.Y - line.Start.Y;
  if (p.X < line.Start.X || p.X > line.End.X || p.Y < std::min(line.Start.Y, line.End.Y) ||
    p.Y > std::max(line.Start.Y, line.End.Y))
  {
    return false;
  }
  // Within these bounds, a segment between pixels' centres passes a pixel if its straight line
  // does: if corners are on both sides, or if it touches the lower left corner, the only one that
  // belongs to the pixel (and does so with the edges at it). Twice the centre's distance is `side`.
  const std::int64_t side = 2 * Turn(line.Start, line.End, p);
  return std::abs(side) < std::abs(dx) + std::abs(dy) || side == dx - dy;
}

HotPixelTree::HotPixelTree(const std::vector<GridPoint>& pixels)
{
  this->Pixels.reserve(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i)
  {
    this->Pixels.push_back(
      { std::int32_t(pixels[i].X), std::int32_t(pixels[i].Y), std::int32_t(i) });
  }
  std::size_t nodes = 1;
  for (std::int64_t size = std::int64_t(pixels.size()); size > LeafSize; size = (size + 1) / 2)
  {
    nodes = 2 * nodes + 1;
  }
  this->Boxes.resize(nodes);
  if (!pixels.empty())
  {
    this->Build(0, 0, std::int64_t(pixels.size()));
  }
}

void HotPixelTree::Build(std::size_t node, std::int64_t begin, std::int64_t end)
{
  Box box{ this->Pixels[begin].X, this->Pixels[begin].Y, this->Pixels[begin].X,
    this->Pixels[begin].Y };
  for (std::int64_t i = begin + 1; i < end; ++i)
  {
    const Pixel& p = this->Pixels[i];
    box = { std::min(box.X0, p.X), std::min(box.Y0, p.Y), std::max(box.X1, p.X),
      std::max(box.Y1, p.Y) };
  }
  this->Boxes[node] = box;
  if (end - begin <= LeafSize)
  {
    return;
  }
  const bool wide = std::int64_t(box.X1) - box.X0 >= std::int64_t(box.Y1) - box.Y0;
  const std::int64_t middle = begin + (end - begin) / 2;
  std::nth_element(this->Pixels.begin() + begin, this->Pixels.begin() + middle,
    this->Pixels.begin() + end,
    [wide](const Pixel& a, const Pixel& b) { return wide ? a.X < b.X : a.Y < b.Y; });
  this->Build(2 * node + 1, begin, middle);
  this->Build(2 * node + 2, middle, end);
}

// If the line may pass pixels in a box; never no if it does.
bool HotPixelTree::IsMet(const GridLine& line, const Box& box)
{
  if (box.X1 < line.Start.X || box.X0 > line.End.X || box.Y1 < std::min(line.Start.Y, line.End.Y) ||
    box.Y0 > std::max(line.Start.Y, line.End.Y))
  {
    return false;
  }
  // All lengths doubled: the centre's distance against the extent of the box with its pixels.
  const std::int64_t dx = line.End.X - line.Start.X;
  const std::int64_t dy = line.End.Y - line.Start.Y;
  const std::int64_t x = std::int64_t(box.X0) + box.X1 - 2 * line.Start.X;
  const std::int64_t y = std::int64_t(box.Y0) + box.Y1 - 2 * line.Start.Y;
  return std::abs(dx * y - dy * x) <=
    dx * (std::int64_t(box.Y1) - box.Y0 + 1) + std::abs(dy) * (std::int64_t(box.X1) - box.X0 + 1);
}

void HotPixelTree::Find(const GridLine& line, std::vector<std::int32_t>& passed) const
{
  struct Range
  {
    std::size_t Node;
    std::int64_t Begin, End;
  };
  // The way of a straight line through pixels is monotone in x and in y.
  struct Place
  {
    std::int64_t Way;
    std::int32_t Index;
  };
  const std::int64_t up = line.End.Y < line.Start.Y ? -1 : 1;
  Range stack[64]; // ranges are halved: no more than 32 wait
  int waiting = 0;
  stack[waiting++] = { 0, 0, std::int64_t(this->Pixels.size()) };
  std::vector<Place> places;
  while (waiting > 0)
  {
    const Range r = stack[--waiting];
    if (r.Begin == r.End || !IsMet(line, this->Boxes[r.Node]))
    {
      continue;
    }
    if (r.End - r.Begin > LeafSize)
    {
      const std::int64_t middle = r.Begin + (r.End - r.Begin) / 2;
      stack[waiting++] = { 2 * r.Node + 1, r.Begin, middle };
      stack[waiting++] = { 2 * r.Node + 2, middle, r.End };
      continue;
    }
    for (std::int64_t i = r.Begin; i < r.End; ++i)
    {
      const Pixel& p = this->Pixels[i];
      if (PassesPixel(line, { p.X, p.Y }))
      {
        places.push_back({ p.X + up * p.Y, p.Index });
      }
    }
  }
  std::sort(
    places.begin(), places.end(), [](const Place& a, const Place& b) { return a.Way < b.Way; });
  for (const Place& place : places)
  {
    passed.push_back(place.Index);
  }
}

} // namespace nurbs
