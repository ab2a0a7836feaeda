// Takes a vertex of a tile from the evaluated textures, instead of from attributes.

//NURBS::Tile::Dec

uniform sampler2D nurbsPositions;
uniform sampler2D nurbsNormals;
uniform samplerBuffer nurbsOrigins; // of the surfaces: high and low parts
uniform vec3 nurbsShiftHigh;        // where vertexMC has its origin
uniform vec3 nurbsShiftLow;
uniform int nurbsFirstTile;
uniform float nurbsCoarser;         // levels by which tiles are drawn coarser than they are evaluated
#ifdef NURBS_SPREAD
uniform mat4 nurbsToClip;     // from vertexMC
uniform vec4 nurbsViewport;   // x, y, width, height in pixels
uniform float nurbsMargin;    // pixels by which triangles may be off the surface
#endif

vec4 vertexMC;
vec3 normalMC;
flat out int nurbsTileIndex;
out vec2 nurbsT;        // parameters in the patch's spans
out vec3 nurbsNormalMC; // outwards, interpolated

#ifdef NURBS_SPREAD

// A step from a point with clip coordinates c, in pixels on screen.
vec2 nurbsOnScreen(vec4 c, vec3 direction)
{
  vec4 d = nurbsToClip * vec4(direction, 0.0);
  return 0.5 * nurbsViewport.zw * (d.xy - c.xy / c.w * d.w) / c.w;
}

// Moves a vertex, so that the triangles cover every pixel that the surface covers: outwards along
// the normal where the surface turns away from the eye, and beyond the borders of the patch at which
// it ends or has a crease. Which pixels are the surface's is for the fragments to say.
void nurbsSpread(nurbsTileInfo tile, ivec2 k, ivec2 cells, ivec2 skip)
{
  ivec2 next = ivec2(k.x < cells.x ? 1 : -1, k.y < cells.y ? 1 : -1);
  ivec2 here = tile.place + (k << skip);
  vec3 point = texelFetch(nurbsPositions, here, 0).xyz;
  vec3 normal = texelFetch(nurbsNormals, here, 0).xyz;
  vec3 step[2], turn[2];
  for (int dir = 0; dir < 2; ++dir)
  {
    ivec2 there = here + ((dir == 0 ? ivec2(next.x, 0) : ivec2(0, next.y)) << skip);
    step[dir] = float(next[dir]) * (texelFetch(nurbsPositions, there, 0).xyz - point);
    turn[dir] = float(next[dir]) * (texelFetch(nurbsNormals, there, 0).xyz - normal);
  }
  vec4 c = nurbsToClip * vertexMC;
  if (c.w <= 0.0)
  {
    return; // behind the eye
  }
  mat4 m = transpose(nurbsToClip);
  vec3 sight = normalize(cross(c.w * m[0].xyz - c.x * m[3].xyz, c.w * m[1].xyz - c.y * m[3].xyz));
  vec3 shift = vec3(0.0);
  bool moved = false;
#ifdef NURBS_EXACT
  if (abs(dot(normal, sight)) < 0.75)
  {
    float e = dot(step[0], step[0]), f = dot(step[0], step[1]), g = dot(step[1], step[1]);
    float x = dot(sight, step[0]), y = dot(sight, step[1]);
    vec2 along = vec2(g * x - f * y, e * y - f * x); // times e g - f^2 >= 0
    float bend = dot(along.x * turn[0] + along.y * turn[1], along.x * step[0] + along.y * step[1]);
    shift += sign(bend) * nurbsMargin / max(length(nurbsOnScreen(c, normal)), 1e-30) * normal;
    moved = true;
  }
#endif
  vec2 screen[2] = vec2[2](nurbsOnScreen(c, step[0]), nurbsOnScreen(c, step[1]));
  float area = abs(screen[0].x * screen[1].y - screen[0].y * screen[1].x);
  for (int dir = 0; dir < 2; ++dir)
  {
    // What has moved along the normal reaches over every border of the tile, lest it bare something.
    int sides = moved ? 3 : int(texelFetch(nurbsKnots, tile.block[dir] + 3).r);
    int at = moved ? k[dir] : tile.first[dir] + (k[dir] << skip[dir]);
    int end = moved ? cells[dir] : 1 << tile.level[dir];
    float outwards = at == 0 && (sides & 1) != 0 ? -1.0 : at == end && (sides & 2) != 0 ? 1.0 : 0.0;
    float reach = moved ? 2.0 * nurbsMargin : nurbsMargin;
#ifdef NURBS_EXACT
    // Pixels of a cell across the border, which a step outwards need not be on screen.
    float pixels = area / max(length(screen[1 - dir]), 1e-6 * length(screen[dir]));
    float most = 64.0;
#else
    float pixels = length(screen[dir]);
    float most = 0.5; // nobody takes back what is too much
#endif
    if (outwards != 0.0 && length(screen[dir]) > 0.0)
    {
      float cellsOut = outwards * min(reach / max(pixels, 1e-30), most);
      shift += cellsOut * step[dir];
      nurbsT[dir] += cellsOut * float(1 << skip[dir]) / float(1 << tile.level[dir]);
    }
  }
  vertexMC.xyz += shift;
}

#endif

// A vertex of the grid that is drawn, every 2^skip-th of the one that was evaluated.
void nurbsTake(nurbsTileInfo tile, ivec2 cells, ivec2 skip, ivec2 k, out vec3 local, out vec3 normal)
{
  if (tile.reversed)
  {
    k.x = cells.x - k.x; // triangles turn the other way
  }
  ivec2 texel = tile.place + (k << skip);
  local = texelFetch(nurbsPositions, texel, 0).xyz;
  normal = texelFetch(nurbsNormals, texel, 0).xyz;
}

void nurbsFetchVertex()
{
  nurbsTileIndex = nurbsFirstTile + gl_InstanceID;
  nurbsTileInfo tile = nurbsGetTile(nurbsTileIndex);
  ivec2 level = min(tile.level, ivec2(NURBS_MAX_LOG));
  ivec2 skip = min(ivec2(int(nurbsCoarser)), level);
  ivec2 cells = ivec2(1) << (level - skip);
  ivec2 k = ivec2(gl_VertexID % (cells.x + 1), gl_VertexID / (cells.x + 1));
  vec3 local;
  nurbsTake(tile, cells, skip, k, local, normalMC);
  // Between two levels: what the coarser one predicts, plus a part of the detail (the synthesis of an
  // interpolating wavelet). At the next whole level the vertex lies on an edge of the coarser grid.
  float part = fract(nurbsCoarser);
  ivec2 odd = (k & 1) * ivec2(lessThan(skip, level));
  if (part > 0.0 && odd != ivec2(0))
  {
    vec3 before, after, normalBefore, normalAfter;
    nurbsTake(tile, cells, skip, k - odd, before, normalBefore);
    nurbsTake(tile, cells, skip, k + odd, after, normalAfter);
    local = mix(local, 0.5 * (before + after), part);
    normalMC = mix(normalMC, 0.5 * (normalBefore + normalAfter), part);
  }
  if (tile.reversed)
  {
    normalMC = -normalMC;
    k.x = cells.x - k.x;
  }
  nurbsNormalMC = normalMC;
  vec3 high = texelFetch(nurbsOrigins, 2 * tile.surface).xyz - nurbsShiftHigh;
  vec3 low = texelFetch(nurbsOrigins, 2 * tile.surface + 1).xyz - nurbsShiftLow;
  vertexMC = vec4(high + (low + local), 1.0);
  nurbsT = vec2(nurbsParameter(tile.first.x + (k.x << skip.x), tile.level.x),
    nurbsParameter(tile.first.y + (k.y << skip.y), tile.level.y));
#ifdef NURBS_SPREAD
  nurbsSpread(tile, k, cells, skip);
#endif
}
