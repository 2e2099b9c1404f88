// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "palmar/report/study/study_page.h"
#include "palmar/report/words/plain_words.h"
#include "palmar/report/words/study_words.h"

namespace palmar::report {
namespace {

/// The product with the lowest mean of a quantity among those in some hand, or -1.
int lowest_of(const study::ConditionAnalysis& analysis, const std::string& key) {
  int lowest = -1;
  double least = 0.0;
  for (const study::ProductStatistics& one : analysis.products) {
    const study::QuantitySummary* summary = study::summary_of(one, key);
    if (summary == nullptr) continue;
    if (lowest < 0 || summary->summary.mean < least) {
      lowest = one.product;
      least = summary->summary.mean;
    }
  }
  return lowest;
}

void describe_pairs(const study::StudyResults& results, const study::ConditionAnalysis& analysis,
                    const std::string& key, std::vector<std::string>& sentences) {
  const study::QuantityComparison* comparison = study::comparison_of(analysis, key);
  const int lowest = lowest_of(analysis, key);
  if (comparison == nullptr || lowest < 0) return;
  for (const study::ProductPair& pair : comparison->pairs) {
    if (pair.first != lowest && pair.second != lowest) continue;
    const std::string force =
        grip_force_words(results, analysis.condition, pair.first, pair.second);
    sentences.push_back(capitalised(pair_words(results.plan, comparison->quantity, pair)) +
                        (force.empty() ? "" : " " + force));
  }
}

std::string share_words(const study::StudyResults& results, const study::Accommodation& one,
                        const study::Exclusion& exclusion, bool is_only) {
  const std::string& name = results.plan.products[static_cast<std::size_t>(one.product)].name;
  if (one.inside.n == 0) return name + ": no grasp was run.";
  std::string words = capitalised(name) + " is held by " + std::to_string(one.inside.count) +
                      " of " + counted(one.inside.n, "hand");
  if (study::is_drawn_by_chance(results.plan)) {
    words += " (" + short_number(100.0 * one.inside.share) + " %, 95 % interval " +
             short_number(100.0 * one.inside.interval.low, 2) + " to " +
             short_number(100.0 * one.inside.interval.high, 2) + " %)";
  }
  std::string causes;
  for (const study::OutsideCause& cause : one.causes) {
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
    if (cause == study::ExclusionCause::kRange || cause == study::ExclusionCause::kStrength) {
      words += " It asks for more " + words_of(cause) + " than " + hands + " have.";
    } else if (cause == study::ExclusionCause::kNails) {
      words += " Nails are in the way of " + hands + ".";
    }
  }
  return words;
}

/// "4 of 6 (67 %: 3 by grip strength, 1 by nails)", "nobody".
std::string excluded_words(const study::Exclusion& one) {
  if (one.excluded.count == 0) return "nobody";
  std::string causes;
  for (const auto& [cause, people] : one.causes) {
    if (cause == study::ExclusionCause::kNone || people.count == 0) continue;
    causes +=
        (causes.empty() ? "" : ", ") + std::to_string(people.count) + " by " + words_of(cause);
  }
  return std::to_string(one.excluded.count) + " of " + std::to_string(one.excluded.n) + " (" +
         short_number(100.0 * one.excluded.share, 2) + " %" +
         (causes.empty() ? "" : ": " + causes) + ")";
}

/// Whether a difference that the first condition has is that of another one, too.
std::string standing_words(const study::StudyResults& results, const study::ProductPair& first,
                           const study::ProductPair& other) {
  const auto sign = [](const study::ProductPair& pair) {
    return pair.mean_second < pair.mean_first;
  };
  const auto is_shown = [&](const study::ProductPair& pair) {
    return study::is_drawn_by_chance(results.plan)
               ? pair.verdict == study::DifferenceVerdict::kShown
               : pair.verdict != study::DifferenceVerdict::kTooFewPairs &&
                     pair.verdict != study::DifferenceVerdict::kNone;
  };
  const std::string names = results.plan.products[static_cast<std::size_t>(first.first)].name +
                            " and " +
                            results.plan.products[static_cast<std::size_t>(first.second)].name;
  if (other.verdict == study::DifferenceVerdict::kTooFewPairs) return names + " can't be compared";
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
std::string other_words(const study::StudyResults& results, const study::ConditionAnalysis& first,
                        const study::ConditionAnalysis& other) {
  std::string suits, excludes;
  for (std::size_t p = 0; p < other.exclusion.size(); ++p) {
    const std::string& name = results.plan.products[p].name;
    const statistics::Proportion& inside = other.accommodation[p].inside;
    suits += (suits.empty() ? "" : "; ") + name + " is held by " + std::to_string(inside.count) +
             " of " + std::to_string(inside.n);
    excludes += (excludes.empty() ? "" : "; ") + name + " asks too much of " +
                excluded_words(other.exclusion[p]);
  }
  std::string words =
      capitalised(condition_words(results.plan, other.condition)) + ": " + suits + "; " + excludes;
  const std::string key = "peak_pressure_cells_mpa";
  const study::QuantityComparison* before = study::comparison_of(first, key);
  const study::QuantityComparison* now = study::comparison_of(other, key);
  const int lowest = lowest_of(first, key);
  if (before == nullptr || now == nullptr || lowest < 0) return words + ".";
  for (std::size_t k = 0; k < before->pairs.size() && k < now->pairs.size(); ++k) {
    const study::ProductPair& pair = before->pairs[k];
    if (pair.first != lowest && pair.second != lowest) continue;
    words += "; " + standing_words(results, pair, now->pairs[k]);
    const auto forces = study::grip_forces(results, other.condition, pair.first, pair.second);
    if (forces && forces->are_unequal()) {
      words += "; at different grip forces (" + short_number(forces->first) + " and " +
               short_number(forces->second) + " N)";
    }
  }
  return words + ".";
}

/// Grasps of a condition that are held though forces are left over.
void describe_unbalanced(const study::StudyResults& results, const study::StudyCondition& condition,
                         std::vector<std::string>& sentences) {
  const study::StudyPlan& plan = results.plan;
  if (!plan.settings[static_cast<std::size_t>(condition.setting)].is_balanced) return;
  for (std::size_t p = 0; p < plan.products.size(); ++p) {
    if (!plan.products[p].posture_of.empty()) continue;
    int held = 0, unbalanced = 0;
    for (const int hand : study::hands_of(plan, condition)) {
      const study::StudyRecord* record =
          study::record_of(results, condition, static_cast<int>(p), hand);
      if (record == nullptr || !study::is_in_hand(*record)) continue;
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

std::vector<std::string> study_verdict(const study::StudyResults& results,
                                       const study::StudyAnalysis& all) {
  const study::ConditionAnalysis& analysis = all.conditions.front();
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
      const study::QuantitySummary* one = study::summary_of(analysis.products.front(), key);
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
  for (const study::ProductSizes& family : analysis.sizes) {
    std::string words = "Sizes of " + family.family + ": ";
    int served = -1;
    for (std::size_t k = 0; k < family.choices.size(); ++k) {
      const study::SizeChoice& choice = family.choices[k];
      if (choice.served.count == served) {
        words += "; one more serves nobody else";
        break;
      }
      served = choice.served.count;
      std::string names;
      for (const study::ServedBySize& size : choice.sizes) {
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

}  // namespace palmar::report
