// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkNURBSMeshMapper
 * @brief Draws triangles and keeps its index buffers while only their points move.
 *
 * A vtkPolyDataMapper for meshes that are updated in place, as those of vtkNURBSDeformingTessellator.
 * VTK up to 9.2 compares the present state of the cells with all states that it has seen since the
 * mapper was made, and so makes and sends the index buffers of every frame in which a point moved: of
 * 1,000,000 points that is most of the time that a frame takes. This one compares it with the last.
 * Composite data sets need one mapper a block.
 *
 * @sa vtkNURBSDeformingTessellator
 */
#ifndef vtkNURBSMeshMapper_h
#define vtkNURBSMeshMapper_h

#include "vtkNURBSRenderingOpenGL2Module.h" // For export macro
#include "vtkOpenGLPolyDataMapper.h"

class VTKNURBSRENDERINGOPENGL2_EXPORT vtkNURBSMeshMapper : public vtkOpenGLPolyDataMapper
{
public:
  static vtkNURBSMeshMapper* New();
  vtkTypeMacro(vtkNURBSMeshMapper, vtkOpenGLPolyDataMapper);
  void PrintSelf(ostream& os, vtkIndent indent) override;

protected:
  vtkNURBSMeshMapper();
  ~vtkNURBSMeshMapper() override;

  void BuildIBO(vtkRenderer* renderer, vtkActor* actor, vtkPolyData* mesh) override;

private:
  vtkNURBSMeshMapper(const vtkNURBSMeshMapper&) = delete;
  void operator=(const vtkNURBSMeshMapper&) = delete;
};

#endif
