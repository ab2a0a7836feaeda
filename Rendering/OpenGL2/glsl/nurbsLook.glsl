// What only the exact surface can show: curvature, reflection lines, isophotes, draft angles, lines of
// constant parameter; and the face's edges.

#ifdef NURBS_LOOK

uniform int nurbsLookKind;            // vtkNURBSMapper::Looks
uniform samplerBuffer nurbsLookTable; // colours
uniform vec2 nurbsLookRange;          // values of the first and the last colour
uniform vec3 nurbsLookDirection;      // of stripes, light or draft, a unit vector in the model's axes
uniform float nurbsStripes;           // stripes in 180 degrees
uniform vec2 nurbsLineCounts;         // lines of constant u and v in the domain; 0: none
uniform float nurbsLineWidth;         // pixels
uniform vec3 nurbsLineColor;
uniform bool nurbsShowEdges;

// Second derivatives of the homogeneous surface.
void nurbsSecond(out vec4 huu, out vec4 huv, out vec4 hvv)
{
  nurbsTileInfo tile = nurbsFaceTile;
  float nu[NURBS_MAX_DEGREE + 1], du[NURBS_MAX_DEGREE + 1], ddu[NURBS_MAX_DEGREE + 1];
  float nv[NURBS_MAX_DEGREE + 1], dv[NURBS_MAX_DEGREE + 1], ddv[NURBS_MAX_DEGREE + 1];
  nurbsBasis(tile.block.x, tile.degree.x, nurbsHere.t.x, nu, du, ddu);
  nurbsBasis(tile.block.y, tile.degree.y, nurbsHere.t.y, nv, dv, ddv);
  huu = huv = hvv = vec4(0.0);
  for (int j = 0; j <= NURBS_MAX_DEGREE; ++j)
  {
    if (j > tile.degree.y)
    {
      break;
    }
    for (int i = 0; i <= NURBS_MAX_DEGREE; ++i)
    {
      if (i > tile.degree.x)
      {
        break;
      }
      vec4 p = texelFetch(nurbsPoints, tile.point + j * tile.stride + i);
      huu += ddu[i] * nv[j] * p;
      huv += du[i] * dv[j] * p;
      hvv += nu[i] * ddv[j] * p;
    }
  }
}

// Derivatives of the surface's point with the patch's parameters.
struct nurbsBend
{
  vec3 su, sv, suu, suv, svv;
};

nurbsBend nurbsGetBend()
{
  vec4 h = nurbsHere.jet.h, hu = nurbsHere.jet.hu, hv = nurbsHere.jet.hv, huu, huv, hvv;
  nurbsSecond(huu, huv, hvv);
  vec3 s = h.xyz / h.w;
  nurbsBend b;
  b.su = (hu.xyz - hu.w * s) / h.w;
  b.sv = (hv.xyz - hv.w * s) / h.w;
  b.suu = (huu.xyz - huu.w * s - 2.0 * hu.w * b.su) / h.w;
  b.suv = (huv.xyz - huv.w * s - hu.w * b.sv - hv.w * b.su) / h.w;
  b.svv = (hvv.xyz - hvv.w * s - 2.0 * hv.w * b.sv) / h.w;
  return b;
}

// Mean and Gaussian curvature, the former positive where the surface bends away from its outside.
vec2 nurbsCurvature(vec3 normal)
{
  nurbsBend b = nurbsGetBend();
  float e = dot(b.su, b.su), f = dot(b.su, b.sv), g = dot(b.sv, b.sv);
  float l = dot(b.suu, normal), m = dot(b.suv, normal), n = dot(b.svv, normal);
  float area = max(e * g - f * f, 1e-36);
  return vec2(-0.5 * (e * n - 2.0 * f * m + g * l), l * n - m * m) / area;
}

vec3 nurbsLookUp(float value)
{
  float last = float(textureSize(nurbsLookTable) - 1);
  float share = (value - nurbsLookRange.x) / (nurbsLookRange.y - nurbsLookRange.x);
  return texelFetch(nurbsLookTable, int(clamp(share, 0.0, 1.0) * last + 0.5)).rgb;
}

float nurbsPhase; // stripes counted from where the direction is looked at
float nurbsPhaseWidth; // how many of them a pixel sees

// The unit normal's change with x and y on screen.
mat2x3 nurbsTurn(vec3 normal)
{
  nurbsBend b = nurbsGetBend();
  vec3 across = cross(b.su, b.sv); // along the normal or against it
  float size = dot(across, normal);
  mat2x3 turn = mat2x3(cross(b.suu, b.sv) + cross(b.su, b.suv),
    cross(b.suv, b.sv) + cross(b.su, b.svv));
  for (int dir = 0; dir < 2; ++dir)
  {
    turn[dir] = size == 0.0 ? vec3(0.0) : (turn[dir] - dot(turn[dir], normal) * normal) / size;
  }
  return turn * nurbsPerPixel;
}

// Sets the variables above. Not by dFdx: a neighbouring pixel may show something else, or nothing.
void nurbsBeginLook()
{
  if (nurbsLookKind != 5 && nurbsLookKind != 6)
  {
    return;
  }
  vec3 normal = nurbsNormal;
  vec3 line = normal;
  mat2x3 change = nurbsTurn(normal);
  if (nurbsLookKind == 5)
  {
    float size = length(nurbsSight);
    vec3 sight = nurbsSight / size;
    line = reflect(sight, normal);
    for (int dir = 0; dir < 2; ++dir)
    {
      vec3 step = nurbsSightChange[dir] / size;
      step -= dot(step, sight) * sight;
      vec3 turn = change[dir];
      change[dir] = reflect(step, normal) -
        2.0 * (dot(sight, turn) * normal + dot(sight, normal) * turn);
    }
  }
  float cosine = clamp(dot(line, nurbsLookDirection), -1.0, 1.0);
  vec2 slope = nurbsLookDirection * change / sqrt(max(1.0 - cosine * cosine, 1e-12));
  nurbsPhase = acos(cosine) / 3.14159265 * nurbsStripes;
  nurbsPhaseWidth = (abs(slope.x) + abs(slope.y)) / 3.14159265 * nurbsStripes;
}

// Black and white by turns, grey where they are finer than pixels.
float nurbsStripe()
{
  float wave = abs(fract(0.5 * nurbsPhase) - 0.5) - 0.25; // distance from a stripe's border, halved
  float sharp = clamp(0.5 + 2.0 * wave / max(nurbsPhaseWidth, 1e-6), 0.0, 1.0);
  return mix(sharp, 0.5, clamp(nurbsPhaseWidth - 0.5, 0.0, 1.0));
}

// How much of the pixel is a line that is `distance` pixels away.
float nurbsLine(float distance)
{
  return clamp(0.5 * nurbsLineWidth + 0.5 - distance, 0.0, 1.0);
}

vec3 nurbsLook(vec3 color)
{
  vec3 normal = nurbsNormal;
  if (nurbsLookKind >= 1 && nurbsLookKind <= 4)
  {
    vec2 curvature = nurbsCurvature(normal);
    float root = sqrt(max(curvature.x * curvature.x - curvature.y, 0.0));
    color = nurbsLookUp(nurbsLookKind == 1 ? curvature.x
        : nurbsLookKind == 2              ? curvature.y
        : nurbsLookKind == 3              ? curvature.x - root
                                          : curvature.x + root);
  }
  else if (nurbsLookKind == 5 || nurbsLookKind == 6) // zebra, isophotes
  {
    color *= nurbsStripe();
  }
  else if (nurbsLookKind == 7) // draft angle: of the surface and the direction
  {
    color = nurbsLookUp(degrees(asin(clamp(dot(normal, nurbsLookDirection), -1.0, 1.0))));
  }
  float line = 0.0;
  for (int dir = 0; dir < 2; ++dir)
  {
    float perPixel = length(vec2(nurbsPerPixel[0][dir], nurbsPerPixel[1][dir]));
    if (nurbsLineCounts[dir] > 0.0)
    {
      float x = (nurbsStart[dir] + nurbsHere.t[dir] * nurbsSize[dir]) * nurbsLineCounts[dir];
      float off = abs(x - round(x)) / nurbsLineCounts[dir] / nurbsSize[dir];
      line = max(line, nurbsLine(off / perPixel));
    }
    if (nurbsShowEdges)
    {
      int sides = int(texelFetch(nurbsKnots, nurbsFaceTile.block[dir] + 3).r);
      float low = (sides & 1) != 0 ? nurbsHere.t[dir] / perPixel : 1e6;
      float high = (sides & 2) != 0 ? (1.0 - nurbsHere.t[dir]) / perPixel : 1e6;
      line = max(line, nurbsLine(max(min(low, high), 0.0)));
    }
  }
  if (nurbsShowEdges && nurbsFaceTile.trim >= 0)
  {
    // The part of a square around the pixel that is trimmed away tells how far the trim is.
    float width = nurbsLineWidth + 1.0;
    float coverage = nurbsCoverage(nurbsFaceTile.trim, nurbsStart + nurbsHere.t * nurbsSize,
      width * nurbsPerPixel[0] * nurbsSize, width * nurbsPerPixel[1] * nurbsSize);
    line = max(line, nurbsLine(max(coverage - 0.5, 0.0) * width));
  }
  return mix(color, nurbsLineColor, line);
}

#endif
