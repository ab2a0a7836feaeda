// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What of a model is visible, by the options of the command line: as a drawing, or as a model
/// again.
#ifndef vtkDrawModel_h
#define vtkDrawModel_h

#include "vtkReadModel.h"

namespace nurbs
{

struct Arguments;
struct Report;

/// Throws Failure if the output is no format of the command (arguments.What), or cannot be written.
void CheckViewPath(const Arguments& arguments);

/// Finds what is visible of a model and fills in the report's figures of it: for Command::Drawing
/// the lines in the image plane, vtkPolyData or a composite data set of it; for Command::Visible
/// the model of what is visible. Throws Failure if nothing came out.
vtkSmartPointer<vtkDataObject> LookAt(vtkDataObject* model, const Arguments& arguments,
  const ProgressFunction& progress, Report& report);

/// Writes what LookAt gave, and fills in the report's figures of it. Throws Failure if the file
/// cannot be written.
void WriteView(vtkDataObject* data, const Arguments& arguments, const ProgressFunction& progress,
  Report& report);

} // namespace nurbs

#endif
