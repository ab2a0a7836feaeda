// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file vtkNURBSEditTables.h
 * @brief Edits of control points as rows of tables, as panels and state files keep them.
 *
 * Private to this module. A row names a control point by the flat index of its block (0: the input
 * itself, or the first model of a composite one) and its index there, both as doubles, because a
 * property's elements are all of one type.
 */
#ifndef vtkNURBSEditTables_h
#define vtkNURBSEditTables_h

#include "vtkType.h"

#include <array>
#include <vector>

class vtkDoubleArray;
class vtkIdTypeArray;
class vtkNURBSControlPointEdits;

struct vtkNURBSEditTables
{
  using PlaceRow = std::array<double, 5>;  ///< Block, point, x, y, z.
  using WeightRow = std::array<double, 3>; ///< Block, point, weight.

  std::vector<PlaceRow> Moves;     ///< Displacements.
  std::vector<PlaceRow> Positions; ///< Places.
  std::vector<WeightRow> Weights;

  bool operator==(const vtkNURBSEditTables& other) const;

  /// Adds the rows to `edits`: positions first, then moves, then weights, each in the order of its
  /// rows.
  void Apply(vtkNURBSControlPointEdits* edits) const;

  /// Moves a control point further: by the last row of one of `together`, the points that are edited
  /// with it, or by a new row.
  void Move(unsigned int block, vtkIdTypeArray* together, vtkIdType point, const double by[3]);
  /// Gives a control point a weight, by its last row or a new one.
  void SetWeight(unsigned int block, vtkIdType point, double weight);
};

#endif
