// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The commands of the vtknurbs tool.
#ifndef vtkCommands_h
#define vtkCommands_h

#include "Arguments.h"

namespace nurbs
{

/// Runs the command and returns the process's exit code. Throws Failure.
int Execute(const Arguments& arguments);

} // namespace nurbs

#endif
