// SPDX-License-Identifier: BSD-3-Clause
// Small CAD files from file to mesh through the filters; every face is measured against the original
// shape. The whole collection is verified by verify_all.py.
#include "FaceCheck.h"
#include "OpenEdges.h"
#include "ReferenceShape.h"
#include "vtkMeshInput.h"

#include "vtkNURBSCADReader.h"
#include "vtkNURBSTessellator.h"

#include <vtkDataObject.h>
#include <vtkNew.h>
#include <vtkPartitionedDataSetCollection.h>
#include <vtkPolyData.h>

#include <gtest/gtest.h>

#include <fstream>

namespace
{

using namespace verify;

struct Case
{
  const char* File;
  const char* Error;
};

void PrintTo(const Case& c, std::ostream* os)
{
  *os << c.File << " " << c.Error;
}

class VerifiedMesh : public testing::TestWithParam<Case>
{};

TEST_P(VerifiedMesh, MeetsTheToleranceOnEveryFace)
{
  const std::string file = std::string("/usr/share/opencascade/data/") + this->GetParam().File;
  if (!std::ifstream(file))
  {
    GTEST_SKIP() << file << " is not there (Debian package occt-misc)";
  }
  const ReferenceShape shape = Describe(ReadShape(file));
  CheckOptions options;
  options.Tolerance = 1e-3 * shape.Diagonal;
  vtkNew<vtkNURBSCADReader> reader;
  reader->SetFileName(file.c_str());
  reader->SingleModelOn();
  reader->Update();
  vtkNew<vtkNURBSTessellator> tessellator;
  tessellator->SetInputData(reader->GetOutput()->GetPartition(0, 0));
  tessellator->SetToleranceModeToAbsolute();
  tessellator->SetAbsoluteTolerance(options.Tolerance);
  const bool guaranteed = std::string(this->GetParam().Error) == "guaranteed";
  guaranteed ? tessellator->SetErrorModeToGuaranteed() : tessellator->SetErrorModeToEstimated();
  tessellator->Update();
  const std::vector<FaceMesh> meshes = SplitIntoFaces(
    vtkPolyData::SafeDownCast(tessellator->GetOutputDataObject(0)), int(shape.Faces.size()));
  const std::vector<FaceGap> gaps = MeasureGaps(shape);
  for (std::size_t f = 0; f < meshes.size(); ++f)
  {
    const FaceReport r = CheckFace(shape.Faces[f], meshes[f], options);
    const double reach = options.Tolerance + gaps[f].Neighbours;
    EXPECT_FALSE(r.Missing) << "face " << f;
    EXPECT_LE(r.Error(), reach * (1.0 + 1e-6)) << "face " << f;
    EXPECT_TRUE(r.AreaAgrees(reach)) << "face " << f << ": " << r.MeshArea << ", " << r.ExactArea;
    EXPECT_EQ(r.Folded, 0) << "face " << f;
    if (guaranteed)
    {
      EXPECT_LE(r.Error(), meshes[f].Certified * (1.0 + 1e-9) + 1e-6 * options.Tolerance)
        << "face " << f;
    }
  }
  const OpenEdgeReport open = FindOpenEdges(shape, meshes, 2.0 * options.Tolerance);
  EXPECT_EQ(open.OpenEdges, 0);
  EXPECT_EQ(open.Cracks, 0);
  EXPECT_EQ(open.Misdirected, 0);
}

INSTANTIATE_TEST_SUITE_P(OcctMisc, VerifiedMesh,
  testing::Values(Case{ "step/screw.step", "guaranteed" }, Case{ "step/screw.step", "estimated" },
    Case{ "iges/hammer.iges", "guaranteed" }, Case{ "occ/face2.brep", "guaranteed" },
    Case{ "occ/fuse.brep", "guaranteed" }, Case{ "occ/Pump_Nut.brep", "guaranteed" },
    Case{ "occ/wing.brep", "guaranteed" }, Case{ "occ/CrankArm.rle", "guaranteed" },
    Case{ "occ/CrankArm.rle", "estimated" }, Case{ "occ/Axis_of_bearing.brep", "guaranteed" },
    Case{ "occ/MODERN_Sink_1_opened.brep", "guaranteed" }));

} // namespace
