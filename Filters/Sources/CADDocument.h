// SPDX-License-Identifier: BSD-3-Clause
/// @file CADDocument.h
/// @brief A CAD file loaded by OpenCASCADE: parts, where they are placed, names and colours.
#pragma once

#include "CADFile.h"
#include "CADSession.h"
#include "ModelBuilder.h"
#include "PartConverter.h"

namespace nurbs
{

/// A loaded file. Lengths are millimetres, as OpenCASCADE reads them (BREP files know no unit).
struct CADDocument
{
  /// A placed copy of a part; becomes one model.
  struct Instance
  {
    std::size_t Part = 0; ///< Index into Parts.
    nurbs::Placement Placement;
    std::vector<FaceAttributes> Faces; ///< FaceId, colour and name of each of the part's faces.
  };

  /// A node of the assembly tree, parents before children. Node 0 is the file.
  struct Node
  {
    std::int64_t Parent = -1;
    std::string Name;           ///< Product name, UTF-8.
    std::string InstanceName;   ///< What the assembly calls this use of the product; may be empty.
    std::int64_t Instance = -1; ///< Index into Instances, -1 for an assembly.
  };

  CADFormat Format = CADFormat::BREP;
  std::vector<TopoDS_Shape> Parts;
  std::vector<Instance> Instances; ///< In the order of FaceId.
  std::vector<Node> Nodes;
  std::vector<std::string> Warnings; ///< What OpenCASCADE could not make shapes of.
  bool HasColors = false;            ///< Some face has a colour of its own or inherits one.
  std::string FileUnit = "mm";       ///< Unit of length in the file: "mm", "m", "in", ...
  double FileUnitLength = 1.0;       ///< That unit in millimetres.
};

/// Loads a file. Throws Error with one clear sentence when there is nothing to be had: see
/// DetectCADFormat; syntax errors; no shape in it. Stopped by `progress`: throws Error "aborted".
/// OpenCASCADE's messages are kept from the console. Safe to call from several threads: the readers
/// share global state and take turns.
CADDocument LoadCADFile(const std::string& path, const CADProgress& progress);

} // namespace nurbs
