// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/assessment/verdict.h"

#include <algorithm>
#include <cmath>

#include "palmar/geometry/degrees.h"
#include "palmar/grasp/joint_strength.h"
#include "palmar/grasp/task_force.h"
#include "palmar/study/assessment/hold_doubts.h"

namespace palmar::study {
namespace {

constexpr double kSameTurn = 10.0 * geometry::kDegree;  // choices: less than hands differ by
constexpr double kSameShift = 5.0;                      // mm

double peak_of(const AssessedProduct& one) {
  return one.assessment.contact.total.peak_pressure_cells;
}

std::optional<StrengthUse> strength_of(const AssessedProduct& one, double grip_force) {
  const Assessment& assessment = one.assessment;
  const grasp::Grip grip = assessment.grasp.grip;
  if (assessment.balance.status != grasp::BalanceStatus::kBalanced || !(grip_force > 0.0))
    return {};
  if (grip == grasp::Grip::kFixedHook) return {};  // carries; nobody squeezes
  if (assessment.options.balance.is_light()) return {};
  StrengthUse use;
  use.grip_force = grip_force;
  use.share = assessment.balance.strength_use;
  use.is_judged = grasp::is_power(grip);
  use.is_by_wrist = assessment.balance.is_by_wrist;
  use.is_pinch = grasp::strength_share(grip) < 1.0;
  const auto& asked = assessment.options.balance.share_of_strength;
  use.reached =
      asked ? asked->reached(grip) : grasp::usual_grip_strength() * grasp::strength_share(grip);
  use.whose = asked ? asked->whose : grasp::usual_people();
  return use;
}

std::optional<HardestPlace> hardest_of(const AssessedProduct& one) {
  const contact::ContactResult& contact = one.assessment.contact;
  if (contact.regions.empty()) return {};
  const auto worst =
      std::max_element(contact.regions.begin(), contact.regions.end(),
                       [](const contact::RegionContact& a, const contact::RegionContact& b) {
                         return a.peak_pressure_cells < b.peak_pressure_cells;
                       });
  HardestPlace place{.region = worst->region,
                     .pressure = worst->peak_pressure_cells,
                     .on_product = {},
                     .face = {}};
  const contact::ProductFootprint& footprint = one.assessment.footprint;
  const auto peak = std::max_element(footprint.pressure.begin(), footprint.pressure.end());
  if (peak != footprint.pressure.end() && *peak > 0.0) {
    place.on_product = footprint.surface.vertices[peak - footprint.pressure.begin()];
  }
  for (const FaceContact& face : one.assessment.faces) {
    if (face.has_peak) place.face = face.face;
  }
  return place;
}

ProductVerdict judge(const AssessedProduct& one, const hand::Hand* hand) {
  ProductVerdict verdict;
  if (!presses_on_skin(one.assessment)) return verdict;
  const grasp::Grasp& grasp = one.assessment.grasp;
  const bool is_doubtful =
      !doubts_of(one.assessment).empty() || grasp.status != grasp::GraspStatus::kHeld;
  verdict.held = is_doubtful                              ? HeldVerdict::kDoubtful
                 : grasp.grip == grasp::Grip::kFingerPush ? HeldVerdict::kPushes
                 : grasp::is_non_prehensile(grasp.grip)   ? HeldVerdict::kRests
                                                          : HeldVerdict::kHeld;
  verdict.grip_force = grip_force_of(one);
  if (one.assessment.options.balance.is_on) {
    verdict.asked = one.assessment.options.balance.asked_grip_force(one.assessment.grasp.grip);
  }
  if (hand != nullptr) verdict.comfort = grasp::assess_comfort(*hand, one.assessment.contact);
  verdict.strength = strength_of(one, verdict.grip_force);
  verdict.hardest = hardest_of(one);
  return verdict;
}

/// Gripped with what its task asks for, and that is reached.
bool does_task(const AssessedProduct& one) {
  const grasp::Balance& balance = one.assessment.balance;
  const grasp::BalanceOptions& options = one.assessment.options.balance;
  if (options.turn) {
    return balance.turn && are_equally_firm(std::abs(*balance.turn), std::abs(*options.turn));
  }
  const auto asked = options.asked_grip_force(one.assessment.grasp.grip);
  return options.holds_load && asked && are_equally_firm(balance.grip_force, *asked);
}

/// Between thumb and fingers where fingertips hold it, else where the hand is along the axis.
Vec3 middle_of(const grasp::Grasp& grasp) {
  if (grasp.fingertips.empty()) return grasp.grip_point;
  Vec3 others = Vec3::Zero();
  double count = 0.0;
  std::optional<Vec3> thumb;
  for (const grasp::FingertipContact& tip : grasp.fingertips) {
    if (tip.finger == hand::Finger::kThumb) {
      thumb = tip.reached;
    } else {
      others += tip.reached;
      count += 1.0;
    }
  }
  if (count == 0.0) return *thumb;
  return thumb ? Vec3(0.5 * (*thumb + others / count)) : Vec3(others / count);
}

double change(double worse, double better) { return worse > 0.0 ? better / worse - 1.0 : 0.0; }

ProductComparison compare(const AssessmentSet& set, const std::vector<ProductVerdict>& verdicts,
                          int worse, int better) {
  ProductComparison pair;
  pair.worse = worse;
  pair.better = better;
  const AssessedProduct& a = set.assessments[worse];
  const AssessedProduct& b = set.assessments[better];
  const HeldVerdict held_a = verdicts[worse].held, held_b = verdicts[better].held;
  if (!is_sound(held_a) || !is_sound(held_b)) {
    pair.verdict = is_sound(held_b) ? PairVerdict::kOnlyOneHeld : PairVerdict::kNoneHeld;
    return pair;
  }
  const grasp::Grasp &grasp_a = a.assessment.grasp, &grasp_b = b.assessment.grasp;
  pair.hand_turned =
      grasp_a.product_from_hand.rotation.angularDistance(grasp_b.product_from_hand.rotation);
  pair.hand_shifted = (middle_of(grasp_b) - middle_of(grasp_a)).norm();
  pair.peak_change = change(peak_of(a), peak_of(b));
  pair.area_change = change(a.assessment.contact.total.area, b.assessment.contact.total.area);
  pair.are_of_task = does_task(a) && does_task(b);
  if (!pair.are_of_task &&
      !are_equally_firm(verdicts[worse].grip_force, verdicts[better].grip_force)) {
    pair.verdict = PairVerdict::kUnequalForce;
    return pair;
  }
  const auto& band_a = a.assessment.contact.band;
  const auto& band_b = b.assessment.contact.band;
  bool depends = false;
  if (band_a && band_b) {
    const auto& soft_a = band_a->total.peak_pressure_cells_low;
    const auto& soft_b = band_b->total.peak_pressure_cells_low;
    if (soft_a > 0.0 && soft_b > 0.0) {
      pair.peak_change_soft = change(soft_a, soft_b);
      depends = depends || *pair.peak_change_soft > 0.0;
    }
    const auto& stiff_a = band_a->total.peak_pressure_cells_high;
    const auto& stiff_b = band_b->total.peak_pressure_cells_high;
    if (stiff_a > 0.0 && stiff_b > 0.0) {
      pair.peak_change_stiff = change(stiff_a, stiff_b);
      depends = depends || *pair.peak_change_stiff > 0.0;
    }
  }
  const auto& sure_a = a.assessment.certainty;
  const auto& sure_b = b.assessment.certainty;
  if (sure_a && sure_b) pair.peak_unsure = std::hypot(sure_a->peak_unsure(), sure_b->peak_unsure());
  const auto at_second = [&](const std::optional<Certainty>& of_a,
                             const std::optional<Certainty>& of_b) {
    const auto peak = [](const AssessedProduct& one, const std::optional<Certainty>& sure) {
      return peak_of(one) * (sure ? 1.0 + sure->second->change.peak_pressure_cells : 1.0);
    };
    const double second = change(peak(a, of_a), peak(b, of_b));
    pair.peak_change_second = std::max(second, pair.peak_change_second.value_or(second));
  };
  if (sure_a && sure_a->second) at_second(sure_a, {});
  if (sure_b && sure_b->second) at_second({}, sure_b);
  const double told_apart = std::max(grasp::kToldApart, pair.peak_unsure.value_or(0.0));
  pair.verdict = std::abs(pair.peak_change) < told_apart      ? PairVerdict::kSame
                 : depends                                    ? PairVerdict::kDependsOnSkin
                 : pair.peak_change_second.value_or(-1) > 0.0 ? PairVerdict::kDependsOnRest
                                                              : PairVerdict::kLower;
  return pair;
}

/// The product that presses least among those that are held; else the first in the hand.
int least_pressing(const AssessmentSet& set, const std::vector<ProductVerdict>& verdicts) {
  int least = 0;
  for (int i = 1; i < static_cast<int>(verdicts.size()); ++i) {
    const auto rank = [&](int k) {
      const HeldVerdict held = verdicts[k].held;
      return std::pair(is_sound(held) ? 0 : static_cast<int>(held), peak_of(set.assessments[k]));
    };
    if (rank(i) < rank(least)) least = i;
  }
  return least;
}

}  // namespace

bool ProductComparison::are_held_alike() const {
  return hand_turned && *hand_turned <= kSameTurn && *hand_shifted <= kSameShift;
}

std::string_view name_of(HeldVerdict verdict) {
  switch (verdict) {
    case HeldVerdict::kHeld:
      return "held";
    case HeldVerdict::kRests:
      return "rests";
    case HeldVerdict::kPushes:
      return "pushes";
    case HeldVerdict::kDoubtful:
      return "doubtful";
    case HeldVerdict::kNotHeld:
      break;
  }
  return "not_held";
}

bool is_sound(HeldVerdict verdict) {
  return verdict != HeldVerdict::kDoubtful && verdict != HeldVerdict::kNotHeld;
}

std::string_view name_of(PairVerdict verdict) {
  switch (verdict) {
    case PairVerdict::kLower:
      return "lower";
    case PairVerdict::kSame:
      return "same";
    case PairVerdict::kDependsOnSkin:
      return "depends_on_skin";
    case PairVerdict::kDependsOnRest:
      return "depends_on_rest";
    case PairVerdict::kUnequalForce:
      return "unequal_force";
    case PairVerdict::kOnlyOneHeld:
      return "only_one_held";
    case PairVerdict::kNoneHeld:
      break;
  }
  return "none_held";
}

bool are_equally_firm(double first, double second) {
  return std::abs(first - second) <= grasp::kToldApart * std::max(first, second);
}

bool presses_on_skin(const Assessment& assessment) {
  const grasp::GraspStatus status = assessment.grasp.status;
  return (status == grasp::GraspStatus::kHeld || status == grasp::GraspStatus::kPartlyHeld) &&
         !assessment.contact.regions.empty();
}

SetVerdict verdict_of(const AssessmentSet& set) {
  SetVerdict verdict;
  for (const AssessedProduct& one : set.assessments) {
    verdict.products.push_back(judge(one, set.hand.get()));
  }
  if (verdict.products.size() < 2) return verdict;
  const int least = least_pressing(set, verdict.products);
  bool is_best = true;
  for (int i = 0; i < static_cast<int>(verdict.products.size()); ++i) {
    if (i == least) continue;
    verdict.comparisons.push_back(compare(set, verdict.products, i, least));
    const PairVerdict pair = verdict.comparisons.back().verdict;
    is_best = is_best && (pair == PairVerdict::kLower || pair == PairVerdict::kOnlyOneHeld);
  }
  if (is_best) verdict.best = least;
  return verdict;
}

}  // namespace palmar::study
