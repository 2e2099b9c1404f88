// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "assess/balance_arguments.h"
#include "assess/friction_arguments.h"
#include "cli.h"
#include "grasp/grasp_options.h"
#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/product/check.h"
#include "palmar/records/assessment_json.h"
#include "palmar/records/index_json.h"
#include "palmar/records/posture/coordination_file.h"
#include "palmar/records/product/product_file.h"
#include "palmar/report/page/assessment_report.h"
#include "palmar/study/assessment/assessment.h"
#include "product/cad_arguments.h"
#include "text.h"

namespace palmar::cli {
namespace {

namespace fs = std::filesystem;

struct AssessArguments {
  std::vector<std::string> products;
  GraspArguments grasp;
  ContactArguments contact;
  FrictionArguments friction;
  BalanceArguments balance;
  CadArguments cad;
  std::string natural_postures;
  std::string out;
  bool no_pictures = false;
};

/// "palmar-report", or the first free "palmar-report-2", ...: nothing that stands there is touched.
std::string default_folder() {
  std::string folder = "palmar-report";
  for (int i = 2; fs::exists(folder); ++i) folder = "palmar-report-" + std::to_string(i);
  return folder;
}

std::string summary(const Hand& hand, const Product& product, const Assessment& assessment) {
  std::string text =
      fmt::format("== {}\n{}{}{}", product.name, grasp_text(assessment.grasp),
                  balance_text(assessment.balance), contact_text(assessment.contact)) +
      friction_text(hand, assessment) + index_text(assessment.indices);
  for (const Coating& coating : assessment.options.contact.coatings) {
    text += fmt::format("sleeve: {:g} mm of {:g} kPa{}\n", coating.thickness,
                        1000.0 * coating.shear_modulus,
                        coating.where.isEmpty() ? "" : ", inside its box");
  }
  return text;
}

/// Above this, finding crossing triangles takes more than a few tenths of a second.
constexpr int kMostTrianglesForCrossings = 100'000;

/// Adds what a check of its mesh finds to the product's notes.
void add_findings(Product& product) {
  const bool is_small = product.mesh.triangle_count() <= kMostTrianglesForCrossings;
  for (const Finding& finding : check_mesh(product.mesh, is_small).findings) {
    const bool is_known = std::any_of(
        product.notes.begin(), product.notes.end(),
        [&](const std::string& note) { return note.find(finding.text) != std::string::npos; });
    if (finding.severity != Severity::kOk && !is_known) product.notes.push_back(finding.text);
  }
}

Cancelled cancelled_with(std::size_t done, std::size_t asked, const std::string& folder) {
  if (done == 0) return Cancelled("cancelled before anything was finished; nothing written");
  return Cancelled(fmt::format(
      "cancelled; {} of {} product{} assessed, {}", done, asked, asked == 1 ? "" : "s",
      folder.empty() ? "printed" : "written to " + folder + " (pictures may be missing)"));
}

int run_assess(const AssessArguments& arguments, const Context& context) {
  AssessOptions options;
  options.grasp = arguments.grasp.options();
  options.contact = arguments.contact.options();
  options.friction = arguments.friction.options();
  options.balance = arguments.balance.options(arguments.friction, options.grasp.grip);
  // The thesis leaves the hand as it was closed.
  if (arguments.contact.preset == "xie2014" && !options.balance.grip_force) {
    options.balance.is_on = false;
  }
  const ContactModel model = arguments.contact.model();
  options.seed = context.common.seed;
  const Progress progress = make_progress(context.common);

  if (!arguments.out.empty()) check_report_folder(arguments.out);

  std::vector<FrictionOptions> friction;  // per product
  // Every product is read before the first is grasped: a mistyped name costs no waiting.
  std::vector<Product> products;
  for (const std::string& path : arguments.products) {
    if (progress.is_cancelled()) throw cancelled_with(0, arguments.products.size(), "");
    products.push_back(load_product(path, arguments.cad.options(arguments.grasp.unit, progress)));
    if (progress.is_cancelled()) throw cancelled_with(0, arguments.products.size(), "");
    add_findings(products.back());
    friction.push_back(arguments.friction.options_for(products.back()));
    for (const std::string& text : products.back().notes) note(context.common, path + ": " + text);
  }

  if (progress.report) progress.report(0.0, "preparing the hand");
  const auto hand = load_hand(arguments.grasp.hand, arguments.contact.tissue);
  if (!arguments.natural_postures.empty()) {
    options.indices.coordination = read_coordination(arguments.natural_postures, hand->skeleton);
  }
  const PreparedHand prepared(hand, model);

  std::vector<AssessedProduct> done;
  int code = 0;
  for (std::size_t i = 0; i < products.size(); ++i) {
    const double start = 0.1 + 0.6 * static_cast<double>(i) / static_cast<double>(products.size());
    const Progress part = part_of(
        progress, start, start + 0.6 / static_cast<double>(products.size()), products[i].name);
    options.grasp = arguments.grasp.options_for(products[i]);
    options.friction = friction[i];
    options.balance.load = options.friction.load;
    try {
      done.push_back({products[i], assess(prepared, products[i], options, part)});
    } catch (const Cancelled&) {
      break;
    }
    const ContactResult& contact = done.back().assessment.contact;
    if (contact.status == ContactStatus::kNotConverged) {
      note(context.common, products[i].name + ": " + contact.message);
      code = 4;
    }
  }

  bool is_cancelled = done.size() < products.size();
  const AssessmentSet set{
      .hand = hand, .assessments = std::move(done), .command_line = context.command_line};
  const bool writes = !arguments.out.empty() || !context.common.json;
  std::string folder = arguments.out;
  if (writes && !set.assessments.empty()) {
    if (folder.empty()) folder = default_folder();
    // What is done is written even when the user has cancelled, but for pictures; a second Ctrl-C
    // ends that too.
    const Progress writing = part_of(progress, 0.7, 1.0);
    try {
      write_report(folder, set, {.pictures = !arguments.no_pictures}, writing);
    } catch (const Cancelled&) {
      is_cancelled = true;
    }
  }
  finish_progress();
  if (is_cancelled && set.assessments.empty()) throw cancelled_with(0, products.size(), "");
  if (context.common.json) {
    print(assessment_json(set) + "\n");
  } else {
    for (const AssessedProduct& one : set.assessments) {
      print(summary(*hand, one.product, one.assessment) + "\n");
    }
    if (writes && !set.assessments.empty()) print("Report: " + folder + "/report.html\n");
  }
  if (is_cancelled) throw cancelled_with(set.assessments.size(), products.size(), folder);
  return code;
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
  verb->add_flag("--no-pictures", arguments->no_pictures, "Leave out the PNG pictures");
  verb->callback([&context, arguments] {
    context.run = [&context, arguments] { return run_assess(*arguments, context); };
  });
}

}  // namespace palmar::cli
