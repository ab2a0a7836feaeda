// SPDX-License-Identifier: BSD-3-Clause
// vtkNURBSVisibleRegions and input that is wrong, degenerate or ambiguous: a clear error, or the right
// areas.
#include "vtkRegionScene.h"

#include "vtkPartitionedDataSetCollection.h"

namespace
{

using namespace regions;

constexpr double PI = 3.14159265358979323846;
const double NaN = std::numeric_limits<double>::quiet_NaN();
const double Infinity = std::numeric_limits<double>::infinity();

// A filter whose messages are kept.
struct Case
{
  vtkNew<vtkNURBSVisibleRegions> Filter;
  vtkNew<MessageKeeper> Errors;
  vtkNew<MessageKeeper> Warnings;

  Case()
  {
    this->Filter->AddObserver(vtkCommand::ErrorEvent, this->Errors);
    this->Filter->AddObserver(vtkCommand::WarningEvent, this->Warnings);
  }
  void Run(vtkDataObject* input, double x, double y, double z)
  {
    this->Filter->SetInputData(input);
    this->Filter->SetDirection(x, y, z);
    this->Filter->Update();
  }
  // True if an Update is an error that says `part`, and leaves nothing of the last result.
  bool Fails(const char* part)
  {
    this->Errors->Text.clear();
    this->Filter->Modified();
    this->Filter->Update();
    return this->Filter->GetErrorCode() == vtkErrorCode::UserError && this->Errors->Says(part) &&
      Models(this->Filter)->GetNumberOfCells() == 0 &&
      this->Filter->GetLines()->GetNumberOfPoints() == 0 && this->Filter->GetNumberOfLines() == 0 &&
      this->Filter->GetNumberOfFaces() == 0 && this->Filter->GetVisibleArea() == 0.0 &&
      this->Filter->GetSeconds() == 0.0;
  }
  double Area(int face) { return VisibleAreaOf(this->Filter, face); }
  // The length of the lines of a visibility.
  double Length(int visibility)
  {
    vtkPolyData* lines = this->Filter->GetLines();
    vtkNew<vtkIdList> ids;
    double sum = 0.0;
    for (vtkIdType c = 0; c < lines->GetNumberOfCells(); ++c)
    {
      lines->GetCellPoints(c, ids);
      for (vtkIdType k = 1;
           CellValue(lines, "Visibility", c) == visibility && k < ids->GetNumberOfIds(); ++k)
      {
        double p[3], q[3];
        lines->GetPoint(ids->GetId(k - 1), p);
        lines->GetPoint(ids->GetId(k), q);
        sum += std::sqrt(vtkMath::Distance2BetweenPoints(p, q));
      }
    }
    return sum;
  }
};

TEST(NURBSVisibleRegionsInput, DirectionsThatAreNone)
{
  Case c;
  c.Run(Shape(vtkNURBSShapeSource::SPHERE), 0, 0, 1);
  EXPECT_GT(c.Filter->GetNumberOfLines(), 0);
  c.Filter->SetDirection(0, 0, 0);
  EXPECT_TRUE(c.Fails("direction to the viewer has length zero")) << c.Errors->Text;
  c.Filter->SetDirection(0, NaN, 0);
  EXPECT_TRUE(c.Fails("direction to the viewer is not finite")) << c.Errors->Text;
  c.Filter->SetDirection(0, 1, -Infinity);
  EXPECT_TRUE(c.Fails("direction to the viewer is not finite")) << c.Errors->Text;
  c.Filter->SetDirection(0, 1, 0);
  c.Filter->SetViewUp(0, NaN, 1);
  EXPECT_TRUE(c.Fails("up direction is not finite")) << c.Errors->Text;
  // No length of the direction, or of what is up, matters.
  for (const double length : { 1e-310, 1e-160, 1e160, 1e308 })
  {
    c.Filter->SetDirection(length, 0, length);
    for (const double up : { 0.0, 1e-310, 1e-160, 1e160, 1e308 })
    {
      c.Filter->SetViewUp(0, up, 0);
      c.Filter->Update();
      EXPECT_NEAR(c.Filter->GetVisibleArea(), 2.0 * PI, 2e-3) << length << " " << up;
      EXPECT_EQ(c.Filter->GetErrorCode(), vtkErrorCode::NoError) << c.Errors->Text;
    }
  }
}

TEST(NURBSVisibleRegionsInput, EyesThatSeeNothing)
{
  Case c;
  c.Filter->SetInputData(Shape(vtkNURBSShapeSource::SPHERE));
  c.Filter->SetProjectionToPerspective();
  c.Filter->SetEyePoint(0, 0, NaN);
  EXPECT_TRUE(c.Fails("eye is not finite")) << c.Errors->Text;
  c.Filter->SetEyePoint(0, Infinity, 0);
  EXPECT_TRUE(c.Fails("eye is not finite")) << c.Errors->Text;
  const double eyes[][3] = { { 0, 0, 0 }, { 0.5, 0.1, 0 }, { 1, 0, 0 }, { 0, 0, -1 },
    { 0.9, 0.9, 0.9 }, { 1, 1, 1 }, { 0, 1.0 + 1e-12, 0 } };
  for (const auto& eye : eyes)
  {
    c.Filter->SetEyePoint(eye[0], eye[1], eye[2]);
    EXPECT_TRUE(c.Fails("The eye is within the model's box")) << eye[0] << c.Errors->Text;
  }
  c.Filter->SetEyePoint(0, 1.25, 0);
  c.Filter->Update();
  EXPECT_EQ(c.Filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_NEAR(c.Filter->GetVisibleArea(), 2.0 * PI * 0.2, 2e-3);
  // From far away it looks as in parallel light; at last numbers do not suffice to tell it.
  for (const double far : { 1e3, 1e6 })
  {
    c.Filter->SetEyePoint(0, far, far);
    c.Filter->Update();
    EXPECT_EQ(c.Filter->GetErrorCode(), vtkErrorCode::NoError) << c.Errors->Text;
    EXPECT_NEAR(c.Filter->GetVisibleArea(), 2.0 * PI, 1e-2) << far;
  }
  for (const double far : { 1e12, 1e20, 1e200 })
  {
    c.Filter->SetEyePoint(0, far, far);
    EXPECT_TRUE(c.Fails("too far from the origin")) << far << c.Errors->Text;
  }
}

TEST(NURBSVisibleRegionsInput, PrecisionAndAngles)
{
  Case c;
  c.Filter->SetInputData(Shape(vtkNURBSShapeSource::SPHERE));
  for (const double precision : { 0.0, -1e-4, NaN, Infinity, -Infinity })
  {
    c.Filter->SetPrecision(precision);
    EXPECT_TRUE(c.Fails("Precision must be positive")) << precision << c.Errors->Text;
  }
  for (const double precision : { 1e-9, 1e-12, 1e-300 })
  {
    c.Filter->SetPrecision(precision);
    EXPECT_TRUE(c.Fails("finer than 2e-9 of the image's size")) << precision << c.Errors->Text;
    c.Filter->SetPrecisionModeToAbsolute();
    EXPECT_TRUE(c.Fails("finer than 2e-9 of the image's size")) << precision << c.Errors->Text;
    c.Filter->SetPrecisionModeToRelative();
  }
  c.Filter->SetPrecision(1e-4);
  for (const double angle : { 0.0, -30.0, 180.1, NaN })
  {
    c.Filter->SetFeatureAngle(angle);
    EXPECT_TRUE(c.Fails("FeatureAngle must be in (0, 180]")) << angle << c.Errors->Text;
  }
  c.Filter->SetFeatureAngle(180.0);
  // Coarse as can be: what is narrower is left out, nothing else happens.
  for (const double precision : { 1.0, 1e3, 1e300 })
  {
    c.Filter->SetPrecision(precision);
    c.Filter->Update();
    EXPECT_EQ(c.Filter->GetErrorCode(), vtkErrorCode::NoError) << c.Errors->Text;
    EXPECT_LE(c.Filter->GetVisibleArea(), 4.0 * PI + 1e-9);
  }
  c.Filter->SetPrecision(1e-4);
  c.Filter->Update();
  EXPECT_NEAR(c.Filter->GetVisibleArea(), 2.0 * PI, 2e-3);
}

TEST(NURBSVisibleRegionsInput, ModelsThatAreNone)
{
  Case c;
  vtkNew<vtkUnstructuredGrid> other;
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(0, 0, 0);
  other->SetPoints(points);
  const vtkIdType id = 0;
  other->InsertNextCell(VTK_VERTEX, 1, &id);
  c.Filter->SetInputData(other);
  EXPECT_TRUE(c.Fails("is not a NURBS model")) << c.Errors->Text;
  c.Errors->Text.clear();
  vtkNew<vtkUnstructuredGrid> empty;
  c.Run(empty, 0, 0, 1);
  nurbs::ModelBuilder builder;
  c.Run(Grid(builder), 0, 0, 1);
  EXPECT_EQ(c.Errors->Text, "");
  EXPECT_EQ(c.Filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_EQ(Models(c.Filter)->GetNumberOfCells(), 0);
  EXPECT_EQ(c.Filter->GetNumberOfLines(), 0);
  EXPECT_EQ(c.Filter->GetNumberOfFaces(), 0);
}

// Control points that are not numbers in one face.
vtkSmartPointer<vtkUnstructuredGrid> BoxWithABrokenFace(vtkIdType face)
{
  nurbs::ModelBuilder builder;
  AddBox(builder, { 0, 0, 0 }, { 1, 1, 1 });
  auto grid = Grid(builder);
  vtkNew<vtkIdList> ids;
  grid->GetCellPoints(face, ids);
  grid->GetPoints()->SetPoint(ids->GetId(2), NaN, 0, 0);
  grid->GetPoints()->Modified();
  return grid;
}

TEST(NURBSVisibleRegionsInput, FacesThatFail)
{
  Case c;
  c.Run(BoxWithABrokenFace(0), 1, 1, 1);
  EXPECT_EQ(c.Filter->GetErrorCode(), vtkErrorCode::NoError) << c.Errors->Text;
  EXPECT_TRUE(c.Warnings->Says("face 0")) << c.Warnings->Text;
  EXPECT_EQ(c.Filter->GetNumberOfFailedFaces(), 1);
  for (const int face : { 1, 3, 5 })
  {
    EXPECT_NEAR(c.Area(face), 1.0, 1e-9);
  }
  EXPECT_NEAR(c.Filter->GetVisibleArea(), 3.0, 1e-9);
  EXPECT_EQ(vtkNURBSModel::Validate(Models(c.Filter)), "");
  // The lid is missing: half of each of the low sides is seen through the opening.
  c.Run(BoxWithABrokenFace(5), 1, 1, 1);
  EXPECT_TRUE(c.Warnings->Says("face 5")) << c.Warnings->Text;
  const double expected[6] = { 0.5, 1.0, 0.5, 1.0, 0.0, 0.0 };
  for (int face = 0; face < 6; ++face)
  {
    EXPECT_NEAR(c.Area(face), expected[face], 2e-3) << face;
  }
  // All are broken.
  auto grid = BoxWithABrokenFace(0);
  for (vtkIdType k = 0; k < grid->GetNumberOfPoints(); ++k)
  {
    grid->GetPoints()->SetPoint(k, NaN, NaN, NaN);
  }
  c.Run(grid, 1, 1, 1);
  EXPECT_EQ(c.Filter->GetErrorCode(), vtkErrorCode::NoError) << c.Errors->Text;
  EXPECT_EQ(c.Filter->GetNumberOfFailedFaces(), 6);
  EXPECT_EQ(c.Filter->GetNumberOfHiddenFaces(), 6);
  EXPECT_EQ(Models(c.Filter)->GetNumberOfCells(), 0);
}

TEST(NURBSVisibleRegionsInput, PlanesSeenEdgeOn)
{
  nurbs::ModelBuilder builder;
  AddQuad(builder, { 0, 0, 0 }, { 3, 0, 0 }, { 0, 2, 0 }, { 3, 2, 0 });
  auto plane = Grid(builder);
  // Of its outline, 3 by 2, the sides towards the viewer are visible.
  const double views[][4] = { { 1, 0, 0, 2 }, { 0, -1, 0, 3 }, { 1, 1, 0, 5 },
    { -0.3, 0.7, 0, 5 } };
  for (const auto& view : views)
  {
    Case c;
    c.Run(plane, view[0], view[1], view[2]);
    EXPECT_NEAR(c.Length(1), view[3], 1e-2) << view[0] << " " << view[1];
    EXPECT_EQ(c.Errors->Text, "");
    EXPECT_EQ(c.Warnings->Text, "");
    EXPECT_EQ(Models(c.Filter)->GetNumberOfCells(), 0);
    EXPECT_EQ(c.Filter->GetVisibleArea(), 0.0);
    EXPECT_NEAR(c.Length(0) + c.Length(1), 10.0, 1e-9) << view[0] << " " << view[1];
    // All of it is hidden, then.
    c.Filter->SetRegionToHidden();
    c.Filter->Update();
    EXPECT_NEAR(CheckedArea(Models(c.Filter)), 6.0, 1e-9);
  }
  // Before another plane it hides nothing.
  AddQuad(builder, { 0, 0, 0 }, { 3, 0, 0 }, { 0, 2, 0 }, { 3, 2, 0 });
  AddQuad(builder, { -1, -1, -2 }, { -1, 3, -2 }, { -1, -1, 2 }, { -1, 3, 2 });
  Case c;
  c.Run(Grid(builder), 1, 0, 0);
  EXPECT_EQ(c.Area(0), 0.0);
  EXPECT_NEAR(c.Area(1), 16.0, 2e-2);
}

// A point of two faces at one place is visible on one of them.
TEST(NURBSVisibleRegionsInput, FacesAtTheSamePlace)
{
  nurbs::ModelBuilder builder;
  AddQuad(builder, { 0, 0, 0 }, { 3, 0, 0 }, { 0, 2, 0 }, { 3, 2, 0 });
  AddQuad(builder, { 0, 0, 0 }, { 3, 0, 0 }, { 0, 2, 0 }, { 3, 2, 0 });
  AddQuad(builder, { 0, 0, 0 }, { 0, 2, 0 }, { 3, 0, 0 }, { 3, 2, 0 }); // Turned over.
  auto planes = Grid(builder);
  for (const double x : { 0.0, 0.3, -2.0 })
  {
    Case c;
    c.Run(planes, x, 0.2, 1);
    EXPECT_NEAR(c.Filter->GetVisibleArea(), 6.0, 1e-2);
    EXPECT_NEAR(CheckedArea(Models(c.Filter)), 6.0, 1e-2);
  }
  // A solid twice, curved faces.
  auto torus = Shape(vtkNURBSShapeSource::TORUS);
  Case once;
  once.Run(torus, 0.3, -0.9, 0.5);
  vtkNew<vtkUnstructuredGrid> copy;
  copy->DeepCopy(torus);
  vtkNew<vtkPartitionedDataSetCollection> both;
  both->SetPartition(0, 0, torus);
  both->SetPartition(1, 0, copy);
  Case twice;
  twice.Run(both, 0.3, -0.9, 0.5);
  EXPECT_EQ(twice.Errors->Text, "");
  EXPECT_NEAR(twice.Filter->GetVisibleArea(), once.Filter->GetVisibleArea(), 2e-2);
}

TEST(NURBSVisibleRegionsInput, PlanesThatOverlapInOnePlane)
{
  nurbs::ModelBuilder builder;
  AddQuad(builder, { 0, 0, 0 }, { 3, 0, 0 }, { 0, 2, 0 }, { 3, 2, 0 });
  AddQuad(builder, { 1, 1, 0 }, { 5, 1, 0 }, { 1, 5, 0 }, { 5, 5, 0 });
  Case c;
  c.Run(Grid(builder), 0.3, 0.2, 1);
  EXPECT_NEAR(c.Filter->GetVisibleArea(), 6.0 + 16.0 - 2.0, 2e-2);
}

TEST(NURBSVisibleRegionsInput, BoxesThatShareAPlane)
{
  // Side by side: the faces between them are seen from nowhere.
  nurbs::ModelBuilder pair;
  AddBox(pair, { 0, 0, 0 }, { 1, 1, 1 });
  AddBox(pair, { 1, 0, 0 }, { 2, 1, 1 });
  auto boxes = Grid(pair);
  Case c;
  c.Run(boxes, 1, 1, 1);
  for (int face = 0; face < 12; ++face)
  {
    const bool seen = face == 3 || face == 5 || face == 7 || face == 9 || face == 11;
    EXPECT_NEAR(c.Area(face), seen ? 1.0 : 0.0, 2e-3) << face;
  }
  c.Run(boxes, 0, 0, 1);
  EXPECT_NEAR(c.Filter->GetVisibleArea(), 2.0, 2e-3);
  c.Run(boxes, 1, 0, 0);
  EXPECT_NEAR(c.Area(7), 1.0, 2e-3);
  EXPECT_NEAR(c.Filter->GetVisibleArea(), 1.0, 2e-3);
  // A smaller one stands on the other's top, and casts a shadow of 1/2 - 1/4 beside its foot.
  nurbs::ModelBuilder stack;
  AddBox(stack, { 0, 0, 0 }, { 1, 1, 1 });
  AddBox(stack, { 0.25, 0.25, 1 }, { 0.75, 0.75, 2 });
  c.Run(Grid(stack), 1, 1, 1);
  const double expected[12] = { 0, 1, 0, 1, 0, 0.5, 0, 0.5, 0, 0.5, 0, 0.25 };
  for (int face = 0; face < 12; ++face)
  {
    EXPECT_NEAR(c.Area(face), expected[face], 2e-3) << face;
  }
  EXPECT_EQ(vtkNURBSModel::Validate(Models(c.Filter)), "");
}

TEST(NURBSVisibleRegionsInput, FacesThatTouchAlongLines)
{
  // A cylinder touches a plane along x = 1.
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShapeToCylinder();
  source->CappingOff();
  source->Update();
  nurbs::ModelBuilder builder;
  AddQuad(builder, { 1, -2, 0 }, { 1, 2, 0 }, { 1, -2, 2 }, { 1, 2, 2 });
  auto plane = Grid(builder);
  vtkNew<vtkPartitionedDataSetCollection> both;
  both->SetPartition(0, 0, source->GetOutput());
  both->SetPartition(1, 0, plane);
  const auto area = [&](double x, double y) {
    Case c;
    c.Run(both, x, y, 0);
    EXPECT_EQ(c.Errors->Text, "");
    return c.Filter->GetVisibleArea();
  };
  EXPECT_NEAR(area(1, 0), 8.0, 1e-2);
  EXPECT_NEAR(area(-1, 0), 2.0 * PI + 4.0, 1e-2);
  // A wall stands on a floor, and hides as much of it as it is high.
  nurbs::ModelBuilder walls;
  AddQuad(walls, { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 }, { 4, 4, 0 });
  AddQuad(walls, { 1, 2, 0 }, { 3, 2, 0 }, { 1, 2, 1 }, { 3, 2, 1 });
  Case c;
  c.Run(Grid(walls), 0, 1, 1);
  EXPECT_NEAR(c.Area(0), 14.0, 1e-2);
  EXPECT_NEAR(c.Area(1), 2.0, 1e-2);
}

TEST(NURBSVisibleRegionsInput, SizesOfAllKinds)
{
  for (const double size : { 1e-5, 1.0, 1e5, 1e9 })
  {
    nurbs::ModelBuilder builder;
    AddBox(builder, size * Vec3(1, 2, 3), size * Vec3(2, 3, 4));
    Case c;
    c.Run(Grid(builder), 0.3, -0.9, 0.2);
    EXPECT_NEAR(c.Filter->GetVisibleArea() / (size * size), 3.0, 1e-3) << size;
  }
  // A face of no size is skipped over, whatever is said of it.
  nurbs::ModelBuilder point;
  AddBox(point, { 0, 0, 0 }, { 1, 1, 1 });
  AddQuad(point, { 5, 0, 0 }, { 5, 0, 0 }, { 5, 0, 0 }, { 5, 0, 0 });
  Case c;
  c.Run(Grid(point), 0, 0, 1);
  EXPECT_EQ(c.Filter->GetErrorCode(), vtkErrorCode::NoError) << c.Errors->Text;
  EXPECT_NEAR(c.Filter->GetVisibleArea(), 1.0, 1e-3);
  EXPECT_EQ(c.Area(6), 0.0);
  nurbs::ModelBuilder alone;
  AddQuad(alone, { 5, 0, 0 }, { 5, 0, 0 }, { 5, 0, 0 }, { 5, 0, 0 });
  c.Run(Grid(alone), 0, 0, 1);
  EXPECT_EQ(c.Filter->GetVisibleArea(), 0.0);
}

} // namespace
