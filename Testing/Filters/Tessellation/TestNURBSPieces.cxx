// SPDX-License-Identifier: BSD-3-Clause
// Pieces that sources give, as partitions of a block: filters put them together again. What several
// processes do is tested with ParaView (Testing/Plugin/ParaView/TestPieces.py).
#include "vtkNURBSModel.h"
#include "vtkNURBSShapeSource.h"
#include "vtkNURBSTessellator.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

namespace
{

using Grid = vtkSmartPointer<vtkUnstructuredGrid>;
using Triangle = std::array<double, 10>; // FaceId and corners.

Grid Piece(vtkNURBSShapeSource* source, int piece, int pieces)
{
  source->UpdatePiece(piece, pieces, 0);
  Grid grid = Grid::New();
  grid->DeepCopy(source->GetOutput());
  return grid;
}

std::vector<vtkIdType> FaceIds(vtkUnstructuredGrid* grid)
{
  std::vector<vtkIdType> ids;
  for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell)
  {
    ids.push_back(vtkNURBSModel::GetFaceId(grid, cell));
  }
  return ids;
}

void AddTriangles(vtkPolyData* mesh, std::vector<Triangle>& triangles)
{
  vtkDataArray* faces = mesh->GetCellData()->GetArray(vtkNURBSModel::FaceIdName());
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    mesh->GetCellPoints(cell, corners);
    Triangle triangle;
    triangle[0] = faces->GetTuple1(cell);
    for (int k = 0; k < 3; ++k)
    {
      mesh->GetPoint(corners->GetId(k), &triangle[1 + 3 * k]);
    }
    triangles.push_back(triangle);
  }
}

/// All triangles and the largest certified error of a tessellation.
std::vector<Triangle> Tessellate(vtkDataObject* models, double& error)
{
  vtkNew<vtkNURBSTessellator> tessellator;
  tessellator->SetInputData(models);
  tessellator->SetTolerance(1e-3);
  tessellator->Update();
  error = tessellator->GetCertifiedError();
  std::vector<Triangle> triangles;
  vtkDataObject* output = tessellator->GetOutputDataObject(0);
  if (auto* mesh = vtkPolyData::SafeDownCast(output))
  {
    AddTriangles(mesh, triangles);
  }
  auto* collection = vtkPartitionedDataSetCollection::SafeDownCast(output);
  for (unsigned int k = 0; collection && k < collection->GetNumberOfPartitions(0); ++k)
  {
    AddTriangles(vtkPolyData::SafeDownCast(collection->GetPartition(0, k)), triangles);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

TEST(Pieces, HaveAllFacesOnce)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToTeapot();
  source->Update();
  const std::vector<vtkIdType> all = FaceIds(source->GetOutput());
  EXPECT_FALSE(vtkNURBSModel::HasGlobalIds(source->GetOutput()));
  for (const int pieces : { 2, 5, 40 })
  {
    std::vector<vtkIdType> together;
    for (int piece = 0; piece < pieces; ++piece)
    {
      const Grid grid = Piece(source, piece, pieces);
      EXPECT_TRUE(vtkNURBSModel::HasGlobalIds(grid));
      EXPECT_EQ(vtkNURBSModel::Validate(grid), "");
      const std::vector<vtkIdType> some = FaceIds(grid);
      together.insert(together.end(), some.begin(), some.end());
    }
    EXPECT_EQ(together, all) << pieces << " pieces";
  }
}

// The pieces of one block share edges, and so do their triangles: they are those of the whole.
TEST(Pieces, OfOneBlockBecomeOneMesh)
{
  vtkNew<vtkNURBSShapeSource> source;
  for (const int shape : { vtkNURBSShapeSource::TEAPOT, vtkNURBSShapeSource::VASE })
  {
    source->SetShape(shape);
    double wholeError = 0.0;
    const std::vector<Triangle> whole = Tessellate(Piece(source, 0, 1), wholeError);
    ASSERT_GT(whole.size(), 100u);
    for (const int pieces : { 2, 3 })
    {
      vtkNew<vtkPartitionedDataSetCollection> parts;
      parts->SetNumberOfPartitionedDataSets(1);
      for (int piece = 0; piece < pieces; ++piece)
      {
        parts->SetPartition(0, piece, Piece(source, piece, pieces));
      }
      double error = 0.0;
      EXPECT_EQ(Tessellate(parts, error), whole);
      EXPECT_EQ(error, wholeError);
    }
  }
}

// What tells that pieces fit together is their ids: without them each is a model of its own.
TEST(Pieces, WithoutIdsStayApart)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToTeapot();
  vtkNew<vtkPartitionedDataSetCollection> parts;
  parts->SetNumberOfPartitionedDataSets(1);
  for (int piece = 0; piece < 2; ++piece)
  {
    const Grid grid = Piece(source, piece, 2);
    grid->GetFieldData()->RemoveArray("EdgeGlobalId");
    parts->SetPartition(0, piece, grid);
  }
  double error = 0.0;
  EXPECT_GT(Tessellate(parts, error).size(), 100u);
}

} // namespace
