// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

// What the tasks on tables of subjects share.

#include <filesystem>
#include <string>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/records/csv.h"
#include "palmar/records/table_results.h"
#include "palmar/workflow/population/table_choice.h"

namespace palmar::workflow {

/// The analysis of every group of a table; what it says about a group of too few subjects names the
/// group. `groups` becomes what was analysed.
template <typename Result, typename Analyse>
records::TableResults<Result> analysed(const TableChoice& choice, double level,
                                       std::vector<population::TableGroup>& groups,
                                       const Analyse& analyse) {
  records::TableResults<Result> results;
  results.source = choice.file;
  results.by = choice.by;
  results.level = level;
  groups = load_groups(choice, results.notes);
  for (const population::TableGroup& group : groups) {
    try {
      results.groups.push_back({group.name, group.table.subjects(), analyse(group.table)});
    } catch (const InputError& error) {
      if (choice.by.empty()) throw;
      throw InputError(std::string(error.what()) + " (" + choice.by + " " + group.name + ")");
    }
  }
  return results;
}

/// The table as a file of that folder, which is made if missing.
inline void write_table(const std::string& folder, const std::string& name,
                        const records::CsvTable& table) {
  formats::create_folder(folder);
  formats::write_file(std::filesystem::path(folder) / name, records::format_csv(table));
}

}  // namespace palmar::workflow
