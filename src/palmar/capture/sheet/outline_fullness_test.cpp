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
  allow_for_fullness(estimate);
  // A hand from elsewhere: girth 11 mm, breadth 5 mm less than regressed. 95 of 100 are within two
  // standard deviations.
  EXPECT_GT(1.96 * estimate.dimensions[0].sd, 11.0);
  EXPECT_GT(1.96 * estimate.dimensions[2].sd, 5.0);
  EXPECT_LT(1.96 * estimate.dimensions[0].sd, 20.0);  // and not whatever one likes
  // What was measured, and lengths, stay.
  EXPECT_EQ(estimate.dimensions[1].sd, 1.2);
  EXPECT_EQ(estimate.dimensions[3].sd, 2.0);
}

}  // namespace
}  // namespace palmar
