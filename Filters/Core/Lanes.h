// SPDX-License-Identifier: BSD-3-Clause
/// @file Lanes.h
/// @brief Four doubles that are computed with at once, in registers of a given width. Internal.
///
/// WideLanes is one AVX register, NarrowLanes two of SSE2 or NEON. Both give the same bits. They are
/// two types because GCC makes slow code of vectors that are wider than the machine's: a loop over
/// 32-byte vectors built for SSE2 takes 20 times as long as one over 16-byte vectors.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

/// Vector types live in registers only if everything around them is inlined.
#define NURBS_INLINE inline __attribute__((always_inline))

namespace nurbs
{

struct WideLanes
{
  using Vector = double __attribute__((vector_size(32)));
  Vector V;

  /// The four doubles at `from`, which need no alignment.
  static NURBS_INLINE WideLanes Load(const double* from)
  {
    WideLanes a;
    std::memcpy(&a.V, from, 32);
    return a;
  }
  NURBS_INLINE void Store(double* to) const { std::memcpy(to, &this->V, 32); }

  friend NURBS_INLINE WideLanes operator+(WideLanes a, WideLanes b) { return { a.V + b.V }; }
  friend NURBS_INLINE WideLanes operator-(WideLanes a, WideLanes b) { return { a.V - b.V }; }
  friend NURBS_INLINE WideLanes operator*(WideLanes a, WideLanes b) { return { a.V * b.V }; }
  friend NURBS_INLINE WideLanes operator*(double s, WideLanes a) { return { s * a.V }; }
  static NURBS_INLINE WideLanes Reciprocal(WideLanes a) { return { 1.0 / a.V }; }
  static NURBS_INLINE WideLanes All(double x) { return { x + Vector{} }; }
  static NURBS_INLINE WideLanes Min(WideLanes a, WideLanes b) { return { b.V < a.V ? b.V : a.V }; }
  static NURBS_INLINE WideLanes Max(WideLanes a, WideLanes b) { return { a.V < b.V ? b.V : a.V }; }

  /// All bits of lane k are set if a, b and c are positive there (NaN is not).
  static NURBS_INLINE void Positive(WideLanes a, WideLanes b, WideLanes c, std::int64_t (&lanes)[4])
  {
    const auto mask = (a.V > 0.0) & (b.V > 0.0) & (c.V > 0.0);
    std::memcpy(lanes, &mask, 32);
  }

  /// Rows of a 4 x 4 matrix to columns.
  static NURBS_INLINE void Transpose(WideLanes (&m)[4])
  {
    const Vector a = __builtin_shufflevector(m[0].V, m[1].V, 0, 4, 2, 6);
    const Vector b = __builtin_shufflevector(m[0].V, m[1].V, 1, 5, 3, 7);
    const Vector c = __builtin_shufflevector(m[2].V, m[3].V, 0, 4, 2, 6);
    const Vector d = __builtin_shufflevector(m[2].V, m[3].V, 1, 5, 3, 7);
    m[0].V = __builtin_shufflevector(a, c, 0, 1, 4, 5);
    m[1].V = __builtin_shufflevector(b, d, 0, 1, 4, 5);
    m[2].V = __builtin_shufflevector(a, c, 2, 3, 6, 7);
    m[3].V = __builtin_shufflevector(b, d, 2, 3, 6, 7);
  }
};

struct NarrowLanes
{
  using Vector = double __attribute__((vector_size(16)));
  Vector Low;
  Vector High;

  static NURBS_INLINE NarrowLanes Load(const double* from)
  {
    NarrowLanes a;
    std::memcpy(&a.Low, from, 16);
    std::memcpy(&a.High, from + 2, 16);
    return a;
  }
  NURBS_INLINE void Store(double* to) const
  {
    std::memcpy(to, &this->Low, 16);
    std::memcpy(to + 2, &this->High, 16);
  }

  friend NURBS_INLINE NarrowLanes operator+(NarrowLanes a, NarrowLanes b)
  {
    return { a.Low + b.Low, a.High + b.High };
  }
  friend NURBS_INLINE NarrowLanes operator-(NarrowLanes a, NarrowLanes b)
  {
    return { a.Low - b.Low, a.High - b.High };
  }
  friend NURBS_INLINE NarrowLanes operator*(NarrowLanes a, NarrowLanes b)
  {
    return { a.Low * b.Low, a.High * b.High };
  }
  friend NURBS_INLINE NarrowLanes operator*(double s, NarrowLanes a)
  {
    return { s * a.Low, s * a.High };
  }
  static NURBS_INLINE NarrowLanes Reciprocal(NarrowLanes a)
  {
    return { 1.0 / a.Low, 1.0 / a.High };
  }

  static NURBS_INLINE NarrowLanes All(double x) { return { x + Vector{}, x + Vector{} }; }
  static NURBS_INLINE NarrowLanes Min(NarrowLanes a, NarrowLanes b)
  {
    return { b.Low < a.Low ? b.Low : a.Low, b.High < a.High ? b.High : a.High };
  }
  static NURBS_INLINE NarrowLanes Max(NarrowLanes a, NarrowLanes b)
  {
    return { a.Low < b.Low ? b.Low : a.Low, a.High < b.High ? b.High : a.High };
  }

  static NURBS_INLINE void Positive(
    NarrowLanes a, NarrowLanes b, NarrowLanes c, std::int64_t (&lanes)[4])
  {
    const auto low = (a.Low > 0.0) & (b.Low > 0.0) & (c.Low > 0.0);
    const auto high = (a.High > 0.0) & (b.High > 0.0) & (c.High > 0.0);
    std::memcpy(lanes, &low, 16);
    std::memcpy(lanes + 2, &high, 16);
  }

  static NURBS_INLINE void Transpose(NarrowLanes (&m)[4])
  {
    const NarrowLanes a = m[0];
    const NarrowLanes b = m[1];
    const NarrowLanes c = m[2];
    const NarrowLanes d = m[3];
    m[0].Low = __builtin_shufflevector(a.Low, b.Low, 0, 2);
    m[0].High = __builtin_shufflevector(c.Low, d.Low, 0, 2);
    m[1].Low = __builtin_shufflevector(a.Low, b.Low, 1, 3);
    m[1].High = __builtin_shufflevector(c.Low, d.Low, 1, 3);
    m[2].Low = __builtin_shufflevector(a.High, b.High, 0, 2);
    m[2].High = __builtin_shufflevector(c.High, d.High, 0, 2);
    m[3].Low = __builtin_shufflevector(a.High, b.High, 1, 3);
    m[3].High = __builtin_shufflevector(c.High, d.High, 1, 3);
  }
};

/// 1 / sqrt(a), lane by lane.
template <typename Quad>
NURBS_INLINE Quad ReciprocalRoot(Quad a)
{
  double x[4];
  a.Store(x);
  for (int k = 0; k < 4; ++k)
  {
    x[k] = std::sqrt(x[k]);
  }
  return Quad::Reciprocal(Quad::Load(x));
}

} // namespace nurbs
