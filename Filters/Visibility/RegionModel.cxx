// SPDX-License-Identifier: BSD-3-Clause
// Visible regions as a model.
#include "ModelBuilder.h"
#include "VisibleRegions.h"

#include <algorithm>
#include <array>
#include <map>

namespace nurbs
{

namespace
{

class RegionWriter
{
public:
  RegionWriter(const CompletedModel& whole, ModelBuilder& builder)
    : Source(whole.Data)
    , Builder(builder)
  {}

  void AddFace(std::int64_t index, const std::vector<RegionLoop>& loops);

private:
  void AddPiece(const RegionPiece& piece);
  void AddPolyline(const std::vector<Vec2>& points);
  std::int64_t EdgeOf(const TrimCurve& curve, double low, double high);
  std::int64_t VertexOf(std::int64_t edge, double share);

  const Model& Source;
  ModelBuilder& Builder;
  std::map<std::int64_t, std::int64_t> Vertices;                // By the source's vertex.
  std::map<std::pair<std::int64_t, double>, std::int64_t> Cuts; // By edge and share.
  std::map<std::array<double, 3>, std::int64_t> Edges;          // By edge and range of shares.
};

// The vertex at an end of an edge, or where it is cut; -1 if its place is not known.
std::int64_t RegionWriter::VertexOf(std::int64_t edge, double share)
{
  const Edge& source = this->Source.Edges[edge];
  if (share == 0.0 || share == 1.0)
  {
    const std::int64_t vertex = source.Vertex[share == 0.0 ? 0 : 1];
    if (vertex < 0)
    {
      return -1;
    }
    const auto found = this->Vertices.find(vertex);
    return found != this->Vertices.end()
      ? found->second
      : this->Vertices[vertex] = this->Builder.AddVertex(this->Source.Vertices[vertex]);
  }
  if (source.Geometry.Count < 2)
  {
    return -1;
  }
  const auto found = this->Cuts.find({ edge, share });
  const Interval domain = source.Geometry.Domain();
  return found != this->Cuts.end()
    ? found->second
    : this->Cuts[{ edge, share }] =
        this->Builder.AddVertex(Evaluate(source.Geometry, domain.Min + share * domain.Length()));
}

std::int64_t RegionWriter::EdgeOf(const TrimCurve& curve, double low, double high)
{
  const Edge& source = this->Source.Edges[curve.Edge];
  const auto found = this->Edges.find({ double(curve.Edge), low, high });
  if (found != this->Edges.end())
  {
    return found->second;
  }
  const std::int64_t start = this->VertexOf(curve.Edge, low);
  const std::int64_t end = this->VertexOf(curve.Edge, high);
  std::int64_t edge = -1;
  if (source.Geometry.Count == 1)
  {
    const Interval domain = curve.Geometry.Domain();
    edge = this->Builder.AddPole(source.Geometry.Point(0),
      { domain.Min + low * domain.Length(), domain.Min + high * domain.Length() }, source.Tolerance,
      start >= 0 ? start : end);
  }
  else if (source.Geometry.Count == 0)
  {
    edge = this->Builder.AddUnknownEdge(source.Tolerance, start, end);
  }
  else if (low == 0.0 && high == 1.0)
  {
    edge = this->Builder.AddEdge(source.Geometry, source.Tolerance, start, end);
  }
  else
  {
    const Interval domain = source.Geometry.Domain();
    const Curve<3> part = Restrict(source.Geometry, domain.Min + low * domain.Length(),
      high == 1.0 ? domain.Max : domain.Min + high * domain.Length());
    edge = this->Builder.AddEdge(part.View(), source.Tolerance, start, end);
  }
  return this->Edges[{ double(curve.Edge), low, high }] = edge;
}

// A curve of degree 1; its parameter is the number of the point.
void RegionWriter::AddPolyline(const std::vector<Vec2>& points)
{
  Curve<2> curve;
  for (const Vec2& point : points)
  {
    if (curve.Points.empty() || point != curve.Points.back())
    {
      curve.Points.push_back(point);
    }
  }
  if (curve.Points.size() < 2)
  {
    return;
  }
  curve.Degree = 1;
  curve.Weights.assign(curve.Points.size(), 1.0);
  curve.Knots.push_back(0.0);
  for (std::size_t k = 0; k < curve.Points.size(); ++k)
  {
    curve.Knots.push_back(double(k));
  }
  curve.Knots.push_back(curve.Knots.back());
  curve.Pack();
  this->Builder.AddTrimCurve(curve.View(), -1, false);
}

void RegionWriter::AddPiece(const RegionPiece& piece)
{
  if (piece.Curve < 0)
  {
    this->AddPolyline(piece.Polyline);
    return;
  }
  const TrimCurve& source = this->Source.TrimCurves[piece.Curve];
  const double low = std::min(piece.From, piece.To);
  const double high = std::max(piece.From, piece.To);
  const std::int64_t edge = this->EdgeOf(source, low, high);
  const bool reversed = piece.From > piece.To;
  if (low == 0.0 && high == 1.0)
  {
    this->Builder.AddTrimCurve(source.Geometry, edge, reversed);
    return;
  }
  const Interval domain = source.Geometry.Domain();
  const Curve<2> part = Restrict(source.Geometry, domain.Min + low * domain.Length(),
    high == 1.0 ? domain.Max : domain.Min + high * domain.Length());
  this->Builder.AddTrimCurve(part.View(), edge, reversed);
}

void RegionWriter::AddFace(std::int64_t index, const std::vector<RegionLoop>& loops)
{
  const Face& face = this->Source.Faces[index];
  FaceAttributes attributes;
  attributes.FaceId = face.FaceId;
  attributes.Reversed = face.Reversed;
  this->Builder.BeginFace(face.Geometry, attributes);
  for (const RegionLoop& loop : loops)
  {
    this->Builder.BeginLoop();
    for (const RegionPiece& piece : loop)
    {
      this->AddPiece(piece);
    }
  }
}

} // namespace

std::vector<std::int64_t> BuildRegions(
  const VisibleRegions& regions, std::int64_t first, std::int64_t last, ModelBuilder& builder)
{
  RegionWriter writer(regions.Lines.Whole, builder);
  std::vector<std::int64_t> faces;
  for (std::int64_t f = first; f < last && f < std::int64_t(regions.Faces.size()); ++f)
  {
    if (!regions.Faces[f].Loops.empty())
    {
      writer.AddFace(f, regions.Faces[f].Loops);
      faces.push_back(f);
    }
  }
  return faces;
}

} // namespace nurbs
