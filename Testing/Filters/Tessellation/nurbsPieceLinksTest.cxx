// SPDX-License-Identifier: BSD-3-Clause
// Pieces of a model, tessellated by threads that stand for processes, make the triangles of the whole.
#include "PieceBuilder.h"
#include "Tessellator.h"
#include "nurbsModelShapes.h"
#include "nurbsSolids.h"

#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <set>
#include <thread>

namespace
{

using nurbs::ModelBuilder;
using nurbs::TessellationResult;

/// Collects one message of every thread.
class MeetingPoint
{
public:
  explicit MeetingPoint(int count)
    : Count(count)
  {}
  std::vector<std::vector<char>> Meet(int rank, const std::vector<char>& message)
  {
    std::unique_lock<std::mutex> lock(this->Mutex);
    const std::int64_t round = this->Round;
    this->Messages.resize(this->Count);
    this->Messages[rank] = message;
    if (++this->Here == this->Count)
    {
      this->Shared = std::move(this->Messages);
      this->Messages.clear();
      this->Here = 0;
      ++this->Round;
      this->Changed.notify_all();
    }
    this->Changed.wait(lock, [&]() { return this->Round != round; });
    return this->Shared;
  }
  std::int64_t Round = 0;

private:
  int Count;
  int Here = 0;
  std::vector<std::vector<char>> Messages, Shared;
  std::mutex Mutex;
  std::condition_variable Changed;
};

/// A wavy sheet of n x n patches that share edges, some of them bent far more than others.
ModelBuilder Patches(int n)
{
  ModelBuilder builder;
  nurbs::PatchStitcher stitcher(builder, 1e-9);
  for (int j = 0; j < n; ++j)
  {
    for (int i = 0; i < n; ++i)
    {
      nurbs::Surface s;
      s.Degree[0] = s.Degree[1] = 3;
      s.Count[0] = s.Count[1] = 4;
      s.Knots[0] = s.Knots[1] = { 0, 0, 0, 0, 1, 1, 1, 1 };
      for (int k = 0; k < 16; ++k)
      {
        const double x = i + (k % 4) / 3.0;
        const double y = j + (k / 4) / 3.0;
        const bool inside = k % 4 % 3 != 0 && k / 4 % 3 != 0;
        s.Points.push_back(nurbs::Vec3(x, y,
          std::sin(2.0 * x) * std::cos(3.0 * y) + (inside ? 0.8 * ((i * 5 + j * 3) % 4) : 0)));
      }
      stitcher.AddFace(s, nurbs::FaceAttributes());
    }
  }
  return builder;
}

nurbs::TessellatorOptions Options(double tolerance)
{
  nurbs::TessellatorOptions options;
  options.Tolerance = tolerance;
  return options;
}

std::set<std::int64_t> VerticesOf(const nurbs::Model& model, const nurbs::Face& face)
{
  std::set<std::int64_t> vertices;
  for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
  {
    for (std::int64_t c = 0; c < model.Loops[l].CurveCount; ++c)
    {
      const std::int64_t edge = model.TrimCurves[model.Loops[l].FirstCurve + c].Edge;
      vertices.insert(model.Edges[edge].Vertex[0]);
      vertices.insert(model.Edges[edge].Vertex[1]);
    }
  }
  return vertices;
}

/// What process `rank` makes of its own faces [first, last) and their neighbours.
void Tessellate(const ModelBuilder& builder, const std::vector<std::int64_t>& starts, int rank,
  double tolerance, MeetingPoint& meeting, TessellationResult& out)
{
  const nurbs::AssembledModel whole = nurbs::AssembleModel(builder.Arrays());
  std::set<std::int64_t> own;
  for (std::int64_t f = starts[rank]; f < starts[rank + 1]; ++f)
  {
    const std::set<std::int64_t> some = VerticesOf(whole.Model, whole.Model.Faces[f]);
    own.insert(some.begin(), some.end());
  }
  nurbs::PieceBuilder piece;
  piece.Begin(builder.Arrays(), {}, {});
  nurbs::PieceLinks links;
  std::vector<std::int64_t> faces;
  for (std::int64_t f = 0; f < builder.FaceCount(); ++f)
  {
    const bool isOwn = f >= starts[rank] && f < starts[rank + 1];
    const std::set<std::int64_t> vertices = VerticesOf(whole.Model, whole.Model.Faces[f]);
    const bool isNear = std::any_of(
      vertices.begin(), vertices.end(), [&](std::int64_t vertex) { return own.count(vertex) > 0; });
    if (isOwn || isNear)
    {
      piece.AddFace(f);
      faces.push_back(f);
      links.IsGhost.push_back(!isOwn);
      links.Faces.push_back({ 0, f });
    }
  }
  piece.Finish();
  links.Edges = piece.EdgeIds;
  links.Vertices = piece.VertexIds;
  links.Exchange = [&](const std::vector<char>& message) { return meeting.Meet(rank, message); };
  const nurbs::AssembledModel model = nurbs::AssembleModel(piece.Model.Arrays());
  nurbs::TessellatorOptions options = Options(tolerance);
  options.Pieces = &links;
  TessellationResult result = nurbs::Tessellate(model.Model, model.FaceErrors, options);
  for (std::size_t k = 0; k < faces.size(); ++k)
  {
    if (!links.IsGhost[k])
    {
      out.Meshes[faces[k]] = std::move(result.Meshes[k]);
    }
    else
    {
      EXPECT_TRUE(result.Meshes[k].Triangles.empty());
    }
  }
}

/// Compares the pieces' triangles with the whole's. Returns how often the processes met.
std::int64_t Compare(const ModelBuilder& builder, int ranks, double tolerance)
{
  const nurbs::AssembledModel whole = nurbs::AssembleModel(builder.Arrays());
  const TessellationResult alone =
    nurbs::Tessellate(whole.Model, whole.FaceErrors, Options(tolerance));
  const std::vector<std::int64_t> starts =
    nurbs::DealFaces(std::vector<double>(std::size_t(builder.FaceCount()), 1.0), ranks);
  TessellationResult together;
  together.Meshes.resize(alone.Meshes.size());
  MeetingPoint meeting(ranks);
  std::vector<std::thread> threads;
  for (int rank = 0; rank < ranks; ++rank)
  {
    threads.emplace_back(
      [&, rank]() { Tessellate(builder, starts, rank, tolerance, meeting, together); });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  std::size_t triangles = 0;
  for (std::size_t f = 0; f < alone.Meshes.size(); ++f)
  {
    EXPECT_EQ(alone.Meshes[f].Points, together.Meshes[f].Points) << "face " << f;
    EXPECT_EQ(alone.Meshes[f].Triangles, together.Meshes[f].Triangles) << "face " << f;
    EXPECT_EQ(alone.Meshes[f].CertifiedError, together.Meshes[f].CertifiedError) << "face " << f;
    triangles += together.Meshes[f].Triangles.size() / 3;
  }
  EXPECT_GT(triangles, 0u);
  return meeting.Round;
}

TEST(PieceLinks, PatchesAreThoseOfTheWhole)
{
  const ModelBuilder patches = Patches(6);
  for (const double tolerance : { 0.1, 1e-2, 1e-3 })
  {
    for (const int ranks : { 2, 3, 5 })
    {
      Compare(patches, ranks, tolerance);
    }
  }
}

// The processes have something to tell: there is more than the first pass.
TEST(PieceLinks, RequestsCrossBorders)
{
  EXPECT_GT(Compare(Patches(6), 3, 1e-2), 2);
}

TEST(PieceLinks, MoreProcessesThanFaces)
{
  ModelBuilder box;
  solids::AddBox(box, nurbs::Vec3(1, 2, 3), solids::At(nurbs::Vec3(0, 0, 0)));
  Compare(box, 9, 1e-2);
}

// Edges that are too short to matter become points, which decides over faces far from each other.
TEST(PieceLinks, ShortEdgesBecomeTheSamePoints)
{
  ModelBuilder builder;
  nurbs::PatchStitcher stitcher(builder, 1e-12);
  const double widths[] = { 1.0, 1e-3, 2e-3, 1e-3, 1.0, 3e-3, 1e-3, 1.0 };
  double x = 0.0;
  for (const double width : widths)
  {
    for (int row = 0; row < 2; ++row)
    {
      nurbs::Surface s;
      s.Count[0] = s.Count[1] = 2;
      s.Knots[0] = s.Knots[1] = { 0, 0, 1, 1 };
      for (int k = 0; k < 4; ++k)
      {
        s.Points.push_back(nurbs::Vec3(x + (k % 2) * width, row + k / 2, 0.1 * row * (k / 2) * x));
      }
      stitcher.AddFace(s, nurbs::FaceAttributes());
    }
    x += width;
  }
  for (const int ranks : { 2, 4, 7 })
  {
    Compare(builder, ranks, 0.2);
    Compare(builder, ranks, 0.35);
  }
}

} // namespace
