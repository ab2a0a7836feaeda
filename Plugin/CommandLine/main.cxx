// SPDX-License-Identifier: BSD-3-Clause
#include "Arguments.h"
#include "Failure.h"
#include "vtkCommands.h"

#include <exception>
#include <iostream>
#include <new>

int main(int argc, char** argv)
{
  nurbs::Arguments arguments;
  int exitCode = nurbs::ExitSuccess;
  if (!nurbs::Parse(argc, argv, arguments, exitCode))
  {
    return exitCode;
  }
  try
  {
    return nurbs::Execute(arguments);
  }
  catch (const std::bad_alloc&)
  {
    std::cerr << "vtknurbs: out of memory; a larger tolerance needs less\n";
  }
  catch (const std::exception& error)
  {
    std::cerr << "vtknurbs: " << error.what() << "\n";
  }
  return nurbs::ExitFailure;
}
