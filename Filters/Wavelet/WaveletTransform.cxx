// SPDX-License-Identifier: BSD-3-Clause
#include "WaveletTransform.h"

#include <algorithm>

namespace nurbs
{

namespace
{

// The loops run over values: one coordinate of one sample. Lines are contiguous.

// odd - (a + b) / 2
template <typename Real>
void Predict(const Real* a, const Real* b, const Real* odd, std::int64_t n, Real* detail)
{
  for (std::int64_t i = 0; i < n; ++i)
  {
    detail[i] = odd[i] - Real(0.5) * (a[i] + b[i]);
  }
}

// detail + (a + b) / 2
template <typename Real>
void Unpredict(const Real* a, const Real* b, const Real* detail, std::int64_t n, Real* odd)
{
  for (std::int64_t i = 0; i < n; ++i)
  {
    odd[i] = detail[i] + Real(0.5) * (a[i] + b[i]);
  }
}

// even + sign (before + after) / 4
template <typename Real>
void Update(
  Real sign, const Real* before, const Real* after, const Real* even, std::int64_t n, Real* out)
{
  for (std::int64_t i = 0; i < n; ++i)
  {
    out[i] = even[i] + sign * Real(0.25) * (before[i] + after[i]);
  }
}

// One sample.
template <typename Real, int N>
void CopySample(const Real* from, Real* to)
{
  for (int c = 0; c < N; ++c)
  {
    to[c] = from[c];
  }
}

// (a + sign b) times scale
template <typename Real>
void Combine(Real sign, Real scale, const Real* a, const Real* b, std::int64_t n, Real* out)
{
  for (std::int64_t i = 0; i < n; ++i)
  {
    out[i] = scale * (a[i] + sign * b[i]);
  }
}

// A line of n intervals into coarse samples and details.
template <typename Real, int N>
void AnalyseLine(Wavelet kind, bool update, int n, const Real* line, Real* out)
{
  const int half = n / 2;
  if (kind == Wavelet::Haar)
  {
    Real* details = out + std::int64_t(half + 2) * N;
    CopySample<Real, N>(line, out);
    for (int i = 0; i < half; ++i)
    {
      const Real* x = line + std::int64_t(2 * i + 1) * N;
      Combine(Real(1), Real(0.5), x, x + N, N, out + std::int64_t(i + 1) * N);
      Combine(Real(-1), Real(0.5), x, x + N, N, details + std::int64_t(i) * N);
    }
    CopySample<Real, N>(line + std::int64_t(n + 1) * N, out + std::int64_t(half + 1) * N);
    return;
  }
  Real* details = out + std::int64_t(half + 1) * N;
  for (int i = 0; i < half; ++i)
  {
    const Real* x = line + std::int64_t(2 * i) * N;
    CopySample<Real, N>(x, out + std::int64_t(i) * N);
    Predict(x, x + 2 * N, x + N, N, details + std::int64_t(i) * N);
  }
  CopySample<Real, N>(line + std::int64_t(n) * N, out + std::int64_t(half) * N);
  if (update)
  {
    Update(Real(1), details, details + N, out + N, std::int64_t(half - 1) * N, out + N);
  }
}

// The inverse. `even` has room for half + 1 samples.
template <typename Real, int N>
void SynthesiseLine(
  Wavelet kind, bool update, int n, const Real* coarse, const Real* details, Real* even, Real* line)
{
  const int half = n / 2;
  if (kind == Wavelet::Haar)
  {
    CopySample<Real, N>(coarse, line);
    for (int i = 0; i < half; ++i)
    {
      const Real* a = coarse + std::int64_t(i + 1) * N;
      const Real* d = details + std::int64_t(i) * N;
      Real* x = line + std::int64_t(2 * i + 1) * N;
      Combine(Real(1), Real(1), a, d, N, x);
      Combine(Real(-1), Real(1), a, d, N, x + N);
    }
    CopySample<Real, N>(coarse + std::int64_t(half + 1) * N, line + std::int64_t(n + 1) * N);
    return;
  }
  if (update)
  {
    CopySample<Real, N>(coarse, even);
    Update(Real(-1), details, details + N, coarse + N, std::int64_t(half - 1) * N, even + N);
    CopySample<Real, N>(coarse + std::int64_t(half) * N, even + std::int64_t(half) * N);
    coarse = even;
  }
  for (int i = 0; i < half; ++i)
  {
    const Real* a = coarse + std::int64_t(i) * N;
    const Real* d = details + std::int64_t(i) * N;
    Real* x = line + std::int64_t(2 * i) * N;
    for (int c = 0; c < N; ++c)
    {
      x[c] = a[c];
      x[N + c] = d[c] + Real(0.5) * (a[c] + a[N + c]);
    }
  }
  CopySample<Real, N>(coarse + std::int64_t(half) * N, line + std::int64_t(n) * N);
}

// Columns are transformed a row at a time: rows are the vectors that the formulas combine. In a row
// of coarse samples and details of u, only the samples of the border, the first and the last coarse
// one, have columns that are not updated.
struct Columns
{
  std::int64_t Last;  ///< First value of the last coarse sample in a row.
  std::int64_t Width; ///< Values in a row.
};

template <typename Real, int N>
void UpdateRow(const Columns& columns, Real sign, const Real* before, const Real* after,
  const Real* even, Real* out)
{
  const std::int64_t last = columns.Last;
  CopySample<Real, N>(even, out);
  Update(sign, before + N, after + N, even + N, last - N, out + N);
  CopySample<Real, N>(even + last, out + last);
  Update(sign, before + last + N, after + last + N, even + last + N, columns.Width - last - N,
    out + last + N);
}

} // namespace

template <typename Real, int N>
void AnalyseGrid(const GridStep& step, Real* grid, std::int64_t pitch)
{
  const Wavelet kind = step.Kind;
  const int rows = step.FineSamples(1);
  const std::int64_t width = std::int64_t(step.FineSamples(0)) * N;
  const std::int64_t stride = pitch * N;
  if (step.Halved[0])
  {
    std::vector<Real> line(width);
    for (int j = 0; j < rows; ++j)
    {
      const bool update = kind == Wavelet::Lifted && j > 0 && j + 1 < rows;
      Real* row = grid + j * stride;
      std::copy_n(row, width, line.data());
      AnalyseLine<Real, N>(kind, update, step.Intervals[0], line.data(), row);
    }
  }
  if (!step.Halved[1])
  {
    return;
  }
  const Columns columns{ std::int64_t(step.CoarseSamples(0) - 1) * N, width };
  const int half = step.Intervals[1] / 2;
  const int coarse = step.CoarseSamples(1);
  std::vector<Real> fine(std::size_t(rows) * width);
  for (int j = 0; j < rows; ++j)
  {
    std::copy_n(grid + j * stride, width, fine.data() + j * width);
  }
  const auto from = [&](int j) { return fine.data() + j * width; };
  const auto to = [&](int j) { return grid + j * stride; };
  std::copy_n(from(rows - 1), width, to(coarse - 1));
  if (kind == Wavelet::Haar)
  {
    for (int k = 0; k < half; ++k)
    {
      Combine(Real(1), Real(0.5), from(2 * k + 1), from(2 * k + 2), width, to(k + 1));
      Combine(Real(-1), Real(0.5), from(2 * k + 1), from(2 * k + 2), width, to(coarse + k));
    }
    return;
  }
  for (int k = 0; k < half; ++k)
  {
    Predict(from(2 * k), from(2 * k + 2), from(2 * k + 1), width, to(coarse + k));
    if (k > 0 && kind == Wavelet::Lifted)
    {
      UpdateRow<Real, N>(columns, Real(1), to(coarse + k - 1), to(coarse + k), from(2 * k), to(k));
    }
    else
    {
      std::copy_n(from(2 * k), width, to(k));
    }
  }
}

template <typename Real, int N>
void SynthesiseGrid(
  const GridStep& step, const Real* coarse, const Real* details, std::int64_t pitch, Real* fine)
{
  const Wavelet kind = step.Kind;
  const int rows = step.FineSamples(1);
  const int n = step.Intervals[0];
  const std::int64_t width = std::int64_t(step.FineSamples(0)) * N;
  const std::int64_t coarseWidth = std::int64_t(step.CoarseSamples(0)) * N;
  const std::int64_t stride = pitch * N;
  std::vector<Real> even(coarseWidth);
  // A row of coarse samples and details of u, in two pieces, to a row of the fine grid.
  const auto finish = [&](int j, const Real* samples, const Real* rest) {
    Real* row = fine + j * width;
    if (!step.Halved[0])
    {
      std::copy_n(samples, width, row);
      return;
    }
    const bool update = kind == Wavelet::Lifted && j > 0 && j + 1 < rows;
    SynthesiseLine<Real, N>(kind, update, n, samples, rest, even.data(), row);
  };
  const auto coarseRow = [&](int j) { return coarse + j * coarseWidth; };
  const auto detailRow = [&](int j) { return details + j * stride; };
  if (!step.Halved[1])
  {
    for (int j = 0; j < rows; ++j)
    {
      finish(j, coarseRow(j), detailRow(j) + coarseWidth);
    }
    return;
  }
  const int half = step.Intervals[1] / 2;
  const int first = step.CoarseSamples(1); // First row of the details of v.
  std::vector<Real> buffer[3];
  for (std::vector<Real>& b : buffer)
  {
    b.resize(width);
  }
  // Row k of the coarse rows, both pieces together.
  const auto load = [&](int k, Real* out) {
    std::copy_n(coarseRow(k), coarseWidth, out);
    std::copy_n(detailRow(k) + coarseWidth, width - coarseWidth, out + coarseWidth);
  };
  if (kind == Wavelet::Haar)
  {
    load(0, buffer[0].data());
    finish(0, buffer[0].data(), buffer[0].data() + coarseWidth);
    for (int k = 0; k < half; ++k)
    {
      load(k + 1, buffer[0].data());
      for (int side = 0; side < 2; ++side)
      {
        Combine(Real(side == 0 ? 1 : -1), Real(1), buffer[0].data(), detailRow(first + k), width,
          buffer[1].data());
        finish(2 * k + 1 + side, buffer[1].data(), buffer[1].data() + coarseWidth);
      }
    }
    load(half + 1, buffer[0].data());
    finish(rows - 1, buffer[0].data(), buffer[0].data() + coarseWidth);
    return;
  }
  const Columns columns{ coarseWidth - N, width };
  Real* before = buffer[0].data();
  Real* now = buffer[1].data();
  Real* odd = buffer[2].data();
  for (int k = 0; k <= half; ++k)
  {
    load(k, now);
    if (kind == Wavelet::Lifted && k > 0 && k < half)
    {
      UpdateRow<Real, N>(
        columns, Real(-1), detailRow(first + k - 1), detailRow(first + k), now, now);
    }
    if (k > 0)
    {
      Unpredict(before, now, detailRow(first + k - 1), width, odd);
      finish(2 * k - 1, odd, odd + coarseWidth);
    }
    finish(2 * k, now, now + coarseWidth);
    std::swap(before, now);
  }
}

namespace
{

// Coarse samples of a line from its fine ones.
template <typename Real, int N>
void CoarsenLine(Wavelet kind, bool update, int n, const Real* fine, Real* coarse)
{
  const int half = n / 2;
  if (kind == Wavelet::Haar)
  {
    CopySample<Real, N>(fine, coarse);
    for (int i = 0; i < half; ++i)
    {
      const Real* x = fine + std::int64_t(2 * i + 1) * N;
      Combine(Real(1), Real(0.5), x, x + N, N, coarse + std::int64_t(i + 1) * N);
    }
    CopySample<Real, N>(fine + std::int64_t(n + 1) * N, coarse + std::int64_t(half + 1) * N);
    return;
  }
  for (int i = 0; i <= half; ++i)
  {
    const Real* x = fine + std::int64_t(2 * i) * N;
    Real* out = coarse + std::int64_t(i) * N;
    if (!update || i == 0 || i == half)
    {
      CopySample<Real, N>(x, out);
      continue;
    }
    for (int c = 0; c < N; ++c)
    {
      const Real before = x[c - N] - Real(0.5) * (x[c - 2 * N] + x[c]);
      const Real after = x[c + N] - Real(0.5) * (x[c] + x[c + 2 * N]);
      out[c] = x[c] + Real(0.25) * (before + after);
    }
  }
}

} // namespace

template <typename Real, int N>
void CoarsenGrid(const GridStep& step, const Real* fine, Real* coarse)
{
  const Wavelet kind = step.Kind;
  const int rows = step.FineSamples(1);
  const int last = step.CoarseSamples(1) - 1;
  const std::int64_t width = std::int64_t(step.FineSamples(0)) * N;
  const std::int64_t coarseWidth = std::int64_t(step.CoarseSamples(0)) * N;
  const auto row = [&](int j, Real* out) {
    const bool update = kind == Wavelet::Lifted && j > 0 && j + 1 < rows;
    step.Halved[0] ? CoarsenLine<Real, N>(kind, update, step.Intervals[0], fine + j * width, out)
                   : void(std::copy_n(fine + j * width, width, out));
  };
  if (!step.Halved[1])
  {
    for (int j = 0; j < rows; ++j)
    {
      row(j, coarse + j * coarseWidth);
    }
    return;
  }
  std::vector<Real> buffer[5]; // Row j is in number j mod 5.
  for (std::vector<Real>& b : buffer)
  {
    b.resize(coarseWidth);
  }
  int made = 0; // Rows in the buffers, but for those passed by.
  const auto get = [&](int j) {
    for (; made <= j; ++made)
    {
      row(made, buffer[made % 5].data());
    }
    return buffer[j % 5].data();
  };
  for (int k = 0; k <= last; ++k)
  {
    Real* out = coarse + k * coarseWidth;
    if (k == 0 || k == last)
    {
      row(k == 0 ? 0 : rows - 1, out);
    }
    else if (kind == Wavelet::Haar)
    {
      row(2 * k - 1, buffer[0].data());
      row(2 * k, buffer[1].data());
      Combine(Real(1), Real(0.5), buffer[0].data(), buffer[1].data(), coarseWidth, out);
    }
    else if (kind == Wavelet::Interpolating)
    {
      row(2 * k, out);
    }
    else
    {
      get(2 * k + 2);
      const Real* x[5];
      for (int i = 0; i < 5; ++i)
      {
        x[i] = buffer[(2 * k - 2 + i) % 5].data();
      }
      std::copy_n(x[2], coarseWidth, out); // The border's columns are not updated.
      for (std::int64_t c = N; c < coarseWidth - N; ++c)
      {
        const Real before = x[1][c] - Real(0.5) * (x[0][c] + x[2][c]);
        const Real after = x[3][c] - Real(0.5) * (x[2][c] + x[4][c]);
        out[c] = x[2][c] + Real(0.25) * (before + after);
      }
    }
  }
}

template void AnalyseGrid<double, 3>(const GridStep&, double*, std::int64_t);
template void AnalyseGrid<float, 3>(const GridStep&, float*, std::int64_t);
template void AnalyseGrid<float, 4>(const GridStep&, float*, std::int64_t);
template void SynthesiseGrid<double, 3>(
  const GridStep&, const double*, const double*, std::int64_t, double*);
template void SynthesiseGrid<float, 3>(
  const GridStep&, const float*, const float*, std::int64_t, float*);
template void SynthesiseGrid<float, 4>(
  const GridStep&, const float*, const float*, std::int64_t, float*);

template void CoarsenGrid<double, 3>(const GridStep&, const double*, double*);
template void CoarsenGrid<float, 3>(const GridStep&, const float*, float*);
template void CoarsenGrid<float, 4>(const GridStep&, const float*, float*);

} // namespace nurbs
