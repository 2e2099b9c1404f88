// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "report_arguments.h"

namespace palmar::cli {

void ReportArguments::add_to(CLI::App& verb) {
  verb.add_option("--language", language_, "Language of the report: en or de")
      ->capture_default_str();
  verb.add_option("--units", units_,
                  "Units in which the page opens: metric (mm, N, MPa) or us (inches, pounds, psi); "
                  "files keep the first")
      ->capture_default_str();
  verb.add_option("--project", project_,
                  "TOML file with name, author, notes and logo of the project, for the report");
  verb.add_flag("--pdf", pdf_,
                "Print the first screen (answer.pdf) and all (report.pdf) with a headless browser");
  verb.add_option("--paper", paper_, "Paper of --pdf: a4 or letter")->capture_default_str();
  verb.add_flag("--slides", slides_,
                "Pictures of 1920 x 1080 for slides, with a headless browser: slide-answer.png, "
                "slide-hold.png, slide-map.png");
  verb.add_flag("--excel", excel_, "All tables as one Excel workbook, report.xlsx");
  verb.add_flag("--rounded-csv", rounded_csv_,
                "Beside every table X.csv X-rounded.csv with three digits");
}

Language ReportArguments::language() const { return language_named(language_); }

std::optional<report::Paper> ReportArguments::pdf() const {
  const report::Paper paper = report::paper_named(paper_);
  return pdf_ ? std::optional(paper) : std::nullopt;
}

report::ReportExtras ReportArguments::extras() const {
  report::ReportExtras extras{.units = report::units_named(units_),
                              .project = {},
                              .excel = excel_,
                              .rounded_csv = rounded_csv_,
                              .slides = slides_};
  if (!project_.empty()) extras.project = records::read_project(project_);
  return extras;
}

}  // namespace palmar::cli
