// SPDX-License-Identifier: BSD-3-Clause
#include "CutCells.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{
constexpr double Margin = 0.2; // Of a cell: loops that come nearer cut it.
} // namespace

int CutCells::AddVertex(const Vec2& uv, const Vec3& x, const Eigen::Vector3f& normal, double offset)
{
  this->Mesh.UV.push_back(uv);
  this->Mesh.Points.push_back(x);
  this->Mesh.Normals.push_back(normal);
  this->Offsets.push_back(offset);
  return int(this->Mesh.Points.size()) - 1;
}

int CutCells::GridVertex(int i, int j)
{
  int& id = this->GridIds[i + std::size_t(j) * (this->Cells[0] + 1)];
  if (id < 0)
  {
    const std::size_t at = i + std::size_t(j) * (this->Cells[0] + 1);
    id = this->AddVertex(Vec2(this->Job.Lines[0][i], this->Job.Lines[1][j]), this->Job.Samples[at],
      this->Job.Normals[at], this->Job.Offset);
  }
  return id;
}

// Vertices at any parameters: the surface is asked for normals and for the distance from it.
std::vector<int> CutCells::AddEvaluated(
  const std::vector<Vec2>& uv, const std::vector<Vec3>* places)
{
  const std::size_t n = uv.size();
  std::vector<Vec3> points(n), normals(n);
  SurfaceEvaluator evaluator(this->Job.Source->Bound().Evaluator());
  std::vector<int> ids;
  if (n > 0)
  {
    evaluator.Batch(uv.data(), std::int64_t(n), points[0].data(), normals[0].data());
  }
  for (std::size_t k = 0; k < n; ++k)
  {
    const Vec3& x = places ? (*places)[k] : points[k];
    const Vec3 normal = this->Job.Reversed ? Vec3(-normals[k]) : normals[k];
    ids.push_back(this->AddVertex(uv[k], x, normal.cast<float>(), (x - points[k]).norm()));
  }
  return ids;
}

void CutCells::AddLoops()
{
  std::vector<Vec2> uv;
  std::vector<Vec3> places;
  for (const std::vector<LevelLoopVertex>& loop : this->Job.Loops)
  {
    for (const LevelLoopVertex& v : loop)
    {
      uv.push_back(v.UV);
      places.push_back(v.X);
    }
  }
  this->AddEvaluated(uv, &places);
  int first = 0;
  for (const std::vector<LevelLoopVertex>& loop : this->Job.Loops)
  {
    const int n = int(loop.size());
    for (int k = 0; k < n; ++k)
    {
      const int a = first + k;
      const int b = first + (k + 1) % n;
      this->Segments.push_back({ a, b, &loop[k], this->SideOf(uv[a], uv[b]), false });
    }
    first += n;
  }
  for (std::size_t s = 0; s < this->Segments.size(); ++s)
  {
    const Segment& segment = this->Segments[s];
    if (segment.Side >= 0)
    {
      const int d = segment.Side % 2;
      const bool forward = uv[segment.A][d] < uv[segment.B][d];
      const int low = forward ? segment.A : segment.B;
      this->Sides[segment.Side].insert({ uv[low][d], int(s) });
    }
  }
}

int CutCells::SideOf(const Vec2& a, const Vec2& b) const
{
  const ParameterBox& box = this->Job.Source->Box();
  const double side[4] = { box.V0, box.U1, box.V1, box.U0 };
  for (int s = 0; s < 4; ++s)
  {
    if (a[1 - s % 2] == side[s] && b[1 - s % 2] == side[s])
    {
      return s;
    }
  }
  return -1;
}

void CutCells::MarkGrid()
{
  const std::size_t width = this->Cells[0] + 1;
  this->GridIds.assign(width * (this->Cells[1] + 1), -1);
  this->Marks.assign(this->GridIds.size(), 0);
  this->Owner.assign(std::size_t(this->Cells[0]) * this->Cells[1], -1);
  for (std::size_t l = 0; l < this->Job.Leaves.size(); ++l)
  {
    const GridLeaf& leaf = this->Job.Leaves[l];
    for (int j = leaf.J0; j < leaf.J1; ++j)
    {
      std::fill_n(
        &this->Owner[leaf.I0 + std::size_t(j) * this->Cells[0]], leaf.I1 - leaf.I0, int(l));
    }
    for (const int i : { leaf.I0, leaf.I1 })
    {
      this->Marks[i + leaf.J0 * width] = this->Marks[i + leaf.J1 * width] = 1;
    }
  }
}

// The leaves that loops cut, but for loops along sides of the box.
void CutCells::CutLeaves()
{
  this->States.assign(this->Job.Leaves.size(), Outside);
  this->CutBy.resize(this->Job.Leaves.size());
  for (std::size_t s = 0; s < this->Segments.size(); ++s)
  {
    if (this->Segments[s].Side < 0)
    {
      this->Walk(int(s));
    }
  }
}

void CutCells::Walk(int s)
{
  const Vec2& a = this->Mesh.UV[this->Segments[s].A];
  const Vec2& b = this->Mesh.UV[this->Segments[s].B];
  const std::vector<double>& us = this->Job.Lines[0];
  const std::vector<double>& vs = this->Job.Lines[1];
  const auto touched = [](const std::vector<double>& lines, double low, double high, int& first,
                         int& last) {
    const int n = int(lines.size()) - 1;
    const auto cell = [&](double t) {
      return std::clamp(
        int(std::upper_bound(lines.begin(), lines.end(), t) - lines.begin()) - 1, 0, n - 1);
    };
    first = cell(low);
    last = cell(high);
    while (first > 0 && low - lines[first] <= Margin * (lines[first] - lines[first - 1]))
    {
      --first;
    }
    while (last + 1 < n && lines[last + 1] - high <= Margin * (lines[last + 2] - lines[last + 1]))
    {
      ++last;
    }
  };
  int i0, i1;
  touched(us, std::min(a[0], b[0]), std::max(a[0], b[0]), i0, i1);
  for (int i = i0; i <= i1; ++i)
  {
    const double reach = Margin * (us[i + 1] - us[i]);
    double t0 = 0.0;
    double t1 = 1.0;
    if (a[0] != b[0])
    {
      double s0 = (us[i] - reach - a[0]) / (b[0] - a[0]);
      double s1 = (us[i + 1] + reach - a[0]) / (b[0] - a[0]);
      if (s0 > s1)
      {
        std::swap(s0, s1);
      }
      t0 = std::clamp(s0, 0.0, 1.0);
      t1 = std::clamp(s1, 0.0, 1.0);
    }
    const double va = a[1] + t0 * (b[1] - a[1]);
    const double vb = a[1] + t1 * (b[1] - a[1]);
    int j0, j1;
    touched(vs, std::min(va, vb), std::max(va, vb), j0, j1);
    for (int j = j0; j <= j1; ++j)
    {
      const int owner = this->OwnerOf(i, j);
      this->States[owner] = Cut;
      if (this->CutBy[owner].empty() || this->CutBy[owner].back() != s)
      {
        this->CutBy[owner].push_back(s);
      }
    }
  }
}

// Where a line v = const crosses loops, ascending.
std::vector<std::vector<double>> CutCells::Crossings(const std::vector<double>& vs) const
{
  std::vector<std::vector<double>> out(vs.size());
  for (const Segment& segment : this->Segments)
  {
    const Vec2* low = &this->Mesh.UV[segment.A];
    const Vec2* high = &this->Mesh.UV[segment.B];
    if ((*low)[1] > (*high)[1])
    {
      std::swap(low, high);
    }
    for (auto j = std::lower_bound(vs.begin(), vs.end(), (*low)[1]) - vs.begin();
         j < std::ptrdiff_t(vs.size()) && vs[j] < (*high)[1]; ++j)
    {
      const double t = (vs[j] - (*low)[1]) / ((*high)[1] - (*low)[1]);
      out[j].push_back((*low)[0] + t * ((*high)[0] - (*low)[0]));
    }
  }
  for (std::vector<double>& row : out)
  {
    std::sort(row.begin(), row.end());
  }
  return out;
}

bool CutCells::IsInside(const std::vector<double>& crossings, double u)
{
  return (std::lower_bound(crossings.begin(), crossings.end(), u) - crossings.begin()) % 2 == 1;
}

// Of the others, those inside are kept, if the edges along their sides fit.
void CutCells::KeepLeaves()
{
  std::vector<double> middles;
  for (int j = 0; j < this->Cells[1]; ++j)
  {
    middles.push_back(0.5 * (this->Job.Lines[1][j] + this->Job.Lines[1][j + 1]));
  }
  const std::vector<std::vector<double>> crossings = this->Crossings(middles);
  for (std::size_t l = 0; l < this->Job.Leaves.size(); ++l)
  {
    const GridLeaf& leaf = this->Job.Leaves[l];
    const double u = 0.5 * (this->Job.Lines[0][leaf.I0] + this->Job.Lines[0][leaf.I0 + 1]);
    if (this->States[l] == Outside && IsInside(crossings[leaf.J0], u))
    {
      this->States[l] = this->TakeSides(leaf) ? Kept : Cut;
    }
  }
}

// Corners of a leaf, counter-clockwise from (I0, J0).
void CutCells::Corner(const GridLeaf& leaf, int k, int& i, int& j)
{
  i = k == 1 || k == 2 ? leaf.I1 : leaf.I0;
  j = k >= 2 ? leaf.J1 : leaf.J0;
}

bool CutCells::IsOnSide(const GridLeaf& leaf, int side) const
{
  return side == 0 ? leaf.J0 == 0
    : side == 1    ? leaf.I1 == this->Cells[0]
    : side == 2    ? leaf.J1 == this->Cells[1]
                   : leaf.I0 == 0;
}

bool CutCells::TakeSides(const GridLeaf& leaf)
{
  std::vector<int> chains[4];
  for (int side = 0; side < 4; ++side)
  {
    if (this->IsOnSide(leaf, side) && !this->FindChain(leaf, side, chains[side]))
    {
      return false;
    }
  }
  // Corners of the grid that are vertices of loops.
  std::vector<std::pair<std::size_t, int>> corners;
  for (int side = 0; side < 4; ++side)
  {
    for (int end = 0; end < 2 && !chains[side].empty(); ++end)
    {
      int i, j;
      Corner(leaf, (side + end) % 4, i, j);
      const std::size_t at = i + std::size_t(j) * (this->Cells[0] + 1);
      const Segment& segment = this->Segments[end ? chains[side].back() : chains[side].front()];
      const int id = this->EndOf(segment, side, end == 1);
      if (this->GridIds[at] >= 0 && this->GridIds[at] != id)
      {
        return false;
      }
      corners.emplace_back(at, id);
    }
  }
  for (const auto& corner : corners)
  {
    for (const auto& other : corners)
    {
      if (corner.first == other.first && corner.second != other.second)
      {
        return false;
      }
    }
  }
  for (const auto& corner : corners)
  {
    this->GridIds[corner.first] = corner.second;
  }
  for (const std::vector<int>& chain : chains)
  {
    for (const int s : chain)
    {
      this->Segments[s].Consumed = true;
    }
  }
  return true;
}

// The end of a segment on a side that comes first or last on the way around the box.
int CutCells::EndOf(const Segment& segment, int side, bool last) const
{
  const int d = side % 2;
  const bool ascending = this->Mesh.UV[segment.A][d] < this->Mesh.UV[segment.B][d];
  return ascending == (side < 2) ? (last ? segment.B : segment.A) : (last ? segment.A : segment.B);
}

// The segments along a leaf's side on the box, counter-clockwise; false: they do not fit it.
bool CutCells::FindChain(const GridLeaf& leaf, int side, std::vector<int>& chain) const
{
  const int d = side % 2;
  const double low = this->Job.Lines[d][d == 0 ? leaf.I0 : leaf.J0];
  const double high = this->Job.Lines[d][d == 0 ? leaf.I1 : leaf.J1];
  double at = low;
  int vertex = -1;
  while (at < high)
  {
    const auto range = this->Sides[side].equal_range(at);
    int found = -1;
    for (auto s = range.first; s != range.second && found < 0; ++s)
    {
      const Segment& segment = this->Segments[s->second];
      if (!segment.Consumed && (vertex < 0 || segment.A == vertex || segment.B == vertex))
      {
        found = s->second;
      }
    }
    if (found < 0)
    {
      return false;
    }
    const Segment& segment = this->Segments[found];
    vertex = this->Mesh.UV[segment.A][d] == at ? segment.B : segment.A;
    at = this->Mesh.UV[vertex][d];
    chain.push_back(found);
  }
  if (side >= 2)
  {
    std::reverse(chain.begin(), chain.end());
  }
  return at == high;
}

ParameterBox CutCells::BoxOf(const GridLeaf& leaf) const
{
  return { this->Job.Lines[0][leaf.I0], this->Job.Lines[0][leaf.I1], this->Job.Lines[1][leaf.J0],
    this->Job.Lines[1][leaf.J1] };
}

int CutCells::CellOf(int dir, double t) const
{
  const std::vector<double>& lines = this->Job.Lines[dir];
  return std::clamp(int(std::upper_bound(lines.begin(), lines.end(), t) - lines.begin()) - 1, 0,
    this->Cells[dir] - 1);
}

} // namespace nurbs
