// SPDX-License-Identifier: BSD-3-Clause
/// @file FlatIndex.h
/// @brief A small hash table from 64-bit keys to 32-bit indices.
///
/// Open addressing with linear probing: a search is one or two cache lines, where std::unordered_map
/// follows pointers. The mesh asks for the vertices on every side of every cell it makes.
#pragma once

#include <cstdint>
#include <vector>

namespace nurbs
{

/// Keys may have any value but all ones.
class FlatIndex
{
public:
  /// The value of a key; -1: there is none.
  std::int32_t Find(std::uint64_t key) const
  {
    if (this->Entries.empty())
    {
      return -1;
    }
    for (std::size_t k = this->Place(key);; k = (k + 1) & this->Mask())
    {
      if (this->Entries[k].Key == key)
      {
        return this->Entries[k].Value;
      }
      if (this->Entries[k].Key == Free)
      {
        return -1;
      }
    }
  }

  /// Sets the value of a key, which may be new.
  void Set(std::uint64_t key, std::int32_t value)
  {
    if (2 * (this->Count + 1) > this->Entries.size())
    {
      this->Grow();
    }
    std::size_t k = this->Place(key);
    while (this->Entries[k].Key != Free && this->Entries[k].Key != key)
    {
      k = (k + 1) & this->Mask();
    }
    this->Count += this->Entries[k].Key == Free;
    this->Entries[k] = { key, value };
  }

  /// Removes a key if it is there. Later entries move up, so that no search ends too early.
  void Remove(std::uint64_t key)
  {
    if (this->Entries.empty())
    {
      return;
    }
    std::size_t hole = this->Place(key);
    while (this->Entries[hole].Key != key)
    {
      if (this->Entries[hole].Key == Free)
      {
        return;
      }
      hole = (hole + 1) & this->Mask();
    }
    --this->Count;
    for (std::size_t k = (hole + 1) & this->Mask(); this->Entries[k].Key != Free;
         k = (k + 1) & this->Mask())
    {
      const std::size_t home = this->Place(this->Entries[k].Key);
      if (((k - home) & this->Mask()) >= ((k - hole) & this->Mask()))
      {
        this->Entries[hole] = this->Entries[k];
        hole = k;
      }
    }
    this->Entries[hole].Key = Free;
  }

  /// Calls f(value) with a reference to every value.
  template <typename F>
  void ForEach(const F& f)
  {
    for (Entry& entry : this->Entries)
    {
      if (entry.Key != Free)
      {
        f(entry.Value);
      }
    }
  }

private:
  static constexpr std::uint64_t Free = ~std::uint64_t(0);
  struct Entry
  {
    std::uint64_t Key = Free;
    std::int32_t Value = -1;
  };

  std::size_t Mask() const { return this->Entries.size() - 1; }
  std::size_t Place(std::uint64_t key) const
  {
    return std::size_t((key * 0x9E3779B97F4A7C15u) >> this->Shift);
  }
  void Grow()
  {
    std::vector<Entry> old;
    old.swap(this->Entries);
    this->Shift = old.empty() ? 60 : this->Shift - 1;
    this->Entries.resize(std::size_t(1) << (64 - this->Shift));
    this->Count = 0;
    for (const Entry& entry : old)
    {
      if (entry.Key != Free)
      {
        this->Set(entry.Key, entry.Value);
      }
    }
  }

  std::vector<Entry> Entries;
  std::size_t Count = 0;
  int Shift = 60;
};

} // namespace nurbs
