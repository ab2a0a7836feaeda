// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSDrawingLines.h
 * @brief Takes the lines of a drawing out of VTK data. Private to this module.
 */
#ifndef vtkNURBSDrawingLines_h
#define vtkNURBSDrawingLines_h

#include "PathJoin.h"

#include <string>
#include <vector>

class vtkDataObject;

namespace vtkNURBSDrawingLines
{

constexpr int KindCount = 5; // Silhouette, boundary, sharp, smooth, intersection.

/// Where a line comes from.
struct Origin
{
  int Kind = 2;
  bool Visible = true;
  std::int64_t Face = -1, Edge = -1;
  std::size_t Part = 0;
};

struct Lines
{
  std::vector<nurbs::PlaneLine> Geometry;
  std::vector<Origin> Origins; ///< One a line.
  /// Of a composite data set's leaves: their names, or their numbers from 0. Of a single data set:
  /// "".
  std::vector<std::string> Parts;
  std::string Unit; ///< LengthUnit of the first part that has one.
  nurbs::Box2 Box;
};

/// All lines of a vtkPolyData or a composite data set; hidden ones only if wanted. Returns what is
/// wrong, or "".
std::string Collect(vtkDataObject* input, bool hidden, Lines& lines);

/// Takes away of hidden lines what other lines draw already, within a tolerance.
void DropHiddenCopies(Lines& lines, double tolerance);

} // namespace vtkNURBSDrawingLines

#endif
