// SPDX-License-Identifier: BSD-3-Clause
#include "VisibleParts.h"

#include "BoxTree.h"
#include "EdgeContour.h"
#include "UnionFind.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace nurbs
{

namespace
{

// What is in front by less than this may be the line's own surface, in pixels.
constexpr double DepthMargin = 8.0;
// Parts reach this far beyond where they are cut, in pixels.
constexpr double Overlap = 2.0;

// The work of FindVisibleParts.
class PartFinder
{
public:
  PartFinder(const ViewLines& lines, const FaceClusters& clusters, const ImagePlane& image,
    const RayCaster& caster, const FrontMap& map)
    : Lines(lines)
    , Clusters(clusters)
    , Image(image)
    , Caster(caster)
    , Map(map)
    , Walk(lines.Lines, map)
  {
    std::vector<Box3> boxes;
    for (const auto& ends : map.Snapped.Edges)
    {
      Box2 box(map.VertexImage(ends[0]));
      box.extend(map.VertexImage(ends[1]));
      boxes.emplace_back(
        Vec3(box.min()[0], box.min()[1], 0.0), Vec3(box.max()[0], box.max()[1], 0.0));
    }
    this->Tree.Build(boxes, map.Pixel);
  }

  void FindOfContour(std::int64_t line, std::vector<LinePart>& out) const;
  void FindOfInner(std::int64_t line, std::vector<LinePart>& out) const;

private:
  bool IsHidden(const ViewLine& line, LinePosition at, const Vec2& image) const;
  bool IsHidden(const ViewLine& line, LinePosition from, LinePosition to) const;
  bool IsHiddenAside(const ViewLine& line, LinePosition at) const;
  void AddCrossings(
    const ViewLine& line, std::size_t segment, std::vector<LinePosition>& out) const;
  void Add(std::int64_t line, LinePosition from, LinePosition to, std::vector<LinePart>& out) const;

  const ViewLines& Lines;
  const FaceClusters& Clusters;
  const ImagePlane& Image;
  const RayCaster& Caster;
  const FrontMap& Map;
  LineWalk Walk;
  BoxTree Tree;
};

// True if something else is clearly in front of a line's point, seen at an image point on or beside it.
// A neighbour in the cluster may be in front beside the line: a narrow face may lie between them.
bool PartFinder::IsHidden(const ViewLine& line, LinePosition at, const Vec2& image) const
{
  const FrontHit hit = LookAt(this->Caster, this->Image, image);
  if (hit.Face < 0 || IsOfFace(this->Lines, line, hit.Face))
  {
    return false;
  }
  bool isNeighbour = this->Clusters.Cluster[line.Face] == this->Clusters.Cluster[hit.Face];
  if (line.IsIntersection())
  {
    isNeighbour =
      isNeighbour || this->Clusters.Cluster[line.OtherFace] == this->Clusters.Cluster[hit.Face];
  }
  for (std::size_t k = 0; line.IsEdge() && k < this->Lines.Uses[line.Edge].size(); ++k)
  {
    const std::int64_t face = this->Lines.Uses[line.Edge][k].Face;
    isNeighbour = isNeighbour || this->Clusters.Cluster[face] == this->Clusters.Cluster[hit.Face];
  }
  const double inFront = this->Image.Depth(PointAt(line, at)) - this->Image.Depth(hit.Point);
  return inFront > DepthMargin * this->Map.Pixel && !isNeighbour;
}

// The same at three points of a part, at their own images. One would do, if nothing pierced anything.
bool PartFinder::IsHidden(const ViewLine& line, LinePosition from, LinePosition to) const
{
  for (const double share : { 0.5, 0.1, 0.9 })
  {
    const LinePosition at = from + share * (to - from);
    const Vec3 point = ExactPointAt(this->Lines, line, at).Point;
    if (!this->IsHidden(line, at, this->Image.Project(point)))
    {
      return false;
    }
  }
  return true;
}

// The same on both sides of a point: a wall that is seen edge-on may stand on the line, and a line of
// sight along it may meet what it ends at.
bool PartFinder::IsHiddenAside(const ViewLine& line, LinePosition at) const
{
  const auto k = std::min(std::size_t(at), line.Image.size() - 2);
  const Vec2 along = (line.Image[k + 1] - line.Image[k]).normalized();
  const Vec2 aside = SideReach * this->Map.Pixel * Vec2(-along[1], along[0]);
  const Vec2 image = ImageAt(line, at);
  return this->IsHidden(line, at, image + aside) && this->IsHidden(line, at, image - aside);
}

// Adds a part of an inner line, longer by the overlap, or makes the last one longer.
void PartFinder::Add(
  std::int64_t index, LinePosition from, LinePosition to, std::vector<LinePart>& out) const
{
  const ViewLine& line = this->Lines.Lines[index];
  const auto reach = [&](LinePosition at, int step) {
    double left = Overlap * this->Map.Pixel;
    const double end = step < 0 ? 0.0 : double(line.Points.size() - 1);
    while (at != end && left > 0.0)
    {
      const double next = step < 0 ? std::ceil(at) - 1.0 : std::floor(at) + 1.0;
      const double length = (ImageAt(line, next) - ImageAt(line, at)).norm();
      at = length > left ? at + left / length * (next - at) : next;
      left -= length;
    }
    return at;
  };
  from = reach(from, -1);
  to = reach(to, 1);
  if (!out.empty() && out.back().Line == index && from <= out.back().To)
  {
    out.back().To = std::max(out.back().To, to);
  }
  else
  {
    out.emplace_back();
    out.back().Line = std::int32_t(index);
    out.back().From = from;
    out.back().To = to;
  }
}

void PartFinder::FindOfContour(std::int64_t index, std::vector<LinePart>& out) const
{
  const ViewLine& line = this->Lines.Lines[index];
  const std::vector<LineStep> steps = this->Walk.Steps(index);
  for (std::size_t first = 0, last = 0; first < steps.size(); first = last)
  {
    last = this->Walk.GroupEnd(steps, first);
    bool hidden =
      this->IsHidden(line, this->Walk.Start(steps[first]), this->Walk.End(steps[last - 1]));
    for (int lineSide = 0; lineSide < 2 && hidden; ++lineSide)
    {
      const LineStep& best = this->Walk.Widest(steps, first, last, lineSide);
      const LinePosition at = 0.5 * (this->Walk.Start(best) + this->Walk.End(best));
      hidden =
        this->IsHidden(line, at, this->Map.Beside(best.Edge, this->Walk.Side(best, lineSide)));
    }
    for (std::size_t k = first; k < last && !hidden; ++k)
    {
      const auto& ends = this->Map.Snapped.Edges[steps[k].Edge];
      LinePart part;
      part.Line = std::int32_t(index);
      part.From = this->Walk.Start(steps[k]);
      part.To = std::max(part.From, this->Walk.End(steps[k]));
      part.IsSnapped = true;
      part.Ends[this->Walk.Side(steps[k], 0)] = this->Map.Snapped.Vertices[ends[0]];
      part.Ends[this->Walk.Side(steps[k], 1)] = this->Map.Snapped.Vertices[ends[1]];
      out.push_back(part);
    }
  }
}

// Where a segment of a line crosses edges of the map.
void PartFinder::AddCrossings(
  const ViewLine& line, std::size_t segment, std::vector<LinePosition>& out) const
{
  const Vec2 a = line.Image[segment];
  const Vec2 along = line.Image[segment + 1] - a;
  Box2 box(a);
  box.extend(line.Image[segment + 1]);
  const auto cross = [](const Vec2& p, const Vec2& q) { return p[0] * q[1] - p[1] * q[0]; };
  const auto meets = [&](const Box3& other) {
    return box.min()[0] <= other.max()[0] && box.max()[0] >= other.min()[0] &&
      box.min()[1] <= other.max()[1] && box.max()[1] >= other.min()[1];
  };
  this->Tree.Search(meets, [&](std::int32_t edge, const Box3&) {
    const auto& ends = this->Map.Snapped.Edges[edge];
    const Vec2 p = this->Map.VertexImage(ends[0]) - a;
    const Vec2 q = this->Map.VertexImage(ends[1]) - a;
    const double slope = cross(along, q - p);
    if (slope == 0.0)
    {
      return; // Along the line.
    }
    // An edge that starts or ends near the line counts as crossed.
    const double reach = this->Map.Pixel / (q - p).norm();
    const double onEdge = cross(p, along) / slope;
    if (onEdge >= -reach && onEdge <= 1.0 + reach)
    {
      out.push_back(double(segment) + std::clamp(cross(p, q - p) / slope, 0.0, 1.0));
    }
  });
}

void PartFinder::FindOfInner(std::int64_t index, std::vector<LinePart>& out) const
{
  const ViewLine& line = this->Lines.Lines[index];
  std::vector<LinePosition> cuts{ 0.0, double(line.Points.size() - 1) };
  for (std::size_t k = 0; k + 1 < line.Points.size(); ++k)
  {
    this->AddCrossings(line, k, cuts);
  }
  std::sort(cuts.begin(), cuts.end());
  for (std::size_t k = 0; k + 1 < cuts.size(); ++k)
  {
    if (cuts[k] < cuts[k + 1] &&
      !(this->IsHidden(line, cuts[k], cuts[k + 1]) &&
        this->IsHiddenAside(line, 0.5 * (cuts[k] + cuts[k + 1]))))
    {
      this->Add(index, cuts[k], cuts[k + 1], out);
    }
  }
}

} // namespace

FaceClusters FindClusters(const ViewLines& lines, const Viewer& viewer)
{
  FaceClusters out;
  out.IsInner.assign(lines.Lines.size(), 0);
  UnionFind clusters(lines.Whole.Data.Faces.size());
  for (std::size_t l = 0; l < lines.Lines.size(); ++l)
  {
    const ViewLine& line = lines.Lines[l];
    out.IsInner[l] = line.IsEdge() && !line.IsBehind && !line.MeetsSilhouette &&
      FaceTheSameWay(lines.Whole.Data, line.Edge, lines.Uses[line.Edge], viewer);
    if (out.IsInner[l])
    {
      clusters.Join(lines.Uses[line.Edge][0].Face, lines.Uses[line.Edge][1].Face);
    }
  }
  out.Cluster = clusters.Sets();
  return out;
}

std::vector<LinePart> FindVisibleParts(const ViewLines& lines, const FaceClusters& clusters,
  const ImagePlane& image, const RayCaster& caster, double pixel, const ParallelFor& parallel,
  const std::function<bool(double)>& progress)
{
  std::vector<LinePart> contours = LinesInView(lines);
  contours.erase(std::remove_if(contours.begin(), contours.end(),
                   [&](const LinePart& part) { return clusters.IsInner[part.Line] != 0; }),
    contours.end());
  const FrontMap map = MakeLineMap(lines, contours, pixel, parallel);
  const PartFinder finder(lines, clusters, image, caster, map);
  const auto count = std::int64_t(lines.Lines.size());
  std::vector<std::vector<LinePart>> parts(count);
  std::atomic<std::int64_t> done{ 0 };
  std::atomic<bool> goOn{ true };
  parallel(0, count, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t l = begin; l < end && goOn; ++l)
    {
      if (clusters.IsInner[l])
      {
        finder.FindOfInner(l, parts[l]);
      }
      else
      {
        finder.FindOfContour(l, parts[l]);
      }
      ++done;
      if (progress && !progress(double(done) / double(count)))
      {
        goOn = false;
      }
    }
  });
  std::vector<LinePart> out;
  for (std::int64_t l = 0; l < count && goOn; ++l)
  {
    out.insert(out.end(), parts[l].begin(), parts[l].end());
  }
  return out;
}

} // namespace nurbs
