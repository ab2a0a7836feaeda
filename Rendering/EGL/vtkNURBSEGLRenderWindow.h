// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkNURBSEGLRenderWindow
 * @brief   offscreen OpenGL render window that needs no display server
 *
 * A vtkRenderWindow whose OpenGL context comes from EGL: no X server, no window manager, no Xvfb.
 * It draws on a GPU where a driver offers one, and in software (Mesa's llvmpipe) elsewhere. It
 * works with any VTK that has its OpenGL2 backend, also one that was built without EGL, such as
 * Debian's VTK and ParaView.
 *
 * @code
 * auto window = vtkSmartPointer<vtkNURBSEGLRenderWindow>::Take(
 *   vtkNURBSEGLRenderWindow::Create(800, 600));
 * if (!window)
 * {
 *   return EXIT_FAILURE; // the reason was printed as a VTK error
 * }
 * window->AddRenderer(renderer);
 * window->Render();
 * // then GetPixelData(), GetZbufferData(), vtkWindowToImageFilter, ... as with any window
 * @endcode
 *
 * From Python: `from vtknurbs import vtkNURBSEGLRenderWindow`, beside the `vtkmodules` of the same
 * VTK; import `vtkmodules.vtkRenderingOpenGL2` first so that vtkRenderer draws with OpenGL.
 *
 * Devices: EGL_EXT_device_enumeration numbers the machine's devices from 0, GPUs usually before the
 * software renderer. DeviceIndex -1, the default, takes the first device that gives a context,
 * hardware before software; if the driver cannot enumerate devices, Mesa's surfaceless platform and
 * then EGL's default display are tried. An index that was asked for is never replaced by another:
 * if it does not work, the error says why. The environment variable VTK_EGL_DEVICE_INDEX sets the
 * initial DeviceIndex, as it does for VTK's own EGL window.
 *
 * The context is an OpenGL core profile of version 3.2 or later, made on the first Initialize() or
 * Render(). All drawing goes to VTK's framebuffer objects; the EGL surface behind them has one
 * pixel and never changes, so any size up to GetMaximumSize() costs only its framebuffers. Several
 * windows, of different sizes and on different devices, may live at once; each has its own
 * context.
 *
 * Threads: a context belongs to the thread that made it current. One thread at a time may use a
 * window; to hand it to another thread call ReleaseCurrent() first. Windows of different threads
 * are independent of each other, as long as each is made, used and deleted by one thread; VTK's
 * reference counts of objects they share (actors, mappers) are not protected by it, so share none.
 *
 * Errors: without a usable EGL (no driver, no such device, a device without OpenGL 3.2) one
 * vtkErrorMacro tells the reason and the remedy, Render() draws nothing, reads of pixels return
 * VTK_ERROR, and GetErrorMessage() keeps the words. Nothing crashes. Changing DeviceIndex or
 * calling Finalize() lets the window try again.
 *
 * @sa vtkGenericOpenGLRenderWindow, vtkWindowToImageFilter
 */

#ifndef vtkNURBSEGLRenderWindow_h
#define vtkNURBSEGLRenderWindow_h

#include "vtkGenericOpenGLRenderWindow.h"
#include "vtkNURBSRenderingEGLModule.h" // For export macro
#include "vtkWrappingHints.h"           // For VTK_NEWINSTANCE

#include <memory> // For the EGL handles
#include <string> // For messages and names

class VTKNURBSRENDERINGEGL_EXPORT vtkNURBSEGLRenderWindow : public vtkGenericOpenGLRenderWindow
{
public:
  static vtkNURBSEGLRenderWindow* New();
  vtkTypeMacro(vtkNURBSEGLRenderWindow, vtkGenericOpenGLRenderWindow);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /**
   * A window of width x height pixels whose context already works, or null after a vtkErrorMacro
   * that tells why there is none. The caller owns it: take it with vtkSmartPointer::Take (Python
   * does so by itself). Multisampling is VTK's default; see SetMultiSamples(). deviceIndex is that
   * of SetDeviceIndex(), and -1 leaves it as it is.
   */
  VTK_NEWINSTANCE
  static vtkNURBSEGLRenderWindow* Create(int width, int height, int deviceIndex = -1);

  ///@{
  /**
   * What EGL offers on this machine. The number of devices is 0 when the driver cannot enumerate
   * them, which does not mean that rendering is impossible. GetDeviceName() describes device
   * 0 <= index < CountDevices() without making a context, e.g. "/dev/dri/card0" or
   * "software renderer"; it is empty for any other index. GetNumberOfDevices() is the same number
   * as CountDevices(), by the name that vtkRenderWindow gives it.
   */
  static int CountDevices();
  static std::string GetDeviceName(int index);
  int GetNumberOfDevices() override { return vtkNURBSEGLRenderWindow::CountDevices(); }
  ///@}

  /**
   * The EGL device to draw on, -1 (default) for the first that works. Setting another one drops
   * the present context and everything that VTK uploaded to it; the next Render() makes a new one.
   */
  void SetDeviceIndex(int index) override;

  ///@{
  /**
   * Strings of the context in use: who draws (e.g. "llvmpipe (LLVM 15.0.6, 256 bits)"), its
   * vendor, and the OpenGL version. Empty before Initialize() and without a context.
   */
  std::string GetRendererName();
  std::string GetVendorName();
  std::string GetVersionName();
  ///@}

  /**
   * The longest side of a picture in pixels that the context can draw, 0 without a context.
   */
  int GetMaximumSize();

  /**
   * Why the window has no context, in words; empty while all is well.
   */
  const std::string& GetErrorMessage() const { return this->ErrorMessage; }

  /**
   * Make the context if there is none. Called by Render(); call it to have errors early, then
   * look at GetErrorMessage().
   */
  void Initialize() override;

  /**
   * Release everything on the device: VTK's objects, the context, and EGL's display when the last
   * window on it goes. Whatever context was current in the calling thread stays so. The window may
   * be used again afterwards.
   */
  void Finalize() override;

  ///@{
  /**
   * Binding of the context to the calling thread. MakeCurrent() does nothing without a context;
   * IsCurrent() asks EGL; ReleaseCurrent() leaves the thread without a context.
   */
  void MakeCurrent() override;
  bool IsCurrent() override;
  void ReleaseCurrent() override;
  ///@}

  /**
   * Draw the renderers; nothing, after an error, if there is no context.
   */
  void Render() override;

  /**
   * The depths, 0 (near) to 1 (far), of the pixels of a rectangle that includes its corners, row
   * by row from the bottom. VTK_ERROR, and no value written, if the window has not been drawn.
   */
  int GetZbufferData(int x1, int y1, int x2, int y2, float* z) override;
  using vtkGenericOpenGLRenderWindow::GetZbufferData;

  /**
   * Bits of a depth: those of the framebuffer that is bound, and before the first Render() the 32
   * that VTK asks for. The EGL surface has no depths.
   */
  int GetDepthBufferSize() override;

  /**
   * OpenGL's vendor, renderer, version and extensions as text, or the error message.
   */
  const char* ReportCapabilities() override;

  ///@{
  /**
   * 1 if OpenGL 3.2 can be had from the device (this makes the context), else 0; whether it
   * draws without an X server in between: always, once there is a context.
   */
  int SupportsOpenGL() override;
  vtkTypeBool IsDirect() override;
  ///@}

  ///@{
  /**
   * VTK's steps of setting up a fresh context. glewInit() ends with "no GLX display" although it
   * has loaded every OpenGL function, which is as it should be here and accepted.
   */
  void OpenGLInit() override;
  void OpenGLInitContext() override;
  ///@}

protected:
  vtkNURBSEGLRenderWindow();
  ~vtkNURBSEGLRenderWindow() override;

  void CreateAWindow() override;
  void DestroyWindow() override;

  std::string ErrorMessage;

private:
  vtkNURBSEGLRenderWindow(const vtkNURBSEGLRenderWindow&) = delete;
  void operator=(const vtkNURBSEGLRenderWindow&) = delete;

  void Fail(const std::string& reason);
  std::string ContextString(unsigned int name);

  struct vtkInternals;
  std::unique_ptr<vtkInternals> Internals;
};

#endif
