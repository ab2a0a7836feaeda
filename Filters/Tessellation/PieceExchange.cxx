// SPDX-License-Identifier: BSD-3-Clause
#include "PieceExchange.h"

#include "PieceMessage.h"

#include <algorithm>

namespace nurbs
{

PieceExchange::PieceExchange(const PieceLinks* links, const CompletedModel& model,
  const std::vector<std::vector<EdgeUse>>& uses)
  : Links(links)
  , KnownEdges(model.KnownEdges)
{
  if (!links)
  {
    return;
  }
  this->IsBorder.assign(model.Data.Faces.size(), 0);
  for (std::int64_t e = 0; e < this->KnownEdges; ++e)
  {
    this->EdgeWith[links->Edges[e]] = e;
    const bool shared = std::any_of(uses[e].begin(), uses[e].end(),
      [this](const EdgeUse& use) { return this->IsGhost(use.Face); });
    for (const EdgeUse& use : uses[e])
    {
      this->IsBorder[use.Face] = this->IsBorder[use.Face] || shared;
    }
  }
  for (std::size_t f = 0; f < links->Faces.size(); ++f)
  {
    if (links->IsGhost[f])
    {
      this->GhostsWith[links->Faces[f][1]].push_back(std::int64_t(f));
    }
  }
}

bool PieceExchange::IsOwnEdge(const std::vector<EdgeUse>& uses) const
{
  return std::any_of(
    uses.begin(), uses.end(), [this](const EdgeUse& use) { return !this->IsGhost(use.Face); });
}

std::vector<char> PieceExchange::Pack(
  const PassNews& news, const std::vector<std::int64_t>& done) const
{
  std::vector<char> message;
  MessageWriter out(message);
  const char flags[2] = { news.IsAborted, news.IsUnfinished };
  out.Put(flags, 2);
  for (const std::int64_t f : done)
  {
    if (!this->IsBorder[f] || (news.Requests[f].empty() && news.Weak[f].empty()))
    {
      continue;
    }
    std::vector<std::int64_t> edges;
    std::vector<double> places;
    for (const SplitRequest& request : news.Requests[f])
    {
      if (request.Edge < this->KnownEdges)
      {
        edges.push_back(this->Links->Edges[request.Edge]);
        places.push_back(request.T);
      }
    }
    out.Put(this->Links->Faces[f]);
    out.Put(edges);
    out.Put(places);
    out.Put(news.Weak[f]);
  }
  return message;
}

void PieceExchange::Share(PassNews& news, std::vector<std::int64_t>& done) const
{
  for (const std::int64_t f : done)
  {
    news.IsUnfinished = news.IsUnfinished || !news.Requests[f].empty() || !news.Weak[f].empty();
  }
  if (!this->Links)
  {
    return;
  }
  for (const std::vector<char>& message : this->Links->Exchange(this->Pack(news, done)))
  {
    MessageReader in(message);
    std::vector<char> flags;
    in.Get(flags);
    news.IsAborted = news.IsAborted || flags[0];
    news.IsUnfinished = news.IsUnfinished || flags[1];
    while (!in.IsDone())
    {
      std::vector<std::int64_t> face, edges;
      std::vector<double> places;
      std::vector<int> weak;
      in.Get(face);
      in.Get(edges);
      in.Get(places);
      in.Get(weak);
      const auto found = this->GhostsWith.find(face[1]);
      if (found == this->GhostsWith.end())
      {
        continue;
      }
      for (const std::int64_t ghost : found->second)
      {
        if (this->Links->Faces[ghost][0] != face[0])
        {
          continue;
        }
        for (std::size_t k = 0; k < edges.size(); ++k)
        {
          const auto edge = this->EdgeWith.find(edges[k]);
          if (edge != this->EdgeWith.end())
          {
            news.Requests[ghost].push_back({ edge->second, places[k] });
          }
        }
        news.Weak[ghost] = weak;
        done.push_back(ghost);
      }
    }
  }
}

PieceLoops PieceExchange::GetLoops() const
{
  PieceLoops piece;
  piece.IsOwn = [this](std::int64_t face) { return !this->IsGhost(face); };
  piece.EdgeNumber = [this](std::int64_t edge) {
    return edge < this->KnownEdges ? this->Links->Edges[edge] : -1;
  };
  piece.VertexNumber = [this](std::int64_t vertex) {
    return vertex < std::int64_t(this->Links->Vertices.size()) ? this->Links->Vertices[vertex] : -1;
  };
  piece.Share = [this](ShortLoops& loops) {
    std::vector<char> message;
    MessageWriter out(message);
    for (const std::vector<LoopEdge>& loop : loops)
    {
      out.Put(loop);
    }
    loops.clear();
    for (const std::vector<char>& one : this->Links->Exchange(message))
    {
      for (MessageReader in(one); !in.IsDone();)
      {
        loops.emplace_back();
        in.Get(loops.back());
      }
    }
  };
  return piece;
}

} // namespace nurbs
