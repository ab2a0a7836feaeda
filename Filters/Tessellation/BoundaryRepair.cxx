// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryRepair.h"

#include "LoopRepair.h"

namespace nurbs
{

namespace
{

// A given side: the vertex it starts from and the point in space where it ends.
struct GivenSide
{
  const BoundaryVertex* Start;
  const BoundaryVertex* End;
};

BoundaryVertex MakeVertex(const RepairedVertex& repaired, const std::vector<GivenSide>& sides)
{
  const GivenSide& side = sides[repaired.Side];
  const BoundaryVertex& start = *side.Start;
  BoundaryVertex vertex = repaired.Source >= 0 ? *sides[repaired.Source].Start : start;
  vertex.UV = repaired.P;
  if (repaired.Source < 0)
  {
    vertex.X = (1.0 - repaired.S0) * start.X + repaired.S0 * side.End->X;
  }
  vertex.Edge = start.Edge;
  vertex.T0 = start.T0 + repaired.S0 * (start.T1 - start.T0);
  vertex.T1 = start.T0 + repaired.S1 * (start.T1 - start.T0);
  return vertex;
}

} // namespace

std::string RepairBoundary(std::vector<std::vector<BoundaryVertex>>& loops, bool crossings)
{
  Loops2 polygons;
  std::vector<GivenSide> sides;
  for (const std::vector<BoundaryVertex>& loop : loops)
  {
    polygons.emplace_back();
    for (std::size_t i = 0; i < loop.size(); ++i)
    {
      polygons.back().push_back(loop[i].UV);
      sides.push_back({ &loop[i], &loop[i + 1 < loop.size() ? i + 1 : 0] });
    }
  }
  const bool turn = !LoopsRunRight(polygons);
  if (!turn && !crossings)
  {
    return "";
  }
  static thread_local CrossingFinder finder;
  const bool cross = !finder.Find(polygons).empty();
  if (cross ? !crossings : !turn)
  {
    return "";
  }
  const RepairedLoops repaired = RepairLoops(polygons);
  std::vector<std::vector<BoundaryVertex>> made;
  for (const std::vector<RepairedVertex>& loop : repaired.Loops)
  {
    made.emplace_back();
    for (const RepairedVertex& vertex : loop)
    {
      made.back().push_back(MakeVertex(vertex, sides));
    }
  }
  loops.swap(made);
  return repaired.Message;
}

} // namespace nurbs
