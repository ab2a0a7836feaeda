// SPDX-License-Identifier: BSD-3-Clause
/// @file CADExport.h
/// @brief Shapes with names, colours and an assembly tree as STEP, IGES and BREP files.
///
/// STEP files are of AP214 (ISO 10303-214, AUTOMOTIVE_DESIGN), which every CAD system reads, and hold
/// all: names as UTF-8, colours of parts and faces, the tree. IGES files have entities of solids and
/// shells (186, 514, 510, 508) and so keep which faces share an edge, and colours; their names are
/// ASCII, and each instance is written out. BREP files hold geometry and topology only, in millimetres, the unit of all shapes here.
#pragma once

#include "CADFile.h"
#include "CADSession.h"

#include <TopLoc_Location.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

#include <array>
#include <cstdint>
#include <vector>

namespace nurbs
{

/// A shape with what is told of it and its faces.
struct CADPart
{
  TopoDS_Shape Shape;
  std::string Name; ///< UTF-8.
  std::vector<TopoDS_Face> Faces;
  std::vector<std::string> FaceNames;              ///< One a face, UTF-8; or empty.
  std::vector<std::array<std::uint8_t, 3>> Colors; ///< sRGB, one a face; or empty.
};

/// A node of the assembly tree, parents before children. Nodes with the same part are instances of it,
/// and have one name.
struct CADNode
{
  std::int64_t Parent = -1; ///< -1: nothing is above it.
  std::string Name;         ///< UTF-8.
  std::string InstanceName; ///< What the node above calls it; may be empty.
  std::int64_t Part = -1;   ///< Index into Parts; -1: an assembly of the nodes below it.
  TopLoc_Location Place;    ///< Where the part is moved to; not of a node that nothing is above.
};

struct CADContent
{
  std::vector<CADPart> Parts;
  std::vector<CADNode> Nodes;
  std::string Name;                                 ///< Of the file, as its header tells it.
  CADUnit Unit = { "millimetre", "mm", "MM", 1.0 }; ///< Of lengths in the file.
};

/// Writes a file, and looks whether it is whole. Throws Error, naming the path, if it can't be written;
/// then the file that stood there, if one did, is as it was. Stopped by `progress`: throws Error
/// "aborted", likewise. Takes its turn with all who
/// read or write CAD files.
void SaveCADFile(const CADContent& content, CADFormat format, const std::string& path,
  const CADProgress& progress);

} // namespace nurbs
