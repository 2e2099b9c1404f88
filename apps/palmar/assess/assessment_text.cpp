// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "assess/assessment_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "assess/balance_arguments.h"
#include "assess/friction_arguments.h"
#include "palmar/contact/prepared/resolution.h"
#include "palmar/records/assessment/index_json.h"
#include "palmar/report/page/friction_words.h"
#include "palmar/report/words/plain_words.h"
#include "palmar/study/assessment/error_budget.h"
#include "palmar/study/assessment/hold_doubts.h"
#include "plain_names.h"
#include "text.h"

namespace palmar::cli {
namespace {

/// What the sensors say, and how near a measurement is.
std::string sensor_text(const study::Assessment& assessment) {
  if (!assessment.sensors) return "";
  const study::SensorReading& reading = *assessment.sensors;
  std::string text = fmt::format(
      "sensors: {} of {} cells, {:.1f} N on them, {:.1f} N beside; highest cell {:.1f} kPa\n",
      reading.layout.name, reading.cells.size(), reading.force, reading.force_beside,
      1000.0 * reading.peak_pressure);
  if (!assessment.measured) return text;
  const study::PressureComparison& one = *assessment.measured;
  return text + fmt::format(
                    "measured: {:.1f} N, highest cell {:.1f} kPa; over {} loaded cells Pearson's r "
                    "{:.2f}, Spearman's {:.2f}, differences {:.1f} kPa (RMS)\n",
                    one.force_measured, 1000.0 * one.peak_measured, one.compared, one.pearson.r,
                    one.spearman.r, 1000.0 * one.rms);
}

/// What makes the figures doubtful, sensors and sleeves: the same in summary and details.
std::string notes_text(const study::Assessment& assessment) {
  std::string text;
  for (const study::HoldDoubt& doubt : study::doubts_of(assessment)) {
    if (doubt.key == "few_contacts") text += "doubtful: " + doubt.words + "\n";
  }
  const std::string unresolved = contact::unresolved_words(assessment.contact);
  const std::string refined = contact::refinement_words(assessment.contact);
  if (!unresolved.empty()) {
    text += "not resolved: " + with_plain_names(unresolved) + "\n";
  } else if (!refined.empty()) {
    text += "refined: " + with_plain_names(refined) + "\n";
  }
  text += sensor_text(assessment);
  for (const contact::Coating& coating : assessment.options.contact.coatings) {
    text += fmt::format("sleeve: {:g} mm of {:g} kPa{}\n", coating.thickness,
                        1000.0 * coating.shear_modulus,
                        coating.where.isEmpty() ? "" : ", inside its box");
  }
  return text;
}

/// One line for each thing changed: what becomes of the figures, against those as they are.
std::string error_budget_text(const study::ErrorBudget& budget) {
  const auto line = [](const std::string& name, const study::ErrorCase& one) {
    return fmt::format("{:<42}{:>6.0f}{:>8.0f}{:>9.0f}{:>10.3f}{:>9.3f}\n", name, one.grip_force,
                       one.force, one.area, one.peak_pressure_cells, one.mean_pressure);
  };
  std::string text =
      fmt::format("{:<42}{:>6}{:>8}{:>9}{:>10}{:>9}\n{:<42}{:>6}{:>8}{:>9}{:>10}{:>9}\n",
                  "error budget", "grip", "force", "area", "on a cell", "mean", "", "N", "N", "mm²",
                  "MPa", "MPa") +
      line("as it is", budget.nominal);
  for (const study::ErrorCase& one : budget.cases) {
    const std::string name = fmt::format("{}: {}", name_of(one.source), one.changed);
    text += one.failure.empty() ? line(name, one) : name + ": no figures: " + one.failure + "\n";
  }
  return text;
}

/// Area and highest pressure, with what soft and stiff skin make of it.
std::string pressure_text(const contact::ContactResult& contact) {
  if (contact.status == contact::ContactStatus::kNoContact) return "contact: nothing is touched\n";
  const contact::RegionContact& total = contact.total;
  std::string text = fmt::format("contact area: {} mm²\n", report::short_number(total.area)) +
                     fmt::format("highest pressure: {} MPa on a sensor cell",
                                 report::short_number(total.peak_pressure_cells));
  if (contact.band) {
    const contact::ContactBandRow& all = contact.band->total;
    if (all.peak_pressure_cells_low > 0.0 && all.peak_pressure_cells_high > 0.0) {
      text += fmt::format("; {} with soft, {} with stiff skin",
                          report::short_number(all.peak_pressure_cells_low),
                          report::short_number(all.peak_pressure_cells_high));
    }
  }
  return text + "\n";
}

/// How much area and highest pressure change if the hand or the force were a little other.
std::string certainty_text(const study::Assessment& assessment) {
  if (!assessment.certainty) return {};
  const study::Certainty& sure = *assessment.certainty;
  const auto change = [](const study::FigureChange& one) {
    return fmt::format("area {:+.1f} %, highest pressure {:+.1f} %", 100.0 * one.area,
                       100.0 * one.peak_pressure_cells);
  };
  std::string text = "in a hand 1 % larger: " + change(sure.hand_size) + "\n" +
                     "at 1 % more force: " + change(sure.grip_force) + "\n";
  if (sure.second) {
    text += "in a second way to rest, " +
            fmt::format("{:+.0f} % effort: ", 100.0 * (sure.second->effort - 1.0)) +
            change(sure.second->change) + "\n";
  }
  return text;
}

}  // namespace

std::string verdict_text(const records::VerdictWords& words) {
  std::string text = words.sentence + "\n";
  for (const std::string& reason : words.reasons) text += "  " + reason + "\n";
  if (!words.command.empty()) text += words.next + "\n  " + words.command + "\n";
  return text + "\n";
}

std::string summary_text(const hand::Hand& hand, const study::AssessedProduct& one) {
  const study::Assessment& assessment = one.assessment;
  const grasp::Grasp& grasp = assessment.grasp;
  std::string text = fmt::format("== {}\n", one.product.name);
  if (grasp.hold) text += fmt::format("hold: {}\n", grasp.hold_words);
  text += status_text(grasp);
  text += balance_text(assessment) + pressure_text(assessment.contact) + certainty_text(assessment);
  const std::string friction = report::friction_verdict(hand, assessment);
  if (!friction.empty()) text += "friction: " + friction + "\n";
  return text + notes_text(assessment) + (one.errors ? error_budget_text(*one.errors) : "");
}

std::string details_text(const hand::Hand& hand, const study::AssessedProduct& one) {
  const study::Assessment& assessment = one.assessment;
  return fmt::format("== {}\n", one.product.name) + balance_text(assessment) +
         rest_text(assessment) + grasp_text(assessment.grasp) + contact_text(assessment.contact) +
         friction_text(hand, assessment) +
         with_plain_names(records::index_text(assessment.indices)) + notes_text(assessment) +
         (one.errors ? error_budget_text(*one.errors) : "");
}

}  // namespace palmar::cli
