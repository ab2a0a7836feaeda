// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What is in a model, in words and figures.
#ifndef vtkDescribeModel_h
#define vtkDescribeModel_h

#include "Report.h"

#include <iosfwd>

class vtkDataObject;

namespace nurbs
{

/// Fills in Unit, Faces, Edges, Unconverted and Problems.
void Count(vtkDataObject* model, Report& report);

/// Prints faces, edges, degrees, size, unit, the tree of parts and the problems. Equal siblings of
/// the tree share a line; of many different ones some are left out unless `wholeTree`.
void Describe(vtkDataObject* model, const Report& report, bool wholeTree, std::ostream& out);

} // namespace nurbs

#endif
