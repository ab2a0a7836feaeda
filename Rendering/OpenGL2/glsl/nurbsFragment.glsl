// What a fragment knows of its face, and what becomes of it.

uniform samplerBuffer nurbsFaceLooks;  // two texels a surface, see vtkNURBSFaceLooks
uniform isamplerBuffer nurbsFaceIds;   // cell and block of a surface
flat in int nurbsTileIndex;
in vec2 nurbsT;

nurbsTileInfo nurbsFaceTile;
vec2 nurbsST; // place in the face's domain, 0 to 1

bool nurbsIsSurface = true; // whether the pixel sees the surface at all
#ifdef NURBS_EXACT
uniform float nurbsMargin;   // pixels by which triangles reach over the surface's outline
uniform int nurbsOnce;       // 1: no point of the surface may be drawn twice, as it is translucent
uniform vec3 nurbsDepthAxis; // direction in which depth rises, in vertexMC's axes
uniform int nurbsCulled;     // 1: the inside is not drawn, 2: the outside, 0: both are
in vec3 nurbsGridNormal;
mat2 nurbsPerPixel; // change of nurbsST from one pixel to the next in x and y
float nurbsDepth;   // of the surface, 0 to 1
float nurbsGap;     // pixels that this face may be off its neighbours at an edge
vec4 nurbsVertex;   // the surface's point, as vertexMC
vec3 nurbsNormal;   // unit length, outwards, in vertexMC's axes
bool nurbsFront;    // whether the outside is seen

vec3 nurbsProject(nurbsJet jet, vec4 derivative)
{
  return (derivative.xyz - derivative.w * jet.h.xyz / jet.h.w) / jet.h.w;
}

void nurbsSetPoint(nurbsRay ray, nurbsJet jet)
{
  nurbsDepth = 0.5 + 0.5 * dot(ray.z, jet.h) / dot(ray.w, jet.h);
  nurbsVertex = vec4(jet.h.xyz / jet.h.w + ray.origin, 1.0);
  vec3 normal = cross(nurbsProject(jet, jet.hu), nurbsProject(jet, jet.hv));
  // What the triangles say where it vanishes.
  nurbsNormal = normal == vec3(0.0)        ? normalize(nurbsGridNormal)
    : nurbsFaceTile.reversed ? -normalize(normal)
                             : normalize(normal);
  vec3 sight = cross(ray.x.xyz, ray.y.xyz);
  nurbsFront = dot(nurbsNormal, sight) * dot(sight, nurbsDepthAxis) < 0.0;
}
#endif

// Sets the variables above; called in uniform control flow.
void nurbsBeginFragment()
{
  nurbsFaceTile = nurbsGetTile(nurbsTileIndex);
  ivec2 block = nurbsFaceTile.block;
  vec2 start = vec2(texelFetch(nurbsKnots, block.x).r, texelFetch(nurbsKnots, block.y).r);
  vec2 size = vec2(texelFetch(nurbsKnots, block.x + 1).r, texelFetch(nurbsKnots, block.y + 1).r);
  vec2 t = nurbsT;
#ifdef NURBS_EXACT
  mat2 pixels; // change on screen with t
  float perUnit, noise;
  nurbsRay ray = nurbsGetRay(nurbsFaceTile.surface);
  nurbsJet jet;
  nurbsIsSurface = nurbsHit(ray, nurbsFaceTile, t, jet, pixels, perUnit, noise);
  nurbsSetPoint(ray, jet);
  nurbsIsSurface = nurbsIsSurface && nurbsCulled != (nurbsFront ? 2 : 1);
  float tolerance = texelFetch(nurbsOrigins, 2 * nurbsFaceTile.surface).w;
  nurbsGap = noise + min(tolerance * perUnit, 0.5);
  mat2 perPixelT = inverse(pixels);
  for (int dir = 0; dir < 2; ++dir)
  {
    // Beyond a side at which the surface ends, or the next patch joins with a crease, it is not this
    // patch that the pixel sees. Beyond other sides the next tile goes on as this one does, and either
    // may draw the pixel; of a translucent surface only the one that has the point.
    int sides = int(texelFetch(nurbsKnots, block[dir] + 3).r);
    float perPixel = length(vec2(perPixelT[0][dir], perPixelT[1][dir]));
    float open = perPixel * nurbsGap;
    float smoothly = min(2.0 * perPixel * nurbsMargin, 0.25);
    float inner = perPixel * (noise + 1e-4);
    vec2 range = nurbsRange(nurbsFaceTile, dir);
    bool once = nurbsOnce == 1;
    float low = once && range.x > 0.0 ? range.x - inner
      : (sides & 1) != 0 ? -open : once ? -inner : -smoothly;
    float high = once && range.y < 1.0 ? range.y + inner
      : 1.0 + ((sides & 2) != 0 ? open : once ? inner : smoothly);
    nurbsIsSurface = nurbsIsSurface && t[dir] >= low && t[dir] <= high;
  }
  nurbsPerPixel = mat2(perPixelT[0] * size, perPixelT[1] * size);
#endif
  nurbsST = start + t * size;
}

bool nurbsIsInside()
{
  int trim = nurbsFaceTile.trim;
  if (!nurbsIsSurface)
  {
    return false;
  }
  if (trim < 0 || nurbsInside(trim, nurbsST))
  {
    return true;
  }
#ifdef NURBS_EXACT
  // Neighbours may disagree about where their edge is.
  vec2 x = nurbsGap * nurbsPerPixel[0];
  vec2 y = nurbsGap * nurbsPerPixel[1];
  return nurbsInside(trim, nurbsST + x) || nurbsInside(trim, nurbsST - x) ||
    nurbsInside(trim, nurbsST + y) || nurbsInside(trim, nurbsST - y);
#else
  return false;
#endif
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
