// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/grasp/holds/hold.h"
#include "palmar/grasp/holds/hold_anchor.h"
#include "palmar/grasp/holds/hold_candidates.h"
#include "palmar/grasp/holds/hold_limits.h"
#include "palmar/grasp/holds/hold_place.h"
#include "palmar/grasp/holds/laid_holds.h"
#include "palmar/grasp/holds/offered_holds.h"
#include "palmar/grasp/holds/precision_holds.h"
#include "palmar/grasp/holds/twin_handles.h"
#include "palmar/grasp/precision/ring_targets.h"

namespace palmar::grasp {
namespace {

constexpr std::size_t kClosed = 16;                 // holds that the hand is closed on
constexpr std::size_t kClosedAlike = 4;             // of these with the same part and direction
constexpr std::size_t kPrecisionOrder = 1'000'000;  // after all power holds where both are as good
// How well a closed hand holds, in the units of the scores (choices).
constexpr double kPerMissingFinger = 0.5;
constexpr double kPerMissingWrap = 6.0;    // per share of a turn below a third
constexpr double kPerClash = 0.004;        // per mm^2 of the back of the hand in the product
constexpr double kEnoughWrap = 1.0 / 3.0;  // of a turn
constexpr double kUsualContact = 0.06;     // of hand length squared: palmar skin in a power grip
constexpr double kHookContact = 0.02;      // ... of the fingers alone
constexpr double kContactWeight = 0.7;     // Napier 1956: a power grip uses much of the palm

// Turns of two holds against a third that differ by less are the same; choice.
constexpr double kSameTurn = 5.0 * geometry::kDegree;

/// A candidate with the hand closed on it.
struct ClosedHold {
  RankedHold ranked;
  std::size_t order = 0;  ///< among the candidates
};

// Fingers that a grip needs on the product, thumb included.
int fingers_wanted(const HoldScene& scene, const Hold& hold) {
  const product::ProductPart& part = part_of(hold, *scene.parts);
  const double finger = 0.25 * fingers_breadth(*scene.hand);
  int fingers = 4;
  if (part.opening) {
    fingers = std::clamp(static_cast<int>(part.opening->width / finger + 0.3), 1, 4);
  }
  const bool has_thumb = hold.grip != Grip::kFixedHook || part.kind == product::PartKind::kLoop;
  return fingers + (has_thumb ? 1 : 0);
}

HoldTerm grip_term(const PowerPlace& place, const HoldScene& scene, const Hold& hold) {
  if (!place.is_found) {
    return {"closing", 0.0, "", -10.0, "a hand can't close on it"};
  }
  const double hand_length = scene.hand->dimensions.hand_length;
  const HoldMeasure& measure = place.pose.measure;
  const int wanted = fingers_wanted(scene, hold);
  const double missing = std::max(0.0, wanted - static_cast<double>(measure.fingers));
  const double wrap = std::max(0.0, kEnoughWrap - measure.wrap);
  const double usual = hold.grip == Grip::kFixedHook ? kHookContact : kUsualContact;
  const double contact =
      std::clamp(measure.contact_area / (usual * hand_length * hand_length), 0.05, 1.5);
  const double little = std::min(0.0, kContactWeight * std::log(contact / 1.5));
  const double score = -kPerMissingFinger * missing - kPerMissingWrap * wrap -
                       kPerClash * measure.other_area + little;
  // What speaks against it; if nothing does, what there is.
  constexpr double kWorthNaming = -0.3;  // of the score: half of what against() tells
  std::vector<std::string> reasons;
  const double degrees = 360.0 * measure.wrap;
  if (missing > 0.0)
    reasons.push_back(fmt::format("{} of {} fingers on it", measure.fingers, wanted));
  if (wrap > 0.0) reasons.push_back(fmt::format("only {:.0f} degrees round it", degrees));
  if (measure.other_area > 50.0) reasons.emplace_back("the back of the hand is in it");
  if (little < kWorthNaming) reasons.emplace_back("little of the palm's side touches it");
  std::string words;
  for (const std::string& reason : reasons) words += (words.empty() ? "" : ", ") + reason;
  if (words.empty()) {
    words = fmt::format("{} fingers on it, {:.0f} degrees round it", measure.fingers, degrees);
  }
  return {"closing", static_cast<double>(measure.fingers), "", score, words};
}

// Which to close the hand on: the best, but not all of one kind.
std::vector<std::size_t> chosen(const std::vector<HoldCandidate>& candidates, bool takes_more) {
  const std::size_t most = takes_more ? 10 * kClosed : kClosed;
  const std::size_t most_alike = takes_more ? 10 * kClosedAlike : kClosedAlike;
  std::vector<std::size_t> list;
  std::map<std::tuple<int, int, bool>, std::size_t> alike;
  for (std::size_t k = 0; k < candidates.size() && list.size() < most; ++k) {
    const Hold& hold = candidates[k].hold;
    std::size_t& count =
        alike[{hold.part, hold.is_over_end ? 0 : hold.toward, hold.grip == Grip::kFixedHook}];
    if (count == most_alike) continue;
    ++count;
    list.push_back(k);
  }
  return list;
}

std::string against(const std::vector<HoldTerm>& terms) {
  const auto worst =
      std::min_element(terms.begin(), terms.end(),
                       [](const HoldTerm& a, const HoldTerm& b) { return a.score < b.score; });
  constexpr double kWorthTelling = -0.5;
  return worst == terms.end() || worst->score > kWorthTelling ? "" : worst->words;
}

bool is_unlike(const hand::Hand& hand, const product::ProductParts& parts, const RankedHold& a,
               const RankedHold& b) {
  if (a.hold.part != b.hold.part || is_power(a.hold.grip) != is_power(b.hold.grip)) return true;
  if (!is_power(a.hold.grip) && a.hold.grip != b.hold.grip) return true;
  const product::ProductPart& part = part_of(a.hold, parts);
  if (is_power(a.hold.grip) && is_round_about(part, parts)) {
    constexpr double kElsewhere = 20.0;  // mm along it
    if (a.hold.is_over_end != b.hold.is_over_end) return true;
    if (a.hold.is_over_end) return a.hold.along != b.hold.along;
    const Vec3 axis = product::part_frame(part, 0.5, 0.0).rotation * Vec3::UnitX();
    const double apart = axis.dot(a.grasp.grip_point - b.grasp.grip_point);
    return a.hold.toward != b.hold.toward || std::abs(apart) > kElsewhere;
  }
  return differ(hand, a.grasp.product_from_hand, b.grasp.product_from_hand);
}

void check_part(const product::ProductParts& parts, const HoldOptions& options) {
  if (!options.part && options.part_name.empty()) return;
  std::string list;
  for (const product::ProductPart& part : parts.parts) {
    if (is_part_asked(part, options)) return;
    list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", part.number, part.name);
  }
  const std::string asked =
      options.part ? std::to_string(*options.part) : "\"" + options.part_name + "\"";
  throw UsageError("setting \"part\": the product has no part " + asked + "; " +
                   (list.empty() ? "it has no parts" : list + " is allowed"));
}

}  // namespace

void HoldOptions::check() const {
  const auto require_direction = [](const char* name, const std::optional<Vec3>& direction) {
    if (direction && !(direction->allFinite() && direction->norm() > 1e-9)) {
      throw UsageError(fmt::format(
          "setting \"{}\" has no direction; three numbers, not all 0, are required", name));
    }
  };
  require_direction("toward", toward);
  require_direction("up", up);
  if (mass && !(*mass > 0.0 && std::isfinite(*mass))) {
    throw UsageError(fmt::format("setting \"mass\" is {} kg; more than 0 kg is required", *mass));
  }
  if (along && !(*along >= 0.0 && *along <= 1.0)) {
    throw UsageError(
        fmt::format("setting \"along\" is {}; a fraction from 0 to 1 is required", *along));
  }
  if (most < 1) {
    throw UsageError(fmt::format("setting \"most\" is {}; at least 1 is required", most));
  }
  PowerGraspOptions depths;
  depths.palm_limit_depth = palm_limit_depth;
  depths.finger_limit_depth = finger_limit_depth;
  depths.check();
}

RankedHolds rank_holds(const hand::Hand& hand, const product::Product& product,
                       const HoldOptions& options, const Progress& progress) {
  options.check();
  progress.update(0.0, "taking " + product.name + " apart");
  RankedHolds result;
  result.purpose = options.purpose;
  result.parts = product::find_parts(product);
  check_part(result.parts, options);
  const HoldScene scene = hold_scene(hand, product, result.parts, options);
  result.has_handle = scene.has_handle() || scissor_rings(result.parts, product).has_value();
  std::vector<ClosedHold> closed;

  const bool is_offered = are_offered(options);
  if (!is_offered && (!options.grip || is_power(*options.grip))) {
    progress.update(0.1, "finding ways to hold " + product.name);
    const std::vector<HoldCandidate> candidates = power_candidates(scene, options);
    result.considered += static_cast<int>(candidates.size());
    const HandCloser coarse(hand, kSearchSpacing);
    PowerGraspOptions power;
    power.grip = options.grip;
    power.palm_limit_depth = options.palm_limit_depth;
    power.finger_limit_depth = options.finger_limit_depth;
    std::map<std::pair<int, double>, GraspedSurface> surfaces;  // by part and place along it
    for (const std::size_t k : chosen(candidates, options.lists_all)) {
      progress.throw_if_cancelled();
      const HoldCandidate& candidate = candidates[k];
      const Hold& hold = candidate.hold;
      const auto key = std::pair(hold.part, hold.is_over_end ? 2.0 + hold.along : hold.along);
      auto known = surfaces.find(key);
      if (known == surfaces.end()) {
        known =
            surfaces
                .emplace(key, grasped_surface_near(hold, result.parts, product, candidate.at, hand))
                .first;
      }
      const PowerPlace place =
          place_of_hold(candidate.at, hold.grip, known->second, coarse, power, progress);
      ++result.closed;
      ClosedHold done;
      done.order = candidate.index;
      done.ranked.hold = hold;
      done.ranked.terms = candidate.terms;
      done.ranked.terms.push_back(grip_term(place, scene, hold));
      done.ranked.grasp = place.grasp;
      closed.push_back(std::move(done));
    }
  }
  std::vector<RankedHold> others;
  if (is_offered) {
    others = offered_holds(scene, options, result.considered, progress);
  } else {
    others = precision_holds(scene, options, progress);
    for (RankedHold& ranked : laid_holds(scene, options, progress)) {
      others.push_back(std::move(ranked));
    }
    result.considered += static_cast<int>(others.size());
  }
  for (RankedHold& ranked : others) {
    ++result.closed;
    closed.push_back({std::move(ranked), kPrecisionOrder + closed.size()});
  }
  for (ClosedHold& hold : closed) {
    if (scene.lay && !is_offered) {
      hold.ranked.terms.push_back(table_term(scene, hand_over_weights(), hold.ranked.grasp));
    }
    hold.ranked.score = sum_of(hold.ranked.terms);
    hold.ranked.grasp.score = hold.ranked.score;
    hold.ranked.words = words_of(hold.ranked.hold, result.parts);
    hold.ranked.hold.anchor = anchor_of(hold.ranked.hold, result.parts);
    hold.ranked.against = against(hold.ranked.terms);
  }
  std::stable_sort(closed.begin(), closed.end(), [](const ClosedHold& a, const ClosedHold& b) {
    return a.ranked.score > b.ranked.score;
  });
  // Of holds that are as good: the one most like another product's, else the first candidate.
  const auto rank_of = [&](const ClosedHold& hold) {
    const bool is_as_good = hold.ranked.score >= closed.front().ranked.score - kNearTie;
    const double turned =
        options.like ? hold.ranked.grasp.product_from_hand.rotation.angularDistance(*options.like)
                     : 0.0;
    return std::tuple(is_as_good ? 0 : 1, std::round(turned / kSameTurn), hold.order,
                      -hold.ranked.score);
  };
  const auto best =
      std::min_element(closed.begin(), closed.end(),
                       [&](const auto& a, const auto& b) { return rank_of(a) < rank_of(b); });
  if (best != closed.end()) std::rotate(closed.begin(), best, best + 1);
  for (ClosedHold& hold : closed) {
    if (!options.lists_all && result.holds.size() == static_cast<std::size_t>(options.most)) break;
    const bool is_new =
        options.lists_all ||
        std::all_of(result.holds.begin(), result.holds.end(), [&](const RankedHold& other) {
          return is_unlike(hand, result.parts, hold.ranked, other);
        });
    if (is_new) result.holds.push_back(std::move(hold.ranked));
  }
  return result;
}

std::optional<int> other_as_likely(const RankedHolds& ranked) {
  if (ranked.taken < 1 || static_cast<std::size_t>(ranked.taken) > ranked.holds.size()) return {};
  const RankedHold& taken = ranked.holds[static_cast<std::size_t>(ranked.taken) - 1];
  for (std::size_t k = 0; k < ranked.holds.size(); ++k) {
    const RankedHold& other = ranked.holds[k];
    const bool is_along = is_power(taken.hold.grip) && is_power(other.hold.grip) &&
                          !taken.hold.is_over_end && !other.hold.is_over_end;
    const bool is_otherwise =
        other.hold.part != taken.hold.part || (is_along && other.hold.toward != taken.hold.toward);
    if (is_otherwise && std::abs(other.score - taken.score) < kNearTie) {
      return static_cast<int>(k) + 1;
    }
  }
  return {};
}

namespace {

std::string place_words(const Hold& hold, const product::ProductPart& part,
                        const product::ProductParts& parts) {
  if (std::abs(hold.edge) < 0.1 || part.is_ring) {
    return fmt::format(", {:.0f} % along it", 100.0 * std::clamp(hold.along, 0.0, 1.0));
  }
  if (part.opening) return ", index finger where the opening ends";
  const std::size_t end = hold.along > 0.5 ? 1 : 0;
  if (part.ends[end].joined) {
    return ", up to the " + parts.parts[*part.ends[end].joined - 1].name;
  }
  return part.ends[1 - end].joined ? ", at its free end" : ", at one of its ends";
}

}  // namespace

std::string words_of(const Hold& hold, const product::ProductParts& parts) {
  const product::ProductPart& part = part_of(hold, parts);
  std::string grip(name_of(hold.grip));
  std::replace(grip.begin(), grip.end(), '_', ' ');
  std::string words = fmt::format("{} of the {}", grip, part.name);
  if (is_non_prehensile(hold.grip)) return fmt::format("{} on the {}", grip, part.name);
  if (hold.grip == Grip::kDistalType) {
    return words + ", thumb through it, fingers through the other ring";
  }
  if (!is_power(hold.grip)) return words;
  if (hold.is_over_end) return words + ", palm over its end";
  if (part.kind == product::PartKind::kLoop) words += ", fingers through it";
  if (twin_of(part, parts) != nullptr) words += " and its twin";
  words += place_words(hold, part, parts);
  const std::size_t end = hold.toward > 0 ? 1 : 0;
  if (!part.is_ring && part.ends[end].joined && !part.ends[1 - end].joined) {
    words += ", thumb's side towards the " + parts.parts[*part.ends[end].joined - 1].name;
  } else if (!part.is_ring && !part.ends[end].joined && part.ends[1 - end].joined) {
    words += ", thumb's side towards its free end";
  }
  return words;
}

}  // namespace palmar::grasp
