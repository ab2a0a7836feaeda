// SPDX-License-Identifier: BSD-3-Clause
// What is seen of handles and nets, pixel by pixel.
#include "vtkWidgetScene.h"

#include "vtkPoints.h"
#include "vtkProperty.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using nurbs::Vec2;
using nurbs::Vec3;
using Representation = vtkNURBSControlPointRepresentation;
using vtkTestImage::Colour;

constexpr Colour White = { 255, 255, 255 };

Colour Rounded(const double* color)
{
  Colour rounded;
  for (std::size_t c = 0; c < 3; ++c)
  {
    rounded[c] = int(std::lround(255.0 * color[c]));
  }
  return rounded;
}

testing::AssertionResult Near(const Colour& a, const Colour& b, int margin = 1)
{
  for (std::size_t c = 0; c < 3; ++c)
  {
    if (std::abs(a[c] - b[c]) > margin)
    {
      return testing::AssertionFailure()
        << "(" << a[0] << " " << a[1] << " " << a[2] << ") is not (" << b[0] << " " << b[1] << " "
        << b[2] << ")";
    }
  }
  return testing::AssertionSuccess();
}

long CountOf(vtkImageData* image, const Colour& color)
{
  long count = 0;
  for (int y = 0; y < vtkWidgetScene::Height; ++y)
  {
    for (int x = 0; x < vtkWidgetScene::Width; ++x)
    {
      count += bool(Near(vtkTestImage::Pixel(image, x, y), color));
    }
  }
  return count;
}

TEST(ControlPointLooks, HandlesAreDiscsInTheirColours)
{
  vtkWidgetScene scene(vtkWidgetShape(vtkNURBSShapeSource::SHEET));
  Representation* handles = scene.Handles();
  handles->SetNet(Representation::NET_OFF);
  scene.Actor->VisibilityOff();
  auto image = vtkTestImage::Take(scene.Window);
  // 36 discs of 7 pixels; 7 * 7 * pi / 4 pixels each, but for rasterization.
  const long expected = std::lround(36 * 49 * 3.14159 / 4);
  EXPECT_NEAR(CountOf(image, Rounded(handles->GetHandleColor())), expected, 0.06 * expected);
  EXPECT_NEAR(vtkTestImage::CountOthers(image, White), expected, 0.06 * expected);
  for (vtkIdType k = 0; k < 36; ++k)
  {
    const Vec2 at = scene.DisplayOf(scene.Before(k)).head<2>();
    EXPECT_TRUE(
      Near(vtkTestImage::Pixel(image, int(at[0]), int(at[1])), Rounded(handles->GetHandleColor())));
  }

  const Vec2 at = scene.PixelOf(scene.Before(14));
  scene.Move(at);
  EXPECT_TRUE(Near(scene.PixelColour(at), Rounded(handles->GetHoverColor())));
  const double large = 81 * 3.14159 / 4;
  EXPECT_NEAR(CountOf(vtkTestImage::Take(scene.Window), Rounded(handles->GetHoverColor())), large,
    0.15 * large);
  scene.Click(at);
  scene.Move(Vec2(1, 1));
  EXPECT_TRUE(Near(scene.PixelColour(at), Rounded(handles->GetSelectedColor())));
  scene.Send(vtkCommand::MouseMoveEvent, at);
  scene.Send(vtkCommand::LeaveEvent, at);
  EXPECT_TRUE(Near(scene.PixelColour(at), Rounded(handles->GetSelectedColor())));
  scene.Key("Escape");
  EXPECT_TRUE(Near(scene.PixelColour(at), Rounded(handles->GetHandleColor())));

  scene.Widget->Off();
  EXPECT_EQ(vtkTestImage::CountOthers(vtkTestImage::Take(scene.Window), White), 0);
}

TEST(ControlPointLooks, ADragIsSeen)
{
  vtkWidgetScene scene(vtkWidgetShape(vtkNURBSShapeSource::SHEET));
  scene.Handles()->SetNet(Representation::NET_OFF);
  const auto before = vtkTestImage::Take(scene.Window);
  const Vec2 start = scene.PixelOf(scene.Before(14)), end = start + Vec2(0, 45);
  scene.Move(start);
  scene.Press(start);
  scene.Move(end);
  // Without asking for a picture: the widget has drawn.
  EXPECT_TRUE(Near(scene.PixelColour(end), Rounded(scene.Handles()->GetHoverColor())));
  EXPECT_FALSE(Near(scene.PixelColour(start), Rounded(scene.Handles()->GetSelectedColor())));
  scene.Release(end);
  scene.Widget->Off();
  scene.Window->Render();
  vtkWidgetScene untouched(vtkWidgetShape(vtkNURBSShapeSource::SHEET));
  untouched.Widget->Off();
  EXPECT_GT(vtkTestImage::MeanDifference(
              vtkTestImage::Take(scene.Window), vtkTestImage::Take(untouched.Window)),
    1.0)
    << "the surface follows";
  ASSERT_TRUE(scene.Edits->Undo());
  EXPECT_LT(vtkTestImage::MeanDifference(
              vtkTestImage::Take(scene.Window), vtkTestImage::Take(untouched.Window)),
    1e-3)
    << "and comes back";
}

// A handle 20 before the sheet, and one 20 behind it at the same place of the picture.
struct FrontAndBack : testing::Test
{
  vtkSmartPointer<vtkUnstructuredGrid> Grid = vtkWidgetShape(vtkNURBSShapeSource::SHEET, 12, 0.0);
  std::unique_ptr<vtkWidgetScene> Scene;
  const vtkIdType Front = 79, Back = 65;

  void SetUp() override
  {
    // A flat sheet; two control points far off it, too few to bend it away from their line.
    this->Scene = std::make_unique<vtkWidgetScene>(this->Grid);
    vtkCamera* camera = this->Scene->Renderer->GetActiveCamera();
    camera->SetPosition(50, 50, 500);
    camera->SetFocalPoint(50, 50, 0);
    camera->SetViewUp(0, 1, 0);
    this->Scene->Renderer->ResetCamera();
    const Vec3 place = this->Scene->Before(this->Front);
    this->Scene->Edits->SetControlPointPosition(this->Front, place[0], place[1], 20.0);
    this->Scene->Edits->SetControlPointPosition(this->Back, place[0], place[1], -20.0);
    this->Scene->Edits->Update();
    this->Scene->Handles()->SetNet(Representation::NET_OFF);
    this->Scene->Renderer->ResetCameraClippingRange();
    this->Scene->Window->Render();
  }
};

TEST_F(FrontAndBack, TheOneBeforeIsPicked)
{
  const Vec2 at = this->Scene->PixelOf(this->Scene->Now(this->Front));
  ASSERT_EQ(at, this->Scene->PixelOf(this->Scene->Now(this->Back)));
  for (const int mode : { Representation::HIDE, Representation::FAINT, Representation::SHOW })
  {
    this->Scene->Handles()->SetHiddenHandles(mode);
    this->Scene->Window->Render();
    ASSERT_TRUE(this->Scene->Handles()->Pick(at[0], at[1]));
    EXPECT_EQ(this->Scene->Handles()->GetHoveredControlPoint(), this->Front);
  }
}

TEST_F(FrontAndBack, HiddenHandlesAsAskedFor)
{
  vtkNURBSControlPointEdits* edits = this->Scene->Edits;
  Representation* handles = this->Scene->Handles();
  // Out of the way of everything but the sheet.
  const Vec3 alone = Vec3(40.0, 60.0, -20.0);
  edits->ResetControlPoint(this->Front);
  edits->SetControlPointPosition(this->Back, alone[0], alone[1], alone[2]);
  this->Scene->Window->Render();
  const Vec2 at = this->Scene->PixelOf(alone);
  handles->SetHiddenHandles(Representation::HIDE);
  const Colour sheet = this->Scene->PixelColour(at);
  EXPECT_FALSE(Near(sheet, Rounded(handles->GetHandleColor()), 40));
  EXPECT_FALSE(handles->Pick(at[0], at[1]) && handles->GetHoveredControlPoint() == this->Back)
    << "hidden handles are not picked";

  handles->SetHiddenHandles(Representation::FAINT);
  handles->SetHiddenOpacity(0.5);
  Colour half;
  for (std::size_t c = 0; c < 3; ++c)
  {
    half[c] = (sheet[c] + Rounded(handles->GetHandleColor())[c]) / 2;
  }
  EXPECT_TRUE(Near(this->Scene->PixelColour(at), half, 2));
  ASSERT_TRUE(handles->Pick(at[0], at[1]));
  EXPECT_EQ(handles->GetHoveredControlPoint(), this->Back);

  handles->SetHiddenHandles(Representation::SHOW);
  handles->Highlight(0);
  EXPECT_TRUE(Near(this->Scene->PixelColour(at), Rounded(handles->GetHandleColor())));
}

TEST_F(FrontAndBack, AVisibleHandleGoesBeforeANearerHiddenOne)
{
  Representation* handles = this->Scene->Handles();
  const double size = this->Scene->PixelSize(Vec3::Zero());
  // The hidden one under the cursor, the visible one 4 pixels beside it.
  const Vec3 place = Vec3(40.0, 60.0, 0.0);
  this->Scene->Edits->SetControlPointPosition(this->Back, place[0], place[1], -20.0);
  this->Scene->Edits->SetControlPointPosition(this->Front, place[0] + 4 * size, place[1], 20.0);
  this->Scene->Window->Render();
  const Vec2 at = this->Scene->PixelOf(place);
  handles->SetHiddenHandles(Representation::FAINT);
  ASSERT_TRUE(handles->Pick(at[0], at[1]));
  EXPECT_EQ(handles->GetHoveredControlPoint(), this->Front);
  handles->SetHiddenHandles(Representation::SHOW);
  ASSERT_TRUE(handles->Pick(at[0], at[1]));
  EXPECT_EQ(handles->GetHoveredControlPoint(), this->Back) << "all are equal there";
}

TEST(ControlPointLooks, NetsOfAllAndOfSelectedFaces)
{
  vtkWidgetScene scene(vtkWidgetShape(vtkNURBSShapeSource::TEAPOT));
  Representation* handles = scene.Handles();
  scene.Actor->VisibilityOff();
  handles->SetHandleSize(0.5);
  const Colour net = Rounded(handles->GetNetColor());
  const auto count = [&](int mode) {
    handles->SetNet(mode);
    return CountOf(vtkTestImage::Take(scene.Window), net);
  };
  EXPECT_EQ(count(Representation::NET_OFF), 0);
  EXPECT_EQ(count(Representation::NET_OF_SELECTED_FACES), 0);
  const long all = count(Representation::NET_OF_ALL_FACES);
  EXPECT_GT(all, 1000);
  handles->SelectControlPoint(0, 5);
  const long one = count(Representation::NET_OF_SELECTED_FACES);
  EXPECT_GT(one, 20);
  EXPECT_LT(one, all / 4);
  handles->ClearSelection();
  EXPECT_EQ(count(Representation::NET_OF_SELECTED_FACES), 0);
}

TEST(ControlPointLooks, Picture)
{
  vtkWidgetScene scene(vtkWidgetShape(vtkNURBSShapeSource::TEAPOT));
  scene.Window->SetSize(400, 300);
  scene.Renderer->GetActiveCamera()->SetPosition(3, -8, 4);
  scene.Renderer->GetActiveCamera()->SetFocalPoint(0, 0, 0);
  scene.Renderer->ResetCamera();
  scene.Renderer->GetActiveCamera()->Zoom(1.3);
  scene.Actor->GetProperty()->SetColor(0.9, 0.88, 0.8);
  scene.Handles()->SetNet(Representation::NET_OF_SELECTED_FACES);
  scene.Window->Render();
  double display[3];
  vtkIdType picked = -1;
  for (vtkIdType k = 0; picked < 0 && k < scene.Handles()->GetNumberOfHandles(); ++k)
  {
    // The first handle of the front that is well in the picture's right half.
    if (scene.Handles()->GetHandleDisplayPosition(0, k, display) && display[0] > 220 &&
      display[0] < 250 && display[1] > 120 && display[1] < 160 &&
      scene.Handles()->Pick(display[0], display[1]) &&
      scene.Handles()->GetHoveredControlPoint() == k)
    {
      picked = k;
    }
  }
  ASSERT_GE(picked, 0);
  const Vec2 start = scene.PixelOf(scene.Before(picked)), end = start + Vec2(10, -25);
  scene.Move(start);
  scene.Press(start);
  scene.Move(end);
  scene.Release(end);
  scene.Move(Vec2(1, 1));
  EXPECT_TRUE(Near(scene.PixelColour(end), Rounded(scene.Handles()->GetSelectedColor())));
  EXPECT_TRUE(
    vtkTestImage::Matches(vtkTestImage::Take(scene.Window), "TestNURBSControlPointWidget", 60.0));
}

} // namespace
