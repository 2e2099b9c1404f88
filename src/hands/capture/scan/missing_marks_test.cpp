// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/missing_marks.h"

#include <gtest/gtest.h>

namespace palmar::capture {
namespace {

TEST(MissingMarks, NamesWhatIsMissing) {
  EXPECT_EQ(missing_creases_note({}), "");
  EXPECT_EQ(missing_creases_note({hand::Segment::kPalm, hand::Segment::kRingMiddle}),
            "Creases not found, taken from the joints: wrist, ring_middle.");

  // The thesis draws 50 dots: three on each of 14 phalanges, eight on the back of the hand.
  std::map<hand::Segment, int> dots = advised_dots();
  int all = 0;
  for (const auto& [segment, count] : dots) all += count;
  EXPECT_EQ(all, 50);
  EXPECT_EQ(missing_dots_note("a.ply", dots, advised_dots()), "");
  dots.erase(hand::Segment::kThumbDistal);
  dots[hand::Segment::kPalm] = 7;
  dots[hand::Segment::kRingDistal] = 4;  // one too many is no lack
  EXPECT_EQ(missing_dots_note("a.ply", dots, advised_dots()),
            "a.ply: dots not found: palm (7 of 8), thumb_distal (0 of 3). Where fewer than two are "
            "left, the joint follows the skin.");
}

}  // namespace
}  // namespace palmar::capture
