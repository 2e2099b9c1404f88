// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/prepared/resolution.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "palmar/contact/contact_test_hand.h"
#include "palmar/geometry/distance/analytic_distance.h"

namespace palmar::contact {
namespace {

using contact_test::ball_hand;

constexpr double kBall = 10.0;  // mm

/// The ball on the edge between two faces of a bar, 1.5 mm deep, with edges of skin of 1.5, 0.75
/// or 0.37 mm (subdivisions 3 to 5).
ContactResult press_edge(double fillet, int subdivisions, bool refine = false) {
  static const std::array<PreparedHand, 3> hands = {PreparedHand(ball_hand(kBall, 3)),
                                                    PreparedHand(ball_hand(kBall, 4)),
                                                    PreparedHand(ball_hand(kBall, 5))};
  const PreparedHand& hand = hands[static_cast<std::size_t>(subdivisions - 3)];
  const auto bar = geometry::make_prism_distance(
      {.width = 40, .depth = 40, .length = 60, .fillet_radius = fillet});
  const double apex = std::sqrt(2.0) * (20.0 - fillet) + fillet;
  const double away = (apex + kBall - 1.5) / std::sqrt(2.0);
  geometry::Rigid3 place;
  place.translation = Vec3(away, away, 0.0);
  ContactOptions options;
  options.refine = refine;
  return solve_hand_contact(hand, hand.hand().skin.vertices, place, *bar, options);
}

TEST(Resolution, ThoroughWhatIsResolvedMovesByLessThan5PercentWhenTheMeshIsHalved) {
  int resolved = 0;
  for (const double fillet : {2.0, 4.0, 8.0}) {
    const ContactResult finest = press_edge(fillet, 5);
    for (const int subdivisions : {3, 4}) {
      const ContactResult contact = press_edge(fillet, subdivisions);
      if (contact.total.unresolved_force > kToldShare * contact.total.force) continue;
      ++resolved;
      EXPECT_EQ(unresolved_words(contact), "");
      EXPECT_NEAR(contact.total.peak_pressure_cells, finest.total.peak_pressure_cells,
                  0.05 * finest.total.peak_pressure_cells)
          << "fillet " << fillet << ", subdivisions " << subdivisions;
    }
  }
  EXPECT_GE(resolved, 3);
}

TEST(Resolution, ThoroughSharpEdgesAreToldAndTheirForceHoldsAllTheSame) {
  const ContactResult finest = press_edge(0.5, 5);
  for (const int subdivisions : {3, 4}) {
    const ContactResult contact = press_edge(0.5, subdivisions);
    EXPECT_GT(contact.total.unresolved_force, 0.9 * contact.total.force);
    EXPECT_THAT(unresolved_words(contact), testing::HasSubstr("sharper than the skin's mesh"));
    EXPECT_THAT(unresolved_words(contact), testing::HasSubstr("middle_distal "));
    EXPECT_NEAR(contact.total.force, finest.total.force, 0.05 * finest.total.force);
  }
}

TEST(Resolution, ThoroughSkinRefinedOnAnEdgeComesNearTheFinestMesh) {
  for (const double fillet : {2.0, 3.0}) {
    const double truth = press_edge(fillet, 5).total.peak_pressure_cells;
    const ContactResult refined = press_edge(fillet, 3, true);
    EXPECT_TRUE(is_resolved(refined));
    EXPECT_NEAR(refined.total.peak_pressure_cells, truth, 0.05 * truth) << fillet;
    EXPECT_GT(press_edge(fillet, 3).total.peak_pressure_cells, 1.05 * truth) << fillet;
  }
}

TEST(Resolution, RoundThingsAreResolved) {
  // Skin with edges of 1.5 mm: a rod of 8 mm turns by 0.37 rad over one, one of 4 mm by 0.75.
  const PreparedHand hand(ball_hand(kBall, 3));
  for (const double radius : {4.0, 2.0}) {
    const contact_test::Ball knob(Vec3(0.0, 0.0, -kBall - radius + 0.5), radius);
    const ContactResult contact = solve_hand_contact(hand, hand.hand().skin.vertices, {}, knob);
    ASSERT_GT(contact.total.force, 0.0);
    EXPECT_EQ(unresolved_words(contact).empty(), radius > 3.0) << radius;
  }
}

}  // namespace
}  // namespace palmar::contact
