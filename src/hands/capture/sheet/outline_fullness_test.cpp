// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "hands/capture/sheet/outline_person.h"

namespace palmar::capture {
namespace {

TEST(OutlinePerson, GirthsOfOtherPeopleLieWithinWhatIsStated) {
  population::PersonEstimate estimate;
  estimate.dimensions = {
      {.dimension = {hand::DimensionKind::kHandCircumference}, .value = 190.0, .sd = 4.0},
      {.dimension = {hand::DimensionKind::kHandWidth},
       .value = 84.0,
       .sd = 1.2,
       .is_measured = true},
      {.dimension = {hand::DimensionKind::kHandWidth}, .value = 84.0, .sd = 2.0},
      {.dimension = {hand::DimensionKind::kHandLength}, .value = 185.0, .sd = 2.0}};
  allow_for_build(estimate);
  // A hand from elsewhere: girth 11 mm, breadth 5 mm less than regressed. 95 of 100 are within two
  // standard deviations.
  EXPECT_GT(1.96 * estimate.dimensions[0].sd, 11.0);
  EXPECT_GT(1.96 * estimate.dimensions[2].sd, 5.0);
  EXPECT_LT(1.96 * estimate.dimensions[0].sd, 20.0);  // and not whatever one likes
  // What was measured stays better known than what follows from it, and the hand's length as it is.
  EXPECT_GT(estimate.dimensions[1].sd, 1.2);
  EXPECT_LT(estimate.dimensions[1].sd, estimate.dimensions[2].sd);
  EXPECT_EQ(estimate.dimensions[3].sd, 2.0);
}

TEST(OutlinePerson, SegmentsByAnotherRulerLieWithinWhatIsStated) {
  // The last segment of the middle finger in Greiner 1991 is 28.7 mm in a hand of 194 mm; in the
  // template's proportions it is 35.3. The middle finger as a whole isn't known better by that.
  population::PersonEstimate estimate;
  estimate.dimensions = {
      {.dimension = {hand::DimensionKind::kSegmentLength, hand::Segment::kMiddleDistal},
       .value = 35.3,
       .sd = 1.8},
      {.dimension = {hand::DimensionKind::kSegmentWidth, hand::Segment::kIndexProximal},
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

TEST(OutlinePerson, AFirstSegmentErrsByWhatTheOthersDo) {
  // Greiner 1991, middle finger, men (hand 194.1 mm): 26.4 and 28.7 mm. In the template's
  // proportions 26.8 and 35.3: of the same finger 7 mm more are left for the first segment.
  const double middle = 26.8, distal = 35.3, left = middle + distal - 26.4 - 28.7;
  population::PersonEstimate estimate;
  estimate.dimensions = {
      {.dimension = {hand::DimensionKind::kSegmentLength, hand::Segment::kMiddleProximal},
       .value = 25.0,
       .sd = 1.0},
      {.dimension = {hand::DimensionKind::kSegmentLength, hand::Segment::kMiddleMiddle},
       .value = middle},
      {.dimension = {hand::DimensionKind::kSegmentLength, hand::Segment::kMiddleDistal},
       .value = distal},
      {.dimension = {hand::DimensionKind::kSegmentLength, hand::Segment::kThumbProximal},
       .value = 30.0}};
  allow_for_build(estimate);
  EXPECT_GT(1.96 * estimate.dimensions[0].sd, left);
  EXPECT_LT(1.96 * estimate.dimensions[0].sd, 2.0 * left);
  EXPECT_NEAR(estimate.dimensions[3].sd, 4.5, 0.01);  // the thumb's is no such rest
}

TEST(OutlinePerson, DepthsOfOtherPeopleLieWithinWhatIsStated) {
  // Index finger, men, Greiner 1991: breadth 23.0 and circumference 68.4 mm at the PIP joint are
  // those of an ellipse 20.5 mm deep. In the template's proportion to the breadth: 23.2.
  population::PersonEstimate estimate;
  estimate.dimensions = {
      {.dimension = {hand::DimensionKind::kSegmentThickness, hand::Segment::kIndexMiddle},
       .value = 23.2}};
  allow_for_build(estimate);
  EXPECT_GT(1.96 * estimate.dimensions[0].sd, 23.2 - 20.5);
  EXPECT_LT(1.96 * estimate.dimensions[0].sd, 2.0 * (23.2 - 20.5));
}

}  // namespace
}  // namespace palmar::capture
