// SPDX-License-Identifier: BSD-3-Clause
/// @file testMessageKeeper.h
/// @brief Keeps a VTK object's errors and warnings for a test to read, instead of printing them.
#pragma once

#include "vtkCommand.h"

#include <string>

/// Observer of ErrorEvent or WarningEvent: `object->AddObserver(vtkCommand::ErrorEvent, keeper)`.
class MessageKeeper : public vtkCommand
{
public:
  static MessageKeeper* New() { return new MessageKeeper; }
  void Execute(vtkObject*, unsigned long, void* text) override
  {
    this->Text = static_cast<const char*>(text);
  }
  /// True if the last message contains `part`.
  bool Says(const std::string& part) const { return this->Text.find(part) != std::string::npos; }

  std::string Text; ///< The last message; "" if there was none.
};
