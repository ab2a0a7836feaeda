// SPDX-License-Identifier: BSD-3-Clause
// What the tests of wavelet levels of detail ask of their meshes.
#ifndef nurbsWaveletShapes_h
#define nurbsWaveletShapes_h

#include "../Core/nurbsModelShapes.h"
#include "WaveletModel.h"

#include <array>
#include <map>

namespace shapes
{

using Place = std::array<double, 3>;

/// Edges of the triangles of all faces together, by their places, and how many triangles have them;
/// triangles that run along them one way count 1, the other way -1.
struct EdgeCounts
{
  std::size_t Open = 0;   ///< One triangle has it.
  std::size_t Turned = 0; ///< Two have it, the same way around.
  std::size_t Inside = 0; ///< Open, and on no side of [0, 10] x [0, 10] (AddHoles).
};

inline EdgeCounts CountEdges(const nurbs::WaveletMeshes& meshes)
{
  std::map<std::pair<Place, Place>, std::pair<int, int>> edges;
  for (const nurbs::WaveletMesh& mesh : meshes.Faces)
  {
    for (std::size_t t = 0; t < mesh.Triangles.size(); t += 3)
    {
      for (int k = 0; k < 3; ++k)
      {
        const Vec3& a = mesh.Points[mesh.Triangles[t + k]];
        const Vec3& b = mesh.Points[mesh.Triangles[t + (k + 1) % 3]];
        Place p = { a[0], a[1], a[2] };
        Place q = { b[0], b[1], b[2] };
        const int way = p < q ? 1 : -1;
        if (q < p)
        {
          std::swap(p, q);
        }
        auto& edge = edges[{ p, q }];
        ++edge.first;
        edge.second += way;
      }
    }
  }
  EdgeCounts out;
  for (const auto& edge : edges)
  {
    const Place& p = edge.first.first;
    const Place& q = edge.first.second;
    out.Open += edge.second.first == 1;
    out.Turned += edge.second.first == 2 && edge.second.second != 0;
    bool border = false;
    for (int c = 0; c < 2; ++c)
    {
      for (const double side : { 0.0, 10.0 })
      {
        border = border || (std::abs(p[c] - side) < 1e-9 && std::abs(q[c] - side) < 1e-9);
      }
    }
    out.Inside += edge.second.first == 1 && !border;
  }
  return out;
}

/// The largest distance between points of the triangles and of the surface at the same parameters,
/// by dense samples; no smaller than the distance itself.
inline double Measure(const nurbs::WaveletMesh& mesh, const nurbs::SurfaceView& surface)
{
  constexpr int n = 6;
  double largest = 0.0;
  for (std::size_t t = 0; t < mesh.Triangles.size(); t += 3)
  {
    for (int i = 0; i <= n; ++i)
    {
      for (int j = 0; i + j <= n; ++j)
      {
        const double share[3] = { double(i) / n, double(j) / n, double(n - i - j) / n };
        Vec3 x = Vec3::Zero();
        Vec2 uv = Vec2::Zero();
        for (int k = 0; k < 3; ++k)
        {
          x += share[k] * mesh.Points[mesh.Triangles[t + k]];
          uv += share[k] * mesh.UV[mesh.Triangles[t + k]];
        }
        largest = std::max(largest, (x - nurbs::Evaluate(surface, uv[0], uv[1])).norm());
      }
    }
  }
  return largest;
}

} // namespace shapes

#endif
