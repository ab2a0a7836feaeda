// SPDX-License-Identifier: BSD-3-Clause
#include "Model.h"

namespace nurbs
{

Box2 LoopsBox(const Model& model, const Face& face)
{
  Box2 box;
  for (std::int64_t l = face.FirstLoop; l < face.FirstLoop + face.LoopCount; ++l)
  {
    const TrimLoop& loop = model.Loops[l];
    for (std::int64_t c = loop.FirstCurve; c < loop.FirstCurve + loop.CurveCount; ++c)
    {
      const CurveView<2>& curve = model.TrimCurves[c].Geometry;
      for (int i = 0; i < curve.Count; ++i)
      {
        box.extend(curve.Point(i));
      }
    }
  }
  const Interval u = face.Geometry.Domain(0), v = face.Geometry.Domain(1);
  const Box2 domain(Vec2(u.Min, v.Min), Vec2(u.Max, v.Max));
  return box.isEmpty() ? domain : box.intersection(domain);
}

Box3 SampledBox(const Model& model, const Face& face)
{
  Box3 box;
  if (face.Geometry.Size() == 0)
  {
    return box;
  }
  const Box2 uv = LoopsBox(model, face);
  if (uv.isEmpty())
  {
    return box;
  }
  int count[2];
  for (int dir = 0; dir < 2; ++dir)
  {
    const bool linear = face.Geometry.Degree[dir] == 1 && face.Geometry.Count[dir] == 2;
    count[dir] = linear ? 2 : 5;
  }
  for (int j = 0; j < count[1]; ++j)
  {
    const double v = uv.min()[1] + uv.sizes()[1] * j / (count[1] - 1);
    for (int i = 0; i < count[0]; ++i)
    {
      const double u = uv.min()[0] + uv.sizes()[0] * i / (count[0] - 1);
      box.extend(Evaluate(face.Geometry, u, v));
    }
  }
  return box;
}

} // namespace nurbs
