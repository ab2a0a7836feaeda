// SPDX-License-Identifier: BSD-3-Clause
#include "Bezier.h"

#include <algorithm>

namespace nurbs
{

namespace
{

constexpr int MaxPoints = 2 * (MaxDegree + 1); // room for products and lifted curves on the stack

} // namespace

template <int D>
Vec<D> DeCasteljau(const Vec<D>* points, int degree, double t)
{
  Vec<D> local[MaxPoints];
  std::vector<Vec<D>> heap;
  Vec<D>* p = local;
  if (degree >= MaxPoints)
  {
    heap.resize(degree + 1);
    p = heap.data();
  }
  p[0] = points[0];
  std::copy(points + 1, points + degree + 1, p + 1);
  for (int r = degree; r > 0; --r)
  {
    for (int i = 0; i < r; ++i)
    {
      p[i] = (1.0 - t) * p[i] + t * p[i + 1];
    }
  }
  return p[0];
}

template <int D>
void SplitBezier(const Vec<D>* points, int degree, double t, Vec<D>* left, Vec<D>* right)
{
  std::copy(points, points + degree + 1, right);
  for (int r = 0; r <= degree; ++r)
  {
    left[r] = right[0];
    for (int i = 0; i < degree - r; ++i)
    {
      right[i] = (1.0 - t) * right[i] + t * right[i + 1];
    }
  }
}

template <int D>
std::vector<Vec<D>> ElevateBezier(const std::vector<Vec<D>>& points)
{
  const int n = static_cast<int>(points.size()); // the new degree
  std::vector<Vec<D>> raised(n + 1);
  raised[0] = points[0];
  raised[n] = points[n - 1];
  for (int i = 1; i < n; ++i)
  {
    const double a = static_cast<double>(i) / n;
    raised[i] = a * points[i - 1] + (1.0 - a) * points[i];
  }
  return raised;
}

template <int D>
std::vector<Vec<D>> ReduceBezierOnce(const std::vector<Vec<D>>& points, double& error)
{
  const int n = static_cast<int>(points.size()) - 1;
  if (n < 1)
  {
    throw Error("ReduceBezierOnce: a curve of degree 0 cannot be reduced");
  }
  // Elevation reversed, from the left for the first half and from the right for the second: each is
  // stable on its own side only.
  std::vector<Vec<D>> reduced(n);
  const int middle = (n - 1) / 2; // the last index of the left half, shared if n is odd
  reduced[0] = points[0];
  for (int i = 1; i <= middle; ++i)
  {
    reduced[i] = (n * points[i] - i * reduced[i - 1]) / (n - i);
  }
  const Vec<D> fromLeft = reduced[middle];
  reduced[n - 1] = points[n];
  for (int i = n - 1; i > n / 2; --i)
  {
    reduced[i - 1] = (n * points[i] - (n - i) * reduced[i]) / i;
  }
  if (n % 2 == 1)
  {
    reduced[middle] = 0.5 * (reduced[middle] + fromLeft);
  }
  const std::vector<Vec<D>> back = ElevateBezier<D>(reduced);
  error = 0.0;
  for (int i = 0; i <= n; ++i)
  {
    error = std::max(error, (back[i] - points[i]).norm());
  }
  return reduced;
}

template <int D>
std::vector<Vec<D>> ReduceBezier(std::vector<Vec<D>> points, double tolerance)
{
  double total = 0.0;
  while (points.size() > 1)
  {
    double error = 0.0;
    std::vector<Vec<D>> reduced = ReduceBezierOnce<D>(points, error);
    total += error;
    if (!(total <= tolerance))
    {
      break;
    }
    points = std::move(reduced);
  }
  return points;
}

void SplitBezierPatch(
  const BezierPatch& patch, int dir, double t, BezierPatch& low, BezierPatch& high)
{
  const int n = patch.Degree[dir];
  const int step = dir == 0 ? 1 : patch.Degree[0] + 1;
  const int lineStep = dir == 0 ? patch.Degree[0] + 1 : 1;
  const int lines = patch.Degree[1 - dir] + 1;
  low = patch;
  high = patch;
  const Interval whole = dir == 0 ? patch.U : patch.V;
  const double cut = whole.Min + t * whole.Length();
  (dir == 0 ? low.U : low.V).Max = cut;
  (dir == 0 ? high.U : high.V).Min = cut;
  for (int line = 0; line < lines; ++line)
  {
    Vec4* left = low.Points.data() + line * lineStep;
    Vec4* right = high.Points.data() + line * lineStep;
    for (int r = 0; r <= n; ++r)
    {
      left[r * step] = right[0];
      for (int i = 0; i < n - r; ++i)
      {
        right[i * step] = (1.0 - t) * right[i * step] + t * right[(i + 1) * step];
      }
    }
  }
}

#define NURBS_INSTANTIATE_BEZIER(D)                                                      \
  template Vec<D> DeCasteljau<D>(const Vec<D>*, int, double);                            \
  template void SplitBezier<D>(const Vec<D>*, int, double, Vec<D>*, Vec<D>*);            \
  template std::vector<Vec<D>> ElevateBezier<D>(const std::vector<Vec<D>>&);             \
  template std::vector<Vec<D>> ReduceBezierOnce<D>(const std::vector<Vec<D>>&, double&); \
  template std::vector<Vec<D>> ReduceBezier<D>(std::vector<Vec<D>>, double);

NURBS_INSTANTIATE_BEZIER(1)
NURBS_INSTANTIATE_BEZIER(2)
NURBS_INSTANTIATE_BEZIER(3)
NURBS_INSTANTIATE_BEZIER(4)

} // namespace nurbs
