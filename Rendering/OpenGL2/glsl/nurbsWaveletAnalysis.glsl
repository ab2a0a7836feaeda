//VTK::System::Dec

// One step of analysis along lines (Tan, Zhao, Lu 2012, section 4.3.2): coarse samples, details.

//NURBS::WaveletLine::Dec

vec4 detail(int k, int across)
{
  return fetchSample(2 * k + 1, across) -
    0.5 * (fetchSample(2 * k, across) + fetchSample(2 * k + 2, across));
}

// Neighbours take different ways through a branch, so that each waits for both; shares of 0, 1 and
// -1 do without, and change no bit.
vec4 analysed(int i, int across, int n)
{
  int middle = n / 2;
#if WAVELET == 0
  bool end = i == 0 || i == middle + 1;
  bool coarse = i < middle + 2;
  int k = coarse ? i - 1 : i - middle - 2;
  int first = i == 0 ? 0 : end ? n + 1 : 2 * k + 1;
  vec4 second = fetchSample(end ? first : first + 1, across);
  return 0.5 * (fetchSample(first, across) + (coarse ? 1.0 : -1.0) * second);
#else
  bool coarse = i <= middle;
  int at = coarse ? 2 * i : 2 * (i - middle) - 1;
  vec4 sides = fetchSample(max(at - 1, 0), across) + fetchSample(min(at + 1, n), across);
  vec4 value = fetchSample(at, across) - (coarse ? 0.0 : 0.5) * sides;
#if WAVELET == 2
  if (isUpdated(across) && i > 0 && i < middle)
  {
    value += 0.25 * (detail(i - 1, across) + detail(i, across));
  }
#endif
  return value;
#endif
}

void main()
{
  ivec2 place = linePlace();
  int n = lineIntervals();
  gl_FragData[0] =
    n > 0 ? analysed(place.x, place.y, n) : fetchSample(place.x, place.y);
}
