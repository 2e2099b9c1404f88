// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/hand_plausibility.h"

#include <gmock/gmock.h>

#include "palmar/core/enum_index.h"

namespace palmar::capture {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

hand::HandDimensions dimensions(double size) {
  hand::HandDimensions all;
  for (hand::SegmentDimensions& one : all.segment) one = {30.0 * size, 16.0 * size, 14.0 * size};
  return all;
}

TEST(ImpossibleDimensions, PeopleDiffer) {
  hand::HandDimensions small = dimensions(0.8);
  small.segment[3] = {0.8 * 22.0, 0.8 * 21.0, 0.8 * 18.0};
  EXPECT_THAT(impossible_dimensions(small, dimensions(1.0)), IsEmpty());
}

TEST(ImpossibleDimensions, AFingerFiveTimesAsWideIsNamed) {
  hand::HandDimensions found = dimensions(0.8);
  found.segment[index_of(hand::Segment::kLittleProximal)].width = 79.2;
  found.segment[index_of(hand::Segment::kMiddleProximal)].length = 8.0;
  EXPECT_THAT(impossible_dimensions(found, dimensions(1.0)),
              ElementsAre("middle_proximal is 8 mm long, where about 24 mm are expected",
                          "little_proximal is 79 mm wide, where about 13 mm are expected"));
}

}  // namespace
}  // namespace palmar::capture
