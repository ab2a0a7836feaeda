// SPDX-License-Identifier: BSD-3-Clause
// What is done with the pieces of regions' borders once they are traced.
#include "RegionLoops.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace nurbs
{

namespace
{

// Shares of a trim curve that are nearer to each other are the same.
constexpr double SameShare = 1e-12;
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

void CutAtSharedEnds(const ViewLines& lines, std::vector<std::vector<RegionLoop>>& regions)
{
  const Model& model = lines.Whole.Data;
  std::map<std::int64_t, std::vector<double>> ends;
  const auto forPieces = [&](const auto& visit) {
    for (std::vector<RegionLoop>& region : regions)
    {
      for (RegionLoop& loop : region)
      {
        visit(loop);
      }
    }
  };
  forPieces([&](const RegionLoop& loop) {
    for (const RegionPiece& piece : loop)
    {
      if (piece.Curve >= 0)
      {
        std::vector<double>& at = ends[model.TrimCurves[piece.Curve].Edge];
        at.insert(at.end(), { piece.From, piece.To });
      }
    }
  });
  for (auto& [edge, at] : ends)
  {
    std::sort(at.begin(), at.end());
    at.erase(
      std::unique(at.begin(), at.end(), [](double a, double b) { return b - a < SameShare; }),
      at.end());
  }
  forPieces([&](RegionLoop& loop) {
    RegionLoop out;
    for (RegionPiece piece : loop)
    {
      if (piece.Curve >= 0)
      {
        const std::vector<double>& at = ends[model.TrimCurves[piece.Curve].Edge];
        std::vector<double> cuts;
        for (const double share : at)
        {
          if (share > std::min(piece.From, piece.To) + SameShare &&
            share < std::max(piece.From, piece.To) - SameShare)
          {
            cuts.push_back(share);
          }
        }
        if (piece.From > piece.To)
        {
          std::reverse(cuts.begin(), cuts.end());
        }
        for (const double share : cuts)
        {
          RegionPiece part = piece;
          part.To = piece.From = share;
          out.push_back(part);
        }
      }
      out.push_back(std::move(piece));
    }
    loop = std::move(out);
  });
}

void DropFlatLoops(const Model& model, std::int64_t face, std::vector<RegionLoop>& loops)
{
  const auto isFlat = [&](const RegionLoop& loop) {
    return IsFlat(model, model.Faces[face].Geometry, loop);
  };
  loops.erase(std::remove_if(loops.begin(), loops.end(), isFlat), loops.end());
}

} // namespace nurbs
