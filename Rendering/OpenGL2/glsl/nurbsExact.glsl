// Where the ray of a pixel meets the surface itself.
//
// A fragment of the triangles is within PixelError of the surface's point that the pixel sees; that
// point is found by Newton's method on the two planes that meet in the pixel's ray. So silhouettes,
// trims and normals are those of the surface, not of the triangles; and two faces that share an edge
// agree about each pixel, whatever their triangles are.

uniform samplerBuffer nurbsPoints;
uniform samplerBuffer nurbsOrigins;
uniform vec3 nurbsShiftHigh;
uniform vec3 nurbsShiftLow;
uniform mat4 nurbsToClip;   // from vertexMC
uniform vec4 nurbsViewport; // x, y, width, height in pixels
uniform int nurbsOnce;      // 1: no point of the surface may be drawn twice, as it is translucent

// Homogeneous point and derivatives with respect to the patch's own parameters.
struct nurbsJet
{
  vec4 h, hu, hv;
};

// Basis functions of a span at t and their first and second derivatives, by the triangle of Cox and
// de Boor on the span's own knots. Here and below, loops have a constant count: compilers unroll them
// then, and keep arrays in registers.
void nurbsBasis(int block, int degree, float t, out float n[NURBS_MAX_DEGREE + 1],
  out float d[NURBS_MAX_DEGREE + 1], out float dd[NURBS_MAX_DEGREE + 1])
{
  // The functions of degree - 1 and degree - 2 give the derivatives of those of degree.
  for (int k = 0; k <= NURBS_MAX_DEGREE; ++k)
  {
    n[k] = 0.0;
    d[k] = 0.0;
    dd[k] = 0.0;
  }
  n[0] = 1.0;
  for (int r = 1; r <= NURBS_MAX_DEGREE; ++r)
  {
    if (r > degree)
    {
      break;
    }
    // Knots k[degree - r .. degree + r - 1] bound the functions of degree r.
    int first = block + 4 + degree - r;
    float saved = 0.0, savedD = 0.0, savedDD = 0.0;
    for (int j = 0; j < NURBS_MAX_DEGREE; ++j)
    {
      if (j >= r)
      {
        break;
      }
      float low = texelFetch(nurbsKnots, first + j).r;
      float high = texelFetch(nurbsKnots, first + j + r).r;
      float width = 1.0 / (high - low);
      float a = (t - low) * width;
      float left = (1.0 - a) * n[j] + saved;
      float leftD = (1.0 - a) * d[j] - width * n[j] + savedD;
      float leftDD = (1.0 - a) * dd[j] - 2.0 * width * d[j] + savedDD;
      saved = a * n[j];
      savedD = a * d[j] + width * n[j];
      savedDD = a * dd[j] + 2.0 * width * d[j];
      n[j] = left;
      d[j] = leftD;
      dd[j] = leftDD;
    }
    n[r] = saved;
    d[r] = savedD;
    dd[r] = savedDD;
  }
}

nurbsJet nurbsEvaluate(nurbsTileInfo tile, vec2 t)
{
  float nu[NURBS_MAX_DEGREE + 1], du[NURBS_MAX_DEGREE + 1], ddu[NURBS_MAX_DEGREE + 1];
  float nv[NURBS_MAX_DEGREE + 1], dv[NURBS_MAX_DEGREE + 1], ddv[NURBS_MAX_DEGREE + 1];
  nurbsBasis(tile.block.x, tile.degree.x, t.x, nu, du, ddu);
  nurbsBasis(tile.block.y, tile.degree.y, t.y, nv, dv, ddv);
  nurbsJet jet = nurbsJet(vec4(0.0), vec4(0.0), vec4(0.0));
  for (int j = 0; j <= NURBS_MAX_DEGREE; ++j)
  {
    if (j > tile.degree.y)
    {
      break;
    }
    vec4 row = vec4(0.0), rowU = vec4(0.0);
    int first = tile.point + j * tile.stride;
    for (int i = 0; i <= NURBS_MAX_DEGREE; ++i)
    {
      if (i > tile.degree.x)
      {
        break;
      }
      vec4 p = texelFetch(nurbsPoints, first + i);
      row += nu[i] * p;
      rowU += du[i] * p;
    }
    jet.h += nv[j] * row;
    jet.hu += nv[j] * rowU;
    jet.hv += dv[j] * row;
  }
  return jet;
}

// The two planes through the pixel's ray, in coordinates relative to the surface's origin; scaled so
// that their values, over the clip coordinate w, are pixels.
struct nurbsRay
{
  vec4 x, y, z, w;
  vec3 origin; // of the surface, in vertexMC's coordinates
};

nurbsRay nurbsGetRay(int surface, vec2 pixel)
{
  vec2 ndc = 2.0 * (pixel - nurbsViewport.xy) / nurbsViewport.zw - 1.0;
  mat4 m = transpose(nurbsToClip);
  nurbsRay ray;
  ray.x = 0.5 * nurbsViewport.z * (m[0] - ndc.x * m[3]);
  ray.y = 0.5 * nurbsViewport.w * (m[1] - ndc.y * m[3]);
  ray.z = m[2];
  ray.w = m[3];
  ray.origin = (texelFetch(nurbsOrigins, 2 * surface).xyz - nurbsShiftHigh) +
    (texelFetch(nurbsOrigins, 2 * surface + 1).xyz - nurbsShiftLow);
  ray.x.w += dot(ray.x.xyz, ray.origin);
  ray.y.w += dot(ray.y.xyz, ray.origin);
  ray.z.w += dot(ray.z.xyz, ray.origin);
  ray.w.w += dot(ray.w.xyz, ray.origin);
  return ray;
}

// What a ray has found.
struct nurbsFound
{
  vec2 t;        // parameters of the patch
  nurbsJet jet;
  mat2 pixels;   // change on screen, in pixels, with t
  float perUnit; // pixels of a unit of length
  float noise;   // pixels of rounding errors in single precision
};

// From parameters near the hit to the hit. False if the ray passes the surface by.
bool nurbsHit(nurbsRay ray, nurbsTileInfo tile, vec2 start, out nurbsFound found)
{
  vec2 t = clamp(start, 0.0, 1.0); // triangles reach over borders, where high degrees run away
  float radius = texelFetch(nurbsOrigins, 2 * tile.surface + 1).w;
  vec2 last = t;
  float side = 0.0; // on which side of the outline the search began
  float least = 1e30;
  int poor = 0;
  for (int i = 0; i < 12; ++i)
  {
    nurbsJet jet = nurbsEvaluate(tile, t);
    vec2 f = vec2(dot(ray.x, jet.h), dot(ray.y, jet.h));
    vec2 fu = vec2(dot(ray.x, jet.hu), dot(ray.y, jet.hu));
    vec2 fv = vec2(dot(ray.x, jet.hv), dot(ray.y, jet.hv));
    float w = dot(ray.w, jet.h);
    // Derivatives of the place on screen, by the quotient rule.
    fu -= f * (dot(ray.w, jet.hu) / w);
    fv -= f * (dot(ray.w, jet.hv) / w);
    float perUnit = length(ray.x.xyz) * jet.h.w / w;
    found = nurbsFound(t, jet, mat2(fu, fv) / w, perUnit, 2e-7 * radius * perUnit);
    float det = fu.x * fv.y - fu.y * fv.x;
    if (det == 0.0)
    {
      break;
    }
    vec2 step = vec2(f.x * fv.y - f.y * fv.x, fu.x * f.y - fu.y * f.x) / det;
    float miss = length(f) / abs(w);
    if (miss < 0.002 + found.noise)
    {
      found.t -= clamp(step, -0.01, 0.01); // what is left is the square of that
      return true;
    }
    side = i == 0 ? sign(det) : side;
    if (sign(det) != side)
    {
      t = mix(last, t, 0.25); // the step led over the outline, where another point is
      continue;
    }
    // Where there is a hit, even at the outline, a step leaves a quarter or less, but for a few.
    poor += miss > 0.5 * least ? 1 : 0;
    if (poor > 2)
    {
      break;
    }
    least = min(least, miss);
    // No further than a patch: beyond it the polynomials mean nothing.
    last = t;
    t = clamp(t - clamp(step, -0.5, 0.5), -0.25, 1.25);
  }
  return false;
}

// Goes on into the next patch, if the point is beyond a side across which the surface is smooth.
bool nurbsStepOver(inout nurbsTileInfo tile, int dir, inout vec2 t)
{
  int side = t[dir] < 0.0 ? -1 : t[dir] > 1.0 ? 1 : 0;
  int block = tile.block[dir];
  float start = texelFetch(nurbsKnots, block).r;
  float size = texelFetch(nurbsKnots, block + 1).r;
  int open = int(texelFetch(nurbsKnots, block + 3).r);
  bool ends = side < 0 ? start <= 0.0 || (open & 1) != 0 : start + size >= 1.0 || (open & 2) != 0;
  if (side == 0 || ends)
  {
    return false;
  }
  int next = block + side * (4 + 2 * tile.degree[dir]);
  float first = texelFetch(nurbsKnots, block + 2).r;
  float nextFirst = texelFetch(nurbsKnots, next + 2).r;
  t[dir] = (start + t[dir] * size - texelFetch(nurbsKnots, next).r) / texelFetch(nurbsKnots, next + 1).r;
  tile.block[dir] = next;
  tile.point += int(nextFirst - first) * (dir == 0 ? 1 : tile.stride);
  return true;
}

// The hit in the patch that the ray meets, which may be the next one; that draws it itself if no point
// may be drawn twice.
bool nurbsFindHit(nurbsRay ray, inout nurbsTileInfo tile, vec2 start, out nurbsFound found)
{
  vec2 t = start;
  for (int hop = 0; hop < 3; ++hop)
  {
    if (!nurbsHit(ray, tile, t, found))
    {
      return false;
    }
    if (nurbsOnce == 1)
    {
      break;
    }
    t = found.t;
    bool overU = nurbsStepOver(tile, 0, t);
    bool overV = nurbsStepOver(tile, 1, t);
    if (!overU && !overV)
    {
      break;
    }
  }
  return true;
}
