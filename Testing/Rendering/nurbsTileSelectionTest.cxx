// SPDX-License-Identifier: BSD-3-Clause
// What TileSelection promises, against dense samples of surfaces and triangles as a camera sees them.
#include "TileSelection.h"
#include "nurbsBoundReference.h"

#include <gtest/gtest.h>

#include <map>

namespace
{

using nurbs::SurfaceTable;
using nurbs::SurfaceView;
using nurbs::Tile;
using nurbs::TileSelection;
using nurbs::TileView;
using nurbs::Vec2;
using nurbs::Vec3;
using reference::Random;
using reference::Rounds;
using Matrix = Eigen::Matrix4d;

constexpr double Infinity = std::numeric_limits<double>::infinity();
const nurbs::Box2 Everything(Vec2(0.0, 0.0), Vec2(1.0, 1.0));

/// Clip coordinates, built from what a camera is rather than from VTK's matrices.
struct Camera
{
  Vec3 Eye = Vec3::Zero(), Target = Vec3::Zero(), Up = Vec3::UnitZ();
  bool Parallel = false;
  double HalfHeight = 0.3; ///< Of the picture, at distance 1 (parallel: in units).
  double Near = 0.1, Far = 100.0;
  Vec2 WindowCenter = Vec2(0.0, 0.0); ///< The picture's middle, in halves of it.
  Vec3 ModelScale = Vec3::Ones();     ///< Of the model before all else.

  TileView View(int width, int height, double error) const
  {
    const Vec3 back = (this->Eye - this->Target).normalized();
    const Vec3 right = this->Up.cross(back).normalized();
    const Vec3 up = back.cross(right);
    Matrix view = Matrix::Identity();
    view.row(0).head<3>() = right.transpose();
    view.row(1).head<3>() = up.transpose();
    view.row(2).head<3>() = back.transpose();
    view.topRightCorner<3, 1>() = -view.topLeftCorner<3, 3>() * this->Eye;
    Matrix toClip = Matrix::Zero();
    toClip(0, 0) = double(height) / width / this->HalfHeight;
    toClip(1, 1) = 1.0 / this->HalfHeight;
    const double depth = this->Far - this->Near;
    if (this->Parallel)
    {
      toClip(2, 2) = -2.0 / depth;
      toClip(2, 3) = -(this->Far + this->Near) / depth;
      toClip(3, 3) = 1.0;
      toClip(0, 3) = -this->WindowCenter[0];
      toClip(1, 3) = -this->WindowCenter[1];
    }
    else
    {
      toClip(2, 2) = -(this->Far + this->Near) / depth;
      toClip(2, 3) = -2.0 * this->Far * this->Near / depth;
      toClip(3, 2) = -1.0;
      toClip(0, 2) = this->WindowCenter[0];
      toClip(1, 2) = this->WindowCenter[1];
    }
    Matrix scale = Matrix::Identity();
    scale.diagonal().head<3>() = this->ModelScale;
    TileView result;
    result.ModelToClip = toClip * view * scale;
    result.Size[0] = width;
    result.Size[1] = height;
    result.Near = this->Parallel ? 1.0 : this->Near;
    result.PixelError = error;
    return result;
  }
};

bool IsSeen(const TileView& view, const Vec3& p, double* pixel = nullptr)
{
  const nurbs::Vec4 c = view.ModelToClip * nurbs::Vec4(p[0], p[1], p[2], 1.0);
  for (int k = 0; k < 2 && pixel; ++k)
  {
    pixel[k] = 0.5 * view.Size[k] * c[k] / c[3];
  }
  return c[3] > 0.0 && c.head<3>().cwiseAbs().maxCoeff() <= c[3];
}

/// A surface in a table of its own.
struct Subject
{
  nurbs::Surface Shape;
  SurfaceTable Table;

  explicit Subject(nurbs::Surface shape)
    : Shape(std::move(shape))
    , Geometry(Shape.View())
  {
    this->Table.Add(this->Geometry, Everything);
    this->Table.Fill(0, 1);
  }
  Subject(const Subject&) = delete;

  TileSelection Select(const TileView& view) const
  {
    TileSelection selection;
    nurbs::SelectTiles(this->Table, 0, view, selection);
    return selection;
  }

  /// The parameter of t in [0, 1] of a span.
  double Parameter(int dir, int span, double t) const
  {
    const nurbs::Interval share = this->Table[0].Spans[dir][span];
    const nurbs::Interval domain = this->Geometry.Domain(dir);
    return domain.Min + (share.Min + t * share.Length()) * domain.Length();
  }
  Vec2 Parameters(const Tile& tile, double i, double j) const
  {
    return Vec2(this->Parameter(0, tile.Span[0], std::ldexp(tile.First[0] + i, -tile.Log[0])),
      this->Parameter(1, tile.Span[1], std::ldexp(tile.First[1] + j, -tile.Log[1])));
  }
  Vec3 Point(const Vec2& uv) const { return nurbs::Evaluate(this->Geometry, uv[0], uv[1]); }

  SurfaceView Geometry;
};

/// Shapes with poles, seams and creases, and wild surfaces near and far from the origin.
std::vector<std::unique_ptr<Subject>> Subjects(Random& random)
{
  std::vector<std::unique_ptr<Subject>> subjects;
  const auto add = [&](nurbs::Surface s) {
    subjects.push_back(std::make_unique<Subject>(std::move(s)));
  };
  add(reference::Sphere(2.0));
  add(reference::Torus(2.0, 0.7));
  add(reference::Cone(1.5, 3.0));
  add(reference::Cylinder(1.0, 4.0));
  add(reference::Quadric(1.0, -3.0));
  for (int k = 0; k < Rounds(10); ++k)
  {
    const Vec3 origin = k % 4 == 3 ? Vec3(1e5, -2e5, 3e4) : Vec3::Zero();
    add(reference::WildSurface(
      random, random.Integer(1, 6), random.Integer(1, 6), k % 2 == 0, origin));
  }
  return subjects;
}

double SizeOf(const Subject& subject)
{
  return 2.0 * subject.Table[0].Radius;
}

struct Shot
{
  TileView View;
  Vec2 Target = Vec2(0.0, 0.0); ///< Parameters of what is looked at.
};

/// Cameras around a surface: far, near, grazing, zoomed in, parallel, off its axis, stretched.
std::vector<Shot> Shots(const Subject& subject, Random& random)
{
  std::vector<Shot> shots;
  const double size = SizeOf(subject);
  for (int k = 0; k < 12; ++k)
  {
    const Vec2 uv(random.Parameter(subject.Geometry.Knots[0], subject.Geometry.Degree[0]),
      random.Parameter(subject.Geometry.Knots[1], subject.Geometry.Degree[1]));
    Camera camera;
    camera.ModelScale = k % 5 == 4 ? Vec3(1.0, 0.3, 2.0) : Vec3::Constant(k % 5 == 3 ? 3.0 : 1.0);
    camera.Target = subject.Point(uv).cwiseProduct(camera.ModelScale);
    const Vec3 direction =
      Vec3(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1)).normalized();
    const double distance = size * (k % 3 == 2 ? 0.02 : 2.0);
    camera.Eye = camera.Target + distance * direction;
    camera.Parallel = k % 4 == 1;
    const double zoom = k % 6 == 0 ? 1.0 : k % 6 < 4 ? 30.0 : 1000.0;
    camera.HalfHeight = (camera.Parallel ? 0.5 * size : 0.6) / (k % 3 == 2 ? 1.0 : zoom);
    camera.Near = distance * 0.01;
    camera.Far = distance + 10.0 * size;
    if (k >= 8)
    {
      camera.WindowCenter = Vec2(random.Uniform(-0.9, 0.9), random.Uniform(-0.9, 0.9));
    }
    const double error = k % 2 ? 0.5 : 2.0;
    shots.push_back({ camera.View(800, 600, error), uv });
  }
  return shots;
}

/// Most pixels between a triangle and the surface, at points that are both seen.
double LargestDistance(
  const Subject& subject, const TileView& view, const Tile& tile, int cellU, int cellV)
{
  double largest = 0.0;
  const Vec2 corners[2][3] = { { { 0, 0 }, { 1, 0 }, { 1, 1 } }, { { 0, 0 }, { 1, 1 }, { 0, 1 } } };
  for (const auto& triangle : corners)
  {
    Vec3 x[3];
    for (int k = 0; k < 3; ++k)
    {
      x[k] =
        subject.Point(subject.Parameters(tile, cellU + triangle[k][0], cellV + triangle[k][1]));
    }
    reference::Barycentric(5, [&](double a, double b, double c) {
      const Vec2 t = a * triangle[0] + b * triangle[1] + c * triangle[2];
      const Vec3 exact = subject.Point(subject.Parameters(tile, cellU + t[0], cellV + t[1]));
      double p[2], q[2];
      if (IsSeen(view, exact, p) && IsSeen(view, a * x[0] + b * x[1] + c * x[2], q))
      {
        largest = std::max(largest, std::hypot(p[0] - q[0], p[1] - q[1]));
      }
    });
  }
  return largest;
}

TEST(TileSelection, TrianglesAreWithinThePixelError)
{
  Random random(1);
  std::vector<double> shares;
  for (const auto& subject : Subjects(random))
  {
    for (const Shot& shot : Shots(*subject, random))
    {
      const TileSelection selection = subject->Select(shot.View);
      const double bound = std::max(shot.View.PixelError, selection.PixelError);
      for (int k = 0; k < 20 && !selection.Tiles.empty(); ++k)
      {
        const Tile& tile =
          selection.Tiles[std::size_t(random.Integer(0, int(selection.Tiles.size()) - 1))];
        const double distance =
          LargestDistance(*subject, shot.View, tile, random.Integer(0, (1 << tile.CellsLog(0)) - 1),
            random.Integer(0, (1 << tile.CellsLog(1)) - 1));
        EXPECT_LE(distance, bound * (1.0 + 1e-9) + 1e-6) << shot.View.ModelToClip;
        if (distance > 0.0)
        {
          shares.push_back(distance / bound);
        }
      }
    }
  }
  std::sort(shares.begin(), shares.end());
  std::printf("distance over the bound: median %.3f, worst %.3f of %zu cells\n",
    shares[shares.size() / 2], shares.back(), shares.size());
  EXPECT_GT(shares.back(), 0.5) << "the bound is far from what triangles need";
}

/// Cells of the finest grid; a place on it is an integer.
std::int64_t PlaceOf(const Tile& tile, int dir, int k)
{
  return (std::int64_t(tile.Span[dir]) << Tile::MaxSpanLog) +
    (std::int64_t(tile.First[dir] + k) << (Tile::MaxSpanLog - tile.Log[dir]));
}

/// A side of a tile: where it lies along its line, and how far its vertices are apart.
struct Side
{
  std::int64_t From, To, Step;
};

/// The place on screen of a point, in pixels.
Vec2 OnScreen(const TileView& view, const Vec3& p)
{
  double pixel[2];
  IsSeen(view, p, pixel);
  return Vec2(pixel[0], pixel[1]);
}

TEST(TileSelection, PixelsPerUnitBoundEveryStep)
{
  Random random(7);
  double largest = 0.0;
  for (int k = 0; k < Rounds(200); ++k)
  {
    Camera camera;
    camera.Eye = 5.0 * Vec3(random.Uniform(-1, 1), random.Uniform(-1, 1), 1.0);
    camera.Parallel = k % 4 == 1;
    camera.HalfHeight = camera.Parallel ? 3.0 : std::pow(10.0, random.Uniform(-2.0, 0.5));
    camera.WindowCenter = Vec2(random.Uniform(-3, 3), random.Uniform(-3, 3));
    camera.ModelScale = Vec3(random.Uniform(0.2, 3), random.Uniform(0.2, 3), 1.0);
    const TileView view = camera.View(800, 600, 0.5);
    const Matrix back = view.ModelToClip.inverse();
    double worst = 0.0;
    for (int n = 0; n < 500; ++n)
    {
      // Somewhere seen, its corners included, and a short step from there.
      const auto place = [&] { return std::min(1.0, std::max(-1.0, random.Uniform(-1.5, 1.5))); };
      const Vec3 p = (back * nurbs::Vec4(place(), place(), place(), 1.0)).hnormalized();
      const double w = view.ModelToClip.row(3).dot(p.homogeneous().transpose());
      const Vec3 step =
        1e-6 * w * Vec3(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1));
      const double pixels = (OnScreen(view, p + step) - OnScreen(view, p)).norm();
      worst = std::max(worst, pixels / (step.norm() * nurbs::PixelsPerUnit(view, w)));
    }
    EXPECT_LE(worst, 1.0 + 1e-4);
    largest = std::max(largest, worst);
  }
  EXPECT_GT(largest, 0.99);
}

TEST(TileSelection, HasNoVertexInsideASideOfANeighbour)
{
  Random random(2);
  std::size_t compared = 0;
  for (const auto& subject : Subjects(random))
  {
    for (const Shot& shot : Shots(*subject, random))
    {
      // The sides of all tiles, by the line of the surface that they are on.
      std::map<std::pair<int, std::int64_t>, std::vector<Side>> lines;
      for (const Tile& tile : subject->Select(shot.View).Tiles)
      {
        for (int dir = 0; dir < 2; ++dir)
        {
          const int along = 1 - dir;
          const Side side = { PlaceOf(tile, along, 0),
            PlaceOf(tile, along, 1 << tile.CellsLog(along)),
            std::int64_t(1) << (Tile::MaxSpanLog - tile.Log[along]) };
          lines[{ dir, PlaceOf(tile, dir, 0) }].push_back(side);
          lines[{ dir, PlaceOf(tile, dir, 1 << tile.CellsLog(dir)) }].push_back(side);
        }
      }
      for (auto& line : lines)
      {
        std::vector<Side>& sides = line.second;
        std::sort(
          sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.From < b.From; });
        for (std::size_t k = 1; k < sides.size(); ++k)
        {
          if (sides[k].From < sides[k - 1].To)
          {
            ++compared;
            EXPECT_EQ(sides[k].Step, sides[k - 1].Step);
            EXPECT_EQ((sides[k].From - sides[k - 1].From) % sides[k].Step, 0);
            EXPECT_TRUE(k < 2 || sides[k].From >= sides[k - 2].To) << "two tiles overlap";
          }
        }
      }
    }
  }
  EXPECT_GT(compared, 1000u);
}

/// True if a tile has the point t (shares of the spans) of a patch.
bool IsCovered(const std::vector<Tile>& tiles, int spanU, int spanV, const Vec2& t)
{
  return std::any_of(tiles.begin(), tiles.end(), [&](const Tile& tile) {
    bool inside = tile.Span[0] == spanU && tile.Span[1] == spanV;
    for (int dir = 0; dir < 2; ++dir)
    {
      const double cell = std::ldexp(t[dir], tile.Log[dir]) - tile.First[dir];
      inside = inside && cell >= 0.0 && cell <= (1 << tile.CellsLog(dir));
    }
    return inside;
  });
}

TEST(TileSelection, MissesNothingThatIsSeen)
{
  Random random(3);
  long seen = 0;
  for (const auto& subject : Subjects(random))
  {
    for (const Shot& shot : Shots(*subject, random))
    {
      const TileSelection selection = subject->Select(shot.View);
      for (int k = 0; k < 400; ++k)
      {
        // Anywhere, and near what is looked at, at every scale.
        Vec2 uv, t;
        int span[2] = { 0, 0 };
        for (int dir = 0; dir < 2; ++dir)
        {
          const nurbs::Interval domain = subject->Geometry.Domain(dir);
          const double reach = k % 2 ? std::pow(10.0, random.Uniform(-6.0, 0.0)) : 1.0;
          uv[dir] =
            domain.Clamp(shot.Target[dir] + random.Uniform(-1, 1) * reach * domain.Length());
          const auto& spans = subject->Table[0].Spans[dir];
          const double share = (uv[dir] - domain.Min) / domain.Length();
          while (span[dir] + 1 < int(spans.size()) && share >= spans[std::size_t(span[dir])].Max)
          {
            ++span[dir];
          }
          const nurbs::Interval& s = spans[std::size_t(span[dir])];
          t[dir] = std::min(1.0, std::max(0.0, (share - s.Min) / s.Length()));
        }
        if (IsSeen(shot.View, subject->Point(uv)))
        {
          ++seen;
          EXPECT_TRUE(IsCovered(selection.Tiles, span[0], span[1], t));
        }
      }
    }
  }
  std::printf("%ld points are seen\n", seen);
  EXPECT_GT(seen, Rounds(20000));
}

/// The least distance of samples of a tile from the picture, in halves of the picture: 0 if one is
/// seen.
double DistanceFromPicture(const Subject& subject, const TileView& view, const Tile& tile)
{
  constexpr int N = 12;
  double least = Infinity;
  for (int k = 0; k < (N + 1) * (N + 1); ++k)
  {
    const Vec3 p =
      subject.Point(subject.Parameters(tile, double(k % (N + 1)) / N * (1 << tile.CellsLog(0)),
        double(k / (N + 1)) / N * (1 << tile.CellsLog(1))));
    const nurbs::Vec4 c = view.ModelToClip * nurbs::Vec4(p[0], p[1], p[2], 1.0);
    least =
      std::min(least, std::max(0.0, c.head<3>().cwiseAbs().maxCoeff() / std::abs(c[3]) - 1.0));
  }
  return least;
}

TEST(TileSelection, LeavesOutWhatIsOffScreen)
{
  Random random(4);
  long seen = 0, unseen = 0;
  double farthest = 0.0;
  for (const auto& subject : Subjects(random))
  {
    for (const Shot& shot : Shots(*subject, random))
    {
      const TileSelection selection = subject->Select(shot.View);
      const std::size_t stride = selection.Tiles.size() / 100 + 1;
      for (std::size_t k = 0; k < selection.Tiles.size(); k += stride)
      {
        const Tile& tile = selection.Tiles[k];
        // A span that is a single tile is left out by its control points, not by its own extent.
        if (std::max(tile.Log[0], tile.Log[1]) > Tile::MaxLog)
        {
          const double distance = DistanceFromPicture(*subject, shot.View, tile);
          ++(distance == 0.0 ? seen : unseen);
          farthest = std::max(farthest, distance);
        }
      }
    }
  }
  std::printf("%ld tiles are seen, %ld are not, the farthest %.3g halves of a picture away\n", seen,
    unseen, farthest);
  EXPECT_LT(unseen, seen / 2);
}

TEST(TileSelection, SelectsNothingBehindOrBeside)
{
  const Subject sphere(reference::Sphere(1.0));
  Camera camera;
  camera.Eye = Vec3(5.0, 0.0, 0.0);
  EXPECT_FALSE(sphere.Select(camera.View(800, 600, 0.5)).Tiles.empty());
  camera.Target = Vec3(10.0, 0.0, 0.0);
  EXPECT_TRUE(sphere.Select(camera.View(800, 600, 0.5)).Tiles.empty());
  camera.Target = Vec3(5.0, 10.0, 0.0);
  EXPECT_TRUE(sphere.Select(camera.View(800, 600, 0.5)).Tiles.empty());
  camera.Target = Vec3::Zero();
  camera.Far = 3.0;
  EXPECT_TRUE(sphere.Select(camera.View(800, 600, 0.5)).Tiles.empty());
}

TEST(TileSelection, TellsWhenItCannotKeepTheBound)
{
  const Subject sphere(reference::Sphere(1.0));
  Camera camera;
  camera.Eye = Vec3(1.0 + 1e-6, 0.0, 0.0);
  camera.Near = 1e-9;
  const TileSelection selection = sphere.Select(camera.View(800, 600, 0.5));
  EXPECT_GT(selection.PixelError, 0.5);
  EXPECT_LT(selection.Tiles.size(), 1u << 16);
}

} // namespace
