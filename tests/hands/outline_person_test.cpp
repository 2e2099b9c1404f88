// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/sheet/outline_person.h"

#include <gmock/gmock.h>

#include <cmath>

#include "hands/capture/sheet/silhouette.h"
#include "hands/phantom/person/spread_hand.h"
#include "hands/phantom/photo/sheet_photograph.h"
#include "palmar/records/population/population_file.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

/// Hands placed on A4 and seen by a camera without error: what the method itself misses.
class OutlinePersonTest : public TemplateTest {
 protected:
  static capture::OutlineScene scene(double tilt, bool palm_up = false) {
    capture::OutlineScene scene;
    scene.sheet.format = capture::sheet_format_named("a4");
    scene.sheet.eye = 430.0 * Vec3(std::sin(tilt) * 0.6, std::sin(tilt) * 0.8, std::cos(tilt));
    scene.grid = capture::grid_of_sheet(scene.sheet, capture::kOutlineCell);
    scene.proportions = capture::outline_proportions(hand().dimensions);
    scene.options.palm_up = palm_up;
    return scene;
  }
  static capture::HandOutline seen(const phantom::SpreadHand& spread,
                                   const capture::OutlineScene& scene, std::uint64_t seed) {
    phantom::SheetPhotographOptions place;
    place.seed = seed;
    const imaging::VoxelMask mask =
        capture::silhouette(phantom::hand_on_sheet(spread, place), scene.sheet.eye, scene.grid);
    return capture::measure_outline(scene.grid, mask, scene.sheet, scene.proportions, "hand.jpg");
  }
  static double finger(const hand::HandDimensions& d, int f) {
    double sum = 0.0;
    for (const auto& s : hand::segments_of(static_cast<hand::Finger>(f))) {
      if (s) sum += d.segment[static_cast<std::size_t>(*s)].length;
    }
    return sum;
  }
};

TEST_F(OutlinePersonTest, APersonThatIsNoneOfPalmarsHandsIsFound) {
  // Another skin, other joints and proportions (make_person()); a right and a left hand, the camera
  // straight above and 10 degrees off.
  const population::Population population = records::load_population("ansur2");
  for (const std::uint64_t seed : {61U, 62U}) {
    const hand::Side side = seed % 2 == 0 ? hand::Side::kLeft : hand::Side::kRight;
    const phantom::SpreadHand truth = phantom::spread_person(hand(), side, {.seed = seed});
    const capture::OutlineScene place = scene(seed % 2 == 0 ? 0.17 : 0.0);
    const capture::HandOutline outline = seen(truth, place, seed);
    EXPECT_EQ(outline.is_right, side == hand::Side::kRight);
    const capture::OutlinePerson person =
        capture::person_of_outline(hand(), population, {}, outline, place);
    ASSERT_TRUE(person.model);
    EXPECT_EQ(person.hand.side, side);
    // Creases of people lie 1 mm from where joints have them; twice the errors reported.
    const capture::OutlineErrors errors;
    EXPECT_NEAR(person.outline.hand_length, truth.dimensions.hand_length, 2.0 * errors.length);
    for (int f = 1; f < 5; ++f) {
      EXPECT_NEAR(person.outline.finger[static_cast<std::size_t>(f)].length,
                  finger(truth.dimensions, f), 2.0 * errors.finger)
          << f;
    }
  }
}

TEST_F(OutlinePersonTest, OneOfPalmarsHandsIsFoundNearlyAsItIs) {
  // Only what the measures miss of a hand is left, and that is taken off.
  const phantom::SpreadHand truth = phantom::spread_hand(hand(), {.seed = 4});
  const capture::OutlineScene place = scene(0.1);
  const capture::HandOutline outline = seen(truth, place, 4);
  const capture::OutlinePerson person =
      capture::person_of_outline(hand(), records::load_population("ansur2"), {}, outline, place);
  ASSERT_TRUE(person.model);
  EXPECT_LT(person.model->direction_error, 0.03);
  const hand::HandDimensions straight = capture::straight_dimensions(hand());
  EXPECT_NEAR(person.outline.hand_length, straight.hand_length, 1.0);
  for (int f = 1; f < 5; ++f) {
    EXPECT_NEAR(person.outline.finger[static_cast<std::size_t>(f)].length, finger(straight, f), 1.5)
        << f;
  }
}

TEST_F(OutlinePersonTest, AHandsBackAndPalmAreDistinguished) {
  // The outline of a left hand on its palm is that of a right hand on its back.
  const phantom::SpreadHand left = phantom::spread_person(hand(), hand::Side::kLeft, {.seed = 61});
  const capture::OutlineScene place = scene(0.0, true);
  capture::HandOutline outline = seen(left, place, 61);
  outline.is_right = true;
  const capture::OutlinePerson person =
      capture::person_of_outline(hand(), records::load_population("ansur2"), {}, outline, place);
  ASSERT_TRUE(person.model);
  EXPECT_EQ(person.hand.side, hand::Side::kRight);
  EXPECT_LT(person.model->direction_error, 0.03);
  // The back of a hand lies otherwise on a table than its palm: 3 mm.
  EXPECT_NEAR(person.outline.hand_length, left.dimensions.hand_length, 3.0);
}

TEST_F(OutlinePersonTest, WhatIsStatedCountsInsteadOfThePhotograph) {
  const population::KnownMeasure stated =
      population::KnownMeasure::of({hand::DimensionKind::kHandLength}, 190.0, 0.5);
  capture::HandOutline outline;
  outline.hand_length = 170.0;
  outline.hand_width = 80.0;
  const auto all =
      capture::measures_together({stated}, capture::measures_of(outline, capture::OutlineErrors{}));
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].value, 190.0);
  EXPECT_EQ(all[1].value, 80.0);
  // An error of scale adds to that of the measure: hypot(1.6, 0.02 * 80).
  EXPECT_NEAR(capture::measures_of(outline, capture::OutlineErrors{.width = 1.6}, 0.02)[1].sd,
              std::hypot(1.6, 1.6), 1e-12);
}

TEST_F(OutlinePersonTest, APersonsTruthIsThatOfStraightFingers) {
  const phantom::SpreadHand one = phantom::spread_person(hand(), hand::Side::kRight, {.seed = 61}),
                            other = phantom::spread_person(hand(), hand::Side::kLeft, {.seed = 61});
  EXPECT_EQ(one.dimensions.hand_length, other.dimensions.hand_length);
  EXPECT_NEAR(one.wrist.x(), -other.wrist.x(), 1e-12);
  // From the wrist to the tip of the middle finger in the skin itself, which is spread by a degree.
  const double seen = (one.fingertips[1] - one.wrist).head<2>().norm();
  EXPECT_NEAR(one.dimensions.hand_length, seen, 1.5);
  // The palm and the three segments of the finger make the hand's length.
  const double parts = one.dimensions.segment[0].length +
                       finger(one.dimensions, static_cast<int>(hand::Finger::kMiddle));
  EXPECT_NEAR(parts, one.dimensions.hand_length, 3.0);
}

}  // namespace
}  // namespace palmar::tests
