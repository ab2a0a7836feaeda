// SPDX-License-Identifier: BSD-3-Clause
/// @file CADFile.h
/// @brief What kind of CAD file a file is, by its content, before anybody parses it.
#pragma once

#include <string>

namespace nurbs
{

enum class CADFormat
{
  STEP,      ///< ISO 10303-21 text.
  IGES,      ///< 80-column IGES text.
  BREP,      ///< OpenCASCADE's shape as text (.brep, .rle).
  BinaryBREP ///< The same in binary form.
};

/// "STEP", "IGES" or "BREP".
const char* NameOf(CADFormat format);

/// The format by content; the extension is only used to word errors. Throws Error, naming the path,
/// if it is missing, a directory, unreadable, empty, none of these formats, or visibly cut short (a
/// STEP file without END-ISO-10303-21, an IGES file without its terminate section, a BREP text
/// without its table of shapes).
CADFormat DetectCADFormat(const std::string& path);

} // namespace nurbs
