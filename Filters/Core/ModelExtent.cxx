// SPDX-License-Identifier: BSD-3-Clause
#include "ModelExtent.h"

namespace nurbs
{

namespace
{

constexpr int Samples = 5;

Box3 FaceBox(const Model& model, const Face& face)
{
  const Box2 uv = LoopsBox(model, face);
  Box3 box;
  if (uv.isEmpty())
  {
    return box;
  }
  int count[2];
  for (int dir = 0; dir < 2; ++dir)
  {
    const bool linear = face.Geometry.Degree[dir] == 1 && face.Geometry.Count[dir] == 2;
    count[dir] = linear ? 2 : Samples;
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

} // namespace

std::vector<Box3> FaceBoxes(
  const Model& model, const std::vector<std::string>& faceErrors, const ParallelFor& parallel)
{
  std::vector<Box3> boxes(model.Faces.size());
  parallel(0, std::int64_t(boxes.size()), [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f)
    {
      if (faceErrors[f].empty())
      {
        boxes[f] = FaceBox(model, model.Faces[f]);
      }
    }
  });
  return boxes;
}

double Diagonal(const std::vector<Box3>& boxes)
{
  Box3 all;
  for (const Box3& box : boxes)
  {
    all.extend(box);
  }
  return all.isEmpty() ? 0.0 : all.diagonal().norm();
}

} // namespace nurbs
