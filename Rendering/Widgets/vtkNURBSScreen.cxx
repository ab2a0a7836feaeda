// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSScreen.h"

#include "vtkCamera.h"
#include "vtkMatrix4x4.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"

namespace vtkNURBSScreen
{

bool MakeView(vtkRenderer* renderer, nurbs::ScreenView& view)
{
  vtkRenderWindow* window = renderer ? renderer->GetRenderWindow() : nullptr;
  if (!window || !renderer->IsActiveCameraCreated())
  {
    return false;
  }
  const int* size = window->GetSize();
  double port[4];
  renderer->GetViewport(port);
  view.Origin = nurbs::Vec2(size[0] * port[0], size[1] * port[1]);
  view.Size = nurbs::Vec2(size[0] * (port[2] - port[0]), size[1] * (port[3] - port[1]));
  vtkMatrix4x4* matrix = renderer->GetActiveCamera()->GetCompositeProjectionTransformMatrix(
    renderer->GetTiledAspectRatio(), -1.0, 1.0);
  for (int i = 0; i < 4; ++i)
  {
    for (int j = 0; j < 4; ++j)
    {
      view.WorldToClip(i, j) = matrix->GetElement(i, j);
    }
  }
  return view.Size.minCoeff() > 0.0;
}

std::vector<bool> FindHidden(vtkRenderer* renderer, const nurbs::ScreenView& view,
  const std::vector<nurbs::HandleHit>& hits, double pixels)
{
  std::vector<bool> hidden(hits.size(), false);
  vtkRenderWindow* window = renderer->GetRenderWindow();
  if (hits.empty() || window->GetNeverRendered())
  {
    return hidden;
  }
  Eigen::AlignedBox2i box;
  for (const nurbs::HandleHit& hit : hits)
  {
    box.extend(hit.Display.head<2>().array().floor().matrix().cast<int>());
  }
  const int* size = window->GetSize();
  box = box.intersection(
    Eigen::AlignedBox2i(Eigen::Vector2i(0, 0), Eigen::Vector2i(size[0] - 1, size[1] - 1)));
  if (box.isEmpty())
  {
    return hidden;
  }
  const int width = box.sizes()[0] + 1;
  std::vector<float> depths(std::size_t(width) * (box.sizes()[1] + 1), 1.0f);
  window->GetZbufferData(box.min()[0], box.min()[1], box.max()[0], box.max()[1], depths.data());
  for (std::size_t k = 0; k < hits.size(); ++k)
  {
    const Eigen::Vector2i pixel = hits[k].Display.head<2>().array().floor().matrix().cast<int>();
    if (box.contains(pixel))
    {
      const Eigen::Vector2i at = pixel - box.min();
      const double depth = 2.0 * depths[std::size_t(at[0]) + std::size_t(width) * at[1]] - 1.0;
      hidden[k] = depth < view.DepthInFront(hits[k].Display, pixels);
    }
  }
  return hidden;
}

} // namespace vtkNURBSScreen
