// SPDX-License-Identifier: BSD-3-Clause
#include "TileSelection.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

// Signed distances (up to a factor) of a box from the six planes of the view's frustum.
bool IsOutside(const Eigen::Matrix4d& m, const Box3& box)
{
  const Vec3 center = box.center(), half = 0.5 * box.sizes();
  const Eigen::RowVector4d w = m.row(3);
  for (int k = 0; k < 3; ++k)
  {
    for (const double sign : { 1.0, -1.0 })
    {
      const Eigen::RowVector4d plane = w + sign * m.row(k);
      const Vec3 n = plane.head<3>().transpose();
      if (n.dot(center) + plane[3] + n.cwiseAbs().dot(half) < 0.0)
      {
        return true;
      }
    }
  }
  return false;
}

double LeastDepth(const Eigen::Matrix4d& m, const Box3& box)
{
  const Vec3 n = m.row(3).head<3>().transpose();
  return n.dot(box.center()) + m(3, 3) - n.cwiseAbs().dot(0.5 * box.sizes());
}

// Bound of the distance of triangles with 2^-log cells from the surface.
double Bow(const std::array<float, 3>& second, const int (&log)[2])
{
  const double a = std::ldexp(1.0, -log[0]), b = std::ldexp(1.0, -log[1]);
  return (a * a * second[0] + 2.0 * a * b * second[1] + b * b * second[2]) / 8.0;
}

int LogFor(double second, double tolerance)
{
  const double ratio = second / (8.0 * tolerance);
  return ratio <= 1.0 ? 0 : int(std::ceil(0.5 * std::log2(ratio)));
}

// Selects the tiles of one surface.
class SurfaceTiles
{
public:
  SurfaceTiles(const SurfaceTable& table, int index, const TileView& view, TileSelection& selection)
    : Surface(table[index])
    , Index(index)
    , View(view)
    , Selection(selection)
    , Domain{ Surface.View.Domain(0), Surface.View.Domain(1) }
    , Pixels(PixelsPerUnit(view, 1.0))
  {}

  void Select()
  {
    for (int dir = 0; dir < 2; ++dir)
    {
      this->Logs[dir].assign(this->Surface.Spans[dir].size(), -1);
    }
    const auto& used = this->Surface.Used;
    for (int j = used[1][0]; j < used[1][1]; ++j)
    {
      for (int i = used[0][0]; i < used[0][1]; ++i)
      {
        this->Refine(i, j);
      }
    }
    for (int j = used[1][0]; j < used[1][1]; ++j)
    {
      for (int i = used[0][0]; i < used[0][1]; ++i)
      {
        this->Emit(i, j);
      }
    }
  }

private:
  // A rectangle of a patch: shares of its spans.
  struct Part
  {
    double U, V, A, B;
  };
  static constexpr Part Whole = { 0.0, 0.0, 1.0, 1.0 };

  Box3 PatchBox(int i, int j) const
  {
    const PatchBound& patch = this->Surface.Patch(i, j);
    return { patch.Box.min().cast<double>() + this->Surface.Origin,
      patch.Box.max().cast<double>() + this->Surface.Origin };
  }

  // The box of a part: its corners' box, widened by what the surface bows out of the corners' hull.
  Box3 PartBox(int i, int j, const Part& part) const
  {
    Box3 box;
    for (int corner = 0; corner < 4; ++corner)
    {
      double t[2] = { part.U + (corner & 1) * part.A, part.V + (corner >> 1) * part.B };
      const int span[2] = { i, j };
      for (int dir = 0; dir < 2; ++dir)
      {
        const Interval& share = this->Surface.Spans[dir][span[dir]];
        t[dir] = this->Domain[dir].Min +
          (share.Min + t[dir] * share.Length()) * this->Domain[dir].Length();
      }
      box.extend(Evaluate(this->Surface.View, t[0], t[1]));
    }
    const auto& s = this->Surface.Patch(i, j).Second;
    const double bow =
      (part.A * part.A * s[0] + 2.0 * part.A * part.B * s[1] + part.B * part.B * s[2]) / 8.0;
    box.min().array() -= bow;
    box.max().array() += bow;
    return box;
  }

  bool IsTrimmedAway(int i, int j, const Part& part) const
  {
    const Interval& u = this->Surface.Spans[0][i];
    const Interval& v = this->Surface.Spans[1][j];
    const Vec2 low(u.Min + part.U * u.Length(), v.Min + part.V * v.Length());
    const Vec2 high = low + Vec2(part.A * u.Length(), part.B * v.Length());
    return !this->Surface.Left.intersects(Box2(low, high));
  }

  // Least depth of what is seen of a part; infinite if nothing is. Parts that reach over much depth
  // are halved, since their least depth alone would refine them too much.
  double SeenDepth(int i, int j, const Part& part, const Box3& box, int depth) const
  {
    const Eigen::Matrix4d& m = this->View.ModelToClip;
    if (IsOutside(m, box))
    {
      return std::numeric_limits<double>::infinity();
    }
    const double least = std::max(LeastDepth(m, box), this->View.Near);
    const Vec3 n = m.row(3).head<3>().transpose();
    const double range = n.cwiseAbs().dot(box.sizes());
    if (range <= 0.25 * least || depth == 0)
    {
      return least;
    }
    double result = std::numeric_limits<double>::infinity();
    for (int child = 0; child < 4; ++child)
    {
      const Part half = { part.U + 0.5 * (child & 1) * part.A, part.V + 0.5 * (child >> 1) * part.B,
        0.5 * part.A, 0.5 * part.B };
      result = std::min(result, this->SeenDepth(i, j, half, this->PartBox(i, j, half), depth - 1));
    }
    return result;
  }

  // Raises the numbers of cells of column i and row j to what patch (i, j) needs.
  void Refine(int i, int j)
  {
    const Box3 box = this->PatchBox(i, j);
    if (IsOutside(this->View.ModelToClip, box))
    {
      return;
    }
    const auto& second = this->Surface.Patch(i, j).Second;
    double scale =
      this->Pixels / std::max(LeastDepth(this->View.ModelToClip, box), this->View.Near);
    const int coarse[2] = { Tile::MaxLog, Tile::MaxLog };
    if (Bow(second, coarse) * scale > this->View.PixelError)
    {
      const double w = this->SeenDepth(i, j, Whole, box, 4);
      if (!std::isfinite(w))
      {
        return;
      }
      scale = this->Pixels / w;
    }
    const double tolerance = this->View.PixelError / scale;
    int log[2] = { LogFor(second[0], tolerance), LogFor(second[2], tolerance) };
    log[0] = std::min(log[0], Tile::MaxSpanLog);
    log[1] = std::min(log[1], Tile::MaxSpanLog);
    while (Bow(second, log) > tolerance)
    {
      int more[2][2] = { { log[0] + 1, log[1] }, { log[0], log[1] + 1 } };
      const bool full[2] = { log[0] >= Tile::MaxSpanLog, log[1] >= Tile::MaxSpanLog };
      if (full[0] && full[1])
      {
        break;
      }
      const int dir = full[0] || (!full[1] && Bow(second, more[1]) < Bow(second, more[0]));
      ++log[dir];
    }
    this->Selection.PixelError = std::max(this->Selection.PixelError, Bow(second, log) * scale);
    this->Logs[0][i] = std::max(this->Logs[0][i], log[0]);
    this->Logs[1][j] = std::max(this->Logs[1][j], log[1]);
  }

  void Emit(int i, int j)
  {
    const int log[2] = { this->Logs[0][i], this->Logs[1][j] };
    const Box3 box = this->PatchBox(i, j);
    if (log[0] >= 0 && log[1] >= 0 && !IsOutside(this->View.ModelToClip, box))
    {
      const int tiles[2] = { std::max(log[0] - Tile::MaxLog, 0),
        std::max(log[1] - Tile::MaxLog, 0) };
      this->Emit(i, j, log, 0, 0, tiles);
    }
  }

  // The tiles of a block of 2^left[0] x 2^left[1] tiles at (x, y), by halves.
  void Emit(int i, int j, const int (&log)[2], int x, int y, const int (&left)[2])
  {
    if (left[0] < std::max(log[0] - Tile::MaxLog, 0) ||
      left[1] < std::max(log[1] - Tile::MaxLog, 0))
    {
      const double tile[2] = { std::ldexp(1.0, std::min(Tile::MaxLog - log[0], 0)),
        std::ldexp(1.0, std::min(Tile::MaxLog - log[1], 0)) };
      const Part part = { x * tile[0], y * tile[1], std::ldexp(tile[0], left[0]),
        std::ldexp(tile[1], left[1]) };
      if (this->IsTrimmedAway(i, j, part) ||
        IsOutside(this->View.ModelToClip, this->PartBox(i, j, part)))
      {
        return;
      }
    }
    if (left[0] == 0 && left[1] == 0)
    {
      Tile tile;
      tile.Surface = this->Index;
      tile.Span[0] = i;
      tile.Span[1] = j;
      for (int dir = 0; dir < 2; ++dir)
      {
        tile.Log[dir] = log[dir];
        tile.First[dir] = (dir == 0 ? x : y) << Tile::MaxLog;
      }
      this->Selection.Cells += std::int64_t(1) << (tile.CellsLog(0) + tile.CellsLog(1));
      this->Selection.Tiles.push_back(tile);
      return;
    }
    const int dir = left[1] > left[0];
    int half[2] = { left[0], left[1] };
    --half[dir];
    const int step = 1 << half[dir];
    this->Emit(i, j, log, x, y, half);
    this->Emit(i, j, log, dir == 0 ? x + step : x, dir == 1 ? y + step : y, half);
  }

  const TableSurface& Surface;
  int Index;
  const TileView& View;
  TileSelection& Selection;
  Interval Domain[2];
  double Pixels;            ///< Of a unit of length at depth 1.
  std::vector<int> Logs[2]; ///< Of each column and row; -1: nothing of it is seen.
};

} // namespace

bool Tile::operator==(const Tile& o) const
{
  return this->Surface == o.Surface && std::equal(this->Span, this->Span + 2, o.Span) &&
    std::equal(this->Log, this->Log + 2, o.Log) &&
    std::equal(this->First, this->First + 2, o.First);
}

double PixelsPerUnit(const TileView& view, double w)
{
  // A step d from a point at (x, y) of the picture, -1 to 1, moves it by
  //   ((m_x - x m_w) d, (m_y - y m_w) d) / w
  // halves of the picture. The norm of that map is convex in (x, y): greatest at a corner.
  const Eigen::Matrix4d& m = view.ModelToClip;
  double most = 0.0;
  for (int corner = 0; corner < 4; ++corner)
  {
    Vec3 row[2];
    for (int k = 0; k < 2; ++k)
    {
      const double place = (corner >> k) & 1 ? 1.0 : -1.0;
      row[k] = 0.5 * view.Size[k] * (m.row(k) - place * m.row(3)).head<3>().transpose();
    }
    const double a = row[0].squaredNorm(), b = row[0].dot(row[1]), c = row[1].squaredNorm();
    most = std::max(most, 0.5 * (a + c + std::hypot(a - c, 2.0 * b))); // the norm's square
  }
  return std::sqrt(most) / w;
}

void SelectTiles(
  const SurfaceTable& table, int surface, const TileView& view, TileSelection& selection)
{
  const TableSurface& s = table[surface];
  if (s.IsDrawable() && !s.Bounds.isEmpty() && !IsOutside(view.ModelToClip, s.Bounds))
  {
    SurfaceTiles(table, surface, view, selection).Select();
  }
}

} // namespace nurbs
