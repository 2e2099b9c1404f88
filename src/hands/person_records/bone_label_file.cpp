// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_records/bone_label_file.h"

#include <array>

#include "palmar/formats/csv_reader.h"

namespace palmar::person_records {

std::vector<hand::BoneLabel> read_bone_labels(const std::string& path) {
  const formats::CsvFile file = formats::read_csv(path);
  std::array<std::size_t, 4> column{};
  const std::array<const char*, 4> names = {"name", "x_mm", "y_mm", "z_mm"};
  for (std::size_t k = 0; k < names.size(); ++k) {
    const int found = file.column(names[k]);
    if (found < 0) {
      file.fail(file.header_line, std::string("has no column ") + names[k] +
                                      "; name, x_mm, y_mm and z_mm are needed");
    }
    column[k] = static_cast<std::size_t>(found);
  }
  std::vector<hand::BoneLabel> labels;
  for (const formats::CsvFile::Row& row : file.rows) {
    hand::BoneLabel label;
    label.name = row.cells[column[0]];
    for (int a = 0; a < 3; ++a) {
      label.point[a] = file.number(row, column[static_cast<std::size_t>(a) + 1]);
    }
    label.place = path + ":" + std::to_string(row.line);
    labels.push_back(std::move(label));
  }
  return labels;
}

}  // namespace palmar::person_records
