//VTK::System::Dec

// A rectangle of the target for each grid: all its samples.

uniform isamplerBuffer nurbsRectangles; // place, intervals of u and v (negative: not halved)
uniform int endSamples;                 // samples of a line beyond its intervals
uniform vec2 targetSize;

flat out ivec4 grid;

void main()
{
  grid = texelFetch(nurbsRectangles, gl_InstanceID);
  vec2 samples = vec2(abs(grid.zw) + endSamples);
  vec2 corner = vec2(grid.xy) + samples * vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(2.0 * corner / targetSize - 1.0, 0.0, 1.0);
}
