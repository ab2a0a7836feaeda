// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSFaceLooks.h"

#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkMapper.h"
#include "vtkScalarsToColors.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>

namespace
{

unsigned char Byte(double share)
{
  return static_cast<unsigned char>(std::lround(255.0 * std::min(std::max(share, 0.0), 1.0)));
}

} // namespace

bool vtkNURBSFaceLooks::Update(
  vtkMapper* mapper, const vtkNURBSDrawnModel& model, vtkCompositeDataDisplayAttributes* attributes)
{
  std::vector<std::pair<const void*, vtkMTimeType>> state;
  state.emplace_back(mapper, mapper->GetMTime());
  state.emplace_back(attributes, attributes ? attributes->GetMTime() : 0);
  for (const vtkNURBSDrawnModel::Leaf& leaf : model.GetLeaves())
  {
    state.emplace_back(leaf.Grid, leaf.Grid->GetMTime());
  }
  if (vtkScalarsToColors* table = mapper->GetLookupTable())
  {
    state.emplace_back(table, table->GetMTime());
  }
  if (state == this->State)
  {
    return false;
  }
  this->Bytes.clear();
  this->Hidden.clear();
  this->Translucent = false;
  for (const vtkNURBSDrawnModel::Leaf& leaf : model.GetLeaves())
  {
    this->AddLeaf(mapper, leaf, attributes);
  }
  // The lookup table may have been made, and built, just now.
  state.resize(2 + model.GetLeaves().size());
  state[0].second = mapper->GetMTime();
  if (vtkScalarsToColors* table = mapper->GetLookupTable())
  {
    state.emplace_back(table, table->GetMTime());
  }
  this->State = std::move(state);
  return true;
}

void vtkNURBSFaceLooks::AddLeaf(vtkMapper* mapper, const vtkNURBSDrawnModel::Leaf& leaf,
  vtkCompositeDataDisplayAttributes* attributes)
{
  vtkDataObject* block = leaf.Grid;
  const auto has = [&](auto test) { return attributes && (attributes->*test)(block); };
  using Attributes = vtkCompositeDataDisplayAttributes;
  const bool hidden =
    has(&Attributes::HasBlockVisibility) && !attributes->GetBlockVisibility(block);
  const bool hasColor = has(&Attributes::HasBlockColor);
  const bool hasOpacity = has(&Attributes::HasBlockOpacity);
  double color[3] = { 1.0, 1.0, 1.0 };
  if (hasColor)
  {
    attributes->GetBlockColor(block, color);
  }
  const double opacity = hasOpacity ? attributes->GetBlockOpacity(block) : 1.0;
  int inCells = 0;
  mapper->ClearColorArrays(); // they are of another leaf
  vtkUnsignedCharArray* colors = mapper->MapScalars(leaf.Grid, 1.0, inCells);
  if (inCells != 1)
  {
    colors = nullptr;
  }
  const auto faces = static_cast<vtkIdType>(leaf.Model().Faces.size());
  for (vtkIdType f = 0; f < faces; ++f)
  {
    unsigned char look[8] = { Byte(color[0]), Byte(color[1]), Byte(color[2]), 255,
      Byte(hasColor || colors), Byte(hasOpacity), Byte(opacity), 0 };
    if (colors && !hasColor)
    {
      for (int k = 0; k < colors->GetNumberOfComponents(); ++k)
      {
        look[k] = colors->GetValue(colors->GetNumberOfComponents() * f + k);
      }
    }
    this->Bytes.insert(this->Bytes.end(), look, look + 8);
    this->Hidden.push_back(hidden);
    this->Translucent = this->Translucent || (!hidden && (look[3] < 255 || opacity < 1.0));
  }
}
