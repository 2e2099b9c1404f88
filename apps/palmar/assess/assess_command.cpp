// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "assess/balance_arguments.h"
#include "assess/friction_arguments.h"
#include "cli.h"
#include "grasp/grasp_options.h"
#include "palmar/core/error.h"
#include "palmar/records/assessment_json.h"
#include "palmar/records/index_json.h"
#include "palmar/study/assessment/hold_doubts.h"
#include "palmar/workflow/assess.h"
#include "product/cad_arguments.h"
#include "text.h"

namespace palmar::cli {
namespace {

struct AssessArguments {
  std::vector<std::string> products;
  GraspArguments grasp;
  ContactArguments contact;
  FrictionArguments friction;
  BalanceArguments balance;
  CadArguments cad;
  std::string natural_postures;
  std::string out, language = "en", paper = "a4";
  bool pdf = false;
  bool no_pictures = false;
};

std::string summary(const Hand& hand, const Product& product, const Assessment& assessment) {
  std::string text = fmt::format("== {}\n{}{}{}", product.name, balance_text(assessment),
                                 grasp_text(assessment.grasp), contact_text(assessment.contact)) +
                     friction_text(hand, assessment) + index_text(assessment.indices);
  for (const HoldDoubt& doubt : doubts_of(assessment)) {
    if (doubt.key == "few_contacts") text += "to be doubted: " + doubt.words + "\n";
  }
  for (const Coating& coating : assessment.options.contact.coatings) {
    text += fmt::format("sleeve: {:g} mm of {:g} kPa{}\n", coating.thickness,
                        1000.0 * coating.shear_modulus,
                        coating.where.isEmpty() ? "" : ", inside its box");
  }
  return text;
}

/// The answer, why, and what to do next.
std::string verdict_text(const VerdictWords& words) {
  std::string text = words.sentence + "\n";
  for (const std::string& reason : words.reasons) text += "  " + reason + "\n";
  if (!words.command.empty()) text += words.next + "\n  " + words.command + "\n";
  return text + "\n";
}

Cancelled cancelled_after(const AssessOutcome& outcome) {
  return Cancelled(fmt::format(
      "cancelled; {} of {} product{} assessed, {}", outcome.set.assessments.size(), outcome.asked,
      outcome.asked == 1 ? "" : "s",
      outcome.folder.empty() ? "printed"
                             : "written to " + outcome.folder + " (pictures may be missing)"));
}

AssessRequest request_of(const AssessArguments& arguments, const Context& context) {
  AssessRequest request;
  request.grasp = arguments.grasp.settings();
  request.contact = arguments.contact.options();
  request.friction = arguments.friction.settings();
  request.rest = arguments.balance.settings();
  // The thesis leaves the hand as it was closed.
  if (arguments.contact.preset == "xie2014" && request.rest.is_usual()) {
    request.rest.is_balanced = false;
  }
  request.model = arguments.contact.model();
  request.hand = {
      .name = arguments.grasp.hand, .tissue = arguments.contact.tissue, .value = nullptr};
  const LoadProductOptions reading = arguments.cad.options(arguments.grasp.unit);
  for (const std::string& path : arguments.products) request.products.emplace_back(path, reading);
  request.natural_postures = arguments.natural_postures;
  request.out = arguments.out;
  if (request.out.empty() && !context.common.json) request.out = free_report_folder();
  request.language = language_named(arguments.language);
  const Paper paper = paper_named(arguments.paper);
  if (arguments.pdf) request.pdf = paper;
  request.pictures = !arguments.no_pictures;
  request.seed = context.common.seed;
  request.command_line = context.command_line;
  request.note = [&context](const std::string& text) { note(context.common, text); };
  return request;
}

int run_assess(const AssessArguments& arguments, const Context& context) {
  const AssessOutcome outcome =
      assess_products(request_of(arguments, context), make_progress(context.common));
  finish_progress();
  if (context.common.json) {
    print(assessment_json(outcome.set, outcome.words) + "\n");
  } else {
    print(verdict_text(outcome.words));
    for (const AssessedProduct& one : outcome.set.assessments) {
      print(summary(*outcome.set.hand, one.product, one.assessment) + "\n");
    }
    if (!outcome.folder.empty()) print("Report: " + outcome.folder + "/report.html\n");
  }
  if (outcome.is_cancelled) throw cancelled_after(outcome);
  return outcome.has_converged ? 0 : 4;
}

}  // namespace

void add_assess_command(CLI::App& app, Context& context) {
  const auto arguments = std::make_shared<AssessArguments>();
  CLI::App* verb = add_verb(app, "assess", "How products feel in the hand: grasp, contact, report",
                            "palmar assess old.stl new.stl --unit mm --out report");
  verb->add_option("PRODUCT", arguments->products, "Files: STL, OBJ, PLY, 3MF, glTF, STEP or IGES")
      ->required();
  arguments->grasp.add_to(*verb);
  arguments->cad.add_to(*verb);
  arguments->contact.add_to(*verb);
  arguments->friction.add_to(*verb);
  arguments->balance.add_to(*verb);
  verb->add_option("--natural-postures", arguments->natural_postures,
                   "CSV of measured grasp postures (degrees, a column per joint angle): basis of "
                   "the index of ease in place of the built-in one");
  verb->add_option("--out", arguments->out,
                   "Folder of the report; default palmar-report (with --json alone: none)");
  verb->add_option("--language", arguments->language, "Language of the report: en or de")
      ->capture_default_str();
  verb->add_flag(
      "--pdf", arguments->pdf,
      "Print the first screen (answer.pdf) and all (report.pdf) with a headless browser");
  verb->add_option("--paper", arguments->paper, "Paper of --pdf: a4 or letter")
      ->capture_default_str();
  verb->add_flag("--no-pictures", arguments->no_pictures, "Leave out the PNG pictures");
  verb->callback([&context, arguments] {
    context.run = [&context, arguments] { return run_assess(*arguments, context); };
  });
}

}  // namespace palmar::cli
