// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSDrawingSVG.h"

#include "vtk_pugixml.h"

#include <sstream>

namespace
{

using nurbs::Drawing;
using nurbs::DrawingLayer;
using nurbs::DrawingNumber;
using nurbs::DrawingStroke;

constexpr int WidthDigits = 4; // After the point of what is no coordinate.

void Set(pugi::xml_node node, const char* name, const std::string& value)
{
  node.append_attribute(name).set_value(value.c_str());
}

// y goes down in SVG.
void AppendPoint(const nurbs::Vec2& p, const Drawing& drawing, std::string& text)
{
  text += DrawingNumber(p.x(), drawing.Digits) + ' ' +
    DrawingNumber(drawing.Height - p.y(), drawing.Digits);
}

std::string PathData(const nurbs::FittedPath& path, const Drawing& drawing)
{
  std::string text = "M";
  AppendPoint(path.Pieces.front().Points[0], drawing, text);
  for (std::size_t k = 0; k < path.Pieces.size(); ++k)
  {
    const nurbs::PathPiece& piece = path.Pieces[k];
    if (piece.Straight && path.Closed && k + 1 == path.Pieces.size())
    {
      continue; // Z draws it.
    }
    text += piece.Straight ? 'L' : 'C';
    for (std::size_t p = piece.Straight ? 3 : 1; p < 4; ++p)
    {
      AppendPoint(piece.Points[p], drawing, text);
      text += p < 3 ? " " : "";
    }
  }
  return path.Closed ? text + 'Z' : text;
}

std::string Joined(const std::vector<std::int64_t>& numbers)
{
  std::string text;
  for (const std::int64_t number : numbers)
  {
    text += (text.empty() ? "" : " ") + std::to_string(number);
  }
  return text;
}

void SetIfAny(pugi::xml_node node, const char* name, const std::string& value)
{
  if (!value.empty())
  {
    Set(node, name, value);
  }
}

pugi::xml_node AddGroup(pugi::xml_node parent, const std::string& name, const std::string& style,
  const std::string& label)
{
  pugi::xml_node group = parent.append_child("g");
  Set(group, "id", name);
  Set(group, "class", style);
  Set(group, "inkscape:groupmode", "layer");
  Set(group, "inkscape:label", label);
  return group;
}

// Attributes, which every reader knows and a style sheet goes before.
void SetStyle(const DrawingLayer& layer, pugi::xml_node group)
{
  const double width = layer.LineWidth;
  Set(group, "stroke-width", DrawingNumber(width, WidthDigits));
  if (!layer.Visible)
  {
    Set(group, "stroke-dasharray",
      DrawingNumber(nurbs::DashWidths * width, WidthDigits) + ' ' +
        DrawingNumber(nurbs::GapWidths * width, WidthDigits));
  }
}

void AddMetadata(const Drawing& drawing, pugi::xml_node svg)
{
  svg.append_child("title").text().set(drawing.Title.c_str());
  svg.append_child("desc").text().set(nurbs::DrawingDescription(drawing).c_str());
  pugi::xml_node facts = svg.append_child("metadata").append_child("drawing");
  Set(facts, "xmlns", "urn:vtknurbs:drawing");
  SetIfAny(facts, "source", drawing.Source);
  SetIfAny(facts, "view", drawing.View);
  Set(facts, "scale", drawing.Scale);
}

void AddLayers(const Drawing& drawing, pugi::xml_node svg)
{
  pugi::xml_node groups[2];
  std::size_t number = 0;
  for (const DrawingLayer& layer : drawing.Layers)
  {
    const char* name = layer.Visible ? "visible" : "hidden";
    pugi::xml_node& parent = groups[layer.Visible ? 1 : 0];
    if (!parent)
    {
      parent = AddGroup(svg, name, name, layer.Visible ? "Visible" : "Hidden");
      Set(parent, "fill", "none");
      Set(parent, "stroke", "#000");
      Set(parent, "stroke-linejoin", "round");
      Set(parent, "stroke-linecap", layer.Visible ? "round" : "butt");
    }
    pugi::xml_node group =
      AddGroup(parent, layer.Name, std::string(name) + ' ' + layer.Kind, layer.Label);
    SetStyle(layer, group);
    for (const DrawingStroke& stroke : layer.Strokes)
    {
      pugi::xml_node path = group.append_child("path");
      Set(path, "id", "line-" + std::to_string(++number));
      SetIfAny(path, "data-face", Joined(stroke.Faces));
      SetIfAny(path, "data-edge", Joined(stroke.Edges));
      SetIfAny(path, "data-part", stroke.Part);
      Set(path, "d", PathData(stroke.Path, drawing));
    }
  }
}

} // namespace

std::string vtkNURBSDrawingSVG::Make(const Drawing& drawing)
{
  const std::string width = DrawingNumber(drawing.Width, WidthDigits);
  const std::string height = DrawingNumber(drawing.Height, WidthDigits);
  pugi::xml_document document;
  pugi::xml_node declaration = document.append_child(pugi::node_declaration);
  Set(declaration, "version", "1.0");
  Set(declaration, "encoding", "UTF-8");
  pugi::xml_node svg = document.append_child("svg");
  Set(svg, "xmlns", "http://www.w3.org/2000/svg");
  Set(svg, "xmlns:inkscape", "http://www.inkscape.org/namespaces/inkscape");
  Set(svg, "version", "1.1");
  Set(svg, "width", width + "mm");
  Set(svg, "height", height + "mm");
  Set(svg, "viewBox", "0 0 " + width + ' ' + height);
  AddMetadata(drawing, svg);
  AddLayers(drawing, svg);
  std::ostringstream stream;
  document.save(stream, "  ");
  return stream.str();
}
