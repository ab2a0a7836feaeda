// SPDX-License-Identifier: BSD-3-Clause
// A synthetic load with the make-up of a car body: many bicubic faces, shared boundaries, holes of
// many sizes, and faces that fill a hole. It stands in for the models of 8,036 and 31,040 trimmed
// patches of Balazs, Guthe and Klein (2004), which are not public.
#include "PatchStitcher.h"
#include "Shapes.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{
namespace
{

constexpr double Pi = 3.14159265358979323846;
constexpr double Length = 4400.0; // mm
constexpr int Cells = 2;          ///< Hermite cells a patch and direction.
constexpr int Net = 2 * Cells + 2;
constexpr int Segments = 8; ///< Cubic segments of a hole's outline and of its edge.

/// A hash of two numbers, uniform in 64 bits (splitmix64): the load's only randomness.
std::uint64_t Hash(std::uint64_t a, std::uint64_t b)
{
  std::uint64_t z = a * 0x9E3779B97F4A7C15ull + b * 0xD1B54A32D192ED03ull + 0x632BE59BD9B4E019ull;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  return z ^ (z >> 31);
}

/// The b-th random number in [0, 1) of tile a.
double Random(std::uint64_t a, std::uint64_t b)
{
  return static_cast<double>(Hash(a, b) >> 11) * 0x1.0p-53;
}

/// The body: s from bonnet to boot, t from one sill over the roof to the other.
Vec3 Body(double s, double t)
{
  const double end = std::pow(2.0 * s - 1.0, 6);
  const double width = 850.0 * (1.0 - 0.25 * end);
  const double cabin = std::exp(-std::pow((s - 0.55) / 0.21, 4));
  const double height = 520.0 + 110.0 * std::sin(Pi * s) + 520.0 * cabin;
  const double c = std::cos(Pi * t), h = std::sin(Pi * t);
  return Vec3(Length * (s - 0.5), -width * c * (1.0 + 0.18 * h * h),
    150.0 + height * h * (1.0 + 0.1 * c * c));
}

/// What a tile of the body becomes.
enum class TileKind
{
  Plain,   ///< No hole.
  Holes,   ///< One to three holes.
  Pattern, ///< Six to sixteen.
  Plugged  ///< One hole, and a second face that fills it.
};

TileKind KindOf(std::int64_t tile)
{
  const double r = Random(tile, 0);
  return r < 0.35
    ? TileKind::Plain
    : (r < 0.65 ? TileKind::Holes : (r < 0.75 ? TileKind::Pattern : TileKind::Plugged));
}

int HoleCount(std::int64_t tile)
{
  switch (KindOf(tile))
  {
    case TileKind::Plain:
      return 0;
    case TileKind::Holes:
      return 1 + static_cast<int>(3.0 * Random(tile, 1));
    case TileKind::Pattern:
      return 6 + static_cast<int>(11.0 * Random(tile, 1));
    case TileKind::Plugged:
      break;
  }
  return 1;
}

/// Positions on a regular grid over the body, one ring wider than it, and their differences: cubic
/// Hermite data whose tiles join C1.
class BodyGrid
{
public:
  BodyGrid(std::int64_t columns, std::int64_t rows)
    : Columns(columns * Cells)
    , Rows(rows * Cells)
  {
    this->Nodes.reserve((this->Columns + 3) * (this->Rows + 3));
    for (std::int64_t j = -1; j <= this->Rows + 1; ++j)
    {
      for (std::int64_t i = -1; i <= this->Columns + 1; ++i)
      {
        this->Nodes.push_back(
          Body(static_cast<double>(i) / this->Columns, static_cast<double>(j) / this->Rows));
      }
    }
  }

  /// The Bezier control point beside node (i, j) towards (a, b), each -1, 0 or 1.
  Vec3 Control(std::int64_t i, std::int64_t j, int a, int b) const
  {
    const Vec3 ds = 0.5 * (this->At(i + 1, j) - this->At(i - 1, j));
    const Vec3 dt = 0.5 * (this->At(i, j + 1) - this->At(i, j - 1));
    const Vec3 twist = 0.25 *
      ((this->At(i + 1, j + 1) - this->At(i - 1, j + 1)) -
        (this->At(i + 1, j - 1) - this->At(i - 1, j - 1)));
    return this->At(i, j) + (a / 3.0) * ds + (b / 3.0) * dt + (a * b / 9.0) * twist;
  }

private:
  const Vec3& At(std::int64_t i, std::int64_t j) const
  {
    return this->Nodes[(i + 1) + (j + 1) * (this->Columns + 3)];
  }
  std::int64_t Columns, Rows;
  std::vector<Vec3> Nodes;
};

/// Knots of a C1 cubic of `cells` Hermite cells over [0, cells * step].
std::vector<double> HermiteKnots(int cells, double step)
{
  std::vector<double> knots(4, 0.0);
  for (int i = 1; i < cells; ++i)
  {
    knots.insert(knots.end(), 2, i * step);
  }
  knots.insert(knots.end(), 4, cells * step);
  return knots;
}

/// Control point k of such a cubic lies beside this node, on this side.
int HermiteNode(int k)
{
  return k / 2;
}
int HermiteSide(int k, int cells)
{
  return k == 0 || k == 2 * cells + 1 ? 0 : (k % 2 == 1 ? 1 : -1);
}

/// The patch of the tile in column `column` and row `row`: degree 3, 6 x 6 control points over
/// [0, 2] x [0, 2].
Surface TilePatch(const BodyGrid& grid, std::int64_t column, std::int64_t row)
{
  Surface patch;
  for (int dir = 0; dir < 2; ++dir)
  {
    patch.Degree[dir] = 3;
    patch.Count[dir] = Net;
    patch.Knots[dir] = HermiteKnots(Cells, 1.0);
  }
  for (int j = 0; j < Net; ++j)
  {
    for (int i = 0; i < Net; ++i)
    {
      // k = 0, 1 lie beside node 0; 2, 3 beside node 1; 4, 5 beside node 2.
      patch.Points.push_back(grid.Control(column * Cells + HermiteNode(i),
        row * Cells + HermiteNode(j), HermiteSide(i, Cells), HermiteSide(j, Cells)));
    }
  }
  return patch;
}

/// The C1 cubic through `values` with these derivatives, `step` apart in the parameter.
template <int D>
Curve<D> HermiteCurve(
  const std::vector<Vec<D>>& values, const std::vector<Vec<D>>& derivatives, double step)
{
  const int cells = static_cast<int>(values.size()) - 1;
  Curve<D> curve;
  curve.Degree = 3;
  curve.Knots = HermiteKnots(cells, step);
  for (int k = 0; k < 2 * cells + 2; ++k)
  {
    const int node = HermiteNode(k);
    curve.Points.push_back(values[node] + (step / 3.0 * HermiteSide(k, cells)) * derivatives[node]);
    curve.Weights.push_back(1.0);
  }
  curve.Pack();
  return curve;
}

/// A rounded outline with three bulges inside the circle of `radius`, counter-clockwise, over
/// [0, 8].
Curve<2> Blob(const Vec2& center, double radius, double phase)
{
  std::vector<Vec2> values, derivatives;
  for (int k = 0; k <= Segments; ++k)
  {
    const double angle = 2.0 * Pi * (k % Segments) / Segments;
    const Vec2 direction(std::cos(angle), std::sin(angle));
    const double r = radius * (0.8 + 0.2 * std::cos(3.0 * angle + phase));
    const double dr = -0.6 * radius * std::sin(3.0 * angle + phase);
    values.push_back(center + r * direction);
    derivatives.push_back(
      (2.0 * Pi / Segments) * (dr * direction + r * Vec2(-direction[1], direction[0])));
  }
  return HermiteCurve<2>(values, derivatives, 1.0);
}

/// The outline of hole `k` of `count` in a tile, in a slot of its own.
Curve<2> HoleOutline(std::int64_t tile, int k, int count)
{
  const int slots = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count))));
  const double size = static_cast<double>(Cells) / slots;
  const std::uint64_t seed = 16 + 8 * static_cast<std::uint64_t>(k);
  const double radius = size * (0.1 + 0.33 * Random(tile, seed));
  const double slack = 0.9 * (0.5 * size - radius);
  const Vec2 center((k % slots + 0.5) * size + slack * (2.0 * Random(tile, seed + 1) - 1.0),
    (k / slots + 0.5) * size + slack * (2.0 * Random(tile, seed + 2) - 1.0));
  return Random(tile, seed + 3) < 0.5 ? TrimCircle(center, radius)
                                      : Blob(center, radius, 6.0 * Random(tile, seed + 4));
}

/// A closed trim curve lifted to a C1 cubic; `deviation` receives 1.5 times its largest distance in
/// the segments' middles, where the error of a cubic Hermite fit peaks.
Curve<3> FitLifted(const SurfaceView& patch, const CurveView<2>& trim, double& deviation)
{
  const Interval range = trim.Domain();
  const double step = range.Length() / Segments;
  std::vector<Vec3> values, derivatives;
  for (int k = 0; k <= Segments; ++k)
  {
    Vec2 c[2];
    EvaluateDerivatives(trim, range.Min + (k % Segments) * step, 1, c);
    const SurfaceDerivatives s = EvaluateDerivatives(patch, c[0][0], c[0][1], 1);
    values.push_back(s.S);
    derivatives.push_back(c[1][0] * s.Su + c[1][1] * s.Sv);
  }
  const Curve<3> fit = HermiteCurve<3>(values, derivatives, step);
  deviation = 0.0;
  for (int k = 0; k < Segments; ++k)
  {
    const double t = range.Min + (k + 0.5) * step;
    const Vec2 c = Evaluate(trim, t);
    deviation =
      std::max(deviation, 1.5 * (Evaluate(fit.View(), t) - Evaluate(patch, c[0], c[1])).norm());
  }
  return fit;
}

/// Adds a hole to the current face. Returns its edge.
std::int64_t AddHole(PatchStitcher& stitcher, const Surface& patch, const Curve<2>& outline)
{
  double deviation = 0.0;
  const Curve<3> fit = FitLifted(patch.View(), outline.View(), deviation);
  const std::int64_t vertex = stitcher.Vertex(fit.Points.front());
  const std::int64_t edge =
    stitcher.GetBuilder().AddEdge(fit.View(), deviation + stitcher.GetTolerance(), vertex, vertex);
  stitcher.GetBuilder().BeginLoop();
  stitcher.GetBuilder().AddTrimCurve(outline.View(), edge, true);
  return edge;
}

FaceAttributes Attributes(std::int64_t tile)
{
  FaceAttributes attributes;
  attributes.Name = "panel";
  const auto shade = static_cast<std::uint8_t>(150.0 + 60.0 * Random(tile, 2));
  attributes.Color = { { shade, static_cast<std::uint8_t>(shade - 20), 90 } };
  return attributes;
}

void AddTile(PatchStitcher& stitcher, const Surface& patch, std::int64_t tile, bool plug)
{
  stitcher.AddFace(patch, Attributes(tile));
  const int holes = HoleCount(tile);
  for (int k = 0; k < holes; ++k)
  {
    const Curve<2> outline = HoleOutline(tile, k, holes);
    const std::int64_t edge = AddHole(stitcher, patch, outline);
    if (plug)
    {
      FaceAttributes attributes;
      attributes.Name = "plug";
      attributes.Color = { { 60, 80, 110 } };
      stitcher.GetBuilder().BeginFace(patch.View(), attributes);
      stitcher.GetBuilder().BeginLoop();
      stitcher.GetBuilder().AddTrimCurve(outline.View(), edge, false);
    }
  }
}

} // namespace

void AddCarBody(ModelBuilder& builder, std::int64_t faces)
{
  if (faces < 1 || faces > 10000000)
  {
    throw Error("a car body has 1 to 10,000,000 faces, not " + std::to_string(faces));
  }
  std::int64_t tiles = 0;
  for (std::int64_t made = 0; made < faces; ++tiles)
  {
    made += KindOf(tiles) == TileKind::Plugged ? 2 : 1;
  }
  const auto columns = static_cast<std::int64_t>(std::ceil(std::sqrt(1.4 * tiles)));
  const BodyGrid grid(columns, (tiles + columns - 1) / columns);
  PatchStitcher stitcher(builder, 1e-12 * Length);
  std::int64_t left = faces;
  for (std::int64_t tile = 0; tile < tiles; ++tile)
  {
    const bool plug = KindOf(tile) == TileKind::Plugged && left >= 2;
    AddTile(stitcher, TilePatch(grid, tile % columns, tile / columns), tile, plug);
    left -= plug ? 2 : 1;
  }
}

} // namespace nurbs
