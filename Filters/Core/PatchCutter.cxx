// SPDX-License-Identifier: BSD-3-Clause
#include "PatchCutter.h"

#include "Model.h"
#include "PieceSearch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nurbs
{

namespace
{

/// A cell's derivatives vary by at most this factor, see Flatten.
constexpr double FlatEnough = 0.3;
/// The tangent of the angle between ray and normal for which that is meant.
constexpr double SteepEnough = 1.0;
/// Cells are not made smaller than this part of the model.
constexpr double SmallestCell = 1e-4;
/// Parts that a monotone piece of a trim curve is cut into, to tell which cells it meets.
constexpr int CurveSteps = 8;
/// Up to this factor, derivatives are more than a quarter of those in the piece's middle.
constexpr double SafeFactor = 0.75;

/// A float that is not less; large ones stay finite.
float RoundUp(double x)
{
  const float infinity = std::numeric_limits<float>::infinity();
  return std::nextafter(static_cast<float>(std::min(x, 1e30)), infinity);
}

/// The basis of two tangents and their cross product.
struct TangentFrame
{
  Vec3 Normal;        ///< The cross product, not of unit length.
  Vec3 Reciprocal[2]; ///< Their products with a vector are its coordinates along the tangents.
  Vec3 Dual;          ///< The same along Normal.

  explicit TangentFrame(const Vec3 (&tangents)[2])
    : Normal(tangents[0].cross(tangents[1]))
  {
    const double square = std::max(
      this->Normal.squaredNorm(), 1e-28 * tangents[0].squaredNorm() * tangents[1].squaredNorm());
    const double inverse = 1.0 / std::max(square, std::numeric_limits<double>::min());
    this->Reciprocal[0] = inverse * tangents[1].cross(this->Normal);
    this->Reciprocal[1] = inverse * this->Normal.cross(tangents[0]);
    this->Dual = inverse * this->Normal;
  }

  /// Along the tangents and the normal.
  Vec3 Coordinates(const Vec3& vector) const
  {
    return Vec3(
      this->Reciprocal[0].dot(vector), this->Reciprocal[1].dot(vector), this->Dual.dot(vector));
  }
};

/// Largest coordinates of the differences of derivatives in a tangent frame.
struct VariationBound
{
  Eigen::Matrix2d Along =
    Eigen::Matrix2d::Zero();  ///< On a tangent (row), of a derivative (column).
  Vec2 Across = Vec2::Zero(); ///< On the normal.

  /// `difference`: in coordinates of the frame, see TangentFrame::Coordinates.
  void Extend(int d, const Vec3& difference)
  {
    this->Along(0, d) = std::max(this->Along(0, d), std::abs(difference[0]));
    this->Along(1, d) = std::max(this->Along(1, d), std::abs(difference[1]));
    this->Across[d] = std::max(this->Across[d], std::abs(difference[2]));
  }
};

/// De Casteljau's algorithm at the middle, for a net of any vectors: `high` becomes its upper half.
template <typename T>
void HalveNet(std::vector<T>& high, const int (&count)[2], int dir, std::vector<T>& low)
{
  low = high;
  const int n = count[dir] - 1;
  const int step = dir == 0 ? 1 : count[0];
  const int lineStep = dir == 0 ? count[0] : 1;
  for (int line = 0; line < count[1 - dir]; ++line)
  {
    T* a = low.data() + line * lineStep;
    T* b = high.data() + line * lineStep;
    for (int r = 0; r <= n; ++r)
    {
      a[r * step] = b[0];
      for (int i = 0; i < n - r; ++i)
      {
        b[i * step] = 0.5 * (b[i * step] + b[(i + 1) * step]);
      }
    }
  }
}

/// C(n, 0) to C(n, n).
std::vector<double> Binomials(int n)
{
  std::vector<double> row{ 1.0 };
  for (int i = 1; i <= n; ++i)
  {
    row.push_back(row.back() * (n - i + 1) / i);
  }
  return row;
}

} // namespace

namespace
{

/// Points along a monotone piece of a trim curve, in the order of v.
std::vector<Vec2> Sample(const TrimPiece& piece, const std::vector<Vec3>& inner)
{
  const Vec2 size = piece.High - piece.Low;
  const int steps = size[0] == 0.0 || size[1] == 0.0 ? 1 : CurveSteps;
  std::vector<Vec2> points;
  for (int k = 0; k <= steps; ++k)
  {
    const double t = double(k) / steps;
    const int n = piece.Degree;
    Vec3 sum = std::pow(1.0 - t, n) * Vec3::UnitZ() + std::pow(t, n) * Vec3::Ones();
    for (int i = 1; i < n; ++i)
    {
      sum += std::pow(t, i) * std::pow(1.0 - t, n - i) * inner[piece.FirstInner + i - 1];
    }
    const double x = sum[0] / sum[2];
    points.push_back(
      piece.Low + size.cwiseProduct(Vec2(piece.Falling ? 1.0 - x : x, sum[1] / sum[2])));
  }
  return points;
}

} // namespace

CoverTest::CoverTest(const Model& model, const nurbs::Face& face, const FaceTrim& trim)
  : Trim(trim)
  , Domain{ face.Geometry.Domain(0), face.Geometry.Domain(1) }
{
  if (trim.IsWhole())
  {
    return;
  }
  const TrimPieces cut = CutTrimLoops(model, face);
  for (const TrimPiece& piece : cut.Pieces)
  {
    // Between two points of it, a monotone curve stays in their box.
    const std::vector<Vec2> points = Sample(piece, cut.Inner);
    for (std::size_t k = 1; k < points.size(); ++k)
    {
      Box2 box(points[k - 1]);
      this->Boxes.push_back(box.extend(points[k]));
    }
  }
}

TrimCover CoverTest::Cover(const Box2& rectangle) const
{
  for (const Box2& box : this->Boxes)
  {
    if (box.intersects(rectangle))
    {
      return TrimCover::Part;
    }
  }
  const Vec2 middle = rectangle.center();
  const bool inside = this->Trim.Inside(this->Domain[0].Min + middle[0] * this->Domain[0].Length(),
    this->Domain[1].Min + middle[1] * this->Domain[1].Length());
  return inside ? TrimCover::Whole : TrimCover::None;
}

PatchCutter::Context::Context(const CoverTest& test, double reach, const BezierPatch& given)
  : Test(test)
  , Reach(reach)
  , Domain{ { test.Normalise(0, given.U.Min), test.Normalise(0, given.U.Max) },
    { test.Normalise(1, given.V.Min), test.Normalise(1, given.V.Max) } }
{}

TrimCover PatchCutter::Context::Cover(const CutPiece& piece) const
{
  Box2 rectangle;
  for (int d = 0; d < 2; ++d)
  {
    const Interval& part = d == 0 ? piece.Patch.U : piece.Patch.V;
    const double length = this->Domain[d].Length();
    const double most = length * part.Length() * this->Reach /
      std::max(piece.Slowest[d], std::numeric_limits<double>::min());
    const double margin = std::min(1.0, most) + 1e-9;
    rectangle.min()[d] = this->Domain[d].Min + part.Min * length - margin;
    rectangle.max()[d] = this->Domain[d].Min + part.Max * length + margin;
  }
  return this->Test.Cover(rectangle);
}

Box3 CutPiece::Box() const
{
  Box3 box;
  for (const Vec4& h : this->Patch.Points)
  {
    box.extend(h.head<3>() / h[3]);
  }
  return box;
}

void PatchCutter::Add(
  const BezierPatch& given, std::int32_t face, const CoverTest& test, double reach)
{
  CutPiece whole = Whole(given);
  const auto first = static_cast<std::int64_t>(this->Points.size());
  this->Patches.push_back(
    { { given.Degree[0], given.Degree[1] }, face, first, { given.U, given.V } });
  this->Points.insert(this->Points.end(), whole.Patch.Points.begin(), whole.Patch.Points.end());
  const std::size_t before = this->Cells.size();
  this->Cut(Context(test, reach, given), whole);
  if (this->Cells.size() == before)
  {
    this->Points.resize(static_cast<std::size_t>(first));
    this->Patches.pop_back();
  }
}

namespace
{

/// Products of Bezier polynomials (Farin, Curves and Surfaces for CAGD, section 5.5), derivatives
/// raised to the patch's degree.
QuotientNet MakeQuotients(const BezierPatch& patch)
{
  const int p = patch.Degree[0];
  const int q = patch.Degree[1];
  std::vector<Vec4> raised[2];
  for (int d = 0; d < 2; ++d)
  {
    const int n = patch.Degree[d];
    const int step = d == 0 ? 1 : p + 1;
    for (int k = 0; k < (p + 1) * (q + 1); ++k)
    {
      const int i = d == 0 ? k % (p + 1) : k / (p + 1);
      const Vec4* h = patch.Points.data() + k;
      Vec4 sum = Vec4::Zero();
      if (i > 0)
      {
        sum += i * (h[0] - h[-step]);
      }
      if (i < n)
      {
        sum += (n - i) * (h[step] - h[0]);
      }
      raised[d].push_back(sum);
    }
  }
  const std::vector<double> bu = Binomials(p), bv = Binomials(q);
  const std::vector<double> bbu = Binomials(2 * p), bbv = Binomials(2 * q);
  using Quotient = QuotientNet::value_type;
  QuotientNet product((2 * p + 1) * (2 * q + 1), Quotient::Zero());
  for (int a = 0; a < (p + 1) * (q + 1); ++a)
  {
    for (int b = 0; b < (p + 1) * (q + 1); ++b)
    {
      const int ia = a % (p + 1), ja = a / (p + 1), ib = b % (p + 1), jb = b / (p + 1);
      const double factor = bu[ia] * bu[ib] / bbu[ia + ib] * (bv[ja] * bv[jb] / bbv[ja + jb]);
      const Vec4& h = patch.Points[a];
      Quotient term;
      for (int d = 0; d < 2; ++d)
      {
        const Vec4& derivative = raised[d][b];
        term.segment<3>(3 * d) = h[3] * derivative.head<3>() - derivative[3] * h.head<3>();
      }
      term[6] = h[3] * patch.Points[b][3];
      product[ia + ib + (ja + jb) * (2 * p + 1)] += factor * term;
    }
  }
  return product;
}

} // namespace

CutPiece PatchCutter::Whole(const BezierPatch& given)
{
  CutPiece piece;
  piece.Patch = given;
  double heaviest = 0.0;
  double lightest = std::numeric_limits<double>::infinity();
  for (const Vec4& h : given.Points)
  {
    heaviest = std::max(heaviest, h[3]);
    lightest = std::min(lightest, h[3]);
  }
  for (Vec4& h : piece.Patch.Points)
  {
    h /= heaviest;
  }
  piece.Patch.U = Interval();
  piece.Patch.V = Interval();
  if (lightest < heaviest)
  {
    piece.Quotients = MakeQuotients(piece.Patch);
  }
  return piece;
}

void PatchCutter::Judge(const Context& context, CutPiece& piece)
{
  const double turn = this->Flatten(piece);
  if (turn <= SafeFactor)
  {
    for (int d = 0; d < 2; ++d)
    {
      piece.Slowest[d] = std::max(piece.Slowest[d], 0.25 * piece.Cell.D[d].norm());
    }
  }
  const TrimCover cover = turn <= SafeFactor || std::min(piece.Slowest[0], piece.Slowest[1]) > 0.0
    ? context.Cover(piece)
    : TrimCover::Part;
  piece.Cell.IsWhole = cover == TrimCover::Whole;
  const bool isCell = turn <= FlatEnough || piece.Depth == MaxHalvings ||
    piece.Cell.Radius < SmallestCell * this->Size;
  piece.Is = cover == TrimCover::None ? CutPiece::Verdict::Empty
    : isCell                          ? CutPiece::Verdict::Cell
                                      : CutPiece::Verdict::Halve;
}

void PatchCutter::Halve(CutPiece& piece, CutPiece& low, CutPiece& high)
{
  const int dir = piece.Direction;
  SplitBezierPatch(piece.Patch, dir, 0.5, low.Patch, high.Patch);
  low.Depth = high.Depth = piece.Depth + 1;
  high.Quotients = std::move(piece.Quotients);
  if (!high.Quotients.empty())
  {
    const int count[2] = { 2 * piece.Patch.Degree[0] + 1, 2 * piece.Patch.Degree[1] + 1 };
    HalveNet(high.Quotients, count, dir, low.Quotients);
    for (QuotientNet* net : { &low.Quotients, &high.Quotients })
    {
      for (auto& quotient : *net)
      {
        quotient.segment<3>(3 * dir) *= 0.5;
      }
    }
  }
  piece.Patch.Points = std::vector<Vec4>();
}

void PatchCutter::Cut(const Context& context, CutPiece& piece)
{
  this->Judge(context, piece);
  if (piece.Is == CutPiece::Verdict::Cell)
  {
    piece.Cell.Patch = static_cast<std::int32_t>(this->Patches.size()) - 1;
    this->Cells.push_back(piece.Cell);
    this->Boxes.push_back(piece.Box());
  }
  else if (piece.Is == CutPiece::Verdict::Halve)
  {
    CutPiece low, high;
    Halve(piece, low, high);
    this->Cut(context, low);
    this->Cut(context, high);
  }
}

/// Fills in the cell of a piece. Returns by how much the derivatives vary, as the factor by which s
/// - Y g(s) contracts for a ray at a slope of SteepEnough to the normal, and sets the direction in
/// which they do so more.
double PatchCutter::Flatten(CutPiece& given)
{
  const BezierPatch& piece = given.Patch;
  const QuotientNet& quotients = given.Quotients;
  PatchRays::Cell& cell = given.Cell;
  const int p = piece.Degree[0];
  const int q = piece.Degree[1];
  PatchPoint middle;
  EvaluatePatch(piece.Points.data(), p, q, 0.5, 0.5, middle);
  cell.Middle = middle.H.head<3>() / middle.H[3];
  double radius = 0.0;
  for (const Vec4& h : piece.Points)
  {
    radius = std::max(radius, (h.head<3>() / h[3] - cell.Middle).norm());
  }
  for (int d = 0; d < 2; ++d)
  {
    cell.D[d] = (middle.D[d].head<3>() - middle.D[d][3] * cell.Middle) / middle.H[3];
  }
  const TangentFrame frame(cell.D);
  VariationBound whole;
  VariationBound bend[2]; // second differences by their direction
  for (int d = 0; d < 2; ++d)
  {
    // Control vectors of the derivative, in the frame: it lies in their hull.
    int count[2] = { p + (d == 0 ? 0 : 1), q + (d == 1 ? 0 : 1) };
    std::vector<Vec3>& net = this->Scratch;
    net.clear();
    const Vec3 along = cell.D[d].stableNormalized();
    double slowest = std::numeric_limits<double>::infinity();
    const auto add = [&](const Vec3& vector) {
      slowest = std::min(slowest, along.dot(vector));
      net.push_back(frame.Coordinates(vector));
    };
    if (quotients.empty())
    {
      const int step = d == 0 ? 1 : p + 1;
      for (int j = 0; j < count[1]; ++j)
      {
        const Vec4* h = piece.Points.data() + j * (p + 1);
        for (int i = 0; i < count[0]; ++i, ++h)
        {
          add(piece.Degree[d] / h[0][3] * (h[step] - h[0]).head<3>());
        }
      }
    }
    else
    {
      count[0] = 2 * p + 1;
      count[1] = 2 * q + 1;
      for (const auto& quotient : quotients)
      {
        add(quotient.segment<3>(3 * d) / quotient[6]);
      }
    }
    given.Slowest[d] = std::max(slowest, 0.0);
    const Vec3 own = frame.Coordinates(cell.D[d]);
    const Vec3* here = net.data();
    for (int j = 0; j < count[1]; ++j)
    {
      for (int i = 0; i < count[0]; ++i, ++here)
      {
        whole.Extend(d, *here - own);
        if (i > 0)
        {
          bend[0].Extend(d, (count[0] - 1) * (here[0] - here[-1]));
        }
        if (j > 0)
        {
          bend[1].Extend(d, (count[1] - 1) * (here[0] - here[-count[0]]));
        }
      }
    }
  }
  const Vec2 slope = SteepEnough * frame.Normal.norm() *
    Vec2(frame.Reciprocal[0].norm(), frame.Reciprocal[1].norm());
  const auto matrix = [&](const VariationBound& bound) -> Eigen::Matrix2d {
    return bound.Along + slope * bound.Across.transpose();
  };
  // The eigenvalue's derivative tells what a part of the matrix adds to it.
  Vec2 right, left;
  const double factor = ContractionFactor(matrix(whole), right);
  ContractionFactor(matrix(whole).transpose(), left);
  const double shares[2] = { left.dot(matrix(bend[0]) * right), left.dot(matrix(bend[1]) * right) };
  given.Direction = shares[0] >= shares[1] ? 0 : 1;
  for (int d = 0; d < 2; ++d)
  {
    cell.Along[0][d] = RoundUp(whole.Along(0, d));
    cell.Along[1][d] = RoundUp(whole.Along(1, d));
    cell.Across[d] = RoundUp(whole.Across[d]);
    const Interval& part = d == 0 ? piece.U : piece.V;
    cell.Low[d] = static_cast<float>(part.Min);
    cell.High[d] = static_cast<float>(part.Max);
  }
  cell.Radius = RoundUp(radius);
  return factor;
}

} // namespace nurbs
