// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "palmar/capture/sheet/outline_person.h"

namespace palmar {
namespace {

TEST(OutlinePerson, GirthsOfOtherPeopleLieWithinWhatIsStated) {
  PersonEstimate estimate;
  estimate.dimensions = {
      {.dimension = {DimensionKind::kHandCircumference}, .value = 190.0, .sd = 4.0},
      {.dimension = {DimensionKind::kHandWidth}, .value = 84.0, .sd = 1.2, .is_measured = true},
      {.dimension = {DimensionKind::kHandWidth}, .value = 84.0, .sd = 2.0},
      {.dimension = {DimensionKind::kHandLength}, .value = 185.0, .sd = 2.0}};
  allow_for_build(estimate);
  // A hand from elsewhere: girth 11 mm, breadth 5 mm less than regressed. 95 of 100 are within two
  // standard deviations.
  EXPECT_GT(1.96 * estimate.dimensions[0].sd, 11.0);
  EXPECT_GT(1.96 * estimate.dimensions[2].sd, 5.0);
  EXPECT_LT(1.96 * estimate.dimensions[0].sd, 20.0);  // and not whatever one likes
  // What was measured, and the hand's length, stay.
  EXPECT_EQ(estimate.dimensions[1].sd, 1.2);
  EXPECT_EQ(estimate.dimensions[3].sd, 2.0);
}

TEST(OutlinePerson, SegmentsByAnotherRulerLieWithinWhatIsStated) {
  // The last segment of the middle finger in Greiner 1991 is 28.7 mm in a hand of 194 mm; in the
  // template's proportions it is 35.3. The middle finger as a whole isn't known better by that.
  PersonEstimate estimate;
  estimate.dimensions = {{.dimension = {DimensionKind::kSegmentLength, Segment::kMiddleDistal},
                          .value = 35.3,
                          .sd = 1.8},
                         {.dimension = {DimensionKind::kSegmentWidth, Segment::kMiddleProximal},
                          .value = 20.0,
                          .sd = 0.3,
                          .is_measured = true}};
  allow_for_build(estimate);
  EXPECT_GT(1.96 * estimate.dimensions[0].sd, 35.3 - 28.7);
  EXPECT_LT(1.96 * estimate.dimensions[0].sd, 2.0 * (35.3 - 28.7));
  // A width is never surer than what an outline's edge shows of it.
  EXPECT_GT(estimate.dimensions[1].sd, 0.5);
  EXPECT_LT(estimate.dimensions[1].sd, 1.0);
}

}  // namespace
}  // namespace palmar
