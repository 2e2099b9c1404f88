// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "palmar/grasp/indices/grasp_index.h"
#include "palmar/hand/dimensions/hand_dimension.h"
#include "palmar/study/study_plan.h"
#include "palmar/study/study_record.h"

namespace palmar::study {

/// What a study found: the plan and a record of every grasp that was finished. Statistics need no
/// fields, so records come without skin_pressure and product_pressure; maps get those one by one
/// from a RecordSource.
struct StudyResults {
  StudyPlan plan;
  std::vector<StudyRecord> records;  ///< ascending by number
  void check() const;  ///< throws UsageError: a record outside the plan, twice, or out of order
};

/// Gives every record with its fields to `visit`, ascending by number; may be called again.
using RecordSource = std::function<void(const std::function<void(const StudyRecord&)>& visit)>;

/// Everything about a grasp but hand and product: within it products are compared.
struct StudyCondition {
  std::optional<int> population;  ///< nothing: all populations together
  int profile = 0, setting = 0, grip = 0;
};
bool is_same(const StudyCondition& a, const StudyCondition& b);
/// All conditions of a plan: for every profile, setting and grip first all populations together,
/// then, if there are several, each by itself.
std::vector<StudyCondition> conditions_of(const StudyPlan& plan);
/// "thesis", "ANSUR II women, gloves, tripod": for people; only what the plan has several of, and
/// at least the population.
std::string title_of(const StudyPlan& plan, const StudyCondition& condition);

/// Hands (indices into plan.hands) of a condition, ascending.
std::vector<int> hands_of(const StudyPlan& plan, const StudyCondition& condition);
/// The record of one hand with one product, or null if it wasn't run.
const StudyRecord* record_of(const StudyResults& results, const StudyCondition& condition,
                             int product, int hand);
/// Whether the product was held, at least partly, and pressed on the skin: only then do force and
/// pressure say how it feels to hold it.
bool is_in_hand(const StudyRecord& record);
/// What the hand measures, if the population says so; mm.
std::optional<double> size_of(const StudyHand& hand, hand::HandDimension dimension);
/// The same as it grasps under a condition: times the profile's size factor; mm.
std::optional<double> size_of(const StudyPlan& plan, const StudyCondition& condition, int hand,
                              hand::HandDimension dimension);
/// Whether hands are drawn by chance: those of a boundary or of percentiles are chosen, so that
/// shares of them, intervals and p values say nothing about people.
bool is_drawn_by_chance(const StudyPlan& plan);

inline constexpr int kStudyOutcomes = 7;
/// How the grasps of a condition ended; they sum to the hands of the condition.
struct OutcomeCounts {
  std::array<int, kStudyOutcomes> of{};  ///< by StudyOutcome
  int not_run = 0;
  int hands() const;    ///< all
  int in_hand() const;  ///< held or partly held
};
OutcomeCounts outcomes_of(const StudyResults& results, const StudyCondition& condition,
                          int product);

/// A number that every grasp has: of the whole hand, what it asks of its owner, or an index.
struct StudyQuantity {
  std::string key;   ///< "peak_pressure_cells_mpa", "epsilon_l1"; as in files
  std::string name;  ///< for people: "peak pressure on sensor cells"
  std::string unit;  ///< "MPa"; "" if it has none
  grasp::Better better = grasp::Better::kNeither;
};
/// Those that at least one record has a value of: of the whole hand first, then indices in the
/// order in which they appear.
std::vector<StudyQuantity> quantities_of(const StudyResults& results);
/// The keys that every study has, without indices.
const std::vector<StudyQuantity>& hand_quantities();
/// Value of a quantity, if the product was in the hand and the grasp has one.
std::optional<double> quantity_of(const StudyRecord& record, const std::string& key);
/// The quantity with that key. Throws UsageError naming the nearest key.
StudyQuantity quantity_named(const StudyResults& results, const std::string& key);

}  // namespace palmar::study
