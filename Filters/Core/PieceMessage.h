// SPDX-License-Identifier: BSD-3-Clause
/// @file PieceMessage.h
/// @brief Messages between the processes that have pieces of a model: arrays, one after the other.
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

namespace nurbs
{

/// Appends arrays of plain values to a message.
class MessageWriter
{
public:
  /// Appends to `out`, which must outlive this.
  explicit MessageWriter(std::vector<char>& out)
    : Out(out)
  {}
  /// Appends `count` values.
  template <typename T>
  void Put(const T* values, std::size_t count)
  {
    const auto size = std::uint64_t(count);
    const auto* bytes = reinterpret_cast<const char*>(&size);
    this->Out.insert(this->Out.end(), bytes, bytes + sizeof size);
    bytes = reinterpret_cast<const char*>(values);
    this->Out.insert(this->Out.end(), bytes, bytes + count * sizeof(T));
  }
  /// Appends a vector's values.
  template <typename C>
  void Put(const C& values)
  {
    this->Put(values.data(), values.size());
  }

private:
  std::vector<char>& Out;
};

/// Takes the arrays out again, in the same order and of the same types.
class MessageReader
{
public:
  /// Reads from the start of `in`, which must outlive this.
  explicit MessageReader(const std::vector<char>& in)
    : In(in)
  {}
  /// True if everything was read.
  bool IsDone() const { return this->At >= this->In.size(); }
  /// Takes the next array.
  template <typename C>
  void Get(C& values)
  {
    std::uint64_t count = 0;
    std::memcpy(&count, this->In.data() + this->At, sizeof count);
    this->At += sizeof count;
    values.resize(count);
    const std::size_t bytes = count * sizeof(values[0]);
    if (bytes > 0)
    {
      std::memcpy(static_cast<void*>(&values[0]), this->In.data() + this->At, bytes);
    }
    this->At += bytes;
  }

private:
  const std::vector<char>& In;
  std::size_t At = 0;
};

} // namespace nurbs
