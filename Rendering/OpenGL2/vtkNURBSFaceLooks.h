// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkNURBSFaceLooks
 * @brief   colour, opacity and visibility of every face
 *
 * Colours are those of cell arrays through the mapper's lookup table, or those of blocks of a
 * composite data set. Eight bytes a surface, which nurbsFragment.glsl reads as two texels: red, green,
 * blue, opacity of the face; whether there is a colour (255 or 0), whether there is an opacity of the
 * block, that opacity, unused. Private to vtkNURBSMapper.
 */
#ifndef vtkNURBSFaceLooks_h
#define vtkNURBSFaceLooks_h

#include "vtkNURBSDrawnModel.h"

class vtkCompositeDataDisplayAttributes;
class vtkMapper;
class vtkSelection;

class vtkNURBSFaceLooks
{
public:
  /// Looks at the mapper's settings and the model's attributes as they are now. True if something
  /// is other than at the last time. Faces of the mapper's selection have the colour `selected`.
  bool Update(vtkMapper* mapper, const vtkNURBSDrawnModel& model,
    vtkCompositeDataDisplayAttributes* attributes, const double selected[3]);

  const std::vector<unsigned char>& GetBytes() const { return this->Bytes; }
  bool IsHidden(int surface) const { return this->Hidden[surface] != 0; }
  /// True if a face is seen whose own colour or block is translucent.
  bool HasTranslucent() const { return this->Translucent; }

private:
  void AddLeaf(vtkMapper* mapper, const vtkNURBSDrawnModel::Leaf& leaf,
    vtkCompositeDataDisplayAttributes* attributes);
  void MarkSelected(
    vtkSelection* selection, const vtkNURBSDrawnModel& model, const double color[3]);

  std::vector<std::pair<const void*, vtkMTimeType>> State;
  std::vector<unsigned char> Bytes;
  std::vector<char> Hidden;
  bool Translucent = false;
};

#endif
