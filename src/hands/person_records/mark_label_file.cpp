// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_records/mark_label_file.h"

#include <fmt/format.h>

#include <array>

#include "palmar/formats/csv_reader.h"

namespace palmar::person_records {
std::vector<hand::MarkLabel> read_mark_labels(const std::string& path) {
  const formats::CsvFile file = formats::read_csv(path);
  const std::array<const char*, 6> names = {"posture", "mark", "name", "x_mm", "y_mm", "z_mm"};
  std::array<std::size_t, 6> column{};
  for (std::size_t k = 0; k < names.size(); ++k) {
    const int found = file.column(names[k]);
    if (found < 0) {
      file.fail(file.header_line, std::string("has no column ") + names[k] +
                                      "; posture, mark, name, x_mm, y_mm and z_mm are needed");
    }
    column[k] = static_cast<std::size_t>(found);
  }
  std::vector<hand::MarkLabel> labels;
  for (const formats::CsvFile::Row& row : file.rows) {
    records::MarkText text{row.cells[column[0]], row.cells[column[1]], row.cells[column[2]],
                           Vec3::Zero(), path + ":" + std::to_string(row.line)};
    for (int a = 0; a < 3; ++a) {
      text.point[a] = file.number(row, column[static_cast<std::size_t>(a) + 3]);
    }
    const auto label =
        records::mark_label_of(text, [&](const std::string& why) { file.fail(row.line, why); });
    if (label) labels.push_back(*label);
  }
  return labels;
}

records::CsvTable mark_table(const std::vector<capture::TakenMark>& marks) {
  records::CsvTable table{{"posture", "mark", "name", "x_mm", "y_mm", "z_mm"}, {}};
  for (const capture::TakenMark& mark : marks) {
    table.rows.push_back(
        {std::string(name_of(mark.posture)), std::string(records::name_of(mark.kind)),
         records::mark_name(mark.kind, mark.segment), fmt::format("{:.2f}", mark.point.x()),
         fmt::format("{:.2f}", mark.point.y()), fmt::format("{:.2f}", mark.point.z())});
  }
  return table;
}

}  // namespace palmar::person_records
