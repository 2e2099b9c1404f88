// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/report_extras.h"

#include "palmar/core/error.h"
#include "palmar/core/version.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/vtk.h"
#include "palmar/report/page/desk_json.h"

namespace palmar::report {

std::string name_of(Units units) { return units == Units::kUs ? "us" : "metric"; }

Units units_named(const std::string& name) {
  for (const Units units : {Units::kMetric, Units::kUs}) {
    if (name == name_of(units)) return units;
  }
  throw UsageError("setting \"units\" is \"" + name +
                   "\"; metric (mm, N, MPa) or us (inches, pounds, psi) is allowed");
}

PageJson desk_json(const ReportExtras& extras, Attachments& attachments) {
  const records::Project& project = extras.project;
  PageJson shown = nullptr;
  if (!project.is_empty()) {
    PageJson logo = nullptr;
    if (!project.logo.empty()) {
      attachments["logo"] =
          "data:" + project.logo_type + ";base64," + formats::base64(project.logo);
      logo = "attachment:logo";
    }
    shown = {{"name", project.name},
             {"author", project.author},
             {"remarks", project.notes},
             {"logo", std::move(logo)}};
  }
  return {{"units", name_of(extras.units)}, {"project", std::move(shown)}};
}

void write_desk_tables(const std::filesystem::path& folder, const std::string& title,
                       const std::vector<DeskTable>& tables, const ReportExtras& extras) {
  if (!extras.excel && !extras.rounded_csv) return;
  std::vector<records::WorkbookSheet> sheets;
  for (const DeskTable& one : tables) {
    if (one.table.rows.empty()) continue;
    sheets.push_back({one.name, one.about, one.table});
    if (extras.rounded_csv) {
      formats::write_file(folder / (one.name + "-rounded.csv"),
                          records::format_csv(records::rounded_table(one.table)));
    }
  }
  if (!extras.excel || sheets.empty()) return;
  std::vector<std::string> notes;
  for (const std::string& note :
       {extras.project.name, extras.project.author, extras.project.notes}) {
    if (!note.empty()) notes.push_back(note);
  }
  notes.push_back("Made by Palmar " + std::string(version()) +
                  ". Lengths in mm, forces in N, pressures in MPa (1 MPa = 1 N/mm² = 1000 kPa).");
  notes.push_back(
      "Numbers are shown shortened and kept in full digits. Compare designs with each other; "
      "single "
      "figures are less certain.");
  formats::write_file(folder / "report.xlsx", records::format_workbook(title, notes, sheets));
}

}  // namespace palmar::report
