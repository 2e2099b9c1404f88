// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/core/language.h"
#include "palmar/core/progress.h"
#include "palmar/grasp/find/grasp_settings.h"
#include "palmar/grasp/rest/friction_settings.h"
#include "palmar/grasp/rest/rest_settings.h"
#include "palmar/records/assessment/verdict_text.h"
#include "palmar/report/page/print_pdf.h"
#include "palmar/report/page/report_extras.h"
#include "palmar/study/assessment/assessment.h"
#include "palmar/workflow/grasp/contact_with_band.h"
#include "palmar/workflow/hand/load_hand.h"
#include "palmar/workflow/note/note.h"
#include "palmar/workflow/product/product_choice.h"

namespace palmar::workflow {

/// How one hand holds one or more products, each by itself.
struct AssessRequest {
  std::vector<ProductChoice> products;  ///< files or values; at least one
  HandChoice hand;
  grasp::GraspSettings grasp;
  contact::ContactModel model = contact::palmar_model();  ///< the equations of the skin
  contact::ContactOptions contact = refined_contact_with_band();
  grasp::FrictionSettings friction;
  grasp::RestSettings rest;  ///< one grip force for all products, unless it says otherwise
  /// CSV of measured grasp postures (degrees, a column per joint angle) as basis of the index of
  /// ease; "": the built-in one.
  std::string natural_postures;
  /// Sensors between hand and product: a built-in layout or a TOML file (read_sensor_layout()); "":
  /// none.
  std::string sensors;
  /// CSV of what such sensors measured on the one product (read_measured_pressure()); "": nothing.
  std::string measured;
  bool error_budget = false;               ///< hold each product again with one thing changed
  Language language = Language::kEnglish;  ///< of the report and the verdict
  std::string out;                         ///< folder of the report; "": none is written
  bool pictures = true;                    ///< PNG pictures in it
  std::optional<report::Paper> pdf = std::nullopt;  ///< answer.pdf and report.pdf on this paper
  report::ReportExtras extras = {};  ///< whose it is, units, files for other programs
  std::uint64_t seed = 0;            ///< written into the results
  std::string command_line;          ///< for provenance
  NoteSink note = {};  ///< early notes: what was found in a product, why one has no solution
  void check() const;  ///< throws UsageError: setting, value, what is allowed
};

struct AssessOutcome {
  study::AssessmentSet set;     ///< of the products that were finished, in their order
  std::size_t asked = 0;        ///< products that were asked for
  bool is_cancelled = false;    ///< what was finished is here and, but for pictures, in the report
  bool has_converged = true;    ///< of every contact
  std::string folder;           ///< of the report; "": none was written
  records::VerdictWords words;  ///< the answer, as it stands in report and JSON
};

/// Reads all products, checks them, prepares the hand and assesses one product after the other;
/// writes a report of those that are finished if one is asked for (write_report()). Every product
/// is read before the first is grasped: a mistyped name costs no waiting.
///
/// When cancelled after the first product, the outcome holds what was finished; before, Cancelled
/// is thrown. Throws UsageError, InputError naming the file, OutputError.
AssessOutcome assess_products(const AssessRequest& request, const Progress& progress = {});

/// The verdict in words, and the report if one is asked for; the last 30 % of the whole.
/// `is_cancelled` says whether anything of the report is missing. Throws as assess_products().
void finish_assessment(const AssessRequest& request, const Progress& progress,
                       AssessOutcome& outcome);

/// "palmar-report" in the working folder, or the first free "palmar-report-2", ...: nothing that
/// stands there is touched.
std::string free_report_folder();

}  // namespace palmar::workflow
