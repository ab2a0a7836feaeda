// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSCADReader.h"

#include "CADDocument.h"
#include "PieceBuilder.h"
#include "vtkCellData.h"
#include "vtkDataAssembly.h"
#include "vtkDoubleArray.h"
#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSParallel.h"
#include "vtkNURBSPieces.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkUnstructuredGrid.h"

#include <chrono>

vtkStandardNewMacro(vtkNURBSCADReader);

namespace
{

constexpr double ParsePart = 0.8; // of the progress

double Now()
{
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

/// One model of the output while it is made.
struct Model
{
  nurbs::ModelBuilder Builder;
  std::vector<double> Errors;
  std::vector<std::string> Unconverted;
  std::vector<std::int64_t> EdgeIds, VertexIds; ///< Of a piece.
};

/// Keeps of all models the faces of a piece.
void TakePiece(std::vector<Model>& models, int piece, int pieces)
{
  std::vector<const nurbs::ModelBuilder*> builders;
  for (const Model& model : models)
  {
    builders.push_back(&model.Builder);
  }
  const auto ranges = nurbs::DealModels(builders, piece, pieces);
  for (std::size_t i = 0; i < models.size(); ++i)
  {
    Model& model = models[i];
    const auto [first, last] = ranges[i];
    nurbs::PieceBuilder part = nurbs::TakeFaces(model.Builder, first, last);
    model.Builder = std::move(part.Model);
    model.EdgeIds = std::move(part.EdgeIds);
    model.VertexIds = std::move(part.VertexIds);
    model.Errors = std::vector<double>(model.Errors.begin() + first, model.Errors.begin() + last);
  }
}

/// A placed copy of a part, in the output's unit.
void Append(
  const nurbs::Part& part, nurbs::CADDocument::Instance& instance, double scale, Model& model)
{
  for (std::size_t i = 0; i < part.Faces.size(); ++i)
  {
    if (!part.Faces[i].Failure.empty())
    {
      model.Unconverted.push_back(
        std::to_string(instance.Faces[i].FaceId) + ": " + part.Faces[i].Failure);
    }
  }
  nurbs::Placement placement = instance.Placement;
  placement.Linear *= scale;
  placement.Shift *= scale;
  nurbs::AppendPart(part, placement, instance.Faces, model.Builder, model.Errors);
}

void Store(Model& model, const std::string& unit, bool colors, vtkUnstructuredGrid* grid)
{
  model.Builder.LengthUnit = unit;
  vtkNURBSModel::Store(model.Builder, grid);
  vtkNew<vtkDoubleArray> errors;
  errors->SetName("ConversionError");
  errors->SetNumberOfValues(static_cast<vtkIdType>(model.Errors.size()));
  std::copy(model.Errors.begin(), model.Errors.end(), errors->GetPointer(0));
  grid->GetCellData()->AddArray(errors);
  if (!colors)
  {
    grid->GetCellData()->RemoveArray(vtkNURBSModel::ColorName());
  }
  if (!model.Unconverted.empty())
  {
    vtkNURBSModel::SetUnconvertedFaces(grid, model.Unconverted);
  }
  if (!model.EdgeIds.empty())
  {
    vtkNURBSModel::SetGlobalIds(grid, model.EdgeIds, model.VertexIds);
  }
}

void AddModel(
  vtkPartitionedDataSetCollection* output, vtkUnstructuredGrid* grid, const std::string& name)
{
  const unsigned int index = output->GetNumberOfPartitionedDataSets();
  output->SetNumberOfPartitionedDataSets(index + 1);
  output->SetNumberOfPartitions(index, 1);
  output->SetPartition(index, 0, grid);
  output->GetMetaData(index)->Set(vtkCompositeDataSet::NAME(), name.c_str());
}

std::string NodeName(const std::string& label)
{
  const std::string name = vtkDataAssembly::MakeValidNodeName(label.c_str());
  return name.empty() ? "part" : name;
}

/// The tree of the document; instances become data set indices.
void FillAssembly(const nurbs::CADDocument& document, bool single, vtkDataAssembly* assembly)
{
  const nurbs::CADDocument::Node& root = document.Nodes.front();
  assembly->SetRootNodeName(NodeName(root.Name).c_str());
  const int rootNode = vtkDataAssembly::GetRootNode();
  assembly->SetAttribute(rootNode, "label", root.Name.c_str());
  if (single || root.Instance >= 0)
  {
    assembly->AddDataSetIndex(rootNode, 0);
    return;
  }
  std::vector<int> ids{ rootNode };
  for (std::size_t i = 1; i < document.Nodes.size(); ++i)
  {
    const nurbs::CADDocument::Node& node = document.Nodes[i];
    const int id =
      assembly->AddNode(NodeName(node.Name).c_str(), ids[static_cast<std::size_t>(node.Parent)]);
    ids.push_back(id);
    assembly->SetAttribute(id, "label", node.Name.c_str());
    if (!node.InstanceName.empty())
    {
      assembly->SetAttribute(id, "instance", node.InstanceName.c_str());
    }
    if (node.Instance >= 0)
    {
      assembly->AddDataSetIndex(id, static_cast<unsigned int>(node.Instance));
    }
  }
}

/// The name that each instance has in the tree.
std::vector<std::string> InstanceNames(const nurbs::CADDocument& document)
{
  std::vector<std::string> names(document.Instances.size());
  for (const nurbs::CADDocument::Node& node : document.Nodes)
  {
    if (node.Instance >= 0)
    {
      names[static_cast<std::size_t>(node.Instance)] = node.Name;
    }
  }
  return names;
}

/// Symbol of the output's unit and how many of it a millimetre is.
std::pair<std::string, double> OutputUnit(int wanted, const nurbs::CADDocument& document)
{
  switch (wanted)
  {
    case vtkNURBSCADReader::METRES:
      return { "m", 1e-3 };
    case vtkNURBSCADReader::FILE_UNIT:
      return { document.FileUnit, 1.0 / document.FileUnitLength };
    default:
      return { "mm", 1.0 };
  }
}

} // namespace

vtkNURBSCADReader::vtkNURBSCADReader()
{
  this->SetNumberOfInputPorts(0);
}

vtkNURBSCADReader::~vtkNURBSCADReader()
{
  this->SetFileName(nullptr);
}

int vtkNURBSCADReader::CanReadFile(const char* fileName)
{
  try
  {
    nurbs::DetectCADFormat(fileName ? fileName : "");
    return 1;
  }
  catch (const std::exception&)
  {
    return 0;
  }
}

int vtkNURBSCADReader::RequestInformation(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  outputVector->GetInformationObject(0)->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
  return 1;
}

int vtkNURBSCADReader::RequestData(
  vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector)
{
  vtkPartitionedDataSetCollection* output = vtkPartitionedDataSetCollection::GetData(outputVector);
  output->Initialize();
  this->ParseSeconds = this->ConvertSeconds = 0.0;
  this->SetErrorCode(vtkErrorCode::NoError);
  if (!this->FileName || !*this->FileName)
  {
    this->SetErrorCode(vtkErrorCode::NoFileNameError);
    vtkErrorMacro("FileName is not set");
    return 1;
  }

  const double start = Now();
  nurbs::CADDocument document;
  try
  {
    document = nurbs::LoadCADFile(this->FileName, [this](double done) {
      this->UpdateProgress(ParsePart * done);
      return !this->GetAbortExecute();
    });
  }
  catch (const std::exception& problem)
  {
    if (!this->GetAbortExecute())
    {
      this->SetErrorCode(vtkErrorCode::FileFormatError);
      vtkErrorMacro("Cannot read the file: " << problem.what());
    }
    return 1; // Zero would make the executive report a second error.
  }
  const double parsed = Now();
  this->ParseSeconds = parsed - start;
  for (const std::string& warning : document.Warnings)
  {
    vtkWarningMacro("\"" << this->FileName << "\": " << warning);
  }

  std::vector<nurbs::Part> parts;
  std::atomic<bool> abort{ false };
  for (const TopoDS_Shape& shape : document.Parts)
  {
    parts.push_back(nurbs::ConvertPart(shape, vtkNURBSParallelFor, abort));
    this->UpdateProgress(
      ParsePart + (1.0 - ParsePart) * double(parts.size()) / double(document.Parts.size()));
    if (this->GetAbortExecute())
    {
      return 1;
    }
  }

  const auto [unit, scale] = OutputUnit(this->LengthUnit, document);
  const std::size_t count = this->SingleModel ? 1 : document.Instances.size();
  std::vector<Model> models(count);
  std::vector<vtkSmartPointer<vtkUnstructuredGrid>> grids(count);
  for (std::size_t i = 0; i < document.Instances.size(); ++i)
  {
    nurbs::CADDocument::Instance& instance = document.Instances[i];
    Append(parts[instance.Part], instance, scale, models[this->SingleModel ? 0 : i]);
  }
  int piece = 0;
  int pieces = 1;
  if (vtkNURBSPieces::IsPieceAsked(outputVector->GetInformationObject(0), piece, pieces))
  {
    TakePiece(models, piece, pieces);
  }
  const std::vector<std::string> names = InstanceNames(document);
  for (std::size_t i = 0; i < count; ++i)
  {
    grids[i] = vtkSmartPointer<vtkUnstructuredGrid>::New();
    Store(models[i], unit, document.HasColors, grids[i]);
    const bool none = pieces > 1 && grids[i]->GetNumberOfCells() == 0;
    AddModel(output, none ? nullptr : grids[i].Get(),
      this->SingleModel ? document.Nodes.front().Name : names[i]);
    for (std::size_t k = 0; piece == 0 && k < models[i].Unconverted.size(); ++k)
    {
      const std::string& reason = models[i].Unconverted[k];
      vtkWarningMacro("Face " << reason << " (not converted)");
    }
  }
  vtkNew<vtkDataAssembly> assembly;
  FillAssembly(document, this->SingleModel, assembly);
  output->SetDataAssembly(assembly);
  this->ConvertSeconds = Now() - parsed;
  this->UpdateProgress(1.0);
  return 1;
}

void vtkNURBSCADReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "LengthUnit: "
     << (this->LengthUnit == METRES ? "metres"
                                    : (this->LengthUnit == FILE_UNIT ? "file unit" : "millimetres"))
     << "\n";
  os << indent << "SingleModel: " << (this->SingleModel ? "on" : "off") << "\n";
  os << indent << "ParseSeconds: " << this->ParseSeconds << "\n";
  os << indent << "ConvertSeconds: " << this->ConvertSeconds << "\n";
}
