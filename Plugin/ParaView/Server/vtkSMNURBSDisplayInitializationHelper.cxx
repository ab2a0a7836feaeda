// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMNURBSDisplayInitializationHelper.h"

#include "vtkNURBSModel.h"
#include "vtkPVNURBSModelInformation.h"

#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxy.h"
#include "vtkSMSourceProxy.h"

#include <string>

vtkStandardNewMacro(vtkSMNURBSDisplayInitializationHelper);

namespace
{

// Whether all cells have Degree, NetSize and KnotStart, the structure's arrays of two components.
bool MayBeModel(vtkPVDataInformation* about)
{
  if (about->GetDataSetType() != VTK_UNSTRUCTURED_GRID || about->GetNumberOfCells() == 0 ||
    about->GetNumberOfUniqueBlockTypes() > 1)
  {
    return false;
  }
  int count = 0;
  vtkPVDataSetAttributesInformation* cells = about->GetCellDataInformation();
  for (int n = 0; n < cells->GetNumberOfArrays(); ++n)
  {
    vtkPVArrayInformation* array = cells->GetArrayInformation(n);
    const bool isOurs = vtkNURBSModel::IsStructureArray(array->GetName());
    count += isOurs && array->GetNumberOfComponents() == 2 && !array->GetIsPartial();
  }
  return count == 3;
}

bool IsModel(vtkSMSourceProxy* source, unsigned int port)
{
  if (!MayBeModel(source->GetDataInformation(port)))
  {
    return false;
  }
  vtkNew<vtkPVNURBSModelInformation> information;
  information->SetPortNumber(static_cast<int>(port));
  source->GatherInformation(information);
  return information->GetIsModel();
}

// The width in pixels in which an output's lines show, if they are such that lie on surfaces; else 0.
int WidthOfLines(vtkSMSourceProxy* source, unsigned int port)
{
  const std::string name = source->GetXMLName();
  const bool isDrawing = name == "NURBSSilhouette" || (name == "NURBSVisibleRegions" && port == 1);
  return isDrawing ? 2 : name == "NURBSTessellator" && port == 1 ? 1 : 0;
}

void SetIfUntouched(
  vtkSMProxy* proxy, const char* name, const double* values, unsigned int count, vtkMTimeType since)
{
  vtkSMProperty* property = proxy->GetProperty(name);
  if (property && property->GetMTime() <= since)
  {
    vtkSMPropertyHelper(property).Set(values, count);
  }
}

} // namespace

void vtkSMNURBSDisplayInitializationHelper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

void vtkSMNURBSDisplayInitializationHelper::PostInitializeProxy(
  vtkSMProxy* proxy, vtkPVXMLElement*, vtkMTimeType started)
{
  vtkSMProperty* representation = proxy->GetProperty("Representation");
  vtkSMPropertyHelper input(proxy, "Input");
  auto* source = vtkSMSourceProxy::SafeDownCast(input.GetAsProxy());
  if (!source || !representation || representation->GetMTime() > started)
  {
    return;
  }
  vtkSMPropertyHelper type(representation);
  if (std::string(type.GetAsString()) == "Surface" && IsModel(source, input.GetOutputPort()))
  {
    type.Set("NURBS Surface");
  }
  // Lines in the colour of surfaces could not be told from them.
  if (const int width = WidthOfLines(source, input.GetOutputPort()))
  {
    const double black[3] = { 0.0, 0.0, 0.0 }, pixels = width;
    SetIfUntouched(proxy, "AmbientColor", black, 3, started);
    SetIfUntouched(proxy, "DiffuseColor", black, 3, started);
    SetIfUntouched(proxy, "LineWidth", &pixels, 1, started);
  }
}
