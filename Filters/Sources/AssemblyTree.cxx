// SPDX-License-Identifier: BSD-3-Clause
#include "AssemblyTree.h"

#include "FaceConverter.h"

#include <Quantity_Color.hxx>
#include <TDF_AttributeIterator.hxx>
#include <TDF_ChildIterator.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TopTools_DataMapOfShapeInteger.hxx>
#include <TopoDS_Iterator.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Trsf.hxx>

#include <algorithm>
#include <cmath>
#include <optional>

namespace nurbs
{

namespace
{

using Color = std::array<std::uint8_t, 3>;

/// What a label says about its shape.
struct Look
{
  std::optional<nurbs::Color> Color;
  std::string Name;
};

std::string NameOf(const TDF_Label& label)
{
  Handle(TDataStd_Name) attribute;
  if (label.IsNull() || !label.FindAttribute(TDataStd_Name::GetID(), attribute))
  {
    return std::string();
  }
  const TCollection_ExtendedString& name = attribute->Get();
  std::string text(static_cast<std::size_t>(name.LengthOfCString()) + 1, '\0');
  Standard_PCharacter buffer = text.data();
  text.resize(static_cast<std::size_t>(name.ToUTF8CString(buffer)));
  return text;
}

/// Names that OpenCASCADE makes up for labels without one.
bool IsMadeUp(const std::string& name)
{
  static const char* const kinds[] = { "COMPOUND", "COMPSOLID", "SOLID", "SHELL", "FACE", "SHAPE",
    "ASSEMBLY" };
  return name.compare(0, 2, "=>") == 0 ||
    std::any_of(std::begin(kinds), std::end(kinds), [&](const char* kind) { return name == kind; });
}

class Reader
{
public:
  Reader(const Handle(TDocStd_Document) & data, CADDocument& document)
    : Document(document)
  {
    if (!data.IsNull())
    {
      this->Shapes = XCAFDoc_DocumentTool::ShapeTool(data->Main());
      this->Colors = XCAFDoc_DocumentTool::ColorTool(data->Main());
    }
  }

  void ReadFreeShapes()
  {
    TDF_LabelSequence labels;
    this->Shapes->GetFreeShapes(labels);
    for (int i = 1; i <= labels.Length(); ++i)
    {
      this->Visit(labels(i), TopLoc_Location(), std::nullopt, 0);
    }
  }

  void ReadShape(const TopoDS_Shape& shape)
  {
    this->Looks.clear();
    this->LookOf.Clear();
    if (!this->Shapes.IsNull())
    {
      TDF_LabelSequence labels;
      this->Shapes->GetShapes(labels);
      for (int i = 1; i <= labels.Length(); ++i)
      {
        this->AddLook(labels(i));
        this->AddSubShapes(labels(i));
      }
    }
    this->Document.Nodes[0].Instance = 0;
    this->AddInstance(shape, TopLoc_Location(), std::nullopt, this->Document.Nodes[0].Name);
  }

private:
  std::optional<nurbs::Color> ColorOf(const TDF_Label& label) const
  {
    Quantity_Color color;
    if (!this->Colors->GetColor(label, XCAFDoc_ColorSurf, color) &&
      !this->Colors->GetColor(label, XCAFDoc_ColorGen, color))
    {
      return std::nullopt;
    }
    double rgb[3];
    color.Values(rgb[0], rgb[1], rgb[2], Quantity_TOC_sRGB);
    nurbs::Color result;
    for (int i = 0; i < 3; ++i)
    {
      result[i] =
        static_cast<std::uint8_t>(std::lround(255.0 * std::min(1.0, std::max(0.0, rgb[i]))));
    }
    return result;
  }

  void AddLook(const TDF_Label& label)
  {
    Look look{ this->ColorOf(label), NameOf(label) };
    if (IsMadeUp(look.Name))
    {
      look.Name.clear();
    }
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label);
    if ((look.Color || !look.Name.empty()) && !shape.IsNull() && !this->LookOf.IsBound(shape))
    {
      this->LookOf.Bind(shape, static_cast<int>(this->Looks.size()));
      this->Looks.push_back(std::move(look));
    }
  }

  void AddSubShapes(const TDF_Label& label)
  {
    TDF_LabelSequence labels;
    XCAFDoc_ShapeTool::GetSubShapes(label, labels);
    for (int i = 1; i <= labels.Length(); ++i)
    {
      this->AddLook(labels(i));
    }
  }

  /// `inherited`: the colour of the assembly around it.
  void Visit(const TDF_Label& label, const TopLoc_Location& around,
    std::optional<nurbs::Color> inherited, std::int64_t parent)
  {
    TDF_Label product = label;
    TopLoc_Location location = around;
    CADDocument::Node node;
    node.Parent = parent;
    std::optional<nurbs::Color> color = this->ColorOf(label);
    if (XCAFDoc_ShapeTool::IsReference(label))
    {
      XCAFDoc_ShapeTool::GetReferredShape(label, product);
      location = around * XCAFDoc_ShapeTool::GetLocation(label);
      node.InstanceName = NameOf(label);
      if (IsMadeUp(node.InstanceName))
      {
        node.InstanceName.clear();
      }
      color = color ? color : this->ColorOf(product);
    }
    color = color ? color : inherited;
    node.Name = NameOf(product);
    const std::int64_t index = static_cast<std::int64_t>(this->Document.Nodes.size());
    this->Document.Nodes.push_back(node);
    if (XCAFDoc_ShapeTool::IsAssembly(product))
    {
      TDF_LabelSequence components;
      XCAFDoc_ShapeTool::GetComponents(product, components);
      for (int i = 1; i <= components.Length(); ++i)
      {
        this->Visit(components(i), location, color, index);
      }
      return;
    }
    this->Looks.clear();
    this->LookOf.Clear();
    this->AddSubShapes(product);
    const std::int64_t instance = static_cast<std::int64_t>(this->Document.Instances.size());
    if (this->AddInstance(XCAFDoc_ShapeTool::GetShape(product), location, color, node.Name))
    {
      this->Document.Nodes[static_cast<std::size_t>(index)].Instance = instance;
    }
  }

  /// False if the shape has no face.
  bool AddInstance(const TopoDS_Shape& shape, const TopLoc_Location& location,
    const std::optional<nurbs::Color>& color, const std::string& name)
  {
    if (shape.IsNull())
    {
      return false;
    }
    CADDocument::Instance instance;
    instance.Placement = ToPlacement(location.Transformation());
    this->AddFaces(shape, color, name, instance.Faces);
    if (instance.Faces.empty())
    {
      return false;
    }
    if (!this->PartOf.IsBound(shape))
    {
      this->PartOf.Bind(shape, static_cast<int>(this->Document.Parts.size()));
      this->Document.Parts.push_back(shape);
    }
    instance.Part = static_cast<std::size_t>(this->PartOf.Find(shape));
    this->Document.Instances.push_back(std::move(instance));
    return true;
  }

  /// Depth first, the order of TopExp_Explorer.
  void AddFaces(const TopoDS_Shape& shape, std::optional<nurbs::Color> color, std::string name,
    std::vector<FaceAttributes>& faces)
  {
    if (const int* found = this->LookOf.Seek(shape))
    {
      const Look& look = this->Looks[static_cast<std::size_t>(*found)];
      color = look.Color ? look.Color : color;
      name = look.Name.empty() ? name : look.Name;
    }
    if (shape.ShapeType() == TopAbs_FACE)
    {
      FaceAttributes face;
      face.FaceId = this->NextFace++;
      face.Name = name;
      if (color)
      {
        face.Color = *color;
        this->Document.HasColors = true;
      }
      faces.push_back(std::move(face));
      return;
    }
    if (shape.ShapeType() > TopAbs_FACE)
    {
      return;
    }
    for (TopoDS_Iterator it(shape); it.More(); it.Next())
    {
      this->AddFaces(it.Value(), color, name, faces);
    }
  }

  CADDocument& Document;
  Handle(XCAFDoc_ShapeTool) Shapes;
  Handle(XCAFDoc_ColorTool) Colors;
  std::vector<Look> Looks; ///< Of shapes inside the part at hand.
  TopTools_DataMapOfShapeInteger LookOf;
  TopTools_DataMapOfShapeInteger PartOf;
  std::int64_t NextFace = 0;
};

} // namespace

void ReadAssembly(const Handle(TDocStd_Document) & data, CADDocument& document)
{
  Reader(data, document).ReadFreeShapes();
}

void ReadSingleShape(
  const TopoDS_Shape& shape, const Handle(TDocStd_Document) & data, CADDocument& document)
{
  Reader(data, document).ReadShape(shape);
}

} // namespace nurbs
