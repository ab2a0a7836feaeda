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

/// Fills in Unit, Faces, Edges and Unconverted.
void Count(vtkDataObject* model, Report& report);

/// Fills in Problems: faces that were not converted, and all that the model's checks find.
void ListProblems(vtkDataObject* model, Report& report);

/// Prints faces, edges, degrees, size, unit, the tree of parts and the problems. Equal siblings of
/// the tree share a line; of many different ones, and of many problems, some are left out unless the
/// `whole` is wanted.
void Describe(vtkDataObject* model, const Report& report, bool whole, std::ostream& out);

} // namespace nurbs

#endif
