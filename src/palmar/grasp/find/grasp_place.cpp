// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/find/grasp_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/grasp/holds/firm_hold.h"
#include "palmar/grasp/holds/hold_anchor.h"
#include "palmar/grasp/holds/hold_place.h"
#include "palmar/grasp/holds/laid_holds.h"
#include "palmar/grasp/holds/power_place.h"
#include "palmar/grasp/precision/laid_hand.h"
#include "palmar/grasp/precision/precision_grip.h"

namespace palmar::grasp {
namespace {

constexpr std::size_t kNextTried = 3;  // other holds that a hand tries which can't take the one

bool is_held(const Grasp& grasp) { return grasp.status == GraspStatus::kHeld; }

}  // namespace

struct GraspingHand::Impl {
  explicit Impl(std::shared_ptr<const hand::Hand> shared)
      : hand(std::move(shared)), coarse(*hand, kSearchSpacing), fine(*hand, 0.0) {}
  std::shared_ptr<const hand::Hand> hand;
  HandCloser coarse, fine;
};

GraspingHand::GraspingHand(std::shared_ptr<const hand::Hand> hand) {
  if (!hand) throw UsageError("grasping hand: no hand was given");
  impl_ = std::make_unique<Impl>(std::move(hand));
}

GraspingHand::~GraspingHand() = default;
GraspingHand::GraspingHand(GraspingHand&&) noexcept = default;
GraspingHand& GraspingHand::operator=(GraspingHand&&) noexcept = default;

const hand::Hand& GraspingHand::hand() const { return *impl_->hand; }

struct GraspPlace::Impl {
  const hand::Hand* reference;
  const product::Product* product;
  GraspOptions options;
  PowerGraspOptions power;          ///< of `options`, with the grip
  std::optional<PowerPlace> place;  ///< of a power grip
  std::optional<Hold> hold;         ///< unset: coordinates say where the hand goes
  RankedHolds ranked;               ///< whose parts the hold refers to
  Grasp grasp;

  void place_by_coordinates(const Progress& progress);
  void place_by_hold(const Progress& progress);
  const RankedHold& numbered(int number) const;  ///< of the ranked holds; throws UsageError
  void take_hold(const Progress& progress);
  Grasp take_precisely(const Hold& taken, const hand::Hand& hand, const Progress& progress) const;
  Grasp hold_power(const GraspingHand& hand, const Progress& progress) const;
  Grasp hold_precisely(const hand::Hand& hand, const Progress& progress) const;
  Grasp place_non_prehensile(const hand::Hand& hand) const;
  std::string other_hold_of(const GraspingHand& hand, Grasp& failed,
                            const Progress& progress) const;
};

void GraspPlace::Impl::place_by_coordinates(const Progress& progress) {
  if (options.grip && is_non_prehensile(*options.grip)) {
    grasp = place_non_prehensile(*reference);
    return;
  }
  if (options.grip && !is_power(*options.grip)) {
    PrecisionGripOptions precision = options.precision;
    precision.grip = *options.grip;
    grasp = close_precision_grip(*reference, *product, precision, progress);
    return;
  }
  power = options.power;
  power.grip = options.grip;
  place = find_power_place(*reference, *product, power, progress);
  grasp = place->grasp;
  if (!place->is_found) return;
  const HandCloser coarse(*reference, kSearchSpacing), fine(*reference, 0.0);
  grasp = close_at(*place, fine, *product, power, progress);
}

// A hand that rests or pushes where coordinates say. A laid hand has its middle knuckle there;
// its fingers point along `axis`, else along the coordinate axis that is most nearly level there.
Grasp GraspPlace::Impl::place_non_prehensile(const hand::Hand& hand) const {
  const PrecisionGripOptions& asked = options.precision;
  Vec3 point = asked.placement.at.value_or(product->distance->bounding_box().center());
  if (!asked.targets.empty()) point = asked.targets.front().point;
  if (*options.grip == Grip::kFingerPush) return close_finger_push(hand, *product, point);
  const geometry::DistanceSample at = product->distance->at(point);
  LaidSite site;
  site.knuckle = at.closest;
  site.up = options.holds.up ? options.holds.up->normalized() : at.normal;
  Eigen::Index level = 0;
  site.up.cwiseAbs().minCoeff(&level);
  site.fingers = asked.placement.axis.value_or(Vec3::Unit(level));
  site.fingers = (site.fingers - site.up * site.up.dot(site.fingers)).normalized();
  return close_laid_hand(hand, *product, *options.grip, site);
}

void GraspPlace::Impl::place_by_hold(const Progress& progress) {
  power = options.power;
  if (options.hold) {
    ranked.parts = options.parts ? *options.parts : product::find_parts(*product);
    hold = as_anchored(*options.hold, ranked.parts);
  } else {
    HoldOptions asked = options.holds;
    asked.grip = options.grip;
    asked.palm_limit_depth = power.palm_limit_depth;
    asked.finger_limit_depth = power.finger_limit_depth;
    asked.most = std::max(asked.most, options.hold_rank.value_or(1));
    ranked = rank_holds(*reference, *product, asked, progress);
    ranked.taken = options.hold_rank.value_or(1);
    if (options.grip_force && !options.hold_rank && !ranked.holds.empty()) {
      const FirmHold firm = firm_hold(ranked.holds, *options.grip_force);
      ranked.taken = firm.number;
      ranked.why_taken = firm.why;
    }
    if (ranked.holds.empty() && ranked.taken == 1) {
      power.grip = options.grip && is_power(*options.grip) ? options.grip : std::nullopt;
      grasp = no_place(*reference, *product);
      return;
    }
    hold = numbered(ranked.taken).hold;
  }
  take_hold(progress);
}

const RankedHold& GraspPlace::Impl::numbered(int number) const {
  if (number < 1 || static_cast<std::size_t>(number) > ranked.holds.size()) {
    throw UsageError(fmt::format("setting \"hold\" is {}; {} holds of {} were found", number,
                                 ranked.holds.size(), product->name));
  }
  return ranked.holds[static_cast<std::size_t>(number) - 1];
}

// The reference hand takes `hold`.
void GraspPlace::Impl::take_hold(const Progress& progress) {
  if (is_power(hold->grip)) {
    power.grip = hold->grip;
    const HandCloser coarse(*reference, kSearchSpacing), fine(*reference, 0.0);
    const HoldSite at = site_of(*hold, ranked.parts, *product, *reference);
    const GraspedSurface surface =
        grasped_surface_near(*hold, ranked.parts, *product, at, *reference);
    place = place_of_hold(at, hold->grip, surface, coarse, power, progress);
    grasp = place->is_found ? close_at(*place, fine, *product, power, progress) : place->grasp;
  } else {
    grasp = take_precisely(*hold, *reference, progress);
  }
  grasp.hold = hold;
  grasp.hold_words = words_of(*hold, ranked.parts);
  grasp.hold_kind = part_of(*hold, ranked.parts).kind;
  grasp.candidates = std::max(grasp.candidates, ranked.considered);
  // Other places of a precision grip: their scores differ by as much as the search found.
  if (!ranked.holds.empty()) {
    const RankedHold& taken = ranked.holds[static_cast<std::size_t>(ranked.taken) - 1];
    for (GraspRunnerUp& own : grasp.runners_up) {
      own.score = taken.score - std::max(0.0, grasp.score - own.score);
    }
  }
  for (std::size_t k = 0; k < ranked.holds.size(); ++k) {
    const RankedHold& other = ranked.holds[k];
    if (k + 1 == static_cast<std::size_t>(ranked.taken)) {
      grasp.candidates = std::max(grasp.candidates, other.grasp.candidates);
      grasp.score = other.score;
      grasp.hold_terms = other.terms;
    } else {
      grasp.runners_up.push_back({other.hold.grip, other.grasp.posture,
                                  other.grasp.product_from_hand, other.score, other.hold,
                                  other.words});
    }
  }
  std::stable_sort(
      grasp.runners_up.begin(), grasp.runners_up.end(),
      [](const GraspRunnerUp& a, const GraspRunnerUp& b) { return a.score > b.score; });
}

Grasp GraspPlace::Impl::take_precisely(const Hold& taken, const hand::Hand& hand,
                                       const Progress& progress) const {
  const product::ProductPart& part = part_of(taken, ranked.parts);
  if (is_laid(taken.grip)) {
    return close_laid_hand(hand, *product, taken.grip, laid_site_of(taken, ranked.parts, *product));
  }
  if (taken.grip == Grip::kFingerPush) {
    return close_finger_push(hand, *product,
                             product::point_at(part, taken.fingertips.front().place));
  }
  PrecisionGripOptions precision = options.precision;
  precision.grip = taken.grip;
  precision.placement = {};
  precision.targets.clear();
  precision.wrist = taken.wrist;
  for (const HoldFingertip& tip : taken.fingertips) {
    const Vec3 near = product::point_at(part, tip.place);
    precision.targets.push_back({tip.finger, product->distance->at(near).closest});
  }
  return close_precision_grip(hand, *product, precision, progress);
}

Grasp GraspPlace::Impl::hold_power(const GraspingHand& hand, const Progress& progress) const {
  const HandCloser& coarse = hand.impl().coarse;
  const HandCloser& fine = hand.impl().fine;
  std::optional<HoldSite> at;
  if (hold) at = site_of(*hold, ranked.parts, *product, hand.hand());
  const PowerPlace carried =
      carried_over(*place, *reference, coarse, at ? &*at : nullptr, power, progress);
  return close_at(carried, fine, *product, power, progress);
}

Grasp GraspPlace::Impl::hold_precisely(const hand::Hand& hand, const Progress& progress) const {
  if (hold) return take_precisely(*hold, hand, progress);
  if (is_non_prehensile(*options.grip)) return place_non_prehensile(hand);
  PrecisionGripOptions same = options.precision;
  same.grip = *options.grip;
  same.targets.clear();
  for (const FingertipContact& tip : grasp.fingertips) {
    same.targets.push_back({tip.finger, tip.target});
  }
  same.placement = {};
  return close_precision_grip(hand, *product, same, progress);
}

// The first of the next best holds that a hand can take, in words; it becomes the first of the
// runners-up of the grasp that failed.
std::string GraspPlace::Impl::other_hold_of(const GraspingHand& hand, Grasp& failed,
                                            const Progress& progress) const {
  std::size_t tried = 0;
  for (const RankedHold& other : ranked.holds) {
    if (hold && words_of(other.hold, ranked.parts) == words_of(*hold, ranked.parts)) continue;
    if (++tried > kNextTried) break;
    GraspOptions asked = options;
    asked.hold = other.hold;
    asked.grip = other.hold.grip;
    const Grasp own = GraspPlace(hand.hand(), *product, asked, progress).reference_grasp();
    if (!is_held(own)) continue;
    failed.runners_up.insert(failed.runners_up.begin(),
                             {own.grip, own.posture, own.product_from_hand, other.score});
    return other.words;
  }
  return {};
}

GraspPlace::GraspPlace(const hand::Hand& reference, const product::Product& product,
                       const GraspOptions& options, const Progress& progress) {
  options.check();
  auto impl = std::make_unique<Impl>();
  impl->reference = &reference;
  impl->product = &product;
  impl->options = options;
  if (options.is_placed()) {
    impl->place_by_coordinates(progress);
  } else {
    impl->place_by_hold(progress);
  }
  impl_ = std::move(impl);
}

GraspPlace::GraspPlace(std::unique_ptr<const Impl> impl) : impl_(std::move(impl)) {}

GraspPlace GraspPlace::with_hold(int number, const std::string& why,
                                 const Progress& progress) const {
  const RankedHold& other = impl_->numbered(number);
  auto impl = std::make_unique<Impl>(*impl_);
  impl->options.hold_rank = number;
  impl->ranked.taken = number;
  impl->ranked.why_taken = why;
  impl->hold = other.hold;
  impl->place.reset();
  impl->take_hold(progress);
  return GraspPlace(std::move(impl));
}

GraspPlace::~GraspPlace() = default;
GraspPlace::GraspPlace(GraspPlace&&) noexcept = default;
GraspPlace& GraspPlace::operator=(GraspPlace&&) noexcept = default;

const Grasp& GraspPlace::reference_grasp() const { return impl_->grasp; }

const RankedHolds& GraspPlace::ranked() const { return impl_->ranked; }

Grasp GraspPlace::hold(const GraspingHand& hand, const Progress& progress) const {
  if (hand.hand().skin.vertices == impl_->reference->skin.vertices) return impl_->grasp;
  const bool has_place = impl_->place ? impl_->place->is_found : !impl_->grasp.fingertips.empty();
  if (!has_place) return find_grasp(hand.hand(), *impl_->product, impl_->options, progress);
  Grasp grasp = impl_->place ? impl_->hold_power(hand, progress)
                             : impl_->hold_precisely(hand.hand(), progress);
  grasp.hold = impl_->hold;
  grasp.hold_words = impl_->grasp.hold_words;
  grasp.hold_kind = impl_->grasp.hold_kind;
  grasp.hold_terms = impl_->grasp.hold_terms;
  if (is_held(grasp) || !is_held(impl_->grasp)) return grasp;
  // Never silently another way of holding: it is told, and stands first among the runners-up.
  const std::string why = std::move(grasp.message);
  grasp.message =
      (grasp.hold_words.empty() ? "cannot hold it where the reference hand does: "
                                : "cannot take the hold \"" + grasp.hold_words + "\": ") +
      why;
  if (impl_->ranked.holds.empty()) return grasp;  // the hold was given: no other was looked for
  const std::string other = impl_->other_hold_of(hand, grasp, progress);
  grasp.message += other.empty() ? "; no other hold was found that this hand can take"
                                 : "; it could hold it so: " + other;
  return grasp;
}

}  // namespace palmar::grasp
