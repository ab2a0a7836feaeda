// SPDX-License-Identifier: BSD-3-Clause
#include "CADFile.h"

#include "Types.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

namespace nurbs
{

namespace
{

constexpr std::streamoff HeadSize = 65536;
constexpr std::streamoff TailSize = 8192;
constexpr std::streamoff PieceSize = 1 << 20;

std::string ReadPiece(std::ifstream& file, std::streamoff offset, std::streamoff size)
{
  std::string piece(static_cast<std::size_t>(size), '\0');
  file.clear();
  file.seekg(offset);
  file.read(piece.data(), size);
  piece.resize(static_cast<std::size_t>(file.gcount()));
  return piece;
}

bool Contains(const std::string& text, const char* part)
{
  return text.find(part) != std::string::npos;
}

/// The section letter in column 73 of the line that begins at `line`, or 0.
char IgesSection(const std::string& text, std::size_t line)
{
  return line + 80 <= text.size() && text.find('\n', line) >= line + 80 ? text[line + 72] : '\0';
}

std::optional<CADFormat> FormatOf(const std::string& head)
{
  const std::string start = head.substr(0, 512);
  if (Contains(start, "Open CASCADE Topology"))
  {
    return CADFormat::BinaryBREP;
  }
  if (Contains(start, "CASCADE Topology V") || Contains(start, "DBRep_DrawableShape"))
  {
    return CADFormat::BREP;
  }
  const std::size_t iso = head.find("ISO-10303-21");
  if (iso != std::string::npos && iso == head.find_first_not_of(" \t\r\n\xEF\xBB\xBF"))
  {
    return CADFormat::STEP;
  }
  const char section = IgesSection(head, 0);
  if ((section == 'S' || section == 'B' || section == 'C') &&
    head.find_first_of("0123456789", 73) < 80)
  {
    return CADFormat::IGES;
  }
  // Comments may precede the keyword of a STEP file.
  return iso != std::string::npos && head.compare(0, 2, "/*") == 0
    ? std::optional<CADFormat>(CADFormat::STEP)
    : std::nullopt;
}

/// True if a line of the file begins with `keyword`, searched from the end.
bool HasLine(std::ifstream& file, std::streamoff size, const std::string& keyword)
{
  const std::string wanted = "\n" + keyword;
  const std::streamoff overlap = static_cast<std::streamoff>(wanted.size()) - 1;
  for (std::streamoff end = size; end > 0;)
  {
    const std::streamoff begin = std::max<std::streamoff>(0, end - PieceSize);
    const std::streamoff length = std::min(size, end + overlap) - begin;
    if (ReadPiece(file, begin, length).find(wanted) != std::string::npos)
    {
      return true;
    }
    end = begin;
  }
  return false;
}

/// True if the last line that is not blank is the terminate section's.
bool EndsAsIges(std::string tail)
{
  tail.erase(tail.find_last_not_of(" \t\r\n\0\x1a") + 1);
  const std::size_t line = tail.find_last_of('\n') + 1;
  return tail.size() >= line + 73 && tail[line + 72] == 'T';
}

} // namespace

const char* NameOf(CADFormat format)
{
  switch (format)
  {
    case CADFormat::STEP:
      return "STEP";
    case CADFormat::IGES:
      return "IGES";
    default:
      return "BREP";
  }
}

CADFormat DetectCADFormat(const std::string& path)
{
  namespace fs = std::filesystem;
  const std::string quoted = "\"" + path + "\"";
  std::error_code code;
  const fs::file_status status = fs::status(fs::u8path(path), code);
  if (path.empty() || status.type() == fs::file_type::not_found)
  {
    throw Error("no such file: " + quoted);
  }
  if (fs::is_directory(status))
  {
    throw Error(quoted + " is a directory, not a CAD file");
  }
  if (!fs::is_regular_file(status))
  {
    throw Error(quoted + " is not a regular file");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file)
  {
    throw Error("cannot open " + quoted + ": " + std::strerror(errno));
  }
  file.seekg(0, std::ios::end);
  const std::streamoff size = file.tellg();
  if (size == 0)
  {
    throw Error(quoted + " is empty");
  }
  const std::string head = ReadPiece(file, 0, std::min(size, HeadSize));
  const std::streamoff tailSize = std::min(size, TailSize);
  const std::string tail = ReadPiece(file, size - tailSize, tailSize);
  const std::optional<CADFormat> format = FormatOf(head);
  if (!format)
  {
    throw Error(quoted + " is neither a STEP, an IGES nor a BREP file by its content");
  }
  if (*format == CADFormat::STEP && !Contains(tail, "END-ISO-10303-21"))
  {
    throw Error(quoted + " is a truncated STEP file: END-ISO-10303-21 is missing");
  }
  if (*format == CADFormat::IGES && !EndsAsIges(tail))
  {
    throw Error(quoted + " is a truncated IGES file: its terminate section is missing");
  }
  if (*format == CADFormat::BREP && !HasLine(file, size, "TShapes "))
  {
    throw Error(quoted + " is a truncated or broken BREP file: it has no table of shapes");
  }
  return *format;
}

} // namespace nurbs
