// What analysis and synthesis share: the line of samples that a texel lies on, in direction
// DIRECTION (0: rows, 1: columns). WAVELET is 0 (Haar), 1 (interpolating) or 2 (lifted), see
// WaveletTransform.h.

uniform sampler2D nurbsGrids;
flat in ivec4 grid;

//VTK::Output::Dec

// Where the texel is: along its line, and across.
ivec2 linePlace()
{
  ivec2 s = ivec2(gl_FragCoord.xy) - grid.xy;
  return DIRECTION == 0 ? s.xy : s.yx;
}

vec4 fetchSample(int along, int across)
{
  return texelFetch(
    nurbsGrids, grid.xy + (DIRECTION == 0 ? ivec2(along, across) : ivec2(across, along)), 0);
}

// Intervals of the line before the analysis, negative if it is not halved.
int lineIntervals()
{
  return DIRECTION == 0 ? grid.z : grid.w;
}

// True for lines inside the grid. Those along its border are not updated: they are curves of their
// own. Columns are taken when rows are coarse samples and details, so that the last coarse one is
// the border.
bool isUpdated(int across)
{
  int intervals = DIRECTION == 0 ? grid.w : grid.z;
  int last = DIRECTION == 1 && intervals > 0 ? intervals / 2 : abs(intervals);
  return WAVELET == 2 && across != 0 && across != last;
}
