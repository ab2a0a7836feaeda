// SPDX-License-Identifier: BSD-3-Clause
#include "PieceSearch.h"

#include <algorithm>
#include <cmath>

namespace nurbs
{

namespace
{

/// Pieces are not made smaller than this part of the patch.
constexpr double SmallestPiece = 1e-13;
/// After this many pieces the roots are taken to lie on a curve.
constexpr int MaxPieces = 4000;
/// The values C(n, i) / 2^n: the Bernstein polynomials of degree n at 1/2.
struct MiddleWeights
{
  double Value[MaxDegree + 1][MaxDegree + 1] = {};
  constexpr MiddleWeights()
  {
    this->Value[0][0] = 1.0;
    for (int n = 1; n <= MaxDegree; ++n)
    {
      for (int i = 0; i <= n; ++i)
      {
        const double left = i > 0 ? this->Value[n - 1][i - 1] : 0.0;
        const double right = i < n ? this->Value[n - 1][i] : 0.0;
        this->Value[n][i] = 0.5 * (left + right);
      }
    }
  }
};
constexpr MiddleWeights AtMiddle;

} // namespace

double ContractionFactor(const Eigen::Matrix2d& bound, Vec2& unit)
{
  // No entry is quite zero, so that the vector has none.
  const double a = bound(0, 0);
  const double b = bound(0, 1) + 1e-6;
  const double c = bound(1, 0) + 1e-6;
  const double d = bound(1, 1);
  const double half = 0.5 * (a - d);
  const double root = std::sqrt(half * half + b * c);
  unit = half > 0.0 ? Vec2(half + root, c) : Vec2(b, root - half);
  return 0.5 * (a + d) + root;
}

PieceSearch::PieceSearch(const Vec4* net, int p, int q, const Vec4 (&planes)[2], double noise)
  : Degree{ p, q }
  , Size((p + 1) * (q + 1))
  , Noise(noise)
{
  this->Nets.resize(16 * this->Size);
  for (int i = 0; i < this->Size; ++i)
  {
    this->Nets[i] = planes[0].dot(net[i]);
    this->Nets[this->Size + i] = planes[1].dot(net[i]);
  }
}

/// De Casteljau's algorithm in place, for both components.
void PieceSearch::Cut(double* net, int dir, double t, bool keepLow) const
{
  const int n = this->Degree[dir];
  const int width = this->Degree[0] + 1;
  const int step = dir == 0 ? 1 : width;
  const int lines = dir == 0 ? 2 * (this->Degree[1] + 1) : width;
  const int lineStep = dir == 0 ? width : 1;
  const double s = 1.0 - t;
  for (int part = 0; part < (dir == 0 ? 1 : 2); ++part)
  {
    double* first = net + part * this->Size;
    for (int r = 1; r <= n; ++r)
    {
      for (int k = 0; k <= n - r; ++k)
      {
        const int i = keepLow ? n - k : k;
        double* a = first + (keepLow ? i - 1 : i) * step;
        double* into = first + i * step;
        for (int line = 0; line < lines; ++line)
        {
          into[line * lineStep] = s * a[line * lineStep] + t * a[line * lineStep + step];
        }
      }
    }
  }
}

void PieceSearch::Restrict(const PatchPiece& piece)
{
  for (int dir = 0; dir < 2; ++dir)
  {
    if (piece.High[dir] < 1.0)
    {
      this->Cut(this->Nets.data(), dir, piece.High[dir], true);
    }
    if (piece.Low[dir] > 0.0)
    {
      this->Cut(this->Nets.data(), dir, piece.Low[dir] / piece.High[dir], false);
    }
  }
}

const std::vector<RootPiece>& PieceSearch::Run(const PatchPiece& whole)
{
  this->Restrict(whole);
  this->Pieces.assign(1, whole);
  int rounds = 0;
  while (!this->Pieces.empty())
  {
    if (++rounds > MaxPieces)
    {
      const auto isolated = [](const RootPiece& root) { return root.Isolated; };
      this->Found.erase(
        std::stable_partition(this->Found.begin(), this->Found.end(), isolated), this->Found.end());
      break;
    }
    const std::size_t top = this->Pieces.size() - 1;
    double* net = this->Nets.data() + 2 * this->Size * top;
    int dir = 0;
    if (this->Judge(net, this->Pieces[top], dir) != Verdict::Halve)
    {
      this->Pieces.pop_back();
      continue;
    }
    if (this->Nets.size() < (top + 2) * 2 * this->Size)
    {
      this->Nets.resize(2 * this->Nets.size());
      net = this->Nets.data() + 2 * this->Size * top;
    }
    std::copy(net, net + 2 * this->Size, net + 2 * this->Size);
    this->Cut(net, dir, 0.5, false);
    this->Cut(net + 2 * this->Size, dir, 0.5, true);
    PatchPiece low = this->Pieces[top];
    const double middle = 0.5 * (low.Low[dir] + low.High[dir]);
    this->Pieces[top].Low[dir] = middle;
    low.High[dir] = middle;
    this->Pieces.push_back(low);
  }
  return this->Found;
}

/// True if all of a x + b y have one sign, beyond noise. `within`: all are noise.
bool PieceSearch::IsOffPlane(const double* net, double a, double b, bool& within) const
{
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (int i = 0; i < this->Size; ++i)
  {
    const double d = a * net[i] + b * net[this->Size + i];
    low = d < low ? d : low;
    high = d > high ? d : high;
  }
  within = low >= -this->Noise && high <= this->Noise;
  return low > this->Noise || high < -this->Noise;
}

PieceSearch::Verdict PieceSearch::Judge(const double* net, const PatchPiece& piece, int& dir)
{
  bool within;
  if (this->IsOffPlane(net, 1.0, 0.0, within) || this->IsOffPlane(net, 0.0, 1.0, within))
  {
    return Verdict::Empty;
  }
  // A plane along the farthest point and one across: what is seen from the side is thin.
  double a = 0.0;
  double b = 0.0;
  double farthest = 0.0;
  for (int i = 0; i < this->Size; ++i)
  {
    const double square = net[i] * net[i] + net[this->Size + i] * net[this->Size + i];
    if (square > farthest)
    {
      farthest = square;
      a = net[i];
      b = net[this->Size + i];
    }
  }
  farthest = std::sqrt(farthest);
  bool unresolved = farthest <= this->Noise ||
    (piece.High[0] - piece.Low[0] < SmallestPiece && piece.High[1] - piece.Low[1] < SmallestPiece);
  if (!unresolved)
  {
    if (this->IsOffPlane(net, a / farthest, b / farthest, within) ||
      this->IsOffPlane(net, -b / farthest, a / farthest, unresolved))
    {
      return Verdict::Empty;
    }
  }
  if (unresolved)
  {
    this->Found.emplace_back();
    this->Found.back().Piece = piece;
    return Verdict::Done;
  }
  return this->Contract(net, piece, dir);
}

/// Krawczyk's test with the mean derivative as the matrix.
PieceSearch::Verdict PieceSearch::Contract(const double* net, const PatchPiece& piece, int& dir)
{
  const int width = this->Degree[0] + 1;
  const int height = this->Degree[1] + 1;
  const int counts[2] = { (width - 1) * height, width * (height - 1) };
  const int steps[2] = { 1, width };
  Eigen::Matrix2d mean = Eigen::Matrix2d::Zero(); // column: direction
  double longest[2] = { 0.0, 0.0 };
  const auto forDerivatives = [&](int d, const auto& body) {
    for (int j = 0; j < height - (d == 1 ? 1 : 0); ++j)
    {
      for (int i = 0; i < width - (d == 0 ? 1 : 0); ++i)
      {
        const double* at = net + i + j * width;
        body(this->Degree[d] * (at[steps[d]] - at[0]),
          this->Degree[d] * (at[this->Size + steps[d]] - at[this->Size]));
      }
    }
  };
  for (int d = 0; d < 2; ++d)
  {
    double x = 0.0;
    double y = 0.0;
    forDerivatives(d, [&](double dx, double dy) {
      x += dx;
      y += dy;
      longest[d] = std::max(longest[d], dx * dx + dy * dy);
    });
    mean.col(d) = Vec2(x, y) / counts[d];
  }
  dir = longest[0] >= longest[1] ? 0 : 1;
  const double det = mean(0, 0) * mean(1, 1) - mean(0, 1) * mean(1, 0);
  if (std::abs(det) <= 1e-15 * std::sqrt(longest[0] * longest[1]))
  {
    return Verdict::Halve;
  }
  Eigen::Matrix2d inverse;
  inverse << mean(1, 1), -mean(0, 1), -mean(1, 0), mean(0, 0);
  inverse /= det;
  // Bounds on the entries of 1 - inverse * derivative.
  Eigen::Matrix2d rest = Eigen::Matrix2d::Zero();
  for (int d = 0; d < 2; ++d)
  {
    forDerivatives(d, [&](double dx, double dy) {
      const Vec2 e = inverse * (Vec2(dx, dy) - mean.col(d));
      rest.col(d) = rest.col(d).cwiseMax(e.cwiseAbs());
    });
  }
  Vec2 value = Vec2::Zero();
  for (int j = 0; j < height; ++j)
  {
    for (int i = 0; i < width; ++i)
    {
      const double weight = AtMiddle.Value[this->Degree[0]][i] * AtMiddle.Value[this->Degree[1]][j];
      value += weight * Vec2(net[i + j * width], net[this->Size + i + j * width]);
    }
  }
  const Vec2 root = Vec2(0.5, 0.5) - inverse * value;
  for (int d = 0; d < 2; ++d)
  {
    const double reach = 0.5 * rest.row(d).sum();
    const double noise = inverse.row(d).norm() * this->Noise + 1e-9;
    if (root[d] < -reach - noise || root[d] > 1.0 + reach + noise)
    {
      return Verdict::Empty;
    }
  }
  Vec2 unit;
  const double factor = ContractionFactor(rest, unit);
  if (factor >= MaxFactor)
  {
    return Verdict::Halve;
  }
  RootPiece found{ piece, true, root, inverse, factor, unit, false };
  for (int d = 0; d < 2; ++d)
  {
    const double length = piece.High[d] - piece.Low[d];
    found.Start[d] = piece.Low[d] + length * root[d];
    found.Chord.row(d) *= length;
    found.Unit[d] *= length;
  }
  this->Found.push_back(found);
  return Verdict::Done;
}

} // namespace nurbs
