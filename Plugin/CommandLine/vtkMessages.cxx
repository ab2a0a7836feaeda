// SPDX-License-Identifier: BSD-3-Clause
#include "vtkMessages.h"

#include "vtkObjectFactory.h"

#include <regex>
#include <utility>

vtkStandardNewMacro(vtkMessages);

//--------------------------------------------------------------------------------------------------
std::string vtkMessages::Plain(const char* text)
{
  static const std::regex heading(
    "^\\s*(ERROR|Warning|Generic Warning|Debug): In [^\n]*, line [0-9]+\n");
  static const std::regex object("^[A-Za-z0-9_]+ \\(0?x?[0-9a-fA-F]+\\): ");
  std::string plain = std::regex_replace(std::string(text ? text : ""), heading, "");
  plain = std::regex_replace(plain, object, "");
  while (!plain.empty() && (plain.back() == '\n' || plain.back() == ' ' || plain.back() == '.'))
  {
    plain.pop_back();
  }
  static const std::regex spaces("\\s+");
  return std::regex_replace(plain, spaces, " ");
}

//--------------------------------------------------------------------------------------------------
void vtkMessages::DisplayErrorText(const char* text)
{
  const std::string plain = vtkMessages::Plain(text);
  std::lock_guard<std::mutex> lock(this->Mutex);
  if (this->FirstError.empty())
  {
    this->FirstError = plain;
  }
}

//--------------------------------------------------------------------------------------------------
void vtkMessages::DisplayWarningText(const char* text)
{
  const std::string plain = vtkMessages::Plain(text);
  std::lock_guard<std::mutex> lock(this->Mutex);
  this->Warnings.push_back(plain);
}

//--------------------------------------------------------------------------------------------------
void vtkMessages::DisplayGenericWarningText(const char* text)
{
  this->DisplayWarningText(text);
}

//--------------------------------------------------------------------------------------------------
void vtkMessages::DisplayText(const char* text)
{
  this->DisplayWarningText(text);
}

//--------------------------------------------------------------------------------------------------
void vtkMessages::DisplayDebugText(const char*) {}

//--------------------------------------------------------------------------------------------------
std::string vtkMessages::GetFirstError()
{
  std::lock_guard<std::mutex> lock(this->Mutex);
  return this->FirstError;
}

//--------------------------------------------------------------------------------------------------
std::vector<std::string> vtkMessages::TakeWarnings()
{
  std::lock_guard<std::mutex> lock(this->Mutex);
  return std::exchange(this->Warnings, {});
}
