// SPDX-License-Identifier: BSD-3-Clause
// Models whose control points can be moved, and what the tests ask of their meshes.
#ifndef nurbsDeformingShapes_h
#define nurbsDeformingShapes_h

#include "../Core/nurbsModelShapes.h"
#include "DeformingModel.h"

#include <array>
#include <map>

namespace shapes
{

/// A model with control points and weights of its own.
struct MovableModel
{
  nurbs::ModelBuilder Builder;
  nurbs::AssembledModel Assembled;
  std::vector<double> Points, Weights;
  nurbs::Model Model;

  /// To be called when the builder has its faces.
  void Make()
  {
    nurbs::AssembleOptions options;
    options.CheckEdges = false;
    this->Assembled = nurbs::AssembleModel(this->Builder.Arrays(), options);
    const nurbs::ModelArrays arrays = this->Builder.Arrays();
    this->Points.assign(arrays.Points.begin(), arrays.Points.end());
    this->Weights.assign(arrays.Weights.begin(), arrays.Weights.end());
    this->Model = this->Assembled.Model;
    for (nurbs::Face& face : this->Model.Faces)
    {
      face.Geometry.Points = this->Points.data();
      face.Geometry.Weights = this->Weights.empty() ? nullptr : this->Weights.data();
    }
  }
  std::int64_t Count() const { return std::int64_t(this->Points.size() / 3); }
  Eigen::Map<nurbs::Vec3> Point(std::int64_t k)
  {
    return Eigen::Map<nurbs::Vec3>(this->Points.data() + 3 * k);
  }
  const std::vector<std::string>& Errors() const { return this->Assembled.FaceErrors; }
};

/// A bicubic sheet over [0, 10] x [0, 10] with n x n spans, wavy.
inline void AddSheet(nurbs::ModelBuilder& builder, int spans, double height)
{
  Surface s;
  const int count = spans + 3;
  for (int d = 0; d < 2; ++d)
  {
    s.Degree[d] = 3;
    s.Count[d] = count;
    s.Knots[d] = nurbs::UniformKnots(3, count);
  }
  for (int j = 0; j < count; ++j)
  {
    for (int i = 0; i < count; ++i)
    {
      const double x = 10.0 * i / (count - 1);
      const double y = 10.0 * j / (count - 1);
      s.Points.emplace_back(x, y, height * std::sin(1.1 * x) * std::cos(0.8 * y + 0.3));
    }
  }
  builder.BeginFace(s.View(), nurbs::FaceAttributes());
}

struct MeshCounts
{
  std::int64_t Open = 0;   ///< Edges that one triangle has.
  std::int64_t Inside = 0; ///< Of these, those that are not on a side of their face's domain.
  std::int64_t Turned = 0; ///< That two have, the same way around.
  std::int64_t Beyond = 0; ///< Corners that are no points.
};

/// True if both points are on one side of a surface's domain.
inline bool AreOnSide(const nurbs::SurfaceView& surface, const double* a, const double* b)
{
  for (int d = 0; d < 2; ++d)
  {
    const nurbs::Interval domain = surface.Domain(d);
    for (const double side : { domain.Min, domain.Max })
    {
      const double near = 1e-9 * domain.Length();
      if (std::abs(a[d] - side) <= near && std::abs(b[d] - side) <= near)
      {
        return true;
      }
    }
  }
  return false;
}

/// Counts edges by the places of their ends.
inline MeshCounts Count(const nurbs::MeshArrays& mesh, const nurbs::Model& model)
{
  using Place = std::array<double, 3>;
  std::map<Place, int> ids;
  std::vector<int> id(mesh.PointCount);
  for (std::int64_t k = 0; k < mesh.PointCount; ++k)
  {
    const double* p = mesh.Points + 3 * k;
    id[k] = ids.emplace(Place{ p[0] + 0.0, p[1] + 0.0, p[2] + 0.0 }, int(ids.size())).first->second;
  }
  struct Edge
  {
    int Triangles = 0, Way = 0;
    bool OnSide = false;
  };
  MeshCounts out;
  std::map<std::pair<int, int>, Edge> edges;
  for (std::int64_t t = 0; t < mesh.TriangleCount; ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const std::int64_t a = mesh.Corners[3 * t + k];
      const std::int64_t b = mesh.Corners[3 * t + (k + 1) % 3];
      if (a < 0 || b < 0 || a >= mesh.PointCount || b >= mesh.PointCount)
      {
        ++out.Beyond;
        continue;
      }
      if (id[a] != id[b])
      {
        Edge& edge = edges[std::minmax(id[a], id[b])];
        ++edge.Triangles;
        edge.Way += id[a] < id[b] ? 1 : -1;
        edge.OnSide =
          AreOnSide(model.Faces[mesh.Faces[t]].Geometry, mesh.UV + 2 * a, mesh.UV + 2 * b);
      }
    }
  }
  for (const auto& edge : edges)
  {
    out.Open += edge.second.Triangles == 1;
    out.Inside += edge.second.Triangles == 1 && !edge.second.OnSide;
    out.Turned += edge.second.Triangles == 2 && edge.second.Way != 0;
  }
  return out;
}

/// What the triangles of a mesh are from the surfaces at equal parameters, at most, by dense samples.
inline double LargestDistance(const nurbs::MeshArrays& mesh, const nurbs::Model& model)
{
  constexpr int n = 5;
  double largest = 0.0;
  for (std::int64_t t = 0; t < mesh.TriangleCount; ++t)
  {
    const nurbs::SurfaceView& surface = model.Faces[mesh.Faces[t]].Geometry;
    for (int i = 0; i <= n; ++i)
    {
      for (int j = 0; i + j <= n; ++j)
      {
        const double share[3] = { double(i) / n, double(j) / n, double(n - i - j) / n };
        Vec3 x = Vec3::Zero();
        Vec2 uv = Vec2::Zero();
        for (int k = 0; k < 3; ++k)
        {
          const std::int64_t c = mesh.Corners[3 * t + k];
          x += share[k] * Eigen::Map<const Vec3>(mesh.Points + 3 * c);
          uv += share[k] * Eigen::Map<const Vec2>(mesh.UV + 2 * c);
        }
        largest = std::max(largest, (x - nurbs::Evaluate(surface, uv[0], uv[1])).norm());
      }
    }
  }
  return largest;
}

/// Area of the triangles in the parameters of a face: a hole or an overlap changes it.
inline double ParameterArea(const nurbs::MeshArrays& mesh, std::int64_t face)
{
  double area = 0.0;
  for (std::int64_t t = 0; t < mesh.TriangleCount; ++t)
  {
    if (mesh.Faces[t] == face)
    {
      Vec2 p[3];
      for (int k = 0; k < 3; ++k)
      {
        p[k] = Eigen::Map<const Vec2>(mesh.UV + 2 * mesh.Corners[3 * t + k]);
      }
      const Vec2 a = p[1] - p[0];
      const Vec2 b = p[2] - p[0];
      area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
  }
  return area;
}

} // namespace shapes

#endif
