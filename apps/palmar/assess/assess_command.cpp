// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "assess/assessment_text.h"
#include "assess/balance_arguments.h"
#include "assess/friction_arguments.h"
#include "cli.h"
#include "grasp/grasp_options.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/records/assessment/assessment_json.h"
#include "palmar/records/study/people_range.h"
#include "palmar/workflow/assess.h"
#include "palmar/workflow/assess_bench.h"
#include "palmar/workflow/study/study.h"
#include "palmar/workflow/study/study_report.h"
#include "product/cad_arguments.h"
#include "report_arguments.h"
#include "study/study_comparison_text.h"

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
  std::string sensors, measured;
  ReportArguments report;
  std::string out;
  bool left = false, error_budget = false;
  std::vector<std::string> populations;
  int hands = 0;
  bool no_pictures = false, details = false;
};

Cancelled cancelled_after(const workflow::AssessOutcome& outcome) {
  return Cancelled(fmt::format(
      "cancelled; {} of {} product{} assessed, {}", outcome.set.assessments.size(), outcome.asked,
      outcome.asked == 1 ? "" : "s",
      outcome.folder.empty() ? "printed"
                             : "written to " + outcome.folder + " (pictures may be missing)"));
}

workflow::AssessRequest request_of(const AssessArguments& arguments, const Context& context) {
  workflow::AssessRequest request;
  request.grasp = arguments.grasp.settings();
  request.contact = arguments.contact.options();
  request.friction = arguments.friction.settings();
  request.rest = arguments.balance.settings();
  // The thesis leaves the hand as it was closed.
  if (arguments.contact.preset() == "xie2014" && request.rest.is_usual()) {
    request.rest.is_balanced = false;
  }
  request.model = arguments.contact.model();
  request.hand = {.name = arguments.grasp.hand,
                  .tissue = arguments.contact.tissue,
                  .value = nullptr,
                  .person = arguments.balance.person(),
                  .is_left = arguments.left};
  const records::LoadProductOptions reading = arguments.cad.options(arguments.grasp.unit);
  for (const std::string& path : arguments.products) request.products.emplace_back(path, reading);
  request.natural_postures = arguments.natural_postures;
  request.sensors = arguments.sensors;
  request.measured = arguments.measured;
  request.error_budget = arguments.error_budget;
  request.out = arguments.out;
  if (request.out.empty() && !context.common.json) request.out = workflow::free_report_folder();
  request.language = arguments.report.language();
  request.pdf = arguments.report.pdf();
  request.extras = arguments.report.extras();
  request.pictures = !arguments.no_pictures;
  request.seed = context.common.seed;
  request.command_line = context.command_line;
  request.note = [&context](const std::string& text) { note(context.common, text); };
  return request;
}

/// The same question put to many hands: a small study with its report.
int run_as_study(const AssessArguments& arguments, const CLI::App& verb, const Context& context) {
  for (const std::string& product : arguments.products) {
    if (!workflow::is_bench_project(product)) continue;
    throw UsageError("--population doesn't go with " + product +
                     ": the project is of one hand; give the product's own file");
  }
  constexpr int kFewHands = 12;  // enough for a sign: 6 pairs are the fewest that show anything
  static const std::set<std::string> kTaken = {
      "PRODUCT", "help",  "unit",        "population",   "hands",        "out",     "language",
      "pdf",     "paper", "hold",        "part",         "along",        "toward",  "up",
      "purpose", "hand",  "no-pictures", "grip-force-n", "limit-depths", "units",   "project",
      "slides",  "excel", "rounded-csv", "mass-kg",      "task",         "turn-n-m"};
  for (const CLI::Option* option : verb.get_options()) {
    const std::string name = option->get_single_name();
    if (option->count() > 0 && !kTaken.contains(name)) {
      throw UsageError("--" + name +
                       " is of one hand and doesn't go with --population; a study file says it for "
                       "many (palmar study run FILE.toml)");
    }
  }
  workflow::QuickStudy quick;
  quick.products = arguments.products;
  quick.unit = parse_unit(arguments.grasp.unit);
  quick.populations = arguments.populations;
  const bool are_given =
      std::any_of(quick.populations.begin(), quick.populations.end(),
                  [](const std::string& one) { return records::is_people_range(one); });
  quick.hands = arguments.hands > 0 || are_given ? arguments.hands : kFewHands;
  if (arguments.grasp.hand != "template") quick.hand = arguments.grasp.hand;
  quick.holding = arguments.grasp.settings().holding;
  quick.mass = arguments.friction.settings().mass.value_or(0.0);
  const grasp::RestSettings rest = arguments.balance.settings();
  quick.task = rest.task;
  quick.turn = rest.turn;
  quick.grip_force = rest.grip_force;
  quick.limit_depths = rest.limit_depths;
  const std::string folder = arguments.out.empty() ? workflow::free_report_folder() : arguments.out;
  formats::create_folder(folder);

  workflow::StudyRunRequest run;
  run.study = workflow::study_of(quick);
  if (context.common.seed != 0) run.study.seed = context.common.seed;
  run.out = folder + "/hands.palmar";
  run.note = [&context](const std::string& text) { note(context.common, text); };
  const workflow::StudyRunOutcome ran = run_study(run, make_progress(context.common));
  workflow::StudyReportRequest report;
  report.store = ran.store;
  report.folder = folder;
  report.report.language = arguments.report.language();
  report.report.extras = arguments.report.extras();
  report.report.pictures = !arguments.no_pictures;
  report.pdf = arguments.report.pdf();
  workflow::report_study(report, make_progress(context.common));
  workflow::StudyCompareRequest compare;
  compare.store = ran.store;
  compare.language = report.report.language;
  const workflow::StudyCompareOutcome outcome = workflow::compare_study(compare);
  finish_progress();
  print(context.common.json ? comparison_object(outcome, compare.comparison).dump(2) + "\n"
                            : answer_text(outcome.answer) + "Report: " + folder + "/report.html\n");
  return 0;
}

/// A project of the workbench: what is held and how stands in the file.
workflow::AssessOutcome assessed_project(const AssessArguments& arguments, const CLI::App& verb,
                                         const Context& context) {
  static const std::set<std::string> kTaken = {
      "PRODUCT",      "help",     "out",     "language",    "pdf",           "paper",
      "units",        "project",  "slides",  "excel",       "rounded-csv",   "no-pictures",
      "grip-force-n", "friction", "mass-kg", "weight-n",    "density-g-cm3", "acceleration-g",
      "gravity",      "mass-at",  "load-n",  "torque-n-mm", "load-at"};
  const std::string& file = arguments.products.front();
  for (const CLI::Option* option : verb.get_options()) {
    const std::string name = option->get_single_name();
    if (option->count() > 0 && !kTaken.contains(name)) {
      throw UsageError("--" + name + " doesn't go with " + file +
                       ": the project says product, hand, hold and posture itself; what may be "
                       "given is the grip force (--grip-force-n), load, friction and the report");
    }
  }
  workflow::BenchAssessRequest request;
  request.file = file;
  request.grip_force = arguments.balance.settings().grip_force;
  request.friction = arguments.friction.settings();
  request.report = request_of(arguments, context);
  request.report.products.clear();
  return workflow::assess_bench_project(request, make_progress(context.common));
}

int run_assess(const AssessArguments& arguments, const CLI::App& verb, const Context& context) {
  const auto& products = arguments.products;
  const auto project = std::find_if(products.begin(), products.end(), workflow::is_bench_project);
  if (project != products.end() && products.size() > 1) {
    throw UsageError(*project + " is a project of the workbench and is assessed by itself; " +
                     std::to_string(products.size()) + " files are given");
  }
  const workflow::AssessOutcome outcome =
      project != products.end() ? assessed_project(arguments, verb, context)
                                : workflow::assess_products(request_of(arguments, context),
                                                            make_progress(context.common));
  finish_progress();
  if (context.common.json) {
    print(records::assessment_json(outcome.set, outcome.words) + "\n");
  } else {
    print(verdict_text(outcome.words));
    for (const study::AssessedProduct& one : outcome.set.assessments) {
      print((arguments.details ? details_text(*outcome.set.hand, one)
                               : summary_text(*outcome.set.hand, one)) +
            "\n");
    }
    if (!arguments.details) {
      print("Regions, joints and indices are in the report; --details prints them here.\n");
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
                            "palmar assess old.step new.step --out report");
  verb->add_option(
          "PRODUCT", arguments->products,
          "Files: STL, OBJ, PLY, 3MF, glTF, STEP or IGES; or one project that the workbench "
          "saved (.palmar-project)")
      ->required();
  arguments->grasp.add_to(*verb);
  arguments->cad.add_to(*verb);
  arguments->contact.add_to(*verb);
  arguments->friction.add_to(*verb);
  arguments->balance.add_to(*verb);
  verb->add_option("--natural-postures", arguments->natural_postures,
                   "CSV of measured grasp postures (degrees, a column per joint angle): basis of "
                   "the index of ease in place of the built-in one");
  verb->add_option("--sensors", arguments->sensors,
                   "Pressure sensors between hand and product, force and mean pressure per cell: "
                   "mat (wrapped round the held part), glove, or a layout's file (.toml)");
  verb->add_option(
      "--measured", arguments->measured,
      "CSV of what such sensors measured (row, column, patch; force_n, pressure_kpa or "
      "pressure_mpa), to lay beside the simulation; one product");
  verb->add_flag("--error-budget", arguments->error_budget,
                 "Hold each product again with one thing changed at a time: tissue, bone, mesh, "
                 "friction, posture; some 15 s each");
  verb->add_flag("--left", arguments->left, "A left hand");
  verb->add_option("--population", arguments->populations,
                   "Many hands in place of one, as a small study: a built-in population (`palmar "
                   "population list`), people from one size to another (woman:P5..man:P95), a "
                   "population file (.toml) or a table of given hands (.csv)")
      ->allow_extra_args(false);
  verb->add_option("--hands", arguments->hands,
                   "Number of hands to draw from each population; 12 if not given")
      ->check(CLI::Range(1, workflow::QuickStudy::kMostHands));
  verb->add_option("--out", arguments->out,
                   "Folder of the report; default palmar-report (with --json alone: none)");
  arguments->report.add_to(*verb);
  verb->add_flag("--details", arguments->details,
                 "Print every figure on the terminal: regions, joints, indices");
  verb->add_flag("--no-pictures", arguments->no_pictures, "Leave out the PNG pictures");
  verb->callback([&context, arguments, verb] {
    context.run = [&context, arguments, verb] {
      if (!arguments->populations.empty()) return run_as_study(*arguments, *verb, context);
      if (arguments->hands > 0) {
        throw UsageError("--hands is the number of hands of a --population, which is not given");
      }
      return run_assess(*arguments, *verb, context);
    };
  });
}

}  // namespace palmar::cli
