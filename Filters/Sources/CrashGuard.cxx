// SPDX-License-Identifier: BSD-3-Clause
// OpenCASCADE is built with this: its own code has places that signals jump to, and keeps a list of
// them, which would be left in disorder by a jump past them.
#define OCC_CONVERT_SIGNALS

#include "CrashGuard.h"

#include <OSD_SIGSEGV.hxx>
#include <Standard_ErrorHandler.hxx>

#include <array>
#include <csignal>
#include <memory>

namespace nurbs
{

namespace
{

constexpr std::array<int, 4> Signals{ { SIGSEGV, SIGBUS, SIGFPE, SIGILL } };
constexpr std::size_t StackSize = 1 << 16; // for the handler, when the thread's own is exhausted

struct sigaction OldActions[Signals.size()];
thread_local bool Guarded = false;
volatile std::sig_atomic_t Seen = 0;

void OnSignal(int signal)
{
  if (Guarded)
  {
    Seen = Seen == 0 ? signal : Seen;
    // The jump does not restore the mask, which blocks the signal inside its handler.
    sigset_t mask;
    sigemptyset(&mask);
    sigaddset(&mask, signal);
    pthread_sigmask(SIG_UNBLOCK, &mask, nullptr);
    OSD_SIGSEGV::NewInstance("a signal")->Jump();
  }
  // Another thread's: the old handler gets it when the instruction is run again.
  for (std::size_t i = 0; i < Signals.size(); ++i)
  {
    if (Signals[i] == signal)
    {
      sigaction(signal, &OldActions[i], nullptr);
    }
  }
}

/// Handlers and their stack, in place while it lives.
class Handlers
{
public:
  Handlers()
    : Stack(new char[StackSize])
  {
    stack_t stack = {};
    stack.ss_sp = this->Stack.get();
    stack.ss_size = StackSize;
    sigaltstack(&stack, &this->OldStack);
    struct sigaction action = {};
    action.sa_handler = OnSignal;
    action.sa_flags = SA_ONSTACK;
    sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < Signals.size(); ++i)
    {
      sigaction(Signals[i], &action, &OldActions[i]);
    }
  }

  ~Handlers()
  {
    Guarded = false;
    for (std::size_t i = 0; i < Signals.size(); ++i)
    {
      sigaction(Signals[i], &OldActions[i], nullptr);
    }
    sigaltstack(&this->OldStack, nullptr);
  }

  Handlers(const Handlers&) = delete;
  Handlers& operator=(const Handlers&) = delete;

private:
  std::unique_ptr<char[]> Stack;
  stack_t OldStack = {};
};

} // namespace

int RunGuarded(const std::function<void()>& body)
{
  const Handlers handlers;
  Seen = 0;
  try
  {
    OCC_CATCH_SIGNALS
    Guarded = true;
    body();
  }
  catch (...)
  {
    Guarded = false;
    if (Seen == 0)
    {
      throw;
    }
  }
  Guarded = false;
  return Seen;
}

} // namespace nurbs
