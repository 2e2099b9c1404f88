// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "palmar/population/hand_profile.h"
#include "palmar/statistics/proportion.h"
#include "palmar/study/statistics/study_results.h"

namespace palmar::study {

/// Why a person can't use a product.
enum class ExclusionCause {
  kNone,          ///< not excluded
  kTooLarge,      ///< the fingers can't reach round it
  kTooSmall,      ///< the fist closes without holding it
  kNotGraspable,  ///< no place that the grip can take
  kSlipsOut,
  kRange,     ///< joints don't bend far enough for any way of holding that was found
  kStrength,  ///< muscles too weak for the task's force
  kNails,     ///< nails meet product or palm
  kUnknown    ///< no grasp gave an answer
};
inline constexpr int kExclusionCauses = 9;
std::string name_of(ExclusionCause cause);   ///< "none", "too_large", ..., "range", "unknown"
std::string words_of(ExclusionCause cause);  ///< for people: "range of motion"

/// What one person can do.
struct Capability {
  double range_share = 1.0;
  double grip_strength = 0.0;  ///< N, the profile's share of the person's own; 0: not known
  double nail_length = 0.0;    ///< mm
};
Capability capability_of(const population::HandProfile& profile,
                         const population::HandSample& person);

/// Whether a person is excluded. `records` are all ways that were found for one hand to hold one
/// product in one grip, whatever range, strength and nails they were found with; `own` is the one
/// found under the person's own profile, null if it wasn't run.
///
/// Not excluded if any of them holds the product and asks no more than the person can do. As the
/// list is the same for all profiles and less range or strength, or longer nails, meet fewer
/// demands, such a person is never included where an abler one isn't. Strength that isn't known
/// excludes nobody.
///
/// Cause: if one way holds, what the least demanding one asks too much of (fewest causes; range
/// before strength before nails); else what became of `own`, or of the first that gave an answer.
ExclusionCause exclusion_of(std::span<const StudyRecord* const> records, const StudyRecord* own,
                            const Capability& capability);

/// Share of people whom a product excludes under one condition.
struct Exclusion {
  StudyCondition condition;
  int product = 0;
  int unknown = 0;                  ///< people without an answer; not among the others
  statistics::Proportion excluded;  ///< of those with one
  std::vector<std::pair<ExclusionCause, statistics::Proportion>> causes;  ///< those that occur;
                                                                          ///< they add up
  int without_strength = 0;  ///< people whose strength isn't known, judged without it
};
Exclusion exclusion_of(const StudyResults& results, const StudyCondition& condition, int product,
                       double level = 0.95);
/// Of every condition and product, conditions first. Intervals after Wilson.
std::vector<Exclusion> exclusions(const StudyResults& results, double level = 0.95);

}  // namespace palmar::study
