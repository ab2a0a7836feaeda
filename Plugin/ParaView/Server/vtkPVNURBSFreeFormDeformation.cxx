// SPDX-License-Identifier: BSD-3-Clause
#include "vtkPVNURBSFreeFormDeformation.h"

#include "vtkObjectFactory.h"

#include <sstream>

vtkStandardNewMacro(vtkPVNURBSFreeFormDeformation);

void vtkPVNURBSFreeFormDeformation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "LatticeMoves: " << this->Moves.size() << "\n";
}

void vtkPVNURBSFreeFormDeformation::AddLatticeMove(
  double i, double j, double k, double dx, double dy, double dz)
{
  this->Moves.push_back({ i, j, k, dx, dy, dz });
  this->Modified();
}

void vtkPVNURBSFreeFormDeformation::RemoveAllLatticeMoves()
{
  if (!this->Moves.empty())
  {
    this->Moves.clear();
    this->Modified();
  }
}

int vtkPVNURBSFreeFormDeformation::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  // Set here and not as rows come, for Dimensions may be set after them.
  this->ResetLattice();
  int count[3];
  this->GetDimensions(count);
  std::ostringstream outside;
  for (const auto& [i, j, k, dx, dy, dz] : this->Moves)
  {
    const double at[3] = { i, j, k };
    bool inside = true;
    for (int a = 0; a < 3; ++a)
    {
      inside = inside && at[a] >= 0.0 && at[a] < count[a];
    }
    if (inside)
    {
      this->SetLatticeDisplacement(
        static_cast<int>(i), static_cast<int>(j), static_cast<int>(k), dx, dy, dz);
    }
    else
    {
      outside << " (" << i << ", " << j << ", " << k << ")";
    }
  }
  if (!outside.str().empty())
  {
    vtkWarningMacro("The lattice has " << count[0] << " x " << count[1] << " x " << count[2]
                                       << " points; left out:" << outside.str());
  }
  return this->Superclass::RequestData(request, inputs, outputs);
}
