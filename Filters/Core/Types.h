// SPDX-License-Identifier: BSD-3-Clause
/// @file Types.h
/// @brief Basic types shared by every kernel: vectors, views, intervals, parallel loops.
///
/// Kernels (namespace `nurbs`) know C++17 and Eigen only. Parameters are called `u` and `v`,
/// lengths are in the model's unit, angles in radians.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace nurbs
{

/// A point or vector of D doubles.
template <int D>
using Vec = Eigen::Matrix<double, D, 1>;
/// Parameters (u, v), or a point of an image.
using Vec2 = Vec<2>;
/// A point or vector of space, Cartesian.
using Vec3 = Vec<3>;
using Vec4 = Vec<4>; ///< Homogeneous (w x, w y, w z, w) unless a function says "Cartesian".
/// A rectangle along the axes.
using Box2 = Eigen::AlignedBox2d;
/// A box along the axes.
using Box3 = Eigen::AlignedBox3d;

/// The highest degree of a curve or surface in one direction (the limit of OpenCASCADE, too).
inline constexpr int MaxDegree = 25;

/// A non-owning view of `Size` contiguous values; the owner must outlive it.
template <typename T>
class ArrayView
{
public:
  ArrayView() = default;
  /// `size` values at `data`.
  ArrayView(const T* data, std::size_t size)
    : First(data)
    , Count(size)
  {}
  /// All values of a vector, valid until it changes.
  ArrayView(const std::vector<T>& values)
    : First(values.data())
    , Count(values.size())
  {}
  /// Value i; not checked.
  const T& operator[](std::size_t i) const { return this->First[i]; }
  /// As of a standard container, like the next ones.
  const T* begin() const { return this->First; }
  /// Behind the last value.
  const T* end() const { return this->First + this->Count; }
  /// The first value; null if there is none.
  const T* data() const { return this->First; }
  /// The first of at least one value.
  const T& front() const { return this->First[0]; }
  /// The last of at least one value.
  const T& back() const { return this->First[this->Count - 1]; }
  /// Number of values.
  std::size_t size() const { return this->Count; }
  /// True if there is no value.
  bool empty() const { return this->Count == 0; }

private:
  const T* First = nullptr;
  std::size_t Count = 0;
};

/// Knots of one direction, ascending.
using KnotView = ArrayView<double>;

/// A closed parameter interval [Min, Max].
struct Interval
{
  double Min = 0.0;
  double Max = 1.0;
  /// Max - Min.
  double Length() const { return this->Max - this->Min; }
  /// The number of the interval that is next to t.
  double Clamp(double t) const
  {
    return t < this->Min ? this->Min : (t > this->Max ? this->Max : t);
  }
};

/// What a kernel throws when its input breaks a precondition; the text names the reason.
class Error : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// Runs `body(begin, end)` over disjoint ranges that cover [first, last), possibly in parallel.
/// `vtk*` files pass vtkSMPTools in; kernels alone use SerialFor.
using ParallelFor = std::function<void(std::int64_t first, std::int64_t last,
  const std::function<void(std::int64_t begin, std::int64_t end)>& body)>;

/// The ParallelFor that runs in the calling thread.
inline void SerialFor(std::int64_t first, std::int64_t last,
  const std::function<void(std::int64_t, std::int64_t)>& body)
{
  if (first < last)
  {
    body(first, last);
  }
}

} // namespace nurbs
