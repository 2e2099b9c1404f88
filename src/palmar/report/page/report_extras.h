// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "palmar/records/csv.h"
#include "palmar/records/project_file.h"
#include "palmar/records/workbook.h"

namespace palmar::report {

/// In which units a report's page opens; a button in it changes them. Files keep SI units.
enum class Units { kMetric, kUs };
std::string name_of(Units units);  ///< "metric" (mm, N, MPa), "us" (inches, pounds, psi)
/// Throws UsageError with what is allowed.
Units units_named(const std::string& name);

/// Whose a report is, and which files it gets for programs of the desk.
struct ReportExtras {
  Units units = Units::kMetric;
  records::Project project;
  bool excel = false;        ///< report.xlsx, one sheet a table
  bool rounded_csv = false;  ///< beside every table X.csv X-rounded.csv with three digits
  bool slides = false;       ///< pictures of hold and map are kept sharp for slides (print_pdf.h)
};

/// A table with the name of its file without ending, and what a row of it is.
struct DeskTable {
  std::string name;
  std::string about;
  records::CsvTable table;
};
/// Writes what `extras` asks for of these tables into a report's folder; tables without rows are
/// left out. Throws OutputError.
void write_desk_tables(const std::filesystem::path& folder, const std::string& title,
                       const std::vector<DeskTable>& tables, const ReportExtras& extras);

}  // namespace palmar::report
