// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkNURBSGridIndices
 * @brief   indices that draw tiles of every shape as triangles, lines or points
 *
 * Private to vtkNURBSMapper. The context must be current, and a vertex array object bound.
 */
#ifndef vtkNURBSGridIndices_h
#define vtkNURBSGridIndices_h

#include "TileSelection.h"

class vtkNURBSGridIndices
{
public:
  void Bind();
  void Unbind();
  /// Draws `count` tiles of a shape by one call; representation is that of vtkProperty.
  void Draw(int representation, int shape, int count) const;
  /// Deletes it; without a context (its window is gone) it is only forgotten.
  void Release(bool hasContext);

private:
  struct Range
  {
    std::size_t Offset = 0; ///< In bytes.
    int Count = 0;
  };
  unsigned int Buffer = 0;
  Range Ranges[3][nurbs::Tile::ShapeCount];
};

#endif
