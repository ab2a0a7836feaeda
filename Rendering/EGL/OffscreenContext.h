// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// An OpenGL context on a device chosen through EGL, with no window system behind it.
#ifndef nurbsOffscreenContext_h
#define nurbsOffscreenContext_h

#include <memory>
#include <string>
#include <vector>

namespace nurbs
{

/// One EGL device as EGL_EXT_device_enumeration lists it.
struct OffscreenDevice
{
  std::string Name;      ///< device file, vendor's name, or "software renderer"
  bool Software = false; ///< drawn by the CPU (EGL_MESA_device_software)
};

/// The machine's EGL devices, in EGL's order; empty if the driver cannot enumerate them.
std::vector<OffscreenDevice> OffscreenDevices();

/// An OpenGL core context of version 3.2 or later with a surface of one pixel (or none, where EGL
/// has surfaceless contexts only): draw to framebuffer objects. The display is shared by the
/// contexts on it and terminated with the last.
class OffscreenContext
{
public:
  /// A context on device `index`, or on the first that works if it is -1 (hardware before
  /// software, then Mesa's surfaceless platform, then EGL's default display). Null on failure,
  /// `error` then says what is missing and what to do. Leaves the calling thread's current context
  /// alone. May be called by several threads at once.
  static std::unique_ptr<OffscreenContext> Create(int index, std::string& error);

  /// Destroys the context; the caller has released what it made in it. Should it be current in the
  /// calling thread, the thread is left without a context.
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  /// Bind to the calling thread. False, with `error`, if EGL refuses, as it does when another
  /// thread holds the context.
  bool MakeCurrent(std::string& error);

  /// Whether the context is bound to the calling thread.
  bool IsCurrent() const;

  /// Unbind from the calling thread, if bound to it.
  void ReleaseCurrent();

private:
  struct Handles;
  explicit OffscreenContext(std::unique_ptr<Handles> handles);
  std::unique_ptr<Handles> EGL;
};

/// Remembers the calling thread's current EGL context and binds it again at the end of the scope.
class CurrentContextKeeper
{
public:
  CurrentContextKeeper();
  ~CurrentContextKeeper();
  CurrentContextKeeper(const CurrentContextKeeper&) = delete;
  CurrentContextKeeper& operator=(const CurrentContextKeeper&) = delete;

private:
  void* Display;
  void* Draw;
  void* Read;
  void* Context;
};

} // namespace nurbs

#endif
