// SPDX-License-Identifier: BSD-3-Clause
// What is done with the pieces of regions' borders once they are traced.
#include "RegionLoops.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

namespace nurbs
{

namespace
{

// Shares of a trim curve that are nearer to each other are the same.
constexpr double SameShare = 1e-12;
// Nor are those told apart that are so many roundings of the parameter from each other.
constexpr double RoundingSteps = 16.0 * std::numeric_limits<double>::epsilon();
// What loops enclose, as a share of their length squared, that counts as nothing: a little more than
// what the checks of a model (ModelChecks.cxx) complain of.
constexpr double FlatShare = 1e-11;

// True if a loop encloses nothing in (u, v) relative to the domain.
bool IsFlat(const Model& model, const SurfaceView& surface, const RegionLoop& loop)
{
  const Vec2 size(surface.Domain(0).Length(), surface.Domain(1).Length());
  std::vector<Vec2> points;
  for (const RegionPiece& piece : loop)
  {
    points.insert(points.end(), piece.Polyline.begin(), piece.Polyline.end());
    const int samples =
      piece.Curve < 0 ? 0 : 4 * std::max(1, model.TrimCurves[piece.Curve].Geometry.Count - 1);
    RegionPiece part = piece;
    for (int k = 0; k < samples; ++k)
    {
      part.To = piece.From + double(k) / samples * (piece.To - piece.From);
      points.push_back(EndOfPiece(model, part, true));
    }
  }
  double area = 0.0;
  double length = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k)
  {
    const Vec2 a = (points[k] - points[0]).cwiseQuotient(size);
    const Vec2 b = (points[(k + 1) % points.size()] - points[0]).cwiseQuotient(size);
    area += a[0] * b[1] - a[1] * b[0];
    length += (b - a).norm();
  }
  return std::abs(area) <= FlatShare * std::max(FlatShare, length * length);
}

} // namespace

Vec2 EndOfPiece(const Model& model, const RegionPiece& piece, bool last)
{
  if (piece.Curve < 0)
  {
    return last ? piece.Polyline.back() : piece.Polyline.front();
  }
  const CurveView<2>& curve = model.TrimCurves[piece.Curve].Geometry;
  const Interval domain = curve.Domain();
  const double share = last ? piece.To : piece.From;
  return Evaluate(curve, share == 1.0 ? domain.Max : domain.Min + share * domain.Length());
}

namespace
{

// Where uses of an edge are cut: shares in order, 0 and 1 among them, no two of them as near to each other
// as parameters are told apart.
struct EdgeCuts
{
  std::vector<double> Shares{ 0.0, 1.0 };
  double Apart = SameShare;

  void Add(const RegionPiece& piece, const Interval& domain)
  {
    this->Shares.insert(this->Shares.end(), { piece.From, piece.To });
    const double largest = std::max(std::abs(domain.Min), std::abs(domain.Max));
    this->Apart = std::max(this->Apart, RoundingSteps * largest / domain.Length());
  }
  void Unite()
  {
    std::sort(this->Shares.begin(), this->Shares.end());
    std::vector<double> kept;
    for (const double share : this->Shares)
    {
      if (kept.empty() || share - kept.back() > this->Apart)
      {
        kept.push_back(share);
      }
    }
    if (kept.size() > 1 && 1.0 - kept.back() <= this->Apart)
    {
      kept.pop_back();
    }
    kept.push_back(1.0);
    this->Shares = std::move(kept);
  }
  double Nearest(double share) const
  {
    const auto above = std::lower_bound(this->Shares.begin(), this->Shares.end() - 1, share);
    return above != this->Shares.begin() && share - *(above - 1) < *above - share ? *(above - 1)
                                                                                  : *above;
  }
};

// Cuts a piece of a trim curve; nothing is left of one that is too short to have two ends.
void AddParts(const EdgeCuts& cuts, RegionPiece piece, RegionLoop& out)
{
  piece.From = cuts.Nearest(piece.From);
  piece.To = cuts.Nearest(piece.To);
  const double low = std::min(piece.From, piece.To);
  const double high = std::max(piece.From, piece.To);
  std::vector<double> within;
  std::copy_if(cuts.Shares.begin(), cuts.Shares.end(), std::back_inserter(within),
    [&](double share) { return share > low && share < high; });
  if (piece.From > piece.To)
  {
    std::reverse(within.begin(), within.end());
  }
  for (const double share : within)
  {
    RegionPiece part = piece;
    part.To = piece.From = share;
    out.push_back(part);
  }
  if (low < high)
  {
    out.push_back(piece);
  }
}

} // namespace

void CutAtSharedEnds(const ViewLines& lines, std::vector<std::vector<RegionLoop>>& regions)
{
  const Model& model = lines.Whole.Data;
  std::map<std::int64_t, EdgeCuts> cuts;
  const auto forLoops = [&](const auto& visit) {
    for (std::vector<RegionLoop>& region : regions)
    {
      std::for_each(region.begin(), region.end(), visit);
    }
  };
  forLoops([&](const RegionLoop& loop) {
    for (const RegionPiece& piece : loop)
    {
      if (piece.Curve >= 0)
      {
        const TrimCurve& curve = model.TrimCurves[piece.Curve];
        cuts[curve.Edge].Add(piece, curve.Geometry.Domain());
      }
    }
  });
  for (auto& one : cuts)
  {
    one.second.Unite();
  }
  forLoops([&](RegionLoop& loop) {
    RegionLoop out;
    for (RegionPiece& piece : loop)
    {
      if (piece.Curve >= 0)
      {
        AddParts(cuts[model.TrimCurves[piece.Curve].Edge], piece, out);
      }
      else
      {
        out.push_back(std::move(piece));
      }
    }
    JoinPolylines(model, out);
    loop = std::move(out);
  });
}

// Polylines end where what is beside them does, to the last bit.
void JoinPolylines(const Model& model, RegionLoop& loop)
{
  for (std::size_t k = 0; k < loop.size() && loop.size() > 1; ++k)
  {
    RegionPiece& next = loop[(k + 1) % loop.size()];
    if (loop[k].Curve < 0)
    {
      loop[k].Polyline.back() = EndOfPiece(model, next, false);
    }
    else if (next.Curve < 0)
    {
      next.Polyline.front() = EndOfPiece(model, loop[k], true);
    }
  }
}

void DropFlatLoops(const Model& model, std::int64_t face, std::vector<RegionLoop>& loops)
{
  const auto isFlat = [&](const RegionLoop& loop) {
    return IsFlat(model, model.Faces[face].Geometry, loop);
  };
  loops.erase(std::remove_if(loops.begin(), loops.end(), isFlat), loops.end());
}

} // namespace nurbs
