//VTK::System::Dec

// Evaluation by basis functions in many passes (Krishnamurthy, Khardekar, McMains 2007), as Tan, Zhao
// and Lu 2012 describe the method that theirs is compared with. The spans of samples come from the
// CPU.
//
// BASIS: one pass a degree and direction, a row a sample: the functions' values, and in the last pass
// their derivatives.
// Else: sums of control points times functions, to positions and unit normals.
//
// LOCAL: only the DEGREE + 1 functions that do not vanish; else those of the whole net.

//VTK::Output::Dec

#ifdef BASIS

uniform sampler2D lower;       // functions of the degree below: value, derivative
uniform samplerBuffer knots;
uniform isamplerBuffer spans;  // of samples
uniform int degree;            // of this pass
uniform int functions;         // columns
uniform int samples;
uniform vec2 domain;           // start, length

float share(float above, float below)
{
  return below > 0.0 ? above / below : 0.0;
}

void main()
{
  ivec2 place = ivec2(gl_FragCoord.xy);
  int span = texelFetch(spans, place.y).r;
#ifdef LOCAL
  int i = span - DEGREE + place.x;
#else
  int i = place.x;
#endif
  float value = i == span ? 1.0 : 0.0;
  float derivative = 0.0;
  if (degree > 0)
  {
    float u = domain.x + domain.y * (float(place.y) / float(samples - 1));
    float a = texelFetch(lower, place, 0).r;
    float b = place.x + 1 < functions ? texelFetch(lower, place + ivec2(1, 0), 0).r : 0.0;
    vec4 k = vec4(texelFetch(knots, i).r, texelFetch(knots, i + degree).r,
      texelFetch(knots, i + 1).r, texelFetch(knots, i + degree + 1).r);
    a = share(a, k.y - k.x);
    b = share(b, k.w - k.z);
    value = (u - k.x) * a + (k.w - u) * b;
    derivative = float(degree) * (a - b);
  }
  gl_FragData[0] = vec4(value, derivative, 0.0, 0.0);
}

#else

uniform sampler2D basisU;
uniform sampler2D basisV;
uniform samplerBuffer points;
uniform isamplerBuffer spansU;
uniform isamplerBuffer spansV;
uniform int countU;
uniform int countV;

void main()
{
  ivec2 place = ivec2(gl_FragCoord.xy);
#ifdef LOCAL
  ivec2 first = ivec2(texelFetch(spansU, place.x).r, texelFetch(spansV, place.y).r) - DEGREE;
  ivec2 count = ivec2(DEGREE + 1);
#else
  ivec2 first = ivec2(0);
  ivec2 count = ivec2(countU, countV);
#endif
  vec4 h = vec4(0.0);
  vec4 hu = vec4(0.0);
  vec4 hv = vec4(0.0);
  for (int j = 0; j < count.y; ++j)
  {
    vec2 v = texelFetch(basisV, ivec2(j, place.y), 0).rg;
    for (int i = 0; i < count.x; ++i)
    {
      vec2 u = texelFetch(basisU, ivec2(i, place.x), 0).rg;
      vec4 p = texelFetch(points, first.x + i + (first.y + j) * countU);
      h += u.x * v.x * p;
      hu += u.y * v.x * p;
      hv += u.x * v.y * p;
    }
  }
  vec3 point = h.xyz / h.w;
  vec3 normal = cross(hu.xyz - hu.w * point, hv.xyz - hv.w * point);
  gl_FragData[0] = vec4(point, 1.0);
  gl_FragData[1] = vec4(normalize(normal), 0.0);
}

#endif
