// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/statistics/exclusion.h"

#include <array>
#include <cmath>

#include "palmar/core/enum_index.h"

namespace palmar::study {
namespace {

// What a share of a range loses by rounding when the range is reduced and a joint stops at its end.
constexpr double kShareRounding = 1e-9;

// What a way of holding asks too much of: range, strength, nails.
std::array<bool, 3> lacks(const GraspDemand& demand, const Capability& capability) {
  return {demand.range_share > capability.range_share + kShareRounding,
          capability.grip_strength > 0.0 && demand.grip_strength > capability.grip_strength,
          capability.nail_length > demand.nail_room};
}

ExclusionCause cause_of(StudyOutcome outcome) {
  switch (outcome) {
    case StudyOutcome::kTooLarge:
      return ExclusionCause::kTooLarge;
    case StudyOutcome::kTooSmall:
      return ExclusionCause::kTooSmall;
    case StudyOutcome::kSlipsOut:
      return ExclusionCause::kSlipsOut;
    case StudyOutcome::kFailed:
      return ExclusionCause::kUnknown;
    case StudyOutcome::kNotGraspable:
    case StudyOutcome::kPartlyHeld:  // without force: touched, not held
    case StudyOutcome::kHeld:
      break;
  }
  return ExclusionCause::kNotGraspable;
}

// Profiles that leave the hand's size and its cover the same find ways of holding for each other.
bool are_akin(const population::HandProfile& a, const population::HandProfile& b) {
  return a.size_factor == b.size_factor && a.glove_thickness == b.glove_thickness &&
         (a.glove_thickness == 0.0 || a.glove_shear_modulus == b.glove_shear_modulus);
}

const population::HandProfile& profile_at(const StudyPlan& plan, int profile) {
  return plan.profiles[profile];
}

}  // namespace

std::string name_of(ExclusionCause cause) {
  constexpr std::array<const char*, kExclusionCauses> kNames = {
      "none",  "too_large", "too_small", "not_graspable", "slips_out",
      "range", "strength",  "nails",     "unknown"};
  return kNames[index_of(cause)];
}

std::string words_of(ExclusionCause cause) {
  constexpr std::array<const char*, kExclusionCauses> kWords = {
      "not excluded",    "too large",     "too small", "not graspable", "slips out",
      "range of motion", "grip strength", "nails",     "no answer"};
  return kWords[index_of(cause)];
}

Capability capability_of(const population::HandProfile& profile,
                         const population::HandSample& person) {
  return {.range_share = profile.range_share,
          .grip_strength = profile.strength_share * person.grip_strength,
          .nail_length = profile.nail_length};
}

ExclusionCause exclusion_of(std::span<const StudyRecord* const> records, const StudyRecord* own,
                            const Capability& capability) {
  int fewest = 4;
  ExclusionCause cause = ExclusionCause::kUnknown;
  for (const StudyRecord* record : records) {
    if (!is_in_hand(*record)) continue;
    const auto lack = lacks(record->demand, capability);
    const int count =
        static_cast<int>(lack[0]) + static_cast<int>(lack[1]) + static_cast<int>(lack[2]);
    if (count == 0) return ExclusionCause::kNone;
    if (count >= fewest) continue;
    fewest = count;
    cause = lack[0] ? ExclusionCause::kRange
                    : (lack[1] ? ExclusionCause::kStrength : ExclusionCause::kNails);
  }
  if (fewest < 4) return cause;
  if (own != nullptr && own->outcome != StudyOutcome::kFailed) return cause_of(own->outcome);
  for (const StudyRecord* record : records) {
    if (record->outcome != StudyOutcome::kFailed) return cause_of(record->outcome);
  }
  return ExclusionCause::kUnknown;
}

Exclusion exclusion_of(const StudyResults& results, const StudyCondition& condition, int product,
                       double level) {
  const StudyPlan& plan = results.plan;
  const population::HandProfile& profile = profile_at(plan, condition.profile);
  Exclusion exclusion;
  exclusion.condition = condition;
  exclusion.product = product;
  std::array<int, kExclusionCauses> count{};
  for (const int hand : hands_of(plan, condition)) {
    std::vector<const StudyRecord*> ways;
    StudyCondition other = condition;
    for (int p = 0; p < static_cast<int>(plan.profiles.size()); ++p) {
      if (!are_akin(profile, profile_at(plan, p))) continue;
      other.profile = p;
      const StudyRecord* record = record_of(results, other, product, hand);
      if (record != nullptr) ways.push_back(record);
    }
    const population::HandSample& person = plan.hands[hand].sample;
    const ExclusionCause cause = exclusion_of(ways, record_of(results, condition, product, hand),
                                              capability_of(profile, person));
    ++count[index_of(cause)];
    if (cause != ExclusionCause::kUnknown && !(person.grip_strength > 0.0)) {
      ++exclusion.without_strength;
    }
  }
  int people = 0;
  for (const int n : count) people += n;
  exclusion.unknown = count[index_of(ExclusionCause::kUnknown)];
  people -= exclusion.unknown;
  const int included = count[index_of(ExclusionCause::kNone)];
  exclusion.excluded = statistics::wilson_proportion(people - included, people, level);
  for (int c = 1; c < static_cast<int>(ExclusionCause::kUnknown); ++c) {
    const int n = count[c];
    if (n == 0) continue;
    exclusion.causes.emplace_back(static_cast<ExclusionCause>(c),
                                  statistics::wilson_proportion(n, people, level));
  }
  return exclusion;
}

std::vector<Exclusion> exclusions(const StudyResults& results, double level) {
  std::vector<Exclusion> list;
  for (const StudyCondition& condition : conditions_of(results.plan)) {
    for (int product = 0; product < static_cast<int>(results.plan.products.size()); ++product) {
      list.push_back(exclusion_of(results, condition, product, level));
    }
  }
  return list;
}

}  // namespace palmar::study
