// SPDX-License-Identifier: BSD-3-Clause
// The count of open edges on meshes whose cracks are known.
#include "vtkMeshOpenEdges.h"

#include "vtkCellArray.h"
#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <gtest/gtest.h>

#include <vector>

namespace
{

// Triangles with points of their own; x and y are the parameters too.
vtkSmartPointer<vtkPolyData> MakeMesh(const std::vector<double>& corners)
{
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> uv;
  uv->SetName("UV");
  uv->SetNumberOfComponents(2);
  vtkNew<vtkCellArray> triangles;
  for (std::size_t k = 0; k + 8 < corners.size(); k += 9)
  {
    const vtkIdType first = points->GetNumberOfPoints();
    for (std::size_t c = 0; c < 9; c += 3)
    {
      points->InsertNextPoint(&corners[k + c]);
      uv->InsertNextTuple2(corners[k + c], corners[k + c + 1]);
    }
    triangles->InsertNextCell({ first, first + 1, first + 2 });
  }
  mesh->SetPoints(points);
  mesh->SetPolys(triangles);
  mesh->GetPointData()->AddArray(uv);
  return mesh;
}

// Two triangles on the unit square, and the tetrahedron over half of it.
const std::vector<double> Square{ 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0 };
const std::vector<double> Tetrahedron{ 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0,
  0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 1 };

} // namespace

TEST(MeshOpenEdges, ClosedSolidHasNone)
{
  EXPECT_EQ(CountOpenEdges(MakeMesh(Tetrahedron), false), 0);
}

TEST(MeshOpenEdges, MissingTriangleOpensItsThreeEdges)
{
  const std::vector<double> open(Tetrahedron.begin(), Tetrahedron.end() - 9);
  EXPECT_EQ(CountOpenEdges(MakeMesh(open), false), 3);
}

TEST(MeshOpenEdges, BorderOfTheDomainCanBeLeftOut)
{
  EXPECT_EQ(CountOpenEdges(MakeMesh(Square), false), 4);
  EXPECT_EQ(CountOpenEdges(MakeMesh(Square), true), 0);
}

TEST(MeshOpenEdges, LastBitsAndTheSignOfZero)
{
  std::vector<double> signs = Square;
  signs[2] = -0.0;
  EXPECT_EQ(CountOpenEdges(MakeMesh(signs), true), 0);
  std::vector<double> bits = Square;
  bits[8] = 1e-300; // a corner of the diagonal, in one of its two triangles
  EXPECT_EQ(CountOpenEdges(MakeMesh(bits), true), 2);
}

TEST(MeshOpenEdges, VertexInTheMiddleOfAnEdgeOpensThree)
{
  std::vector<double> split(Square.begin(), Square.begin() + 9);
  const std::vector<double> halves{ 0, 0, 0, 0.5, 0.5, 0, 0, 1, 0, 0.5, 0.5, 0, 1, 1, 0, 0, 1, 0 };
  split.insert(split.end(), halves.begin(), halves.end());
  EXPECT_EQ(CountOpenEdges(MakeMesh(split), true), 3);
}

TEST(MeshOpenEdges, TrianglesWithoutAreaDoNotCount)
{
  std::vector<double> more = Tetrahedron;
  const std::vector<double> flat{ 0, 0, 0, 1, 0, 0, 1, 0, 0 };
  more.insert(more.end(), flat.begin(), flat.end());
  EXPECT_EQ(CountOpenEdges(MakeMesh(more), false), 0);
}
