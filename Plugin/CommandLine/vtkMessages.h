// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkMessages
 * @brief   turns what VTK's classes complain about into lines for a command's user
 *
 * Installed as the vtkOutputWindow. Errors are kept, so that the command can end with the first of
 * them; warnings are kept too and printed by the command when its progress bar is away. Neither
 * shows source files, class names or addresses.
 */
#ifndef vtkMessages_h
#define vtkMessages_h

#include "vtkOutputWindow.h"

#include <mutex>
#include <string>
#include <vector>

class vtkMessages : public vtkOutputWindow
{
public:
  static vtkMessages* New();
  vtkTypeMacro(vtkMessages, vtkOutputWindow);

  void DisplayText(const char* text) override;
  void DisplayErrorText(const char* text) override;
  void DisplayWarningText(const char* text) override;
  void DisplayGenericWarningText(const char* text) override;
  void DisplayDebugText(const char* text) override;

  /// The first error so far, one line, or an empty string.
  std::string GetFirstError();

  /// Warnings since the last call, one line each.
  std::vector<std::string> TakeWarnings();

  /// "ERROR: In file, line 7\nvtkClass (0x1): text\n" to "text".
  static std::string Plain(const char* text);

protected:
  vtkMessages() = default;
  ~vtkMessages() override = default;

private:
  vtkMessages(const vtkMessages&) = delete;
  void operator=(const vtkMessages&) = delete;

  std::mutex Mutex;
  std::string FirstError;
  std::vector<std::string> Warnings;
};

#endif
