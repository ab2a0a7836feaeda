// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A model as a file that keeps its surfaces: STEP, IGES, BREP, or VTK's own.
#ifndef vtkConvertModel_h
#define vtkConvertModel_h

#include "vtkReadModel.h"

namespace nurbs
{

struct Arguments;
struct Report;

/// True if the ending of the path is that of a CAD file.
bool IsCADPath(const std::string& path);

/// Throws Failure if no model can be written to the path: an ending that is not .step .stp .iges .igs
/// .brep .brp .vtu .vtpc, or a folder that refuses.
void CheckModelPath(const std::string& path);

/// Writes a model to arguments.Output and, if that is a CAD file, fills in the report's figures of it.
/// Throws Failure if writing fails, or if there are several parts and the file is to be .vtu.
void WriteModel(vtkDataObject* model, const Arguments& arguments, const ProgressFunction& progress,
  Report& report);

} // namespace nurbs

#endif
