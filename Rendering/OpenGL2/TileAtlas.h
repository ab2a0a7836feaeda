// SPDX-License-Identifier: BSD-3-Clause
/// @file TileAtlas.h
/// @brief Where the vertices of tiles lie in a texture, and which of them are there already.
///
/// The texture is cut into square pages; a page holds slots of one shape of tile. Tiles stay where
/// they are from frame to frame and give way, when room is short, if the present frame has no use for
/// them.
#pragma once

#include "TileSelection.h"

#include <cstdint>
#include <vector>

namespace nurbs
{

/// Places of tiles in a texture of Width x Height texels.
class TileAtlas
{
public:
  /// Side of a page: 8 x 8 slots of the largest tiles.
  static constexpr int PageSize = 8 * ((1 << Tile::MaxLog) + 1);

  /// A tile's place, in texels.
  struct Slot
  {
    int X = 0, Y = 0; ///< Of the tile's first vertex.
  };

  /// Forgets everything and takes a new size, whole pages.
  void Resize(int pagesX, int pagesY);
  /// Texels across.
  int Width() const { return this->Pages[0] * PageSize; }
  /// Texels down.
  int Height() const { return this->Pages[1] * PageSize; }

  /// A new frame: tiles not asked for from now on may be dropped.
  void BeginFrame() { ++this->Frame; }

  /// The place of a tile. `isNew` tells that its vertices have to be evaluated. False if there is no
  /// room.
  bool Place(const Tile& tile, Slot& slot, bool& isNew);

  /// Drops the tiles of surfaces (ascending) that have changed.
  void Forget(const std::vector<int>& surfaces);
  /// Forgets all tiles.
  void Clear() { this->Resize(this->Pages[0], this->Pages[1]); }

  /// Tiles that are in the atlas.
  std::size_t Size() const { return this->Count; }
  /// Pages that a selection needs in an empty atlas.
  static std::int64_t PagesFor(const std::vector<Tile>& tiles);

private:
  /// A tile that is in the atlas.
  struct Entry
  {
    std::uint64_t Key[2] = { 0, 0 }; ///< The tile.
    std::int32_t Page = -1;          ///< -1: there is none.
    std::int32_t Index = 0;          ///< Slot in the page.
    std::uint64_t Frame = 0;         ///< That asked for it last.

    explicit Entry() = default;
    explicit Entry(const Tile& tile);
    int Surface() const { return static_cast<int>(this->Key[0] & 0xffffffff); }
    int Shape() const;
    std::uint64_t Hash() const;
  };
  struct Page
  {
    int Shape = -1; ///< -1: free.
    int Taken = 0;
    std::vector<int> Free;
  };
  static int SlotsPerRow(int log) { return PageSize / ((1 << log) + 1); }
  static int SlotsPerPage(int shape);
  Slot Locate(int shape, const Entry& entry) const;
  bool Take(int shape, Entry& entry);
  void GiveBack(const Entry& entry);
  Entry& Find(const Entry& wanted);
  void Rehash(std::size_t size);
  bool DropUnused();
  template <typename F>
  bool DropIf(F&& isDropped);

  int Pages[2] = { 0, 0 };
  std::vector<Page> PageList;
  std::vector<int> FreePages;
  std::vector<int> OpenPages[Tile::ShapeCount]; ///< Pages of a shape that may have free slots.
  std::vector<Entry> Tiles; ///< A hash table, open addressing: a power of two, at most half full.
  std::size_t Count = 0;    ///< Entries in use.
  std::uint64_t Frame = 1;
};

} // namespace nurbs
