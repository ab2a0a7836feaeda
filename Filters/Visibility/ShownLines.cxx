// SPDX-License-Identifier: BSD-3-Clause
// Which lines are seen.
#include "FeatureEdges.h"
#include "FrontMap.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace nurbs
{

namespace
{

// A hit beside a line is on a sheet that ends there if the way back along the surface leads this much
// nearer to the line. On other sheets it leads nowhere near; at a silhouette, where the surface turns
// away, to the square root of the chord's error.
constexpr double NearerShare = 0.6;
// Parts of a line between two crossings that are looked at beside a cluster, if the first look says that
// it is hidden.
constexpr std::size_t LooksOfHidden = 4;
// What is in front of a line by less is its own surface, in pixels.
constexpr double BareDepth = 8.0;

// Says where lines end the surfaces that are seen beside them.
class ShownLines
{
public:
  ShownLines(
    const ViewLines& lines, const ImagePlane& image, const RayCaster& caster, FrontMap& map)
    : Lines(lines)
    , Image(image)
    , Caster(caster)
    , Map(map)
    , Walk(lines.Lines, map)
    , Neighbours(lines.Whole.Data.Faces.size())
    , Joined(lines.Whole.Data.Faces.size(), 0)
    , Planar(lines.Whole.Data.Faces.size(), 0)
    , Size((lines.Box().diagonal()).norm())
  {
    for (std::size_t f = 0; f < this->Joined.size(); ++f)
    {
      const auto lowest = std::size_t(lines.Cluster[f]);
      this->Joined[f] = this->Joined[f] || lowest != f;
      this->Joined[lowest] = this->Joined[lowest] || lowest != f;
    }
    for (std::size_t f = 0; f < this->Planar.size(); ++f)
    {
      this->Planar[f] = !this->Joined[f] && IsPlanar(lines.Whole.Data.Faces[f].Geometry);
    }
    for (const std::vector<EdgeUse>& uses : lines.Uses)
    {
      for (const EdgeUse& use : uses)
      {
        for (const EdgeUse& other : uses)
        {
          this->Neighbours[lines.Cluster[use.Face]].insert(lines.Cluster[other.Face]);
        }
      }
    }
  }

  void Find(std::int64_t line);

private:
  /// What is looked at of one step and side, each once.
  struct Looks
  {
    const ViewLine& Line;
    const LineStep& Step;
    int Side;
    std::optional<Vec3> Middle;
    std::optional<FrontHit> There, Beside;
  };

  Vec3 Middle(const ViewLine& line, const LineStep& step) const;
  const Vec3& Middle(Looks& looks) const;
  const FrontHit& There(Looks& looks) const;
  const FrontHit& Beside(Looks& looks) const;
  bool Shows(Looks& looks) const;
  bool FindOf(const ViewLine& line, const std::vector<LineStep>& steps, std::size_t first,
    std::size_t last, int lineSide);
  bool LeadsTo(const FrontHit& hit, const Vec3& point) const;
  bool IsNeighbour(const ViewLine& line, std::int64_t face) const;
  bool IsBare(Looks& looks) const;
  bool IsEdgeOn(const ViewLine& line) const;
  bool IsForemost(const ViewLine& line, const LineStep& step) const;

  const ViewLines& Lines;
  const ImagePlane& Image;
  const RayCaster& Caster;
  FrontMap& Map;
  LineWalk Walk;
  std::vector<std::set<std::int64_t>> Neighbours; // Of clusters, by their edges; and themselves.
  std::vector<char> Joined;                       // One a face: its cluster has more faces.
  std::vector<char> Planar;                       // One a face: it is, and is not joined.
  double Size;                                    // Of the image.
};

Vec3 ShownLines::Middle(const ViewLine& line, const LineStep& step) const
{
  const LinePosition at = 0.5 * (this->Walk.Start(step) + this->Walk.End(step));
  return ExactPointAt(this->Lines, line, at).Point;
}

const Vec3& ShownLines::Middle(Looks& looks) const
{
  if (!looks.Middle)
  {
    looks.Middle = this->Middle(looks.Line, looks.Step);
  }
  return *looks.Middle;
}

// What is seen where the middle of the step is.
const FrontHit& ShownLines::There(Looks& looks) const
{
  if (!looks.There)
  {
    looks.There = LookAt(this->Caster, this->Image, this->Image.Project(this->Middle(looks)));
  }
  return *looks.There;
}

// And beside it.
const FrontHit& ShownLines::Beside(Looks& looks) const
{
  if (!looks.Beside)
  {
    looks.Beside = LookAt(this->Caster, this->Image, this->Map.Beside(looks.Step.Edge, looks.Side));
  }
  return *looks.Beside;
}

// True if the tangent plane leads to a point of another face of the cluster.
bool ShownLines::LeadsTo(const FrontHit& hit, const Vec3& point) const
{
  const SurfaceView& surface = this->Lines.Whole.Data.Faces[hit.Face].Geometry;
  const Vec3 normal = Normal(surface, hit.UV[0], hit.UV[1]);
  const Ray sight = this->Image.Sight(this->Image.Project(point));
  const double t = normal.dot(hit.Point - sight.Origin) / normal.dot(sight.Direction);
  const Vec3 reached = sight.Origin + t * sight.Direction;
  return (reached - point).norm() <= NearerShare * (hit.Point - point).norm();
}

bool ShownLines::Shows(Looks& looks) const
{
  const ViewLine& line = looks.Line;
  const FrontHit& front = this->Map.Front(looks.Step.Edge, looks.Side);
  if (!line.IsIntersection() && this->Planar[front.Face])
  {
    return true; // A plane has one sheet in the image.
  }
  const Vec3& point = this->Middle(looks);
  if (line.IsIntersection())
  {
    // Both faces are seen on both sides of it, where nothing is in front.
    const FrontHit& there = this->There(looks);
    return there.Face < 0 ||
      this->Image.Depth(point) - this->Image.Depth(there.Point) <= this->Map.Pixel;
  }
  const FrontHit& hit = this->Beside(looks);
  if (!this->Lines.AreJoined(hit.Face, front.Face))
  {
    return true; // Too near to tell; what the cell says goes.
  }
  if (!UsesLine(this->Lines, line, hit.Face))
  {
    return this->LeadsTo(hit, point);
  }
  const SurfaceView& surface = this->Lines.Whole.Data.Faces[hit.Face].Geometry;
  Vec2 uv = hit.UV;
  const int sheet = hit.FromBehind == this->Lines.Whole.Data.Faces[hit.Face].Reversed ? 1 : -1;
  this->Image.Lift(surface, this->Image.Project(point), this->Map.Pixel, sheet, uv);
  return (Evaluate(surface, uv[0], uv[1]) - point).norm() <=
    NearerShare * (hit.Point - point).norm();
}

// True if the face's cluster has an edge in common with one that the line is of.
bool ShownLines::IsNeighbour(const ViewLine& line, std::int64_t face) const
{
  if (face < 0)
  {
    return false;
  }
  const std::vector<std::int64_t>& cluster = this->Lines.Cluster;
  const auto touches = [&](std::int64_t own) {
    return this->Neighbours[cluster[own]].count(cluster[face]) > 0;
  };
  if (!line.IsEdge())
  {
    return touches(line.Face);
  }
  const std::vector<EdgeUse>& uses = this->Lines.Uses[line.Edge];
  return std::any_of(
    uses.begin(), uses.end(), [&](const EdgeUse& use) { return touches(use.Face); });
}

// A face that turns away may be narrower than a pixel there, so that a neighbour's cell begins at its
// silhouette. True if that is so, and nothing is in front of the line itself.
bool ShownLines::IsBare(Looks& looks) const
{
  const ViewLine& line = looks.Line;
  // A cell wide enough to be trusted has one front: most lines are hidden by what is far from them.
  const std::int32_t cell = this->Map.Cell(looks.Step.Edge, looks.Side);
  if (!this->Map.IsSliver(cell) && !this->IsNeighbour(line, this->Map.Cells[cell].Face))
  {
    return false;
  }
  const Vec3& point = this->Middle(looks);
  const FrontHit& beside = this->Beside(looks);
  // Of a surface that turns away with a radius up to the image's size.
  const double reach = std::sqrt(2.0 * SideReach * this->Map.Pixel * this->Size);
  const double behind =
    beside.Face < 0 ? reach : this->Image.Depth(beside.Point) - this->Image.Depth(point);
  // A look within a pixel of the line may miss its surface, where the line is not exact.
  const bool isMissed = behind >= reach &&
    (this->Map.Beside(looks.Step.Edge, looks.Side) - this->Image.Project(point)).norm() <=
      this->Map.Pixel;
  if (!isMissed && (std::abs(behind) > reach || !this->IsNeighbour(line, beside.Face)))
  {
    return false;
  }
  // Where no surface beside the line is known to be its own, only what is at the same place is.
  const double depth = isMissed || this->Map.Cells[cell].Face < 0 ? 1.0 : BareDepth;
  const FrontHit& front = this->There(looks);
  return front.Face < 0 ||
    this->Image.Depth(point) - this->Image.Depth(front.Point) <= depth * this->Map.Pixel;
}

// True if no face of an edge is seen, because all are edge-on.
bool ShownLines::IsEdgeOn(const ViewLine& line) const
{
  const auto isEdgeOn = [&](const EdgeUse& use) {
    const auto& patches = this->Lines.Faces[use.Face].Patches;
    return patches[int(PatchVisibility::EdgeOn)] > 0 &&
      patches[int(PatchVisibility::Visible)] + patches[int(PatchVisibility::Partial)] +
        patches[int(PatchVisibility::Invisible)] ==
      0;
  };
  return line.IsEdge() &&
    std::all_of(this->Lines.Uses[line.Edge].begin(), this->Lines.Uses[line.Edge].end(), isEdgeOn);
}

// True if nothing but its own faces is in front of a line, and no line that it coincides with is nearer.
bool ShownLines::IsForemost(const ViewLine& line, const LineStep& step) const
{
  const Vec3 point = this->Middle(line, step);
  const double depth = this->Image.Depth(point);
  const FrontHit front = LookAt(this->Caster, this->Image, this->Image.Project(point));
  if (front.Face >= 0 && !IsOfFace(this->Lines, line, front.Face) &&
    depth - this->Image.Depth(front.Point) > BareDepth * this->Map.Pixel)
  {
    return false;
  }
  const auto& ends = this->Map.Snapped.Edges[step.Edge];
  for (const LineSource& source : this->Map.SourcesOf(step.Edge))
  {
    const ViewLine& other = this->Lines.Lines[source.Line];
    const LinePosition middle = 0.5 *
      (this->Map.At(this->Lines.Lines, source, ends[0]) +
        this->Map.At(this->Lines.Lines, source, ends[1]));
    if (&other != &line && depth - this->Image.Depth(PointAt(other, middle)) > this->Map.Pixel)
    {
      return false;
    }
  }
  return true;
}

// Looks at a part of a line on one side, where there is most room. False: it is hidden, or empty.
bool ShownLines::FindOf(const ViewLine& line, const std::vector<LineStep>& steps, std::size_t first,
  std::size_t last, int lineSide)
{
  if (first == last)
  {
    return false;
  }
  const LineStep& best = this->Walk.Widest(steps, first, last, lineSide);
  Looks looks{ line, best, this->Walk.Side(best, lineSide), {}, {}, {} };
  const std::int64_t face = this->Map.Cells[this->Walk.Cell(best, lineSide)].Face;
  const bool shows = face >= 0 && IsOfFace(this->Lines, line, face) && this->Shows(looks);
  const bool isBare = !shows && this->IsBare(looks);
  for (std::size_t k = first; k < last; ++k)
  {
    LineSource& source = this->Map.Sources[steps[k].Source];
    source.Shows |= std::uint8_t((shows ? 1 : 0) << this->Walk.Side(steps[k], lineSide));
    source.IsBare = source.IsBare || isBare;
  }
  return shows || isBare;
}

// Between two crossings nothing changes: one look a side.
void ShownLines::Find(std::int64_t index)
{
  const ViewLine& line = this->Lines.Lines[index];
  const std::vector<LineStep> steps = this->Walk.Steps(index);
  for (std::size_t first = 0, last = 0; first < steps.size(); first = last)
  {
    last = this->Walk.GroupEnd(steps, first);
    if (this->IsEdgeOn(line))
    {
      const bool isForemost = this->IsForemost(line, steps[first + (last - first) / 2]);
      for (std::size_t k = first; k < last; ++k)
      {
        this->Map.Sources[steps[k].Source].IsBare = isForemost;
      }
      continue;
    }
    // A silhouette has its own surface on its left only.
    const int sides = line.IsEdge() || line.IsIntersection() ? 2 : 1;
    for (int lineSide = 0; lineSide < sides; ++lineSide)
    {
      // Beside a cluster no smooth edges cut the line; it is hidden only if it is everywhere.
      const std::size_t count = last - first;
      const bool isSeen = this->FindOf(line, steps, first, last, lineSide);
      for (std::size_t k = 0; k < LooksOfHidden && !isSeen && this->Joined[line.Face]; ++k)
      {
        this->FindOf(line, steps, first + k * count / LooksOfHidden,
          first + (k + 1) * count / LooksOfHidden, lineSide);
      }
    }
  }
}

} // namespace

void FindShownLines(const ViewLines& lines, const ImagePlane& image, const RayCaster& caster,
  FrontMap& map, const ParallelFor& parallel)
{
  ShownLines finder(lines, image, caster, map);
  parallel(0, std::int64_t(lines.Lines.size()), [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t line = begin; line < end; ++line)
    {
      finder.Find(line);
    }
  });
}

} // namespace nurbs
