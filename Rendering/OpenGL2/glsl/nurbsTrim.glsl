uniform samplerBuffer nurbsTrimPoints;
uniform isamplerBuffer nurbsTrimRecords;
bool nurbsInside(int trimStart, vec2 st)
{
  return true;
}
