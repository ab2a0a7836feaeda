// SPDX-License-Identifier: BSD-3-Clause
// Loops that processes divide: all have the results of all items, as one process makes them.
#include "WorkShare.h"

#include <gtest/gtest.h>

namespace
{

struct Stop
{};

// The results of all processes. Each runs twice: what it tells is known to all the second time.
std::vector<std::vector<double>> ResultsOf(std::int64_t processes, std::int64_t count, int& calls)
{
  std::vector<std::vector<char>> messages(processes);
  std::vector<std::vector<double>> results(processes);
  for (int round = 0; round < 2; ++round)
  {
    for (std::int64_t p = 0; p < processes; ++p)
    {
      std::vector<double>& made = results[p];
      made.assign(count, 0.0);
      nurbs::WorkShare share;
      share.Process = p;
      share.Processes = processes;
      share.Exchange = [&](const std::vector<char>& own) {
        messages[p] = own;
        if (round == 0)
        {
          throw Stop();
        }
        return messages;
      };
      try
      {
        nurbs::ForShared(
          share, nurbs::SerialFor, count,
          [&](std::int64_t item) {
            ++calls;
            made[item] = 1.0 / double(item + 3);
          },
          [&](std::int64_t item, nurbs::MessageWriter& out) { out.Put(&made[item], 1); },
          [&](std::int64_t item, nurbs::MessageReader& in) {
            std::vector<double> value;
            in.Get(value);
            made[item] = value.at(0);
          });
      }
      catch (const Stop&)
      {}
    }
  }
  return results;
}

} // namespace

TEST(WorkShare, AllHaveTheResultsOfAll)
{
  for (const std::int64_t count : { 0, 1, 2, 7, 8 })
  {
    int alone = 0;
    const std::vector<double> wanted = ResultsOf(1, count, alone).front();
    for (std::int64_t processes = 2; processes < 5; ++processes)
    {
      int calls = 0;
      for (const std::vector<double>& made : ResultsOf(processes, count, calls))
      {
        EXPECT_EQ(made, wanted) << count << " items by " << processes;
      }
      EXPECT_EQ(calls, alone) << count << " items by " << processes;
    }
  }
}

TEST(WorkShare, OwnItemsOfARange)
{
  nurbs::WorkShare share;
  share.Processes = 3;
  std::vector<int> done(10, 0);
  for (share.Process = 0; share.Process < 3; ++share.Process)
  {
    nurbs::ForOwn(share, nurbs::SerialFor)(2, 10, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t item = begin; item < end; ++item)
      {
        done[item] += 1 + int(item % 3 == share.Process ? 0 : 10);
      }
    });
  }
  EXPECT_EQ(done, (std::vector<int>{ 0, 0, 1, 1, 1, 1, 1, 1, 1, 1 }));
}
