// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "palmar/report/plain_words.h"
#include "palmar/report/study_page.h"
#include "palmar/report/study_words.h"

namespace palmar {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

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

void tell_pairs(const StudyResults& results, const ConditionAnalysis& analysis,
                const std::string& key, std::vector<std::string>& sentences) {
  const QuantityComparison* comparison = comparison_of(analysis, key);
  const int lowest = lowest_of(analysis, key);
  if (comparison == nullptr || lowest < 0) return;
  for (const ProductPair& pair : comparison->pairs) {
    if (pair.first != lowest && pair.second != lowest) continue;
    sentences.push_back(capitalised(pair_words(results.plan, comparison->quantity, pair)));
  }
}

std::string share_words(const StudyResults& results, const Accommodation& one,
                        const Exclusion& exclusion) {
  const std::string& name = results.plan.products[at(one.product)].name;
  if (one.inside.n == 0) return name + ": no grasp was run.";
  std::string words = capitalised(name) + " suits " + std::to_string(one.inside.count) + " of " +
                      std::to_string(one.inside.n) + " hands (" +
                      short_number(100.0 * one.inside.share) + " %, 95 % interval " +
                      short_number(100.0 * one.inside.interval.low, 2) + " to " +
                      short_number(100.0 * one.inside.interval.high, 2) + " %)";
  std::string causes;
  for (const OutsideCause& cause : one.causes) {
    causes +=
        (causes.empty() ? "" : ", ") + std::to_string(cause.hands) + " " + cause_words(cause.cause);
  }
  if (causes.empty()) {
    words += "; nobody is left out";
  } else {
    words += "; left out: " + causes;
    if (one.shortest_outside) {
      words += ", hands of " + short_number(*one.shortest_outside) + " to " +
               short_number(*one.longest_outside) + " mm length";
    }
  }
  words += ".";
  // Who doesn't get hold of it stands above; here whom it asks too much of.
  std::string asked;
  for (const auto& [cause, people] : exclusion.causes) {
    const bool is_asked = cause == ExclusionCause::kRange || cause == ExclusionCause::kStrength ||
                          cause == ExclusionCause::kNails;
    if (!is_asked || people.count == 0) continue;
    asked += (asked.empty() ? "" : ", ") + words_of(cause) + " " + std::to_string(people.count);
  }
  if (!asked.empty()) {
    words += " It asks too much of " + asked + " of " + std::to_string(exclusion.excluded.n) + ".";
  }
  return words;
}

}  // namespace

std::vector<std::string> study_verdict(const StudyResults& results,
                                       const ConditionAnalysis& analysis) {
  std::vector<std::string> sentences;
  tell_pairs(results, analysis, "peak_pressure_cells_mpa", sentences);
  if (results.plan.products.size() == 1) {
    for (const char* key : {"peak_pressure_cells_mpa", "contact_area_mm2"}) {
      const QuantitySummary* one = summary_of(analysis.products.front(), key);
      if (one == nullptr) continue;
      sentences.push_back(capitalised(one->quantity.name) + ": " + short_number(one->summary.mean) +
                          " " + one->quantity.unit + " on average, " + short_number(one->p5) +
                          " to " + short_number(one->p95) + " " + one->quantity.unit +
                          " for nine hands of ten.");
    }
  }
  for (std::size_t p = 0; p < analysis.accommodation.size(); ++p) {
    sentences.push_back(share_words(results, analysis.accommodation[p], analysis.exclusion[p]));
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
        names += (names.empty() ? "" : " + ") + results.plan.products[at(size.product)].name;
      }
      words += (k > 0 ? "; " : "") + std::to_string(choice.sizes.size()) + " (" + names +
               ") serve" + (choice.sizes.size() == 1 ? "s " : " ") +
               short_number(100.0 * choice.served.share) + " % of hands";
    }
    sentences.push_back(words + ".");
  }
  return sentences;
}

}  // namespace palmar
