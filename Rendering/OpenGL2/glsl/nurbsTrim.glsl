// SPDX-License-Identifier: BSD-3-Clause
// Is a fragment of a trimmed NURBS face inside its trimming loops? GLSL 1.50.
//
// The steps of FaceTrim::Inside (Filters/Core/TrimIndex.h, which says what counts as inside and where
// the method comes from) on the texels of nurbs::Flatten. Coordinates `st` are (u, v) normalised to
// the face's domain: [0, 1] x [0, 1]. What rounding may get wrong lies within a few steps of a float
// (2.5e-7 of the domain) of the boundary, whatever the zoom.
//
// nurbsTrimRecords (RGBA32I), a face from its start texel on:
//   header        (first point texel, root, 0, 0); the root is a child as those of nodes
//   leaf texels   integers, four a texel:
//                 2 x (number of references) + (parity of all that is not referred to),
//                 number of ordered references, then the references, ordered ones first:
//                 (place << 8) | (degree << 3) | (falling << 2) | (above << 1) | below
//                 place: of the piece, counted from the face's first point texel
//                 falling: u decreases as v increases
//                 above, below: 1 if the piece counts for points above or below it
// nurbsTrimPoints (RGBA32F), a face from its first point texel on:
//   nodes         (split, direction: 0 u, 1 v, low child, high child); a child is the index of a node,
//                 -1 outside, -2 inside, or -3 - k: the leaf that starts k texels after the header
//   pieces        the box (low u, low v, high u, high v), then, for degrees over 1, the inner
//                 coefficients C(n, i) w_i (x_i, y_i, 1) in the box's coordinates; the ends are
//                 (0, 0, 1) and (1, 1, 1)
uniform samplerBuffer nurbsTrimPoints;
uniform isamplerBuffer nurbsTrimRecords;

// The largest float below 1: the upper sides of the domain belong to the face.
const float nurbsBelowOne = 0.99999994;

int nurbsTrimInteger(int index)
{
  return texelFetch(nurbsTrimRecords, index >> 2)[index & 3];
}

// The homogeneous point of a piece at t.
vec3 nurbsPiecePoint(int place, int degree, float t)
{
  vec3 h;
  if (t <= 0.5) // Horner's scheme in t / (1 - t), which the projection cancels
  {
    float r = t / (1.0 - t);
    h = vec3(r);
    for (int i = degree - 1; i > 0; --i)
    {
      h = (h + texelFetch(nurbsTrimPoints, place + i).xyz) * r;
    }
    return h + vec3(0.0, 0.0, 1.0);
  }
  float r = (1.0 - t) / t;
  h = vec3(0.0, 0.0, r);
  for (int i = 1; i < degree; ++i)
  {
    h = (h + texelFetch(nurbsTrimPoints, place + i).xyz) * r;
  }
  return h + vec3(1.0);
}

// True if the piece, which rises from (0, 0) to (1, 1), lies right of p at its height: bisection until
// p is outside the box of what remains.
bool nurbsRisesRight(int place, int degree, vec2 p)
{
  if (degree == 1)
  {
    return p.y > p.x;
  }
  float low = 0.0;
  float high = 1.0;
  for (int step = 0; step < 26; ++step)
  {
    float middle = 0.5 * (low + high);
    vec3 h = nurbsPiecePoint(place, degree, middle);
    bool right = h.x > p.x * h.z;
    bool higher = h.y > p.y * h.z;
    if (right != higher)
    {
      return right;
    }
    if (higher)
    {
      high = middle;
    }
    else
    {
      low = middle;
    }
  }
  return false;
}

// A piece's part in the parity at p.
bool nurbsCounts(int reference, int place, vec4 box, vec2 p)
{
  if (p.y < box.y)
  {
    return (reference & 1) != 0;
  }
  if (p.y >= box.w)
  {
    return (reference & 2) != 0;
  }
  if (p.x < box.x || p.x >= box.z)
  {
    return p.x < box.x;
  }
  bool falling = (reference & 4) != 0;
  vec2 local = (vec2(falling ? box.z - p.x : p.x - box.x, p.y - box.y)) / (box.zw - box.xy);
  return nurbsRisesRight(place, (reference >> 3) & 31, local) != falling;
}

bool nurbsCounts(int reference, int firstPoint, vec2 p)
{
  int place = firstPoint + (reference >> 8);
  return nurbsCounts(reference, place, texelFetch(nurbsTrimPoints, place), p);
}

// From a child down to what is no node: -1, -2 or a leaf.
int nurbsTrimDescend(int firstPoint, int child, vec2 p)
{
  while (child >= 0)
  {
    vec4 node = texelFetch(nurbsTrimPoints, firstPoint + child);
    child = int((node.y < 0.5 ? p.x : p.y) < node.x ? node.z : node.w);
  }
  return child;
}

bool nurbsInsideFrom(int trimStart, int firstPoint, int child, vec2 p)
{
  child = nurbsTrimDescend(firstPoint, child, p);
  if (child > -3)
  {
    return child == -2;
  }
  int leaf = 4 * (trimStart + 1 - 3 - child);
  ivec4 head = texelFetch(nurbsTrimRecords, leaf >> 2);
  int first = leaf + 2;
  int right = 0;
  int end = head.y;
  while (right < end)
  {
    int middle = (right + end) / 2;
    if (nurbsCounts(nurbsTrimInteger(first + middle), firstPoint, p))
    {
      right = middle + 1;
    }
    else
    {
      end = middle;
    }
  }
  int parity = head.x + right;
  for (int k = head.y; k < (head.x >> 1); ++k)
  {
    parity += nurbsCounts(nurbsTrimInteger(first + k), firstPoint, p) ? 1 : 0;
  }
  return (parity & 1) != 0;
}

vec2 nurbsTrimClamp(vec2 st)
{
  return clamp(st, vec2(0.0), vec2(nurbsBelowOne));
}

// True if st is inside the face whose header is at trimStart; -1: the face is not trimmed.
bool nurbsInside(int trimStart, vec2 st)
{
  if (trimStart < 0)
  {
    return true;
  }
  ivec4 header = texelFetch(nurbsTrimRecords, trimStart);
  return nurbsInsideFrom(trimStart, header.x, header.y, nurbsTrimClamp(st));
}

// The mean of eight points of the footprint, on a grid turned so that no two are in line with an axis.
float nurbsSampledCoverage(
  int trimStart, int firstPoint, int child, vec2 st, vec2 dstdx, vec2 dstdy)
{
  const ivec2 places[8] = ivec2[8](ivec2(1, -3), ivec2(-1, 3), ivec2(5, 1), ivec2(-3, -5),
    ivec2(-5, 5), ivec2(-7, -1), ivec2(3, 7), ivec2(7, -7));
  int count = 0;
  for (int k = 0; k < 8; ++k)
  {
    vec2 place = vec2(places[k]) / 16.0;
    vec2 p = nurbsTrimClamp(st + place.x * dstdx + place.y * dstdy);
    count += nurbsInsideFrom(trimStart, firstPoint, child, p) ? 1 : 0;
  }
  return float(count) / 8.0;
}

// The part of the square [-1/2, 1/2]^2 where value + dot(slope, (x, y)) > 0.
float nurbsHalfPlaneCoverage(float value, vec2 slope)
{
  slope = abs(slope);
  float large = max(slope.x, slope.y);
  float small = min(slope.x, slope.y);
  float off = abs(value);
  float part = 1.0;
  if (off <= 0.5 * (large - small))
  {
    part = large > 0.0 ? 0.5 + off / large : 0.5;
  }
  else if (off < 0.5 * (large + small))
  {
    float corner = 0.5 * (large + small) - off; // cut off by the line: a triangle
    part = 1.0 - 0.5 * corner * corner / (large * small);
  }
  return value < 0.0 ? 1.0 - part : part;
}

// The part of the footprint that lies left of a piece which runs through it from side to side: that of
// the half-plane beside the piece's chord across it. `reach`: half of the footprint's box.
float nurbsPieceCoverage(
  int reference, int place, vec4 box, vec2 st, vec2 reach, vec2 dstdx, vec2 dstdy)
{
  int degree = (reference >> 3) & 31;
  vec2 size = box.zw - box.xy;
  // A level piece has no sense of its own, but tells on which side it counts.
  bool falling = (reference & (size.y > 0.0 ? 4 : 1)) != 0;
  vec2 p = st - box.xy;
  if (falling) // mirrored, so that the piece rises; left of it is then right of it
  {
    p.x = box.z - st.x;
    dstdx.x = -dstdx.x;
    dstdy.x = -dstdy.x;
  }
  vec2 from = vec2(0.0);
  vec2 to = size;
  float low = 0.0;
  float high = 1.0;
  for (int step = 0; step < 26 && degree > 1; ++step)
  {
    if (all(lessThan(to - from, 0.25 * reach)))
    {
      break;
    }
    float middle = 0.5 * (low + high);
    vec3 h = nurbsPiecePoint(place, degree, middle);
    vec2 away = h.xy / h.z * size - p;
    if (away.x >= reach.x && away.y <= -reach.y)
    {
      return falling ? 0.0 : 1.0;
    }
    if (away.x <= -reach.x && away.y >= reach.y)
    {
      return falling ? 1.0 : 0.0;
    }
    // Towards where the curve crosses the footprint's falling diagonal.
    if (away.x * reach.y + away.y * reach.x > 0.0)
    {
      high = middle;
      to = away + p;
    }
    else
    {
      low = middle;
      from = away + p;
    }
  }
  vec2 normal = vec2(from.y - to.y, to.x - from.x);
  float part = nurbsHalfPlaneCoverage(
    dot(normal, p - from), vec2(dot(normal, dstdx), dot(normal, dstdy)));
  return falling ? 1.0 - part : part;
}

bool nurbsIsWithin(vec2 p, vec2 low, vec2 high)
{
  return all(greaterThanEqual(p, low)) && all(lessThanEqual(p, high));
}

// The part of a pixel's footprint, the parallelogram st + x dstdx + y dstdy with |x|, |y| <= 1/2, that
// is inside the face; dstdx and dstdy are dFdx(st) and dFdy(st) where those are to be had.
//
// 0 or 1 if no piece's box meets the footprint's. Where one piece runs through it, the area beside the
// piece's chord (Schollmeyer and Froehlich 2019 estimate coverage from the nearest curve's distance);
// where pieces end or are more than one, the mean of eight samples.
float nurbsCoverage(int trimStart, vec2 st, vec2 dstdx, vec2 dstdy)
{
  if (trimStart < 0)
  {
    return 1.0;
  }
  ivec4 header = texelFetch(nurbsTrimRecords, trimStart);
  vec2 reach = 0.5 * (abs(dstdx) + abs(dstdy));
  vec2 low = nurbsTrimClamp(st - reach);
  vec2 high = nurbsTrimClamp(st + reach);
  int child = header.y;
  while (child >= 0)
  {
    vec4 node = texelFetch(nurbsTrimPoints, header.x + child);
    bool isU = node.y < 0.5;
    bool reachesLow = (isU ? low.x : low.y) < node.x;
    bool reachesHigh = (isU ? high.x : high.y) >= node.x;
    if (reachesLow && reachesHigh)
    {
      return nurbsSampledCoverage(trimStart, header.x, child, st, dstdx, dstdy);
    }
    child = int(reachesLow ? node.z : node.w);
  }
  if (child > -3)
  {
    return child == -2 ? 1.0 : 0.0;
  }
  int leaf = 4 * (trimStart + 1 - 3 - child);
  ivec4 head = texelFetch(nurbsTrimRecords, leaf >> 2);
  if (head.y > 8) // bisection of many pieces, eight times, is less than a look at each
  {
    return nurbsSampledCoverage(trimStart, header.x, child, st, dstdx, dstdy);
  }
  bool inside = (head.x & 1) != 0;
  int passing = -1;
  for (int k = 0; k < (head.x >> 1); ++k)
  {
    int reference = nurbsTrimInteger(leaf + 2 + k);
    int place = header.x + (reference >> 8);
    vec4 box = texelFetch(nurbsTrimPoints, place);
    bool spans = box.y <= low.y && high.y < box.w;
    bool apart = high.y < box.y || low.y >= box.w || (spans && (high.x < box.x || low.x >= box.z));
    if (apart)
    {
      inside = inside != nurbsCounts(reference, place, box, low);
      continue;
    }
    bool falling = (reference & 4) != 0;
    bool endsIn = nurbsIsWithin(vec2(falling ? box.z : box.x, box.y), low, high) ||
      nurbsIsWithin(vec2(falling ? box.x : box.z, box.w), low, high);
    bool beside = high.x < box.x || low.x >= box.z; // but ends at a height of the footprint's
    if (passing >= 0 || beside || endsIn)
    {
      return nurbsSampledCoverage(trimStart, header.x, child, st, dstdx, dstdy);
    }
    passing = reference;
  }
  if (passing < 0)
  {
    return inside ? 1.0 : 0.0;
  }
  int place = header.x + (passing >> 8);
  float part = nurbsPieceCoverage(passing, place, texelFetch(nurbsTrimPoints, place),
    nurbsTrimClamp(st), reach, dstdx, dstdy);
  return inside ? 1.0 - part : part;
}
