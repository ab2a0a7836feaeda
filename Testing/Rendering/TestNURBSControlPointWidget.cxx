// SPDX-License-Identifier: BSD-3-Clause
// Mouse and keys on control points, against closed forms of the camera.
#include "vtkWidgetScene.h"

#include "Surface.h"
#include "vtkCellData.h"
#include "vtkFieldData.h"
#include "vtkNURBSModel.h"
#include "vtkNURBSModelView.h"
#include "vtkPartitionedDataSetCollection.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>

namespace
{

using nurbs::Vec2;
using nurbs::Vec3;
using Representation = vtkNURBSControlPointRepresentation;

constexpr vtkIdType Middle = 14; // A control point of the 6 x 6 sheet.

vtkSmartPointer<vtkUnstructuredGrid> Sheet(int points = 6, double height = 5.0)
{
  return vtkWidgetShape(vtkNURBSShapeSource::SHEET, points, height);
}

TEST(ControlPointWidget, ClicksSelect)
{
  vtkWidgetScene scene(Sheet());
  Representation* handles = scene.Handles();
  EXPECT_EQ(handles->GetNumberOfHandles(), 36);
  scene.Click(scene.PixelOf(scene.Before(7)));
  ASSERT_EQ(handles->GetNumberOfSelectedControlPoints(), 1);
  EXPECT_EQ(handles->GetSelectedControlPoint(0), 7);
  scene.Click(scene.PixelOf(scene.Before(Middle)));
  ASSERT_EQ(handles->GetNumberOfSelectedControlPoints(), 1) << "without Shift only this one";
  EXPECT_EQ(handles->GetSelectedControlPoint(0), Middle);
  scene.Click(scene.PixelOf(scene.Before(20)), true);
  scene.Click(scene.PixelOf(scene.Before(21)), false, true);
  ASSERT_EQ(handles->GetNumberOfSelectedControlPoints(), 3);
  scene.Click(scene.PixelOf(scene.Before(20)), true);
  EXPECT_EQ(handles->GetNumberOfSelectedControlPoints(), 3) << "Shift does not take away";
  scene.Click(scene.PixelOf(scene.Before(20)), false, true);
  ASSERT_EQ(handles->GetNumberOfSelectedControlPoints(), 2) << "Ctrl does";
  EXPECT_FALSE(handles->IsSelected(0, 20));
  scene.Click(scene.PixelOf(scene.Before(21)));
  ASSERT_EQ(handles->GetNumberOfSelectedControlPoints(), 1) << "one of several clicked: only it";
  EXPECT_EQ(handles->GetSelectedControlPoint(0), 21);
  scene.Key("Escape");
  EXPECT_EQ(handles->GetNumberOfSelectedControlPoints(), 0);
  EXPECT_EQ(scene.Edits->GetNumberOfEdits(), 0) << "clicks move nothing";
  EXPECT_EQ(scene.Edits->GetNumberOfUndos(), 0);
  EXPECT_GT(scene.Events[vtkCommand::SelectionChangedEvent], 6);
}

TEST(ControlPointWidget, ADragFollowsTheCursor)
{
  for (const bool parallel : { true, false })
  {
    vtkWidgetScene scene(Sheet(), parallel);
    const Vec2 start = scene.PixelOf(scene.Before(Middle));
    const double size = scene.PixelSize(scene.Before(Middle));
    scene.Move(start);
    scene.Press(start);
    scene.Move(start + Vec2(3, 1));
    scene.Move(start + Vec2(37, -19));
    const Vec3 expected = scene.Before(Middle) + size * (37.0 * scene.Right() - 19.0 * scene.Up());
    EXPECT_LT((scene.Now(Middle) - expected).norm(), 1e-9 * 100.0) << "parallel: " << parallel;
    scene.Release(start + Vec2(37, -19));
    scene.Move(start + Vec2(60, 60));
    EXPECT_LT((scene.Now(Middle) - expected).norm(), 1e-9 * 100.0) << "the drag is over";
    for (vtkIdType k = 0; k < 36; ++k)
    {
      EXPECT_EQ(scene.Now(k) == scene.Before(k), k != Middle);
    }
    EXPECT_EQ(scene.Events[vtkCommand::StartInteractionEvent], 1);
    EXPECT_EQ(scene.Events[vtkCommand::InteractionEvent], 2);
    EXPECT_EQ(scene.Events[vtkCommand::EndInteractionEvent], 1);
    EXPECT_EQ(scene.Edits->GetNumberOfUndos(), 1) << "one step for the whole drag";
    EXPECT_EQ(scene.Errors->Text, "");
  }
}

// A drag that is long, or goes out and back, ends where it should to the last bit.
TEST(ControlPointWidget, ADragDoesNotDrift)
{
  vtkWidgetScene scene(Sheet(), false);
  const Vec2 start = scene.PixelOf(scene.Before(Middle));
  scene.Move(start);
  scene.Press(start);
  for (int k = 0; k < 60; ++k)
  {
    scene.Move(start + Vec2(k % 17, k % 23));
  }
  scene.Move(start);
  EXPECT_LT((scene.Now(Middle) - scene.Before(Middle)).norm(), 1e-12 * 100.0);
  scene.Release(start);
}

TEST(ControlPointWidget, TheSelectionMovesAsOne)
{
  vtkWidgetScene scene(Sheet(), false);
  Representation* handles = scene.Handles();
  for (const vtkIdType point : { 7, 8, 15 })
  {
    ASSERT_TRUE(handles->SelectControlPoint(0, point));
  }
  EXPECT_FALSE(handles->SelectControlPoint(0, 36));
  const Vec2 start = scene.PixelOf(scene.Before(8));
  scene.Move(start);
  scene.Press(start);
  scene.Move(start + Vec2(10, 10));
  scene.Release(start + Vec2(10, 10));
  const Vec3 moved = scene.Now(8) - scene.Before(8);
  EXPECT_NEAR(moved.norm(), 10.0 * std::sqrt(2.0) * scene.PixelSize(scene.Before(8)), 1e-9);
  for (const vtkIdType point : { 7, 15 })
  {
    EXPECT_LT((scene.Now(point) - scene.Before(point) - moved).norm(), 1e-12 * 100.0);
  }
  EXPECT_EQ(scene.Edits->GetNumberOfEdits(), 3);
  EXPECT_EQ(handles->GetNumberOfSelectedControlPoints(), 3);
}

TEST(ControlPointWidget, AlongAnAxis)
{
  vtkWidgetScene scene(Sheet());
  const Vec2 start = scene.PixelOf(scene.Before(Middle));
  const double size = scene.PixelSize(scene.Before(Middle));
  const Vec3 wanted = size * (21.0 * scene.Right() + 33.0 * scene.Up());
  scene.Move(start);
  scene.Press(start);
  scene.Move(start + Vec2(21, 33));
  const char* const keys[] = { "x", "Y", "z" };
  for (int axis = 0; axis < 3; ++axis)
  {
    scene.Key(keys[axis], axis == 1);
    // In parallel projection: the shadow of the cursor's way on the axis as the viewer sees it.
    const Vec3 direction = Vec3::Unit(axis);
    const Vec3 seen = direction - direction.dot(scene.Ahead()) * scene.Ahead();
    const double way = wanted.dot(seen) / seen.squaredNorm();
    EXPECT_LT((scene.Now(Middle) - scene.Before(Middle) - way * direction).norm(), 1e-9 * 100.0);
    EXPECT_GT(std::abs(way), size);
  }
  scene.Key("v");
  EXPECT_LT((scene.Now(Middle) - scene.Before(Middle) - wanted).norm(), 1e-9 * 100.0);
  scene.Key("z");
  scene.Release(start + Vec2(21, 33));
  EXPECT_EQ(scene.Handles()->GetConstraint(), Representation::VIEW_PLANE)
    << "keys hold for one drag";
  EXPECT_EQ(scene.Now(Middle)[0], scene.Before(Middle)[0]);
  scene.Key("x");
  EXPECT_EQ(scene.Handles()->GetConstraint(), Representation::VIEW_PLANE) << "no drag, no effect";
}

TEST(ControlPointWidget, AlongAnAxisInPerspective)
{
  vtkWidgetScene scene(Sheet(), false);
  scene.Handles()->SetConstraint(Representation::Z_AXIS);
  const Vec2 start = scene.PixelOf(scene.Before(Middle));
  scene.Move(start);
  scene.Press(start);
  scene.Move(start + Vec2(4, 40));
  scene.Release(start + Vec2(4, 40));
  EXPECT_EQ(scene.Handles()->GetConstraint(), Representation::Z_AXIS) << "set, not by a key";
  const Vec3 moved = scene.Now(Middle) - scene.Before(Middle);
  EXPECT_LT(moved.head<2>().norm(), 1e-12);
  // Nearest to the cursor's line of sight, but for how far off the handle it was grabbed.
  const Vec3 eye(scene.Renderer->GetActiveCamera()->GetPosition());
  const auto distance = [&](const Vec2& pixel, double z) {
    scene.Renderer->SetDisplayPoint(pixel[0], pixel[1], 0.5);
    scene.Renderer->DisplayToWorld();
    const Vec3 beyond =
      Eigen::Map<const nurbs::Vec4>(scene.Renderer->GetWorldPoint()).hnormalized();
    const Vec3 point = scene.Before(Middle) + z * Vec3::UnitZ();
    return (point - eye).cross((beyond - eye).normalized()).norm();
  };
  const Vec2 grabbed = start - scene.DisplayOf(scene.Before(Middle)).head<2>();
  const Vec2 target = start + Vec2(4, 40) - grabbed;
  const double best = distance(target, moved[2]);
  EXPECT_LT(best, distance(target, moved[2] + 1e-3));
  EXPECT_LT(best, distance(target, moved[2] - 1e-3));
  EXPECT_GT(moved[2], 10.0 * scene.PixelSize(scene.Before(Middle)));
}

TEST(ControlPointWidget, AnAxisSeenEndOnMovesNothing)
{
  vtkWidgetScene scene(Sheet());
  vtkCamera* camera = scene.Renderer->GetActiveCamera();
  camera->SetPosition(50, 50, 500);
  camera->SetFocalPoint(50, 50, 0);
  camera->SetViewUp(0, 1, 0);
  scene.Renderer->ResetCamera();
  const Vec2 start = scene.PixelOf(scene.Before(Middle));
  scene.Move(start);
  scene.Press(start);
  scene.Move(start + Vec2(20, 20));
  scene.Key("z");
  EXPECT_EQ(scene.Now(Middle), scene.Before(Middle));
  scene.Release(start + Vec2(20, 20));
}

// A handle that leaves the depths that the camera shows is not lost.
TEST(ControlPointWidget, ClippingFollows)
{
  vtkWidgetScene scene(Sheet(6, 0.0));
  vtkCamera* camera = scene.Renderer->GetActiveCamera();
  const double before = camera->GetClippingRange()[1];
  scene.Handles()->SetConstraint(Representation::Y_AXIS);
  const Vec2 start = scene.PixelOf(scene.Before(Middle));
  scene.Move(start);
  scene.Press(start);
  for (int k = 1; k <= 20; ++k)
  {
    scene.Move(start + k * Vec2(5, 4));
  }
  double display[3];
  EXPECT_TRUE(scene.Handles()->GetHandleDisplayPosition(0, Middle, display));
  EXPECT_GT(camera->GetClippingRange()[1], before);
  scene.Release(start + Vec2(100, 80));
}

TEST(ControlPointWidget, AlongTheNormal)
{
  // On a sphere the normal is the direction from the centre to the surface's point.
  auto sphere = vtkWidgetShape(vtkNURBSShapeSource::SPHERE);
  vtkWidgetScene scene(sphere, false);
  const auto view = vtkNURBSModel::View(sphere);
  const nurbs::SurfaceView& s = view->GetModel().Faces[0].Geometry;
  int dragged = 0;
  for (const vtkIdType point : { 12, 21, 29, 33 })
  {
    double greville[2];
    const vtkIdType index[2] = { point % s.Count[0], point / s.Count[0] };
    for (int d = 0; d < 2; ++d)
    {
      ASSERT_EQ(s.Degree[d], 2);
      greville[d] = 0.5 * (s.Knots[d][index[d] + 1] + s.Knots[d][index[d] + 2]);
    }
    const Vec3 normal = nurbs::Evaluate(s, greville[0], greville[1]).normalized();
    const Vec2 start = scene.PixelOf(scene.Before(point));
    scene.Handles()->SetHiddenHandles(Representation::SHOW);
    scene.Move(start);
    if (scene.Handles()->GetHoveredControlPoint() != point)
    {
      continue; // Covered by a handle before it.
    }
    scene.Press(start);
    scene.Key("n");
    scene.Move(start + Vec2(9, 5));
    const Vec3 moved = scene.Now(point) - scene.Before(point);
    EXPECT_GT(std::abs(moved.dot(normal)), 1e-3);
    EXPECT_LT(moved.cross(normal).norm(), 1e-9 * moved.norm());
    // Half way, the normal is still that of the start.
    scene.Move(start + Vec2(-9, 2));
    EXPECT_LT((scene.Now(point) - scene.Before(point)).cross(normal).norm(), 1e-9);
    scene.Key("Escape");
    EXPECT_EQ(scene.Now(point), scene.Before(point));
    ++dragged;
  }
  EXPECT_GE(dragged, 2);
}

TEST(ControlPointWidget, EscapeUndoRedo)
{
  vtkWidgetScene scene(Sheet());
  const auto drag = [&](const Vec2& by) {
    const Vec2 start = scene.PixelOf(scene.Now(Middle));
    scene.Move(start);
    scene.Press(start);
    scene.Move(start + by);
    return Vec2(start + by);
  };
  scene.Release(drag(Vec2(10, 0)));
  const Vec3 first = scene.Now(Middle);
  EXPECT_NE(first, scene.Before(Middle));

  const Vec2 end = drag(Vec2(0, 30));
  EXPECT_NE(scene.Now(Middle), first);
  scene.Key("Escape");
  EXPECT_EQ(scene.Now(Middle), first);
  EXPECT_EQ(scene.Events[vtkCommand::EndInteractionEvent], 2);
  scene.Move(end + Vec2(30, 0));
  EXPECT_EQ(scene.Now(Middle), first) << "the button is still down, but the drag is over";
  scene.Release(end);
  EXPECT_EQ(scene.Edits->GetNumberOfUndos(), 1);

  scene.Release(drag(Vec2(0, 20)));
  const Vec3 second = scene.Now(Middle);
  scene.Key("z", false, true);
  EXPECT_EQ(scene.Now(Middle), first);
  scene.Key("z", false, true);
  EXPECT_EQ(scene.Now(Middle), scene.Before(Middle));
  scene.Key("z", false, true);
  EXPECT_EQ(scene.Now(Middle), scene.Before(Middle)) << "nothing left to undo";
  scene.Key("y", false, true);
  EXPECT_EQ(scene.Now(Middle), first);
  scene.Key("Z", true, true);
  EXPECT_EQ(scene.Now(Middle), second);
  drag(Vec2(20, 0));
  scene.Key("z", false, true);
  EXPECT_EQ(scene.Now(Middle), second) << "Ctrl+Z takes the drag back that is under way";
}

TEST(ControlPointWidget, WheelAndKeysChangeWeights)
{
  vtkWidgetScene scene(Sheet());
  scene.Widget->SetWeightFactor(1.25);
  const Vec2 at = scene.PixelOf(scene.Before(Middle));
  const Vec2 away = scene.PixelOf(scene.Before(0));
  vtkCamera* camera = scene.Renderer->GetActiveCamera();
  const double scale = camera->GetParallelScale();
  scene.Send(vtkCommand::MouseWheelForwardEvent, at);
  EXPECT_NE(camera->GetParallelScale(), scale) << "nothing is selected: the style zooms";
  EXPECT_EQ(scene.Weight(Middle), 1.0);
  camera->SetParallelScale(scale);

  scene.Click(at);
  scene.Send(vtkCommand::MouseWheelForwardEvent, at);
  scene.Send(vtkCommand::MouseWheelForwardEvent, at);
  EXPECT_EQ(camera->GetParallelScale(), scale);
  EXPECT_DOUBLE_EQ(scene.Weight(Middle), 1.25 * 1.25);
  scene.Send(vtkCommand::MouseWheelBackwardEvent, at);
  EXPECT_DOUBLE_EQ(scene.Weight(Middle), 1.25);
  scene.Key("minus");
  scene.Key("KP_Subtract");
  EXPECT_DOUBLE_EQ(scene.Weight(Middle), 0.8);
  scene.Key("plus", true);
  scene.Key("z", false, true);
  EXPECT_DOUBLE_EQ(scene.Weight(Middle), 0.8) << "steps can be undone one by one";
  scene.Send(vtkCommand::MouseWheelForwardEvent, away);
  EXPECT_NE(camera->GetParallelScale(), scale) << "not over a selected handle";
  EXPECT_DOUBLE_EQ(scene.Weight(Middle), 0.8);
  EXPECT_EQ(scene.Weight(0), 1.0);
  EXPECT_EQ(scene.Now(Middle), scene.Before(Middle));
}

TEST(ControlPointWidget, ARefusedWeightLeavesTheOld)
{
  vtkWidgetScene scene(Sheet());
  scene.Edits->SetControlPointWeight(Middle, 1e307);
  scene.Widget->SetWeightFactor(100.0);
  scene.Click(scene.PixelOf(scene.Before(Middle)));
  scene.Key("plus");
  EXPECT_TRUE(scene.Errors->Says("control point 14 (of cell 0, FaceId "));
  EXPECT_EQ(scene.Weight(Middle), 1e307);
  scene.Key("minus");
  EXPECT_DOUBLE_EQ(scene.Weight(Middle), 1e305);
}

TEST(ControlPointWidget, ABoxSelects)
{
  vtkWidgetScene scene(Sheet());
  const Vec3 camera(scene.Renderer->GetActiveCamera()->GetPosition());
  const Vec2 low(3, 3), high(vtkWidgetScene::Width * 0.55, vtkWidgetScene::Height * 0.6);
  scene.Move(low);
  scene.Press(low, false, true);
  scene.Move(high);
  scene.Release(high);
  vtkIdType inside = 0;
  for (vtkIdType k = 0; k < 36; ++k)
  {
    const Vec3 at = scene.DisplayOf(scene.Before(k));
    const bool in = at[0] >= low[0] && at[0] <= high[0] && at[1] >= low[1] && at[1] <= high[1];
    inside += in;
    EXPECT_EQ(scene.Handles()->IsSelected(0, k), in) << k;
  }
  EXPECT_GT(inside, 4);
  EXPECT_LT(inside, 32);
  EXPECT_EQ(Vec3(scene.Renderer->GetActiveCamera()->GetPosition()), camera);
  scene.Handles()->SelectAll();
  EXPECT_EQ(scene.Handles()->GetNumberOfSelectedControlPoints(), 36);

  // Escape leaves the selection as it was.
  scene.Key("Escape");
  scene.Press(low, false, true);
  scene.Move(high);
  scene.Key("Escape");
  scene.Release(high);
  EXPECT_EQ(scene.Handles()->GetNumberOfSelectedControlPoints(), 0);
}

TEST(ControlPointWidget, ElsewhereTheStyleTurnsTheCamera)
{
  vtkWidgetScene scene(Sheet());
  const auto place = [&]() { return Vec3(scene.Renderer->GetActiveCamera()->GetPosition()); };
  const Vec3 before = place();
  const Vec2 start = scene.PixelOf(scene.Before(Middle));
  scene.Move(start);
  scene.Press(start);
  scene.Move(start + Vec2(25, 5));
  scene.Release(start + Vec2(25, 5));
  EXPECT_EQ(place(), before) << "a drag of a handle is no turn of the camera";
  scene.Press(Vec2(2, 2));
  scene.Move(Vec2(22, 12));
  scene.Release(Vec2(22, 12));
  EXPECT_NE(place(), before);
}

TEST(ControlPointWidget, OffIsOff)
{
  vtkWidgetScene scene(Sheet());
  const Vec2 start = scene.PixelOf(scene.Before(Middle));
  scene.Move(start);
  scene.Press(start);
  scene.Move(start + Vec2(12, 0));
  scene.Widget->Off();
  EXPECT_EQ(scene.Events[vtkCommand::EndInteractionEvent], 1);
  const Vec3 place = scene.Now(Middle);
  EXPECT_NE(place, scene.Before(Middle));
  scene.Move(start + Vec2(50, 0));
  scene.Release(start + Vec2(50, 0));
  EXPECT_EQ(scene.Now(Middle), place);
  scene.Click(scene.PixelOf(scene.Before(3)));
  EXPECT_FALSE(scene.Handles()->IsSelected(0, 3));

  scene.Widget->SetCurrentRenderer(scene.Renderer);
  scene.Widget->On();
  scene.Widget->ProcessEventsOff();
  scene.Click(scene.PixelOf(scene.Before(3)));
  EXPECT_FALSE(scene.Handles()->IsSelected(0, 3));
  scene.Widget->ProcessEventsOn();
  scene.Window->Render();
  scene.Click(scene.PixelOf(scene.Before(3)));
  EXPECT_TRUE(scene.Handles()->IsSelected(0, 3));
}

TEST(ControlPointWidget, DeletedInTheMiddleOfADrag)
{
  vtkWidgetScene scene(Sheet());
  scene.Widget->Off();
  auto widget = vtkSmartPointer<vtkNURBSControlPointWidget>::New();
  widget->SetInteractor(scene.Interactor);
  widget->SetCurrentRenderer(scene.Renderer);
  widget->SetEdits(scene.Edits);
  widget->On();
  scene.Window->Render();
  const Vec2 start = scene.PixelOf(scene.Before(Middle));
  scene.Move(start);
  scene.Press(start);
  scene.Move(start + Vec2(12, 0));
  EXPECT_EQ(scene.Edits->GetNumberOfEdits(), 1);
  widget = nullptr;
  EXPECT_EQ(scene.Edits->GetNumberOfEdits(), 0) << "an unfinished drag is taken back";
  scene.Release(start);
  const Vec3 before(scene.Renderer->GetActiveCamera()->GetPosition());
  scene.Press(Vec2(2, 2));
  scene.Move(Vec2(22, 12));
  scene.Release(Vec2(22, 12));
  EXPECT_NE(Vec3(scene.Renderer->GetActiveCamera()->GetPosition()), before)
    << "events go to the others again";
}

TEST(ControlPointWidget, OneOfTwoRenderers)
{
  vtkWidgetScene scene(Sheet(), false);
  vtkNew<vtkRenderer> other;
  other->SetViewport(0.0, 0.0, 0.4, 1.0);
  other->AddActor(scene.Actor);
  scene.Window->AddRenderer(other);
  scene.Renderer->SetViewport(0.4, 0.25, 1.0, 1.0);
  scene.Renderer->ResetCamera();
  other->GetActiveCamera()->DeepCopy(scene.Renderer->GetActiveCamera());
  scene.Window->Render();
  const Vec2 start = scene.PixelOf(scene.Before(Middle));
  EXPECT_GT(start[0], 0.4 * vtkWidgetScene::Width);
  scene.Move(start);
  EXPECT_EQ(scene.Handles()->GetHoveredControlPoint(), Middle);
  scene.Press(start);
  scene.Move(start + Vec2(15, 15));
  scene.Release(start + Vec2(15, 15));
  const double size = scene.PixelSize(scene.Before(Middle));
  EXPECT_LT(
    (scene.Now(Middle) - scene.Before(Middle) - 15.0 * size * (scene.Right() + scene.Up())).norm(),
    1e-9 * 100.0);

  // The same control point as the other renderer shows it.
  vtkIdType undos = scene.Edits->GetNumberOfUndos();
  other->SetWorldPoint(scene.Before(3)[0], scene.Before(3)[1], scene.Before(3)[2], 1.0);
  other->WorldToDisplay();
  const Vec2 there = Vec2(other->GetDisplayPoint()).array().round().matrix();
  scene.Move(there);
  EXPECT_EQ(scene.Handles()->GetHoveredControlPoint(), -1);
  scene.Click(there);
  scene.Key("z", false, true);
  EXPECT_FALSE(scene.Handles()->IsSelected(0, 3));
  EXPECT_EQ(scene.Edits->GetNumberOfUndos(), undos) << "keys there are not ours either";
}

TEST(ControlPointWidget, TwoModelsOfAnAssembly)
{
  vtkNew<vtkPartitionedDataSetCollection> assembly;
  auto second = Sheet();
  for (vtkIdType k = 0; k < second->GetNumberOfPoints(); ++k)
  {
    const Vec3 place = Vec3(second->GetPoint(k)) + Vec3(0, 0, 40);
    second->GetPoints()->SetPoint(k, place.data());
  }
  assembly->SetNumberOfPartitions(0, 1);
  assembly->SetNumberOfPartitions(1, 1);
  assembly->SetPartition(0, 0, Sheet());
  assembly->SetPartition(1, 0, second);
  const unsigned int block = assembly->GetCompositeIndex(1, 0);
  vtkWidgetScene scene(assembly, false);
  EXPECT_EQ(scene.Handles()->GetNumberOfHandles(), 72);
  const Vec3 before(second->GetPoint(Middle));
  const Vec2 start = scene.PixelOf(before);
  scene.Move(start);
  EXPECT_EQ(scene.Handles()->GetHoveredBlock(), block);
  EXPECT_EQ(scene.Handles()->GetHoveredControlPoint(), Middle);
  ASSERT_TRUE(scene.Handles()->SelectControlPoint(assembly->GetCompositeIndex(0, 0), 3));
  scene.Press(start, true);
  scene.Move(start + Vec2(10, 0));
  scene.Release(start + Vec2(10, 0));
  double place[3];
  ASSERT_TRUE(scene.Edits->GetBlockControlPoint(block, Middle, place));
  const Vec3 moved = 10.0 * scene.PixelSize(before) * scene.Right();
  EXPECT_LT((Vec3(place) - before - moved).norm(), 1e-9 * 100.0);
  EXPECT_LT((scene.Now(3) - scene.Before(3) - moved).norm(), 1e-9 * 100.0) << "the other block's";
  EXPECT_TRUE(scene.Edits->Undo());
  EXPECT_EQ(scene.Edits->GetNumberOfEdits(), 0) << "one step for both blocks";
}

TEST(ControlPointWidget, TheRightOneAmongTenThousand)
{
  auto sheet = Sheet(100);
  vtkWidgetScene scene(sheet, false);
  // Near, so that handles do not cover each other everywhere.
  scene.Renderer->GetActiveCamera()->Zoom(6.0);
  scene.Window->Render();
  scene.Handles()->SetHiddenHandles(Representation::SHOW);
  scene.Handles()->SetPickRadius(4.0);
  std::vector<Vec3> displays;
  for (vtkIdType k = 0; k < sheet->GetNumberOfPoints(); ++k)
  {
    displays.push_back(scene.DisplayOf(Vec3(sheet->GetPoint(k))));
  }
  std::mt19937 random(3);
  int found = 0, none = 0;
  double seconds = 0.0;
  for (int k = 0; k < 300; ++k)
  {
    const Vec2 at(int(random() % vtkWidgetScene::Width), int(random() % vtkWidgetScene::Height));
    double nearest = 1e300;
    for (const Vec3& display : displays)
    {
      nearest = std::min(nearest, (display.head<2>() - at).norm());
    }
    const auto start = std::chrono::steady_clock::now();
    const bool hit = scene.Handles()->Pick(at[0], at[1]);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ASSERT_EQ(hit, nearest <= scene.Handles()->GetPickRadius());
    if (!hit)
    {
      ++none;
      continue;
    }
    ++found;
    const Vec3 picked = displays[std::size_t(scene.Handles()->GetHoveredControlPoint())];
    EXPECT_LE((picked.head<2>() - at).norm(), nearest + 1.5);
    for (const Vec3& display : displays)
    {
      const double distance = (display.head<2>() - at).norm();
      if (distance <= std::min(nearest + 1.4999, scene.Handles()->GetPickRadius()))
      {
        EXPECT_LE(picked[2], display[2] + 1e-12) << "one before it was nearer to the viewer";
      }
    }
  }
  EXPECT_GT(found, 100);
  EXPECT_GT(none, 10);
  std::printf("a pick among 10,000 handles: %.2f ms\n", 1e3 * seconds / 300.0);
}

TEST(ControlPointWidget, AMillionHandles)
{
  using std::chrono::steady_clock;
  const auto milliseconds = [](steady_clock::time_point from) {
    return 1e3 * std::chrono::duration<double>(steady_clock::now() - from).count();
  };
  vtkWidgetScene scene(Sheet(), false); // For its camera: a million discs take seconds to draw.
  vtkNew<vtkNURBSControlPointEdits> edits;
  edits->SetInputDataObject(Sheet(1000));
  vtkNew<Representation> handles;
  handles->SetRenderer(scene.Renderer);
  handles->SetEdits(edits);
  EXPECT_EQ(handles->GetNumberOfHandles(), 1000000);
  auto start = steady_clock::now();
  for (int k = 0; k < 10; ++k)
  {
    EXPECT_TRUE(handles->Pick(150 + k, 100));
  }
  const double pick = milliseconds(start) / 10.0;
  EXPECT_TRUE(handles->SelectControlPoint(0, handles->GetHoveredControlPoint()));
  double position[2] = { 159, 100 };
  handles->StartWidgetInteraction(position);
  position[0] += 5.0;
  handles->WidgetInteraction(position); // The first copies the points.
  edits->Update();
  start = steady_clock::now();
  for (int k = 0; k < 100; ++k)
  {
    position[0] += k % 2 ? 1.0 : -1.0;
    handles->WidgetInteraction(position);
    edits->Update();
  }
  const double drag = milliseconds(start) / 100.0;
  handles->EndWidgetInteraction(position);
  std::printf(
    "1,000,000 handles: %.2f ms a pick, %.3f ms a step of a drag, drawing aside\n", pick, drag);
  EXPECT_LT(drag, pick) << "a drag must not look at all points";
  EXPECT_EQ(edits->GetNumberOfEdits(), 1);
}

TEST(ControlPointWidget, WithoutEditsInputRendererOrWindow)
{
  vtkNew<vtkNURBSControlPointRepresentation> alone;
  double position[2] = { 1.0, 1.0 };
  double bounds[6] = { 0, 1, 0, 1, 0, 1 };
  alone->PlaceWidget(bounds);
  alone->BuildRepresentation();
  alone->StartWidgetInteraction(position);
  alone->WidgetInteraction(position);
  alone->EndWidgetInteraction(position);
  EXPECT_FALSE(alone->Pick(1, 1));
  EXPECT_FALSE(alone->ScaleSelectedWeights(2.0));
  EXPECT_EQ(alone->GetBounds(), nullptr);
  EXPECT_EQ(alone->GetNumberOfHandles(), 0);
  vtkNew<vtkNURBSControlPointEdits> edits;
  alone->SetEdits(edits);
  EXPECT_EQ(alone->GetNumberOfHandles(), 0) << "no input";
  edits->SetInputDataObject(Sheet());
  EXPECT_EQ(alone->GetNumberOfHandles(), 36);
  EXPECT_FALSE(alone->Pick(1, 1)) << "no renderer";
  EXPECT_EQ(alone->GetBounds()[0], edits->GetInputDataObject(0, 0) ? 0.0 : 1.0);

  auto noFaces = vtkSmartPointer<vtkUnstructuredGrid>::New();
  noFaces->SetPoints(Sheet()->GetPoints());
  noFaces->GetCellData()->ShallowCopy(Sheet()->GetCellData());
  noFaces->GetFieldData()->ShallowCopy(Sheet()->GetFieldData());
  edits->SetInputDataObject(noFaces);
  EXPECT_EQ(alone->GetNumberOfHandles(), 0) << "points, but no cell";

  vtkWidgetScene scene(Sheet());
  scene.Widget->SetEdits(nullptr);
  scene.Click(Vec2(150, 100));
  scene.Key("z", false, true);
  scene.Window->Render();
  EXPECT_EQ(scene.Handles()->GetNumberOfHandles(), 0);
}

// An input that changes under the selection keeps what is still there, and ends a drag.
TEST(ControlPointWidget, AnotherModel)
{
  vtkWidgetScene scene(Sheet());
  scene.Handles()->SelectControlPoint(0, 3);
  scene.Handles()->SelectControlPoint(0, 30);
  const Vec2 start = scene.PixelOf(scene.Before(Middle));
  scene.Move(start);
  scene.Press(start, true);
  scene.Move(start + Vec2(10, 0));
  EXPECT_EQ(scene.Edits->GetNumberOfEdits(), 3);
  scene.Edits->SetInputDataObject(Sheet(5));
  scene.Window->Render();
  EXPECT_EQ(scene.Handles()->GetNumberOfHandles(), 25);
  EXPECT_EQ(scene.Handles()->GetNumberOfSelectedControlPoints(), 2);
  EXPECT_FALSE(scene.Handles()->IsSelected(0, 30));
  EXPECT_EQ(scene.Edits->GetNumberOfEdits(), 0);
  scene.Move(start + Vec2(20, 0));
  scene.Release(start + Vec2(20, 0));
  EXPECT_EQ(scene.Edits->GetNumberOfEdits(), 0);
}

} // namespace
