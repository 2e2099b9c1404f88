// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/hold_candidates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "palmar/geometry/degrees.h"
#include "palmar/grasp/holds/hold_limits.h"
#include "palmar/grasp/power/grip_choice.h"

namespace palmar::grasp {
namespace {

// Eighths of a turn; what mirrored products have mirrored stands together.
constexpr std::array<int, 8> kPalmSides = {0, 4, 1, -1, 3, -3, 2, -2};
constexpr double kTowardLimit =
    60.0 * geometry::kDegree;        // the thumb's side may be off what was asked by
constexpr double kEndMargin = 4.0;   // mm of a handle that stick out of the fist
constexpr double kShortPart = 1.25;  // breadths of the fingers; shorter: one place
constexpr double kSamePlace = 0.25;  // breadths of the fingers; nearer places are the same; choice
constexpr double kIndexBeyond = 0.25;    // one of four fingers lies beyond a short handle's end
constexpr double kBelowTrigger = 0.25;   // of the fingers' breadth: one finger; choice
constexpr double kCircle = 1.05;         // of a circle's girth; a square has 1.27; choice
constexpr double kPalmAlong = 0.9;       // cosine; choice
constexpr double kIndexPlaceOf = 0.375;  // of the fingers' breadth: the index finger's middle

struct CandidatePlace {
  double along = 0.5, edge = 0.0;
};

// Where a loop's line leaves the opening at the thumb's end.
double end_of_opening(const product::ProductPart& part, int toward) {
  const Vec3 chord = part.line.back().centre - part.line.front().centre;
  Vec3 along = part.opening->wide * (part.opening->wide.dot(chord) < 0.0 ? -1.0 : 1.0);
  along *= toward;
  double best = 0.5, least = 1e300;
  for (const product::PartStation& station : part.line) {
    if (std::abs(station.axis.dot(along)) < 0.5) continue;  // it runs across there
    const double beyond = along.dot(station.centre - part.opening->centre);
    const double gap = std::abs(beyond - 0.5 * part.opening->width);
    if (gap >= least) continue;
    least = gap;
    best = station.along;
  }
  return best;
}

// Where on a part hands could be, the thumb's side to `toward`.
std::vector<CandidatePlace> places_on(const HoldScene& scene, const product::ProductPart& part,
                                      int toward) {
  const double breadth = fingers_breadth(*scene.hand);
  const double thumb_end = toward > 0 ? 1.0 : 0.0;
  std::vector<CandidatePlace> places;
  if (part.is_ring) {
    for (const double along : {0.0, 0.25, 0.5, 0.75}) places.push_back({along, 0.0});
    return places;
  }
  const product::PartTrigger* trigger = trigger_of(scene, part);
  if (trigger != nullptr && trigger->end == (toward > 0 ? 1U : 0U)) {
    // The index finger on the trigger, which may stand before what the handle carries.
    // At its middle; or a finger lower, from where the index finger reaches up to it: what the
    // handle carries may be in the way of the thumb's ball.
    for (const double lower : {0.0, kBelowTrigger}) {
      const double at = trigger->along - toward * lower * breadth / part.length;
      const double end = std::clamp(at, 0.0, 1.0);
      const double beyond = toward * (at - end) * part.length;
      places.push_back({end, std::max(-0.5, kIndexPlaceOf - beyond / breadth)});
    }
  }
  places.push_back({0.5, 0.0});
  if (part.opening) {
    // The index finger right below where the opening ends, so that the thumb lies on top of it.
    places.push_back({end_of_opening(part, toward), 0.5});
    return places;
  }
  if (part.length < kShortPart * breadth) {
    // The index finger finds room beyond the end at what the handle carries: on its trigger.
    const std::size_t end = toward > 0 ? 1 : 0;
    if (part.kind == product::PartKind::kBar && part.ends[end].joined) {
      places.push_back({thumb_end, 0.5 - kIndexBeyond});
    }
    return places;
  }
  const double margin = kEndMargin / part.length;
  places.push_back({std::abs(thumb_end - margin), 0.5});
  places.push_back({std::abs(1.0 - thumb_end - margin), -0.5});
  const double half = 0.5 * breadth / part.length;
  const auto add_middle = [&](double along) {
    const double kept = std::clamp(along, half, 1.0 - half);
    const bool is_new =
        std::none_of(places.begin(), places.end(), [&](const CandidatePlace& other) {
          return other.edge == 0.0 &&
                 std::abs(kept - other.along) * part.length < kSamePlace * breadth;
        });
    if (is_new) places.push_back({kept, 0.0});
  };
  add_middle(product::place_of(part, scene.gravity_centre).along);
  for (const product::PartWaist& waist : part.waists) add_middle(waist.along);
  return places;
}

bool is_toward(const HoldOptions& options, const HoldSite& at) {
  if (!options.toward) return true;
  return at.site.axis.dot(options.toward->normalized()) > std::cos(kTowardLimit);
}

Grip grip_for(const product::ProductPart& part, const HoldSite& at, bool is_over_end,
              const HoldOptions& options, double hand_length) {
  if (options.grip) return *options.grip;
  if (part.kind == product::PartKind::kBall || is_over_end) return Grip::kPowerSphere;
  return wrap_for(at.site.girth, hand_length);
}

/// The turn about a part's axis at which the palm lies as in that hold of another product; nothing
/// if its palm faces along the axis.
std::optional<double> turn_like(const product::ProductPart& part, double along, const Quat& like) {
  const geometry::Rigid3 frame = product::part_frame(part, along, 0.0);
  const Vec3 axis = frame.rotation * Vec3::UnitX(), zero = frame.rotation * Vec3::UnitZ();
  const Vec3 palm = like * -Vec3::UnitZ();  // from the axis to it: it faces along z
  if (std::abs(axis.dot(palm)) > kPalmAlong) return std::nullopt;
  return std::atan2(axis.dot(zero.cross(palm)), zero.dot(palm));
}

}  // namespace

bool is_round_about(const product::ProductPart& axis_of, const product::ProductParts& parts) {
  constexpr double kRound = 0.08;  // width over thickness, less 1
  constexpr double kOff = 2.0;     // mm beside the axis; or a share of the width
  const geometry::Rigid3 frame = product::part_frame(axis_of, 0.5, 0.0);
  const Vec3 axis = frame.rotation * Vec3::UnitX();
  for (const product::ProductPart& part : parts.parts) {
    if (part.kind == product::PartKind::kLoop || part.is_ring || part.sections.empty())
      return false;
    const double width = std::max(part.width, 1.0);
    if (part.width > (1.0 + kRound) * part.thickness) return false;
    for (const product::PartStation& station : part.line) {
      const Vec3 r = station.centre - frame.translation;
      if ((r - axis * axis.dot(r)).norm() > std::max(kOff, 0.05 * width)) return false;
    }
  }
  return true;
}

bool is_part_asked(const product::ProductPart& part, const HoldOptions& options) {
  if (options.part && *options.part != part.number) return false;
  return options.part_name.empty() || options.part_name == part.name ||
         options.part_name == name_of(part.kind);
}

std::vector<HoldCandidate> power_candidates(const HoldScene& scene, const HoldOptions& options) {
  std::vector<HoldCandidate> found;
  const double length = scene.hand->dimensions.hand_length;
  std::size_t place_number = 0;
  const auto add = [&](Hold hold, const product::ProductPart& part, int side) {
    HoldCandidate candidate;
    candidate.at = site_of(hold, *scene.parts, *scene.product, *scene.hand);
    if (!is_toward(options, candidate.at)) return;
    if (hold.grip != Grip::kFixedHook)
      hold.grip = grip_for(part, candidate.at, hold.is_over_end, options, length);
    candidate.terms = shape_terms(scene, hold, candidate.at);
    candidate.score = sum_of(candidate.terms) + rough_table_score(scene, candidate.at);
    candidate.hold = std::move(hold);
    // Mirror images of each other have the same number.
    candidate.index = 16 * place_number + static_cast<std::size_t>(std::abs(side));
    found.push_back(std::move(candidate));
  };
  for (const product::ProductPart& part : scene.parts->parts) {
    if (!is_part_asked(part, options) || part.line.size() < 2) continue;
    Hold hold;
    hold.part = part.number;
    hold.part_name = part.name;
    // A square bar is as broad as it is thick, too, but its edges count.
    const bool is_circle = part.girth < kCircle * std::numbers::pi * part.width;
    const bool is_round = options.like && is_circle && is_round_about(part, *scene.parts);
    for (const int toward : {1, -1}) {
      hold.toward = toward;
      std::vector<CandidatePlace> places = places_on(scene, part, toward);
      if (options.along) places = {{*options.along, 0.0}};
      for (const CandidatePlace& place : places) {
        hold.along = place.along;
        hold.edge = place.edge;
        ++place_number;
        const std::optional<double> like =
            is_round ? turn_like(part, place.along, *options.like) : std::nullopt;
        for (const int side : kPalmSides) {
          if (like && side != 0) continue;  // all sides are the same
          hold.turn = like.value_or(0.0) + 0.25 * std::numbers::pi * side;
          if (part.kind == product::PartKind::kLoop) hold.turn = std::numbers::pi;
          add(hold, part, part.kind == product::PartKind::kLoop ? 4 : side);
          if (part.kind != product::PartKind::kLoop) continue;
          if (!options.grip) {
            hold.grip = Grip::kFixedHook;
            add(hold, part, 4);
            hold.grip = Grip::kMediumWrap;
          }
          break;
        }
      }
    }
    // A knob or lid is taken from its free end; a whole ball from any side, so from these, too.
    const bool is_stub =
        part.kind == product::PartKind::kBar && part.length < kStubShare * part.diameter();
    const bool is_capped =
        part.kind == product::PartKind::kBall || part.kind == product::PartKind::kBody || is_stub;
    if (!is_capped || part.is_ring || options.along) continue;
    hold.is_over_end = true;
    hold.edge = 0.0;
    hold.toward = 1;
    for (const std::size_t end : {std::size_t{1}, std::size_t{0}}) {
      if (part.ends[end].joined) continue;
      hold.along = static_cast<double>(end);
      ++place_number;
      for (const int side : kPalmSides) {
        hold.turn = 0.25 * std::numbers::pi * side;
        add(hold, part, side);
      }
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const HoldCandidate& a, const HoldCandidate& b) {
    return a.score > b.score;
  });
  return found;
}

}  // namespace palmar::grasp
