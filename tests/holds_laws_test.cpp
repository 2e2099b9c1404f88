// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The hold belongs to the product's shape: it depends neither on where the product lies in its file
// and how it is meshed, nor on the hand's side or a hundredth of its size.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "holds/peoples_holds.h"
#include "holds/tried_products.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/hand/instance/scaled_hand.h"
#include "palmar/hand/mirror.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

constexpr double kLawDeg = std::numbers::pi / 180.0;

// Their own mirror images across the held part: both ends of it are the same, so either may come
// first.
bool is_reversible(const std::string& product) {
  static const std::set<std::string> names = {"suitcase", "bucket", "spade", "cube_60mm"};
  return names.contains(product);
}

// Laws that are known to be broken: "Law/product" and why. One that is listed here and holds fails,
// too: then it is struck off.
const std::map<std::string, std::string>& known_breaks() {
  static const std::string kPlaces =
      "fingertips come down in another of several places that score alike";
  static const std::string kPads = "pads come down in another minimum, some millimetres off";
  static const std::string kParts = "its parts hang on the voxels";
  static const std::string kPlacesAlong = "places along it score alike, by how the hand closes";
  static const std::string kAlike = "its two halves are alike";
  static const std::string kMirror = "joints close a little otherwise in the mirror image";
  static const std::string kThinMesh = "its rings are as thin as the mesh is coarse";
  static const std::map<std::string, std::string> breaks = {
      {"coarser/beer_bottle", kPlacesAlong},
      {"coarser/bucket", kParts},
      {"coarser/cookie_spatula", kPlacesAlong},
      {"coarser/cube_60mm", kPlaces},
      {"coarser/handheld_console", kPlaces},
      {"coarser/key", kParts},
      {"coarser/large_marker", kPlaces},
      {"coarser/lever_handle", kPlacesAlong},
      {"coarser/nail_scissors", kAlike},
      {"coarser/palm_sander", kParts},
      {"coarser/pliers", kAlike},
      {"coarser/power_drill", kPlacesAlong},
      {"coarser/scissors", kThinMesh},
      {"coarser/spray_bottle", kPlacesAlong},
      {"coarser/tailors_shears", kParts},
      {"coarser/tongs", kAlike},
      {"coarser/tv_remote", kAlike},
      {"coarser/wine_glass", kPlaces},
      {"finer/computer_mouse", kPads},
      {"finer/cube_60mm", kPlaces},
      {"finer/dinner_plate", kPlaces},
      {"finer/handheld_console", kPlaces},
      {"finer/large_marker", kPlaces},
      {"finer/rotary_knob", kPlaces},
      {"finer/spray_bottle", kPlacesAlong},
      {"larger/computer_mouse", kPads},
      {"larger/lever_handle", kPlacesAlong},
      {"larger/wine_glass", kParts},
      {"mirrored/ball_screwdriver", kMirror},
      {"mirrored/beer_bottle", kMirror},
      {"mirrored/drawer_knob", kPlaces},
      {"mirrored/flat_mouse", kPads},
      {"mirrored/lever_handle", kPlacesAlong},
      {"mirrored/nail_scissors", kAlike},
      {"mirrored/portable_drive", kMirror},
      {"mirrored/portable_speaker", kMirror},
      {"mirrored/screwdriver_phillips", kMirror},
      {"mirrored/spray_bottle", kPlacesAlong},
      {"mirrored/torch", kMirror},
      {"mirrored/tumbler", kMirror},
      {"mirrored/tv_remote", kAlike},
      {"shifted/computer_mouse", kPads},
      {"shifted/spray_bottle", kPlacesAlong},
      {"shuffled/cube_60mm", kPlaces},
      {"shuffled/drawer_knob", kPlaces},
      {"shuffled/handheld_console", kPlaces},
      {"shuffled/rotary_knob", kPlaces},
      {"shuffled/spray_bottle", kPlacesAlong},
      {"shuffled/wine_glass", kParts},
      {"turned/computer_mouse", kPads},
      {"turned/palm_sander", kParts},
      {"turned/spray_bottle", kPlacesAlong},
      {"turned/wine_glass", kParts},
  };
  return breaks;
}

struct FirstHold {
  bool is_found = false;
  grasp::RankedHold ranked;
  double part_length = 0.0;  // mm
  double centre = 0.0;       // from the product's middle, mm
};

FirstHold first_hold(const hand::Hand& hand, const product::Product& product) {
  grasp::RankedHolds found = grasp::rank_holds(hand, product);
  FirstHold first;
  if (found.holds.empty()) return first;
  first.is_found = true;
  first.ranked = std::move(found.holds.front());
  first.part_length = found.parts.parts.at(first.ranked.hold.part - 1).length;
  first.centre = (centre_of(first.ranked) - geometry::centre_of_volume(product.mesh)).norm();
  return first;
}

std::string words_of(const FirstHold& first) {
  if (!first.is_found) return "none";
  const grasp::Hold& h = first.ranked.hold;
  return fmt::format(
      "{}: part {} ({}), {}, along {:.3f}, toward {:+d}, turn {:.0f} deg, score {:.3f}",
      first.ranked.words, h.part, h.part_name, name_of(h.grip), h.along, h.toward, h.turn / kLawDeg,
      first.ranked.score);
}

// What tells two holds apart, in words; "" if nothing does: part, grip, place and direction. Of
// fingertips: how far from the product's middle, because places that symmetry makes equal have
// other coordinates.
std::string difference(const FirstHold& a, const FirstHold& b, const std::string& product) {
  if (!a.is_found || !b.is_found) return a.is_found == b.is_found ? "" : "found once only";
  const grasp::Hold &p = a.ranked.hold, &q = b.ranked.hold;
  if (p.part != q.part || p.part_name != q.part_name) return "another part";
  if (p.grip != q.grip) return "another grip";
  if (!grasp::is_power(p.grip)) {
    if (p.fingertips.size() != q.fingertips.size()) return "other fingers";
    // A fiftieth of the part, at least the finest lattice's step.
    const double tolerance = std::max(3.0, 0.02 * a.part_length);  // mm
    return std::abs(a.centre - b.centre) <= tolerance
               ? ""
               : fmt::format("fingertips {:.1f} mm further out", b.centre - a.centre);
  }
  const bool is_same = p.toward == q.toward && std::abs(p.along - q.along) <= 0.02;
  const bool is_reverse = is_reversible(product) && p.toward == -q.toward &&
                          std::abs(p.along - (1.0 - q.along)) <= 0.02;
  if (is_same || is_reverse) return "";
  return p.toward == q.toward ? "another place along the part" : "the hand is turned round";
}

// Reports a difference unless it is known; `law` as known_breaks() has it.
void expect_no_difference(const std::string& law, const std::string& product,
                          const std::string& difference, const FirstHold& a, const FirstHold& b) {
  const auto known = known_breaks().find(law + "/" + product);
  if (known == known_breaks().end()) {
    EXPECT_EQ(difference, "") << product << "\n  as it is: " << words_of(a)
                              << "\n  this way: " << words_of(b);
  } else {
    EXPECT_NE(difference, "") << "the law holds; strike it off the known breaks: " << known->second;
  }
}

class LawsOfHolds : public TemplateTest, public testing::WithParamInterface<std::string> {
 protected:
  static const product::Product& as_it_is() {
    static std::map<std::string, product::Product> known;
    const auto found = known.find(GetParam());
    return found != known.end()
               ? found->second
               : known.emplace(GetParam(), tried_product(GetParam())).first->second;
  }
  static const FirstHold& first() {
    static std::map<std::string, FirstHold> known;
    const auto found = known.find(GetParam());
    return found != known.end()
               ? found->second
               : known.emplace(GetParam(), first_hold(hand(), as_it_is())).first->second;
  }
  static void expect_same(const std::string& law, const FirstHold& other) {
    expect_no_difference(law, GetParam(), difference(first(), other, GetParam()), first(), other);
  }
};

TEST_P(LawsOfHolds, StayWhenTheProductIsShiftedAndTurnedALittle) {
  const geometry::Rigid3 motion = {Quat(Eigen::AngleAxisd(5.0 * kLawDeg, Vec3(0.6, -0.48, 0.64))),
                                   Vec3(100.0, 0.0, 0.0)};
  expect_same("shifted", first_hold(hand(), moved(as_it_is(), motion)));
}

TEST_P(LawsOfHolds, StayWhenTheProductIsTurnedAnyhow) {
  const geometry::Rigid3 motion = {Quat(Eigen::AngleAxisd(2.2, Vec3(0.36, 0.48, -0.8))),
                                   Vec3(-40.0, 25.0, 310.0)};
  expect_same("turned", first_hold(hand(), moved(as_it_is(), motion)));
}

TEST_P(LawsOfHolds, StayOnAMeshWithHalfTheEdgeLength) {
  expect_same("finer", first_hold(hand(), with_finer_mesh(GetParam())));
}

TEST_P(LawsOfHolds, StayOnAMeshWithDoubleTheEdgeLength) {
  expect_same("coarser", first_hold(hand(), with_coarser_mesh(GetParam())));
}

TEST_P(LawsOfHolds, StayWhenTrianglesAreShuffled) {
  expect_same("shuffled", first_hold(hand(), shuffled(as_it_is())));
}

TEST_P(LawsOfHolds, AreMirroredWithProductAndHand) {
  const FirstHold mirror = first_hold(mirrored(hand()), mirrored(as_it_is()));
  std::string what = difference(first(), mirror, GetParam());
  if (what.empty() && first().is_found) {
    double largest = 0.0;  // rad
    for (std::size_t d = 0; d < mirror.ranked.grasp.posture.angle.size(); ++d) {
      largest = std::max(largest, std::abs(mirror.ranked.grasp.posture.angle[d] -
                                           first().ranked.grasp.posture.angle[d]));
    }
    if (largest > 1e-4) what = fmt::format("joints differ by up to {:.2f} deg", largest / kLawDeg);
  }
  expect_no_difference("mirrored", GetParam(), what, first(), mirror);
}

TEST_P(LawsOfHolds, StayInAHandOneHundredthLarger) {
  expect_same("larger", first_hold(scaled(hand(), 1.01), as_it_is()));
}

INSTANTIATE_TEST_SUITE_P(Products, LawsOfHolds, testing::ValuesIn(tried_products()),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace palmar::tests
