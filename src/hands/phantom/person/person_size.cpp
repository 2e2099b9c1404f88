// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/person/person_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "hands/phantom/person/person_random.h"
#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/mesh/section.h"
#include "palmar/hand/instance/hand_instance.h"
#include "palmar/population/survey_figures.h"

namespace palmar::phantom {
namespace {

enum SizeStream : std::uint64_t { kSize = 1, kLengths = 6, kWidths = 8 };

using Targets = std::vector<hand::SizedDimension>;

PersonSize drawn_size(RandomStream& random, const PersonDispersion& dispersion) {
  PersonSize size;
  size.sex = random.uniform() < 0.5 ? grasp::Sex::kFemale : grasp::Sex::kMale;
  const population::AnsurFigures& s = population::ansur2_figures(size.sex);
  // Near relatives of seeds that older figures name stay the persons they were.
  constexpr double kOlderWomen = 0.5697;
  const double r =
      dispersion.is_free || size.sex == grasp::Sex::kMale ? s.r_length_circumference : kOlderWomen;
  const double z = spread(random, 1.0), y = spread(random, 1.0);
  size.length =
      std::clamp(s.length.mean + s.length.sd * z, dispersion.shortest, dispersion.longest);
  size.girth = s.circumference.mean + s.circumference.sd * (r * z + std::sqrt(1.0 - r * r) * y);
  if (!dispersion.is_free) size.girth = std::clamp(size.girth, 170.0, 222.0);
  return size;
}

void set_length(Targets& targets, hand::Segment segment, double length) {
  targets.push_back({{hand::DimensionKind::kSegmentLength, segment}, length});
}

// Lengths of phalanges vary by about 3 % beside the hand's size; the middle finger follows.
void add_relative(const hand::Hand& base, double larger, RandomStream& random, Targets& targets) {
  set_length(targets, hand::Segment::kPalm,
             base.dimensions.segment[0].length * larger * (1.0 + spread(random, 0.015)));
  for (int k = 1; k < hand::kSegmentCount; ++k) {
    const auto segment = static_cast<hand::Segment>(k);
    const double own = 1.0 + spread(random, 0.03);
    if (hand::finger_of(segment) == hand::Finger::kMiddle) continue;
    set_length(targets, segment, base.dimensions.segment[k].length * larger * own);
  }
}

// Of a link in proportion to hand length, with its scatter at given length.
double link_length(const population::Moment& link, const population::Moment& length,
                   double hand_length, RandomStream& random) {
  return link.mean * hand_length / length.mean *
         (1.0 + spread(random, population::residual_share(link, length)));
}

}  // namespace

double finger_breadth(const geometry::TriangleMesh& skin, const Vec3& joint, const Vec3& axis,
                      const Vec3& along) {
  double best = 1e9, breadth = 15.0;
  for (const geometry::SectionCurve& curve : geometry::plane_section(skin, joint, along)) {
    const double d = (geometry::curve_centre(curve) - joint).norm();
    if (d >= best) continue;
    best = d;
    breadth = geometry::extent(curve.point, axis);
  }
  return breadth;
}

PersonSize drawn_size(std::uint64_t seed, const PersonDispersion& dispersion) {
  RandomStream random(seed, kSize);
  return drawn_size(random, dispersion);
}

namespace {

// Segments of the four fingers that hand length and palm leave; nothing if one is out of
// proportion.
std::optional<Targets> finger_lengths(const hand::HandDimensions& base, const PersonSize& size,
                                      double palm, RandomStream& random) {
  constexpr std::array<double, 4> kOfMiddle{0.91, 1.0, 0.93, 0.76};
  constexpr std::array<double, 3> kLeast{0.7, 0.85, 0.9}, kMost{1.4, 1.15, 1.12};
  const population::GreinerFigures& greiner = population::greiner_figures(size.sex);
  Targets targets;
  for (int f = 0; f < 4; ++f) {
    const auto segments = hand::segments_of(static_cast<hand::Finger>(f + 1));
    const auto& link = greiner.link[f];
    const double whole = kOfMiddle[f] * (size.length - palm);
    std::array<double, 3> usual{}, part{};
    usual[0] = part[0] = whole * (f == 1 ? 1.0 : 1.0 + spread(random, 0.03));
    for (std::size_t k = 1; k < 3; ++k) {
      usual[k] = link[k].mean * size.length / greiner.length.mean;
      part[k] = link_length(link[k], greiner.length, size.length, random);
      usual[0] -= usual[k];
      part[0] -= part[k];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const double made_of = base.segment[index_of(*segments[k])].length;
      if (part[k] < std::max(kLeast[k] * usual[k], 0.55 * made_of)) return {};
      if (part[k] > kMost[k] * usual[k]) return {};
      // The middle finger's proximal segment is what hand length leaves.
      if (f != 1 || k > 0) set_length(targets, *segments[k], part[k]);
    }
  }
  return targets;
}

}  // namespace

std::vector<hand::SizedDimension> surveyed_lengths(const hand::HandDimensions& base,
                                                   const PersonSize& size, std::uint64_t seed) {
  RandomStream random(seed, kLengths);
  const population::AnsurFigures& ansur = population::ansur2_figures(size.sex);
  const population::GreinerFigures& greiner = population::greiner_figures(size.sex);
  const double usual = ansur.palm.mean + ansur.palm_slope * (size.length - ansur.length.mean);
  constexpr int kTries = 20'000;
  for (int k = 0; k < kTries; ++k) {
    const double palm = usual + spread(random, ansur.palm_residual);
    std::optional<Targets> targets = finger_lengths(base, size, palm, random);
    if (!targets) continue;
    set_length(*targets, hand::Segment::kPalm, palm);
    const double larger = size.length / base.hand_length;
    set_length(*targets, hand::Segment::kThumbProximal,
               base.segment[index_of(hand::Segment::kThumbProximal)].length * larger *
                   (1.0 + spread(random, 0.085)));
    set_length(*targets, hand::Segment::kThumbDistal,
               link_length(greiner.thumb_distal, greiner.length, size.length, random));
    return *targets;
  }
  throw InputError(fmt::format(
      "a free person with a hand of {:.0f} mm can't be made from a start hand of {:.0f} mm",
      size.length, base.hand_length));
}

std::array<double, hand::kFingerCount> surveyed_widenings(const hand::Hand& hand,
                                                          std::uint64_t seed,
                                                          const PersonDispersion& dispersion) {
  const PersonSize size = drawn_size(seed, dispersion);
  const population::GreinerFigures& greiner = population::greiner_figures(size.sex);
  const auto wider = [&](hand::JointId pip, hand::JointId dip, const population::Moment& breadth) {
    const hand::Joint& joint = hand.skeleton.joint(pip);
    const Vec3 along = (hand.skeleton.joint(dip).centre - joint.centre).normalized();
    return breadth.mean * size.girth / greiner.circumference.mean /
           finger_breadth(hand.skin, joint.centre, joint.dofs.back().axis, along);
  };
  const double both =
      0.5 * (population::residual_share(greiner.index_pip_breadth, greiner.circumference) +
             population::residual_share(greiner.middle_pip_breadth, greiner.circumference));
  const double each = both * std::sqrt(0.5);
  RandomStream random(seed, kWidths);
  const double common =
      0.5 * (1.0 + spread(random, each)) *
      (wider(hand::JointId::kIndexPip, hand::JointId::kIndexDip, greiner.index_pip_breadth) +
       wider(hand::JointId::kMiddlePip, hand::JointId::kMiddleDip, greiner.middle_pip_breadth));
  std::array<double, hand::kFingerCount> widening{};
  for (double& own : widening) own = common * (1.0 + spread(random, each));
  return widening;
}

hand::Hand sized_hand(const hand::Hand& base, std::uint64_t seed,
                      const PersonDispersion& dispersion) {
  RandomStream random(seed, kSize);
  const PersonSize size = drawn_size(random, dispersion);
  Targets targets{{{hand::DimensionKind::kHandLength}, size.length},
                  {{hand::DimensionKind::kHandCircumference}, size.girth}};
  if (!dispersion.is_free) {
    add_relative(base, size.length / base.dimensions.hand_length, random, targets);
    return hand::make_hand_instance(base, targets).hand;
  }
  const Targets lengths = surveyed_lengths(base.dimensions, size, seed);
  targets.insert(targets.end(), lengths.begin(), lengths.end());
  return hand::make_hand_instance(base, targets).hand;
}

}  // namespace palmar::phantom
