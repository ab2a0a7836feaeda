// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a picture ought to show: rays through pixels against the exact surfaces of a model.
#ifndef vtkRayReference_h
#define vtkRayReference_h

#include "RayCaster.h"
#include "vtkNURBSModelView.h"
#include "vtkUnstructuredGrid.h"

#include <memory>
#include <vector>

class vtkRenderer;

/// The pixels of a renderer that fills its window, as rays see them. Parallel over rows.
class vtkRayReference
{
public:
  explicit vtkRayReference(vtkUnstructuredGrid* grid);

  struct Pixel
  {
    int Face = -1;      ///< Cell; -1: background.
    double Depth = 1.0; ///< As in the depth buffer.
    double T = 0.0;     ///< Distance from the near plane along the ray, model units.
    nurbs::Vec3 Normal; ///< Of the hit face, outwards.
  };
  /// Rows from the bottom.
  std::vector<Pixel> Cast(vtkRenderer* renderer) const;
  /// The ray through a place on the screen (pixels; the centre of the first is 0.5, 0.5).
  nurbs::Ray PixelRay(vtkRenderer* renderer, double x, double y) const;
  const nurbs::RayCaster& GetCaster() const { return this->Caster; }
  const nurbs::Face& GetFace(std::int64_t face) const { return this->View->GetModel().Faces[face]; }

private:
  std::shared_ptr<const vtkNURBSModelView> View;
  nurbs::RayCaster Caster;
};

#endif
