// SPDX-License-Identifier: BSD-3-Clause
#include "MeshSlots.h"

#include <algorithm>

namespace nurbs
{

namespace
{
constexpr double LargestFreeShare = 0.05; // Of the points' places.
} // namespace

void MeshVectors::Resize(std::int64_t points, std::int64_t triangles)
{
  this->Xyz.resize(3 * points);
  this->Directions.resize(3 * points);
  this->Parameters.resize(2 * points);
  this->Indices.resize(3 * triangles);
  this->Owners.resize(triangles);
  this->PointCount = points;
  this->TriangleCount = triangles;
  this->Points = this->Xyz.data();
  this->Normals = this->Directions.data();
  this->UV = this->Parameters.data();
  this->Corners = this->Indices.data();
  this->Faces = this->Owners.data();
}

MeshSlots::MeshSlots(MeshArrays& arrays, std::function<std::int32_t&(const TriangleOwner&)> heads)
  : Data(arrays)
  , Head(std::move(heads))
{
  this->Data.Resize(0, 0);
}

std::int32_t MeshSlots::AddPoint(const PointUse& use, const Vec2& uv)
{
  std::int32_t point;
  if (!this->FreePoints.empty())
  {
    point = this->FreePoints.back();
    this->FreePoints.pop_back();
    this->Uses[point] = use;
  }
  else
  {
    point = std::int32_t(this->Uses.size());
    this->Uses.push_back(use);
    this->Reserve(point + 1, this->TriangleEnd);
  }
  this->Data.UV[2 * std::int64_t(point)] = uv[0];
  this->Data.UV[2 * std::int64_t(point) + 1] = uv[1];
  this->Changed.Topology = true;
  ++this->Changed.Inserted;
  this->Changed.Added.push_back(point);
  return point;
}

void MeshSlots::RemovePoint(std::int32_t point)
{
  this->Uses[point] = PointUse();
  this->FreePoints.push_back(point);
  this->Changed.Topology = true;
  ++this->Changed.Deleted;
}

// Grows the arrays by steps that double while a frame adds to them; FillGaps cuts them to size.
void MeshSlots::Reserve(std::int64_t points, std::int64_t triangles)
{
  const bool morePoints = points > this->Data.PointCount;
  const bool moreTriangles = triangles > this->Data.TriangleCount;
  if (morePoints || moreTriangles)
  {
    this->Step *= 2;
    this->Data.Resize(morePoints ? points + this->Step : this->Data.PointCount,
      moreTriangles ? triangles + this->Step : this->Data.TriangleCount);
  }
}

void MeshSlots::Fit(std::int64_t points)
{
  this->Step = SmallestStep;
  if (points != this->Data.PointCount || this->TriangleEnd != this->Data.TriangleCount)
  {
    this->Data.Resize(points, this->TriangleEnd);
  }
}

void MeshSlots::Touch(std::int64_t triangle)
{
  this->Changed.Topology = true;
  if (this->Changed.FirstTriangle < 0)
  {
    this->Changed.FirstTriangle = this->Changed.LastTriangle = triangle;
  }
  this->Changed.FirstTriangle = std::min(this->Changed.FirstTriangle, triangle);
  this->Changed.LastTriangle = std::max(this->Changed.LastTriangle, triangle);
}

void MeshSlots::Link(std::int32_t triangle, const TriangleOwner& owner)
{
  std::int32_t& head = this->Head(owner);
  this->Owners[triangle] = owner;
  this->Previous[triangle] = -1;
  this->Next[triangle] = head;
  if (head >= 0)
  {
    this->Previous[head] = triangle;
  }
  head = triangle;
}

void MeshSlots::Unlink(std::int32_t triangle)
{
  const std::int32_t before = this->Previous[triangle];
  const std::int32_t after = this->Next[triangle];
  (before >= 0 ? this->Next[before] : this->Head(this->Owners[triangle])) = after;
  if (after >= 0)
  {
    this->Previous[after] = before;
  }
}

void MeshSlots::AddTriangle(
  const TriangleOwner& owner, std::int32_t a, std::int32_t b, std::int32_t c)
{
  std::int32_t triangle;
  if (!this->FreeTriangles.empty())
  {
    triangle = this->FreeTriangles.back();
    this->FreeTriangles.pop_back();
  }
  else
  {
    triangle = std::int32_t(this->TriangleEnd++);
    this->Owners.resize(this->TriangleEnd);
    this->Next.resize(this->TriangleEnd);
    this->Previous.resize(this->TriangleEnd);
    this->Reserve(this->Data.PointCount, this->TriangleEnd);
  }
  this->Link(triangle, owner);
  std::int64_t* corners = this->Data.Corners + 3 * std::int64_t(triangle);
  corners[0] = a;
  corners[1] = b;
  corners[2] = c;
  this->Data.Faces[triangle] = owner.Face;
  this->Touch(triangle);
}

void MeshSlots::RemoveTriangles(const TriangleOwner& owner)
{
  std::int32_t& head = this->Head(owner);
  for (std::int32_t t = head; t >= 0; t = this->Next[t])
  {
    this->Owners[t] = TriangleOwner();
    this->FreeTriangles.push_back(t);
    this->Changed.Topology = true;
  }
  head = -1;
}

void MeshSlots::FillGaps()
{
  std::sort(this->FreeTriangles.begin(), this->FreeTriangles.end());
  std::size_t first = 0;
  while (first < this->FreeTriangles.size())
  {
    const std::int32_t last = std::int32_t(this->TriangleEnd) - 1;
    --this->TriangleEnd;
    if (this->FreeTriangles.back() == last)
    {
      this->FreeTriangles.pop_back();
      continue;
    }
    const std::int32_t gap = this->FreeTriangles[first++];
    const TriangleOwner owner = this->Owners[last];
    this->Unlink(last);
    this->Link(gap, owner);
    std::copy_n(
      this->Data.Corners + 3 * std::int64_t(last), 3, this->Data.Corners + 3 * std::int64_t(gap));
    this->Data.Faces[gap] = this->Data.Faces[last];
    this->Touch(gap);
  }
  this->FreeTriangles.clear();
  // Points at the end that nothing uses.
  std::int64_t end = std::int64_t(this->Uses.size());
  while (end > 0 && this->Uses[end - 1].Face < 0)
  {
    --end;
  }
  if (end < std::int64_t(this->Uses.size()))
  {
    this->Uses.resize(end);
    this->FreePoints.erase(std::remove_if(this->FreePoints.begin(), this->FreePoints.end(),
                             [&](std::int32_t point) { return point >= end; }),
      this->FreePoints.end());
  }
  this->Owners.resize(this->TriangleEnd);
  this->Next.resize(this->TriangleEnd);
  this->Previous.resize(this->TriangleEnd);
  this->Fit(end);
  if (this->Changed.LastTriangle >= this->TriangleEnd)
  {
    this->Changed.LastTriangle = this->TriangleEnd - 1;
    if (this->Changed.FirstTriangle > this->Changed.LastTriangle)
    {
      this->Changed.FirstTriangle = this->Changed.LastTriangle = -1;
    }
  }
}

void MeshSlots::HideGaps()
{
  if (this->FreePoints.empty() || this->Uses.empty())
  {
    return;
  }
  const std::int64_t used = std::int64_t(this->Uses.size()) - 1; // FillGaps leaves a used one last.
  for (const std::int32_t point : this->FreePoints)
  {
    std::copy_n(this->Data.Points + 3 * used, 3, this->Data.Points + 3 * std::int64_t(point));
    std::copy_n(this->Data.Normals + 3 * used, 3, this->Data.Normals + 3 * std::int64_t(point));
    std::copy_n(this->Data.UV + 2 * used, 2, this->Data.UV + 2 * std::int64_t(point));
  }
}

bool MeshSlots::IsSparse() const
{
  return double(this->FreePoints.size()) > LargestFreeShare * double(this->Uses.size());
}

std::vector<std::int32_t> MeshSlots::Compact()
{
  std::vector<std::int32_t> place(this->Uses.size(), -1);
  std::int32_t count = 0;
  for (std::size_t point = 0; point < this->Uses.size(); ++point)
  {
    if (this->Uses[point].Face < 0)
    {
      continue;
    }
    place[point] = count;
    if (std::int32_t(point) != count)
    {
      const std::int64_t from = std::int64_t(point);
      std::copy_n(this->Data.Points + 3 * from, 3, this->Data.Points + 3 * std::int64_t(count));
      std::copy_n(this->Data.Normals + 3 * from, 3, this->Data.Normals + 3 * std::int64_t(count));
      std::copy_n(this->Data.UV + 2 * from, 2, this->Data.UV + 2 * std::int64_t(count));
      this->Uses[count] = this->Uses[point];
    }
    ++count;
  }
  this->Uses.resize(count);
  this->FreePoints.clear();
  for (std::int64_t k = 0; k < 3 * this->TriangleEnd; ++k)
  {
    this->Data.Corners[k] = place[this->Data.Corners[k]];
  }
  this->Fit(count);
  this->Changed.Topology = this->Changed.Renumbered = true;
  this->Changed.FirstTriangle = this->TriangleEnd > 0 ? 0 : -1;
  this->Changed.LastTriangle = this->TriangleEnd - 1;
  return place;
}

} // namespace nurbs
