// What a fragment knows of its face, and what becomes of it.

uniform samplerBuffer nurbsFaceLooks;  // two texels a surface, see vtkNURBSFaceLooks
uniform isamplerBuffer nurbsFaceIds;   // cell, block and process of a surface
flat in int nurbsTileIndex;
in vec2 nurbsT;
in vec3 nurbsNormalMC;

nurbsTileInfo nurbsFaceTile;
vec2 nurbsStart; // of the patch in the face's domain, 0 to 1
vec2 nurbsSize;

void nurbsTakePatch()
{
  ivec2 block = nurbsFaceTile.block;
  nurbsStart = vec2(texelFetch(nurbsKnots, block.x).r, texelFetch(nurbsKnots, block.y).r);
  nurbsSize = vec2(texelFetch(nurbsKnots, block.x + 1).r, texelFetch(nurbsKnots, block.y + 1).r);
}

uniform float nurbsMargin; // pixels by which triangles may be off the surface, and reach over its borders
mat2 nurbsPerPixel;        // change of t with x and y on screen

// Whether the face's trims leave a point over, or one within so many pixels: neighbours may disagree
// that much about where their edge is.
bool nurbsIsUntrimmed(vec2 t, float gap)
{
  int trim = nurbsFaceTile.trim;
  vec2 st = nurbsStart + t * nurbsSize;
  if (trim < 0 || nurbsInside(trim, st))
  {
    return true;
  }
  vec2 x = gap * nurbsPerPixel[0] * nurbsSize;
  vec2 y = gap * nurbsPerPixel[1] * nurbsSize;
  return nurbsInside(trim, st + x) || nurbsInside(trim, st - x) || nurbsInside(trim, st + y) ||
    nurbsInside(trim, st - y);
}

#ifdef NURBS_EXACT

uniform vec3 nurbsDepthAxis; // direction in which depth rises, in vertexMC's axes
uniform int nurbsCulled;     // 1: the inside is not drawn, 2: the outside, 0: both are

nurbsFound nurbsHere; // the point that this fragment shows
float nurbsDepth;     // its depth, 0 to 1
vec4 nurbsVertex;     // its place, as vertexMC
vec3 nurbsNormal;     // its unit normal, outwards, in vertexMC's axes
bool nurbsFront;      // whether the outside is seen
vec3 nurbsSight;      // direction away from the eye
mat2x3 nurbsSightChange; // with x and y on screen

void nurbsShow(nurbsRay ray, nurbsTileInfo tile, nurbsFound found)
{
  nurbsFaceTile = tile;
  nurbsTakePatch();
  nurbsHere = found;
  nurbsPerPixel = inverse(found.pixels);
  vec4 h = found.jet.h, hu = found.jet.hu, hv = found.jet.hv;
  vec3 point = h.xyz / h.w;
  nurbsDepth = 0.5 + 0.5 * dot(ray.z, h) / dot(ray.w, h);
  nurbsVertex = vec4(point + ray.origin, 1.0);
  vec3 normal = cross(hu.xyz - hu.w * point, hv.xyz - hv.w * point);
  // What the triangles say where it vanishes.
  nurbsNormal = normal == vec3(0.0) ? normalize(nurbsNormalMC)
    : nurbsFaceTile.reversed        ? -normalize(normal)
                                    : normalize(normal);
  nurbsSight = cross(ray.x.xyz, ray.y.xyz);
  float away = sign(dot(nurbsSight, nurbsDepthAxis));
  nurbsSight *= away;
  // A pixel further, the planes are turned by the plane w = 0.
  nurbsSightChange = away * mat2x3(cross(ray.y.xyz, ray.w.xyz), cross(ray.w.xyz, ray.x.xyz));
  nurbsFront = dot(nurbsNormal, nurbsSight) < 0.0;
}

// Pixels that this face may be off its neighbours at an edge.
float nurbsGap()
{
  float tolerance = texelFetch(nurbsOrigins, 2 * nurbsFaceTile.surface).w;
  return nurbsHere.noise + min(tolerance * nurbsHere.perUnit, 0.5);
}

// Beyond a side at which the surface ends, or the next patch joins with a crease, it is not this patch
// that is seen. Beyond other sides the next tile goes on as this one does, and either may draw the
// point; of a translucent surface, only the one that has it.
bool nurbsIsOnPatch(vec2 t)
{
  bool once = nurbsOnce == 1;
  for (int dir = 0; dir < 2; ++dir)
  {
    int sides = int(texelFetch(nurbsKnots, nurbsFaceTile.block[dir] + 3).r);
    float perPixel = length(vec2(nurbsPerPixel[0][dir], nurbsPerPixel[1][dir]));
    float open = perPixel * nurbsGap();
    float smoothly = min(2.0 * perPixel * nurbsMargin, 0.25);
    float within = perPixel * (nurbsHere.noise + 1e-4);
    vec2 range = once ? nurbsRange(nurbsFaceTile, dir) : vec2(0.0, 1.0);
    float low = (sides & 1) != 0 && range.x == 0.0 ? open : once ? within : smoothly;
    float high = (sides & 2) != 0 && range.y == 1.0 ? open : once ? within : smoothly;
    if (t[dir] < range.x - low || t[dir] > range.y + high)
    {
      return false;
    }
  }
  return true;
}

bool nurbsIsCulled()
{
  return nurbsCulled == (nurbsFront ? 2 : 1);
}

#ifdef NURBS_SAMPLES

uniform int nurbsSampleCount;
uniform vec2 nurbsSamples[NURBS_SAMPLES]; // places in the pixel, -1/2 to 1/2

// Which of the pixel's samples see the face: each for itself, by its own ray where the surface turns
// away, else by the parameters' change over the pixel. The fragment shows the first that does.
bool nurbsFindSamples()
{
  int mask = 0;
  nurbsFound center;
  nurbsTileInfo tile = nurbsFaceTile;
  nurbsRay ray = nurbsGetRay(tile.surface, gl_FragCoord.xy);
  bool hit = nurbsFindHit(ray, tile, nurbsT, center);
  bool steep = true;
  float coverage = 0.5;
  if (hit)
  {
    nurbsShow(ray, tile, center);
    vec4 h = center.jet.h;
    vec3 su = center.jet.hu.xyz - center.jet.hu.w / h.w * h.xyz;
    vec3 sv = center.jet.hv.xyz - center.jet.hv.w / h.w * h.xyz;
    vec3 normal = cross(su, sv);
    steep = abs(dot(normal, nurbsSight)) < 0.3 * length(normal) * length(nurbsSight);
    coverage = nurbsFaceTile.trim < 0 ? 1.0
      : nurbsCoverage(nurbsFaceTile.trim, nurbsStart + center.t * nurbsSize,
          nurbsPerPixel[0] * nurbsSize, nurbsPerPixel[1] * nurbsSize);
  }
  bool shown = hit;
  for (int i = 0; i < nurbsSampleCount; ++i)
  {
    vec2 offset = nurbsSamples[i];
    vec2 t = hit ? center.t + nurbsPerPixel * offset : nurbsT;
    if (steep)
    {
      nurbsFound found;
      tile = nurbsFaceTile;
      ray = nurbsGetRay(tile.surface, gl_FragCoord.xy + offset);
      if (!nurbsFindHit(ray, tile, t, found))
      {
        continue;
      }
      // Parameters of the face's domain go through all patches alike.
      t = (vec2(texelFetch(nurbsKnots, tile.block.x).r, texelFetch(nurbsKnots, tile.block.y).r) +
            found.t * vec2(texelFetch(nurbsKnots, tile.block.x + 1).r,
                        texelFetch(nurbsKnots, tile.block.y + 1).r) - nurbsStart) / nurbsSize;
      if (!shown)
      {
        nurbsShow(ray, tile, found);
        t = found.t;
        shown = true;
      }
    }
    bool untrimmed = steep || (coverage > 0.0 && coverage < 1.0) ? nurbsIsUntrimmed(t, nurbsGap()) : coverage > 0.5;
    if (untrimmed && nurbsIsOnPatch(t))
    {
      mask |= 1 << i;
    }
  }
  gl_SampleMask[0] = mask;
  return mask != 0;
}

#endif

#endif

bool nurbsIsSeen = true; // whether the pixel sees the face

// Finds out; called in uniform control flow.
void nurbsBeginFragment()
{
  nurbsFaceTile = nurbsGetTile(nurbsTileIndex);
  nurbsTakePatch();
#ifdef NURBS_SAMPLES
  nurbsIsSeen = nurbsFindSamples() && !nurbsIsCulled();
#elif defined(NURBS_EXACT)
  nurbsTileInfo tile = nurbsFaceTile;
  nurbsRay ray = nurbsGetRay(tile.surface, gl_FragCoord.xy);
  nurbsFound found;
  nurbsIsSeen = nurbsFindHit(ray, tile, nurbsT, found);
  nurbsShow(ray, tile, found);
  nurbsIsSeen = nurbsIsSeen && nurbsIsOnPatch(found.t) && nurbsIsUntrimmed(found.t, nurbsGap()) &&
    !nurbsIsCulled();
#else
  nurbsPerPixel = mat2(dFdx(nurbsT), dFdy(nurbsT));
  nurbsIsSeen = nurbsIsUntrimmed(nurbsT, nurbsMargin);
#endif
}

ivec3 nurbsIds()
{
  return texelFetch(nurbsFaceIds, nurbsFaceTile.surface).xyz;
}

//NURBS::Look::Dec

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
#ifdef NURBS_LOOK
  vec3 look = nurbsLook(diffuseIntensity > 1e-6 ? diffuseColor / diffuseIntensity
                                                : ambientColor / max(ambientIntensity, 1e-6));
  ambientColor = ambientIntensity * look;
  diffuseColor = diffuseIntensity * look;
#endif
}
