//VTK::System::Dec

// One step of analysis along lines (Tan, Zhao, Lu 2012, section 4.3.2): coarse samples, details.

//NURBS::WaveletLine::Dec

vec4 detail(int k, int across)
{
  return fetchSample(2 * k + 1, across) -
    0.5 * (fetchSample(2 * k, across) + fetchSample(2 * k + 2, across));
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
    if (i == 0 || i == middle + 1)
    {
      value = fetchSample(i == 0 ? 0 : n + 1, across);
    }
    else if (i < middle + 2)
    {
      value = 0.5 * (fetchSample(2 * i - 1, across) + fetchSample(2 * i, across));
    }
    else
    {
      int k = i - middle - 2;
      value = 0.5 * (fetchSample(2 * k + 1, across) - fetchSample(2 * k + 2, across));
    }
  }
  else if (i > middle)
  {
    value = detail(i - middle - 1, across);
  }
  else
  {
    value = fetchSample(2 * i, across);
    if (isUpdated(across) && i > 0 && i < middle)
    {
      value += 0.25 * (detail(i - 1, across) + detail(i, across));
    }
  }
  gl_FragData[0] = value;
}
