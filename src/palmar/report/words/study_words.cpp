// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/words/study_words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "palmar/grasp/task_force.h"
#include "palmar/report/words/plain_words.h"
#include "palmar/study/statistics/study_statistics.h"

namespace palmar::report {
namespace {

std::string with_unit(const std::string& number, const study::StudyQuantity& quantity) {
  return quantity.unit.empty() ? number : number + " " + quantity.unit;
}

}  // namespace

std::string plain_words(study::StudyOutcome outcome) {
  switch (outcome) {
    case study::StudyOutcome::kHeld:
      return "held";
    case study::StudyOutcome::kPartlyHeld:
      return "partly held";
    case study::StudyOutcome::kSlipsOut:
      return "slips out";
    case study::StudyOutcome::kTooLarge:
      return "too large for the hand";
    case study::StudyOutcome::kTooSmall:
      return "too small for the hand";
    case study::StudyOutcome::kNotGraspable:
      return "not graspable";
    case study::StudyOutcome::kFailed:
      break;
  }
  return "no answer";
}

std::string cause_words(const std::string& cause) {
  for (int k = 0; k < study::kStudyOutcomes; ++k) {
    const auto outcome = static_cast<study::StudyOutcome>(k);
    if (name_of(outcome) == cause) return plain_words(outcome);
  }
  if (cause == "not_run") return "not run";
  if (cause == "no_value") return "no value";
  const std::size_t space = cause.find(' ');
  if (space == std::string::npos) return cause;
  const std::string key = cause.substr(0, space);
  for (const study::StudyQuantity& one : study::hand_quantities()) {
    if (one.key != key) continue;
    const bool has_edge = cause.find(" has no value") == std::string::npos;
    return one.name + cause.substr(space) + (has_edge && !one.unit.empty() ? " " + one.unit : "");
  }
  for (const grasp::GraspIndex& one : study::index_catalogue()) {
    if (one.key == key) return one.name + cause.substr(space);
  }
  return cause;
}

std::string counted(int number, const std::string& one) {
  return std::to_string(number) + " " + one + (number == 1 ? "" : "s");
}

std::string condition_words(const study::StudyPlan& plan, const study::StudyCondition& condition) {
  if (study::conditions_of(plan).size() < 2) return "";
  const std::string title = title_of(plan, condition);
  if (plan.populations.size() > 1) return title;
  study::StudyPlan unnamed;  // the population is the same for all: its name takes the room
  unnamed.populations.resize(1);
  unnamed.populations.front().population.name = "-";
  unnamed.profiles = plan.profiles;
  unnamed.settings = plan.settings;
  unnamed.grips = plan.grips;
  const std::string words = title_of(unnamed, condition);
  return words.size() > 3 ? words.substr(3) : title;
}

std::string grip_force_words(const study::StudyResults& results,
                             const study::StudyCondition& condition, int first, int second) {
  const std::optional<study::GripForces> forces =
      study::grip_forces(results, condition, first, second);
  if (!forces || !forces->are_unequal()) return "";
  const study::StudySetting& setting =
      results.plan.settings[static_cast<std::size_t>(condition.setting)];
  return "They are held at different grip forces (" + short_number(forces->first) + " and " +
         short_number(forces->second) + " N)" +
         (setting.grip_force || setting.strength_share
              ? ": not every hand reaches the requested force."
              : ": compare them in a study at one grip force (grip_force_n).");
}

std::string grip_force_words(const study::StudySetting& setting) {
  if (!setting.is_balanced) return "";
  if (setting.turn) {
    return "the grip force that turning with " + short_number(*setting.turn) + " N m takes";
  }
  if (grasp::holds_load(setting.task)) {
    return std::string("the grip force that each product’s weight asks for") +
           (setting.task == grasp::HandTask::kCarry ? ", while walking" : "");
  }
  if (setting.grip_force) return "grip force " + short_number(*setting.grip_force) + " N";
  if (!setting.strength_share) return "as firm as closing to the limit depths";
  if (!setting.strength) {
    return "grip force " + short_number(100.0 * *setting.strength_share) +
           " % of the person’s own strength";
  }
  const grasp::ShareOfStrength share = study::share_of_strength(setting, 0.0);
  const std::string words = "grip force " + short_number(share.force(grasp::Grip::kMediumWrap)) +
                            " N: " + share.words(grasp::Grip::kMediumWrap) +
                            "; a pinch as much of what it reaches";
  if (!setting.follows_product) return words;
  return words +
         "; where thumb and fingers meet round none of the products, what holds the heaviest: " +
         short_number(std::max(share.least, grasp::kLightestHold)) + " N";
}

std::string grasp_words(const study::StudyRecord& record) {
  std::string words = capitalised(plain_words(record.outcome));
  if (study::is_in_hand(record)) {
    words += "; peak " + short_number(record.peak_pressure_cells) + " MPa on sensor cells, " +
             short_number(record.area) + " mm², " + short_number(record.force) + " N";
  }
  if (!record.reason.empty()) words += ". " + capitalised(record.reason);
  return words;
}

std::string hand_words(const study::StudyPlan& plan, const study::StudyCondition& condition,
                       int hand) {
  const study::StudyHand& one = plan.hands[static_cast<std::size_t>(hand)];
  std::string words = "Hand " + std::to_string(hand + 1);
  const std::string& label = one.sample.label;
  if (!label.empty() && label != std::to_string(hand) && label != std::to_string(hand + 1)) {
    words += ", " + label;
  }
  if (plan.populations.size() > 1) {
    words += ", " + plan.populations[static_cast<std::size_t>(one.population)].population.name;
  }
  const auto length = study::size_of(plan, condition, hand, study::kHandLength);
  const auto round = study::size_of(plan, condition, hand, study::kHandCircumference);
  if (length) words += ": " + short_number(*length) + " mm long";
  if (round) words += std::string(length ? ", " : ": ") + short_number(*round) + " mm round";
  return words;
}

bool has_percentiles(const study::QuantitySummary& one) { return one.summary.n >= 5; }

std::string p_words(double p) {
  if (p < 0.001) return "p < 0.001";
  char text[32];
  std::snprintf(text, sizeof text, p < 0.1 ? "p = %.3f" : "p = %.2f", p);
  return text;
}

std::string left_out_words(const study::StudyPlan& plan, const study::ProductPair& pair) {
  std::string words;
  for (const int product : {pair.first, pair.second}) {
    std::string causes;
    for (const study::LeftOutHands& one : pair.left_out) {
      if (one.product != product) continue;
      causes +=
          (causes.empty() ? "" : ", ") + std::to_string(one.hands) + " " + cause_words(one.cause);
    }
    if (causes.empty()) continue;
    words += (words.empty() ? "" : "; ") + plan.products[static_cast<std::size_t>(product)].name +
             ": " + causes;
  }
  return words;
}

std::string pair_words(const study::StudyPlan& plan, const study::StudyQuantity& quantity,
                       const study::ProductPair& pair) {
  const bool is_second_lower = pair.mean_second < pair.mean_first;
  const int low_product = is_second_lower ? pair.second : pair.first;
  const int high_product = is_second_lower ? pair.first : pair.second;
  const std::string& low = plan.products[static_cast<std::size_t>(low_product)].name;
  const std::string& high = plan.products[static_cast<std::size_t>(high_product)].name;
  const double low_mean = is_second_lower ? pair.mean_second : pair.mean_first;
  const double high_mean = is_second_lower ? pair.mean_first : pair.mean_second;
  const std::string hands =
      std::to_string(pair.pairs) + " of " + std::to_string(pair.hands) + " hands hold both";
  if (pair.verdict == study::DifferenceVerdict::kTooFewPairs) {
    return low + " and " + high + " can't be compared: " + hands + ".";
  }
  if (pair.verdict == study::DifferenceVerdict::kNone) {
    return low + " and " + high + " don't differ in " + quantity.name + " in any hand (" + hands +
           ").";
  }
  const double sign = is_second_lower ? -1.0 : 1.0;
  const double ends[2] = {sign * pair.t_test.interval.low, sign * pair.t_test.interval.high};
  std::string share;
  if (low_mean >= 0.0 && high_mean > 0.0) {
    share = ", " + short_number(100.0 * (1.0 - low_mean / high_mean), 2) + " % less";
  }
  const std::string values =
      short_number(low_mean) + " against " + with_unit(short_number(high_mean), quantity);
  if (!study::is_drawn_by_chance(plan)) {
    return low + " has a lower mean of " + quantity.name + " than " + high + ": " + values + share +
           " (" + hands + "; these hands were chosen, not drawn by chance: a test means nothing).";
  }
  const std::string test = "difference " + short_number(std::abs(pair.t_test.difference)) +
                           ", 95 % interval " + short_number(std::min(ends[0], ends[1])) + " to " +
                           with_unit(short_number(std::max(ends[0], ends[1])), quantity) + "; " +
                           hands + "; t-test " + p_words(pair.t_p_holm) + ", Wilcoxon " +
                           p_words(pair.wilcoxon_p_holm);
  // Of fewer pairs no rank can reach 0.05: 2 / 2^5 = 0.06 (Wilcoxon 1945, both sides).
  constexpr int kFewest = 6;
  const std::string few =
      pair.pairs < kFewest ? " So few hands prove nothing; 6 or more are needed." : "";
  if (pair.verdict == study::DifferenceVerdict::kNotShown) {
    return "No difference in " + quantity.name + " is shown between " + low + " and " + high +
           ": " + values + " (" + test + ")." + few;
  }
  return low + " has a lower " + quantity.name + " than " + high + ": " + values + share + " (" +
         test + ")." + few;
}

}  // namespace palmar::report
