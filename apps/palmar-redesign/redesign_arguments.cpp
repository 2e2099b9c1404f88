// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "redesign_arguments.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "study/study_comparison_text.h"

namespace palmar::cli {
namespace {

/// Comparison and gains, as JSON.
void add_judgement(const workflow::RedesignOutcome& outcome,
                   const report::StudyAnswerOptions& options, nlohmann::ordered_json& object) {
  if (outcome.gains)
    object["gains"] = nlohmann::ordered_json::parse(workflow::gains_json(*outcome.gains));
  const std::optional<workflow::RedesignComparison>& comparison = outcome.comparison;
  if (!comparison) return;
  object["comparison"] = comparison_object(
      workflow::compare_results(comparison->results, comparison->quantities, options), {});
  object["comparison"]["in_other_hands"] = comparison->is_in_other_hands;
  for (const workflow::HoldChange& change : comparison->changes) {
    object["comparison"]["hold_changes"].push_back(
        {{"redesign", change.redesign},
         {"hands", change.hands},
         {"turn_deg", change.turn * geometry::kDegreesPerRadian},
         {"largest_turn_deg", change.largest_turn * geometry::kDegreesPerRadian},
         {"shift_mm", change.shift},
         {"largest_shift_mm", change.largest_shift},
         {"is_other_hold", change.is_other_hold()}});
  }
}

/// The same as text.
void print_judgement(const workflow::RedesignOutcome& outcome,
                     const report::StudyAnswerOptions& options, const Context& context) {
  const std::optional<workflow::RedesignComparison>& comparison = outcome.comparison;
  if (!comparison) return;
  print(comparison_text(
      workflow::compare_results(comparison->results, comparison->quantities, options)));
  note(context.common,
       "report: " + comparison->report.string() + "; study: " + comparison->study.string());
  if (outcome.gains) print(workflow::gains_text(*outcome.gains));
}

}  // namespace

void RedesignArguments::add_to(CLI::App& verb) {
  verb.add_option("PRODUCT", request.product,
                  "STEP, IGES or mesh file, or \"made: prism width_mm=35 fillet_mm=3\"")
      ->required();
  verb.add_option("--out", out, "Folder for what is made: new or empty, or of an earlier redesign")
      ->required();
  verb.add_option("--unit", unit, "Unit of a file that carries none: mm, cm, m, inch");
  verb.add_option("--population", request.populations,
                  "Whose hands hold it: a built-in population (`palmar population list`), a "
                  "population file (.toml) or a table of given hands (.csv)")
      ->allow_extra_args(false)
      ->capture_default_str();
  verb.add_option("--hands", request.hands, "Number of hands to sample from each population")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  verb.add_option("--hand", request.hand, "Hand that is scaled: template or a *.hand.glb file");
  verb.add_flag("--left", request.is_left, "Left hands");
  verb.add_option("--grip", grips, "any (as people would choose), medium_wrap, tripod ...")
      ->expected(1);
  holds.add_hold_to(verb);
  holds.add_to(verb);
  verb.add_option("--at", at, "Where it is held, product frame: x,y,z mm");
  verb.add_option("--axis", axis, "Direction of the handle there: x,y,z");
  verb.add_option("--language", language, "Language of the report: en or de")
      ->capture_default_str();
  verb.add_option("--hold-posture", posture,
                  "new: redesigns are grasped anew in the hold of the original, at the same grip "
                  "force; kept: in the posture in which the same hand holds the original, with "
                  "whatever force that gives")
      ->capture_default_str();
  verb.add_option(
          "--grip-force-n", request.grip_force,
          "Grip force with which all are held, N; 0: the usual one. With --hold-posture new")
      ->capture_default_str();
}

workflow::RedesignRequest RedesignArguments::read(const Context& context) const {
  workflow::RedesignRequest result = request;
  result.posture = workflow::redesign_posture(posture);
  result.unit = parse_unit(unit);
  result.language = language_named(language);
  for (const std::string& name : grips) result.grips.push_back(records::asked_grip_named(name));
  if (!at.empty()) result.at = workflow::parse_vector("--at", at);
  if (!axis.empty()) result.axis = workflow::parse_vector("--axis", axis);
  result.holding = holds.request();
  result.out = out;
  result.seed = context.common.seed;
  result.command = context.command_line;
  result.on_note = [&context](const std::string& text) { note(context.common, text); };
  return result;
}

void add_kept_boxes(CLI::App& verb, std::vector<std::string>& texts) {
  verb.add_option("--keep-box", texts,
                  "Box that must stay as it is: X0,Y0,Z0,X1,Y1,Z1, two corners in mm in the "
                  "product's frame; may be repeated")
      ->allow_extra_args(false);
}

std::vector<Box3> kept_boxes(const std::vector<std::string>& texts) {
  std::vector<Box3> boxes;
  for (const std::string& text : texts) {
    const std::vector<double> v = workflow::parse_list("--keep-box", text);
    if (v.size() != 6) {
      throw UsageError("--keep-box is \"" + text +
                       "\"; two corners X0,Y0,Z0,X1,Y1,Z1 in mm are required");
    }
    boxes.emplace_back();
    boxes.back().extend(Vec3(v[0], v[1], v[2])).extend(Vec3(v[3], v[4], v[5]));
  }
  return boxes;
}

void print_redesign(const workflow::RedesignOutcome& outcome, const Context& context,
                    const std::vector<NamedOutcome>& others) {
  finish_progress();
  report::StudyAnswerOptions options;
  options.command = context.command_line;
  if (outcome.comparison) options.language = outcome.comparison->language;
  if (context.common.json) {
    nlohmann::ordered_json object = nlohmann::ordered_json::parse(outcome.json);
    add_judgement(outcome, options, object);
    for (const NamedOutcome& one : others) {
      nlohmann::ordered_json use = {{"name", one.name}, {"weight", one.weight}};
      add_judgement(one.outcome, options, use);
      object["other_uses"].push_back(std::move(use));
    }
    print(object.dump(2) + "\n");
    return;
  }
  print_judgement(outcome, options, context);
  for (const NamedOutcome& one : others) {
    print(fmt::format("use \"{}\", {:.0f} % of the weight:\n", one.name, 100.0 * one.weight));
    print_judgement(one.outcome, options, context);
  }
}

}  // namespace palmar::cli
