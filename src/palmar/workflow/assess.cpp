// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/assess.h"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/grasp/rest/usual_task.h"
#include "palmar/records/posture/coordination_file.h"
#include "palmar/records/sensors/measured_pressure_file.h"
#include "palmar/records/sensors/sensor_layout_file.h"
#include "palmar/report/page/assessment_report.h"
#include "palmar/report/words/verdict_words.h"
#include "palmar/study/assessment/error_budget.h"
#include "palmar/workflow/grasp/hold_product.h"
#include "palmar/workflow/hand/tissue_on_bone.h"

namespace palmar::workflow {
namespace {

// Shares of the whole: reading and preparing, assessing, writing the report.
constexpr double kPrepared = 0.1;
constexpr double kHeld = 0.25;
constexpr double kAssessed = 0.7;
constexpr double kWritten = 0.9;  // if it is printed, too

Cancelled cancelled_early() {
  return Cancelled("cancelled before anything was finished; nothing written");
}

/// What depends on the product, read once: the same for every hand.
struct ProductTask {
  product::Product product;
  grasp::GraspOptions grasp;
  contact::FrictionOptions friction;
};

/// Takes hold of all products, so that what is usual for them can be said of all.
std::vector<HeldProduct> take_products(const AssessRequest& request,
                                       const std::shared_ptr<const hand::Hand>& hand,
                                       const std::vector<ProductTask>& tasks,
                                       const Progress& progress) {
  std::vector<HeldProduct> held;
  const double step = (kHeld - kPrepared) / static_cast<double>(tasks.size());
  for (const ProductTask& task : tasks) {
    const double start = kPrepared + step * static_cast<double>(held.size());
    grasp::GraspOptions options = task.grasp;
    // A hold by its number is that of `palmar grasp holds`.
    if (!held.empty() && !request.grasp.holding.number) options.holds.like = held.front().turn();
    held.push_back(take_product(
        hand, task.product, request.grasp, options,
        part_of(progress, start, start + step, "taking hold of " + task.product.name)));
  }
  return held;
}

/// What hands do with products that are taken so.
grasp::UsualTask usual_task_of(const std::vector<ProductTask>& tasks,
                               const std::vector<HeldProduct>& held, double hand_length) {
  std::vector<std::optional<grasp::UsualTask>> usual;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    usual.push_back(grasp::usual_task(tasks[i].product, held[i].grasp, hand_length));
  }
  return grasp::task_of_all(usual);
}

std::vector<ProductTask> read_products(const AssessRequest& request, const Progress& progress) {
  std::vector<ProductTask> tasks;
  for (const ProductChoice& choice : request.products) {
    if (progress.is_cancelled()) throw cancelled_early();
    product::Product product = load_product(choice, progress);
    if (progress.is_cancelled()) throw cancelled_early();
    add_findings(product);
    const contact::FrictionOptions friction =
        request.rest.load(request.friction).options_for(product);
    for (const std::string& text : product.notes) {
      note_to(request.note, choice.name() + ": " + text);
    }
    grasp::GraspOptions grasp = options_for(request.grasp, product);
    if (!request.grasp.holding.number) grasp.grip_force = request.rest.grip_force;
    tasks.push_back({std::move(product), grasp, friction});
  }
  return tasks;
}

/// What has to be held, of all products: the usual grip force is the same for all of them.
grasp::HeaviestLoad heaviest_of(const std::vector<ProductTask>& tasks) {
  grasp::HeaviestLoad heaviest;
  for (const ProductTask& task : tasks) heaviest.add(task.product, task.friction.load);
  return heaviest;
}

study::AssessOptions options_of(const AssessRequest& request, const hand::Skeleton& skeleton) {
  study::AssessOptions options;
  options.contact = request.contact;
  options.seed = request.seed;
  if (!request.natural_postures.empty()) {
    options.indices.coordination = records::read_coordination(request.natural_postures, skeleton);
  }
  return options;
}

void add_measured(const product::Product& product, const study::MeasuredPressure& measured,
                  study::Assessment& assessment) {
  if (!assessment.sensors) {
    throw UsageError(product.name + ": the hand doesn't touch it, so nothing stands beside " +
                     measured.source);
  }
  assessment.measured = study::compare_pressure(*assessment.sensors, measured);
}

}  // namespace

void AssessRequest::check() const {
  if (products.empty()) {
    throw UsageError("setting \"products\": none is given; at least one is required");
  }
  for (const ProductChoice& product : products) product.check();
  if (!measured.empty() && sensors.empty()) {
    throw UsageError("setting \"measured\": needs a sensor layout; setting \"sensors\" says which");
  }
  if (!measured.empty() && products.size() != 1) {
    throw UsageError("setting \"measured\": goes with one product; " +
                     std::to_string(products.size()) + " are given");
  }
  grasp.check();
  contact.check();
  friction.options();
  rest.options(friction.friction);
}

AssessOutcome assess_products(const AssessRequest& request, const Progress& progress) {
  request.check();
  if (!request.out.empty()) report::check_report_folder(request.out);
  std::optional<study::SensorLayout> sensors;
  std::optional<study::MeasuredPressure> measured;
  if (!request.sensors.empty()) sensors = records::read_sensor_layout(request.sensors);
  if (!request.measured.empty())
    measured = records::read_measured_pressure(request.measured, *sensors);
  std::vector<ProductTask> tasks = read_products(request, progress);
  if (grasp::holds_load(request.rest.task) && !request.friction.has_load()) {
    note_to(request.note,
            fmt::format("no mass is given: each product weighs as much as a solid of {:g} g/cm3",
                        grasp::kAssumedDensity));
  }

  if (progress.report) progress.report(0.0, "preparing the hand");
  const auto hand = load_hand(request.hand);
  study::AssessOptions options = options_of(request, hand->skeleton);
  options.sensors = sensors;
  const grasp::HeaviestLoad heaviest = request.rest.follows_product() || request.rest.is_usual()
                                           ? heaviest_of(tasks)
                                           : grasp::HeaviestLoad{};
  options.balance = request.rest.options(request.friction.friction, heaviest);
  options.balance.looks_nearby = true;
  const contact::PreparedHand prepared =
      prepared_hand(request.hand, hand, request.model, request.note);

  std::vector<HeldProduct> held;
  try {
    held = take_products(request, hand, tasks, progress);
  } catch (const Cancelled&) {
    throw cancelled_early();
  }
  if (request.rest.follows_product()) {
    options.balance.share_of_strength->holds_only =
        usual_task_of(tasks, held, hand->dimensions.hand_length) == grasp::UsualTask::kHold;
  }

  AssessOutcome outcome;
  outcome.asked = tasks.size();
  outcome.set = {.hand = hand, .assessments = {}, .command_line = request.command_line};
  std::shared_ptr<const contact::PreparedHand> reference;
  const double step = (kAssessed - kHeld) / static_cast<double>(tasks.size());
  for (std::size_t i = 0; i < tasks.size() && !outcome.is_cancelled; ++i) {
    ProductTask& task = tasks[i];
    const double start = kHeld + step * static_cast<double>(i);
    options.grasp = task.grasp;
    options.friction = task.friction;
    options.balance.load = task.friction.load;
    try {
      const auto assess_held = [&] {
        options.balance.like = reference_at_rest(held[i].reference_grasp, hand, task.product,
                                                 options, reference, progress);
        return study::assess(prepared, task.product, options,
                             part_of(progress, start, start + step, task.product.name),
                             [&](const Progress&) { return held[i].grasp; });
      };
      study::Assessment assessment = assess_held();
      if (auto other = held_otherwise(held[i], assessment, hand, prepared, task.product, options,
                                      reference, progress)) {
        held[i] = std::move(*other);
        assessment = assess_held();
      }
      if (measured) add_measured(task.product, *measured, assessment);
      std::shared_ptr<const study::ErrorBudget> errors;
      if (request.error_budget) {
        study::ErrorBudgetOptions budget;
        budget.compliance = [](const hand::Hand& own) {
          return tissue_on_bone(own, {.tissue = contact::TissueModel::kBone});
        };
        errors = std::make_shared<const study::ErrorBudget>(
            study::error_budget(hand, prepared, task.product, held[i].grasp, assessment, budget,
                                part_of(progress, start, start + step, task.product.name)));
      }
      outcome.set.assessments.push_back({std::move(task.product), std::move(assessment),
                                         held[i].ways, held[i].ways_hand, std::move(errors)});
    } catch (const Cancelled&) {
      outcome.is_cancelled = true;
      break;
    }
    const study::AssessedProduct& done = outcome.set.assessments.back();
    const grasp::Grip grip = done.assessment.grasp.grip;
    if (options.balance.share_of_strength && options.balance.share_of_strength->is_raised(grip)) {
      note_to(request.note, fmt::format("{}: grip force {:.0f} N: {}", done.product.name,
                                        options.balance.share_of_strength->force(grip),
                                        options.balance.asked_words(grip)));
    }
    if (done.ways && !done.ways->why_taken.empty()) {
      note_to(request.note,
              fmt::format("{}: {}; held in a {} (hold {}{})", done.product.name,
                          done.ways->why_taken, done.assessment.grasp.hold_words, done.ways->taken,
                          done.ways->purpose == grasp::HoldPurpose::kHandOver
                              ? " of --purpose hand-over"
                              : ""));
    }
    const std::string fallbacks = contact::fallbacks_in_words(done.assessment.contact.fallbacks);
    if (!fallbacks.empty()) {
      note_to(request.note, done.product.name + ": contact solver: " + fallbacks);
    }
    if (done.assessment.contact.status == contact::ContactStatus::kNotConverged) {
      note_to(request.note, done.product.name + ": " + done.assessment.contact.message);
      outcome.has_converged = false;
    }
  }
  if (outcome.set.assessments.empty()) throw cancelled_early();
  finish_assessment(request, progress, outcome);
  return outcome;
}

void finish_assessment(const AssessRequest& request, const Progress& progress,
                       AssessOutcome& outcome) {
  outcome.words =
      report::verdict_words(outcome.set, study::verdict_of(outcome.set), request.language);
  if (request.out.empty()) return;
  // What is done is written even when the user has cancelled, but for pictures.
  outcome.folder = request.out;
  try {
    report::write_report(
        request.out, outcome.set,
        {.language = request.language, .pictures = request.pictures, .extras = request.extras},
        part_of(progress, kAssessed, request.pdf || request.extras.slides ? kWritten : 1.0));
    if (request.pdf) {
      progress.update(kWritten, "PDF");
      report::print_pdf(std::filesystem::path(request.out) / "report.html", *request.pdf, progress);
    }
    if (request.extras.slides) {
      progress.update(kWritten, "slides");
      report::take_slides(std::filesystem::path(request.out) / "report.html", progress);
    }
  } catch (const Cancelled&) {
    outcome.is_cancelled = true;
  }
}

std::string free_report_folder() {
  std::string folder = "palmar-report";
  for (int i = 2; std::filesystem::exists(folder); ++i) {
    folder = "palmar-report-" + std::to_string(i);
  }
  return folder;
}

}  // namespace palmar::workflow
