// SPDX-License-Identifier: BSD-3-Clause
/// @file UnionFind.h
/// @brief Disjoint sets of numbers. Not installed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace nurbs
{

/// Sets of the numbers 0 to n - 1, at first one each; a set is known by its least.
class UnionFind
{
public:
  explicit UnionFind(std::size_t n)
    : Parent(n)
  {
    std::iota(this->Parent.begin(), this->Parent.end(), 0);
  }
  std::int64_t Find(std::int64_t x)
  {
    while (this->Parent[x] != x)
    {
      x = this->Parent[x] = this->Parent[this->Parent[x]];
    }
    return x;
  }
  void Join(std::int64_t a, std::int64_t b)
  {
    a = this->Find(a);
    b = this->Find(b);
    this->Parent[std::max(a, b)] = std::min(a, b);
  }
  /// The set of each number.
  std::vector<std::int64_t> Sets() const
  {
    std::vector<std::int64_t> sets = this->Parent;
    for (std::int64_t& x : sets)
    {
      x = sets[x]; // Which is not above it, so done before.
    }
    return sets;
  }

private:
  std::vector<std::int64_t> Parent;
};

} // namespace nurbs
