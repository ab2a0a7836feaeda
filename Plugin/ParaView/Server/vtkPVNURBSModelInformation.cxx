// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVNURBSModelInformation.h"

#include "ModelChecks.h"
#include "vtkNURBSModel.h"

#include "vtkAlgorithm.h"
#include "vtkClientServerStream.h"
#include "vtkCompositeDataSet.h"
#include "vtkCompositeDataSetRange.h"
#include "vtkDataSet.h"
#include "vtkMultiProcessStream.h"
#include "vtkObjectFactory.h"
#include "vtkUnstructuredGrid.h"

vtkStandardNewMacro(vtkPVNURBSModelInformation);

void vtkPVNURBSModelInformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "PortNumber: " << this->PortNumber << "\n";
  os << indent << "Models: " << this->Models << "\n";
  os << indent << "Others: " << this->Others << "\n";
}

void vtkPVNURBSModelInformation::CopyFromObject(vtkObject* algorithm)
{
  this->Models = this->Others = 0;
  auto* producer = vtkAlgorithm::SafeDownCast(algorithm);
  vtkDataObject* data = producer ? producer->GetOutputDataObject(this->PortNumber) : nullptr;
  const auto count = [this](vtkDataObject* leaf) {
    auto* dataSet = vtkDataSet::SafeDownCast(leaf);
    if (!dataSet || dataSet->GetNumberOfCells() > 0)
    {
      auto* grid = vtkUnstructuredGrid::SafeDownCast(leaf);
      std::vector<nurbs::ModelProblem> problems;
      const bool isModel = vtkNURBSModel::IsModel(grid) && vtkNURBSModel::Validate(grid, problems);
      ++(isModel ? this->Models : this->Others);
    }
  };
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
  {
    for (vtkDataObject* leaf : vtk::Range(composite, vtk::CompositeDataSetOptions::SkipEmptyNodes))
    {
      count(leaf);
    }
  }
  else if (data)
  {
    count(data);
  }
}

void vtkPVNURBSModelInformation::AddInformation(vtkPVInformation* other)
{
  if (auto* same = vtkPVNURBSModelInformation::SafeDownCast(other))
  {
    this->Models += same->Models;
    this->Others += same->Others;
  }
}

void vtkPVNURBSModelInformation::CopyToStream(vtkClientServerStream* stream)
{
  stream->Reset();
  *stream << vtkClientServerStream::Reply << this->Models << this->Others
          << vtkClientServerStream::End;
}

void vtkPVNURBSModelInformation::CopyFromStream(const vtkClientServerStream* stream)
{
  if (!stream->GetArgument(0, 0, &this->Models) || !stream->GetArgument(0, 1, &this->Others))
  {
    vtkErrorMacro("The server's answer can't be read.");
  }
}

void vtkPVNURBSModelInformation::CopyParametersToStream(vtkMultiProcessStream& stream)
{
  stream << this->PortNumber;
}

void vtkPVNURBSModelInformation::CopyParametersFromStream(vtkMultiProcessStream& stream)
{
  stream >> this->PortNumber;
}
