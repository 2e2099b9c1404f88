// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/precision_holds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <utility>

#include "palmar/grasp/holds/hold_candidates.h"
#include "palmar/grasp/holds/hold_limits.h"
#include "palmar/grasp/holds/hold_terms.h"
#include "palmar/grasp/holds/hold_weights.h"
#include "palmar/grasp/power/grip_choice.h"
#include "palmar/grasp/precision/precision_search.h"
#include "palmar/grasp/precision/ring_targets.h"
#include "palmar/product/parts/part_place.h"
#include "palmar/product/parts/part_spread.h"

namespace palmar::grasp {
namespace {

// How much rarer a precision grip is than the best for such a thing: choices, in the order in which
// Feix et al. 2016 name the grips' usual objects.
struct GripPrior {
  Grip grip;
  double score;
};

constexpr double kSmallThing = 0.45;  // hand lengths: longer things aren't taken by fingertips
constexpr double kTinyThing = 0.12;   // hand lengths: only two fingers find room on it
constexpr double kFlatThing = 0.4;    // thickness over width: a key, a card
constexpr double kStem = 14.0;        // mm; thicker bars are for the whole hand
constexpr double kSmallKnob = 0.22;   // hand lengths: fingertips rather than the palm
constexpr double kLargeKnob = 0.28;   // hand lengths: the palm rather than fingertips
constexpr double kThinPlate = 30.0;   // mm
constexpr std::size_t kMostPlaces = 4;
constexpr double kHardly = 0.02;  // a lesser share of a pen or a small knob is none; choice

// Largest first, mm. Of a single part its own: principal axes of a cube are chance.
Vec3 sorted_extents(const HoldScene& scene) {
  const std::vector<product::ProductPart>& parts = scene.parts->parts;
  const product::ProductPart& only = parts.front();
  Vec3 extents = parts.size() > 1 ? body_shape(scene.product->mesh).extent
                                  : Vec3(only.length, only.width, only.thickness);
  std::sort(extents.begin(), extents.end(), std::greater<>());
  return extents;
}

// How much a thing is a pen, 0 to 1: as thin, slender and straight as one, or nearly so.
double pen_share(const HoldScene& scene, const product::ProductPart& part) {
  if (scene.parts->parts.size() > 1) return 0.0;
  if (part.kind != product::PartKind::kPen && part.kind != product::PartKind::kBar) return 0.0;
  const double diameter = std::max(part.diameter(), 1e-9);
  return smooth_step(diameter, 3.0, 5.0) * smooth_step(diameter, 20.0, 16.0) *
         smooth_step(part.length / diameter, 4.5, 5.5) *
         smooth_step(part.straightness, 0.97, 0.99) *
         smooth_step(part.thickness / std::max(part.width, 1e-9), 0.3, 0.5);
}

std::vector<GripPrior> priors(const HoldScene& scene, const product::ProductPart& part,
                              const Vec3& extents) {
  const double length = scene.hand->dimensions.hand_length;
  using enum Grip;
  if (const double pen = pen_share(scene, part); pen > kHardly) {
    return {{kTripod, std::log(pen)}, {kPalmarPinch, std::log(pen) - 1.5}};
  }
  if (extents[0] < kSmallThing * length) {
    if (extents[0] < kTinyThing * length) return {{kTipPinch, -0.3}, {kPalmarPinch, -0.5}};
    const bool is_box =
        scene.parts->parts.size() == 1 && product::face_axes_of(scene.product->mesh).is_box();
    // Fingertips spread round what is round; on a box they press on two faces.
    if (is_box && extents[2] >= kFlatThing * extents[1]) {
      return {{kTripod, -0.4}, {kPalmarPinch, -0.8}, {kPrecisionSphere, -1.0}};
    }
    if (extents[2] < kFlatThing * extents[1]) return {{kLateral, -0.2}, {kPalmarPinch, -0.6}};
    return {{kPrecisionSphere, -0.4}, {kTripod, -0.6}, {kPalmarPinch, -1.2}};
  }
  if (part.kind == product::PartKind::kPlate && part.thickness < kThinPlate) {
    // Who can span it takes it into the palm.
    const double spanned = part.width < kHandSpan * length ? 1.0 : 0.0;
    return {{kPalmarPinch, -1.5 - spanned}, {kLateral, -1.7 - spanned}};
  }
  return {};
}

/// Where people's fingertips would most likely be, of a grip on a part or anywhere, by the weights
/// of holds to hand over: what a place is worth there doesn't depend on what it is for.
class LikelyPlaces {
 public:
  LikelyPlaces(const HoldScene& scene, const Progress& progress)
      : scene_(scene), hand_(*scene.hand), progress_(progress) {}

  OpenedHand& hand() { return hand_; }

  /// So that of() knows these grips' holds.
  void look_for(const std::vector<GripPrior>& grips) {
    std::vector<Grip> unseen;
    for (const GripPrior& one : grips) {
      if (seen_.insert(one.grip).second) unseen.push_back(one.grip);
    }
    if (std::none_of(unseen.begin(), unseen.end(), is_opposed)) return;
    for (OpposedHold& hold : opposed_holds(hand_, *scene_.product, unseen, progress_)) {
      all_.push_back(std::move(hold));
    }
  }

  /// Likeliest first; of the first ones the fingertips may not reach the surface.
  std::vector<OpposedPlace> of(Grip grip, const product::ProductPart* part) const {
    std::vector<OpposedHold> some;
    for (const OpposedHold& hold : all_) {
      if (hold.grip == grip && (part == nullptr || is_within(*part, hold))) some.push_back(hold);
    }
    std::vector<OpposedPlace> places;
    const Eigen::VectorXd chance = chances(hand_over_weights(), some, scene_.lay);
    for (const HoldMode& mode : modes_of(some, chance, kMostPlaces)) {
      places.push_back(some[mode.hold].place);
    }
    return places;
  }

 private:
  // The part is between thumb and fingers.
  static bool is_within(const product::ProductPart& part, const OpposedHold& hold) {
    const product::PartPlace place =
        product::place_of(part, 0.5 * (hold.place.thumb + hold.place.others));
    return place.along >= 0.0 && place.along <= 1.0 && place.height <= 0.5 * part.width;
  }

  const HoldScene& scene_;
  OpenedHand hand_;
  const Progress& progress_;
  std::set<Grip> seen_;
  std::vector<OpposedHold> all_;
};

RankedHold ranked_of(const HoldScene& scene, const Grasp& grasp, double prior) {
  RankedHold ranked;
  ranked.grasp = grasp;
  Hold& hold = ranked.hold;
  hold.grip = grasp.grip;
  Vec3 middle = Vec3::Zero();
  for (const FingertipContact& tip : grasp.fingertips) middle += tip.target;
  middle /= static_cast<double>(grasp.fingertips.size());
  hold.part = scene.parts->nearest(*scene.product, middle) + 1;
  const product::ProductPart& part = scene.parts->parts[hold.part - 1];
  hold.part_name = part.name;
  hold.along = std::clamp(product::place_of(part, middle).along, 0.0, 1.0);
  for (const FingertipContact& tip : grasp.fingertips) {
    hold.fingertips.push_back({tip.finger, product::place_of(part, tip.target)});
  }
  ranked.terms.push_back({"grip", 0.0, "", prior,
                          prior < -0.5 ? "seldom taken by the fingertips" : "taken by fingertips"});
  ranked.terms.push_back(handle_term(scene, hold.part));
  const double held = grasp.status == GraspStatus::kHeld         ? 0.0
                      : grasp.status == GraspStatus::kPartlyHeld ? -3.0
                                                                 : -8.0;
  ranked.terms.push_back({"closing", 0.0, "", held, grasp.message});
  return ranked;
}

}  // namespace

std::vector<RankedHold> precision_holds(const HoldScene& scene, const HoldOptions& options,
                                        const Progress& progress) {
  std::vector<RankedHold> found;
  if (scene.parts->parts.empty() || options.is_power_only ||
      (options.grip && (is_power(*options.grip) || is_non_prehensile(*options.grip))))
    return found;
  const std::optional<ScissorRings> rings = scissor_rings(*scene.parts, *scene.product);
  std::vector<GripPrior> grips;
  if (options.grip) {
    grips.push_back({*options.grip, 0.0});
  } else {
    // What has a handle is taken there.
    const bool is_passed_over = scene.passed_over(1) > 0.5;
    if (!is_passed_over) {
      grips = priors(scene, scene.parts->parts.front(), sorted_extents(scene));
    }
    // What two rings are for (Feix et al. 2016, grip 19).
    if (rings) grips.insert(grips.begin(), {Grip::kDistalType, 0.0});
  }
  LikelyPlaces likely(scene, progress);
  const auto try_grips = [&](const std::vector<GripPrior>& list, const product::ProductPart* part) {
    likely.look_for(list);
    for (const GripPrior& tried : list) {
      PrecisionGripOptions precision;
      precision.grip = tried.grip;
      std::vector<std::optional<OpposedPlace>> places;
      if (is_opposed(tried.grip)) {
        for (const OpposedPlace& place : likely.of(tried.grip, part)) places.emplace_back(place);
      } else {
        places.emplace_back();
        if (tried.grip == Grip::kDistalType && rings) {
          precision.targets = ring_targets(*scene.hand, *scene.product, *rings);
        } else if (part != nullptr) {
          precision.placement.at = product::part_frame(*part, 0.5, 0.0).translation;
        }
      }
      for (const std::optional<OpposedPlace>& place : places) {
        progress.throw_if_cancelled();
        precision.from = place;
        const Grasp grasp =
            close_precision_grip(likely.hand(), *scene.product, precision, progress);
        if (grasp.fingertips.empty()) continue;
        RankedHold ranked = ranked_of(scene, grasp, tried.score);
        if (is_part_asked(scene.parts->parts[ranked.hold.part - 1], options)) {
          found.push_back(std::move(ranked));
        }
        if (grasp.status == GraspStatus::kHeld) break;
      }
    }
  };
  const bool is_one_asked = options.part || !options.part_name.empty();
  if (is_one_asked) {
    for (const product::ProductPart& part : scene.parts->parts) {
      if (is_part_asked(part, options)) try_grips(grips, &part);
    }
    return found;
  }
  try_grips(grips, nullptr);
  if (options.grip || scene.parts->parts.size() < 2) return found;
  // A small knob on something larger; the stem of what has no handle.
  const double length = scene.hand->dimensions.hand_length;
  for (const product::ProductPart& part : scene.parts->parts) {
    const double small =
        smooth_step(std::max(part.length, part.width) / length, kLargeKnob, kSmallKnob);
    if (part.kind == product::PartKind::kBar && !scene.has_handle() && part.diameter() < kStem) {
      try_grips({{Grip::kTripod, -0.5}, {Grip::kPalmarPinch, -0.8}}, &part);
    }
    if (small < kHardly || part.kind == product::PartKind::kPlate ||
        part.kind == product::PartKind::kLoop || !scene.is_handle(part.number)) {
      continue;
    }
    const double prior = std::log(small) - 0.3;
    try_grips({{Grip::kPrecisionSphere, prior}, {Grip::kTripod, prior}}, &part);
  }
  return found;
}

}  // namespace palmar::grasp
