// SPDX-License-Identifier: BSD-3-Clause
/// @file TileAtlas.h
/// @brief Where the vertices of tiles lie in a texture, and which of them are there already.
///
/// The texture is cut into square pages; a page holds slots of one shape of tile. Tiles stay where
/// they are from frame to frame and give way, when room is short, if the present frame has no use for
/// them.
#pragma once

#include "TileSelection.h"

#include <unordered_map>

namespace nurbs
{

/// Places of tiles in a texture of Width x Height texels.
class TileAtlas
{
public:
  /// Side of a page: 8 x 8 slots of the largest tiles.
  static constexpr int PageSize = 8 * ((1 << Tile::MaxLog) + 1);

  struct Slot
  {
    int X = 0, Y = 0; ///< Of the tile's first vertex.
  };

  /// Forgets everything and takes a new size, whole pages.
  void Resize(int pagesX, int pagesY);
  int Width() const { return this->Pages[0] * PageSize; }
  int Height() const { return this->Pages[1] * PageSize; }

  /// A new frame: tiles not asked for from now on may be dropped.
  void BeginFrame() { ++this->Frame; }

  /// The place of a tile. `isNew` tells that its vertices have to be evaluated. False if there is no
  /// room.
  bool Place(const Tile& tile, Slot& slot, bool& isNew);

  /// Drops the tiles of surfaces (ascending) that have changed.
  void Forget(const std::vector<int>& surfaces);
  void Clear() { this->Resize(this->Pages[0], this->Pages[1]); }

  /// Tiles that are in the atlas.
  std::size_t Size() const { return this->Tiles.size(); }
  /// Pages that a selection needs in an empty atlas.
  static std::int64_t PagesFor(const std::vector<Tile>& tiles);

private:
  struct Entry
  {
    int Page;
    int Index; ///< Slot in the page.
    std::uint64_t Frame;
  };
  struct Page
  {
    int Shape = -1; ///< -1: free.
    int Taken = 0;
    std::vector<int> Free;
  };
  struct Hash
  {
    std::size_t operator()(const Tile& tile) const;
  };

  static int SlotsPerRow(int log) { return PageSize / ((1 << log) + 1); }
  static int SlotsPerPage(int shape);
  Slot Locate(int shape, const Entry& entry) const;
  bool Take(int shape, Entry& entry);
  void GiveBack(const Entry& entry);
  bool DropUnused();

  int Pages[2] = { 0, 0 };
  std::vector<Page> PageList;
  std::vector<int> FreePages;
  std::vector<int> OpenPages[Tile::ShapeCount]; ///< Pages of a shape that may have free slots.
  std::unordered_map<Tile, Entry, Hash> Tiles;
  std::uint64_t Frame = 1;
};

} // namespace nurbs
