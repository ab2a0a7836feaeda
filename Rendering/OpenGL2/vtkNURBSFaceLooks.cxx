// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSFaceLooks.h"

#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkMapper.h"
#include "vtkScalarsToColors.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"
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

bool vtkNURBSFaceLooks::Update(vtkMapper* mapper, const vtkNURBSDrawnModel& model,
  vtkCompositeDataDisplayAttributes* attributes, const double selected[3])
{
  vtkSelection* selection = mapper->GetSelection();
  std::vector<std::pair<const void*, vtkMTimeType>> state;
  state.emplace_back(mapper, mapper->GetMTime());
  state.emplace_back(attributes, attributes ? attributes->GetMTime() : 0);
  state.emplace_back(selection, selection ? selection->GetMTime() : 0);
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
  if (selection)
  {
    this->MarkSelected(selection, model, selected);
  }
  // The lookup table may have been made, and built, just now.
  state.resize(3 + model.GetLeaves().size());
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

void vtkNURBSFaceLooks::MarkSelected(
  vtkSelection* selection, const vtkNURBSDrawnModel& model, const double color[3])
{
  for (unsigned int n = 0; n < selection->GetNumberOfNodes(); ++n)
  {
    vtkSelectionNode* node = selection->GetNode(n);
    auto* cells = vtkIdTypeArray::SafeDownCast(node->GetSelectionList());
    if (!cells || node->GetFieldType() != vtkSelectionNode::CELL ||
      node->GetContentType() != vtkSelectionNode::INDICES)
    {
      continue;
    }
    vtkInformation* about = node->GetProperties();
    const bool ofBlock = about->Has(vtkSelectionNode::COMPOSITE_INDEX()) != 0;
    const int block = ofBlock ? about->Get(vtkSelectionNode::COMPOSITE_INDEX()) : 0;
    const bool ofProcess = about->Has(vtkSelectionNode::PROCESS_ID()) != 0;
    const int process = ofProcess ? about->Get(vtkSelectionNode::PROCESS_ID()) : -1;
    for (const vtkNURBSDrawnModel::Leaf& leaf : model.GetLeaves())
    {
      const auto faces = static_cast<vtkIdType>(leaf.Model().Faces.size());
      const bool named = (leaf.FlatIndex == 0 || (ofBlock && int(leaf.FlatIndex) == block)) &&
        (leaf.Process < 0 || process < 0 || leaf.Process == process);
      for (vtkIdType i = 0; named && i < cells->GetNumberOfValues(); ++i)
      {
        const vtkIdType face = cells->GetValue(i);
        if (face >= 0 && face < faces)
        {
          unsigned char* look = &this->Bytes[8 * (leaf.First + face)];
          std::transform(color, color + 3, look, Byte);
          look[4] = 255;
        }
      }
    }
  }
}
