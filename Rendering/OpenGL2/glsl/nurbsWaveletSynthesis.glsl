//VTK::System::Dec

// One step of synthesis along lines, the inverse of nurbsWaveletAnalysis.glsl.

//NURBS::WaveletLine::Dec

// The fine sample 2 k.
vec4 evenSample(int k, int across, int middle)
{
  vec4 value = fetchSample(k, across);
  if (isUpdated(across) && k > 0 && k < middle)
  {
    value -= 0.25 * (fetchSample(middle + k, across) + fetchSample(middle + 1 + k, across));
  }
  return value;
}

void main()
{
  ivec2 place = linePlace();
  int i = place.x;
  int across = place.y;
  int n = lineIntervals();
  int middle = n / 2;
  vec4 value;
  if (n <= 0)
  {
    value = fetchSample(i, across);
  }
  else if (WAVELET == 0)
  {
    if (i == 0 || i == n + 1)
    {
      value = fetchSample(i == 0 ? 0 : middle + 1, across);
    }
    else
    {
      int k = (i - 1) / 2;
      vec4 difference = fetchSample(middle + 2 + k, across);
      value = fetchSample(k + 1, across) + (i % 2 == 1 ? difference : -difference);
    }
  }
  else if (i % 2 == 0)
  {
    value = evenSample(i / 2, across, middle);
  }
  else
  {
    int k = i / 2;
    value = fetchSample(middle + 1 + k, across) +
      0.5 * (evenSample(k, across, middle) + evenSample(k + 1, across, middle));
  }
  gl_FragData[0] = value;
}
