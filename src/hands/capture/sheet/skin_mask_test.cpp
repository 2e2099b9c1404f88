// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/sheet/skin_mask.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "hands/capture/picture_vectors.h"
#include "palmar/core/error.h"
#include "palmar/formats/test_files.h"

namespace palmar::capture {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const Vec3f kTable(1.0F, 1.0F, 1.0F), kRed(1.2F, 0.9F, 0.6F);  // light over the table's

/// 200 x 200 mm of table, red where `is_red` says so.
template <typename IsRed>
RectifiedSheet table(const IsRed& is_red) {
  RectifiedSheet sheet;
  sheet.grid.width = sheet.grid.height = 200;
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) sheet.light.push_back(is_red(x, y) ? kRed : kTable);
  }
  sheet.is_seen.assign(sheet.light.size(), 1);
  return sheet;
}

std::string refusal(const RectifiedSheet& sheet) {
  return formats::message_of<InputError>([&] { skin_mask(sheet, Ground::kTable, "photo.jpg"); });
}

TEST(SkinMask, GrainOfATableIsNotTakenForTouchingFingers) {
  // Red grain, 4 mm wide every 20 mm, that crosses: it encloses pieces of table.
  EXPECT_THAT(refusal(table([](int x, int y) { return x % 20 < 4 || y % 40 < 4; })),
              AllOf(HasSubstr("colour of skin or wood"), Not(HasSubstr("fingers touch"))));
}

TEST(SkinMask, FingersThatTouchAreStillNamed) {
  // A hand of 100 x 90 mm with a gap of 8 x 40 mm that is closed at both ends.
  const RectifiedSheet sheet = table([](int x, int y) {
    const bool is_hand = x >= 50 && x < 140 && y >= 60 && y < 160;
    return is_hand && !(x >= 90 && x < 98 && y >= 70 && y < 110);
  });
  EXPECT_THAT(refusal(sheet), AllOf(HasSubstr("fingers touch"), HasSubstr("3.2 cm2")));
}

}  // namespace
}  // namespace palmar::capture
