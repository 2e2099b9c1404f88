// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/photo/hand_outline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/photo/photo_camera.h"
#include "palmar/photo/photo_view.h"

namespace palmar {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using Vec2 = Eigen::Vector2d;

/// A flat hand made of strips with round ends on an A4 sheet, seen by a pinhole: what it measures
/// is what it is drawn with.
struct DrawnHand {
  struct Strip {
    Vec2 from, to;
    double radius;
  };
  std::vector<Strip> fingers;                      // thumb to little
  double left = -40.0, right = 40.0, top = -55.0;  // the palm, from the sheet's lower edge
  double bottom = -200.0;

  DrawnHand() {
    const double lengths[] = {62.0, 70.0, 64.0, 50.0}, angle[] = {-0.22, -0.06, 0.08, 0.26};
    fingers.push_back({{-30.0, -115.0}, {-82.0, -85.0}, 9.0});
    for (int f = 0; f < 4; ++f) {
      const Vec2 from(-31.0 + 20.5 * f, top - 12.0);
      fingers.push_back(
          {from, from + (lengths[f] + 12.0) * Vec2(std::sin(angle[f]), std::cos(angle[f])), 7.5});
    }
  }
  bool covers(const Vec2& p) const {
    if (p.x() > left && p.x() < right && p.y() > bottom && p.y() < top) return true;
    for (const Strip& s : fingers) {
      const Vec2 d = s.to - s.from;
      const double t = std::clamp((p - s.from).dot(d) / d.squaredNorm(), 0.0, 1.0);
      if ((p - s.from - t * d).norm() < s.radius) return true;
    }
    return false;
  }
};

struct Scene {
  DrawnHand hand;
  Vec2 half{105.0, 148.5};
  std::array<int, 3> table{70, 60, 55}, skin{205, 150, 125};
  double tilt = 12.0, about = -80.0, distance = 460.0, focal = 0.74;
  int width = 600, height = 800;
  bool has_hand = true;

  PhotoCamera camera() const {
    PhotoCamera camera;
    const double f = focal * height, t = tilt * std::numbers::pi / 180.0,
                 a = about * std::numbers::pi / 180.0;
    camera.lens = {width, height, f, f, 0.5 * (width - 1), 0.5 * (height - 1), 0.0, 0.0};
    camera.camera_from_world = looking_at(
        distance * Vec3(std::sin(t) * std::cos(a), std::sin(t) * std::sin(a), std::cos(t)),
        Vec3::Zero());
    return camera;
  }
  RgbImage taken() const {
    const PhotoCamera at = camera();
    const Vec3 eye = at.centre();
    RgbImage image{width, height, {}};
    image.rgb.resize(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        std::array<double, 3> sum{};
        for (int s = 0; s < 4; ++s) {
          const Vec3 ray = at.ray({x - 0.25 + 0.5 * (s % 2), y - 0.25 + 0.5 * (s / 2)});
          const Vec3 p = eye - eye.z() / ray.z() * ray;
          const bool paper = std::abs(p.x()) < half.x() && std::abs(p.y()) < half.y();
          std::array<int, 3> colour = paper ? std::array<int, 3>{226, 224, 220} : table;
          if (has_hand && hand.covers(p.head<2>())) colour = skin;
          for (std::size_t c = 0; c < 3; ++c) sum[c] += 0.25 * colour[c];
        }
        for (std::size_t c = 0; c < 3; ++c) {
          image.rgb[pixel_offset(image, x, y) + c] = static_cast<std::uint8_t>(sum[c] + 0.5);
        }
      }
    }
    return image;
  }
};

OutlineProportions flat() {
  OutlineProportions p;
  for (auto& segment : p.segment) segment = {0.4, 0.3, 0.3};
  p.segment[0] = {0.15, 0.15, 0.0};
  return p;
}

HandOutline measured(const Scene& scene, const HandOutlineOptions& options = {}) {
  const RgbImage image = scene.taken();
  return measure_outline(image, find_sheet(image, "hand.jpg"), flat(), "hand.jpg", options);
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

TEST(SheetView, TellsA4FromLetter) {
  Scene letter;
  letter.half = {107.95, 139.7};
  letter.hand.bottom = -180.0;
  EXPECT_EQ(find_sheet(letter.taken(), "hand.jpg").format.name, "letter");
  Scene lying;
  std::swap(lying.half.x(), lying.half.y());
  lying.has_hand = false;
  lying.distance = 620.0;
  const SheetView view = find_sheet(lying.taken(), "hand.jpg");
  EXPECT_EQ(view.format.name, "a4");
  EXPECT_EQ(view.format.width, 297.0);
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
  Scene none;
  none.half = {0.0, 0.0};
  none.has_hand = false;
  message(none, "sheet");
  Scene white;
  white.table = {224, 222, 219};
  message(white, "white");
  Scene near;
  near.distance = 210.0;
  message(near, "border");
  Scene oblique;
  oblique.tilt = 52.0;
  oblique.distance = 430.0;
  message(oblique, "degrees off the sheet's normal");
  Scene square;
  square.half = {100.0, 100.0};
  message(square, "no A4 or letter");
  EXPECT_THAT(
      [] {
        find_sheet(RgbImage{20, 20, std::vector<std::uint8_t>(1200, 200)}, "x.png");
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
    EXPECT_LT((outline.finger[2].tip - tip).norm(), 0.6);
    EXPECT_NEAR(outline.hand_length, (tip - Vec2(0.0, -148.5)).norm(), 0.8);
    for (std::size_t f = 1; f < 5; ++f) {
      EXPECT_NEAR(outline.finger[f].width[1], 15.0, 0.5) << f;
      EXPECT_NEAR(outline.finger[f].width[2], 15.0, 0.5) << f;
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

TEST(HandOutline, TellsTheSideByTheThumb) {
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
  Scene none;
  none.has_hand = false;
  message(none, "no hand");
  Scene touching;
  touching.hand.fingers[3].to.x() = touching.hand.fingers[2].to.x() + 10.0;
  message(touching, "finger");
  Scene folded;
  folded.hand.fingers[1].to = folded.hand.fingers[1].from;
  message(folded, "4 fingertips");
  Scene sleeve;
  sleeve.hand.bottom = -130.0;
  message(sleeve, "forearm must cross an edge");
  Scene beyond;
  beyond.hand.fingers[0].to.x() = -120.0;
  message(beyond, "within the sheet");
  HandOutlineOptions far;
  far.wrist = 200.0;
  EXPECT_THROW(far.check(), UsageError);
}

}  // namespace
}  // namespace palmar
