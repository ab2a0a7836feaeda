// SPDX-License-Identifier: BSD-3-Clause
#include "vtkNURBSEGLRenderWindow.h"

#include "OffscreenContext.h"
#include "vtkObjectFactory.h"
#include "vtkRenderer.h"
#include "vtkRendererCollection.h"
#include "vtk_glew.h"

#include <algorithm>
#include <cstdlib>
#include <mutex>

//--------------------------------------------------------------------------------------------------
struct vtkNURBSEGLRenderWindow::vtkInternals
{
  std::unique_ptr<nurbs::OffscreenContext> Context;
};

//--------------------------------------------------------------------------------------------------
vtkStandardNewMacro(vtkNURBSEGLRenderWindow);

//--------------------------------------------------------------------------------------------------
vtkNURBSEGLRenderWindow::vtkNURBSEGLRenderWindow()
  : Internals(new vtkInternals)
{
  this->SetFrameBlitModeToNoBlit(); // pixels stay in VTK's framebuffers, nobody looks at a window
  this->ReadyForRendering = false;
  this->ShowWindow = false;
  this->UseOffScreenBuffers = true;
  this->DeviceIndex = -1;
  this->ScreenSize[0] = 1920;
  this->ScreenSize[1] = 1080;
  if (const char* index = std::getenv("VTK_EGL_DEVICE_INDEX"))
  {
    char* end = nullptr;
    const long value = std::strtol(index, &end, 10);
    if (end != index && *end == '\0' && value >= 0 && value <= VTK_INT_MAX)
    {
      this->DeviceIndex = static_cast<int>(value);
    }
  }
}

//--------------------------------------------------------------------------------------------------
vtkNURBSEGLRenderWindow::~vtkNURBSEGLRenderWindow()
{
  this->Finalize();
}

//--------------------------------------------------------------------------------------------------
vtkNURBSEGLRenderWindow* vtkNURBSEGLRenderWindow::Create(int width, int height, int deviceIndex)
{
  vtkNURBSEGLRenderWindow* window = vtkNURBSEGLRenderWindow::New();
  if (deviceIndex != -1)
  {
    window->SetDeviceIndex(deviceIndex);
  }
  window->SetSize(width, height);
  window->Initialize();
  if (!window->ErrorMessage.empty())
  {
    window->Delete();
    return nullptr;
  }
  return window;
}

//--------------------------------------------------------------------------------------------------
int vtkNURBSEGLRenderWindow::CountDevices()
{
  return static_cast<int>(nurbs::OffscreenDevices().size());
}

//--------------------------------------------------------------------------------------------------
std::string vtkNURBSEGLRenderWindow::GetDeviceName(int index)
{
  const auto devices = nurbs::OffscreenDevices();
  return index >= 0 && index < static_cast<int>(devices.size())
    ? devices[static_cast<size_t>(index)].Name
    : std::string();
}

//--------------------------------------------------------------------------------------------------
void vtkNURBSEGLRenderWindow::SetDeviceIndex(int index)
{
  if (index == this->DeviceIndex)
  {
    return;
  }
  this->Finalize();
  this->DeviceIndex = index;
  this->Modified();
}

//--------------------------------------------------------------------------------------------------
std::string vtkNURBSEGLRenderWindow::ContextString(unsigned int name)
{
  if (!this->Initialized)
  {
    return {};
  }
  this->MakeCurrent();
  const GLubyte* text = glGetString(name);
  return text ? reinterpret_cast<const char*>(text) : "";
}

//--------------------------------------------------------------------------------------------------
std::string vtkNURBSEGLRenderWindow::GetRendererName()
{
  return this->ContextString(GL_RENDERER);
}

//--------------------------------------------------------------------------------------------------
std::string vtkNURBSEGLRenderWindow::GetVendorName()
{
  return this->ContextString(GL_VENDOR);
}

//--------------------------------------------------------------------------------------------------
std::string vtkNURBSEGLRenderWindow::GetVersionName()
{
  return this->ContextString(GL_VERSION);
}

//--------------------------------------------------------------------------------------------------
int vtkNURBSEGLRenderWindow::GetMaximumSize()
{
  GLint texture = 0;
  GLint viewport[2] = { 0, 0 };
  if (this->Initialized)
  {
    this->MakeCurrent();
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
  }
  return std::min({ texture, viewport[0], viewport[1] });
}

//--------------------------------------------------------------------------------------------------
void vtkNURBSEGLRenderWindow::Fail(const std::string& reason)
{
  this->Internals->Context.reset();
  this->ReadyForRendering = false;
  this->Mapped = 0;
  this->ErrorMessage = reason;
  vtkErrorMacro("Cannot render offscreen: " << reason);
}

//--------------------------------------------------------------------------------------------------
void vtkNURBSEGLRenderWindow::Initialize()
{
  // A failure is told once; Finalize or another device let us try again.
  if (!this->Initialized && this->ErrorMessage.empty())
  {
    this->CreateAWindow();
  }
}

//--------------------------------------------------------------------------------------------------
void vtkNURBSEGLRenderWindow::CreateAWindow()
{
  std::string error;
  this->Internals->Context = nurbs::OffscreenContext::Create(this->DeviceIndex, error);
  if (!this->Internals->Context || !this->Internals->Context->MakeCurrent(error))
  {
    this->Fail(error);
    return;
  }
  this->OwnContext = 1;
  this->OpenGLInit();
  if (!this->Initialized)
  {
    return;
  }
  this->Mapped = 1;
  this->ReadyForRendering = true;
}

//--------------------------------------------------------------------------------------------------
void vtkNURBSEGLRenderWindow::OpenGLInit()
{
  // Not the direct superclass: it saves OpenGL state of a context it does not own, through
  // functions that are not loaded yet.
  this->vtkOpenGLRenderWindow::OpenGLInit();
  if (this->Initialized)
  {
    this->SetAlphaBitPlanes(8); // of VTK's framebuffers; the superclass asked the EGL surface
  }
}

//--------------------------------------------------------------------------------------------------
void vtkNURBSEGLRenderWindow::OpenGLInitContext()
{
  this->ContextCreationTime.Modified();
  if (this->Initialized)
  {
    return;
  }
  {
    // GLEW keeps the functions' addresses in global variables.
    static std::mutex mutex;
    std::lock_guard<std::mutex> lock(mutex);
    const GLenum result = glewInit();
    this->GlewInitValid = result == GLEW_OK || result == GLEW_ERROR_NO_GLX_DISPLAY;
    if (!this->GlewInitValid)
    {
      const GLubyte* reason = glewGetErrorString(result);
      this->Fail(std::string("OpenGL's functions could not be loaded: ") +
        (reason ? reinterpret_cast<const char*>(reason) : "unknown reason") + ".");
      return;
    }
  }
  if (!GLEW_VERSION_3_2)
  {
    this->Fail("the context has no OpenGL 3.2, but " +
      std::string(reinterpret_cast<const char*>(glGetString(GL_VERSION))) + ".");
    return;
  }
  this->Initialized = true;
  GLfloat range[2] = { 1.0f, 1.0f };
  glGetFloatv(
    this->LineSmoothing ? GL_SMOOTH_LINE_WIDTH_RANGE : GL_ALIASED_LINE_WIDTH_RANGE, range);
  this->MaximumHardwareLineWidth = glGetError() == GL_NO_ERROR ? range[1] : 1.0f;
}

//--------------------------------------------------------------------------------------------------
void vtkNURBSEGLRenderWindow::DestroyWindow()
{
  if (!this->Internals->Context)
  {
    return;
  }
  nurbs::CurrentContextKeeper keeper;
  this->ReleaseGraphicsResources(this);
  this->Internals->Context.reset();
  this->Mapped = 0;
  this->ReadyForRendering = false;
}

//--------------------------------------------------------------------------------------------------
void vtkNURBSEGLRenderWindow::Finalize()
{
  this->DestroyWindow();
  this->ErrorMessage.clear();
}

//--------------------------------------------------------------------------------------------------
void vtkNURBSEGLRenderWindow::MakeCurrent()
{
  std::string error;
  if (this->Internals->Context && !this->Internals->Context->IsCurrent() &&
    !this->Internals->Context->MakeCurrent(error))
  {
    vtkErrorMacro("The OpenGL context could not be made current: " << error << ".");
  }
}

//--------------------------------------------------------------------------------------------------
bool vtkNURBSEGLRenderWindow::IsCurrent()
{
  return this->Internals->Context && this->Internals->Context->IsCurrent();
}

//--------------------------------------------------------------------------------------------------
void vtkNURBSEGLRenderWindow::ReleaseCurrent()
{
  if (this->Internals->Context)
  {
    this->Internals->Context->ReleaseCurrent();
  }
}

//--------------------------------------------------------------------------------------------------
void vtkNURBSEGLRenderWindow::Render()
{
  this->Initialize();
  if (!this->Initialized)
  {
    return;
  }
  this->MakeCurrent();
  if (!this->IsCurrent())
  {
    return;
  }
  const int limit = this->GetMaximumSize();
  if (this->Size[0] > limit || this->Size[1] > limit)
  {
    vtkErrorMacro("A picture of " << this->Size[0] << "x" << this->Size[1]
                                  << " pixels is too large: this device draws up to " << limit
                                  << "x" << limit << ".");
    return;
  }
  // Not the direct superclass, which saves and restores the state of somebody else's context.
  this->vtkOpenGLRenderWindow::Render();
}

//--------------------------------------------------------------------------------------------------
int vtkNURBSEGLRenderWindow::GetZbufferData(int x1, int y1, int x2, int y2, float* z)
{
  if (!this->Initialized)
  {
    vtkErrorMacro("There are no depths to read: the window has not been drawn.");
    return VTK_ERROR;
  }
  return this->Superclass::GetZbufferData(x1, y1, x2, y2, z);
}

//--------------------------------------------------------------------------------------------------
int vtkNURBSEGLRenderWindow::GetDepthBufferSize()
{
  GLint framebuffer = 0;
  if (this->Initialized)
  {
    this->MakeCurrent();
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
  }
  return framebuffer ? this->Superclass::GetDepthBufferSize() : 32;
}

//--------------------------------------------------------------------------------------------------
const char* vtkNURBSEGLRenderWindow::ReportCapabilities()
{
  this->Initialize();
  return this->Initialized ? this->Superclass::ReportCapabilities() : this->ErrorMessage.c_str();
}

//--------------------------------------------------------------------------------------------------
int vtkNURBSEGLRenderWindow::SupportsOpenGL()
{
  this->Initialize();
  this->OpenGLSupportTested = true;
  this->OpenGLSupportResult = this->Initialized ? 1 : 0;
  this->OpenGLSupportMessage = this->Initialized ? this->GetVersionName() : this->ErrorMessage;
  return this->OpenGLSupportResult;
}

//--------------------------------------------------------------------------------------------------
vtkTypeBool vtkNURBSEGLRenderWindow::IsDirect()
{
  return this->Initialized ? 1 : 0;
}

//--------------------------------------------------------------------------------------------------
void vtkNURBSEGLRenderWindow::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "DeviceIndex: " << this->DeviceIndex << "\n";
  os << indent << "ErrorMessage: " << this->ErrorMessage << "\n";
  os << indent << "Renderer: " << this->GetRendererName() << "\n";
  os << indent << "Version: " << this->GetVersionName() << "\n";
}
