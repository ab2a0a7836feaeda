// Takes a vertex of a tile from the evaluated textures, instead of from attributes.

//NURBS::Tile::Dec

uniform sampler2D nurbsPositions;
uniform sampler2D nurbsNormals;
uniform samplerBuffer nurbsOrigins; // of the surfaces: high and low parts
uniform vec3 nurbsShiftHigh;        // where vertexMC has its origin
uniform vec3 nurbsShiftLow;
uniform int nurbsFirstTile;

vec4 vertexMC;
vec3 normalMC;
flat out int nurbsTileIndex;
out vec2 nurbsT; // parameters in the patch's spans

void nurbsFetchVertex()
{
  nurbsTileIndex = nurbsFirstTile + gl_InstanceID;
  nurbsTileInfo tile = nurbsGetTile(nurbsTileIndex);
  ivec2 cells = ivec2(1) << min(tile.level, ivec2(NURBS_MAX_LOG));
  ivec2 k = ivec2(gl_VertexID % (cells.x + 1), gl_VertexID / (cells.x + 1));
  if (tile.reversed)
  {
    k.x = cells.x - k.x; // triangles turn the other way
  }
  vec3 high = texelFetch(nurbsOrigins, 2 * tile.surface).xyz - nurbsShiftHigh;
  vec3 low = texelFetch(nurbsOrigins, 2 * tile.surface + 1).xyz - nurbsShiftLow;
  vec3 local = texelFetch(nurbsPositions, tile.place + k, 0).xyz;
  vertexMC = vec4(high + (low + local), 1.0);
  normalMC = texelFetch(nurbsNormals, tile.place + k, 0).xyz;
  if (tile.reversed)
  {
    normalMC = -normalMC;
  }
  nurbsT = vec2(nurbsParameter(tile.first.x + k.x, tile.level.x),
    nurbsParameter(tile.first.y + k.y, tile.level.y));
}
