// SPDX-License-Identifier: BSD-3-Clause
#include "TileAtlas.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace nurbs
{

namespace
{

constexpr std::size_t MinTableSize = 1024;

} // namespace

// Surface and logs (5 bits hold MaxSpanLog), spans and first cells (16 bits each).
TileAtlas::Entry::Entry(const Tile& tile)
{
  const auto bits = [](int value, int shift) {
    return std::uint64_t(std::uint32_t(value)) << shift;
  };
  this->Key[0] = bits(tile.Surface, 0) | bits(tile.Log[0], 32) | bits(tile.Log[1], 40);
  this->Key[1] = bits(tile.Span[0], 0) | bits(tile.Span[1], 16) | bits(tile.First[0], 32) |
    bits(tile.First[1], 48);
}

int TileAtlas::Entry::Shape() const
{
  Tile tile;
  tile.Log[0] = int(this->Key[0] >> 32 & 0xff);
  tile.Log[1] = int(this->Key[0] >> 40 & 0xff);
  return tile.Shape();
}

std::uint64_t TileAtlas::Entry::Hash() const
{
  std::uint64_t hash = 0;
  for (const std::uint64_t key : this->Key)
  {
    hash = (hash ^ key) * 0x9E3779B97F4A7C15ull;
    hash ^= hash >> 32;
  }
  return hash;
}

void TileAtlas::Resize(int pagesX, int pagesY)
{
  this->Pages[0] = pagesX;
  this->Pages[1] = pagesY;
  this->PageList.assign(std::size_t(pagesX) * pagesY, Page());
  this->FreePages.resize(this->PageList.size());
  std::iota(this->FreePages.rbegin(), this->FreePages.rend(), 0);
  for (auto& open : this->OpenPages)
  {
    open.clear();
  }
  this->Tiles.assign(MinTableSize, Entry());
  this->Count = 0;
}

int TileAtlas::SlotsPerPage(int shape)
{
  return SlotsPerRow(shape % (Tile::MaxLog + 1)) * SlotsPerRow(shape / (Tile::MaxLog + 1));
}

std::int64_t TileAtlas::PagesFor(const std::vector<Tile>& tiles)
{
  std::array<std::int64_t, Tile::ShapeCount> count{};
  for (const Tile& tile : tiles)
  {
    ++count[tile.Shape()];
  }
  std::int64_t pages = 0;
  for (int shape = 0; shape < Tile::ShapeCount; ++shape)
  {
    pages += (count[shape] + SlotsPerPage(shape) - 1) / SlotsPerPage(shape);
  }
  return pages;
}

TileAtlas::Slot TileAtlas::Locate(int shape, const Entry& entry) const
{
  const int log[2] = { shape % (Tile::MaxLog + 1), shape / (Tile::MaxLog + 1) };
  const int perRow = SlotsPerRow(log[0]);
  return { (entry.Page % this->Pages[0]) * PageSize + (entry.Index % perRow) * ((1 << log[0]) + 1),
    (entry.Page / this->Pages[0]) * PageSize + (entry.Index / perRow) * ((1 << log[1]) + 1) };
}

bool TileAtlas::Take(int shape, Entry& entry)
{
  std::vector<int>& open = this->OpenPages[shape];
  while (!open.empty() &&
    (this->PageList[open.back()].Shape != shape || this->PageList[open.back()].Free.empty()))
  {
    open.pop_back();
  }
  if (open.empty())
  {
    if (this->FreePages.empty())
    {
      return false;
    }
    const int page = this->FreePages.back();
    this->FreePages.pop_back();
    this->PageList[page].Shape = shape;
    this->PageList[page].Free.resize(SlotsPerPage(shape));
    std::iota(this->PageList[page].Free.rbegin(), this->PageList[page].Free.rend(), 0);
    open.push_back(page);
  }
  Page& page = this->PageList[open.back()];
  entry.Page = open.back();
  entry.Index = page.Free.back();
  page.Free.pop_back();
  ++page.Taken;
  return true;
}

void TileAtlas::GiveBack(const Entry& entry)
{
  Page& page = this->PageList[entry.Page];
  if (--page.Taken == 0)
  {
    page.Shape = -1;
    page.Free.clear();
    this->FreePages.push_back(entry.Page);
    return;
  }
  if (page.Free.empty())
  {
    this->OpenPages[page.Shape].push_back(entry.Page);
  }
  page.Free.push_back(entry.Index);
}

// The entry of a tile, or the empty one where it belongs.
TileAtlas::Entry& TileAtlas::Find(const Entry& wanted)
{
  const std::size_t mask = this->Tiles.size() - 1;
  std::size_t at = wanted.Hash() & mask;
  while (this->Tiles[at].Page >= 0 &&
    (this->Tiles[at].Key[0] != wanted.Key[0] || this->Tiles[at].Key[1] != wanted.Key[1]))
  {
    at = (at + 1) & mask;
  }
  return this->Tiles[at];
}

void TileAtlas::Rehash(std::size_t size)
{
  const std::vector<Entry> before = std::move(this->Tiles);
  this->Tiles.assign(size, Entry());
  for (const Entry& entry : before)
  {
    if (entry.Page >= 0)
    {
      this->Find(entry) = entry;
    }
  }
}

// Returns whether there were such entries.
template <typename F>
bool TileAtlas::DropIf(F&& isDropped)
{
  const std::size_t before = this->Count;
  for (Entry& entry : this->Tiles)
  {
    if (entry.Page >= 0 && isDropped(entry))
    {
      this->GiveBack(entry);
      entry.Page = -1;
      --this->Count;
    }
  }
  if (this->Count < before)
  {
    this->Rehash(this->Tiles.size()); // closes gaps that a search would end at
  }
  return this->Count < before;
}

bool TileAtlas::DropUnused()
{
  return this->DropIf([this](const Entry& entry) { return entry.Frame < this->Frame; });
}

bool TileAtlas::Place(const Tile& tile, Slot& slot, bool& isNew)
{
  if (2 * this->Count >= this->Tiles.size())
  {
    this->Rehash(std::max(MinTableSize, 2 * this->Tiles.size()));
  }
  Entry wanted(tile);
  Entry* found = &this->Find(wanted);
  isNew = found->Page < 0;
  if (isNew)
  {
    while (!this->Take(tile.Shape(), wanted))
    {
      if (!this->DropUnused())
      {
        return false;
      }
    }
    found = &this->Find(wanted); // entries move when others are dropped
    *found = wanted;
    ++this->Count;
  }
  found->Frame = this->Frame;
  slot = this->Locate(tile.Shape(), *found);
  return true;
}

void TileAtlas::Forget(const std::vector<int>& surfaces)
{
  if (surfaces.empty())
  {
    return;
  }
  std::vector<char> isChanged(std::size_t(surfaces.back()) + 1, 0);
  for (const int surface : surfaces)
  {
    isChanged[surface] = 1;
  }
  this->DropIf([&isChanged](const Entry& entry) {
    return std::size_t(entry.Surface()) < isChanged.size() && isChanged[entry.Surface()];
  });
}

} // namespace nurbs
