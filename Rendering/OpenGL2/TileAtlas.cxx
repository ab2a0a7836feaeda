// SPDX-License-Identifier: BSD-3-Clause
#include "TileAtlas.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace nurbs
{

std::size_t TileAtlas::Hash::operator()(const Tile& tile) const
{
  std::uint64_t key = std::uint64_t(tile.Surface);
  for (const int value : { tile.Span[0], tile.Span[1], tile.First[0] | tile.First[1] << 16,
         tile.Log[0] | tile.Log[1] << 8 })
  {
    key = (key ^ std::uint64_t(std::uint32_t(value))) * 0x9E3779B97F4A7C15ull;
    key ^= key >> 32;
  }
  return key;
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
  this->Tiles.clear();
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

bool TileAtlas::DropUnused()
{
  const std::size_t before = this->Tiles.size();
  for (auto it = this->Tiles.begin(); it != this->Tiles.end();)
  {
    if (it->second.Frame < this->Frame)
    {
      this->GiveBack(it->second);
      it = this->Tiles.erase(it);
    }
    else
    {
      ++it;
    }
  }
  return this->Tiles.size() < before;
}

bool TileAtlas::Place(const Tile& tile, Slot& slot, bool& isNew)
{
  auto found = this->Tiles.find(tile);
  isNew = found == this->Tiles.end();
  if (isNew)
  {
    Entry entry{};
    while (!this->Take(tile.Shape(), entry))
    {
      if (!this->DropUnused())
      {
        return false;
      }
    }
    found = this->Tiles.emplace(tile, entry).first;
  }
  found->second.Frame = this->Frame;
  slot = this->Locate(tile.Shape(), found->second);
  return true;
}

void TileAtlas::Forget(const std::vector<int>& surfaces)
{
  for (auto it = this->Tiles.begin(); it != this->Tiles.end() && !surfaces.empty();)
  {
    if (std::binary_search(surfaces.begin(), surfaces.end(), it->first.Surface))
    {
      this->GiveBack(it->second);
      it = this->Tiles.erase(it);
    }
    else
    {
      ++it;
    }
  }
}

} // namespace nurbs
