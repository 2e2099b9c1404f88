// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/statistics/study_analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "palmar/core/enum_index.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/study/statistics/study_holds.h"

namespace palmar::study {
namespace {

// Depths that the tissue was fitted to: d_lim of Xie 2014, section 3.3.
constexpr double kFittedPalmDepth = 7.0;    // mm
constexpr double kFittedFingerDepth = 4.0;  // mm
// Handles held against measurements: docs/method/validation.md, G3 to G5.
constexpr double kThinnestChecked = 25.0;  // mm
constexpr double kThickestChecked = 70.0;  // mm
constexpr double kLargestScaling = 0.2;    // share; beyond, the template's proportions are a guess
constexpr int kFewHands = 12;  // for a normal mean of differences; Wilcoxon needs 6 for p < 0.05

void add(std::vector<StudyWarning>& warnings, bool is_outside, std::string subject,
         std::string text) {
  warnings.push_back({is_outside, std::move(subject), std::move(text)});
}

void warn_of_settings(const StudyPlan& plan, std::vector<StudyWarning>& warnings) {
  for (const StudySetting& one : plan.settings) {
    const std::string subject = "Setting " + one.name;
    if (one.palm_limit_depth > kFittedPalmDepth) {
      add(warnings, true, subject,
          fmt::format("the palm is pressed in up to {:g} mm; the tissue was fitted up to {:g} mm.",
                      one.palm_limit_depth, kFittedPalmDepth));
    }
    if (one.finger_limit_depth > kFittedFingerDepth) {
      add(warnings, true, subject,
          fmt::format("fingers are pressed in up to {:g} mm; the tissue was fitted up to {:g} mm.",
                      one.finger_limit_depth, kFittedFingerDepth));
    }
    if (!one.is_balanced) {
      add(warnings, false, subject,
          "grasps stay as the hand was closed: forces on the product don't balance.");
    }
  }
}

/// The pair of products whose grip forces are furthest apart, over all conditions.
void warn_of_grip_forces(const StudyResults& results, std::vector<StudyWarning>& warnings) {
  const StudyPlan& plan = results.plan;
  int conditions = 0, unequal = 0;
  double worst = 1.0;
  std::string words;
  bool is_stated = true;
  for (const StudyCondition& condition : conditions_of(plan)) {
    if (condition.population) continue;
    ++conditions;
    bool is_unequal = false;
    for (int first = 0; first < static_cast<int>(plan.products.size()); ++first) {
      for (int second = first + 1; second < static_cast<int>(plan.products.size()); ++second) {
        const auto forces = grip_forces(results, condition, first, second);
        if (!forces || !forces->are_unequal()) continue;
        is_unequal = true;
        const double ratio =
            std::min(forces->first, forces->second) / std::max(forces->first, forces->second);
        if (ratio >= worst) continue;
        worst = ratio;
        words = fmt::format("{} with {:.0f} N, {} with {:.0f} N", plan.products[first].name,
                            forces->first, plan.products[second].name, forces->second);
        const StudySetting& setting = plan.settings[condition.setting];
        is_stated = setting.grip_force || setting.strength_share;
      }
    }
    unequal += is_unequal ? 1 : 0;
  }
  if (unequal == 0) return;
  if (conditions > 1) words += fmt::format(" (in {} of {} conditions)", unequal, conditions);
  add(warnings, false, "Grip force",
      "products are held at different grip forces: " + words + ". Pressures differ by that, too; " +
          (is_stated ? "not every hand reaches the requested force."
                     : "compare them in a study at one grip force (grip_force_n)."));
}

void warn_of_holds(const StudyResults& results, std::vector<StudyWarning>& warnings) {
  const StudyPlan& plan = results.plan;
  for (int product = 0; product < static_cast<int>(plan.products.size()); ++product) {
    bool is_told = false;
    int little = 0;
    for (const StudyCondition& condition : conditions_of(plan)) {
      // Conditions of all populations together come first and hold what the others do.
      if (condition.population && plan.populations.size() > 1) continue;
      const std::vector<HandsByHold> holds = holds_of(results, condition, product);
      little += hands_with_little(results, condition, product);
      if (holds.size() < 2 || is_told) continue;
      is_told = true;
      add(warnings, false, plan.products[product].name,
          "hands differ in how they hold it, so figures differ by that, too: " + words_of(holds) +
              ".");
    }
    if (little == 0) continue;
    add(warnings, false, plan.products[product].name,
        fmt::format("in {} grasp{} fewer parts of the hand touch it than the grip needs: those "
                    "hands would hold it otherwise.",
                    little, little == 1 ? "" : "s"));
  }
}

void warn_of_design(const StudyPlan& plan, std::vector<StudyWarning>& warnings) {
  if (!is_drawn_by_chance(plan)) {
    add(warnings, false, "Hands",
        "those of a boundary or of percentiles are chosen, not drawn by chance: p values and "
        "intervals in the tables mean nothing, and shares are of these hands, not of people.");
  }
  const bool is_weak = std::any_of(
      plan.profiles.begin(), plan.profiles.end(),
      [](const population::HandProfile& profile) { return profile.strength_share < 1.0; });
  const bool is_stated =
      std::any_of(plan.settings.begin(), plan.settings.end(),
                  [](const StudySetting& setting) { return setting.grip_force.has_value(); });
  for (const StudyProduct& product : plan.products) {
    if (!is_weak || is_stated || product.mass > 0.0) continue;
    add(warnings, false, product.name,
        "it has neither a load (mass_kg) nor a grip force (grip_force_n): strength excludes "
        "nobody, "
        "whatever a profile takes of it.");
  }
}

void warn_of_hands(const StudyPlan& plan, const hand::HandDimensions& base,
                   std::vector<StudyWarning>& warnings) {
  for (std::size_t p = 0; p < plan.populations.size(); ++p) {
    const population::Population& population = plan.populations[p].population;
    const std::string subject = "Population " + population.name;
    for (const std::string& caution : population.cautions) add(warnings, false, subject, caution);
    int hands = 0, far = 0;
    for (const StudyHand& hand : plan.hands) {
      if (hand.population != static_cast<int>(p)) continue;
      ++hands;
      const double length = size_of(hand, kHandLength).value_or(base.hand_length);
      far += std::abs(length / base.hand_length - 1.0) > kLargestScaling ? 1 : 0;
    }
    if (far > 0) {
      add(warnings, true, subject,
          fmt::format("{} of {} hands are more than {:g} % longer or shorter than the template "
                      "({:.0f} mm), whose shape they share.",
                      far, hands, 100.0 * kLargestScaling, base.hand_length));
    }
    if (hands < kFewHands) {
      add(warnings, false, subject,
          fmt::format("{} few: small differences can't be shown, and shares are rough.",
                      hands == 1 ? "1 hand is" : fmt::format("{} hands are", hands)));
    }
  }
  if (plan.populations.size() > 1) {
    add(warnings, false, "All populations",
        "together they count as they were drawn: shares and means are of these hands, not of a "
        "country's people.");
  }
  for (const population::HandProfile& profile : plan.profiles) {
    if (profile.size_factor < 1.0 - kLargestScaling) {
      add(warnings, true, "Profile " + profile.name,
          fmt::format("hands are the template's at {:g} of its size; children's differ in shape, "
                      "tissue and strength, too.",
                      profile.size_factor));
    }
  }
}

/// Whether every hand that holds product `p` does so by a loop of it, as a mug's.
bool is_held_by_loop(const StudyResults& results, int p) {
  int count = 0;
  for (const StudyRecord& record : results.records) {
    if (task_at(results.plan, record.number).product != p || !is_in_hand(record)) continue;
    if (!record.hold || record.hold->kind != product::PartKind::kLoop) return false;
    ++count;
  }
  return count > 0;
}

void warn_of_products(const StudyResults& results, const std::vector<product::Product>& products,
                      std::vector<StudyWarning>& warnings) {
  const StudyPlan& plan = results.plan;
  for (std::size_t p = 0; p < products.size() && p < plan.products.size(); ++p) {
    Vec3 sides = geometry::bounding_box(products[p].mesh).sizes();
    std::sort(sides.begin(), sides.end());
    const std::string box =
        fmt::format("{:.0f} x {:.0f} x {:.0f} mm", sides[2], sides[1], sides[0]);
    const std::string subject = plan.products[p].name;
    if (sides[1] < kThinnestChecked) {
      add(warnings, true, subject,
          fmt::format("it is {}; grips were checked against measurements on handles of {:g} to "
                      "{:g} mm.",
                      box, kThinnestChecked, kThickestChecked));
    } else if (sides[0] > kThickestChecked && !is_held_by_loop(results, static_cast<int>(p))) {
      add(warnings, true, subject,
          fmt::format("it is {}, nowhere thinner than {:g} mm as a whole; unless a handle of it is "
                      "held, that is thicker than anything that was checked.",
                      box, kThickestChecked));
    }
  }
}

void warn_of_fallbacks(const StudyResults& results, std::vector<StudyWarning>& warnings) {
  for (const contact::FallbackCount& one : contact::kFallbackCounts) {
    int count = 0;
    int grasps = 0;
    for (const StudyRecord& record : results.records) {
      count += record.fallbacks.*one.count;
      grasps += record.fallbacks.*one.count > 0;
    }
    if (grasps == 0) continue;
    add(warnings, false, "Contact solver",
        fmt::format("{} {}, in {} of {} grasps; their figures count.", count, one.words, grasps,
                    results.records.size()));
  }
}

void warn_of_outcomes(const StudyResults& results, std::vector<StudyWarning>& warnings) {
  const StudyPlan& plan = results.plan;
  std::vector<OutcomeCounts> counts(plan.products.size());
  std::vector<int> unbalanced(plan.products.size(), 0);
  std::vector<std::int64_t> run(plan.products.size(), 0);
  for (const StudyRecord& record : results.records) {
    const StudyTask task = task_at(plan, record.number);
    const int p = task.product;
    ++run[p];
    ++counts[p].of[index_of(record.outcome)];
    const bool wants_rest =
        plan.settings[task.setting].is_balanced && plan.products[p].posture_of.empty();
    if (is_in_hand(record) && wants_rest && !record.is_balanced) ++unbalanced[p];
  }
  const std::int64_t of_product =
      plan.products.empty() ? 0
                            : task_count(plan) / static_cast<std::int64_t>(plan.products.size());
  for (std::size_t p = 0; p < plan.products.size(); ++p) {
    const std::string& subject = plan.products[p].name;
    const auto add_note = [&](int grasps, const char* what) {
      if (grasps > 0) {
        add(warnings, true, subject,
            fmt::format("{} of {} grasps {}; they don't count in means and tests, but are counted "
                        "where hands are left out.",
                        grasps, run[p], what));
      }
    };
    const auto& of = counts[p].of;
    add_note(of[index_of(StudyOutcome::kSlipsOut)], "slip out of the hand");
    add_note(of[index_of(StudyOutcome::kTooLarge)] + of[index_of(StudyOutcome::kTooSmall)] +
                 of[index_of(StudyOutcome::kNotGraspable)],
             "find no hold");
    add_note(of[index_of(StudyOutcome::kFailed)], "gave no answer");
    if (unbalanced[p] > 0) {
      add(warnings, false, subject,
          fmt::format("{} of {} grasps are held without coming fully to rest; their figures count.",
                      unbalanced[p], run[p]));
    }
    if (run[p] < of_product) {
      add(warnings, true, subject,
          fmt::format("{} of {} grasps were not run yet; figures are of those that were.",
                      of_product - run[p], of_product));
    }
  }
}

}  // namespace

StudyAnalysis analyse_study(const StudyResults& results, const ComparisonOptions& options) {
  options.check();
  results.check();
  StudyAnalysis analysis;
  analysis.quantities = quantities_of(results);
  const auto products = static_cast<int>(results.plan.products.size());
  for (const StudyCondition& condition : conditions_of(results.plan)) {
    ConditionAnalysis one;
    one.condition = condition;
    for (int p = 0; p < products; ++p) {
      one.products.push_back(product_statistics(results, analysis.quantities, condition, p));
      one.accommodation.push_back(accommodation_of(results, condition, p, options.level));
      one.exclusion.push_back(exclusion_of(results, condition, p, options.level));
    }
    one.sizes = product_sizes(results, condition);
    one.comparisons.resize(analysis.quantities.size());
    parallel_for(static_cast<int>(analysis.quantities.size()), [&](int q) {
      one.comparisons[q] = compare_products(results, condition, analysis.quantities[q], options);
    });
    analysis.conditions.push_back(std::move(one));
  }
  return analysis;
}

const QuantityComparison* comparison_of(const ConditionAnalysis& analysis, const std::string& key) {
  for (const QuantityComparison& one : analysis.comparisons) {
    if (one.quantity.key == key) return &one;
  }
  return nullptr;
}

std::vector<StudyWarning> study_warnings(const StudyResults& results,
                                         const std::vector<product::Product>& products,
                                         const hand::HandDimensions& base) {
  std::vector<StudyWarning> warnings;
  warn_of_settings(results.plan, warnings);
  warn_of_products(results, products, warnings);
  warn_of_outcomes(results, warnings);
  warn_of_fallbacks(results, warnings);
  warn_of_holds(results, warnings);
  warn_of_grip_forces(results, warnings);
  warn_of_design(results.plan, warnings);
  warn_of_hands(results.plan, base, warnings);
  std::stable_partition(warnings.begin(), warnings.end(),
                        [](const StudyWarning& one) { return one.is_outside; });
  return warnings;
}

}  // namespace palmar::study
