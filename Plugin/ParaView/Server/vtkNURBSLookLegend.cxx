// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSLookLegend.h"

#include "vtkNURBSMapper.h"
#include "vtkNURBSModel.h"

#include "vtkCoordinate.h"
#include "vtkDataObjectTree.h"
#include "vtkDataObjectTreeRange.h"
#include "vtkMath.h"
#include "vtkScalarBarActor.h"
#include "vtkScalarsToColors.h"
#include "vtkTextProperty.h"
#include "vtkUnstructuredGrid.h"

#include <string>

namespace
{

// The unit of the points, as the first model in what is drawn tells it.
std::string UnitOf(vtkDataObject* drawn)
{
  if (auto* tree = vtkDataObjectTree::SafeDownCast(drawn))
  {
    for (vtkDataObject* child : vtk::Range(tree, vtk::DataObjectTreeOptions::SkipEmptyNodes))
    {
      const std::string unit = UnitOf(child);
      if (!unit.empty())
      {
        return unit;
      }
    }
    return "";
  }
  auto* grid = vtkUnstructuredGrid::SafeDownCast(drawn);
  return grid ? vtkNURBSModel::GetLengthUnit(grid) : "";
}

// What a look shows, with its unit; "" if it is nothing that a legend could tell.
std::string TitleOf(int look, const std::string& unit)
{
  const std::string length = unit.empty() ? "length" : unit;
  switch (look)
  {
    case vtkNURBSMapper::MEAN_CURVATURE:
      return "Mean\ncurvature\n1 / " + length;
    case vtkNURBSMapper::GAUSSIAN_CURVATURE:
      return "Gaussian\ncurvature\n1 / " + length + "^2";
    case vtkNURBSMapper::MINIMUM_CURVATURE:
      return "Minimum\ncurvature\n1 / " + length;
    case vtkNURBSMapper::MAXIMUM_CURVATURE:
      return "Maximum\ncurvature\n1 / " + length;
    case vtkNURBSMapper::DRAFT_ANGLE:
      return "Draft\nangle\ndegrees";
    default:
      return "";
  }
}

} // namespace

vtkSmartPointer<vtkScalarBarActor> vtkNURBSLookLegend::Make()
{
  auto bar = vtkSmartPointer<vtkScalarBarActor>::New();
  bar->SetVisibility(0);
  // The title is centred above the bar; axes of orientation are below.
  bar->GetPositionCoordinate()->SetCoordinateSystemToViewport();
  bar->SetPosition(35.0, 130.0);
  bar->SetPosition2(0.14, 0.5);
  bar->SetVerticalTitleSeparation(10);
  bar->SetBarRatio(0.25);
  bar->SetNumberOfLabels(5);
  bar->SetUnconstrainedFontSize(true);
  for (vtkTextProperty* text : { bar->GetTitleTextProperty(), bar->GetLabelTextProperty() })
  {
    text->SetFontSize(14);
    text->ItalicOff();
    text->BoldOff();
    text->ShadowOff();
  }
  return bar;
}

void vtkNURBSLookLegend::Update(vtkScalarBarActor* bar, vtkNURBSMapper* mapper, bool wanted)
{
  vtkDataObject* drawn = mapper->GetInputDataObject(0, 0);
  const std::string title = TitleOf(mapper->GetLook(), UnitOf(drawn));
  double bounds[6];
  mapper->GetBounds(bounds);
  const bool shown = wanted && !title.empty() && vtkMath::AreBoundsInitialized(bounds) != 0;
  bar->SetVisibility(shown);
  if (shown)
  {
    bar->SetLookupTable(mapper->GetLookColors());
    bar->SetTitle(title.c_str());
    bar->SetLabelFormat(mapper->GetLook() == vtkNURBSMapper::DRAFT_ANGLE ? "%.0f" : "%.3g");
  }
}
