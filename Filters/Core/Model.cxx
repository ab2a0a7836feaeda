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

} // namespace nurbs
