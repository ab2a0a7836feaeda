// SPDX-License-Identifier: BSD-3-Clause
#include "InnerPoint.h"

#include "TrimIndex.h"

#include <algorithm>
#include <vector>

namespace nurbs
{
namespace
{

// Samples in the middle of n x n cells, with a border of cells outside around them.
class SampleGrid
{
public:
  SampleGrid(const FaceTrim& trim, const Box2& box, int n)
    : Box(box)
    , N(n)
    , Depth(std::size_t(n + 2) * std::size_t(n + 2), 0)
  {
    for (int j = 1; j <= n; ++j)
    {
      for (int i = 1; i <= n; ++i)
      {
        const Vec2 p = this->Place(i, j);
        this->At(i, j) = trim.Inside(p[0], p[1]) ? n : 0;
      }
    }
    this->FindDepths();
  }

  /// The deepest sample, the one nearest to the middle of equals.
  std::optional<Vec2> Deepest()
  {
    const int middle = (this->N + 1) / 2;
    int best[3] = { 0, 0, 0 }; // depth, distance from the middle, index
    for (int j = 1; j <= this->N; ++j)
    {
      for (int i = 1; i <= this->N; ++i)
      {
        const int away = (i - middle) * (i - middle) + (j - middle) * (j - middle);
        const int depth = this->At(i, j);
        if (depth > best[0] || (depth > 0 && depth == best[0] && away < best[1]))
        {
          best[0] = depth;
          best[1] = away;
          best[2] = j * (this->N + 2) + i;
        }
      }
    }
    if (best[0] == 0)
    {
      return std::nullopt;
    }
    return this->Place(best[2] % (this->N + 2), best[2] / (this->N + 2));
  }

private:
  Vec2 Place(int i, int j) const
  {
    return this->Box.min() +
      Vec2(Vec2(i - 0.5, j - 0.5) / this->N).cwiseProduct(Vec2(this->Box.sizes()));
  }

  int& At(int i, int j) { return this->Depth[std::size_t(j) * (this->N + 2) + i]; }

  // Steps to the next sample outside, diagonal ones included, by a sweep each way.
  void FindDepths()
  {
    const auto look = [this](int i, int j, int di, int dj) {
      const int least = std::min({ this->At(i + di, j), this->At(i, j + dj),
        this->At(i + di, j + dj), this->At(i - di, j + dj) });
      this->At(i, j) = std::min(this->At(i, j), least + 1);
    };
    for (int j = 1; j <= this->N; ++j)
    {
      for (int i = 1; i <= this->N; ++i)
      {
        look(i, j, -1, -1);
      }
    }
    for (int j = this->N; j >= 1; --j)
    {
      for (int i = this->N; i >= 1; --i)
      {
        look(i, j, 1, 1);
      }
    }
  }

  Box2 Box;
  int N;
  std::vector<int> Depth;
};

} // namespace

std::optional<Vec2> InnerPoint(const Model& model, std::int64_t face)
{
  const Face& f = model.Faces[static_cast<std::size_t>(face)];
  if (f.Geometry.Size() == 0)
  {
    return std::nullopt;
  }
  const FaceTrim trim(model, face);
  std::optional<Vec2> found;
  for (int n : { 15, 63, 255 })
  {
    found = SampleGrid(trim, LoopsBox(model, f), n).Deepest();
    if (found)
    {
      break;
    }
  }
  return found;
}

} // namespace nurbs
