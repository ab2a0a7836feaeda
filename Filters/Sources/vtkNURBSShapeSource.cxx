// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSShapeSource.h"

#include "PieceBuilder.h"
#include "Shapes.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSPieces.h"

#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

vtkStandardNewMacro(vtkNURBSShapeSource);

vtkNURBSShapeSource::vtkNURBSShapeSource()
{
  this->SetNumberOfInputPorts(0);
}

vtkNURBSShapeSource::~vtkNURBSShapeSource() = default;

namespace
{

const char* const ShapeNames[] = { "sphere", "torus", "cylinder", "cone", "disc", "plate", "teapot",
  "sheet", "car body", "vase", "missile", "spring" };

nurbs::SheetOptions MakeSheetOptions(vtkNURBSShapeSource* source)
{
  nurbs::SheetOptions options;
  for (int dir = 0; dir < 2; ++dir)
  {
    options.Points[dir] = source->GetSheetPoints()[dir];
    options.Degree[dir] = source->GetSheetDegree()[dir];
  }
  options.Size = source->GetSheetSize();
  options.Amplitude = source->GetSheetAmplitude();
  options.Waves = source->GetSheetWaves();
  options.Rational = source->GetSheetRational();
  return options;
}

void AddShape(vtkNURBSShapeSource* source, nurbs::ModelBuilder& builder)
{
  const double radius = source->GetRadius();
  switch (source->GetShape())
  {
    case vtkNURBSShapeSource::SPHERE:
      nurbs::AddSphere(builder, radius);
      break;
    case vtkNURBSShapeSource::TORUS:
      nurbs::AddTorus(builder, radius, source->GetTubeRadius());
      break;
    case vtkNURBSShapeSource::CYLINDER:
      nurbs::AddCylinder(builder, radius, source->GetHeight(), source->GetCapping());
      break;
    case vtkNURBSShapeSource::CONE:
      nurbs::AddCone(builder, radius, source->GetHeight(), source->GetCapping());
      break;
    case vtkNURBSShapeSource::DISC:
      nurbs::AddDisc(builder, radius);
      break;
    case vtkNURBSShapeSource::PLATE:
      nurbs::AddPlate(builder, source->GetPlateSize()[0], source->GetPlateSize()[1],
        source->GetPlateHoles()[0], source->GetPlateHoles()[1]);
      break;
    case vtkNURBSShapeSource::TEAPOT:
      nurbs::AddTeapot(builder);
      break;
    case vtkNURBSShapeSource::SHEET:
      nurbs::AddSheet(builder, MakeSheetOptions(source));
      break;
    case vtkNURBSShapeSource::CAR_BODY:
      nurbs::AddCarBody(builder, source->GetNumberOfPatches());
      break;
    case vtkNURBSShapeSource::VASE:
      nurbs::AddVase(builder);
      break;
    case vtkNURBSShapeSource::MISSILE:
      nurbs::AddMissile(builder);
      break;
    case vtkNURBSShapeSource::SPRING:
      nurbs::AddSpring(builder);
      break;
  }
}

} // namespace

int vtkNURBSShapeSource::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  outputVector->GetInformationObject(0)->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
  return 1;
}

int vtkNURBSShapeSource::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkUnstructuredGrid* output = vtkUnstructuredGrid::GetData(outputVector);
  nurbs::ModelBuilder builder;
  try
  {
    AddShape(this, builder);
  }
  catch (const nurbs::Error& error)
  {
    vtkErrorMacro(<< "No " << ShapeNames[this->Shape] << " was made: " << error.what());
    return 0;
  }
  int piece = 0;
  int pieces = 1;
  if (!vtkNURBSPieces::IsPieceAsked(outputVector->GetInformationObject(0), piece, pieces))
  {
    vtkNURBSModel::Store(builder, output);
    return 1;
  }
  const auto faces = nurbs::DealModels({ &builder }, piece, pieces).front();
  nurbs::PieceBuilder part = nurbs::TakeFaces(builder, faces.first, faces.second);
  vtkNURBSModel::Store(part.Model, output);
  vtkNURBSModel::SetGlobalIds(output, part.EdgeIds, part.VertexIds);
  return 1;
}

double vtkNURBSShapeSource::GetPlateArea()
{
  try
  {
    return nurbs::PlateArea(
      this->PlateSize[0], this->PlateSize[1], this->PlateHoles[0], this->PlateHoles[1]);
  }
  catch (const nurbs::Error& error)
  {
    vtkErrorMacro(<< error.what());
    return 0.0;
  }
}

void vtkNURBSShapeSource::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Shape: " << ShapeNames[this->Shape] << "\n";
  os << indent << "Radius: " << this->Radius << "\n";
  os << indent << "TubeRadius: " << this->TubeRadius << "\n";
  os << indent << "Height: " << this->Height << "\n";
  os << indent << "Capping: " << (this->Capping ? "On\n" : "Off\n");
  os << indent << "PlateSize: " << this->PlateSize[0] << ", " << this->PlateSize[1] << "\n";
  os << indent << "PlateHoles: " << this->PlateHoles[0] << ", " << this->PlateHoles[1] << "\n";
  os << indent << "SheetPoints: " << this->SheetPoints[0] << ", " << this->SheetPoints[1] << "\n";
  os << indent << "SheetDegree: " << this->SheetDegree[0] << ", " << this->SheetDegree[1] << "\n";
  os << indent << "SheetSize: " << this->SheetSize << "\n";
  os << indent << "SheetAmplitude: " << this->SheetAmplitude << "\n";
  os << indent << "SheetWaves: " << this->SheetWaves << "\n";
  os << indent << "SheetRational: " << (this->SheetRational ? "On\n" : "Off\n");
  os << indent << "NumberOfPatches: " << this->NumberOfPatches << "\n";
}
