// What the shaders know of a tile; the layout is that of vtkNURBSTileTextures.

uniform isamplerBuffer nurbsTiles;    // a tile a texel
uniform isamplerBuffer nurbsSurfaces; // two texels a surface
uniform samplerBuffer nurbsKnots;     // blocks of spans, see SurfaceTable.h

struct nurbsTileInfo
{
  ivec2 place;   // of its first vertex in the atlas
  int surface;
  ivec2 level;   // cells in the whole span, binary logarithm
  ivec2 first;   // first cell
  ivec2 degree;
  ivec2 block;   // of the span in nurbsKnots
  int point;     // first control point that acts on the patch
  int stride;    // control points in a row
  int trim;      // where the face's trims start; -1: none
  bool reversed; // the outside is against Su x Sv
};

nurbsTileInfo nurbsGetTile(int index)
{
  ivec4 t = texelFetch(nurbsTiles, index);
  nurbsTileInfo tile;
  tile.place = ivec2(t.x & 0xffff, (t.x >> 16) & 0xffff);
  tile.surface = t.y & 0xffffff;
  tile.level = ivec2((t.y >> 24) & 15, (t.y >> 28) & 15);
  ivec2 span = ivec2(t.z & 0xffff, (t.z >> 16) & 0xffff);
  tile.first = ivec2(t.w & 0xffff, (t.w >> 16) & 0xffff);
  ivec4 a = texelFetch(nurbsSurfaces, 2 * tile.surface);
  ivec4 b = texelFetch(nurbsSurfaces, 2 * tile.surface + 1);
  tile.degree = ivec2(a.z & 0xff, (a.z >> 8) & 0xff);
  tile.reversed = ((a.z >> 16) & 1) == 1;
  tile.stride = a.y;
  tile.block = b.xy + span * (4 + 2 * tile.degree);
  tile.trim = b.z;
  tile.point = a.x + int(texelFetch(nurbsKnots, tile.block.x + 2).r) +
    a.y * int(texelFetch(nurbsKnots, tile.block.y + 2).r);
  return tile;
}

// The parameter in [0, 1] of vertex k of a span.
float nurbsParameter(int k, int level)
{
  return float(k) / float(1 << level);
}
