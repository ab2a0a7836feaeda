//VTK::System::Dec

// One step of synthesis along lines, the inverse of nurbsWaveletAnalysis.glsl.

//NURBS::WaveletLine::Dec

// The fine sample 2 k.
vec4 evenSample(int k, int across, int middle)
{
  vec4 value = fetchSample(k, across);
#if WAVELET == 2
  if (isUpdated(across) && k > 0 && k < middle)
  {
    value -= 0.25 * (fetchSample(middle + k, across) + fetchSample(middle + 1 + k, across));
  }
#endif
  return value;
}

// Without branches, as the analysis.
vec4 synthesised(int i, int across, int n)
{
  int middle = n / 2;
#if WAVELET == 0
  bool end = i == 0 || i == n + 1;
  int k = clamp((i - 1) / 2, 0, middle - 1);
  int mean = i == 0 ? 0 : end ? middle + 1 : k + 1;
  float share = end ? 0.0 : i % 2 == 1 ? 1.0 : -1.0;
  return fetchSample(mean, across) + share * fetchSample(middle + 2 + k, across);
#else
  int k = i / 2;
  vec4 before = evenSample(k, across, middle);
  vec4 after = evenSample(min(k + 1, middle), across, middle);
  vec4 odd = fetchSample(middle + 1 + min(k, middle - 1), across) + 0.5 * (before + after);
  return i % 2 == 0 ? before : odd;
#endif
}

void main()
{
  ivec2 place = linePlace();
  int n = lineIntervals();
  gl_FragData[0] =
    n > 0 ? synthesised(place.x, place.y, n) : fetchSample(place.x, place.y);
}
