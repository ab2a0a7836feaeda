// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSFaceExtent.h"

#include "vtkCamera.h"
#include "vtkMath.h"

#include <algorithm>
#include <cmath>
#include <limits>

std::vector<double> vtkNURBSFaceExtent::PixelTolerances(const std::vector<nurbs::Box3>& boxes,
  vtkCamera* camera, const int viewport[2], double pixels, double least)
{
  std::vector<double> tolerances(boxes.size(), std::numeric_limits<double>::max());
  if (camera->GetParallelProjection())
  {
    const double size = 2.0 * camera->GetParallelScale() / viewport[1];
    std::fill(tolerances.begin(), tolerances.end(), std::max(least, pixels * size));
    return tolerances;
  }
  const nurbs::Vec3 eye(camera->GetPosition());
  const nurbs::Vec3 forward(camera->GetDirectionOfProjection());
  const int across = camera->GetUseHorizontalViewAngle() ? 0 : 1;
  const double slope = std::tan(0.5 * vtkMath::RadiansFromDegrees(camera->GetViewAngle()));
  const double perPixel = 2.0 * slope / viewport[across];
  // A length at depth z looks longest in the view's corner, turned against the line of sight.
  const double corner = slope * std::hypot(viewport[0], viewport[1]) / viewport[across];
  const double cosine = 1.0 / std::sqrt(1.0 + corner * corner);
  const double near = camera->GetClippingRange()[0];
  for (std::size_t f = 0; f < boxes.size(); ++f)
  {
    if (boxes[f].isEmpty())
    {
      continue;
    }
    double depth = std::numeric_limits<double>::max();
    double farthest = -std::numeric_limits<double>::max();
    for (int c = 0; c < 8; ++c)
    {
      const nurbs::Vec3 p = boxes[f].corner(static_cast<nurbs::Box3::CornerType>(c));
      depth = std::min(depth, (p - eye).dot(forward));
      farthest = std::max(farthest, (p - eye).dot(forward));
    }
    if (farthest < near) // unseen
    {
      depth = boxes[f].exteriorDistance(eye);
    }
    tolerances[f] = std::max(least, pixels * perPixel * cosine * std::max(near, depth));
  }
  return tolerances;
}
