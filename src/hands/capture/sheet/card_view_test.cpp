// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/sheet/card_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hands/capture/sheet/card_pose.h"
#include "hands/capture/sheet/drawn_scene_test.h"
#include "hands/capture/sheet/picture_edges.h"
#include "hands/capture/sheet/skin_mask.h"
#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"

namespace palmar::capture {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// The drawn hand on a grey table, its wrist at y = -148.5, the card beside it.
Scene beside_card() {
  Scene scene;
  scene.table = {150, 152, 155};
  scene.card = Vec2(95.0, -148.5 + 27.0);
  scene.tilt = 6.0;
  scene.distance = 520.0;
  scene.width = 750;
  scene.height = 1000;
  scene.hand.bottom = -600.0;  // the forearm leaves the picture
  return scene;
}

Scene small_beside_card() {
  Scene scene = beside_card();
  scene.width = 610;
  scene.height = 812;
  scene.side = 1;
  return scene;
}

SheetOptions lens_of(const Scene& scene) {
  SheetOptions options;
  options.focal = scene.focal * scene.height;
  options.most_tilt = 20.0;
  return options;
}

TEST(CardPose, OfExactEdgesIsExact) {
  CardPose truth;
  truth.width = 85.60;
  truth.height = 53.98;
  truth.focal = 1500.0;
  truth.centre = {750.0, 1000.0};
  // Looking down: x right, y down, z forward.
  Eigen::Matrix3d down;
  down << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  const Quat lean(Eigen::AngleAxisd(0.11, Vec3(0.6, 0.8, 0.0)));
  truth.camera_from_table = {lean * Quat(down), Vec3(40.0, -30.0, 450.0)};
  std::array<Vec2, 4> corner{};
  const double x = 42.80, y = 26.99;
  const std::array<Vec2, 4> place = {Vec2(-x, y), Vec2(x, y), Vec2(x, -y), Vec2(-x, -y)};
  for (std::size_t c = 0; c < 4; ++c) {
    const Vec3 q = truth.camera_from_table * Vec3(place[c].x(), place[c].y(), 0.76);
    corner[c] = 1500.0 * q.head<2>() / q.z() + truth.centre;
  }
  std::array<FittedLine, 4> edge;
  for (std::size_t e = 0; e < 4; ++e) {
    edge[e] = fit_line({corner[e], corner[(e + 1) % 4]});
  }
  const CardPose found = fit_card(corner, edge, 1500.0, truth.centre);
  EXPECT_LT(found.misfit, 0.1);  // the tilt that is expected pulls a little
  EXPECT_NEAR((found.eye() - truth.eye()).norm(), 0.0, 8.0);
  EXPECT_NEAR(found.eye().z(), truth.eye().z(), 1.0);
  const Vec2 far(-90.0, 150.0);
  const Vec2 seen = (truth.pixel_from_table() * far.homogeneous()).hnormalized();
  const Vec2 back = (found.pixel_from_table().inverse() * seen.homogeneous()).hnormalized();
  EXPECT_LT((back - far).norm(), 1.0);
  const double error = found.scale_error({-90.0, -27.0}, {-90.0, 158.0});
  EXPECT_GT(error, 0.0005);
  EXPECT_LT(error, 0.02);
}

TEST(CardView, FindsTheCameraAndTheWristsLine) {
  for (const double turn : {90.0, 4.0}) {
    Scene scene = beside_card();
    scene.card_turn = turn;
    if (turn == 90.0) scene.card->y() = -148.5 + 42.8;
    const SheetView view = find_card(scene.taken(), "hand.jpg", lens_of(scene));
    EXPECT_NEAR(view.format.height, turn == 90.0 ? 85.60 : 53.98, 1e-9);
    EXPECT_NEAR(view.eye.z(), scene.camera().centre().z(), 5.0);
    const auto in_card = [&](const Vec2& p) {
      const double by = turn == 4.0 ? -4.0 * geometry::kDegree : 0.0;
      return Vec2(Eigen::Rotation2Dd(by) * (p - *scene.card));
    };
    for (const Vec2& p : {Vec2(0.0, -140.0), Vec2(-30.0, 20.0), Vec2(60.0, -20.0)}) {
      const Vec2 seen = *scene.camera().project({p.x(), p.y(), 0.0});
      const Vec2 back = (view.pixel_from_sheet.inverse() * seen.homogeneous()).hnormalized();
      EXPECT_LT((back - in_card(p)).norm(), 2.0) << turn;
    }
    EXPECT_LT(view.scale_error, 0.015);
  }
}

TEST(CardView, LetsAHandBeMeasured) {
  const Scene scene = beside_card();
  const geometry::RgbImage image = scene.taken();
  const SheetView view = find_card(image, "hand.jpg", lens_of(scene));
  const SheetGrid grid = grid_beside_card(view, 0.6);
  const imaging::VoxelMask skin =
      skin_mask(draw_sheet(image, view, grid, Ground::kTable), Ground::kTable, "hand.jpg");
  const HandOutline outline = measure_outline(grid, skin, view, flat_proportions(), "hand.jpg");
  EXPECT_TRUE(outline.is_right);
  const DrawnHand::Strip& middle = scene.hand.fingers[2];
  const Vec2 tip = middle.to + 7.5 * (middle.to - middle.from).normalized();
  EXPECT_NEAR(outline.hand_length, (tip - Vec2(0.0, -148.5)).norm(), 2.0);  // 1 %
  for (std::size_t f = 1; f < 5; ++f) EXPECT_NEAR(outline.finger[f].width[1], 15.0, 0.6) << f;
}

TEST(CardView, SaysWhatIsWrong) {
  const auto message = [](const Scene& scene, const char* text) {
    EXPECT_THAT([&] { find_card(scene.taken(), "hand.jpg", lens_of(scene)); },
                ThrowsMessage<InputError>(AllOf(HasSubstr("hand.jpg: "), HasSubstr(text))));
  };
  Scene none = small_beside_card();
  none.card = Vec2(900.0, 0.0);
  message(none, "no bank card");
  Scene outside = small_beside_card();
  outside.card = Vec2(245.0, -120.0);
  message(outside, "no bank card");
  Scene covered = small_beside_card();
  covered.card = Vec2(40.0, -120.0);
  message(covered, "no bank card");
  Scene same = small_beside_card();
  same.card_colour = same.table;
  message(same, "no bank card");
  Scene square = small_beside_card();
  square.card_size = {60.0, 60.0};
  message(square, "no bank card");
  Scene handless = small_beside_card();
  handless.has_hand = false;
  message(handless, "no hand");
  Scene several = small_beside_card();
  several.other_card = {120.0, 60.0};
  message(several, "several things look like a card");
  Scene skew = small_beside_card();
  skew.card_turn = 42.0;
  skew.card->x() += 12.0;
  message(skew, "isn't parallel");
  Scene oblique = small_beside_card();
  oblique.tilt = 32.0;
  message(oblique, "degrees off the table's normal");
}

TEST(CardView, ATableLikeSkinAndAHandCutOffAreNamed) {
  const auto message = [](const Scene& scene, const char* text) {
    const geometry::RgbImage image = scene.taken();
    const SheetView view = find_card(image, "hand.jpg", lens_of(scene));
    const SheetGrid grid = grid_beside_card(view, 1.0);
    EXPECT_THAT(
        [&] {
          skin_mask(draw_sheet(image, view, grid, Ground::kTable), Ground::kTable, "hand.jpg");
        },
        ThrowsMessage<InputError>(AllOf(HasSubstr("hand.jpg: "), HasSubstr(text))));
  };
  // Skin that differs from the table by its brightness alone.
  Scene alike = small_beside_card();
  alike.table = {119, 86, 71};
  message(alike, "isn't of the colour of skin");
  Scene cut = small_beside_card();
  cut.distance = 320.0;  // what is seen ends 160 mm to the left
  cut.hand.fingers[0].to = {-190.0, -85.0};
  message(cut, "the picture's border cuts the hand off");
}

}  // namespace
}  // namespace palmar::capture
