// SPDX-License-Identifier: BSD-3-Clause
/// @file ShapeBodies.h
/// @brief Faces that share edges as shells and solids.
#pragma once

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

#include <cstdint>
#include <vector>

namespace nurbs
{

/// The faces that share an edge, and whether each runs through it backwards, seen from outside.
struct BodyUse
{
  std::int64_t Face = -1;
  bool Backwards = false;
};
using BodyLink = std::vector<BodyUse>;

struct Bodies
{
  TopoDS_Shape Shape; ///< The only body, or a compound; null without a face.
  std::int64_t Solids = 0;
  std::int64_t Shells = 0; ///< That are no part of a solid.
};

/// Faces that are linked become a shell, in the order of the faces. A shell all of whose edges are
/// used once each way is closed. A closed shell around a positive volume becomes a solid; one around
/// a negative volume becomes a cavity of the smallest solid that it lies in, or stays a shell.
/// @param faces oriented.
Bodies MakeBodies(const std::vector<TopoDS_Face>& faces, const std::vector<BodyLink>& links);

} // namespace nurbs
