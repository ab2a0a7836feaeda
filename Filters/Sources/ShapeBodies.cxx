// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeBodies.h"

#include "UnionFind.h"

#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <Precision.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>

#include <algorithm>

namespace nurbs
{

namespace
{

struct Shell
{
  TopoDS_Shell Shape;
  bool Closed = true;
  double Volume = 0.0; ///< Signed, if closed.
  TopoDS_Solid Solid;  ///< Null if it is none.
};

class Gatherer
{
public:
  Gatherer(const std::vector<TopoDS_Face>& faces, const std::vector<BodyLink>& links)
    : Faces(faces)
    , Links(links)
    , Joined(faces.size())
  {}

  Bodies Run()
  {
    this->JoinFaces();
    this->MakeShells();
    this->FindOpenShells();
    this->MakeSolids();
    return this->Assemble();
  }

private:
  void JoinFaces();
  void MakeShells();
  void FindOpenShells();
  void MakeSolids();
  void PlaceCavity(Shell& cavity);
  Bodies Assemble() const;

  const std::vector<TopoDS_Face>& Faces;
  const std::vector<BodyLink>& Links;
  UnionFind Joined;                  ///< Faces.
  std::vector<std::int64_t> ShellOf; ///< One a face.
  std::vector<Shell> Shells;
};

void Gatherer::JoinFaces()
{
  for (const BodyLink& link : this->Links)
  {
    for (const BodyUse& use : link)
    {
      this->Joined.Join(use.Face, link.front().Face);
    }
  }
}

void Gatherer::MakeShells()
{
  BRep_Builder builder;
  this->ShellOf.assign(this->Faces.size(), -1);
  std::vector<std::int64_t> ofRoot(this->Faces.size(), -1);
  for (std::size_t f = 0; f < this->Faces.size(); ++f)
  {
    std::int64_t& shell = ofRoot[this->Joined.Find(static_cast<std::int64_t>(f))];
    if (shell < 0)
    {
      shell = static_cast<std::int64_t>(this->Shells.size());
      this->Shells.emplace_back();
      builder.MakeShell(this->Shells.back().Shape);
    }
    this->ShellOf[f] = shell;
    builder.Add(this->Shells[shell].Shape, this->Faces[f]);
  }
}

void Gatherer::FindOpenShells()
{
  for (const BodyLink& link : this->Links)
  {
    int uses = 0, balance = 0;
    for (const BodyUse& use : link)
    {
      ++uses;
      balance += use.Backwards ? -1 : 1;
    }
    for (const BodyUse& use : link)
    {
      if (uses != 2 || balance != 0)
      {
        this->Shells[this->ShellOf[use.Face]].Closed = false;
      }
    }
  }
}

void Gatherer::MakeSolids()
{
  BRep_Builder builder;
  for (Shell& shell : this->Shells)
  {
    shell.Shape.Closed(shell.Closed);
    if (!shell.Closed)
    {
      continue;
    }
    GProp_GProps properties;
    BRepGProp::VolumeProperties(shell.Shape, properties);
    shell.Volume = properties.Mass();
    if (shell.Volume > 0.0)
    {
      builder.MakeSolid(shell.Solid);
      builder.Add(shell.Solid, shell.Shape);
    }
  }
  for (Shell& shell : this->Shells)
  {
    if (shell.Closed && shell.Volume < 0.0)
    {
      this->PlaceCavity(shell);
    }
  }
}

void Gatherer::PlaceCavity(Shell& cavity)
{
  TopExp_Explorer vertex(cavity.Shape, TopAbs_VERTEX);
  Shell* around = nullptr;
  for (Shell& shell : this->Shells)
  {
    const bool candidate =
      shell.Volume > -cavity.Volume && vertex.More() && (!around || shell.Volume < around->Volume);
    if (!candidate)
    {
      continue;
    }
    // Without the cavities that it may have got by now.
    TopoDS_Solid outer;
    BRep_Builder builder;
    builder.MakeSolid(outer);
    builder.Add(outer, shell.Shape);
    BRepClass3d_SolidClassifier classifier(
      outer, BRep_Tool::Pnt(TopoDS::Vertex(vertex.Current())), Precision::Confusion());
    if (classifier.State() == TopAbs_IN)
    {
      around = &shell;
    }
  }
  if (around)
  {
    BRep_Builder().Add(around->Solid, cavity.Shape);
    cavity.Shape.Nullify();
  }
}

Bodies Gatherer::Assemble() const
{
  Bodies bodies;
  std::vector<TopoDS_Shape> all;
  for (const Shell& shell : this->Shells)
  {
    if (!shell.Solid.IsNull())
    {
      all.push_back(shell.Solid);
      ++bodies.Solids;
    }
    else if (!shell.Shape.IsNull())
    {
      all.push_back(shell.Shape);
      ++bodies.Shells;
    }
  }
  if (all.size() == 1)
  {
    bodies.Shape = all.front();
  }
  else if (!all.empty())
  {
    BRep_Builder builder;
    TopoDS_Compound compound;
    builder.MakeCompound(compound);
    for (const TopoDS_Shape& shape : all)
    {
      builder.Add(compound, shape);
    }
    bodies.Shape = compound;
  }
  return bodies;
}

} // namespace

Bodies MakeBodies(const std::vector<TopoDS_Face>& faces, const std::vector<BodyLink>& links)
{
  return Gatherer(faces, links).Run();
}

} // namespace nurbs
