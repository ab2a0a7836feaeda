// SPDX-License-Identifier: BSD-3-Clause
/// @file WorkShare.h
/// @brief Loops that several processes divide, all of which have the same input and need all results.
#pragma once

#include "PieceMessage.h"
#include "Types.h"

#include <functional>

namespace nurbs
{

/// How a process divides loops with others. Items go around: process p of n makes p, p + n, p + 2 n ...,
/// as neighbours cost alike.
struct WorkShare
{
  std::int64_t Process = 0, Processes = 1;
  /// Gives every process the messages of all, by number. All must call it at the same time.
  std::function<std::vector<std::vector<char>>(const std::vector<char>&)> Exchange;

  /// How many of the items [0, count) a process makes.
  std::int64_t CountOf(std::int64_t process, std::int64_t count) const
  {
    return count > process ? (count - process - 1) / this->Processes + 1 : 0;
  }
};

/// Runs a loop over the own items only; what it makes of the others' is not there.
inline ParallelFor ForOwn(const WorkShare& share, const ParallelFor& parallel)
{
  if (share.Processes < 2)
  {
    return parallel;
  }
  return [share, parallel](std::int64_t first, std::int64_t last,
           const std::function<void(std::int64_t, std::int64_t)>& body) {
    parallel(share.CountOf(share.Process, first), share.CountOf(share.Process, last),
      [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t k = begin; k < end; ++k)
        {
          const std::int64_t item = share.Process + k * share.Processes;
          body(item, item + 1);
        }
      });
  };
}

/// Calls body(item) for the own items of [0, count), spread by `parallel`; then takes the others' results,
/// which they make in the same way: put(item, MessageWriter&) tells one, get(item, MessageReader&) takes
/// it. The results are as if body had been called for all items here.
template <typename Body, typename Put, typename Get>
void ForShared(const WorkShare& share, const ParallelFor& parallel, std::int64_t count,
  const Body& body, const Put& put, const Get& get)
{
  ForOwn(share, parallel)(0, count, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t item = begin; item < end; ++item)
    {
      body(item);
    }
  });
  if (share.Processes < 2)
  {
    return;
  }
  std::vector<char> message;
  MessageWriter out(message);
  for (std::int64_t item = share.Process; item < count; item += share.Processes)
  {
    put(item, out);
  }
  const std::vector<std::vector<char>> all = share.Exchange(message);
  for (std::int64_t p = 0; p < share.Processes; ++p)
  {
    if (p == share.Process)
    {
      continue;
    }
    MessageReader in(all[p]);
    for (std::int64_t item = p; item < count; item += share.Processes)
    {
      get(item, in);
    }
  }
}

} // namespace nurbs
