// SPDX-License-Identifier: BSD-3-Clause
// Positions and normals that the GPU evaluates against those of the CPU in double precision.
#include "../Filters/Core/nurbsReference.h"
#include "vtkNURBSEGLRenderWindow.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNURBSTileTextures.h"
#include "vtkRenderer.h"
#include "vtkTextureObject.h"
#include "vtk_glew.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace
{

using nurbs::SurfaceTable;
using nurbs::SurfaceView;
using nurbs::Tile;
using nurbs::Vec2;
using nurbs::Vec3;
using reference::Random;

constexpr double Degrees = 180.0 / EIGEN_PI;

struct Vertex
{
  int Surface;
  int Span[2];
  Vec2 Parameters; ///< In the span, 0 to 1.
  Vec3 Position;   ///< Relative to the surface's origin, as the GPU has it.
  Vec3 Normal;     ///< Ditto.
};

/// Evaluates tiles on the GPU and reads them back.
class Evaluator
{
public:
  Evaluator()
    : Window(vtkSmartPointer<vtkNURBSEGLRenderWindow>::Take(vtkNURBSEGLRenderWindow::Create(8, 8)))
  {
    this->Window->AddRenderer(vtkSmartPointer<vtkRenderer>::New());
    this->Window->Render();
    this->Window->MakeCurrent();
  }
  ~Evaluator() { this->Textures.Release(this->Window); }

  std::vector<Vertex> Evaluate(const SurfaceTable& table, const std::vector<Tile>& tiles)
  {
    EXPECT_TRUE(
      this->Textures.SetTable(table, std::vector<vtkNURBSTileTextures::SurfaceInfo>(table.Size())));
    return this->Run(table, tiles);
  }

  /// The same after surfaces of the last table have moved.
  std::vector<Vertex> EvaluateMoved(
    const SurfaceTable& table, const std::vector<int>& moved, const std::vector<Tile>& tiles)
  {
    this->Textures.MoveSurfaces(table, moved);
    return this->Run(table, tiles);
  }

  std::string Device() const { return this->Window->GetRendererName(); }
  unsigned int Width() { return this->Textures.GetPositions()->GetWidth(); }
  long long Evaluated() const { return this->Textures.GetEvaluatedVertices(); }

private:
  std::vector<Vertex> Run(const SurfaceTable& table, const std::vector<Tile>& tiles)
  {
    EXPECT_TRUE(this->Textures.Prepare(this->Window, table, tiles)) << this->Textures.GetError();
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
    const std::vector<float> positions = Read(this->Textures.GetPositions());
    const std::vector<float> normals = Read(this->Textures.GetNormals());
    const std::size_t width = this->Textures.GetPositions()->GetWidth();
    std::vector<Vertex> vertices;
    const std::vector<int>& texels = this->Textures.GetTileTexels();
    for (std::size_t i = 0; i < texels.size(); i += 4)
    {
      const Tile tile = Decode(&texels[i]);
      const std::size_t x = texels[i] & 0xffff, y = texels[i] >> 16;
      for (int b = 0; b <= 1 << tile.CellsLog(1); ++b)
      {
        for (int a = 0; a <= 1 << tile.CellsLog(0); ++a)
        {
          const std::size_t at = 4 * (x + a + (y + b) * width);
          const auto vec = [&](const std::vector<float>& texture) {
            return Vec3(texture[at], texture[at + 1], texture[at + 2]);
          };
          const Vec2 t(std::ldexp(tile.First[0] + a, -tile.Log[0]),
            std::ldexp(tile.First[1] + b, -tile.Log[1]));
          vertices.push_back(
            { tile.Surface, { tile.Span[0], tile.Span[1] }, t, vec(positions), vec(normals) });
        }
      }
    }
    return vertices;
  }

  static std::vector<float> Read(vtkTextureObject* texture)
  {
    std::vector<float> values(std::size_t(4) * texture->GetWidth() * texture->GetHeight());
    glBindTexture(GL_TEXTURE_2D, texture->GetHandle());
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, values.data());
    glBindTexture(GL_TEXTURE_2D, 0);
    return values;
  }

  static Tile Decode(const int* texel)
  {
    Tile tile;
    tile.Surface = texel[1] & 0xffffff;
    for (int dir = 0; dir < 2; ++dir)
    {
      tile.Log[dir] = (texel[1] >> (24 + 4 * dir)) & 15;
      tile.Span[dir] = (texel[2] >> (16 * dir)) & 0xffff;
      tile.First[dir] = (texel[3] >> (16 * dir)) & 0xffff;
    }
    return tile;
  }

  vtkSmartPointer<vtkNURBSEGLRenderWindow> Window;
  vtkNURBSTileTextures Textures;
};

/// Tiles of every size at random places of a surface.
void AddTiles(
  const SurfaceTable& table, int surface, int count, Random& random, std::vector<Tile>& tiles)
{
  const nurbs::TableSurface& s = table[surface];
  for (int k = 0; k < count; ++k)
  {
    Tile tile;
    tile.Surface = surface;
    for (int dir = 0; dir < 2; ++dir)
    {
      tile.Span[dir] = random.Integer(0, int(s.Spans[dir].size()) - 1);
      tile.Log[dir] = k == 0 && random.Integer(0, 1) == 0 ? Tile::MaxSpanLog
                                                          : random.Integer(0, Tile::MaxSpanLog);
      const int tilesInSpan = 1 << (tile.Log[dir] - tile.CellsLog(dir));
      // The ends of spans are where poles and multiple knots are.
      const int place = random.Integer(0, 3);
      tile.First[dir] = (place == 0      ? 0
                            : place == 1 ? tilesInSpan - 1
                                         : random.Integer(0, tilesInSpan - 1))
        << tile.CellsLog(dir);
    }
    if (std::none_of(tiles.begin(), tiles.end(), [&](const Tile& t) { return t == tile; }))
    {
      tiles.push_back(tile);
    }
  }
}

/// A patch of a surface, over its spans alone: at its borders derivatives are those inside.
class Reference
{
public:
  Reference(const nurbs::TableSurface& surface, const int (&span)[2])
    : Size(2.0 * surface.Radius)
  {
    nurbs::Interval part[2];
    for (int dir = 0; dir < 2; ++dir)
    {
      const nurbs::Interval& share = surface.Spans[dir][std::size_t(span[dir])];
      const nurbs::Interval domain = surface.View.Domain(dir);
      part[dir] = { domain.Min + share.Min * domain.Length(),
        domain.Clamp(domain.Min + share.Max * domain.Length()) };
    }
    this->Patch = nurbs::Restrict(surface.View, part[0], part[1]);
    this->Weight = this->Patch;
    this->Weight.Weights.clear();
    for (std::size_t k = 0; k < this->Weight.Points.size(); ++k)
    {
      const double w = this->Patch.Weights.empty() ? 1.0 : this->Patch.Weights[k];
      this->Weight.Points[k] = Vec3(w, 0.0, 0.0);
      this->Greatest = std::max(this->Greatest, w);
    }
  }

  /// Point, normal, and the angle by which the normal turns if homogeneous control points are off by
  /// a rounding error of single precision: their differences are off as much, and the derivatives
  /// are degree times those. Near a pole this is without bound.
  void Evaluate(const Vec2& t, Vec3& point, Vec3& normal, double& roundingAngle) const
  {
    const SurfaceView view = this->Patch.View();
    const nurbs::Interval u = view.Domain(0), v = view.Domain(1);
    const Vec2 uv(u.Min + t[0] * u.Length(), v.Min + t[1] * v.Length());
    const nurbs::SurfaceDerivatives d = nurbs::EvaluateDerivatives(view, uv[0], uv[1], 1);
    point = d.S;
    normal = nurbs::Normal(view, uv[0], uv[1]);
    const Vec3 su = d.Su * u.Length(), sv = d.Sv * v.Length();
    const double weight = nurbs::Evaluate(this->Weight.View(), uv[0], uv[1])[0];
    const double off = 0x1p-24 * this->Size * this->Greatest / weight;
    roundingAngle =
      off * (view.Degree[0] * sv.norm() + view.Degree[1] * su.norm()) / su.cross(sv).norm();
  }

private:
  double Size;
  double Greatest = 0.0;
  nurbs::Surface Patch;
  nurbs::Surface Weight; ///< Its x is the weight.
};

/// The errors of many vertices.
struct Errors
{
  std::vector<double> Positions; ///< Over the surface's size.
  std::vector<double> Normals;   ///< Degrees.
  long Over = 0;                 ///< Normals that are off by more than 0.01 degrees.
  double Worst = 0.0;            ///< Of those, the largest error over that which rounding allows.

  Errors(const SurfaceTable& table, const std::vector<Vertex>& vertices)
  {
    std::unique_ptr<Reference> reference;
    const Vertex* last = nullptr;
    for (const Vertex& v : vertices)
    {
      const nurbs::TableSurface& s = table[v.Surface];
      if (!last || last->Surface != v.Surface || !std::equal(v.Span, v.Span + 2, last->Span))
      {
        reference = std::make_unique<Reference>(s, v.Span);
      }
      last = &v;
      Vec3 point, normal;
      double rounding = 0.0;
      reference->Evaluate(v.Parameters, point, normal, rounding);
      this->Positions.push_back((v.Position + s.Origin - point).norm() / (2.0 * s.Radius));
      const double angle = std::abs(v.Normal.norm() - 1.0) < 1e-6
        ? std::atan2(v.Normal.cross(normal).norm(), v.Normal.dot(normal))
        : EIGEN_PI;
      this->Normals.push_back(Degrees * angle);
      if (this->Normals.back() > 0.01)
      {
        ++this->Over;
        this->Worst = std::max(this->Worst, angle / rounding);
      }
    }
    std::sort(this->Positions.begin(), this->Positions.end());
    std::sort(this->Normals.begin(), this->Normals.end());
  }

  void Print(const std::string& name) const
  {
    std::printf("%-9s %7zu vertices; position over size: median %.1e, worst %.1e; normal, degrees: "
                "median %.1e, worst %.1e; over 0.01: %ld, at most %.2g of rounding\n",
      name.c_str(), this->Positions.size(), this->Positions[this->Positions.size() / 2],
      this->Positions.back(), this->Normals[this->Normals.size() / 2], this->Normals.back(),
      this->Over, this->Worst);
  }
};

TEST(TileTextures, AreTheShapesOfTheSource)
{
  Evaluator evaluator;
  std::printf("drawn by %s\n", evaluator.Device().c_str());
  Random random(31);
  for (int shape = vtkNURBSShapeSource::SPHERE; shape <= vtkNURBSShapeSource::CAR_BODY; ++shape)
  {
    vtkNew<vtkNURBSShapeSource> source;
    source->SetShape(shape);
    source->SetNumberOfPatches(150);
    source->Update();
    const auto view = vtkNURBSModel::View(source->GetOutput());
    SurfaceTable table;
    for (const nurbs::Face& face : view->GetModel().Faces)
    {
      table.Add(face.Geometry, nurbs::Box2(Vec2(0.0, 0.0), Vec2(1.0, 1.0)));
    }
    table.Fill(0, table.Size());
    std::vector<Tile> tiles;
    for (int i = 0; i < table.Size(); ++i)
    {
      AddTiles(table, i, std::max(2, 60 / table.Size()), random, tiles);
    }
    const Errors errors(table, evaluator.Evaluate(table, tiles));
    errors.Print("shape " + std::to_string(shape));
    EXPECT_LE(errors.Positions.back(), 2e-6);
    EXPECT_LE(errors.Normals.back(), 0.01);
  }
}

/// Uneven and multiple knots, weights of 0.2 to 5; some have a side that is a point.
nurbs::Surface WildSurface(Random& random, int maxDegree)
{
  nurbs::Surface s = random.Surface(random.Integer(1, maxDegree), random.Integer(1, maxDegree),
    random.Integer(0, 3) > 0, random.Integer(0, 3) > 0);
  for (double& w : s.Weights)
  {
    w = std::exp(random.Uniform(std::log(0.2), std::log(5.0)));
  }
  if (random.Integer(0, 3) == 0)
  {
    for (int i = 0; i < s.Count[0]; ++i)
    {
      s.Points[i] = s.Points[0];
    }
  }
  const Vec3 origin(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1));
  for (Vec3& p : s.Points)
  {
    p += 1e4 * origin;
  }
  return s;
}

void CompareWild(Evaluator& evaluator, Random& random, int count, int maxDegree, const char* name)
{
  std::vector<nurbs::Surface> surfaces;
  for (int k = 0; k < count; ++k)
  {
    surfaces.push_back(WildSurface(random, maxDegree));
  }
  SurfaceTable table;
  std::vector<Tile> tiles;
  for (const nurbs::Surface& s : surfaces)
  {
    table.Add(s.View(), nurbs::Box2(Vec2(0.0, 0.0), Vec2(1.0, 1.0)));
  }
  table.Fill(0, table.Size());
  for (int i = 0; i < count; ++i)
  {
    AddTiles(table, i, 2, random, tiles);
  }
  const Errors errors(table, evaluator.Evaluate(table, tiles));
  errors.Print(name);
  EXPECT_LE(errors.Positions.back(), 2e-6);
  // Beside a side that is a point, single precision can't tell derivatives from rounding.
  EXPECT_LE(errors.Worst, 3.0);
  EXPECT_LE(errors.Normals.back(), 3.0);
  EXPECT_LE(errors.Over, long(errors.Normals.size() / 200));
}

TEST(TileTextures, AreRandomSurfaces)
{
  Evaluator evaluator;
  Random random(32);
  CompareWild(evaluator, random, 1000, 9, "degree 9");
  CompareWild(evaluator, random, 20, nurbs::MaxDegree, "degree 25");
}

/// What is evaluated does not depend on what was there before: a smaller texture, other control points.
TEST(TileTextures, StayRightWhenTheyGrowAndMove)
{
  Evaluator evaluator;
  Random random(33);
  std::vector<nurbs::Surface> surfaces;
  for (int k = 0; k < 40; ++k)
  {
    surfaces.push_back(random.Surface(3, 3));
  }
  SurfaceTable table;
  for (const nurbs::Surface& s : surfaces)
  {
    table.Add(s.View(), nurbs::Box2(Vec2(0.0, 0.0), Vec2(1.0, 1.0)));
  }
  table.Fill(0, table.Size());
  std::vector<Tile> tiles;
  const auto check = [&](const std::vector<Vertex>& vertices) {
    const Errors errors(table, vertices);
    EXPECT_LE(errors.Positions.back(), 2e-6);
    EXPECT_LE(errors.Normals.back(), 0.01);
    return evaluator.Width();
  };
  AddTiles(table, 0, 2, random, tiles);
  const unsigned int before = check(evaluator.Evaluate(table, tiles));
  for (int i = 0; i < table.Size(); ++i)
  {
    AddTiles(table, i, 10, random, tiles);
  }
  EXPECT_GT(check(evaluator.Evaluate(table, tiles)), before);
  const long long evaluated = evaluator.Evaluated();
  std::vector<int> moved;
  long expected = 0;
  for (int i = 0; i < table.Size(); i += 3)
  {
    surfaces[std::size_t(i)].Points[0] += Vec3(0.1, 0.2, -0.3);
    EXPECT_TRUE(table.Move(i, surfaces[std::size_t(i)].View()));
    moved.push_back(i);
  }
  for (const Tile& tile : tiles)
  {
    const long vertices = ((1 << tile.CellsLog(0)) + 1) * ((1 << tile.CellsLog(1)) + 1);
    expected += tile.Surface % 3 == 0 ? vertices : 0;
  }
  check(evaluator.EvaluateMoved(table, moved, tiles));
  EXPECT_EQ(evaluator.Evaluated() - evaluated, expected);
}

} // namespace
