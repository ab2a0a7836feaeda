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
}
