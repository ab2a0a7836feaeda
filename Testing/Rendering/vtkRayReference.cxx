// SPDX-License-Identifier: BSD-3-Clause
#include "vtkRayReference.h"

#include "vtkCamera.h"
#include "vtkMatrix4x4.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSParallel.h"
#include "vtkRenderer.h"

namespace
{

Eigen::Matrix4d ToClip(vtkRenderer* renderer)
{
  const vtkMatrix4x4* matrix = renderer->GetActiveCamera()->GetCompositeProjectionTransformMatrix(
    renderer->GetTiledAspectRatio(), -1.0, 1.0);
  Eigen::Matrix4d result;
  for (int i = 0; i < 16; ++i)
  {
    result(i / 4, i % 4) = matrix->GetElement(i / 4, i % 4);
  }
  return result;
}

} // namespace

vtkRayReference::vtkRayReference(vtkUnstructuredGrid* grid)
  : View(vtkNURBSModel::View(grid))
  , Caster(View->GetModel(), vtkNURBSParallelFor)
{}

nurbs::Ray vtkRayReference::PixelRay(vtkRenderer* renderer, double x, double y) const
{
  const int* size = renderer->GetSize();
  const Eigen::Matrix4d toModel = ToClip(renderer).inverse();
  const auto at = [&](double z) {
    const nurbs::Vec4 p =
      toModel * nurbs::Vec4(2.0 * x / size[0] - 1.0, 2.0 * y / size[1] - 1.0, z, 1.0);
    return nurbs::Vec3(p.head<3>() / p[3]);
  };
  const nurbs::Vec3 start = at(-1.0), end = at(1.0);
  nurbs::Ray ray;
  ray.Origin = start;
  ray.Direction = (end - start).normalized();
  ray.Min = 0.0;
  ray.Max = (end - start).norm();
  return ray;
}

std::vector<vtkRayReference::Pixel> vtkRayReference::Cast(vtkRenderer* renderer) const
{
  const int width = renderer->GetSize()[0], height = renderer->GetSize()[1];
  const Eigen::Matrix4d toClip = ToClip(renderer);
  std::vector<Pixel> pixels(std::size_t(width) * height);
  renderer->GetSize(); // keeps the size up to date before threads ask
  vtkNURBSParallelFor(0, height, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t k = first * width; k < last * width; ++k)
    {
      const nurbs::Ray ray = this->PixelRay(renderer, k % width + 0.5, k / width + 0.5);
      nurbs::RayHit hit;
      if (this->Caster.Nearest(ray, hit))
      {
        const nurbs::Vec4 clip = toClip * hit.Point.homogeneous();
        pixels[k] = { static_cast<int>(hit.Face), 0.5 + 0.5 * clip[2] / clip[3], hit.T,
          hit.Normal };
      }
    }
  });
  return pixels;
}
