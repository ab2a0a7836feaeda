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

// From the near plane to the far one, through a place between -1 and 1 on the screen.
nurbs::Ray RayThrough(const Eigen::Matrix4d& toModel, double x, double y)
{
  const nurbs::Vec4 near = toModel * nurbs::Vec4(x, y, -1.0, 1.0);
  const nurbs::Vec4 far = toModel * nurbs::Vec4(x, y, 1.0, 1.0);
  const nurbs::Vec3 start = near.head<3>() / near[3], end = far.head<3>() / far[3];
  nurbs::Ray ray;
  ray.Origin = start;
  ray.Direction = (end - start).normalized();
  ray.Min = 0.0;
  ray.Max = (end - start).norm();
  return ray;
}

} // namespace

vtkRayReference::vtkRayReference(vtkUnstructuredGrid* grid)
  : View(vtkNURBSModel::View(grid))
  , Caster(View->GetModel(), vtkNURBSParallelFor)
{}

nurbs::Ray vtkRayReference::PixelRay(vtkRenderer* renderer, double x, double y) const
{
  const int* size = renderer->GetSize();
  return RayThrough(ToClip(renderer).inverse(), 2.0 * x / size[0] - 1.0, 2.0 * y / size[1] - 1.0);
}

std::vector<vtkRayReference::Pixel> vtkRayReference::Cast(vtkRenderer* renderer) const
{
  const int width = renderer->GetSize()[0], height = renderer->GetSize()[1];
  const Eigen::Matrix4d toClip = ToClip(renderer);
  std::vector<Pixel> pixels(std::size_t(width) * height);
  const Eigen::Matrix4d toModel = toClip.inverse(); // a camera is not for many threads to ask
  vtkNURBSParallelFor(0, height, [&](std::int64_t first, std::int64_t last) {
    for (std::int64_t k = first * width; k < last * width; ++k)
    {
      const nurbs::Ray ray = RayThrough(
        toModel, 2.0 * (k % width + 0.5) / width - 1.0, 2.0 * (k / width + 0.5) / height - 1.0);
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
