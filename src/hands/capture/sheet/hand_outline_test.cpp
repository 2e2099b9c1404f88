// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/sheet/hand_outline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "hands/capture/sheet/drawn_scene_test.h"
#include "hands/capture/sheet/skin_mask.h"
#include "palmar/core/error.h"

namespace palmar::capture {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

HandOutline measured(const Scene& scene, const HandOutlineOptions& options = {}) {
  const geometry::RgbImage image = scene.taken();
  const SheetView sheet = find_sheet(image, "hand.jpg");
  const SheetGrid grid = grid_of_sheet(sheet, 0.5);  // coarser than kOutlineCell, to be quick
  const imaging::VoxelMask skin =
      skin_mask(draw_sheet(image, sheet, grid, Ground::kPaper), Ground::kPaper, "hand.jpg");
  return measure_outline(grid, skin, sheet, flat_proportions(), "hand.jpg", options);
}

/// A scene in a small picture, for what is refused.
Scene small_scene() {
  Scene scene;
  scene.width = 360;
  scene.height = 480;
  scene.side = 1;
  return scene;
}

TEST(SheetView, FindsTheCameraAndTheSheet) {
  for (const double tilt : {0.0, 12.0, 28.0}) {
    Scene scene;
    scene.tilt = tilt;
    SheetOptions options;
    options.focal = scene.focal * scene.height;
    const SheetView view = find_sheet(scene.taken(), "hand.jpg", options);
    EXPECT_EQ(view.format.name, "a4");
    EXPECT_NEAR(view.tilt, tilt, 0.5);
    EXPECT_LT((view.eye - scene.camera().centre()).norm(), 4.0);
    for (const Vec2& p : {Vec2(-90.0, 130.0), Vec2(20.0, -10.0), Vec2(100.0, -140.0)}) {
      const Vec2 truth = *scene.camera().project({p.x(), p.y(), 0.0});
      EXPECT_LT((view.pixel_of(p) - truth).norm(), 0.5) << tilt;
    }
  }
}

TEST(SheetView, DistinguishesA4FromLetter) {
  Scene letter = small_scene();
  letter.half = {107.95, 139.7};
  letter.hand.bottom = -180.0;
  EXPECT_EQ(find_sheet(letter.taken(), "hand.jpg").format.name, "letter");
  Scene lying = small_scene();
  std::swap(lying.half.x(), lying.half.y());
  lying.has_hand = false;
  lying.distance = 620.0;
  const SheetView view = find_sheet(lying.taken(), "hand.jpg");
  EXPECT_EQ(view.format.name, "a4");
  EXPECT_EQ(view.format.width, 297.0);
}

TEST(SheetView, AThumbOverAnEdgePartsNoSheet) {
  // It cuts the lower left corner off from the rest of the paper.
  Scene scene;
  scene.hand.fingers[0].to = {-112.0, -85.0};
  const SheetView view = find_sheet(scene.taken(), "hand.jpg");
  const Vec2 corner = *scene.camera().project({-105.0, -148.5, 0.0});
  EXPECT_LT((view.pixel_of({-105.0, -148.5}) - corner).norm(), 1.0);
}

TEST(SheetView, PointsAboveThePaperLieNearerToTheCamerasFoot) {
  SheetView view;
  view.eye = {30.0, -40.0, 500.0};
  const Vec2 seen(130.0, 60.0);
  // The ray from (130, 60, 0) to the eye, at a height of 10.
  EXPECT_LT((view.raised(seen, 10.0) - Vec2(128.0, 58.0)).norm(), 1e-12);
}

TEST(SheetView, SaysWhatIsWrong) {
  const auto message = [](const Scene& scene, const char* text) {
    EXPECT_THAT([&] { find_sheet(scene.taken(), "hand.jpg"); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("hand.jpg: "), HasSubstr(text))));
  };
  Scene none = small_scene();
  none.half = {0.0, 0.0};
  none.has_hand = false;
  message(none, "sheet");
  Scene white = small_scene();
  white.table = {224, 222, 219};
  message(white, "white");
  Scene near = small_scene();
  near.distance = 210.0;
  message(near, "border");
  Scene corner = small_scene();  // a second hand over the upper right corner
  corner.hand.fingers.push_back({{140.0, 95.0}, {60.0, 190.0}, 66.0});
  message(corner, "a corner of the sheet isn't seen");
  Scene oblique = small_scene();
  oblique.tilt = 52.0;
  oblique.distance = 430.0;
  message(oblique, "degrees off the sheet's normal");
  Scene square = small_scene();
  square.half = {100.0, 100.0};
  message(square, "no A4 or letter");
  EXPECT_THAT(
      [] {
        find_sheet(geometry::RgbImage{20, 20, std::vector<std::uint8_t>(1200, 200)}, "x.png");
      },
      ThrowsMessage<InputError>(HasSubstr("20 x 20 pixels")));
  EXPECT_THROW(sheet_format_named("a5"), UsageError);
}

TEST(HandOutline, MeasuresWhatIsDrawn) {
  for (const bool is_dark : {false, true}) {
    Scene scene;
    if (is_dark) scene.skin = {92, 60, 46};
    const HandOutline outline = measured(scene);
    EXPECT_TRUE(outline.is_right);
    // The middle finger's strip ends 7.5 mm beyond its last point; the web is the palm's top.
    const DrawnHand::Strip& middle = scene.hand.fingers[2];
    const Vec2 tip = middle.to + 7.5 * (middle.to - middle.from).normalized();
    EXPECT_LT((outline.finger[2].tip - tip).norm(), 0.8);
    EXPECT_NEAR(outline.hand_length, (tip - Vec2(0.0, -148.5)).norm(), 0.8);
    for (std::size_t f = 1; f < 5; ++f) {
      EXPECT_NEAR(outline.finger[f].width[1], 15.0, 0.6) << f;
      EXPECT_NEAR(outline.finger[f].width[2], 15.0, 0.6) << f;
    }
    for (std::size_t f = 2; f < 4; ++f) {
      const DrawnHand::Strip& strip = scene.hand.fingers[f];
      const Vec2 way = (strip.to - strip.from).normalized();
      const double from_top = (strip.to - strip.from).norm() - 12.0 / way.y() + 7.5;
      EXPECT_NEAR(outline.finger[f].length, from_top - 1.5, 1.0) << f;
    }
    EXPECT_NEAR(outline.hand_width, 80.0, 1.0);
  }
}

TEST(HandOutline, ReportsTheSideByTheThumb) {
  Scene scene;
  for (DrawnHand::Strip& strip : scene.hand.fingers) {
    strip.from.x() *= -1.0;
    strip.to.x() *= -1.0;
  }
  EXPECT_FALSE(measured(scene).is_right);
  HandOutlineOptions up;
  up.palm_up = true;
  EXPECT_TRUE(measured(scene, up).is_right);
}

TEST(HandOutline, SaysWhatIsWrong) {
  const auto message = [](const Scene& scene, const char* text) {
    EXPECT_THAT([&] { measured(scene); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("hand.jpg: "), HasSubstr(text))));
  };
  Scene none = small_scene();
  none.has_hand = false;
  message(none, "no hand");
  Scene touching = small_scene();
  touching.hand.fingers[3].to.x() = touching.hand.fingers[2].to.x() + 10.0;
  message(touching, "finger");
  Scene folded = small_scene();
  folded.hand.fingers[1].to = folded.hand.fingers[1].from;
  message(folded, "4 fingertips");
  Scene sleeve = small_scene();
  sleeve.hand.bottom = -130.0;
  message(sleeve, "forearm must cross an edge");
  Scene beyond;
  beyond.hand.fingers[0].to.x() = -120.0;
  message(beyond, "the hand reaches beyond the sheet at (-10");
  HandOutlineOptions far;
  far.wrist = 200.0;
  EXPECT_THROW(far.check(), UsageError);
}

}  // namespace
}  // namespace palmar::capture
