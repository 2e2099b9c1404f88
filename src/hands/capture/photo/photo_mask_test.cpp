// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/photo_mask.h"

#include <gtest/gtest.h>

#include <array>

namespace palmar::capture {
namespace {

using Colour = std::array<std::uint8_t, 3>;

constexpr Colour kSkin{204, 153, 128}, kCloth{33, 69, 158}, kWood{180, 130, 90};
constexpr int kSide = 300;

/// A camera 500 mm in front of a hand-coloured square of 60 mm round the axis; `behind` it.
PhotoView view_of(const Colour& behind) {
  PhotoView view;
  view.camera.lens = {.width = kSide,
                      .height = kSide,
                      .focal_x = 500.0,
                      .focal_y = 500.0,
                      .centre_x = 149.5,
                      .centre_y = 149.5};
  view.camera.camera_from_world = looking_at(Vec3(500, 0, 100), Vec3(0, 0, 100));
  view.colour = {kSide, kSide, {}};
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const bool is_hand = std::abs(x - 149.5) < 30.0 && std::abs(y - 149.5) < 30.0;
      const Colour& colour = is_hand ? kSkin : behind;
      view.colour.rgb.insert(view.colour.rgb.end(), colour.begin(), colour.end());
    }
  }
  view.grey.assign(kSide * kSide, 128.0F);
  return view;
}

Box3 box_of(double half) {
  return {Vec3(-10.0, -half, 100.0 - half), Vec3(10.0, half, 100.0 + half)};
}

// A box that the hand fills is no background that looks like skin; one of wood is.
TEST(PhotoMask, DistinguishesABackgroundFromAFullBox) {
  const PhotoMask plain = mask_hand(view_of(kCloth), box_of(32.0), 0.0);
  EXPECT_GT(plain.box_share, 0.7);
  EXPECT_LT(plain.around_share, 0.05);
  const PhotoMask wood = mask_hand(view_of(kWood), box_of(32.0), 0.0);
  EXPECT_GT(wood.box_share, 0.9);
  EXPECT_GT(wood.around_share, 0.9);
  // Nothing beside it: what is around can't be determined.
  EXPECT_EQ(mask_hand(view_of(kCloth), box_of(160.0), 0.0).around_share, 1.0);
}

TEST(PhotoMask, IsTheHandAndAMillimetreMore) {
  const PhotoMask mask = mask_hand(view_of(kCloth), box_of(100.0), 0.0);
  const auto inside = [&](int x, int y) { return mask.inside[y * kSide + x]; };
  EXPECT_EQ(inside(150, 150), 1);
  EXPECT_EQ(inside(121, 150), 1);
  EXPECT_EQ(inside(115, 150), 0);
  EXPECT_EQ(inside(60, 60), 0);
}

}  // namespace
}  // namespace palmar::capture
