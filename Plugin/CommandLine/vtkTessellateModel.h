// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A model to triangles, by the options of the command line.
#ifndef vtkTessellateModel_h
#define vtkTessellateModel_h

#include "vtkReadModel.h"

class vtkCamera;
class vtkPolyData;

namespace nurbs
{

struct Arguments;
struct Report;

/// A mesh and its faces' edges.
struct Triangles
{
  vtkSmartPointer<vtkPolyData> Mesh;
  vtkSmartPointer<vtkPolyData> Edges; ///< polylines
};

/// Tessellates a model and fills in the report's figures of it. `camera` is needed for a tolerance
/// in pixels only. Throws Failure if nothing came out.
Triangles Tessellate(vtkDataObject* model, const Arguments& arguments, vtkCamera* camera,
  const ProgressFunction& progress, Report& report);

/// Number of edges that one triangle has and no other. Points with equal coordinates are the same;
/// a triangle with two equal corners has no edge that counts.
std::int64_t CountOpenEdges(vtkPolyData* mesh);

} // namespace nurbs

#endif
