// SPDX-License-Identifier: BSD-3-Clause
// What is asked of visible regions, by lines of sight over the whole image.
#ifndef nurbsRegionReference_h
#define nurbsRegionReference_h

#include "VisibleRegions.h"

#include "ModelBuilder.h"
#include "nurbsSilhouetteReference.h"

#include <algorithm>
#include <cmath>

namespace reference
{

using nurbs::VisibleRegionOptions;
using nurbs::VisibleRegions;

/// What lines of sight say of a result.
struct RegionCheck
{
  int Rays = 0;
  int Fronts = 0; ///< That meet something.
  /// Points of surfaces on the wrong side of a region's border, nearer to it in the image than the
  /// precision, and farther: these are wrong.
  int Near = 0;
  int Wrong = 0;
  Vec2 FirstWrong = Vec2::Zero();
  std::int64_t WrongFace = -1;
  bool WrongIsFront = false;
};

/// The borders of all regions in the image, as dense polylines.
inline std::vector<std::vector<Vec2>> ImageBorders(const VisibleRegions& result)
{
  std::vector<std::vector<Vec2>> out;
  const Model& model = result.Lines.Whole.Data;
  for (std::size_t f = 0; f < result.Faces.size(); ++f)
  {
    for (const nurbs::RegionLoop& loop : result.Faces[f].Loops)
    {
      for (const nurbs::RegionPiece& piece : loop)
      {
        std::vector<Vec2> line;
        const auto add = [&](const Vec2& uv) {
          line.push_back(
            result.Image->Project(nurbs::Evaluate(model.Faces[f].Geometry, uv[0], uv[1])));
        };
        nurbs::RegionPiece part = piece;
        for (int k = 0; piece.Curve >= 0 && k <= 64; ++k)
        {
          part.To = piece.From + k / 64.0 * (piece.To - piece.From);
          add(nurbs::EndOfPiece(model, part, true));
        }
        std::for_each(piece.Polyline.begin(), piece.Polyline.end(), add);
        out.push_back(std::move(line));
      }
    }
  }
  return out;
}

inline double ImageDistance(const std::vector<std::vector<Vec2>>& lines, const Vec2& p)
{
  double least = 1e300;
  for (const std::vector<Vec2>& line : lines)
  {
    for (std::size_t k = 1; k < line.size(); ++k)
    {
      const Vec2 along = line[k] - line[k - 1];
      const double length = along.squaredNorm();
      const double t =
        length > 0.0 ? std::clamp(along.dot(p - line[k - 1]) / length, 0.0, 1.0) : 0.0;
      least = std::min(least, (line[k - 1] + t * along - p).norm());
    }
  }
  return least;
}

/// How many pairs of segments of a face's loops cross each other in its domain, away from their ends.
/// Trim curves are 64 chords each: only exact if they are straight.
inline int CountCrossings(const VisibleRegions& result)
{
  const Model& model = result.Lines.Whole.Data;
  const auto side = [](const Vec2& a, const Vec2& b, const Vec2& p) {
    const Vec2 along = b - a;
    const Vec2 to = p - a;
    const double cross = along[0] * to[1] - along[1] * to[0];
    return std::abs(cross) <= 1e-8 * along.norm() ? 0 : (cross > 0.0 ? 1 : -1);
  };
  int out = 0;
  for (std::size_t f = 0; f < result.Faces.size(); ++f)
  {
    const nurbs::Interval u = model.Faces[f].Geometry.Domain(0);
    const nurbs::Interval v = model.Faces[f].Geometry.Domain(1);
    std::vector<std::array<Vec2, 2>> segments;
    for (const nurbs::RegionLoop& loop : result.Faces[f].Loops)
    {
      for (const nurbs::RegionPiece& piece : loop)
      {
        std::vector<Vec2> line = piece.Polyline;
        nurbs::RegionPiece part = piece;
        for (int k = 0; piece.Curve >= 0 && k <= 64; ++k)
        {
          part.To = piece.From + k / 64.0 * (piece.To - piece.From);
          line.push_back(nurbs::EndOfPiece(model, part, true));
        }
        for (Vec2& p : line)
        {
          p = p.cwiseQuotient(Vec2(u.Length(), v.Length()));
        }
        for (std::size_t k = 1; k < line.size(); ++k)
        {
          segments.push_back({ line[k - 1], line[k] });
        }
      }
    }
    for (std::size_t a = 0; a < segments.size(); ++a)
    {
      for (std::size_t b = 0; b < a; ++b)
      {
        const auto& [p, q] = segments[a];
        const auto& [r, s] = segments[b];
        out += side(p, q, r) * side(p, q, s) < 0 && side(r, s, p) * side(r, s, q) < 0;
      }
    }
  }
  return out;
}

/// Casts n x n lines of sight over the image of the model: the first hit must be inside its face's
/// region, all others outside.
inline RegionCheck CheckRegions(
  const Model& model, const VisibleRegions& result, double precision, int n)
{
  RegionCheck out;
  nurbs::ModelBuilder builder;
  const std::vector<std::int64_t> faces =
    nurbs::BuildRegions(result, 0, std::int64_t(model.Faces.size()), builder);
  const nurbs::AssembledModel regions = nurbs::AssembleModel(builder.Arrays());
  const nurbs::TrimIndex trims(regions.Model);
  std::vector<std::int64_t> regionOf(model.Faces.size(), -1);
  for (std::size_t k = 0; k < faces.size(); ++k)
  {
    regionOf[faces[k]] = regions.FaceErrors[k].empty() ? std::int64_t(k) : -1;
  }
  const nurbs::RayCaster caster(model);
  const std::vector<std::vector<Vec2>> borders = ImageBorders(result);
  nurbs::Box2 box;
  for (const nurbs::ViewLine& line : result.Lines.Lines)
  {
    std::for_each(line.Image.begin(), line.Image.end(), [&](const Vec2& p) { box.extend(p); });
  }
  std::vector<nurbs::RayHit> hits;
  for (int k = 0; k < n * n; ++k)
  {
    // Not on lines of symmetry.
    const Vec2 share((k % n + 0.5137) / n, (k / n + 0.4829) / n);
    const Vec2 at = box.min() + share.cwiseProduct(box.diagonal());
    caster.All(result.Image->Sight(at), hits);
    ++out.Rays;
    out.Fronts += !hits.empty();
    for (std::size_t h = 0; h < hits.size(); ++h)
    {
      const std::int64_t region = regionOf[hits[h].Face];
      const bool inside = region >= 0 && trims.Inside(region, hits[h].U, hits[h].V);
      if (inside != (h == 0))
      {
        const bool isNear = ImageDistance(borders, at) <= precision;
        ++(isNear ? out.Near : out.Wrong);
        if (!isNear && out.Wrong == 1)
        {
          out.FirstWrong = at;
          out.WrongFace = hits[h].Face;
          out.WrongIsFront = h == 0;
        }
      }
    }
  }
  return out;
}

} // namespace reference

#endif
