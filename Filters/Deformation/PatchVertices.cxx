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
  std::vector<std::int32_t> Needed; ///< Not 0.
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

// The outer sums of one vertex. Rows >= 0: their number, as a constant for the compiler.
template <typename Quad, int Rows>
NURBS_INLINE void SumRows(
  const double* sums, const double* N, const double* dN, int rows, Quad& h, Quad& hu, Quad& hv)
{
  const int count = Rows >= 0 ? Rows : rows;
  for (int r = 0; r < count; ++r)
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

template <typename Quad, int Rows>
NURBS_INLINE void RunLoop(const Loop& loop, bool accumulate, bool keep)
{
  const PatchUpdate& update = loop.Update;
  const GridAxis& axis = update.Grid->Axis[1];
  const int q = axis.Degree();
  const int rows = loop.Rows;
  const double sign = update.Reversed ? -1.0 : 1.0;
  const std::size_t count = loop.Vertices.Size();
  const std::int32_t* const lineU = loop.Vertices.I.data();
  const std::int32_t* const lineV = loop.Vertices.J.data();
  const std::int32_t* const places = loop.Vertices.Points.data();
  double* const all = loop.Vertices.Sums.data();
  const double* const lineSums = loop.Lines.Values.data();
  const double* const basis = axis.Basis(update.Grid->Row(update.Patch), 0) + update.FirstRow;
  const bool rational = update.Rational;
  for (std::size_t first = loop.Begin; first < count; first += 4)
  {
    const int some = int(std::min<std::size_t>(4, count - first));
    Quad h[4] = {};
    Quad hu[4] = {};
    Quad hv[4] = {};
    for (int k = 0; k < some; ++k)
    {
      const std::size_t at = first + k;
      double* const kept = accumulate || keep ? all + at * SumSize : nullptr;
      if (accumulate)
      {
        h[k] = Quad::Load(kept);
        hu[k] = Quad::Load(kept + 4);
        hv[k] = Quad::Load(kept + 8);
      }
      const double* N = basis + std::size_t(lineV[at]) * 2 * (q + 1);
      SumRows<Quad, Rows>(
        lineSums + std::size_t(lineU[at]) * rows * 8, N, N + q + 1, rows, h[k], hu[k], hv[k]);
      if (keep)
      {
        h[k].Store(kept);
        hu[k].Store(kept + 4);
        hv[k].Store(kept + 8);
      }
    }
    Quad normal[4];
    const int careful = Project(loop.Directions, rational, true, h, hu, hv, normal);
    StoreVertices(h, normal, some, places + first, sign, loop.Points, loop.Normals);
    for (int k = 0; careful != 0 && k < some; ++k)
    {
      if (careful >> k & 1)
      {
        loop.Careful.push_back(std::int32_t(first + k));
      }
    }
  }
}

// What is asked for again as constants for the compiler.
template <typename Quad, int Rows>
NURBS_INLINE void RunRows(const Loop& loop)
{
  if (loop.Update.Accumulate)
  {
    RunLoop<Quad, Rows>(loop, true, true);
  }
  else if (loop.Update.Keep)
  {
    RunLoop<Quad, Rows>(loop, false, true);
  }
  else
  {
    RunLoop<Quad, Rows>(loop, false, false);
  }
}

template <typename Quad>
NURBS_INLINE void RunAll(const Loop& loop, LineSums& lines, int column)
{
  SumLines<Quad>(loop.Update, column, loop.Rows, lines);
  switch (loop.Rows)
  {
    case 1:
      return RunRows<Quad, 1>(loop);
    case 2:
      return RunRows<Quad, 2>(loop);
    case 3:
      return RunRows<Quad, 3>(loop);
    case 4:
      return RunRows<Quad, 4>(loop);
    default:
      return RunRows<Quad, -1>(loop);
  }
}

NURBS_MULTIVERSION
void RunWide(const Loop& loop, LineSums& lines, int column)
{
  RunAll<WideLanes>(loop, lines, column);
}

} // namespace

void PatchVertices::Add(std::int32_t i, std::int32_t j, std::int32_t point, std::uint64_t key)
{
  this->I.push_back(i);
  this->J.push_back(j);
  this->Points.push_back(point);
  this->Keys.push_back(key);
  this->LineUses.resize(std::max(this->LineUses.size(), std::size_t(i) + 1), 0);
  ++this->LineUses[i];
}

void PatchVertices::Remove(std::size_t index)
{
  const std::size_t last = this->Size() - 1;
  --this->LineUses[this->I[index]];
  this->I[index] = this->I[last];
  this->J[index] = this->J[last];
  this->Points[index] = this->Points[last];
  this->Keys[index] = this->Keys[last];
  this->I.pop_back();
  this->J.pop_back();
  this->Points.pop_back();
  this->Keys.pop_back();
  if (this->HasSums())
  {
    std::copy_n(this->Sums.data() + last * SumSize, SumSize, this->Sums.data() + index * SumSize);
    this->Sums.resize(last * SumSize);
  }
}

std::vector<std::int32_t> UpdateVertices(const PatchUpdate& update, PatchVertices& vertices,
  std::size_t begin, double* points, float* normals)
{
  std::vector<std::int32_t> careful;
  const int column = update.Grid->Column(update.Patch);
  const int rows = update.LastRow - update.FirstRow + 1;
  thread_local LineSums lines; // Kept for its memory.
  lines.Needed.assign(vertices.LineUses.begin(), vertices.LineUses.end());
  lines.Values.resize(lines.Needed.size() * rows * 8);
  if (update.Keep && !update.Accumulate)
  {
    vertices.Sums.resize(vertices.Size() * SumSize);
  }
  thread_local DirectionTables directions[2];
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
