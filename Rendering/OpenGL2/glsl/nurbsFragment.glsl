// What a fragment knows of its face, and what becomes of it.

uniform samplerBuffer nurbsFaceLooks;  // two texels a surface, see vtkNURBSFaceLooks
uniform isamplerBuffer nurbsFaceIds;   // cell and block of a surface
flat in int nurbsTileIndex;
in vec2 nurbsT;

nurbsTileInfo nurbsFaceTile;
vec2 nurbsST; // place in the face's domain, 0 to 1

// Sets the variables above; called in uniform control flow.
void nurbsBeginFragment()
{
  nurbsFaceTile = nurbsGetTile(nurbsTileIndex);
  ivec2 block = nurbsFaceTile.block;
  nurbsST = vec2(texelFetch(nurbsKnots, block.x).r, texelFetch(nurbsKnots, block.y).r) +
    nurbsT * vec2(texelFetch(nurbsKnots, block.x + 1).r, texelFetch(nurbsKnots, block.y + 1).r);
}

bool nurbsIsInside()
{
  return nurbsFaceTile.trim < 0 || nurbsInside(nurbsFaceTile.trim, nurbsST);
}

ivec2 nurbsIds()
{
  return texelFetch(nurbsFaceIds, nurbsFaceTile.surface).xy;
}

void nurbsColor(float ambientIntensity, float diffuseIntensity, inout vec3 ambientColor,
  inout vec3 diffuseColor, inout float opacity)
{
  vec4 color = texelFetch(nurbsFaceLooks, 2 * nurbsFaceTile.surface);
  vec4 block = texelFetch(nurbsFaceLooks, 2 * nurbsFaceTile.surface + 1);
  if (block.r > 0.5)
  {
    ambientColor = ambientIntensity * color.rgb;
    diffuseColor = diffuseIntensity * color.rgb;
  }
  opacity = color.a * (block.g > 0.5 ? block.b : opacity);
}
