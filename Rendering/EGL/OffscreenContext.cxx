// SPDX-License-Identifier: BSD-3-Clause
#include "OffscreenContext.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <map>
#include <mutex>
#include <sstream>

// EGL_EXT_device_query_name, newer than some eglext.h.
#ifndef EGL_RENDERER_EXT
#define EGL_RENDERER_EXT 0x335F
#endif

namespace nurbs
{
namespace
{

bool HasExtension(const char* list, const std::string& name)
{
  std::istringstream words(list ? list : "");
  for (std::string word; words >> word;)
  {
    if (word == name)
    {
      return true;
    }
  }
  return false;
}

// EGL's error of this thread in words (EGL 1.5, section 3.1).
std::string LastError()
{
  switch (const EGLint code = eglGetError())
  {
    case EGL_NOT_INITIALIZED:
      return "the driver could not be initialised";
    case EGL_BAD_ACCESS:
      return "it is in use by another thread";
    case EGL_BAD_ALLOC:
      return "out of memory or other resources";
    case EGL_BAD_MATCH:
      return "the driver does not offer OpenGL 3.2 core contexts";
    case EGL_CONTEXT_LOST:
      return "the device was reset or went to sleep";
    case EGL_SUCCESS:
      return "no reason given";
    default:
    {
      std::ostringstream text;
      text << "EGL error 0x" << std::hex << code;
      return text.str();
    }
  }
}

// The client extensions of libEGL and its drivers that we use.
struct ClientAPI
{
  PFNEGLQUERYDEVICESEXTPROC QueryDevices = nullptr;
  PFNEGLQUERYDEVICESTRINGEXTPROC QueryDeviceString = nullptr;
  PFNEGLGETPLATFORMDISPLAYEXTPROC GetPlatformDisplay = nullptr;
  bool DevicePlatform = false;
  bool Surfaceless = false;

  static const ClientAPI& Get()
  {
    static const ClientAPI api;
    return api;
  }

private:
  ClientAPI()
  {
    const char* list = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!list)
    {
      eglGetError(); // an EGL without client extensions: nothing but the default display
      return;
    }
    const bool base = HasExtension(list, "EGL_EXT_device_base");
    if (base || HasExtension(list, "EGL_EXT_device_enumeration"))
    {
      Load(this->QueryDevices, "eglQueryDevicesEXT");
    }
    if (base || HasExtension(list, "EGL_EXT_device_query"))
    {
      Load(this->QueryDeviceString, "eglQueryDeviceStringEXT");
    }
    if (HasExtension(list, "EGL_EXT_platform_base"))
    {
      Load(this->GetPlatformDisplay, "eglGetPlatformDisplayEXT");
    }
    this->DevicePlatform =
      this->GetPlatformDisplay && HasExtension(list, "EGL_EXT_platform_device");
    this->Surfaceless =
      this->GetPlatformDisplay && HasExtension(list, "EGL_MESA_platform_surfaceless");
  }

  template <typename Function>
  static void Load(Function& function, const char* name)
  {
    function = reinterpret_cast<Function>(eglGetProcAddress(name));
  }
};

std::vector<EGLDeviceEXT> DeviceHandles()
{
  const ClientAPI& api = ClientAPI::Get();
  EGLint count = 0;
  if (!api.QueryDevices || !api.DevicePlatform || !api.QueryDevices(0, nullptr, &count) ||
    count <= 0)
  {
    return {};
  }
  std::vector<EGLDeviceEXT> devices(static_cast<size_t>(count));
  if (!api.QueryDevices(count, devices.data(), &count))
  {
    return {};
  }
  devices.resize(static_cast<size_t>(count));
  return devices;
}

OffscreenDevice Describe(EGLDeviceEXT device)
{
  OffscreenDevice description;
  const ClientAPI& api = ClientAPI::Get();
  const char* extensions =
    api.QueryDeviceString ? api.QueryDeviceString(device, EGL_EXTENSIONS) : nullptr;
  description.Software = HasExtension(extensions, "EGL_MESA_device_software");
  const auto add = [&](const char* extension, EGLint what) {
    const char* text =
      HasExtension(extensions, extension) ? api.QueryDeviceString(device, what) : nullptr;
    if (text && *text)
    {
      description.Name += (description.Name.empty() ? "" : ", ") + std::string(text);
    }
  };
  add("EGL_EXT_device_query_name", EGL_RENDERER_EXT);
  add("EGL_EXT_device_drm", EGL_DRM_DEVICE_FILE_EXT);
  if (description.Name.empty())
  {
    description.Name = description.Software ? "software renderer" : "unnamed device";
  }
  return description;
}

// Displays in use. EGL gives the same handle to all who ask for the same device, and terminating
// it would pull it from under the others.
class Displays
{
public:
  static bool Acquire(EGLDisplay display)
  {
    std::lock_guard<std::mutex> lock(Mutex());
    int& users = Users()[display];
    if (users == 0 && !eglInitialize(display, nullptr, nullptr))
    {
      Users().erase(display);
      return false;
    }
    ++users;
    return true;
  }

  static void Release(EGLDisplay display)
  {
    std::lock_guard<std::mutex> lock(Mutex());
    if (--Users()[display] == 0)
    {
      Users().erase(display);
      eglTerminate(display);
    }
  }

private:
  static std::mutex& Mutex()
  {
    static std::mutex mutex;
    return mutex;
  }
  static std::map<EGLDisplay, int>& Users()
  {
    static std::map<EGLDisplay, int> users;
    return users;
  }
};

struct Candidate
{
  EGLDisplay Display;
  std::string Name;
};

// The displays to try for a device index, best first.
std::vector<Candidate> Candidates(int index, std::string& error)
{
  const ClientAPI& api = ClientAPI::Get();
  const std::vector<EGLDeviceEXT> devices = DeviceHandles();
  const auto open = [&](size_t i) {
    return Candidate{ api.GetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr),
      "EGL device " + std::to_string(i) + " (" + Describe(devices[i]).Name + ")" };
  };
  if (index >= 0)
  {
    if (static_cast<size_t>(index) < devices.size())
    {
      return { open(static_cast<size_t>(index)) };
    }
    error = "there is no EGL device " + std::to_string(index) + ": EGL lists " +
      (devices.empty()          ? std::string("none")
          : devices.size() == 1 ? std::string("one, number 0")
                                : "0 to " + std::to_string(devices.size() - 1));
    return {};
  }
  std::vector<Candidate> candidates;
  for (const bool software : { false, true })
  {
    for (size_t i = 0; i < devices.size(); ++i)
    {
      if (Describe(devices[i]).Software == software)
      {
        candidates.push_back(open(i));
      }
    }
  }
  if (api.Surfaceless)
  {
    candidates.push_back(
      { api.GetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
        "Mesa's surfaceless platform" });
  }
  candidates.push_back({ eglGetDisplay(EGL_DEFAULT_DISPLAY), "EGL's default display" });
  return candidates;
}

} // namespace

//--------------------------------------------------------------------------------------------------
std::vector<OffscreenDevice> OffscreenDevices()
{
  std::vector<OffscreenDevice> devices;
  for (EGLDeviceEXT device : DeviceHandles())
  {
    devices.push_back(Describe(device));
  }
  return devices;
}

//--------------------------------------------------------------------------------------------------
struct OffscreenContext::Handles
{
  EGLDisplay Display = EGL_NO_DISPLAY;
  EGLSurface Surface = EGL_NO_SURFACE;
  EGLContext Context = EGL_NO_CONTEXT;

  ~Handles()
  {
    if (this->Context != EGL_NO_CONTEXT)
    {
      eglDestroyContext(this->Display, this->Context);
    }
    if (this->Surface != EGL_NO_SURFACE)
    {
      eglDestroySurface(this->Display, this->Surface);
    }
    if (this->Display != EGL_NO_DISPLAY)
    {
      Displays::Release(this->Display);
    }
  }

  // All of it on one display, or the reason why not.
  bool Open(EGLDisplay display, std::string& error)
  {
    if (display == EGL_NO_DISPLAY || !Displays::Acquire(display))
    {
      error = display == EGL_NO_DISPLAY ? "EGL has no such display" : LastError();
      return false;
    }
    this->Display = display;
    const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
    EGLConfig config = nullptr;
    const bool pixelBuffers = this->ChooseConfig(EGL_PBUFFER_BIT, config);
    if (!pixelBuffers &&
      (!HasExtension(extensions, "EGL_KHR_surfaceless_context") || !this->ChooseConfig(0, config)))
    {
      error = "it offers no OpenGL drawing without a window";
      return false;
    }
    if (!eglBindAPI(EGL_OPENGL_API))
    {
      error = "its EGL has no desktop OpenGL";
      return false;
    }
    const EGLint version[] = { EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 2,
      EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE };
    this->Context = eglCreateContext(display, config, EGL_NO_CONTEXT, version);
    if (this->Context == EGL_NO_CONTEXT)
    {
      error = LastError();
      return false;
    }
    if (pixelBuffers)
    {
      const EGLint size[] = { EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE };
      this->Surface = eglCreatePbufferSurface(display, config, size);
      if (this->Surface == EGL_NO_SURFACE)
      {
        error = LastError();
        return false;
      }
    }
    return true;
  }

private:
  bool ChooseConfig(EGLint surfaceType, EGLConfig& config)
  {
    const EGLint wanted[] = { EGL_SURFACE_TYPE, surfaceType, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
      EGL_RED_SIZE, 8, EGL_GREEN_SIZE, 8, EGL_BLUE_SIZE, 8, EGL_ALPHA_SIZE, 8, EGL_NONE };
    EGLint found = 0;
    return eglChooseConfig(this->Display, wanted, &config, 1, &found) && found > 0;
  }
};

//--------------------------------------------------------------------------------------------------
OffscreenContext::OffscreenContext(std::unique_ptr<Handles> handles)
  : EGL(std::move(handles))
{}

//--------------------------------------------------------------------------------------------------
OffscreenContext::~OffscreenContext()
{
  this->ReleaseCurrent();
}

//--------------------------------------------------------------------------------------------------
std::unique_ptr<OffscreenContext> OffscreenContext::Create(int index, std::string& error)
{
  error.clear();
  std::string reasons;
  for (const Candidate& candidate : Candidates(index, error))
  {
    CurrentContextKeeper keeper;
    auto handles = std::make_unique<Handles>();
    std::unique_ptr<OffscreenContext> context;
    std::string reason;
    if (handles->Open(candidate.Display, reason))
    {
      context.reset(new OffscreenContext(std::move(handles)));
      if (context->MakeCurrent(reason))
      {
        context->ReleaseCurrent();
        return context;
      }
    }
    reasons += (reasons.empty() ? "" : "; ") + candidate.Name + ": " + reason;
  }
  if (error.empty())
  {
    error = "no OpenGL 3.2 context through EGL. " + reasons;
  }
  if (index < 0)
  {
    error += ". Install an EGL driver: the graphics card's own, or Mesa for drawing in software "
             "(Debian: apt install libegl-mesa0 libgl1-mesa-dri)";
  }
  error += ".";
  return nullptr;
}

//--------------------------------------------------------------------------------------------------
bool OffscreenContext::MakeCurrent(std::string& error)
{
  // The bound API is a property of the thread, and another library may have bound OpenGL ES.
  if (!eglBindAPI(EGL_OPENGL_API) ||
    !eglMakeCurrent(this->EGL->Display, this->EGL->Surface, this->EGL->Surface, this->EGL->Context))
  {
    error = LastError();
    return false;
  }
  return true;
}

//--------------------------------------------------------------------------------------------------
bool OffscreenContext::IsCurrent() const
{
  return eglGetCurrentContext() == this->EGL->Context;
}

//--------------------------------------------------------------------------------------------------
void OffscreenContext::ReleaseCurrent()
{
  if (this->EGL && this->IsCurrent())
  {
    eglMakeCurrent(this->EGL->Display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
}

//--------------------------------------------------------------------------------------------------
CurrentContextKeeper::CurrentContextKeeper()
  : Display(eglGetCurrentDisplay())
  , Draw(eglGetCurrentSurface(EGL_DRAW))
  , Read(eglGetCurrentSurface(EGL_READ))
  , Context(eglGetCurrentContext())
{}

//--------------------------------------------------------------------------------------------------
CurrentContextKeeper::~CurrentContextKeeper()
{
  if (this->Context != EGL_NO_CONTEXT && eglGetCurrentContext() != this->Context)
  {
    eglMakeCurrent(this->Display, this->Draw, this->Read, this->Context);
  }
}

} // namespace nurbs
