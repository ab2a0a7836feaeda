// SPDX-License-Identifier: BSD-3-Clause
// How processes come together, so that none waits for one that does not come.
#include "PieceMessage.h"
#include "vtkNURBSPieces.h"

#include "vtkCommunicator.h"
#include "vtkMultiProcessController.h"

#include <algorithm>
#include <exception>

namespace
{

using nurbs::MessageReader;
using nurbs::MessageWriter;

/// A message of all processes together, as MPI counts in 32 bits.
constexpr vtkIdType LargestExchange = vtkIdType(1) << 30;
/// From here on there may be no room for it.
constexpr vtkIdType LongMessage = vtkIdType(1) << 20;
constexpr std::size_t MaxNamedProcesses = 8;

/// Thrown where a process hears that another one stopped. It is no std::exception: who catches those
/// on the way to Run has nothing to do with it.
struct Stopped
{
  vtkNURBSPieces::Outcome Outcome;
  std::string Problem;
};

/// "process 1: no such file", one line a process; the text alone if all say the same.
std::string Report(const std::vector<std::string>& said)
{
  std::string report;
  std::size_t named = 0;
  std::size_t more = 0;
  bool same = true;
  for (std::size_t rank = 0; rank < said.size(); ++rank)
  {
    same = same && said[rank] == said[0];
    if (said[rank].empty())
    {
      continue;
    }
    if (++named > MaxNamedProcesses)
    {
      ++more;
      continue;
    }
    report +=
      (report.empty() ? "process " : "\nprocess ") + std::to_string(rank) + ": " + said[rank];
  }
  report += more > 0 ? "\nand " + std::to_string(more) + " more processes" : "";
  return same ? said[0] : report;
}

} // namespace

// Before anything else, all processes tell each other what they come for. It goes on if all come for
// the same; else all of them stop here.
std::vector<vtkIdType> vtkNURBSPieces::Meet(
  Purpose purpose, vtkIdType size, const std::string& said) const
{
  const auto ranks = std::size_t(this->Controller->GetNumberOfProcesses());
  const vtkIdType own[2] = { purpose, size };
  std::vector<vtkIdType> all(2 * ranks, 0);
  this->Controller->AllGather(own, all.data(), 2);
  std::vector<vtkIdType> sizes(ranks), lengths(ranks, 0), offsets(ranks, 0);
  vtkIdType length = 0;
  bool same = true;
  bool aborted = false;
  for (std::size_t r = 0; r < ranks; ++r)
  {
    sizes[r] = all[2 * r + 1];
    lengths[r] = all[2 * r] == END_FAILED ? sizes[r] : 0;
    offsets[r] = length;
    length += lengths[r];
    same = same && all[2 * r] == purpose;
    aborted = aborted || all[2 * r] == END_ABORTED;
  }
  if (length > 0)
  {
    std::string texts(std::size_t(length), ' ');
    this->Controller->AllGatherV(
      said.data(), &texts[0], lengths[this->Rank], lengths.data(), offsets.data());
    std::vector<std::string> lines(ranks);
    for (std::size_t r = 0; r < ranks; ++r)
    {
      lines[r] = texts.substr(std::size_t(offsets[r]), std::size_t(lengths[r]));
    }
    throw Stopped{ FAILED, Report(lines) };
  }
  if (!same)
  {
    throw Stopped{ aborted ? ABORTED : FAILED, "processes do not do the same" };
  }
  return sizes;
}

vtkNURBSPieces::Outcome vtkNURBSPieces::Run(
  const std::function<bool()>& work, std::string& problem) const
{
  Outcome own = DONE;
  try
  {
    std::string said;
    try
    {
      ThrowIf(this->HasInput ? "" : "the input could not be made");
      own = work() ? DONE : ABORTED;
    }
    catch (const std::exception& failure)
    {
      own = FAILED;
      said = failure.what();
      said = said.empty() ? "unknown failure" : said;
    }
    if (!this->Controller)
    {
      problem = said;
      return own;
    }
    this->Meet(own == DONE ? END_DONE : (own == ABORTED ? END_ABORTED : END_FAILED),
      vtkIdType(said.size()), said);
  }
  catch (const Stopped& stopped)
  {
    problem = stopped.Outcome == FAILED ? stopped.Problem : std::string();
    return stopped.Outcome;
  }
  return own;
}

void vtkNURBSPieces::ThrowIf(const std::string& problem)
{
  if (!problem.empty())
  {
    throw nurbs::Error(problem);
  }
}

void vtkNURBSPieces::Largest(double* values, int count) const
{
  if (this->Controller)
  {
    const std::vector<double> own(values, values + count);
    this->Meet(REDUCE, count);
    this->Controller->AllReduce(own.data(), values, count, vtkCommunicator::MAX_OP);
  }
}

void vtkNURBSPieces::Sum(vtkIdType* values, int count) const
{
  if (this->Controller)
  {
    const std::vector<vtkIdType> own(values, values + count);
    this->Meet(REDUCE, count);
    this->Controller->AllReduce(own.data(), values, count, vtkCommunicator::SUM_OP);
  }
}

std::vector<std::vector<char>> vtkNURBSPieces::Exchange(const std::vector<char>& own) const
{
  if (!this->Controller)
  {
    return { own };
  }
  const int ranks = this->Controller->GetNumberOfProcesses();
  const auto size = vtkIdType(own.size());
  const std::vector<vtkIdType> sizes = this->Meet(EXCHANGE, size);
  const vtkIdType step = LargestExchange / ranks;
  const vtkIdType longest = *std::max_element(sizes.begin(), sizes.end());
  std::vector<std::vector<char>> all(ranks);
  std::vector<char> part;
  std::size_t room = 0;
  for (int r = 0; r < ranks; ++r)
  {
    all[r].resize(std::size_t(sizes[r]));
    room += std::size_t(std::min(step, sizes[r]));
  }
  part.resize(room);
  if (longest > LongMessage)
  {
    this->Meet(READY); // All have room for it.
  }
  std::vector<vtkIdType> lengths(ranks), offsets(ranks);
  for (vtkIdType first = 0; first < longest; first += step)
  {
    vtkIdType sum = 0;
    for (int r = 0; r < ranks; ++r)
    {
      lengths[r] = std::max(vtkIdType(0), std::min(step, sizes[r] - first));
      offsets[r] = sum;
      sum += lengths[r];
    }
    const char* start = own.data() + std::min(first, size);
    this->Controller->AllGatherV(
      start, part.data(), lengths[this->Rank], lengths.data(), offsets.data());
    for (int r = 0; r < ranks; ++r)
    {
      std::copy_n(
        part.begin() + offsets[r], lengths[r], all[r].begin() + std::min(first, sizes[r]));
    }
  }
  return all;
}

nurbs::WorkShare vtkNURBSPieces::GetShare() const
{
  nurbs::WorkShare share;
  if (this->Controller)
  {
    share.Process = this->Rank;
    share.Processes = this->Controller->GetNumberOfProcesses();
    share.Exchange = [this](const std::vector<char>& own) { return this->Exchange(own); };
  }
  return share;
}

void vtkNURBSPieces::Join(std::vector<std::string>& lines) const
{
  std::vector<char> message;
  MessageWriter out(message);
  for (const std::string& line : lines)
  {
    out.Put(line);
  }
  lines.clear();
  for (const std::vector<char>& one : this->Exchange(message))
  {
    for (MessageReader in(one); !in.IsDone();)
    {
      lines.emplace_back();
      in.Get(lines.back());
    }
  }
}

// In rounds, in each of which a process talks to one other at most; the lower rank speaks first.
std::vector<std::vector<char>> vtkNURBSPieces::ExchangeWithEach(
  const std::vector<std::vector<char>>& messages) const
{
  constexpr int tag = 7181;
  const int ranks = int(messages.size());
  std::vector<std::int64_t> sizes;
  for (const std::vector<char>& message : messages)
  {
    sizes.push_back(std::int64_t(message.size()));
  }
  std::vector<char> told;
  MessageWriter(told).Put(sizes);
  const std::vector<std::vector<char>> tables = this->Exchange(told);
  std::vector<std::vector<char>> heard(ranks);
  for (int r = 0; r < ranks; ++r)
  {
    MessageReader(tables[r]).Get(sizes);
    heard[r].resize(std::size_t(sizes[this->Rank]));
  }
  heard[this->Rank] = messages[this->Rank];
  this->Meet(READY); // All have room for it; from here on nothing can fail.
  const auto pass = [&](vtkIdType size, const std::function<void(vtkIdType, vtkIdType)>& f) {
    for (vtkIdType at = 0; at < size; at += LargestExchange)
    {
      f(at, std::min(LargestExchange, size - at));
    }
  };
  const auto send = [&](int to) {
    pass(vtkIdType(messages[to].size()), [&](vtkIdType at, vtkIdType size) {
      this->Controller->Send(messages[to].data() + at, size, to, tag);
    });
  };
  const auto receive = [&](int from) {
    pass(vtkIdType(heard[from].size()), [&](vtkIdType at, vtkIdType size) {
      this->Controller->Receive(heard[from].data() + at, size, from, tag);
    });
  };
  const int last = ranks + ranks % 2 - 1;
  for (int round = 0; round < last; ++round)
  {
    // All but the last seat walk around; the last one meets who would meet himself.
    int other = (2 * round - this->Rank + 2 * last) % last;
    const int middle = round % last;
    if (this->Rank == last)
    {
      other = middle;
    }
    else if (this->Rank == middle)
    {
      other = last;
    }
    if (other >= ranks)
    {
      continue;
    }
    if (this->Rank < other)
    {
      send(other);
      receive(other);
    }
    else
    {
      receive(other);
      send(other);
    }
  }
  return heard;
}
