// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/statistics/accommodation.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "palmar/study/statistics/study_statistics.h"

namespace palmar::study {
namespace {

bool is_within(double value, const StudyLimit& limit) {
  return (!limit.lowest || value >= *limit.lowest) && (!limit.highest || value <= *limit.highest);
}

bool is_inside_limit(const StudyRecord& record, const StudyLimit& limit) {
  const std::optional<double> value = quantity_of(record, limit.quantity);
  return value && is_within(*value, limit);
}

/// Every cause for which a grasp is outside.
std::vector<std::string> causes_of(const StudyRecord& record,
                                   const std::vector<StudyLimit>& limits) {
  if (!is_in_hand(record)) {
    const bool is_held =
        record.outcome == StudyOutcome::kHeld || record.outcome == StudyOutcome::kPartlyHeld;
    return {is_held ? "no contact" : name_of(record.outcome)};
  }
  std::vector<std::string> causes;
  for (const StudyLimit& limit : limits) {
    const std::optional<double> value = quantity_of(record, limit.quantity);
    if (!value) {
      causes.push_back(limit.quantity + " has no value");
    } else if (limit.lowest && *value < *limit.lowest) {
      causes.push_back(fmt::format("{} below {:g}", limit.quantity, *limit.lowest));
    } else if (limit.highest && *value > *limit.highest) {
      causes.push_back(fmt::format("{} above {:g}", limit.quantity, *limit.highest));
    }
  }
  return causes;
}

void widen(std::optional<double>& low, std::optional<double>& high, double value) {
  low = low ? std::min(*low, value) : value;
  high = high ? std::max(*high, value) : value;
}

}  // namespace

bool is_inside(const StudyRecord& record, const std::vector<StudyLimit>& limits) {
  return is_in_hand(record) && std::all_of(limits.begin(), limits.end(), [&](const auto& limit) {
           return is_inside_limit(record, limit);
         });
}

Accommodation accommodation_of(const StudyResults& results, const StudyCondition& condition,
                               int product, double level) {
  Accommodation found;
  found.condition = condition;
  found.product = product;
  const std::vector<StudyLimit>& limits = results.plan.limits;
  int run = 0, held = 0, inside = 0;
  std::vector<int> inside_limit(limits.size(), 0);
  std::map<std::string, int> causes;
  for (const int h : hands_of(results.plan, condition)) {
    const StudyRecord* record = record_of(results, condition, product, h);
    if (record == nullptr) {
      ++found.not_run;
      continue;
    }
    ++run;
    held += is_in_hand(*record) ? 1 : 0;
    const bool is_served = is_inside(*record, limits);
    inside += is_served ? 1 : 0;
    for (std::size_t k = 0; k < limits.size(); ++k) {
      inside_limit[k] += is_inside_limit(*record, limits[k]) ? 1 : 0;
    }
    for (const std::string& cause : causes_of(*record, limits)) ++causes[cause];
    if (const auto length = size_of(results.plan, condition, h, kHandLength)) {
      if (is_served) {
        widen(found.shortest_inside, found.longest_inside, *length);
      } else {
        widen(found.shortest_outside, found.longest_outside, *length);
      }
    }
  }
  found.in_hand = statistics::wilson_proportion(held, run, level);
  found.inside = statistics::wilson_proportion(inside, run, level);
  for (const int count : inside_limit) {
    found.inside_limit.push_back(statistics::wilson_proportion(count, run, level));
  }
  for (const auto& [cause, hands] : causes) found.causes.push_back({cause, hands});
  std::stable_sort(found.causes.begin(), found.causes.end(),
                   [](const auto& a, const auto& b) { return a.hands > b.hands; });
  return found;
}

std::vector<Accommodation> accommodation(const StudyResults& results, double level) {
  std::vector<Accommodation> all;
  for (const StudyCondition& condition : conditions_of(results.plan)) {
    for (int p = 0; p < static_cast<int>(results.plan.products.size()); ++p) {
      all.push_back(accommodation_of(results, condition, p, level));
    }
  }
  return all;
}

std::string words_of(const StudyResults& results, const StudyLimit& limit) {
  const StudyQuantity quantity = quantity_named(results, limit.quantity);
  std::string words = quantity.name;
  if (limit.lowest && limit.highest) {
    words += fmt::format(" {:g} to {:g}", *limit.lowest, *limit.highest);
  } else if (limit.highest) {
    words += fmt::format(" at most {:g}", *limit.highest);
  } else if (limit.lowest) {
    words += fmt::format(" at least {:g}", *limit.lowest);
  }
  return quantity.unit.empty() ? words : words + " " + quantity.unit;
}

}  // namespace palmar::study
