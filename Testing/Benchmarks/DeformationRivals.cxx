// SPDX-License-Identifier: BSD-3-Clause
#include "DeformationRivals.h"

#include "Basis.h"
#include "NetRefinement.h"
#include "SurfaceEvaluator.h"

#include <algorithm>

namespace nurbs
{

namespace
{

std::vector<int> GridTriangles(int countU, int countV)
{
  std::vector<int> triangles;
  triangles.reserve(std::size_t(6) * (countU - 1) * (countV - 1));
  for (int j = 0; j + 1 < countV; ++j)
  {
    for (int i = 0; i + 1 < countU; ++i)
    {
      const int k = i + j * countU;
      triangles.insert(
        triangles.end(), { k, k + 1, k + countU + 1, k, k + countU + 1, k + countU });
    }
  }
  return triangles;
}

/// Point and unit normal from a point and first derivatives; D = 4: homogeneous.
template <int D>
void Store(const Vec<D>& h, const Vec<D>& hu, const Vec<D>& hv, double* point, double* normal)
{
  Vec3 s = h.template head<3>();
  Vec3 su = hu.template head<3>();
  Vec3 sv = hv.template head<3>();
  if constexpr (D == 4)
  {
    s /= h[3];
    su -= hu[3] * s; // The factor 1 / h[3] does not turn a normal.
    sv -= hv[3] * s;
  }
  Eigen::Map<Vec3> at(point), n(normal);
  at = s;
  n = su.cross(sv);
  n /= n.norm();
}

class OsloRival : public DeformationRival
{
public:
  explicit OsloRival(int multiplicity)
    : Multiplicity(multiplicity)
  {}
  const char* GetName() const override
  {
    return this->Multiplicity == 1 ? "Oslo, simple knots" : "Oslo, knots of full multiplicity";
  }

private:
  /// Value and derivative at a parameter that is a knot: sums over `Count` control points.
  struct Mask
  {
    int First = 0;
    int Count = 0;
    double Value[MaxDegree + 1];
    double Slope[MaxDegree + 1];
  };

  static std::vector<Mask> Masks(
    const std::vector<double>& knots, int degree, const std::vector<double>& parameters)
  {
    std::vector<Mask> masks;
    for (const double t : parameters)
    {
      const int span = FindSpan(knots, degree, t);
      double ders[2 * (MaxDegree + 1)];
      EvaluateBasisDerivatives(knots, degree, span, t, 1, ders);
      Mask mask;
      for (int i = 0; i <= degree; ++i)
      {
        const double value = ders[i], slope = ders[degree + 1 + i];
        if (value != 0.0 || slope != 0.0)
        {
          mask.First = mask.Count == 0 ? span - degree + i : mask.First;
          mask.Value[mask.Count] = value;
          mask.Slope[mask.Count++] = slope;
        }
      }
      masks.push_back(mask);
    }
    return masks;
  }

  void Polygonise() override
  {
    std::vector<Mask> masks[2];
    Refinement refinements[2];
    for (int dir = 0; dir < 2; ++dir)
    {
      const int degree = this->Deformed.Degree[dir];
      const std::vector<double>& knots = this->Deformed.Knots[dir];
      const std::vector<double>& parameters = this->Grid->Parameters[dir];
      refinements[dir] = Refine(
        knots, degree, MissingKnots(knots, parameters, std::min(this->Multiplicity, degree)));
      masks[dir] = Masks(refinements[dir].Knots, degree, parameters);
    }
    RefineNet(NetOf(this->Deformed), refinements, this->Rows, this->Fine);
    if (this->Fine.Dimension == 3)
    {
      this->TakeVertices<3>(masks);
    }
    else
    {
      this->TakeVertices<4>(masks);
    }
  }

  template <int D>
  void TakeVertices(const std::vector<Mask> (&masks)[2])
  {
    using Point = Eigen::Map<const Vec<D>>;
    const std::size_t stride = std::size_t(this->Fine.Count[0]) * D;
    std::vector<double> value(stride), slope(stride);
    double* point = this->Mesh.Points.data();
    double* normal = this->Mesh.Normals.data();
    for (const Mask& v : masks[1])
    {
      std::fill(value.begin(), value.end(), 0.0);
      std::fill(slope.begin(), slope.end(), 0.0);
      for (int j = 0; j < v.Count; ++j)
      {
        const double* row = this->Fine.Values.data() + (v.First + j) * stride;
        for (std::size_t i = 0; i < stride; ++i)
        {
          value[i] += v.Value[j] * row[i];
          slope[i] += v.Slope[j] * row[i];
        }
      }
      for (const Mask& u : masks[0])
      {
        Vec<D> h = Vec<D>::Zero(), hu = Vec<D>::Zero(), hv = Vec<D>::Zero();
        for (int i = 0; i < u.Count; ++i)
        {
          const std::size_t at = std::size_t(u.First + i) * D;
          h += u.Value[i] * Point(value.data() + at);
          hu += u.Slope[i] * Point(value.data() + at);
          hv += u.Value[i] * Point(slope.data() + at);
        }
        Store<D>(h, hu, hv, point, normal);
        point += 3;
        normal += 3;
      }
    }
  }

  int Multiplicity;
  ControlNet Rows, Fine;
};

/// Binomial coefficients of every degree.
struct Binomials
{
  Binomials()
  {
    for (int n = 0; n <= MaxDegree; ++n)
    {
      this->Value[n][0] = 1.0;
      for (int i = 1; i <= n; ++i)
      {
        this->Value[n][i] = this->Value[n][i - 1] * (n - i + 1) / i;
      }
    }
  }
  double Value[MaxDegree + 1][MaxDegree + 1];
};
const Binomials Choose;

/// A Bezier curve at t by Horner's scheme in t and 1 - t; `coefficient(i)` is a Vec<D>.
template <int D, typename Coefficient>
Vec<D> Horner(int degree, double t, const Coefficient& coefficient)
{
  const double* choose = Choose.Value[degree];
  const double s = 1.0 - t;
  double power = 1.0;
  Vec<D> sum = coefficient(0);
  for (int i = 1; i <= degree; ++i)
  {
    power *= t;
    sum = s * sum + (choose[i] * power) * coefficient(i);
  }
  return sum;
}

/// Its derivative, likewise: the curve of the differences.
template <int D, typename Coefficient>
Vec<D> HornerSlope(int degree, double t, const Coefficient& coefficient)
{
  return degree *
    Horner<D>(degree - 1, t, [&](int i) -> Vec<D> { return coefficient(i + 1) - coefficient(i); });
}

/// The control points of one patch in the refined net.
template <int D>
struct PatchPoints
{
  const double* First;
  std::size_t Stride; ///< Numbers from row to row.
  Eigen::Map<const Vec<D>> operator()(int i, int j) const
  {
    return Eigen::Map<const Vec<D>>(this->First + i * D + j * this->Stride);
  }
};

class BezierRival : public DeformationRival
{
public:
  explicit BezierRival(bool sharedRows)
    : SharedRows(sharedRows)
  {}
  const char* GetName() const override
  {
    return this->SharedRows ? "Bezier, Horner, rows shared" : "Bezier, Horner";
  }

private:
  void Polygonise() override
  {
    Refinement refinements[2];
    for (int dir = 0; dir < 2; ++dir)
    {
      const int degree = this->Deformed.Degree[dir];
      const std::vector<double>& knots = this->Deformed.Knots[dir];
      refinements[dir] =
        Refine(knots, degree, MissingKnots(knots, this->Grid->Breaks[dir], degree));
    }
    RefineNet(NetOf(this->Deformed), refinements, this->Rows, this->Fine);
    if (this->Fine.Dimension == 3)
    {
      this->EvaluatePatches<3>(refinements);
    }
    else
    {
      this->EvaluatePatches<4>(refinements);
    }
  }

  template <int D>
  void EvaluatePatches(const Refinement (&refinements)[2])
  {
    const int p = this->Deformed.Degree[0], q = this->Deformed.Degree[1];
    const std::size_t stride = std::size_t(this->Fine.Count[0]) * D;
    const std::vector<double>& us = this->Grid->Breaks[0];
    const std::vector<double>& vs = this->Grid->Breaks[1];
    for (std::size_t b = 0; b + 1 < vs.size(); ++b)
    {
      const int row = FindSpan(refinements[1].Knots, q, vs[b]) - q;
      for (std::size_t a = 0; a + 1 < us.size(); ++a)
      {
        const int column = FindSpan(refinements[0].Knots, p, us[a]) - p;
        const PatchPoints<D> patch{ this->Fine.Values.data() + row * stride + column * D, stride };
        // A vertex that patches share is the last one's.
        const int cells = this->Grid->Cells;
        const int columns = cells + (a + 2 == us.size() ? 1 : 0);
        const int lines = cells + (b + 2 == vs.size() ? 1 : 0);
        const std::size_t first = a * cells + b * cells * this->Grid->Parameters[0].size();
        if (this->SharedRows)
        {
          this->EvaluateByRows(patch, columns, lines, first);
        }
        else
        {
          this->EvaluateOneByOne(patch, columns, lines, first);
        }
      }
    }
  }

  template <int D>
  void EvaluateOneByOne(const PatchPoints<D>& patch, int columns, int lines, std::size_t first)
  {
    const int p = this->Deformed.Degree[0], q = this->Deformed.Degree[1];
    const double cell = 1.0 / this->Grid->Cells;
    for (int b = 0; b < lines; ++b)
    {
      const std::size_t row = first + b * this->Grid->Parameters[0].size();
      for (int a = 0; a < columns; ++a)
      {
        const double u = a * cell, v = b * cell;
        Vec<D> curve[MaxDegree + 1], slope[MaxDegree + 1];
        for (int j = 0; j <= q; ++j)
        {
          const auto line = [&](int i) { return patch(i, j); };
          curve[j] = Horner<D>(p, u, line);
          slope[j] = HornerSlope<D>(p, u, line);
        }
        const auto along = [&](int j) -> const Vec<D>& { return curve[j]; };
        Store<D>(Horner<D>(q, v, along),
          Horner<D>(q, v, [&](int j) -> const Vec<D>& { return slope[j]; }),
          HornerSlope<D>(q, v, along), this->Mesh.Points.data() + 3 * (row + a),
          this->Mesh.Normals.data() + 3 * (row + a));
      }
    }
  }

  template <int D>
  void EvaluateByRows(const PatchPoints<D>& patch, int columns, int lines, std::size_t first)
  {
    const int p = this->Deformed.Degree[0], q = this->Deformed.Degree[1];
    const double cell = 1.0 / this->Grid->Cells;
    for (int b = 0; b < lines; ++b)
    {
      const std::size_t row = first + b * this->Grid->Parameters[0].size();
      Vec<D> curve[MaxDegree + 1], slope[MaxDegree + 1];
      for (int i = 0; i <= p; ++i)
      {
        const auto line = [&](int j) { return patch(i, j); };
        curve[i] = Horner<D>(q, b * cell, line);
        slope[i] = HornerSlope<D>(q, b * cell, line);
      }
      const auto along = [&](int i) -> const Vec<D>& { return curve[i]; };
      const auto across = [&](int i) -> const Vec<D>& { return slope[i]; };
      for (int a = 0; a < columns; ++a)
      {
        const double u = a * cell;
        Store<D>(Horner<D>(p, u, along), HornerSlope<D>(p, u, along), Horner<D>(p, u, across),
          this->Mesh.Points.data() + 3 * (row + a), this->Mesh.Normals.data() + 3 * (row + a));
      }
    }
  }

  bool SharedRows;
  ControlNet Rows, Fine;
};

class GridRival : public DeformationRival
{
public:
  const char* GetName() const override { return "full evaluation"; }

protected:
  void Polygonise() override
  {
    SurfaceEvaluator evaluator(this->Deformed.View());
    evaluator.Grid(this->Grid->Parameters[0], this->Grid->Parameters[1], this->Mesh.Points.data(),
      this->Mesh.Normals.data());
  }
};

class LocalGridRival : public GridRival
{
public:
  const char* GetName() const override { return "local evaluation"; }

private:
  void Update(std::int64_t index, const Vec3&) override
  {
    const int s[2] = { int(index % this->Deformed.Count[0]), int(index / this->Deformed.Count[0]) };
    SurfaceView view = this->Deformed.View();
    ArrayView<double> parameters[2];
    int first[2];
    int firstPoint[2];
    for (int dir = 0; dir < 2; ++dir)
    {
      const std::array<int, 2> range = this->Grid->Support(this->Deformed, dir, s[dir]);
      const int p = view.Degree[dir];
      first[dir] = range[0];
      parameters[dir] = { this->Grid->Parameters[dir].data() + range[0],
        std::size_t(range[1] - range[0]) };
      firstPoint[dir] = FindSpan(view.Knots[dir], p, parameters[dir].front()) - p;
      const int last = FindSpan(view.Knots[dir], p, parameters[dir].back());
      view.Count[dir] = last - firstPoint[dir] + 1;
      view.Knots[dir] = { view.Knots[dir].data() + firstPoint[dir],
        std::size_t(view.Count[dir] + p + 1) };
    }
    this->Ids.clear();
    for (int j = 0; j < view.Count[1]; ++j)
    {
      for (int i = 0; i < view.Count[0]; ++i)
      {
        this->Ids.push_back(
          firstPoint[0] + i + std::int64_t(firstPoint[1] + j) * this->Deformed.Count[0]);
      }
    }
    view.Ids = this->Ids.data();
    const std::size_t width = 3 * parameters[0].size();
    this->Points.resize(width * parameters[1].size());
    this->Normals.resize(this->Points.size());
    SurfaceEvaluator evaluator(view);
    evaluator.Grid(parameters[0], parameters[1], this->Points.data(), this->Normals.data());
    for (std::size_t j = 0; j < parameters[1].size(); ++j)
    {
      const std::size_t target = 3 * (first[0] + (first[1] + j) * this->Grid->Parameters[0].size());
      std::copy_n(this->Points.data() + j * width, width, this->Mesh.Points.data() + target);
      std::copy_n(this->Normals.data() + j * width, width, this->Mesh.Normals.data() + target);
    }
  }

  std::vector<std::int64_t> Ids;
  std::vector<double> Points, Normals;
};

} // namespace

SampleGrid::SampleGrid(const Surface& surface, int cells)
  : Cells(cells)
{
  for (int dir = 0; dir < 2; ++dir)
  {
    for (const Knot& knot : DistinctKnots(surface.Knots[dir], surface.Degree[dir]))
    {
      if (!this->Breaks[dir].empty())
      {
        const double from = this->Breaks[dir].back();
        for (int i = 0; i < cells; ++i)
        {
          this->Parameters[dir].push_back(from + (knot.Value - from) * i / cells);
        }
      }
      this->Breaks[dir].push_back(knot.Value);
    }
    this->Parameters[dir].push_back(this->Breaks[dir].back());
  }
}

std::array<int, 2> SampleGrid::Support(const Surface& surface, int dir, int s) const
{
  const std::vector<double>& t = this->Parameters[dir];
  const double end = surface.Knots[dir][s + surface.Degree[dir] + 1];
  const auto from = std::lower_bound(t.begin(), t.end(), surface.Knots[dir][s]);
  const auto to = end < t.back() ? std::lower_bound(from, t.end(), end) : t.end();
  return { int(from - t.begin()), int(to - t.begin()) };
}

void DeformationRival::Prepare(const Surface& surface, const SampleGrid& grid)
{
  this->Deformed = surface;
  this->Grid = std::make_unique<SampleGrid>(grid);
  this->Mesh.Points.resize(3 * std::size_t(grid.Count()));
  this->Mesh.Normals.resize(3 * std::size_t(grid.Count()));
  this->Mesh.Triangles =
    GridTriangles(int(grid.Parameters[0].size()), int(grid.Parameters[1].size()));
  this->Polygonise();
}

void DeformationRival::Move(std::int64_t index, const Vec3& position)
{
  const Vec3 before = this->Deformed.Points[std::size_t(index)];
  this->Deformed.Points[std::size_t(index)] = position;
  this->Update(index, before);
}

void DeformationRival::Update(std::int64_t, const Vec3&)
{
  this->Polygonise();
}

std::unique_ptr<DeformationRival> MakeOsloRival(int multiplicity)
{
  return std::make_unique<OsloRival>(multiplicity);
}

std::unique_ptr<DeformationRival> MakeBezierRival(bool sharedRows)
{
  return std::make_unique<BezierRival>(sharedRows);
}

std::unique_ptr<DeformationRival> MakeGridRival()
{
  return std::make_unique<GridRival>();
}

std::unique_ptr<DeformationRival> MakeLocalGridRival()
{
  return std::make_unique<LocalGridRival>();
}

} // namespace nurbs
