// SPDX-License-Identifier: BSD-3-Clause
// TileAtlas against a texture in which every texel knows the tile that was written there last.
#include "../Filters/Core/nurbsReference.h"
#include "TileAtlas.h"

#include <gtest/gtest.h>

namespace
{

using nurbs::Tile;
using nurbs::TileAtlas;
using reference::Random;

/// One of few tiles, so that many are asked for again.
Tile AnyTile(Random& random, int surfaces)
{
  Tile tile;
  tile.Surface = random.Integer(0, surfaces - 1);
  for (int dir = 0; dir < 2; ++dir)
  {
    tile.Span[dir] = random.Integer(0, 1);
    tile.Log[dir] = random.Integer(0, 1) + 4 * random.Integer(0, 1);
    tile.First[dir] = random.Integer(0, (1 << tile.Log[dir]) - 1) >> Tile::MaxLog << Tile::MaxLog;
  }
  return tile;
}

/// Plays the GPU: writes the vertices of new tiles, and looks whether those of old ones are there.
class Texture
{
public:
  explicit Texture(const TileAtlas& atlas) { this->Clear(atlas); }

  void Clear(const TileAtlas& atlas)
  {
    this->Width = atlas.Width();
    this->Texels.assign(std::size_t(this->Width) * atlas.Height(), -1);
  }

  void Write(const TileAtlas::Slot& slot, const Tile& tile)
  {
    this->Known.push_back(tile);
    this->Visit(slot, tile, [&](int& texel) { texel = int(this->Known.size()) - 1; });
  }

  bool Holds(const TileAtlas::Slot& slot, const Tile& tile)
  {
    bool holds = true;
    this->Visit(slot, tile,
      [&](int texel) { holds = holds && texel >= 0 && this->Known[std::size_t(texel)] == tile; });
    return holds;
  }

private:
  template <typename F>
  void Visit(const TileAtlas::Slot& slot, const Tile& tile, F&& visit)
  {
    for (int y = 0; y <= 1 << tile.CellsLog(1); ++y)
    {
      for (int x = 0; x <= 1 << tile.CellsLog(0); ++x)
      {
        ASSERT_LT(slot.X + x, this->Width);
        visit(this->Texels.at(std::size_t(slot.Y + y) * this->Width + slot.X + x));
      }
    }
  }

  int Width = 0;
  std::vector<int> Texels;
  std::vector<Tile> Known;
};

TEST(TileAtlas, GivesNoPlaceTwice)
{
  Random random(5);
  TileAtlas atlas;
  atlas.Resize(3, 2);
  Texture texture(atlas);
  long fresh = 0, kept = 0, full = 0, forgotten = 0;
  for (int frame = 0; frame < 600; ++frame)
  {
    if (frame % 100 == 99)
    {
      atlas.Resize(random.Integer(1, 4), random.Integer(1, 3));
      texture.Clear(atlas);
      EXPECT_EQ(atlas.Size(), 0u);
    }
    std::vector<int> changed;
    for (int s = 0; s < 20 && frame % 3 == 0; ++s)
    {
      if (random.Integer(0, 9) == 0)
      {
        changed.push_back(s);
      }
    }
    atlas.Forget(changed);
    atlas.BeginFrame();
    std::vector<std::pair<Tile, TileAtlas::Slot>> drawn;
    const int asked = random.Integer(1, 400);
    for (int k = 0; k < asked; ++k)
    {
      const Tile tile = AnyTile(random, 20);
      TileAtlas::Slot slot;
      bool isNew = false;
      if (!atlas.Place(tile, slot, isNew))
      {
        ++full;
        continue;
      }
      if (isNew)
      {
        texture.Write(slot, tile);
      }
      else
      {
        const bool stale = std::count(changed.begin(), changed.end(), tile.Surface) > 0;
        const bool before =
          std::any_of(drawn.begin(), drawn.end(), [&](const auto& d) { return d.first == tile; });
        EXPECT_TRUE(!stale || before) << "a tile of a changed surface was kept";
        forgotten += stale;
        ++kept;
      }
      fresh += isNew;
      ASSERT_TRUE(texture.Holds(slot, tile)) << "frame " << frame;
      drawn.emplace_back(tile, slot);
    }
    for (const auto& d : drawn)
    {
      ASSERT_TRUE(texture.Holds(d.second, d.first)) << "overwritten within frame " << frame;
    }
  }
  std::printf(
    "%ld new, %ld kept, %ld without room, %ld of changed surfaces\n", fresh, kept, full, forgotten);
  EXPECT_GT(kept, 5000);
  EXPECT_GT(fresh, 10000);
  EXPECT_GT(full, 100);
}

TEST(TileAtlas, TakesAnyTilesThatNeedNoMorePages)
{
  Random random(6);
  TileAtlas atlas;
  for (int round = 0; round < 50; ++round)
  {
    std::vector<Tile> tiles;
    for (int k = random.Integer(1, 3000); k > 0; --k)
    {
      tiles.push_back(AnyTile(random, 1000));
    }
    const int pages = int(TileAtlas::PagesFor(tiles));
    atlas.Resize(pages, 1);
    atlas.BeginFrame();
    for (const Tile& tile : tiles)
    {
      TileAtlas::Slot slot;
      bool isNew = false;
      ASSERT_TRUE(atlas.Place(tile, slot, isNew));
    }
  }
}

TEST(TileAtlas, KeepsWhatFits)
{
  TileAtlas atlas;
  atlas.Resize(1, 1);
  Tile large;
  large.Log[0] = large.Log[1] = Tile::MaxLog;
  TileAtlas::Slot slot;
  bool isNew = false;
  for (int frame = 0; frame < 3; ++frame)
  {
    atlas.BeginFrame();
    for (int k = 0; k < 64; ++k)
    {
      large.Surface = k;
      ASSERT_TRUE(atlas.Place(large, slot, isNew));
      EXPECT_EQ(isNew, frame == 0);
    }
    large.Surface = 64;
    EXPECT_FALSE(atlas.Place(large, slot, isNew)) << "all 64 places are of this frame";
  }
  atlas.BeginFrame();
  EXPECT_TRUE(atlas.Place(large, slot, isNew));
  EXPECT_TRUE(isNew);
}

} // namespace
