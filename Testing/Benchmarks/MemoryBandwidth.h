// SPDX-License-Identifier: BSD-3-Clause
/// @file MemoryBandwidth.h
/// @brief What one thread moves to and from memory or caches: the limit of work that computes little.
#pragma once

#include <cstddef>

namespace measuring
{

/// Bytes a second, those read and those written added up; the best of several repetitions.
struct Bandwidth
{
  double Copy = 0.0;   ///< One array to another.
  double Modify = 0.0; ///< One array in place: a x + b for each number x.
};

/// @param bytes size of an array: far over the caches for the memory's bandwidth; a small one stays
/// in the cache that it fits, since it is worked on again and again.
Bandwidth MeasureBandwidth(std::size_t bytes);

} // namespace measuring
