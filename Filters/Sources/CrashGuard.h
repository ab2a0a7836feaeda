// SPDX-License-Identifier: BSD-3-Clause
/// @file CrashGuard.h
/// @brief Lets a call into OpenCASCADE's readers fail where it would take the process down.
///
/// OpenCASCADE's readers follow null references when a file's entities are broken (two of three STEP
/// files with a few bytes changed), and recurse without end when they form a circle. They count on the
/// application to turn the signal into an error, so that is what this does.
#pragma once

#include <functional>

namespace nurbs
{

/// Runs `body`. Returns 0, or the number of the first signal (SIGSEGV, SIGBUS, SIGFPE, SIGILL) that
/// occurred in it, even if OpenCASCADE caught the error that it was turned into and went on. Objects
/// alive where it occurred are not destroyed, so their memory is lost; what `body` changed must not
/// be used. Exceptions pass if there was no signal.
///
/// For the time of the call the process's handlers of these signals are replaced; signals of other
/// threads are passed on to the old ones. One call at a time in the whole process: the caller locks.
int RunGuarded(const std::function<void()>& body);

} // namespace nurbs
