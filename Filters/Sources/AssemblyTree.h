// SPDX-License-Identifier: BSD-3-Clause
/// @file AssemblyTree.h
/// @brief Assembly tree, names and colours out of OpenCASCADE's XDE documents.
///
/// A face's colour is the first that is set on the way outwards: face, shell, solid, the instance,
/// the product that it is an instance of, then the instance and product of the assembly around it,
/// and so on. Of the two colours that XDE tells apart the surface colour goes before the general one.
#pragma once

#include "CADDocument.h"

#include <TDocStd_Document.hxx>

namespace nurbs
{

/// Fills parts, instances and nodes from all free shapes of an XDE document. Instances come in the
/// order in which TopExp_Explorer meets them in the compound of the free shapes.
void ReadAssembly(const Handle(TDocStd_Document) & data, CADDocument& document);

/// Makes one part and one instance of a shape; `data` (may be null) knows colours and names of it
/// or of shapes in it.
void ReadSingleShape(
  const TopoDS_Shape& shape, const Handle(TDocStd_Document) & data, CADDocument& document);

} // namespace nurbs
