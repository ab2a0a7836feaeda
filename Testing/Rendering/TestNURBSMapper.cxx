// SPDX-License-Identifier: BSD-3-Clause
// What vtkNURBSMapper takes: composite data sets, far and moved models, models with errors, and what
// it tells: bounds, and cells that are picked.
#include "../testMessageKeeper.h"
#include "vtkCamera.h"
#include "vtkCellData.h"
#include "vtkCellPicker.h"
#include "vtkCompositeDataDisplayAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkHardwareSelector.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkMapperScene.h"
#include "vtkMath.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNURBSCellLocator.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRayReference.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"
#include "vtkSphereSource.h"
#include "vtkTestImage.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <random>

namespace
{

using vtkMapperTest::Compare;
using vtkMapperTest::CountDrawn;
using vtkMapperTest::Difference;
using vtkMapperTest::Shape;
using Grid = vtkSmartPointer<vtkUnstructuredGrid>;
using Picture = vtkSmartPointer<vtkImageData>;

constexpr int Size = 160;

Grid Moved(vtkUnstructuredGrid* model, double x, double y, double z)
{
  auto moved = Grid::New();
  moved->ShallowCopy(model);
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->DeepCopy(model->GetPoints());
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    double p[3];
    points->GetPoint(i, p);
    points->SetPoint(i, p[0] + x, p[1] + y, p[2] + z);
  }
  moved->SetPoints(points);
  return moved;
}

// A sphere and, beside it, a cylinder of three faces.
Grid Sphere()
{
  return Shape(vtkNURBSShapeSource::SPHERE);
}

Grid Cylinder()
{
  return Moved(Shape(vtkNURBSShapeSource::CYLINDER), 2.5, 0.0, -1.0);
}

struct Hit
{
  int Block = -1, Cell = -1;
  bool operator<(const Hit& b) const { return Block != b.Block ? Block < b.Block : Cell < b.Cell; }
};

// Pixels of each block and cell that the selector tells.
std::map<Hit, long> Select(vtkMapperScene& scene)
{
  vtkNew<vtkHardwareSelector> selector;
  selector->SetRenderer(scene.Renderer);
  selector->SetArea(0, 0, Size - 1, Size - 1);
  selector->SetFieldAssociation(vtkDataObject::FIELD_ASSOCIATION_CELLS);
  EXPECT_TRUE(selector->CaptureBuffers());
  std::map<Hit, long> hits;
  for (unsigned int y = 0; y < Size; ++y)
  {
    for (unsigned int x = 0; x < Size; ++x)
    {
      const unsigned int place[2] = { x, y };
      const auto info = selector->GetPixelInformation(place);
      if (info.Valid)
      {
        EXPECT_EQ(info.Prop, scene.Actor.Get());
        ++hits[{ static_cast<int>(info.CompositeID), static_cast<int>(info.AttributeID) }];
      }
    }
  }
  return hits;
}

class Composites : public testing::TestWithParam<bool>
{
protected:
  Composites()
  {
    if (this->GetParam())
    {
      vtkNew<vtkMultiBlockDataSet> blocks;
      blocks->SetBlock(0, this->First);
      blocks->SetBlock(1, this->Second);
      this->Input = blocks;
      this->Index[0] = 1;
      this->Index[1] = 2;
    }
    else
    {
      vtkNew<vtkPartitionedDataSetCollection> parts;
      parts->SetPartition(0, 0, this->First);
      parts->SetPartition(1, 0, this->Second);
      this->Input = parts;
      this->Index[0] = 2;
      this->Index[1] = 4;
    }
    this->Scene.reset(new vtkMapperScene(this->Input));
  }
  Grid First = Sphere(), Second = Cylinder();
  vtkSmartPointer<vtkDataObject> Input;
  int Index[2];
  std::unique_ptr<vtkMapperScene> Scene;
  vtkNew<vtkCompositeDataDisplayAttributes> Attributes;
};

TEST_P(Composites, AreDrawnAsTheirParts)
{
  const Difference d = [this] {
    Picture both = this->Scene->Picture();
    vtkNew<vtkNURBSMapper> first, second;
    first->SetInputData(this->First);
    second->SetInputData(this->Second);
    vtkNew<vtkActor> other;
    other->SetMapper(second);
    this->Scene->Renderer->AddActor(other);
    Picture parts = this->Scene->PictureWith(first);
    this->Scene->Renderer->RemoveActor(other);
    return Compare(both, parts);
  }();
  EXPECT_GT(d.Drawn, 3000);
  EXPECT_LE(d.Mean, 0.01);
  EXPECT_LE(d.Strange, 1);
}

TEST_P(Composites, SelectionTellsBlockAndCell)
{
  this->Scene->Picture();
  const std::map<Hit, long> hits = Select(*this->Scene);
  long inFirst = 0, inSecond = 0;
  for (const auto& [hit, pixels] : hits)
  {
    if (hit.Block == this->Index[0])
    {
      EXPECT_EQ(hit.Cell, 0);
      inFirst += pixels;
    }
    else
    {
      EXPECT_EQ(hit.Block, this->Index[1]);
      EXPECT_LT(hit.Cell, 3);
      inSecond += pixels;
    }
  }
  EXPECT_GT(inFirst, 1000);
  EXPECT_GT(inSecond, 1000);
  EXPECT_EQ(inFirst + inSecond, CountDrawn(this->Scene->Picture()));
}

TEST_P(Composites, BlocksHaveVisibility)
{
  double bounds[6];
  this->Scene->Mapper->GetBounds(bounds);
  const double right = bounds[1]; // 3.5, or a little more
  EXPECT_NEAR(bounds[0], -1.0, 1e-6);
  EXPECT_NEAR(right, 3.5, 0.3);
  const long all = CountDrawn(this->Scene->Picture());
  this->Scene->Mapper->SetCompositeDataDisplayAttributes(this->Attributes);
  this->Attributes->SetBlockVisibility(this->Second, false);
  Picture first = this->Scene->Picture();
  vtkNew<vtkNURBSMapper> alone;
  alone->SetInputData(this->First);
  EXPECT_LT(CountDrawn(first), all - 1000);
  EXPECT_LE(Compare(first, this->Scene->PictureWith(alone)).Strange, 1);
  for (const auto& [hit, pixels] : Select(*this->Scene))
  {
    EXPECT_EQ(hit.Block, this->Index[0]);
  }
  // Bounds are those of what is seen, as vtkCompositePolyDataMapper2's are.
  this->Scene->Mapper->GetBounds(bounds);
  EXPECT_NEAR(bounds[1], 1.0, 1e-6);
  this->Attributes->SetBlockVisibility(this->Second, true);
  EXPECT_EQ(CountDrawn(this->Scene->Picture()), all);
  this->Scene->Mapper->GetBounds(bounds);
  EXPECT_EQ(bounds[1], right);
}

TEST_P(Composites, BlocksHaveColorAndOpacity)
{
  vtkMapperScene& scene = *this->Scene;
  scene.Actor->GetProperty()->LightingOff();
  scene.Actor->GetProperty()->SetColor(1.0, 1.0, 1.0);
  scene.Mapper->SetCompositeDataDisplayAttributes(this->Attributes);
  double red[3] = { 0.8, 0.2, 0.0 };
  this->Attributes->SetBlockColor(this->First, red);
  Picture picture = scene.Picture();
  const long inFirst = Size * Size - vtkTestImage::CountOthers(picture, { 204, 51, 0 });
  const long inSecond = Size * Size - vtkTestImage::CountOthers(picture, { 255, 255, 255 });
  EXPECT_GT(inFirst, 1000);
  EXPECT_GT(inSecond, 1000);
  EXPECT_EQ(inFirst + inSecond, CountDrawn(picture));

  // The second as glass; before the first, whose colour is seen through it.
  EXPECT_FALSE(scene.Actor->HasTranslucentPolygonalGeometry());
  this->Attributes->SetBlockOpacity(this->Second, 0.5);
  EXPECT_TRUE(scene.Actor->HasTranslucentPolygonalGeometry());
  scene.Window->SetAlphaBitPlanes(1);
  scene.Renderer->UseDepthPeelingOn();
  scene.Actor->GetProperty()->BackfaceCullingOn();
  picture = scene.Picture();
  const vtkTestImage::Colour glass = { 140, 153, 178 }; // half white, half background
  EXPECT_NEAR(Size * Size - vtkTestImage::CountOthers(picture, glass, 2), inSecond, inSecond / 20);
  EXPECT_EQ(Size * Size - vtkTestImage::CountOthers(picture, { 204, 51, 0 }), inFirst);
}

TEST_P(Composites, SelectedFacesHaveTheirColor)
{
  vtkMapperScene& scene = *this->Scene;
  scene.Actor->GetProperty()->LightingOff();
  const Hit wanted = Select(scene).rbegin()->first; // of the last block
  const long pixels = Select(scene)[wanted];
  EXPECT_EQ(wanted.Block, this->Index[1]);
  vtkNew<vtkIdTypeArray> cells;
  cells->InsertNextValue(wanted.Cell);
  cells->InsertNextValue(1000000); // which there is not
  vtkNew<vtkSelectionNode> node;
  node->SetFieldType(vtkSelectionNode::CELL);
  node->SetContentType(vtkSelectionNode::INDICES);
  node->SetSelectionList(cells);
  node->GetProperties()->Set(vtkSelectionNode::COMPOSITE_INDEX(), wanted.Block);
  vtkNew<vtkSelection> selection;
  selection->AddNode(node);
  scene.Mapper->SetSelection(selection);
  scene.Mapper->SetSelectedColor(0.8, 0.2, 0.0);
  const auto inColor = [&scene] {
    return Size * Size - vtkTestImage::CountOthers(scene.Picture(), { 204, 51, 0 });
  };
  EXPECT_NEAR(inColor(), pixels, 2);
  selection->RemoveAllNodes();
  EXPECT_EQ(inColor(), 0);
}

INSTANTIATE_TEST_SUITE_P(MultiBlockOrPartitioned, Composites, testing::Bool());

/// Selection against rays.
struct Picked
{
  const char* Name;
  std::function<Grid()> Model;
};

void PrintTo(const Picked& picked, std::ostream* os)
{
  *os << picked.Name;
}

class Selections : public testing::TestWithParam<Picked>
{};

TEST_P(Selections, TellWhatRaysHit)
{
  Grid model = this->GetParam().Model();
  vtkMapperScene scene(model, 200);
  scene.Renderer->GetActiveCamera()->Zoom(2.0);
  scene.Picture();
  const std::vector<int> cells = scene.SelectCells();
  const std::vector<vtkRayReference::Pixel> rays = vtkRayReference(model).Cast(scene.Renderer);
  std::mt19937 random(20240611);
  std::uniform_int_distribution<int> place(1, 198);
  long compared = 0, hits = 0, wrong = 0;
  while (compared < 1000)
  {
    const int k = place(random) + 200 * place(random);
    bool border = false;
    for (const int n : { k - 201, k - 200, k - 199, k - 1, k + 1, k + 199, k + 200, k + 201 })
    {
      border = border || rays[n].Face != rays[k].Face;
    }
    if (!border)
    {
      ++compared;
      hits += rays[k].Face >= 0;
      wrong += cells[k] != rays[k].Face;
    }
  }
  std::printf("%s: %ld of 1000 pixels are the model's, %ld differ from rays\n",
    this->GetParam().Name, hits, wrong);
  EXPECT_GT(hits, 300);
  EXPECT_EQ(wrong, 0);
}

INSTANTIATE_TEST_SUITE_P(Cells, Selections,
  testing::Values(Picked{ "Teapot", [] { return Shape(vtkNURBSShapeSource::TEAPOT); } },
    Picked{ "Cone", [] { return Shape(vtkNURBSShapeSource::CONE); } },
    Picked{ "CarBody", [] { return Shape(vtkNURBSShapeSource::CAR_BODY); } },
    Picked{ "Screw", [] { return vtkMapperTest::CADModel("step/screw.step"); } },
    Picked{ "LinkRods", [] { return vtkMapperTest::CADModel("step/linkrods.step"); } }));

// vtkCellPicker by a ray on the CPU and vtkHardwareSelector by pixels tell the same cells.
TEST(Selection, IsThatOfThePicker)
{
  Grid model = Shape(vtkNURBSShapeSource::TEAPOT);
  vtkMapperScene scene(model);
  scene.Actor->SetPosition(0.3, 0.2, -0.1);
  scene.Renderer->ResetCamera();
  scene.Picture();
  const std::vector<int> cells = scene.SelectCells();
  vtkNew<vtkNURBSCellLocator> locator;
  locator->SetDataSet(model);
  vtkNew<vtkCellPicker> picker;
  picker->AddLocator(locator);
  long picked = 0, wrong = 0;
  for (int y = 2; y < Size - 2; y += 5)
  {
    for (int x = 2; x < Size - 2; x += 5)
    {
      const int k = x + y * Size;
      bool inside = true;
      for (const int n : { k - 1, k + 1, k - Size, k + Size })
      {
        inside = inside && cells[n] == cells[k];
      }
      if (inside)
      {
        const int hit = picker->Pick(x + 0.5, y + 0.5, 0.0, scene.Renderer);
        picked += hit;
        wrong += (hit ? static_cast<int>(picker->GetCellId()) : -1) != cells[k];
        if (hit)
        {
          EXPECT_EQ(picker->GetMapper(), scene.Mapper.Get());
          EXPECT_EQ(picker->GetDataSet(), model.Get());
        }
      }
    }
  }
  EXPECT_GT(picked, 80);
  EXPECT_EQ(wrong, 0);
}

// A selection of the whole window, as ParaView's rubber band makes it.
TEST(Selection, HasANodeOfCells)
{
  vtkMapperScene scene(Shape(vtkNURBSShapeSource::TEAPOT));
  scene.Picture();
  vtkNew<vtkHardwareSelector> selector;
  selector->SetRenderer(scene.Renderer);
  selector->SetArea(0, 0, Size - 1, Size - 1);
  selector->SetFieldAssociation(vtkDataObject::FIELD_ASSOCIATION_CELLS);
  auto selection = vtkSmartPointer<vtkSelection>::Take(selector->Select());
  ASSERT_EQ(selection->GetNumberOfNodes(), 1u);
  vtkSelectionNode* node = selection->GetNode(0);
  EXPECT_EQ(node->GetFieldType(), vtkSelectionNode::CELL);
  auto* ids = vtkIdTypeArray::SafeDownCast(node->GetSelectionList());
  ASSERT_TRUE(ids);
  EXPECT_GT(ids->GetNumberOfTuples(), 10);
  EXPECT_LE(ids->GetNumberOfTuples(), 32);
  EXPECT_LT(ids->GetRange()[1], 32.0);
  EXPECT_GE(ids->GetRange()[0], 0.0);
}

// Far from the origin, by its points or by the actor, a model looks as it does there.
class FarModels : public testing::TestWithParam<int>
{};

TEST_P(FarModels, LookTheSame)
{
  const double far[3] = { 1e7, -2e7, 3e7 };
  Grid model = Shape(this->GetParam());
  const auto look = [&](vtkMapperScene& scene, const double* from) {
    vtkCamera* camera = scene.Renderer->GetActiveCamera();
    camera->SetFocalPoint(from[0], from[1], from[2]);
    camera->SetPosition(from[0] + 3.0, from[1] - 4.0, from[2] + 2.5);
    scene.Renderer->ResetCameraClippingRange();
    camera->SetClippingRange(1.0, 12.0);
    return scene.Picture();
  };
  const double origin[3] = { 0.0, 0.0, 0.0 };
  vtkMapperScene here(model);
  Picture expected = look(here, origin);
  const std::vector<float> depths = here.Depths();
  const auto compare = [&](vtkMapperScene& scene) {
    const Difference d = Compare(expected, look(scene, far));
    const std::vector<float> other = scene.Depths();
    double largest = 0.0;
    for (std::size_t k = 0; k < depths.size(); ++k)
    {
      const bool both = depths[k] < 1.0f && other[k] < 1.0f;
      largest = std::max(largest, both ? std::abs(double(depths[k]) - other[k]) : 0.0);
    }
    std::printf("mean difference %.3f, %ld of %ld pixels strange, depths off by %.2g\n", d.Mean,
      d.Strange, d.Drawn, largest);
    EXPECT_GT(d.Drawn, 2000);
    EXPECT_LE(d.Mean, 0.05);
    EXPECT_LE(d.Strange, d.Drawn / 500);
    EXPECT_LE(largest, 5e-5);
  };
  vtkMapperScene byPoints(Moved(model, far[0], far[1], far[2]));
  compare(byPoints);
  vtkMapperScene byActor(model);
  byActor.Actor->SetPosition(far[0], far[1], far[2]);
  compare(byActor);
}

INSTANTIATE_TEST_SUITE_P(
  Shapes, FarModels, testing::Values(vtkNURBSShapeSource::SPHERE, vtkNURBSShapeSource::TORUS));

TEST(Bounds, AreThoseOfTheSurface)
{
  vtkNew<vtkNURBSMapper> mapper;
  mapper->SetInputData(Shape(vtkNURBSShapeSource::TORUS));
  double bounds[6];
  mapper->GetBounds(bounds);
  const double expected[6] = { -1.3, 1.3, -1.3, 1.3, -0.3, 0.3 };
  for (int i = 0; i < 6; ++i)
  {
    EXPECT_NEAR(bounds[i], expected[i], 1e-6);
  }
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->SetPosition(5.0, 0.0, 0.0);
  EXPECT_NEAR(actor->GetBounds()[1], 6.3, 1e-6);
}

class Messages : public testing::Test
{
protected:
  Messages()
    : Scene(Sphere())
  {
    this->Scene.Mapper->AddObserver(vtkCommand::ErrorEvent, this->Errors);
    this->Scene.Mapper->AddObserver(vtkCommand::WarningEvent, this->Warnings);
    this->Scene.Picture();
  }
  vtkMapperScene Scene;
  vtkNew<MessageKeeper> Errors, Warnings;
};

TEST_F(Messages, NothingIsSaidOfAModel)
{
  EXPECT_EQ(this->Errors->Text, "");
  EXPECT_EQ(this->Warnings->Text, "");
}

TEST_F(Messages, NoInputDrawsNothing)
{
  this->Scene.Mapper->SetInputData(nullptr);
  EXPECT_EQ(CountDrawn(this->Scene.Picture()), 0);
  EXPECT_FALSE(vtkMath::AreBoundsInitialized(this->Scene.Mapper->GetBounds()));
}

TEST_F(Messages, AnEmptyGridDrawsNothing)
{
  this->Scene.Mapper->SetInputData(Grid::New());
  EXPECT_EQ(CountDrawn(this->Scene.Picture()), 0);
  EXPECT_FALSE(vtkMath::AreBoundsInitialized(this->Scene.Mapper->GetBounds()));
}

TEST_F(Messages, AnEmptyCompositeDrawsNothing)
{
  vtkNew<vtkPartitionedDataSetCollection> nothing;
  this->Scene.Mapper->SetInputData(nothing);
  EXPECT_EQ(CountDrawn(this->Scene.Picture()), 0);
  EXPECT_EQ(this->Errors->Text, "");
}

// Points and cells, but no surfaces.
Grid PlainGrid()
{
  auto grid = Grid::New();
  vtkNew<vtkPoints> points;
  for (int i = 0; i < 4; ++i)
  {
    points->InsertNextPoint(i % 2, i / 2, 0.0);
  }
  grid->SetPoints(points);
  const vtkIdType ids[4] = { 0, 1, 3, 2 };
  grid->InsertNextCell(VTK_QUAD, 4, ids);
  return grid;
}

TEST_F(Messages, AGridWithoutSurfacesIsAnErrorToldOnce)
{
  Grid plain = PlainGrid();
  this->Scene.Mapper->SetInputData(plain);
  EXPECT_EQ(CountDrawn(this->Scene.Picture()), 0);
  EXPECT_TRUE(this->Errors->Says("no NURBS model")) << this->Errors->Text;
  this->Errors->Text = "";
  this->Scene.Picture();
  EXPECT_EQ(this->Errors->Text, "") << "again";
  plain->Modified();
  this->Scene.Picture();
  EXPECT_EQ(this->Errors->Text, "") << "again";
}

TEST_F(Messages, AGridWithoutSurfacesIsAnErrorAtFirstToo)
{
  vtkMapperScene scene(PlainGrid());
  vtkNew<MessageKeeper> errors;
  scene.Mapper->AddObserver(vtkCommand::ErrorEvent, errors);
  vtkNew<vtkNURBSMapper> fresh;
  fresh->AddObserver(vtkCommand::ErrorEvent, errors);
  fresh->SetInputData(PlainGrid());
  scene.PictureWith(fresh);
  EXPECT_TRUE(errors->Says("no NURBS model")) << errors->Text;
}

// Arrays of the wrong size can't be read at all.
TEST_F(Messages, AModelThatCannotBeReadIsAnErrorToldOnce)
{
  Grid broken = Sphere();
  vtkNew<vtkIntArray> degree;
  degree->SetName("Degree");
  degree->SetNumberOfComponents(2);
  degree->InsertNextTuple2(400.0, -3.0);
  broken->GetCellData()->AddArray(degree);
  this->Scene.Mapper->SetInputData(broken);
  EXPECT_EQ(CountDrawn(this->Scene.Picture()), 0);
  const std::string said = this->Errors->Text + this->Warnings->Text;
  EXPECT_NE(said.find("cell 0"), std::string::npos) << said;
  this->Errors->Text = this->Warnings->Text = "";
  this->Scene.Picture();
  EXPECT_EQ(this->Errors->Text + this->Warnings->Text, "") << "again";
}

TEST_F(Messages, TooManySpansAreAnErrorToldOnce)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(vtkNURBSShapeSource::SHEET);
  source->SetSheetPoints(65600, 4);
  source->Update();
  this->Scene.Mapper->SetInputData(source->GetOutput());
  EXPECT_EQ(CountDrawn(this->Scene.Picture()), 0);
  EXPECT_TRUE(this->Errors->Says("spans")) << this->Errors->Text;
  this->Errors->Text = "";
  EXPECT_EQ(CountDrawn(this->Scene.Picture()), 0);
  source->GetOutput()->GetPoints()->GetData()->Modified();
  EXPECT_EQ(CountDrawn(this->Scene.Picture()), 0);
  EXPECT_EQ(this->Errors->Text, "") << "again";
  this->Scene.Mapper->SetInputData(Sphere());
  EXPECT_GT(CountDrawn(this->Scene.Picture()), 3000);
}

TEST_F(Messages, AFaceWithAnErrorIsNamedAndTheRestDrawn)
{
  Grid good = Shape(vtkNURBSShapeSource::TEAPOT);
  Grid bad = Moved(good, 0.0, 0.0, 0.0);
  const vtkIdType* ids;
  vtkIdType count;
  bad->GetCellPoints(7, count, ids);
  bad->GetPoints()->SetPoint(ids[5], vtkMath::Nan(), 0.0, 0.0);
  vtkMapperScene scene(good);
  vtkNew<vtkNURBSMapper> mapper;
  vtkNew<MessageKeeper> warnings;
  mapper->AddObserver(vtkCommand::WarningEvent, warnings);
  mapper->SetInputData(good);
  Picture all = scene.PictureWith(mapper);
  EXPECT_EQ(warnings->Text, "");
  // The point of one face becomes NaN under way, and is mended again.
  mapper->SetInputData(bad);
  Picture rest = scene.PictureWith(mapper);
  EXPECT_TRUE(warnings->Says("cell 7")) << warnings->Text;
  const Difference d = Compare(all, rest);
  EXPECT_GT(d.Strange, 50);
  EXPECT_LT(d.Strange, d.Drawn / 2);
  EXPECT_TRUE(vtkMath::AreBoundsInitialized(mapper->GetBounds()));
  EXPECT_FALSE(vtkMath::IsNan(mapper->GetBounds()[0]));
  // Whatever is not cell 7 is as before.
  scene.Actor->SetMapper(mapper);
  const std::vector<int> cells = scene.SelectCells();
  EXPECT_EQ(std::count(cells.begin(), cells.end(), 7), 0);
  mapper->SetInputData(good);
  EXPECT_EQ(Compare(all, scene.Picture()).Strange, 0);
  scene.Actor->SetMapper(scene.Mapper);
}

// Higher degrees than before, through a pipeline: the shader is made anew.
TEST(Changes, ReachTheShader)
{
  vtkNew<vtkNURBSShapeSource> source;
  source->SetShape(vtkNURBSShapeSource::PLATE);
  vtkMapperScene scene(Sphere());
  scene.Mapper->SetInputConnection(source->GetOutputPort());
  scene.Picture();
  source->SetShape(vtkNURBSShapeSource::SHEET);
  source->SetSheetDegree(9, 9);
  source->SetSheetPoints(12, 12);
  scene.Renderer->ResetCamera();
  scene.Picture();
  vtkNew<vtkNURBSMapper> fresh;
  fresh->SetInputConnection(source->GetOutputPort());
  Picture changed = scene.Picture();
  const Difference d = Compare(changed, scene.PictureWith(fresh));
  EXPECT_GT(d.Drawn, 2000);
  EXPECT_EQ(d.Strange, 0);
}

// Only what moved is sent and evaluated again.
TEST(MovedPoints, AreSentAlone)
{
  Grid model = Shape(vtkNURBSShapeSource::TEAPOT);
  vtkMapperScene scene(model);
  scene.Picture();
  vtkNURBSMapper* mapper = scene.Mapper;
  const vtkIdType allBytes = mapper->GetNumberOfBytesSent();
  const vtkIdType allVertices = mapper->GetNumberOfEvaluatedVertices();
  scene.Picture();
  EXPECT_EQ(mapper->GetNumberOfBytesSent(), allBytes) << "an unchanged frame sends nothing";
  EXPECT_EQ(mapper->GetNumberOfEvaluatedVertices(), allVertices);

  const vtkIdType* ids;
  vtkIdType count;
  model->GetCellPoints(3, count, ids);
  double p[3];
  model->GetPoints()->GetPoint(ids[5], p);
  model->GetPoints()->SetPoint(ids[5], p[0] + 0.05, p[1] - 0.05, p[2] + 0.1);
  model->GetPoints()->GetData()->Modified();
  Picture moved = scene.Picture();
  const vtkIdType bytes = mapper->GetNumberOfBytesSent() - allBytes;
  const vtkIdType vertices = mapper->GetNumberOfEvaluatedVertices() - allVertices;
  std::printf("teapot: %lld bytes and %lld vertices at first, %lld and %lld for one face\n",
    static_cast<long long>(allBytes), static_cast<long long>(allVertices),
    static_cast<long long>(bytes), static_cast<long long>(vertices));
  EXPECT_GT(vertices, 0);
  EXPECT_LE(vertices, allVertices / 4);
  // 16 points and an origin of 16 and 32 bytes; the rest is the list of tiles and those to evaluate.
  EXPECT_GE(bytes, 16 * 16 + 32);
  EXPECT_LE(bytes, allBytes / 3);

  vtkNew<vtkNURBSMapper> fresh;
  fresh->SetInputData(model);
  const Difference d = Compare(moved, scene.PictureWith(fresh));
  EXPECT_EQ(d.Strange, 0);
  EXPECT_EQ(d.Mean, 0.0);
}

// New trims are sent, and nothing is evaluated for them.
TEST(MovedTrims, AreSentAlone)
{
  Grid model = Shape(vtkNURBSShapeSource::PLATE);
  vtkMapperScene scene(model);
  scene.Picture();
  vtkNURBSMapper* mapper = scene.Mapper;
  const vtkIdType allBytes = mapper->GetNumberOfBytesSent();
  const vtkIdType allVertices = mapper->GetNumberOfEvaluatedVertices();
  // Holes move a little; the outline stays.
  vtkDataArray* points = model->GetFieldData()->GetArray("TrimPoints");
  vtkDataArray* starts = model->GetFieldData()->GetArray("TrimCurvePointStart");
  for (vtkIdType i = static_cast<vtkIdType>(starts->GetTuple1(4)); i < points->GetNumberOfTuples();
       ++i)
  {
    points->SetComponent(i, 1, points->GetComponent(i, 1) + 0.02);
  }
  points->Modified();
  Picture moved = scene.Picture();
  EXPECT_GT(mapper->GetNumberOfBytesSent(), allBytes);
  EXPECT_LT(mapper->GetNumberOfBytesSent() - allBytes, allBytes);
  EXPECT_EQ(mapper->GetNumberOfEvaluatedVertices(), allVertices);
  vtkNew<vtkNURBSMapper> fresh;
  fresh->SetInputData(model);
  EXPECT_EQ(Compare(moved, scene.PictureWith(fresh)).Mean, 0.0);
}

} // namespace
