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

// What one Update works on.
struct vtkNURBSCADReader::Work
{
  Work(vtkInformation* request, vtkInformationVector* outputs)
    : Pieces(request, outputs)
  {
    vtkNURBSPieces::IsPieceAsked(outputs->GetInformationObject(0), this->Piece, this->PieceCount);
  }
  const vtkNURBSPieces Pieces;
  int Piece = 0;
  int PieceCount = 1;
  nurbs::CADDocument Document;
  std::vector<nurbs::Part> Parts;
  std::vector<Model> Models;
};

// False: it was aborted.
bool vtkNURBSCADReader::Load(Work& work)
{
  const double start = Now();
  try
  {
    work.Document = nurbs::LoadCADFile(this->FileName, [this](double done) {
      this->UpdateProgress(ParsePart * done);
      return !this->GetAbortExecute();
    });
  }
  catch (const std::exception&)
  {
    if (this->GetAbortExecute())
    {
      return false;
    }
    throw;
  }
  this->ParseSeconds = Now() - start;
  for (const std::string& warning : work.Document.Warnings)
  {
    vtkWarningMacro("\"" << this->FileName << "\": " << warning);
  }
  std::atomic<bool> abort{ false };
  const std::vector<TopoDS_Shape>& shapes = work.Document.Parts;
  for (const TopoDS_Shape& shape : shapes)
  {
    work.Parts.push_back(nurbs::ConvertPart(shape, vtkNURBSParallelFor, abort));
    this->UpdateProgress(
      ParsePart + (1.0 - ParsePart) * double(work.Parts.size()) / double(shapes.size()));
    if (this->GetAbortExecute())
    {
      return false;
    }
  }
  return true;
}

void vtkNURBSCADReader::MakeModels(Work& work)
{
  std::vector<nurbs::CADDocument::Instance>& instances = work.Document.Instances;
  work.Models.resize(this->SingleModel ? 1 : instances.size());
  const double scale = OutputUnit(this->LengthUnit, work.Document).second;
  for (std::size_t i = 0; i < instances.size(); ++i)
  {
    Append(
      work.Parts[instances[i].Part], instances[i], scale, work.Models[this->SingleModel ? 0 : i]);
  }
  if (work.PieceCount < 2)
  {
    return;
  }
  double faces = 0.0;
  for (const Model& model : work.Models)
  {
    faces += double(model.Errors.size());
  }
  const auto models = double(instances.size());
  double extremes[] = { faces, -faces, models, -models };
  work.Pieces.Largest(extremes, 4);
  if (extremes[0] != -extremes[1] || extremes[2] != -extremes[3])
  {
    throw nurbs::Error("\"" + std::string(this->FileName) +
      "\" is not the same in all processes: " + std::to_string(std::int64_t(faces)) + " faces of " +
      std::to_string(instances.size()) + " models");
  }
  TakePiece(work.Models, work.Piece, work.PieceCount);
}

void vtkNURBSCADReader::FillOutput(Work& work, vtkPartitionedDataSetCollection* output)
{
  const std::string unit = OutputUnit(this->LengthUnit, work.Document).first;
  const std::vector<std::string> names = InstanceNames(work.Document);
  for (std::size_t i = 0; i < work.Models.size(); ++i)
  {
    Model& model = work.Models[i];
    vtkNew<vtkUnstructuredGrid> grid;
    Store(model, unit, work.Document.HasColors, grid);
    const bool none = work.PieceCount > 1 && grid->GetNumberOfCells() == 0;
    AddModel(output, none ? nullptr : grid.Get(),
      this->SingleModel ? work.Document.Nodes.front().Name : names[i]);
    for (std::size_t k = 0; work.Piece == 0 && k < model.Unconverted.size(); ++k)
    {
      vtkWarningMacro("Face " << model.Unconverted[k] << " (not converted)");
    }
  }
  vtkNew<vtkDataAssembly> assembly;
  FillAssembly(work.Document, this->SingleModel, assembly);
  output->SetDataAssembly(assembly);
}

int vtkNURBSCADReader::RequestData(
  vtkInformation* request, vtkInformationVector**, vtkInformationVector* outputVector)
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
  Work work(request, outputVector);
  std::string problem;
  const auto outcome = work.Pieces.Run(
    [&]() {
      if (!this->Load(work))
      {
        return false;
      }
      this->MakeModels(work);
      this->FillOutput(work, output);
      return true;
    },
    problem);
  if (outcome != vtkNURBSPieces::DONE)
  {
    output->Initialize();
  }
  if (outcome == vtkNURBSPieces::FAILED)
  {
    this->SetErrorCode(vtkErrorCode::FileFormatError);
    vtkErrorMacro("Cannot read the file: " << problem);
  }
  if (outcome == vtkNURBSPieces::DONE)
  {
    this->ConvertSeconds = Now() - start - this->ParseSeconds;
    this->UpdateProgress(1.0);
  }
  return 1; // Zero would make the executive report a second error.
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
