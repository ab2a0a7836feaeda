// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How a command ends: its exit codes, and the exception that carries the reason.
#ifndef nurbsFailure_h
#define nurbsFailure_h

#include <stdexcept>

namespace nurbs
{

/// What the process returns.
enum ExitCode
{
  ExitSuccess = 0,
  ExitFailure = 1, ///< nothing, or not all that was asked for, was written
  ExitUsage = 2,   ///< the command line cannot be understood
  ExitStrict = 3   ///< all was written, but --strict found something to complain about
};

/// Ends a command. The text is one line without "vtknurbs:" and without a full stop.
class Failure : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

} // namespace nurbs

#endif
