// SPDX-License-Identifier: BSD-3-Clause
#include "PatchVertices.h"

#include "EvaluatorKernel.h"
#include "Multiversion.h"

namespace nurbs
{

namespace
{

constexpr int SumSize = 12; // H, H_u, H_v.

// Inner sums over u of every row of the net, for every line of the column that is used: value and u
// derivative, 8 numbers a row.
struct LineSums
{
  std::vector<char> Needed;
  std::vector<double> Values;
};

template <typename Quad>
NURBS_INLINE void SumLines(const PatchUpdate& update, int column, int rows, LineSums& lines)
{
  const GridAxis& axis = update.Grid->Axis[0];
  const int p = axis.Degree();
  const Vec4* net = update.Net + std::size_t(update.FirstRow) * (p + 1);
  for (std::size_t i = 0; i < lines.Needed.size(); ++i)
  {
    if (!lines.Needed[i])
    {
      continue;
    }
    const double* N = axis.Basis(column, int(i));
    double* to = lines.Values.data() + i * rows * 8;
    for (int r = 0; r < rows; ++r)
    {
      const Vec4* row = net + r * (p + 1);
      Quad point = Quad::Load(row[0].data());
      Quad value = N[0] * point;
      Quad slope = N[p + 1] * point;
      for (int s = 1; s <= p; ++s)
      {
        point = Quad::Load(row[s].data());
        value = value + N[s] * point;
        slope = slope + N[p + 1 + s] * point;
      }
      value.Store(to + 8 * r);
      slope.Store(to + 8 * r + 4);
    }
  }
}

// The outer sums of one vertex.
template <typename Quad>
NURBS_INLINE void SumRows(
  const double* sums, const double* N, const double* dN, int rows, Quad& h, Quad& hu, Quad& hv)
{
  for (int r = 0; r < rows; ++r)
  {
    const Quad value = Quad::Load(sums + 8 * r);
    h = h + N[r] * value;
    hu = hu + N[r] * Quad::Load(sums + 8 * r + 4);
    hv = hv + dN[r] * value;
  }
}

template <typename Quad>
NURBS_INLINE void StoreVertices(const Quad (&xyz)[4], const Quad (&normal)[4], int count,
  const std::int32_t* places, double sign, double* points, float* normals)
{
  double x[3][4];
  double n[3][4];
  for (int k = 0; k < 3; ++k)
  {
    xyz[k].Store(x[k]);
    (sign * normal[k]).Store(n[k]);
  }
  for (int m = 0; m < count; ++m)
  {
    double* point = points + 3 * std::int64_t(places[m]);
    float* direction = normals + 3 * std::int64_t(places[m]);
    for (int k = 0; k < 3; ++k)
    {
      point[k] = x[k][m];
      direction[k] = float(n[k][m]);
    }
  }
}

struct Loop
{
  const PatchUpdate& Update;
  PatchVertices& Vertices;
  std::size_t Begin;
  const LineSums& Lines;
  int Rows;
  const DirectionTables (&Directions)[2];
  double* Points;
  float* Normals;
  std::vector<std::int32_t>& Careful;
};

template <typename Quad>
NURBS_INLINE void RunLoop(const Loop& loop)
{
  const PatchUpdate& update = loop.Update;
  PatchVertices& vertices = loop.Vertices;
  const GridAxis& axis = update.Grid->Axis[1];
  const int row = update.Grid->Row(update.Patch);
  const int q = axis.Degree();
  const double sign = update.Reversed ? -1.0 : 1.0;
  const std::size_t count = vertices.Size();
  for (std::size_t first = loop.Begin; first < count; first += 4)
  {
    const int some = int(std::min<std::size_t>(4, count - first));
    Quad h[4] = {};
    Quad hu[4] = {};
    Quad hv[4] = {};
    for (int k = 0; k < some; ++k)
    {
      const std::size_t at = first + k;
      double* kept = vertices.Sums.data() + at * SumSize;
      if (update.Accumulate)
      {
        h[k] = Quad::Load(kept);
        hu[k] = Quad::Load(kept + 4);
        hv[k] = Quad::Load(kept + 8);
      }
      const double* N = axis.Basis(row, vertices.J[at]) + update.FirstRow;
      SumRows<Quad>(loop.Lines.Values.data() + std::size_t(vertices.I[at]) * loop.Rows * 8, N,
        N + q + 1, loop.Rows, h[k], hu[k], hv[k]);
      if (update.Keep)
      {
        h[k].Store(kept);
        hu[k].Store(kept + 4);
        hv[k].Store(kept + 8);
      }
    }
    Quad normal[4];
    const int careful = Project(loop.Directions, update.Rational, true, h, hu, hv, normal);
    StoreVertices(h, normal, some, vertices.Points.data() + first, sign, loop.Points, loop.Normals);
    for (int k = 0; careful != 0 && k < some; ++k)
    {
      if (careful >> k & 1)
      {
        loop.Careful.push_back(std::int32_t(first + k));
      }
    }
  }
}

template <typename Quad>
NURBS_INLINE void RunAll(const Loop& loop, LineSums& lines, int column)
{
  SumLines<Quad>(loop.Update, column, loop.Rows, lines);
  RunLoop<Quad>(loop);
}

NURBS_MULTIVERSION
void RunWide(const Loop& loop, LineSums& lines, int column)
{
  RunAll<WideLanes>(loop, lines, column);
}

} // namespace

std::vector<std::int32_t> UpdateVertices(const PatchUpdate& update, PatchVertices& vertices,
  std::size_t begin, double* points, float* normals)
{
  std::vector<std::int32_t> careful;
  const int column = update.Grid->Column(update.Patch);
  const int rows = update.LastRow - update.FirstRow + 1;
  thread_local LineSums lines; // Kept for its memory.
  lines.Needed.assign(update.Grid->Axis[0].Lines(column), 0);
  for (std::size_t k = begin; k < vertices.Size(); ++k)
  {
    lines.Needed[vertices.I[k]] = 1;
  }
  lines.Values.resize(lines.Needed.size() * rows * 8);
  if (update.Keep && !update.Accumulate)
  {
    vertices.Sums.resize(vertices.Size() * SumSize);
  }
  DirectionTables directions[2];
  directions[0].Suspicious = update.Shortest[0];
  directions[1].Suspicious = update.Shortest[1];
  const Loop loop{ update, vertices, begin, lines, rows, directions, points, normals, careful };
  HasWideClones() ? RunWide(loop, lines, column) : RunAll<NarrowLanes>(loop, lines, column);
  return careful;
}

void SumVertex(
  const double* basisU, int p, const double* basisV, int q, const Vec4* net, Vec4 (&h)[3])
{
  h[0] = h[1] = h[2] = Vec4::Zero();
  for (int t = 0; t <= q; ++t)
  {
    Vec4 value = Vec4::Zero();
    Vec4 slope = Vec4::Zero();
    for (int s = 0; s <= p; ++s)
    {
      value += basisU[s] * net[s + t * (p + 1)];
      slope += basisU[p + 1 + s] * net[s + t * (p + 1)];
    }
    h[0] += basisV[t] * value;
    h[1] += basisV[t] * slope;
    h[2] += basisV[q + 1 + t] * value;
  }
}

bool FinishVertex(const Vec4 (&h)[3], bool rational, bool reversed, const double (&shortest)[2],
  double* point, float* normal)
{
  const double w = rational ? h[0][3] : 1.0;
  const Vec3 x = h[0].head<3>() / w;
  Vec3 u = h[1].head<3>();
  Vec3 v = h[2].head<3>();
  if (rational)
  {
    u -= h[1][3] * x;
    v -= h[2][3] * x;
  }
  const Vec3 n = u.cross(v);
  const double area = n.squaredNorm();
  std::copy_n(x.data(), 3, point);
  const Vec3 unit = (reversed ? -1.0 : 1.0) / std::sqrt(area) * n;
  for (int k = 0; k < 3; ++k)
  {
    normal[k] = float(unit[k]);
  }
  constexpr double sine = SuspiciousFraction * SuspiciousFraction;
  return u.squaredNorm() > shortest[0] * w * w && v.squaredNorm() > shortest[1] * w * w &&
    area > sine * u.squaredNorm() * v.squaredNorm();
}

} // namespace nurbs
