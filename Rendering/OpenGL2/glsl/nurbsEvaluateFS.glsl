//VTK::System::Dec

// De Boor's algorithm in one direction (Tan, Zhao, Lu 2012, equations 5 to 7), DEGREE known when the
// shader is compiled. The span of a sample is known from its tile; the last step of the recursion
// gives the derivative as well.
//
// ALONG_U: control points to points of the curves of rows, and their derivatives.
// Else: those rows to positions and unit normals.

uniform samplerBuffer nurbsKnots;
flat in ivec4 tilePlaceLog;
flat in ivec4 tileFirstRows;
flat in ivec4 tileBlockPoint;

//VTK::Output::Dec

// d[0 .. DEGREE] are the points of the span; value and derivative at t of the span. Loops have
// constant counts: compilers unroll them then, and keep d in registers.
void deBoor(inout vec4 d[DEGREE + 1], int block, float t, out vec4 derivative)
{
  for (int r = 1; r < DEGREE; ++r)
  {
    for (int j = DEGREE; j > 0; --j)
    {
      if (j >= r)
      {
        float low = texelFetch(nurbsKnots, block + 3 + j).r;
        float high = texelFetch(nurbsKnots, block + 4 + j - r + DEGREE).r;
        float a = (t - low) / (high - low);
        d[j] = mix(d[j - 1], d[j], a);
      }
    }
  }
  derivative = float(DEGREE) * (d[DEGREE] - d[DEGREE - 1]);
  d[DEGREE] = mix(d[DEGREE - 1], d[DEGREE], t);
}

#ifdef ALONG_U

uniform samplerBuffer nurbsPoints;

void main()
{
  ivec2 s = ivec2(gl_FragCoord.xy) - tilePlaceLog.xy;
  float t = float(tileFirstRows.x + s.x) / float(1 << tilePlaceLog.z);
  int first = tileBlockPoint.z + s.y * tileBlockPoint.w;
  vec4 d[DEGREE + 1];
  for (int k = 0; k <= DEGREE; ++k)
  {
    d[k] = texelFetch(nurbsPoints, first + k);
  }
  vec4 derivative;
  deBoor(d, tileBlockPoint.x, t, derivative);
  gl_FragData[0] = d[DEGREE];
  gl_FragData[1] = derivative;
}

#else

uniform sampler2D nurbsRows;
uniform sampler2D nurbsRowDerivatives;

// d(H.xyz / H.w) from the derivative of H.
vec3 project(vec4 derivative, vec3 point, float w)
{
  return (derivative.xyz - derivative.w * point) / w;
}

void main()
{
  ivec2 s = ivec2(gl_FragCoord.xy) - tilePlaceLog.xy;
  ivec2 column = tileFirstRows.zw + ivec2(s.x, 0);
  float t = float(tileFirstRows.y + s.y) / float(1 << tilePlaceLog.w);
  vec4 d[DEGREE + 1];
  vec4 e[DEGREE + 1];
  for (int k = 0; k <= DEGREE; ++k)
  {
    d[k] = texelFetch(nurbsRows, column + ivec2(0, k), 0);
    e[k] = texelFetch(nurbsRowDerivatives, column + ivec2(0, k), 0);
  }
  // The size of the derivatives, to tell those that vanish.
  float size = length(d[0].xyz / d[0].w - d[DEGREE].xyz / d[DEGREE].w);
  float sizeU = 0.0;
  for (int k = 0; k <= DEGREE; ++k)
  {
    sizeU = max(sizeU, length(e[k].xyz));
  }
  vec4 hv, huv;
  deBoor(d, tileBlockPoint.y, t, hv);
  deBoor(e, tileBlockPoint.y, t, huv);
  vec4 h = d[DEGREE];
  vec4 hu = e[DEGREE];
  vec3 point = h.xyz / h.w;
  vec3 su = project(hu, point, h.w);
  vec3 sv = project(hv, point, h.w);
  vec3 normal = cross(su, sv);
  // A pole: the normal's limit on the way into the patch, by the mixed derivative.
  vec3 suv = (huv.xyz - huv.w * point - hu.w * sv - hv.w * su) / h.w;
  if (length(su) <= 1e-5 * max(sizeU / h.w, length(suv)))
  {
    normal = cross(2.0 * t < 1.0 ? suv : -suv, sv);
  }
  else if (length(sv) <= 1e-5 * max(size, length(suv)))
  {
    float tu = float(tileFirstRows.x + s.x) / float(1 << tilePlaceLog.z);
    normal = cross(su, 2.0 * tu < 1.0 ? suv : -suv);
  }
  float len = length(normal);
  gl_FragData[0] = vec4(point, 1.0);
  gl_FragData[1] = vec4(len > 0.0 ? normal / len : vec3(0.0), 0.0);
}

#endif
