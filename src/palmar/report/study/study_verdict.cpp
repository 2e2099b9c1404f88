// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "palmar/report/study/study_page.h"
#include "palmar/report/words/plain_words.h"
#include "palmar/report/words/study_words.h"

namespace palmar {
namespace {

/// The product with the lowest mean of a quantity among those in some hand, or -1.
int lowest_of(const ConditionAnalysis& analysis, const std::string& key) {
  int lowest = -1;
  double least = 0.0;
  for (const ProductStatistics& one : analysis.products) {
    const QuantitySummary* summary = summary_of(one, key);
    if (summary == nullptr) continue;
    if (lowest < 0 || summary->summary.mean < least) {
      lowest = one.product;
      least = summary->summary.mean;
    }
  }
  return lowest;
}

void describe_pairs(const StudyResults& results, const ConditionAnalysis& analysis,
                    const std::string& key, std::vector<std::string>& sentences) {
  const QuantityComparison* comparison = comparison_of(analysis, key);
  const int lowest = lowest_of(analysis, key);
  if (comparison == nullptr || lowest < 0) return;
  for (const ProductPair& pair : comparison->pairs) {
    if (pair.first != lowest && pair.second != lowest) continue;
    const std::string force =
        grip_force_words(results, analysis.condition, pair.first, pair.second);
    sentences.push_back(capitalised(pair_words(results.plan, comparison->quantity, pair)) +
                        (force.empty() ? "" : " " + force));
  }
}

std::string share_words(const StudyResults& results, const Accommodation& one,
                        const Exclusion& exclusion, bool is_only) {
  const std::string& name = results.plan.products[static_cast<std::size_t>(one.product)].name;
  if (one.inside.n == 0) return name + ": no grasp was run.";
  std::string words = capitalised(name) + " is held by " + std::to_string(one.inside.count) +
                      " of " + counted(one.inside.n, "hand");
  if (is_drawn_by_chance(results.plan)) {
    words += " (" + short_number(100.0 * one.inside.share) + " %, 95 % interval " +
             short_number(100.0 * one.inside.interval.low, 2) + " to " +
             short_number(100.0 * one.inside.interval.high, 2) + " %)";
  }
  std::string causes;
  for (const OutsideCause& cause : one.causes) {
    causes +=
        (causes.empty() ? "" : ", ") + std::to_string(cause.hands) + " " + cause_words(cause.cause);
  }
  if (causes.empty()) {
    words += is_only ? "; nobody is left out" : "; nobody is left out here";
  } else {
    words += "; left out: " + causes;
    if (one.shortest_outside) {
      words += ", hands of " + short_number(*one.shortest_outside) +
               (*one.longest_outside > *one.shortest_outside
                    ? " to " + short_number(*one.longest_outside)
                    : "") +
               " mm length";
    }
  }
  words += ".";
  // Who doesn't get hold of it stands above; here whom it asks too much of.
  for (const auto& [cause, people] : exclusion.causes) {
    if (people.count == 0) continue;
    const std::string hands =
        std::to_string(people.count) + " of " + std::to_string(exclusion.excluded.n) + " hands";
    if (cause == ExclusionCause::kRange || cause == ExclusionCause::kStrength) {
      words += " It asks for more " + words_of(cause) + " than " + hands + " have.";
    } else if (cause == ExclusionCause::kNails) {
      words += " Nails are in the way of " + hands + ".";
    }
  }
  return words;
}

/// "4 of 6 (67 %: 3 by grip strength, 1 by nails)", "nobody".
std::string excluded_words(const Exclusion& one) {
  if (one.excluded.count == 0) return "nobody";
  std::string causes;
  for (const auto& [cause, people] : one.causes) {
    if (cause == ExclusionCause::kNone || people.count == 0) continue;
    causes +=
        (causes.empty() ? "" : ", ") + std::to_string(people.count) + " by " + words_of(cause);
  }
  return std::to_string(one.excluded.count) + " of " + std::to_string(one.excluded.n) + " (" +
         short_number(100.0 * one.excluded.share, 2) + " %" +
         (causes.empty() ? "" : ": " + causes) + ")";
}

/// Whether a difference that the first condition has is that of another one, too.
std::string standing_words(const StudyResults& results, const ProductPair& first,
                           const ProductPair& other) {
  const auto sign = [](const ProductPair& pair) { return pair.mean_second < pair.mean_first; };
  const auto is_shown = [&](const ProductPair& pair) {
    return is_drawn_by_chance(results.plan) ? pair.verdict == DifferenceVerdict::kShown
                                            : pair.verdict != DifferenceVerdict::kTooFewPairs &&
                                                  pair.verdict != DifferenceVerdict::kNone;
  };
  const std::string names = results.plan.products[static_cast<std::size_t>(first.first)].name +
                            " and " +
                            results.plan.products[static_cast<std::size_t>(first.second)].name;
  if (other.verdict == DifferenceVerdict::kTooFewPairs) return names + " can't be compared";
  const std::string means =
      " (" + short_number(other.mean_first) + " and " + short_number(other.mean_second) + ")";
  if (is_shown(first) && is_shown(other)) {
    return "the difference between " + names +
           (sign(first) == sign(other) ? " remains" : " is reversed") + means;
  }
  if (is_shown(first)) return "the difference between " + names + " is not shown" + means;
  if (is_shown(other)) return names + " differ" + means;
  return "no difference between " + names + " is shown" + means;
}

/// A sentence of another condition: whom its products exclude, how many they suit, and whether the
/// first condition's differences stand.
std::string other_words(const StudyResults& results, const ConditionAnalysis& first,
                        const ConditionAnalysis& other) {
  std::string suits, excludes;
  for (std::size_t p = 0; p < other.exclusion.size(); ++p) {
    const std::string& name = results.plan.products[p].name;
    const Proportion& inside = other.accommodation[p].inside;
    suits += (suits.empty() ? "" : "; ") + name + " is held by " + std::to_string(inside.count) +
             " of " + std::to_string(inside.n);
    excludes += (excludes.empty() ? "" : "; ") + name + " asks too much of " +
                excluded_words(other.exclusion[p]);
  }
  std::string words =
      capitalised(condition_words(results.plan, other.condition)) + ": " + suits + "; " + excludes;
  const std::string key = "peak_pressure_cells_mpa";
  const QuantityComparison* before = comparison_of(first, key);
  const QuantityComparison* now = comparison_of(other, key);
  const int lowest = lowest_of(first, key);
  if (before == nullptr || now == nullptr || lowest < 0) return words + ".";
  for (std::size_t k = 0; k < before->pairs.size() && k < now->pairs.size(); ++k) {
    const ProductPair& pair = before->pairs[k];
    if (pair.first != lowest && pair.second != lowest) continue;
    words += "; " + standing_words(results, pair, now->pairs[k]);
    const auto forces = grip_forces(results, other.condition, pair.first, pair.second);
    if (forces && forces->are_unequal()) {
      words += "; at different grip forces (" + short_number(forces->first) + " and " +
               short_number(forces->second) + " N)";
    }
  }
  return words + ".";
}

/// Grasps of a condition that are held though forces are left over.
void describe_unbalanced(const StudyResults& results, const StudyCondition& condition,
                         std::vector<std::string>& sentences) {
  const StudyPlan& plan = results.plan;
  if (!plan.settings[static_cast<std::size_t>(condition.setting)].is_balanced) return;
  for (std::size_t p = 0; p < plan.products.size(); ++p) {
    if (!plan.products[p].posture_of.empty()) continue;
    int held = 0, unbalanced = 0;
    for (const int hand : hands_of(plan, condition)) {
      const StudyRecord* record = record_of(results, condition, static_cast<int>(p), hand);
      if (record == nullptr || !is_in_hand(*record)) continue;
      ++held;
      unbalanced += record->is_balanced ? 0 : 1;
    }
    if (unbalanced == 0) continue;
    sentences.push_back(capitalised(plan.products[p].name) + ": in " + std::to_string(unbalanced) +
                        " of " + std::to_string(held) +
                        " grasps the forces don't balance; their figures count all the same.");
  }
}

constexpr int kMostOthers = 12;  // conditions; the rest stand below only

}  // namespace

std::vector<std::string> study_verdict(const StudyResults& results, const StudyAnalysis& all) {
  const ConditionAnalysis& analysis = all.conditions.front();
  const bool is_only = all.conditions.size() == 1;
  std::vector<std::string> sentences;
  if (!is_only) {
    sentences.push_back("The sentences that come first are of " +
                        condition_words(results.plan, analysis.condition) +
                        "; the other conditions follow at the end.");
  }
  describe_pairs(results, analysis, "peak_pressure_cells_mpa", sentences);
  if (results.plan.products.size() == 1) {
    for (const char* key : {"peak_pressure_cells_mpa", "contact_area_mm2"}) {
      const QuantitySummary* one = summary_of(analysis.products.front(), key);
      if (one == nullptr) continue;
      sentences.push_back(capitalised(one->quantity.name) + ": " + short_number(one->summary.mean) +
                          " " + one->quantity.unit + " on average" +
                          (has_percentiles(*one)
                               ? ", " + short_number(one->p5) + " to " + short_number(one->p95) +
                                     " " + one->quantity.unit + " for nine hands of ten."
                               : "."));
    }
  }
  for (std::size_t p = 0; p < analysis.accommodation.size(); ++p) {
    sentences.push_back(
        share_words(results, analysis.accommodation[p], analysis.exclusion[p], is_only));
  }
  for (const ProductSizes& family : analysis.sizes) {
    std::string words = "Sizes of " + family.family + ": ";
    int served = -1;
    for (std::size_t k = 0; k < family.choices.size(); ++k) {
      const SizeChoice& choice = family.choices[k];
      if (choice.served.count == served) {
        words += "; one more serves nobody else";
        break;
      }
      served = choice.served.count;
      std::string names;
      for (const ServedBySize& size : choice.sizes) {
        names += (names.empty() ? "" : " + ") +
                 results.plan.products[static_cast<std::size_t>(size.product)].name;
      }
      words += (k > 0 ? "; " : "") + std::to_string(choice.sizes.size()) + " (" + names +
               ") serve" + (choice.sizes.size() == 1 ? "s " : " ") +
               short_number(100.0 * choice.served.share) + " % of hands";
    }
    sentences.push_back(words + ".");
  }
  describe_unbalanced(results, analysis.condition, sentences);
  int listed = 0;
  for (std::size_t c = 1; c < all.conditions.size(); ++c) {
    if (listed == kMostOthers) {
      sentences.push_back("Further conditions are below.");
      break;
    }
    sentences.push_back(other_words(results, analysis, all.conditions[c]));
    ++listed;
  }
  return sentences;
}

}  // namespace palmar
