// SPDX-License-Identifier: BSD-3-Clause
#include "LoopRepair.h"

#include <CGAL/Arr_consolidated_curve_data_traits_2.h>
#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <set>
#include <unordered_map>

namespace nurbs
{

namespace
{

constexpr std::size_t FewSides = 512; // swept along one axis; more: CGAL's box intersection
constexpr int MaxRounds = 3;

using Predicates = CGAL::Exact_predicates_inexact_constructions_kernel;

// The sign of the area of a, b, c: 1 if they turn left.
int Orientation(const Vec2& a, const Vec2& b, const Vec2& c)
{
  const double left = (a[0] - c[0]) * (b[1] - c[1]);
  const double right = (a[1] - c[1]) * (b[0] - c[0]);
  const double det = left - right;
  // Shewchuk's bound for the rounding of det.
  if (std::abs(det) > 3.4e-16 * (std::abs(left) + std::abs(right)))
  {
    return det > 0.0 ? 1 : -1;
  }
  using Point = Predicates::Point_2;
  return static_cast<int>(
    CGAL::orientation(Point(a[0], a[1]), Point(b[0], b[1]), Point(c[0], c[1])));
}

// p is on the line through a and b: is it strictly between them?
bool IsBetween(const Vec2& a, const Vec2& b, const Vec2& p)
{
  const int axis = a[0] != b[0] ? 0 : 1;
  return std::min(a[axis], b[axis]) < p[axis] && p[axis] < std::max(a[axis], b[axis]);
}

// More in common than an end; exactly reversed sides (slits) are let pass.
bool Conflict(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d)
{
  const int c1 = Orientation(a, b, c);
  const int d1 = Orientation(a, b, d);
  if (c1 * d1 > 0)
  {
    return false;
  }
  if (c1 == 0 && d1 == 0)
  {
    if (a == d && b == c)
    {
      return false;
    }
    return (a == c && b == d) || IsBetween(a, b, c) || IsBetween(a, b, d) || IsBetween(c, d, a) ||
      IsBetween(c, d, b);
  }
  const int a2 = Orientation(c, d, a);
  const int b2 = Orientation(c, d, b);
  if (a2 * b2 > 0)
  {
    return false;
  }
  if (c1 * d1 < 0 && a2 * b2 < 0)
  {
    return true;
  }
  return (c1 == 0 && IsBetween(a, b, c)) || (d1 == 0 && IsBetween(a, b, d)) ||
    (a2 == 0 && IsBetween(c, d, a)) || (b2 == 0 && IsBetween(c, d, b));
}

} // namespace

void CrossingFinder::Test(const Side& a, const Side& b)
{
  if (a.Low[1] > b.High[1] || b.Low[1] > a.High[1])
  {
    return;
  }
  if (Conflict(a.A, a.B, b.A, b.B))
  {
    this->Pairs.emplace_back(std::min(a.Index, b.Index), std::max(a.Index, b.Index));
  }
}

const std::vector<std::pair<int, int>>& CrossingFinder::Find(const Loops2& loops)
{
  this->Sides.clear();
  this->Pairs.clear();
  int index = 0;
  for (const std::vector<Vec2>& loop : loops)
  {
    for (std::size_t i = 0; i < loop.size(); ++i, ++index)
    {
      const Vec2& a = loop[i];
      const Vec2& b = loop[i + 1 < loop.size() ? i + 1 : 0];
      if (a == b)
      {
        continue;
      }
      Side side;
      side.A = a;
      side.B = b;
      side.Index = index;
      for (int c = 0; c < 2; ++c)
      {
        side.Low[c] = std::min(a[c], b[c]);
        side.High[c] = std::max(a[c], b[c]);
      }
      this->Sides.push_back(side);
    }
  }
  if (this->Sides.size() > FewSides)
  {
    using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 2, const Side*>;
    std::vector<Box> boxes;
    boxes.reserve(this->Sides.size());
    for (const Side& side : this->Sides)
    {
      boxes.emplace_back(CGAL::Bbox_2(side.Low[0], side.Low[1], side.High[0], side.High[1]), &side);
    }
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(),
      [this](const Box& a, const Box& b) { this->Test(*a.handle(), *b.handle()); });
  }
  else
  {
    std::sort(this->Sides.begin(), this->Sides.end(),
      [](const Side& a, const Side& b) { return a.Low[0] < b.Low[0]; });
    this->Active.clear();
    for (std::size_t k = 0; k < this->Sides.size(); ++k)
    {
      const Side& side = this->Sides[k];
      std::size_t kept = 0;
      for (const int other : this->Active)
      {
        if (this->Sides[other].High[0] >= side.Low[0])
        {
          this->Active[kept++] = other;
          this->Test(this->Sides[other], side);
        }
      }
      this->Active.resize(kept);
      this->Active.push_back(static_cast<int>(k));
    }
  }
  std::sort(this->Pairs.begin(), this->Pairs.end());
  return this->Pairs;
}

double SignedArea2(const std::vector<Vec2>& polygon)
{
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
  {
    const Vec2 a = polygon[i] - polygon[0];
    const Vec2 b = polygon[i + 1] - polygon[0];
    sum += a[0] * b[1] - a[1] * b[0];
  }
  return sum;
}

namespace
{

using LoopsR = std::vector<std::vector<RepairedVertex>>;

Loops2 Positions(const LoopsR& loops)
{
  Loops2 out;
  for (const std::vector<RepairedVertex>& loop : loops)
  {
    out.emplace_back();
    for (const RepairedVertex& vertex : loop)
    {
      out.back().push_back(vertex.P);
    }
  }
  return out;
}

LoopsR Number(const Loops2& loops)
{
  LoopsR out;
  int index = 0;
  for (const std::vector<Vec2>& loop : loops)
  {
    out.emplace_back();
    for (const Vec2& p : loop)
    {
      if (!std::isfinite(p[0]) || !std::isfinite(p[1]))
      {
        throw Error("RepairLoops: vertex " + std::to_string(index) + " is not finite");
      }
      RepairedVertex vertex;
      vertex.P = p;
      vertex.Source = vertex.Side = index++;
      out.back().push_back(vertex);
    }
  }
  return out;
}

// Drops vertices in the same spot as the one before; returns how many.
int DropRepeated(LoopsR& loops)
{
  int dropped = 0;
  for (std::vector<RepairedVertex>& loop : loops)
  {
    std::vector<RepairedVertex> kept;
    for (const RepairedVertex& vertex : loop)
    {
      if (!kept.empty() && kept.back().P == vertex.P)
      {
        // The side that goes on from here is that of the later vertex.
        kept.back().Side = vertex.Side;
        kept.back().S0 = vertex.S0;
        kept.back().S1 = vertex.S1;
        ++dropped;
        continue;
      }
      kept.push_back(vertex);
    }
    while (kept.size() > 1 && kept.back().P == kept.front().P)
    {
      kept.pop_back();
      ++dropped;
    }
    loop.swap(kept);
  }
  return dropped;
}

void Reverse(std::vector<RepairedVertex>& loop)
{
  std::reverse(loop.begin(), loop.end());
  // A side belongs to the vertex that it starts from, which was its end.
  const RepairedVertex first = loop.front();
  for (std::size_t i = 0; i < loop.size(); ++i)
  {
    const RepairedVertex& from = i + 1 < loop.size() ? loop[i + 1] : first;
    loop[i].Side = from.Side;
    const double start = from.S1;
    loop[i].S1 = from.S0;
    loop[i].S0 = start;
  }
}

// Crossings of a loop with the ray from p to the right, odd if p is inside; exact.
bool Contains(const std::vector<Vec2>& loop, const Vec2& p)
{
  bool inside = false;
  for (std::size_t i = 0; i < loop.size(); ++i)
  {
    const Vec2& a = loop[i];
    const Vec2& b = loop[i + 1 < loop.size() ? i + 1 : 0];
    if ((a[1] > p[1]) != (b[1] > p[1]))
    {
      const int turn = Orientation(a, b, p);
      inside = inside != (b[1] > a[1] ? turn > 0 : turn < 0);
    }
  }
  return inside;
}

// Is loop `inner` inside loop `outer`, given that they do not cross? Asked of the first vertex that
// is no vertex of the other.
bool LiesInside(const std::vector<Vec2>& inner, const std::vector<Vec2>& outer)
{
  for (const Vec2& p : inner)
  {
    if (std::find(outer.begin(), outer.end(), p) == outer.end())
    {
      return Contains(outer, p);
    }
  }
  return false;
}

// The loops whose direction does not fit their depth.
std::vector<std::size_t> WrongWay(const Loops2& polygons)
{
  std::vector<Box2> boxes(polygons.size());
  for (std::size_t i = 0; i < polygons.size(); ++i)
  {
    for (const Vec2& p : polygons[i])
    {
      boxes[i].extend(p);
    }
  }
  std::vector<std::size_t> wrong;
  for (std::size_t i = 0; i < polygons.size(); ++i)
  {
    int depth = 0;
    for (std::size_t j = 0; j < polygons.size(); ++j)
    {
      depth += i != j && boxes[j].contains(boxes[i]) && LiesInside(polygons[i], polygons[j]);
    }
    if ((SignedArea2(polygons[i]) > 0.0) != (depth % 2 == 0))
    {
      wrong.push_back(i);
    }
  }
  return wrong;
}

// Removes loops of fewer than three vertices or all on a line; returns how many.
int DropFlat(LoopsR& loops)
{
  const auto flat = [](const std::vector<RepairedVertex>& loop) {
    for (std::size_t i = 2; i < loop.size(); ++i)
    {
      if (Orientation(loop[0].P, loop[1].P, loop[i].P) != 0)
      {
        return false;
      }
    }
    return true;
  };
  const auto first = std::remove_if(loops.begin(), loops.end(), flat);
  const auto count = static_cast<int>(loops.end() - first);
  loops.erase(first, loops.end());
  return count;
}

// The loops' sides as a planar subdivision with a winding number in each of its faces.
class Subdivision
{
public:
  explicit Subdivision(const LoopsR& loops)
  {
    std::vector<Curve> curves;
    for (const std::vector<RepairedVertex>& loop : loops)
    {
      for (std::size_t i = 0; i < loop.size(); ++i)
      {
        const RepairedVertex& a = loop[i];
        const RepairedVertex& b = loop[i + 1 < loop.size() ? i + 1 : 0];
        if (a.P == b.P)
        {
          continue;
        }
        this->Given.push_back({ a, b.P, this->Direction.size() });
        const Point p(a.P[0], a.P[1]);
        const Point q(b.P[0], b.P[1]);
        this->Vertices.emplace(p, a);
        curves.emplace_back(Segment(p, q), static_cast<int>(this->Given.size()) - 1);
      }
      this->Direction.push_back(SignedArea2(Positions({ loop })[0]) > 0.0 ? 1 : -1);
    }
    CGAL::insert(this->Plane, curves.begin(), curves.end());
    this->Wind();
  }

  // The boundary of the region that the loops enclose (IsInside), or of that by the even-odd rule.
  LoopsR Boundary(bool evenOdd) const
  {
    LoopsR loops;
    std::set<const void*> done;
    for (auto e = this->Plane.halfedges_begin(); e != this->Plane.halfedges_end(); ++e)
    {
      if (this->IsBoundary(e, evenOdd) && done.count(&*e) == 0)
      {
        loops.emplace_back();
        Halfedge h = e;
        do
        {
          done.insert(&*h);
          loops.back().push_back(this->Vertex(h));
          h = h->next();
          while (!this->IsBoundary(h, evenOdd))
          {
            h = h->twin()->next();
          }
        } while (h != Halfedge(e));
      }
    }
    return loops;
  }

private:
  using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
  using Traits =
    CGAL::Arr_consolidated_curve_data_traits_2<CGAL::Arr_segment_traits_2<Kernel>, int>;
  using Arrangement = CGAL::Arrangement_2<Traits>;
  using Halfedge = Arrangement::Halfedge_const_handle;
  using FaceHandle = Arrangement::Face_const_handle;
  using Curve = Traits::Curve_2;
  using Point = Kernel::Point_2;
  using Segment = CGAL::Arr_segment_traits_2<Kernel>::Curve_2;

  struct GivenSide
  {
    RepairedVertex Start;
    Vec2 End;
    std::size_t Loop;
  };

  // What a loop winds around at all is its own, lobes that run the other way included; clockwise
  // loops take away from the others.
  bool IsInside(FaceHandle face, bool evenOdd) const
  {
    int count = 0;
    const std::vector<int>& winding = this->Winding.at(&*face);
    for (std::size_t loop = 0; loop < winding.size(); ++loop)
    {
      count += evenOdd ? winding[loop] : (winding[loop] != 0 ? this->Direction[loop] : 0);
    }
    return evenOdd ? count % 2 != 0 : count > 0;
  }

  bool IsBoundary(Halfedge h, bool evenOdd) const
  {
    return this->IsInside(h->face(), evenOdd) && !this->IsInside(h->twin()->face(), evenOdd);
  }

  // 1 if the given side runs along the halfedge, -1 if against it.
  int Sense(Halfedge h, const GivenSide& side) const
  {
    const bool up = CGAL::compare_xy(h->source()->point(), h->target()->point()) == CGAL::SMALLER;
    const Vec2& a = side.Start.P;
    const bool sideUp = a[0] < side.End[0] || (a[0] == side.End[0] && a[1] < side.End[1]);
    return up == sideUp ? 1 : -1;
  }

  // Winding numbers from the outside inwards: the face on the left of a loop's side has one more than
  // the face on its right.
  void Wind()
  {
    std::queue<FaceHandle> queue;
    queue.push(this->Plane.unbounded_face());
    this->Winding[&*this->Plane.unbounded_face()].assign(this->Direction.size(), 0);
    while (!queue.empty())
    {
      const FaceHandle face = queue.front();
      queue.pop();
      const auto visit = [&](Arrangement::Ccb_halfedge_const_circulator first) {
        auto h = first;
        do
        {
          std::vector<int> across = this->Winding[&*face];
          for (auto id = h->curve().data().begin(); id != h->curve().data().end(); ++id)
          {
            across[this->Given[*id].Loop] -= this->Sense(h, this->Given[*id]);
          }
          const FaceHandle other = h->twin()->face();
          if (this->Winding.emplace(&*other, std::move(across)).second)
          {
            queue.push(other);
          }
        } while (++h != first);
      };
      for (auto ccb = face->outer_ccbs_begin(); ccb != face->outer_ccbs_end(); ++ccb)
      {
        visit(*ccb);
      }
      for (auto ccb = face->inner_ccbs_begin(); ccb != face->inner_ccbs_end(); ++ccb)
      {
        visit(*ccb);
      }
    }
  }

  static double Share(const GivenSide& side, const Vec2& p)
  {
    const Vec2 d = side.End - side.Start.P;
    const double s = (p - side.Start.P).dot(d) / d.squaredNorm();
    return std::min(1.0, std::max(0.0, s));
  }

  Vec2 Round(const Point& p) const { return Vec2(CGAL::to_double(p.x()), CGAL::to_double(p.y())); }

  RepairedVertex Vertex(Halfedge h) const
  {
    // Prefer a side that runs our way.
    int best = *h->curve().data().begin();
    for (auto id = h->curve().data().begin(); id != h->curve().data().end(); ++id)
    {
      best = this->Sense(h, this->Given[best]) > 0 ? best : *id;
    }
    const GivenSide& side = this->Given[best];
    RepairedVertex vertex;
    const auto known = this->Vertices.find(h->source()->point());
    vertex.P = this->Round(h->source()->point());
    vertex.Source = known != this->Vertices.end() ? known->second.Source : -1;
    vertex.Side = side.Start.Side;
    const double length = side.Start.S1 - side.Start.S0;
    vertex.S0 = side.Start.S0 + length * Share(side, vertex.P);
    vertex.S1 = side.Start.S0 + length * Share(side, this->Round(h->target()->point()));
    return vertex;
  }

  std::vector<GivenSide> Given;
  std::map<Point, RepairedVertex> Vertices;
  Arrangement Plane;
  std::map<const void*, std::vector<int>> Winding; ///< Of each loop around a face.
  std::vector<int> Direction;                      ///< Of each loop: 1 if counter-clockwise.
};

double TotalArea(const LoopsR& loops)
{
  double sum = 0.0;
  for (const std::vector<Vec2>& loop : Positions(loops))
  {
    sum += SignedArea2(loop);
  }
  return sum;
}

std::string Count(std::size_t n, const char* one, const char* many)
{
  return std::to_string(n) + ' ' + (n == 1 ? one : many);
}

void Say(RepairedLoops& repaired, const std::string& what)
{
  repaired.Changed = true;
  repaired.Message += (repaired.Message.empty() ? "" : "; ") + what;
}

} // namespace

bool LoopsRunRight(const Loops2& loops)
{
  return WrongWay(loops).empty();
}

RepairedLoops RepairLoops(const Loops2& loops)
{
  RepairedLoops out;
  out.Loops = Number(loops);
  if (const int dropped = DropRepeated(out.Loops))
  {
    Say(out, Count(dropped, "repeated vertex dropped", "repeated vertices dropped"));
  }
  if (const int dropped = DropFlat(out.Loops))
  {
    Say(out, Count(dropped, "loop without area dropped", "loops without area dropped"));
  }
  CrossingFinder finder;
  for (int round = 0;; ++round)
  {
    const std::size_t crossings = finder.Find(Positions(out.Loops)).size();
    if (crossings == 0)
    {
      break;
    }
    if (round == MaxRounds)
    {
      throw Error("RepairLoops: " + Count(crossings, "pair", "pairs") + " of sides still cross");
    }
    const Subdivision plane(out.Loops);
    LoopsR kept = plane.Boundary(false);
    LoopsR evenOdd = plane.Boundary(true);
    // Half as much, as of two crossing loops with equal lobes, is enough; rounding must not decide.
    constexpr double Half = 0.5 * (1.0 - 1e-6);
    const bool positive = TotalArea(kept) >= Half * TotalArea(evenOdd);
    out.Loops.swap(positive ? kept : evenOdd);
    if (round == 0)
    {
      Say(out,
        "loops cross in " + Count(crossings, "pair of sides", "pairs of sides") +
          (positive ? ": what they enclose is kept"
                    : ": what is inside by the even-odd rule is kept"));
    }
    DropRepeated(out.Loops);
    DropFlat(out.Loops);
  }
  const std::vector<std::size_t> wrong = WrongWay(Positions(out.Loops));
  for (const std::size_t i : wrong)
  {
    Reverse(out.Loops[i]);
  }
  if (const std::size_t turned = wrong.size())
  {
    Say(out,
      Count(turned, "loop that ran the wrong way turned", "loops that ran the wrong way turned"));
  }
  return out;
}

} // namespace nurbs
