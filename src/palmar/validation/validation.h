// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/core/progress.h"
#include "palmar/hand/hand.h"

namespace palmar::validation {

enum class Verdict {
  kMet,
  kMissed,
  kInformation,  ///< shown beside what others found, not judged
  kNotBuilt      ///< waits for a part of the program that is not there yet
};
std::string name_of(Verdict verdict);  ///< "met", "missed", "information", "not built yet"

/// What a quantity is held against. Edges are inclusive; without edges nothing is judged.
struct ValidationTarget {
  std::optional<double> value;    ///< a closed form or a measured figure
  std::optional<double> lowest;   ///< smallest that counts as met
  std::optional<double> highest;  ///< largest that counts as met
  std::string source;             ///< where value and edges come from
};

/// Within `share` of `value` either way (0.02 = 2 %).
ValidationTarget near_value(double value, double share, std::string source);
/// From `lowest` to `highest`.
ValidationTarget between(double lowest, double highest, std::string source);
ValidationTarget at_least(double lowest, std::string source);
ValidationTarget at_most(double highest, std::string source);
/// Shown, not judged. Not for a figure that was measured on people: a miss of one counts as missed.
ValidationTarget information(std::optional<double> value, std::string source);

/// One line of the table.
struct ValidationRow {
  std::string quantity;        ///< "force at 2 mm"
  std::string unit;            ///< "N", "mm2", "" for a plain number
  std::optional<double> ours;  ///< none: not built yet
  ValidationTarget target;
  Verdict verdict = Verdict::kInformation;
  /// Ours over the target's value less 1; without a value the way to the nearer edge as a share of
  /// that edge, 0 inside. None where there is nothing to compare.
  std::optional<double> difference;
  /// Commit that added the row with its target.
  std::string added_in;
  /// Commit that chose a setting of the program with this row in view; empty: nothing was chosen on
  /// it. A row that a setting was chosen on is no independent check of that setting.
  std::string chosen_in;
};

/// Judges a value; one that is not a number is missed.
ValidationRow judge(std::string quantity, std::string unit, double ours, ValidationTarget target);
/// A row that waits for another part of the program; `why` names the part.
ValidationRow not_built(std::string quantity, const std::string& why);

/// One case with its rows.
struct ValidationCase {
  std::string id;     ///< "G1", "layer"
  std::string title;  ///< what was done, which equations ran
  std::vector<ValidationRow> rows;
  double seconds = 0.0;  ///< for the record; not part of the deterministic result
};

struct ValidationReport {
  std::string hand_name;
  std::vector<ValidationCase> cases;
  int count(Verdict verdict) const;
};

struct ValidationOptions {
  /// Of the hand (skin_compliance.h); none: made when first needed.
  std::shared_ptr<const contact::SkinCompliance> compliance = nullptr;
  std::vector<std::string> cases;  ///< ids; empty: all
  bool quick = false;              ///< without those that take longer than some seconds
  void check() const;              ///< throws UsageError: an id that is not known
};

/// Ids of all cases in the order in which they run, and whether --quick leaves one out.
struct ValidationCaseName {
  std::string id, title;
  bool is_slow = false;
};
std::vector<ValidationCaseName> validation_cases();

/// Holds the simulator against closed forms, laws and published figures; nothing is read but the
/// hand. Throws UsageError, NumericalError (a case without a solution), Cancelled.
ValidationReport validate(std::shared_ptr<const hand::Hand> hand,
                          const ValidationOptions& options = {}, const Progress& progress = {});

/// The report as a table in Markdown, without times, so that it changes only with its figures.
std::string validation_markdown(const ValidationReport& report);
/// The same for a terminal, with times.
std::string validation_text(const ValidationReport& report);

}  // namespace palmar::validation
